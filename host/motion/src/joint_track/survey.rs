//! Finding out the joint path of a followed figure: poses are tried until cubics between them say the rest.
//!
//! Following has no closed form, so the path is sampled, every half of a cell that the cubics around it did not
//! foretell again. Done piece by piece, so that whoever has other things to do can do them in between; what is
//! found does not depend on the pieces. Paths of figures have a kink at every key, and one wherever a joint comes
//! to a limit: cubics never reach across either.
//! Source: the choice among cubics that look to either side is that of A. Harten and others, Uniformly High Order
//! Accurate Essentially Non-oscillatory Schemes III, 1987.

use super::{JointPath, Strain};
use crate::curve::Interval;

/// Cubics foretell a pose when no joint is further off than this, radians (our choice: a tenth of what a servo of
/// 4096 counts resolves, so that second derivatives are good to a few per cent).
const FORETOLD_RAD: f64 = 2e-4;
/// A change of slope of eight times this much is a corner, radians a key interval: the middle of a cell of width w
/// with a corner in it is off by up to an eighth of the change times w (our choice).
const CORNER_SLOPE: f64 = 4e-3;
/// Cells of a key interval to begin with, at least; and one for each so many radians of the figure's own turning.
const CELLS_MIN: usize = 4;
/// Most of them.
const CELLS_MAX: usize = 48;
/// Turning of a link that asks for one more cell, radians (our choice).
const CELL_RAD: f64 = 0.2;
/// Cells as narrow as this share of a key interval are not halved: what changes within is a corner (our choice).
const CELL_WIDTH_MIN: f64 = 1.0 / 1024.0;
/// So many narrowest cells in a row may share one corner.
const GAP_CELLS_MAX: usize = 2;
/// A joint that moves so far within the narrowest cell jumps, radians (our choice: fifty radians a key interval).
const JUMP_RAD: f64 = 0.05;

/// Whoever knows the joint angles that a pose of the figure asks for.
pub trait Leader {
    /// Turns `angles` into those at key coordinate `u`, looking for the best branch of all.
    fn begin(&mut self, u: f64, angles: &mut [f64], strained: &mut Vec<(usize, f64)>) -> usize;

    /// Turns `angles`, which are those at a coordinate nearby, into those at `u`. Adds the joints that cannot be
    /// where they were wanted to `strained`, with how far off that leaves their link, 1 being what is tolerated.
    /// Returns what it cost, in about microseconds.
    fn follow(&mut self, u: f64, angles: &mut [f64], strained: &mut Vec<(usize, f64)>) -> usize;

    /// The largest angle that any link of the figure turns from key `key` to the next, radians.
    fn turning_rad(&self, key: usize) -> f64;
}

/// One pose tried.
#[derive(Clone, Debug)]
struct Node {
    u: f64,
    angles_rad: Vec<f64>,
    strained: Vec<(usize, f64)>,
    /// Whether the cell that begins here has a corner or a jump in it that no cubic says.
    gap: bool,
}

/// Where the survey of a key interval is.
#[derive(Clone, Copy, Debug)]
enum Stage {
    /// So many of the first nodes are there.
    Laying(usize),
    /// The cell that begins at this node is looked at next, until that coordinate.
    Halving(usize, f64),
}

/// A survey that is under way.
#[derive(Clone, Debug)]
pub struct Survey {
    joints: Vec<String>,
    last_key: usize,
    key: usize,
    stage: Stage,
    /// Of the key interval at hand.
    nodes: Vec<Node>,
    path: JointPath,
}

impl Survey {
    /// Of a figure with keys 0 to `last_key`, followed by these joints from `rest_rad`.
    pub fn new(joints: Vec<String>, rest_rad: &[f64], last_key: usize) -> Self {
        let mut last_rad = rest_rad.to_vec();
        last_rad.resize(joints.len(), 0.0);
        Self {
            path: JointPath {
                joints: joints.clone(),
                knots: Vec::new(),
                cubics: Vec::new(),
                last_rad,
                strains: Vec::new(),
            },
            joints,
            last_key,
            key: 0,
            stage: Stage::Laying(0),
            nodes: Vec::new(),
        }
    }

    /// How much is done, 0 to 1.
    pub fn progress(&self) -> f64 {
        self.key as f64 / self.last_key.max(1) as f64
    }

    /// Goes on until about `work` microseconds were spent. The path, once it is known.
    pub fn advance(&mut self, leader: &mut dyn Leader, work: usize) -> Option<JointPath> {
        let mut spent = 0;
        while spent < work {
            if self.last_key == 0 {
                return Some(self.standing(leader));
            }
            if self.key == self.last_key {
                return Some(self.path.clone());
            }
            spent += match self.stage {
                Stage::Laying(laid) => self.lay(laid, leader),
                Stage::Halving(at, until) => self.halve(at, until, leader),
            };
        }
        None
    }

    /// A single pose.
    fn standing(&mut self, leader: &mut dyn Leader) -> JointPath {
        let mut strained = Vec::new();
        let mut path = self.path.clone();
        leader.begin(0.0, &mut path.last_rad, &mut strained);
        path.knots.push(0.0);
        path.strains = strained
            .into_iter()
            .filter(|(_, factor)| *factor > 1.0)
            .map(|(joint, factor)| Strain {
                over: Interval::new(0.0, 0.0),
                joint,
                factor,
            })
            .collect();
        path
    }

    /// One more of the first nodes, from left to right.
    fn lay(&mut self, laid: usize, leader: &mut dyn Leader) -> usize {
        let turning = leader.turning_rad(self.key);
        let cells = ((turning / CELL_RAD) as usize).clamp(CELLS_MIN, CELLS_MAX);
        if laid > cells {
            self.stage = Stage::Halving(0, f64::INFINITY);
            return 0;
        }
        let u = self.key as f64 + laid as f64 / cells as f64;
        let mut angles_rad = self
            .nodes
            .last()
            .map_or_else(|| self.path.last_rad.clone(), |node| node.angles_rad.clone());
        let mut strained = Vec::new();
        let work = if self.key == 0 && laid == 0 {
            leader.begin(u, &mut angles_rad, &mut strained)
        } else {
            leader.follow(u, &mut angles_rad, &mut strained)
        };
        self.nodes.push(Node {
            u,
            angles_rad,
            strained,
            gap: false,
        });
        self.stage = Stage::Laying(laid + 1);
        work
    }

    /// Tries the middle of a cell: it is as foretold, or the halves are looked at, or the cell is a corner.
    fn halve(&mut self, at: usize, until: f64, leader: &mut dyn Leader) -> usize {
        let left = self.nodes.get(at).filter(|left| left.u < until);
        let (Some(left), Some(right)) = (left, self.nodes.get(at + 1)) else {
            match self.torn() {
                Some(cell) if self.width(cell) > CELL_WIDTH_MIN => {
                    self.stage = Stage::Halving(cell, self.nodes[cell + 1].u);
                }
                Some(cell) => self.nodes[cell].gap = true,
                None => self.settle(),
            }
            return self.joints.len();
        };
        let (u, width) = (f64::midpoint(left.u, right.u), right.u - left.u);
        let (mut angles_rad, mut strained) = (left.angles_rad.clone(), Vec::new());
        let work = leader.follow(u, &mut angles_rad, &mut strained);
        let tolerance = FORETOLD_RAD.min(CORNER_SLOPE * width);
        let stretch = self.stretch_of(at);
        // A corner next door spoils some of the cubics, never those that end at this cell's ends.
        let stencils =
            [at.saturating_sub(1), at.saturating_sub(2), at].map(|begin| Self::stencil(stretch, begin));
        let told = |joint: usize, angle: f64| {
            let off = |&(first, last): &(usize, usize)| (angle - self.fitted(first, last, joint, u)).abs();
            stencils.iter().any(|stencil| off(stencil) <= tolerance)
        };
        let foretold = angles_rad
            .iter()
            .enumerate()
            .all(|(joint, &angle)| told(joint, angle));
        if !foretold && width <= CELL_WIDTH_MIN {
            self.nodes[at].gap = true;
            self.stage = Stage::Halving(at + 1, until);
            return work;
        }
        self.nodes.insert(
            at + 1,
            Node {
                u,
                angles_rad,
                strained,
                gap: false,
            },
        );
        self.stage = Stage::Halving(if foretold { at + 2 } else { at }, until);
        work
    }

    /// The wider of two cells whose cubics do not meet smoothly, though both middles were foretold: a corner that
    /// happened to lie where it does not show.
    fn torn(&self) -> Option<usize> {
        let slope = |cell: usize, joint: usize, at: usize| {
            let (first, last) = Self::stencil(self.stretch_of(cell), cell.saturating_sub(1));
            self.cubic(first, last, joint, self.nodes[at].u)[1]
        };
        let smooth = |cell: usize| {
            let joins = |joint: usize| slope(cell, joint, cell + 1) - slope(cell + 1, joint, cell + 1);
            (0..self.joints.len()).all(|joint| joins(joint).abs() <= 8.0 * CORNER_SLOPE)
        };
        (0..self.nodes.len().saturating_sub(2))
            .find(|&cell| !self.nodes[cell].gap && !self.nodes[cell + 1].gap && !smooth(cell))
            .map(|cell| cell + usize::from(self.width(cell + 1) > self.width(cell)))
    }

    fn width(&self, cell: usize) -> f64 {
        self.nodes[cell + 1].u - self.nodes[cell].u
    }

    /// The nodes that a cell's cubic may know: those around it with no gap between.
    fn stretch_of(&self, cell: usize) -> (usize, usize) {
        let mut first = cell;
        while first > 0 && cell - first < 3 && !self.nodes[first - 1].gap {
            first -= 1;
        }
        let mut last = cell + 1;
        while last + 1 < self.nodes.len() && last - cell < 4 && !self.nodes[last].gap {
            last += 1;
        }
        (first, last)
    }

    /// Four nodes, or as many as there are, from `begin` if they can be.
    fn stencil((first, last): (usize, usize), begin: usize) -> (usize, usize) {
        let end = (begin.max(first) + 3).min(last);
        (end.saturating_sub(3).max(first), end)
    }

    fn fitted(&self, first: usize, last: usize, joint: usize, u: f64) -> f64 {
        self.cubic(first, last, joint, u)[0]
    }

    /// The polynomial through nodes `first` to `last`, at most four, in powers of the distance from `about`.
    /// Source: Newton's divided differences.
    fn cubic(&self, first: usize, last: usize, joint: usize, about: f64) -> [f64; 4] {
        let nodes = &self.nodes[first..=last];
        let at = |i: usize| nodes[i].u - about;
        let mut table: Vec<f64> = nodes.iter().map(|node| node.angles_rad[joint]).collect();
        for order in 1..nodes.len() {
            for i in (order..nodes.len()).rev() {
                table[i] = (table[i] - table[i - 1]) / (at(i) - at(i - order));
            }
        }
        let mut c = [0.0; 4];
        for i in (0..nodes.len()).rev() {
            // c = c * (x - at(i)) + table[i]
            for power in (1..4).rev() {
                c[power] = c[power - 1] - c[power] * at(i);
            }
            c[0] = table[i] - c[0] * at(i);
        }
        c
    }

    /// Writes the key interval at hand into the path and goes to the next.
    fn settle(&mut self) {
        for cell in 0..self.nodes.len() - 1 {
            self.path.knots.push(self.nodes[cell].u);
            for joint in 0..self.joints.len() {
                let cubic = self.cell_cubic(cell, joint);
                self.path.cubics.push(cubic);
            }
            self.note_strains(cell);
        }
        self.key += 1;
        if let Some(last) = self.nodes.pop() {
            if self.key == self.last_key {
                self.path.knots.push(last.u);
            }
            self.path.last_rad = last.angles_rad;
        }
        self.nodes.clear();
        self.stage = Stage::Laying(0);
    }

    /// In a gap the cubic before it goes on, so that all of the corner is at the gap's end.
    fn cell_cubic(&self, cell: usize, joint: usize) -> [f64; 4] {
        let about = self.nodes[cell].u;
        if !self.nodes[cell].gap {
            let (first, last) = Self::stencil(self.stretch_of(cell), cell.saturating_sub(1));
            return self.cubic(first, last, joint, about);
        }
        let near = cell.saturating_sub(GAP_CELLS_MAX)..cell;
        match near.rev().find(|&before| !self.nodes[before].gap) {
            Some(before) => {
                let (first, last) = Self::stencil(self.stretch_of(before), before.saturating_sub(1));
                self.cubic(first, last, joint, about)
            }
            None => self.cubic(cell, cell + 1, joint, about),
        }
    }

    fn note_strains(&mut self, cell: usize) {
        let (left, right) = (&self.nodes[cell], &self.nodes[cell + 1]);
        let mut found: Vec<(usize, f64)> = left.strained.iter().chain(&right.strained).copied().collect();
        if left.gap {
            let jump = |joint: usize| (right.angles_rad[joint] - left.angles_rad[joint]).abs() / JUMP_RAD;
            found.extend((0..self.joints.len()).map(|joint| (joint, jump(joint))));
        }
        let over = Interval::new(left.u, right.u);
        for (joint, factor) in found.into_iter().filter(|(_, factor)| *factor > 1.0) {
            let strains = &mut self.path.strains;
            match strains
                .iter_mut()
                .rev()
                .find(|open| open.joint == joint && open.over.end >= over.start)
            {
                Some(open) => {
                    open.over.end = over.end;
                    open.factor = open.factor.max(factor);
                }
                None => strains.push(Strain { over, joint, factor }),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A joint that goes as told, up to a stop.
    struct Stopped(fn(f64) -> f64, f64);

    impl Leader for Stopped {
        fn begin(&mut self, u: f64, angles: &mut [f64], strained: &mut Vec<(usize, f64)>) -> usize {
            self.follow(u, angles, strained)
        }

        fn follow(&mut self, u: f64, angles: &mut [f64], strained: &mut Vec<(usize, f64)>) -> usize {
            let wanted = (self.0)(u);
            angles[0] = wanted.min(self.1);
            strained.push((0, (wanted - angles[0]) / 0.1));
            1
        }

        fn turning_rad(&self, _key: usize) -> f64 {
            2.0
        }
    }

    fn path(of: fn(f64) -> f64, stop: f64, work: usize) -> JointPath {
        let mut survey = Survey::new(vec!["a".into()], &[0.0], 2);
        let mut leader = Stopped(of, stop);
        (0..100_000)
            .find_map(|_| survey.advance(&mut leader, work))
            .expect("it ends")
    }

    #[test]
    fn cubics_say_what_was_not_tried() {
        let wave: fn(f64) -> f64 = |u| (5.0 * u).sin() + 0.3 * (17.0 * u).cos();
        let found = path(wave, 9.0, 50);
        for i in 0..=2000 {
            let u = f64::from(i) / 1000.0;
            let mut angle = [0.0];
            found.angles(u, &mut angle);
            assert!((angle[0] - wave(u)).abs() < FORETOLD_RAD, "at {u}");
        }
        assert!(found.strains().is_empty());
        assert_eq!(found, path(wave, 9.0, 1), "however it is cut into pieces");
    }

    #[test]
    fn a_stop_is_a_corner_and_beyond_it_is_strain() {
        let found = path(|u| u, 1.35, 1000);
        let [strain] = found.strains() else {
            panic!("one stretch: {:?}", found.strains())
        };
        // 0.1 of tolerance past 1.35.
        assert!((strain.over.start - 1.45).abs() < 0.1 && strain.over.end == 2.0);
        assert!((strain.factor - 6.5).abs() < 1e-9);
        let mut angle = [0.0];
        for (u, want) in [(1.3, 1.3), (1.349, 1.349), (1.36, 1.35), (1.9, 1.35)] {
            found.angles(u, &mut angle);
            assert!((angle[0] - want).abs() < 2e-3, "at {u}: {}", angle[0]);
        }
        // The slopes beside the corner are those of both sides, not of some average.
        let rows = found.knots().len() - 1;
        let slopes: Vec<f64> = (0..rows).map(|row| found.row(row)[0][1]).collect();
        assert!(
            slopes.iter().all(|s| s.abs() < 1e-6 || (s - 1.0).abs() < 1e-6),
            "{slopes:?}"
        );
    }

    #[test]
    fn a_jump_is_strain_and_no_speed() {
        let found = path(|u| if u < 0.6 { 0.0 } else { 1.0 }, 9.0, 1000);
        assert_eq!(found.strains().len(), 1);
        assert!((found.strains()[0].over.start - 0.6).abs() < 2e-3);
        assert!((0..found.knots().len() - 1).all(|row| found.row(row)[0][1].abs() < 1e-9));
    }
}
