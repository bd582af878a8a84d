//! The near end of a simulated cable: bytes in and out, at the moment the shared clock says it is.

use std::sync::{Arc, Mutex};

use device::clock::{Clock, Instant};
use device::transport::{Boundary, Transport, TransportError, WAIT_STEP};

use super::lock;
use super::seat::Seat;

/// An open port of a simulated device.
pub struct SimTransport {
    address: String,
    seat: Arc<Mutex<Seat>>,
    clock: Arc<dyn Clock>,
    opening: u64,
}

impl SimTransport {
    pub(super) fn new(address: String, seat: Arc<Mutex<Seat>>, clock: Arc<dyn Clock>, opening: u64) -> Self {
        Self {
            address,
            seat,
            clock,
            opening,
        }
    }

    fn gone(&self) -> TransportError {
        TransportError::Gone {
            address: self.address.clone(),
        }
    }
}

impl Transport for SimTransport {
    fn boundary(&self) -> Boundary {
        Boundary::Stream
    }

    fn read(&mut self, buffer: &mut [u8]) -> Result<usize, TransportError> {
        let now_us = self.clock.now().as_micros();
        let mut seat = lock(&self.seat);
        if !seat.call(self.opening, now_us) {
            return Err(self.gone());
        }
        seat.advance(now_us);
        Ok(seat.take(buffer))
    }

    fn write(&mut self, bytes: &[u8]) -> Result<(), TransportError> {
        let now_us = self.clock.now().as_micros();
        let mut seat = lock(&self.seat);
        if !seat.call(self.opening, now_us) {
            return Err(self.gone());
        }
        seat.put(now_us, bytes);
        Ok(())
    }

    fn set_baud(&mut self, baud: u32) -> Result<(), TransportError> {
        let now_us = self.clock.now().as_micros();
        let mut seat = lock(&self.seat);
        if !seat.is_there(self.opening) {
            return Err(self.gone());
        }
        seat.firmware().set_line_baud(now_us, baud);
        Ok(())
    }

    fn wait(&mut self, clock: &dyn Clock, until: Instant) {
        while clock.now() < until && !self.ready() {
            let soon = clock.now().after(WAIT_STEP);
            let due = lock(&self.seat)
                .firmware()
                .next_byte_us()
                .map(|us| Instant::from_nanos(us * 1000));
            // An answer that is not under way yet may come sooner than one that is.
            clock.sleep_until(until.min(due.map_or(soon, |due| due.min(soon).max(clock.now()))));
        }
    }

    fn ready(&mut self) -> bool {
        let now_us = self.clock.now().as_micros();
        let mut seat = lock(&self.seat);
        seat.advance(now_us);
        seat.has_bytes() || !seat.is_there(self.opening)
    }
}
