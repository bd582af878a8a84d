//! Time made visible around the present pose: onion skin, trajectories, equal-time ticks.
//!
//! Ticks that stand close mean slow, wide apart mean fast: they show the timing, the line shows the path,
//! and editing one leaves the other alone. Source: TR-88-032, P-curves; Baecker 1969.

use glam::DVec3;
use motion::clip::Clip;
use motion::figure::Placed;
use ps300::display::Stroke as Vector;

use super::figure::{self, Style};
use super::scene::{Ink, Mark, Scene};
use super::theme;

/// The clip's time from first to last key, seconds.
pub fn span_secs(clip: &Clip) -> [f64; 2] {
    [clip.start_secs(), clip.start_secs() + clip.duration_secs()]
}

/// Adds the poses `count` steps of `step_secs` before and after `now_secs`, fainter the farther, nothing
/// outside the clip.
pub fn add_onion(
    scene: &mut Scene,
    clip: &Clip,
    shapes: &[Vec<Vector>],
    now_secs: f64,
    (count, step_secs): (u32, f64),
) {
    let [start, end] = span_secs(clip);
    let mut placed = Vec::new();
    // The faintest first, so that nearer moments lie over farther ones.
    for step in (1..=count).rev() {
        let strength = 0.6 * (1.0 - f64::from(step - 1) / f64::from(count + 1));
        for secs in [
            now_secs - f64::from(step) * step_secs,
            now_secs + f64::from(step) * step_secs,
        ] {
            if (start..=end).contains(&secs) {
                clip.place(secs, &mut placed);
                figure::add(scene, &placed, shapes, Style::ghost(strength as f32));
            }
        }
    }
}

/// The most samples one trajectory takes; longer clips get coarser lines, not slower pictures.
const SAMPLES_MAX: usize = 1200;

/// Where every link was at even steps of time.
pub struct Samples {
    secs: Vec<f64>,
    placed: Vec<Vec<Placed>>,
    /// Samples per tick.
    per_tick: usize,
}

impl Samples {
    /// Samples the whole clip, four samples a tick.
    pub fn of(clip: &Clip, tick_secs: f64) -> Samples {
        let [start, end] = span_secs(clip);
        let mut per_tick = 4;
        let mut count = ((end - start) / tick_secs * per_tick as f64).max(0.0).round() as usize;
        if count > SAMPLES_MAX {
            per_tick = 1;
            count = (count / 4).min(SAMPLES_MAX);
        }
        let secs: Vec<f64> = (0..=count)
            .map(|i| (start + tick_secs * i as f64 / per_tick as f64).min(end.max(start)))
            .collect();
        let placed = secs
            .iter()
            .map(|&secs| {
                let mut placed = Vec::new();
                clip.place(secs, &mut placed);
                placed
            })
            .collect();
        Samples {
            secs,
            placed,
            per_tick,
        }
    }

    /// The lowest point any link ever reaches.
    pub fn lowest(&self) -> Option<f64> {
        lowest(self.placed.iter().flatten())
    }

    /// Adds the way of `link`'s end from `from_secs` to `to_secs`, a tick at each step of time and a diamond at
    /// each key.
    pub fn add_trail(
        &self,
        scene: &mut Scene,
        link: usize,
        [from_secs, to_secs]: [f64; 2],
        ink: Ink,
        key_secs: &[f64],
    ) {
        let inside = |secs: f64| (from_secs..=to_secs).contains(&secs);
        let ways = self.secs.iter().zip(&self.placed).enumerate();
        let ends: Vec<(usize, DVec3)> = ways
            .filter(|(_, (secs, _))| inside(**secs))
            .filter_map(|(index, (_, placed))| Some((index, placed.get(link)?.end)))
            .collect();
        let points: Vec<DVec3> = ends.iter().map(|(_, end)| *end).collect();
        scene.polyline(&points, theme::WIDTH_GHOST, ink.faded(ink.strength * 0.5));
        for (_, end) in ends.iter().filter(|(index, _)| index % self.per_tick == 0) {
            scene.dot(*end, 1.8, Mark::Disc, ink);
        }
        for &key in key_secs.iter().filter(|&&key| inside(key)) {
            let after = self
                .secs
                .partition_point(|&s| s < key - 1e-9)
                .min(self.placed.len().saturating_sub(1));
            if let Some(placed) = self.placed.get(after).and_then(|placed| placed.get(link)) {
                scene.dot(placed.end, 4.0, Mark::Diamond, ink);
            }
        }
    }

    /// Adds a stretch of the way of `link`'s end as one bold line, the same near and far.
    pub fn add_stretch(&self, scene: &mut Scene, link: usize, [from_secs, to_secs]: [f64; 2], ink: Ink) {
        let ways = self.secs.iter().zip(&self.placed);
        let inside = ways.filter(|(secs, _)| (from_secs..=to_secs).contains(*secs));
        let points: Vec<DVec3> = inside
            .filter_map(|(_, placed)| Some(placed.get(link)?.end))
            .collect();
        scene.polyline(&points, theme::WIDTH_STRETCH, ink.flat());
    }
}

/// The lowest point of some links.
pub fn lowest<'a>(links: impl Iterator<Item = &'a Placed>) -> Option<f64> {
    links
        .map(|link| link.start.y.min(link.end.y))
        .filter(|y| y.is_finite())
        .reduce(f64::min)
}
