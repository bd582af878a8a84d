//! What the Linux kernel tells of HID devices: `class/hidraw/NAME/device` leads to the HID device, above it the USB
//! interface and the USB device. On systems without these folders nothing is found.
//!
//! Read here rather than by the HID library, which reads every attribute of every device on the way, once a second
//! too much. Source: Linux `Documentation/ABI/testing/sysfs-bus-usb`, `drivers/hid/hid-core.c` (uevent).

use super::found::{Access, Found};
use crate::codec::outline::Outline;
use crate::transport::adapter::UsbPlace;
use device_profiles::Bus;
use rustix::io::Errno;
use std::path::Path;

/// How many folders above a HID device the USB device may be: device, interface, and a converter's own.
const LEVELS_MAX: usize = 5;
/// Bus numbers of `linux/input.h`.
const BUS_USB: u16 = 3;
const BUS_BLUETOOTH: u16 = 5;

/// All HID nodes.
pub(super) fn hid(sys: &Path, dev: &Path) -> Vec<Found> {
    let Ok(entries) = std::fs::read_dir(sys.join("class/hidraw")) else {
        return Vec::new();
    };
    let nodes = entries.filter_map(|entry| entry.ok()?.file_name().into_string().ok());
    nodes.filter_map(|node| hid_node(sys, dev, &node)).collect()
}

/// One node; none where it vanished while it was looked at.
fn hid_node(sys: &Path, dev: &Path, node: &str) -> Option<Found> {
    let folder = std::fs::canonicalize(sys.join("class/hidraw").join(node).join("device")).ok()?;
    let about = std::fs::read_to_string(folder.join("uevent")).ok()?;
    let value = |key: &str| {
        let mut lines = about.lines().filter_map(|line| line.split_once('='));
        lines
            .find(|(name, _)| *name == key)
            .map(|(_, value)| value.trim())
    };
    let mut ids = value("HID_ID")?
        .split(':')
        .map(|word| u32::from_str_radix(word, 16));
    let (bus, vendor, product) = (ids.next()?.ok()?, ids.next()?.ok()?, ids.next()?.ok()?);
    let bus = match bus as u16 {
        BUS_USB => Bus::Usb,
        BUS_BLUETOOTH => Bus::Bluetooth,
        _ => return None,
    };
    let path = dev.join(node);
    let mut found = Found::new(path.to_str()?, bus);
    found.vendor = Some(vendor as u16);
    found.product = Some(product as u16);
    value("HID_NAME").unwrap_or_default().clone_into(&mut found.title);
    value("HID_UNIQ")
        .unwrap_or_default()
        .clone_into(&mut found.serial);
    found.place = value("HID_PHYS")
        .filter(|place| !place.is_empty())
        .map(str::to_owned);
    found.driver = link_name(&folder.join("driver"));
    let descriptor = std::fs::read(folder.join("report_descriptor")).unwrap_or_default();
    found.outline = Outline::of(&descriptor);
    found.access = access(&path);
    if bus == Bus::Usb {
        above(&folder, &mut found);
    }
    Some(found)
}

/// What stands above a serial port.
pub(super) fn above_serial(sys: &Path, found: &mut Found) {
    let Some(name) = Path::new(&found.address).file_name() else {
        return;
    };
    let Ok(folder) = std::fs::canonicalize(sys.join("class/tty").join(name).join("device")) else {
        return;
    };
    found.driver = link_name(&folder.join("driver"));
    above(&folder, found);
}

/// The USB interface and device that `folder` lies in.
pub(super) fn above(folder: &Path, found: &mut Found) {
    let levels = || folder.ancestors().take(LEVELS_MAX);
    let Some(device) = levels().find(|level| level.join("idVendor").is_file()) else {
        return;
    };
    let hexadecimal = |file: &Path| u16::from_str_radix(&text(file)?, 16).ok();
    let decimal = |name: &str| text(&device.join(name))?.parse().ok();
    let interface = levels().find_map(|level| hexadecimal(&level.join("bInterfaceNumber")));
    found.interface = interface.and_then(|number| number.try_into().ok());
    found.vendor = found.vendor.or_else(|| hexadecimal(&device.join("idVendor")));
    found.product = found.product.or_else(|| hexadecimal(&device.join("idProduct")));
    found.place = link_or_name(device);
    if let Some(maker) = text(&device.join("manufacturer")) {
        found.maker = maker;
    }
    if let Some(title) = text(&device.join("product")) {
        found.title = title;
    }
    if let Some(serial) = text(&device.join("serial")) {
        found.serial = serial;
    }
    found.usb = (|| {
        Some(UsbPlace {
            bus: decimal("busnum")?,
            address: decimal("devnum")?,
            interface: found.interface.unwrap_or(0),
        })
    })();
}

/// By trying nothing: opening a device may already do something to it.
pub(super) fn access(node: &Path) -> Access {
    use rustix::fs::Access as Right;
    match rustix::fs::access(node, Right::READ_OK | Right::WRITE_OK) {
        Ok(()) => Access::Allowed,
        Err(Errno::NOENT) => Access::NotYet,
        Err(_) => Access::Forbidden,
    }
}

pub(super) fn text(file: &Path) -> Option<String> {
    // Names that a device made up may hold anything.
    let bytes = std::fs::read(file).ok()?;
    let text = String::from_utf8_lossy(&bytes).trim().to_owned();
    (!text.is_empty()).then_some(text)
}

pub(super) fn link_name(link: &Path) -> Option<String> {
    link_or_name(&std::fs::canonicalize(link).ok()?)
}

fn link_or_name(path: &Path) -> Option<String> {
    Some(path.file_name()?.to_str()?.to_owned())
}
