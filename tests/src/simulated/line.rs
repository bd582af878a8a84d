//! A transport whose far end is simulated firmware in the same thread: nothing is handed over, so what is seen is
//! the host's own doing, and in virtual time everything repeats exactly.

use super::Wired;
use device::transport::{Boundary, Transport, TransportError};
use device::{Clock, Instant};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// Longest sleep while nothing is known to come: an answer may begin at any moment once its question is out.
const LOOK: Duration = Duration::from_micros(100);

/// One end of a line with a device at the other. Clones lead to the same device.
pub struct Line<F> {
    far: Arc<Mutex<Far<F>>>,
    clock: Arc<dyn Clock>,
}

struct Far<F> {
    device: F,
    /// What has arrived and was not read yet.
    arrived: Vec<u8>,
    /// Whether the cable is in.
    connected: bool,
}

impl<F> Clone for Line<F> {
    fn clone(&self) -> Self {
        Self {
            far: Arc::clone(&self.far),
            clock: Arc::clone(&self.clock),
        }
    }
}

impl<F: Wired> Line<F> {
    /// A line to `device`, whose time is `clock`'s.
    pub fn new(device: F, clock: Arc<dyn Clock>) -> Self {
        let far = Far {
            device,
            arrived: Vec::with_capacity(4096),
            connected: true,
        };
        Self {
            far: Arc::new(Mutex::new(far)),
            clock,
        }
    }

    /// Does something to the device now, or looks at it.
    pub fn with<T>(&self, act: impl FnOnce(&mut F, u64) -> T) -> T {
        let now_us = self.now_us();
        act(&mut self.far().device, now_us)
    }

    /// Puts the cable in or takes it out.
    pub fn connect(&self, connected: bool) {
        self.far().connected = connected;
    }

    fn far(&self) -> MutexGuard<'_, Far<F>> {
        // A panic of another test leaves a simulated device, which has no broken state.
        self.far.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn now_us(&self) -> u64 {
        self.clock.now().as_micros()
    }

    fn carried(&self) -> Result<MutexGuard<'_, Far<F>>, TransportError> {
        let now_us = self.now_us();
        let mut far = self.far();
        let Far { device, arrived, .. } = &mut *far;
        device.transmit(now_us, arrived);
        if far.connected {
            return Ok(far);
        }
        far.arrived.clear();
        Err(TransportError::Gone {
            address: "sim:line".to_owned(),
        })
    }
}

impl<F: Wired> Transport for Line<F> {
    fn boundary(&self) -> Boundary {
        Boundary::Stream
    }

    fn read(&mut self, buffer: &mut [u8]) -> Result<usize, TransportError> {
        let mut far = self.carried()?;
        let count = far.arrived.len().min(buffer.len());
        for (place, byte) in buffer.iter_mut().zip(far.arrived.drain(..count)) {
            *place = byte;
        }
        Ok(count)
    }

    fn write(&mut self, bytes: &[u8]) -> Result<(), TransportError> {
        let now_us = self.now_us();
        self.carried()?.device.receive(now_us, bytes);
        Ok(())
    }

    fn set_baud(&mut self, baud: u32) -> Result<(), TransportError> {
        let now_us = self.now_us();
        self.carried()?.device.set_line_baud(now_us, baud);
        Ok(())
    }

    fn wait(&mut self, clock: &dyn Clock, until: Instant) {
        while clock.now() < until && !self.ready() {
            let now_us = self.now_us();
            let whole = self.far().device.whole_us(now_us);
            let look = clock.now().after(LOOK);
            // One microsecond later, since the simulation counts whole ones.
            let next = whole.map_or(look, |us| Instant::from_nanos((us + 1) * 1000));
            clock.sleep_until(until.min(next.max(clock.now())));
        }
    }

    fn ready(&mut self) -> bool {
        self.carried().map_or(true, |far| !far.arrived.is_empty())
    }
}
