//! What an intrinsic function is to the network: something that fires on its inputs.
//!
//! Apart from `network` so that a function can be read and tested without queues.

use std::sync::Arc;

use glam::DVec3;

use super::message::Message;
use crate::language::Input;
use crate::network::{InputPort, OutputPort};
use crate::value::{Kind, Kinds, Value};

/// Deterministic, no clock of its own, no I/O: the same messages in give the same messages out.
pub trait Function: Send {
    /// Called once every active input has a message and every required constant a value.
    fn fire(&mut self, inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault>;

    /// A constant input was set. Never sends; most functions look at the value when they fire.
    fn constant_set(&mut self, _number: u8) {}

    /// Network time has moved on. Only clocks do anything.
    fn advance(&mut self, _now: Now, _inputs: &Inputs<'_>, _outputs: &mut Outputs<'_>) -> Result<(), Fault> {
        Ok(())
    }

    /// What it looked for in the picture was there. Only picks that go on looking do anything.
    fn found(&mut self) {}

    /// Everything its future depends on besides its inputs, in values that have literals wherever the
    /// messages it keeps have. Empty: as new.
    fn remembered(&self) -> Vec<Value>;

    /// Takes up what [`Function::remembered`] of an instance of the same type gave. False where that does
    /// not fit; then nothing has changed. Setting constants may restart a function, so set them before.
    fn recall(&mut self, state: &[Value]) -> bool;
}

/// Network time, as the host gives it at each tick.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Now {
    /// Seconds of network time.
    pub secs: f64,
    /// Displayed frames.
    pub frame: u64,
    /// How often the host has ticked the machine.
    pub ticks: u64,
}

impl Now {
    /// Network time in whole microseconds. What measures spans counts in these, so that the parts of a span
    /// add up to it however the host divides its ticks.
    pub fn micros(self) -> u64 {
        (self.secs * 1e6).round().max(0.0) as u64
    }
}

/// Why a firing came to nothing.
#[derive(Clone, Debug, PartialEq)]
pub enum Fault {
    /// The message at this input cannot be combined with the others: it alone is dropped.
    Kind {
        /// From 1.
        input: u8,
        /// What would have fitted.
        expected: Kinds,
    },
    /// The kinds are right, the values have no answer: the set is consumed.
    Domain {
        /// As a clause, for example "division by zero".
        why: &'static str,
    },
}

/// Shorthand for a firing without answer.
pub(crate) fn domain<T>(why: &'static str) -> Result<T, Fault> {
    Err(Fault::Domain { why })
}

/// Text longer than this does not travel: a loop that joins would otherwise fill the memory.
/// The longest real text, the row of key labels, has 96 characters.
pub const TEXT_MAX_BYTES: usize = 4096;

/// The messages a firing consumes and the constants it reads.
#[derive(Clone, Copy)]
pub struct Inputs<'a> {
    ports: &'a [InputPort],
    size: u8,
}

/// Stands in for an input the function does not have.
static NOTHING: Value = Value::Boolean(false);

impl<'a> Inputs<'a> {
    pub(crate) fn new(ports: &'a [InputPort], size: u8) -> Self {
        Self { ports, size }
    }

    /// The size of a sized type, 0 for others.
    pub fn size(&self) -> u8 {
        self.size
    }

    /// How many inputs there are.
    pub fn count(&self) -> u8 {
        self.ports.len() as u8
    }

    /// The message or constant at input `number`; FALSE if the function has no such input.
    #[inline]
    pub fn get(&self, number: u8) -> &'a Value {
        self.find(number).unwrap_or(&NOTHING)
    }

    /// The same, nothing where an optional constant was never set.
    #[inline]
    pub fn find(&self, number: u8) -> Option<&'a Value> {
        self.port(number).and_then(InputPort::front)
    }

    /// Whether a constant holds what somebody sent rather than its default.
    pub fn is_set(&self, number: u8) -> bool {
        self.port(number).is_some_and(InputPort::is_set)
    }

    /// Whether firings leave this input's message in place.
    #[inline]
    pub fn is_constant(&self, number: u8) -> bool {
        self.port(number).is_some_and(|port| port.constant)
    }

    #[inline]
    fn port(&self, number: u8) -> Option<&'a InputPort> {
        self.ports.get(usize::from(number).wrapping_sub(1))
    }

    /// An integer or a real as a real.
    #[inline]
    pub fn number(&self, number: u8) -> Result<f64, Fault> {
        if let Value::Real(x) = self.get(number) {
            return Ok(*x);
        }
        self.get(number).as_number().ok_or(Fault::Kind {
            input: number,
            expected: Kinds::NUMBER,
        })
    }

    /// A number that may be absent.
    #[inline]
    pub fn number_or(&self, number: u8, absent: f64) -> Result<f64, Fault> {
        self.find(number).map_or(Ok(absent), |_| self.number(number))
    }

    /// An integer.
    pub fn integer(&self, number: u8) -> Result<i32, Fault> {
        match self.get(number) {
            Value::Integer(n) => Ok(*n),
            _ => Err(Fault::Kind {
                input: number,
                expected: Kinds::INTEGER,
            }),
        }
    }

    /// A Boolean.
    pub fn boolean(&self, number: u8) -> Result<bool, Fault> {
        match self.get(number) {
            Value::Boolean(b) => Ok(*b),
            _ => Err(Fault::Kind {
                input: number,
                expected: Kinds::BOOLEAN,
            }),
        }
    }

    /// Text.
    pub fn text(&self, number: u8) -> Result<&'a Arc<str>, Fault> {
        match self.get(number) {
            Value::String(text) => Ok(text),
            _ => Err(Fault::Kind {
                input: number,
                expected: Kinds::STRING,
            }),
        }
    }

    /// A 3D vector.
    pub fn vector3(&self, number: u8) -> Result<DVec3, Fault> {
        match self.get(number) {
            Value::Vector3(v) => Ok(*v),
            _ => Err(Fault::Kind {
                input: number,
                expected: Kind::Vector3.into(),
            }),
        }
    }
}

/// What a firing asks of the network beyond its own outputs.
#[derive(Clone, Debug)]
pub(crate) enum Errand {
    /// Deliver `value` to an input known by name only now.
    Send {
        name: Arc<str>,
        input: Input,
        value: Value,
    },
    /// Send on output `output` what the variable `name` holds.
    Fetch { name: Arc<str>, output: u8 },
    /// Look at the picture and send what is there.
    Look(Look),
}

/// What can be seen in the picture.
#[derive(Clone, Debug)]
pub(crate) enum Look {
    /// What is drawn in the pick window: on output 1, or, if this was the `last` try, FALSE on output 2.
    Pick { detailed: bool, last: bool },
    /// What the XFORM node `name` marks: on output 1 and into the node `to`. Of vectors the `part` that begins
    /// with so many left out and has so many.
    Transform {
        name: Arc<str>,
        to: Option<Arc<str>>,
        part: [usize; 2],
    },
}

/// What one firing sent, in the order of the calls. A message mostly lies already where its output keeps its last.
#[derive(Default)]
pub(crate) struct Sent {
    /// On which outputs, from 1; with [`Sent::APART`] for a message that lies apart.
    pub(crate) outputs: Vec<u16>,
    pub(crate) apart: Vec<Value>,
}

impl Sent {
    pub(crate) const APART: u16 = 0x100;

    pub(crate) fn clear(&mut self) {
        self.outputs.clear();
        self.apart.clear();
    }
}

/// Where a firing puts what it sends. Delivered in the order of the calls.
pub struct Outputs<'a> {
    ports: &'a mut [OutputPort],
    sent: &'a mut Sent,
    errands: &'a mut Vec<Errand>,
}

impl<'a> Outputs<'a> {
    pub(crate) fn new(ports: &'a mut [OutputPort], sent: &'a mut Sent, errands: &'a mut Vec<Errand>) -> Self {
        Self { ports, sent, errands }
    }

    /// Sends on output `number`, counted from 1.
    #[inline]
    pub fn send(&mut self, number: u8, value: impl Message) {
        if let Some(port) = self.ports.get_mut(usize::from(number).wrapping_sub(1))
            && value.is_finite()
            && let Some(place) = port.next()
        {
            value.put(place);
            self.sent.outputs.push(number.into());
        } else {
            self.send_apart(number, value.into_value());
        }
    }

    #[cold]
    fn send_apart(&mut self, number: u8, value: Value) {
        self.sent.outputs.push(Sent::APART | u16::from(number));
        self.sent.apart.push(value);
    }

    /// Sends text on output `number`, unless it is too long to travel.
    pub fn send_text(&mut self, number: u8, text: &str) -> Result<(), Fault> {
        if text.len() > TEXT_MAX_BYTES {
            return domain("the text would be longer than 4096 bytes");
        }
        self.send(number, text);
        Ok(())
    }

    pub(crate) fn errand(&mut self, errand: Errand) {
        self.errands.push(errand);
    }
}
