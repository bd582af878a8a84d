//! Any show as a BVH file.
//!
//! A figure that came from motion capture goes back into its own skeleton: names, hierarchy, offsets,
//! channel order, frame time. Any other figure becomes one joint a link, with axes like the link's, so
//! that attachments are offsets as they stand.

use std::fmt::Write as _;

use glam::{DMat3, DVec3};
use motion::{Figure, FigurePose, LinkIndex, Placed};

use super::euler;
use super::skeleton::{Channel, PositionStyle, Skeleton, SkeletonJoint, joint_from_link};
use crate::document::frames::{ExportError, Frames};
use crate::document::show::Show;

/// A file's text with what it could not say.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Exported {
    /// The file.
    pub text: String,
    /// What of the motion is missing in it, in words.
    pub warnings: Vec<String>,
}

/// The clip being edited as a BVH file, one row a frame.
pub fn export(show: &Show) -> Result<Exported, ExportError> {
    let frames = Frames::of(show)?;
    let figure = &frames.figure.figure;
    let mut writer = match &frames.figure.skeleton {
        Some(skeleton) => {
            let link_from_joint = skeleton
                .bones()
                .iter()
                .map(|&bone| joint_from_link(bone).transpose())
                .collect();
            Writer::new(Skeleton::clone(skeleton), link_from_joint)
        }
        None => Writer::new(skeleton_of(figure), vec![DMat3::IDENTITY; figure.len()]),
    };
    let mut out = hierarchy(&writer.skeleton);
    motion_head(&mut out, frames.times_secs.len(), frames.step_secs);
    let mut placed = Vec::new();
    frames.each(|_, pose| {
        writer.stretched |= is_stretched(figure, pose);
        figure.place(pose, &mut placed);
        writer.row(&placed, &mut out);
    });
    Ok(Exported {
        text: out,
        warnings: writer.warnings(),
    })
}

/// A skeleton as a file of one frame with all rotations zero: how a show keeps it.
pub fn skeleton_text(skeleton: &Skeleton) -> String {
    let mut out = hierarchy(skeleton);
    motion_head(&mut out, 1, 1.0 / 30.0);
    let values = skeleton.joints.iter().enumerate().flat_map(|(place, joint)| {
        joint.channels.iter().map(move |channel| match channel {
            Channel::Position(axis) if place > 0 && joint.positions == PositionStyle::Repeated => {
                joint.offset[usize::from(*axis)]
            }
            _ => 0.0,
        })
    });
    let row: Vec<String> = values.map(|value| format!("{value}")).collect();
    out.push_str(&row.join(" "));
    out.push('\n');
    out
}

/// One joint a link; only joints without children get an end.
fn skeleton_of(figure: &Figure) -> Skeleton {
    let rotations = [Channel::Rotation(2), Channel::Rotation(1), Channel::Rotation(0)];
    let positions = [Channel::Position(0), Channel::Position(1), Channel::Position(2)];
    let joint = |link: &motion::Link| SkeletonJoint {
        name: link.name.clone(),
        parent: link.parent.map(LinkIndex::index),
        offset: link.offset,
        channels: if link.parent.is_none() {
            [positions, rotations].concat()
        } else {
            rotations.to_vec()
        },
        ends: if link.attachments.is_empty() {
            vec![DVec3::Z * link.length]
        } else {
            Vec::new()
        },
        positions: PositionStyle::Added,
    };
    Skeleton {
        joints: figure.links().iter().map(joint).collect(),
    }
}

/// Offsets are constant in BVH, so lengths that are keyed cannot be written.
fn is_stretched(figure: &Figure, pose: &FigurePose) -> bool {
    let stretched = |(link, pose): (&motion::Link, &motion::LinkPose)| {
        (pose.length - link.length).abs() > 1e-9 * link.length
    };
    figure.links().iter().zip(&pose.links).any(stretched)
}

fn hierarchy(skeleton: &Skeleton) -> String {
    let mut out = String::from("HIERARCHY\n");
    let mut open: Vec<usize> = Vec::new();
    for (place, joint) in skeleton.joints.iter().enumerate() {
        while open.last().copied() != joint.parent && !open.is_empty() {
            close(skeleton, &mut open, &mut out);
        }
        let indent = "\t".repeat(open.len());
        let kind = if joint.parent.is_none() { "ROOT" } else { "JOINT" };
        let channels: Vec<&str> = joint.channels.iter().map(|channel| channel.word()).collect();
        // Writing to a string cannot fail.
        let _ = writeln!(out, "{indent}{kind} {}\n{indent}{{", joint.name);
        let _ = writeln!(out, "{indent}\tOFFSET {}", triple(joint.offset));
        let _ = writeln!(
            out,
            "{indent}\tCHANNELS {} {}",
            channels.len(),
            channels.join(" ")
        );
        open.push(place);
    }
    while !open.is_empty() {
        close(skeleton, &mut open, &mut out);
    }
    out
}

/// Ends of the innermost open joint, then its brace.
fn close(skeleton: &Skeleton, open: &mut Vec<usize>, out: &mut String) {
    let Some(place) = open.pop() else { return };
    let indent = "\t".repeat(open.len());
    for end in &skeleton.joints[place].ends {
        let _ = writeln!(
            out,
            "{indent}\tEnd Site\n{indent}\t{{\n{indent}\t\tOFFSET {}\n{indent}\t}}",
            triple(*end)
        );
    }
    let _ = writeln!(out, "{indent}}}");
}

fn triple(v: DVec3) -> String {
    format!("{} {} {}", v.x + 0.0, v.y + 0.0, v.z + 0.0)
}

fn motion_head(out: &mut String, frames: usize, step_secs: f64) {
    let _ = writeln!(out, "MOTION\nFrames: {frames}\nFrame Time: {step_secs}");
}

/// Writes rows, keeping the angles of the row before so that curves do not jump.
struct Writer {
    skeleton: Skeleton,
    link_from_joint: Vec<DMat3>,
    angles_rad: Vec<[f64; 3]>,
    worlds: Vec<DMat3>,
    stretched: bool,
    moved_rootless: bool,
    turned_fixed: Vec<bool>,
}

/// Rotations smaller than this are the noise of multiplying matrices, radians.
const TURN_NOISE_RAD: f64 = 1e-6;

impl Writer {
    fn new(skeleton: Skeleton, link_from_joint: Vec<DMat3>) -> Self {
        let count = skeleton.joints.len();
        Self {
            skeleton,
            link_from_joint,
            angles_rad: vec![[0.0; 3]; count],
            worlds: vec![DMat3::IDENTITY; count],
            stretched: false,
            moved_rootless: false,
            turned_fixed: vec![false; count],
        }
    }

    /// One row. `placed` is in the order of joints, since both are depth first.
    fn row(&mut self, placed: &[Placed], out: &mut String) {
        let begun = out.len();
        for (place, joint) in self.skeleton.joints.iter().enumerate() {
            let world = placed[place].world_from_link * self.link_from_joint[place];
            let own = joint
                .parent
                .map_or(world, |parent| self.worlds[parent].transpose() * world);
            self.worlds[place] = world;
            if let Some(axes) = joint.rotation_axes() {
                self.angles_rad[place] = euler::angles(axes, own, self.angles_rad[place]);
            } else if !own.abs_diff_eq(DMat3::IDENTITY, TURN_NOISE_RAD) {
                self.turned_fixed[place] = true;
            }
            let position = match joint.positions {
                _ if place == 0 => placed[0].start - joint.offset,
                PositionStyle::Added => DVec3::ZERO,
                PositionStyle::Repeated => joint.offset,
            };
            let mut angles = self.angles_rad[place].iter();
            for channel in &joint.channels {
                let value = match channel {
                    Channel::Position(axis) => position[usize::from(*axis)],
                    Channel::Rotation(_) => angles.next().copied().unwrap_or_default().to_degrees(),
                };
                push_number(value, out);
            }
            let places = joint
                .channels
                .iter()
                .any(|channel| matches!(channel, Channel::Position(_)));
            if place == 0 && !places && position.length() > 1e-9 {
                self.moved_rootless = true;
            }
        }
        if out.len() > begun {
            out.pop();
        }
        out.push('\n');
    }

    fn warnings(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        if self.stretched {
            warnings.push("BVH bones have one length; changes of length are left out".to_owned());
        }
        if self.moved_rootless {
            warnings.push("the root has no position channels; its movement is left out".to_owned());
        }
        for (joint, turned) in self.skeleton.joints.iter().zip(&self.turned_fixed) {
            if *turned {
                warnings.push(format!(
                    "joint `{}` has no rotation channels; its turning is left out",
                    joint.name
                ));
            }
        }
        warnings
    }
}

/// Six decimals, as capture files have at most, without zeros at the end, and a space.
fn push_number(value: f64, out: &mut String) {
    let begun = out.len();
    let _ = write!(out, "{value:.6}");
    let kept = out[begun..].trim_end_matches('0').trim_end_matches('.').len();
    out.truncate(begun + kept);
    if &out[begun..] == "-0" {
        out.truncate(begun);
        out.push('0');
    }
    out.push(' ');
}
