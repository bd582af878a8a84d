//! The theme's plain numbers as egui wants them.

use std::sync::Arc;

use egui::{Align2, Color32, CornerRadius, FontFamily, FontId, Galley, Painter, Pos2, Rect, Stroke, Visuals};

use crate::render::theme::{self, Rgb};

/// A theme colour for egui.
pub fn ink(Rgb(r, g, b): Rgb) -> Color32 {
    Color32::from_rgb(r, g, b)
}

/// Words.
pub fn words(size: f32) -> FontId {
    FontId::new(size, FontFamily::Proportional)
}

/// Numbers and label displays: digits of one width do not dance.
pub fn digits(size: f32) -> FontId {
    FontId::new(size, FontFamily::Monospace)
}

/// A line of one point.
pub fn hair(colour: Rgb) -> Stroke {
    Stroke::new(1.0, ink(colour))
}

/// The corner radius of everything.
pub fn round() -> CornerRadius {
    CornerRadius::same(theme::ROUND as u8)
}

/// Gives a context the theme.
pub fn apply(ctx: &egui::Context) {
    let mut visuals = Visuals::dark();
    visuals.panel_fill = ink(theme::PANEL);
    visuals.window_fill = ink(theme::RAISED);
    visuals.window_stroke = hair(theme::EDGE);
    visuals.extreme_bg_color = ink(theme::GROUND);
    visuals.override_text_color = Some(ink(theme::TEXT));
    visuals.selection.bg_fill = ink(theme::SELECTED.mix(theme::PANEL, 0.6));
    visuals.selection.stroke = hair(theme::SELECTED);
    visuals.popup_shadow = egui::Shadow::NONE;
    visuals.window_shadow = egui::Shadow::NONE;
    visuals.menu_corner_radius = round();
    for (state, fill) in [
        (&mut visuals.widgets.noninteractive, theme::PANEL),
        (&mut visuals.widgets.inactive, theme::RAISED),
        (&mut visuals.widgets.hovered, theme::HOVERED),
        (&mut visuals.widgets.active, theme::PRESSED),
        (&mut visuals.widgets.open, theme::HOVERED),
    ] {
        state.bg_fill = ink(fill);
        state.weak_bg_fill = ink(fill);
        state.bg_stroke = hair(theme::EDGE);
        state.fg_stroke = hair(theme::TEXT);
        state.corner_radius = round();
        state.expansion = 0.0;
    }
    ctx.set_visuals(visuals);
    ctx.all_styles_mut(|style| {
        style.spacing.item_spacing = egui::vec2(theme::GAP, theme::STEP);
        style.spacing.interact_size.y = theme::ROW;
        style.interaction.tooltip_delay = 0.4;
        style.interaction.selectable_labels = false;
        style.override_font_id = Some(words(theme::SIZE_BODY));
        style.animation_time = 0.0;
    });
}

/// A panel's title in capitals; returns the rectangle beneath it.
pub fn title(painter: &Painter, area: Rect, text: &str) -> Rect {
    let at = area.left_top();
    painter.text(
        at,
        Align2::LEFT_TOP,
        text.to_uppercase(),
        words(theme::SIZE_SMALL),
        ink(theme::DIM),
    );
    let mut rest = area;
    rest.min.y = (at.y + theme::SIZE_SMALL + theme::GAP).round();
    rest
}

/// Lays out one line of text that never leaves its width: what does not fit ends in an ellipsis.
pub fn layout(painter: &Painter, (text, font): (&str, FontId), colour: Rgb, width: f32) -> Arc<Galley> {
    let mut job = egui::text::LayoutJob::simple_singleline(text.to_owned(), font, ink(colour));
    job.wrap = egui::text::TextWrapping::truncate_at_width(width.max(1.0));
    painter.layout_job(job)
}

/// Paints such a line.
pub fn line(painter: &Painter, at: Pos2, anchor: Align2, text: (&str, FontId), colour: Rgb, width: f32) {
    let galley = layout(painter, text, colour, width);
    let rect = anchor.anchor_size(at, galley.size());
    painter.galley(rect.min.round(), galley, ink(colour));
}
