//! How long a link takes to place: the crowd of the mathematics reference, and one clip that stays in cache.
//!
//! 1000 figures of 15 links and 12 keys, each with its own keys and its own kinetic spline; outputs are start and
//! frame of every link. Source: `docs/math.md`, "Speed".

use super::{Row, Subject, Tell, repeated};
use crate::measure::rig_step::nanos_per;
use glam::DVec3;
use motion::{Clip, Figure, FigureKey, FigurePose, Keyframes, KineticsMode, LinkPose, LinkSpec, Placed};
use std::hint::black_box;
use std::sync::Arc;

/// Name of the measure.
pub const NAME: &str = "interpolant";

const LIMIT_NS: f64 = 60.0;
const FIGURES: usize = 1000;
const LINKS: usize = 15;
const KEYS: usize = 12;
/// Figures placed a repetition when there is only one clip.
const SINGLE_PLACES: usize = 1000;
/// All clips last about so long.
const SPAN_SECS: f64 = 6.0;
const FRAME_SECS: f64 = 1.0 / 30.0;
/// Many and short, so that most are over before anything else gets the processor.
const ROUNDS: usize = 201;
/// Parents of the thesis's figure, by number.
const PARENTS: [usize; LINKS] = [0, 0, 1, 2, 3, 1, 5, 6, 1, 8, 9, 10, 8, 12, 13];

/// A reproducible stream of numbers in 0..1 (splitmix64).
pub struct Chance(pub u64);

impl Chance {
    /// The next number.
    pub fn next_unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn point(&mut self) -> DVec3 {
        let mut signed = || 2.0 * self.next_unit() - 1.0;
        DVec3::new(signed(), signed(), signed())
    }
}

fn figure() -> anyhow::Result<Arc<Figure>> {
    let specs: Vec<LinkSpec> = (0..LINKS)
        .map(|number| LinkSpec {
            number: number as u32,
            name: String::new(),
            dof: 3,
            length: 0.2,
            children: (1..LINKS)
                .filter(|&child| PARENTS[child] == number)
                .map(|child| (child as u32, DVec3::new(0.05, 0.0, 0.2)))
                .collect(),
        })
        .collect();
    Ok(Arc::new(Figure::new(&specs)?.0))
}

fn clip(figure: &Arc<Figure>, chance: &mut Chance) -> anyhow::Result<Clip> {
    let mut secs = 0.0;
    let mut keyframes = Keyframes::new(Arc::clone(figure));
    keyframes.kinetics = KineticsMode::Natural;
    for _ in 0..KEYS {
        let link = |chance: &mut Chance| LinkPose {
            direction: chance.point() + DVec3::Z * 1e-3,
            twist_rad: 3.0 * (2.0 * chance.next_unit() - 1.0),
            length: 0.2,
        };
        let links = (0..LINKS).map(|_| link(chance)).collect();
        let root = chance.point();
        keyframes.keys.push(FigureKey {
            secs,
            pose: FigurePose { root, links },
        });
        secs += SPAN_SECS / KEYS as f64 * (0.6 + 0.8 * chance.next_unit());
    }
    Ok(Clip::build(&keyframes)?)
}

/// Takes the measure.
pub fn take(tell: &mut Tell<'_>) -> anyhow::Result<()> {
    let figure = figure()?;
    let mut chance = Chance(1);
    let clips: Vec<Clip> = (0..FIGURES)
        .map(|_| clip(&figure, &mut chance))
        .collect::<anyhow::Result<_>>()?;
    let (crowd, single) = (&clips[..], &clips[..1]);
    let mut subjects = [
        forward("crowd, forward", crowd, FIGURES),
        random("crowd, random time", crowd, FIGURES),
        forward("one clip in cache, forward", single, SINGLE_PLACES),
        random("one clip in cache, random time", single, SINGLE_PLACES),
    ];
    let taken = repeated(&mut subjects, ROUNDS)?;
    for (subject, taken) in subjects.iter().zip(taken) {
        tell(&Row {
            measure: NAME,
            row: subject.row.clone(),
            subject: subject.name,
            value: taken.median,
            best: taken.least,
            unit: "ns/link",
            limit: Some(LIMIT_NS),
            ratio: Some(taken.median / LIMIT_NS),
        });
    }
    Ok(())
}

fn forward<'a>(row: &str, clips: &'a [Clip], places: usize) -> Subject<'a> {
    let mut placed: Vec<Placed> = Vec::new();
    let mut secs = 0.0;
    let repeat = move || {
        let nanos = nanos_per(places * LINKS, || {
            secs = (secs + FRAME_SECS) % SPAN_SECS;
            for (at, clip) in clips.iter().cycle().take(places).enumerate() {
                // A crowd is not in step; a single clip plays on.
                let offset_secs = at as f64 * if clips.len() > 1 { 0.01 } else { FRAME_SECS };
                clip.place((secs + offset_secs) % SPAN_SECS, &mut placed);
                black_box(&placed);
            }
        });
        Ok(nanos)
    };
    Subject {
        row: row.to_owned(),
        name: "dialrig",
        repeat: Box::new(repeat),
    }
}

fn random<'a>(row: &str, clips: &'a [Clip], places: usize) -> Subject<'a> {
    let mut placed: Vec<Placed> = Vec::new();
    let mut chance = Chance(2);
    let times: Vec<f64> = (0..places).map(|_| chance.next_unit() * SPAN_SECS).collect();
    let repeat = move || {
        let nanos = nanos_per(places * LINKS, || {
            for (clip, secs) in clips.iter().cycle().zip(&times) {
                clip.place(*secs, &mut placed);
                black_box(&placed);
            }
        });
        Ok(nanos)
    };
    Subject {
        row: row.to_owned(),
        name: "dialrig",
        repeat: Box::new(repeat),
    }
}
