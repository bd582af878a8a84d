//! What keeps a device from being used, and what to do about it.

use egui::{Align2, Rect, Ui, pos2, vec2};
use rig::{DeviceHealth, DeviceView};

use super::super::button::Button;
use super::super::style::{self, ink};
use crate::render::theme;

/// Height of a line, points.
const LINE: f32 = theme::SIZE_BODY + theme::STEP + 2.0;
/// Width of the button that copies a rule, points.
const COPY: f32 = 64.0;

/// Shows it at the top of `area` and returns what is left.
pub(super) fn show(ui: &mut Ui, area: Rect, device: &DeviceView) -> Rect {
    let (said, rule) = match &device.health {
        DeviceHealth::Present | DeviceHealth::Starting => return area,
        DeviceHealth::Lost => (
            vec![
                "It is away. What it drives stands where it was left.".to_owned(),
                "Plug it in again: it goes on by itself, and nothing jumps.".to_owned(),
            ],
            None,
        ),
        DeviceHealth::Forbidden { rule } => (
            vec![
                "It is there, and this user may not open it.".to_owned(),
                "sudo dialrig devices --install-rules allows it; then plug it in again. Or by hand:"
                    .to_owned(),
            ],
            Some(rule.as_str()),
        ),
        DeviceHealth::Held { driver } => (
            vec![
                format!("{driver} holds it and takes what it says."),
                "End that program, or keep the driver from it; dialrig devices says how.".to_owned(),
            ],
            None,
        ),
    };
    let rule_lines = rule.map_or(0, |rule| {
        wrapped(ui, rule, area.width() - COPY - 4.0 * theme::GAP).1
    });
    let height = LINE * (said.len() + rule_lines) as f32 + 2.0 * theme::GAP;
    let block = Rect::from_min_size(area.min, vec2(area.width(), height));
    let bad = !matches!(device.health, DeviceHealth::Lost);
    let edge = if bad { theme::FAULTED } else { theme::EDGE };
    ui.painter().rect(
        block,
        style::round(),
        ink(theme::GROUND),
        style::hair(edge),
        egui::StrokeKind::Inside,
    );
    let mut at = block.min + vec2(theme::MARGIN, theme::GAP);
    for (index, line) in said.iter().enumerate() {
        let colour = if index == 0 { theme::TEXT } else { theme::DIM };
        let text = (line.as_str(), style::words(theme::SIZE_BODY));
        style::line(
            ui.painter(),
            at,
            Align2::LEFT_TOP,
            text,
            colour,
            block.width() - 2.0 * theme::MARGIN,
        );
        at.y += LINE;
    }
    if let Some(rule) = rule {
        let (galley, _) = wrapped(ui, rule, block.width() - COPY - 4.0 * theme::GAP);
        ui.painter().galley(at.round(), galley, ink(theme::TEXT));
        let copy = Rect::from_min_size(
            pos2(block.right() - COPY - theme::GAP, at.y - 2.0),
            vec2(COPY, theme::ROW),
        );
        let button = Button::new("Copy", "Copies the rule.", "").named("copy the rule");
        if button.show(ui, copy).clicked() {
            ui.ctx().copy_text(rule.to_owned());
        }
    }
    Rect::from_min_max(pos2(area.left(), block.bottom() + theme::MARGIN), area.max)
}

/// A rule in letters of one width, broken where it must be; and its lines.
fn wrapped(ui: &Ui, rule: &str, width: f32) -> (std::sync::Arc<egui::Galley>, usize) {
    let font = style::digits(theme::SIZE_SMALL);
    let galley = ui
        .painter()
        .layout(rule.to_owned(), font, ink(theme::TEXT), width.max(80.0));
    let rows = galley.rows.len();
    (galley, rows)
}
