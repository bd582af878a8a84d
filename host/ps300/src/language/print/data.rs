//! Data nodes as canonical text.

use std::fmt;

use glam::{DVec2, DVec3};

use super::literal::{numbers, point, quoted, real};
use super::node::Indent;
use crate::language::{
    Attributes, BSpline, Characters, Dimension, Font, Illumination, Labels, Pattern, Polygon, Polynomial,
    Surface, SurfaceColor, VectorClass, VectorList,
};

/// Longer tables are written one entry a line.
const ENTRIES_ON_A_LINE_MAX: usize = 4;

/// Puts what comes next on a line of its own, in a table of `count` entries that is too long for one line.
fn separate(f: &mut fmt::Formatter<'_>, count: usize, indent: Option<Indent>) -> fmt::Result {
    match indent {
        Some(indent) if count > ENTRIES_ON_A_LINE_MAX => write!(f, "{indent}"),
        _ => f.write_str(" "),
    }
}

/// What follows VECTOR_LIST; without an indent, on one line.
pub(super) struct Listed<'a>(pub(super) &'a VectorList, pub(super) Option<Indent>);

impl fmt::Display for Listed<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(list, indent) = *self;
        f.write_str(match list.class {
            VectorClass::Connected => "CONNECTED",
            VectorClass::Dots => "DOTS",
            VectorClass::Itemized => "ITEMIZED",
            VectorClass::Separate => "SEPARATE",
            VectorClass::Tabulated => "TABULATED",
        })?;
        f.write_str(if list.block_normalized {
            " BLOCK_NORMALIZED"
        } else {
            ""
        })?;
        f.write_str(if list.colored { " COLOR" } else { "" })?;
        write!(f, " N={}", list.vectors.len())?;
        let flat = list.dimension == Dimension::Two && list.vectors.iter().all(|v| v.at.z.to_bits() == 0);
        let dimension = if flat { Dimension::Two } else { Dimension::Three };
        let quantity = if list.class == VectorClass::Tabulated {
            "T"
        } else {
            "I"
        };
        for vector in &list.vectors {
            separate(f, list.vectors.len(), indent)?;
            if list.class.draws(0).is_none() {
                f.write_str(if vector.draw { "L " } else { "P " })?;
            }
            f.write_str(&coordinates(vector.at, dimension))?;
            if let Some(intensity) = vector.intensity {
                write!(f, " {quantity}={}", real(intensity))?;
            }
        }
        Ok(())
    }
}

fn coordinates(at: DVec3, dimension: Dimension) -> String {
    match dimension {
        Dimension::Two => numbers(&at.truncate().to_array()),
        Dimension::Three => point(at),
    }
}

pub(super) fn print_characters(f: &mut fmt::Formatter<'_>, characters: &Characters) -> fmt::Result {
    f.write_str("CHARACTERS ")?;
    // By bits: a negative zero is not the default.
    if point(characters.at) != point(DVec3::ZERO) {
        write!(f, "{} ", point(characters.at))?;
    }
    if numbers(&characters.step.to_array()) != numbers(&DVec2::X.to_array()) {
        write!(f, "STEP {} ", numbers(&characters.step.to_array()))?;
    }
    f.write_str(&quoted(&characters.text))
}

pub(super) fn print_labels(f: &mut fmt::Formatter<'_>, labels: &Labels, indent: Indent) -> fmt::Result {
    f.write_str("LABELS")?;
    for label in &labels.labels {
        separate(f, labels.labels.len(), Some(indent))?;
        write!(f, "{} {}", point(label.at), quoted(&label.text))?;
    }
    Ok(())
}

pub(super) fn print_bspline(f: &mut fmt::Formatter<'_>, curve: &BSpline, indent: Indent) -> fmt::Result {
    f.write_str(if curve.weights.is_some() { "RATIONAL " } else { "" })?;
    write!(f, "BSPLINE ORDER={}", curve.order)?;
    f.write_str(if curve.closed { " CLOSED" } else { " OPEN" })?;
    f.write_str(if curve.periodic {
        " PERIODIC"
    } else {
        " NONPERIODIC"
    })?;
    write!(f, " N={} VERTICES=", curve.vertices.len())?;
    print_control_points(
        f,
        &curve.vertices,
        curve.weights.as_deref(),
        curve.dimension,
        indent,
    )?;
    if !curve.knots.is_empty() {
        f.write_str(" KNOTS=")?;
        for knot in &curve.knots {
            write!(f, " {}", real(*knot))?;
        }
    }
    write!(f, " CHORDS={}", curve.chords)
}

pub(super) fn print_polynomial(
    f: &mut fmt::Formatter<'_>,
    curve: &Polynomial,
    indent: Indent,
) -> fmt::Result {
    f.write_str(if curve.weights.is_some() { "RATIONAL " } else { "" })?;
    write!(f, "POLYNOMIAL ORDER={} COEFFICIENTS=", curve.order)?;
    print_control_points(
        f,
        &curve.coefficients,
        curve.weights.as_deref(),
        curve.dimension,
        indent,
    )?;
    write!(f, " CHORDS={}", curve.chords)
}

fn print_control_points(
    f: &mut fmt::Formatter<'_>,
    points: &[DVec3],
    weights: Option<&[f64]>,
    dimension: Dimension,
    indent: Indent,
) -> fmt::Result {
    for (index, at) in points.iter().enumerate() {
        separate(f, points.len(), Some(indent))?;
        f.write_str(&coordinates(*at, dimension))?;
        if let Some(weight) = weights.and_then(|weights| weights.get(index)) {
            write!(f, ",{}", real(*weight))?;
        }
    }
    Ok(())
}

pub(super) fn print_polygons(
    f: &mut fmt::Formatter<'_>,
    polygons: &[Polygon],
    indent: Indent,
) -> fmt::Result {
    for (index, polygon) in polygons.iter().enumerate() {
        if index > 0 {
            write!(f, "{indent}")?;
        }
        f.write_str("POLYGON")?;
        if let Some(name) = &polygon.attributes {
            write!(f, " WITH ATTRIBUTES {name}")?;
        }
        if let Some(hue_deg) = polygon.outline_hue_deg {
            write!(f, " WITH OUTLINE {}", real(hue_deg))?;
        }
        f.write_str(if polygon.coplanar { " COPLANAR" } else { "" })?;
        for vertex in &polygon.vertices {
            separate(f, polygon.vertices.len(), Some(indent.deeper()))?;
            f.write_str(if vertex.soft { "S " } else { "" })?;
            f.write_str(&point(vertex.at))?;
            if let Some(normal) = vertex.normal {
                write!(f, " N {}", point(normal))?;
            }
        }
    }
    Ok(())
}

pub(super) fn print_attributes(f: &mut fmt::Formatter<'_>, attributes: &Attributes) -> fmt::Result {
    f.write_str("ATTRIBUTES")?;
    print_surface(f, &attributes.front)?;
    if let Some(back) = &attributes.back {
        f.write_str(" AND")?;
        print_surface(f, back)?;
    }
    Ok(())
}

fn print_surface(f: &mut fmt::Formatter<'_>, surface: &Surface) -> fmt::Result {
    print_color(f, surface.color)?;
    print_quantity(f, "OPAQUE", surface.opaque)?;
    print_quantity(f, "DIFFUSE", surface.diffuse)?;
    print_quantity(f, "SPECULAR", surface.specular)
}

fn print_color(f: &mut fmt::Formatter<'_>, color: Option<SurfaceColor>) -> fmt::Result {
    color.map_or(Ok(()), |color| {
        let numbers = numbers(&[color.hue_deg, color.saturation, color.intensity]);
        write!(f, " COLOR {numbers}")
    })
}

fn print_quantity(f: &mut fmt::Formatter<'_>, word: &str, quantity: Option<f64>) -> fmt::Result {
    quantity.map_or(Ok(()), |number| write!(f, " {word} {}", real(number)))
}

pub(super) fn print_illumination(f: &mut fmt::Formatter<'_>, light: &Illumination) -> fmt::Result {
    write!(f, "ILLUMINATION {}", point(light.direction))?;
    print_color(f, light.color)?;
    print_quantity(f, "AMBIENT", light.ambient)
}

pub(super) fn print_pattern(f: &mut fmt::Formatter<'_>, pattern: &Pattern) -> fmt::Result {
    f.write_str("PATTERN")?;
    for segment in &pattern.segments {
        write!(f, " {segment}")?;
    }
    f.write_str(if pattern.around_corners {
        " AROUND_CORNERS"
    } else {
        ""
    })?;
    f.write_str(if pattern.matched { " MATCH" } else { " NOMATCH" })?;
    write!(f, " LENGTH {}", real(pattern.length))
}

pub(super) fn print_font(f: &mut fmt::Formatter<'_>, font: &Font, indent: Indent) -> fmt::Result {
    f.write_str("BEGIN_FONT")?;
    for glyph in &font.glyphs {
        write!(f, "{}", indent.deeper())?;
        write!(f, "C[{}]: N={}", u32::from(glyph.character), glyph.vectors.len())?;
        for vector in &glyph.vectors {
            let mark = if vector.draw { "L" } else { "P" };
            write!(f, " {mark} {}", numbers(&vector.at.to_array()))?;
        }
        f.write_str(";")?;
    }
    write!(f, "{indent}END_FONT")
}
