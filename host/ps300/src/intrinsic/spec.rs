//! One row of the function table: what the reference page says about a function, as data.
//!
//! The reference page, `net functions --json` and the network itself read the same rows, so that
//! what is documented is what runs.

use super::function::{Fault, Function, Inputs, Outputs};
use crate::value::{Kinds, Value};

/// A function and what is known of it.
pub struct Spec {
    /// Without `F:`, in capitals.
    pub name: &'static str,
    /// For sized types, the least and the greatest size.
    pub sizes: Option<(u8, u8)>,
    /// In order; a repeated row stands for several inputs.
    pub inputs: &'static [InputSpec],
    /// In order; a repeated row stands for several outputs.
    pub outputs: &'static [OutputSpec],
    /// What it does, in words.
    pub behaviour: &'static str,
    /// Where that is known from.
    pub source: &'static str,
    /// How far it can be relied on.
    pub confidence: Confidence,
    /// What goes into an instance `f` and what comes out: steps with ` | ` between them, ` -> `, messages.
    /// A step is `<2> 10`, sent to an input; `@0.5`, network time passing to 0.5 seconds; `(3)`, the size;
    /// or a command. A message is `<1> 11`, or `<1>g 11` where another instance sends it.
    pub example: &'static str,
    /// Whether any one message sets it off, rather than one at every active input.
    pub(crate) each: bool,
    pub(crate) does: Does,
    /// What it comes to if every input is a real number, for functions of one or two inputs that then send one
    /// real number on output <1> and nothing else. It must agree with `does`.
    pub(crate) scalar: Option<Scalar>,
}

/// A function of real numbers. Of one input, the second argument is nothing.
pub(crate) type Scalar = fn(f64, f64) -> f64;

/// How a firing is computed.
pub(crate) enum Does {
    /// From the inputs alone.
    Pure(fn(&Inputs<'_>, &mut Outputs<'_>) -> Result<(), Fault>),
    /// From the inputs and what the instance remembers. Given the size, 0 for unsized types.
    Stateful(fn(u8) -> Box<dyn Function>),
    /// As `Stateful`, and told of network time.
    Clock(fn(u8) -> Box<dyn Function>),
}

pub(crate) type Fire = fn(&Inputs<'_>, &mut Outputs<'_>) -> Result<(), Fault>;
type Make = fn(u8) -> Box<dyn Function>;

/// Rows are built up; what every row needs is not written out in each.
impl Spec {
    const fn new(
        name: &'static str,
        inputs: &'static [InputSpec],
        outputs: &'static [OutputSpec],
        does: Does,
    ) -> Self {
        Self {
            name,
            sizes: None,
            inputs,
            outputs,
            behaviour: "",
            source: "",
            confidence: Confidence::Project,
            example: "",
            each: false,
            does,
            scalar: None,
        }
    }

    /// A function of the inputs alone.
    pub(crate) const fn pure(
        name: &'static str,
        inputs: &'static [InputSpec],
        outputs: &'static [OutputSpec],
        fire: Fire,
    ) -> Self {
        Self::new(name, inputs, outputs, Does::Pure(fire))
    }

    /// A function with a memory.
    pub(crate) const fn stateful(
        name: &'static str,
        inputs: &'static [InputSpec],
        outputs: &'static [OutputSpec],
        make: Make,
    ) -> Self {
        Self::new(name, inputs, outputs, Does::Stateful(make))
    }

    /// A function with a memory that is told of network time.
    pub(crate) const fn clock(
        name: &'static str,
        inputs: &'static [InputSpec],
        outputs: &'static [OutputSpec],
        make: Make,
    ) -> Self {
        Self::new(name, inputs, outputs, Does::Clock(make))
    }

    /// The least and the greatest size of a sized type.
    pub(crate) const fn sized(mut self, least: u8, greatest: u8) -> Self {
        self.sizes = Some((least, greatest));
        self
    }

    /// Any one message sets it off; the firing sees those that wait, and uses up the one at the first input
    /// that has one.
    pub(crate) const fn each(mut self) -> Self {
        self.each = true;
        self
    }

    /// See [`Spec::scalar`].
    pub(crate) const fn scalar(mut self, scalar: Scalar) -> Self {
        self.scalar = Some(scalar);
        self
    }

    pub(crate) const fn says(mut self, behaviour: &'static str) -> Self {
        self.behaviour = behaviour;
        self
    }

    pub(crate) const fn known(mut self, confidence: Confidence, source: &'static str) -> Self {
        self.confidence = confidence;
        self.source = source;
        self
    }

    pub(crate) const fn example(mut self, example: &'static str) -> Self {
        self.example = example;
        self
    }
}

/// How far a row can be relied on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Confidence {
    /// Working programs of the time agree with it.
    Used,
    /// Recollected, hardly in doubt.
    High,
    /// Recollected, details may differ.
    Medium,
    /// Name certain, pins a guess.
    Low,
    /// This project's own rule or function.
    Project,
}

impl Confidence {
    /// The word used in listings.
    pub fn name(self) -> &'static str {
        match self {
            Self::Used => "used",
            Self::High => "high",
            Self::Medium => "medium",
            Self::Low => "low",
            Self::Project => "project",
        }
    }
}

/// How many ports one row stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Times {
    /// One.
    Once,
    /// As many as the size of the type.
    Size,
    /// One fewer than the size of the type.
    SizeLessOne,
}

impl Times {
    fn of(self, size: u8) -> usize {
        usize::from(match self {
            Self::Once => 1,
            Self::Size => size,
            Self::SizeLessOne => size.saturating_sub(1),
        })
    }
}

/// What a constant input holds before anything is sent to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Preset {
    /// Nothing, and the function does not fire without it. Also said of active inputs.
    Required,
    /// This Boolean.
    Boolean(bool),
    /// This integer.
    Integer(i32),
    /// This real.
    Real(f64),
    /// This text.
    Text(&'static str),
    /// No one value: the rule in words.
    Rule(&'static str),
}

impl Preset {
    pub(crate) fn value(self) -> Option<Value> {
        match self {
            Self::Required | Self::Rule(_) => None,
            Self::Boolean(b) => Some(Value::Boolean(b)),
            Self::Integer(n) => Some(Value::Integer(n)),
            Self::Real(x) => Some(Value::Real(x)),
            Self::Text(text) => Some(Value::from(text)),
        }
    }

    /// As listings show it; nothing where the function waits for a value.
    pub fn text(self) -> Option<String> {
        match self {
            Self::Required => None,
            Self::Boolean(b) => Some(if b { "TRUE" } else { "FALSE" }.to_owned()),
            Self::Integer(n) => Some(format!("FIX({n})")),
            Self::Real(x) => Some(format!("{x}")),
            Self::Text(text) => Some(format!("'{text}'")),
            Self::Rule(words) => Some(words.to_owned()),
        }
    }
}

/// One input, or several alike.
#[derive(Clone, Copy, Debug)]
pub struct InputSpec {
    /// What it takes.
    pub kinds: Kinds,
    /// Whether it is constant until SETUP CNESS says otherwise.
    pub constant: bool,
    /// What it holds at first, if constant.
    pub preset: Preset,
    /// How many inputs this row stands for.
    pub times: Times,
}

impl InputSpec {
    /// An input whose messages are consumed.
    pub const fn active(kinds: Kinds) -> Self {
        Self {
            kinds,
            constant: false,
            preset: Preset::Required,
            times: Times::Once,
        }
    }

    /// An input that keeps its latest message.
    pub const fn constant(kinds: Kinds, preset: Preset) -> Self {
        Self {
            kinds,
            constant: true,
            preset,
            times: Times::Once,
        }
    }

    /// A constant input that has to be set.
    pub(crate) const fn required(kinds: Kinds) -> Self {
        Self::constant(kinds, Preset::Required)
    }

    /// The same for several inputs.
    #[must_use]
    pub const fn times(mut self, times: Times) -> Self {
        self.times = times;
        self
    }
}

/// One output, or several alike.
#[derive(Clone, Copy, Debug)]
pub struct OutputSpec {
    /// What it may send.
    pub kinds: Kinds,
    /// How many outputs this row stands for.
    pub times: Times,
}

impl OutputSpec {
    /// One output.
    pub const fn of(kinds: Kinds) -> Self {
        Self {
            kinds,
            times: Times::Once,
        }
    }

    /// The same for several outputs.
    #[must_use]
    pub const fn times(mut self, times: Times) -> Self {
        self.times = times;
        self
    }
}

impl Spec {
    /// Whether firings depend on earlier ones or on network time: whether an instance has a state.
    pub fn remembers(&self) -> bool {
        matches!(self.does, Does::Stateful(_) | Does::Clock(_))
    }

    /// The inputs of an instance of `size` (0 for unsized types), in order from 1.
    pub fn inputs_of(&self, size: u8) -> impl Iterator<Item = InputSpec> {
        self.inputs
            .iter()
            .flat_map(move |input| std::iter::repeat_n(*input, input.times.of(size)))
    }

    /// The outputs of an instance of `size` (0 for unsized types), in order from 1.
    pub fn outputs_of(&self, size: u8) -> impl Iterator<Item = OutputSpec> {
        self.outputs
            .iter()
            .flat_map(move |output| std::iter::repeat_n(*output, output.times.of(size)))
    }
}

impl std::fmt::Debug for Spec {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "F:{}", self.name)
    }
}
