//! The kinetic curve over the keys: across it is time, upwards the key that is reached. Steep is fast, flat
//! is a rest; what goes down runs backwards. Its coefficients are dragged up and down; the path never moves.

use egui::accesskit::Role;
use egui::{Align2, Pos2, Rect, Sense, Stroke, Ui, pos2};
use rig::{Command, EditCommand, Snapshot};

use super::Commands;
use super::button;
use super::style::{self, ink};
use crate::render::theme;
use crate::render::timeline::Timeline;

/// The curve above the keys.
#[derive(Default)]
pub struct Curve;

/// Room above the last and below the first key, so that overshoot is seen, in shares of the height.
const ROOM: f32 = 0.14;

/// From key coordinates to heights.
struct Scale {
    area: Rect,
    keys: f64,
}

impl Scale {
    fn y(&self, u: f64) -> f32 {
        let room = self.area.height() * ROOM;
        let span = self.area.height() - 2.0 * room;
        self.area.bottom() - room - span * (u / self.keys) as f32
    }

    /// Keys for points downwards.
    fn keys_per_point(&self) -> f64 {
        -self.keys / f64::from(self.area.height() * (1.0 - 2.0 * ROOM))
    }
}

impl Curve {
    /// Draws the curve, takes hold of coefficients.
    pub fn show(
        &mut self,
        ui: &Ui,
        area: Rect,
        line: &Timeline,
        seen: &Snapshot,
        commands: &mut Commands<'_>,
    ) {
        let painter = ui.painter().with_clip_rect(area);
        let label = ("kinetics", style::words(theme::SIZE_SMALL));
        // Where the curve never is: it ends in the upper corner, and time begins on the left.
        let corner = area.right_bottom() - egui::vec2(theme::GAP, 2.0);
        if seen.kinetics.curve.len() < 2 {
            style::line(
                &painter,
                corner,
                Align2::RIGHT_BOTTOM,
                label,
                theme::FAINT,
                area.width(),
            );
            let text = ("Two keys make a motion", style::words(theme::SIZE_BODY));
            style::line(
                &painter,
                area.center(),
                Align2::CENTER_CENTER,
                text,
                theme::DIM,
                area.width(),
            );
            return;
        }
        let last = seen.keys.len().saturating_sub(1).max(1) as f64;
        let scale = Scale { area, keys: last };
        for &[from, to] in &seen.kinetics.reversals {
            let band = Rect::from_x_y_ranges(line.x(from)..=line.x(to), area.y_range());
            painter.rect_filled(band, 0.0, ink(theme::EDGE));
            let text = ("backwards", style::words(theme::SIZE_SMALL));
            let at = pos2(band.center().x, area.top() + theme::STEP);
            if band.width() > 64.0 {
                style::line(&painter, at, Align2::CENTER_TOP, text, theme::DIM, band.width());
            }
        }
        for key in 0..=last as usize {
            let y = scale.y(key as f64).round();
            painter.hline(area.x_range(), y, style::hair(theme::PANEL.mix(theme::EDGE, 0.6)));
        }
        let points: Vec<Pos2> = seen
            .kinetics
            .curve
            .iter()
            .map(|&[t, u]| pos2(line.x(t), scale.y(u)))
            .collect();
        painter.line(points, Stroke::new(1.6, ink(theme::TEXT)));
        style::line(&painter, corner, Align2::RIGHT_BOTTOM, label, theme::FAINT, 80.0);
        if let Some(u) = at_time(&seen.kinetics.curve, seen.transport.secs) {
            painter.circle_filled(
                pos2(line.x(seen.transport.secs), scale.y(u)),
                3.5,
                ink(theme::LIVE),
            );
        }
        coefficients(ui, &scale, line, seen, commands);
    }
}

/// The curve's height at a time, between its samples.
fn at_time(curve: &[[f64; 2]], secs: f64) -> Option<f64> {
    let after = curve.partition_point(|p| p[0] < secs);
    let (a, b) = (
        curve.get(after.checked_sub(1).unwrap_or(after))?,
        curve.get(after).or(curve.last())?,
    );
    let share = if b[0] > a[0] {
        ((secs - a[0]) / (b[0] - a[0])).clamp(0.0, 1.0)
    } else {
        0.0
    };
    Some(a[1] + (b[1] - a[1]) * share)
}

fn coefficients(ui: &Ui, scale: &Scale, line: &Timeline, seen: &Snapshot, commands: &mut Commands<'_>) {
    let count = seen.kinetics.coefficients.len();
    let chosen = seen.kinetics.selected.or(commands.choices.coefficient);
    // The first and the last are pinned: they are the first and the last key.
    for index in 1..count.saturating_sub(1) {
        let [secs, u] = seen.kinetics.coefficients[index];
        let at = pos2(
            line.x(secs),
            scale
                .y(u)
                .clamp(scale.area.top() + 4.0, scale.area.bottom() - 4.0),
        );
        let rect = Rect::from_center_size(at, egui::vec2(12.0, 12.0));
        let name = format!("coefficient {index}");
        let response = button::spot(
            ui,
            rect,
            ui.scope_id().with(("coefficient", index)),
            Sense::click_and_drag(),
            (Role::Slider, &name),
        );
        let colour = if chosen == Some(index) {
            theme::SELECTED
        } else {
            theme::DIM
        };
        let fill = if response.hovered() || response.dragged() {
            colour
        } else {
            theme::GROUND
        };
        let square = Rect::from_center_size(at.round(), egui::vec2(6.0, 6.0));
        ui.painter().rect(
            square,
            0.0,
            ink(fill),
            Stroke::new(1.2, ink(colour)),
            egui::StrokeKind::Middle,
        );
        if response.dragged() || response.clicked() {
            commands.choices.coefficient = Some(index);
        }
        let by = f64::from(response.drag_delta().y) * scale.keys_per_point();
        if response.dragged() && by != 0.0 {
            commands.push(Command::Edit(EditCommand::Kinetics {
                coefficient: index,
                by,
            }));
        }
        button::focus_ring(ui, &response);
        let tip = "Drag up to be there earlier, down to be there later. The path stays.";
        button::tooltip(response, tip, "Alt-Left, Alt-Right choose; Alt-Up, Alt-Down move");
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn between_samples_lies_between() {
        let curve = [[0.0, 0.0], [1.0, 2.0], [2.0, 2.0]];
        for (secs, want) in [(-1.0, 0.0), (0.5, 1.0), (1.0, 2.0), (9.0, 2.0)] {
            assert_eq!(at_time(&curve, secs), Some(want), "{secs}");
        }
        assert_eq!(at_time(&[], 0.0), None);
    }

    #[test]
    fn up_is_more() {
        let area = Rect::from_min_max(pos2(0.0, 0.0), pos2(10.0, 100.0));
        let scale = Scale { area, keys: 4.0 };
        assert!(scale.y(4.0) < scale.y(0.0));
        let dragged = scale.y(1.0) - scale.y(2.0);
        assert!((f64::from(-dragged) * scale.keys_per_point() - 1.0).abs() < 1e-5);
    }
}
