//! Hands turn the simulated dials while the network is edited: every count arrives, and no step is like it would
//! not have been without the edits.

use std::sync::Arc;

use bench::Movement;
use bench::world::{DIAL_BOX, World, WorldOptions};
use firmware_sim::hands::Turn;
use rig::document::{NetworkFile, Show};
use rig::{Command, DialView, NetworkEdit, Snapshot};

const DIALS: u8 = 4;
const STEPS: u64 = 900;

/// What is never edited.
const STEADY: &str = "
a1 := F:ACCUMULATE; CONNECT DIALS<1>:<1>a1; VARIABLE v1; CONNECT a1<1>:<1>v1;
a2 := F:ACCUMULATE; CONNECT DIALS<2>:<1>a2; VARIABLE v2; CONNECT a2<1>:<1>v2;
a3 := F:ACCUMULATE; CONNECT DIALS<3>:<1>a3; VARIABLE v3; CONNECT a3<1>:<1>v3;
a4 := F:ACCUMULATE; CONNECT DIALS<4>:<1>a4; VARIABLE v4; CONNECT a4<1>:<1>v4;
";

fn world() -> World {
    let show = Show {
        name: "edits".into(),
        networks: vec![Arc::new(NetworkFile {
            name: "steady".into(),
            text: STEADY.into(),
        })],
        ..Show::default()
    };
    let mut world = World::new(WorldOptions::new(show)).expect("the bench stands");
    let hands = world.hands();
    for control in 0..DIALS {
        for round in 0..6 {
            let counts = 40 + 30 * i32::from(control) - 25 * round;
            let after_secs = 1.5 + f64::from(round) * 1.2;
            let movement = Movement::Turn {
                control,
                by: Turn::Counts(counts),
                over_secs: 1.0,
            };
            hands.begin(DIAL_BOX, after_secs, movement);
        }
    }
    world
}

/// What is asked for at a step, made of its number.
fn edit(step: u64) -> Option<NetworkEdit> {
    let dice = (step.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 40) as u32;
    let (name, other) = (dice % 7, dice / 7 % 7);
    let dial = 1 + dice / 49 % 8;
    let commands = |text: String| NetworkEdit::Commands(text);
    Some(match dice / 392 % 12 {
        0 | 1 => commands(format!("f{name} := F:ADDC; SEND {other} TO <2>f{name};")),
        2 => commands(format!("f{name} := F:DSCALE;")),
        3 | 4 => commands(format!("CONNECT DIALS<{dial}>:<1>f{name};")),
        5 => commands(format!(
            "CONNECT a1<1>:<1>f{name}; CONNECT f{name}<1>:<1>DLABEL{dial};"
        )),
        6 => commands(format!("DELETE f{name}; DISCONNECT f{other}:ALL;")),
        7 | 8 => NetworkEdit::Undo,
        9 => NetworkEdit::Redo,
        10 => NetworkEdit::Program(format!(
            "{STEADY} g{name} := F:ACCUMULATE; CONNECT DIALS<{dial}>:<1>g{name};"
        )),
        _ => return None,
    })
}

fn turns(seen: &Snapshot) -> Vec<f64> {
    seen.desk.dials.iter().map(|dial: &DialView| dial.turns).collect()
}

#[test]
fn dials_stream_through_edits() {
    let (mut edited, mut left_alone) = (world(), world());
    edited.step([Command::LookAtNetwork(true)]);
    left_alone.step([]);
    for step in 0..STEPS {
        let edit = edit(step).filter(|_| step.is_multiple_of(3));
        let seen = Arc::clone(edited.step(edit.map(Command::Network)));
        let other = left_alone.step([]);
        assert_eq!((seen.step, seen.at_secs), (other.step, other.at_secs));
        assert_eq!(turns(&seen), turns(other), "step {step}");
        let look = seen.network.as_ref().expect("somebody looks");
        for dial in 1..=usize::from(DIALS) {
            let name = format!("v{dial}");
            let shown = look
                .picture
                .find(&name.as_str().into())
                .expect("nobody deleted it");
            let held = &look.activity.inputs[look.picture.boxes[shown].first_input].front;
            let sum = held.as_ref().and_then(ps300::Value::as_number).unwrap_or(0.0);
            assert_eq!(sum, seen.desk.dials[dial - 1].turns, "dial {dial} at step {step}");
        }
    }
    assert!(
        turns(edited.seen())
            .iter()
            .filter(|turns| turns.abs() > 0.1)
            .count()
            >= 3
    );
    assert!(edited.seen().undo.is_some());
}
