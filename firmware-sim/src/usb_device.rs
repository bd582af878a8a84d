//! The seam every simulated USB input device is used through: what a host controller sees of it.
//!
//! Apart from [`crate::Firmware`] because USB keeps messages apart: reports come when the host asks for them, and
//! beside them there are features, strings and requests. Whoever holds the other end (a test, the bench, a kernel's
//! uhid or USB/IP) needs to know nothing else.
//! Bytes are as on the wire: a report begins with its id only on interfaces that number their reports.
//! Start reading at [`UsbDevice`]; `chassis` is what all devices have in common.

pub(crate) mod chassis;
mod descriptor;
mod facts;
pub(crate) mod pad;
mod ramps;
mod waiting;

pub(crate) use chassis::{Chassis, Inside, Moment};
pub(crate) use descriptor::Descriptor;
pub use facts::{HidInterface, UsbFacts, string_descriptor};
pub(crate) use ramps::Ramps;
pub(crate) use waiting::Waiting;

use crate::hands::Hands;
use crate::input_fault::{InputFault, Message};
use crate::script::Script;

/// The device refuses a request (a stall on the wire).
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the device refuses the request")]
pub struct Stall;

/// One report on its way to the host.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Report {
    /// The interface it comes from, as numbered in [`UsbFacts::interfaces`].
    pub interface: u8,
    /// Its bytes, id first where the interface numbers its reports.
    pub bytes: Vec<u8>,
}

impl Message for Report {
    fn bytes(&mut self) -> &mut Vec<u8> {
        &mut self.bytes
    }
}

/// A request on the control pipe that is neither standard nor HID.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Request {
    /// `bmRequestType`: direction, kind, recipient.
    pub kind: u8,
    /// `bRequest`.
    pub request: u8,
    /// `wValue`.
    pub value: u16,
    /// `wIndex`.
    pub index: u16,
}

/// What the host made the device show.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Shown {
    /// Brightness of the one lamp, 0 to 255.
    Level(u8),
    /// The lamp pulses: speed as in the device's own words, and whether it does so while awake and asleep.
    Pulse {
        /// Operation (0 divide, 1 normal, 2 multiply) and its argument.
        speed: [u8; 2],
        /// While the host is awake.
        awake: bool,
        /// While the host sleeps.
        asleep: bool,
    },
    /// The lamp is on or off.
    Lamp(bool),
}

/// A USB input device, bus-powered. Times are microseconds of the host's clock and must not run backwards; an earlier
/// time counts as the latest one seen. What comes out depends on what went in and when, never on how often it was
/// looked at.
pub trait UsbDevice: Hands + Send {
    /// What the device says of itself as it stands on the bus now. Changes only when [`UsbDevice::arrival`] does.
    fn facts(&self) -> &UsbFacts;

    /// How often the device has come onto the bus, 0 while it is off it. When the number has changed, the host must
    /// enumerate it again: whatever it had open is gone.
    fn arrival(&mut self, now_us: u64) -> u32;

    /// The cable is pulled out or put in. Without it there is no power: modes are forgotten.
    fn plug(&mut self, now_us: u64, connected: bool);

    /// Somebody begins or ends asking `interface` for reports; nobody asking, none are made.
    fn listen(&mut self, now_us: u64, interface: u8, on: bool);

    /// Takes the next report that has reached the host by `now_us`, with the time it did.
    fn arrived_report(&mut self, now_us: u64) -> Option<(u64, Report)>;

    /// Takes the next report that has reached the host by `now_us`.
    fn report(&mut self, now_us: u64) -> Option<Report> {
        self.arrived_report(now_us).map(|(_, report)| report)
    }

    /// When the next report reaches the host, as far as is known; nothing if none is under way.
    fn next_report_us(&self) -> Option<u64>;

    /// An output report for `interface`.
    fn output(&mut self, now_us: u64, interface: u8, bytes: &[u8]) -> Result<(), Stall>;

    /// A feature report is set on `interface`.
    fn set_feature(&mut self, now_us: u64, interface: u8, bytes: &[u8]) -> Result<(), Stall>;

    /// The feature report `id` of `interface` (0 where reports are not numbered).
    fn feature(&mut self, now_us: u64, interface: u8, id: u8) -> Result<Vec<u8>, Stall>;

    /// The string descriptor of this index, whatever memory the firmware answers with, head and all.
    fn string(&mut self, now_us: u64, index: u8) -> Result<Vec<u8>, Stall>;

    /// A vendor's request; `data` goes out, the answer comes back.
    fn request(&mut self, now_us: u64, request: Request, data: &[u8]) -> Result<Vec<u8>, Stall>;

    /// Brings a fault in.
    fn inject(&mut self, now_us: u64, fault: InputFault);

    /// Plays `script` as well, its times counted from [`Hands::reporting_since_us`].
    fn play(&mut self, script: &Script);

    /// Whether every scripted touch has been made.
    fn script_is_done(&self) -> bool;

    /// Takes what the host has had shown, oldest first, each with its time in microseconds.
    fn drain_shown(&mut self) -> Vec<(u64, Shown)>;
}
