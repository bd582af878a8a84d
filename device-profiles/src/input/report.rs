//! What the bytes of a report mean.
//!
//! Byte 0 is the report's first: its id where the device numbers its reports, otherwise the first of the payload.
//!
//! One report may be read by several tables: by the first matching one of those that are about the tool (`tool`,
//! `enter`, `leave`, `nothing`), by the first matching `pad` or `controls`, and by the first matching `touch`.

use super::{Tool, is_default};
use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error as _};

/// One kind of report.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Report {
    /// Its id; absent where the device does not number its reports.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub id: Option<u8>,
    /// Fewest and most bytes, with the id; shorter and longer ones are rejected.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bytes: Option<[u16; 2]>,
    /// What must hold of single bytes, all of it.
    #[serde(default, rename = "match", skip_serializing_if = "Vec::is_empty")]
    pub matches: Vec<ByteMatch>,
    /// What it is about.
    pub emits: Emits,
    /// Which tool, where the report itself tells no more.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tool: Option<Tool>,
    /// The report is several messages of one length.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub slots: Option<Slots>,
    /// What stands in it.
    #[serde(default, rename = "field", skip_serializing_if = "Vec::is_empty")]
    pub fields: Vec<Field>,
}

/// A condition on one byte: `byte & mask` is `is`, or with `to` between the two. A report too short for the byte
/// does not match.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ByteMatch {
    /// Which byte; with `slot`, counted from the slot's first.
    pub byte: u16,
    /// Bits that matter; all unless said.
    #[serde(default = "all_bits", skip_serializing_if = "is_all_bits")]
    pub mask: u8,
    /// What they must be, or the smallest that they may be.
    pub is: u8,
    /// The largest that they may be.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub to: Option<u8>,
    /// The condition is each slot's own: slots for which it does not hold are left out.
    #[serde(default, skip_serializing_if = "is_default")]
    pub slot: bool,
}

impl ByteMatch {
    /// Whether it holds in these bytes, which begin where `byte` counts from.
    pub fn holds(&self, bytes: &[u8]) -> bool {
        bytes
            .get(usize::from(self.byte))
            .is_some_and(|b| (self.is..=self.to.unwrap_or(self.is)).contains(&(b & self.mask)))
    }
}

/// Messages of one length behind one another; `byte` in fields counts from each one's start.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Slots {
    /// Where the first begins.
    pub first: u16,
    /// Bytes of each.
    pub stride: u16,
    /// How many there may be.
    pub count: u16,
    /// The byte that says how many are used; absent: all.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub used: Option<Used>,
}

/// Where the number of used slots stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Used {
    /// Which byte of the report.
    pub byte: u16,
    /// Its bits.
    pub mask: u8,
}

/// What a report is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Emits {
    /// A tool on the surface.
    Tool,
    /// A tool comes, with its serial and type.
    Enter,
    /// The tool goes.
    Leave,
    /// Keys, rings, strips and dials beside the surface.
    Pad,
    /// Fingers.
    Touch,
    /// Controls of a device that is no tablet.
    Controls,
    /// Nothing anybody wants, but not unknown.
    Nothing,
}

/// One number in a report, or a row of them.
///
/// It is made so: the bits are collected; `invert` flips all of them; `nothing` is compared; the sign is applied;
/// then it is multiplied by `scale`, and `add` is added. Fields of one dial's name in one report add up, and so do
/// those of the wheel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Field {
    /// What it tells.
    pub name: FieldName,
    /// The byte of its lowest bits; with `endian = "big"` that of its highest.
    pub byte: u16,
    /// Its lowest bit in that byte; 0 unless said.
    #[serde(default, skip_serializing_if = "is_default")]
    pub bit: u8,
    /// How many bits, going on in the bytes that follow; 8 unless said, 1 for what is only on or off.
    /// With `endian = "big"` a multiple of 8, from bit 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub width: Option<u8>,
    /// Which byte comes first; the lowest unless said.
    #[serde(default, skip_serializing_if = "is_default")]
    pub endian: ByteOrder,
    /// Further bits, each more significant than what is before it.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub also: Vec<Piece>,
    /// Two's complement over all its bits.
    #[serde(default, skip_serializing_if = "is_default")]
    pub signed: bool,
    /// This bit says that the bits below it are negative.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sign_bit: Option<u8>,
    /// All its bits the other way round.
    #[serde(default, skip_serializing_if = "is_default")]
    pub invert: bool,
    /// With these bits it tells nothing: no finger, no change.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub nothing: Option<u32>,
    /// Multiplied by this; 1 unless said, -1 turns the direction.
    #[serde(default = "one", skip_serializing_if = "is_one")]
    pub scale: i32,
    /// Added at the end.
    #[serde(default, skip_serializing_if = "is_default")]
    pub add: i32,
    /// It is a counter of that width: its differences tell, the shorter way round. The first one tells nothing.
    #[serde(default, skip_serializing_if = "is_default")]
    pub wraps: bool,
    /// It is there only when this holds.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub when: Option<ByteMatch>,
    /// It stands for a row of numbered fields.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub repeat: Option<Repeat>,
}

/// Further bits of a field.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Piece {
    /// The byte.
    pub byte: u16,
    /// Its lowest bit there; 0 unless said.
    #[serde(default, skip_serializing_if = "is_default")]
    pub bit: u8,
    /// How many bits; 8 unless said.
    #[serde(default = "eight", skip_serializing_if = "is_eight")]
    pub width: u8,
}

/// A row of fields: each has the next number and stands this much further on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Repeat {
    /// How many, the first included.
    pub count: u16,
    /// From one to the next, bits.
    pub bits: u16,
}

/// Which byte of a number comes first.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ByteOrder {
    /// The lowest.
    #[default]
    Little,
    /// The highest.
    Big,
}

impl Field {
    /// How many bits `byte` and `bit` begin; those of `also` come on top.
    pub fn bits(&self) -> u8 {
        self.width.unwrap_or(if self.name.is_switch() { 1 } else { 8 })
    }

    /// Bits in all.
    pub fn all_bits(&self) -> u32 {
        let also = self.also.iter().map(|piece| u32::from(piece.width)).sum::<u32>();
        u32::from(self.bits()) + also
    }

    /// The bits collected from a report, `row` of a row from 0; `None` where the report is too short.
    /// The rest of what is said of the field is the decoder's.
    pub fn collect(&self, report: &[u8], row: u16) -> Option<u64> {
        let shift = self.repeat.map_or(0, |r| u32::from(r.bits) * u32::from(row));
        let mut at = 0;
        let mut value = match self.endian {
            ByteOrder::Little => {
                let start = u32::from(self.byte) * 8 + u32::from(self.bit) + shift;
                bits_of(report, start, self.bits().into())?
            }
            ByteOrder::Big => {
                let start = usize::from(self.byte) + usize::try_from(shift / 8).ok()?;
                let bytes = report.get(start..start + usize::from(self.bits() / 8))?;
                bytes.iter().fold(0, |sum, &b| sum << 8 | u64::from(b))
            }
        };
        at += u32::from(self.bits());
        for piece in &self.also {
            let start = u32::from(piece.byte) * 8 + u32::from(piece.bit) + shift;
            value |= bits_of(report, start, piece.width.into())?.checked_shl(at)?;
            at += u32::from(piece.width);
        }
        Some(value)
    }
}

/// `width` bits from bit `start` on, lowest first; 64 at most.
fn bits_of(report: &[u8], start: u32, width: u32) -> Option<u64> {
    let mut value = 0_u64;
    let mut taken = 0;
    while taken < width {
        let bit = start + taken;
        let byte = u64::from(*report.get(usize::try_from(bit / 8).ok()?)?);
        let here = (8 - bit % 8).min(width - taken);
        let piece = byte >> (bit % 8) & ((1 << here) - 1);
        value |= piece.checked_shl(taken)?;
        taken += here;
    }
    Some(value)
}

macro_rules! field_names {
    (plain: $($plain:ident = $word:literal $switch:literal: $meaning:literal,)*;
     numbered: $($numbered:ident = $stem:literal $nswitch:literal: $nmeaning:literal,)*) => {
        /// What a field tells. Numbered ones count from 1 in files: `key1` is control 0 of the buttons.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
        pub enum FieldName {
            $(#[doc = $meaning] $plain,)*
            $(#[doc = $nmeaning] $numbered(
                /// Its number, from 1.
                u16,
            ),)*
        }

        impl FieldName {
            /// Reads a name as the files have it.
            pub fn parse(word: &str) -> Option<Self> {
                match word {
                    $($word => return Some(Self::$plain),)*
                    _ => {}
                }
                let stem = word.trim_end_matches(|c: char| c.is_ascii_digit());
                let digits = word.get(stem.len()..)?;
                let number: u16 = digits.parse().ok().filter(|&n| n > 0 && !digits.starts_with('0'))?;
                match stem {
                    $($stem => Some(Self::$numbered(number)),)*
                    _ => None,
                }
            }

            /// Whether it is only on or off.
            pub fn is_switch(self) -> bool {
                match self {
                    $(Self::$plain => $switch,)*
                    $(Self::$numbered(_) => $nswitch,)*
                }
            }

            /// The same name `steps` numbers on; plain names stay.
            #[must_use]
            pub fn on_by(self, steps: u16) -> Self {
                match self {
                    $(Self::$numbered(n) => Self::$numbered(n.saturating_add(steps)),)*
                    plain => plain,
                }
            }

            /// All plain names and the stems of numbered ones, for messages.
            pub fn all() -> String {
                [$($word,)* $(concat!($stem, "N"),)*].join(", ")
            }
        }

        impl std::fmt::Display for FieldName {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                match self {
                    $(Self::$plain => f.write_str($word),)*
                    $(Self::$numbered(n) => write!(f, concat!($stem, "{}"), n),)*
                }
            }
        }
    };
}

field_names! {
    plain:
    X = "x" false: "Place across.",
    Y = "y" false: "Place down.",
    Pressure = "pressure" false: "Pressure of the tip.",
    TiltX = "tilt_x" false: "Tilt to the right.",
    TiltY = "tilt_y" false: "Tilt towards the user.",
    Twist = "twist" false: "Turn of the pen about itself.",
    Distance = "distance" false: "Height above the surface.",
    Wheel = "wheel" false: "Steps of the tool's wheel.",
    Dx = "dx" false: "Relative movement across.",
    Dy = "dy" false: "Relative movement down.",
    InRange = "in_range" true: "A tool is near.",
    Proximity = "proximity" true: "Its place is valid.",
    Ready = "ready" true: "Its pressure and buttons are valid.",
    Tip = "tip" true: "The tip touches.",
    Eraser = "eraser" true: "The eraser touches, or the tool is the eraser's end.",
    Invert = "invert" true: "The tool is held with the eraser's end down.",
    Serial = "serial" false: "The tool's serial number.",
    ToolType = "tool_type" false: "The tool's type.",
    TouchId = "touch_id" false: "Which finger.",
    TouchX = "touch_x" false: "A finger's place across.",
    TouchY = "touch_y" false: "A finger's place down.",
    TouchDown = "touch_down" true: "The finger touches.",
    ;
    numbered:
    Button = "button" true: "A button of the tool.",
    Key = "key" true: "A key of the pad, or a button of a box: control N - 1 of the buttons.",
    Ring = "ring" false: "A place on a ring or strip: control N - 1 of the rings.",
    Dial = "dial" false: "Steps of a dial: control N - 1 of the dials.",
    Axis = "axis" false: "An absolute value: control N - 1 of the axes.",
    Touched = "touched" true: "A finger is on an absolute control: N - 1 of the axes.",
}

impl Serialize for FieldName {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        to.collect_str(self)
    }
}

impl<'de> Deserialize<'de> for FieldName {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        let word = String::deserialize(from)?;
        Self::parse(&word).ok_or_else(|| {
            D::Error::custom(format!(
                "unknown field name {word:?}, expected one of {}",
                Self::all()
            ))
        })
    }
}

fn all_bits() -> u8 {
    0xFF
}

fn eight() -> u8 {
    8
}

fn one() -> i32 {
    1
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde's signature")]
fn is_all_bits(mask: &u8) -> bool {
    *mask == all_bits()
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde's signature")]
fn is_eight(width: &u8) -> bool {
    *width == eight()
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde's signature")]
fn is_one(scale: &i32) -> bool {
    *scale == one()
}
