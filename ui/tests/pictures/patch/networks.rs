//! Networks that are looked at.

use std::fmt::Write;

use ps300::{Kind, Kinds};

/// The dial network of every PS 300 program (`docs/protocols/ps300.md`, "Canonical dial network").
pub(super) const DIALS: &str = include_str!("../../../../host/ps300/tests/data/dials.ps300");

/// Only the object: what a hand begins with.
pub(super) const OBJECT: &str =
    "obj := BEGIN_STRUCTURE rotx := ROTATE IN X 0; VECTOR_LIST N=2 0,0,0 1,1,1; END_STRUCTURE;
    DISPLAY obj;";

/// Some parameters, as the rig has them.
pub(super) const SINKS: &[(&str, &[Kinds])] = &[
    ("VIEW", &[Kinds::NUMBER, Kinds::NUMBER, Kinds::NUMBER]),
    ("TIME", &[Kinds::NUMBER, Kinds::ANY, Kinds::NUMBER]),
    (
        "POSE",
        &[
            Kinds::of(&[Kind::Vector2, Kind::Vector3]),
            Kinds::NUMBER,
            Kinds::ANY,
        ],
    ),
];

/// About as many instances as asked for: pages of dials as animators make them, with labels, gains and switches.
pub(super) fn pages(instances: usize) -> String {
    let mut text = String::new();
    let mut made = 0;
    for page in 0.. {
        let _ = writeln!(
            text,
            "page{page} := F:CONSTANT; SEND FIX({}) TO <2>page{page};",
            page % 3 + 1
        );
        made += 1;
        for dial in 1..=8 {
            if made + 4 > instances {
                return text;
            }
            let id = format!("{page}_{dial}");
            let _ = writeln!(
                text,
                "pick{id} := F:CROUTE(3); SEND FIX(1) TO <1>pick{id}; CONNECT DIALS<{dial}>:<2>pick{id};"
            );
            let _ = writeln!(text, "CONNECT page{page}<1>:<1>pick{id};");
            let _ = writeln!(
                text,
                "gain{id} := F:MULC; SEND {} TO <2>gain{id}; CONNECT pick{id}<1>:<1>gain{id};",
                dial * 10
            );
            let _ = writeln!(
                text,
                "sum{id} := F:ACCUMULATE; SEND 0 TO <2>sum{id}; SEND 1 TO <4>sum{id};"
            );
            let _ = writeln!(
                text,
                "CONNECT gain{id}<1>:<1>sum{id}; CONNECT pick{id}<2>:<1>sum{id};"
            );
            let _ = writeln!(text, "text{id} := F:PRINT; CONNECT sum{id}<1>:<1>text{id};");
            let target = ["VIEW", "TIME"][page % 2];
            let _ = writeln!(
                text,
                "CONNECT sum{id}<1>:<1>{target}; CONNECT text{id}<1>:<1>DLABEL{dial};"
            );
            made += 4;
        }
    }
    text
}
