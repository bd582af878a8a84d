//! Random messages, the same for the same seed.

use glam::{DMat2, DMat3, DMat4, DVec2, DVec3, DVec4};
use ps300::intrinsic::InputSpec;
use ps300::language::Name;
use ps300::pick::{Pick, Picked, Spot};
use ps300::{Kind, Value};

/// Numbers to choose with, the same for the same seed (xorshift, Marsaglia 2003).
pub(crate) struct Dice(u64);

impl Dice {
    pub(crate) fn new(seed: u64) -> Self {
        Self(0x9e37_79b9_7f4a_7c15_u64.wrapping_mul(seed))
    }

    pub(crate) fn below(&mut self, bound: u64) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0 % bound
    }

    fn number(&mut self) -> f64 {
        self.below(41) as f64 / 8.0 - 1.0
    }

    /// Up to two picks.
    fn picks(&mut self) -> Value {
        let pick = |dice: &mut Self| Pick {
            index: dice.below(9) as i32,
            identifiers: (0..dice.below(3)).map(|_| Name::new("id")).collect(),
            node: Name::new("node"),
            kind: Picked::Curve,
            dimension: 2 + dice.below(2) as u8,
            spot: (dice.below(2) == 0).then_some(Spot {
                at: DVec3::splat(dice.number()),
                along: 0.5,
            }),
        };
        Value::Picks((0..self.below(3)).map(|_| pick(self)).collect())
    }

    /// A message `input` takes, of a kind with a literal where it takes one.
    pub(crate) fn value(&mut self, input: InputSpec) -> Value {
        let kinds: Vec<_> = input
            .kinds
            .iter()
            .filter(|kind| !matches!(kind, Kind::Vectors | Kind::Picks | Kind::Matrix4x3))
            .collect();
        if kinds.is_empty() {
            return self.picks();
        }
        let kind = kinds[self.below(kinds.len() as u64) as usize];
        let x = self.number();
        match kind {
            Kind::Boolean => (x > 1.5).into(),
            Kind::Integer => (self.below(6) as i32).into(),
            Kind::Real => x.into(),
            Kind::Vector2 => DVec2::new(x, 1.0).into(),
            Kind::Vector3 => DVec3::new(x, 1.0, -x).into(),
            Kind::Vector4 => DVec4::new(x, 1.0, -x, 0.5).into(),
            Kind::Matrix2 => DMat2::from_angle(x).into(),
            Kind::Matrix3 => DMat3::from_rotation_x(x).into(),
            Kind::Matrix4 => DMat4::from_rotation_x(x).into(),
            _ => ["", "a", "ab c", "12", "\n"][self.below(5) as usize].into(),
        }
    }
}
