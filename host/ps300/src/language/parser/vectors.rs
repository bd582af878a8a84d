//! Vector lists and patterns.
//! Source: `docs/protocols/ps300.md`, section "Data nodes". Ours, where the record is silent: a list that
//! names no class is itemized if it has P or L marks and connected otherwise; in an itemized or tabulated list
//! a vector without a mark is drawn to, except the first; a list is two-dimensional if all its vectors are;
//! `N=` is checked against what follows and not kept.

use glam::DVec3;

use super::{Parsed, Parser};
use crate::language::token::{Mark, TokenKind};
use crate::language::words::{self, Word};
use crate::language::{Diagnostic, Dimension, Pattern, Position, Vector, VectorClass, VectorList};

const CLASSES: [(Word, VectorClass); 5] = [
    (words::CONNECTED, VectorClass::Connected),
    (words::DOTS, VectorClass::Dots),
    (words::ITEMIZED, VectorClass::Itemized),
    (words::SEPARATE, VectorClass::Separate),
    (words::TABULATED, VectorClass::Tabulated),
];

/// A table of patterns has no more entries than this; longer dashes would not be told apart. Our choice.
const SEGMENTS_MAX: usize = 256;

/// What `N=` said, and where.
pub(super) type Count = Option<(Position, i64)>;

/// The vectors of a list before its class is known.
#[derive(Default)]
struct Found {
    vectors: Vec<Vector>,
    first_mark: Option<Position>,
    in_space: bool,
}

impl Parser<'_> {
    /// Everything after VECTOR_LIST or `VL(`, up to the mark that ends it.
    pub(super) fn vector_list(&mut self, closing: Mark) -> Parsed<VectorList> {
        let mut list = VectorList::new(VectorClass::Connected, Vec::new());
        let mut written_class = None;
        let mut count = None;
        loop {
            if let Some(written) = self.count()? {
                count = Some(written);
            } else if let Some(&(_, class)) = CLASSES.iter().find(|(word, _)| self.is_word(*word)) {
                self.advance();
                written_class = Some(class);
            } else if self.accept_word(words::BLOCK_NORMALIZED) {
                list.block_normalized = true;
            } else if self.accept_word(words::COLOR) {
                list.colored = true;
            } else {
                break;
            }
        }
        let found = self.vectors(written_class, closing)?;
        list.class = written_class.unwrap_or(match found.first_mark {
            Some(_) => VectorClass::Itemized,
            None => VectorClass::Connected,
        });
        list.vectors = found.vectors;
        if !found.in_space && !list.vectors.is_empty() {
            list.dimension = Dimension::Two;
        }
        if let (Some(at), Some(_)) = (found.first_mark, list.class.draws(0)) {
            self.reports.push(
                Diagnostic::warning(at, "P and L do nothing in this class of vector list")
                    .hinting("write ITEMIZED to have them obeyed"),
            );
        }
        for (index, vector) in list.vectors.iter_mut().enumerate() {
            vector.draw = list.class.draws(index).unwrap_or(vector.draw);
        }
        self.check_count(count, list.vectors.len(), "vectors");
        Ok(list)
    }

    /// `N=k`, or nothing.
    pub(super) fn count(&mut self) -> Parsed<Count> {
        let at = self.current.at;
        if !self.accept_word_equals(words::N) {
            return Ok(None);
        }
        let count = self.integer(0..=i64::from(u32::MAX), "how many follow")?;
        Ok(Some((at, count)))
    }

    /// Warns where as many were not there as `N=` said.
    pub(super) fn check_count(&mut self, count: Count, found: usize, what: &str) {
        if let Some((at, count)) = count.filter(|&(_, count)| count != found as i64) {
            let message = format!("N={count}, but {found} {what} follow");
            self.reports
                .push(Diagnostic::warning(at, message).expecting(format!("N={found}")));
        }
    }

    /// The vectors as an itemized list has them.
    fn vectors(&mut self, class: Option<VectorClass>, closing: Mark) -> Parsed<Found> {
        let tabulated = class == Some(VectorClass::Tabulated);
        let mut found = Found::default();
        while let Some(mark) = self.vector_mark(closing, found.vectors.is_empty())? {
            if let Some((at, _)) = mark {
                found.first_mark.get_or_insert(at);
            }
            let draw = mark.map_or(!found.vectors.is_empty(), |(_, draw)| draw);
            let (at, coordinates) = self.components(2, DVec3::ZERO, "a vector")?;
            found.in_space |= coordinates > 2;
            let intensity = if tabulated && self.accept_word_equals(words::T) {
                let last = i64::from(VectorClass::TABLE_LAST);
                Some(self.integer(0..=last, "an entry of the table of colours")? as f64)
            } else if !tabulated && self.accept_word_equals(words::I) {
                Some(self.number("an intensity from 0 to 1")?)
            } else {
                None
            };
            found.vectors.push(Vector { at, draw, intensity });
        }
        Ok(found)
    }

    /// Where a vector begins: its P or L, with its place, if it has one; nothing where the list ends.
    #[allow(clippy::option_option, reason = "a vector without a mark is still a vector")]
    fn vector_mark(&mut self, closing: Mark, is_first: bool) -> Parsed<Option<Option<(Position, bool)>>> {
        let at = self.current.at;
        if self.accept_word_before_number(words::P) {
            return Ok(Some(Some((at, false))));
        }
        if self.accept_word_before_number(words::L) {
            return Ok(Some(Some((at, true))));
        }
        match self.current.kind {
            TokenKind::Number(_) => Ok(Some(None)),
            TokenKind::End => Ok(None),
            TokenKind::Mark(mark) if mark == closing => Ok(None),
            // A semicolon that is missing at the line's end is `finish`'s to report.
            _ if self.current.first_on_line && !is_first => Ok(None),
            _ => Err(self.unknown_word("a vector x,y,z, or a class", &CLASSES.map(|(word, _)| word))),
        }
    }

    /// Everything after PATTERN, where it is defined.
    pub(super) fn pattern(&mut self) -> Parsed<Pattern> {
        let length_range = 0..=i64::from(u16::MAX);
        let mut segments = Vec::new();
        while segments.is_empty() || matches!(self.current.kind, TokenKind::Number(_)) {
            if segments.len() == SEGMENTS_MAX {
                let message = format!("a pattern of more than {SEGMENTS_MAX} segments");
                return Err(Diagnostic::error(self.current.at, message).into());
            }
            segments.push(self.integer(length_range.clone(), "the length of a dash or gap")? as u16);
            self.accept(Mark::Comma);
        }
        let (mut around_corners, mut matched) = (false, true);
        loop {
            if self.accept_word(words::AROUND_CORNERS) {
                around_corners = true;
            } else if self.accept_word(words::MATCH) {
                matched = true;
            } else if self.accept_word(words::NOMATCH) {
                matched = false;
            } else {
                break;
            }
        }
        self.expect_word(words::LENGTH)?;
        self.accept(Mark::Equals);
        Ok(Pattern {
            segments,
            around_corners,
            matched,
            length: self.number("the length of the whole pattern")?,
        })
    }
}
