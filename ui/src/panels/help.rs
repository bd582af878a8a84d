//! The page of keys, over the front view or the network: those that mean something there.

use egui::{Align2, Rect, Ui, pos2, vec2};

use super::layout;
use super::shortcuts::{Place, SHORTCUTS};
use super::style::{self, ink};
use crate::render::theme;

/// Groups as they stand, column by column: where the figure is, and where the network is.
const STAGE: [&[&str]; 3] = [
    &["time", "show", "desk"],
    &["pose", "keys", "view"],
    &["kinetics", "puppet"],
];
const PATCH: [&[&str]; 3] = [&["time", "show"], &["desk"], &["patch"]];

/// Width of a letter of a key's name, points: they are all as wide.
const KEY_WIDTH: f32 = 0.62 * theme::SIZE_SMALL;

/// Keys that are not in the table because there are too many of them, or because they go before all others.
const MORE: [(&str, &str, &str); 6] = [
    ("puppet", "Esc", "STOP"),
    ("desk", "1 - 8", "choose a dial"),
    ("desk", "F1 - F12", "the keys of the desk"),
    ("patch", "Wheel", "zoom at the pointer"),
    ("patch", "Space-drag", "move the view; or middle-drag"),
    ("patch", "Ctrl-Enter", "apply the text"),
];

/// Shows the page in `area`; `patch` says that the network is there.
pub fn show(ui: &Ui, area: Rect, patch: bool) {
    let painter = ui.painter().with_clip_rect(area);
    let page = area.shrink2(vec2(theme::MARGIN * 2.0, theme::MARGIN * 3.0));
    let (fill, edge) = (ink(theme::PANEL), style::hair(theme::EDGE));
    painter.rect(page, style::round(), fill, edge, egui::StrokeKind::Inside);
    let inner = page.shrink(theme::MARGIN * 1.5);
    let columns = if patch { PATCH } else { STAGE };
    let elsewhere = if patch { Place::Stage } else { Place::Patch };
    for (groups, column) in
        columns
            .into_iter()
            .zip(layout::columns(inner, columns.len(), theme::MARGIN * 2.0))
    {
        let rows = |group: &'static str| {
            let more = MORE.iter().filter(move |m| m.0 == group).map(|m| (m.1, m.2));
            let here = SHORTCUTS.iter().filter(move |s| s.place != elsewhere);
            let rows = here.filter(move |s| s.group == group && !s.keys.is_empty());
            more.chain(rows.map(|s| (s.keys, s.does)))
        };
        let wide = |keys: &str| keys.chars().count() as f32 * KEY_WIDTH;
        let all = groups.iter().flat_map(|group| rows(group));
        let keys_width = all.map(|(keys, _)| wide(keys)).fold(0.0, f32::max) + theme::GAP;
        let mut y = column.top();
        for group in groups {
            let head = (group.to_uppercase(), style::words(theme::SIZE_SMALL));
            let at = pos2(column.left(), y);
            painter.text(at, Align2::LEFT_TOP, head.0, head.1, ink(theme::FAINT));
            y += theme::SIZE_SMALL + theme::STEP + 2.0;
            for (keys, does) in rows(group) {
                let text = (keys, style::digits(theme::SIZE_SMALL));
                let at = pos2(column.left(), y + 1.0);
                style::line(&painter, at, Align2::LEFT_TOP, text, theme::TEXT, keys_width);
                let text = (does, style::words(theme::SIZE_BODY));
                let at = pos2(column.left() + keys_width, y);
                let width = column.width() - keys_width;
                style::line(&painter, at, Align2::LEFT_TOP, text, theme::DIM, width);
                y += theme::SIZE_BODY + theme::STEP;
            }
            y += theme::GAP;
        }
    }
}
