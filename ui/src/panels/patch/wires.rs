//! Wires as one mesh: dim at rest, bright for a moment after a message.

use egui::epaint::{Mesh, Vertex, WHITE_UV};
use egui::{Color32, Painter, Pos2, Shape, vec2};

use super::colour;
use super::view::{Detail, View};
use crate::panels::style::ink;
use crate::patch::look::Activity;
use crate::patch::route::Route;
use crate::patch::scene::Port;
use crate::patch::table::Table;
use crate::patch::traffic::Traffic;
use crate::render::theme::{self, Rgb};

/// Width at rest, points.
const WIDTH: f32 = 1.5;
/// Further width of a wire that has just carried something.
const BEAT: f32 = 1.4;
/// Width and strength of the glow around it.
const HALO: (f32, f32) = (9.0, 0.3);
/// How near the panel's ground a resting wire is.
const REST: f32 = 0.52;

/// What else decides how wires look.
pub(super) struct Looks<'a> {
    pub(super) traffic: &'a Traffic,
    pub(super) activity: &'a Activity,
    pub(super) now_secs: f64,
    pub(super) selected: &'a std::collections::BTreeSet<usize>,
    pub(super) hovered: Option<usize>,
    /// While another wire is drawn all others step back.
    pub(super) receding: bool,
}

/// Paints all wires that can be seen.
pub(super) fn paint(painter: &Painter, view: &View, table: &Table, looks: &Looks<'_>) {
    let seen = view.camera.seen(view.size());
    let detail = view.detail();
    let mut glows = Strip::default();
    let mut lines = Strip::default();
    for (index, route) in table.seating.routes.iter().enumerate() {
        if !route.area.grown(8.0).meets(seen) {
            continue;
        }
        let wire = table.scene.wires[index];
        let output = &table.scene.boxes[wire.from.0].outputs[wire.from.1];
        let glow = output
            .activity
            .map_or(0.0, |at| looks.traffic.glow(at, looks.now_secs));
        let kind = kind_colour(output, looks.activity);
        let colour = if looks.selected.contains(&index) {
            theme::SELECTED
        } else if looks.hovered == Some(index) {
            theme::TEXT
        } else {
            kind.mix(theme::GROUND, REST * (1.0 - glow))
                .mix(theme::LINE, glow * 0.4)
        };
        let strength = if looks.receding { 0.35 } else { 1.0 };
        if glow > 0.0 && detail > Detail::Blocks {
            let halo = ink(kind).gamma_multiply(HALO.1 * glow * strength);
            glows.line(view, route, HALO.0 * view.camera.zoom.clamp(0.5, 1.2), halo);
        }
        let width = (WIDTH + BEAT * glow) * view.camera.zoom.clamp(0.5, 1.2);
        lines.line(view, route, width, ink(colour).gamma_multiply(strength));
    }
    painter.add(Shape::mesh(glows.mesh));
    painter.add(Shape::mesh(lines.mesh));
}

/// Paints one wire that is not in the network: the one that is being drawn.
pub(super) fn paint_one(painter: &Painter, view: &View, route: &Route, colour: Rgb) {
    let mut strip = Strip::default();
    strip.line(view, route, 2.2, ink(colour));
    painter.add(Shape::mesh(strip.mesh));
}

/// The colour of what an output sent last, or of what it may send.
pub(super) fn kind_colour(output: &Port, activity: &Activity) -> Rgb {
    let last = output
        .activity
        .and_then(|at| activity.outputs.get(at)?.last.as_ref());
    last.map_or_else(|| colour::of_port(output.kinds), |value| colour::of(value.kind()))
}

/// Pieces of a curve of this length on the plane: no more than can be told apart.
fn pieces(view: &View, long: f32) -> usize {
    let (point, most) = match view.detail() {
        Detail::Blocks => (16.0, 5),
        _ => (10.0, 40),
    };
    ((view.length(long) / point) as usize + 2).min(most)
}

/// Lines as strips of triangles with soft edges.
#[derive(Default)]
struct Strip {
    mesh: Mesh,
    points: Vec<Pos2>,
}

impl Strip {
    fn line(&mut self, view: &View, route: &Route, width: f32, colour: Color32) {
        self.points.clear();
        self.points
            .extend(route.points(|long| pieces(view, long)).map(|at| view.screen(at)));
        let count = self.points.len();
        if count < 2 {
            return;
        }
        // Half the line, then a point of fading on either side; lines thinner than a point fade as a whole.
        let (half, colour) = if width < 1.0 {
            (0.0, colour.gamma_multiply(width))
        } else {
            ((width - 1.0) / 2.0, colour)
        };
        let soft = if width > 4.0 { half } else { 0.0 };
        let whole = [
            (-half - 1.0, Color32::TRANSPARENT),
            (-half + soft, colour),
            (half - soft, colour),
            (half + 1.0, Color32::TRANSPARENT),
        ];
        let thin = [whole[0], (0.0, colour), whole[3]];
        let rows = if half > soft { &whole[..] } else { &thin[..] };
        let seen = view.area.expand(width + 1.0);
        let mut joined = false;
        for index in 1..count {
            let (from, to) = (self.points[index - 1], self.points[index]);
            // Long wires are mostly out of sight when one is near.
            if !seen.intersects(egui::Rect::from_two_pos(from, to)) {
                joined = false;
                continue;
            }
            if !joined {
                self.rib(index - 1, rows);
            }
            self.rib(index, rows);
            joined = true;
            let wide = rows.len() as u32;
            let base = self.mesh.vertices.len() as u32 - 2 * wide;
            for row in base..base + wide - 1 {
                let next = row + wide;
                self.mesh
                    .indices
                    .extend([row, row + 1, next, next, row + 1, next + 1]);
            }
        }
    }

    /// The points across a line at one of its points.
    fn rib(&mut self, index: usize, rows: &[(f32, Color32)]) {
        let before = self.points[index.saturating_sub(1)];
        let after = self.points[(index + 1).min(self.points.len() - 1)];
        let along = (after - before).normalized();
        let side = vec2(-along.y, along.x);
        let at = self.points[index];
        self.mesh.vertices.extend(rows.iter().map(|&(out, color)| Vertex {
            pos: at + side * out,
            uv: WHITE_UV,
            color,
        }));
    }
}
