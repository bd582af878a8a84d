//! What a function remembers is all it needs to go on: a new instance that recalls it does the same.

use ps300::intrinsic::{self, InputSpec, Spec};
use ps300::language::Input;
use ps300::{Machine, Value};

use crate::dice::Dice;

/// One function in a machine, and what was sent to it.
struct Trial {
    machine: Machine,
    spec: &'static Spec,
    inputs: Vec<InputSpec>,
    /// For each input, everything it accepted.
    accepted: Vec<Vec<Value>>,
    secs: f64,
}

impl Trial {
    fn new(spec: &'static Spec) -> Self {
        let mut trial = Self {
            machine: Machine::new(),
            spec,
            inputs: Vec::new(),
            accepted: Vec::new(),
            secs: 0.0,
        };
        trial.make("f");
        let size = spec.sizes.map_or(0, |(least, _)| least.max(2));
        trial.inputs = spec.inputs_of(size).collect();
        trial.accepted = vec![Vec::new(); trial.inputs.len()];
        trial
    }

    fn make(&mut self, name: &str) {
        let size = self
            .spec
            .sizes
            .map_or(String::new(), |(least, _)| format!("({})", least.max(2)));
        assert_eq!(
            self.machine
                .load(&format!("{name} := F:{}{size};", self.spec.name)),
            []
        );
        for output in 1..=127 {
            self.machine.watch(name, output);
        }
    }

    /// Active inputs often, constants seldom.
    fn step(&mut self, dice: &mut Dice, names: &[&str]) {
        for index in 0..self.inputs.len() {
            let input = self.inputs[index];
            if dice.below(8) >= if input.constant { 1 } else { 5 } {
                continue;
            }
            let value = dice.value(input);
            for name in names {
                let number = Input::Number(index as u16 + 1);
                self.machine
                    .send(name, number, value.clone())
                    .expect("of a kind it takes");
            }
            self.accepted[index].push(value);
        }
        self.secs += dice.below(30) as f64 / 100.0;
        self.machine.tick(self.secs, (self.secs * 60.0) as u64, 10_000);
    }

    /// A second instance with the same inputs and the same memory.
    fn copy(&mut self) {
        self.make("g");
        let waiting: Vec<usize> = self
            .machine
            .instances()
            .iter()
            .find(|instance| instance.name.as_str() == "f")
            .map(|instance| instance.inputs.iter().map(|input| input.waiting).collect())
            .expect("made");
        for (index, accepted) in self.accepted.iter().enumerate() {
            let kept = if self.inputs[index].constant {
                1
            } else {
                waiting[index]
            };
            for value in &accepted[accepted.len().saturating_sub(kept)..] {
                let number = Input::Number(index as u16 + 1);
                self.machine
                    .send("g", number, value.clone())
                    .expect("f took it too");
            }
        }
        let state = self.machine.remembered("f");
        assert!(self.machine.recall("g", &state), "F:{} {state:?}", self.spec.name);
        assert_eq!(self.machine.remembered("g"), state, "F:{}", self.spec.name);
    }

    /// What each instance sent since the last call.
    fn sent(&mut self) -> [Vec<(u8, Value)>; 2] {
        let mut sent = [Vec::new(), Vec::new()];
        for watched in self.machine.drain_watched() {
            sent[usize::from(watched.name.as_str() == "g")].push((watched.output, watched.value));
        }
        sent
    }
}

fn remembering() -> impl Iterator<Item = &'static Spec> {
    intrinsic::table().filter(|spec| spec.remembers())
}

#[test]
fn a_function_that_recalls_goes_on_as_the_one_remembered() {
    for spec in remembering() {
        let mut kept_anything = false;
        for seed in 1..=24 {
            let mut dice = Dice::new(seed);
            let mut trial = Trial::new(spec);
            for _ in 0..dice.below(40) {
                trial.step(&mut dice, &["f"]);
            }
            trial.copy();
            kept_anything |= !trial.machine.remembered("f").is_empty();
            trial.sent();
            for step in 0..40 {
                trial.step(&mut dice, &["f", "g"]);
                let [f, g] = trial.sent();
                assert_eq!(f, g, "F:{}, seed {seed}, step {step}", spec.name);
            }
        }
        assert!(kept_anything, "F:{} never remembers anything", spec.name);
    }
}

#[test]
fn a_state_that_does_not_fit_changes_nothing() {
    for spec in remembering() {
        let mut dice = Dice::new(7);
        let mut trial = Trial::new(spec);
        for _ in 0..40 {
            trial.step(&mut dice, &["f"]);
        }
        let state = trial.machine.remembered("f");
        for wrong in [
            vec![Value::Picks([].into())],
            vec![f64::NAN.into()],
            vec![f64::INFINITY.into(), 1.0.into()],
        ] {
            let longer = state.iter().cloned().chain(wrong.clone()).collect::<Vec<_>>();
            for state in [wrong, longer] {
                assert!(
                    !trial.machine.recall("f", &state),
                    "F:{} took {state:?}",
                    spec.name
                );
            }
            assert_eq!(trial.machine.remembered("f"), state, "F:{}", spec.name);
        }
        assert!(trial.machine.recall("f", &[]), "F:{} as new", spec.name);
        assert_eq!(trial.machine.remembered("f"), [], "F:{}", spec.name);
    }
}
