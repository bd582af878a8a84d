//! A BVH file becomes a show: its skeleton a figure, its frames the keys of one clip.
//!
//! A joint's link points along its bone, so its orientation is R·B: R the joint's rotation in the world, B
//! the constant rotation from link to joint axes. Units are the file's own; nothing is scaled.

use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use glam::{DMat3, DQuat, DVec3};
use motion::figure::{frame_of, zyz_from_matrix};
use motion::{Figure, FigureError, FigureKey, FigurePose, KineticsMode, LinkPose, LinkSpec};

use super::euler;
use super::read::{BvhFile, read};
use super::skeleton::{Channel, Skeleton, joint_from_link};
use crate::document::clip::ClipDoc;
use crate::document::fault::{FileError, FileErrors};
use crate::document::figure::FigureDoc;
use crate::document::show::Show;
use crate::document::source::Source;
use crate::document::structure;

/// A show made from a motion-capture file.
#[derive(Clone, Debug)]
pub struct Imported {
    /// The show: one figure, one clip, both called `name`.
    pub show: Show,
    /// What was ignored in the file.
    pub warnings: Vec<FileError>,
}

/// Reads a BVH file into a new show called `name`.
pub fn import(source: &Source, name: &str) -> Result<Imported, FileErrors> {
    let (file, warnings) = read(source)?;
    let unusable = |error: FigureError| FileError::whole(source.path(), error.to_string());
    let figure = figure_of(&file.skeleton).map_err(unusable)?;
    let lengths: Vec<f64> = figure.links().iter().map(|link| link.length).collect();
    let clip = ClipDoc {
        keys: keys(&file, &lengths),
        kinetics: KineticsMode::Linear,
        frame_secs: Some(file.frame_secs),
        ..ClipDoc::default()
    };
    let mut figure = FigureDoc::from_figure(name, figure, &format!("from motion capture: {name}"));
    figure.skeleton = Some(Arc::new(file.skeleton));
    let show = Show {
        name: name.to_owned(),
        figure: Some(Arc::new(figure)),
        clips: BTreeMap::from([(name.to_owned(), Arc::new(clip))]),
        clip: name.to_owned(),
        ..Show::default()
    };
    Ok(Imported { show, warnings })
}

/// The figure of a skeleton: link i is joint i, with a direction and a twist, as long as its bone.
pub fn figure_of(skeleton: &Skeleton) -> Result<Figure, FigureError> {
    let bones = skeleton.bones();
    let names = link_names(skeleton);
    let link = |(number, name): (usize, String)| LinkSpec {
        number: number as u32,
        name,
        dof: 3,
        length: bones[number].length(),
        children: Vec::new(),
    };
    let mut specs: Vec<LinkSpec> = names.into_iter().enumerate().map(link).collect();
    for (number, joint) in skeleton.joints.iter().enumerate() {
        if let Some(parent) = joint.parent {
            let offset = joint_from_link(bones[parent]).transpose() * joint.offset;
            specs[parent].children.push((number as u32, offset));
        }
    }
    Figure::new(&specs).map(|(figure, _)| figure)
}

/// Joint names as link names: one word each, no two alike.
fn link_names(skeleton: &Skeleton) -> Vec<String> {
    let mut taken = BTreeSet::new();
    let unique = |joint: &super::SkeletonJoint| {
        let word = structure::word(&joint.name);
        // A name that reads as a number would look like an attachment in a structure file.
        let word = if word.parse::<f64>().is_ok() {
            format!("joint_{word}")
        } else {
            word
        };
        let mut name = word.clone();
        let mut count = 1;
        while !taken.insert(name.clone()) {
            count += 1;
            name = format!("{word}_{count}");
        }
        name
    };
    skeleton.joints.iter().map(unique).collect()
}

fn keys(file: &BvhFile, lengths: &[f64]) -> Vec<Arc<FigureKey>> {
    let bones = file.skeleton.bones();
    let from_link: Vec<DMat3> = bones.iter().map(|&bone| joint_from_link(bone)).collect();
    let mut worlds = vec![DMat3::IDENTITY; bones.len()];
    let mut keys: Vec<Arc<FigureKey>> = Vec::with_capacity(file.frame_count());
    for frame in 0..file.frame_count() {
        let root = turn_joints(&file.skeleton, file.row(frame), &mut worlds);
        let before = keys.last().map(|key| &key.pose.links);
        let link = |place: usize| {
            let angles = zyz_from_matrix(&(worlds[place] * from_link[place]));
            let direction = (worlds[place] * from_link[place]).z_axis.normalize_or(DVec3::Z);
            let twist_rad = match before {
                Some(links) => continued(&links[place], direction, angles.twist_rad),
                None => angles.twist_rad,
            };
            LinkPose {
                direction,
                twist_rad,
                length: lengths[place],
            }
        };
        let pose = FigurePose {
            root,
            links: (0..bones.len()).map(link).collect(),
        };
        keys.push(Arc::new(FigureKey {
            secs: frame as f64 * file.frame_secs,
            pose,
        }));
    }
    keys
}

/// Rotations of all joints in the world for one row; returns where the root is.
fn turn_joints(skeleton: &Skeleton, row: &[f64], worlds: &mut [DMat3]) -> DVec3 {
    let mut columns = row.iter();
    let mut root = skeleton.joints[0].offset;
    for (place, joint) in skeleton.joints.iter().enumerate() {
        let mut angles_rad = [0.0; 3];
        let mut angle = angles_rad.iter_mut();
        for (channel, value) in joint.channels.iter().zip(&mut columns) {
            match channel {
                Channel::Rotation(_) => {
                    if let Some(angle) = angle.next() {
                        *angle = value.to_radians();
                    }
                }
                Channel::Position(axis) if place == 0 => root[usize::from(*axis)] += value,
                // Below the root the reader has made sure that positions say nothing new.
                Channel::Position(_) => {}
            }
        }
        let own = joint
            .rotation_axes()
            .map_or(DMat3::IDENTITY, |axes| euler::matrix(axes, angles_rad));
        worlds[place] = joint.parent.map_or(own, |parent| worlds[parent] * own);
    }
    root
}

/// The twist equal to `twist_rad` up to whole turns that goes on from the frame before with the least
/// spin about the link, as `motion` carries frames from key to key.
fn continued(before: &LinkPose, direction: DVec3, twist_rad: f64) -> f64 {
    let carried = DQuat::from_rotation_arc(before.direction, direction) * frame_of(before.direction).x_axis;
    let frame = frame_of(direction);
    let mut holonomy_rad = carried.dot(frame.y_axis).atan2(carried.dot(frame.x_axis));
    // The same reading of a half turn as `motion::figure::Sweep`'s.
    if holonomy_rad <= 1e-9 - PI {
        holonomy_rad += TAU;
    }
    let without_spin = before.twist_rad + holonomy_rad;
    twist_rad + TAU * ((without_spin - twist_rad) / TAU).round()
}
