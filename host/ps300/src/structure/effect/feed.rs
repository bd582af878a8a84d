//! Messages to operation nodes.

use glam::{DMat2, DMat4, DVec3};

use super::{Effect, has_planes};
use crate::display::Viewport;
use crate::language::{Input, Operation};
use crate::network::Refusal;
use crate::value::{Kinds, Value};

impl Effect {
    /// Takes a message. The kind has been checked against [`super::accepts`].
    pub(in super::super) fn feed(
        &mut self,
        operation: &Operation,
        input: Input,
        value: &Value,
    ) -> Result<(), Refusal> {
        // What dials send nearly always.
        if let (Self::Model(model), Value::Matrix3(m)) = (&mut *self, value) {
            *model = DMat4::from_mat3(**m);
            return Ok(());
        }
        let second = input == Input::Number(2);
        match (&mut *self, value) {
            (Self::Rendering(rendering), value) => rendering.feed(second, value)?,
            (Self::Color { saturation, .. }, value) if second => *saturation = share(value)?,
            (Self::Color { hue_deg, saturation }, Value::Vector2(v)) => {
                (*hue_deg, *saturation) = (v.x, v.y.clamp(0.0, 1.0));
            }
            (Self::Color { hue_deg, .. }, value) => *hue_deg = number(value)?,
            (Self::Blending(of) | Self::Contrast(of), value) => *of = share(value)?,
            (Self::Intensity { range, .. }, Value::Vector2(v)) => *range = v.to_array(),
            (
                Self::Intensity { on, .. }
                | Self::Bit { on, .. }
                | Self::DepthClipping(on)
                | Self::Picking(on)
                | Self::Phase(on)
                | Self::Shown(on),
                Value::Boolean(b),
            ) => *on = *b,
            (Self::Level(level) | Self::LevelBy(level), Value::Integer(n)) => *level = *n,
            (Self::PickWindow { half, .. }, Value::Vector2(v)) if second => *half = v.abs(),
            (Self::PickWindow { center, .. }, Value::Vector2(v)) => *center = *v,
            (Self::Viewport { .. }, Value::Matrix3(m)) => {
                let row = |n: usize| [m.row(n).x, m.row(n).y];
                *self = Self::Viewport {
                    viewport: Viewport {
                        horizontal: row(0),
                        vertical: row(1),
                    },
                    intensity: Some(row(2)),
                };
            }
            (Self::CharactersOnly(by) | Self::Characters(by), value) => *by = characters(value)?,
            _ => self.feed_matrix(operation, value)?,
        }
        Ok(())
    }

    /// What a message that has just been taken came to, where telling it again would come to something else.
    pub(in super::super) fn outcome(&self, input: Input, value: &Value) -> Option<Value> {
        match self {
            Self::Rendering(rendering) if input == Input::Number(1) => rendering.outcome(value),
            _ => None,
        }
    }

    fn feed_matrix(&mut self, operation: &Operation, value: &Value) -> Result<(), Refusal> {
        match (&mut *self, value) {
            (_, Value::Matrix3(m)) => *self = Self::model(**m),
            (_, Value::Matrix4(m)) => {
                let view = matches!(
                    operation,
                    Operation::FieldOfView { .. } | Operation::Window { .. } | Operation::Eye { .. }
                );
                *self = if view {
                    Self::View {
                        onto: **m,
                        deep: has_planes(m),
                    }
                } else {
                    Self::matrix4(**m)
                };
            }
            (Self::Look(look), Value::Matrix4x3(m)) => *look = (**m).into(),
            (Self::Model(model), Value::Matrix4x3(m)) => *model = (**m).into(),
            (Self::Model(model), Value::Vector2(v)) => *model = DMat4::from_translation(v.extend(0.0)),
            (Self::Model(model), Value::Vector3(v)) => {
                let scales = matches!(operation, Operation::Scale(_));
                *model = if scales {
                    DMat4::from_scale(*v)
                } else {
                    DMat4::from_translation(*v)
                };
            }
            (Self::Model(model), value) => *model = DMat4::from_scale(DVec3::splat(number(value)?)),
            _ => {}
        }
        Ok(())
    }
}

/// Characters by a number, two of them, or a matrix.
fn characters(value: &Value) -> Result<DMat2, Refusal> {
    Ok(match value {
        Value::Matrix2(m) => **m,
        Value::Vector2(v) => DMat2::from_diagonal(*v),
        value => DMat2::from_diagonal(glam::DVec2::splat(number(value)?)),
    })
}

fn number(value: &Value) -> Result<f64, Refusal> {
    value.as_number().ok_or(Refusal::Kind(Kinds::NUMBER))
}

fn share(value: &Value) -> Result<f64, Refusal> {
    Ok(number(value)?.clamp(0.0, 1.0))
}
