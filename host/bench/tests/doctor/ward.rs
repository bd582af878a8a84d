//! A simulated bus for the doctor to look at: an arm of five servos as they should be, to be spoilt by each test.

use bench::stand::{SimPorts, Stand};
use device::clock::VirtualClock;
use device::transport::adapter::UsbPlace;
use device::transport::{Transport, TransportError};
use device_profiles::{Profiles, ServoProfile};
use firmware_sim::servo_bus::{BusOptions, Unit};
use firmware_sim::{Fault, ServoBus};
use rig::doctor::{Adapters, ControlRequests, Doctor, Finding, Ward as Line};
use std::fmt::Write as _;
use std::os::unix::fs::symlink;
use std::path::Path;
use std::sync::Arc;

/// The arm: one bus, five XL330.
const ARM: &str = r#"
name = "Arm"
status = "untested"
source = "made up for tests"
figure = "none"

[[bus]]
name = "arm"
baud = 1000000
"#;
/// Its joints; the ids count from 1.
pub(crate) const JOINTS: [&str; 5] = ["base", "shoulder", "elbow", "wrist", "gripper"];

/// Where their angles are 0, counts: the gripper's range ends near the turn's beginning.
const ZEROS: [f64; 5] = [2048.0, 2048.0, 2048.0, 2048.0, 1200.0];

/// What the bus is made of.
pub(crate) struct Bus {
    pub(crate) baud: u32,
    pub(crate) servos: Vec<(ServoProfile, Unit)>,
    pub(crate) timer_ms: Option<u8>,
    /// Why the port cannot be opened.
    pub(crate) refused: Option<TransportError>,
    faults: Vec<Fault>,
}

impl Bus {
    /// Nothing is wrong with it.
    pub(crate) fn healthy() -> Self {
        let mut bus = Self {
            baud: 1_000_000,
            servos: Vec::new(),
            timer_ms: None,
            refused: None,
            faults: Vec::new(),
        };
        for (id, zero_counts) in (1..).zip(ZEROS) {
            bus.add("XL330-M288", id).start_rad = (zero_counts - 2048.0) * std::f64::consts::TAU / 4096.0;
        }
        bus
    }

    /// Another model in that place, with the same id.
    pub(crate) fn replace(&mut self, place: usize, model: &str) {
        self.servos[place - 1].0 = Profiles::builtin().servo(model).expect("built in").clone();
    }

    /// Hangs another servo on the end.
    pub(crate) fn add(&mut self, model: &str, id: u8) -> &mut Unit {
        let profile = Profiles::builtin().servo(model).expect("built in").clone();
        let unit = Unit {
            return_delay_us: Some(0),
            turnaround_us: 30,
            ..Unit::new(id)
        };
        self.servos.push((profile, unit));
        &mut self.servos.last_mut().expect("just added").1
    }

    /// The servo in that place of the chain, from 1.
    pub(crate) fn unit(&mut self, place: usize) -> &mut Unit {
        &mut self.servos[place - 1].1
    }

    /// Something goes wrong from the beginning.
    pub(crate) fn fault(&mut self, text: &str) {
        self.faults.push(Fault::parse(text).expect(text));
    }

    fn build(&self) -> ServoBus {
        let mut bus = ServoBus::new(BusOptions {
            baud: self.baud,
            seed: 1,
            ..BusOptions::default()
        });
        for (profile, unit) in &self.servos {
            bus.add(profile, unit.clone()).expect("fits");
        }
        for fault in &self.faults {
            bus.inject(0, fault);
        }
        bus
    }
}

/// Nobody at the other end of USB.
struct NoChip;

impl ControlRequests for NoChip {
    fn latency_ms(&mut self, _: UsbPlace, _: u16) -> Result<u8, String> {
        Err("no chip".into())
    }

    fn set_latency_ms(&mut self, _: UsbPlace, _: u16, _: u8) -> Result<(), String> {
        Err("no chip".into())
    }
}

/// The bus on a bench, and the doctor in front of it.
pub(crate) struct Ward {
    pub(crate) doctor: Doctor,
    pub(crate) line: Line,
    _sysfs: tempfile::TempDir,
}

impl Ward {
    pub(crate) fn new(mut bus: Bus, puppet: bool) -> Self {
        let clock = VirtualClock::new();
        let stand = Stand::builder(Arc::new(clock.clone()))
            .servo_bus("arm", bus.build())
            .expect("alone")
            .build();
        let folder = tempfile::tempdir().expect("a folder");
        let profiles = profiles(folder.path());
        let sysfs = tempfile::tempdir().expect("a folder");
        let tty = sysfs_of(sysfs.path(), bus.timer_ms);
        let ports = Renamed {
            ports: SimPorts::new(stand),
            tty: tty.clone(),
            refused: bus.refused.take(),
        };
        let adapters = Adapters::new(sysfs.path(), Box::new(NoChip));
        let mut doctor = Doctor::new(Box::new(ports), Arc::new(clock), Arc::new(profiles), adapters);
        if puppet {
            doctor = doctor.of_puppet("arm").expect("written");
        }
        let line = Line {
            bus: "arm".into(),
            address: tty,
            baud: bus.baud,
        };
        Self {
            doctor,
            line,
            _sysfs: sysfs,
        }
    }

    pub(crate) fn look(&mut self) -> Vec<Finding> {
        self.doctor
            .examine(&self.line, &mut |_| {})
            .expect("the line holds")
    }
}

/// The built-in profiles and the arm's.
fn profiles(folder: &Path) -> Profiles {
    let mut text = ARM.to_owned();
    for (place, joint) in JOINTS.iter().enumerate() {
        let parent = if place == 0 {
            String::new()
        } else {
            format!("parent = \"{}\"\n", JOINTS[place - 1])
        };
        let _ = write!(
            text,
            "[[group]]\nlink = \"{joint}\"\n{parent}length_m = 0.1\n\n[[group.joint]]\nname = \"{joint}\"\nbus = \"arm\"\n\
             id = {}\nmodel = \"XL330-M288\"\nsign = 1\nzero_counts = {}\nmin_rad = -1.5\nmax_rad = 1.5\n\
             speed_max_rad_per_s = 4.0\naccel_max_rad_per_s2 = 30.0\norigin_xyz_m = [0.0, 0.0, 0.1]\n\
             axis = [0.0, 1.0, 0.0]\n\n",
            place + 1,
            ZEROS[place]
        );
    }
    let puppets = folder.join("puppets");
    std::fs::create_dir_all(&puppets).expect("a folder");
    std::fs::write(puppets.join("arm.toml"), text).expect("writes");
    Profiles::builtin()
        .with_user_folder(folder)
        .unwrap_or_else(|errors| panic!("{errors:?}"))
}

/// The kernel's tree for port `ttyUSB9` with such a timer, if there is one.
fn sysfs_of(sysfs: &Path, timer_ms: Option<u8>) -> String {
    if let Some(ms) = timer_ms {
        let device = sysfs.join("devices/3-2");
        let port = device.join("3-2:1.0/ttyUSB9");
        std::fs::create_dir_all(&port).expect("a folder");
        for (file, text) in [
            ("idVendor", "0403"),
            ("idProduct", "6014"),
            ("busnum", "3"),
            ("devnum", "9"),
        ] {
            std::fs::write(device.join(file), text).expect("writes");
        }
        std::fs::write(port.join("latency_timer"), ms.to_string()).expect("writes");
        let class = sysfs.join("class/tty/ttyUSB9");
        std::fs::create_dir_all(&class).expect("a folder");
        symlink(&port, class.join("device")).expect("links");
    }
    "/dev/ttyUSB9".to_owned()
}

/// The simulated bus under a path, as a USB adapter has one.
struct Renamed {
    ports: SimPorts,
    tty: String,
    refused: Option<TransportError>,
}

impl rig::Ports for Renamed {
    fn list(&mut self) -> Vec<rig::Found> {
        self.ports.list()
    }

    fn open(&mut self, address: &str, baud: u32) -> Result<Box<dyn Transport>, TransportError> {
        assert_eq!(address, self.tty);
        if let Some(error) = self.refused.take() {
            return Err(error);
        }
        self.ports.open("sim:arm", baud)
    }
}
