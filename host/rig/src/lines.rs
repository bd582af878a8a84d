//! Who is at serial ports that say nothing: asked where a person wants it, and remembered in the user's folder.
//!
//! A port is known again as a device is: by the serial number of its adapter, else by where that hangs, else by its
//! address. Must not know what is asked: that is in the profiles.

use std::collections::BTreeMap;
use std::path::Path;

use device::clock::Clock;
use device::discovery::{self, Access, Places, Strings};
use device_profiles::{Bus, Profiles};
use serde::{Deserialize, Serialize};

use crate::document::disk::{Disk, RealDisk};
use crate::survey::{Surveyed, survey};

/// The file's name in the user's folder.
const FILE: &str = "lines.toml";
/// The form of the file.
const VERSION: u32 = 1;

#[derive(Debug, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    version: u32,
    /// Key of the profile, by port.
    #[serde(default)]
    lines: BTreeMap<String, String>,
}

/// What was found out.
#[derive(Debug, Default)]
pub(crate) struct Lines {
    known: BTreeMap<String, String>,
}

/// A port that was asked.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Asked {
    /// Its address.
    pub address: String,
    /// Key of the profile whose device answered; none: nobody did. An error in words: it could not be asked.
    pub who: Result<Option<String>, String>,
}

impl Lines {
    /// Those of the user's folder; a file that cannot be read is as good as none.
    pub(crate) fn load(folder: Option<&Path>) -> Self {
        let Some(file) = folder.map(|folder| folder.join(FILE)) else {
            return Self::default();
        };
        match read(&file) {
            Ok(known) => Self { known },
            Err(why) => {
                tracing::warn!(
                    "{}: {why}; serial devices that were found by asking are not known",
                    file.display()
                );
                Self::default()
            }
        }
    }

    /// What was found out about the ports makes them certain.
    pub(crate) fn apply(&self, seen: &mut [Surveyed], profiles: &Profiles) {
        for one in seen.iter_mut().filter(|one| is_asked(one)) {
            if let Some(key) = self.known.get(&port(&one.found))
                && profiles.input(key).is_ok()
            {
                one.matches = vec![key.clone()];
                one.certain = true;
                one.why = None;
            }
        }
    }
}

/// Asks at every serial port of which nothing is known, and remembers in `folder` who answered; who does not answer
/// any more is forgotten.
pub fn ask(profiles: &Profiles, clock: &dyn Clock, folder: Option<&Path>) -> Vec<Asked> {
    let seen = survey(&Places::default(), profiles, &mut Strings::new());
    let mut known = Lines::load(folder).known;
    let mut asked = Vec::new();
    for one in seen.iter().filter(|one| is_asked(one)) {
        let who = discovery::ask(&one.found.address, profiles, clock)
            .map(|profile| profile.map(|profile| profile.key.clone()))
            .map_err(|error| error.to_string());
        match &who {
            Ok(Some(key)) => drop(known.insert(port(&one.found), key.clone())),
            Ok(None) => drop(known.remove(&port(&one.found))),
            // Somebody has it: what was known stays.
            Err(_) => {}
        }
        asked.push(Asked {
            address: one.found.address.clone(),
            who,
        });
    }
    if let Some(file) = folder.map(|folder| folder.join(FILE))
        && let Err(error) = write(&file, known)
    {
        tracing::warn!("{}: {error}; who answered is not remembered", file.display());
    }
    asked
}

/// Whether only asking tells who is there.
fn is_asked(one: &Surveyed) -> bool {
    one.found.bus == Bus::Serial && !one.certain && one.found.access == Access::Allowed
}

fn port(found: &discovery::Found) -> String {
    match (&found.id(), found.serial.as_str(), &found.place) {
        (Some(id), serial, _) if !serial.is_empty() => format!("{id} {serial}"),
        (_, _, Some(place)) => format!("at {place}"),
        _ => found.address.clone(),
    }
}

fn read(file: &Path) -> Result<BTreeMap<String, String>, String> {
    let text = match std::fs::read_to_string(file) {
        Ok(text) => text,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(BTreeMap::new()),
        Err(error) => return Err(error.to_string()),
    };
    let found: File = toml::from_str(&text).map_err(|error| error.to_string())?;
    if found.version == VERSION {
        Ok(found.lines)
    } else {
        Err(format!("expected version {VERSION}, found {}", found.version))
    }
}

fn write(file: &Path, lines: BTreeMap<String, String>) -> std::io::Result<()> {
    let contents = File {
        version: VERSION,
        lines,
    };
    let rows = toml::to_string(&contents).map_err(std::io::Error::other)?;
    let text = format!("# Who answered at serial ports. Written by `dialrig devices --ask`.\n{rows}");
    let folder = file.parent().unwrap_or(Path::new("."));
    let mut disk = RealDisk;
    disk.make_folder(folder)?;
    let aside = disk.write_aside(folder, &text)?;
    disk.rename(&aside, file)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(address: &str, serial: &str, place: Option<&str>) -> Surveyed {
        let mut found = discovery::Found::new(address, Bus::Serial);
        (found.vendor, found.product) = (Some(0x0403), Some(0x6001));
        found.serial = serial.to_owned();
        found.place = place.map(str::to_owned);
        Surveyed {
            found,
            matches: vec!["digitizer-ii".to_owned(), "summasketch".to_owned()],
            certain: false,
            why: Some("asked".to_owned()),
            held: None,
            beside: Vec::new(),
        }
    }

    #[test]
    fn who_answered_is_known_again_by_its_port() {
        let folder = tempfile::tempdir().expect("a folder");
        let profiles = Profiles::builtin();
        let [known, other] = [
            line("/dev/ttyUSB0", "A1", Some("1-1")),
            line("/dev/ttyUSB1", "", Some("1-2")),
        ];
        let row = |one: &Surveyed, key: &str| (port(&one.found), key.to_owned());
        let rows = [row(&known, "digitizer-ii"), row(&other, "no-such-profile")];
        write(&folder.path().join(FILE), rows.into()).expect("room");
        let lines = Lines::load(Some(folder.path()));
        // In another place, under another address.
        let mut seen = [
            line("/dev/ttyUSB7", "A1", Some("3-1")),
            other,
            line("/dev/ttyS0", "", None),
        ];
        lines.apply(&mut seen, &profiles);
        let certain: Vec<_> = seen.iter().map(|one| one.certain).collect();
        assert_eq!(certain, [true, false, false]);
        assert_eq!(seen[0].matches, ["digitizer-ii"]);
    }

    #[test]
    fn a_broken_file_is_as_good_as_none() {
        let folder = tempfile::tempdir().expect("a folder");
        for text in ["version = 7\n", "what = 1", "["] {
            std::fs::write(folder.path().join(FILE), text).expect("room");
            assert!(Lines::load(Some(folder.path())).known.is_empty(), "{text}");
        }
    }
}
