//! The network as a patch panel draws it.

use ps300::Machine;
use ps300::language::Input;
use ps300::machine::picture::BoxRole;
use ps300::value::{Kinds, Value};

const NETWORK: &str = "
turn := F:XROTATE; scale := F:MULC; spare := F:NOP; VARIABLE v;
rot := ROTATE IN X 0 THEN line; line := VECTOR_LIST N=2 0,0 1,1; idle := SCALE BY 2;
SEND 90 TO <2>scale;
CONNECT DIALS<1>:<1>scale; CONNECT scale<1>:<1>turn; CONNECT turn<1>:<1>rot;
CONNECT scale<1>:<1>POSE; CONNECT scale<1>:<1>v;
";

fn machine() -> Machine {
    let mut machine = Machine::new();
    machine.declare_sink("POSE", &[Kinds::NUMBER]).expect("a name");
    machine.declare_sink("OTHER", &[Kinds::NUMBER]).expect("a name");
    assert_eq!(machine.load(NETWORK), []);
    machine
}

#[test]
fn boxes_are_what_is_wired_and_every_function() {
    let picture = machine().picture();
    let shown: Vec<(&str, BoxRole)> = picture.boxes.iter().map(|b| (b.name.as_str(), b.role)).collect();
    assert_eq!(
        shown,
        [
            ("DIALS", BoxRole::Device),
            ("turn", BoxRole::Function),
            ("scale", BoxRole::Function),
            ("spare", BoxRole::Function),
            ("v", BoxRole::Variable),
            ("rot", BoxRole::Node),
            ("POSE", BoxRole::Parameter),
        ]
    );
    assert!(picture.unwired.iter().any(|b| b.name.as_str() == "OTHER"));
    assert!(picture.unwired.iter().any(|b| b.name.as_str() == "idle"));
    let wires: Vec<(&str, u8, &str, Input)> = picture
        .wires
        .iter()
        .map(|w| {
            let name = |at: usize| picture.boxes[at].name.as_str();
            (name(w.from_box), w.output, name(w.to_box), w.input)
        })
        .collect();
    let first = Input::Number(1);
    assert_eq!(
        wires,
        [
            ("DIALS", 1, "scale", first),
            ("turn", 1, "rot", first),
            ("scale", 1, "turn", first),
            ("scale", 1, "POSE", first),
            ("scale", 1, "v", first),
        ]
    );
}

#[test]
fn activity_follows_the_messages() {
    let mut m = machine();
    let picture = m.picture();
    m.emit("DIALS", 1, 0.5);
    m.tick(0.01, 1, 1000);
    let activity = m.activity(&picture);
    let at = |name: &str| &picture.boxes[picture.find(&name.into()).expect("is shown")];
    let scale = at("scale");
    assert_eq!(activity.outputs[scale.first_output].sent, 1);
    assert_eq!(activity.outputs[scale.first_output].last, Some(Value::Real(45.0)));
    let gain = &activity.inputs[scale.first_input + 1];
    assert_eq!((&gain.front, gain.is_set), (&Some(Value::Real(90.0)), true));
    assert_eq!(
        activity.inputs[at("POSE").first_input].front,
        Some(Value::Real(45.0))
    );
    assert_eq!(activity.reports.len(), picture.boxes.len());
    assert_eq!(
        m.topology_revision(),
        picture.revision,
        "messages change no wires"
    );
    assert_eq!(m.load("CONNECT scale<1>:<1>spare;"), []);
    assert_ne!(m.topology_revision(), picture.revision);
}

#[test]
fn a_frozen_output_withholds_and_counts() {
    let mut m = machine();
    let picture = m.picture();
    assert!(m.freeze("scale", 1, true));
    assert!(!m.freeze("scale", 2, true));
    for turn in 1..=3 {
        m.emit("DIALS", 1, f64::from(turn));
        m.tick(f64::from(turn), 0, 1000);
    }
    let at = picture.boxes[picture.find(&"scale".into()).expect("is shown")].first_output;
    let frozen = m.activity(&picture).outputs[at].clone();
    assert_eq!((frozen.sent, frozen.withheld, frozen.frozen), (0, 3, true));
    assert_eq!(m.held("v"), None);
    m.freeze("scale", 1, false);
    m.emit("DIALS", 1, 1.0);
    m.tick(4.0, 0, 1000);
    assert_eq!(m.held("v"), Some(&Value::Real(90.0)));
}
