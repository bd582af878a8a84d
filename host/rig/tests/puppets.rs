//! Puppets without servos in sight: posed joint by joint and by their ends, kept in shows, judged, slowed to fit.

use std::sync::Arc;
use std::time::Duration;

use device::transport::{Transport, TransportError};
use device::{Clock, VirtualClock};
use rig::controls_calibration::Store;
use rig::document::{self, Show};
use rig::{
    Command, EditCommand, Found, Ports, Profiles, PuppetPose, PuppetPoseView, Rig, RigOptions, Snapshot,
    StretchKind, TransportCommand,
};

struct NoPorts;

impl Ports for NoPorts {
    fn list(&mut self) -> Vec<Found> {
        Vec::new()
    }

    fn open(&mut self, address: &str, _baud: u32) -> Result<Box<dyn Transport>, TransportError> {
        Err(TransportError::NotFound {
            address: address.to_owned(),
        })
    }
}

struct Desk {
    rig: Rig,
    clock: VirtualClock,
    seen: Arc<Snapshot>,
}

impl Desk {
    fn of(show: Show) -> Self {
        let clock = VirtualClock::new();
        let options = RigOptions {
            show,
            folder: None,
            profiles: Arc::new(Profiles::builtin()),
            inputs: Vec::new(),
            calibrations: Store::in_memory(),
            puppet: None,
            recorder: None,
        };
        let rig = Rig::new(Arc::new(clock.clone()), Box::new(NoPorts), options).expect("a rig");
        Self {
            rig,
            clock,
            seen: Arc::default(),
        }
    }

    fn arm() -> Self {
        Self::of(document::from_texts(&rig::shipped::arm()).expect("the shipped arm"))
    }

    fn human() -> Self {
        Self::of(document::from_texts(&rig::shipped::salute()).expect("the shipped human"))
    }

    fn step(&mut self, command: Option<Command>) -> &Snapshot {
        let next = self.clock.now().after(Duration::from_millis(10));
        self.clock.sleep_until(next);
        self.seen = self.rig.step(&mut command.into_iter());
        &self.seen
    }

    fn pose(&mut self, pose: PuppetPose) -> PuppetPoseView {
        self.step(Some(Command::PuppetPose(pose)));
        self.seen.puppet_pose.clone().expect("a puppet")
    }

    fn edit(&mut self, edit: EditCommand) {
        self.step(Some(Command::Edit(edit)));
    }

    /// Steps until the clip is judged and nobody looks for key times any more; how many steps that took.
    fn judged(&mut self) -> usize {
        for steps in 0..5000 {
            let feasibility = self.step(None).feasibility.clone().expect("a puppet");
            if feasibility.progress >= 1.0 && !feasibility.slowing {
                return steps;
            }
        }
        panic!("still not judged: {:?}", self.seen.feasibility)
    }

    fn last_note(&self) -> &str {
        self.seen.notes.last().map_or("", |note| note.text.as_str())
    }

    fn times(&self) -> Vec<f64> {
        self.seen.keys.iter().map(|key| key.secs).collect()
    }
}

fn angle(pose: &PuppetPoseView, joint: &str) -> f64 {
    let place = pose.names.iter().position(|name| name == joint).expect("a joint");
    pose.angles_rad[place]
}

fn joint(name: &str, angle_rad: f64) -> PuppetPose {
    PuppetPose::Joint {
        joint: name.into(),
        angle_rad,
    }
}

#[test]
fn joints_are_posed_one_by_one_and_stop_at_their_range() {
    let mut desk = Desk::arm();
    let posed = desk.pose(joint("elbow_flex", 0.5));
    assert!((angle(&posed, "elbow_flex") - 0.5).abs() < 1e-12 && posed.by_hand);
    let by = PuppetPose::JointBy {
        joint: "elbow_flex".into(),
        by_rad: 9.0,
    };
    let posed = desk.pose(by);
    assert!((angle(&posed, "elbow_flex") - 1.69).abs() < 1e-12);
    let before = desk.pose(PuppetPose::Rest);
    for wrong in [joint("knee", 0.1), joint("elbow_flex", f64::NAN)] {
        let after = desk.pose(wrong);
        assert_eq!(after.angles_rad, before.angles_rad);
    }
    assert!(
        desk.last_note().contains("must be a number"),
        "{}",
        desk.last_note()
    );
}

#[test]
fn an_end_is_dragged_and_the_joints_come_along() {
    let mut desk = Desk::arm();
    let before = desk.pose(PuppetPose::Rest);
    let hand = before
        .ends
        .iter()
        .find(|end| end.link == "gripper")
        .expect("an end")
        .at;
    let mut to = hand;
    for step in 1..=20 {
        to = hand + glam::DVec3::new(0.002, -0.004, -0.001) * f64::from(step);
        let posed = desk.pose(PuppetPose::Drag {
            link: "gripper".into(),
            to: to.to_array(),
        });
        assert!(posed.drag_error_m < 1e-3, "{step}: {}", posed.drag_error_m);
        let ranges = posed.ranges_rad.iter().zip(&posed.angles_rad);
        assert!(
            ranges
                .clone()
                .all(|([min, max], angle)| min <= angle && angle <= max)
        );
        let moved = posed
            .ends
            .iter()
            .find(|end| end.link == "gripper")
            .expect("an end")
            .at;
        assert!((moved.distance(to) - posed.drag_error_m).abs() < 1e-9);
    }
    assert!(hand.distance(to) > 0.05);
    desk.pose(PuppetPose::Drag {
        link: "tail".into(),
        to: [0.0; 3],
    });
    assert!(desk.last_note().contains("no link tail"), "{}", desk.last_note());
}

#[test]
fn poses_become_keys_of_a_clip_that_is_kept() {
    let show = Show {
        name: "bare".into(),
        puppet: Some("so-101".into()),
        ..Show::default()
    };
    let mut desk = Desk::of(show);
    for (secs, pan) in [(0.0, 0.0), (1.0, 0.4), (2.5, -0.3)] {
        desk.pose(joint("shoulder_pan", pan));
        desk.edit(EditCommand::StoreKey { secs });
    }
    assert_eq!(
        (desk.times(), desk.seen.undo.as_deref()),
        (vec![0.0, 1.0, 2.5], Some("Store key at 2.50 s"))
    );
    let kept = document::texts(desk.rig.show()).expect("texts");
    let again = document::from_texts(&kept).expect("a show");
    let keys = |show: &Show| show.current_joint_clip().expect("a clip").keys.clone();
    for (again, kept) in keys(&again).iter().zip(keys(desk.rig.show())) {
        assert!(again.secs == kept.secs && again.angles_rad.keys().eq(kept.angles_rad.keys()));
        // Degrees in the file.
        let off = again
            .angles_rad
            .values()
            .zip(kept.angles_rad.values())
            .map(|(a, b)| (a - b).abs());
        assert!(off.fold(0.0, f64::max) < 1e-12);
    }
    assert_eq!(keys(&again).len(), 3);
    // The clip is shown where time stands, and what it shows passes its keys.
    desk.step(Some(Command::PuppetPose(PuppetPose::FromClip)));
    desk.step(Some(Command::Transport(TransportCommand::Seek { secs: 1.0 })));
    let pose = desk.seen.puppet_pose.clone().expect("a puppet");
    assert!((angle(&pose, "shoulder_pan") - 0.4).abs() < 1e-9 && !pose.by_hand);
    desk.edit(EditCommand::MoveKey { key: 1, secs: 1.2 });
    desk.edit(EditCommand::DeleteKey { key: 2 });
    assert_eq!(desk.times(), [0.0, 1.2]);
    desk.step(Some(Command::Undo));
    desk.step(Some(Command::Undo));
    assert_eq!(desk.times(), [0.0, 1.0, 2.5]);
}

#[test]
fn a_clip_that_is_too_fast_is_slowed_by_one_step_of_undo() {
    let mut desk = Desk::arm();
    desk.judged();
    assert!(
        desk.seen
            .feasibility
            .as_ref()
            .is_some_and(|f| f.stretches.is_empty())
    );
    let show = Arc::clone(desk.rig.show());
    let times = desk.times();
    let fast: Vec<f64> = times.iter().map(|secs| secs / 4.0).collect();
    desk.edit(EditCommand::Retime {
        times_secs: fast.clone(),
    });
    desk.judged();
    let feasibility = desk.seen.feasibility.clone().expect("a puppet");
    let kinds = |kind| feasibility.stretches.iter().filter(|s| s.kind == kind).count();
    assert!(kinds(StretchKind::Acceleration) > 0 && kinds(StretchKind::Speed) > 0);
    assert!(
        feasibility
            .stretches
            .iter()
            .all(|s| s.factor > 1.0 && s.from_secs <= s.to_secs && s.link.is_none())
    );
    desk.step(Some(Command::SlowToFit));
    desk.judged();
    desk.judged();
    let slow = desk.times();
    assert_eq!(desk.seen.undo.as_deref(), Some("Slow to fit"));
    assert!(
        slow.last() > fast.last() && slow.last() <= times.last(),
        "{slow:?}"
    );
    let left = &desk.seen.feasibility.as_ref().expect("a puppet").stretches;
    assert!(left.is_empty(), "{left:?}");
    // The path is the same: every key says what it said.
    let angles = |show: &Show| -> Vec<_> {
        let clip = show.current_joint_clip().expect("a clip");
        clip.keys.iter().map(|key| key.angles_rad.clone()).collect()
    };
    assert_eq!(angles(desk.rig.show()), angles(&show));
    desk.step(Some(Command::Undo));
    assert_eq!(desk.times(), fast);
    desk.step(Some(Command::SlowToFit));
    desk.step(Some(Command::Undo));
    desk.judged();
    assert_eq!(desk.times(), times, "an edit ends the search for key times");
}

#[test]
fn a_figure_s_clip_is_judged_by_the_puppet_that_follows_it() {
    let mut desk = Desk::human();
    let steps = desk.judged();
    assert!(steps > 3, "it is done in pieces");
    let times = desk.times();
    let fast: Vec<f64> = times.iter().map(|secs| secs / 3.0).collect();
    desk.edit(EditCommand::Retime { times_secs: fast });
    let again = desk.judged();
    assert!(again < steps, "the path is known: {again} of {steps}");
    let feasibility = desk.seen.feasibility.clone().expect("a puppet");
    let fastest = feasibility
        .stretches
        .iter()
        .filter(|s| s.kind == StretchKind::Speed);
    let figure = desk.seen.figure.clone().expect("a figure");
    for stretch in fastest {
        let link = stretch.link.expect("a link that leads the joint");
        assert!(usize::from(link) < figure.figure.len());
    }
    assert!(feasibility.slow_down > 1.5 && feasibility.error_rad < 0.175);
    desk.step(Some(Command::SlowToFit));
    desk.judged();
    desk.judged();
    let left = &desk.seen.feasibility.as_ref().expect("a puppet").stretches;
    assert!(!left.iter().any(|stretch| stretch.slowable), "{left:?}");
    assert!(
        desk.last_note().starts_with("slowed to fit"),
        "{}",
        desk.last_note()
    );
}

#[test]
fn a_pose_the_puppet_cannot_take_is_out_of_reach_however_slow() {
    let mut desk = Desk::human();
    // The right forearm bent the wrong way: the elbow has its stop at the straight arm.
    let forearm = desk
        .step(None)
        .figure
        .as_ref()
        .and_then(|f| f.figure.by_name("rfa"))
        .expect("a forearm");
    for (secs, direction) in [(20.0, [0.0, -1.0, 0.0]), (30.0, [0.3, 0.9, -0.9])] {
        let pose = rig::PoseCommand::LinkDirection {
            link: forearm.0,
            direction,
        };
        desk.step(Some(Command::Transport(TransportCommand::Seek { secs })));
        desk.step(Some(Command::Pose(pose)));
        desk.edit(EditCommand::StoreKey { secs });
    }
    // So that time does not run back through it.
    desk.edit(EditCommand::KineticsMode(rig::KineticsMode::Monotone));
    desk.judged();
    let feasibility = desk.seen.feasibility.clone().expect("a puppet");
    let reach: Vec<_> = feasibility
        .stretches
        .iter()
        .filter(|s| s.kind == StretchKind::Reach)
        .collect();
    assert!(
        reach.iter().any(|s| s.to_secs - s.from_secs > 0.1),
        "{:?}",
        feasibility.stretches
    );
    assert!(
        reach
            .iter()
            .all(|s| !s.slowable && s.joint.starts_with("right_") && s.to_secs > 20.0),
        "{reach:?}"
    );
    assert!(feasibility.error_rad > 0.175);
}
