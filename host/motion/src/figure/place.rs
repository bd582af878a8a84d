//! Where a posed figure's links lie in the world.
//!
//! Only starts pass down the tree: a child starts at its parent's start plus the attachment turned by the
//! parent's frame. A parent that is longer or shorter than at rest carries its attachments along in
//! proportion (our choice), so that joints stay on the link's end.

use super::frame::frame_of;
use super::{Figure, FigurePose, Link};
use glam::{DMat3, DVec3};

/// One link in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placed {
    /// Where it starts, metres.
    pub start: DVec3,
    /// Where it ends, metres.
    pub end: DVec3,
    /// Its frame: +z runs from start to end.
    pub world_from_link: DMat3,
}

impl Figure {
    /// Places every link of a pose, in the figure's order, replacing what was in `placed`.
    /// Links that the pose lacks stand at rest; those it has too many of are left out.
    pub fn place(&self, pose: &FigurePose, placed: &mut Vec<Placed>) {
        placed.clear();
        for (index, link) in self.links().iter().enumerate() {
            let (frame, length) = match pose.links.get(index) {
                Some(stands) => {
                    let untwisted = frame_of(stands.direction);
                    let (sin, cos) = stands.twist_rad.sin_cos();
                    let x = untwisted.x_axis * cos + untwisted.y_axis * sin;
                    let y = untwisted.y_axis * cos - untwisted.x_axis * sin;
                    (DMat3::from_cols(x, y, untwisted.z_axis), stands.length)
                }
                None => (DMat3::IDENTITY, link.length),
            };
            push(self, link, pose.root, frame, length, placed);
        }
    }
}

/// Appends one link; its parent is already in `placed`.
fn push(figure: &Figure, link: &Link, root: DVec3, frame: DMat3, length: f64, placed: &mut Vec<Placed>) {
    let start = match link.parent {
        None => root,
        Some(parent) => {
            let (on, rest) = (placed[parent.index()], figure.links()[parent.index()].length);
            let stretch = on.start.distance(on.end) / rest;
            on.start + on.world_from_link * DVec3::new(link.offset.x, link.offset.y, link.offset.z * stretch)
        }
    };
    placed.push(Placed {
        start,
        end: start + frame.z_axis * length,
        world_from_link: frame,
    });
}
