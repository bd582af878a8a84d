//! Neighbouring bytes of a control table that are read at once, and how far a read may go on behind them.

use super::register::Field;
use device_profiles::{Register, ServoProfile};

/// Longest block that is gathered: Goal Position to Present Position of the X series, and what may be read on.
pub(super) const BLOCK_BYTES_MAX: usize = 48;
/// How many more bytes than wanted are read at most. The lengths of a block tell its answers apart; see [`super::owed`].
const SPARE_MAX: u16 = 15;

/// Neighbouring rows that are read at once.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Block {
    /// First byte.
    pub(super) address: u16,
    /// Bytes that are wanted.
    pub(super) bytes: u16,
    /// So many bytes of the table follow without a gap: a longer read is answered too.
    behind: u16,
    /// So many come before.
    before: u16,
    /// What even a shorter read must hold: first byte, and one past the last.
    core: [u16; 2],
}

impl Block {
    /// From the first row to the end of the last, gaps between them included.
    pub(super) fn spanning(servo: &ServoProfile, rows: &[Field]) -> Self {
        let address = rows.iter().map(|row| row.address).min().unwrap_or_default();
        let end = rows.iter().map(Field::end).max().unwrap_or_default();
        let bytes = end.saturating_sub(address);
        let room = (BLOCK_BYTES_MAX as u16).saturating_sub(bytes).min(SPARE_MAX);
        let behind = (0..room).take_while(|more| is_row(servo, end.saturating_add(*more)));
        let behind = behind.count() as u16;
        let row_at = |less: &u16| {
            let place = address.checked_sub(less + 1);
            place.is_some_and(|place| is_row(servo, place))
        };
        let before = (0..room - behind).take_while(row_at).count() as u16;
        Self {
            address,
            bytes,
            behind,
            before,
            core: [address, end],
        }
    }

    /// Of all that is read only `row` is indispensable.
    pub(super) fn around(mut self, row: Field) -> Self {
        self.core = [row.address, row.end()];
        self
    }

    /// How many bytes may be read for it: as many as are wanted, then more, then fewer.
    pub(super) fn lengths(&self) -> impl Iterator<Item = u16> + use<> {
        let [begin, end] = self.core;
        let more = self.bytes + self.behind + self.before;
        (self.bytes..=more).chain((end - begin..self.bytes).rev())
    }

    /// Where a read of so many bytes begins; more than are wanted go on behind, then begin earlier.
    pub(super) fn address_for(&self, bytes: u16) -> u16 {
        if bytes < self.bytes {
            return self.address.max(self.core[1].saturating_sub(bytes));
        }
        let more = bytes - self.bytes;
        self.address - more.saturating_sub(self.behind).min(self.before)
    }

    /// Blocks without gaps that hold all rows between them: what firmware does with a read across a gap is not
    /// known (servo reference, 3.6).
    pub(super) fn covering(servo: &ServoProfile, rows: &[Field]) -> Vec<Self> {
        let mut rows = rows.to_vec();
        rows.sort_by_key(|row| row.address);
        let mut groups: Vec<Vec<Field>> = Vec::new();
        for row in rows {
            match groups.last_mut() {
                Some(group) if Self::joins(servo, group, row) => group.push(row),
                _ => groups.push(vec![row]),
            }
        }
        groups.iter().map(|group| Self::spanning(servo, group)).collect()
    }

    /// Whether a row can be read together with a group before it.
    fn joins(servo: &ServoProfile, group: &[Field], row: Field) -> bool {
        let begin = group.iter().map(|row| row.address).min().unwrap_or(row.address);
        let end = group.iter().map(Field::end).max().unwrap_or(row.address);
        let whole = usize::from(row.end().saturating_sub(begin)) <= BLOCK_BYTES_MAX;
        whole && is_covered(servo, end, row.address)
    }

    /// Whether it holds all of a row.
    pub(super) fn holds(&self, row: Field) -> bool {
        row.address >= self.address && row.end() <= self.address.saturating_add(self.bytes)
    }
}

/// Whether rows lie from `begin` to before `end` without a gap.
pub(super) fn is_covered(servo: &ServoProfile, begin: u16, end: u16) -> bool {
    (begin..end).all(|address| is_row(servo, address))
}

fn is_row(servo: &ServoProfile, address: u16) -> bool {
    servo
        .register_at(address)
        .is_some_and(|row: &Register| row.count == 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use device_profiles::{Profiles, Role};

    #[test]
    fn blocks_have_no_gaps_and_know_what_follows() {
        let profiles = Profiles::builtin();
        let servo = profiles.servo("xl330-m288").expect("it is built in");
        let row = |role| Field::for_role(servo, role).expect("it has it");
        let covering = |roles: &[Role]| {
            let rows: Vec<Field> = roles.iter().map(|role| row(*role)).collect();
            Block::covering(servo, &rows)
        };
        let position = covering(&[Role::PresentPosition]);
        // From 132: position, velocity and position trajectory, voltage, temperature, backup ready, then a gap.
        assert_eq!((position[0].address, position[0].bytes), (132, 4));
        assert!(position[0].lengths().eq(4..=19));
        assert_eq!(
            [4, 5, 16, 17, 19].map(|bytes| position[0].address_for(bytes)),
            [132, 132, 132, 131, 129]
        );
        let mixed = covering(&[
            Role::PresentTemperature,
            Role::TorqueEnable,
            Role::Led,
            Role::PresentVoltage,
        ]);
        let places: Vec<[u16; 2]> = mixed.iter().map(|block| [block.address, block.bytes]).collect();
        assert_eq!(places, [[64, 2], [144, 3]]);
        assert!(
            position[0].holds(row(Role::PresentPosition)) && !position[0].holds(row(Role::PresentVoltage))
        );
    }
}
