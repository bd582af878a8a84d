//! What inlets of the rig's parameters mean to a control: whether they go to a value or add to it, over which range.
//!
//! Apart from `crate::parameters`, which says what a message does: this says how a hand is best joined to it. It
//! must not know where a parameter stands; the rig does.

/// What a message at an inlet does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Sort {
    /// Goes to a value. `added` is the inlet that adds to the same.
    Absolute { added: u8 },
    /// Adds to a value. `absolute` is the inlet that goes to one; `per_turn` is what a turn of a dial is best.
    Added { absolute: u8, per_turn: f64 },
    /// Goes so many steps on.
    Step,
    /// Any message does it.
    Trigger,
}

/// One inlet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Drive {
    /// What people call it; of links and joints their own name.
    pub(crate) short: &'static str,
    /// What the value is in.
    pub(crate) unit: &'static str,
    pub(crate) sort: Sort,
}

const fn absolute(short: &'static str, unit: &'static str, added: u8) -> Drive {
    Drive {
        short,
        unit,
        sort: Sort::Absolute { added },
    }
}

const fn added(short: &'static str, unit: &'static str, absolute: u8, per_turn: f64) -> Drive {
    Drive {
        short,
        unit,
        sort: Sort::Added { absolute, per_turn },
    }
}

const fn trigger(short: &'static str) -> Drive {
    Drive {
        short,
        unit: "",
        sort: Sort::Trigger,
    }
}

const fn step(short: &'static str) -> Drive {
    Drive {
        short,
        unit: "",
        sort: Sort::Step,
    }
}

/// Inlets that a hand can be joined to. A turn is a quarter of a turn of the view, four seconds, a quarter of a
/// turn of a joint: the project's own, as its shipped networks have it.
const DRIVES: &[(&str, u8, Drive)] = &[
    ("VIEW", 1, added("turn", "°", 5, 90.0)),
    ("VIEW", 2, added("tilt", "°", 6, 90.0)),
    ("VIEW", 4, trigger("front")),
    ("VIEW", 5, absolute("turn", "°", 1)),
    ("VIEW", 6, absolute("tilt", "°", 2)),
    ("TIME", 1, added("time", "s", 2, 4.0)),
    ("TIME", 2, absolute("time", "s", 1)),
    ("TIME", 3, trigger("play")),
    ("TIME", 4, step("key")),
    ("TIME", 5, trigger("loop")),
    ("TIME", 6, absolute("speed", "×", 7)),
    ("TIME", 7, added("speed", "×", 6, 1.0)),
    ("POSE", 3, trigger("place")),
    ("POSE", 4, step("link")),
    ("POSE", 7, trigger("clip")),
    ("KEYS", 1, trigger("store")),
    ("KEYS", 2, trigger("delete")),
    ("PUPPET", 5, trigger("stop")),
    ("SHOW", 1, trigger("undo")),
    ("SHOW", 2, trigger("redo")),
    ("SHOW", 3, trigger("save")),
];

/// Inlets of a link of the figure ([`crate::parameters::LINK`]).
const LINK: &[(u8, Drive)] = &[(2, absolute("", "°", 3)), (3, added("", "°", 2, 90.0))];
/// Inlets of a joint of the puppet ([`crate::parameters::JOINT`]).
const JOINT: &[(u8, Drive)] = &[(1, absolute("", "°", 2)), (2, added("", "°", 1, 90.0))];

/// What a hand can do at an inlet; none where it is none of the rig's, or not for hands.
pub(crate) fn drive(name: &str, inlet: u8) -> Option<Drive> {
    let of = |table: &[(u8, Drive)]| table.iter().find(|(number, _)| *number == inlet).map(|row| row.1);
    if link(name).is_some() {
        return of(LINK);
    }
    if joint(name).is_some() {
        return of(JOINT);
    }
    let mut all = DRIVES.iter();
    all.find(|(known, number, _)| known.eq_ignore_ascii_case(name) && *number == inlet)
        .map(|row| row.2)
}

/// What people call what an inlet drives, in a few characters.
pub(crate) fn short(name: &str, inlet: u8) -> String {
    let own = link(name).or_else(|| joint(name)).map(str::to_owned);
    own.or_else(|| drive(name, inlet).map(|it| it.short.to_owned()))
        .unwrap_or_else(|| name.to_owned())
}

/// The inlet whose value says where an inlet's parameter stands: itself, or the one it adds to.
pub(crate) fn read_at(name: &str, inlet: u8) -> Option<u8> {
    match drive(name, inlet)?.sort {
        Sort::Absolute { .. } => Some(inlet),
        Sort::Added { absolute, .. } => Some(absolute),
        Sort::Step | Sort::Trigger => None,
    }
}

/// The link that a parameter's name speaks of.
pub(crate) fn link(name: &str) -> Option<&str> {
    after(name, "FIGURE.")
}

/// The joint that a parameter's name speaks of.
pub(crate) fn joint(name: &str) -> Option<&str> {
    after(name, "PUPPET.")
}

fn after<'a>(name: &'a str, prefix: &str) -> Option<&'a str> {
    let (start, rest) = name.split_at_checked(prefix.len())?;
    (start.eq_ignore_ascii_case(prefix) && !rest.is_empty()).then_some(rest)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parameters::{JOINT as JOINTS, LINK as LINKS, PARAMETERS};

    #[test]
    fn every_row_is_an_inlet_and_twins_name_each_other() {
        let exists = |name: &str, inlet: u8| {
            let known = PARAMETERS.iter().find(|it| it.name == name);
            let count = match (link(name), joint(name)) {
                (Some(_), _) => LINKS.len(),
                (_, Some(_)) => JOINTS.len(),
                _ => known.map_or(0, |it| it.inlets.len()),
            };
            (1..=count).contains(&usize::from(inlet))
        };
        let own = DRIVES.iter().map(|(name, inlet, _)| (*name, *inlet));
        let links = LINK.iter().map(|(inlet, _)| ("FIGURE.a", *inlet));
        let joints = JOINT.iter().map(|(inlet, _)| ("PUPPET.a", *inlet));
        for (name, inlet) in own.chain(links).chain(joints) {
            assert!(exists(name, inlet), "{name}<{inlet}>");
            match drive(name, inlet).map(|it| it.sort) {
                Some(Sort::Absolute { added }) => {
                    let twin = drive(name, added).map(|it| it.sort);
                    assert!(matches!(twin, Some(Sort::Added { absolute, .. }) if absolute == inlet));
                }
                Some(Sort::Added { absolute, .. }) => {
                    let twin = drive(name, absolute).map(|it| it.sort);
                    assert!(matches!(twin, Some(Sort::Absolute { added }) if added == inlet));
                }
                other => assert!(other.is_some(), "{name}<{inlet}>"),
            }
        }
    }

    #[test]
    fn links_and_joints_go_by_their_own_names() {
        assert_eq!(short("FIGURE.rua", 2), "rua");
        assert_eq!(short("puppet.elbow", 1), "elbow");
        assert_eq!(short("TIME", 2), "time");
        assert_eq!(read_at("TIME", 1), Some(2));
        assert_eq!(read_at("TIME", 3), None);
        assert_eq!(drive("FIGURE.", 2), None);
        assert_eq!(drive("gain", 2), None);
    }
}
