//! The display tree: operations, instances, structures and data, each also a place messages go to.
//!
//! Apart from `network`, which knows a node only by its number. Nodes refer to each other by name, so
//! that a name can be used before it is defined and redefined after.
//! Source: `docs/protocols/ps300.md`, "Two graphs sharing one name space" and "Display-tree nodes as
//! sinks and sources".

mod blink;
mod build;
mod curve;
mod cycle;
mod dash;
mod edit;
mod effect;
mod font;
mod frustum;
mod inlet;
mod near;
mod polygon;
pub(crate) mod projection;
mod section;
mod state;
mod walk;

pub(crate) use build::BuildError;
pub(crate) use cycle::reaches;
pub(crate) use near::{Aim, picks};
pub(crate) use projection::NoView;
pub(crate) use walk::{Traced, Walk};

use curve::Curve;
use effect::{Effect, Rate};
use font::Typeface;
use polygon::Polygons;
use state::Told;

use crate::language::{
    Attributes, Characters, Illumination, Input, Labels, Name, Operation, Pattern, VectorList,
};
use crate::names::NameId;
use crate::value::Kinds;

/// A node of the display tree. Not reused while anything refers to it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct NodeId(pub(crate) u32);

/// One node.
pub(crate) struct Slot {
    /// As commands reach it; that of the structure around it where it has no label.
    pub(crate) name: Name,
    pub(crate) body: Body,
    /// Put above it by PREFIX, outermost first.
    pub(crate) above: Vec<Change>,
    /// Put below it by FOLLOW, outermost first.
    pub(crate) below: Vec<Change>,
    told: Told,
}

/// An operation as written and what it now does.
pub(crate) struct Change {
    pub(crate) operation: Operation,
    /// What its inputs take, from <1>.
    inputs: &'static [Kinds],
    effect: Effect,
}

impl Change {
    fn accepts(&self, input: Input) -> Option<Kinds> {
        let Input::Number(number) = input else {
            return None;
        };
        self.inputs.get(usize::from(number).checked_sub(1)?).copied()
    }
}

/// What a node is.
pub(crate) enum Body {
    Nil,
    Instance(Vec<NameId>),
    /// Labels without the structure's own name.
    Structure(Vec<(Option<Name>, NodeId)>),
    Operation {
        change: Change,
        applied_to: Option<NameId>,
    },
    Vectors {
        list: Drawn<VectorList>,
        /// How it is dashed.
        pattern: Option<NameId>,
    },
    Curve {
        curve: Drawn<Curve>,
        /// How it is dashed.
        pattern: Option<NameId>,
    },
    Characters(Drawn<Characters>),
    Labels(Drawn<Labels>),
    Polygons(Polygons),
    Attributes(Attributes),
    Illumination(Illumination),
    Pattern(Pattern),
    Font(Typeface),
    /// A function of the structure around it, which the network has.
    Function {
        function: Name,
        size: Option<u16>,
    },
}

/// Data as written, and as messages have left it.
pub(crate) struct Drawn<T> {
    pub(crate) written: T,
    changed: Option<T>,
}

impl<T: Clone> Drawn<T> {
    fn new(written: T) -> Self {
        Self {
            written,
            changed: None,
        }
    }

    fn now(&self) -> &T {
        self.changed.as_ref().unwrap_or(&self.written)
    }

    fn now_mut(&mut self) -> &mut T {
        self.changed.get_or_insert_with(|| self.written.clone())
    }
}

/// All nodes.
#[derive(Default)]
pub(crate) struct Structure {
    slots: Vec<Option<Slot>>,
    vacant: Vec<u32>,
    /// Counts changes that can be seen.
    pub(crate) revision: u64,
    /// What blinks, or did.
    rates: Vec<Rate>,
}

impl Structure {
    pub(crate) fn slot(&self, id: NodeId) -> Option<&Slot> {
        self.slots.get(id.0 as usize).and_then(Option::as_ref)
    }

    pub(crate) fn slot_mut(&mut self, id: NodeId) -> Option<&mut Slot> {
        self.revision += 1;
        self.slots.get_mut(id.0 as usize).and_then(Option::as_mut)
    }

    fn add(&mut self, name: Name, body: Body) -> NodeId {
        self.revision += 1;
        let slot = Some(Slot {
            name,
            body,
            above: Vec::new(),
            below: Vec::new(),
            told: Told::default(),
        });
        if let Some(index) = self.vacant.pop() {
            self.slots[index as usize] = slot;
            NodeId(index)
        } else {
            self.slots.push(slot);
            NodeId(self.slots.len() as u32 - 1)
        }
    }

    /// Takes a node and, if it is a structure, its members; returns all that went.
    pub(crate) fn remove(&mut self, id: NodeId) -> Vec<NodeId> {
        self.revision += 1;
        let mut gone = vec![id];
        let mut next = 0;
        while let Some(&id) = gone.get(next) {
            next += 1;
            if let Some(slot) = self.slots.get_mut(id.0 as usize).and_then(Option::take) {
                self.vacant.push(id.0);
                if let Body::Structure(members) = slot.body {
                    gone.extend(members.into_iter().map(|(_, member)| member));
                }
            }
        }
        gone
    }

    /// What a list or curve is dashed with.
    pub(crate) fn pattern(&self, id: NodeId) -> Option<NameId> {
        match self.slot(id)?.body {
            Body::Vectors { pattern, .. } | Body::Curve { pattern, .. } => pattern,
            _ => None,
        }
    }

    pub(crate) fn set_pattern(&mut self, id: NodeId, with: Option<NameId>) {
        let body = self.slot_mut(id).map(|slot| &mut slot.body);
        if let Some(Body::Vectors { pattern, .. } | Body::Curve { pattern, .. }) = body {
            *pattern = with;
        }
    }

    /// The full names of the labelled members of a structure, at any depth.
    pub(crate) fn labels(&self, id: NodeId) -> Vec<Name> {
        let mut found = Vec::new();
        let mut open = vec![id];
        while let Some(slot) = open.pop().and_then(|id| self.slot(id)) {
            if let Body::Structure(members) = &slot.body {
                open.extend(members.iter().map(|(_, member)| *member));
                let labelled = members.iter().filter(|(label, _)| label.is_some());
                found.extend(labelled.filter_map(|(_, member)| Some(self.slot(*member)?.name.clone())));
            }
        }
        found
    }

    /// The full names of the functions among the members of a structure, at any depth.
    pub(crate) fn functions(&self, id: NodeId) -> Vec<Name> {
        let mut found = Vec::new();
        let mut open = vec![id];
        while let Some(slot) = open.pop().and_then(|id| self.slot(id)) {
            match &slot.body {
                Body::Structure(members) => open.extend(members.iter().map(|(_, member)| *member)),
                Body::Function { .. } => found.push(slot.name.clone()),
                _ => {}
            }
        }
        found
    }

    /// The names directly below a node or its members.
    pub(crate) fn below(&self, id: NodeId) -> Vec<NameId> {
        match self.slot(id).map(|slot| &slot.body) {
            Some(Body::Instance(of)) => of.clone(),
            Some(Body::Operation {
                applied_to: Some(name),
                ..
            }) => vec![*name],
            Some(Body::Structure(members)) => members
                .iter()
                .flat_map(|(_, member)| self.below(*member))
                .collect(),
            _ => Vec::new(),
        }
    }

    /// The vectors of a list, as messages have left them.
    pub(crate) fn vectors(&self, id: NodeId) -> Option<&VectorList> {
        match &self.slot(id)?.body {
            Body::Vectors { list, .. } => Some(list.now()),
            _ => None,
        }
    }

    /// Whether a node sends a message when it has rendered.
    pub(crate) fn renders(&self, id: NodeId) -> bool {
        let body = self.slot(id).map(|slot| &slot.body);
        matches!(body, Some(Body::Operation { change, .. }) if matches!(change.effect, Effect::Rendering(_)))
    }

    /// As reports and drawings name a node's kind.
    pub(crate) fn what(&self, id: NodeId) -> &'static str {
        match self.slot(id).map(|slot| &slot.body) {
            Some(Body::Operation { change, .. }) => effect::what(&change.operation),
            Some(Body::Nil) => "NIL",
            Some(Body::Instance(_)) => "INSTANCE",
            Some(Body::Structure(_)) => "STRUCTURE",
            Some(Body::Vectors { .. }) => "VECTOR_LIST",
            Some(Body::Curve { curve, .. }) => match curve.written {
                Curve::BSpline(_) => "BSPLINE",
                Curve::Polynomial(_) => "POLYNOMIAL",
            },
            Some(Body::Characters(_)) => "CHARACTERS",
            Some(Body::Labels(_)) => "LABELS",
            Some(Body::Polygons(_)) => "POLYGON",
            Some(Body::Attributes(_)) => "ATTRIBUTES",
            Some(Body::Illumination(_)) => "ILLUMINATION",
            Some(Body::Pattern(_)) => "PATTERN",
            Some(Body::Font(_)) => "FONT",
            Some(Body::Function { .. }) => "FUNCTION",
            None => "removed",
        }
    }
}
