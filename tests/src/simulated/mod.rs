//! Simulated firmware at the far end of a line: in the same thread ([`Line`]) or behind a pseudo-terminal with a
//! thread of its own ([`Served`]).
//!
//! Apart from the bench's own ports, so that the tests of the bench's parts do not rest on the bench.

mod line;
mod served;
mod servos;

pub use line::Line;
pub use served::Served;
pub use servos::{POSITION, bus_of, members};

use firmware_sim::{Firmware, ServoBus, SgiDialBox, WacomIv};

/// Firmware that knows when it is worth looking at its line.
pub trait Wired: Firmware + Send + 'static {
    /// When, in microseconds, what is on its way will have arrived in one piece; none while nothing is known to
    /// come. Waking for every byte would take a processor of its own at 1 Mbaud.
    fn whole_us(&self, now_us: u64) -> Option<u64>;
}

impl Wired for ServoBus {
    fn whole_us(&self, now_us: u64) -> Option<u64> {
        // Answers come one behind the other, so the last one known ends last.
        let ends = self.statuses().last().map(|status| status.last_us);
        ends.filter(|&ends| ends > now_us).or(self.next_byte_us())
    }
}

impl Wired for SgiDialBox {
    fn whole_us(&self, _now_us: u64) -> Option<u64> {
        self.next_byte_us()
    }
}

impl Wired for WacomIv {
    fn whole_us(&self, _now_us: u64) -> Option<u64> {
        self.next_byte_us()
    }
}
