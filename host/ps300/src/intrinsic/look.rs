//! Functions that look at the picture: picks, and transforms read back from the display tree.
//!
//! What they need of the tree they ask for after firing (`network/look.rs`), so that firing itself sees
//! nothing but messages.

use std::fmt::Write;
use std::sync::Arc;

use super::function::{Errand, Fault, Function, Inputs, Look, Now, Outputs};
use super::recalled::restore;
use super::spec::{Confidence, InputSpec, OutputSpec, Preset, Spec};
use crate::language::VectorList;
use crate::pick::Pick;
use crate::value::{Kind, Kinds, Value};

const PICKS: Kinds = Kinds::of(&[Kind::Picks]);
const LISTED: Kinds = Kinds::MATRIX.or(PICKS).or(Kinds::of(&[Kind::Vectors]));
const READ: Kinds = Kinds::of(&[Kind::Matrix4, Kind::Vectors]);
const POINT: Kinds = Kinds::of(&[Kind::Vector2, Kind::Vector3]);
const INTEGER: OutputSpec = OutputSpec::of(Kinds::INTEGER);
const TEXT: OutputSpec = OutputSpec::of(Kinds::STRING);

/// Also the device of that name.
pub(crate) const PICK: Spec = Spec::clock(
    "PICK",
    &[
        InputSpec::active(Kinds::ANY),
        InputSpec::constant(Kinds::BOOLEAN, Preset::Boolean(false)),
        InputSpec::constant(Kinds::INTEGER, Preset::Integer(0)),
    ],
    &[OutputSpec::of(PICKS), OutputSpec::of(Kinds::BOOLEAN)],
    |_| Box::new(PickOnce::default()),
)
.says(
    "Every message at <1>, of any kind, looks for lines, characters, curves and polygon edges \
             in the pick window of PICK_LOCATION, below SET PICKING ON. Output <1> lists what is \
             there, nearest to the middle first; with <2> TRUE each with its place. If nothing is \
             there it looks again for <3> displayed frames, then sends FALSE on <2>.",
)
.known(
    Confidence::Used,
    "D0 pick networks for <1>, <2> and output <1>; the meaning of <2> recollected; <3> in \
             frames and output <2> ours",
)
.example("<1> TRUE -> <2> FALSE");

pub(super) const TABLE: &[Spec] = &[
    PICK,
    Spec::pure(
        "PICKINFO",
        &[
            InputSpec::active(PICKS),
            InputSpec::constant(Kinds::INTEGER, Preset::Integer(1)),
        ],
        &[
            INTEGER,
            TEXT,
            OutputSpec::of(POINT),
            INTEGER,
            INTEGER,
            OutputSpec::of(Kinds::REAL),
            TEXT,
            INTEGER,
            INTEGER,
        ],
        pick_info,
    )
    .says(
        "Takes the first of the picks at <1> apart: <1> its number in its list, from 1; <2> its \
             pick identifiers, innermost first, at most <2> of them, with commas between; <3> where \
             it was picked, in its own space; <4> its dimension, 2 or 3; <5> what it is part of: 0 \
             vectors, 1 characters, 2 labels, 3 a curve, 4 a polygon; <6> how far along the line or \
             curve, 0 to 1; <7> the name of its node; <8> how many identifiers it has; <9> how many \
             picks there are. <3> and <6> are sent if PICK was told to say where.",
    )
    .known(
        Confidence::Used,
        "D0 pick networks for nine outputs, of which <2> is text beginning with an identifier; \
             <1> recollected; the others' order ours",
    )
    .example(
        "p := F:PICK | CONNECT p<1>:<1>f | SEND TRUE TO <2>p | l := VECTOR_LIST N=2 -1,0 1,0 | d \
             := BEGIN_STRUCTURE SET PICKING ON; SET PICKING IDENTIFIER=edge; INSTANCE OF l; \
             END_STRUCTURE | DISPLAY d | SEND TRUE TO <1>p -> <1> FIX(2) | <2> 'edge' | <3> V2D(0,0) \
             | <4> FIX(2) | <5> FIX(0) | <6> 0.5 | <7> 'l' | <8> FIX(1) | <9> FIX(1)",
    ),
    Spec::pure(
        "XFORMDATA",
        &[
            InputSpec::active(Kinds::ANY),
            InputSpec::constant(Kinds::STRING, Preset::Required),
            InputSpec::constant(Kinds::STRING, Preset::Rule("nothing")),
            InputSpec::constant(Kinds::INTEGER, Preset::Integer(1)),
            InputSpec::constant(Kinds::INTEGER, Preset::Rule("all")),
        ],
        &[OutputSpec::of(READ)],
        transform_data,
    )
    .says(
        "Every message at <1>, of any kind, reads the displayed XFORM node with the full name \
             <2>: of XFORM MATRIX the 4x4 matrix gathered from the last viewing node down to it, of \
             XFORM VECTOR_LIST the lines below it, transformed, as a vector list; of these <5> \
             vectors from number <4>. The node named by <3>, if it is set, receives it too: at <1>, \
             or in place of the vectors it had.",
    )
    .known(
        Confidence::Used,
        "D0 matrix read-back for <1>, <2> and the matrix; the rest recollected; from where it is \
             gathered ours",
    )
    .example(
        "l := VECTOR_LIST N=2 0,0 1,0 | s := BEGIN_STRUCTURE SCALE BY 2; x := XFORM MATRIX; \
             INSTANCE OF l; END_STRUCTURE | DISPLAY s | <2> 's.x' | <1> TRUE -> <1> M4D(2,0,0,0, \
             0,2,0,0, 0,0,2,0, 0,0,0,1)",
    ),
    Spec::pure("LIST", &[InputSpec::active(LISTED)], &[TEXT], list)
        .says(
            "Prints a matrix, a vector list or picks line by line, a message for each: a heading, \
             then a line for each row, vector or pick, the last with a semicolon behind it.",
        )
        .known(
            Confidence::Used,
            "D0 matrix read-back for 4x4 matrices; what the lines hold ours",
        )
        .example("<1> M2D(1,0,0,2) -> <1> 'MATRIX_2X2' | <1> '1,0' | <1> '0,2;'"),
];

#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct PickOnce {
    frame: u64,
    /// The last frame to look in, after one in which nothing was there.
    until: Option<u64>,
}

impl Function for PickOnce {
    fn fire(&mut self, inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
        let detailed = inputs.boolean(2)?;
        let frames = u64::try_from(inputs.integer(3)?).unwrap_or(0);
        self.until = (frames > 0).then_some(self.frame + frames);
        outputs.errand(Errand::Look(Look::Pick {
            detailed,
            last: frames == 0,
        }));
        Ok(())
    }

    fn advance(&mut self, now: Now, inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
        let passed = now.frame > self.frame;
        self.frame = now.frame;
        if let (Some(until), true) = (self.until, passed) {
            let last = now.frame >= until;
            if last {
                self.until = None;
            }
            let detailed = inputs.boolean(2)?;
            outputs.errand(Errand::Look(Look::Pick { detailed, last }));
        }
        Ok(())
    }

    fn found(&mut self) {
        self.until = None;
    }

    fn remembered(&self) -> Vec<Value> {
        match (self.frame, self.until) {
            (0, None) => Vec::new(),
            (frame, None) => vec![Value::Real(frame as f64)],
            (frame, Some(until)) => vec![Value::Real(frame as f64), Value::Real(until as f64)],
        }
    }

    fn recall(&mut self, state: &[Value]) -> bool {
        restore(self, Self::default(), state, |state| {
            Some(Self {
                frame: state.count()?,
                until: if state.left() > 0 {
                    Some(state.count()?)
                } else {
                    None
                },
            })
        })
    }
}

fn pick_info(inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
    let Value::Picks(picks) = inputs.get(1) else {
        return Err(Fault::Kind {
            input: 1,
            expected: PICKS,
        });
    };
    let depth = usize::try_from(inputs.integer(2)?).unwrap_or(0);
    if let Some(pick) = picks.first() {
        outputs.send(1, pick.index);
        outputs.send_text(2, &identifiers(pick, depth))?;
        if let Some(spot) = pick.spot {
            if pick.dimension == 2 {
                outputs.send(3, spot.at.truncate());
            } else {
                outputs.send(3, spot.at);
            }
        }
        outputs.send(4, i32::from(pick.dimension));
        outputs.send(5, pick.kind.code());
        if let Some(spot) = pick.spot {
            outputs.send(6, spot.along);
        }
        outputs.send_text(7, pick.node.as_str())?;
        outputs.send(8, count(pick.identifiers.len()));
    }
    outputs.send(9, count(picks.len()));
    Ok(())
}

fn count(length: usize) -> i32 {
    i32::try_from(length).unwrap_or(i32::MAX)
}

fn identifiers(pick: &Pick, depth: usize) -> String {
    let names: Vec<_> = pick
        .identifiers
        .iter()
        .take(depth)
        .map(crate::language::Name::as_str)
        .collect();
    names.join(",")
}

fn transform_data(inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
    let optional = |number| {
        inputs
            .find(number)
            .map(|_| inputs.text(number).cloned())
            .transpose()
    };
    let positive = |n: i32| usize::try_from(n).unwrap_or(0);
    let name = inputs.text(2)?.clone();
    let to = optional(3)?;
    let first = positive(inputs.integer(4)?).max(1);
    let count = match inputs.find(5) {
        Some(_) => positive(inputs.integer(5)?),
        None => usize::MAX,
    };
    outputs.errand(Errand::Look(Look::Transform {
        name,
        to,
        part: [first - 1, count],
    }));
    Ok(())
}

fn list(inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
    let mut lines = match inputs.get(1) {
        Value::Matrix2(m) => rows("MATRIX_2X2", 2, |row| m.row(row).to_array().to_vec()),
        Value::Matrix3(m) => rows("MATRIX_3X3", 3, |row| m.row(row).to_array().to_vec()),
        Value::Matrix4(m) => rows("MATRIX_4X4", 4, |row| m.row(row).to_array().to_vec()),
        Value::Matrix4x3(m) => rows("MATRIX_4X3", 3, |row| {
            let linear = m.matrix3.row(row).to_array();
            [&linear[..], &[m.translation[row]]].concat()
        }),
        Value::Vectors(list) => vectors(list),
        Value::Picks(picks) => {
            let line = |pick: &Pick| {
                let ids = identifiers(pick, usize::MAX);
                format!("{} {} {ids}", pick.index, pick.node)
                    .trim_end()
                    .to_owned()
            };
            std::iter::once(format!("PICKS {}", picks.len()))
                .chain(picks.iter().map(line))
                .collect()
        }
        _ => {
            return Err(Fault::Kind {
                input: 1,
                expected: LISTED,
            });
        }
    };
    if let Some(last) = lines.last_mut() {
        last.push(';');
    }
    lines.iter().try_for_each(|line| outputs.send_text(1, line))
}

fn rows(heading: &str, count: usize, row: impl Fn(usize) -> Vec<f64>) -> Vec<String> {
    let heading = std::iter::once(heading.to_owned());
    heading.chain((0..count).map(|at| joined(&row(at)))).collect()
}

fn joined(numbers: &[f64]) -> String {
    let mut text = String::new();
    for (index, number) in numbers.iter().enumerate() {
        // Writing to a string cannot fail.
        let _ = write!(text, "{}{number}", if index > 0 { "," } else { "" });
    }
    text
}

fn vectors(list: &Arc<VectorList>) -> Vec<String> {
    let heading = std::iter::once(format!("VECTOR_LIST ITEMIZED N={}", list.vectors.len()));
    let line = |vector: &crate::language::Vector| {
        let letter = if vector.draw { 'L' } else { 'P' };
        let at = vector.at.to_array();
        let dimension = usize::from(list.dimension.count());
        format!("{letter} {}", joined(&at[..dimension]))
    };
    heading.chain(list.vectors.iter().map(line)).collect()
}
