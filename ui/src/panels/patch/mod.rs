//! The patch panel: the function network as boxes and wires, live, to be rewired while it runs.
//!
//! What is shown where is decided in [`crate::patch`], without egui; here it is painted and hands are read.
//! What hands want leaves as [`NetworkEdit`]s, command-language text each of which is one step of undo.
//! Start at [`Patch::ui`].

mod adder;
mod bar;
mod boxes;
mod canvas;
mod colour;
mod hand;
mod keys;
mod literal;
mod pop;
mod ports;
mod probes;
mod selection;
mod text;
mod tip;
mod view;
mod wires;

use egui::{Align2, Rect, Ui, pos2};
use glam::Vec2;
use ps300::language::Name;

use self::adder::{Adder, Found};
use self::hand::{Done, Gesture, Tie};
use self::literal::{Literal, Typed};
use self::probes::Probes;
use self::selection::Selection;
use self::text::{Text, Wish};
use self::view::View;
use super::shortcuts::Act;
use super::style::{self, ink};
use crate::patch::area::Area;
use crate::patch::camera::Camera;
use crate::patch::catalogue::Want;
use crate::patch::hit::Hit;
use crate::patch::look::{Look, NetworkEdit};
use crate::patch::table::{Change, Table};
use crate::patch::traffic::Traffic;
use crate::patch::{duplicate, edit};
use crate::render::theme;

/// Share of the width the text takes, and its bounds in points.
const TEXT_SHARE: f32 = 0.36;
const TEXT_WIDTHS: [f32; 2] = [300.0, 520.0];

/// The panel and what it remembers; a restart may lose all of it.
#[derive(Default)]
pub struct Patch {
    table: Table,
    camera: Camera,
    /// The camera and the size of the view as framing left them; a hand on the camera ends that.
    framed: Option<(Camera, Vec2)>,
    traffic: Traffic,
    gesture: Gesture,
    selection: Selection,
    hovered: Option<Hit>,
    adder: Option<Adder>,
    literal: Option<Literal>,
    probes: Probes,
    text: Text,
    /// Whether the space bar was used to move the view since it went down.
    panned: bool,
}

/// What hands on the panel want.
#[derive(Default)]
pub struct Asked {
    /// Of the network, in order.
    pub edits: Vec<NetworkEdit>,
    /// Play or pause: the space bar was let go without having moved anything.
    pub play: bool,
}

impl Patch {
    /// Whether the text is shown beside the graph.
    pub fn show_text(&mut self, on: bool) {
        self.text.open = on;
    }

    /// Folds a structure into one box, or unfolds it.
    pub fn fold(&mut self, structure: &Name, on: bool) {
        self.table.fold(structure, on);
    }

    /// Where a box is on the screen, as last drawn in `area`; for manuals and tests.
    pub fn place_of(&self, area: Rect, name: &Name) -> Option<Rect> {
        let index = self.table.scene.find(name)?;
        Some(
            self.view(self.parts(area).1)
                .rect(*self.table.seating.areas.get(index)?),
        )
    }

    /// Where a port's mark is on the screen: an output, or else an input, counted from 0.
    pub fn port_of(&self, area: Rect, name: &Name, output: bool, port: usize) -> Option<egui::Pos2> {
        let index = self.table.scene.find(name)?;
        let (scene, seating) = (&self.table.scene, &self.table.seating);
        let at = if output {
            seating.output(scene, index, port)
        } else {
            seating.input(scene, index, port)
        };
        Some(self.view(self.parts(area).1).screen(at))
    }

    /// The part of `area` in which the boxes lie.
    pub fn table_area(&self, area: Rect) -> Rect {
        self.parts(area).1
    }

    fn view(&self, area: Rect) -> View {
        View {
            area,
            camera: self.camera,
        }
    }

    /// The bar, the table and, if it is open, the text.
    fn parts(&self, area: Rect) -> (Rect, Rect, Option<Rect>) {
        let mut bar = area;
        bar.max.y = area.top() + bar::HEIGHT;
        let mut table = area;
        table.min.y = bar.max.y;
        if !self.text.open {
            return (bar, table, None);
        }
        let width = (area.width() * TEXT_SHARE)
            .clamp(TEXT_WIDTHS[0], TEXT_WIDTHS[1])
            .round();
        let mut text = table;
        text.min.x = area.right() - width;
        table.max.x = text.min.x;
        (bar, table, Some(text))
    }

    /// Draws the panel into all of `ui`'s rectangle. Without a look there is nothing to edit, and it says so.
    pub fn ui(&mut self, ui: &mut Ui, look: Option<&Look>) -> Asked {
        let mut asked = Asked::default();
        let (bar, area, text) = self.parts(ui.max_rect());
        let now_secs = ui.input(|input| input.time);
        let mut acts = bar::show(ui, bar, &self.table, look, self.text.open);
        ui.painter()
            .hline(bar.x_range(), bar.bottom() - 0.5, style::hair(theme::EDGE));
        let Some(look) = look else {
            ui.painter().rect_filled(area, 0.0, ink(theme::GROUND));
            let text = (
                "The network is not looked at yet",
                style::words(theme::SIZE_TITLE),
            );
            style::line(
                ui.painter(),
                area.center(),
                Align2::CENTER_CENTER,
                text,
                theme::DIM,
                area.width(),
            );
            return asked;
        };
        self.see(look, area, now_secs);
        if let Some(rect) = text {
            match self.text.show(ui, rect, look) {
                Some(Wish::Apply(program)) => asked.edits.push(NetworkEdit::Program(program)),
                Some(Wish::Point(name)) => self.point(&name),
                None => {}
            }
        }
        // A field that is open has the keys.
        if self.adder.is_none() && self.literal.is_none() {
            acts.extend(keys::acts(ui.ctx()));
            self.space(ui, &mut asked);
        }
        let done = self.canvas(ui, area, look, now_secs);
        if let Some(done) = done {
            self.done(done, ui, area, look, &mut asked);
        }
        for act in acts {
            self.perform(act, ui, area, look, &mut asked);
        }
        self.fields(ui, area, look, &mut asked);
        self.probes.show(ui, area, &self.table.scene);
        if self.traffic.is_warm(now_secs) || self.table.is_waiting() {
            ui.ctx().request_repaint();
        }
        asked
    }

    /// Takes in what is new.
    fn see(&mut self, look: &Look, area: Rect, now_secs: f64) {
        let change = self.table.see(&look.picture);
        if change != Change::None {
            self.gesture = Gesture::Idle;
            self.selection.find(&self.table.scene);
        }
        let size = Vec2::new(area.width(), area.height());
        // What was framed stays framed when the text opens or the window grows.
        let outgrown = self
            .framed
            .is_some_and(|(camera, view)| camera == self.camera && view != size);
        if change == Change::Arranged || outgrown || self.framed.is_none() {
            self.frame(area, self.table.seating.extent());
        }
        self.traffic.see(look.picture.revision, &look.activity, now_secs);
        self.probes.see(&self.table.scene, look);
    }

    /// What is selected, or all.
    fn meant(&self) -> Option<Area> {
        let areas = &self.table.seating.areas;
        let chosen = self
            .selection
            .boxes
            .iter()
            .filter_map(|&node| areas.get(node).copied());
        chosen.reduce(Area::union).or_else(|| self.table.seating.extent())
    }

    /// Shows a part of the plane.
    fn frame(&mut self, area: Rect, whole: Option<Area>) {
        let view = Vec2::new(area.width(), area.height());
        if let Some(whole) = whole {
            self.camera.frame(whole, view);
        }
        // An empty table is framed too: its first box stays under the hand that puts it there.
        self.framed = Some((self.camera, view));
    }

    /// The cursor in the text is on a name: its box is meant.
    fn point(&mut self, name: &Name) {
        let scene = &self.table.scene;
        let node = scene.find(name);
        let frame = scene.frames.iter().find(|frame| frame.name == *name);
        match (node, frame) {
            (Some(node), _) => self.selection.choose_box(scene, node, false),
            (None, Some(frame)) => self.selection.choose_boxes(scene, &frame.members, false),
            (None, None) => {}
        }
    }

    /// The space bar plays when it is let go, unless it has moved the view.
    fn space(&mut self, ui: &Ui, asked: &mut Asked) {
        if ui.ctx().text_edit_focused() {
            return;
        }
        let (pressed, released, held) = ui.input(|input| {
            (
                input.key_pressed(egui::Key::Space),
                input.key_released(egui::Key::Space),
                input.key_down(egui::Key::Space),
            )
        });
        if pressed {
            self.panned = false;
        }
        self.panned |= held && matches!(self.gesture, Gesture::Pan);
        asked.play |= released && !self.panned;
    }

    /// The search and the field for a value, where they are open.
    fn fields(&mut self, ui: &Ui, area: Rect, look: &Look, asked: &mut Asked) {
        if let Some(adder) = &mut self.adder {
            let at = adder.at();
            match adder.show(ui.ctx(), area, look) {
                Found::Open => return,
                Found::Closed => {}
                Found::Commands(text, name) => {
                    self.table.expect(name.clone(), at);
                    self.selection.expect([name]);
                    asked.edits.push(NetworkEdit::Commands(text));
                }
                Found::Guest(name) => {
                    self.table.add_guest(name.clone(), at);
                    self.selection.expect([name]);
                }
            }
            self.adder = None;
        }
        if let Some(literal) = &mut self.literal {
            let view = View {
                area,
                camera: self.camera,
            };
            match literal.show(ui.ctx(), &view) {
                Typed::Open => return,
                Typed::Closed => {}
                Typed::Commands(text) => asked.edits.push(NetworkEdit::Commands(text)),
            }
            self.literal = None;
        }
    }

    fn done(&mut self, done: Done, ui: &Ui, area: Rect, look: &Look, asked: &mut Asked) {
        match done {
            Done::Commands(text) => asked.edits.push(NetworkEdit::Commands(text)),
            Done::Wanted(want, tie, before) => self.open_adder(ui, area, look, want, tie, before),
            Done::Literal(node, port) => {
                let input = &self.table.scene.boxes[node].inputs[port];
                let holds = input
                    .activity
                    .and_then(|at| look.activity.inputs.get(at)?.front.as_ref());
                let at = self.table.seating.input(&self.table.scene, node, port);
                self.literal = Some(Literal::new(input, at, holds));
            }
            Done::Fold(name) => self.table.fold(&name, !self.table.is_folded(&name)),
        }
    }

    fn open_adder(&mut self, ui: &Ui, area: Rect, look: &Look, want: Want, tie: Tie, before: String) {
        let pointer = ui
            .input(|input| input.pointer.latest_pos())
            .filter(|at| area.contains(*at));
        let corner = pointer.unwrap_or_else(|| pos2(area.center().x - 210.0, area.top() + 60.0));
        let view = self.view(area);
        // The box's first port comes under the pointer, roughly.
        let at = view.plane(corner) - Vec2::new(0.0, crate::patch::size::port(0));
        self.adder = Some(Adder::new(look, at, corner, want, tie, before));
        self.literal = None;
    }

    fn perform(&mut self, act: Act, ui: &Ui, area: Rect, look: &Look, asked: &mut Asked) {
        match act {
            Act::Add => self.open_adder(ui, area, look, Want::Any, Tie::None, String::new()),
            Act::Frame => self.frame(area, self.meant()),
            Act::PatchUndo => asked.edits.push(NetworkEdit::Undo),
            Act::PatchRedo => asked.edits.push(NetworkEdit::Redo),
            Act::LayOut => self.table.lay_out(),
            Act::PatchText => self.text.open = !self.text.open,
            Act::SelectAll => {
                let all: Vec<usize> = (0..self.table.scene.boxes.len()).collect();
                self.selection.choose_boxes(&self.table.scene, &all, false);
            }
            Act::PatchDelete => {
                let chosen = &self.selection.boxes;
                let guests: Vec<Name> = chosen
                    .iter()
                    .map(|&node| self.table.scene.boxes[node].name.clone())
                    .collect();
                let text = edit::delete(&self.table.scene, chosen, &self.selection.wires);
                asked.edits.extend(text.map(NetworkEdit::Commands));
                for guest in &guests {
                    self.table.remove_guest(guest);
                }
                self.selection.clear();
            }
            Act::Duplicate => self.duplicate(look, asked),
            Act::Fold => self.fold_under_pointer(),
            Act::Probe | Act::Freeze => self.output_under_pointer(act, look, asked),
            _ => {}
        }
    }

    fn duplicate(&mut self, look: &Look, asked: &mut Asked) {
        let Some((text, copies)) = duplicate::duplicate(look, &self.table.scene, &self.selection.boxes)
        else {
            return;
        };
        for (model, copy) in &copies {
            let area = self
                .table
                .scene
                .find(model)
                .map(|node| self.table.seating.areas[node]);
            if let Some(area) = area {
                self.table.expect(copy.clone(), area.min + Vec2::splat(28.0));
            }
        }
        self.selection.expect(copies.into_values());
        asked.edits.push(NetworkEdit::Commands(text));
    }

    fn fold_under_pointer(&mut self) {
        let scene = &self.table.scene;
        let around = |node: usize| {
            let shown = scene.boxes.get(node)?;
            shown.structure.clone().or_else(|| Some(shown.name.clone()))
        };
        let name = match &self.hovered {
            Some(Hit::Box(node) | Hit::Input(node, _) | Hit::Output(node, _)) => around(*node),
            Some(Hit::Frame(name)) => Some(name.clone()),
            _ => self.selection.single().and_then(around),
        };
        if let Some(name) = name {
            self.table.fold(&name, !self.table.is_folded(&name));
        }
    }

    fn output_under_pointer(&mut self, act: Act, look: &Look, asked: &mut Asked) {
        let scene = &self.table.scene;
        let (node, port) = match &self.hovered {
            Some(Hit::Output(node, port)) => (*node, *port),
            Some(Hit::Wire(wire)) => scene.wires[*wire].from,
            // A box with one output means that one.
            Some(Hit::Box(node)) if scene.boxes[*node].outputs.len() == 1 => (*node, 0),
            _ => return,
        };
        let output = &scene.boxes[node].outputs[port];
        if act == Act::Probe {
            self.probes.toggle(output);
            return;
        }
        let frozen = output
            .activity
            .and_then(|at| look.activity.outputs.get(at))
            .is_some_and(|o| o.frozen);
        asked.edits.push(NetworkEdit::Freeze {
            name: output.of.to_string(),
            output: edit::output_number(output),
            on: !frozen,
        });
    }
}
