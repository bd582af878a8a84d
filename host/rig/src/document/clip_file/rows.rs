//! The row form of clip files: one line of numbers a key, for clips made by recording.
//!
//! Apart because it trades readability for size: a row holds `secs x y z` of the root and then α β γ of
//! each link in degrees (see [`zyz`]), rounded to 1e-7 degrees. That moves the end of a link by
//! less than two billionths of its length.

use std::fmt::Write as _;

use glam::DVec3;
use motion::Figure;

use super::{KeyText, LinkText};
use crate::document::clip::ClipDoc;
use crate::document::fault::Findings;
use crate::document::fields::{Placed, quoted};
use crate::document::limits::KEYS_MAX;
use crate::document::source::{finite, words};
use crate::document::zyz;

/// Clips with more keys than this are written in rows: nobody keys so many poses by hand.
const KEYS_BY_HAND_MAX: usize = 200;

/// Rows start on the line after this opening.
const OPENING: &str = "rows = '''\n";

/// Whether the row form holds all there is to say: it has no lengths.
pub(super) fn suits(clip: &ClipDoc, figure: &Figure) -> bool {
    let rests = |key: &std::sync::Arc<motion::FigureKey>| {
        key.pose
            .links
            .iter()
            .zip(figure.links())
            .all(|(pose, link)| pose.length == link.length)
    };
    clip.keys.len() > KEYS_BY_HAND_MAX && clip.keys.iter().all(rests)
}

/// Appends the `[frames]` table.
pub(super) fn write(clip: &ClipDoc, figure: &Figure, out: &mut String) {
    let names: Vec<String> = figure.links().iter().map(|link| quoted(&link.name)).collect();
    out.push_str("\n[frames]\n");
    // Writing to a string cannot fail.
    let _ = writeln!(out, "links = [{}]", names.join(", "));
    out.push_str(OPENING);
    for key in &clip.keys {
        let root = key.pose.root;
        let _ = write!(out, "{} {} {} {}", key.secs, root.x, root.y, root.z);
        for link in &key.pose.links {
            push_link(link.direction, link.twist_rad, out);
        }
        out.push('\n');
    }
    out.push_str("'''\n");
}

fn push_link(direction: DVec3, twist_rad: f64, out: &mut String) {
    let (alpha, beta) = zyz::angles_of(direction);
    let [alpha, beta, gamma] = [alpha, beta, twist_rad].map(|angle| rounded(angle.to_degrees()));
    // A tilt that rounds to a pole loses the azimuth; the twist takes it over.
    let [alpha, gamma] = match beta {
        0.0 => [0.0, rounded((twist_rad + alpha.to_radians()).to_degrees())],
        180.0 => [0.0, rounded((twist_rad - alpha.to_radians()).to_degrees())],
        _ => [alpha, gamma],
    };
    let _ = write!(out, " {alpha} {beta} {gamma}");
}

/// To seven decimals; never −0.
fn rounded(degrees: f64) -> f64 {
    (degrees * 1e7).round() / 1e7 + 0.0
}

/// Reads the `[frames]` table.
pub(super) fn read<'t>(frames: Placed<'t>, found: &mut Findings) -> Vec<KeyText<'t>> {
    let Some(mut table) = frames.fields(found) else {
        return Vec::new();
    };
    let links = table.required("links", found).and_then(|v| v.texts(found));
    let rows = table.required("rows", found);
    table.finish(found);
    let (Some(links), Some(rows)) = (links, rows) else {
        return Vec::new();
    };
    let Some(text) = rows.text(found) else {
        return Vec::new();
    };
    report_doubles(&links, found);
    let names: Vec<(&str, usize)> = links.iter().map(|(name, value)| (*name, value.at)).collect();
    let (first_line, _) = rows.source.line_column(rows.at);
    let mut keys = Vec::new();
    for (index, line) in text
        .lines()
        .enumerate()
        .filter(|(_, line)| !line.trim().is_empty())
    {
        // The opening quotes take the first line, as written above; TOML drops the line end after them.
        let line_number = first_line + 1 + index as u32;
        if keys.len() == KEYS_MAX {
            found.error(
                rows.source
                    .error_at((line_number, 1), format!("more than {KEYS_MAX} rows")),
            );
            break;
        }
        keys.extend(read_row(line, line_number, &names, rows, found));
    }
    keys
}

fn report_doubles(links: &[(&str, Placed<'_>)], found: &mut Findings) {
    let mut seen = std::collections::BTreeSet::new();
    for (name, value) in links {
        if !seen.insert(name) {
            found.error(value.fault(format!("link `{name}` is named twice")));
        }
    }
}

fn read_row<'t>(
    line: &str,
    line_number: u32,
    names: &[(&'t str, usize)],
    rows: Placed<'t>,
    found: &mut Findings,
) -> Option<KeyText<'t>> {
    let mut numbers = Vec::with_capacity(4 + 3 * names.len());
    for (column, word) in words(line) {
        match finite(word) {
            Ok(number) => numbers.push(number),
            Err(message) => {
                found.error(rows.source.error_at((line_number, column), message));
                return None;
            }
        }
    }
    let expected = 4 + 3 * names.len();
    if numbers.len() != expected {
        let message = format!(
            "expected {expected} numbers (secs, root, 3 a link), found {}",
            numbers.len()
        );
        found.error(rows.source.error_at((line_number, 1), message));
        return None;
    }
    let link = |(&(name, at), angles): (&(&'t str, usize), &[f64])| {
        let (direction, twist_rad) = zyz::link_from_angles([
            angles[0].to_radians(),
            angles[1].to_radians(),
            angles[2].to_radians(),
        ]);
        LinkText {
            name,
            at,
            direction,
            twist_rad,
            length: None,
        }
    };
    Some(KeyText {
        at: rows.source.offset_of_line(line_number),
        secs: numbers[0],
        root: DVec3::new(numbers[1], numbers[2], numbers[3]),
        links: names.iter().zip(numbers[4..].chunks_exact(3)).map(link).collect(),
    })
}
