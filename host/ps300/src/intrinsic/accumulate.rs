//! Functions that integrate: what makes dials, which send movements, turn into positions.
//!
//! The stored sum itself is clamped, so that turning back from a limit acts at once.

use glam::{DMat2, DMat3, DMat4, DVec3};

use super::components::{assemble, components};
use super::function::{Fault, Function, Inputs, Outputs, domain};
use super::numbers::integer;
use super::recalled::{Recalled, remembers_one, restore};
use super::spec::{Confidence, InputSpec, OutputSpec, Preset, Spec};
use crate::value::{Kind, Kinds, Value};

const SUMMED: Kinds =
    Kinds::NUMBER
        .or(Kinds::VECTOR)
        .or(Kinds::of(&[Kind::Matrix2, Kind::Matrix3, Kind::Matrix4]));
const BOUND: Kinds = Kinds::NUMBER.or(Kinds::VECTOR);

pub(super) const TABLE: &[Spec] = &[
    Spec::stateful(
        "ACCUMULATE",
        &[
            InputSpec::active(SUMMED),
            InputSpec::constant(
                SUMMED,
                Preset::Rule("zero, or the identity matrix, of the kind of <1>"),
            ),
            InputSpec::constant(Kinds::NUMBER, Preset::Real(0.0)),
            InputSpec::constant(Kinds::NUMBER, Preset::Real(1.0)),
            InputSpec::constant(BOUND, Preset::Rule("unbounded")),
            InputSpec::constant(BOUND, Preset::Rule("unbounded")),
        ],
        &[OutputSpec::of(SUMMED)],
        |_| Box::<Accumulate>::default(),
    )
    .says(
        "Running sum: <2> plus every <1> times the scale <4>, of the kind of <2> (without it, of \
             <1>, integers becoming real with the first real or a scale with a fraction), the stored \
             sum kept between the lower limit <6> and the upper limit <5>. A vector is limited \
             component by component. Sent on when it has changed by at least <3> since it was last \
             sent. Sending <2> starts anew from there without sending. Matrices are multiplied, new \
             times old; scale and limits do not apply to them.",
    )
    .known(
        Confidence::Used,
        "D0 dial networks for inputs 1, 2, 4, 5, 6; input 3 recollected; matrices and defaults \
             ours",
    )
    .example(
        "<2> V3D(0,0,0) | <4> 100 | <1> V3D(0.5,0,0) | <1> V3D(0,1,0) -> <1> V3D(50,0,0) | <1> \
             V3D(50,100,0)",
    ),
    Spec::stateful(
        "DSCALE",
        &[
            InputSpec::active(Kinds::NUMBER),
            InputSpec::constant(Kinds::NUMBER, Preset::Real(1.0)),
            InputSpec::constant(Kinds::NUMBER, Preset::Real(1.0)),
            InputSpec::constant(Kinds::NUMBER, Preset::Rule("unbounded")),
            InputSpec::constant(Kinds::NUMBER, Preset::Rule("unbounded")),
        ],
        &[
            OutputSpec::of(Kinds::of(&[Kind::Matrix3])),
            OutputSpec::of(Kinds::REAL),
        ],
        |_| Box::<ScaleSum>::default(),
    )
    .says(
        "Integrating uniform scale: the start <2> plus every <1> times the gain <3>, the stored \
             sum kept between the lower limit <5> and the upper limit <4>. Output <1> the scaling \
             matrix, <2> the factor. Sending <2> starts anew from there without sending.",
    )
    .known(
        Confidence::Used,
        "D0 dial networks for all five inputs and output 1; output 2 recollected; defaults ours",
    )
    .example("<3> 0.2 | <4> 1000 | <5> 0.01 | <1> 1 -> <1> M3D(1.2,0,0, 0,1.2,0, 0,0,1.2) | <2> 1.2"),
];

/// The running sum of ACCUMULATE; nothing until the first firing after a (re)start.
#[derive(Default)]
struct Accumulate {
    running: Option<Running>,
}

enum Running {
    /// Up to four components; `sent` is what went out last, or the start.
    Sum {
        kind: Kind,
        sum: [f64; 4],
        sent: [f64; 4],
    },
    Product(Value),
}

impl Function for Accumulate {
    fn constant_set(&mut self, number: u8) {
        if number == 2 {
            self.running = None;
        }
    }

    fn fire(&mut self, inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
        if !inputs.is_constant(2) {
            self.running = None;
        }
        let running = match &mut self.running {
            Some(running) => running,
            none => none.insert(start(inputs)?),
        };
        match running {
            Running::Product(product) => multiply(product, inputs, outputs),
            Running::Sum { kind, sum, sent } => {
                if *kind == Kind::Integer {
                    *kind = promoted(inputs);
                }
                add(*kind, sum, sent, inputs, outputs)
            }
        }
    }

    fn remembered(&self) -> Vec<Value> {
        match &self.running {
            None => Vec::new(),
            Some(Running::Product(product)) => vec![product.clone()],
            Some(Running::Sum { kind, sum, sent }) => {
                // The sum of integers has a fraction; a third value says that integers are sent.
                let mut state = vec![assemble(*kind, *sum), assemble(*kind, *sent)];
                state.extend((*kind == Kind::Integer).then_some(Value::Boolean(true)));
                state
            }
        }
    }

    fn recall(&mut self, state: &[Value]) -> bool {
        restore(&mut self.running, None, state, |state| running(state).map(Some))
    }
}

fn running(state: &mut Recalled<'_>) -> Option<Running> {
    let first = state.value()?;
    let Some(sum) = components(first).filter(|_| first.kind() != Kind::Integer) else {
        return match first.kind() {
            Kind::Matrix2 | Kind::Matrix3 | Kind::Matrix4 => Some(Running::Product(first.clone())),
            _ => None,
        };
    };
    let sent = components(state.value().filter(|sent| sent.kind() == first.kind())?)?;
    let kind = match (first.kind(), state.left()) {
        (Kind::Real, 1) if state.boolean()? => Kind::Integer,
        (kind, _) => kind,
    };
    Some(Running::Sum { kind, sum, sent })
}

fn start(inputs: &Inputs<'_>) -> Result<Running, Fault> {
    let delta = inputs.get(1);
    let seed = inputs.find(2).unwrap_or(delta);
    if let Some(components) = components(seed) {
        let sum = if inputs.find(2).is_some() {
            components
        } else {
            [0.0; 4]
        };
        return Ok(Running::Sum {
            kind: seed.kind(),
            sum,
            sent: sum,
        });
    }
    let product = match (inputs.find(2), delta) {
        (Some(seed), _) => seed.clone(),
        (None, Value::Matrix2(_)) => DMat2::IDENTITY.into(),
        (None, Value::Matrix3(_)) => DMat3::IDENTITY.into(),
        (None, Value::Matrix4(_)) => DMat4::IDENTITY.into(),
        (None, _) => {
            return Err(Fault::Kind {
                input: 1,
                expected: SUMMED,
            });
        }
    };
    Ok(Running::Product(product))
}

/// A sum of integers that nothing made integral by <2> becomes real with the first real, or scale with a
/// fraction, that enters it.
fn promoted(inputs: &Inputs<'_>) -> Kind {
    let scale = inputs.get(4).as_number().unwrap_or(1.0);
    let real = inputs.get(1).kind() == Kind::Real || scale.fract() != 0.0;
    if real && inputs.find(2).is_none() {
        Kind::Real
    } else {
        Kind::Integer
    }
}

fn multiply(product: &mut Value, inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
    let next: Value = match (inputs.get(1), &*product) {
        (Value::Matrix2(new), Value::Matrix2(old)) => (**new * **old).into(),
        (Value::Matrix3(new), Value::Matrix3(old)) => (**new * **old).into(),
        (Value::Matrix4(new), Value::Matrix4(old)) => (**new * **old).into(),
        _ => {
            return Err(Fault::Kind {
                input: 1,
                expected: product.kind().into(),
            });
        }
    };
    if !next.is_finite() {
        return domain("the product is not finite; it was left as it was");
    }
    *product = next.clone();
    outputs.send(1, next);
    Ok(())
}

fn add(
    kind: Kind,
    sum: &mut [f64; 4],
    sent: &mut [f64; 4],
    inputs: &Inputs<'_>,
    outputs: &mut Outputs<'_>,
) -> Result<(), Fault> {
    let expected = if Kinds::NUMBER.has(kind) {
        Kinds::NUMBER
    } else {
        kind.into()
    };
    let delta = inputs.get(1);
    let delta = components(delta).filter(|_| expected.has(delta.kind()));
    let delta = delta.ok_or(Fault::Kind { input: 1, expected })?;
    let least = inputs.number_or(3, 0.0)?;
    let scale = inputs.number_or(4, 1.0)?;
    let mut next: [f64; 4] = std::array::from_fn(|i| sum[i] + delta[i] * scale);
    limit(&mut next, kind, inputs, 5, f64::min)?;
    limit(&mut next, kind, inputs, 6, f64::max)?;
    if !next.iter().all(|x| x.is_finite()) {
        return domain("the sum is not finite; it was left as it was");
    }
    *sum = next;
    if least <= 0.0 || moved(&next, sent) >= least {
        let value = sendable(kind, next)?;
        *sent = next;
        outputs.send(1, value);
    }
    Ok(())
}

/// How far two sums are apart.
fn moved(a: &[f64; 4], b: &[f64; 4]) -> f64 {
    a.iter()
        .zip(b)
        .map(|(a, b)| (a - b) * (a - b))
        .sum::<f64>()
        .sqrt()
}

/// Keeps the components that the kind has on the right side of a limit, where there is one.
#[inline]
fn limit(
    sum: &mut [f64; 4],
    kind: Kind,
    inputs: &Inputs<'_>,
    input: u8,
    keep: fn(f64, f64) -> f64,
) -> Result<(), Fault> {
    let Some(limit) = inputs.find(input) else {
        return Ok(());
    };
    let each = match limit.as_number() {
        Some(x) => [x; 4],
        None => components(limit)
            .filter(|_| limit.kind() == kind)
            .ok_or(Fault::Kind {
                input,
                expected: Kinds::NUMBER | kind.into(),
            })?,
    };
    for (x, limit) in sum.iter_mut().zip(each).take(count(kind)) {
        *x = keep(*x, limit);
    }
    Ok(())
}

fn count(kind: Kind) -> usize {
    match kind {
        Kind::Vector2 => 2,
        Kind::Vector3 => 3,
        Kind::Vector4 => 4,
        _ => 1,
    }
}

/// What is sent: of an integer sum, its whole part.
fn sendable(kind: Kind, sum: [f64; 4]) -> Result<Value, Fault> {
    match kind {
        Kind::Integer => Ok(integer(sum[0].trunc())?.into()),
        kind => Ok(assemble(kind, sum)),
    }
}

/// The running factor of DSCALE.
#[derive(Default)]
struct ScaleSum {
    factor: Option<f64>,
}

impl Function for ScaleSum {
    fn constant_set(&mut self, number: u8) {
        if number == 2 {
            self.factor = None;
        }
    }

    fn fire(&mut self, inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
        let start = inputs.number_or(2, 1.0)?;
        let old = self.factor.filter(|_| inputs.is_constant(2)).unwrap_or(start);
        let upper = inputs.number_or(4, f64::INFINITY)?;
        let lower = inputs.number_or(5, f64::NEG_INFINITY)?;
        let factor = (old + inputs.number(1)? * inputs.number(3)?)
            .min(upper)
            .max(lower);
        if !factor.is_finite() {
            return domain("the factor is not finite; it was left as it was");
        }
        self.factor = Some(factor);
        outputs.send(1, DMat3::from_diagonal(DVec3::splat(factor)));
        outputs.send(2, factor);
        Ok(())
    }

    remembers_one!(factor, Real, real);
}
