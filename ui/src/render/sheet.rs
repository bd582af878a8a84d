//! A contact sheet: key poses and what lies between them, side by side with captions.

use motion::clip::Clip;
use motion::figure::Placed;
use ps300::display::Stroke as Vector;

use super::camera::Camera;
use super::figure::{self, Style};
use super::flat::{Flat, Viewport};
use super::picture::Picture;
use super::raster::Canvas;
use super::scene::{Ink, Layer, Scene};
use super::theme;
use super::timeline::clock_text;
use super::trail;

/// One pose of a sheet.
#[derive(Clone, Debug, PartialEq)]
pub struct Moment {
    /// Animation time.
    pub secs: f64,
    /// Number of the key, from 1, if it is one.
    pub key: Option<usize>,
}

/// Keys at their times with `between` poses evenly spaced in time from each to the next.
pub fn moments(key_secs: &[f64], between: usize) -> Vec<Moment> {
    let mut moments = Vec::new();
    for (index, &secs) in key_secs.iter().enumerate() {
        moments.push(Moment {
            secs,
            key: Some(index + 1),
        });
        let Some(&next) = key_secs.get(index + 1) else {
            break;
        };
        for step in 1..=between {
            let share = step as f64 / (between + 1) as f64;
            moments.push(Moment {
                secs: secs + (next - secs) * share,
                key: None,
            });
        }
    }
    moments
}

/// How a sheet is laid out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layout {
    /// Poses in a row, at least 1.
    pub columns: usize,
    /// Width of one pose, pixels.
    pub cell_width: u32,
    /// Height of one pose, pixels.
    pub cell_height: u32,
    /// In-betweens from each key to the next.
    pub between: usize,
}

impl Layout {
    /// What the caption leaves of a cell.
    fn pose_height(&self) -> u32 {
        self.cell_height.saturating_sub(CAPTION).max(1)
    }
}

impl Default for Layout {
    /// Six poses a row, 1248 pixels wide: two keys with two in-betweens each.
    fn default() -> Self {
        Layout {
            columns: 6,
            cell_width: 208,
            cell_height: 248,
            between: 2,
        }
    }
}

/// Draws the sheet of a clip, seen by `camera`, which is moved so that all poses stand at their cells'
/// middle and none is cut off.
pub fn draw(
    clip: &Clip,
    shapes: &[Vec<Vector>],
    key_secs: &[f64],
    camera: &Camera,
    layout: &Layout,
    title: &str,
) -> Picture {
    let moments = moments(key_secs, layout.between);
    let columns = layout.columns.max(1);
    let rows = moments.len().div_ceil(columns).max(1) as u32;
    let margin = theme::MARGIN as u32;
    let head = theme::SIZE_TITLE as u32 + 2 * margin;
    let width = columns as u32 * layout.cell_width + 2 * margin;
    let height = rows * layout.cell_height + head + margin;
    let mut canvas = Canvas::new(width, height);
    canvas.text(
        title,
        theme::SIZE_TITLE,
        [(2 * margin) as f32, margin as f32],
        theme::TEXT,
    );
    let mut sheet = canvas.finish();
    let poses: Vec<Vec<Placed>> = moments.iter().map(|moment| place(clip, moment.secs)).collect();
    let camera = fitted(camera, &poses, layout);
    for (index, (moment, pose)) in moments.iter().zip(&poses).enumerate() {
        let (column, row) = ((index % columns) as u32, (index / columns) as u32);
        let picture = cell(moment, pose, shapes, &camera, layout);
        sheet.paste(
            &picture,
            margin + column * layout.cell_width,
            head + row * layout.cell_height,
        );
    }
    sheet
}

fn place(clip: &Clip, secs: f64) -> Vec<Placed> {
    let mut placed = Vec::new();
    clip.place(secs, &mut placed);
    placed
}

/// Height of the caption under a pose, pixels.
const CAPTION: u32 = 36;

/// The camera around all poses, each about its own middle.
fn fitted(camera: &Camera, poses: &[Vec<Placed>], layout: &Layout) -> Camera {
    let aspect = f64::from(layout.cell_width) / f64::from(layout.pose_height());
    let unit = Camera {
        half_height: 1.0,
        half_depth: 1.0,
        ..*camera
    };
    let mut need = 1e-3_f64;
    for pose in poses {
        let Some(bounds) = bounds(&unit, pose) else {
            continue;
        };
        let half = (bounds.1 - bounds.0) / 2.0;
        need = need.max(half.y).max(half.x / aspect);
    }
    let half_height = need * 1.1;
    Camera {
        half_height,
        half_depth: half_height * 0.6,
        ..*camera
    }
}

fn bounds(camera: &Camera, pose: &[Placed]) -> Option<(glam::DVec3, glam::DVec3)> {
    let points = pose
        .iter()
        .flat_map(|link| [link.start, link.end])
        .map(|p| camera.project(p));
    points.fold(None, |bounds, p| match bounds {
        None => Some((p, p)),
        Some((low, high)) => Some((low.min(p), high.max(p))),
    })
}

fn cell(
    moment: &Moment,
    pose: &[Placed],
    shapes: &[Vec<Vector>],
    camera: &Camera,
    layout: &Layout,
) -> Picture {
    let mut camera = *camera;
    let unit = Camera {
        half_height: 1.0,
        half_depth: 1.0,
        centre: glam::DVec3::ZERO,
        ..camera
    };
    if let Some((low, high)) = bounds(&unit, pose) {
        camera.centre = camera.view_from_world.transpose() * low.midpoint(high);
    }
    let mut scene = Scene::new(camera);
    if let Some(floor) = trail::lowest(pose.iter()) {
        let ink = Ink::new(theme::FAINT, Layer::Ground).faded(0.6).flat();
        let reach = camera.view_from_world.transpose().x_axis * camera.half_height * 0.55;
        let feet = glam::DVec3::new(camera.centre.x, floor, camera.centre.z);
        scene.stroke(feet - reach, feet + reach, theme::WIDTH_GRID, ink);
    }
    let mut style = Style::present(None);
    if moment.key.is_none() {
        style.ink = style.ink.faded(0.8);
        style.width = theme::WIDTH_GHOST * 1.5;
    }
    figure::add(&mut scene, pose, shapes, style);
    let (width, height) = (layout.cell_width, layout.cell_height);
    let mut canvas = Canvas::new(width, height);
    canvas.paint(&Flat::new(
        &scene,
        &Viewport::of_size(width, layout.pose_height()),
    ));
    caption(&mut canvas, moment, width as f32, height as f32);
    canvas.finish()
}

fn caption(canvas: &mut Canvas, moment: &Moment, width: f32, height: f32) {
    let time = format!("{} s", clock_text(moment.secs));
    let text = moment
        .key
        .map_or(time.clone(), |key| format!("key {key}  {time}"));
    let (colour, mark) = match moment.key {
        Some(_) => (theme::TEXT, 5.0),
        None => (theme::DIM, 0.0),
    };
    let text_width = canvas.text_width(&text, theme::SIZE_BODY);
    let room = if mark > 0.0 { 2.0 * mark + theme::GAP } else { 0.0 };
    let left = ((width - text_width - room) / 2.0).round();
    let top = height - theme::SIZE_BODY - theme::MARGIN;
    if mark > 0.0 {
        canvas.diamond(
            [left + mark, (top + theme::SIZE_BODY / 2.0).round()],
            mark,
            theme::TEXT,
        );
    }
    canvas.text(&text, theme::SIZE_BODY, [left + room, top], colour);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn in_betweens_lie_between() {
        let all = moments(&[0.0, 0.3, 0.9], 2);
        let secs: Vec<f64> = all.iter().map(|m| m.secs).collect();
        assert_eq!(all.len(), 7);
        assert_eq!(all[3].key, Some(2));
        assert!(secs.windows(2).all(|pair| pair[0] < pair[1]));
        assert!((secs[1] - 0.1).abs() < 1e-12);
        assert!(moments(&[], 2).is_empty());
    }
}
