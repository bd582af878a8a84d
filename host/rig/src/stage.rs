//! The figure on stage: the pose on screen and the hands' way of changing it, link by link.
//!
//! The cursor is a line along the view direction; the selected link's end goes to the point of its sphere
//! nearest to that line (`motion::figure::posing`). Inside the circle there are two such points.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use motion::clip::Clip;
use motion::figure::posing::{self, Answer, Sight, View};
use motion::figure::{Figure, FigurePose, LinkIndex, Placed};
use ps300::display::Stroke;

use crate::command::{PoseCommand, Side};
use crate::snapshot::FigureView;
use crate::take::StageStart;

/// The posed figure and the state of the hands on it.
#[derive(Debug)]
pub(crate) struct Stage {
    figure: Arc<Figure>,
    shapes: Arc<Vec<Vec<Stroke>>>,
    pose: FigurePose,
    placed: Vec<Placed>,
    selected: u16,
    side: Side,
    cursor: Option<DVec2>,
    candidates: Vec<DVec3>,
    posing: bool,
}

impl Stage {
    pub(crate) fn new(figure: Arc<Figure>, shapes: Arc<Vec<Vec<Stroke>>>) -> Self {
        let pose = figure.rest_pose();
        let mut stage = Self {
            figure,
            shapes,
            pose,
            placed: Vec::new(),
            selected: 0,
            side: Side::Near,
            cursor: None,
            candidates: Vec::new(),
            posing: false,
        };
        stage.place();
        stage
    }

    fn place(&mut self) {
        self.figure.place(&self.pose, &mut self.placed);
    }

    /// Shows the clip's pose; what was posed by hand and not stored is gone.
    pub(crate) fn show_clip(&mut self, clip: &Clip, secs: f64) {
        clip.sample(secs, &mut self.pose);
        self.place();
        self.posing = false;
        self.candidates.clear();
    }

    /// Takes over a pose that comes from elsewhere, such as a puppet's own.
    pub(crate) fn take_over(&mut self, take: impl FnOnce(&Figure, &mut FigurePose)) {
        take(&self.figure, &mut self.pose);
        self.changed();
    }

    /// Does what the hand asks; says what was wrong with it otherwise and leaves the pose alone.
    pub(crate) fn apply(&mut self, command: &PoseCommand, view: &View) -> Result<(), String> {
        match *command {
            PoseCommand::Cursor(at) => self.point(DVec2::from_array(at), view),
            PoseCommand::Side(side) => {
                self.side = side;
                self.cursor.map_or(Ok(()), |cursor| self.point(cursor, view))
            }
            PoseCommand::Place => {
                self.step(1);
                Ok(())
            }
            PoseCommand::Select(link) => {
                self.link(link)?;
                self.select(link);
                Ok(())
            }
            PoseCommand::Step(by) => {
                self.step(by);
                Ok(())
            }
            PoseCommand::Twist { by_rad } => {
                let now_rad = self
                    .pose
                    .links
                    .get(usize::from(self.selected))
                    .map_or(0.0, |l| l.twist_rad);
                self.twist(self.selected, now_rad + by_rad)
            }
            PoseCommand::Direction(direction) => self.direct(self.selected, DVec3::from_array(direction)),
            PoseCommand::LinkDirection { link, direction } => self.direct(link, DVec3::from_array(direction)),
            PoseCommand::LinkTwist { link, twist_rad } => self.twist(link, twist_rad),
            PoseCommand::Root(at) => self.move_root(DVec3::from_array(at)),
            PoseCommand::RootBy(by) => self.move_root(self.pose.root + DVec3::from_array(by)),
            // The rig shows the clip itself: it knows the time.
            PoseCommand::FromClip => Ok(()),
        }
    }

    fn point(&mut self, cursor: DVec2, view: &View) -> Result<(), String> {
        let (start, length) = match (
            self.placed.get(usize::from(self.selected)),
            self.pose.links.get(usize::from(self.selected)),
        ) {
            (Some(placed), Some(link)) => (placed.start, link.length),
            _ => return Err("no link is selected".into()),
        };
        let answer = posing::aim(view, start, length, cursor).map_err(|error| error.to_string())?;
        self.cursor = Some(cursor);
        self.candidates.clear();
        self.candidates.extend(ends(&answer, start, length));
        let side = match self.side {
            Side::Near => posing::Side::Near,
            Side::Far => posing::Side::Far,
        };
        self.direct(self.selected, answer.direction(side))
    }

    fn direct(&mut self, link: u16, direction: DVec3) -> Result<(), String> {
        let name = self.link(link)?;
        let Some(unit) = direction.try_normalize() else {
            return Err(format!(
                "link {name}: a direction needs a length, found {direction}"
            ));
        };
        self.pose.links[usize::from(link)].direction = unit;
        self.changed();
        Ok(())
    }

    fn twist(&mut self, link: u16, twist_rad: f64) -> Result<(), String> {
        let name = self.link(link)?;
        if !twist_rad.is_finite() {
            return Err(format!("link {name}: a twist must be a number"));
        }
        self.pose.links[usize::from(link)].twist_rad = twist_rad;
        self.changed();
        Ok(())
    }

    fn move_root(&mut self, at: DVec3) -> Result<(), String> {
        if !at.is_finite() {
            return Err("the root's position must be three numbers".into());
        }
        self.pose.root = at;
        self.changed();
        Ok(())
    }

    fn changed(&mut self) {
        self.posing = true;
        self.place();
    }

    /// The link's name, if there is such a link.
    fn link(&self, link: u16) -> Result<&str, String> {
        self.figure
            .link(LinkIndex(link))
            .map(|l| l.name.as_str())
            .ok_or_else(|| format!("there is no link {link}; the figure has {}", self.figure.len()))
    }

    fn select(&mut self, link: u16) {
        self.selected = link;
        self.side = Side::Near;
        self.candidates.clear();
        self.cursor = None;
    }

    fn step(&mut self, by: i32) {
        let last = self.figure.len().saturating_sub(1) as i32;
        self.select((i32::from(self.selected).saturating_add(by)).clamp(0, last) as u16);
    }

    /// The pose, shared as long as it stays the same.
    pub(crate) fn shared_pose(&self) -> Arc<FigurePose> {
        Arc::new(self.pose.clone())
    }

    /// How the figure stands and the hands on it.
    pub(crate) fn standing(&self) -> StageStart {
        StageStart {
            pose: self.pose.clone(),
            selected: self.selected,
            side: self.side,
            cursor: self.cursor.map(|at| at.to_array()),
            posing: self.posing,
        }
    }

    /// Goes on from there; a pose of another figure is left alone.
    pub(crate) fn resume(&mut self, start: &StageStart) {
        if start.pose.links.len() != self.figure.len() {
            return;
        }
        self.pose.clone_from(&start.pose);
        self.selected = start.selected;
        self.side = start.side;
        self.cursor = start.cursor.map(DVec2::from_array);
        self.posing = start.posing;
        self.candidates.clear();
        self.place();
    }

    pub(crate) fn pose(&self) -> &FigurePose {
        &self.pose
    }

    /// The link the hands are on, by its place in the figure's order.
    pub(crate) fn selected(&self) -> u16 {
        self.selected
    }

    /// The figure's links, in its order.
    pub(crate) fn figure(&self) -> &Figure {
        &self.figure
    }

    /// A link's twist about its own axis.
    pub(crate) fn twist_rad(&self, link: u16) -> Option<f64> {
        self.pose.links.get(usize::from(link)).map(|it| it.twist_rad)
    }

    pub(crate) fn posing(&self) -> bool {
        self.posing
    }

    /// The pose is now one of the clip's.
    pub(crate) fn stored(&mut self) {
        self.posing = false;
    }

    pub(crate) fn placed(&self) -> &[Placed] {
        &self.placed
    }

    pub(crate) fn view(&self) -> FigureView {
        FigureView {
            figure: Arc::clone(&self.figure),
            shapes: Arc::clone(&self.shapes),
            pose: self.pose.clone(),
            placed: self.placed.clone(),
            selected: Some(self.selected),
            cursor: self.cursor,
            candidates: self.candidates.clone(),
            posing: self.posing,
        }
    }
}

/// Where the link's end could go: near first; one place on or outside the circle.
fn ends(answer: &Answer, start: DVec3, length: f64) -> impl Iterator<Item = DVec3> {
    let far = (answer.sight == Sight::Inside).then_some(answer.far);
    let directions = std::iter::once(answer.near).chain(far);
    directions.map(move |direction| start + length * direction)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DMat3;
    use motion::figure::LinkSpec;

    const FRONT: View = View {
        view_from_world: DMat3::IDENTITY,
        centre: DVec3::ZERO,
        scale: 1.0,
    };

    fn stage() -> Stage {
        let one = LinkSpec {
            number: 0,
            name: "one".into(),
            dof: 2,
            length: 1.0,
            children: vec![(1, DVec3::Z)],
        };
        let two = LinkSpec {
            number: 1,
            name: "two".into(),
            children: vec![],
            ..one.clone()
        };
        let (figure, _) = Figure::new(&[one, two]).expect("a chain of two");
        Stage::new(Arc::new(figure), Arc::new(vec![vec![], vec![]]))
    }

    fn end(stage: &Stage, link: usize) -> DVec3 {
        stage.placed()[link].end
    }

    #[test]
    fn the_cursor_poses_the_selected_link_and_place_goes_on() {
        let mut s = stage();
        s.apply(&PoseCommand::Cursor([0.6, 0.0]), &FRONT).expect("poses");
        assert!((end(&s, 0) - DVec3::new(0.6, 0.0, 0.8)).length() < 1e-12);
        s.apply(&PoseCommand::Side(Side::Far), &FRONT).expect("turns");
        assert!((end(&s, 0) - DVec3::new(0.6, 0.0, -0.8)).length() < 1e-12);
        s.apply(&PoseCommand::Place, &FRONT).expect("places");
        s.apply(&PoseCommand::Cursor([9.6, 0.0]), &FRONT).expect("poses");
        assert!(
            (end(&s, 1) - DVec3::new(1.6, 0.0, -0.8)).length() < 1e-12,
            "{}",
            end(&s, 1)
        );
        assert_eq!(s.view().candidates.len(), 1);
    }

    #[test]
    fn refusals_change_nothing() {
        let mut s = stage();
        let before = s.pose().clone();
        for bad in [
            PoseCommand::Direction([0.0; 3]),
            PoseCommand::Direction([f64::NAN, 0.0, 1.0]),
            PoseCommand::LinkDirection {
                link: 7,
                direction: [1.0, 0.0, 0.0],
            },
            PoseCommand::LinkTwist {
                link: 0,
                twist_rad: f64::INFINITY,
            },
            PoseCommand::Cursor([f64::NAN, 0.0]),
            PoseCommand::Root([0.0, f64::NAN, 0.0]),
            PoseCommand::Select(2),
        ] {
            assert!(s.apply(&bad, &FRONT).is_err(), "{bad:?}");
        }
        assert_eq!(*s.pose(), before);
    }

    #[test]
    fn steps_stay_inside_the_figure() {
        let mut s = stage();
        for (by, want) in [(-5, 0), (1, 1), (i32::MAX, 1), (i32::MIN, 0)] {
            s.apply(&PoseCommand::Step(by), &FRONT).expect("steps");
            assert_eq!(s.view().selected, Some(want), "after {by}");
        }
    }
}
