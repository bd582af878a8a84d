//! How near does a served bus come to what its wire allows? Twenty servos at 1 Mbaud on a pseudo-terminal, each
//! cycle one sync write of goals and one sync read of positions: `cargo run --release -p bench --example wire`.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use bench::serve::{self, BusPlan, Place, ServeLine, ServoSpec};
use device::clock::{Clock, Instant, MonotonicClock};
use device::servo::framing::dynamixel2;
use device::transport::{Transport, serial};
use device_profiles::Profiles;

const SERVOS: u8 = 20;
const CYCLES: u32 = 1000;
const BAUD: u32 = 1_000_000;
/// Return Delay Time, Goal Position, Present Position: addresses of the X series (e-manual).
const RETURN_DELAY: u16 = 9;
const GOAL: u16 = 116;
const POSITION: u16 = 132;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let plan = BusPlan::new(ServoSpec::parse(&format!("XL430-W250:1-{SERVOS}"))?);
    let mut device = plan.build(&Profiles::builtin())?;
    let mut line = ServeLine::open(&Place::Pty(None), BAUD)?;
    let path = line.path().to_owned();
    let stop = Arc::new(AtomicBool::new(false));
    let there = Arc::clone(&stop);
    let thread = std::thread::spawn(move || {
        serve::run(
            &mut device,
            &mut line,
            &MonotonicClock::new(),
            &there,
            &mut || None,
            &mut |_| (),
        )
    });
    let mut port = serial::open(&path, BAUD)?;
    let clock = MonotonicClock::new();
    for id in 1..=SERVOS {
        let mut packet = Vec::new();
        dynamixel2::write(&mut packet, id, RETURN_DELAY, &[0])?;
        port.write(&packet)?;
        hear(&mut port, &clock, dynamixel2::STATUS_OVERHEAD_BYTES);
    }
    let goals = (1..=SERVOS).map(|id| (id, 2048_i32.to_le_bytes()));
    let mut packet = Vec::new();
    dynamixel2::sync_write(&mut packet, GOAL, goals)?;
    dynamixel2::sync_read(&mut packet, POSITION, 4, 1..=SERVOS)?;
    let answer_bytes = usize::from(SERVOS) * (dynamixel2::STATUS_OVERHEAD_BYTES + 4);
    let began = clock.now();
    for _ in 0..CYCLES {
        port.write(&packet)?;
        hear(&mut port, &clock, answer_bytes);
    }
    let took_secs = clock.now().since(began).as_secs_f64() / f64::from(CYCLES);
    let wire_secs = (packet.len() + answer_bytes) as f64 * 10.0 / f64::from(BAUD);
    println!(
        "wire {:.3} ms, cycle {:.3} ms, ratio {:.3}",
        wire_secs * 1e3,
        took_secs * 1e3,
        wire_secs / took_secs
    );
    stop.store(true, Ordering::Relaxed);
    thread.join().expect("the server does not panic")?;
    Ok(())
}

/// Takes `count` bytes, waiting for them no longer than a second.
fn hear(port: &mut dyn Transport, clock: &dyn Clock, count: usize) {
    let end: Instant = clock.now().after(Duration::from_secs(1));
    let (mut heard, mut buffer) = (0, [0; 1024]);
    while heard < count && clock.now() < end {
        port.wait(clock, end);
        heard += port.read(&mut buffer).unwrap_or(0);
    }
}
