//! Drivers and programs that have a device already.

use super::{Access, Found, Places, nodeless_remedy};
use device_profiles::Bus;

/// Somebody who has the device, and what that does.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Holder {
    /// The driver's or program's name.
    pub name: String,
    /// What it does, and what to do about it.
    pub remedy: String,
}

/// Kernel drivers that change a device's mode or its descriptor, by the name in `/sys/bus/hid/drivers`, and the module
/// each is in. Source: Linux `drivers/hid/hid-uclogic-core.c`, `drivers/hid/wacom_sys.c`.
const DRIVERS: [(&str, &str); 2] = [("uclogic", "hid_uclogic"), ("wacom", "wacom")];

/// Who holds a device, as far as the system tells.
pub fn holder(found: &Found, places: &Places) -> Option<Holder> {
    let driver = found.driver.as_deref()?;
    if found.access == Access::Nodeless {
        return (driver != "usbhid").then(|| Holder {
            name: driver.to_owned(),
            remedy: nodeless_remedy(found),
        });
    }
    if let Some((name, module)) = DRIVERS.iter().find(|(name, _)| *name == driver) {
        return Some(Holder {
            name: (*module).to_owned(),
            remedy: format!(
                "the kernel's {module} has it and changes its mode: both get reports, and they may be in another form; to have it \
                 alone, as root: `echo blacklist {module} > /etc/modprobe.d/no-{module}.conf && rmmod {module}` (driver \"{name}\"), then \
                 plug it out and in"
            ),
        });
    }
    let is_modem = found.bus == Bus::Serial && driver == "cdc_acm";
    (is_modem && runs(places, "ModemManager")).then(|| Holder {
        name: "ModemManager".to_owned(),
        remedy: "ModemManager talks to new ports for some seconds, looking for a modem: wait, or keep it away with \
                 `sudo dialrig devices --install-rules`"
            .to_owned(),
    })
}

/// Whether a program of that name runs.
fn runs(places: &Places, name: &str) -> bool {
    let Ok(processes) = std::fs::read_dir(&places.proc) else {
        return false;
    };
    processes
        .filter_map(Result::ok)
        .filter(|process| {
            let name = process.file_name();
            name.to_str()
                .is_some_and(|name| name.bytes().all(|b| b.is_ascii_digit()))
        })
        // The kernel cuts names at 15 letters.
        .any(|process| {
            std::fs::read_to_string(process.path().join("comm")).is_ok_and(|comm| comm.trim_end() == name)
        })
}
