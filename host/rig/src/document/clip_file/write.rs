//! Writing: the same form that is read, exact to the last bit but for the row form's angles.

use std::fmt::Write as _;

use motion::{Figure, FigureKey};

use super::{DIRECTION_LAWS, KINETICS, TWIST_LAWS, VERSION, rows};
use crate::document::clip::ClipDoc;
use crate::document::fields;

/// The file of a clip: reading it gives the clip back.
pub(in crate::document) fn write(clip: &ClipDoc, figure: &Figure) -> String {
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
    write_timing(clip, &mut out);
    if let Some(secs) = clip.frame_secs {
        line(&mut out, format_args!("frame_secs = {secs:?}"));
    }
    if rows::suits(clip, figure) {
        rows::write(clip, figure, &mut out);
    } else {
        for key in &clip.keys {
            write_key(key, figure, &mut out);
        }
    }
    out
}

/// What clips of every kind say about time.
pub(super) fn write_timing<K>(clip: &ClipDoc<K>, out: &mut String) {
    line(
        out,
        format_args!("kinetics = \"{}\"", word(&KINETICS, clip.kinetics)),
    );
    if clip.keep_forward {
        line(out, format_args!("keep_forward = true"));
    }
    if !clip.coefficient_edits.is_empty() {
        let pairs: Vec<String> = clip
            .coefficient_edits
            .iter()
            .map(|(i, by)| format!("[{i}, {by:?}]"))
            .collect();
        line(out, format_args!("adjust = [{}]", pairs.join(", ")));
    }
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
            more = format!(", twist = {:?}", degrees(pose.twist_rad));
        }
        if pose.length != link.length {
            let _ = write!(more, ", length = {:?}", pose.length);
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
pub(super) fn degrees(angle_rad: f64) -> f64 {
    let exact = angle_rad.to_degrees();
    let round = (exact * 1e9).round() / 1e9;
    if (round.to_radians() - angle_rad).abs() <= angle_rad.abs() * 4.0 * f64::EPSILON {
        round
    } else {
        exact
    }
}

pub(super) fn line(out: &mut String, text: std::fmt::Arguments<'_>) {
    // Writing to a string cannot fail.
    let _ = writeln!(out, "{text}");
}

fn word<'w, T: PartialEq + Copy>(words: &[(&'w str, T)], value: T) -> &'w str {
    words
        .iter()
        .find(|(_, known)| *known == value)
        .map_or("", |&(word, _)| word)
}
