//! The compiled meaning of a device's reports: what [`compile`](super::compile) makes of a profile and
//! [`generic`](super::generic) of a descriptor, and [`run`](super::run) goes through for every report.

use super::bits::{self, Bits};
use device_profiles::{ByteMatch, Emits, FieldName, Used};

use crate::codec::Tool;

/// All reports of a device.
#[derive(Clone, Debug, Default)]
pub(super) struct Plan {
    pub(super) reports: Vec<PlannedReport>,
    /// Bytes to leave out at the beginning of every report.
    pub(super) skip_bytes: usize,
    /// Counters whose differences tell.
    pub(super) counters: usize,
    pub(super) buttons: u16,
    pub(super) axes: u16,
    pub(super) rings: u16,
    pub(super) dials: u16,
    /// A pressure of more than this is a tip where nothing else tells.
    pub(super) tip_from_counts: u32,
    /// Which way tilts are counted.
    pub(super) tilt_signs: [i8; 2],
}

/// One kind of report.
#[derive(Clone, Debug)]
pub(super) struct PlannedReport {
    /// `None`: reports are not numbered.
    pub(super) id: Option<u8>,
    /// Fewest and most bytes, id included.
    pub(super) bytes: [usize; 2],
    pub(super) matches: Vec<ByteMatch>,
    pub(super) emits: Emits,
    pub(super) tool: Option<Tool>,
    /// Where the number of used groups stands.
    pub(super) used: Option<Used>,
    /// One, or one for each slot.
    pub(super) groups: Vec<Group>,
}

/// Fields that are read together.
#[derive(Clone, Debug, Default)]
pub(super) struct Group {
    /// All must hold, or the group is left out.
    pub(super) conditions: Vec<ByteMatch>,
    pub(super) fields: Vec<PlannedField>,
    /// Arrays of which buttons are down.
    pub(super) arrays: Vec<ButtonArray>,
    /// Which finger, where no field says.
    pub(super) finger: u16,
}

/// A number and what is done with it.
#[derive(Clone, Copy, Debug)]
pub(super) struct PlannedField {
    pub(super) name: FieldName,
    pub(super) bits: Bits,
    pub(super) sign: Sign,
    pub(super) invert: bool,
    /// These bits tell nothing.
    pub(super) nothing: Option<u64>,
    /// Values outside tell nothing: a descriptor's null state.
    pub(super) range: Option<[i64; 2]>,
    /// Values outside are brought to its ends.
    pub(super) clamp: Option<[i64; 2]>,
    pub(super) scale: i64,
    pub(super) add: i64,
    /// Number of the counter whose differences it tells.
    pub(super) counter: Option<usize>,
    pub(super) when: Option<ByteMatch>,
}

/// How the bits are a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Sign {
    /// 0 and up.
    None,
    /// Two's complement.
    Twos,
    /// This bit makes the rest negative.
    Bit(u8),
}

/// Elements each of which names a button that is down.
#[derive(Clone, Copy, Debug)]
pub(super) struct ButtonArray {
    /// The first element.
    pub(super) element: Bits,
    pub(super) count: u32,
    pub(super) signed: bool,
    /// The value that means the first button.
    pub(super) lowest: i64,
    /// Its number, and how many there are.
    pub(super) first: u16,
    pub(super) buttons: u16,
    /// The choice that stands for none: usage 0 of every page of keys and buttons.
    pub(super) nothing: Option<u16>,
    /// The choice that says that more are down than can be named.
    pub(super) too_many: Option<u16>,
}

impl PlannedField {
    /// A plain unsigned number.
    pub(super) fn plain(name: FieldName, bits: Bits) -> Self {
        Self {
            name,
            bits,
            sign: Sign::None,
            invert: false,
            nothing: None,
            range: None,
            clamp: None,
            scale: 1,
            add: 0,
            counter: None,
            when: None,
        }
    }

    /// What the report says, or nothing. `previous` holds the counters.
    pub(super) fn value(&self, report: &[u8], previous: &mut [Option<u64>]) -> Option<i64> {
        if self.when.is_some_and(|when| !when.holds(report)) {
            return None;
        }
        let width = self.bits.width();
        let mut raw = self.bits.read(report)?;
        if self.invert {
            raw ^= bits::mask(width);
        }
        if self.nothing == Some(raw) {
            return None;
        }
        let value = match (self.counter, self.sign) {
            (Some(counter), _) => {
                let before = previous.get_mut(counter)?.replace(raw)?;
                bits::signed(raw.wrapping_sub(before) & bits::mask(width), width)
            }
            (None, Sign::None) => i64::try_from(raw).unwrap_or(i64::MAX),
            (None, Sign::Twos) => bits::signed(raw, width),
            (None, Sign::Bit(bit)) => {
                let size = (raw & bits::mask(bit)) as i64;
                if raw >> bit & 1 == 1 { -size } else { size }
            }
        };
        if self
            .range
            .is_some_and(|[low, high]| !(low..=high).contains(&value))
        {
            return None;
        }
        let value = self
            .clamp
            .map_or(value, |[low, high]| value.clamp(low, high.max(low)));
        Some(value.saturating_mul(self.scale).saturating_add(self.add))
    }
}

impl ButtonArray {
    /// The button that element `n` names, counted from the array's first; `None` for none.
    pub(super) fn named(&self, n: u32, report: &[u8]) -> Option<u16> {
        let element = self.element.moved(n * u32::from(self.element.width()));
        let raw = element.read(report)?;
        let value = if self.signed {
            bits::signed(raw, element.width())
        } else {
            i64::try_from(raw).ok()?
        };
        let at = u16::try_from(value.checked_sub(self.lowest)?).ok()?;
        (at < self.buttons && self.nothing != Some(at)).then_some(at)
    }
}

/// Families of reports: of each the first that matches is used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Family {
    /// What is about the tool.
    Tool,
    /// Keys, dials, axes.
    Controls,
    /// Fingers.
    Touch,
}

impl PlannedReport {
    pub(super) fn family(&self) -> Family {
        match self.emits {
            Emits::Tool | Emits::Enter | Emits::Leave | Emits::Nothing => Family::Tool,
            Emits::Pad | Emits::Controls => Family::Controls,
            Emits::Touch => Family::Touch,
        }
    }
}
