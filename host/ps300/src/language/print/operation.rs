//! Operations as canonical text.

use std::fmt;

use super::literal::{affine_rows, numbers, point, real, rows};
use crate::language::{Axis, Boundaries, Comparison, Operation, Range};

impl fmt::Display for Operation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Rotate { axis, degrees } => {
                let axis = match axis {
                    Axis::X => "X",
                    Axis::Y => "Y",
                    Axis::Z => "Z",
                };
                write!(f, "ROTATE IN {axis} {}", real(*degrees))
            }
            Self::Translate(by) => write!(f, "TRANSLATE BY {}", point(*by)),
            Self::Scale(by) => {
                let [x, y, z] = by.to_array().map(f64::to_bits);
                let text = if x == y && y == z { real(by.x) } else { point(*by) };
                write!(f, "SCALE BY {text}")
            }
            Self::Matrix2(m) => write!(f, "MATRIX_2x2 {}", rows(&m.transpose().to_cols_array(), 2)),
            Self::Matrix3(m) => write!(f, "MATRIX_3x3 {}", rows(&m.transpose().to_cols_array(), 3)),
            Self::Matrix4x3(m) => write!(f, "MATRIX_4x3 {}", rows(&affine_rows(m), 4)),
            Self::Matrix4(m) => write!(f, "MATRIX_4x4 {}", rows(&m.transpose().to_cols_array(), 4)),
            Self::Look { at, from, up } => {
                write!(f, "LOOK AT {} FROM {}", point(*at), point(*from))?;
                up.map_or(Ok(()), |up| write!(f, " UP {}", point(up)))
            }
            Self::FieldOfView { degrees, boundaries } => {
                write!(f, "FIELD_OF_VIEW {}", real(*degrees))?;
                print_boundaries(f, boundaries.as_ref())
            }
            Self::Window { x, y, boundaries } => {
                write!(f, "WINDOW X={x} Y={y}")?;
                print_boundaries(f, boundaries.as_ref())
            }
            Self::Viewport {
                horizontal,
                vertical,
                intensity,
            } => {
                write!(f, "VIEWPORT HORIZONTAL={horizontal} VERTICAL={vertical}")?;
                intensity.map_or(Ok(()), |range| write!(f, " INTENSITY={range}"))
            }
            Self::Eye {
                back,
                right,
                up,
                width,
                boundaries,
            } => {
                write!(f, "EYE BACK {}", real(*back))?;
                print_offset(f, ["RIGHT", "LEFT"], *right)?;
                print_offset(f, ["UP", "DOWN"], *up)?;
                write!(f, " FROM SCREEN AREA {} WIDE", real(*width))?;
                print_boundaries(f, boundaries.as_ref())
            }
            attribute => print_attribute(f, attribute),
        }
    }
}

/// ` RIGHT 2` or, of a negative number, ` LEFT 2`; nothing for what need not be written.
fn print_offset(f: &mut fmt::Formatter<'_>, [positive, negative]: [&str; 2], by: f64) -> fmt::Result {
    if by.to_bits() == 0 {
        Ok(())
    } else if by.is_sign_negative() {
        write!(f, " {negative} {}", real(-by))
    } else {
        write!(f, " {positive} {}", real(by))
    }
}

fn on_off(on: bool) -> &'static str {
    if on { "ON" } else { "OFF" }
}

fn print_attribute(f: &mut fmt::Formatter<'_>, operation: &Operation) -> fmt::Result {
    match operation {
        Operation::SetColor { hue_deg, saturation } => {
            write!(f, "SET COLOR {},{}", real(*hue_deg), real(*saturation))
        }
        Operation::SetColorBlending { saturation } => write!(f, "SET COLOR BLENDING {}", real(*saturation)),
        Operation::SetContrast(contrast) => write!(f, "SET CONTRAST TO {}", real(*contrast)),
        Operation::SetIntensity { on, range } => write!(f, "SET INTENSITY {} {range}", on_off(*on)),
        Operation::SetDepthClipping(on) => write!(f, "SET DEPTH_CLIPPING {}", on_off(*on)),
        Operation::SetPicking(on) => write!(f, "SET PICKING {}", on_off(*on)),
        Operation::SetPickingIdentifier(name) => write!(f, "SET PICKING IDENTIFIER={name}"),
        Operation::SetPickingLocation { center, size } => {
            let [center, size] = [center, size].map(|v| numbers(&v.to_array()));
            write!(f, "SET PICKING LOCATION={center} {size}")
        }
        Operation::SetDisplay { number, on } => write!(f, "SET DISPLAY {number} {}", on_off(*on)),
        Operation::SetPlotter(on) => write!(f, "SET PLOTTER {}", on_off(*on)),
        Operation::SetLineTexture { around_corners, mask } => {
            let around = if *around_corners { "AROUND_CORNERS " } else { "" };
            write!(f, "SET LINE_TEXTURE {around}{mask}")
        }
        condition => print_condition(f, condition),
    }
}

/// Bits, levels and phases: what sets them and what asks for them.
fn print_condition(f: &mut fmt::Formatter<'_>, operation: &Operation) -> fmt::Result {
    match operation {
        Operation::SetConditionalBit { bit, on } => {
            write!(f, "SET CONDITIONAL_BIT {bit} {}", on_off(*on))
        }
        Operation::IfConditionalBit { bit, on } => write!(f, "IF CONDITIONAL_BIT {bit} IS {}", on_off(*on)),
        Operation::SetLevelOfDetail(level) => write!(f, "SET LEVEL_OF_DETAIL TO {level}"),
        Operation::IncrementLevelOfDetail => f.write_str("INCREMENT LEVEL_OF_DETAIL"),
        Operation::DecrementLevelOfDetail => f.write_str("DECREMENT LEVEL_OF_DETAIL"),
        Operation::IfLevelOfDetail { comparison, level } => {
            write!(f, "IF LEVEL_OF_DETAIL {comparison} {level}")
        }
        Operation::SetRate {
            on_frames,
            off_frames,
            initially,
            delay_frames,
        } => {
            write!(f, "SET RATE {on_frames} {off_frames}")?;
            initially.map_or(Ok(()), |on| write!(f, " {}", on_off(on)))?;
            delay_frames.map_or(Ok(()), |frames| write!(f, " {frames}"))
        }
        Operation::SetRateExternal => f.write_str("SET RATE EXTERNAL"),
        Operation::IfPhase(on) => write!(f, "IF PHASE IS {}", on_off(*on)),
        other => print_other(f, other),
    }
}

/// Characters, places to read transforms, and rendering.
fn print_other(f: &mut fmt::Formatter<'_>, operation: &Operation) -> fmt::Result {
    match operation {
        Operation::CharacterScale(by) if by.x.to_bits() == by.y.to_bits() => {
            write!(f, "CHARACTER SCALE {}", real(by.x))
        }
        Operation::CharacterScale(by) => write!(f, "CHARACTER SCALE {}", numbers(&by.to_array())),
        Operation::CharacterRotate { degrees } => write!(f, "CHARACTER ROTATE {}", real(*degrees)),
        Operation::CharacterFont(name) => write!(f, "CHARACTER FONT {name}"),
        Operation::StandardFont => f.write_str("STANDARD FONT"),
        Operation::TextSize(size) => write!(f, "TEXT SIZE {}", real(*size)),
        Operation::XformMatrix => f.write_str("XFORM MATRIX"),
        Operation::XformVectorList => f.write_str("XFORM VECTOR_LIST"),
        Operation::SurfaceRendering => f.write_str("SURFACE_RENDERING"),
        Operation::SolidRendering => f.write_str("SOLID_RENDERING"),
        Operation::SectioningPlane => f.write_str("SECTIONING_PLANE"),
        printed => unreachable!("{printed:?} is printed above"),
    }
}

impl fmt::Display for Comparison {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let spelling = Self::ALL.iter().find(|(_, comparison)| comparison == self);
        f.write_str(spelling.expect("every comparison is in the table").0)
    }
}

fn print_boundaries(f: &mut fmt::Formatter<'_>, boundaries: Option<&Boundaries>) -> fmt::Result {
    boundaries.map_or(Ok(()), |boundaries| {
        write!(
            f,
            " FRONT BOUNDARY={} BACK BOUNDARY={}",
            real(boundaries.front),
            real(boundaries.back)
        )
    })
}

impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}", real(self.from), real(self.to))
    }
}
