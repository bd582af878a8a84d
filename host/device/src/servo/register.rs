//! Control table rows, found by name or by role, and their values as numbers and in SI units.
//!
//! Source: the servo's profile, which says how words are ordered and negative numbers written (two's complement
//! after the e-manual, "Control Table"; sign and magnitude on Feetech).

use device_profiles::{Area, Register, Role, ServoProfile, WordOrder};

/// Why a register cannot be used.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum RegisterError {
    /// The table has no such row.
    #[error("{model} has no register \"{name}\"; it has: {known}")]
    Unknown {
        /// The servo profile's name.
        model: String,
        /// What was asked for.
        name: String,
        /// What there is.
        known: String,
    },
    /// The table has no row for something that is needed.
    #[error("{model} has no register with role \"{role}\", which is needed here")]
    Lacks {
        /// The servo profile's name.
        model: String,
        /// What was looked for.
        role: Role,
    },
    /// The row cannot be written, or not with this value.
    #[error("{raw} does not fit register \"{name}\" of {size} bytes: give a value from {min} to {max}")]
    Value {
        /// The row.
        name: String,
        /// The value in counts.
        raw: i64,
        /// Bytes of the row.
        size: u8,
        /// Smallest value.
        min: i64,
        /// Largest value.
        max: i64,
    },
    /// The row is marked read only.
    #[error("register \"{name}\" is read only")]
    ReadOnly {
        /// The row.
        name: String,
    },
}

/// One value of a control table: where it lies and what a count of it means.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Field {
    /// First byte.
    pub address: u16,
    /// 1, 2 or 4 bytes.
    pub size: u8,
    /// How they follow each other.
    pub order: WordOrder,
    /// How negative numbers are written.
    pub sign: Sign,
    /// How many of the row's SI unit one count is; 1 for pure numbers.
    pub unit_per_count: f64,
    /// Kept without power, and locked while torque is on.
    pub eeprom: bool,
}

/// How a register writes negative numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sign {
    /// Not at all.
    None,
    /// Two's complement in the row's bytes.
    Complement,
    /// The given bit says minus, those below it are the magnitude.
    Magnitude(u8),
}

impl Sign {
    fn of(row: &Register) -> Self {
        match (row.sign_bit, row.signed) {
            (Some(bit), _) => Self::Magnitude(bit),
            (None, true) => Self::Complement,
            (None, false) => Self::None,
        }
    }
}

/// The bytes of one value as a servo wants them; as many as the row has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Word {
    bytes: [u8; 4],
    size: u8,
}

impl AsRef<[u8]> for Word {
    fn as_ref(&self) -> &[u8] {
        self.bytes.get(..usize::from(self.size)).unwrap_or_default()
    }
}

impl Field {
    /// A row of a servo's table.
    pub fn of(servo: &ServoProfile, row: &Register) -> Self {
        Self {
            address: row.address,
            size: row.size,
            order: servo.word_order(),
            sign: Sign::of(row),
            unit_per_count: row.unit_per_count.unwrap_or(1.0),
            eeprom: row.area == Area::Eeprom,
        }
    }

    /// The row for a purpose, if the servo has one.
    pub fn for_role(servo: &ServoProfile, role: Role) -> Option<Self> {
        servo.role(role).map(|row| Self::of(servo, row))
    }

    /// The row for a purpose without which nothing goes.
    pub fn needed(servo: &ServoProfile, role: Role) -> Result<Self, RegisterError> {
        Self::for_role(servo, role).ok_or_else(|| RegisterError::Lacks {
            model: servo.name.clone(),
            role,
        })
    }

    /// The row called `name`, exactly as the profile spells it.
    pub fn named(servo: &ServoProfile, name: &str) -> Result<Self, RegisterError> {
        servo
            .register(name)
            .map(|row| Self::of(servo, row))
            .ok_or_else(|| RegisterError::Unknown {
                model: servo.name.clone(),
                name: name.to_owned(),
                known: servo
                    .registers
                    .iter()
                    .map(|row| row.name.as_str())
                    .collect::<Vec<_>>()
                    .join(", "),
            })
    }

    /// One past the last byte.
    pub fn end(&self) -> u16 {
        self.address.saturating_add(u16::from(self.size))
    }

    /// The value in a block of bytes that starts at `block_address`; none if it is not all inside.
    pub fn get(&self, block: &[u8], block_address: u16) -> Option<i64> {
        let from = usize::from(self.address.checked_sub(block_address)?);
        let bytes = block.get(from..from + usize::from(self.size))?;
        Some(decode(bytes, self.order, self.sign))
    }

    /// The same in the row's SI unit.
    pub fn get_si(&self, block: &[u8], block_address: u16) -> Option<f64> {
        Some(self.si(self.get(block, block_address)?))
    }

    /// Counts to the row's SI unit.
    pub fn si(&self, raw: i64) -> f64 {
        raw as f64 * self.unit_per_count
    }

    /// The row's SI unit to the nearest count; saturates at the ends of the row's bytes.
    pub fn raw(&self, si: f64) -> i64 {
        let (min, max) = bounds(self.size, self.sign);
        ((si / self.unit_per_count).round() as i64).clamp(min, max)
    }

    /// The bytes of a value; what does not fit is taken to the nearer end.
    pub fn word(&self, raw: i64) -> Word {
        let (min, max) = bounds(self.size, self.sign);
        let raw = raw.clamp(min, max);
        let plain = match self.sign {
            Sign::Magnitude(bit) if raw < 0 => raw.unsigned_abs() | 1 << bit.min(31),
            _ => raw as u64,
        };
        let mut bytes = (plain as u32).to_le_bytes();
        if self.order == WordOrder::Big && self.size > 1 {
            // High byte first in each word of two; of two words the low one comes first.
            bytes.chunks_exact_mut(2).for_each(<[u8]>::reverse);
        }
        Word {
            bytes,
            size: self.size.min(4),
        }
    }
}

/// The bytes of `raw` for a row of the profile, checked against the row's access, size and legal values.
pub fn encode_checked(servo: &ServoProfile, row: &Register, raw: i64) -> Result<Word, RegisterError> {
    if row.access == device_profiles::Access::R {
        return Err(RegisterError::ReadOnly {
            name: row.name.clone(),
        });
    }
    let (lowest, highest) = bounds(row.size, Sign::of(row));
    let min = row.min.unwrap_or(lowest).max(lowest);
    let max = row.max.unwrap_or(highest).min(highest);
    let listed = row.values.is_empty() || row.values.contains(&raw);
    if raw < min || raw > max || !listed {
        return Err(RegisterError::Value {
            name: row.name.clone(),
            raw,
            size: row.size,
            min,
            max,
        });
    }
    Ok(Field::of(servo, row).word(raw))
}

/// Up to 4 bytes as a number.
pub fn decode(bytes: &[u8], order: WordOrder, sign: Sign) -> i64 {
    let mut word = [0; 4];
    for (place, byte) in word.iter_mut().zip(bytes) {
        *place = *byte;
    }
    if order == WordOrder::Big && bytes.len() > 1 {
        word.chunks_exact_mut(2).for_each(<[u8]>::reverse);
    }
    let plain = i64::from(u32::from_le_bytes(word));
    let bits = 8 * bytes.len().min(4) as u32;
    match sign {
        Sign::Complement if bits > 0 && plain >> (bits - 1) & 1 == 1 => plain - (1 << bits),
        Sign::Magnitude(bit) if plain >> bit.min(31) & 1 == 1 => -(plain & ((1 << bit.min(31)) - 1)),
        Sign::None | Sign::Complement | Sign::Magnitude(_) => plain,
    }
}

/// Smallest and largest value of so many bytes.
fn bounds(size: u8, sign: Sign) -> (i64, i64) {
    let bits = 8 * u32::from(size.min(4));
    match sign {
        Sign::None => (0, (1 << bits) - 1),
        Sign::Complement => (-(1 << (bits - 1)), (1 << (bits - 1)) - 1),
        Sign::Magnitude(bit) => {
            let most = (1 << bit.min(31)) - 1;
            (-most, most)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_keep_their_sign_and_words_their_order() {
        use Sign::{Complement, Magnitude, None};
        use WordOrder::{Big, Little};
        for (bytes, order, sign, want) in [
            (&[0xff_u8, 0xff][..], Little, Complement, -1_i64),
            (&[0xff, 0xff], Little, None, 65_535),
            (&[0xfd, 0xff, 0xff, 0xff], Little, Complement, -3),
            (&[0xff], Little, Complement, -1),
            (&[0x00, 0x08, 0, 0], Little, Complement, 2048),
            (&[0x05, 0x80], Little, Magnitude(15), -5),
            (&[0x05, 0x04], Little, Magnitude(10), -5),
            (&[0xff, 0x7f], Little, Magnitude(15), 32_767),
            (&[0x08, 0x00], Big, None, 2048),
            (&[0x80, 0x05], Big, Magnitude(15), -5),
            // Source: servo reference 3.5, 0x12345678 on SCS.
            (&[0x56, 0x78, 0x12, 0x34], Big, None, 0x1234_5678),
            (&[0x07], Big, None, 7),
        ] {
            assert_eq!(
                decode(bytes, order, sign),
                want,
                "{bytes:02x?} {order:?} {sign:?}"
            );
            let field = Field {
                address: 0,
                size: bytes.len() as u8,
                order,
                sign,
                unit_per_count: 1.0,
                eeprom: false,
            };
            assert_eq!(field.word(want).as_ref(), bytes, "{want} {order:?} {sign:?}");
        }
        assert_eq!(decode(&[], Little, Complement), 0);
    }

    #[test]
    fn a_field_outside_its_block_is_none() {
        let field = Field {
            address: 132,
            size: 4,
            order: WordOrder::Little,
            sign: Sign::Complement,
            unit_per_count: 0.5,
            eeprom: false,
        };
        let block = [0, 0, 0, 0, 4, 0, 0, 0];
        assert_eq!(field.get_si(&block, 128), Some(2.0));
        assert_eq!(field.get(&block, 133), None);
        assert_eq!(field.get(&block, 126), None);
        assert_eq!(field.raw(1.0), 2);
        assert_eq!(field.raw(f64::INFINITY), i64::from(i32::MAX));
    }
}
