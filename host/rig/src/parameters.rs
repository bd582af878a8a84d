//! What the function network can drive: the rig's parameters, as named inlets like any adder's.
//!
//! `CONNECT gain<1>:<1>VIEW;` in a network file reaches the table below. Reading the table is reading the
//! reference: `docs/parameters.md` is made from it.

use ps300::value::{Kind, Kinds, Value};

use crate::command::{Command, PoseCommand, PuppetCommand, PuppetPose, Side, TransportCommand, ViewCommand};

/// A parameter: a name and its inlets, numbered from 1.
#[derive(Debug)]
pub struct Parameter {
    /// Name in the command language.
    pub name: &'static str,
    /// Inlets in order.
    pub inlets: &'static [Inlet],
}

/// One inlet of a parameter.
#[derive(Debug)]
pub struct Inlet {
    /// Kinds of value it takes.
    pub kinds: Kinds,
    /// What a value does, in words.
    pub meaning: &'static str,
    /// The same, for the rig.
    request: fn(&Value) -> Option<Request>,
}

/// What a value asks for. Some need to know the present time or selection, which only the rig does.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Request {
    /// A complete command.
    Command(Command),
    /// A key at the present time.
    StoreKey,
    /// Deletes the key at the present time.
    DeleteKey,
    /// Selects another kinetic coefficient.
    KineticStep(i32),
    /// Adds to the selected kinetic coefficient.
    KineticBy(f64),
    /// Turns the view about the vertical to an angle, radians.
    Azimuth(f64),
    /// Tilts the view to an angle, radians.
    Elevation(f64),
    /// Adds to the playing speed.
    SpeedBy(f64),
    /// Twists a link further.
    TwistBy {
        /// By its place in the figure's order.
        link: u16,
        /// Radians.
        by_rad: f64,
    },
    /// Something that is not for networks to do, and why.
    NotForNetworks(&'static str),
}

/// What an inlet asks for when `value` arrives; `None` for values that ask for nothing.
pub(crate) fn request(name: &str, port: u8, value: &Value) -> Option<Request> {
    let parameter = PARAMETERS.iter().find(|p| p.name.eq_ignore_ascii_case(name))?;
    let inlet = parameter.inlets.get(usize::from(port).checked_sub(1)?)?;
    (inlet.request)(value)
}

const fn inlet(kinds: Kinds, meaning: &'static str, request: fn(&Value) -> Option<Request>) -> Inlet {
    Inlet {
        kinds,
        meaning,
        request,
    }
}

/// Degrees, as networks speak of angles, to radians.
fn degrees(value: &Value) -> Option<f64> {
    value.as_number().map(f64::to_radians).filter(|v| v.is_finite())
}

fn real(value: &Value) -> Option<f64> {
    value.as_number().filter(|v| v.is_finite())
}

fn step(value: &Value) -> Option<i32> {
    real(value).map(|v| v.round() as i32).filter(|&v| v != 0)
}

fn pose(command: PoseCommand) -> Request {
    Request::Command(Command::Pose(command))
}

fn time(command: TransportCommand) -> Request {
    Request::Command(Command::Transport(command))
}

fn view(azimuth_by_rad: f64, elevation_by_rad: f64) -> Request {
    Request::Command(Command::View(ViewCommand::Turn {
        azimuth_by_rad,
        elevation_by_rad,
    }))
}

fn puppet(command: PuppetCommand) -> Request {
    Request::Command(Command::Puppet(command))
}

/// Said when a network tries.
const RESET_IS_FOR_PEOPLE: &str =
    "the network cannot reset the puppet: a stop or fault is left by a person, with Reset in the studio";

/// Two components, or three of which the third is not needed.
const PLANE_OR_SPACE: Kinds = Kinds::of(&[Kind::Vector2, Kind::Vector3]);
/// Three components.
const SPACE: Kinds = Kinds::of(&[Kind::Vector3]);

/// All parameters but the figure's links, which are named after the figure (`FIGURE.rua`, see [`LINK`]).
pub const PARAMETERS: &[Parameter] = &[
    Parameter {
        name: "POSE",
        inlets: &[
            inlet(
                PLANE_OR_SPACE,
                "cursor in the front view, −1…1, y up: the selected link follows it",
                |v| match v {
                    Value::Vector2(p) if p.is_finite() => Some(pose(PoseCommand::Cursor([p.x, p.y]))),
                    Value::Vector3(p) if p.is_finite() => Some(pose(PoseCommand::Cursor([p.x, p.y]))),
                    _ => None,
                },
            ),
            inlet(
                Kinds::NUMBER,
                "side of the sphere inside the circle: 1 near, 2 far",
                |v| match real(v)? {
                    side if side >= 1.5 => Some(pose(PoseCommand::Side(Side::Far))),
                    _ => Some(pose(PoseCommand::Side(Side::Near))),
                },
            ),
            inlet(
                Kinds::ANY,
                "any message fixes the selected link and selects the next",
                |_| Some(pose(PoseCommand::Place)),
            ),
            inlet(Kinds::NUMBER, "selects a later (positive) or earlier link", |v| {
                Some(pose(PoseCommand::Step(step(v)?)))
            }),
            inlet(
                Kinds::NUMBER,
                "twists the selected link about its axis, degrees, added",
                |v| Some(pose(PoseCommand::Twist { by_rad: degrees(v)? })),
            ),
            inlet(SPACE, "moves the root, metres, added", |v| match v {
                Value::Vector3(p) if p.is_finite() => Some(pose(PoseCommand::RootBy(p.to_array()))),
                _ => None,
            }),
            inlet(
                Kinds::ANY,
                "any message takes over the pose of the clip at the present time",
                |_| Some(pose(PoseCommand::FromClip)),
            ),
        ],
    },
    Parameter {
        name: "VIEW",
        inlets: &[
            inlet(Kinds::NUMBER, "turns about the vertical, degrees, added", |v| {
                Some(view(degrees(v)?, 0.0))
            }),
            inlet(Kinds::NUMBER, "tilts, degrees, added", |v| {
                Some(view(0.0, degrees(v)?))
            }),
            inlet(Kinds::NUMBER, "zooms: one unit doubles the picture", |v| {
                Some(Request::Command(Command::View(ViewCommand::Zoom {
                    by: real(v)?.clamp(-8.0, 8.0).exp2(),
                })))
            }),
            inlet(Kinds::ANY, "any message restores the front view", |_| {
                Some(Request::Command(Command::View(ViewCommand::Reset)))
            }),
            inlet(
                Kinds::NUMBER,
                "goes to an angle about the vertical, degrees, 0 the front view",
                |v| Some(Request::Azimuth(degrees(v)?)),
            ),
            inlet(Kinds::NUMBER, "goes to a tilt, degrees, 0 the front view", |v| {
                Some(Request::Elevation(degrees(v)?))
            }),
        ],
    },
    Parameter {
        name: "TIME",
        inlets: &[
            inlet(Kinds::NUMBER, "moves time, seconds, added", |v| {
                Some(time(TransportCommand::Nudge { by_secs: real(v)? }))
            }),
            inlet(Kinds::NUMBER, "goes to a time, seconds", |v| {
                Some(time(TransportCommand::Seek { secs: real(v)? }))
            }),
            inlet(Kinds::ANY, "any message plays, or pauses while playing", |_| {
                Some(time(TransportCommand::Toggle))
            }),
            inlet(Kinds::NUMBER, "goes to a later (positive) or earlier key", |v| {
                Some(time(TransportCommand::Key(step(v)?)))
            }),
            inlet(Kinds::ANY, "any message switches looping", |_| {
                Some(time(TransportCommand::ToggleLoop))
            }),
            inlet(Kinds::NUMBER, "goes to a playing speed, 1 as it was made", |v| {
                Some(time(TransportCommand::Speed(real(v)?)))
            }),
            inlet(Kinds::NUMBER, "changes the playing speed, added", |v| {
                Some(Request::SpeedBy(real(v)?))
            }),
        ],
    },
    Parameter {
        name: "KEYS",
        inlets: &[
            inlet(
                Kinds::ANY,
                "any message stores the pose as a key at the present time",
                |_| Some(Request::StoreKey),
            ),
            inlet(
                Kinds::ANY,
                "any message deletes the key at the present time",
                |_| Some(Request::DeleteKey),
            ),
        ],
    },
    Parameter {
        name: "KINETIC",
        inlets: &[
            inlet(
                Kinds::NUMBER,
                "selects a later (positive) or earlier coefficient",
                |v| Some(Request::KineticStep(step(v)?)),
            ),
            inlet(
                Kinds::NUMBER,
                "adds to the selected coefficient, in keys: timing changes, the path does not",
                |v| Some(Request::KineticBy(real(v)?)),
            ),
        ],
    },
    Parameter {
        name: "PUPPET",
        inlets: &[
            inlet(
                Kinds::ANY,
                "any message arms: goals pinned to the measured pose, then torque",
                |_| Some(puppet(PuppetCommand::Arm)),
            ),
            inlet(Kinds::ANY, "any message plays the clip", |_| {
                Some(puppet(PuppetCommand::Play))
            }),
            inlet(Kinds::ANY, "any message holds", |_| {
                Some(puppet(PuppetCommand::Hold))
            }),
            inlet(Kinds::ANY, "any message slows down and lets go", |_| {
                Some(puppet(PuppetCommand::Release))
            }),
            inlet(Kinds::ANY, "any message stops at once and latches", |_| {
                Some(puppet(PuppetCommand::Stop))
            }),
            inlet(
                Kinds::ANY,
                "does nothing but say so: a network may stop a puppet, only people leave a stop or fault",
                |_| Some(Request::NotForNetworks(RESET_IS_FOR_PEOPLE)),
            ),
            inlet(
                Kinds::ANY,
                "any message lets the puppet follow the figure live",
                |_| Some(puppet(PuppetCommand::Follow)),
            ),
            inlet(
                Kinds::ANY,
                "any message is a heartbeat, for puppets that are played only while one comes",
                |_| Some(puppet(PuppetCommand::Heartbeat)),
            ),
            inlet(
                Kinds::NUMBER,
                "1 or more takes goals ahead of time by as much as each joint lags, less does not",
                |v| Some(puppet(PuppetCommand::CompensateLag(real(v)? >= 1.0))),
            ),
        ],
    },
    Parameter {
        name: "SHOW",
        inlets: &[
            inlet(Kinds::ANY, "any message undoes", |_| {
                Some(Request::Command(Command::Undo))
            }),
            inlet(Kinds::ANY, "any message redoes", |_| {
                Some(Request::Command(Command::Redo))
            }),
            inlet(Kinds::ANY, "any message saves the show", |_| {
                Some(Request::Command(Command::Save))
            }),
        ],
    },
];

/// Inlets of every link of the figure; its name is `FIGURE.` and the link's.
pub const LINK: &[(Kinds, &str)] = &[
    (
        Kinds::VECTOR,
        "direction of the link, world axes; need not be unit",
    ),
    (Kinds::NUMBER, "twist about its own axis, degrees"),
    (Kinds::NUMBER, "twists it about its own axis, degrees, added"),
];

/// Inlets of every joint of the puppet; its name is `PUPPET.` and the joint's.
pub const JOINT: &[(Kinds, &str)] = &[
    (
        Kinds::NUMBER,
        "goes to an angle, degrees; it stops at the joint's range",
    ),
    (
        Kinds::NUMBER,
        "turns the joint, degrees, added; it stops at the joint's range",
    ),
];

/// What a link's inlet asks for.
pub(crate) fn link_request(link: u16, port: u8, value: &Value) -> Option<Request> {
    match (port, value) {
        (1, Value::Vector3(d)) if d.is_finite() => Some(pose(PoseCommand::LinkDirection {
            link,
            direction: d.to_array(),
        })),
        (2, value) => Some(pose(PoseCommand::LinkTwist {
            link,
            twist_rad: degrees(value)?,
        })),
        (3, value) => Some(Request::TwistBy {
            link,
            by_rad: degrees(value)?,
        }),
        _ => None,
    }
}

/// What a joint's inlet asks for.
pub(crate) fn joint_request(joint: &str, port: u8, value: &Value) -> Option<Request> {
    let joint = joint.to_owned();
    let pose = match port {
        1 => PuppetPose::Joint {
            joint,
            angle_rad: degrees(value)?,
        },
        2 => PuppetPose::JointBy {
            joint,
            by_rad: degrees(value)?,
        },
        _ => return None,
    };
    Some(Request::Command(Command::PuppetPose(pose)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    #[test]
    fn values_become_requests() {
        let cursor = Value::Vector2(DVec2::new(0.25, -0.5));
        let rows = [
            ("POSE", 1, cursor, Some(pose(PoseCommand::Cursor([0.25, -0.5])))),
            (
                "pose",
                2,
                Value::Integer(2),
                Some(pose(PoseCommand::Side(Side::Far))),
            ),
            (
                "VIEW",
                1,
                Value::Real(180.0),
                Some(view(std::f64::consts::PI, 0.0)),
            ),
            (
                "TIME",
                4,
                Value::Real(-1.0),
                Some(time(TransportCommand::Key(-1))),
            ),
            ("TIME", 4, Value::Real(0.2), None),
            ("TIME", 1, Value::Real(f64::NAN), None),
            ("KEYS", 1, Value::Boolean(true), Some(Request::StoreKey)),
            ("KEYS", 3, Value::Boolean(true), None),
            (
                "PUPPET",
                5,
                Value::Boolean(true),
                Some(puppet(PuppetCommand::Stop)),
            ),
            (
                "PUPPET",
                6,
                Value::Boolean(true),
                Some(Request::NotForNetworks(RESET_IS_FOR_PEOPLE)),
            ),
            (
                "PUPPET",
                9,
                Value::Integer(1),
                Some(puppet(PuppetCommand::CompensateLag(true))),
            ),
            ("NOSUCH", 1, Value::Boolean(true), None),
        ];
        for (name, port, value, want) in rows {
            assert_eq!(request(name, port, &value), want, "{name}<{port}> {value:?}");
        }
    }

    #[test]
    fn names_are_unique() {
        let mut names: Vec<_> = PARAMETERS.iter().map(|p| p.name).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), PARAMETERS.len());
    }
}
