//! The host's half of the MM language: one character a command, some with a second.
//!
//! Source: `docs/protocols/mm.md` (xf86-input-summa, `src/xf86Summa.c`; the MM1201 manual as quoted on
//! classic-computer lists).

/// A complete command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Command {
    /// NUL: everything as after power-up.
    Reset,
    /// `B`: reports only when prompted.
    PromptMode,
    /// `P`: one report, now.
    Prompt,
    /// `@`: reports by itself.
    Stream,
    /// `F` and `E`.
    Absolute(bool),
    /// `b`: origin in the upper left corner.
    UpperOrigin,
    /// `zb`: packets of bytes rather than lines of text.
    Binary,
    /// `z?`: who are you.
    Identify,
    /// `a`: the largest coordinates.
    Configuration,
    /// `0`, `1`: the bit that tells two tablets on one line apart.
    TabletId(bool),
    /// `I` and a character: how far it must have moved to be reported, 0 to 95 counts.
    Increment(u8),
    /// A letter: lines per inch.
    Resolution(u16),
    /// A space, which is for waking up only.
    Nothing,
    Unknown,
}

/// What a first character waits for.
#[derive(Clone, Debug, Default)]
pub(super) struct Parser {
    first: Option<u8>,
}

impl Parser {
    /// Takes one character; gives the command it completes.
    pub(super) fn push(&mut self, byte: u8) -> Option<Command> {
        match (self.first.take(), byte) {
            (None, b'z' | b'I') => {
                self.first = Some(byte);
                None
            }
            (None, byte) => Some(single(byte)),
            (Some(b'z'), b'b') => Some(Command::Binary),
            (Some(b'z'), b'?') => Some(Command::Identify),
            (Some(b'I'), byte @ 32..=127) => Some(Command::Increment(byte - 32)),
            _ => Some(Command::Unknown),
        }
    }
}

fn single(byte: u8) -> Command {
    match byte {
        0 => Command::Reset,
        b' ' => Command::Nothing,
        b'B' => Command::PromptMode,
        b'P' => Command::Prompt,
        b'@' => Command::Stream,
        b'F' => Command::Absolute(true),
        b'E' => Command::Absolute(false),
        b'b' => Command::UpperOrigin,
        b'a' => Command::Configuration,
        b'0' => Command::TabletId(false),
        b'1' => Command::TabletId(true),
        _ => resolution(byte).map_or(Command::Unknown, Command::Resolution),
    }
}

/// Lines per inch by letter.
fn resolution(letter: u8) -> Option<u16> {
    Some(match letter {
        b'l' => 1,
        b'n' => 2,
        b'p' => 4,
        b'd' => 100,
        b'e' => 200,
        b'f' => 254,
        b'g' => 400,
        b'h' => 500,
        b'i' => 508,
        b'j' => 1000,
        b'q' => 1016,
        b's' => 2000,
        b'u' => 2032,
        b'v' => 2540,
        _ => return None,
    })
}
