//! Packets as they come, read where they lie: what a controller says is heard without asking for memory.
//!
//! Source: OSC 1.0, "OSC Packets", "OSC Messages" and "OSC Type Tag String"; types beyond the four required ones are
//! those of its table of further types. It must not know what addresses mean.

use std::str::Chars;

/// How the address of a bundle reads.
const BUNDLE: &str = "#bundle";
/// Everything begins at a multiple of this many bytes from the packet's beginning.
const ALIGNED: usize = 4;
/// A time tag.
const TAG_BYTES: usize = 8;

/// One packet, or one part of a bundle.
#[derive(Clone, Debug)]
pub(super) enum Packet<'p> {
    Message(Message<'p>),
    Bundle(Parts<'p>),
}

/// Where it goes and what it says.
#[derive(Clone, Debug)]
pub(super) struct Message<'p> {
    pub(super) address: &'p str,
    arguments: Arguments<'p>,
}

/// The packet, up to the end of the part that is read, and how far that has been.
#[derive(Clone, Debug)]
struct Cursor<'p> {
    bytes: &'p [u8],
    at: usize,
}

/// What is left of a message's arguments.
#[derive(Clone, Debug)]
struct Arguments<'p> {
    tags: Chars<'p>,
    values: Cursor<'p>,
}

/// What is left of a bundle.
#[derive(Clone, Debug)]
pub(super) struct Parts<'p>(Cursor<'p>);

/// An argument, as far as it is one of a control.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Argument {
    Number(f64),
    Other,
}

/// Reads a packet; `None` where it is none.
pub(super) fn packet(bytes: &[u8]) -> Option<Packet<'_>> {
    part(Cursor { bytes, at: 0 })
}

fn part(mut cursor: Cursor<'_>) -> Option<Packet<'_>> {
    let address = cursor.text()?;
    if address == BUNDLE {
        cursor.take(TAG_BYTES)?;
        return Some(Packet::Bundle(Parts(cursor)));
    }
    if !address.starts_with('/') {
        return None;
    }
    let mut tags = cursor.text()?.chars();
    // The comma.
    tags.next();
    let arguments = Arguments { tags, values: cursor };
    let whole = arguments.clone().all(|argument| argument.is_some());
    whole.then_some(Packet::Message(Message { address, arguments }))
}

impl Message<'_> {
    /// Its arguments as numbers, in order; `None` for what is none.
    pub(super) fn numbers(&self) -> impl Iterator<Item = Option<f64>> {
        self.arguments.clone().map(|argument| match argument {
            Some(Argument::Number(value)) => Some(value).filter(|value| value.is_finite()),
            Some(Argument::Other) | None => None,
        })
    }
}

impl<'p> Iterator for Parts<'p> {
    type Item = Option<Packet<'p>>;

    /// The next part; `None` in it where that cannot be read, with which the bundle ends.
    fn next(&mut self) -> Option<Self::Item> {
        if self.0.is_at_end() {
            return None;
        }
        let next = self.0.sized().and_then(part);
        if next.is_none() {
            self.0.at = self.0.bytes.len();
        }
        Some(next)
    }
}

impl Iterator for Arguments<'_> {
    type Item = Option<Argument>;

    /// The next argument; `None` in it where that cannot be read.
    fn next(&mut self) -> Option<Self::Item> {
        let tag = self.tags.next()?;
        Some(self.argument(tag))
    }
}

impl Arguments<'_> {
    /// One argument; an array is one, whatever is in it.
    fn argument(&mut self, tag: char) -> Option<Argument> {
        if tag != '[' {
            return self.one(tag);
        }
        let mut open = 1_usize;
        while open > 0 {
            match self.tags.next()? {
                '[' => open += 1,
                ']' => open -= 1,
                tag => {
                    self.one(tag)?;
                }
            }
        }
        Some(Argument::Other)
    }

    fn one(&mut self, tag: char) -> Option<Argument> {
        let values = &mut self.values;
        Some(Argument::Number(match tag {
            'f' => f32::from_be_bytes(values.array()?).into(),
            'd' => f64::from_be_bytes(values.array()?),
            'i' => i32::from_be_bytes(values.array()?).into(),
            'h' => i64::from_be_bytes(values.array()?) as f64,
            'T' => 1.0,
            'F' => 0.0,
            _ => {
                match tag {
                    's' => values.text().map(drop)?,
                    'b' => values.blob()?,
                    't' => values.take(TAG_BYTES).map(drop)?,
                    'c' => values.character()?,
                    'r' | 'm' => values.take(4).map(drop)?,
                    'N' | 'I' => {}
                    _ => return None,
                }
                return Some(Argument::Other);
            }
        }))
    }
}

impl<'p> Cursor<'p> {
    fn is_at_end(&self) -> bool {
        self.at >= self.bytes.len()
    }

    fn take(&mut self, count: usize) -> Option<&'p [u8]> {
        let end = self.at.checked_add(count)?;
        let taken = self.bytes.get(self.at..end)?;
        self.at = end;
        Some(taken)
    }

    fn array<const N: usize>(&mut self) -> Option<[u8; N]> {
        self.take(N)?.try_into().ok()
    }

    fn count(&mut self) -> Option<usize> {
        usize::try_from(u32::from_be_bytes(self.array()?)).ok()
    }

    /// Goes on to where the next thing begins.
    fn align(&mut self) -> Option<()> {
        self.take(self.at.next_multiple_of(ALIGNED) - self.at).map(drop)
    }

    /// Text up to a zero.
    fn text(&mut self) -> Option<&'p str> {
        let length = self.bytes.get(self.at..)?.iter().position(|&byte| byte == 0)?;
        let text = std::str::from_utf8(self.take(length)?).ok()?;
        self.take(1)?;
        self.align()?;
        Some(text)
    }

    fn character(&mut self) -> Option<()> {
        char::from_u32(u32::from_be_bytes(self.array()?)).map(drop)
    }

    fn blob(&mut self) -> Option<()> {
        let count = self.count()?;
        self.take(count)?;
        self.align()
    }

    /// A piece of which the length comes first.
    fn sized(&mut self) -> Option<Self> {
        let count = self.count()?;
        let at = self.at;
        self.take(count)?;
        let bytes = self.bytes.get(..self.at)?;
        Some(Self { bytes, at })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use rosc::{OscArray, OscBundle, OscMessage, OscPacket, OscTime, OscType};

    /// A message as it was read.
    type Read = (String, Vec<Option<f64>>);

    fn read(packet: Packet<'_>, all: &mut Vec<Read>) {
        match packet {
            Packet::Message(message) => {
                all.push((message.address.to_owned(), message.numbers().collect()));
            }
            Packet::Bundle(parts) => parts.flatten().for_each(|part| read(part, all)),
        }
    }

    /// What another reader of the format makes of it.
    fn witnessed(packet: OscPacket, all: &mut Vec<Read>) {
        match packet {
            OscPacket::Message(OscMessage { addr, args }) => {
                let number = |argument: &OscType| match *argument {
                    OscType::Float(value) => Some(f64::from(value)),
                    OscType::Double(value) => Some(value),
                    OscType::Int(value) => Some(f64::from(value)),
                    OscType::Long(value) => Some(value as f64),
                    OscType::Bool(value) => Some(f64::from(u8::from(value))),
                    _ => None,
                };
                let finite = |argument| number(argument).filter(|value| value.is_finite());
                all.push((addr, args.iter().map(finite).collect()));
            }
            OscPacket::Bundle(bundle) => bundle.content.into_iter().for_each(|part| witnessed(part, all)),
        }
    }

    fn argument() -> impl Strategy<Value = OscType> {
        prop_oneof![
            any::<f32>().prop_map(OscType::Float),
            any::<f64>().prop_map(OscType::Double),
            any::<i32>().prop_map(OscType::Int),
            any::<i64>().prop_map(OscType::Long),
            any::<bool>().prop_map(OscType::Bool),
            "[a-z]{0,9}".prop_map(OscType::String),
            prop::collection::vec(any::<u8>(), 0..9).prop_map(OscType::Blob),
            any::<char>().prop_map(OscType::Char),
            Just(OscType::Nil),
            Just(OscType::Inf),
            any::<[u32; 2]>()
                .prop_map(|[seconds, fractional]| OscType::Time(OscTime { seconds, fractional })),
        ]
    }

    fn argument_or_array() -> impl Strategy<Value = OscType> {
        argument().prop_recursive(3, 12, 4, |inner| {
            prop::collection::vec(inner, 0..4).prop_map(|content| OscType::Array(OscArray { content }))
        })
    }

    fn any_packet(argument: impl Strategy<Value = OscType> + 'static) -> impl Strategy<Value = OscPacket> {
        let message = ("/[a-z0-9/]{0,12}", prop::collection::vec(argument, 0..5))
            .prop_map(|(addr, args)| OscPacket::Message(OscMessage { addr, args }));
        message.prop_recursive(3, 12, 4, |inner| {
            let content = prop::collection::vec(inner, 0..4);
            content.prop_map(|content| {
                let timetag = OscTime::from((0, 1));
                OscPacket::Bundle(OscBundle { timetag, content })
            })
        })
    }

    proptest! {
        #[test]
        fn packets_read_as_another_reader_reads_them(sent in any_packet(argument_or_array())) {
            let bytes = rosc::encoder::encode(&sent).expect("encodes");
            let (mut ours, mut theirs) = (Vec::new(), Vec::new());
            read(packet(&bytes).expect("a packet"), &mut ours);
            witnessed(rosc::decoder::decode_udp(&bytes).expect("a packet").1, &mut theirs);
            prop_assert_eq!(ours, theirs);
        }

        /// Cut short or with a wrong byte nobody reads more out of it than the other.
        #[test]
        fn broken_packets_read_as_another_reader_reads_them(
            sent in any_packet(argument()),
            at in any::<prop::sample::Index>(),
            byte in any::<u8>(),
            length in any::<prop::sample::Index>(),
        ) {
            let mut bytes = rosc::encoder::encode(&sent).expect("encodes");
            let at = at.index(bytes.len());
            // What another reader makes of brackets that do not match is its own.
            bytes[at] = byte;
            prop_assume!(!bytes.iter().any(|byte| b"[]".contains(byte)));
            bytes.truncate(length.index(bytes.len()) + 1);
            let (mut ours, mut theirs) = (Vec::new(), Vec::new());
            if let Some(it) = packet(&bytes) {
                read(it, &mut ours);
            }
            if let Ok((_, it)) = rosc::decoder::decode_udp(&bytes) {
                witnessed(it, &mut theirs);
            }
            prop_assert_eq!(ours, theirs);
        }
    }

    #[test]
    fn brackets_that_do_not_match_are_no_message() {
        for tags in [b",[f\0".as_slice(), b",]f\0", b",f[\0", b",f]\0"] {
            let bytes = [b"/a\0\0", tags, &1.0_f32.to_be_bytes()].concat();
            assert!(packet(&bytes).is_none(), "{tags:?}");
        }
    }
}
