//! What must hold for every program: nothing panics, portions of work do not show, text is the network.

use proptest::prelude::*;
use ps300::intrinsic;
use ps300::language::Input;
use ps300::network::Watched;
use ps300::{Kinds, Limits, Machine, Ran, Value};

const NAMES: [&str; 6] = ["a", "b", "c", "D", "e_1", "s"];
const LITERALS: [&str; 16] = [
    "TRUE",
    "FALSE",
    "FIX(0)",
    "FIX(1)",
    "FIX(2)",
    "FIX(-2147483648)",
    "0",
    "-1.5",
    "1e300",
    "'text'",
    "V2D(0,1)",
    "V3D(1,2,3)",
    "V4D(1,2,3,4)",
    "M2D(1,2,3,4)",
    "M3D(1,0,0,0,1,0,0,0,1)",
    "M4D(1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1)",
];
const INPUTS: [&str; 9] = [
    "1", "2", "3", "4", "append", "clear", "delete", "last", "position",
];
const NODES: [&str; 12] = [
    "NIL",
    "INSTANCE OF a, b",
    "INSTANCE OF c, D, e_1",
    "VECTOR_LIST N=2 0,0 1,1",
    "VECTOR_LIST DOTS N=1 0,0,0",
    "ROTATE IN X 30 THEN a",
    "SCALE BY 2 THEN b",
    "SET COLOR 120,1 THEN c",
    "LOOK AT 0,0,0 FROM 0,0,-1 THEN D",
    "FIELD_OF_VIEW 30 THEN a",
    "CHARACTERS 1,1 'abc'",
    "BEGIN_STRUCTURE l := TRANSLATE BY 1,1,1; IF CONDITIONAL_BIT 1 IS OFF; INSTANCE OF b; END_STRUCTURE",
];

/// Numbers to choose with: the same numbers always make the same program.
type Dice = [u8; 6];

fn pick<'a, T: ?Sized>(from: &[&'a T], die: u8) -> &'a T {
    from[usize::from(die) % from.len()]
}

/// Functions that answer most messages, so that something happens in a random network.
const LIVELY: [&str; 16] = [
    "NOP",
    "NOP",
    "ADD",
    "ADDC",
    "MULC",
    "SUB",
    "CSUB",
    "SYNC(2)",
    "PASSTHRU(2)",
    "CONSTANT",
    "EQ",
    "PRINT",
    "VEC",
    "LIMIT",
    "CROUTE(2)",
    "SINCOS",
];
/// Likewise, with a memory.
const REMEMBERING: [&str; 5] = ["ACCUMULATE", "DELTA", "DSCALE", "AVERAGE", "DXROTATE"];

fn definition(dice: Dice) -> String {
    let specs: Vec<_> = intrinsic::table().collect();
    let spec = specs[usize::from(dice[1]) % specs.len()];
    let size = spec.sizes.map_or(String::new(), |(least, _)| {
        format!("({})", least.max(2) + dice[2] % 2)
    });
    format!("{} := F:{}{size};", pick(&NAMES, dice[0]), spec.name)
}

/// A network in which every name is a function and most wires fit.
fn lively(functions: Dice, connections: &[Dice], table: &[&str]) -> String {
    let define = |(name, die): (&&str, u8)| format!("{name} := F:{};\n", pick(table, die));
    let mut program: String = NAMES.iter().zip(functions).map(define).collect();
    for dice in connections {
        let from = if dice[0].is_multiple_of(4) {
            "DIALS"
        } else {
            pick(&NAMES, dice[0])
        };
        let (output, input) = (1 + u8::from(dice[1] > 200), 1 + u8::from(dice[2] > 150));
        program.push_str("CONNECT ");
        program.push_str(
            &[
                from,
                "<",
                &output.to_string(),
                ">:<",
                &input.to_string(),
                ">",
                pick(&NAMES, dice[3]),
                ";\n",
            ]
            .concat(),
        );
    }
    program
}

fn connection(dice: Dice) -> String {
    let from = if dice[0].is_multiple_of(5) {
        "DIALS"
    } else {
        pick(&NAMES, dice[0])
    };
    let (output, input) = (1 + dice[1] % 3, pick(&INPUTS, dice[2]));
    format!("CONNECT {from}<{output}>:<{input}>{};", pick(&NAMES, dice[3]))
}

fn message(dice: Dice) -> String {
    format!(
        "SEND {} TO <{}>{};",
        pick(&LITERALS, dice[0]),
        pick(&INPUTS, dice[1] % 4),
        pick(&NAMES, dice[2])
    )
}

/// Any command at all.
fn anything(dice: Dice) -> String {
    let rest = [dice[1], dice[2], dice[3], dice[4], dice[5], dice[0]];
    let (name, other) = (pick(&NAMES, dice[1]), pick(&NAMES, dice[2]));
    match dice[0] % 24 {
        0..5 => definition(rest),
        5..10 => connection(rest),
        10..14 => message(rest),
        14 | 15 => format!("{name} := {};", pick(&NODES, dice[2])),
        16 => format!(
            "SETUP CNESS {} <{}>{name};",
            dice[2].is_multiple_of(2),
            1 + dice[3] % 3
        ),
        17 => format!("DISPLAY {name}; DISCONNECT {other}:ALL;"),
        18 => format!("DELETE {name};"),
        19 => format!("FORGET {name};"),
        20 => format!("PREFIX {name} WITH SCALE BY 2; FOLLOW {other} WITH ROTATE IN Y 5;"),
        21 => format!("INCLUDE {name} IN {other}; REMOVE {name} FROM s;"),
        22 => format!("VARIABLE {name}; STORE 1 IN <1>{name}; SEND VALUE({name}) TO <1>{other};"),
        _ => pick(
            &[
                "INITIALIZE DISPLAY;",
                "INITIALIZE CONNECTIONS;",
                "DELETE e*;",
                "c := F:CLCSECONDS;",
            ],
            dice[1],
        )
        .to_owned(),
    }
}

fn dice(most: usize) -> impl Strategy<Value = Vec<Dice>> {
    prop::collection::vec(any::<Dice>(), 0..most)
}

fn limits() -> Limits {
    Limits {
        queue_max: 8,
        behind_max: 64,
        firings_per_batch: 60,
        firings_per_command: 200,
        ..Limits::default()
    }
}

fn loaded(program: &str) -> Machine {
    let mut machine = Machine::with_limits(limits());
    machine.load(program);
    machine
}

fn watch_everything(machine: &mut Machine) {
    let outputs: Vec<_> = machine
        .instances()
        .iter()
        .map(|it| (it.name.to_string(), it.outputs.len() as u8))
        .collect();
    for (name, count) in outputs {
        for output in 1..=count {
            machine.watch(&name, output);
        }
    }
}

/// Sends the same messages to either machine; what is refused is refused by both.
fn feed(machine: &mut Machine, tokens: &[Dice]) {
    for token in tokens {
        let number = 0.125 * f64::from(token[3]);
        let value = match token[0] % 8 {
            0 => Value::Boolean(token[3] > 127),
            1 => Value::Integer(i32::from(token[3]) - 9),
            2 => Value::from("text"),
            3 => Value::Vector2(glam::DVec2::new(number, 1.0)),
            _ => Value::Real(number),
        };
        if token[1].is_multiple_of(2) {
            machine.emit("DIALS", 1 + token[2] % 3, number);
        }
        let _ = machine.send(
            pick(&NAMES, token[2]),
            Input::Number(u16::from(1 + token[4] % 2)),
            value,
        );
    }
}

/// What a host does between two ticks.
#[derive(Clone, Debug)]
struct Act {
    tokens: Vec<Dice>,
    ends_batch: bool,
    command: Option<Dice>,
}

fn acts() -> impl Strategy<Value = Vec<Act>> {
    let command = prop::option::weighted(0.2, any::<Dice>());
    let act = (dice(8), any::<bool>(), command).prop_map(|(tokens, ends_batch, command)| Act {
        tokens,
        ends_batch,
        command,
    });
    prop::collection::vec(act, 1..12)
}

/// Firings allowed in each tick, used in turn.
fn budgets() -> impl Strategy<Value = Vec<u32>> {
    prop::collection::vec(prop_oneof![1_u32..9, 1_u32..100, Just(u32::MAX)], 1..5)
}

const TO_THE_HOST: &str = "c := F:CLCSECONDS; CONNECT c<1>:<1>a; CONNECT c<1>:<1>D;
    CONNECT a<1>:<1>host; CONNECT b<1>:<2>host; CONNECT e_1<1>:<1>host; CONNECT s<1>:<1>host; CONNECT D<1>:<1>DLABEL1;";

/// Watched messages with their times, what reached the host, and the reports.
type Left = (Vec<Watched>, Vec<(String, u8, Value)>, Vec<String>);

/// All that left the network.
fn played(program: &str, acts: &[Act], budgets: &[u32]) -> Left {
    let mut machine = Machine::with_limits(limits());
    machine
        .declare_sink("host", &[Kinds::ANY, Kinds::NUMBER])
        .unwrap();
    machine.load(program);
    watch_everything(&mut machine);
    for ((act, step), budget) in acts.iter().zip(1_u32..).zip(budgets.iter().cycle()) {
        feed(&mut machine, &act.tokens);
        if act.ends_batch {
            machine.go_on(*budget);
            feed(&mut machine, &act.tokens);
        }
        if let Some(command) = act.command {
            machine.load(&anything(command));
        }
        machine.tick(f64::from(step) / 32.0, step.into(), *budget);
    }
    machine.settle();
    let mut arrived = Vec::new();
    machine.drain_sinks(|_, name, input, value| arrived.push((name.to_owned(), input, value)));
    let reports = machine.reports().iter().map(ToString::to_string).collect();
    (machine.drain_watched().collect(), arrived, reports)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 192, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn nothing_panics_and_its_text_reads_back(commands in dice(60), tokens in dice(20), budget in 0_u32..50) {
        let program: String = commands.into_iter().map(|dice| anything(dice) + "\n").collect();
        let mut machine = loaded(&program);
        for step in 0..4_u32 {
            feed(&mut machine, &tokens);
            machine.tick(f64::from(step) * 0.1, step.into(), budget);
        }
        let behind: usize = machine.instances().iter().flat_map(|it| it.inputs.iter())
            .map(|input| input.waiting.saturating_sub(1)).sum();
        prop_assert!(behind <= 64);
        machine.drain_sinks(|_, _, _, value| assert!(value.is_finite()));
        for report in machine.reports() {
            prop_assert!(!report.to_string().is_empty());
        }
        machine.dot();
        machine.display();
        let text = machine.network_text();
        let mut again = Machine::with_limits(limits());
        let diagnostics = again.load(&text);
        let errors: Vec<_> = diagnostics.iter().filter(|d| d.severity == ps300::language::Severity::Error).collect();
        prop_assert!(errors.is_empty(), "{program}\n--\n{text}\n--\n{errors:?}");
    }

    #[test]
    fn how_the_firings_are_portioned_does_not_show(
        functions in any::<Dice>(), connections in dice(16), acts in acts(), budgets in budgets(),
    ) {
        let table = [&LIVELY[..], &REMEMBERING[..]].concat();
        let program = lively(functions, &connections, &table) + TO_THE_HOST;
        prop_assert_eq!(played(&program, &acts, &budgets), played(&program, &acts, &[u32::MAX]), "{}", program);
    }

    #[test]
    fn the_text_of_a_network_is_the_network(
        functions in any::<Dice>(), connections in dice(12), messages in dice(24), cness in dice(4), tokens in dice(24),
    ) {
        let mut program = lively(functions, &connections, &LIVELY);
        program.extend(cness.into_iter().map(|dice| anything([16, dice[1], dice[2], dice[3], 0, 0])));
        program.extend(messages.into_iter().map(message));
        let mut machine = loaded(&program);
        prop_assume!(matches!(machine.tick(0.0, 0, 0), Ran::Quiet { .. }));
        let text = machine.network_text();
        let mut again = Machine::with_limits(limits());
        prop_assert_eq!(again.load(&text), []);
        prop_assert_eq!(again.network_text(), text);
        let after = |machine: &mut Machine| {
            watch_everything(machine);
            feed(machine, &tokens);
            machine.tick(0.0, 0, 500);
            machine.drain_watched().collect::<Vec<Watched>>()
        };
        prop_assert_eq!(after(&mut machine), after(&mut again));
    }
}
