//! What a link itself takes to carry bytes there and back, both ends awake all the time.
//!
//! Measured once for all who are measured, so that nobody has an advantage. The way back is taken as long after the way
//! there as on a bus: a link that has just carried bytes carries the next ones sooner than one that has rested.

use super::far::{Link, Socket};
use device::transport::{self, Transport};
use device::{Clock, MonotonicClock};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// Probes; a fifth of a second even where each takes a millisecond.
const PROBES: usize = 200;
/// Bytes of a probe, as many as a short question has.
const PROBE: [u8; 64] = [0x55; 64];
/// So long the far end waits, awake, before it sends a probe back: what an answer takes in the shortest cycle measured
/// (six servos by fast read at 4 Mbaud, 56 bytes).
const REST: Duration = Duration::from_micros(140);
/// After so long a probe is lost and the channel unfit.
const LOST: Duration = Duration::from_secs(2);

/// Rounds, of which the quickest counts: a busy machine only makes it slower.
const ROUNDS: usize = 8;

/// There and back: the quickest quarter's longest time, in the quickest of the rounds.
pub(super) fn there_and_back(link: Link) -> anyhow::Result<Duration> {
    static MEASURED: [OnceLock<Duration>; 2] = [OnceLock::new(), OnceLock::new()];
    let [terminal, tcp] = &MEASURED;
    let measured = match link {
        Link::Terminal => terminal,
        Link::Tcp => tcp,
    };
    if let Some(measured) = measured.get() {
        return Ok(*measured);
    }
    let mut quickest = LOST;
    for _ in 0..ROUNDS {
        quickest = quickest.min(round(link)?);
    }
    Ok(*measured.get_or_init(|| quickest))
}

fn round(link: Link) -> anyhow::Result<Duration> {
    let (mut far, path) = link.open()?;
    let mut near = transport::open(&path.parse()?, 1_000_000)?;
    let over = AtomicBool::new(false);
    std::thread::scope(|scope| {
        scope.spawn(|| echo(&mut far, &over));
        let took = probe(near.as_mut());
        over.store(true, Ordering::Relaxed);
        took
    })
}

fn echo(far: &mut Socket, over: &AtomicBool) {
    let clock = MonotonicClock::new();
    let mut bytes = [0; PROBE.len()];
    while !over.load(Ordering::Relaxed) {
        let Some(line) = far.line() else { continue };
        let count = line.read(&mut bytes).unwrap_or(0);
        if count > 0 {
            let back_at = clock.now().after(REST);
            while clock.now() < back_at {
                std::hint::spin_loop();
            }
            // What is not echoed is missed by the other side, which says so.
            let _ = line.write(bytes.get(..count).unwrap_or_default());
        }
    }
}

fn probe(near: &mut dyn Transport) -> anyhow::Result<Duration> {
    let clock = MonotonicClock::new();
    let mut took = Vec::with_capacity(PROBES);
    let mut bytes = [0; PROBE.len()];
    for _ in 0..PROBES {
        let began = clock.now();
        near.write(&PROBE)?;
        let mut back = 0;
        while back < PROBE.len() {
            back += near.read(&mut bytes)?;
            anyhow::ensure!(clock.now().since(began) < LOST, "a link lost bytes");
        }
        took.push(clock.now().since(began).saturating_sub(REST));
        let next_at = clock.now().after(REST);
        while clock.now() < next_at {
            std::hint::spin_loop();
        }
    }
    took.sort_unstable();
    Ok(took.get(PROBES / 4).copied().unwrap_or_default())
}
