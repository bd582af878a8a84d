//! The udev rules that let whoever sits at the machine open the devices of the profiles.
//!
//! `uaccess` gives the node to the user of the seat for as long as he is logged in; the file's name must sort before
//! `73-seat-late.rules`, which does it. Source: udev(7), systemd `73-seat-late.rules`; the form as OpenTabletDriver
//! writes it.

use device_profiles::{Bus, InputProfile, Profiles};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

/// Where the rules go.
pub const RULES_FILE: &str = "/etc/udev/rules.d/70-dialrig.rules";

/// The file's text.
pub fn rules(profiles: &Profiles) -> String {
    let mut text = String::from(
        "# Input devices that dialrig knows: whoever sits at the machine may open them.\n\
         # Written by `dialrig devices --install-rules`; written anew, changes are lost.\n",
    );
    for ((bus, vendor, product), names) in ids(profiles) {
        let names: Vec<_> = names.into_iter().collect();
        // Writing to a string cannot fail.
        let _ = write!(text, "\n# {}\n", names.join(", "));
        match bus {
            Bus::Usb => usb(&mut text, vendor, product),
            Bus::Bluetooth => {
                let product = product.map_or("*".to_owned(), |p| format!("{p:04X}"));
                let _ = writeln!(
                    text,
                    "SUBSYSTEM==\"hidraw\", KERNELS==\"0005:{vendor:04X}:{product}.*\", TAG+=\"uaccess\""
                );
            }
            _ => {
                let _ = writeln!(
                    text,
                    "SUBSYSTEM==\"tty\", {}, TAG+=\"uaccess\", ENV{{ID_MM_DEVICE_IGNORE}}=\"1\"",
                    attributes("ATTRS", vendor, product)
                );
            }
        }
    }
    text
}

fn usb(text: &mut String, vendor: u16, product: Option<u16>) {
    let _ = writeln!(
        text,
        "SUBSYSTEM==\"hidraw\", {}, TAG+=\"uaccess\"",
        attributes("ATTRS", vendor, product)
    );
    // The device as a whole, for its strings.
    let _ = writeln!(
        text,
        "SUBSYSTEM==\"usb\", ENV{{DEVTYPE}}==\"usb_device\", {}, TAG+=\"uaccess\"",
        attributes("ATTR", vendor, product)
    );
}

fn attributes(word: &str, vendor: u16, product: Option<u16>) -> String {
    let mut text = format!("{word}{{idVendor}}==\"{vendor:04x}\"");
    if let Some(product) = product {
        let _ = write!(text, ", {word}{{idProduct}}==\"{product:04x}\"");
    }
    text
}

type Id = (Bus, u16, Option<u16>);

/// Every id of every profile, with the names of those that have it.
fn ids(profiles: &Profiles) -> BTreeMap<Id, BTreeSet<&str>> {
    let mut all: BTreeMap<Id, BTreeSet<&str>> = BTreeMap::new();
    for profile in profiles.inputs() {
        for id in ids_of(profile) {
            all.entry(id).or_default().insert(&profile.name);
        }
    }
    all
}

fn ids_of(profile: &InputProfile) -> impl Iterator<Item = Id> {
    let matched = profile
        .matches
        .iter()
        .filter(|m| matches!(m.bus, Bus::Usb | Bus::Bluetooth | Bus::Serial))
        .filter_map(|m| Some((m.bus, m.vendor?, m.product)));
    let siblings = profile.init.iter().filter_map(|step| step.expect_sibling);
    matched.chain(siblings.map(|[vendor, product]| (Bus::Usb, vendor, Some(product))))
}
