//! The table the boxes lie on: what is shown, where, what is folded, and what a hand has moved.
//!
//! Places are kept by name, so that an edit of the network moves nothing that it does not touch. Large layouts are
//! made on a thread of their own while the old picture stays.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, TryRecvError, sync_channel};

use glam::Vec2;
use ps300::language::Name;

use super::area::Area;
use super::hit::Seating;
use super::layout::{self, Placed, place};
use super::look::Picture;
use super::scene::Scene;

/// Layouts of more boxes than this are made on a thread.
const AT_ONCE_MAX: usize = 300;
/// More new boxes than this, and than a third of all, are no edit but another network.
const EDIT_MAX: usize = 8;

/// What lies where.
#[derive(Default)]
pub struct Table {
    /// What is shown.
    pub scene: Scene,
    /// Where.
    pub seating: Seating,
    picture: Option<Arc<Picture>>,
    lanes: Vec<Vec<[Vec2; 2]>>,
    folded: BTreeSet<Name>,
    guests: BTreeSet<Name>,
    spots: BTreeMap<Name, Vec2>,
    /// Corners of frames when they were folded.
    homes: BTreeMap<Name, Vec2>,
    stale: bool,
    anew: bool,
    waiting: Option<Receiver<(Scene, Placed)>>,
}

/// What happened to the table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Change {
    /// Nothing.
    None,
    /// A few boxes came or went, or nothing but their ports.
    Edited,
    /// Everything may be elsewhere.
    Arranged,
}

impl Table {
    /// Takes a picture; does something only where it or the table has changed since.
    pub fn see(&mut self, picture: &Arc<Picture>) -> Change {
        if let Some(change) = self.received() {
            return change;
        }
        let same = self
            .picture
            .as_ref()
            .is_some_and(|known| Arc::ptr_eq(known, picture));
        if same && !self.stale {
            return Change::None;
        }
        self.picture = Some(picture.clone());
        self.stale = false;
        let wired = |name: &Name| picture.boxes.iter().any(|seen| seen.name == *name);
        self.guests.retain(|guest| !wired(guest));
        let scene = Scene::new(picture, &self.folded, &self.guests);
        let unknown = scene
            .boxes
            .iter()
            .filter(|shown| !self.spots.contains_key(&shown.name))
            .count();
        let anew = std::mem::take(&mut self.anew);
        let first = self.scene.boxes.is_empty() && unknown == scene.boxes.len();
        if anew || first || unknown > EDIT_MAX && unknown * 3 > scene.boxes.len() {
            return self.arrange(scene, anew);
        }
        let mut at: Vec<Option<Vec2>> = scene
            .boxes
            .iter()
            .map(|shown| self.spots.get(&shown.name).copied())
            .collect();
        let corners = place::fill(&scene, &mut at);
        // Lanes belong to a layout that may no longer be.
        let lanes = kept_lanes(&self.scene, &self.lanes, &scene);
        self.take(scene, corners, lanes);
        Change::Edited
    }

    fn arrange(&mut self, scene: Scene, anew: bool) -> Change {
        let spots: Vec<Option<Vec2>> = scene
            .boxes
            .iter()
            .map(|shown| self.spots.get(&shown.name).copied().filter(|_| !anew))
            .collect();
        if scene.boxes.len() <= AT_ONCE_MAX {
            let placed = layout::arrange_scene(&scene, &|index| spots.get(index).copied().flatten());
            self.take(scene, placed.at, placed.lanes);
            return Change::Arranged;
        }
        let (done, waiting) = sync_channel(1);
        let work = move || {
            let placed = layout::arrange_scene(&scene, &|index| spots.get(index).copied().flatten());
            // Nobody waits any longer where another picture has come meanwhile.
            let _ = done.send((scene, placed));
        };
        self.waiting = Some(waiting);
        if std::thread::Builder::new()
            .name("layout".into())
            .spawn(work)
            .is_err()
        {
            self.waiting = None;
        }
        Change::None
    }

    fn received(&mut self) -> Option<Change> {
        match self.waiting.as_ref()?.try_recv() {
            Ok((scene, placed)) => {
                self.waiting = None;
                self.take(scene, placed.at, placed.lanes);
                Some(Change::Arranged)
            }
            Err(TryRecvError::Empty) => None,
            Err(TryRecvError::Disconnected) => {
                self.waiting = None;
                None
            }
        }
    }

    /// Whether a layout is being made.
    pub fn is_waiting(&self) -> bool {
        self.waiting.is_some()
    }

    fn take(&mut self, scene: Scene, corners: Vec<Vec2>, lanes: Vec<Vec<[Vec2; 2]>>) {
        self.seating = Seating::new(&scene, &corners, &lanes);
        for (shown, corner) in scene.boxes.iter().zip(corners) {
            self.spots.insert(shown.name.clone(), corner);
        }
        self.lanes = lanes;
        self.scene = scene;
    }

    /// Lays everything out anew at the next look, whatever hands have moved.
    pub fn lay_out(&mut self) {
        self.anew = true;
        self.stale = true;
    }

    /// Where a box of this name is to lie when it comes.
    pub fn expect(&mut self, name: Name, at: Vec2) {
        self.spots.insert(name, at.round());
    }

    /// Lays a box that is not wired yet on the table.
    pub fn add_guest(&mut self, name: Name, at: Vec2) {
        self.expect(name.clone(), at);
        self.guests.insert(name);
        self.stale = true;
    }

    /// Takes such a box away again.
    pub fn remove_guest(&mut self, name: &Name) {
        self.stale |= self.guests.remove(name);
    }

    /// Moves boxes; their wires follow.
    pub fn shift(&mut self, boxes: &BTreeSet<usize>, by: Vec2) {
        for &index in boxes {
            if let (Some(area), Some(shown)) =
                (self.seating.areas.get_mut(index), self.scene.boxes.get(index))
            {
                *area = Area::new(area.min + by, area.size());
                self.spots.insert(shown.name.clone(), area.min);
            }
        }
        for (index, wire) in self.scene.wires.iter().enumerate() {
            if boxes.contains(&wire.from.0) || boxes.contains(&wire.to.0) {
                if let Some(lanes) = self.lanes.get_mut(index) {
                    lanes.clear();
                }
                self.seating.routes[index] = self.seating.route(&self.scene, index, &[]);
            }
        }
        for (frame, (_, area)) in self.scene.frames.iter().zip(&mut self.seating.frames) {
            let members = frame.members.iter().map(|&member| self.seating.areas[member]);
            if let Some(around) = layout::frame_around(members) {
                *area = around;
            }
        }
    }

    /// The structures that are folded.
    pub fn is_folded(&self, structure: &Name) -> bool {
        self.folded.contains(structure)
    }

    /// Folds a structure into one box where its frame was; or unfolds it, making room where there is none.
    pub fn fold(&mut self, structure: &Name, on: bool) {
        let Some(picture) = self
            .picture
            .clone()
            .filter(|_| self.folded.contains(structure) != on)
        else {
            return;
        };
        let area = self.extent_of(structure).unwrap_or_default();
        self.stale = true;
        if on {
            self.folded.insert(structure.clone());
            self.homes.insert(structure.clone(), area.min);
            self.spots.insert(structure.clone(), area.min);
            return;
        }
        self.folded.remove(structure);
        let scene = Scene::new(&picture, &self.folded, &self.guests);
        let members = self.seat_members(&scene, structure, area.min);
        let areas = members.iter().filter_map(|&m| {
            Some(Area::new(
                *self.spots.get(&scene.boxes[m].name)?,
                scene.boxes[m].size,
            ))
        });
        if let Some(frame) = layout::frame_around(areas) {
            self.make_room(&scene, &members, area, frame);
        }
    }

    /// Puts the boxes of an unfolded structure where they were before, or else where a layout wants them, its frame
    /// beginning at `corner`. Returns their places in the scene.
    fn seat_members(&mut self, scene: &Scene, structure: &Name, corner: Vec2) -> Vec<usize> {
        let inside = |&index: &usize| scene.boxes[index].structure.as_ref() == Some(structure);
        let members: Vec<usize> = (0..scene.boxes.len()).filter(inside).collect();
        let known = members
            .iter()
            .all(|&m| self.spots.contains_key(&scene.boxes[m].name));
        if let Some(home) = self.homes.get(structure).copied().filter(|_| known) {
            for &member in &members {
                if let Some(spot) = self.spots.get_mut(&scene.boxes[member].name) {
                    *spot += corner - home;
                }
            }
            return members;
        }
        let fresh = layout::arrange_scene(scene, &|_| None);
        let areas = members
            .iter()
            .map(|&m| Area::new(fresh.at[m], scene.boxes[m].size));
        let origin = layout::frame_around(areas).unwrap_or_default().min;
        for &member in &members {
            let name = scene.boxes[member].name.clone();
            self.spots.insert(name, fresh.at[member] - origin + corner);
        }
        members
    }

    /// Where a frame that was one box would cover others, all that is to its right goes to the right, and all that
    /// is below it goes down.
    fn make_room(&mut self, scene: &Scene, members: &[usize], old: Area, frame: Area) {
        let others: Vec<usize> = (0..scene.boxes.len())
            .filter(|index| !members.contains(index))
            .collect();
        let area = |spots: &BTreeMap<Name, Vec2>, index: usize| {
            let shown = &scene.boxes[index];
            spots.get(&shown.name).map(|&at| Area::new(at, shown.size))
        };
        let covered = others
            .iter()
            .any(|&index| area(&self.spots, index).is_some_and(|a| a.meets(frame)));
        if !covered {
            return;
        }
        let growth = frame.size() - old.size();
        for &index in &others {
            let Some(there) = area(&self.spots, index) else {
                continue;
            };
            let same_columns = there.min.x < frame.max.x && there.max.x > frame.min.x;
            let by = if there.min.x >= old.max.x {
                Vec2::new(growth.x, 0.0)
            } else if there.min.y >= old.max.y && same_columns {
                Vec2::new(0.0, growth.y)
            } else {
                continue;
            };
            if let Some(spot) = self.spots.get_mut(&scene.boxes[index].name) {
                *spot += by;
            }
        }
    }

    /// What a structure covers now, folded or not.
    fn extent_of(&self, structure: &Name) -> Option<Area> {
        let frame = self
            .seating
            .frames
            .iter()
            .find(|(name, _)| name == structure)
            .map(|(_, area)| *area);
        frame.or_else(|| self.seating.areas.get(self.scene.find(structure)?).copied())
    }
}

/// The lanes of wires that are in both scenes between the same places.
fn kept_lanes(old: &Scene, lanes: &[Vec<[Vec2; 2]>], new: &Scene) -> Vec<Vec<[Vec2; 2]>> {
    let ends = |scene: &Scene, index: usize| {
        let wire = scene.wires[index];
        let (from, to) = (&scene.boxes[wire.from.0], &scene.boxes[wire.to.0]);
        (from.name.clone(), wire.from.1, to.name.clone(), wire.to.1)
    };
    let known: BTreeMap<_, usize> = (0..old.wires.len())
        .map(|index| (ends(old, index), index))
        .collect();
    (0..new.wires.len())
        .map(|index| {
            let before = known.get(&ends(new, index));
            before
                .and_then(|&before| lanes.get(before))
                .cloned()
                .unwrap_or_default()
        })
        .collect()
}
