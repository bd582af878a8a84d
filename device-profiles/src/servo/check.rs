//! What can be wrong with a servo's profile beyond its shape.

use super::register::Register;
use super::{ServoProfile, Unit};
use crate::read::{Check, Flaw};

impl Check for ServoProfile {
    fn flaws(&self, flaws: &mut Vec<Flaw>) {
        self.flaws_of_head(flaws);
        self.flaws_of_motor(flaws);
        flaws_of_table(&self.registers, flaws);
        self.flaws_of_variants(flaws);
    }
}

impl ServoProfile {
    fn flaws_of_head(&self, flaws: &mut Vec<Flaw>) {
        let mut flaw = |key, message: String| flaws.push(Flaw::at_key(key, message));
        if !(self.counts_per_turn.is_finite() && self.counts_per_turn >= 1.0) {
            flaw(
                "counts_per_turn",
                format!(
                    "counts_per_turn must be at least 1, found {}",
                    self.counts_per_turn
                ),
            );
        }
        let [first, last] = self.position_counts;
        if !(first..=last).contains(&self.centre_counts.into()) || first == last {
            flaw(
                "position_counts",
                format!(
                    "position_counts must rise and have centre_counts between them, found {first}, {} and {last}",
                    self.centre_counts
                ),
            );
        }
        if self.bauds.is_empty() {
            flaw(
                "bauds",
                "bauds must list at least one line speed, found none".to_owned(),
            );
        }
        if !self.baud_codes.is_empty() && self.baud_codes.len() != self.bauds.len() {
            flaw(
                "baud_codes",
                format!(
                    "baud_codes must have one value for each of bauds, found {} for {}; leave it out where the \
                     index is the value",
                    self.baud_codes.len(),
                    self.bauds.len()
                ),
            );
        }
        if let Some((fault, bit)) = self.fault_bits.iter().find(|&(_, &bit)| bit > 7) {
            flaw(
                "fault_bits",
                format!("fault_bits must be bits 0 to 7 of a byte, found {bit} for {fault}"),
            );
        }
        if self.registers.is_empty() {
            flaw(
                "registers",
                "registers must have at least one row, found none".to_owned(),
            );
        }
    }

    fn flaws_of_motor(&self, flaws: &mut Vec<Flaw>) {
        let Some(motor) = &self.motor else { return };
        for (key, value) in motor.numbers() {
            if !(value.is_finite() && value > 0.0) {
                flaws.push(Flaw::at_key(key, format!("{key} must be above 0, found {value}")));
            }
        }
        if let Some(value) = motor.standby_current_a.filter(|a| !(a.is_finite() && *a >= 0.0)) {
            flaws.push(Flaw::at_key(
                "standby_current_a",
                format!("standby_current_a must be at least 0, found {value}"),
            ));
        }
    }

    fn flaws_of_variants(&self, flaws: &mut Vec<Flaw>) {
        for (at, variant) in self.variants.iter().enumerate() {
            let [from, to] = variant.firmware;
            let mut flaw = |message: String| flaws.push(Flaw::at_header("[[variant]]", at, message));
            if from > to {
                flaw(format!("firmware must be [first, last], found [{from}, {to}]"));
            }
            if variant.covers(self.firmware) {
                flaw(format!(
                    "firmware [{from}, {to}] has {} in it, whose table `registers` gives in full",
                    self.firmware
                ));
            }
            for name in variant
                .removed
                .iter()
                .filter(|name| self.register(name).is_none())
            {
                flaw(format!("removes \"{name}\", which the table does not have"));
            }
            let mut own = Vec::new();
            flaws_of_table(&variant.applied(&self.registers), &mut own);
            for found in own {
                flaw(format!("with firmware [{from}, {to}]: {}", found.message()));
            }
        }
    }
}

/// What is wrong with a whole table, rows ascending.
fn flaws_of_table(table: &[Register], flaws: &mut Vec<Flaw>) {
    for (at, row) in table.iter().enumerate() {
        let end_before = if at == 0 { 0 } else { table[at - 1].end() };
        let mut flaw =
            |message: String| flaws.push(Flaw::at_text(format!("name = \"{}\"", row.name), message));
        flaws_of_place(row, end_before, &mut flaw);
        flaws_of_value(row, &mut flaw);
        flaws_among(row, table, &mut flaw);
    }
}

fn flaws_of_place(row: &Register, end_before: u32, flaw: &mut impl FnMut(String)) {
    let name = &row.name;
    if ![1, 2, 4].contains(&row.size) || row.count == 0 {
        flaw(format!(
            "\"{name}\" must have size 1, 2 or 4 and a count of at least 1, found {} × {}",
            row.size, row.count
        ));
    }
    if u32::from(row.address) < end_before {
        flaw(format!(
            "\"{name}\" at {} overlaps the row before it, which ends at {end_before}",
            row.address
        ));
    }
    if row.end() > 0x1_0000 {
        flaw(format!(
            "\"{name}\" ends at {}, beyond the last address 65535",
            row.end()
        ));
    }
}

fn flaws_of_value(row: &Register, flaw: &mut impl FnMut(String)) {
    let name = &row.name;
    if row.unit.is_some_and(|u| u != Unit::Bits) != row.unit_per_count.is_some() {
        flaw(format!(
            "\"{name}\" must have both unit and unit_per_count, or neither (bits: unit alone)"
        ));
    }
    if row.unit_per_count.is_some_and(|k| !(k.is_finite() && k > 0.0)) {
        flaw(format!("\"{name}\" must have a finite unit_per_count above 0"));
    }
    if let (Some(min), Some(max)) = (row.min, row.max)
        && min > max
    {
        flaw(format!("\"{name}\" has min {min} above max {max}"));
    }
    if row.signed && row.sign_bit.is_some() {
        flaw(format!(
            "\"{name}\" has both signed (two's complement) and sign_bit (sign and magnitude); one is allowed"
        ));
    }
    if let Some(bit) = row.sign_bit
        && !(1..u16::from(row.size) * 8).contains(&bit.into())
    {
        flaw(format!(
            "\"{name}\" must have its sign_bit in 1 to {}, found {bit}",
            u16::from(row.size) * 8 - 1
        ));
    }
}

fn flaws_among(row: &Register, table: &[Register], flaw: &mut impl FnMut(String)) {
    let name = &row.name;
    if table.iter().filter(|r| r.name == row.name).count() > 1 {
        flaw(format!(
            "\"{name}\" occurs more than once; names of registers must differ"
        ));
    }
    if let Some(role) = row.role
        && let Some(other) = table.iter().find(|r| r.role == row.role && r.name != row.name)
    {
        flaw(format!(
            "\"{name}\" has role {role}, and so has \"{}\"; one row may have it",
            other.name
        ));
    }
    let named = [&row.min_register, &row.max_register, &row.magnitude_register];
    for other in named.into_iter().flatten() {
        if !table.iter().any(|r| r.name == *other) {
            flaw(format!(
                "\"{name}\" is bounded by \"{other}\", which the table does not have"
            ));
        }
    }
}
