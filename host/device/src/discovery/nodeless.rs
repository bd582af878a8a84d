//! USB devices with HID interfaces that the kernel gives no node to: a driver of another kind has them, HID leaves them
//! alone, or the module of the one driver that may have them is missing.
//!
//! Source: Linux `drivers/hid/hid-quirks.c` (`hid_ignore_list`, `hid_have_special_driver`), `drivers/hid/hid-generic.c`
//! (`hid_generic_match`), `drivers/input/misc/powermate.c`; all of it seen on a real kernel, `docs/kernel-tier.md`.

use super::{Access, Found, Places, sysfs};
use device_profiles::Bus;
use std::path::Path;

/// Where the kernel's module options go that `--install-rules` writes.
pub const MODPROBE_FILE: &str = "/etc/modprobe.d/dialrig.conf";

/// Class of HID interfaces (USB, "Defined Class Codes").
const HID_CLASS: &str = "03";
/// The driver that hands an interface to the kernel's HID.
const USB_HID: &str = "usbhid";
/// A device that came less long ago may still get its node, milliseconds.
const SETTLES_IN_MS: u64 = 2000;
/// Devices that HID leaves to the driver `powermate`: Griffin's PowerMate and SoundKnob.
const LEFT_TO_POWERMATE: [[u16; 2]; 2] = [[0x077D, 0x0410], [0x077D, 0x04AA]];
/// The bit by which `usbhid` takes such a device all the same (`HID_QUIRK_NO_IGNORE`, `include/linux/hid.h`).
const NO_IGNORE: u32 = 0x4000_0000;
/// Modules that alone may have some HID devices of a vendor.
const MODULES: [(u16, &str); 1] = [(0x046D, "hid-logitech")];

/// Devices of which none of `nodes` is a part. Most are nobody's affair: it is for the profiles to say which are.
pub(super) fn devices(places: &Places, nodes: &[Found]) -> Vec<Found> {
    let folder = places.sys.join("bus/usb/devices");
    let Ok(entries) = std::fs::read_dir(&folder) else {
        return Vec::new();
    };
    let mut names: Vec<_> = entries
        .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
        .collect();
    names.sort();
    let mut found: Vec<Found> = Vec::new();
    for name in names {
        // An interface is called as its device, its configuration and its number: `1-2:1.0`.
        let Some((place, _)) = name.split_once(':') else {
            continue;
        };
        let known = |other: &Found| other.place.as_deref() == Some(place);
        if nodes.iter().chain(&found).any(known) {
            continue;
        }
        found.extend(interface(&folder, &name, place));
    }
    found
}

/// A HID interface without a node, unless it may still get one.
fn interface(folder: &Path, name: &str, place: &str) -> Option<Found> {
    let interface = folder.join(name);
    let device = folder.join(place);
    if sysfs::text(&interface.join("bInterfaceClass"))? != HID_CLASS {
        return None;
    }
    let there_for_ms =
        sysfs::text(&device.join("power/connected_duration")).and_then(|ms| ms.parse::<u64>().ok());
    if there_for_ms.is_some_and(|ms| ms < SETTLES_IN_MS) {
        return None;
    }
    let mut found = Found::new(interface.to_str()?, Bus::Usb);
    sysfs::above(&std::fs::canonicalize(&interface).ok()?, &mut found);
    found.access = Access::Nodeless;
    found.driver = sysfs::link_name(&interface.join("driver"));
    if found.driver.as_deref() == Some(USB_HID) && has_hid_driver(&interface) {
        // A node is on its way, or this kernel makes none for anything.
        return None;
    }
    Some(found)
}

/// Whether the HID device below an interface has a driver: its folder is called `0003:046D:C626.0001`.
fn has_hid_driver(interface: &Path) -> bool {
    let Ok(entries) = std::fs::read_dir(interface) else {
        return false;
    };
    entries.filter_map(Result::ok).any(|entry| {
        let name = entry.file_name();
        let is_hid = name.to_str().is_some_and(|name| name.matches(':').count() == 2);
        is_hid && entry.path().join("driver").exists()
    })
}

/// Who keeps a device from having a node, and what to do about it. Only of what is [`Access::Nodeless`].
pub fn remedy(found: &Found) -> String {
    let ids = [found.vendor.unwrap_or(0), found.product.unwrap_or(0)];
    let holder = found.driver.as_deref();
    if LEFT_TO_POWERMATE.contains(&ids) {
        let has = holder.map_or("leaves it alone".to_owned(), |driver| {
            format!("leaves it to its driver {driver}, which makes a mouse wheel of it")
        });
        return format!(
            "it has no node: the kernel's HID {has}; `sudo dialrig devices --install-rules` writes {MODPROBE_FILE} with \
             \"{}\", then start the machine anew",
            quirks()
        );
    }
    match holder {
        Some(USB_HID) => {
            let module = MODULES.iter().find(|(vendor, _)| *vendor == ids[0]);
            let named = module.map_or_else(String::new, |(_, name)| format!(" {name}"));
            let wanted = module.map_or_else(
                || format!("hid:b0003g0001v{:08X}p{:08X}", ids[0], ids[1]),
                |(_, name)| (*name).to_owned(),
            );
            format!(
                "it has no node: the kernel keeps it for a module{named} of its own, which is not loaded; as root: \
                 `modprobe {wanted}` (on some systems in a package of further modules, such as linux-modules-extra)"
            )
        }
        Some(driver) => format!(
            "it has no node: the kernel's driver {driver} has it; as root: `rmmod {driver}`, then plug it out and in"
        ),
        None => format!(
            "it has no node: no driver of the kernel has taken it; as root: `modprobe {USB_HID}`, then plug it out and in"
        ),
    }
}

/// The option of `usbhid` that makes it take what HID leaves alone.
fn quirks() -> String {
    let each =
        LEFT_TO_POWERMATE.map(|[vendor, product]| format!("{vendor:#06x}:{product:#06x}:{NO_IGNORE:#x}"));
    format!("options {USB_HID} quirks={}", each.join(","))
}

/// The text of [`MODPROBE_FILE`].
pub fn module_options() -> String {
    format!(
        "# Input devices that dialrig knows and the kernel's HID leaves alone: Griffin's PowerMate and SoundKnob.\n\
         # Written by `dialrig devices --install-rules`; written anew, changes are lost. In force when usbhid is loaded\n\
         # the next time. If you give usbhid other quirks elsewhere, put all of them into one line.\n\
         {}\n\
         blacklist powermate\n",
        quirks()
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::discovery::{Verdict, holder, judge, list};
    use device_profiles::Profiles;
    use std::fs;
    use std::os::unix::fs::symlink;

    /// A kernel's folders with one USB device that has one interface.
    struct Machine(tempfile::TempDir);

    impl Machine {
        /// `driver` has the interface; where that is `usbhid`, `hid_driver` has the HID device below it.
        fn with(ids: [u16; 2], class: &str, driver: Option<&str>, hid_driver: Option<&str>) -> Self {
            let root = tempfile::tempdir().expect("a folder");
            let sys = root.path().join("sys");
            let device = sys.join("devices/usb1/1-2");
            let interface = device.join("1-2:1.0");
            let hid = interface.join(format!("0003:{:04X}:{:04X}.0001", ids[0], ids[1]));
            let below = if driver == Some(USB_HID) { &hid } else { &interface };
            fs::create_dir_all(below).expect("room");
            for folder in ["dev", "proc", "sys/class/tty", "sys/bus/usb/devices"] {
                fs::create_dir_all(root.path().join(folder)).expect("room");
            }
            let [vendor, product] = ids.map(|id| format!("{id:04x}\n"));
            for (file, text) in [
                ("idVendor", vendor.as_str()),
                ("idProduct", &product),
                ("busnum", "1\n"),
                ("devnum", "7\n"),
                ("1-2:1.0/bInterfaceNumber", "00\n"),
                ("1-2:1.0/bInterfaceClass", class),
            ] {
                fs::write(device.join(file), text).expect("room");
            }
            let has = |holder: Option<&str>, whom: &Path| {
                let Some(holder) = holder else { return };
                let folder = sys.join("drivers").join(holder);
                fs::create_dir_all(&folder).expect("room");
                symlink(folder, whom.join("driver")).expect("a link");
            };
            has(driver, &interface);
            has(hid_driver, &hid);
            for (name, place) in [("1-2", &device), ("1-2:1.0", &interface)] {
                symlink(place, sys.join("bus/usb/devices").join(name)).expect("a link");
            }
            Self(root)
        }

        fn places(&self) -> Places {
            Places {
                sys: self.0.path().join("sys"),
                dev: self.0.path().join("dev"),
                proc: self.0.path().join("proc"),
            }
        }

        fn found(&self) -> Vec<Found> {
            let mut all = list(&self.places());
            all.retain(|found| found.access == Access::Nodeless);
            all
        }
    }

    const KNOB: [u16; 2] = [0x077D, 0x0410];
    const CAP: [u16; 2] = [0x046D, 0xC626];
    const TABLET: [u16; 2] = [0x256C, 0x006D];

    #[test]
    fn whoever_keeps_a_device_from_its_node_is_named_with_what_to_do() {
        let rows: [([u16; 2], Option<&str>, &[&str]); 6] = [
            (
                KNOB,
                Some("powermate"),
                &["driver powermate", "0x077d:0x0410:0x40000000", MODPROBE_FILE],
            ),
            (KNOB, None, &["leaves it alone", "--install-rules"]),
            (CAP, Some(USB_HID), &["modprobe hid-logitech"]),
            (
                TABLET,
                Some(USB_HID),
                &["modprobe hid:b0003g0001v0000256Cp0000006D"],
            ),
            (TABLET, Some("other"), &["rmmod other"]),
            (TABLET, None, &["modprobe usbhid"]),
        ];
        for (ids, driver, words) in rows {
            let machine = Machine::with(ids, "03\n", driver, None);
            let [found] = &machine.found()[..] else {
                panic!(
                    "{ids:x?} with {driver:?} is to be found once: {:?}",
                    machine.found()
                );
            };
            assert_eq!(
                (found.place.as_deref(), found.vendor),
                (Some("1-2"), Some(ids[0]))
            );
            let said = remedy(found);
            for word in words {
                assert!(said.contains(word), "{word}: {said}");
            }
            let held = holder(found, &machine.places()).map(|holder| holder.name);
            assert_eq!(held.as_deref(), driver.filter(|driver| *driver != USB_HID));
        }
    }

    #[test]
    fn what_it_is_is_judged_by_ids_alone() {
        let profiles = Profiles::builtin();
        let mut asked = |_| -> Result<String, String> { panic!("a device without a node is not asked") };
        let machine = Machine::with(KNOB, "03\n", Some("powermate"), None);
        match judge(&machine.found()[0], &profiles, &mut asked) {
            Verdict::One(profile) => assert_eq!(profile.key, "powermate"),
            other => panic!("{other:?}"),
        }
        let machine = Machine::with(TABLET, "03\n", None, None);
        match judge(&machine.found()[0], &profiles, &mut asked) {
            Verdict::Several(all) => assert!(all.iter().any(|profile| profile.key == "hs610")),
            other => panic!("{other:?}"),
        }
        let machine = Machine::with([0x1209, 1], "03\n", None, None);
        assert!(matches!(
            judge(&machine.found()[0], &profiles, &mut asked),
            Verdict::Nobody(_)
        ));
    }

    #[test]
    fn what_gets_a_node_or_is_no_hid_device_is_left_out() {
        let class = |class| Machine::with(KNOB, class, None, None).found().len();
        assert_eq!((class("08\n"), class("03\n")), (0, 1));
        // A driver has the HID device: the node is on its way.
        let coming = Machine::with(CAP, "03\n", Some(USB_HID), Some("hid-generic"));
        assert!(coming.found().is_empty());
        let fresh = Machine::with(KNOB, "03\n", None, None);
        let power = fresh.places().sys.join("devices/usb1/1-2/power");
        fs::create_dir_all(&power).expect("room");
        for (ms, count) in [("120\n", 0), ("5000\n", 1)] {
            fs::write(power.join("connected_duration"), ms).expect("room");
            assert_eq!(fresh.found().len(), count, "{ms}");
        }
    }

    #[test]
    fn the_options_free_what_is_left_to_powermate() {
        let text = module_options();
        assert!(
            text.contains("\noptions usbhid quirks=0x077d:0x0410:0x40000000,0x077d:0x04aa:0x40000000\n"),
            "{text}"
        );
        assert!(text.contains("\nblacklist powermate\n"), "{text}");
    }
}
