//! What functions and data nodes remember: running sums, clocks, the last value passed, ink.
//!
//! Apart from constants and waiting messages, which commands can make again without knowing the function.

use super::execute::Done;
use super::{ExecuteError, Machine};
use crate::language::Name;
use crate::names::Thing;
use crate::network::Instance;
use crate::value::Value;

impl Machine {
    /// What the function `name` remembers beyond its inputs. Empty: it is as new, or it never remembers
    /// anything, or it is no function.
    pub fn remembered(&self, name: &str) -> Vec<Value> {
        match self.names.named(name) {
            Some(Thing::Instance(id)) => self
                .network
                .instance(id)
                .map_or_else(Vec::new, Instance::remembered),
            _ => Vec::new(),
        }
    }

    /// Makes the function `name` remember what [`Machine::remembered`] gave of another of its type. Set the
    /// constants before: some restart it. False, and nothing has changed, where it does not fit.
    pub fn recall(&mut self, name: &str, state: &[Value]) -> bool {
        match self.names.named(name) {
            Some(Thing::Instance(id)) => self.network.recall(id, state),
            _ => false,
        }
    }

    pub(super) fn setup_state(&mut self, name: &Name, values: &[Value]) -> Done {
        let fits = match self.thing(name)? {
            Thing::Instance(id) => self.network.recall(id, values),
            Thing::Node(id) => self.structure.recall(id, values),
            Thing::Sink(_) => false,
        };
        if fits {
            Ok(())
        } else {
            Err(ExecuteError::State { name: name.clone() })
        }
    }
}
