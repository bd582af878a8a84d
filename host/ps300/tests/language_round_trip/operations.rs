//! Operation nodes.

use glam::{DAffine3, DMat2, DMat3, DMat4, DVec3};
use proptest::prelude::*;
use ps300::language::{Axis, Boundaries, Comparison, Operation, Range};

use super::atoms::{name, pair, point, real, reals};

fn range() -> impl Strategy<Value = Range> {
    reals::<2>().prop_map(|[from, to]| Range { from, to })
}

fn boundaries() -> impl Strategy<Value = Option<Boundaries>> {
    prop::option::of(reals::<2>().prop_map(|[front, back]| Boundaries { front, back }))
}

fn transforms() -> Vec<BoxedStrategy<Operation>> {
    let axis = prop::sample::select(vec![Axis::X, Axis::Y, Axis::Z]);
    vec![
        (axis, real())
            .prop_map(|(axis, degrees)| Operation::Rotate { axis, degrees })
            .boxed(),
        point().prop_map(Operation::Translate).boxed(),
        prop_oneof![point(), real().prop_map(DVec3::splat)]
            .prop_map(Operation::Scale)
            .boxed(),
        reals::<4>()
            .prop_map(|n| Operation::Matrix2(DMat2::from_cols_array(&n)))
            .boxed(),
        reals::<9>()
            .prop_map(|n| Operation::Matrix3(DMat3::from_cols_array(&n)))
            .boxed(),
        reals::<12>()
            .prop_map(|n| Operation::Matrix4x3(DAffine3::from_cols_array(&n)))
            .boxed(),
        reals::<16>()
            .prop_map(|n| Operation::Matrix4(DMat4::from_cols_array(&n)))
            .boxed(),
    ]
}

fn views() -> Vec<BoxedStrategy<Operation>> {
    vec![
        (point(), point(), prop::option::of(point()))
            .prop_map(|(at, from, up)| Operation::Look { at, from, up })
            .boxed(),
        (real(), boundaries())
            .prop_map(|(degrees, boundaries)| Operation::FieldOfView { degrees, boundaries })
            .boxed(),
        (range(), range(), boundaries())
            .prop_map(|(x, y, boundaries)| Operation::Window { x, y, boundaries })
            .boxed(),
        (reals::<4>(), boundaries())
            .prop_map(|([back, right, up, width], boundaries)| Operation::Eye {
                back,
                right,
                up,
                width,
                boundaries,
            })
            .boxed(),
        (range(), range(), prop::option::of(range()))
            .prop_map(|(horizontal, vertical, intensity)| Operation::Viewport {
                horizontal,
                vertical,
                intensity,
            })
            .boxed(),
    ]
}

fn attributes() -> Vec<BoxedStrategy<Operation>> {
    vec![
        reals::<2>()
            .prop_map(|[hue_deg, saturation]| Operation::SetColor { hue_deg, saturation })
            .boxed(),
        real()
            .prop_map(|saturation| Operation::SetColorBlending { saturation })
            .boxed(),
        (any::<bool>(), range())
            .prop_map(|(on, range)| Operation::SetIntensity { on, range })
            .boxed(),
        real().prop_map(Operation::SetContrast).boxed(),
        any::<bool>().prop_map(Operation::SetDepthClipping).boxed(),
        any::<bool>().prop_map(Operation::SetPicking).boxed(),
        name().prop_map(Operation::SetPickingIdentifier).boxed(),
        (pair(), pair())
            .prop_map(|(center, size)| Operation::SetPickingLocation { center, size })
            .boxed(),
        (any::<u8>(), any::<bool>())
            .prop_map(|(number, on)| Operation::SetDisplay { number, on })
            .boxed(),
        any::<bool>().prop_map(Operation::SetPlotter).boxed(),
        (any::<bool>(), 1..=Operation::LINE_TEXTURE_MAX)
            .prop_map(|(around_corners, mask)| Operation::SetLineTexture { around_corners, mask })
            .boxed(),
    ]
}

fn conditions() -> Vec<BoxedStrategy<Operation>> {
    let rate = (
        any::<u32>(),
        any::<u32>(),
        prop::option::of(any::<bool>()),
        prop::option::of(any::<u32>()),
    );
    let comparison = prop::sample::select(Comparison::ALL.map(|(_, comparison)| comparison).to_vec());
    vec![
        (0..Operation::CONDITIONAL_BITS, any::<bool>())
            .prop_map(|(bit, on)| Operation::SetConditionalBit { bit, on })
            .boxed(),
        (0..Operation::CONDITIONAL_BITS, any::<bool>())
            .prop_map(|(bit, on)| Operation::IfConditionalBit { bit, on })
            .boxed(),
        any::<i32>().prop_map(Operation::SetLevelOfDetail).boxed(),
        Just(Operation::IncrementLevelOfDetail).boxed(),
        Just(Operation::DecrementLevelOfDetail).boxed(),
        (comparison, any::<i32>())
            .prop_map(|(comparison, level)| Operation::IfLevelOfDetail { comparison, level })
            .boxed(),
        rate.prop_map(
            |(on_frames, off_frames, initially, delay_frames)| Operation::SetRate {
                on_frames,
                off_frames,
                initially,
                delay_frames,
            },
        )
        .boxed(),
        Just(Operation::SetRateExternal).boxed(),
        any::<bool>().prop_map(Operation::IfPhase).boxed(),
    ]
}

fn others() -> Vec<BoxedStrategy<Operation>> {
    vec![
        pair().prop_map(Operation::CharacterScale).boxed(),
        real()
            .prop_map(|degrees| Operation::CharacterRotate { degrees })
            .boxed(),
        name().prop_map(Operation::CharacterFont).boxed(),
        Just(Operation::StandardFont).boxed(),
        real().prop_map(Operation::TextSize).boxed(),
        Just(Operation::XformMatrix).boxed(),
        Just(Operation::XformVectorList).boxed(),
        Just(Operation::SurfaceRendering).boxed(),
        Just(Operation::SolidRendering).boxed(),
        Just(Operation::SectioningPlane).boxed(),
    ]
}

/// One strategy for each operation.
pub(crate) fn operations() -> Vec<BoxedStrategy<Operation>> {
    [transforms(), views(), attributes(), conditions(), others()].concat()
}

pub(crate) fn operation() -> impl Strategy<Value = Operation> {
    prop::strategy::Union::new(operations())
}
