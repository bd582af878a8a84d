//! What position channels below the root mean: programs write them in two ways, and only rigid skeletons can
//! be links of a figure.

use glam::DVec3;

use super::skeleton::{Channel, PositionStyle, Skeleton};
use crate::document::fault::{FileError, Findings};
use crate::document::source::Source;

/// Finds out what position channels below the root mean; bones that change length are refused.
pub(super) fn tell_styles(source: &Source, skeleton: &mut Skeleton, values: &[f64], found: &mut Findings) {
    let columns = skeleton.column_count().max(1);
    let tolerance = 1e-4 * skeleton.height();
    let mut first = 0;
    for (index, joint) in skeleton.joints.iter_mut().enumerate() {
        let at = first;
        first += joint.channels.len();
        if index == 0
            || !joint
                .channels
                .iter()
                .any(|channel| matches!(channel, Channel::Position(_)))
        {
            continue;
        }
        let agrees = |expected: DVec3| {
            values.chunks_exact(columns).all(|row| {
                joint
                    .channels
                    .iter()
                    .zip(&row[at..])
                    .all(|(channel, value)| match channel {
                        Channel::Position(axis) => (value - expected[*axis as usize]).abs() <= tolerance,
                        Channel::Rotation(_) => true,
                    })
            })
        };
        if agrees(DVec3::ZERO) {
            joint.positions = PositionStyle::Added;
        } else if agrees(joint.offset) {
            joint.positions = PositionStyle::Repeated;
        } else {
            let message = format!(
                "joint `{}` moves against its parent; only the root may",
                joint.name
            );
            let error = FileError::whole(source.path(), message);
            found.error(error.with_hint("export it with rigid bones"));
        }
    }
}
