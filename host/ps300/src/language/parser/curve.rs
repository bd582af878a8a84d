//! Curves.
//! Source: `docs/protocols/ps300.md`, section "Data nodes". Ours, where the record is silent: the parts may stand
//! in any order; the knots may follow the vertices without `KNOTS=`, told apart by having no commas; a weight is
//! the last number of a rational vertex or coefficient; closed curves are periodic and open ones not, unless
//! written; ORDER of a polynomial is its degree.

use glam::DVec3;

use super::{Parsed, Parser};
use crate::language::token::{Mark, TokenKind};
use crate::language::words;
use crate::language::{BSpline, Diagnostic, Dimension, Node, Polynomial, Position};

/// Vertices or coefficients.
struct ControlPoints {
    rational: bool,
    points: Vec<DVec3>,
    weights: Vec<f64>,
    in_space: bool,
}

impl ControlPoints {
    fn new(rational: bool) -> Self {
        Self {
            rational,
            points: Vec::new(),
            weights: Vec::new(),
            in_space: false,
        }
    }

    fn dimension(&self) -> Dimension {
        if self.in_space || self.points.is_empty() {
            Dimension::Three
        } else {
            Dimension::Two
        }
    }

    fn split(self) -> (Vec<DVec3>, Option<Vec<f64>>) {
        (self.points, self.rational.then_some(self.weights))
    }
}

impl Parser<'_> {
    /// Everything after RATIONAL.
    pub(super) fn rational_curve(&mut self) -> Parsed<Node> {
        if self.accept_word(words::BSPLINE) {
            return self.bspline(true).map(Node::BSpline);
        }
        if self.accept_word(words::POLYNOMIAL) {
            return self.polynomial(true).map(Node::Polynomial);
        }
        let known = [words::BSPLINE, words::POLYNOMIAL];
        Err(self.unknown_word(words::listed(&known), &known))
    }

    /// Everything after BSPLINE.
    pub(super) fn bspline(&mut self, rational: bool) -> Parsed<BSpline> {
        let at = self.end;
        let mut controls = ControlPoints::new(rational);
        let (mut order, mut chords, mut count, mut periodic) = (None, None, None, None);
        let mut closed = false;
        let mut knots = Vec::new();
        loop {
            if self.accept_word_equals(words::ORDER) {
                order =
                    Some(self.integer(1..=i64::from(BSpline::ORDER_MAX), "the order of the curve")? as u8);
            } else if self.accept_word_equals(words::CHORDS) {
                chords = Some(self.chords()?);
            } else if let Some(written) = self.count()? {
                count = Some(written);
            } else if self.accept_word(words::OPEN) {
                closed = false;
            } else if self.accept_word(words::CLOSED) {
                closed = true;
            } else if self.accept_word(words::NONPERIODIC) {
                periodic = Some(false);
            } else if self.accept_word(words::PERIODIC) {
                periodic = Some(true);
            } else if self.accept_word_equals(words::KNOTS) {
                self.knots(&mut knots)?;
            } else if matches!(self.current.kind, TokenKind::Number(_)) {
                if self.following.kind == TokenKind::Mark(Mark::Comma) {
                    self.control_point(&mut controls)?;
                } else {
                    knots.push(self.number("a knot")?);
                }
            } else if !self.accept_word_equals(words::VERTICES) {
                break;
            }
        }
        self.check_count(count, controls.points.len(), "vertices");
        let dimension = controls.dimension();
        let (vertices, weights) = controls.split();
        Ok(BSpline {
            order: self.needed(order, at, "ORDER=4, the degree plus one")?,
            closed,
            periodic: periodic.unwrap_or(closed),
            dimension,
            vertices,
            weights,
            knots,
            chords: self.needed(chords, at, "CHORDS=20, how many lines to draw")?,
        })
    }

    /// Everything after POLYNOMIAL.
    pub(super) fn polynomial(&mut self, rational: bool) -> Parsed<Polynomial> {
        let at = self.end;
        let mut controls = ControlPoints::new(rational);
        let (mut order, mut chords) = (None, None);
        loop {
            if self.accept_word_equals(words::ORDER) {
                let range = 0..=i64::from(Polynomial::ORDER_MAX);
                order = Some(self.integer(range, "the degree of the curve")? as u8);
            } else if self.accept_word_equals(words::CHORDS) {
                chords = Some(self.chords()?);
            } else if matches!(self.current.kind, TokenKind::Number(_)) {
                self.control_point(&mut controls)?;
            } else if !self.accept_word_equals(words::COEFFICIENTS) {
                break;
            }
        }
        let order: u8 = self.needed(order, at, "ORDER=3, the degree")?;
        if controls.points.len() != usize::from(order) + 1 {
            let message = format!("ORDER={order}, but {} coefficients", controls.points.len());
            return Err(Diagnostic::error(at, message)
                .expecting(format!("{} coefficients", order + 1))
                .hinting("that of the highest power first, the constant last")
                .into());
        }
        let dimension = controls.dimension();
        let (coefficients, weights) = controls.split();
        Ok(Polynomial {
            order,
            dimension,
            coefficients,
            weights,
            chords: self.needed(chords, at, "CHORDS=20, how many lines to draw")?,
        })
    }

    fn chords(&mut self) -> Parsed<u32> {
        Ok(self.integer(1..=i64::from(u32::MAX), "how many lines to draw")? as u32)
    }

    /// A part that may not be left out.
    fn needed<T>(&self, part: Option<T>, at: Position, expected: &str) -> Parsed<T> {
        match (part, self.current.kind) {
            (Some(part), _) => Ok(part),
            (None, TokenKind::Mark(Mark::Semicolon)) => {
                let word = expected.split('=').next().unwrap_or(expected);
                Err(Diagnostic::error(at, format!("this curve has no {word}"))
                    .expecting(expected)
                    .into())
            }
            (None, _) => Err(self.unexpected(expected)),
        }
    }

    /// Numbers, commas between them allowed.
    fn knots(&mut self, into: &mut Vec<f64>) -> Parsed<()> {
        loop {
            into.push(self.number("a knot")?);
            if !self.accept(Mark::Comma) && !matches!(self.current.kind, TokenKind::Number(_)) {
                return Ok(());
            }
        }
    }

    /// `x,y[,z]`, and a weight after that in rational curves.
    fn control_point(&mut self, into: &mut ControlPoints) -> Parsed<()> {
        let weights = usize::from(into.rational);
        let mut numbers = [0.0; 4];
        let mut count = 0;
        loop {
            numbers[count] = self.number("the next coordinate")?;
            count += 1;
            if count == 3 + weights || !self.accept(Mark::Comma) {
                break;
            }
        }
        if count < 2 + weights {
            let expected = if into.rational {
                "x,y,w or x,y,z,w"
            } else {
                "x,y or x,y,z"
            };
            return Err(self.unexpected(format!("`,` and the rest of {expected}")));
        }
        let coordinates = count - weights;
        into.in_space |= coordinates == 3;
        let z = if coordinates == 3 { numbers[2] } else { 0.0 };
        into.points.push(DVec3::new(numbers[0], numbers[1], z));
        if into.rational {
            into.weights.push(numbers[count - 1]);
        }
        Ok(())
    }
}
