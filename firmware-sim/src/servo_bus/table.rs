//! A control table: the servo's memory, and what each byte of it is.
//!
//! The rows come from the servo's profile; indirect data bytes stand for the bytes their addresses name.
//! EEPROM has a second copy, the one that is still there after power was off: a locked servo obeys a write
//! but does not keep it.

use super::coding;
use super::reg::Reg;
use device_profiles::{Access, Area, Register, Role, ServoProfile, WordOrder};

/// An indirect block: `count` addresses of two bytes, and the data bytes that stand for them.
#[derive(Clone, Copy, Debug)]
struct Indirect {
    addresses: u16,
    data: u16,
    count: u16,
}

/// Marks an address that no row covers.
const NO_ROW: u16 = u16::MAX;

/// Memory with its rows.
#[derive(Clone, Debug)]
pub(super) struct Table {
    rows: Vec<Register>,
    row_at: Vec<u16>,
    known: Vec<Option<u16>>,
    indirect: Vec<Indirect>,
    order: WordOrder,
    memory: Vec<u8>,
    /// What of the memory outlives power; only the bytes of EEPROM rows mean something.
    kept: Vec<u8>,
}

impl Table {
    /// A table with factory values throughout.
    pub(super) fn new(profile: &ServoProfile) -> Self {
        let rows = profile.registers.clone();
        let size = profile.table_bytes();
        let mut row_at = vec![NO_ROW; size];
        for (index, row) in (0..).zip(&rows) {
            let start = usize::from(row.address);
            row_at[start..start + usize::from(row.bytes())].fill(index);
        }
        let known = Reg::places(profile);
        let indirect = rows
            .iter()
            .filter_map(|row| {
                let slots = row.name.strip_prefix("Indirect Address ")?;
                let data = rows
                    .iter()
                    .find(|data| data.name.strip_prefix("Indirect Data ") == Some(slots))?;
                Some(Indirect {
                    addresses: row.address,
                    data: data.address,
                    count: row.count.min(data.count),
                })
            })
            .collect();
        let mut table = Self {
            rows,
            row_at,
            known,
            indirect,
            order: profile.word_order(),
            memory: vec![0; size],
            kept: Vec::new(),
        };
        table.start_values(Area::Eeprom);
        table.start_values(Area::Ram);
        table.keep();
        table
    }

    /// Puts every register of `area` to its documented start value, zero where there is none.
    pub(super) fn start_values(&mut self, area: Area) {
        for row in self.rows.iter().filter(|row| row.area == area) {
            let (size, init) = (usize::from(row.size), row.init.unwrap_or(0));
            for slot in 0..row.count {
                let at = usize::from(row.address) + usize::from(slot) * size;
                let value = init + i64::from(slot) * row.init_step;
                coding::store(self.order, row, value, &mut self.memory[at..at + size]);
            }
        }
    }

    /// What power-up finds: EEPROM as it was kept, RAM as the document says.
    pub(super) fn wake(&mut self) {
        for row in self.rows.iter().filter(|row| row.area == Area::Eeprom) {
            let bytes = span(row);
            self.memory[bytes.clone()].copy_from_slice(&self.kept[bytes]);
        }
        self.start_values(Area::Ram);
    }

    /// Everything in EEPROM outlives power from here on.
    pub(super) fn keep(&mut self) {
        self.kept.clone_from(&self.memory);
    }

    /// What `reg` holds now outlives power from here on.
    pub(super) fn keep_register(&mut self, reg: Reg) {
        if let Some(bytes) = self.row(reg).map(span) {
            self.kept[bytes.clone()].copy_from_slice(&self.memory[bytes]);
        }
    }

    /// The same for the row that covers `address`.
    pub(super) fn keep_at(&mut self, address: u16) {
        if let Some(bytes) = self.row_covering(address).map(span) {
            self.kept[bytes.clone()].copy_from_slice(&self.memory[bytes]);
        }
    }

    /// Puts `bytes` where a row's value, or a part of it, is. `keeps`: so that they outlive power.
    pub(super) fn put(&mut self, address: u16, bytes: &[u8], keeps: bool) {
        let at = usize::from(address)..usize::from(address) + bytes.len();
        self.memory[at.clone()].copy_from_slice(bytes);
        if keeps {
            self.kept[at].copy_from_slice(bytes);
        }
    }

    /// Bytes from the table's start to the end of its EEPROM.
    pub(super) fn eeprom_bytes(&self) -> usize {
        let ends = self.rows.iter().filter(|row| row.area == Area::Eeprom);
        ends.map(|row| usize::from(row.address + row.bytes()))
            .max()
            .unwrap_or(0)
    }

    pub(super) fn memory(&self) -> &[u8] {
        &self.memory
    }

    /// What outlives power, from address 0 to the end of the EEPROM.
    pub(super) fn kept(&self) -> &[u8] {
        &self.kept[..self.eeprom_bytes()]
    }

    /// Puts back what `kept` gave; it takes effect at the next `wake`.
    pub(super) fn restore(&mut self, bytes: &[u8]) {
        self.kept[..bytes.len()].copy_from_slice(bytes);
    }

    pub(super) fn row(&self, reg: Reg) -> Option<&Register> {
        self.known[reg as usize].map(|row| &self.rows[usize::from(row)])
    }

    pub(super) fn row_named(&self, name: &str) -> Option<&Register> {
        self.rows.iter().find(|row| row.name == name)
    }

    pub(super) fn row_of(&self, role: Role) -> Option<&Register> {
        self.rows.iter().find(|row| row.role == Some(role))
    }

    /// Which register the firmware knows covers `address`.
    pub(super) fn known_at(&self, address: u16) -> Option<Reg> {
        let row = *self.row_at.get(usize::from(address))?;
        Reg::of_row(&self.known, row)
    }

    /// The value of `reg`; zero where the model lacks it.
    pub(super) fn get(&self, reg: Reg) -> i64 {
        self.row(reg).map_or(0, |row| self.value(row))
    }

    /// Stores `value` cut to the register's size; nothing where the model lacks it.
    pub(super) fn set(&mut self, reg: Reg, value: i64) {
        if let Some(row) = self.known[reg as usize] {
            self.set_row(row, value);
        }
    }

    /// Stores `value` in the row that covers `address`.
    pub(super) fn set_at(&mut self, address: u16, value: i64) {
        if let Some(&row) = self.row_at.get(usize::from(address)) {
            self.set_row(row, value);
        }
    }

    fn set_row(&mut self, row: u16, value: i64) {
        let Some(row) = self.rows.get(usize::from(row)) else {
            return;
        };
        let at = usize::from(row.address);
        let bytes = &mut self.memory[at..at + usize::from(row.size)];
        coding::store(self.order, row, value, bytes);
    }

    /// The first value of `row`.
    pub(super) fn value(&self, row: &Register) -> i64 {
        let at = usize::from(row.address);
        self.decode(row, &self.memory[at..at + usize::from(row.size)])
    }

    /// What `bytes` mean in `row`.
    pub(super) fn decode(&self, row: &Register, bytes: &[u8]) -> i64 {
        coding::load(self.order, row, bytes)
    }

    /// The row that covers `address`.
    pub(super) fn row_covering(&self, address: u16) -> Option<&Register> {
        self.rows
            .get(usize::from(*self.row_at.get(usize::from(address))?))
    }

    /// Where a byte really lives: indirect data bytes stand for the byte at their address.
    pub(super) fn resolve(&self, address: u16) -> u16 {
        let block = self
            .indirect
            .iter()
            .find(|block| (block.data..block.data + block.count).contains(&address));
        block.map_or(address, |block| {
            let at = usize::from(block.addresses + 2 * (address - block.data));
            let target = u16::from_le_bytes([self.memory[at], self.memory[at + 1]]);
            if usize::from(target) < self.memory.len() {
                target
            } else {
                address
            }
        })
    }

    pub(super) fn byte(&self, address: u16) -> u8 {
        self.memory
            .get(usize::from(self.resolve(address)))
            .copied()
            .unwrap_or(0)
    }

    /// Whether a host may write `row` at all.
    pub(super) fn is_writable(row: &Register) -> bool {
        row.access == Access::Rw
    }
}

/// The bytes of `row`.
fn span(row: &Register) -> std::ops::Range<usize> {
    let start = usize::from(row.address);
    start..start + usize::from(row.bytes())
}
