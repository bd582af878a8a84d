//! What does a host hear when a dial of the SGI box is turned a quarter turn?
//!
//! `cargo run -p firmware-sim --example turn_a_dial`

use firmware_sim::dial_box::Options;
use firmware_sim::{Firmware, SgiDialBox};

fn main() {
    let mut dial_box = SgiDialBox::new(Options::default());
    // Initialise, then let all eight dials report their counts.
    dial_box.receive(0, &[0x20, 0x50, 0x00, 0xFF]);
    // 64 counts of 256, over a fiftieth of a second.
    dial_box.turn(10_000, 3, 64, 20_000);
    for now_us in (0..40_000).step_by(1000) {
        let mut heard = Vec::new();
        dial_box.transmit(now_us, &mut heard);
        if !heard.is_empty() {
            println!("{:5.3} s  {heard:02x?}", now_us as f64 * 1e-6);
        }
    }
}
