//! A serial port of an input device: read by a thread of its own, so that every piece has the time it arrived.
//!
//! The servo bus reads its port itself: there the answer's time is known, and a thread between would only cost.

use super::intake::{Intake, Reading, gone};
use super::serial::{self, SerialTransport};
use super::{Boundary, Transport, TransportError, descriptor};
use crate::clock::{Clock, Instant};
use device_profiles::Line;
use rustix::fd::{AsFd, OwnedFd};
use std::io;
use std::sync::Arc;
use std::time::Duration;

/// An open port.
#[derive(Debug)]
pub struct StampedSerial {
    port: SerialTransport,
    intake: Intake,
}

/// Opens `path` with the line's manners; arrivals are noted by `clock`.
pub fn open(path: &str, line: &Line, clock: Arc<dyn Clock>) -> Result<StampedSerial, TransportError> {
    let port = serial::open_line(path, line)?;
    let reading = Port(port.handle()?);
    let name = path.rsplit('/').next().unwrap_or(path);
    let intake = Intake::spawn(name, clock, Box::new(reading)).map_err(|source| TransportError::Io {
        address: path.to_owned(),
        source,
    })?;
    Ok(StampedSerial { port, intake })
}

struct Port(OwnedFd);

impl Reading for Port {
    fn read(&mut self, buffer: &mut [u8], limit: Duration) -> io::Result<usize> {
        descriptor::read_within(self.0.as_fd(), buffer, limit)
    }
}

impl Transport for StampedSerial {
    fn boundary(&self) -> Boundary {
        Boundary::Stream
    }

    fn read(&mut self, buffer: &mut [u8]) -> Result<usize, TransportError> {
        self.intake.read(buffer).ok_or_else(|| gone(self.port.address()))
    }

    fn write(&mut self, bytes: &[u8]) -> Result<(), TransportError> {
        self.port.write(bytes)
    }

    fn set_baud(&mut self, baud: u32) -> Result<(), TransportError> {
        self.port.set_baud(baud)
    }

    fn arrived(&self) -> Option<Instant> {
        self.intake.arrived()
    }

    fn dropped(&self) -> u64 {
        self.intake.dropped()
    }

    fn wait(&mut self, clock: &dyn Clock, until: Instant) {
        self.intake.wait(clock, until);
    }

    fn ready(&mut self) -> bool {
        self.intake.ready()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::clock::MonotonicClock;
    use crate::transport::pty::Pty;
    use device_profiles::Parity;
    use rustix::termios::ControlModes as Modes;

    fn line(parity: Parity) -> Line {
        Line {
            baud: 9600,
            parity,
            data_bits: 8,
            stop_bits: 1,
            rts_cts: false,
            boot_wait_ms: 0,
        }
    }

    #[test]
    fn pieces_keep_the_time_they_arrived_however_late_they_are_read() {
        let clock = Arc::new(MonotonicClock::new());
        let mut far = Pty::open().expect("a terminal");
        let path = far.path().to_string_lossy().into_owned();
        let theirs: Arc<dyn Clock> = clock.clone();
        let mut near = open(&path, &line(Parity::Odd), theirs).expect("it is there");
        far.write(&[1, 2, 3]).expect("room");
        near.wait(clock.as_ref(), clock.now().after(Duration::from_secs(5)));
        let there = clock.now();
        clock.sleep_until(there.after(Duration::from_millis(50)));
        let mut buffer = [0; 8];
        let count = near.read(&mut buffer).expect("it is open");
        assert_eq!(buffer[..count], [1, 2, 3][..count]);
        assert!(near.arrived().expect("noted") <= there);
        drop(far);
        let until = clock.now().after(Duration::from_secs(5));
        while clock.now() < until && near.read(&mut buffer).is_ok() {
            near.wait(clock.as_ref(), until);
        }
        assert!(near.read(&mut buffer).expect_err("its far end is gone").is_gone());
    }

    #[test]
    fn every_manner_of_a_line_is_taken() {
        let far = Pty::open().expect("a terminal");
        let path = far.path().to_string_lossy().into_owned();
        for parity in [Parity::None, Parity::Odd, Parity::Even] {
            for boot_wait_ms in [0, 2000] {
                let manners = Line {
                    stop_bits: 2,
                    rts_cts: true,
                    boot_wait_ms,
                    ..line(parity)
                };
                let port = serial::open_line(&path, &manners).expect("it is taken");
                let settings = rustix::termios::tcgetattr(port.handle().expect("open")).expect("a terminal");
                let has = |flag| settings.control_modes.contains(flag);
                assert_eq!(has(Modes::PARODD), parity == Parity::Odd);
                assert_eq!(
                    has(Modes::HUPCL),
                    boot_wait_ms == 0,
                    "a board goes on when it is closed"
                );
            }
        }
    }
}
