//! The judge: goes through a motion from key time to key time, as far as there is time for it.

use std::sync::Arc;

use super::cuts::{Cut, cuts};
use super::limits::JointLimits;
use super::polynomial::Polynomial;
use super::torque::Loads;
use super::{Kind, Stretch};
use crate::joint_track::JointTrack;

/// Ends of a stretch are found to this, seconds: a tenth of the fastest control cycle.
const GRAIN_SECS: f64 = 1e-4;
/// A corner that asks for less than this of a joint's acceleration is rounding or none (our choice).
const CORNER_SHARE_MIN: f64 = 1e-9;

/// A judgement under way.
#[derive(Clone, Debug)]
pub struct Judge {
    limits: Arc<[JointLimits]>,
    loads: Option<Arc<Loads>>,
    span: usize,
    /// The speeds with which the last cut ended.
    speeds: Vec<f64>,
    found: Vec<Stretch>,
}

impl Judge {
    /// Of a track whose joints have these limits, one for each; with `loads`, of torque as well.
    pub fn new(limits: Arc<[JointLimits]>, loads: Option<Arc<Loads>>) -> Self {
        Self {
            speeds: vec![0.0; limits.len()],
            limits,
            loads,
            span: 0,
            found: Vec::new(),
        }
    }

    /// How much is done, 0 to 1.
    pub fn progress(&self, track: &JointTrack) -> f64 {
        self.span as f64 / track.kinetics.last_key().max(1) as f64
    }

    /// Goes on until about `work` microseconds were spent. All stretches in order of time, once all are known.
    pub fn advance(&mut self, track: &JointTrack, work: usize) -> Option<Vec<Stretch>> {
        let mut spent = 0;
        loop {
            if self.span >= track.kinetics.last_key() {
                self.end(track);
                return Some(joined(std::mem::take(&mut self.found)));
            }
            if spent >= work {
                return None;
            }
            let mut here = cuts(track, self.span);
            for cut in &here {
                self.judge_cut(track, cut);
            }
            spent += here.len() * self.limits.len() * if self.loads.is_some() { 4 } else { 1 };
            self.judge_strains(track, &mut here);
            self.span += 1;
        }
    }

    /// All at once.
    pub fn whole(track: &JointTrack, limits: Arc<[JointLimits]>, loads: Option<Arc<Loads>>) -> Vec<Stretch> {
        Self::new(limits, loads)
            .advance(track, usize::MAX)
            .unwrap_or_default()
    }

    fn judge_cut(&mut self, track: &JointTrack, cut: &Cut) {
        let span_secs = cut.to_secs - cut.from_secs;
        let grain = (GRAIN_SECS / span_secs).min(0.25);
        let limits = Arc::clone(&self.limits);
        let cubics = cut.row.map(|row| track.path.row(row)).unwrap_or_default();
        let mut motions = Vec::with_capacity(if self.loads.is_some() { limits.len() } else { 0 });
        for (joint, limits) in limits.iter().enumerate() {
            let Some(cubic) = cubics.get(joint) else {
                self.corner(joint, cut.from_secs, 0.0, limits);
                continue;
            };
            let angle = Polynomial::composed(cubic, &cut.x);
            let speed = angle.rate(span_secs);
            let accel = speed.rate(span_secs);
            self.corner(joint, cut.from_secs, speed.at(0.0), limits);
            self.speeds[joint] = speed.at(1.0);
            let half = limits.range_rad.length() / 2.0;
            let middle = limits.range_rad.start + half;
            // Half a thousandth of a degree beyond the end is a key at the end.
            let reach = (angle.less(middle), half + 1e-5, Kind::Reach);
            let fast = (speed, limits.speed_max_rad_per_s, Kind::Speed);
            let hard = (accel, limits.accel_max_rad_per_s2, Kind::Acceleration);
            for (polynomial, limit, kind) in [reach, fast, hard] {
                for beyond in polynomial.beyond(limit, grain) {
                    let at = |s: f64| cut.from_secs + s * span_secs;
                    let factor = beyond.most / limit;
                    self.add(joint, kind, [at(beyond.from), at(beyond.to)], factor);
                }
            }
            if self.loads.is_some() {
                motions.push([angle, speed, accel]);
            }
        }
        if let Some(loads) = self.loads.clone().filter(|_| motions.len() == limits.len()) {
            loads.judge(&motions, &limits, cut.from_secs, span_secs, &mut self.found);
        }
    }

    /// A change of speed all at once, at the beginning of a cut.
    fn corner(&mut self, joint: usize, secs: f64, speed: f64, limits: &JointLimits) {
        let change = (speed - std::mem::replace(&mut self.speeds[joint], speed)).abs();
        let factor = JointLimits::corner_accel(change) / limits.accel_max_rad_per_s2;
        if factor > 1.0 + CORNER_SHARE_MIN {
            let half_secs = change / limits.accel_max_rad_per_s2 / 2.0;
            self.add(
                joint,
                Kind::Acceleration,
                [secs - half_secs, secs + half_secs],
                factor,
            );
        }
    }

    fn add(&mut self, joint: usize, kind: Kind, [from_secs, to_secs]: [f64; 2], factor: f64) {
        let slow_down = match kind {
            Kind::Reach | Kind::Torque => None,
            Kind::Speed => Some(factor),
            Kind::Acceleration => Some(factor.sqrt()),
        };
        self.found.push(Stretch {
            from_secs,
            to_secs,
            joint,
            kind,
            factor,
            slow_down,
        });
    }

    /// Where the survey of a followed figure found poses out of reach.
    fn judge_strains(&mut self, track: &JointTrack, cuts: &mut Vec<Cut>) {
        let knots = track.path.knots();
        for cut in cuts.drain(..) {
            let Some(over) = cut.row.and_then(|row| knots.get(row..row + 2)) else {
                continue;
            };
            for strain in track.path.strains() {
                if strain.over.start < over[1] && strain.over.end > over[0] {
                    self.add(
                        strain.joint,
                        Kind::Reach,
                        [cut.from_secs, cut.to_secs],
                        strain.factor,
                    );
                }
            }
        }
    }

    /// The stop at the end; for a single pose, whether it can be taken.
    fn end(&mut self, track: &JointTrack) {
        let domain = track.kinetics.domain();
        for (joint, limits) in Arc::clone(&self.limits).iter().enumerate() {
            self.corner(joint, domain.end, 0.0, limits);
        }
        if track.kinetics.last_key() > 0 {
            return;
        }
        let mut angles_rad = vec![0.0; self.limits.len()];
        track.path.angles(0.0, &mut angles_rad);
        for (joint, limits) in Arc::clone(&self.limits).iter().enumerate() {
            let half = limits.range_rad.length() / 2.0;
            let off = (angles_rad[joint] - limits.range_rad.start - half).abs() / (half + 1e-5);
            if off > 1.0 {
                self.add(joint, Kind::Reach, [domain.start, domain.end], off);
            }
        }
        for strain in track.path.strains() {
            self.add(
                strain.joint,
                Kind::Reach,
                [domain.start, domain.end],
                strain.factor,
            );
        }
    }
}

/// Stretches of one joint and kind that touch become one; in order of time, then joint.
pub fn joined(mut found: Vec<Stretch>) -> Vec<Stretch> {
    let key = |s: &Stretch| (s.joint, s.kind);
    found.sort_by(|a, b| key(a).cmp(&key(b)).then(a.from_secs.total_cmp(&b.from_secs)));
    let mut joined: Vec<Stretch> = Vec::new();
    for stretch in found {
        match joined.last_mut() {
            Some(open) if key(open) == key(&stretch) && stretch.from_secs <= open.to_secs + GRAIN_SECS => {
                open.to_secs = open.to_secs.max(stretch.to_secs);
                open.factor = open.factor.max(stretch.factor);
                // One that slowing cannot help spoils what it touches.
                open.slow_down = open.slow_down.zip(stretch.slow_down).map(|(a, b)| a.max(b));
            }
            _ => joined.push(stretch),
        }
    }
    joined.sort_by(|a, b| a.from_secs.total_cmp(&b.from_secs).then(a.joint.cmp(&b.joint)));
    joined
}

#[cfg(test)]
mod tests;
