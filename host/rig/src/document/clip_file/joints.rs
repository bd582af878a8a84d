//! The form for clips of a puppet's own joints: `of = "joints"`, and in every key angles by name, in degrees.
//!
//! A key may name any of the joints; the others pass by. Which joints there are is the puppet's to know, so names
//! are judged when the clip is played, not when it is read.

use std::collections::BTreeMap;
use std::sync::Arc;

use motion::JointKey;

use super::VERSION;
use super::read::{check_times, read_timing, too_many};
use super::write::{degrees, line, write_timing};
use crate::document::clip::JointClipDoc;
use crate::document::fault::Findings;
use crate::document::fields::{self, Fields, Placed};
use crate::document::source::Source;

/// What such a file says it is of.
const JOINTS: &str = "joints";
/// A servo of several turns may be keyed many turns away; more is a mistyped angle, degrees.
const ANGLE_DEG_MAX: f64 = 1e5;

/// Whether a clip file is of this kind. Other faults in it are somebody else's to tell.
pub(in crate::document) fn is_of_joints(source: &Source) -> bool {
    let mut nobody = Findings::default();
    let table = fields::parse(source, &mut nobody);
    let mut file = Fields::of_file(source, &table);
    let of = file.optional("of").and_then(|v| v.text(&mut nobody));
    of == Some(JOINTS)
}

/// Reads a clip of joints.
pub(in crate::document) fn read_joints(source: &Source, found: &mut Findings) -> Option<JointClipDoc> {
    let table = fields::parse(source, found);
    if !found.errors.is_empty() {
        return None;
    }
    let mut file = Fields::of_file(source, &table);
    let mut clip = JointClipDoc::default();
    let version = file
        .required("version", found)
        .and_then(|v| Some((v, v.count(found)?)));
    if let Some((at, version)) = version.filter(|(_, version)| *version != VERSION) {
        found.error(at.fault(format!("clips of joints have version {VERSION}, not {version}")));
    }
    file.required("of", found);
    let adjust_at = read_timing(&mut file, &mut clip, found).unwrap_or(0);
    clip.frame_secs = file.optional("frame_secs").and_then(|v| v.above_zero(found));
    let keys = file
        .optional("key")
        .and_then(|v| v.array(found))
        .unwrap_or_default();
    file.finish(found);
    if too_many(&keys, found) {
        return None;
    }
    let keys: Vec<(usize, JointKey)> = keys.into_iter().filter_map(|key| read_key(key, found)).collect();
    let times: Vec<(usize, f64)> = keys.iter().map(|(at, key)| (*at, key.secs)).collect();
    check_times(source, &times, found);
    clip.keys = keys.into_iter().map(|(_, key)| Arc::new(key)).collect();
    if found.errors.is_empty()
        && let Err(error) = clip.check_timing()
    {
        found.error(source.error(adjust_at, format!("the timing cannot be: {error}")));
    }
    found.errors.is_empty().then_some(clip)
}

fn read_key(key: Placed<'_>, found: &mut Findings) -> Option<(usize, JointKey)> {
    let mut table = key.fields(found)?;
    let secs = table.required("secs", found).and_then(|v| v.number(found));
    let joints = table.required("joints", found).and_then(|v| v.entries(found));
    table.finish(found);
    let mut angles_rad = BTreeMap::new();
    for (name, _, value) in joints? {
        let Some(angle) = value.number(found) else {
            continue;
        };
        if angle.abs() > ANGLE_DEG_MAX {
            found.error(value.fault(format!("{angle} degrees; angles lie within {ANGLE_DEG_MAX} of 0")));
        }
        angles_rad.insert(name.to_owned(), angle.to_radians());
    }
    Some((
        key.at,
        JointKey {
            secs: secs?,
            angles_rad,
        },
    ))
}

/// The file of a clip of joints: reading it gives the clip back.
pub(in crate::document) fn write_joints(clip: &JointClipDoc) -> String {
    let mut out = String::new();
    line(&mut out, format_args!("version = {VERSION}\nof = \"{JOINTS}\""));
    write_timing(clip, &mut out);
    if let Some(secs) = clip.frame_secs {
        line(&mut out, format_args!("frame_secs = {secs:?}"));
    }
    for key in &clip.keys {
        line(
            &mut out,
            format_args!("\n[[key]]\nsecs = {:?}\n\n[key.joints]", key.secs),
        );
        for (joint, angle) in &key.angles_rad {
            line(
                &mut out,
                format_args!("{} = {:?}", fields::key(joint), degrees(*angle)),
            );
        }
    }
    out
}
