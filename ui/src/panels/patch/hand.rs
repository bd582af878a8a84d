//! What the pointer does on the table: pan, zoom, select, move, draw wires.

use std::collections::BTreeSet;

use egui::{Key, PointerButton, Response, Ui};
use glam::Vec2;

use super::ports::Offer;
use super::selection::Selection;
use super::view::View;
use crate::patch::area::Area;
use crate::patch::camera::Camera;
use crate::patch::catalogue::Want;
use crate::patch::edit;
use crate::patch::fit::{self, Fit};
use crate::patch::hit::Hit;
use crate::patch::scene::{Port, Scene};
use crate::patch::table::Table;

/// Zoom for each point scrolled, as an exponent.
const ZOOM_PER_POINT: f32 = 0.0028;

/// What the pointer is in the middle of.
#[derive(Default)]
pub(super) enum Gesture {
    /// Nothing.
    #[default]
    Idle,
    /// Moving the view.
    Pan,
    /// A rubber band from here; what was selected before stays so.
    Band(Vec2, BTreeSet<usize>),
    /// Moving what is selected.
    Move,
    /// Drawing a wire.
    Wire(Drawn),
}

/// A wire that hangs at the pointer.
pub(super) struct Drawn {
    /// The end that stays.
    pub(super) fixed: End,
    /// The wire that was taken off its input.
    pub(super) lifted: Option<usize>,
    /// What it fits.
    pub(super) offer: Offer,
}

/// One end of a wire, by box and port.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum End {
    /// An output.
    Output(usize, usize),
    /// An input.
    Input(usize, usize),
}

/// What a hand has done that others must act on.
pub(super) enum Done {
    /// Commands for the network.
    Commands(String),
    /// A wire was let go over nothing: something that fits is looked for. The commands come first.
    Wanted(Want, Tie, String),
    /// A port was clicked twice.
    Literal(usize, usize),
    /// A structure's title, or its folded box, was clicked twice.
    Fold(ps300::language::Name),
}

/// What a box that is added is connected to.
#[derive(Clone, Debug, Default)]
pub(super) enum Tie {
    /// Nothing.
    #[default]
    None,
    /// An output feeds it.
    From(Port),
    /// It feeds an input.
    To(Port),
}

/// The table and what may change with a gesture.
pub(super) struct Reach<'a> {
    pub(super) table: &'a mut Table,
    pub(super) camera: &'a mut Camera,
    pub(super) selection: &'a mut Selection,
}

/// Takes what the pointer did since the last picture.
pub(super) fn act(
    gesture: &mut Gesture,
    ui: &Ui,
    response: &Response,
    view: &View,
    reach: &mut Reach<'_>,
) -> Option<Done> {
    wheel(ui, response, view, reach.camera);
    let origin = ui.input(|input| input.pointer.press_origin());
    let held = ui.input(|input| input.key_down(Key::Space));
    let started = |button| response.drag_started_by(button);
    if started(PointerButton::Middle)
        || started(PointerButton::Secondary)
        || started(PointerButton::Primary) && held
    {
        *gesture = Gesture::Pan;
    } else if let Some(origin) = origin.filter(|_| started(PointerButton::Primary)) {
        *gesture = begin(ui, view.plane(origin), view, reach);
    }
    match gesture {
        Gesture::Pan => {
            let by = response.drag_delta();
            reach.camera.pan(Vec2::new(by.x, by.y));
        }
        Gesture::Move => {
            let by = response.drag_delta();
            reach
                .table
                .shift(&reach.selection.boxes, Vec2::new(by.x, by.y) / reach.camera.zoom);
        }
        Gesture::Band(from, before) => {
            if let Some(at) = response.interact_pointer_pos() {
                let band = Area::between(*from, view.plane(at));
                let inside = reach.table.seating.within(band);
                reach.selection.boxes = before.iter().copied().chain(inside).collect();
            }
        }
        Gesture::Idle | Gesture::Wire(_) => {}
    }
    if response.drag_stopped() || !ui.input(|input| input.pointer.any_down()) {
        let over = std::mem::take(gesture);
        if let (Gesture::Wire(drawn), Some(at)) = (over, ui.input(|input| input.pointer.latest_pos())) {
            return drop_wire(&drawn, view.plane(at), view, reach.table);
        }
        if matches!(gesture, Gesture::Idle) {
            return clicks(ui, response, view, reach);
        }
    }
    None
}

fn wheel(ui: &Ui, response: &Response, view: &View, camera: &mut Camera) {
    let Some(at) = response.hover_pos().filter(|_| response.hovered()) else {
        return;
    };
    let (scrolled, pinched) = ui.input(|input| (input.smooth_scroll_delta, input.zoom_delta()));
    if scrolled.y != 0.0 || pinched != 1.0 {
        camera.zoom_at(view.within(at), (scrolled.y * ZOOM_PER_POINT).exp() * pinched);
    }
    if scrolled.x != 0.0 {
        camera.pan(Vec2::new(scrolled.x, 0.0));
    }
}

fn begin(ui: &Ui, at: Vec2, view: &View, reach: &mut Reach<'_>) -> Gesture {
    let more = ui.input(|input| input.modifiers.shift);
    let scene = &reach.table.scene;
    match reach.table.seating.hit(scene, at, view.camera.zoom) {
        Some(Hit::Output(node, port)) => Gesture::Wire(Drawn {
            fixed: End::Output(node, port),
            lifted: None,
            offer: Offer::to_inputs(scene, (node, port)),
        }),
        Some(Hit::Input(node, port)) => Gesture::Wire(lift(scene, (node, port))),
        Some(Hit::Box(node)) => {
            if !reach.selection.boxes.contains(&node) {
                reach.selection.choose_box(scene, node, more);
            }
            Gesture::Move
        }
        Some(Hit::Frame(name)) => {
            let frame = scene.frames.iter().find(|frame| frame.name == name);
            reach
                .selection
                .choose_boxes(scene, frame.map_or(&[][..], |frame| &frame.members), more);
            Gesture::Move
        }
        // A click takes a wire; a band may begin anywhere between boxes.
        Some(Hit::Wire(_)) | None => {
            if !more {
                reach.selection.clear();
            }
            Gesture::Band(at, reach.selection.boxes.clone())
        }
    }
}

/// An input gives up its last wire; one without wires begins a new one, backwards.
fn lift(scene: &Scene, to: (usize, usize)) -> Drawn {
    let last = scene.wires.iter().rposition(|wire| wire.to == to);
    match last {
        Some(wire) => {
            let from = scene.wires[wire].from;
            Drawn {
                fixed: End::Output(from.0, from.1),
                lifted: Some(wire),
                offer: Offer::to_inputs(scene, from),
            }
        }
        None => Drawn {
            fixed: End::Input(to.0, to.1),
            lifted: None,
            offer: Offer::to_outputs(scene, to),
        },
    }
}

/// The port a wire would end at, were it let go at `at`.
pub(super) fn target(drawn: &Drawn, at: Vec2, view: &View, table: &Table) -> Option<End> {
    let hit = table.seating.hit(&table.scene, at, view.camera.zoom)?;
    match (drawn.fixed, hit) {
        (End::Output(..), Hit::Input(node, port)) => Some(End::Input(node, port)),
        (End::Input(..), Hit::Output(node, port)) => Some(End::Output(node, port)),
        // Anywhere on a box means the first of its ports that fits.
        (End::Output(from, _), Hit::Box(node) | Hit::Output(node, _)) if from != node => {
            Some(End::Input(node, drawn.offer.first(node)?))
        }
        (End::Input(to, _), Hit::Box(node) | Hit::Input(node, _)) if to != node => {
            Some(End::Output(node, drawn.offer.first(node)?))
        }
        _ => None,
    }
}

/// Both ends in the direction of flow.
pub(super) fn ends(fixed: End, other: End) -> Option<((usize, usize), (usize, usize))> {
    match (fixed, other) {
        (End::Output(a, b), End::Input(c, d)) | (End::Input(c, d), End::Output(a, b)) => {
            Some(((a, b), (c, d)))
        }
        _ => None,
    }
}

fn drop_wire(drawn: &Drawn, at: Vec2, view: &View, table: &Table) -> Option<Done> {
    let scene = &table.scene;
    let mut text = String::new();
    if let Some(wire) = drawn.lifted {
        let same = scene.wires[wire].to;
        if target(drawn, at, view, table) == Some(End::Input(same.0, same.1)) {
            return None;
        }
        let (output, input) = edit::ends(scene, wire);
        text = edit::disconnect(output, input);
    }
    let Some(other) = target(drawn, at, view, table) else {
        let over_nothing = table
            .seating
            .hit(scene, at, view.camera.zoom)
            .is_none_or(|hit| matches!(hit, Hit::Wire(_)));
        return match drawn.fixed {
            _ if drawn.lifted.is_some() => Some(Done::Commands(text)),
            End::Output(node, port) if over_nothing => {
                let port = scene.boxes[node].outputs[port].clone();
                Some(Done::Wanted(Want::Takes(port.kinds), Tie::From(port), text))
            }
            End::Input(node, port) if over_nothing => {
                let port = scene.boxes[node].inputs[port].clone();
                Some(Done::Wanted(Want::Sends(port.kinds), Tie::To(port), text))
            }
            _ => None,
        };
    };
    let (from, to) = ends(drawn.fixed, other)?;
    if matches!(fit::judge(scene, from, to), Fit::Refused(_)) {
        return None;
    }
    text.push_str(&edit::connect(
        &scene.boxes[from.0].outputs[from.1],
        &scene.boxes[to.0].inputs[to.1],
    ));
    Some(Done::Commands(text))
}

fn clicks(ui: &Ui, response: &Response, view: &View, reach: &mut Reach<'_>) -> Option<Done> {
    let at = response.interact_pointer_pos().filter(|_| response.clicked())?;
    let more = ui.input(|input| input.modifiers.shift);
    let scene = &reach.table.scene;
    let hit = reach.table.seating.hit(scene, view.plane(at), view.camera.zoom);
    let twice = response.double_clicked();
    match hit {
        Some(Hit::Input(node, port)) if twice => return Some(Done::Literal(node, port)),
        Some(Hit::Frame(name)) if twice => return Some(Done::Fold(name)),
        Some(Hit::Box(node)) => {
            let shown = &scene.boxes[node];
            if twice {
                if matches!(shown.part, crate::patch::scene::Part::Folded(_)) {
                    return Some(Done::Fold(shown.name.clone()));
                }
                // A value is edited where it stands, not only at its port's mark.
                if let Some(port) = row_under(reach.table, node, view.plane(at)) {
                    return Some(Done::Literal(node, port));
                }
            }
            reach.selection.choose_box(scene, node, more);
        }
        Some(Hit::Frame(name)) => {
            let frame = scene.frames.iter().find(|frame| frame.name == name);
            reach
                .selection
                .choose_boxes(scene, frame.map_or(&[][..], |frame| &frame.members), more);
        }
        Some(Hit::Wire(wire)) => reach.selection.choose_wire(scene, wire, more),
        Some(Hit::Input(..) | Hit::Output(..)) => {}
        None => reach.selection.clear(),
    }
    None
}

/// The input whose row is under the pointer, on the box's left side.
fn row_under(table: &Table, node: usize, at: Vec2) -> Option<usize> {
    let shown = table.scene.boxes.get(node)?;
    let area = table.seating.areas.get(node)?;
    let left = at.x < area.centre().x || shown.outputs.is_empty();
    let row = |port: &usize| (area.min.y + shown.port_y(*port) - at.y).abs() <= crate::patch::size::ROW / 2.0;
    (0..shown.inputs.len()).find(row).filter(|_| left)
}
