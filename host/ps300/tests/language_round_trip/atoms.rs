//! Names, numbers, texts, literals: what commands are made of.

use glam::{DAffine3, DMat2, DMat3, DMat4, DVec2, DVec3, DVec4};
use proptest::prelude::*;
use ps300::language::{KEYWORDS, Name};
use ps300::value::{Kind, Value};

use super::data::vector_list;

/// Names that are also words of the language, long names, dotted names.
pub(crate) fn name() -> impl Strategy<Value = Name> + Clone {
    prop_oneof![
        3 => "[A-Za-z][A-Za-z0-9_$]{0,8}",
        2 => prop::sample::select(KEYWORDS).prop_map(|(word, _)| word.to_owned()),
        2 => prop::sample::select(vec!["f", "begin_s", "end_s", "end_f", "poly", "fov", "cond_bit", "Größe"])
            .prop_map(str::to_owned),
        1 => "[a-z]{1,3}\\.[a-z][a-z0-9]{0,3}",
        1 => "[a-z]{200,240}",
    ]
    .prop_map(|text| Name::new(&text))
}

/// Labels have no dots.
pub(crate) fn label() -> impl Strategy<Value = Name> {
    name().prop_filter("a label has no dot", |name| !name.as_str().contains('.'))
}

pub(crate) fn real() -> impl Strategy<Value = f64> + Clone {
    prop_oneof![
        2 => prop::sample::select(vec![0.0, -0.0, 1.0, -1.0, 5.0, 1e-300, -1e300, 5e-324, f64::MAX, f64::MIN_POSITIVE,
            0.1, 1.0 / 3.0, 1e16, 123_456_789_012_345_680.0, 1e15]),
        3 => -1000.0..1000.0,
        1 => any::<f64>().prop_filter("literals are finite", |number| number.is_finite()),
    ]
}

pub(crate) fn reals<const COUNT: usize>() -> impl Strategy<Value = [f64; COUNT]> {
    prop::collection::vec(real(), COUNT).prop_map(|numbers| numbers.try_into().expect("as many as asked for"))
}

pub(crate) fn point() -> impl Strategy<Value = DVec3> + Clone {
    (real(), real(), real()).prop_map(DVec3::from)
}

pub(crate) fn pair() -> impl Strategy<Value = DVec2> {
    reals::<2>().prop_map(DVec2::from_array)
}

pub(crate) fn text() -> impl Strategy<Value = String> {
    prop_oneof![
        Just(String::new()),
        "[ -~]{0,12}",
        "['\";{}\n\r\t\u{0}\u{7f}a]{0,8}",
        any::<String>(),
    ]
}

/// One strategy for each kind that has a literal. Forgetting a new kind does not compile.
fn literal_of(kind: Kind) -> Option<BoxedStrategy<Value>> {
    Some(match kind {
        Kind::Boolean => any::<bool>().prop_map(Value::from).boxed(),
        Kind::Integer => any::<i32>().prop_map(Value::from).boxed(),
        Kind::Real => real().prop_map(Value::from).boxed(),
        Kind::String => text().prop_map(|text| Value::from(text.as_str())).boxed(),
        Kind::Vector2 => pair().prop_map(Value::from).boxed(),
        Kind::Vector3 => point().prop_map(Value::from).boxed(),
        Kind::Vector4 => reals::<4>().prop_map(|n| DVec4::from_array(n).into()).boxed(),
        Kind::Matrix2 => reals::<4>()
            .prop_map(|n| DMat2::from_cols_array(&n).into())
            .boxed(),
        Kind::Matrix3 => reals::<9>()
            .prop_map(|n| DMat3::from_cols_array(&n).into())
            .boxed(),
        Kind::Matrix4 => reals::<16>()
            .prop_map(|n| DMat4::from_cols_array(&n).into())
            .boxed(),
        Kind::Matrix4x3 => reals::<12>()
            .prop_map(|n| DAffine3::from_cols_array(&n).into())
            .boxed(),
        Kind::Vectors => vector_list().prop_map(Value::from).boxed(),
        Kind::Picks => return None,
    })
}

pub(crate) fn value() -> impl Strategy<Value = Value> {
    prop::strategy::Union::new(Kind::ALL.into_iter().filter_map(literal_of))
}
