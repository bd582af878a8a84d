//! Commands of the language as text.

use super::{Dice, pick};
use ps300::intrinsic;
use ps300::language::{Command, FORMS, Name, parse, print};

/// Few, so that commands meet. The last two are members of a structure some of them become.
pub(crate) const NAMES: [&str; 8] = ["a", "b", "c", "D", "e_1", "s", "a.f", "s.l"];
pub(crate) const LITERALS: [&str; 16] = [
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
pub(crate) const INPUTS: [&str; 9] = [
    "1", "2", "3", "4", "append", "clear", "delete", "last", "position",
];
/// Nodes of the names above.
pub(crate) const NODES: [&str; 13] = [
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
    "BEGIN_STRUCTURE f := F:ADDC; l := SCALE BY 1; CHARACTERS 'x'; END_STRUCTURE",
];

/// Functions that answer most messages, so that something happens in a random network.
pub(crate) const LIVELY: [&str; 16] = [
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
pub(crate) const REMEMBERING: [&str; 12] = [
    "ACCUMULATE",
    "DELTA",
    "DSCALE",
    "AVERAGE",
    "DXROTATE",
    "TIMEOUT",
    "DR_SLEW",
    "DR_LAG",
    "DR_COUNTER",
    "DR_RECORDER",
    "DR_RANDOM",
    "DR_CHANGE",
];

pub(crate) fn definition(dice: Dice) -> String {
    let specs: Vec<_> = intrinsic::table().collect();
    let spec = specs[usize::from(dice[1]) % specs.len()];
    let size = spec.sizes.map_or(String::new(), |(least, greatest)| {
        format!("({})", least + dice[2] % (greatest - least + 1))
    });
    format!("{} := F:{}{size};", pick(&NAMES, dice[0]), spec.name)
}

/// A network in which every name is a function and most wires fit.
pub(crate) fn lively(functions: Dice, connections: &[Dice], table: &[&str]) -> String {
    let define = |(name, die): (&&str, u8)| format!("{name} := F:{};\n", pick(table, die));
    let mut program: String = NAMES.iter().zip(functions).map(define).collect();
    program.extend(connections.iter().map(|&dice| link(dice) + "\n"));
    program
}

/// A wire that mostly fits.
pub(crate) fn link(dice: Dice) -> String {
    let from = if dice[0].is_multiple_of(4) {
        "DIALS"
    } else {
        pick(&NAMES, dice[0])
    };
    let (output, input) = (1 + u8::from(dice[1] > 200), 1 + u8::from(dice[2] > 150));
    format!("CONNECT {from}<{output}>:<{input}>{};", pick(&NAMES, dice[3]))
}

pub(crate) fn connection(dice: Dice) -> String {
    let from = if dice[0].is_multiple_of(5) {
        "DIALS"
    } else {
        pick(&NAMES, dice[0])
    };
    let (output, input) = (1 + dice[1] % 3, pick(&INPUTS, dice[2]));
    format!("CONNECT {from}<{output}>:<{input}>{};", pick(&NAMES, dice[3]))
}

pub(crate) fn message(dice: Dice) -> String {
    format!(
        "SEND {} TO <{}>{};",
        pick(&LITERALS, dice[0]),
        pick(&INPUTS, dice[1] % 4),
        pick(&NAMES, dice[2])
    )
}

/// What the reference of the language shows: an example as it is, or one of its definitions under one of the names.
pub(crate) fn example(dice: Dice) -> String {
    let forms: Vec<_> = FORMS.iter().flat_map(|section| section.forms).collect();
    let form = forms[usize::from(dice[0]) % forms.len()];
    let (commands, _) = parse(form.example);
    match commands
        .get(usize::from(dice[1]) % (commands.len() + 1))
        .map(|command| &command.what)
    {
        Some(Command::Define { definition, .. }) => print(&Command::Define {
            name: Name::new(pick(&NAMES, dice[2])),
            definition: definition.clone(),
        }),
        _ => form.example.to_owned(),
    }
}

/// Any command at all.
pub(crate) fn anything(dice: Dice) -> String {
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
                "SEND VL(c) TO <1>a;",
                "BEGIN; SEND 1 TO <1>a; SEND 2 TO <1>b; END;",
                "BEGIN; c := F:NOP; CONNECT a<1>:<1>c;",
                "END;",
                "!RESET;",
                "COMMAND STATUS;",
            ],
            dice[1],
        )
        .to_owned(),
    }
}
