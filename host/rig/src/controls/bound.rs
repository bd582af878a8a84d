//! What a control drives: from its output along the wires, through functions that only scale and shift, to an
//! inlet whose value can be known.
//!
//! This is how a control learns the value of what it drives: the way is gone back, from the parameter's value to the
//! place where the control would have to be. It must not know which control asks, nor what parameters there are.

use std::collections::BTreeMap;

use ps300::language::{Input, InputOf, Name};
use ps300::machine::Machine;
use ps300::value::Value;

/// Longest way that is followed. The project's own: longer ones are hardly a scaling.
const STEPS_MAX: usize = 8;

/// Who feeds whom, as it stood at one [`Machine::topology_revision`].
#[derive(Debug, Default)]
pub(crate) struct Wires {
    revision: Option<u64>,
    to: BTreeMap<(Name, u8), Vec<InputOf>>,
    functions: BTreeMap<Name, &'static str>,
}

/// A function that can be gone through backwards.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Through {
    Same,
    Times,
    Plus,
    Minus,
    Over,
}

/// One thing an output drives.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Bound {
    /// Functions on the way, from the control on.
    through: Vec<(Name, Through)>,
    /// Where it ends.
    pub(crate) to: Name,
    /// Which inlet of it; 0 for a named one.
    pub(crate) inlet: u8,
}

impl Wires {
    /// Looks again if anything may have changed. Returns whether it has.
    pub(crate) fn follow(&mut self, machine: &Machine) -> bool {
        let revision = Some(machine.topology_revision());
        if self.revision == revision {
            return false;
        }
        self.revision = revision;
        self.to.clear();
        for wire in machine.connections() {
            self.to.entry((wire.from, wire.output)).or_default().push(wire.to);
        }
        let instances = machine.instances().into_iter();
        self.functions = instances.map(|it| (it.name.clone(), it.spec.name)).collect();
        true
    }

    /// What an output drives, in the order of its wires.
    pub(crate) fn bound(&self, name: &Name, output: u8) -> Vec<Bound> {
        let mut found = Vec::new();
        self.walk(name, output, &mut Vec::new(), &mut found);
        found
    }

    fn walk(&self, name: &Name, output: u8, through: &mut Vec<(Name, Through)>, found: &mut Vec<Bound>) {
        for to in self.to.get(&(name.clone(), output)).into_iter().flatten() {
            let way = self.way_through(to).filter(|_| through.len() < STEPS_MAX);
            let leads_on = self.to.contains_key(&(to.name.clone(), 1));
            if let Some(way) = way.filter(|_| leads_on) {
                through.push((to.name.clone(), way));
                self.walk(&to.name, 1, through, found);
                through.pop();
                continue;
            }
            found.push(Bound {
                through: through.clone(),
                to: to.name.clone(),
                inlet: match to.input {
                    Input::Number(number) => u8::try_from(number).unwrap_or(0),
                    _ => 0,
                },
            });
        }
    }

    fn way_through(&self, to: &InputOf) -> Option<Through> {
        if to.input != Input::Number(1) {
            return None;
        }
        match *self.functions.get(&to.name)? {
            "NOP" => Some(Through::Same),
            "MULC" => Some(Through::Times),
            "ADDC" => Some(Through::Plus),
            "SUBC" => Some(Through::Minus),
            "DIVC" => Some(Through::Over),
            _ => None,
        }
    }
}

impl Bound {
    /// As the network names it.
    pub(crate) fn words(&self) -> String {
        match self.inlet {
            0 => self.to.to_string(),
            inlet => format!("{}<{inlet}>", self.to),
        }
    }

    /// What the control would have to send so that `value` arrives; none where a constant on the way is missing,
    /// no number, or nothing goes through it.
    pub(crate) fn back(&self, machine: &Machine, value: f64) -> Option<f64> {
        let mut value = value;
        for (name, way) in self.through.iter().rev() {
            if *way == Through::Same {
                continue;
            }
            let constant = number(machine.front(name.as_str(), 2)?)?;
            value = match way {
                Through::Same => value,
                Through::Times => value / constant,
                Through::Plus => value - constant,
                Through::Minus => value + constant,
                Through::Over => value * constant,
            };
        }
        value.is_finite().then_some(value)
    }

    /// The number that stands at the inlet, where it is a constant of a function.
    pub(crate) fn stands(&self, machine: &Machine) -> Option<f64> {
        number(machine.front(self.to.as_str(), self.inlet)?)
    }
}

fn number(value: &Value) -> Option<f64> {
    value.as_number().filter(|it| it.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;
    use ps300::value::Kinds;

    fn machine(text: &str) -> (Machine, Wires) {
        let mut machine = Machine::new();
        machine
            .declare_sink("TIME", &[Kinds::NUMBER; 2])
            .expect("a name of its own");
        machine
            .declare_source("BOX", &[Kinds::REAL; 3])
            .expect("a name of its own");
        assert_eq!(machine.load(text), []);
        let mut wires = Wires::default();
        assert!(wires.follow(&machine) && !wires.follow(&machine));
        (machine, wires)
    }

    #[test]
    fn scalings_are_gone_through_both_ways() {
        let (machine, wires) = machine(
            "a := F:MULC; b := F:ADDC; c := F:NOP; SEND 4 TO <2>a; SEND 1 TO <2>b; CONNECT BOX<1>:<1>a;
             CONNECT a<1>:<1>b; CONNECT b<1>:<1>c; CONNECT c<1>:<2>TIME; CONNECT BOX<2>:<1>TIME;",
        );
        let bound = wires.bound(&Name::new("box"), 1);
        assert_eq!(bound.len(), 1);
        assert_eq!(bound[0].words(), "TIME<2>");
        assert_eq!(bound[0].back(&machine, 3.0), Some(0.5));
        assert_eq!(wires.bound(&Name::new("BOX"), 2)[0].words(), "TIME<1>");
        assert_eq!(wires.bound(&Name::new("BOX"), 3), []);
    }

    #[test]
    fn what_is_no_scaling_is_an_end() {
        let (machine, wires) = machine(
            "s := F:MULC; SEND 0.25 TO <2>s; CONNECT BOX<1>:<2>s; CONNECT s<1>:<1>TIME;
             acc := F:ACCUMULATE; CONNECT BOX<2>:<1>acc; CONNECT acc<1>:<2>TIME;
             z := F:MULC; SEND 0 TO <2>z; CONNECT BOX<3>:<1>z; CONNECT z<1>:<2>TIME;",
        );
        let ends = |output| wires.bound(&Name::new("BOX"), output);
        assert_eq!(ends(1)[0].words(), "s<2>");
        assert_eq!(ends(1)[0].stands(&machine), Some(0.25));
        assert_eq!(ends(2)[0].words(), "acc<1>");
        assert_eq!(ends(3)[0].back(&machine, 1.0), None, "nothing goes through zero");
    }

    #[test]
    fn a_loop_ends() {
        let (_, wires) =
            machine("a := F:NOP; b := F:NOP; CONNECT BOX<1>:<1>a; CONNECT a<1>:<1>b; CONNECT b<1>:<1>a;");
        assert_eq!(wires.bound(&Name::new("BOX"), 1).len(), 1);
    }
}
