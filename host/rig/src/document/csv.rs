//! Where every link is at every frame, as a table for other programs. Columns: `docs/formats.md`.

use std::fmt::Write as _;

use motion::figure::zyz_from_matrix;

use super::frames::{ExportError, Frames};
use super::show::Show;

/// First line of the file.
const HEADER: &str = "t_secs,link,start_x,start_y,start_z,end_x,end_y,end_z,alpha_deg,beta_deg,gamma_deg\n";

/// The clip being edited, one row a frame and link, links in the figure's order.
pub fn export(show: &Show) -> Result<String, ExportError> {
    let frames = Frames::of(show)?;
    let figure = &frames.figure.figure;
    let names: Vec<String> = figure.links().iter().map(|link| cell(&link.name)).collect();
    let mut out = String::from(HEADER);
    let mut placed = Vec::new();
    frames.each(|secs, pose| {
        figure.place(pose, &mut placed);
        for (name, placed) in names.iter().zip(&placed) {
            let angles = zyz_from_matrix(&placed.world_from_link);
            // Writing to a string cannot fail.
            let _ = write!(out, "{},{name}", number(secs));
            let angles = [angles.azimuth_rad, angles.polar_rad, angles.twist_rad].map(f64::to_degrees);
            for value in placed
                .start
                .to_array()
                .into_iter()
                .chain(placed.end.to_array())
                .chain(angles)
            {
                let _ = write!(out, ",{}", number(value));
            }
            out.push('\n');
        }
    });
    Ok(out)
}

/// To nine decimals, which hides the noise of rotations; never −0. Large numbers have no such decimals.
fn number(value: f64) -> f64 {
    if value.abs() > 1e6 {
        value
    } else {
        (value * 1e9).round() / 1e9 + 0.0
    }
}

/// A name as a CSV cell (RFC 4180).
fn cell(name: &str) -> String {
    if name.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", name.replace('"', "\"\""))
    } else {
        name.to_owned()
    }
}
