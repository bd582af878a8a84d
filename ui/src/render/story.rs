//! One frame of the demo's film: hands below, figure above, puppet beside it, and a line that says what happens.
//!
//! The desk is drawn as the network sees it (labels, turns, lamps), the puppet as it was measured: nothing here is
//! drawn from what was intended.

use std::f32::consts::TAU;

use rig::{DeskView, PuppetState, Snapshot};

use super::flat::{Flat, Viewport};
use super::frame;
use super::picture::Picture;
use super::puppet;
use super::raster::Canvas;
use super::scene::Scene;
use super::stage::{self, Look};
use super::theme::{self, Rgb};

/// Height at which a frame has one pixel per point.
const HEIGHT_OF_ONE: f32 = 480.0;
/// Heights of the strips, points.
const CAPTION: f32 = 30.0;
const TIME: f32 = 34.0;
const DESK: f32 = 62.0;
/// Share of the width that figure (front), figure (side) and puppet take.
const SHARES: [f32; 3] = [0.52, 0.2, 0.28];

/// Draws the rig as it stands, with a caption.
pub fn draw(seen: &Snapshot, look: &Look, caption: &str, width: u32, height: u32) -> Picture {
    let mut picture = Canvas::new(width, height).finish();
    let scale = (picture.height as f32 / HEIGHT_OF_ONE).max(0.5);
    let points = |points: f32| (points * scale).round() as u32;
    let middle = picture
        .height
        .saturating_sub(points(CAPTION) + points(TIME) + points(DESK))
        .max(1);
    let widths = SHARES.map(|share| (picture.width as f32 * share).round() as u32);
    let scene = stage::scene(seen, look);
    let aspect = f64::from(widths[2].max(1)) / f64::from(middle);
    let mut x = 0;
    let views = [
        (scene.clone(), "figure"),
        (scene.side(), "side"),
        (
            puppet::scene(seen.puppet.as_ref(), None, aspect),
            "puppet, measured",
        ),
    ];
    for ((scene, name), width) in views.into_iter().zip(widths) {
        let width = width.min(picture.width - x);
        picture.paste(
            &view(&scene, width, middle, scale, name, x > 0),
            x,
            points(CAPTION),
        );
        x += width;
    }
    picture.paste(
        &caption_strip(seen, caption, picture.width, points(CAPTION), scale),
        0,
        0,
    );
    let below = points(CAPTION) + middle;
    picture.paste(
        &frame::time_strip(seen, picture.width, points(TIME), scale),
        0,
        below,
    );
    let rest = picture.height - below - points(TIME);
    picture.paste(
        &desk_strip(&seen.desk, picture.width, rest, scale),
        0,
        below + points(TIME),
    );
    picture
}

fn view(scene: &Scene, width: u32, height: u32, scale: f32, name: &str, beside: bool) -> Picture {
    let mut canvas = Canvas::new(width, height);
    canvas.paint(&Flat::new(scene, &Viewport::of_size(width, height).scaled(scale)));
    let margin = theme::MARGIN * scale;
    canvas.text(name, theme::SIZE_SMALL * scale, [margin, margin], theme::DIM);
    if beside {
        canvas.rectangle([0.0, 0.0], [scale.max(1.0).round(), height as f32], theme::EDGE);
    }
    canvas.finish()
}

fn caption_strip(seen: &Snapshot, caption: &str, width: u32, height: u32, scale: f32) -> Picture {
    let mut canvas = Canvas::new(width, height);
    let (wide, high) = (width as f32, height as f32);
    canvas.rectangle([0.0, 0.0], [wide, high], theme::PANEL);
    canvas.rectangle(
        [0.0, high - scale.max(1.0).round()],
        [wide, scale.max(1.0).round()],
        theme::EDGE,
    );
    let size = theme::SIZE_BODY * scale;
    let y = ((high - size) / 2.0).round();
    canvas.text(caption, size, [theme::MARGIN * scale, y], theme::TEXT);
    if let Some(puppet) = &seen.puppet {
        let (word, colour) = state(puppet.state);
        let text = format!("puppet {word}");
        let x = wide - theme::MARGIN * scale - canvas.text_width(&text, size);
        canvas.text(&text, size, [x, y], colour);
    }
    canvas.finish()
}

fn state(state: PuppetState) -> (&'static str, Rgb) {
    match state {
        PuppetState::Released => ("released", theme::DIM),
        PuppetState::Arming => ("arming", theme::TEXT),
        PuppetState::Holding => ("holding", theme::TEXT),
        PuppetState::Playing => ("playing", theme::LIVE),
        PuppetState::Faulted => ("faulted", theme::FAULTED),
    }
}

/// Dials with their pointers and labels, keys with theirs.
fn desk_strip(desk: &DeskView, width: u32, height: u32, scale: f32) -> Picture {
    let mut canvas = Canvas::new(width, height);
    let (wide, high) = (width as f32, height as f32);
    canvas.rectangle([0.0, 0.0], [wide, high], theme::PANEL);
    let size = theme::SIZE_SMALL * scale;
    let pitch = wide * 0.5 / 8.0;
    for (index, dial) in desk.dials.iter().enumerate() {
        let colour = if dial.live { theme::LIVE } else { theme::DIM };
        let x = (index as f32 + 0.5) * pitch;
        label(
            &mut canvas,
            &dial.label,
            size * 0.9,
            [x, high * 0.1],
            if dial.live { theme::LIVE } else { theme::TEXT },
        );
        knob(
            &mut canvas,
            [x, high * 0.66],
            high * 0.24,
            dial.turns as f32,
            scale,
            colour,
        );
    }
    let (left, pitch) = (wide * 0.52, wide * 0.48 / 6.0);
    for (index, key) in desk.keys.iter().enumerate() {
        let x = left + (index % 6) as f32 * pitch;
        let y = high * if index < 6 { 0.1 } else { 0.54 };
        let ground = if key.down {
            theme::LIVE.mix(theme::PANEL, 0.4)
        } else {
            theme::RAISED
        };
        canvas.rectangle([x, y], [pitch - 4.0 * scale, high * 0.36], ground);
        let colour = if key.down || key.lit {
            theme::TEXT
        } else {
            theme::DIM
        };
        label(
            &mut canvas,
            &key.label,
            size * 0.9,
            [x + (pitch - 4.0 * scale) / 2.0, y + high * 0.08],
            colour,
        );
    }
    canvas.finish()
}

/// Text with its middle at `x`.
fn label(canvas: &mut Canvas, text: &str, size: f32, [x, y]: [f32; 2], colour: Rgb) {
    let half = canvas.text_width(text, size) / 2.0;
    canvas.text(text, size, [(x - half).round(), y.round()], colour);
}

fn knob(canvas: &mut Canvas, [x, y]: [f32; 2], radius: f32, turns: f32, scale: f32, colour: Rgb) {
    let at = |share: f32, reach: f32| {
        let angle = share * TAU;
        [x + radius * reach * angle.sin(), y - radius * reach * angle.cos()]
    };
    let ring: Vec<[f32; 2]> = (0..=24).map(|i| at(i as f32 / 24.0, 1.0)).collect();
    canvas.polyline(&ring, 1.2 * scale, colour);
    canvas.line(at(turns, 0.25), at(turns, 0.9), 2.0 * scale, colour);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_empty_rig_makes_a_frame_of_the_size_asked_for() {
        let picture = draw(&Snapshot::default(), &Look::film(), "nothing yet", 640, 400);
        assert_eq!([picture.width, picture.height], [640, 400]);
        assert_eq!(picture.rgba.len(), 640 * 400 * 4);
    }
}
