//! The form before version 1: `fps`, keys at whole `frame` numbers, links as z-y-z angles in degrees.

use super::read::too_many;
use super::{ClipText, KeyText, LinkText};
use crate::document::fault::Findings;
use crate::document::fields::{Fields, Placed};
use crate::document::zyz;

/// Reads such a file; exports keep its frame rate.
pub(super) fn read<'t>(mut file: Fields<'t>, found: &mut Findings) -> ClipText<'t> {
    let mut text = ClipText::default();
    let fps = file
        .required("fps", found)
        .and_then(|v| v.above_zero(found))
        .unwrap_or(1.0);
    let keys = file
        .optional("key")
        .and_then(|v| v.array(found))
        .unwrap_or_default();
    file.finish(found);
    text.laws.frame_secs = Some(1.0 / fps);
    if !too_many(&keys, found) {
        text.keys = keys
            .into_iter()
            .filter_map(|key| read_key(key, fps, found))
            .collect();
    }
    text
}

fn read_key<'t>(key: Placed<'t>, fps: f64, found: &mut Findings) -> Option<KeyText<'t>> {
    let mut table = key.fields(found)?;
    let frame = table.required("frame", found).and_then(|v| v.count(found));
    let root = table.required("root", found).and_then(|v| v.vector(found));
    let links = table.required("links", found).and_then(|v| v.entries(found));
    table.finish(found);
    let read_link = |(name, at, value): (&'t str, usize, Placed<'t>)| {
        let angles = value.numbers::<3>(found)?.map(f64::to_radians);
        let (direction, twist_rad) = zyz::link_from_angles(angles);
        Some(LinkText {
            name,
            at,
            direction,
            twist_rad,
            length: None,
        })
    };
    let links = links?.into_iter().filter_map(read_link).collect();
    Some(KeyText {
        at: key.at,
        secs: frame? as f64 / fps,
        root: root?,
        links,
    })
}
