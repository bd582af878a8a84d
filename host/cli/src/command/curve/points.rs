//! Points out of CSV or JSON, all of one dimension, all finite.

use std::fmt;

use rig::document::FileError;
use rig::document::source::Source;
use serde::de::{self, Deserialize, Deserializer, SeqAccess, Visitor};

/// More is not what a curve is laid through by hand; the solver itself has no bound.
const POINTS_MAX: usize = 1_000_000;

/// Points as a file gives them.
#[derive(Debug, PartialEq)]
pub(super) struct Points {
    /// Coordinates of each; at least one point, one to three coordinates, as many for each.
    pub(super) rows: Vec<Vec<f64>>,
    /// The order of the B-spline a JSON file asks for.
    pub(super) order: Option<u32>,
}

/// Reads either format, told apart by the first character.
pub(super) fn read(source: &Source) -> Result<Points, FileError> {
    let points = match source.text().trim_start().chars().next() {
        Some('{') => json::<CurveFile>(source).map(|file| Points {
            rows: file.points.0,
            order: file.order,
        }),
        Some('[') => json::<Rows>(source).map(|rows| Points {
            rows: rows.0,
            order: None,
        }),
        _ => csv(source).map(|rows| Points { rows, order: None }),
    }?;
    if points.rows.is_empty() {
        let error = source.error(source.text().len(), "there are no points here");
        return Err(error.with_hint("one point a line, coordinates separated by commas: 0,1.5,2"));
    }
    Ok(points)
}

/// What a point may not be; shared by both formats.
fn fault(row: &[f64], first: Option<&Vec<f64>>) -> Option<String> {
    if !(1..=3).contains(&row.len()) {
        return Some(format!("expected one to three coordinates, found {}", row.len()));
    }
    match first {
        Some(first) if first.len() != row.len() => Some(format!(
            "expected {} coordinates as before, found {}",
            first.len(),
            row.len()
        )),
        _ => None,
    }
}

fn csv(source: &Source) -> Result<Vec<Vec<f64>>, FileError> {
    let mut rows: Vec<Vec<f64>> = Vec::new();
    let mut headed = false;
    for (index, line) in source.text().lines().enumerate() {
        let number = index as u32 + 1;
        if line.trim().is_empty() || line.trim_start().starts_with('#') {
            continue;
        }
        let cells = cells(line);
        // The first line may name the columns.
        if !headed && rows.is_empty() && cells.iter().all(|(_, cell)| cell.parse::<f64>().is_err()) {
            headed = true;
            continue;
        }
        let mut row = Vec::with_capacity(cells.len());
        for (column, cell) in cells {
            match cell.parse::<f64>() {
                Ok(value) if value.is_finite() => row.push(value),
                Ok(_) => return Err(source.error_at((number, column), format!("`{cell}` is not finite"))),
                Err(_) => {
                    let message = format!("expected a number, found `{cell}`");
                    return Err(source.error_at((number, column), message));
                }
            }
        }
        if let Some(message) = fault(&row, rows.first()) {
            return Err(source.error_at((number, 1), message));
        }
        if rows.len() == POINTS_MAX {
            return Err(source.error_at((number, 1), format!("more than {POINTS_MAX} points")));
        }
        rows.push(row);
    }
    Ok(rows)
}

/// The cells of a line with their columns. Semicolons, else commas, else tabs and spaces separate them.
fn cells(line: &str) -> Vec<(u32, &str)> {
    let separator = [';', ','].into_iter().find(|&separator| line.contains(separator));
    let pieces: Vec<&str> = match separator {
        Some(separator) => line.split(separator).collect(),
        None => line.split(char::is_whitespace).collect(),
    };
    let mut cells = Vec::with_capacity(pieces.len());
    let mut column = 1;
    for piece in pieces {
        let indent = piece.chars().take_while(|letter| letter.is_whitespace()).count() as u32;
        // Without separators of its own, a line has empty pieces between two spaces.
        if separator.is_some() || !piece.is_empty() {
            cells.push((column + indent, piece.trim()));
        }
        column += piece.chars().count() as u32 + 1;
    }
    cells
}

/// A JSON text, errors with their places.
fn json<'s, T: Deserialize<'s>>(source: &'s Source) -> Result<T, FileError> {
    serde_json::from_str(source.text()).map_err(|error| {
        let place = format!(" at line {} column {}", error.line(), error.column());
        let text = error.to_string();
        let message = text.strip_suffix(&place).unwrap_or(&text);
        let at = (error.line().max(1) as u32, error.column().max(1) as u32);
        source.error_at(at, message)
    })
}

/// What `curve fit --json` writes, as far as it is read back: other members are derived from these.
#[derive(serde::Deserialize)]
struct CurveFile {
    points: Rows,
    #[serde(default)]
    order: Option<u32>,
}

/// An array of points; a point is an array of coordinates or, on a line, one number.
#[derive(Debug)]
struct Rows(Vec<Vec<f64>>);

struct Row(Vec<f64>);

impl<'de> Deserialize<'de> for Rows {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader;
        impl<'de> Visitor<'de> for Reader {
            type Value = Rows;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("an array of points")
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut array: A) -> Result<Rows, A::Error> {
                let mut rows: Vec<Vec<f64>> = Vec::new();
                while let Some(Row(row)) = array.next_element()? {
                    if let Some(message) = fault(&row, rows.first()) {
                        return Err(de::Error::custom(message));
                    }
                    if rows.len() == POINTS_MAX {
                        return Err(de::Error::custom(format_args!("more than {POINTS_MAX} points")));
                    }
                    rows.push(row);
                }
                Ok(Rows(rows))
            }
        }
        deserializer.deserialize_seq(Reader)
    }
}

impl<'de> Deserialize<'de> for Row {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader;
        impl<'de> Visitor<'de> for Reader {
            type Value = Row;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a number or an array of one to three numbers")
            }
            fn visit_f64<E: de::Error>(self, x: f64) -> Result<Row, E> {
                Ok(Row(vec![x]))
            }
            fn visit_i64<E: de::Error>(self, x: i64) -> Result<Row, E> {
                Ok(Row(vec![x as f64]))
            }
            fn visit_u64<E: de::Error>(self, x: u64) -> Result<Row, E> {
                Ok(Row(vec![x as f64]))
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut array: A) -> Result<Row, A::Error> {
                let mut row = Vec::new();
                while let Some(x) = array.next_element::<f64>()? {
                    row.push(x);
                }
                Ok(Row(row))
            }
        }
        deserializer.deserialize_any(Reader)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    fn points(text: &str) -> Result<Vec<Vec<f64>>, (u32, u32)> {
        match read(&Source::from_text(Path::new("p"), text)) {
            Ok(points) => Ok(points.rows),
            Err(error) => Err((error.line, error.column)),
        }
    }

    #[test]
    fn points_are_read_from_either_format() {
        let expected = Ok(vec![vec![0.0, 1.0], vec![2.5, -3.0]]);
        for text in [
            "0,1\n2.5,-3\n",
            "x,y\n0, 1\n\n2.5 ,-3",
            "# from a tablet\n0;1\r\n2.5;-3\r\n",
            "0 1\n2.5\t-3",
            "[[0,1],[2.5,-3]]",
            " {\"kind\":\"natural\",\"points\":[[0,1],[2.5,-3e0]]}",
        ] {
            assert_eq!(points(text), expected, "{text}");
        }
        assert_eq!(points("1\n2"), Ok(vec![vec![1.0], vec![2.0]]));
        assert_eq!(points("[1,2.5]"), Ok(vec![vec![1.0], vec![2.5]]));
    }

    #[test]
    fn faults_have_places() {
        for (text, place) in [
            ("", (1, 1)),
            ("x,y\n", (2, 1)),
            ("0,1\n2, nan\n", (2, 4)),
            ("0,1\n2,b\n", (2, 3)),
            ("0,1\n2\n", (2, 1)),
            ("0,1,2,3\n", (1, 1)),
            ("0 1\n2   inf", (2, 5)),
            ("[[0,1],\n [2]]", (2, 5)),
            ("[[0,1],[2,\"b\"]]", (1, 13)),
            ("[[0,1],[2,", (1, 10)),
            ("[]", (1, 3)),
        ] {
            assert_eq!(points(text), Err(place), "{text}");
        }
    }
}
