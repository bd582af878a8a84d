//! A fader, knob or axis: its counts from end to end, how far it was moved, where it rested.

use egui::{Align2, Painter, Rect, Stroke, pos2, vec2};
use rig::controls_calibration::{AxisCalibration, Measured};

use super::super::super::style::{self, ink};
use crate::render::theme::{self, Rgb};

/// Height of the track, points.
const TRACK: f32 = 40.0;
/// The number of where it is, so far above the track, points.
const READOUT: f32 = 68.0;
/// Width of the cap, points.
const CAP: f32 = 12.0;

/// Paints it.
pub(super) fn paint(painter: &Painter, area: Rect, measured: &Measured) {
    let Measured::Travel {
        range,
        at,
        seen,
        rests,
        holds,
        proposed,
    } = measured
    else {
        return;
    };
    let rest = style::title(painter, area, "counts");
    let track = Rect::from_center_size(rest.center(), vec2(rest.width() - 72.0, TRACK));
    let counts = Counts::of(track, *range, *seen, holds.ends);
    painter.rect(
        track,
        3.0,
        ink(theme::GROUND),
        style::hair(theme::FAINT),
        egui::StrokeKind::Outside,
    );
    scale(painter, &counts);
    if let Some([low, high]) = seen {
        let span = Rect::from_x_y_ranges(counts.x(*low)..=counts.x(*high), track.y_range());
        painter.rect_filled(span, 0.0, ink(theme::LIVE.mix(theme::GROUND, 0.72)));
    }
    let colour = if proposed.is_some() {
        theme::DIM
    } else {
        theme::TEXT
    };
    ends(painter, &counts, *holds, ("holds", colour, false));
    if let Some(proposed) = proposed {
        ends(painter, &counts, *proposed, ("measured", theme::SELECTED, true));
    }
    if let Some(at) = at {
        let cap = Rect::from_center_size(pos2(counts.x(*at), track.center().y), vec2(CAP, TRACK + 14.0));
        painter.rect_filled(cap, style::round(), ink(theme::LIVE));
        let said = at.to_string();
        let text = (said.as_str(), style::digits(theme::SIZE_READOUT));
        let above = pos2(cap.center().x, track.top() - READOUT);
        let above = pos2(above.x.clamp(area.left() + 40.0, area.right() - 40.0), above.y);
        style::line(painter, above, Align2::CENTER_CENTER, text, theme::LIVE, 120.0);
    }
    for rest in rests {
        painter.circle_filled(pos2(counts.x(*rest), track.center().y), 4.0, ink(theme::SELECTED));
    }
}

/// Where counts are on the screen: the profile's range, and whatever lies beyond it.
struct Counts {
    track: Rect,
    low: f32,
    high: f32,
}

impl Counts {
    fn of(track: Rect, range: [i32; 2], seen: Option<[i32; 2]>, holds: [i32; 2]) -> Self {
        let all = range.into_iter().chain(holds).chain(seen.into_iter().flatten());
        let (low, high) = all.fold((i32::MAX, i32::MIN), |(low, high), it| {
            (low.min(it), high.max(it))
        });
        Self {
            track,
            low: low as f32,
            high: (high as f32).max(low as f32 + 1.0),
        }
    }

    fn x(&self, counts: i32) -> f32 {
        let share = (counts as f32 - self.low) / (self.high - self.low);
        self.track.left() + share.clamp(0.0, 1.0) * self.track.width()
    }
}

fn scale(painter: &Painter, counts: &Counts) {
    for tenth in 1..10_u8 {
        let x = counts.track.left() + counts.track.width() * f32::from(tenth) / 10.0;
        let line = style::hair(theme::EDGE);
        painter.vline(x.round(), counts.track.y_range(), line);
    }
}

/// Ends as brackets, above what was measured, below what holds; the rest with its quiet middle between them.
fn ends(painter: &Painter, counts: &Counts, axis: AxisCalibration, (name, colour, above): (&str, Rgb, bool)) {
    let (inner, outer) = if above {
        (counts.track.top(), counts.track.top() - 26.0)
    } else {
        (counts.track.bottom(), counts.track.bottom() + 26.0)
    };
    let line = Stroke::new(2.0, ink(colour));
    let beyond = if above { -9.0 } else { 9.0 };
    for end in axis.ends {
        let x = counts.x(end);
        painter.line_segment([pos2(x, inner), pos2(x, outer)], line);
        let said = end.to_string();
        let text = (said.as_str(), style::digits(theme::SIZE_BODY));
        style::line(
            painter,
            pos2(x, outer + beyond),
            Align2::CENTER_CENTER,
            text,
            colour,
            90.0,
        );
    }
    let middle = pos2(counts.track.center().x, outer);
    let Some(rest) = axis.rest else {
        let text = (name, style::words(theme::SIZE_SMALL));
        style::line(painter, middle, Align2::CENTER_CENTER, text, colour, 120.0);
        return;
    };
    let dead = [
        rest.saturating_sub(axis.dead_counts),
        rest.saturating_add(axis.dead_counts),
    ];
    let [low, high] = dead.map(|counts_at| counts.x(counts_at));
    painter.rect_filled(
        Rect::from_x_y_ranges(low..=high, counts.track.y_range()),
        0.0,
        ink(colour.mix(theme::GROUND, 0.7)),
    );
    let x = counts.x(rest);
    painter.line_segment([pos2(x, inner), pos2(x, outer)], line);
    let said = format!("{rest} \u{b1} {}", axis.dead_counts);
    let text = (said.as_str(), style::digits(theme::SIZE_BODY));
    let at = pos2(x, outer + beyond);
    style::line(painter, at, Align2::CENTER_CENTER, text, colour, 120.0);
}
