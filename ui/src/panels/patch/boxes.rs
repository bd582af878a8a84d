//! Boxes: name and type, a row for each port with what it holds, and how much is told of them at each size.

use std::collections::BTreeSet;

use egui::{Align2, CornerRadius, Painter, Pos2, Rect, Shape, Stroke, StrokeKind, pos2, vec2};

use super::colour;
use super::ports::{self, Offer};
use super::view::{Detail, View};
use crate::panels::style::{self, ink};
use crate::patch::look::{Activity, Look, Role};
use crate::patch::scene::{Part, Shown};
use crate::patch::size;
use crate::patch::table::Table;
use crate::patch::traffic::Traffic;
use crate::render::theme::{self, Rgb};

/// What else decides how boxes look.
pub(super) struct Looks<'a> {
    pub(super) look: &'a Look,
    pub(super) traffic: &'a Traffic,
    pub(super) now_secs: f64,
    pub(super) selected: &'a BTreeSet<usize>,
    pub(super) hovered: Option<usize>,
    /// While a wire is drawn: which ports it fits.
    pub(super) offer: Option<&'a Offer>,
}

/// Paints every box that can be seen.
pub(super) fn paint(painter: &Painter, view: &View, table: &Table, looks: &Looks<'_>) {
    let seen = view.camera.seen(view.size()).grown(24.0);
    let detail = view.detail();
    for (index, shown) in table.scene.boxes.iter().enumerate() {
        let area = table.seating.areas[index];
        if !area.meets(seen) {
            continue;
        }
        let rect = view.rect(area);
        let chosen = looks.selected.contains(&index);
        body(painter, view, rect, shown, looks, index);
        match detail {
            Detail::Blocks => {}
            Detail::Names => {
                small_name(painter, rect, shown);
                ports::marks(painter, view, table, index, looks);
            }
            Detail::Full => {
                head(painter, view, rect, shown);
                ports::rows(painter, view, table, index, looks);
            }
        }
        if chosen {
            let width = if detail == Detail::Blocks { 1.0 } else { 1.6 };
            outline(painter, view, rect, Stroke::new(width, ink(theme::SELECTED)));
        } else if looks.hovered == Some(index) && detail > Detail::Blocks {
            outline(painter, view, rect, style::hair(theme::FAINT));
        }
        badge(painter, rect, shown, looks);
    }
}

fn corner(view: &View) -> CornerRadius {
    CornerRadius::same((theme::ROUND * 1.4 * view.camera.zoom).clamp(0.0, 5.0) as u8)
}

fn outline(painter: &Painter, view: &View, rect: Rect, stroke: Stroke) {
    painter.rect_stroke(rect.expand(0.5), corner(view), stroke, StrokeKind::Outside);
}

/// The ground of a box: warmer at the ends of a network than inside it.
fn body(painter: &Painter, view: &View, rect: Rect, shown: &Shown, looks: &Looks<'_>, index: usize) {
    let strength = looks
        .offer
        .map_or(1.0, |offer| if offer.any(index) { 1.0 } else { 0.5 });
    let ground = ink(theme::PANEL.mix(theme::RAISED, 0.35)).gamma_multiply(strength);
    let edge = ink(theme::EDGE.mix(theme::FAINT, 0.3)).gamma_multiply(strength);
    if view.detail() == Detail::Blocks {
        let heat = shown
            .outputs
            .iter()
            .filter_map(|port| {
                let glow = looks.traffic.glow(port.activity?, looks.now_secs);
                (glow > 0.0).then(|| (glow, colour::of_port(port.kinds)))
            })
            .reduce(|a, b| if b.0 > a.0 { b } else { a });
        let rest = head_colour(shown).mix(theme::PRESSED, 0.5);
        let fill = heat.map_or(rest, |(glow, kind)| rest.mix(kind, glow));
        painter.add(Shape::rect_filled(rect, 0.0, ink(fill).gamma_multiply(strength)));
        return;
    }
    painter.rect(
        rect,
        corner(view),
        ground,
        Stroke::new(1.0, edge),
        StrokeKind::Inside,
    );
    let mut head = rect;
    head.max.y = head.min.y + view.length(size::HEAD);
    if view.detail() == Detail::Names {
        head = rect;
    }
    let round = corner(view);
    let top = CornerRadius {
        sw: if view.detail() == Detail::Names {
            round.sw
        } else {
            0
        },
        se: if view.detail() == Detail::Names {
            round.se
        } else {
            0
        },
        ..round
    };
    painter.rect_filled(
        head.shrink(1.0),
        top,
        ink(head_colour(shown)).gamma_multiply(strength),
    );
    if matches!(shown.part, Part::Folded(_)) {
        // Like a pile of cards.
        for step in [3.0, 6.0] {
            let y = rect.bottom() + step * view.camera.zoom.min(1.0);
            let inset = step * 1.5;
            painter.hline(
                rect.left() + inset..=rect.right() - inset,
                y,
                Stroke::new(1.0, edge),
            );
        }
    }
}

/// What kind of thing it is, in greys.
fn head_colour(shown: &Shown) -> Rgb {
    match shown.role {
        Role::Function => theme::RAISED,
        Role::Variable => theme::HOVERED,
        Role::Device => theme::PRESSED,
        Role::Node | Role::Parameter => theme::HOVERED.mix(theme::PRESSED, 0.35),
    }
}

fn head(painter: &Painter, view: &View, rect: Rect, shown: &Shown) {
    let pad = view.length(10.0);
    let middle = rect.top() + view.length(size::HEAD / 2.0);
    let word = font(view, theme::SIZE_SMALL);
    let kind = style::layout(painter, (shown.kind_word(), word), theme::DIM, rect.width() * 0.6);
    let right = rect.right() - pad;
    let width = right - rect.left() - pad - kind.size().x - view.length(8.0);
    painter.galley(
        pos2(right - kind.size().x, middle - kind.size().y / 2.0),
        kind,
        ink(theme::DIM),
    );
    let text = (shown.title(), font(view, theme::SIZE_BODY));
    style::line(
        painter,
        pos2(rect.left() + pad, middle),
        Align2::LEFT_CENTER,
        text,
        theme::TEXT,
        width,
    );
}

/// Digits' type at this zoom, in whole points: every size more is a set of letters more.
pub(super) fn font(view: &View, points: f32) -> egui::FontId {
    style::digits(view.length(points).round().max(5.0))
}

fn small_name(painter: &Painter, rect: Rect, shown: &Shown) {
    let points = (rect.height() * 0.4).clamp(8.0, 12.0).round();
    let text = (shown.title(), style::digits(points));
    style::line(
        painter,
        rect.center(),
        Align2::CENTER_CENTER,
        text,
        theme::TEXT,
        rect.width() - 6.0,
    );
}

/// How many boxes have reported something, and how often, at its upper right corner.
fn badge(painter: &Painter, rect: Rect, shown: &Shown, looks: &Looks<'_>) {
    let count = reports(shown, &looks.look.activity);
    if count == 0 {
        return;
    }
    let at = badge_place(rect);
    painter.circle_filled(at, 8.0, ink(theme::FAULTED));
    painter.circle_stroke(at, 8.0, Stroke::new(1.5, ink(theme::GROUND)));
    let text = if count < 100 {
        count.to_string()
    } else {
        String::from("99+")
    };
    let size = if count < 10 { 11.0 } else { 9.0 };
    painter.text(
        at,
        Align2::CENTER_CENTER,
        text,
        style::digits(size),
        ink(theme::GROUND),
    );
}

/// Where the badge of a box is.
pub(super) fn badge_place(rect: Rect) -> Pos2 {
    rect.right_top() + vec2(-2.0, 0.0)
}

/// How often something went wrong at a box, or inside it.
pub(super) fn reports(shown: &Shown, activity: &Activity) -> u64 {
    let of = |index: &usize| activity.reports.get(*index).copied().unwrap_or(0);
    match &shown.part {
        Part::Box(index) => of(index),
        Part::Folded(members) => members.iter().map(of).sum(),
        Part::Guest => 0,
    }
}
