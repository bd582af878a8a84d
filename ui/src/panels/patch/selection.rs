//! What the next action applies to: boxes and wires.

use std::collections::BTreeSet;

use ps300::language::Name;

use crate::patch::scene::Scene;

/// Boxes and wires by their places in the scene; boxes are found again by name when that changes.
#[derive(Default)]
pub(super) struct Selection {
    pub(super) boxes: BTreeSet<usize>,
    pub(super) wires: BTreeSet<usize>,
    names: BTreeSet<Name>,
}

impl Selection {
    pub(super) fn clear(&mut self) {
        self.boxes.clear();
        self.wires.clear();
        self.names.clear();
    }

    /// One box; with `more`, that one too or no longer.
    pub(super) fn choose_box(&mut self, scene: &Scene, node: usize, more: bool) {
        if more && self.boxes.remove(&node) {
            self.remember(scene);
            return;
        }
        self.choose_boxes(scene, &[node], more);
    }

    pub(super) fn choose_boxes(&mut self, scene: &Scene, nodes: &[usize], more: bool) {
        if !more {
            self.clear();
        }
        self.boxes.extend(nodes);
        self.remember(scene);
    }

    pub(super) fn choose_wire(&mut self, scene: &Scene, wire: usize, more: bool) {
        if !more {
            self.clear();
        }
        if !self.wires.remove(&wire) {
            self.wires.insert(wire);
        }
        self.remember(scene);
    }

    /// Boxes that may only be there in the next picture.
    pub(super) fn expect(&mut self, names: impl IntoIterator<Item = Name>) {
        self.clear();
        self.names.extend(names);
    }

    /// Notes the names of what is selected.
    pub(super) fn remember(&mut self, scene: &Scene) {
        self.names = self
            .boxes
            .iter()
            .filter_map(|&node| Some(scene.boxes.get(node)?.name.clone()))
            .collect();
    }

    /// Finds the boxes again in a new scene.
    pub(super) fn find(&mut self, scene: &Scene) {
        self.boxes = self.names.iter().filter_map(|name| scene.find(name)).collect();
        self.wires.clear();
    }

    /// The only box that is selected.
    pub(super) fn single(&self) -> Option<usize> {
        let mut boxes = self.boxes.iter();
        boxes.next().copied().filter(|_| boxes.next().is_none())
    }
}
