//! Learning: which control and which parameter were touched, and the commands that connect them.
//!
//! The connection is ordinary text of the network: functions called `LEARN_…`, wires, constants. It must not know
//! devices or parameters beyond what it is told of the two.

use device_profiles::ControlKind;
use ps300::language::{Command, Definition, Disconnection, Input, InputOf, Name, OutputOf, Payload, print};
use ps300::value::Value;

use super::button::ButtonMode;
use super::control::RATE;
use super::drive::Sort;
use super::pickup::Way;

/// What was touched since learning began.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Learning {
    /// Device and number of the control.
    pub(crate) control: Option<(String, u8)>,
    /// Name and inlet of the parameter.
    pub(crate) parameter: Option<(String, u8)>,
}

/// The end of a connection at the hand.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hand<'a> {
    /// Instance of the device's page.
    pub(crate) instance: &'a str,
    pub(crate) number: u8,
    pub(crate) kind: ControlKind,
    /// It springs back and goes by its speed, as a dial that turns for as long as it is pushed.
    pub(crate) rate: bool,
}

/// The other end.
#[derive(Clone, Debug)]
pub(crate) struct Goal<'a> {
    pub(crate) name: &'a str,
    pub(crate) inlet: u8,
    /// What it does; none for inlets of the network's own functions and nodes, which go to a value.
    pub(crate) sort: Option<Sort>,
    /// What the ends of the control are to come to.
    pub(crate) range: Option<[f64; 2]>,
    /// Where it stands.
    pub(crate) value: Option<f64>,
}

/// Turns of a dial for the whole range of something that has no best of its own.
const TURNS_FOR_ALL: f64 = 4.0;

/// The functions that learning makes for an output.
pub(crate) fn functions(instance: &str, number: u8) -> [String; 2] {
    let stem = format!("LEARN_{instance}_{number}");
    [stem.clone(), format!("{stem}_FROM")]
}

/// Commands that part an output from what it drives, and delete what learning had made for it.
pub(crate) fn parted(
    instance: &str,
    number: u8,
    is_there: &dyn Fn(&str) -> bool,
    wired: bool,
) -> Vec<Command> {
    let mut commands = Vec::new();
    if wired {
        commands.push(Command::Disconnect(Disconnection::Output(OutputOf {
            name: Name::new(instance),
            output: number,
        })));
    }
    let made = functions(instance, number)
        .into_iter()
        .filter(|name| is_there(name));
    commands.extend(made.map(|name| Command::Delete(Name::new(&name))));
    commands
}

/// Commands that connect a control to an inlet, or why that makes no sense.
pub(crate) fn connection(hand: Hand<'_>, goal: &Goal<'_>) -> Result<Vec<Command>, String> {
    let (inlet, stages) = match hand.kind {
        ControlKind::Fader | ControlKind::Knob | ControlKind::Strip => {
            let inlet = goes_to(goal)?;
            let [low, high] = goal.range.unwrap_or([0.0, 1.0]);
            (inlet, scaling(high - low, low))
        }
        ControlKind::Axis if hand.rate => turned(goal)?,
        ControlKind::Axis => {
            let inlet = goes_to(goal)?;
            let [low, high] = goal.range.unwrap_or([-1.0, 1.0]);
            (inlet, scaling((high - low) / 2.0, f64::midpoint(low, high)))
        }
        ControlKind::Dial | ControlKind::Ring => turned(goal)?,
        ControlKind::Button => pressed(goal),
    };
    let [first, second] = functions(hand.instance, hand.number);
    let mut commands = Vec::new();
    let mut from = output(hand.instance, hand.number);
    for (name, stage) in [first, second].into_iter().zip(stages) {
        commands.push(Command::Define {
            name: Name::new(&name),
            definition: Definition::Function {
                function: Name::new(stage.function),
                size: None,
            },
        });
        for (constant, value) in stage.constants {
            commands.push(Command::Send {
                payload: Payload::Value(value),
                to: input(&name, constant),
            });
        }
        commands.push(Command::Connect {
            from,
            to: input(&name, 1),
        });
        from = output(&name, 1);
    }
    commands.push(Command::Connect {
        from,
        to: input(goal.name, inlet),
    });
    Ok(commands)
}

/// Commands as text, one a line.
pub(crate) fn text(commands: &[Command]) -> String {
    let lines: Vec<String> = commands.iter().map(print).collect();
    lines.join("\n")
}

/// A function on the way.
struct Stage {
    function: &'static str,
    constants: Vec<(u8, Value)>,
}

impl Stage {
    fn new(function: &'static str, constants: &[(u8, f64)]) -> Self {
        Self {
            function,
            constants: constants
                .iter()
                .map(|&(at, value)| (at, Value::Real(value)))
                .collect(),
        }
    }
}

/// Times `factor`, plus `offset`, as far as that does anything.
fn scaling(factor: f64, offset: f64) -> Vec<Stage> {
    let mut stages = Vec::new();
    if factor != 1.0 {
        stages.push(Stage::new("MULC", &[(2, factor)]));
    }
    if offset != 0.0 {
        stages.push(Stage::new("ADDC", &[(2, offset)]));
    }
    stages
}

/// The inlet that goes to a value.
fn goes_to(goal: &Goal<'_>) -> Result<u8, String> {
    match goal.sort {
        None | Some(Sort::Absolute { .. }) => Ok(goal.inlet),
        Some(Sort::Added { absolute, .. }) => Ok(absolute),
        Some(Sort::Step | Sort::Trigger) => Err(format!(
            "{}<{}> takes presses, not a place between two ends: use a button",
            goal.name, goal.inlet
        )),
    }
}

/// What turns: onto the inlet that adds, else through a running sum that begins where the inlet stands.
fn turned(goal: &Goal<'_>) -> Result<(u8, Vec<Stage>), String> {
    Ok(match goal.sort {
        Some(Sort::Added { per_turn, .. }) => (goal.inlet, scaling(per_turn, 0.0)),
        Some(Sort::Absolute { added }) => {
            let per_turn = super::drive::drive(goal.name, added).map(|it| it.sort);
            let per_turn = match per_turn {
                Some(Sort::Added { per_turn, .. }) => per_turn,
                _ => 1.0,
            };
            (added, scaling(per_turn, 0.0))
        }
        Some(Sort::Step | Sort::Trigger) => {
            return Err(format!(
                "{}<{}> takes presses: use a button",
                goal.name, goal.inlet
            ));
        }
        None => {
            let start = goal.value.unwrap_or(0.0);
            let mut constants = vec![(2, start)];
            match goal.range {
                Some([low, high]) => {
                    constants.extend([(4, (high - low) / TURNS_FOR_ALL)]);
                    constants.extend([(5, low.max(high)), (6, low.min(high))]);
                }
                None => constants.push((4, 1.0)),
            }
            (goal.inlet, vec![Stage::new("ACCUMULATE", &constants)])
        }
    })
}

/// What is pressed: any message for what any message does, one step for what steps, one end down and the other up
/// for what goes to a value.
fn pressed(goal: &Goal<'_>) -> (u8, Vec<Stage>) {
    let [low, high] = goal.range.unwrap_or([0.0, 1.0]);
    match goal.sort {
        Some(Sort::Trigger) => (goal.inlet, Vec::new()),
        Some(Sort::Step) => (goal.inlet, vec![Stage::new("CONSTANT", &[(2, 1.0)])]),
        Some(Sort::Added { absolute, .. }) => (
            absolute,
            vec![Stage::new("BOOLEAN_CHOOSE", &[(2, high), (3, low)])],
        ),
        None | Some(Sort::Absolute { .. }) => (
            goal.inlet,
            vec![Stage::new("BOOLEAN_CHOOSE", &[(2, high), (3, low)])],
        ),
    }
}

/// Whether what is learnt goes by its speed: what springs back does, unless it was given another mode than it has by
/// itself, or a range to be placed in.
pub(crate) fn goes_by_speed(kind: ControlKind, mode: &str, has_range: bool) -> bool {
    let unchosen = mode == RATE || mode == Way::default().word();
    kind == ControlKind::Axis && unchosen && !has_range
}

/// The mode in which a control is of use there; the present one where that is as good.
pub(crate) fn mode_for<'m>(hand: Hand<'_>, sort: Option<Sort>, mode: &'m str) -> &'m str {
    match (hand.kind, sort) {
        (ControlKind::Button, Some(Sort::Trigger | Sort::Step)) => ButtonMode::Press.word(),
        (ControlKind::Button, _) => ButtonMode::Toggle.word(),
        (ControlKind::Axis, _) if hand.rate => RATE,
        (ControlKind::Axis, _) if mode == RATE => Way::default().word(),
        _ => mode,
    }
}

fn output(name: &str, output: u8) -> OutputOf {
    OutputOf {
        name: Name::new(name),
        output,
    }
}

/// An inlet by name and number.
pub(crate) fn input(name: &str, input: u8) -> InputOf {
    InputOf {
        name: Name::new(name),
        input: Input::Number(input.into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn learnt(kind: ControlKind, goal: &Goal<'_>) -> String {
        let hand = Hand {
            instance: "NANO",
            number: 3,
            kind,
            rate: false,
        };
        connection(hand, goal).map_or_else(|why| why, |commands| text(&commands))
    }

    fn time(inlet: u8) -> Goal<'static> {
        Goal {
            name: "TIME",
            inlet,
            sort: super::super::drive::drive("TIME", inlet).map(|it| it.sort),
            range: Some([0.0, 5.0]),
            value: Some(1.0),
        }
    }

    #[test]
    fn each_kind_of_control_is_joined_in_its_own_way() {
        assert_eq!(
            learnt(ControlKind::Fader, &time(2)),
            "LEARN_NANO_3 := F:MULC;\nSEND 5 TO <2>LEARN_NANO_3;\nCONNECT NANO<3>:<1>LEARN_NANO_3;\n\
             CONNECT LEARN_NANO_3<1>:<2>TIME;"
        );
        assert!(learnt(ControlKind::Fader, &time(1)).ends_with("<2>TIME;"));
        assert!(learnt(ControlKind::Dial, &time(2)).ends_with("CONNECT LEARN_NANO_3<1>:<1>TIME;"));
        assert_eq!(learnt(ControlKind::Button, &time(3)), "CONNECT NANO<3>:<3>TIME;");
        assert!(learnt(ControlKind::Button, &time(4)).contains("F:CONSTANT"));
        assert!(learnt(ControlKind::Knob, &time(3)).contains("use a button"));
        let axis = learnt(ControlKind::Axis, &time(2));
        assert!(
            axis.contains("SEND 2.5 TO <2>LEARN_NANO_3;")
                && axis.contains("SEND 2.5 TO <2>LEARN_NANO_3_FROM;")
        );
    }

    #[test]
    fn a_dial_sums_up_where_only_a_value_is_taken() {
        let goal = Goal {
            name: "gain",
            inlet: 2,
            sort: None,
            range: Some([-1.0, 1.0]),
            value: Some(0.25),
        };
        let text = learnt(ControlKind::Dial, &goal);
        for part in [
            "F:ACCUMULATE",
            "SEND 0.25 TO <2>",
            "SEND 0.5 TO <4>",
            "SEND 1 TO <5>",
            "SEND -1 TO <6>",
        ] {
            assert!(text.contains(part), "{part} in {text}");
        }
        assert!(text.ends_with("CONNECT LEARN_NANO_3<1>:<2>gain;"), "{text}");
    }

    #[test]
    fn what_was_learnt_is_taken_away_and_nothing_else() {
        let there = |name: &str| name == "LEARN_NANO_3";
        let text = text(&parted("NANO", 3, &there, true));
        assert_eq!(text, "DISCONNECT NANO<3>:ALL;\nDELETE LEARN_NANO_3;");
        assert_eq!(parted("NANO", 3, &|_| false, false), []);
    }
}
