//! What instances ask of the picture after firing: picks and transforms.
//!
//! Apart from `run` because only few functions look, and what they see is the surroundings' business.

use glam::DVec2;

use super::connection::{InstanceId, Outlet};
use super::{Cause, Network, Surroundings};
use crate::intrinsic::Look;
use crate::language::Input;
use crate::value::Value;

/// Half the size of the pick window where nothing else was sent. Source: D0 sends (0.01, 0.01).
const HALF_SIZE: DVec2 = DVec2::splat(0.01);

impl Network {
    pub(super) fn look(&mut self, from: InstanceId, look: Look, outside: &mut impl Surroundings) {
        match look {
            Look::Pick { detailed, last } => {
                let window = self.pick_window(outside);
                let picks = outside.picks(window, detailed);
                let outlet = |output| Outlet { from, output };
                if !picks.is_empty() {
                    if let Some(behaviour) = self.behaviours.get_mut(from.0 as usize) {
                        behaviour.found();
                    }
                    self.send_out(outlet(1), Value::Picks(picks), outside);
                } else if last {
                    self.send_out(outlet(2), Value::Boolean(false), outside);
                }
            }
            Look::Transform { name, to, part } => match outside.transform(&name, part) {
                Ok(value) => {
                    self.send_out(Outlet { from, output: 1 }, value.clone(), outside);
                    if let Some(to) = to {
                        self.put(from, &to, &value, outside);
                    }
                }
                Err(why) => self.report(from, Cause::Domain { why }),
            },
        }
    }

    /// The constants of PICK_LOCATION; until its middle was sent, the place of the tablet.
    fn pick_window(&self, outside: &impl Surroundings) -> [DVec2; 2] {
        let vector = |value: Option<&Value>| match value {
            Some(Value::Vector2(v)) => Some(*v),
            _ => None,
        };
        let location = outside.device("PICK_LOCATION").and_then(|id| self.instance(id));
        let held = |number| location.and_then(|it| vector(it.held_if_set(number)));
        let tablet = outside.device("TABLETIN").and_then(|id| self.instance(id));
        let middle = held(1).or_else(|| vector(tablet.and_then(|it| it.output_last(1))));
        [
            middle.unwrap_or(DVec2::ZERO),
            held(2).map_or(HALF_SIZE, DVec2::abs),
        ]
    }

    /// Puts a matrix or a list into a node known by name.
    fn put(&mut self, from: InstanceId, to: &str, value: &Value, outside: &mut impl Surroundings) {
        let list = matches!(value, Value::Vectors(_));
        let input = if list { Input::Append } else { Input::Number(1) };
        let Some(inlet) = outside.inlet(to, input) else {
            let name = to.to_owned();
            return self.report(from, Cause::Unknown { name });
        };
        if list && let Some(clear) = outside.inlet(to, Input::Clear) {
            self.deliver(clear, &Value::Boolean(true), outside);
        }
        self.deliver(inlet, value, outside);
    }
}
