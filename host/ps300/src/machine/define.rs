//! Definitions: function instances, variables, and parts of the display tree with their members.
//!
//! A definition either happens or leaves everything as it was: what can be wrong is found out before anything is
//! taken away. A function among the members of a structure is the instance `structure.label`; it comes and goes
//! with the structure.

use std::collections::BTreeMap;

use super::execute::Done;
use super::{ExecuteError, Machine};
use crate::intrinsic::{self, Spec};
use crate::language::{Member, Name, Node};
use crate::names::{Owner, Thing};
use crate::network::{InstanceId, Role};
use crate::structure::{BuildError, NodeId, Structure, reaches};

/// Instances that a structure made anew takes over from the one it replaces, by full name.
pub(super) type Kept = BTreeMap<Name, InstanceId>;

impl Machine {
    pub(super) fn define_function(&mut self, name: &Name, function: &Name, size: Option<u16>) -> Done {
        self.free(name)?;
        let (spec, size) = function_of(function, size)?;
        self.make(name, spec, size, Role::Function)
    }

    pub(super) fn define_variable(&mut self, name: &Name) -> Done {
        self.free(name)?;
        self.make(name, &intrinsic::VARIABLE, None, Role::Variable)
    }

    fn make(&mut self, name: &Name, spec: &'static Spec, size: Option<u8>, role: Role) -> Done {
        self.clear(name);
        let written = self.written(name);
        let Some(id) = self.network.add(written, spec, size, role) else {
            return Err(self.full());
        };
        let entry = self.names.define(name, Thing::Instance(id));
        self.displayed.retain(|&displayed| displayed != entry); // It is nothing to look at any more.
        Ok(())
    }

    fn full(&self) -> ExecuteError {
        ExecuteError::TooMany {
            max: self.network.limits.instances_max,
        }
    }

    /// The spelling a name was first given.
    fn written(&self, name: &Name) -> Name {
        self.names
            .find(name)
            .map_or_else(|| name.clone(), |id| self.names.entry(id).name.clone())
    }

    pub(super) fn define_node(&mut self, name: &Name, node: &Node) -> Done {
        let copied = self.with_copies(node)?;
        self.define_node_keeping(name, copied.as_ref().unwrap_or(node), &Kept::new())
    }

    /// The same, with functions among the members taken over instead of made.
    pub(super) fn define_node_keeping(&mut self, name: &Name, node: &Node, kept: &Kept) -> Done {
        self.free(name)?;
        Structure::check(node).map_err(|error| build_error(name, error))?;
        let mut functions = BTreeMap::new();
        functions_in(node, &self.written(name), &mut functions)?;
        if functions.len() > self.network.room() {
            return Err(self.full());
        }
        let (id, labelled) = self.build(name, node)?;
        self.clear(name);
        self.names.define(name, Thing::Node(id));
        for (full, id) in labelled {
            self.clear(&full);
            self.names.define_label(&full, Thing::Node(id));
        }
        for (full, (spec, size)) in functions {
            self.house(&full, spec, size, kept);
        }
        Ok(())
    }

    /// Makes the nodes of a definition without giving any name its meaning yet.
    fn build(&mut self, name: &Name, node: &Node) -> Result<(NodeId, Vec<(Name, NodeId)>), ExecuteError> {
        let written = self.written(name);
        let mut labelled = Vec::new();
        let built = self
            .structure
            .build(&written, node, &mut self.names, &mut |full, id| {
                labelled.push((full, id));
            });
        let id = built.map_err(|error| build_error(name, error))?;
        let contains_itself = match self.names.find(name) {
            Some(entry) if self.names.entry(entry).referenced => {
                reaches(&self.structure, &self.names, id, entry)
            }
            _ => false,
        };
        let taken = labelled.iter().find(|(full, _)| {
            self.names
                .find(full)
                .is_some_and(|entry| self.names.entry(entry).owner == Owner::Machine)
        });
        if let Some((full, _)) = taken {
            self.structure.remove(id);
            self.free(full)?;
        }
        if contains_itself {
            self.structure.remove(id);
            return Err(ExecuteError::Cycle { name: name.clone() });
        }
        Ok((id, labelled))
    }

    /// Gives a function label its instance: one that is kept, or a new one.
    fn house(&mut self, full: &Name, spec: &'static Spec, size: Option<u8>, kept: &Kept) {
        self.clear(full);
        let id = match kept.get(full) {
            Some(&id) => Some(id),
            None => self.network.add(full.clone(), spec, size, Role::Function),
        };
        if let Some(id) = id {
            self.names.define_label(full, Thing::Instance(id));
            let entry = self.names.find(full);
            self.displayed.retain(|&displayed| Some(displayed) != entry); // Nor is this.
        }
    }

    /// Removes what a name denotes, with its members and connections, so that it can denote anew.
    pub(super) fn clear(&mut self, name: &Name) {
        if let Some(id) = self.names.find(name) {
            self.delete_all(&[id]);
        }
    }
}

/// The functions among the members of a structure, by full name. Of two members of one label the latter counts.
fn functions_in(
    node: &Node,
    name: &Name,
    found: &mut BTreeMap<Name, (&'static Spec, Option<u8>)>,
) -> Result<(), ExecuteError> {
    let Node::Structure(members) = node else {
        return Ok(());
    };
    for Member { label, node } in members {
        let full = label.as_ref().map(|label| Name::new(&format!("{name}.{label}")));
        match (node, full) {
            (Node::Function { function, size }, Some(full)) => {
                let (spec, size) = function_of(function, *size)?;
                found.insert(full, (spec, size));
            }
            (node, full) => functions_in(node, full.as_ref().unwrap_or(name), found)?,
        }
    }
    Ok(())
}

/// The row of the function table that `F:function(size)` means.
pub(super) fn function_of(
    function: &Name,
    size: Option<u16>,
) -> Result<(&'static Spec, Option<u8>), ExecuteError> {
    let Some(spec) = intrinsic::find(function.as_str()) else {
        return Err(no_function(function));
    };
    let wrong = |wanted| {
        Err(ExecuteError::Size {
            function: spec.name,
            wanted,
        })
    };
    match (spec.sizes, size) {
        (None, None) => Ok((spec, None)),
        (Some((least, most)), Some(size)) if (u16::from(least)..=u16::from(most)).contains(&size) => {
            Ok((spec, Some(size as u8)))
        }
        (Some((least, most)), _) => wrong(format!(
            "needs a size from {least} to {most}: F:{}({least})",
            spec.name
        )),
        (None, Some(_)) => wrong("has no size; leave the brackets out".to_owned()),
    }
}

pub(super) fn build_error(name: &Name, error: BuildError) -> ExecuteError {
    let name = name.clone();
    match error {
        BuildError::NoView(why) => ExecuteError::NoView { name, why },
        BuildError::Depth => ExecuteError::Depth { name },
    }
}

fn no_function(function: &Name) -> ExecuteError {
    let absent = intrinsic::ABSENT
        .iter()
        .find(|absent| absent.name.eq_ignore_ascii_case(function.as_str()));
    if let Some(absent) = absent {
        return ExecuteError::AbsentFunction {
            function: absent.name,
            purpose: absent.purpose,
        };
    }
    let alike = intrinsic::alike(function.as_str())
        .into_iter()
        .map(Name::new)
        .collect();
    ExecuteError::NoFunction {
        function: function.clone(),
        alike,
    }
}
