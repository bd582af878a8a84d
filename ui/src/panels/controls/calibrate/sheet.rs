//! A tablet's sheet from above: the area that counts, the one measured, corners touched, where the tool is.

use egui::{Align2, Painter, Pos2, Rect, Shape, Stroke, pos2, vec2};
use rig::TabletMapping;
use rig::controls_calibration::{Measured, Sheet as Size};

use super::super::super::style::{self, ink};
use crate::render::theme::{self, Rgb};

/// Between lines of the grid, millimetres.
const GRID_MM: f64 = 10.0;

/// What is drawn of it.
pub(super) struct Sheet {
    size_mm: [f64; 2],
    at_mm: Option<[f64; 2]>,
    touched_mm: Vec<[f64; 2]>,
    holds: TabletMapping,
    proposed: Option<TabletMapping>,
    /// It is what is being measured, or what can be.
    bright: bool,
}

impl Sheet {
    /// What holds, beside something else that is measured.
    pub(super) fn held(size: Size, holds: &TabletMapping) -> Self {
        Self {
            size_mm: size.size_mm(),
            at_mm: None,
            touched_mm: Vec::new(),
            holds: holds.clone(),
            proposed: None,
            bright: false,
        }
    }

    /// The same where nothing is measured.
    pub(super) fn bright(self) -> Self {
        Self { bright: true, ..self }
    }

    /// What is being measured; an empty sheet of anything else.
    pub(super) fn measured(of: &Measured) -> Self {
        let (mut size, mut at, mut touched) = ([1.0; 2], None, Vec::new());
        let (mut mapping, mut result) = (TabletMapping::default(), None);
        if let Measured::Area {
            size_mm,
            at_mm,
            touched_mm,
            holds,
            proposed,
        } = of
        {
            (size, at) = (*size_mm, *at_mm);
            touched.clone_from(touched_mm);
            mapping = holds.clone();
            result.clone_from(proposed);
        }
        Self {
            size_mm: size,
            at_mm: at,
            touched_mm: touched,
            holds: mapping,
            proposed: result,
            bright: true,
        }
    }
}

/// Paints it.
pub(super) fn paint(painter: &Painter, area: Rect, sheet: &Sheet) {
    let rest = style::title(painter, area, "area");
    let [width, height] = sheet.size_mm;
    let said = format!("{width:.1} \u{d7} {height:.1} mm");
    let text = (said.as_str(), style::digits(theme::SIZE_SMALL));
    style::line(
        painter,
        area.right_top(),
        Align2::RIGHT_TOP,
        text,
        theme::DIM,
        area.width() / 2.0,
    );
    let place = Place::of(rest.shrink2(vec2(0.0, theme::STEP)), sheet.size_mm);
    painter.rect(
        place.rect,
        style::round(),
        ink(theme::GROUND),
        style::hair(theme::FAINT),
        egui::StrokeKind::Outside,
    );
    grid(painter, &place);
    let (colour, fill) = if sheet.bright {
        (theme::TEXT, 0.08)
    } else {
        (theme::DIM, 0.05)
    };
    let quiet = sheet.proposed.is_some() || !sheet.touched_mm.is_empty();
    let colour = if quiet { theme::FAINT } else { colour };
    outline(painter, &place, &sheet.holds, (colour, fill));
    if let Some(proposed) = &sheet.proposed {
        outline(painter, &place, proposed, (theme::SELECTED, 0.16));
    }
    spanned(painter, &place, sheet);
    for (index, &corner) in sheet.touched_mm.iter().enumerate() {
        mark(painter, place.at(corner), index);
    }
    if let Some(at) = sheet.at_mm {
        tool(painter, &place, at);
    }
}

/// Where millimetres are on the screen.
struct Place {
    rect: Rect,
    points_per_mm: f32,
    size_mm: [f64; 2],
}

impl Place {
    fn of(area: Rect, size_mm: [f64; 2]) -> Self {
        let [width, height] = size_mm.map(|side| side.max(1.0) as f32);
        let points_per_mm = (area.width() / width).min(area.height() / height);
        let size = vec2(width, height) * points_per_mm;
        let rect = Rect::from_min_size(pos2(area.left(), area.center().y - size.y / 2.0), size);
        Self {
            rect: Rect::from_min_max(rect.min.round(), rect.max.round()),
            points_per_mm,
            size_mm,
        }
    }

    fn at(&self, [x, y]: [f64; 2]) -> Pos2 {
        self.rect.min + vec2(x as f32, y as f32) * self.points_per_mm
    }
}

fn grid(painter: &Painter, place: &Place) {
    let line = Stroke::new(1.0, ink(theme::EDGE.mix(theme::GROUND, 0.45)));
    let steps = |side: f64| {
        (1..)
            .map(|step| f64::from(step) * GRID_MM)
            .take_while(move |mm| *mm < side)
    };
    for x in steps(place.size_mm[0]) {
        painter.vline(place.at([x, 0.0]).x.round(), place.rect.y_range(), line);
    }
    for y in steps(place.size_mm[1]) {
        painter.hline(place.rect.x_range(), place.at([0.0, y]).y.round(), line);
    }
}

/// What is drawn on, as it lies; where up is has an arrow.
fn outline(painter: &Painter, place: &Place, mapping: &TabletMapping, (colour, fill): (Rgb, f32)) {
    let size = Size {
        // A hundredth of a millimetre a count: here the sheet is known in millimetres.
        max_counts: place.size_mm.map(|side| (side * 100.0).round() as u32),
        counts_per_inch: [2540.0; 2],
    };
    let corners = mapping.outline_mm(&size).map(|corner| place.at(corner));
    let line = Stroke::new(1.5, ink(colour));
    painter.add(Shape::convex_polygon(
        corners.to_vec(),
        ink(colour).gamma_multiply(fill),
        line,
    ));
    let [left, right, ..] = corners;
    let [a, b, c, d] = corners;
    let centre = pos2((a.x + b.x + c.x + d.x) / 4.0, (a.y + b.y + c.y + d.y) / 4.0);
    let upper = left + (right - left) / 2.0;
    let up = (upper - centre).normalized();
    let (tip, side) = (upper - up * 6.0, up.rot90() * 4.0);
    let arrow = vec![tip, tip - up * 8.0 + side, tip - up * 8.0 - side];
    painter.add(Shape::convex_polygon(arrow, ink(colour), Stroke::NONE));
}

/// From the first corner to the tool, before the second is touched.
fn spanned(painter: &Painter, place: &Place, sheet: &Sheet) {
    let ([first], Some(at), None) = (&sheet.touched_mm[..], sheet.at_mm, &sheet.proposed) else {
        return;
    };
    let rect = Rect::from_two_pos(place.at(*first), place.at(at));
    let line = Stroke::new(1.0, ink(theme::SELECTED));
    let corners = [
        rect.left_top(),
        rect.right_top(),
        rect.right_bottom(),
        rect.left_bottom(),
        rect.left_top(),
    ];
    painter.extend(Shape::dashed_line(&corners, line, 5.0, 4.0));
    let [width, height] = [0, 1].map(|axis| (at[axis] - first[axis]).abs());
    let said = format!("{width:.1} \u{d7} {height:.1}");
    let text = (said.as_str(), style::digits(theme::SIZE_SMALL));
    style::line(
        painter,
        rect.center(),
        Align2::CENTER_CENTER,
        text,
        theme::SELECTED,
        140.0,
    );
}

fn mark(painter: &Painter, at: Pos2, index: usize) {
    painter.circle(
        at,
        8.0,
        ink(theme::GROUND),
        Stroke::new(1.5, ink(theme::SELECTED)),
    );
    let number = (index + 1).to_string();
    let text = (number.as_str(), style::digits(theme::SIZE_SMALL));
    style::line(painter, at, Align2::CENTER_CENTER, text, theme::SELECTED, 16.0);
}

fn tool(painter: &Painter, place: &Place, at_mm: [f64; 2]) {
    let at = place.at(at_mm);
    let line = Stroke::new(1.0, ink(theme::LIVE.mix(theme::GROUND, 0.45)));
    painter.vline(at.x, place.rect.y_range(), line);
    painter.hline(place.rect.x_range(), at.y, line);
    painter.circle_filled(at, 3.5, ink(theme::LIVE));
}
