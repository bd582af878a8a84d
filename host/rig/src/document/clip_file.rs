//! Clip files: key poses as TOML a person can read and change.
//!
//! A key names every link with its direction; twist and length stand only where they say something. Clips
//! of very many keys use the row form of [`clip_rows`](super::clip_rows) instead. Version 0 counted frames
//! instead of seconds and gave z-y-z angles instead of directions; it is read, never written.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::sync::Arc;

use glam::DVec3;
use motion::{DirectionLaw, Figure, FigureKey, FigurePose, KineticsMode, LinkPose, TwistLaw};

use super::clip::ClipDoc;
use super::clip_rows;
use super::fault::Findings;
use super::fields::{self, Fields, Placed};
use super::limits::KEYS_MAX;
use super::source::Source;
use super::zyz;

/// The version written.
pub(super) const VERSION: u64 = 1;

const DIRECTION_LAWS: [(&str, DirectionLaw); 2] = [
    ("constant", DirectionLaw::Constant),
    ("chord", DirectionLaw::Chord),
];
const TWIST_LAWS: [(&str, TwistLaw); 2] = [("transport", TwistLaw::Transport), ("zyz", TwistLaw::Zyz)];
const KINETICS: [(&str, KineticsMode); 3] = [
    ("natural", KineticsMode::Natural),
    ("monotone", KineticsMode::Monotone),
    ("linear", KineticsMode::Linear),
];

/// A clip file before its link names have been looked up in a figure.
#[derive(Debug, Default)]
pub(super) struct ClipText<'t> {
    pub(super) laws: ClipDoc,
    pub(super) keys: Vec<KeyText<'t>>,
}

/// A key of such a file.
#[derive(Debug)]
pub(super) struct KeyText<'t> {
    pub(super) at: usize,
    pub(super) secs: f64,
    pub(super) root: DVec3,
    pub(super) links: Vec<LinkText<'t>>,
}

/// One link of a key; `length` only where it differs from the figure's.
#[derive(Clone, Copy, Debug)]
pub(super) struct LinkText<'t> {
    pub(super) name: &'t str,
    pub(super) at: usize,
    pub(super) direction: DVec3,
    pub(super) twist_rad: f64,
    pub(super) length: Option<f64>,
}

/// Reads a clip file for `figure`. Without a figure everything but the link names is checked.
pub(super) fn read(source: &Source, figure: Option<&Figure>, found: &mut Findings) -> Option<ClipDoc> {
    let table = fields::parse(source, found);
    if !found.errors.is_empty() {
        return None;
    }
    let mut file = Fields::of_file(source, &table);
    let version = super::show_file::version(&mut file, found)?;
    let text = if version == 0 {
        read_0(file, found)
    } else {
        read_1(file, found)
    };
    check_times(source, &text.keys, found);
    let keys = match figure {
        Some(figure) => bind(source, &text.keys, figure, found),
        None => Vec::new(),
    };
    let mut clip = text.laws;
    check_edits(source, &clip, text.keys.len(), found);
    clip.keys = keys;
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
    if let Some(mode) = file.optional("kinetics").and_then(|v| v.choice(&KINETICS, found)) {
        laws.kinetics = mode;
    }
    laws.keep_forward = file
        .optional("keep_forward")
        .and_then(|v| v.boolean(found))
        .unwrap_or(false);
    laws.coefficient_edits = file
        .optional("adjust")
        .map(|v| adjustments(v, found))
        .unwrap_or_default();
    laws.frame_secs = file.optional("frame_secs").and_then(|v| above_zero(v, found));
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
        Some(rows) => clip_rows::read(rows, found),
        None => keys.into_iter().filter_map(|key| read_key(key, found)).collect(),
    };
    text
}

fn too_many(keys: &[Placed<'_>], found: &mut Findings) -> bool {
    let Some(key) = keys.get(KEYS_MAX) else {
        return false;
    };
    found.error(key.fault(format!("{} keys; at most {KEYS_MAX} are read", keys.len())));
    true
}

/// A number above zero.
pub(super) fn above_zero(value: Placed<'_>, found: &mut Findings) -> Option<f64> {
    let number = value.number(found)?;
    if number > 0.0 {
        return Some(number);
    }
    found.error(value.fault(format!("must be above 0, not {number}")));
    None
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
        let length = link.optional("length").and_then(|v| above_zero(v, found));
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

/// Version 0: `fps`, keys at whole `frame` numbers, links as z-y-z angles in degrees.
fn read_0<'t>(mut file: Fields<'t>, found: &mut Findings) -> ClipText<'t> {
    let mut text = ClipText::default();
    let fps = file
        .required("fps", found)
        .and_then(|v| above_zero(v, found))
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
            .filter_map(|key| read_key_0(key, fps, found))
            .collect();
    }
    text
}

fn read_key_0<'t>(key: Placed<'t>, fps: f64, found: &mut Findings) -> Option<KeyText<'t>> {
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

fn check_times(source: &Source, keys: &[KeyText<'_>], found: &mut Findings) {
    for pair in keys.windows(2) {
        if pair[1].secs <= pair[0].secs {
            let message = format!(
                "key at {} s follows one at {} s; times must increase",
                pair[1].secs, pair[0].secs
            );
            found.error(source.error(pair[1].at, message));
        }
    }
}

fn check_edits(source: &Source, clip: &ClipDoc, keys: usize, found: &mut Findings) {
    let coefficients = keys + 2;
    for &(index, _) in &clip.coefficient_edits {
        if index == 0 || index + 1 >= coefficients {
            let message = format!("`adjust` names coefficient {index}; {keys} keys leave 1 to {keys} free");
            found.error(source.error(0, message));
        }
    }
}

/// Looks link names up and puts poses in the figure's order.
fn bind(source: &Source, keys: &[KeyText<'_>], figure: &Figure, found: &mut Findings) -> Vec<Arc<FigureKey>> {
    let places: BTreeMap<&str, usize> = figure
        .links()
        .iter()
        .enumerate()
        .map(|(place, link)| (link.name.as_str(), place))
        .collect();
    let key = |key: &KeyText<'_>| {
        let mut links: Vec<Option<LinkPose>> = vec![None; places.len()];
        for link in &key.links {
            let Some(&place) = places.get(link.name) else {
                let error = source.error(link.at, format!("the figure has no link `{}`", link.name));
                let known: Vec<&str> = figure
                    .links()
                    .iter()
                    .take(40)
                    .map(|link| link.name.as_str())
                    .collect();
                found.error(error.with_hint(format!("it has {}", known.join(", "))));
                continue;
            };
            let length = link.length.unwrap_or(figure.links()[place].length);
            links[place] = Some(LinkPose {
                direction: link.direction,
                twist_rad: link.twist_rad,
                length,
            });
        }
        for (link, pose) in figure.links().iter().zip(&links) {
            if pose.is_none() {
                found.error(source.error(key.at, format!("this key does not place link `{}`", link.name)));
            }
        }
        let links = links.into_iter().collect::<Option<Vec<LinkPose>>>()?;
        Some(Arc::new(FigureKey {
            secs: key.secs,
            pose: FigurePose {
                root: key.root,
                links,
            },
        }))
    };
    keys.iter().filter_map(key).collect()
}

/// The file of a clip: reading it gives the clip back.
pub(super) fn write(clip: &ClipDoc, figure: &Figure) -> String {
    let mut out = String::new();
    line(&mut out, format_args!("version = {VERSION}"));
    line(
        &mut out,
        format_args!("direction = \"{}\"", word(&DIRECTION_LAWS, clip.direction_law)),
    );
    line(
        &mut out,
        format_args!("twist = \"{}\"", word(&TWIST_LAWS, clip.twist_law)),
    );
    line(
        &mut out,
        format_args!("kinetics = \"{}\"", word(&KINETICS, clip.kinetics)),
    );
    if clip.keep_forward {
        line(&mut out, format_args!("keep_forward = true"));
    }
    if !clip.coefficient_edits.is_empty() {
        let pairs: Vec<String> = clip
            .coefficient_edits
            .iter()
            .map(|(i, by)| format!("[{i}, {by:?}]"))
            .collect();
        line(&mut out, format_args!("adjust = [{}]", pairs.join(", ")));
    }
    if let Some(secs) = clip.frame_secs {
        line(&mut out, format_args!("frame_secs = {secs:?}"));
    }
    if clip_rows::suits(clip, figure) {
        clip_rows::write(clip, figure, &mut out);
    } else {
        for key in &clip.keys {
            write_key(key, figure, &mut out);
        }
    }
    out
}

fn write_key(key: &FigureKey, figure: &Figure, out: &mut String) {
    line(out, format_args!("\n[[key]]\nsecs = {:?}", key.secs));
    line(
        out,
        format_args!("root = {}\n\n[key.links]", fields::vector(key.pose.root)),
    );
    for (link, pose) in figure.links().iter().zip(&key.pose.links) {
        let mut more = String::new();
        if pose.twist_rad != 0.0 {
            more.push_str(&format!(", twist = {:?}", degrees(pose.twist_rad)));
        }
        if pose.length != link.length {
            more.push_str(&format!(", length = {:?}", pose.length));
        }
        let name = fields::key(&link.name);
        line(
            out,
            format_args!(
                "{name} = {{ direction = {}{more} }}",
                fields::vector(pose.direction)
            ),
        );
    }
}

/// Degrees, rounded where that is only the noise of the conversion: 90, not 90.00000000000001.
fn degrees(angle_rad: f64) -> f64 {
    let exact = angle_rad.to_degrees();
    let round = (exact * 1e9).round() / 1e9;
    if (round.to_radians() - angle_rad).abs() <= angle_rad.abs() * 4.0 * f64::EPSILON {
        round
    } else {
        exact
    }
}

fn line(out: &mut String, text: std::fmt::Arguments<'_>) {
    // Writing to a string cannot fail.
    let _ = writeln!(out, "{text}");
}

fn word<'w, T: PartialEq>(words: &[(&'w str, T)], value: T) -> &'w str {
    words
        .iter()
        .find(|(_, known)| *known == value)
        .map_or("", |&(word, _)| word)
}
