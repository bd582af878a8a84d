//! The page of keys, over the front view.

use egui::{Align2, Rect, Ui, pos2, vec2};

use super::shortcuts::SHORTCUTS;
use super::style::{self, ink};
use crate::render::theme;

/// Groups as they stand, column by column.
const COLUMNS: [&[&str]; 4] = [
    &["time", "show"],
    &["pose", "keys", "desk"],
    &["view", "kinetics", "puppet"],
    &["patch"],
];

/// Keys that are not in the table because there are too many of them, or because they go before all others.
const MORE: [(&str, &str, &str); 6] = [
    ("puppet", "Esc", "STOP"),
    ("desk", "1 - 8", "choose a dial"),
    ("desk", "F1 - F12", "the keys of the desk"),
    ("patch", "Wheel", "zoom at the pointer"),
    ("patch", "Space-drag", "move the view; or middle-drag"),
    ("patch", "Ctrl-Enter", "apply the text"),
];

/// Shows the page in `area`.
pub fn show(ui: &Ui, area: Rect) {
    let painter = ui.painter().with_clip_rect(area);
    let page = area.shrink2(vec2(theme::MARGIN * 2.0, theme::MARGIN * 3.0));
    painter.rect(
        page,
        style::round(),
        ink(theme::PANEL),
        style::hair(theme::EDGE),
        egui::StrokeKind::Inside,
    );
    let inner = page.shrink(theme::MARGIN * 1.5);
    let width = inner.width() / COLUMNS.len() as f32;
    for (index, groups) in COLUMNS.into_iter().enumerate() {
        let left = inner.left() + width * index as f32;
        let mut y = inner.top();
        for group in groups {
            let font = style::words(theme::SIZE_SMALL);
            painter.text(
                pos2(left, y),
                Align2::LEFT_TOP,
                group.to_uppercase(),
                font,
                ink(theme::FAINT),
            );
            y += theme::SIZE_SMALL + theme::STEP + 2.0;
            let more = MORE.iter().filter(|m| m.0 == *group).map(|m| (m.1, m.2));
            let rows = SHORTCUTS
                .iter()
                .filter(|s| s.group == *group && !s.keys.is_empty());
            for (keys, does) in more.chain(rows.map(|s| (s.keys, s.does))) {
                let keys_width = (width * 0.42).min(136.0);
                let text = (keys, style::digits(theme::SIZE_SMALL));
                style::line(
                    &painter,
                    pos2(left, y + 1.0),
                    Align2::LEFT_TOP,
                    text,
                    theme::TEXT,
                    keys_width,
                );
                let text = (does, style::words(theme::SIZE_BODY));
                let at = pos2(left + keys_width + theme::GAP, y);
                style::line(
                    &painter,
                    at,
                    Align2::LEFT_TOP,
                    text,
                    theme::DIM,
                    width - keys_width - theme::MARGIN * 2.0,
                );
                y += theme::SIZE_BODY + theme::STEP;
            }
            y += theme::GAP;
        }
    }
}
