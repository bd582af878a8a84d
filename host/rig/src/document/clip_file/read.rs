//! Reading: laws, then keys or rows, then the names of links.

use std::collections::BTreeMap;

use glam::DVec3;
use motion::Figure;

use super::{ClipText, DIRECTION_LAWS, KINETICS, KeyText, LinkText, TWIST_LAWS, bind, rows, version_0};
use crate::document::clip::ClipDoc;
use crate::document::fault::Findings;
use crate::document::fields::{self, Fields, Placed};
use crate::document::limits::{KEY_GAP_SECS_MIN, KEYS_MAX, SECS_MAX};
use crate::document::show_file;
use crate::document::source::Source;

/// Reads a clip file for `figure`. Without a figure everything but the link names is checked.
pub(in crate::document) fn read(
    source: &Source,
    figure: Option<&Figure>,
    found: &mut Findings,
) -> Option<ClipDoc> {
    let table = fields::parse(source, found);
    if !found.errors.is_empty() {
        return None;
    }
    let mut file = Fields::of_file(source, &table);
    let version = show_file::version(&mut file, found)?;
    let text = if version == 0 {
        version_0::read(file, found)
    } else {
        read_1(file, found)
    };
    let times: Vec<(usize, f64)> = text.keys.iter().map(|key| (key.at, key.secs)).collect();
    check_times(source, &times, found);
    let mut clip = text.laws;
    clip.keys = match figure {
        Some(figure) => bind::bind(source, &text.keys, figure, found),
        None => Vec::new(),
    };
    if found.errors.is_empty()
        && figure.is_some()
        && let Err(error) = clip.check_timing()
    {
        found.error(source.error(text.adjust_at, format!("the timing cannot be: {error}")));
    }
    found.errors.is_empty().then_some(clip)
}

fn read_1<'t>(mut file: Fields<'t>, found: &mut Findings) -> ClipText<'t> {
    let mut text = ClipText::default();
    let laws = &mut text.laws;
    if let Some(law) = file
        .optional("direction")
        .and_then(|v| v.choice(&DIRECTION_LAWS, found))
    {
        laws.direction_law = law;
    }
    if let Some(law) = file.optional("twist").and_then(|v| v.choice(&TWIST_LAWS, found)) {
        laws.twist_law = law;
    }
    if let Some(at) = read_timing(&mut file, laws, found) {
        text.adjust_at = at;
    }
    laws.frame_secs = file.optional("frame_secs").and_then(|v| v.above_zero(found));
    let keys = file
        .optional("key")
        .and_then(|v| v.array(found))
        .unwrap_or_default();
    let rows = file.optional("frames");
    file.finish(found);
    if let (Some(key), Some(rows)) = (keys.first(), rows) {
        found.error(key.fault("a clip has either [[key]] tables or [frames] rows, not both"));
        found.error(rows.fault("a clip has either [[key]] tables or [frames] rows, not both"));
    }
    if too_many(&keys, found) {
        return text;
    }
    text.keys = match rows {
        Some(rows) => rows::read(rows, found),
        None => keys.into_iter().filter_map(|key| read_key(key, found)).collect(),
    };
    text
}

/// What clips of every kind say about time; where the adjustments stand.
pub(super) fn read_timing<K>(
    file: &mut Fields<'_>,
    laws: &mut ClipDoc<K>,
    found: &mut Findings,
) -> Option<usize> {
    if let Some(mode) = file.optional("kinetics").and_then(|v| v.choice(&KINETICS, found)) {
        laws.kinetics = mode;
    }
    laws.keep_forward = file
        .optional("keep_forward")
        .and_then(|v| v.boolean(found))
        .unwrap_or(false);
    let pairs = file.optional("adjust")?;
    laws.coefficient_edits = adjustments(pairs, found);
    Some(pairs.at)
}

pub(super) fn too_many(keys: &[Placed<'_>], found: &mut Findings) -> bool {
    let Some(key) = keys.get(KEYS_MAX) else {
        return false;
    };
    found.error(key.fault(format!("{} keys; at most {KEYS_MAX} are read", keys.len())));
    true
}

fn adjustments(value: Placed<'_>, found: &mut Findings) -> Vec<(usize, f64)> {
    let mut sums = BTreeMap::new();
    for pair in value.array(found).unwrap_or_default() {
        let Some([index, by]) = pair.numbers::<2>(found) else {
            continue;
        };
        if index < 0.0 || index.fract() != 0.0 || index > (KEYS_MAX + 2) as f64 {
            found.error(pair.fault(format!(
                "expected a coefficient's number from 0 up, found {index}"
            )));
            continue;
        }
        *sums.entry(index as usize).or_insert(0.0) += by;
    }
    sums.into_iter().collect()
}

fn read_key<'t>(key: Placed<'t>, found: &mut Findings) -> Option<KeyText<'t>> {
    let mut table = key.fields(found)?;
    let secs = table.required("secs", found).and_then(|v| v.number(found));
    let root = table.required("root", found).and_then(|v| v.vector(found));
    let links = table.required("links", found).and_then(|v| v.entries(found));
    table.finish(found);
    let read_link = |(name, at, value): (&'t str, usize, Placed<'t>)| {
        let mut link = value.fields(found)?;
        let direction = link
            .required("direction", found)
            .and_then(|v| direction(v, found));
        let twist = link.optional("twist").map_or(Some(0.0), |v| v.number(found));
        let length = link.optional("length").and_then(|v| v.above_zero(found));
        link.finish(found);
        Some(LinkText {
            name,
            at,
            direction: direction?,
            twist_rad: twist?.to_radians(),
            length,
        })
    };
    let links = links?.into_iter().filter_map(read_link).collect();
    Some(KeyText {
        at: key.at,
        secs: secs?,
        root: root?,
        links,
    })
}

/// A direction as written, made a unit vector unless it is one already: what was written by this
/// program comes back to the last bit.
fn direction(value: Placed<'_>, found: &mut Findings) -> Option<DVec3> {
    let written = value.vector(found)?;
    if (written.length_squared() - 1.0).abs() < 1e-14 {
        return Some(written);
    }
    let largest = written.abs().max_element();
    let unit = (largest > 0.0)
        .then(|| written / largest)
        .and_then(DVec3::try_normalize);
    if unit.is_none() {
        found.error(value.fault("a direction cannot be zero"));
    }
    unit
}

/// Times must increase, and not by next to nothing; each with its place.
pub(super) fn check_times(source: &Source, keys: &[(usize, f64)], found: &mut Findings) {
    for &(at, secs) in keys.iter().filter(|(_, secs)| secs.abs() > SECS_MAX) {
        let message = format!("key at {secs} s; times lie within {SECS_MAX} s of 0");
        found.error(source.error(at, message));
    }
    for pair in keys.windows(2) {
        let ((_, before), (at, secs)) = (pair[0], pair[1]);
        if secs - before < KEY_GAP_SECS_MIN {
            let message = format!("key at {secs} s follows one at {before} s; times must increase");
            found.error(source.error(at, message));
        }
    }
}
