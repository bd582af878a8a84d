//! The one name space that functions, nodes, devices and host parameters share.
//!
//! A name is an entry of its own, and display nodes refer to entries: redefining a name changes what
//! every reference to it means, FORGET takes the name away and leaves the references.
//! Source: `docs/protocols/ps300.md`, "Two graphs sharing one name space" and "Commands".

use std::collections::BTreeMap;

use crate::language::{Name, Spelling};
use crate::network::{InstanceId, Made, SinkId};
use crate::structure::NodeId;

/// A name's entry; stays valid as long as the machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct NameId(pub(crate) u32);

/// What a name denotes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Thing {
    Instance(InstanceId),
    Node(NodeId),
    Sink(SinkId),
}

/// Who gave a name its meaning, and so may take it away.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Owner {
    /// A definition; another may replace it.
    Commands,
    /// The machine or the host; commands leave it alone.
    Machine,
    /// A label inside a structure, with which it comes and goes.
    Structure,
}

/// One name, or what is left of it after FORGET.
pub(crate) struct Entry {
    /// As first written.
    pub(crate) name: Name,
    pub(crate) thing: Option<Thing>,
    pub(crate) owner: Owner,
    /// Whether display nodes refer to it, or did.
    pub(crate) referenced: bool,
    /// Whether the name still leads here.
    pub(crate) known: bool,
    /// Counts definitions; listings are in this order.
    pub(crate) defined: u64,
    /// The command that defined it.
    pub(crate) made: Option<Made>,
}

/// All names.
#[derive(Default)]
pub(crate) struct Names {
    entries: Vec<Entry>,
    by_name: BTreeMap<Name, NameId>,
    definitions: u64,
    /// The command that defines what is being defined.
    pub(crate) making: Option<Made>,
}

impl Names {
    pub(crate) fn entry(&self, id: NameId) -> &Entry {
        &self.entries[id.0 as usize] // Ids come from `intern` only and entries are never removed.
    }

    fn entry_mut(&mut self, id: NameId) -> &mut Entry {
        &mut self.entries[id.0 as usize] // As above.
    }

    pub(crate) fn find(&self, name: &Name) -> Option<NameId> {
        self.by_name.get(name).copied()
    }

    /// The thing a text names.
    pub(crate) fn named(&self, text: &str) -> Option<Thing> {
        let id = self.by_name.get(&text as &Spelling<'_>).copied()?;
        self.entry(id).thing
    }

    /// The thing `name` denotes.
    pub(crate) fn thing(&self, name: &Name) -> Option<Thing> {
        self.find(name).and_then(|id| self.entry(id).thing)
    }

    /// The thing an entry denotes.
    pub(crate) fn denoted(&self, id: NameId) -> Option<Thing> {
        self.entry(id).thing
    }

    /// The node an entry denotes.
    pub(crate) fn node(&self, id: NameId) -> Option<NodeId> {
        match self.entry(id).thing {
            Some(Thing::Node(node)) => Some(node),
            _ => None,
        }
    }

    /// The entry of `name`, made if there is none.
    pub(crate) fn intern(&mut self, name: &Name) -> NameId {
        if let Some(id) = self.find(name) {
            return id;
        }
        let id = NameId(self.entries.len() as u32);
        self.entries.push(Entry {
            name: name.clone(),
            thing: None,
            owner: Owner::Commands,
            referenced: false,
            known: true,
            defined: 0,
            made: None,
        });
        self.by_name.insert(name.clone(), id);
        id
    }

    /// The same, noting that a display node refers to it.
    pub(crate) fn refer(&mut self, name: &Name) -> NameId {
        let id = self.intern(name);
        self.entry_mut(id).referenced = true;
        id
    }

    pub(crate) fn define(&mut self, name: &Name, thing: Thing) -> NameId {
        let id = self.intern(name);
        self.definitions += 1;
        let (defined, made) = (self.definitions, self.making.clone());
        let entry = self.entry_mut(id);
        entry.thing = Some(thing);
        entry.defined = defined;
        entry.made = made;
        entry.owner = Owner::Commands;
        id
    }

    /// Defines the label of a structure's member by its full name.
    pub(crate) fn define_label(&mut self, name: &Name, thing: Thing) {
        let id = self.define(name, thing);
        self.entry_mut(id).owner = Owner::Structure;
    }

    /// Defines what commands may not redefine.
    pub(crate) fn fix(&mut self, name: &Name, thing: Thing) {
        let id = self.define(name, thing);
        self.entry_mut(id).owner = Owner::Machine;
    }

    /// The name stays and denotes nothing.
    pub(crate) fn clear(&mut self, id: NameId) {
        let entry = self.entry_mut(id);
        entry.thing = None;
        entry.made = None;
        entry.owner = Owner::Commands;
    }

    /// The entry stays and the name leads to it no longer.
    pub(crate) fn forget(&mut self, id: NameId) {
        let name = self.entry(id).name.clone();
        self.by_name.remove(&name);
        self.entry_mut(id).known = false;
    }

    /// Takes FORGET back, unless the name leads elsewhere by now.
    pub(crate) fn remember(&mut self, id: NameId) {
        let name = self.entry(id).name.clone();
        self.by_name.entry(name).or_insert(id);
        let leads_here = self.find(&self.entry(id).name) == Some(id);
        self.entry_mut(id).known = leads_here;
    }

    /// Takes FORGET back for a name whose thing is gone, so that what still refers to it finds the next.
    pub(crate) fn revive(&mut self, name: &Name) {
        let is_left = |entry: &Entry| !entry.known && entry.thing.is_none() && entry.name == *name;
        if let Some(at) = self.entries.iter().position(is_left) {
            self.remember(NameId(at as u32));
        }
    }

    /// Gives entries their places in listings, as if they had just been defined in this order.
    pub(crate) fn reorder(&mut self, order: &[NameId]) {
        for &id in order {
            self.definitions += 1;
            self.entry_mut(id).defined = self.definitions;
        }
    }

    /// The name of an entry; for one that was forgotten, a name nothing else bears: its own where that is free.
    pub(crate) fn spelling(&self, id: NameId) -> Name {
        let entry = self.entry(id);
        if entry.known {
            return entry.name.clone();
        }
        // Of several forgotten ones of one name one keeps it: one that denotes something, the oldest.
        let rank = |at: usize, entry: &Entry| (entry.thing.is_none(), at);
        let own = rank(id.0 as usize, entry);
        let taken = |name: &Name| {
            let others = self
                .entries
                .iter()
                .enumerate()
                .filter(|(at, _)| *at != id.0 as usize);
            let mut forgotten = others.filter(|(_, other)| !other.known && other.name == *name);
            let is_own = entry.name == *name;
            self.by_name.contains_key(name) || forgotten.any(|(at, other)| !is_own || rank(at, other) < own)
        };
        let mut spare = entry.name.clone();
        if taken(&spare) {
            spare = Name::new(&format!("{spare}${}", id.0));
        }
        while taken(&spare) {
            spare = Name::new(&format!("{spare}$"));
        }
        spare
    }

    /// Every entry that denotes something commands made, in the order of definition.
    pub(crate) fn defined(&self) -> Vec<NameId> {
        let mut ids: Vec<_> = (0..self.entries.len() as u32)
            .map(NameId)
            .filter(|&id| self.entry(id).thing.is_some() && self.entry(id).owner != Owner::Machine)
            .collect();
        ids.sort_by_key(|&id| self.entry(id).defined);
        ids
    }

    /// The names that the machine and the host have given.
    pub(crate) fn fixed(&self) -> impl Iterator<Item = (&Name, Thing)> {
        let machine = self.entries.iter().filter(|entry| entry.owner == Owner::Machine);
        machine.filter_map(|entry| Some((&entry.name, entry.thing?)))
    }

    /// Every known name that begins so, whatever it denotes.
    pub(crate) fn beginning(&self, prefix: &Name) -> Vec<NameId> {
        let prefix = prefix.as_str();
        self.by_name
            .iter()
            .filter(|(name, _)| {
                let start = name.as_str().as_bytes().get(..prefix.len());
                start.is_some_and(|start| start.eq_ignore_ascii_case(prefix.as_bytes()))
            })
            .map(|(_, &id)| id)
            .collect()
    }

    /// Names that might have been meant by one that denotes nothing, at most three.
    pub(crate) fn alike(&self, name: &Name) -> Vec<Name> {
        if self.by_name.len() > COMPARED_MAX {
            return Vec::new();
        }
        let limit = (name.as_str().len() / 3).clamp(1, 3);
        let mut near: Vec<_> = self
            .by_name
            .iter()
            .filter(|&(_, &id)| self.entry(id).thing.is_some())
            .filter_map(|(known, _)| {
                let far = distance(known.as_str(), name.as_str(), limit)?;
                Some((far, known.clone()))
            })
            .collect();
        near.sort();
        near.into_iter().take(3).map(|(_, name)| name).collect()
    }
}

/// In larger name spaces nothing is suggested: comparing would take longer than looking.
const COMPARED_MAX: usize = 4096;

/// How many letters must change, at most `limit`; case does not count. Long names are not compared.
pub(crate) fn distance(a: &str, b: &str, limit: usize) -> Option<usize> {
    if a.len().abs_diff(b.len()) > limit || a.len() > 40 {
        return None;
    }
    let (a, b) = (a.to_ascii_lowercase(), b.to_ascii_lowercase());
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, x) in a.bytes().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, y) in b.bytes().enumerate() {
            let above = row[j + 1];
            row[j + 1] = (diagonal + usize::from(x != y)).min(above + 1).min(row[j] + 1);
            diagonal = above;
        }
    }
    row.last().copied().filter(|&far| far <= limit)
}
