//! What stands after `:=`, and structures.
//! Source: `docs/protocols/ps300.md`, sections "Structure and display" and "Network commands". That a
//! structure may stand inside another is this project's reading, and functions inside structures are its own.

use super::{Parsed, Parser};
use crate::language::token::{Mark, TokenKind};
use crate::language::words::{self, Word};
use crate::language::{Definition, Diagnostic, Member, Name, Node};

/// Structures inside one another. Keeps the recursion of everything that walks a command far from the end
/// of any stack; nothing drawn by hand comes near it. Our choice.
const STRUCTURE_DEPTH_MAX: usize = 32;

type Form<'s> = fn(&mut Parser<'s>) -> Parsed<Node>;

impl<'s> Parser<'s> {
    /// Everything after `:=`.
    pub(super) fn definition(&mut self) -> Parsed<Definition> {
        if self.is_word_before(words::FUNCTION, Mark::Colon) {
            let (function, size) = self.function()?;
            return Ok(Definition::Function { function, size });
        }
        let node = self.node("what the name denotes: F:TYPE, or a node such as ROTATE")?;
        Ok(Definition::Node(node))
    }

    /// `F:TYPE` or `F:TYPE(k)`.
    fn function(&mut self) -> Parsed<(Name, Option<u16>)> {
        self.advance();
        self.advance();
        let function = self.name("the type of a function, as in F:ADD")?;
        let mut size = None;
        if self.accept(Mark::Open) {
            size = Some(self.integer(1..=i64::from(u16::MAX), "the number of inputs or outputs")? as u16);
            self.expect(Mark::Close)?;
        }
        Ok((function, size))
    }

    fn node(&mut self, expected: &str) -> Parsed<Node> {
        if let Some(operation) = self.operation()? {
            return Ok(Node::Operation {
                operation,
                applied_to: self.applied_to()?,
            });
        }
        if self.accept_word(words::NIL) {
            return Ok(Node::Nil);
        }
        if self.accept_word(words::INSTANCE) {
            if self.is(Mark::Semicolon) {
                return Ok(Node::Instance(Vec::new()));
            }
            self.skip_word_before_name(words::OF);
            return Ok(Node::Instance(self.names("the name of what is shown")?));
        }
        if self.is_word(words::BEGIN_STRUCTURE) {
            return self.structure();
        }
        if self.accept_word(words::COPY) {
            return self.copy();
        }
        if let Some(node) = self.data()? {
            return Ok(node);
        }
        Err(self.unknown_word(expected, &words::NODES))
    }

    /// A data node, if the word here begins one.
    fn data(&mut self) -> Parsed<Option<Node>> {
        let forms: [(Word, Form<'s>); 10] = [
            (words::VECTOR_LIST, |parser| {
                parser.vector_list(Mark::Semicolon).map(Node::VectorList)
            }),
            (words::CHARACTERS, |parser| {
                parser.characters().map(Node::Characters)
            }),
            (words::LABELS, |parser| parser.labels().map(Node::Labels)),
            (words::RATIONAL, Self::rational_curve),
            (words::BSPLINE, |parser| parser.bspline(false).map(Node::BSpline)),
            (words::ATTRIBUTES, |parser| {
                parser.attributes().map(Node::Attributes)
            }),
            (words::ILLUMINATION, |parser| {
                parser.illumination().map(Node::Illumination)
            }),
            (words::PATTERN, |parser| parser.pattern().map(Node::Pattern)),
            (words::POLYGON, |parser| parser.polygons().map(Node::Polygons)),
            (words::POLYNOMIAL, |parser| {
                parser.polynomial(false).map(Node::Polynomial)
            }),
        ];
        if self.is_word_before_one_of(words::POLYNOMIAL, &[words::ORDER]) {
            self.advance(); // `POLY` is enough of either word; ORDER after it tells them apart.
            return self.polynomial(false).map(|curve| Some(Node::Polynomial(curve)));
        }
        if self.is_word(words::BEGIN_FONT) {
            return self.font().map(|font| Some(Node::Font(font)));
        }
        let Some(&(_, form)) = forms.iter().find(|(word, _)| self.is_word(*word)) else {
            return Ok(None);
        };
        self.advance();
        form(self).map(Some)
    }

    /// Everything after COPY.
    fn copy(&mut self) -> Parsed<Node> {
        let of = self.name("the name of what is copied")?;
        let (mut start, mut count) = (None, None);
        loop {
            let positive = 1..=i64::from(u32::MAX);
            if self.accept_word_equals(words::START) {
                start = Some(self.integer(positive, "the first element")? as u32);
            } else if self.accept_word_equals(words::COUNT) {
                count = Some(self.integer(positive, "how many elements")? as u32);
            } else if start.is_none() || !self.accept(Mark::Comma) {
                return Ok(Node::Copy { of, start, count });
            }
        }
    }

    /// `APPLIED TO name`, `THEN name` or nothing.
    fn applied_to(&mut self) -> Parsed<Option<Name>> {
        if self.accept_word(words::APPLIED) {
            self.skip_word_before_name(words::TO);
        } else if !self.accept_word(words::THEN) {
            return Ok(None);
        }
        self.name("the name of what it is applied to").map(Some)
    }

    fn structure(&mut self) -> Parsed<Node> {
        let begin = self.current.at;
        if self.depth == STRUCTURE_DEPTH_MAX {
            self.skip_structure();
            let message = format!("structures inside one another more than {STRUCTURE_DEPTH_MAX} deep");
            return Err(Diagnostic::error(begin, message)
                .hinting("name the inner ones and instance them")
                .into());
        }
        self.advance();
        self.depth += 1;
        let mut members = Vec::new();
        while !self.stands_as_word(words::END_STRUCTURE) {
            if self.current.kind == TokenKind::End {
                self.depth -= 1;
                return Err(Diagnostic::error(begin, "this structure is never ended")
                    .expecting("END_STRUCTURE;")
                    .into());
            }
            if self.accept(Mark::Semicolon) {
                continue;
            }
            let taken = self.taken;
            match self.member().and_then(|member| self.finish().map(|()| member)) {
                Ok(member) => members.push(member),
                Err(fault) => self.recover(fault, taken),
            }
        }
        self.advance();
        self.depth -= 1;
        Ok(Node::Structure(members))
    }

    /// Whether `word` stands here as itself and not as a label.
    fn stands_as_word(&self, word: Word) -> bool {
        self.is_word(word) && self.following.kind != TokenKind::Mark(Mark::Assign)
    }

    fn member(&mut self) -> Parsed<Member> {
        let mut label = None;
        if self.following.kind == TokenKind::Mark(Mark::Assign) {
            let at = self.current.at;
            let name = self.name("a label")?;
            if name.as_str().contains('.') {
                let message = format!(
                    "the label `{}` has a dot in it",
                    crate::language::token::cut(name.as_str())
                );
                return Err(Diagnostic::error(at, message)
                    .hinting("the dot is added outside the structure")
                    .into());
            }
            self.advance();
            label = Some(name);
        }
        if self.is_word_before(words::FUNCTION, Mark::Colon) {
            if label.is_none() {
                let diagnostic = Diagnostic::error(self.current.at, "this function has no label");
                return Err(diagnostic
                    .expecting("`label := F:TYPE;`")
                    .hinting("without one nothing could be connected to it")
                    .into());
            }
            let (function, size) = self.function()?;
            let node = Node::Function { function, size };
            return Ok(Member { label, node });
        }
        let node = self.node("an element of the structure, or END_STRUCTURE")?;
        Ok(Member { label, node })
    }

    /// Passes a structure with all that is inside it, without recursion.
    fn skip_structure(&mut self) {
        let mut open = 0_usize;
        while self.current.kind != TokenKind::End {
            if self.stands_as_word(words::BEGIN_STRUCTURE) {
                open += 1;
            } else if self.stands_as_word(words::END_STRUCTURE) {
                open -= 1;
            }
            self.advance();
            if open == 0 {
                return;
            }
        }
    }
}
