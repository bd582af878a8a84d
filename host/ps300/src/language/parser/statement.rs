//! Commands by their first word.
//! Source: `docs/protocols/ps300.md`, sections "Structure and display" and "Network commands". Ours, where the
//! record is silent: BEGIN may be followed by a semicolon and need not be.

use super::{Parsed, Parser};
use crate::language::token::{Mark, TokenKind};
use crate::language::words::{self, Word};
use crate::language::{Command, Diagnostic, Disconnection, Initialization, Input, InputOf, Name, OutputOf};

type Form<'s> = fn(&mut Parser<'s>) -> Parsed<Command>;

impl<'s> Parser<'s> {
    /// Everything up to the semicolon.
    pub(super) fn command(&mut self) -> Parsed<Command> {
        if matches!(self.current.kind, TokenKind::Word(_))
            && self.following.kind == TokenKind::Mark(Mark::Assign)
        {
            return self.define();
        }
        let forms: [(Word, Form<'s>); 20] = [
            (words::CONNECT, Self::connect),
            (words::DISCONNECT, Self::disconnect),
            (words::SEND, Self::send),
            (words::STORE, Self::store),
            (words::VARIABLE, |parser| {
                Ok(Command::Variable(parser.names("the name of a variable")?))
            }),
            (words::SETUP, Self::setup),
            (words::INCLUDE, Self::include),
            (words::REMOVE, Self::remove),
            (words::DISPLAY, |parser| {
                Ok(Command::Display(parser.name("what to display")?))
            }),
            (words::DELETE, Self::delete),
            (words::FORGET, |parser| {
                Ok(Command::Forget(parser.name("the name to forget")?))
            }),
            (words::FOLLOW, Self::follow),
            (words::PREFIX, Self::prefix),
            (words::INITIALIZE, Self::initialize),
            (words::PATTERN, Self::pattern_with),
            (words::BEGIN, |_| Ok(Command::BeginGroup)),
            (words::END, |parser| Ok(parser.end())),
            (words::OPTIMIZE, |parser| {
                parser.expect_word(words::STRUCTURE)?;
                Ok(Command::Optimize)
            }),
            (words::RESERVE_WORKING_STORAGE, |parser| {
                let bytes = parser.integer(0..=i64::from(u32::MAX), "a number of bytes")? as u32;
                Ok(Command::ReserveWorkingStorage { bytes })
            }),
            (words::COMMAND, |parser| {
                parser.expect_word(words::STATUS)?;
                Ok(Command::CommandStatus)
            }),
        ];
        if let Some(&(_, form)) = forms.iter().find(|(word, _)| self.is_word(*word)) {
            self.advance();
            return form(self);
        }
        if self.accept(Mark::Bang) {
            self.expect_word(words::RESET)?;
            return Ok(Command::Reset);
        }
        if self.is_word(words::BEGIN_STRUCTURE) || self.is_word(words::END_STRUCTURE) {
            return Err(self.loose_structure());
        }
        Err(self.unknown_word("a command, or a name and `:=`", &words::COMMANDS))
    }

    fn loose_structure(&self) -> super::Fault {
        let (message, hint) = if self.is_word(words::BEGIN_STRUCTURE) {
            ("this structure has no name", "write `name := BEGIN_STRUCTURE`")
        } else {
            (
                "END_STRUCTURE without BEGIN_STRUCTURE",
                "was the structure given up above?",
            )
        };
        Diagnostic::error(self.current.at, message).hinting(hint).into()
    }

    fn define(&mut self) -> Parsed<Command> {
        let name = self.name("a name")?;
        self.expect(Mark::Assign)?;
        Ok(Command::Define {
            name,
            definition: self.definition()?,
        })
    }

    fn connect(&mut self) -> Parsed<Command> {
        let from = self.output_of()?;
        self.expect(Mark::Colon)?;
        Ok(Command::Connect {
            from,
            to: self.input_of()?,
        })
    }

    fn disconnect(&mut self) -> Parsed<Command> {
        let name = self.name("the name of a function or device")?;
        if self.accept(Mark::Colon) {
            self.expect_word(words::ALL)?;
            return Ok(Command::Disconnect(Disconnection::All(name)));
        }
        let from = OutputOf {
            name,
            output: self.output_number()?,
        };
        self.expect(Mark::Colon)?;
        Ok(Command::Disconnect(if self.accept_word(words::ALL) {
            Disconnection::Output(from)
        } else {
            Disconnection::Pair {
                from,
                to: self.input_of()?,
            }
        }))
    }

    fn send(&mut self) -> Parsed<Command> {
        let payload = self.payload()?;
        self.expect_word(words::TO)?;
        Ok(Command::Send {
            payload,
            to: self.input_of()?,
        })
    }

    fn store(&mut self) -> Parsed<Command> {
        let payload = self.payload()?;
        self.expect_word(words::IN)?;
        Ok(Command::Store {
            payload,
            to: self.input_of()?,
        })
    }

    fn setup(&mut self) -> Parsed<Command> {
        if self.accept_word(words::STATE) {
            return self.setup_state();
        }
        if !self.accept_word(words::CNESS) {
            let known = [words::CNESS, words::STATE];
            return Err(self.unknown_word(words::listed(&known), &known));
        }
        let constant = self.one_of(&[(words::TRUE, true), (words::FALSE, false)])?;
        Ok(Command::SetupCness {
            constant,
            input: self.input_of()?,
        })
    }

    fn setup_state(&mut self) -> Parsed<Command> {
        let mut values = Vec::new();
        while !self.is_word(words::IN) {
            values.push(self.value()?);
            if !self.accept(Mark::Comma) {
                break;
            }
        }
        self.expect_word(words::IN)?;
        Ok(Command::SetupState {
            name: self.name("the name of a function")?,
            values,
        })
    }

    fn pattern_with(&mut self) -> Parsed<Command> {
        let list = self.name("the name of a vector list or curve")?;
        self.expect_word(words::WITH)?;
        Ok(Command::PatternWith {
            list,
            pattern: self.name("the name of a pattern")?,
        })
    }

    fn end(&mut self) -> Command {
        if self.accept_word(words::OPTIMIZE) {
            Command::EndOptimize
        } else {
            Command::EndGroup
        }
    }

    fn include(&mut self) -> Parsed<Command> {
        let member = self.name("what to include")?;
        self.expect_word(words::IN)?;
        Ok(Command::Include {
            member,
            instance: self.name("the name of an instance node")?,
        })
    }

    fn remove(&mut self) -> Parsed<Command> {
        let name = self.name("what to remove")?;
        if self.accept_word(words::FROM) {
            let instance = self.name("the name of an instance node")?;
            return Ok(Command::RemoveFrom {
                member: name,
                instance,
            });
        }
        Ok(Command::Remove(name))
    }

    fn delete(&mut self) -> Parsed<Command> {
        if self.is(Mark::Star) {
            let diagnostic = Diagnostic::error(self.current.at, "found `*` without the beginning of a name");
            return Err(diagnostic.hinting("INITIALIZE NAMES; deletes everything").into());
        }
        let name = self.name("what to delete")?;
        Ok(if self.accept(Mark::Star) {
            Command::DeleteAll { prefix: name }
        } else {
            Command::Delete(name)
        })
    }

    fn follow(&mut self) -> Parsed<Command> {
        let name = self.name("the name of an operation")?;
        self.expect_word(words::WITH)?;
        Ok(Command::Follow {
            name,
            with: self.lone_operation()?,
        })
    }

    fn prefix(&mut self) -> Parsed<Command> {
        let name = self.name("the name to put an operation above")?;
        self.expect_word(words::WITH)?;
        Ok(Command::Prefix {
            name,
            with: self.lone_operation()?,
        })
    }

    fn initialize(&mut self) -> Parsed<Command> {
        if !matches!(self.current.kind, TokenKind::Word(_)) || self.current.first_on_line {
            return Ok(Command::Initialize(Initialization::Everything));
        }
        let scope = self.one_of(&[
            (words::CONNECTIONS, Initialization::Connections),
            (words::DISPLAY, Initialization::Display),
            (words::NAMES, Initialization::Names),
        ])?;
        Ok(Command::Initialize(scope))
    }

    /// `name<output>`.
    fn output_of(&mut self) -> Parsed<OutputOf> {
        let name = self.name("the name of a function or device")?;
        Ok(OutputOf {
            name,
            output: self.output_number()?,
        })
    }

    fn output_number(&mut self) -> Parsed<u8> {
        self.expect(Mark::Less)?;
        let output = self.integer(1..=i64::from(u8::MAX), "an output number")?;
        self.expect(Mark::Greater)?;
        Ok(output as u8)
    }

    /// `<input>name`.
    fn input_of(&mut self) -> Parsed<InputOf> {
        self.expect(Mark::Less)?;
        let input = if let TokenKind::Word(word) = self.current.kind {
            self.named_input(word)?
        } else {
            Input::Number(self.integer(1..=i64::from(u16::MAX), "an input number")? as u16)
        };
        self.expect(Mark::Greater)?;
        let name: Name = self.name("the name of what receives")?;
        Ok(InputOf { name, input })
    }

    fn named_input(&mut self, word: &str) -> Parsed<Input> {
        let found = Input::NAMED
            .iter()
            .find(|(name, _)| name.eq_ignore_ascii_case(word));
        let Some(&(_, input)) = found else {
            let known = Input::NAMED.map(|(name, _)| name).join(", ");
            return Err(self.unexpected(format!("an input number or one of {known}")));
        };
        self.advance();
        Ok(input)
    }
}
