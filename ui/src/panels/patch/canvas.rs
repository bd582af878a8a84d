//! The table itself: ground, frames, wires, boxes, and what hangs at the pointer.

use egui::accesskit::Role;
use egui::{Align2, Rect, Sense, StrokeKind, Ui, UiBuilder, vec2};

use super::hand::{self, Done, Drawn, End, Gesture, Reach};
use super::view::{Detail, View};
use super::{Patch, boxes, tip, wires};
use crate::panels::button;
use crate::panels::style::{self, ink};
use crate::patch::area::Area;
use crate::patch::fit::{self, Fit};
use crate::patch::hit::Hit;
use crate::patch::look::Look;
use crate::patch::route::Route;
use crate::render::theme;

/// Distance of the dots of the ground, points of the plane.
const GRID: f32 = 32.0;

impl Patch {
    /// Paints the table into `area` and reads the hands on it.
    pub(super) fn canvas(&mut self, ui: &mut Ui, area: Rect, look: &Look, now_secs: f64) -> Option<Done> {
        let mut done = None;
        ui.scope_builder(UiBuilder::new().max_rect(area).id_salt("table"), |ui| {
            ui.set_clip_rect(area.intersect(ui.clip_rect()));
            let id = ui.scope_id().with("table");
            let response = button::spot(ui, area, id, Sense::click_and_drag(), (Role::Canvas, "patch"));
            let view = self.view(area);
            let open = self.adder.is_some() || self.literal.is_some();
            if !open || !matches!(self.gesture, Gesture::Idle) || response.hovered() {
                let mut reach = Reach {
                    table: &mut self.table,
                    camera: &mut self.camera,
                    selection: &mut self.selection,
                };
                let before = reach.selection.single();
                done = hand::act(&mut self.gesture, ui, &response, &view, &mut reach);
                if self.selection.single() != before && response.contains_pointer() {
                    self.show_line();
                }
            }
            let view = self.view(area);
            self.hovered = response
                .hover_pos()
                .filter(|_| response.hovered())
                .and_then(|at| {
                    self.table
                        .seating
                        .hit(&self.table.scene, view.plane(at), view.camera.zoom)
                });
            self.paint(ui, &view, look, now_secs);
            self.tips(ui, &view, look);
        });
        done
    }

    /// The text follows what is selected.
    fn show_line(&mut self) {
        let node = self
            .selection
            .single()
            .or_else(|| self.selection.boxes.first().copied());
        if let Some(shown) = node.and_then(|node| self.table.scene.boxes.get(node)) {
            let name = shown.name.clone();
            self.text.point_to(&name);
        }
    }

    fn paint(&self, ui: &Ui, view: &View, look: &Look, now_secs: f64) {
        let painter = ui.painter();
        painter.rect_filled(view.area, 0.0, ink(theme::GROUND));
        grid(ui, view);
        self.frames(ui, view);
        let drawn = match &self.gesture {
            Gesture::Wire(drawn) => Some(drawn),
            _ => None,
        };
        let wire_looks = wires::Looks {
            traffic: &self.traffic,
            activity: &look.activity,
            now_secs,
            selected: &self.selection.wires,
            hovered: match self.hovered {
                Some(Hit::Wire(wire)) => Some(wire),
                _ => None,
            },
            receding: drawn.is_some(),
        };
        wires::paint(painter, view, &self.table, &wire_looks);
        let looks = boxes::Looks {
            look,
            traffic: &self.traffic,
            now_secs,
            selected: &self.selection.boxes,
            hovered: match self.hovered {
                Some(Hit::Box(node) | Hit::Input(node, _) | Hit::Output(node, _)) => Some(node),
                _ => None,
            },
            offer: drawn.map(|drawn| &drawn.offer),
        };
        boxes::paint(painter, view, &self.table, &looks);
        if let Some(drawn) = drawn {
            self.hanging(ui, view, drawn);
        }
        if let (Gesture::Band(from, _), Some(at)) =
            (&self.gesture, ui.input(|input| input.pointer.latest_pos()))
        {
            let band = view.rect(Area::between(*from, view.plane(at)));
            let fill = ink(theme::SELECTED).gamma_multiply(0.08);
            painter.rect(band, 0.0, fill, style::hair(theme::SELECTED), StrokeKind::Inside);
        }
        if self.table.scene.boxes.is_empty() && !self.table.is_waiting() {
            let text = (
                "An empty network: Tab adds the first function",
                style::words(theme::SIZE_TITLE),
            );
            style::line(
                painter,
                view.area.center(),
                Align2::CENTER_CENTER,
                text,
                theme::DIM,
                view.area.width(),
            );
        }
    }

    /// Unfolded structures behind everything that is in them.
    fn frames(&self, ui: &Ui, view: &View) {
        let painter = ui.painter();
        for (name, area) in &self.table.seating.frames {
            let rect = view.rect(*area);
            if !rect.intersects(view.area) {
                continue;
            }
            let hovered = matches!(&self.hovered, Some(Hit::Frame(under)) if under == name);
            let edge = if hovered { theme::FAINT } else { theme::EDGE };
            let fill = ink(theme::PANEL.mix(theme::GROUND, 0.35));
            painter.rect(rect, style::round(), fill, style::hair(edge), StrokeKind::Inside);
            if view.detail() > Detail::Blocks {
                let size = view.length(12.0).clamp(9.0, 14.0).round();
                let at = rect.min + vec2(view.length(12.0), view.length(13.0));
                let text = (name.as_str(), style::words(size));
                style::line(
                    painter,
                    at,
                    Align2::LEFT_CENTER,
                    text,
                    theme::DIM,
                    rect.width() - 16.0,
                );
            }
        }
    }

    /// The wire at the pointer.
    fn hanging(&self, ui: &Ui, view: &View, drawn: &Drawn) {
        let Some(at) = ui.input(|input| input.pointer.latest_pos()) else {
            return;
        };
        let plane = view.plane(at);
        let (scene, seating) = (&self.table.scene, &self.table.seating);
        let mark = |end: End| match end {
            End::Output(node, port) => seating.output(scene, node, port),
            End::Input(node, port) => seating.input(scene, node, port),
        };
        let over = hand::target(drawn, plane, view, &self.table);
        let fit = over
            .and_then(|over| hand::ends(drawn.fixed, over))
            .map(|(from, to)| fit::judge(scene, from, to));
        let refused = matches!(fit, Some(Fit::Refused(_)));
        let loose = over.filter(|_| !refused).map_or(plane, mark);
        let fixed = mark(drawn.fixed);
        let (from, to) = match drawn.fixed {
            End::Output(..) => (fixed, loose),
            End::Input(..) => (loose, fixed),
        };
        let colour = if refused { theme::FAULTED } else { theme::SELECTED };
        wires::paint_one(
            ui.painter(),
            view,
            &Route::new(from, &[], to, from.y.max(to.y)),
            colour,
        );
        ui.painter().circle_filled(view.screen(loose), 4.0, ink(colour));
        if let Some(fit) = fit {
            tip::wire(ui.ctx(), at, &fit);
        }
    }

    fn tips(&self, ui: &Ui, view: &View, look: &Look) {
        let Some(at) = ui
            .input(|input| input.pointer.hover_pos())
            .filter(|_| matches!(self.gesture, Gesture::Idle))
        else {
            return;
        };
        if self.adder.is_some() || self.literal.is_some() || !view.area.contains(at) {
            return;
        }
        let scene = &self.table.scene;
        let near_badge = self.table.seating.areas.iter().position(|area| {
            let rect = view.rect(*area);
            boxes::badge_place(rect).distance(at) < 10.0
        });
        let reported = near_badge
            .map(|node| &scene.boxes[node])
            .filter(|b| boxes::reports(b, &look.activity) > 0);
        if let Some(shown) = reported {
            tip::reports(ui.ctx(), at, shown, look);
            return;
        }
        match &self.hovered {
            Some(Hit::Input(node, port)) => tip::input(ui.ctx(), at, &scene.boxes[*node].inputs[*port], look),
            Some(Hit::Output(node, port)) => {
                tip::output(ui.ctx(), at, &scene.boxes[*node].outputs[*port], look);
            }
            _ => {}
        }
    }
}

/// Dots that say how far one has moved and how near one is.
fn grid(ui: &Ui, view: &View) {
    let step = view.length(GRID);
    if step < 14.0 {
        return;
    }
    let colour = ink(theme::EDGE.mix(theme::GROUND, 0.45));
    let first = view.camera.corner.rem_euclid(glam::Vec2::splat(GRID)) * -view.camera.zoom;
    let mut mesh = egui::Mesh::default();
    let mut y = view.area.top() + first.y;
    while y < view.area.bottom() {
        let mut x = view.area.left() + first.x;
        while x < view.area.right() {
            let dot = Rect::from_center_size(egui::pos2(x.round(), y.round()), vec2(1.5, 1.5));
            mesh.add_colored_rect(dot, colour);
            x += step;
        }
        y += step;
    }
    ui.painter().add(egui::Shape::mesh(mesh));
}
