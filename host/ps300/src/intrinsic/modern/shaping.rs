//! Functions that bend a number: ranges, dead zones, steps, mixtures.

use super::super::components::{CONTINUOUS, Point};
use super::super::function::{Fault, Inputs, Outputs, domain};
use super::super::spec::{Confidence, InputSpec, OutputSpec, Spec};
use super::{NUMBER, OURS, REAL_OUT, real, truth};

pub(super) const TABLE: &[Spec] = &[
    Spec::pure(
        "DR_MAP",
        &[NUMBER, real(0.0), real(1.0), real(0.0), real(1.0), truth(true)],
        &[REAL_OUT],
        map,
    )
    .says(
        "The number carried from the range <2> to <3> over to the range <4> to <5>, in which it \
             stays while <6> is TRUE. Ranges may run downwards; a first range of no width is \
             reported.",
    )
    .known(Confidence::Project, OURS)
    .example("<2> -1 | <3> 1 | <4> 0 | <5> 180 | <1> 0 | <1> 3 -> <1> 90 | <1> 180"),
    Spec::pure(
        "DR_DEADZONE",
        &[NUMBER, real(0.05), real(0.0), real(1.0)],
        &[REAL_OUT],
        deadzone,
    )
    .says(
        "How far the number lies from the centre <3>, 0 within <2> of it; beyond, growing without \
             a jump, so that at the distance <4> it is <4>. <4> not above <2>, or a negative <2>, is \
             reported.",
    )
    .known(Confidence::Project, OURS)
    .example("<2> 0.2 | <1> 0.1 | <1> 0.6 | <1> -1 -> <1> 0 | <1> 0.5 | <1> -1"),
    Spec::pure("DR_SNAP", &[NUMBER, real(1.0), real(0.0)], &[REAL_OUT], snap)
        .says(
            "The nearest of the numbers that lie a multiple of <2> from <3>. A step that is not \
             positive is reported.",
        )
        .known(Confidence::Project, OURS)
        .example("<2> 15 | <1> 52 | <1> 53 -> <1> 45 | <1> 60"),
    Spec::pure(
        "DR_MIX",
        &[
            InputSpec::active(CONTINUOUS),
            InputSpec::required(CONTINUOUS),
            real(0.5),
        ],
        &[OutputSpec::of(CONTINUOUS)],
        mix,
    )
    .says("Between <1>, where <3> is 0, and <2>, where <3> is 1: numbers, or vectors of one kind.")
    .known(Confidence::Project, OURS)
    .example("<2> V2D(10,0) | <3> 0.25 | <1> V2D(2,4) -> <1> V2D(4,3)"),
];

fn map(inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
    let [from, to] = [
        [inputs.number(2)?, inputs.number(3)?],
        [inputs.number(4)?, inputs.number(5)?],
    ];
    if from[0] == from[1] {
        return domain("the range to map from has no width");
    }
    let share = (inputs.number(1)? - from[0]) / (from[1] - from[0]);
    let share = if inputs.boolean(6)? {
        share.clamp(0.0, 1.0)
    } else {
        share
    };
    outputs.send(1, to[0] + (to[1] - to[0]) * share);
    Ok(())
}

fn deadzone(inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
    let (width, full) = (inputs.number(2)?, inputs.number(4)?);
    if width < 0.0 || full <= width {
        return domain("a dead zone is not negative and ends before the full distance");
    }
    let off = inputs.number(1)? - inputs.number(3)?;
    let beyond = (off.abs() - width).max(0.0) * full / (full - width);
    outputs.send(1, beyond.copysign(off));
    Ok(())
}

fn snap(inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
    let (step, from) = (inputs.number(2)?, inputs.number(3)?);
    if step <= 0.0 {
        return domain("a step is positive");
    }
    outputs.send(1, from + ((inputs.number(1)? - from) / step).round() * step);
    Ok(())
}

fn mix(inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
    let (a, b) = (Point::of(inputs, 1)?, Point::of(inputs, 2)?);
    if !a.is_like(b) {
        return Err(Fault::Kind {
            input: 2,
            expected: a.kinds(),
        });
    }
    outputs.send(1, a.towards(b, inputs.number(3)?).value());
    Ok(())
}
