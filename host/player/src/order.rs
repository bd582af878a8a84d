//! Everything that can be asked of a player.

use motion::joint_clip::JointClip;
use std::sync::Arc;

/// One wish. Orders that do not fit the state are rejected and change nothing, but [`Order::Stop`] always fits.
#[derive(Debug, Clone)]
pub enum Order {
    /// Measure, pin and switch on. From released.
    Arm,
    /// Approach the clip's pose at `from_secs`, then play. From holding or playing.
    Play {
        /// What to play; joints that it does not name stand.
        clip: Arc<JointClip>,
        /// Where to begin; outside the clip: its nearer end.
        from_secs: f64,
        /// Seconds of the clip in a second; above 0, at most 10.
        speed: f64,
        /// Begin again at the end.
        looped: bool,
    },
    /// Approach another moment of the clip that is playing.
    Seek(f64),
    /// Follow a live pose, one angle for each joint in the puppet's order. The latest wins.
    Follow(Arc<[f64]>),
    /// Decelerate and stand.
    Hold,
    /// Decelerate, then switch torque off.
    Release,
    /// Stop now and stay stopped: decelerate, then as configured. From every state.
    Stop,
    /// Leave a fault; torque goes off if it is still on.
    Reset,
    /// The operator is there.
    Alive,
    /// A sign of life from outside, for puppets that need one ([`crate::PlayerConfig::heartbeat_max`]).
    Heartbeat,
    /// Whether goals are taken ahead of the clip's time by each joint's lag. Moves nothing that stands.
    CompensateLag(bool),
}

/// Why an order was not followed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Rejection {
    /// It does not fit the state.
    #[error("cannot {order} while {state}; {remedy}")]
    State {
        /// The order.
        order: &'static str,
        /// The state's name.
        state: &'static str,
        /// What to do first.
        remedy: &'static str,
    },
    /// The clip is for another puppet.
    #[error("the clip moves \"{joint}\", which this puppet does not have; it has: {known}")]
    UnknownJoint {
        /// The clip's joint.
        joint: String,
        /// The puppet's joints.
        known: String,
    },
    /// Nothing to play.
    #[error("the clip has no joints; bake it for this puppet first")]
    EmptyClip,
    /// A live pose of another puppet.
    #[error("the pose has {got} angles, the puppet {want} joints")]
    PoseLength {
        /// Joints of the puppet.
        want: usize,
        /// Angles given.
        got: usize,
    },
    /// Not a number, or not a speed.
    #[error("{what} {value}: expected {expected}")]
    Value {
        /// What was given.
        what: &'static str,
        /// Its value.
        value: f64,
        /// What would do.
        expected: &'static str,
    },
}

impl Order {
    /// The verb, for messages.
    pub(crate) fn verb(&self) -> &'static str {
        match self {
            Self::Arm => "arm",
            Self::Play { .. } => "play",
            Self::Seek(_) => "seek",
            Self::Follow(_) => "follow",
            Self::Hold => "hold",
            Self::Release => "release",
            Self::Stop => "stop",
            Self::Reset => "reset",
            Self::Alive | Self::Heartbeat => "note a sign of life",
            Self::CompensateLag(_) => "compensate lag",
        }
    }
}
