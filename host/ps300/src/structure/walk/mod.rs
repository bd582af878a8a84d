//! Walking the display tree into a display list.
//!
//! State set by an operation holds for everything below it; inside a structure, an operation without a
//! target of its own holds for the members after it. On meeting a viewing node, everything above becomes
//! part of the view and world space begins anew below it. Polygons below a rendering node are gathered
//! and drawn at the end, when it is known which plane cuts them and what shines on them.

mod data;
mod faces;
mod pen;
mod state;
mod text;
mod trace;

pub(crate) use trace::{Trace, Traced};

use glam::DMat4;

use super::{Body, Change, NodeId, Structure};
use crate::display::{Cut, DisplayList};
use crate::language::Name;
use crate::names::{NameId, Names};
use faces::{Gathered, Rendition};
use state::State;

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
    /// Displayed frames so far; what blinks goes by it.
    frame: u64,
    visited: usize,
    path: Vec<NodeId>,
    renditions: Vec<Rendition>,
    gathered: Vec<Gathered>,
    /// Those outside all rendering nodes.
    lights: Vec<crate::display::Light>,
    /// Where every stroke came from, for picks.
    traced: Option<&'a mut Traced>,
    /// The XFORM node looked for, and the transform found above it.
    sought: Option<(NodeId, Option<DMat4>)>,
    dashes: Vec<[f64; 2]>,
}

/// Whether the walk goes on below or after an operation.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Go {
    On,
    Stop,
}

impl<'a> Walk<'a> {
    pub(crate) fn new(
        structure: &'a Structure,
        names: &'a Names,
        frame: u64,
        list: &'a mut DisplayList,
    ) -> Self {
        Self {
            structure,
            names,
            list,
            frame,
            visited: 0,
            path: Vec::new(),
            renditions: Vec::new(),
            gathered: Vec::new(),
            lights: Vec::new(),
            traced: None,
            sought: None,
            dashes: Vec::new(),
        }
    }

    /// Notes where every stroke comes from. Polygons are outlines then, whatever is rendered.
    pub(crate) fn tracing(mut self, traced: &'a mut Traced) -> Self {
        self.traced = Some(traced);
        self
    }

    /// Looks for a node on the way.
    pub(crate) fn seeking(mut self, node: NodeId) -> Self {
        self.sought = Some((node, None));
        self
    }

    /// The transform of what is below the node looked for, if the walk came by it.
    pub(crate) fn found(&self) -> Option<DMat4> {
        self.sought?.1
    }

    /// Draws what a name denotes, placed by `world_from_model`.
    pub(crate) fn draw(&mut self, name: NameId, world_from_model: DMat4) {
        self.draw_with(name, State::new(world_from_model));
    }

    /// Draws what a name denotes on the screen itself, moved to `at`.
    pub(crate) fn draw_on_screen(&mut self, name: NameId, at: glam::DVec2) {
        let mut state = State::on_screen();
        state.world_from_here = DMat4::from_translation(at.extend(0.0));
        self.draw_with(name, state);
    }

    fn draw_with(&mut self, name: NameId, mut state: State) {
        if let Some(node) = self.names.node(name) {
            self.visit(node, &mut state);
        }
        self.finish_faces();
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
            self.visit_body(id, &slot.body, &slot.below, state)
        } else {
            let mut prefixed = *state;
            if self.apply_all(&slot.above, &mut prefixed) == Go::On {
                self.visit_body(id, &slot.body, &slot.below, &mut prefixed);
            }
            Go::On
        };
        self.path.pop();
        go
    }

    fn refusal(&self, id: NodeId, name: &Name) -> Option<Cut> {
        let name = name.clone();
        if self.visited + self.drawn() > PARTS_MAX {
            Some(Cut::Size { name, max: PARTS_MAX })
        } else if self.path.len() >= DEPTH_MAX {
            Some(Cut::Depth { name, max: DEPTH_MAX })
        } else if self.path.contains(&id) {
            Some(Cut::Cycle { name })
        } else {
            None
        }
    }

    fn drawn(&self) -> usize {
        self.list.strokes.len() + self.list.edges.len() + self.gathered.len()
    }

    fn visit_body(&mut self, id: NodeId, body: &'a Body, below: &'a [Change], state: &mut State) -> Go {
        match body {
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
                return self.operate(id, change, below, state);
            }
            Body::Operation {
                change,
                applied_to: Some(name),
            } => {
                let mut state = *state;
                if self.operate(id, change, below, &mut state) == Go::On
                    && let Some(node) = self.names.node(*name)
                {
                    self.visit(node, &mut state);
                }
            }
            data if state.shown => self.draw_data(id, data, state),
            _ => {}
        }
        Go::On
    }

    fn operate(&mut self, id: NodeId, change: &Change, below: &[Change], state: &mut State) -> Go {
        if let Some((sought, found @ None)) = &mut self.sought
            && *sought == id
        {
            *found = Some(state.world_from_here);
        }
        if self.apply(&change.effect, state) {
            self.apply_all(below, state)
        } else {
            Go::Stop
        }
    }

    fn apply_all(&mut self, changes: &[Change], state: &mut State) -> Go {
        if changes.iter().all(|change| self.apply(&change.effect, state)) {
            Go::On
        } else {
            Go::Stop
        }
    }
}
