//! The devices, one card each: which, how it is, how steadily it speaks.

use std::fmt::Write as _;

use egui::accesskit::Role;
use egui::{Align2, Rect, ScrollArea, Sense, Ui, UiBuilder, pos2, vec2};
use rig::{DeviceHealth, DeviceView};

use super::super::style::{self, ink};
use super::super::{Commands, button};
use crate::render::theme;

/// Height of a card, points.
const CARD: f32 = 52.0;

/// What is said of a device's health in one or two words.
pub(super) fn word(health: &DeviceHealth) -> &'static str {
    match health {
        DeviceHealth::Present => "answers",
        DeviceHealth::Starting => "starting",
        DeviceHealth::Lost => "unplugged",
        DeviceHealth::Forbidden { .. } => "not allowed",
        DeviceHealth::Held { .. } => "held by another",
    }
}

/// A device's name for people, and which of several equal ones it is.
pub(super) fn title(device: &DeviceView) -> String {
    let title = if device.title.is_empty() {
        &device.name
    } else {
        &device.title
    };
    match device.slot {
        0 | 1 => title.clone(),
        slot => format!("{title} {slot}"),
    }
}

/// Shows the cards; a click on one chooses it.
pub(super) fn show(
    ui: &mut Ui,
    area: Rect,
    devices: &[DeviceView],
    chosen: &str,
    commands: &mut Commands<'_>,
) {
    ui.scope_builder(UiBuilder::new().max_rect(area), |ui| {
        ui.spacing_mut().item_spacing = egui::Vec2::ZERO;
        ScrollArea::vertical().auto_shrink([false, false]).show(ui, |ui| {
            for device in devices {
                let (_, rect) = ui.allocate_space(vec2(ui.available_width(), CARD + theme::STEP));
                let rect = Rect::from_min_size(rect.min, vec2(rect.width(), CARD));
                if card(ui, rect, device, device.name == chosen) {
                    commands.choices.device = Some(device.name.clone());
                }
            }
        });
    });
}

fn card(ui: &Ui, rect: Rect, device: &DeviceView, chosen: bool) -> bool {
    let name = title(device);
    let id = ui.scope_id().with(("device card", &device.name));
    let spoken = format!("controls of {name}");
    let response = button::spot(ui, rect, id, Sense::click(), (Role::Button, &spoken));
    let fill = if chosen {
        theme::HOVERED
    } else if response.hovered() {
        theme::RAISED
    } else {
        theme::PANEL
    };
    let edge = if chosen { theme::FAINT } else { theme::EDGE };
    let painter = ui.painter();
    painter.rect(
        rect,
        style::round(),
        ink(fill),
        style::hair(edge),
        egui::StrokeKind::Inside,
    );
    lamp(ui, pos2(rect.left() + theme::MARGIN, rect.top() + 17.0), device);
    let left = rect.left() + 2.0 * theme::MARGIN;
    let width = rect.right() - left - theme::GAP;
    let quiet = device.health == DeviceHealth::Lost;
    let colour = if quiet { theme::DIM } else { theme::TEXT };
    let text = (name.as_str(), style::words(theme::SIZE_BODY));
    let at = pos2(left, rect.top() + 17.0);
    style::line(painter, at, Align2::LEFT_CENTER, text, colour, width);
    let said = rhythm(device);
    let text = (said.as_str(), style::digits(theme::SIZE_SMALL));
    let at = pos2(left, rect.bottom() - 16.0);
    style::line(painter, at, Align2::LEFT_CENTER, text, theme::DIM, width);
    button::focus_ring(ui, &response);
    response.clicked()
}

/// Filled where it answers, red where somebody has to do something, a ring where it is away.
pub(super) fn lamp(ui: &Ui, at: egui::Pos2, device: &DeviceView) {
    let painter = ui.painter();
    match device.health {
        DeviceHealth::Present => {
            painter.circle_filled(at, 3.5, ink(theme::LIVE));
        }
        DeviceHealth::Forbidden { .. } | DeviceHealth::Held { .. } => {
            painter.circle_filled(at, 3.5, ink(theme::FAULTED));
        }
        DeviceHealth::Starting | DeviceHealth::Lost => {
            painter.circle_stroke(at, 3.0, egui::Stroke::new(1.5, ink(theme::FAINT)));
        }
    }
}

/// How it speaks: rate and jitter while it does, and what got lost on the way.
fn rhythm(device: &DeviceView) -> String {
    let mut said = match device.health {
        DeviceHealth::Present if device.rate_hz > 0.0 => {
            format!("{:.0}/s \u{b1}{:.1} ms", device.rate_hz, device.jitter_ms)
        }
        DeviceHealth::Present => "quiet".to_owned(),
        ref health => word(health).to_owned(),
    };
    for (count, what) in [(device.dropped, "lost"), (device.rejected, "bad")] {
        if count > 0 {
            let _ = write!(said, "  {count} {what}");
        }
    }
    said
}
