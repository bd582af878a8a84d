//! One frame of a film: the front view large, the side view narrow, time beneath with its keys.

use rig::Snapshot;

use super::flat::{Flat, Viewport};
use super::picture::Picture;
use super::raster::Canvas;
use super::scene::Scene;
use super::stage::{self, Look};
use super::theme::{self, Rgb};
use super::timeline::{Timeline, clock_text};

/// Height at which a film has one pixel per point.
const HEIGHT_OF_ONE: f32 = 480.0;

/// Draws the rig as it stands.
pub fn draw(seen: &Snapshot, look: &Look, width: u32, height: u32) -> Picture {
    let canvas = Canvas::new(width, height);
    let mut picture = canvas.finish();
    let scale = (picture.height as f32 / HEIGHT_OF_ONE).max(0.5);
    let strip = ((44.0 * scale) as u32).min(picture.height / 3);
    let upper = picture.height - strip;
    let front_width = picture.width * 7 / 10;
    let front = stage::scene(seen, look);
    picture.paste(&view(&front, front_width, upper, scale, "front"), 0, 0);
    picture.paste(
        &view(&front.side(), picture.width - front_width, upper, scale, "side"),
        front_width,
        0,
    );
    picture.paste(&time_strip(seen, picture.width, strip, scale), 0, upper);
    picture
}

fn view(scene: &Scene, width: u32, height: u32, scale: f32, name: &str) -> Picture {
    let mut canvas = Canvas::new(width, height);
    canvas.paint(&Flat::new(scene, &Viewport::of_size(width, height).scaled(scale)));
    let margin = theme::MARGIN * scale;
    canvas.text(name, theme::SIZE_SMALL * scale, [margin, margin], theme::DIM);
    if name == "side" {
        canvas.rectangle([0.0, 0.0], [scale.max(1.0).round(), height as f32], theme::EDGE);
    }
    canvas.finish()
}

pub(super) fn time_strip(seen: &Snapshot, width: u32, height: u32, scale: f32) -> Picture {
    let mut canvas = Canvas::new(width, height);
    let (wide, high) = (width as f32, height as f32);
    canvas.rectangle([0.0, 0.0], [wide, high], theme::PANEL);
    canvas.rectangle([0.0, 0.0], [wide, scale.max(1.0).round()], theme::EDGE);
    let size = theme::SIZE_BODY * scale;
    let text = format!("{} s", clock_text(seen.transport.secs));
    let text_y = ((high - size) / 2.0).round();
    canvas.text(&text, size, [theme::MARGIN * scale, text_y], theme::TEXT);
    let left = theme::MARGIN * scale * 2.0 + canvas.text_width("00:00.00 s", size);
    let line = Timeline::new(
        seen.transport.start_secs,
        seen.transport.end_secs,
        left,
        wide - theme::MARGIN * scale * 2.0,
    );
    let middle = (high / 2.0).round();
    let thick = (2.0 * scale).max(1.0);
    let now = line.x(seen.transport.secs.clamp(line.start_secs, line.end_secs));
    canvas.line([line.left, middle], [line.right, middle], thick, theme::EDGE);
    canvas.line(
        [line.left, middle],
        [now, middle],
        thick,
        theme::LIVE.mix(theme::PANEL, 0.35),
    );
    for key in &seen.keys {
        let passed = key.secs <= seen.transport.secs + 1e-9;
        let colour: Rgb = if passed { theme::TEXT } else { theme::FAINT };
        canvas.diamond([line.x(key.secs), middle], 5.0 * scale, colour);
    }
    canvas.rectangle(
        [now - scale, 8.0 * scale],
        [2.0 * scale, high - 16.0 * scale],
        theme::LIVE,
    );
    canvas.finish()
}
