//! The host's half of protocol IV: characters to commands.
//!
//! `$` and `#` count at the start of a line, `~#` needs no carriage return, everything else ends with one.
//! Source: `docs/protocols/wacom-iv.md`.

/// Longest line kept; anything longer is noise.
const LINE_MAX: usize = 32;

/// A complete command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Command {
    /// `$`: default speed, and on protocol IV the older "II-S" manner, which sends nothing here.
    ResetBaud,
    /// `#`: protocol IV with its defaults.
    Reset,
    Identify,
    Resolution,
    Size,
    Start,
    Stop,
    UpperOrigin(bool),
    Pressure(bool),
    Tilt(bool),
    Interval(u32),
    Suppress(u32),
    /// Known, and without effect here.
    Accepted,
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
            ([], b'$') => Some(Command::ResetBaud),
            ([], b'#') => Some(Command::Reset),
            ([b'~'], b'#') => {
                self.line.clear();
                Some(Command::Identify)
            }
            ([], b'\r') => None,
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
        (b"OC", Some(on)) => Command::UpperOrigin(on != 0),
        // A PenPartner has a word of its own for it.
        (b"ZF" | b"PH", Some(on)) => Command::Pressure(on != 0),
        (b"FM", Some(on)) => Command::Tilt(on != 0),
        (b"IT", Some(units)) => Command::Interval(units),
        (b"SU", Some(counts)) => Command::Suppress(counts),
        // Several tools at once, modes, increment, resolution, stream.
        (b"MU" | b"~M" | b"IN" | b"NR", Some(_)) => Command::Accepted,
        (b"SR", None) if argument.is_empty() => Command::Accepted,
        _ => Command::Unknown,
    }
}
