//! A pen's pressure: across what the tablet tells, upwards what it comes to; where the tip goes down and up.

use egui::{Align2, Painter, Pos2, Rect, Shape, Stroke, pos2, vec2};
use rig::controls_calibration::{Measured, PressureCurve};

use super::super::super::style::{self, ink};
use crate::render::theme::{self, Rgb};

/// Points of a curve.
const SAMPLES: u32 = 96;
/// Counts that stand for the whole of what a tablet tells, in the picture.
const FULL: u32 = 1_000_000;
/// Room below for the three pressures, points.
const BELOW: f32 = 34.0;
/// Room beside for the scale, points.
const BESIDE: f32 = 34.0;

/// What is drawn of it.
pub(super) struct Curve {
    at: Option<f64>,
    most: [Option<f64>; 3],
    holds: PressureCurve,
    proposed: Option<PressureCurve>,
    bright: bool,
}

impl Curve {
    /// What holds, beside something else that is measured.
    pub(super) fn held(holds: PressureCurve) -> Self {
        Self {
            at: None,
            most: [None; 3],
            holds,
            proposed: None,
            bright: false,
        }
    }

    /// The same where nothing is measured.
    pub(super) fn bright(self) -> Self {
        Self { bright: true, ..self }
    }

    /// What is being measured; what a tablet begins with of anything else.
    pub(super) fn measured(of: &Measured) -> Self {
        match of {
            Measured::Pressure {
                at,
                most,
                holds,
                proposed,
            } => Self {
                at: *at,
                most: *most,
                holds: *holds,
                proposed: *proposed,
                bright: true,
            },
            _ => Self::held(PressureCurve::default()),
        }
    }
}

/// Paints it.
pub(super) fn paint(painter: &Painter, area: Rect, curve: &Curve) {
    let rest = style::title(painter, area, "pressure");
    let plot = Rect::from_min_max(
        pos2(rest.left() + BESIDE, rest.top() + theme::GAP),
        pos2(rest.right() - theme::GAP, rest.bottom() - BELOW),
    );
    painter.rect(
        plot,
        0.0,
        ink(theme::GROUND),
        style::hair(theme::EDGE),
        egui::StrokeKind::Outside,
    );
    scale(painter, plot);
    let quiet = curve.proposed.is_some();
    let colour = match (quiet, curve.bright) {
        (true, _) => theme::FAINT,
        (false, true) => theme::TEXT,
        (false, false) => theme::DIM,
    };
    line(painter, plot, curve.holds, colour);
    if let Some(proposed) = curve.proposed {
        line(painter, plot, proposed, theme::SELECTED);
    }
    let shown = curve.proposed.unwrap_or(curve.holds);
    if let Some(at) = curve.at {
        live(painter, plot, shown, at);
    }
    measured(painter, plot, curve);
    tips(painter, plot, shown, curve.bright);
}

fn place(plot: Rect, raw: f64, share: f64) -> Pos2 {
    let (x, y) = (raw.clamp(0.0, 1.0) as f32, share.clamp(0.0, 1.0) as f32);
    pos2(plot.left() + x * plot.width(), plot.bottom() - y * plot.height())
}

fn share(curve: PressureCurve, raw: f64) -> f64 {
    curve.share((raw * f64::from(FULL)).round() as u32, FULL)
}

fn scale(painter: &Painter, plot: Rect) {
    let faint = style::hair(theme::EDGE);
    for quarter in 0..=4_u8 {
        let part = f64::from(quarter) / 4.0;
        let at = place(plot, part, part);
        painter.hline(plot.x_range(), at.y, faint);
        painter.vline(at.x, plot.y_range(), faint);
        if quarter % 2 == 0 {
            let percent = format!("{:.0} %", part * 100.0);
            let text = (percent.as_str(), style::digits(theme::SIZE_SMALL));
            let left = pos2(plot.left() - theme::STEP, at.y);
            style::line(painter, left, Align2::RIGHT_CENTER, text, theme::FAINT, BESIDE);
        }
    }
}

fn line(painter: &Painter, plot: Rect, curve: PressureCurve, colour: Rgb) {
    let points = (0..=SAMPLES).map(|step| {
        let raw = f64::from(step) / f64::from(SAMPLES);
        place(plot, raw, share(curve, raw))
    });
    // Where it begins and ends exactly, however coarse the samples.
    let ends = [(curve.nothing, 0.0), (curve.full, 1.0)].map(|(raw, share)| place(plot, raw, share));
    let mut points: Vec<Pos2> = points.chain(ends).collect();
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(b.y.total_cmp(&a.y)));
    painter.add(Shape::line(points, Stroke::new(2.0, ink(colour))));
}

/// How hard it is pressed now, and what that comes to.
fn live(painter: &Painter, plot: Rect, curve: PressureCurve, raw: f64) {
    let at = place(plot, raw, share(curve, raw));
    let faint = Stroke::new(1.0, ink(theme::LIVE.mix(theme::GROUND, 0.45)));
    painter.line_segment([pos2(at.x, plot.bottom()), at], faint);
    painter.line_segment([pos2(plot.left(), at.y), at], faint);
    painter.circle_filled(at, 4.0, ink(theme::LIVE));
}

/// The most of each of the three pressures, below the plot.
fn measured(painter: &Painter, plot: Rect, curve: &Curve) {
    const NAMES: [&str; 3] = ["hovering", "lightly", "hard"];
    let mut right_of = f32::MIN;
    for (name, most) in NAMES.iter().zip(curve.most) {
        let Some(most) = most else { continue };
        let x = place(plot, most, 0.0).x;
        let top = plot.bottom();
        painter.vline(x, top..=top + 6.0, Stroke::new(2.0, ink(theme::SELECTED)));
        let galley = style::layout(
            painter,
            (name, style::words(theme::SIZE_SMALL)),
            theme::SELECTED,
            80.0,
        );
        // Names of pressures that are near to each other stand side by side.
        let least = plot.left() - BESIDE;
        let left = (x - galley.size().x / 2.0)
            .clamp(least, plot.right() - galley.size().x)
            .max(right_of);
        right_of = left + galley.size().x + theme::STEP;
        painter.galley(pos2(left, top + 9.0).round(), galley, ink(theme::SELECTED));
    }
}

/// Where the tip goes down, and where up again.
fn tips(painter: &Painter, plot: Rect, curve: PressureCurve, bright: bool) {
    let colour = if bright { theme::DIM } else { theme::FAINT };
    let [up, down] = [curve.tip_up, curve.tip_down].map(|raw| place(plot, raw, 1.0));
    let line = Stroke::new(1.0, ink(colour));
    for at in [up, down] {
        painter.extend(Shape::dashed_line(
            &[at, pos2(at.x, plot.bottom())],
            line,
            3.0,
            3.0,
        ));
    }
    let at = down + vec2(theme::STEP, theme::STEP);
    let text = ("tip down, up", style::words(theme::SIZE_SMALL));
    style::line(painter, at, Align2::LEFT_TOP, text, colour, plot.right() - at.x);
}
