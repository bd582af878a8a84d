//! Walking the display tree into a display list.
//!
//! State set by an operation holds for everything below it; inside a structure, an operation without a
//! target of its own holds for the members after it. On meeting a viewing node, everything above becomes
//! part of the view and world space begins anew below it.

use glam::{DMat2, DMat4, DVec3};

use super::effect::Effect;
use super::{Body, Change, NodeId, Structure};
use crate::display::{Cut, DisplayList, Lettering, Stroke, View, Viewport};
use crate::language::{Characters, Name, Vector, VectorClass, VectorList};
use crate::names::{NameId, Names};

/// Levels of the tree; what people build has a dozen.
const DEPTH_MAX: usize = 256;
/// Nodes visited and strokes drawn in one picture: more than a screen shows, little enough to end.
const PARTS_MAX: usize = 1 << 19;
/// Cuts listed in one picture.
const CUTS_MAX: usize = 64;

/// One walk.
pub(crate) struct Walk<'a> {
    structure: &'a Structure,
    names: &'a Names,
    list: &'a mut DisplayList,
    visited: usize,
    path: Vec<NodeId>,
}

/// What operations above have set.
#[derive(Clone, Copy)]
struct State {
    world_from_here: DMat4,
    screen_from_world: Option<DMat4>,
    viewport: Viewport,
    characters: DMat2,
    hue_deg: f64,
    saturation: f64,
    brightest: f64,
    bits: u16,
}

/// Whether the walk goes on below or after an operation.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Go {
    On,
    Stop,
}

impl<'a> Walk<'a> {
    pub(crate) fn new(structure: &'a Structure, names: &'a Names, list: &'a mut DisplayList) -> Self {
        Self {
            structure,
            names,
            list,
            visited: 0,
            path: Vec::new(),
        }
    }

    /// Draws what a name denotes, placed by `world_from_model`.
    pub(crate) fn draw(&mut self, name: NameId, world_from_model: DMat4) {
        let mut state = State {
            world_from_here: world_from_model,
            screen_from_world: None,
            viewport: Viewport::default(),
            characters: DMat2::IDENTITY,
            hue_deg: 0.0,
            saturation: 0.0,
            brightest: 1.0,
            bits: 0,
        };
        if let Some(node) = self.names.node(name) {
            self.visit(node, &mut state);
        }
    }

    /// Draws a node. In a structure `state` is what the members before it left, and it leaves its own.
    fn visit(&mut self, id: NodeId, state: &mut State) -> Go {
        let structure = self.structure;
        let Some(slot) = structure.slot(id) else {
            return Go::On;
        };
        self.visited += 1;
        if let Some(cut) = self.refusal(id, &slot.name) {
            if self.list.cuts.len() < CUTS_MAX && !self.list.cuts.contains(&cut) {
                self.list.cuts.push(cut);
            }
            return Go::On;
        }
        self.path.push(id);
        let go = if slot.above.is_empty() {
            self.visit_body(&slot.body, &slot.below, state)
        } else {
            let mut prefixed = *state;
            if apply_all(&slot.above, &mut prefixed) == Go::On {
                self.visit_body(&slot.body, &slot.below, &mut prefixed);
            }
            Go::On
        };
        self.path.pop();
        go
    }

    fn refusal(&self, id: NodeId, name: &Name) -> Option<Cut> {
        let name = name.clone();
        if self.visited + self.list.strokes.len() > PARTS_MAX {
            Some(Cut::Size { name, max: PARTS_MAX })
        } else if self.path.len() >= DEPTH_MAX {
            Some(Cut::Depth { name, max: DEPTH_MAX })
        } else if self.path.contains(&id) {
            Some(Cut::Cycle { name })
        } else {
            None
        }
    }

    fn visit_body(&mut self, body: &'a Body, below: &'a [Change], state: &mut State) -> Go {
        match body {
            Body::Nil | Body::Unseen(_) => {}
            Body::Instance(of) => {
                for node in of.iter().filter_map(|&name| self.names.node(name)) {
                    self.visit(node, &mut state.clone());
                }
            }
            Body::Structure(members) => {
                let mut state = *state;
                for (_, member) in members {
                    if self.visit(*member, &mut state) == Go::Stop {
                        break;
                    }
                }
            }
            Body::Operation {
                change,
                applied_to: None,
            } => {
                // Without a target it holds for what follows.
                return match apply(change, state) {
                    Go::Stop => Go::Stop,
                    Go::On => apply_all(below, state),
                };
            }
            Body::Operation {
                change,
                applied_to: Some(name),
            } => {
                let mut state = *state;
                if apply(change, &mut state) == Go::On
                    && apply_all(below, &mut state) == Go::On
                    && let Some(node) = self.names.node(*name)
                {
                    self.visit(node, &mut state);
                }
            }
            Body::Vectors(list) => self.draw_vectors(list.now(), state),
            Body::Characters(characters) => self.draw_characters(characters.now(), state),
        }
        Go::On
    }

    fn draw_vectors(&mut self, list: &VectorList, state: &State) {
        let view = self.view(state);
        let mut from: Option<DVec3> = None;
        for Vector { at, draw, intensity } in &list.vectors {
            if self.list.strokes.len() >= PARTS_MAX {
                return;
            }
            let to = state.world_from_here.transform_point3(*at);
            let start = if list.class == VectorClass::Dots {
                Some(to)
            } else {
                from
            };
            if let (true, Some(from)) = (*draw, start) {
                self.list.strokes.push(Stroke {
                    from,
                    to,
                    hue_deg: state.hue_deg,
                    saturation: state.saturation,
                    intensity: intensity.unwrap_or(1.0) * state.brightest,
                    view,
                });
            }
            from = Some(to);
        }
    }

    fn draw_characters(&mut self, characters: &Characters, state: &State) {
        let view = self.view(state);
        let placed = |v: glam::DVec2| {
            state
                .world_from_here
                .transform_vector3((state.characters * v).extend(0.0))
        };
        self.list.letterings.push(Lettering {
            at: state.world_from_here.transform_point3(characters.at),
            right: placed(glam::DVec2::X),
            up: placed(glam::DVec2::Y),
            step: characters.step,
            text: characters.text.clone(),
            hue_deg: state.hue_deg,
            saturation: state.saturation,
            intensity: state.brightest,
            view,
        });
    }

    fn view(&mut self, state: &State) -> u16 {
        let view = View {
            screen_from_world: state.screen_from_world,
            viewport: state.viewport,
        };
        let views = &mut self.list.views;
        if let Some(index) = views.iter().rposition(|known| *known == view) {
            return index as u16;
        }
        if views.len() < usize::from(u16::MAX) {
            views.push(view);
        }
        views.len() as u16 - 1
    }
}

fn apply_all(changes: &[Change], state: &mut State) -> Go {
    let stopped = changes.iter().any(|change| apply(change, state) == Go::Stop);
    if stopped { Go::Stop } else { Go::On }
}

fn apply(change: &Change, state: &mut State) -> Go {
    match &change.effect {
        Effect::Model(m) => state.world_from_here *= *m,
        Effect::View(m) => {
            let above = state.screen_from_world.unwrap_or(DMat4::IDENTITY) * state.world_from_here;
            state.screen_from_world = Some(above * *m);
            state.world_from_here = DMat4::IDENTITY;
        }
        Effect::Viewport(viewport) => state.viewport = *viewport,
        Effect::Characters(m) => state.characters *= *m,
        Effect::Color { hue_deg, saturation } => {
            (state.hue_deg, state.saturation) = (*hue_deg, *saturation);
        }
        Effect::Intensity { on, brightest } => state.brightest = if *on { *brightest } else { 1.0 },
        Effect::Bit { bit, on } => {
            let mask = 1_u16.checked_shl(u32::from(*bit)).unwrap_or(0);
            state.bits = if *on {
                state.bits | mask
            } else {
                state.bits & !mask
            };
        }
        Effect::If { bit, on } => {
            let mask = 1_u16.checked_shl(u32::from(*bit)).unwrap_or(0);
            if (state.bits & mask != 0) != *on {
                return Go::Stop;
            }
        }
        Effect::Unseen => {}
    }
    Go::On
}
