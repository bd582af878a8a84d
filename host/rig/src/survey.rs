//! What is plugged in and which profiles it fits, looked at again and again by a thread of its own: asking a tablet for
//! a string may take it half a second, and the rig must not wait that long.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use device::clock::Clock;
use device::discovery::{self, Access, Places, Strings, Verdict};
use device::transport::ports;
use device_profiles::{Bus, Profiles};

use crate::ports::Held;

/// Between two looks. With as long a pause between two listings of the rig a device is taken within a second.
const LOOK_AGAIN: Duration = Duration::from_millis(400);

/// One thing that is there.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Surveyed {
    /// As the system tells of it.
    pub(crate) found: discovery::Found,
    /// Keys of profiles that fit, or of those that may.
    pub(crate) matches: Vec<String>,
    /// Whether it is known for certain: the one profile, or its own description.
    pub(crate) certain: bool,
    /// Why it is not.
    pub(crate) why: Option<String>,
    /// Who has it already.
    pub(crate) held: Option<Held>,
    /// Addresses of the device's other interfaces that belong to the same profile.
    pub(crate) beside: Vec<String>,
}

/// Looks once.
pub(crate) fn survey(places: &Places, profiles: &Profiles, strings: &mut Strings) -> Vec<Surveyed> {
    let found = discovery::list(places);
    strings.keep(&found);
    let surveyed = found.into_iter().map(|found| {
        let verdict = discovery::judge(&found, profiles, &mut |index| strings.get(&found, index));
        let (matches, certain, why) = told(verdict);
        let held = discovery::holder(&found, places).map(|holder| Held {
            driver: holder.name,
            remedy: holder.remedy,
        });
        Surveyed {
            found,
            matches,
            certain,
            why,
            held,
            beside: Vec::new(),
        }
    });
    // Of devices without a node only those concern anybody that a profile knows.
    let concerns = |one: &Surveyed| one.found.access != Access::Nodeless || !one.matches.is_empty();
    joined(surveyed.filter(concerns).collect())
}

/// Keys that fit, whether that is certain, why not.
fn told(verdict: Verdict<'_>) -> (Vec<String>, bool, Option<String>) {
    let keys = |profiles: &[&device_profiles::InputProfile]| {
        profiles
            .iter()
            .map(|profile| profile.key.clone())
            .collect::<Vec<_>>()
    };
    match verdict {
        Verdict::One(profile) => (vec![profile.key.clone()], true, None),
        Verdict::Several(all) => {
            let why = "these fit equally well; name the one it is in the show".to_owned();
            (keys(&all), false, Some(why))
        }
        Verdict::Generic([page, usage]) => {
            let why =
                format!("no profile knows it; used by its own description (usage {page:02x}/{usage:02x})");
            (Vec::new(), true, Some(why))
        }
        Verdict::Line(all) => {
            let why = "a serial line does not say what hangs on it; name the device's profile and this address, or have it asked \
                 with `dialrig devices --ask`";
            (keys(&all), false, Some(why.to_owned()))
        }
        Verdict::Nobody(why) => (Vec::new(), false, Some(why)),
    }
}

/// A device's interfaces of one profile are one device: the first stands for all.
fn joined(all: Vec<Surveyed>) -> Vec<Surveyed> {
    let mut first: BTreeMap<(String, String), usize> = BTreeMap::new();
    let mut kept: Vec<Surveyed> = Vec::new();
    let mut sorted = all;
    sorted.sort_by(|a, b| (a.found.interface, &a.found.address).cmp(&(b.found.interface, &b.found.address)));
    for one in sorted {
        let key = match (&one.found.place, one.matches.as_slice()) {
            (Some(place), [profile]) if one.certain && one.found.bus == Bus::Usb => {
                (place.clone(), profile.clone())
            }
            _ => {
                kept.push(one);
                continue;
            }
        };
        if let Some(&place) = first.get(&key) {
            kept[place].beside.push(one.found.address);
        } else {
            first.insert(key, kept.len());
            kept.push(one);
        }
    }
    kept.sort_by(|a, b| a.found.address.cmp(&b.found.address));
    kept
}

/// What has to be done before it may be opened, if anything.
pub(crate) fn allowed(found: &discovery::Found) -> Result<(), String> {
    match (found.access, found.bus) {
        (Access::Allowed, _) => Ok(()),
        (Access::NotYet, _) => Err("its node is not there yet; the system is still making it".to_owned()),
        (Access::Nodeless, _) => Err(discovery::nodeless_remedy(found)),
        (Access::Forbidden, Bus::Midi) => Err(device::transport::midi_raw::MIDI_HINT.to_owned()),
        (Access::Forbidden, Bus::Serial) => Err(ports::PERMISSION_HINT.to_owned()),
        (Access::Forbidden, _) => Err(device::transport::hid::HID_HINT.to_owned()),
    }
}

/// A thread that looks again and again.
pub(crate) struct Lookout {
    shared: Arc<Shared>,
}

#[derive(Default)]
struct Shared {
    latest: Mutex<Vec<Surveyed>>,
    stop: AtomicBool,
}

impl Lookout {
    /// Begins. The first look is over when this returns.
    pub(crate) fn start(
        places: Places,
        profiles: Arc<Profiles>,
        clock: Arc<dyn Clock>,
    ) -> std::io::Result<Self> {
        let mut strings = Strings::new();
        let shared = Arc::new(Shared::default());
        *lock(&shared) = survey(&places, &profiles, &mut strings);
        let theirs = Arc::clone(&shared);
        std::thread::Builder::new()
            .name("lookout".to_owned())
            .spawn(move || {
                while !theirs.stop.load(Ordering::Relaxed) {
                    clock.sleep_until(clock.now().after(LOOK_AGAIN));
                    let seen = survey(&places, &profiles, &mut strings);
                    *lock(&theirs) = seen;
                }
            })?;
        Ok(Self { shared })
    }

    /// What was seen last.
    pub(crate) fn latest(&self) -> Vec<Surveyed> {
        lock(&self.shared).clone()
    }
}

impl Drop for Lookout {
    fn drop(&mut self) {
        self.shared.stop.store(true, Ordering::Relaxed);
    }
}

fn lock(shared: &Shared) -> MutexGuard<'_, Vec<Surveyed>> {
    // A panic elsewhere leaves a whole list.
    shared.latest.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn one(address: &str, place: &str, interface: u8, profile: &str) -> Surveyed {
        let mut found = discovery::Found::new(address, Bus::Usb);
        found.place = Some(place.to_owned());
        found.interface = Some(interface);
        Surveyed {
            found,
            matches: vec![profile.to_owned()],
            certain: true,
            why: None,
            held: None,
            beside: Vec::new(),
        }
    }

    #[test]
    fn interfaces_of_one_device_are_one_and_equal_devices_are_two() {
        let all = joined(vec![
            one("/dev/hidraw0", "1-2", 1, "cth-470"),
            one("/dev/hidraw1", "1-2", 0, "cth-470"),
            one("/dev/hidraw2", "1-3", 0, "cth-470"),
            one("/dev/hidraw3", "1-3", 1, "other"),
        ]);
        let told: Vec<_> = all
            .iter()
            .map(|one| (one.found.address.as_str(), one.beside.len()))
            .collect();
        assert_eq!(
            told,
            [("/dev/hidraw1", 1), ("/dev/hidraw2", 0), ("/dev/hidraw3", 0)]
        );
        assert_eq!(all[0].beside, ["/dev/hidraw0"]);
    }
}
