//! Commands about the display tree: INCLUDE, REMOVE, DISPLAY, PREFIX, FOLLOW.

use super::define::build_error;
use super::execute::Done;
use super::{ExecuteError, Machine};
use crate::language::{Name, Operation};
use crate::names::{NameId, Thing};
use crate::structure::{Body, BuildError, Change, NodeId, reaches};
use crate::value::Value;

impl Machine {
    fn node_named(&self, name: &Name) -> Result<NodeId, ExecuteError> {
        match self.thing(name)? {
            Thing::Node(id) => Ok(id),
            other => {
                let is = self.what_is(other);
                Err(ExecuteError::NotA {
                    name: name.clone(),
                    is,
                    wanted: "part of the display tree",
                })
            }
        }
    }

    /// What `VL(name)` carries.
    pub(super) fn vectors_of(&self, name: &Name) -> Result<Value, ExecuteError> {
        let id = self.node_named(name)?;
        let list = self.structure.vectors(id).ok_or_else(|| ExecuteError::NotA {
            name: name.clone(),
            is: self.structure.what(id),
            wanted: "a VECTOR_LIST",
        })?;
        Ok(list.clone().into())
    }

    fn members(&mut self, instance: &Name) -> Result<&mut Vec<NameId>, ExecuteError> {
        let id = self.node_named(instance)?;
        let not = ExecuteError::NotA {
            name: instance.clone(),
            is: self.structure.what(id),
            wanted: "an INSTANCE",
        };
        match self.structure.slot_mut(id).map(|slot| &mut slot.body) {
            Some(Body::Instance(of)) => Ok(of),
            _ => Err(not),
        }
    }

    pub(super) fn include(&mut self, member: &Name, instance: &Name) -> Done {
        self.members(instance)?;
        let entry = self.names.refer(member);
        let around = self.names.refer(instance);
        let below = self.names.node(entry);
        if entry == around || below.is_some_and(|id| reaches(&self.structure, &self.names, id, around)) {
            return Err(ExecuteError::Cycle {
                name: instance.clone(),
            });
        }
        let members = self.members(instance)?;
        if !members.contains(&entry) {
            members.push(entry);
        }
        Ok(())
    }

    pub(super) fn remove_from(&mut self, member: &Name, instance: &Name) -> Done {
        let entry = self.names.find(member).ok_or_else(|| self.unknown(member))?;
        let members = self.members(instance)?;
        match members.iter().position(|&id| id == entry) {
            Some(at) => {
                members.remove(at);
                Ok(())
            }
            None => Err(ExecuteError::Nothing {
                what: format!("{member} is not in {instance}"),
            }),
        }
    }

    pub(super) fn show(&mut self, name: &Name) -> Done {
        if self.names.thing(name).is_some() {
            self.node_named(name)?;
        }
        let entry = self.names.refer(name);
        if !self.displayed.contains(&entry) {
            self.displayed.push(entry);
            self.structure.revision += 1;
        }
        Ok(())
    }

    pub(super) fn hide(&mut self, name: &Name) -> Done {
        let entry = self.names.find(name).ok_or_else(|| self.unknown(name))?;
        match self.displayed.iter().position(|&id| id == entry) {
            Some(at) => {
                self.displayed.remove(at);
                self.structure.revision += 1;
                Ok(())
            }
            None => Err(ExecuteError::Nothing {
                what: format!("{name} is not displayed"),
            }),
        }
    }

    /// PATTERN list WITH p.
    pub(super) fn dash(&mut self, list: &Name, pattern: &Name) -> Done {
        let id = self.node_named(list)?;
        let with = self.node_named(pattern)?;
        if !matches!(
            self.structure.slot(with).map(|slot| &slot.body),
            Some(Body::Pattern(_))
        ) {
            return Err(ExecuteError::NotA {
                name: pattern.clone(),
                is: self.structure.what(with),
                wanted: "a PATTERN",
            });
        }
        let is = self.structure.what(id);
        let entry = self.names.refer(pattern);
        match self.structure.slot_mut(id).map(|slot| &mut slot.body) {
            Some(Body::Vectors { pattern, .. } | Body::Curve { pattern, .. }) => {
                *pattern = Some(entry);
                Ok(())
            }
            _ => Err(ExecuteError::NotA {
                name: list.clone(),
                is,
                wanted: "a vector list or a curve",
            }),
        }
    }

    /// FOLLOW and PREFIX: both put an operation directly next to the node, so FOLLOW in front of what
    /// followed before, PREFIX behind what was there.
    pub(super) fn insert(
        &mut self,
        name: &Name,
        with: &Operation,
        side: fn(&mut crate::structure::Slot) -> &mut Vec<Change>,
        operation_only: bool,
    ) -> Done {
        let id = self.node_named(name)?;
        let change = Change::new(with.clone(), &mut self.names)
            .map_err(|error| build_error(name, BuildError::from(error)))?;
        let is = self.structure.what(id);
        let Some(slot) = self.structure.slot_mut(id) else {
            return Ok(());
        };
        if operation_only {
            if !matches!(slot.body, Body::Operation { .. }) {
                return Err(ExecuteError::NotA {
                    name: name.clone(),
                    is,
                    wanted: "an operation",
                });
            }
            side(slot).insert(0, change);
        } else {
            side(slot).push(change);
        }
        Ok(())
    }
}
