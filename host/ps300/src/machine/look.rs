//! Looking at the picture: all that is displayed, what lies under the cursor, transforms read back.

use std::sync::Arc;

use glam::{DMat4, DVec2};

use super::{Around, Machine};
use crate::display::DisplayList;
use crate::language::{Dimension, Name, Operation, Vector, VectorClass, VectorList};
use crate::names::Thing;
use crate::pick::Pick;
use crate::structure::{Aim, Body, NodeId, Traced, Walk, picks};
use crate::value::Value;

/// What this name denotes is on the screen, where the tablet is, without DISPLAY. Source:
/// `docs/protocols/ps300.md`, "Initial structure".
pub(super) const CURSOR: &str = "CURSOR";

impl Machine {
    /// Says how the host's own camera puts the world on the screen, -1 to 1 each way: where picks find what
    /// has no viewing nodes above it. As it is until said otherwise.
    pub fn set_camera(&mut self, screen_from_world: DMat4) {
        self.camera = screen_from_world;
    }

    /// All that is displayed.
    pub fn display(&self) -> DisplayList {
        let mut list = DisplayList::default();
        self.display_into(&mut list);
        list
    }

    /// The same into a list whose memory is used again.
    pub fn display_into(&self, list: &mut DisplayList) {
        list.clear();
        let mut walk = Walk::new(&self.structure, &self.names, self.ticked.frame, list);
        for &name in &self.displayed {
            walk.draw(name, DMat4::IDENTITY);
        }
        if let Some(cursor) = self.names.find(&Name::new(CURSOR)) {
            walk.draw_on_screen(cursor, self.tablet());
        }
    }

    /// What one name denotes, displayed or not, placed by `world_from_model`. Empty if it denotes nothing
    /// that can be drawn.
    pub fn display_of(&self, name: &str, world_from_model: DMat4) -> DisplayList {
        let mut list = DisplayList::default();
        if let Some(name) = self.names.find(&Name::new(name)) {
            let frame = self.ticked.frame;
            Walk::new(&self.structure, &self.names, frame, &mut list).draw(name, world_from_model);
        }
        list
    }

    /// Where the tablet was last.
    fn tablet(&self) -> DVec2 {
        let tablet = self.outlet("TABLETIN", 1).map(|outlet| outlet.from);
        let tablet = tablet.and_then(|id| self.network.instance(id));
        match tablet.and_then(|tablet| tablet.output_last(1)) {
            Some(Value::Vector2(at)) => *at,
            _ => DVec2::ZERO,
        }
    }

    /// A tablet that has moved moves the cursor, if there is one.
    pub(super) fn follow_tablet(&mut self) {
        let at = self.tablet();
        if at != self.cursor {
            self.cursor = at;
            if matches!(self.names.named(CURSOR), Some(Thing::Node(_))) {
                self.structure.revision += 1;
            }
        }
    }
}

impl Around<'_> {
    pub(super) fn look(&self, window: [DVec2; 2], detailed: bool) -> Arc<[Pick]> {
        let mut list = DisplayList::default();
        let mut traced = Traced::default();
        let mut walk = Walk::new(self.structure, self.names, self.frame, &mut list).tracing(&mut traced);
        for &name in self.displayed {
            walk.draw(name, DMat4::IDENTITY);
        }
        let aim = Aim {
            window,
            camera: *self.camera,
            detailed,
        };
        picks(self.structure, self.names, &list, &traced, &aim)
    }

    /// What the XFORM node `name` marks, on the first way to it.
    pub(super) fn marked(&self, name: &str, part: [usize; 2]) -> Result<Value, &'static str> {
        let Some(Thing::Node(id)) = self.names.thing(&Name::new(name)) else {
            return Err("there is no display node of the name at input <2>");
        };
        let (operation, below) = match self.structure.slot(id).map(|slot| &slot.body) {
            Some(Body::Operation { change, applied_to }) => (&change.operation, *applied_to),
            _ => return Err(NO_XFORM),
        };
        let world_from_here = self.transform_at(id).ok_or("the node is not on the screen")?;
        match operation {
            Operation::XformMatrix => Ok(world_from_here.into()),
            Operation::XformVectorList => {
                let below = below.ok_or("XFORM VECTOR_LIST is read where it is applied to a name")?;
                let mut list = DisplayList::default();
                Walk::new(self.structure, self.names, self.frame, &mut list).draw(below, world_from_here);
                Ok(vectors(&list, part).into())
            }
            _ => Err(NO_XFORM),
        }
    }

    fn transform_at(&self, node: NodeId) -> Option<DMat4> {
        let mut list = DisplayList::default();
        let mut walk = Walk::new(self.structure, self.names, self.frame, &mut list).seeking(node);
        for &name in self.displayed {
            walk.draw(name, DMat4::IDENTITY);
            if walk.found().is_some() {
                break;
            }
        }
        walk.found()
    }
}

const NO_XFORM: &str = "the node at input <2> is not an XFORM node";

/// The lines of a picture as one list; of its vectors the part asked for, beginning with a move.
fn vectors(list: &DisplayList, [skipped, count]: [usize; 2]) -> VectorList {
    let mut all = Vec::new();
    let mut last = None;
    let vector = |at, draw| Vector {
        at,
        draw,
        intensity: None,
    };
    for stroke in &list.strokes {
        if last != Some(stroke.from) {
            all.push(vector(stroke.from, false));
        }
        all.push(vector(stroke.to, true));
        last = Some(stroke.to);
    }
    let mut part: Vec<_> = all.into_iter().skip(skipped).take(count).collect();
    if let Some(first) = part.first_mut() {
        first.draw = false;
    }
    VectorList {
        dimension: Dimension::Three,
        ..VectorList::new(VectorClass::Itemized, part)
    }
}
