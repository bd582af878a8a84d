//! Control table rows by the e-manual's names, and their values as numbers and in SI units.
//!
//! Source: the servo's profile; byte order and two's complement after the e-manual, "Control Table".

use device_profiles::{Area, Register, ServoProfile};

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
    /// 1, 2 or 4 bytes, low byte first.
    pub size: u8,
    /// Two's complement.
    pub signed: bool,
    /// How many of the row's SI unit one count is; 1 for pure numbers.
    pub unit_per_count: f64,
    /// Kept without power, and locked while torque is on.
    pub eeprom: bool,
}

impl From<&Register> for Field {
    fn from(row: &Register) -> Self {
        Self {
            address: row.address,
            size: row.size,
            signed: row.signed,
            unit_per_count: row.unit_per_count.unwrap_or(1.0),
            eeprom: row.area == Area::Eeprom,
        }
    }
}

impl Field {
    /// The row called `name`, exactly as the e-manual spells it.
    pub fn named(servo: &ServoProfile, name: &str) -> Result<Self, RegisterError> {
        servo
            .register(name)
            .map(Self::from)
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
        Some(decode(bytes, self.signed))
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
        let (min, max) = bounds(self.size, self.signed);
        ((si / self.unit_per_count).round() as i64).clamp(min, max)
    }
}

/// The bytes of `raw` for a row of the profile, checked against the row's access, size and legal values.
/// Returns four bytes of which the first `size` count.
pub fn encode_checked(row: &Register, raw: i64) -> Result<[u8; 4], RegisterError> {
    if row.access == device_profiles::Access::R {
        return Err(RegisterError::ReadOnly {
            name: row.name.clone(),
        });
    }
    let (lowest, highest) = bounds(row.size, row.signed);
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
    Ok((raw as u32).to_le_bytes())
}

/// Low byte first, sign extended when `signed`; up to 4 bytes.
pub fn decode(bytes: &[u8], signed: bool) -> i64 {
    let plain = bytes
        .iter()
        .take(4)
        .rev()
        .fold(0_i64, |value, &byte| value << 8 | i64::from(byte));
    let bits = 8 * bytes.len().min(4) as u32;
    if signed && bits > 0 && plain >> (bits - 1) & 1 == 1 {
        plain - (1 << bits)
    } else {
        plain
    }
}

/// Smallest and largest value of so many bytes.
fn bounds(size: u8, signed: bool) -> (i64, i64) {
    let bits = 8 * u32::from(size.min(4));
    if signed {
        (-(1 << (bits - 1)), (1 << (bits - 1)) - 1)
    } else {
        (0, (1 << bits) - 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_keep_their_sign() {
        for (bytes, signed, want) in [
            (&[0xff_u8, 0xff][..], true, -1_i64),
            (&[0xff, 0xff], false, 65_535),
            (&[0xfd, 0xff, 0xff, 0xff], true, -3),
            (&[0xff], true, -1),
            (&[0x00, 0x08, 0, 0], true, 2048),
            (&[], true, 0),
        ] {
            assert_eq!(decode(bytes, signed), want, "{bytes:02x?}");
        }
    }

    #[test]
    fn a_field_outside_its_block_is_none() {
        let field = Field {
            address: 132,
            size: 4,
            signed: true,
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
