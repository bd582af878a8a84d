//! Rotation matrices, from an angle or from movements that add up to one.
//!
//! Positive by the right-hand formula: the first row about z is (cos, -sin, 0).

use glam::DMat3;

use super::function::{Fault, Function, Inputs, Outputs, domain};
use super::recalled::remembers_one;
use super::spec::{Confidence, InputSpec, OutputSpec, Preset, Spec};
use crate::value::{Kind, Kinds};

const MATRIX3: OutputSpec = OutputSpec::of(Kinds::of(&[Kind::Matrix3]));

const ANGLE_IN: &[InputSpec] = &[InputSpec::active(Kinds::NUMBER)];

const MOVEMENT_IN: &[InputSpec] = &[
    InputSpec::active(Kinds::NUMBER),
    InputSpec::constant(Kinds::NUMBER, Preset::Real(0.0)),
    InputSpec::constant(Kinds::NUMBER, Preset::Real(1.0)),
];
const MOVEMENT_OUT: &[OutputSpec] = &[MATRIX3, OutputSpec::of(Kinds::REAL)];

macro_rules! absolute {
    ($name:literal, $about:expr) => {
        Spec::pure($name, ANGLE_IN, &[MATRIX3], |inputs, outputs| {
            outputs.send(1, $about(inputs.number(1)?.to_radians()));
            Ok(())
        })
        .says("The rotation by an angle in degrees.")
    };
}

macro_rules! integrating {
    ($name:literal, $about:expr) => {
        Spec::stateful($name, MOVEMENT_IN, MOVEMENT_OUT, |_| {
            Box::new(Turning {
                about: $about,
                degrees: None,
            })
        })
        .says(
            "Running angle in degrees: the start <2> plus every <1> times the scale <3>. Output <1> \
             the rotation by it, <2> the angle. Sending <2> starts anew from there without sending.",
        )
        .known(
            Confidence::Used,
            "D0 dial networks for the inputs and output 1; output 2 recollected; defaults ours",
        )
    };
}

pub(super) const TABLE: &[Spec] = &[
    absolute!("XROTATE", DMat3::from_rotation_x)
        .known(Confidence::High, "recollected")
        .example("<1> 90 -> <1> M3D(1,0,0, 0,0,-1, 0,1,0)"),
    absolute!("YROTATE", DMat3::from_rotation_y)
        .known(Confidence::High, "recollected")
        .example("<1> 90 -> <1> M3D(0,0,1, 0,1,0, -1,0,0)"),
    absolute!("ZROTATE", DMat3::from_rotation_z)
        .known(Confidence::Used, "D0 viewing networks")
        .example("<1> 90 -> <1> M3D(0,-1,0, 1,0,0, 0,0,1)"),
    integrating!("DXROTATE", DMat3::from_rotation_x)
        .example("<3> 200 | <1> 0.45 -> <1> M3D(1,0,0, 0,0,-1, 0,1,0) | <2> 90"),
    integrating!("DYROTATE", DMat3::from_rotation_y)
        .example("<2> 45 | <1> 45 -> <1> M3D(0,0,1, 0,1,0, -1,0,0) | <2> 90"),
    integrating!("DZROTATE", DMat3::from_rotation_z).example(
        "<3> 90 | <1> 0.5 | <1> 0.5 -> <1> M3D(0.7071067811865476,-0.7071067811865476,0, \
             0.7071067811865476,0.7071067811865476,0, 0,0,1) | <2> 45 | <1> M3D(0,-1,0, 1,0,0, 0,0,1) \
             | <2> 90",
    ),
];

struct Turning {
    about: fn(f64) -> DMat3,
    degrees: Option<f64>,
}

impl Function for Turning {
    fn constant_set(&mut self, number: u8) {
        if number == 2 {
            self.degrees = None;
        }
    }

    fn fire(&mut self, inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
        let start = inputs.number(2)?;
        let old = self.degrees.filter(|_| inputs.is_constant(2)).unwrap_or(start);
        let degrees = old + inputs.number(1)? * inputs.number(3)?;
        if !degrees.is_finite() {
            return domain("the angle is not finite; it was left as it was");
        }
        self.degrees = Some(degrees);
        outputs.send(1, (self.about)(degrees.to_radians()));
        outputs.send(2, degrees);
        Ok(())
    }

    remembers_one!(degrees, Real, real);
}
