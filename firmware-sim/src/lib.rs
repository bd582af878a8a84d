//! Simulated device firmware: bytes in, bytes out, byte for byte what the manuals say, late where the
//! wire is slow, wrong where a fault was asked for.
//!
//! Knows: wire formats, control tables (through `device_profiles`), the time a byte takes, hands, motors
//! and heat, each only as well as a driver can see them from the far end of the cable.
//! Must not know: the driver. It shares facts with it (the profiles), never code, so that one mistake
//! cannot agree with itself. It reads no clock, opens no port and keeps no thread: time comes in as `now_us`,
//! and how the calls are cut up does not change a byte.
//!
//! Start at [`Firmware`] (a serial cable) and [`UsbDevice`] (what a host controller sees), then [`dial_box`] (the
//! smallest device), [`wacom_iv`], and [`servo_bus`], where `bus.rs` orders the events on the wire and `servo.rs` is
//! one servo. [`script`] plays hands from a text.
pub mod ctl_472;
pub mod deco_01_v2;
pub mod deej;
pub mod dial_box;
pub mod firmata;
mod firmware;
pub mod hands;
pub mod hs610;
mod input_fault;
mod line;
pub mod midi_box;
pub mod mm;
pub mod powermate;
pub mod pth_660;
pub mod script;
pub mod serial;
mod serial_kinds;
pub mod servo_bus;
pub mod shuttle_pro;
pub mod space_mouse;
mod travel;
mod uart;
pub mod usb_device;
mod usb_kinds;
pub mod wacom_iv;
pub mod wacom_v;

pub use deej::Deej;
pub use dial_box::SgiDialBox;
pub use firmata::Firmata;
pub use firmware::Firmware;
pub use input_fault::{InputFault, InputFaultError};
pub use midi_box::{LaunchControlXl, MidiOptions, MidiShown, NanoKontrol2, XTouchMini};
pub use mm::SummagraphicsMm;
pub use script::Script;
pub use serial_kinds::{SerialDevice, serial_device};
pub use servo_bus::{Fault, ServoBus};
pub use uart::Parity;
pub use usb_device::UsbDevice;
pub use usb_kinds::{USB_KINDS, UsbKind, usb_kind};
pub use wacom_iv::WacomIv;
pub use wacom_v::WacomV;
