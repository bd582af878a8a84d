//! Any line as a `serialport` port, for programs that want one of those.

use device::transport::Transport;
use device::{Clock, MonotonicClock};
use serialport::{ClearBuffer, DataBits, FlowControl, Parity, Result, SerialPort, StopBits};
use std::io;
use std::time::Duration;

/// The host's end of a line.
pub(super) struct AsPort {
    line: Box<dyn Transport>,
    clock: MonotonicClock,
    timeout: Duration,
    baud: u32,
    /// Read from the line and not asked for yet.
    waiting: Vec<u8>,
}

impl AsPort {
    pub(super) fn new(line: Box<dyn Transport>, clock: MonotonicClock, baud: u32, timeout: Duration) -> Self {
        Self {
            line,
            clock,
            timeout,
            baud,
            waiting: Vec::new(),
        }
    }

    fn look(&mut self) -> io::Result<()> {
        let mut chunk = [0; 512];
        loop {
            let count = self.line.read(&mut chunk).map_err(io::Error::other)?;
            if count == 0 {
                return Ok(());
            }
            self.waiting
                .extend_from_slice(chunk.get(..count).unwrap_or_default());
            // Most often that was all; whoever waits for more asks again.
            if count < chunk.len() {
                return Ok(());
            }
        }
    }
}

impl io::Read for AsPort {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        if self.waiting.is_empty() {
            let until = self.clock.now().after(self.timeout);
            self.line.wait(&self.clock, until);
            self.look()?;
        }
        let count = self.waiting.len().min(buffer.len());
        if count == 0 {
            return Err(io::ErrorKind::TimedOut.into());
        }
        for (place, byte) in buffer.iter_mut().zip(self.waiting.drain(..count)) {
            *place = byte;
        }
        Ok(count)
    }
}

impl io::Write for AsPort {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.line.write(bytes).map_err(io::Error::other)?;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// What any line has of a serial port: a speed, a time limit and bytes. The rest is as it always is.
impl SerialPort for AsPort {
    fn name(&self) -> Option<String> {
        None
    }

    fn baud_rate(&self) -> Result<u32> {
        Ok(self.baud)
    }

    fn data_bits(&self) -> Result<DataBits> {
        Ok(DataBits::Eight)
    }

    fn flow_control(&self) -> Result<FlowControl> {
        Ok(FlowControl::None)
    }

    fn parity(&self) -> Result<Parity> {
        Ok(Parity::None)
    }

    fn stop_bits(&self) -> Result<StopBits> {
        Ok(StopBits::One)
    }

    fn timeout(&self) -> Duration {
        self.timeout
    }

    fn set_baud_rate(&mut self, baud: u32) -> Result<()> {
        self.baud = baud;
        self.line.set_baud(baud).map_err(io::Error::other)?;
        Ok(())
    }

    fn set_data_bits(&mut self, _: DataBits) -> Result<()> {
        Ok(())
    }

    fn set_flow_control(&mut self, _: FlowControl) -> Result<()> {
        Ok(())
    }

    fn set_parity(&mut self, _: Parity) -> Result<()> {
        Ok(())
    }

    fn set_stop_bits(&mut self, _: StopBits) -> Result<()> {
        Ok(())
    }

    fn set_timeout(&mut self, timeout: Duration) -> Result<()> {
        self.timeout = timeout;
        Ok(())
    }

    fn write_request_to_send(&mut self, _: bool) -> Result<()> {
        Ok(())
    }

    fn write_data_terminal_ready(&mut self, _: bool) -> Result<()> {
        Ok(())
    }

    fn read_clear_to_send(&mut self) -> Result<bool> {
        Ok(true)
    }

    fn read_data_set_ready(&mut self) -> Result<bool> {
        Ok(true)
    }

    fn read_ring_indicator(&mut self) -> Result<bool> {
        Ok(false)
    }

    fn read_carrier_detect(&mut self) -> Result<bool> {
        Ok(true)
    }

    fn bytes_to_read(&self) -> Result<u32> {
        // The line itself can only be looked at by reading it; between two instructions it is silent.
        Ok(self.waiting.len() as u32)
    }

    fn bytes_to_write(&self) -> Result<u32> {
        Ok(0)
    }

    fn clear(&self, _: ClearBuffer) -> Result<()> {
        Ok(())
    }

    fn try_clone(&self) -> Result<Box<dyn SerialPort>> {
        let message = "the line has one end";
        Err(io::Error::new(io::ErrorKind::Unsupported, message).into())
    }

    fn set_break(&self) -> Result<()> {
        Ok(())
    }

    fn clear_break(&self) -> Result<()> {
        Ok(())
    }
}
