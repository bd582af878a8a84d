//! Data nodes.

use glam::{DVec2, DVec3};
use proptest::prelude::*;
use ps300::language::{
    Attributes, BSpline, Characters, Dimension, Font, Glyph, GlyphVector, Illumination, Label, Labels, Node,
    Pattern, Polygon, PolygonVertex, Polynomial, Surface, SurfaceColor, Vector, VectorClass, VectorList,
};

use super::atoms::{name, pair, point, real, reals, text};

/// In two dimensions z is not written, and a list without anything is not flat.
fn flattened(dimension: Dimension, points: &mut [DVec3]) -> Dimension {
    if points.is_empty() {
        return Dimension::Three;
    }
    if dimension == Dimension::Two {
        for point in points {
            point.z = 0.0;
        }
    }
    dimension
}

fn dimension() -> impl Strategy<Value = Dimension> {
    prop::sample::select(vec![Dimension::Two, Dimension::Three])
}

pub(crate) fn vector_list() -> impl Strategy<Value = VectorList> {
    let class = prop::sample::select(vec![
        VectorClass::Connected,
        VectorClass::Dots,
        VectorClass::Itemized,
        VectorClass::Separate,
        VectorClass::Tabulated,
    ]);
    let intensity = prop::option::of((real(), 0..=VectorClass::TABLE_LAST));
    let vector = (point(), any::<bool>(), intensity);
    let vectors = prop::collection::vec(vector, 0..8);
    (class, dimension(), any::<bool>(), any::<bool>(), vectors).prop_map(
        |(class, dimension, block_normalized, colored, vectors)| {
            let mut points: Vec<DVec3> = vectors.iter().map(|vector| vector.0).collect();
            let dimension = flattened(dimension, &mut points);
            let vectors = vectors.into_iter().zip(points).enumerate();
            let vectors = vectors.map(|(index, ((_, draw, intensity), at))| Vector {
                at,
                draw: class.draws(index).unwrap_or(draw),
                intensity: intensity.map(|(brightness, entry)| {
                    if class == VectorClass::Tabulated {
                        f64::from(entry)
                    } else {
                        brightness
                    }
                }),
            });
            VectorList {
                class,
                block_normalized,
                colored,
                dimension,
                vectors: vectors.collect(),
            }
        },
    )
}

fn characters() -> impl Strategy<Value = Characters> {
    let at = prop_oneof![Just(DVec3::ZERO), point()];
    let step = prop_oneof![Just(DVec2::X), pair()];
    (at, step, text()).prop_map(|(at, step, text)| Characters {
        at,
        step,
        text: text.into(),
    })
}

fn labels() -> impl Strategy<Value = Labels> {
    let label = (point(), text()).prop_map(|(at, text)| Label {
        at,
        text: text.into(),
    });
    prop::collection::vec(label, 0..6).prop_map(|labels| Labels { labels })
}

fn bspline() -> impl Strategy<Value = BSpline> {
    let flags = (any::<bool>(), any::<bool>(), any::<bool>());
    let controls = prop::collection::vec((point(), real()), 0..7);
    let knots = prop::collection::vec(real(), 0..7);
    (
        1..=BSpline::ORDER_MAX,
        flags,
        dimension(),
        controls,
        knots,
        1..=u32::MAX,
    )
        .prop_map(
            |(order, (closed, periodic, rational), dimension, controls, knots, chords)| {
                let (mut vertices, weights): (Vec<_>, Vec<_>) = controls.into_iter().unzip();
                BSpline {
                    order,
                    closed,
                    periodic,
                    dimension: flattened(dimension, &mut vertices),
                    vertices,
                    weights: rational.then_some(weights),
                    knots,
                    chords,
                }
            },
        )
}

fn polynomial() -> impl Strategy<Value = Polynomial> {
    let controls = prop::collection::vec((point(), real()), 1..=usize::from(Polynomial::ORDER_MAX) + 1);
    (any::<bool>(), dimension(), controls, 1..=u32::MAX).prop_map(
        |(rational, dimension, controls, chords)| {
            let (mut coefficients, weights): (Vec<_>, Vec<_>) = controls.into_iter().unzip();
            Polynomial {
                order: coefficients.len() as u8 - 1,
                dimension: flattened(dimension, &mut coefficients),
                coefficients,
                weights: rational.then_some(weights),
                chords,
            }
        },
    )
}

fn polygon() -> impl Strategy<Value = Polygon> {
    let vertex = (point(), any::<bool>(), prop::option::of(point()))
        .prop_map(|(at, soft, normal)| PolygonVertex { at, soft, normal });
    let head = (prop::option::of(name()), prop::option::of(real()), any::<bool>());
    (head, prop::collection::vec(vertex, 3..7)).prop_map(
        |((attributes, outline_hue_deg, coplanar), vertices)| Polygon {
            attributes,
            outline_hue_deg,
            coplanar,
            vertices,
        },
    )
}

fn color() -> impl Strategy<Value = Option<SurfaceColor>> {
    prop::option::of(
        reals::<3>().prop_map(|[hue_deg, saturation, intensity]| SurfaceColor {
            hue_deg,
            saturation,
            intensity,
        }),
    )
}

fn surface() -> impl Strategy<Value = Surface> {
    let quantity = || prop::option::of(real());
    (color(), quantity(), quantity(), quantity()).prop_map(|(color, opaque, diffuse, specular)| Surface {
        color,
        opaque,
        diffuse,
        specular,
    })
}

fn attributes() -> impl Strategy<Value = Attributes> {
    (surface(), prop::option::of(surface())).prop_map(|(front, back)| Attributes { front, back })
}

fn illumination() -> impl Strategy<Value = Illumination> {
    (point(), color(), prop::option::of(real())).prop_map(|(direction, color, ambient)| Illumination {
        direction,
        color,
        ambient,
    })
}

fn pattern() -> impl Strategy<Value = Pattern> {
    let segments = prop::collection::vec(any::<u16>(), 1..9);
    (segments, any::<bool>(), any::<bool>(), real()).prop_map(
        |(segments, around_corners, matched, length)| Pattern {
            segments,
            around_corners,
            matched,
            length,
        },
    )
}

fn font() -> impl Strategy<Value = Font> {
    let vector = (pair(), any::<bool>()).prop_map(|(at, draw)| GlyphVector { at, draw });
    let glyph = (any::<char>(), prop::collection::vec(vector, 0..5))
        .prop_map(|(character, vectors)| Glyph { character, vectors });
    prop::collection::vec(glyph, 0..4).prop_map(|glyphs| Font { glyphs })
}

fn copy() -> impl Strategy<Value = Node> {
    let number = || prop::option::of(1..=u32::MAX);
    (name(), number(), number()).prop_map(|(of, start, count)| Node::Copy { of, start, count })
}

/// One strategy for each sort of data node.
pub(crate) fn data() -> Vec<BoxedStrategy<Node>> {
    vec![
        vector_list().prop_map(Node::VectorList).boxed(),
        characters().prop_map(Node::Characters).boxed(),
        labels().prop_map(Node::Labels).boxed(),
        bspline().prop_map(Node::BSpline).boxed(),
        polynomial().prop_map(Node::Polynomial).boxed(),
        prop::collection::vec(polygon(), 1..4)
            .prop_map(Node::Polygons)
            .boxed(),
        attributes().prop_map(Node::Attributes).boxed(),
        illumination().prop_map(Node::Illumination).boxed(),
        pattern().prop_map(Node::Pattern).boxed(),
        font().prop_map(Node::Font).boxed(),
        copy().boxed(),
    ]
}
