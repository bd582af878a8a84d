//! What waits at the inputs, and who is ready to fire.
//!
//! Only what every message touches: all else about an instance is kept apart from it.
//! Source: `docs/protocols/ps300.md`, "Tokens, queues, firing"; the layout is explained in
//! `docs/decisions/0014-memory-of-the-network.md`.

use std::collections::BTreeSet;

use super::Limits;
use super::connection::InstanceId;
use super::port::InputPort;
use super::ring::Ring;
use super::token::Token;
use crate::intrinsic::{Preset, Scalar};
use crate::language::Input;
use crate::value::{Kinds, Value};

/// What delivering to an instance and firing it need to know.
#[derive(Clone, Copy, Default)]
pub(super) struct Head {
    /// What it does if all inputs are real numbers.
    pub(super) scalar: Option<Scalar>,
    pub(super) first_input: u32,
    pub(super) first_output: u32,
    pub(super) input_count: u8,
    pub(super) output_count: u8,
    /// How many inputs still keep it from firing.
    pub(super) missing: u8,
    /// Of a sized type; 0 for others.
    pub(super) size: u8,
    /// Whether any one message sets it off.
    pub(super) each: bool,
    /// Whether it is in the run queue.
    pub(super) queued: bool,
    /// The one input that is active, from 1; 0 where there is another number of them.
    pub(super) sole: u8,
}

impl Head {
    pub(super) fn inputs(&self) -> std::ops::Range<usize> {
        let first = self.first_input as usize;
        first..first + usize::from(self.input_count)
    }

    pub(super) fn outputs(&self) -> std::ops::Range<usize> {
        let first = self.first_output as usize;
        first..first + usize::from(self.output_count)
    }
}

/// Why a message was not simply put into an empty queue.
#[derive(Clone, Copy)]
pub(super) enum Hindrance {
    /// The input takes only these.
    Kind(Kinds),
    /// The input is constant.
    Constant,
    /// Others are waiting there.
    Occupied,
}

/// A queue that could not take a message.
#[derive(Clone, Copy)]
pub(super) enum Full {
    Queue,
    Network,
}

/// The inputs of all instances and the run queue.
pub(super) struct Queues {
    pub(super) heads: Vec<Head>,
    pub(super) inputs: Vec<InputPort>,
    pub(super) ready: Ring,
    /// Messages waiting behind another.
    behind: usize,
    queue_max: usize,
    behind_max: usize,
}

impl Queues {
    pub(super) fn new(limits: &Limits) -> Self {
        Self {
            heads: Vec::new(),
            inputs: Vec::new(),
            ready: Ring::default(),
            behind: 0,
            queue_max: limits.queue_max,
            behind_max: limits.behind_max,
        }
    }

    pub(super) fn head(&self, id: InstanceId) -> Option<&Head> {
        self.heads.get(id.0 as usize)
    }

    /// The inputs of an instance.
    pub(super) fn ports(&self, id: InstanceId) -> &[InputPort] {
        self.head(id)
            .and_then(|head| self.inputs.get(head.inputs()))
            .unwrap_or_default()
    }

    fn ports_mut(&mut self, id: InstanceId) -> &mut [InputPort] {
        let inputs = self.heads.get(id.0 as usize).map(Head::inputs);
        inputs
            .and_then(|inputs| self.inputs.get_mut(inputs))
            .unwrap_or_default()
    }

    /// Puts a message into an empty queue, or says what else there is to do.
    #[inline]
    pub(super) fn deliver(&mut self, to: InstanceId, input: u8, token: &impl Token) -> Result<(), Hindrance> {
        let Some(head) = self.heads.get_mut(to.0 as usize) else {
            return Ok(());
        };
        let number = input.wrapping_sub(1);
        if number >= head.input_count {
            return Ok(());
        }
        let Some(port) = self
            .inputs
            .get_mut(head.first_input as usize + usize::from(number))
        else {
            return Ok(());
        };
        if !port.kinds.has(token.kind()) {
            return Err(Hindrance::Kind(port.kinds));
        }
        if !port.take_first(token) {
            return Err(if port.constant {
                Hindrance::Constant
            } else {
                Hindrance::Occupied
            });
        }
        head.missing = head.missing.saturating_sub(1);
        if (head.missing == 0 || head.each) && !head.queued {
            head.queued = true;
            self.ready.push(to);
        }
        Ok(())
    }

    /// Puts a message behind others.
    pub(super) fn deliver_behind(&mut self, to: InstanceId, input: u8, value: Value) -> Result<(), Full> {
        let (behind, behind_max, queue_max) = (self.behind, self.behind_max, self.queue_max);
        let Some(port) = self.port_mut(to, input) else {
            return Ok(());
        };
        if port.waiting() >= queue_max {
            return Err(Full::Queue);
        }
        if behind >= behind_max {
            return Err(Full::Network);
        }
        port.push_behind(value);
        self.behind += 1;
        Ok(())
    }

    /// Replaces a constant.
    pub(super) fn hold(&mut self, to: InstanceId, input: u8, value: Value) {
        let Some(port) = self.port_mut(to, input) else {
            return;
        };
        let satisfied = port.satisfied();
        port.hold(value);
        if !satisfied && let Some(head) = self.heads.get_mut(to.0 as usize) {
            head.missing = head.missing.saturating_sub(1);
            self.enqueue_if_ready(to);
        }
    }

    /// The first message that waits for an instance, and where.
    pub(super) fn first_waiting(&self, id: InstanceId) -> Option<(Option<Input>, Value)> {
        let mut waiting = (1..).zip(self.ports(id)).filter(|(_, port)| !port.constant);
        let (number, value) = waiting.find_map(|(number, port)| Some((number, port.front()?)))?;
        Some((Some(Input::Number(number)), value.clone()))
    }

    fn port_mut(&mut self, of: InstanceId, input: u8) -> Option<&mut InputPort> {
        self.ports_mut(of).get_mut(usize::from(input).checked_sub(1)?)
    }

    pub(super) fn is_ready(&self, id: InstanceId) -> bool {
        let Some(head) = self.head(id) else {
            return false;
        };
        head.missing == 0 || (head.each && self.ports(id).iter().any(|port| port.waiting() > 0))
    }

    pub(super) fn enqueue_if_ready(&mut self, id: InstanceId) {
        if self.is_ready(id)
            && let Some(head) = self.heads.get_mut(id.0 as usize)
            && !head.queued
        {
            head.queued = true;
            self.ready.push(id);
        }
    }

    /// What an instance that works on real numbers sends, if that is what waits; then its inputs are settled.
    #[inline]
    pub(super) fn fire_scalar(&mut self, id: InstanceId) -> Option<(u32, f64)> {
        let head = self.heads.get_mut(id.0 as usize)?;
        let scalar = head.scalar?;
        let ports = self.inputs.get_mut(head.inputs())?;
        let behind = &mut self.behind;
        let mut take = |port: &mut InputPort| {
            if port.constant {
            } else if port.pop_real() {
                *behind -= 1;
            } else {
                head.missing += 1;
            }
        };
        let result = match ports {
            [only] => {
                let result = scalar(only.real()?, 0.0);
                take(only);
                result
            }
            [first, second] => {
                let result = scalar(first.real()?, second.real()?);
                take(first);
                take(second);
                result
            }
            _ => return None,
        };
        if head.missing == 0 {
            head.queued = true;
            self.ready.push(id);
        }
        Some((head.first_output, result))
    }

    /// Takes one message from every active queue, or of an instance that any one message sets off, that one.
    /// Then it is ready again if others had been waiting behind.
    #[inline]
    pub(super) fn consume(&mut self, id: InstanceId) {
        let Some(head) = self.heads.get_mut(id.0 as usize) else {
            return;
        };
        let Some(sole) = head.sole.checked_sub(1).filter(|_| head.missing == 0) else {
            return self.consume_each(id);
        };
        if let Some(port) = self.inputs.get_mut(head.first_input as usize + usize::from(sole)) {
            if !port.pop() {
                head.missing = 1;
                return;
            }
            self.behind -= 1;
            if !head.queued {
                head.queued = true;
                self.ready.push(id);
            }
        }
    }

    fn consume_each(&mut self, id: InstanceId) {
        let Some(head) = self.heads.get_mut(id.0 as usize) else {
            return;
        };
        let ports = self.inputs.get_mut(head.inputs()).unwrap_or_default();
        let taken_from = if head.each { 1 } else { ports.len() };
        let waiting = ports
            .iter_mut()
            .filter(|port| !port.constant && port.front().is_some());
        for port in waiting.take(taken_from) {
            if port.pop() {
                self.behind -= 1;
            } else {
                head.missing = head.missing.saturating_add(1);
            }
        }
        self.enqueue_if_ready(id);
    }

    /// Takes the one message that did not fit: at `input`, or, where that is a constant, at the first
    /// active input.
    pub(super) fn consume_offending(&mut self, id: InstanceId, input: u8) {
        let blamed = usize::from(input).wrapping_sub(1);
        let ports = self.ports(id);
        let at = match ports.get(blamed) {
            Some(port) if !port.constant => Some(blamed),
            _ => ports.iter().position(|port| !port.constant),
        };
        if let Some(at) = at {
            self.pop(id, at);
        }
        self.enqueue_if_ready(id);
    }

    fn pop(&mut self, id: InstanceId, at: usize) {
        let Some(head) = self.heads.get_mut(id.0 as usize) else {
            return;
        };
        let Some(port) = self.inputs.get_mut(head.first_input as usize + at) else {
            return;
        };
        if port.waiting() == 0 {
        } else if port.pop() {
            self.behind -= 1;
        } else {
            head.missing = head.missing.saturating_add(1);
        }
    }

    /// Makes an input constant or active; false if there is no such input.
    pub(super) fn set_constant(&mut self, id: InstanceId, input: u8, constant: bool, preset: Preset) -> bool {
        let Some(port) = self.port_mut(id, input) else {
            return false;
        };
        self.behind -= port.make_constant(constant, preset);
        self.recount(id);
        self.enqueue_if_ready(id);
        true
    }

    pub(super) fn recount(&mut self, id: InstanceId) {
        let ports = self.ports(id);
        let unsatisfied = ports.iter().filter(|port| !port.satisfied()).count();
        // If all are constant, nothing is left that could set it off.
        let missing = unsatisfied + usize::from(ports.iter().all(|port| port.constant));
        let mut active = (1..).zip(ports).filter(|(_, port)| !port.constant);
        let sole = match (active.next(), active.next()) {
            (Some((number, _)), None) => number,
            _ => 0,
        };
        if let Some(head) = self.heads.get_mut(id.0 as usize) {
            head.missing = missing as u8;
            head.sole = sole;
        }
    }

    /// Forgets all that waits for some instances. Their ports are left vacant.
    pub(super) fn clear(&mut self, ids: &BTreeSet<InstanceId>) {
        let mut any_queued = false;
        for &id in ids {
            let behind: usize = self.ports(id).iter().map(InputPort::behind).sum();
            self.behind -= behind;
            self.ports_mut(id).fill_with(InputPort::vacant);
            if let Some(head) = self.heads.get_mut(id.0 as usize) {
                any_queued |= head.queued;
                *head = Head::default();
            }
        }
        if any_queued {
            self.ready.retain(|id| !ids.contains(&id));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::intrinsic::{Does, InputSpec, Inputs, Outputs, Sent, table};

    const NUMBERS: [f64; 9] = [
        0.0,
        -0.0,
        1.5,
        -2.0,
        1e-300,
        1e300,
        -1e308,
        f64::MAX,
        f64::MIN_POSITIVE,
    ];

    /// What the function's own rule sends.
    fn ruled(does: &Does, numbers: &[f64]) -> Vec<(u8, Value)> {
        let Does::Pure(fire) = does else {
            panic!("it has a memory")
        };
        let ports: Vec<_> = numbers
            .iter()
            .map(|number| {
                let mut port = InputPort::new(InputSpec::active(Kinds::ANY));
                port.take_first(number);
                port
            })
            .collect();
        let (mut sent, mut errands) = (Sent::default(), Vec::new());
        let mut outputs = Outputs::new(&mut [], &mut sent, &mut errands);
        assert_eq!(fire(&Inputs::new(&ports, 0), &mut outputs), Ok(()));
        assert!(errands.is_empty());
        assert!(sent.outputs.iter().all(|output| output & Sent::APART != 0));
        let outputs = sent.outputs.iter().map(|output| *output as u8);
        outputs.zip(sent.apart).collect()
    }

    #[test]
    fn what_every_message_touches_is_small() {
        assert_eq!(size_of::<Head>(), 24);
        assert_eq!(size_of::<InputPort>(), 48);
        assert_eq!(size_of::<super::super::OutputPort>(), 64);
    }

    #[test]
    fn short_cuts_for_real_numbers_lead_where_the_rules_do() {
        let mut count = 0;
        for spec in table() {
            let Some(scalar) = spec.scalar else { continue };
            count += 1;
            for a in NUMBERS {
                for b in NUMBERS {
                    let numbers = if spec.inputs.len() == 1 {
                        vec![a]
                    } else {
                        vec![a, b]
                    };
                    let short = scalar(a, b);
                    let [(1, Value::Real(long))] = ruled(&spec.does, &numbers)[..] else {
                        panic!("F:{} does not send one real number", spec.name)
                    };
                    assert_eq!(short.to_bits(), long.to_bits(), "F:{} of {a} and {b}", spec.name);
                }
            }
        }
        assert_eq!(count, 10);
    }
}
