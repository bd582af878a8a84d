//! What lasts is measured in network time: how the host divides it into ticks does not show.

use ps300::intrinsic::{self, InputSpec, Spec};
use ps300::language::Input;
use ps300::{Machine, Value};

use crate::dice::Dice;

/// Their unit is the tick or the frame.
const BY_TICKS: [&str; 2] = ["CLFRAMES", "CLTICKS"];
/// A spring is at rest when hardly anything is left, which a tick has to come to see.
const NEAR: f64 = 1e-5;

fn made(spec: &Spec) -> Machine {
    let mut machine = Machine::new();
    let size = spec
        .sizes
        .map_or(String::new(), |(least, _)| format!("({least})"));
    assert_eq!(machine.load(&format!("f := F:{}{size};", spec.name)), []);
    machine
}

/// The last message of each output.
fn last(machine: &Machine) -> Vec<Option<Value>> {
    let instances = machine.instances();
    let f = instances
        .iter()
        .find(|instance| instance.name.as_str() == "f")
        .expect("made");
    f.outputs.iter().map(|output| output.last.cloned()).collect()
}

fn near(a: &Value, b: &Value) -> bool {
    match (a, b) {
        (Value::Real(a), Value::Real(b)) => (a - b).abs() < NEAR,
        (Value::Vector2(a), Value::Vector2(b)) => a.distance(*b) < NEAR,
        (Value::Vector3(a), Value::Vector3(b)) => a.distance(*b) < NEAR,
        (Value::Vector4(a), Value::Vector4(b)) => a.distance(**b) < NEAR,
        _ => a == b,
    }
}

#[test]
fn the_division_into_ticks_does_not_show() {
    let lasting = intrinsic::table().filter(|spec| spec.remembers() && !BY_TICKS.contains(&spec.name));
    for spec in lasting {
        let size = spec.sizes.map_or(0, |(least, _)| least);
        let inputs: Vec<InputSpec> = spec.inputs_of(size).collect();
        for seed in 1..=12 {
            let mut dice = Dice::new(seed);
            let [mut coarse, mut fine] = [made(spec), made(spec)];
            for tenth in 0..40_u32 {
                for (number, input) in (1..).zip(&inputs) {
                    if dice.below(8) >= if input.constant { 1 } else { 3 } {
                        continue;
                    }
                    let value = dice.value(*input);
                    for machine in [&mut coarse, &mut fine] {
                        machine
                            .send("f", Input::Number(number), value.clone())
                            .expect("of a kind it takes");
                        machine.settle();
                    }
                }
                let at = |hundredth: u32| f64::from(10 * tenth + hundredth) / 100.0;
                for hundredth in 1..=10 {
                    fine.tick(at(hundredth), 0, 10_000);
                }
                coarse.tick(at(10), 0, 10_000);
                let (a, b) = (last(&coarse), last(&fine));
                let alike = a.iter().zip(&b).all(|pair| match pair {
                    (Some(a), Some(b)) => near(a, b),
                    (a, b) => a == b,
                });
                assert!(alike, "F:{}, seed {seed}, {tenth}: {a:?} {b:?}", spec.name);
            }
        }
    }
}
