//! The host's half of protocol V: characters to commands.
//!
//! `$` and `#` count at the start of a line, `~#` needs no carriage return, everything else ends with one.
//! Source: `docs/protocols/wacom-v.md`.

/// Longest line kept; anything longer is noise.
const LINE_MAX: usize = 32;

/// A complete command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Command {
    /// `$`: everything as after power-up, 9600 baud.
    ResetBaud,
    /// `#`: the protocol's defaults, reporting, at the speed it has.
    Reset,
    Identify,
    Resolution,
    Size,
    Start,
    Stop,
    /// `BA19`, `BA38`: 19200 or 38400 baud.
    Baud(u32),
    /// `MT`: two tools at once.
    TwoTools(bool),
    /// `ID`: a tool that comes is introduced.
    Introductions(bool),
    /// `IT`: units of 5 ms between packets of one tool.
    Interval(u32),
    Unknown,
}

/// The line in hand.
#[derive(Clone, Debug, Default)]
pub(super) struct Parser {
    line: Vec<u8>,
}

impl Parser {
    /// Takes one character; gives the command it completes.
    pub(super) fn push(&mut self, byte: u8) -> Option<Command> {
        match (self.line.as_slice(), byte) {
            // Commands of this set-up are separated by a space as well as a return (xf86-input-wacom).
            ([], b' ' | b'\r') => None,
            ([], b'$') => Some(Command::ResetBaud),
            ([], b'#') => Some(Command::Reset),
            ([b'~'], b'#') => {
                self.line.clear();
                Some(Command::Identify)
            }
            (line, b'\r') => {
                let command = command(line);
                self.line.clear();
                Some(command)
            }
            (line, _) => {
                if line.len() < LINE_MAX {
                    self.line.push(byte);
                }
                None
            }
        }
    }
}

fn command(line: &[u8]) -> Command {
    let Some((name, argument)) = line.split_at_checked(2) else {
        return Command::Unknown;
    };
    let number = std::str::from_utf8(argument)
        .ok()
        .and_then(|text| text.parse::<u32>().ok());
    match (name, number) {
        (b"~R", None) if argument.is_empty() => Command::Resolution,
        (b"~C", None) if argument.is_empty() => Command::Size,
        (b"ST", None) if argument.is_empty() => Command::Start,
        (b"SP", None) if argument.is_empty() => Command::Stop,
        (b"BA", Some(19)) => Command::Baud(19_200),
        (b"BA", Some(38)) => Command::Baud(38_400),
        (b"MT", Some(on)) => Command::TwoTools(on != 0),
        (b"ID", Some(on)) => Command::Introductions(on != 0),
        (b"IT", Some(units)) => Command::Interval(units),
        _ => Command::Unknown,
    }
}
