//! What is asked of the puppet and what goes wrong meanwhile, from one random number generator.

use super::stage::Stage;
use fastrand::Rng;
use motion::JointClip;
use player::{Order, State};
use std::sync::Arc;

/// Doings of one run, at most.
const DOINGS_MAX: u32 = 10;
/// Ticks between two doings, at most.
const TICKS_MAX: u32 = 40;

/// A whole run, but for its end.
pub(super) fn perform(stage: &mut Stage, random: &mut Rng) {
    let clips: Vec<Arc<JointClip>> = (0..2).filter_map(|_| clip(stage, random)).collect();
    stage.tick([Order::CompensateLag(random.bool()), Order::Arm]);
    for _ in 0..45 {
        stage.tick([]);
    }
    for _ in 0..random.u32(2..=DOINGS_MAX) {
        come_back(stage, random);
        act(stage, random, &clips);
        for _ in 0..random.u32(0..TICKS_MAX) {
            stage.tick([]);
        }
    }
}

/// What has stopped is mostly started again, or nothing more would happen.
fn come_back(stage: &mut Stage, random: &mut Rng) {
    if matches!(stage.player().state(), State::Faulted(_)) && random.f64() < 0.7 {
        stage.tick([Order::Reset]);
        for _ in 0..random.u32(1..30) {
            stage.tick([]);
        }
    }
    if *stage.player().state() == State::Released && random.f64() < 0.8 {
        stage.tick([Order::Arm]);
        for _ in 0..random.u32(0..60) {
            stage.tick([]);
        }
    }
}

fn act(stage: &mut Stage, random: &mut Rng, clips: &[Arc<JointClip>]) {
    match random.u32(0..20) {
        0..7 => {
            if let Some(clip) = random.choice(clips.iter()) {
                stage.tick([Order::Play {
                    clip: Arc::clone(clip),
                    from_secs: random.f64() * 2.0 - 0.2,
                    speed: 0.2 + random.f64() * if random.u32(0..4) == 0 { 9.8 } else { 1.5 },
                    looped: random.bool(),
                }]);
            }
        }
        7..9 => stage.tick([Order::Seek(random.f64() * 3.0 - 0.5)]),
        9..12 => {
            let pose: Vec<f64> = stage
                .limits()
                .iter()
                .map(|limits| angle(limits, random))
                .collect();
            stage.tick([Order::Follow(pose.into())]);
        }
        12 => stage.tick([Order::Hold]),
        13 => {
            let order = [Order::Release, Order::Stop, Order::Reset, Order::Arm];
            stage.tick(order.get(random.usize(0..4)).cloned());
        }
        14 => stage.stall(random.f64() * 0.7),
        15 => {
            let bus = random.usize(0..4);
            stage.plug(bus, false);
            for _ in 0..random.u32(0..40) {
                stage.tick([]);
            }
            stage.plug(bus, true);
        }
        _ => {
            let bus = random.usize(0..4);
            let text = fault(stage.ids(bus), random);
            stage.inject(bus, &text);
        }
    }
}

/// What may go wrong. Not a jammed horn that comes free: it leaps to where it should be as fast as the motor can, and
/// nobody on the wire can help that. Not bits turned on the way to servos either, see `docs/safety.md`.
fn fault(ids: &[u8], random: &mut Rng) -> String {
    let id = random.choice(ids.iter()).copied().unwrap_or(1);
    let ms = random.u32(1..900);
    match random.u32(0..14) {
        0 => format!("drop {}% for {ms}ms", random.u32(1..60)),
        1 => format!("late {}ms once", random.u32(1..60)),
        2 => format!("late {}ms for {ms}ms", random.u32(1..40)),
        3 => format!("servo {id} silent for {ms}ms"),
        4 => format!("servo {id} deaf for {ms}ms"),
        5 => format!("stall for {ms}ms"),
        6 => format!("host stall for {ms}ms"),
        7 => format!("echo for {ms}ms"),
        8 => format!("cable cut after {} for {ms}ms", random.usize(0..=ids.len())),
        9 => format!("data cut after {} for {ms}ms", random.usize(0..=ids.len())),
        10 => format!("servo {id} reboot"),
        11 => format!("brownout for {ms}ms"),
        12 => format!("servo {id} flips {}% for {ms}ms", random.u32(1..10)),
        _ => format!("servo {id} hot {} for {ms}ms", random.u32(55..68)),
    }
}

/// An angle as anybody might ask for it: most inside the range, some far outside, some no numbers at all.
fn angle(limits: &device::servo::Limits, random: &mut Rng) -> f64 {
    let (low, high) = (limits.min_rad(), limits.max_rad());
    match random.u32(0..12) {
        0 => *random
            .choice([f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300].iter())
            .unwrap_or(&0.0),
        1..3 => random.f64() * 18.0 - 9.0,
        _ => low + random.f64() * (high - low),
    }
}

/// A clip that asks for too much: rows anywhere, often soon after each other, of some joints or all.
fn clip(stage: &Stage, random: &mut Rng) -> Option<Arc<JointClip>> {
    let limits = stage.limits();
    let names = stage.player().puppet().joints();
    let chosen: Vec<usize> = (0..names.len()).filter(|_| random.f64() < 0.7).collect();
    let rows = random.usize(2..8);
    let mut samples = Vec::with_capacity(rows * chosen.len());
    for _ in 0..rows {
        for joint in &chosen {
            let limits = &limits[*joint];
            let middle = f64::midpoint(limits.min_rad(), limits.max_rad());
            samples.push(middle + (random.f64() - 0.5) * 1.3 * (limits.max_rad() - limits.min_rad()));
        }
    }
    let joints = chosen.iter().map(|joint| names[*joint].clone()).collect();
    let period_secs = 0.02 + random.f64() * random.f64() * 1.2;
    JointClip::new(joints, period_secs, samples).ok().map(Arc::new)
}
