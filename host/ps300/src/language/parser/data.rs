//! Data nodes: vector lists and characters.
//! Source: `docs/protocols/ps300.md`, section "Data nodes". Ours, where the record is silent: a list that
//! names no class is itemized if it has P or L marks and connected otherwise; in an itemized list a vector
//! without a mark is drawn to, except the first; `N=` is checked against what follows and not kept.

use glam::{DVec2, DVec3};

use super::{Parsed, Parser};
use crate::language::token::{Mark, TokenKind};
use crate::language::words::{self, Word};
use crate::language::{Characters, Diagnostic, Position, Vector, VectorClass, VectorList};

const CLASSES: [(Word, VectorClass); 4] = [
    (words::CONNECTED, VectorClass::Connected),
    (words::DOTS, VectorClass::Dots),
    (words::ITEMIZED, VectorClass::Itemized),
    (words::SEPARATE, VectorClass::Separate),
];

impl Parser<'_> {
    /// Everything after VECTOR_LIST.
    pub(super) fn vector_list(&mut self) -> Parsed<VectorList> {
        let mut written_class = None;
        let mut count = None;
        loop {
            if self.is_word_before(words::N, Mark::Equals) {
                let at = self.current.at;
                self.advance();
                self.advance();
                count = Some((
                    at,
                    self.integer(0..=i64::from(u32::MAX), "the number of vectors")?,
                ));
            } else if let Some(&(_, class)) = CLASSES.iter().find(|(word, _)| self.is_word(*word)) {
                self.advance();
                written_class = Some(class);
            } else if !self.accept_word(words::BLOCK_NORMALIZED) && !self.accept_word(words::COLOR) {
                break;
            }
        }

        let (mut vectors, first_mark) = self.vectors()?;
        let class = written_class.unwrap_or(match first_mark {
            Some(_) => VectorClass::Itemized,
            None => VectorClass::Connected,
        });
        if let (Some(at), false) = (first_mark, class == VectorClass::Itemized) {
            self.reports.push(
                Diagnostic::warning(at, "P and L do nothing in this class of vector list")
                    .hinting("write ITEMIZED to have them obeyed"),
            );
        }
        for (index, vector) in vectors.iter_mut().enumerate() {
            vector.draw = class.draws(index).unwrap_or(vector.draw);
        }
        if let Some((at, count)) = count.filter(|&(_, count)| count != vectors.len() as i64) {
            let message = format!("N={count}, but {} vectors follow", vectors.len());
            self.reports
                .push(Diagnostic::warning(at, message).expecting(format!("N={}", vectors.len())));
        }
        Ok(VectorList::new(class, vectors))
    }

    /// The vectors as an itemized list has them, and where the first mark is.
    fn vectors(&mut self) -> Parsed<(Vec<Vector>, Option<Position>)> {
        let mut vectors = Vec::new();
        let mut first_mark = None;
        loop {
            let at = self.current.at;
            let mark = [(words::P, false), (words::L, true)]
                .into_iter()
                .find(|(word, _)| self.is_word(*word));
            if mark.is_some() {
                first_mark.get_or_insert(at);
                self.advance();
            } else if !matches!(self.current.kind, TokenKind::Number(_)) {
                return match self.current.kind {
                    TokenKind::Mark(Mark::Semicolon) | TokenKind::End => Ok((vectors, first_mark)),
                    // A semicolon that is missing at the line's end is `finish`'s to report.
                    _ if self.current.first_on_line && !vectors.is_empty() => Ok((vectors, first_mark)),
                    _ => Err(self.unknown_word("a vector x,y,z, or a class", &CLASSES.map(|(word, _)| word))),
                };
            }
            let draw = mark.map_or(!vectors.is_empty(), |(_, draw)| draw);
            let position = self.point("a vector")?;
            let intensity = if self.is_word_before(words::I, Mark::Equals) {
                self.advance();
                self.advance();
                Some(self.number("an intensity from 0 to 1")?)
            } else {
                None
            };
            vectors.push(Vector {
                at: position,
                draw,
                intensity,
            });
        }
    }

    /// Everything after CHARACTERS.
    pub(super) fn characters(&mut self) -> Parsed<Characters> {
        let mut at = DVec3::ZERO;
        let mut step = DVec2::X;
        if matches!(self.current.kind, TokenKind::Number(_)) {
            at = self.point("where the text stands")?;
        }
        if self.accept_word(words::STEP) {
            step = self.pair("the step from character to character, as 1,0")?;
        }
        Ok(Characters {
            at,
            step,
            text: self.text()?,
        })
    }
}
