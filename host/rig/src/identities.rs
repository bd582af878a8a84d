//! Which of several equal input devices is which: remembered in the user's folder, so that a knob box has the same job
//! after it was plugged out and in.
//!
//! A device is known again by its serial number; where it has none, or two have the same, by the port it hangs in. One
//! without a serial number that comes in another port takes the place of one that is away. Must not know what any
//! place is for.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::document::disk::{Disk, RealDisk};

/// The file's name in the user's folder.
pub(crate) const FILE: &str = "devices.toml";
/// The form of the file.
const VERSION: u32 = 1;

/// One device as it is now.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Unit {
    /// Key of its profile.
    pub(crate) profile: String,
    /// Its serial number; empty where it has none.
    pub(crate) serial: String,
    /// The port it hangs in, where that is known.
    pub(crate) place: Option<String>,
}

/// One device that was here once.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Row {
    profile: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    serial: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    place: Option<String>,
    /// Which of the equal ones, from 1.
    slot: u16,
    /// Nobody else takes its place.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pinned: bool,
}

#[derive(Debug, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    version: u32,
    #[serde(default, rename = "device", skip_serializing_if = "Vec::is_empty")]
    rows: Vec<Row>,
}

/// All places, and the file they are kept in.
#[derive(Debug, Default)]
pub(crate) struct Identities {
    file: Option<PathBuf>,
    rows: Vec<Row>,
}

impl Identities {
    /// Those of the user's folder. A file that cannot be read is left alone, and nothing is remembered beyond the
    /// program's end.
    pub(crate) fn load(folder: Option<&Path>) -> Self {
        let Some(file) = folder.map(|folder| folder.join(FILE)) else {
            return Self::default();
        };
        let text = match std::fs::read_to_string(&file) {
            Ok(text) => text,
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
                return Self {
                    file: Some(file),
                    rows: Vec::new(),
                };
            }
            Err(error) => {
                tracing::warn!(
                    "{}: {error}; which device is which is not remembered",
                    file.display()
                );
                return Self::default();
            }
        };
        match toml::from_str::<File>(&text) {
            Ok(read) if read.version == VERSION => Self {
                file: Some(file),
                rows: read.rows,
            },
            Ok(read) => {
                let found = read.version;
                tracing::warn!(
                    "{}: expected version {VERSION}, found {found}; which device is which is not remembered",
                    file.display()
                );
                Self::default()
            }
            Err(error) => {
                tracing::warn!(
                    "{}: {error}; which device is which is not remembered",
                    file.display()
                );
                Self::default()
            }
        }
    }

    /// The place of each unit among the equal ones, from 1, in the order given. All that are there must be given.
    pub(crate) fn assign(&mut self, units: &[Unit]) -> Vec<u16> {
        let before = self.rows.clone();
        let mut taken = BTreeSet::new();
        let known: Vec<Option<usize>> = units
            .iter()
            .map(|unit| {
                let row = self.row_of(unit, has_twin(unit, units))?;
                taken.insert(row).then_some(row)
            })
            .collect();
        let rows: Vec<usize> = units
            .iter()
            .zip(known)
            .map(|(unit, known)| known.unwrap_or_else(|| self.seat(unit, has_twin(unit, units), &mut taken)))
            .collect();
        for (unit, &row) in units.iter().zip(&rows) {
            self.rows[row].place.clone_from(&unit.place);
        }
        if self.rows != before {
            self.save();
        }
        rows.into_iter().map(|row| self.rows[row].slot).collect()
    }

    /// The row a unit is known by.
    fn row_of(&self, unit: &Unit, twin: bool) -> Option<usize> {
        let by_serial = !unit.serial.is_empty() && !twin;
        self.rows.iter().position(|row| {
            row.profile == unit.profile
                && if by_serial {
                    row.serial.as_deref() == Some(&unit.serial)
                } else {
                    let serial = row.serial.as_deref().unwrap_or(&unit.serial);
                    serial == unit.serial && row.place.is_some() && row.place == unit.place
                }
        })
    }

    /// A row for a unit that is not known: that of one that is away, or a new one.
    fn seat(&mut self, unit: &Unit, twin: bool, taken: &mut BTreeSet<usize>) -> usize {
        let serial = (!unit.serial.is_empty() && !twin).then(|| unit.serial.clone());
        let mut away: Vec<usize> = (0..self.rows.len())
            .filter(|row| !taken.contains(row))
            .filter(|&row| {
                let row = &self.rows[row];
                row.profile == unit.profile && row.serial.is_none() && serial.is_none() && !row.pinned
            })
            .collect();
        away.sort_by_key(|&row| self.rows[row].slot);
        let row = if let Some(&row) = away.first() {
            row
        } else {
            self.rows.push(Row {
                profile: unit.profile.clone(),
                serial,
                place: unit.place.clone(),
                slot: self.free_slot(&unit.profile),
                pinned: false,
            });
            self.rows.len() - 1
        };
        taken.insert(row);
        row
    }

    fn free_slot(&self, profile: &str) -> u16 {
        let used: BTreeSet<u16> = self
            .rows
            .iter()
            .filter(|row| row.profile == profile)
            .map(|row| row.slot)
            .collect();
        (1..u16::MAX)
            .find(|slot| !used.contains(slot))
            .unwrap_or(u16::MAX)
    }

    /// By what a unit is known again, now and after a restart: its profile and serial number, or which of those of its
    /// profile it was that came first. Unlike its place it does not change hands.
    pub(crate) fn identity(&self, unit: &Unit) -> Option<String> {
        let at = self.row_of(unit, false).or_else(|| self.row_of(unit, true))?;
        let row = &self.rows[at];
        if let Some(serial) = &row.serial {
            return Some(format!("{} {serial}", row.profile));
        }
        // Rows are never taken out, so the count of those before one stays.
        let before = self.rows[..at].iter();
        let nth = before.filter(|other| other.profile == row.profile).count() + 1;
        Some(format!("{} no. {nth}", row.profile))
    }

    /// Gives a unit a place for good; whoever had it takes this one's. None: it may be found by itself again.
    pub(crate) fn pin(&mut self, unit: &Unit, slot: Option<u16>) -> Result<(), String> {
        let row = self
            .row_of(unit, false)
            .or_else(|| self.row_of(unit, true))
            .ok_or_else(|| format!("{} has no place yet", unit.profile))?;
        self.rows[row].pinned = slot.is_some();
        if let Some(slot) = slot {
            if slot == 0 {
                return Err("places count from 1".to_owned());
            }
            let before = std::mem::replace(&mut self.rows[row].slot, slot);
            let others = self.rows.iter_mut().enumerate();
            for (_, other) in others.filter(|(place, other)| *place != row && other.profile == unit.profile) {
                if other.slot == slot {
                    other.slot = before;
                }
            }
        }
        self.save();
        Ok(())
    }

    /// Writes the file; a failure is said once each time, and the rig goes on.
    fn save(&self) {
        let Some(file) = &self.file else { return };
        let contents = File {
            version: VERSION,
            rows: self.rows.clone(),
        };
        if let Err(error) = write(file, &contents) {
            tracing::warn!(
                "{}: {error}; which device is which is not remembered",
                file.display()
            );
        }
    }
}

/// Whether another device of the kind has the same serial number, as cheap ones do.
fn has_twin(unit: &Unit, units: &[Unit]) -> bool {
    let same = |other: &&Unit| other.profile == unit.profile && other.serial == unit.serial;
    units.iter().filter(same).count() > 1
}

fn write(file: &Path, contents: &File) -> std::io::Result<()> {
    let rows = toml::to_string(contents).map_err(std::io::Error::other)?;
    let text = format!("# Which of several equal input devices is which. Written by dialrig.\n{rows}");
    let folder = file.parent().unwrap_or(Path::new("."));
    let mut disk = RealDisk;
    disk.make_folder(folder)?;
    let aside = disk.write_aside(folder, &text)?;
    disk.rename(&aside, file)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unit(serial: &str, place: &str) -> Unit {
        Unit {
            profile: "knob".to_owned(),
            serial: serial.to_owned(),
            place: Some(place.to_owned()),
        }
    }

    #[test]
    fn a_serial_number_is_known_again_in_any_port() {
        let mut all = Identities::default();
        assert_eq!(all.assign(&[unit("A", "1-1"), unit("B", "1-2")]), [1, 2]);
        assert_eq!(all.assign(&[unit("B", "1-1")]), [2]);
        assert_eq!(all.assign(&[unit("B", "1-1"), unit("A", "1-9")]), [2, 1]);
        assert_eq!(
            all.assign(&[unit("C", "1-1")]),
            [3],
            "another one takes nobody's place"
        );
    }

    #[test]
    fn without_one_the_port_tells_and_a_moved_one_takes_the_place_that_is_free() {
        let mut all = Identities::default();
        assert_eq!(all.assign(&[unit("", "1-1"), unit("", "1-2")]), [1, 2]);
        assert_eq!(all.assign(&[unit("", "1-2")]), [2]);
        assert_eq!(all.assign(&[unit("", "1-2"), unit("", "1-7")]), [2, 1]);
        assert_eq!(all.assign(&[unit("", "1-7")]), [1]);
        all.pin(&unit("", "1-7"), Some(1)).expect("it is known");
        assert_eq!(
            all.assign(&[unit("", "1-8")]),
            [2],
            "a place that is pinned stays free"
        );
    }

    #[test]
    fn ten_equal_ones_with_one_serial_number_are_told_apart_by_their_ports() {
        let mut all = Identities::default();
        let ten: Vec<Unit> = (0..10).map(|n| unit("000000", &format!("1-{n}"))).collect();
        let slots = all.assign(&ten);
        assert_eq!(slots, (1..=10).collect::<Vec<u16>>());
        // The first alone was known by its number; its place stays when the second comes.
        let mut two = Identities::default();
        assert_eq!(two.assign(&ten[..1]), [1]);
        assert_eq!(two.assign(&ten[..2]), [1, 2]);
        let backwards: Vec<Unit> = ten.iter().rev().cloned().collect();
        assert_eq!(all.assign(&backwards), (1..=10).rev().collect::<Vec<u16>>());
    }

    #[test]
    fn pinning_exchanges_places() {
        let mut all = Identities::default();
        let two = [unit("A", "1-1"), unit("B", "1-2")];
        all.assign(&two);
        all.pin(&two[1], Some(1)).expect("it is known");
        assert_eq!(all.assign(&two), [2, 1]);
        let identities = two.each_ref().map(|it| all.identity(it));
        assert_eq!(identities, [Some("knob A".to_owned()), Some("knob B".to_owned())]);
        assert!(all.pin(&unit("C", "1-3"), Some(1)).is_err());
        assert!(all.pin(&two[0], Some(0)).is_err());
    }

    #[test]
    fn what_a_device_is_known_by_stays_with_it() {
        let mut all = Identities::default();
        let two = [unit("", "1-1"), unit("", "1-2")];
        all.assign(&two);
        let known = |all: &Identities, it: &Unit| all.identity(it).expect("it has a place");
        let before = two.each_ref().map(|it| known(&all, it));
        assert_ne!(before[0], before[1]);
        all.pin(&two[1], Some(1)).expect("it is known");
        all.assign(&two);
        assert_eq!(
            two.each_ref().map(|it| known(&all, it)),
            before,
            "places changed, devices did not"
        );
        assert_eq!(all.identity(&unit("C", "1-3")), None);
    }

    #[test]
    fn the_file_is_read_back_and_a_broken_one_is_left_alone() {
        let folder = tempfile::tempdir().expect("a folder");
        let two = [unit("A", "1-1"), unit("", "1-2")];
        Identities::load(Some(folder.path())).assign(&two);
        let backwards = [two[1].clone(), two[0].clone()];
        assert_eq!(Identities::load(Some(folder.path())).assign(&backwards), [2, 1]);
        let file = folder.path().join(FILE);
        std::fs::write(&file, "version = 1\n[[device]]\nwhat = 1\n").expect("room");
        assert_eq!(Identities::load(Some(folder.path())).assign(&two), [1, 2]);
        let text = std::fs::read_to_string(&file).expect("it is there");
        assert!(text.contains("what = 1"), "a person may want it back");
    }
}
