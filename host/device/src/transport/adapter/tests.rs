//! A tree as Linux has it, in a folder of its own, and a chip that remembers.

use super::*;
use std::os::unix::fs::symlink;
use std::sync::{Arc, Mutex};

/// What stands in for a chip: its timer, or why it does not answer.
#[derive(Clone)]
struct Chip(Arc<Mutex<Result<u8, String>>>);

impl Chip {
    fn with(timer: Result<u8, &str>) -> Self {
        Self(Arc::new(Mutex::new(timer.map_err(str::to_owned))))
    }
}

impl ControlRequests for Chip {
    fn latency_ms(&mut self, _place: UsbPlace, _product: u16) -> Result<u8, String> {
        self.0.lock().unwrap().clone()
    }

    fn set_latency_ms(&mut self, place: UsbPlace, product: u16, ms: u8) -> Result<(), String> {
        assert_eq!((place.bus, place.address, product), (3, 17, 0x6014));
        let mut timer = self.0.lock().unwrap();
        timer.clone()?;
        *timer = Ok(ms);
        Ok(())
    }
}

/// A port `ttyUSB0` as the kernel describes it; `timer` as its file, if the driver has one.
fn tree(vendor: &str, timer: Option<&str>) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let device = folder.path().join("devices/usb3/3-2");
    let port = device.join("3-2:1.0/ttyUSB0");
    std::fs::create_dir_all(&port).unwrap();
    for (file, text) in [
        ("idVendor", vendor),
        ("idProduct", "6014"),
        ("serial", "FT4THVJ6"),
        ("busnum", "3"),
        ("devnum", "17"),
        ("3-2:1.0/bInterfaceNumber", "00"),
    ] {
        std::fs::write(device.join(file), format!("{text}\n")).unwrap();
    }
    if let Some(timer) = timer {
        std::fs::write(port.join("latency_timer"), format!("{timer}\n")).unwrap();
    }
    let class = folder.path().join("class/tty/ttyUSB0");
    std::fs::create_dir_all(&class).unwrap();
    symlink(&port, class.join("device")).unwrap();
    folder
}

#[test]
fn the_kernels_file_is_read_and_written() {
    let tree = tree("0403", Some("16"));
    let chip = Chip::with(Err("not asked"));
    let mut adapters = Adapters::new(tree.path(), Box::new(chip));
    let adapter = adapters.of_port("/dev/ttyUSB0").unwrap();
    assert_eq!((adapter.vendor, adapter.serial.as_str()), (FTDI, "FT4THVJ6"));
    assert_eq!(adapters.latency_ms(&adapter), Some((16, Way::Sysfs)));
    assert_eq!(adapters.set_latency_ms(&adapter, 1), Ok(Way::Sysfs));
    assert_eq!(adapters.latency_ms(&adapter), Some((1, Way::Sysfs)));
    let rule = adapter.permission_rule();
    assert!(
        rule.contains(r#"ATTRS{idVendor}=="0403""#) && rule.contains("uaccess"),
        "{rule}"
    );
}

#[test]
fn the_chip_is_asked_where_the_kernel_has_no_file() {
    let tree = tree("0403", None);
    let chip = Chip::with(Ok(16));
    let mut adapters = Adapters::new(tree.path(), Box::new(chip.clone()));
    let adapter = adapters.of_port("/dev/ttyUSB0").unwrap();
    assert_eq!(adapters.latency_ms(&adapter), Some((16, Way::Request)));
    assert_eq!(adapters.set_latency_ms(&adapter, 1), Ok(Way::Request));
    assert_eq!(*chip.0.lock().unwrap(), Ok(1));
}

#[test]
fn a_refusal_says_what_grants_it() {
    let tree = tree("0403", None);
    // A folder where the file should be: nobody can write it, not even the superuser.
    std::fs::create_dir(tree.path().join("devices/usb3/3-2/3-2:1.0/ttyUSB0/latency_timer")).unwrap();
    let mut adapters = Adapters::new(tree.path(), Box::new(Chip::with(Err("access denied"))));
    let adapter = adapters.of_port("/dev/ttyUSB0").unwrap();
    assert_eq!(adapters.latency_ms(&adapter), None);
    let error = adapters.set_latency_ms(&adapter, 1).unwrap_err().to_string();
    for words in ["access denied", "low_latency", "udev", "ftdi_sio"] {
        assert!(error.contains(words), "{words}: {error}");
    }
}

#[test]
fn other_makes_have_no_timer() {
    let tree = tree("1a86", None);
    let mut adapters = Adapters::new(tree.path(), Box::new(Chip::with(Ok(16))));
    let adapter = adapters.of_port("/dev/ttyUSB0").unwrap();
    assert_eq!(adapters.latency_ms(&adapter), None);
    let tty = "ttyUSB0".to_owned();
    assert_eq!(
        adapters.set_latency_ms(&adapter, 1),
        Err(AdapterError::NoTimer { tty })
    );
    assert_eq!(adapters.of_port("/dev/ttyS0"), None);
    assert_eq!(adapters.of_port("tcp:host:1"), None);
}

#[test]
fn chips_with_several_ports_count_them_from_one() {
    let place = |interface| UsbPlace {
        bus: 1,
        address: 2,
        interface,
    };
    for (product, interface, index) in [(0x6014, 0, 0), (0x6001, 0, 0), (0x6010, 0, 1), (0x6011, 3, 4)] {
        assert_eq!(ftdi::index(place(interface), product), index, "{product:04x}");
    }
}
