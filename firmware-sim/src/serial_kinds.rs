//! The simulated devices on serial lines, each made from the profile of the real one by the profile's format.

use crate::deej::Deej;
use crate::dial_box::{Output, SgiDialBox};
use crate::firmata::Firmata;
use crate::firmware::Firmware;
use crate::hands::Hands;
use crate::input_fault::InputFault;
use crate::midi_box;
use crate::mm::{self, SummagraphicsMm};
use crate::script::{Device, Script};
use crate::uart::Parity;
use crate::wacom_iv::WacomIv;
use crate::wacom_v::WacomV;
use device_profiles::InputProfile;

/// A simulated input device on a serial line: bytes at one end, hands at the other.
pub trait SerialDevice: Firmware + Hands + Send {
    /// Plays `script` as well, its times counted from when the host first switched reporting on.
    fn play(&mut self, script: &Script);

    /// Whether every scripted touch has been made.
    fn script_is_done(&self) -> bool;

    /// Takes what the host has made it show, each with its time in microseconds.
    fn take_outputs(&mut self, take: &mut dyn FnMut(u64, Output));

    /// Speed and parity at which a host's port must begin.
    fn line(&self) -> (u32, Parity);

    /// What scripts may do to it.
    fn controls(&self) -> Device;

    /// Brings a fault in. False where it is none of a serial line's: such a cable is pulled by whoever holds it.
    fn inject(&mut self, now_us: u64, fault: InputFault) -> bool;
}

/// The device that `profile` describes, switched on, with a clock that is right; none where nothing of its format is
/// simulated here.
pub fn serial_device(profile: &InputProfile) -> Option<Box<dyn SerialDevice>> {
    Some(match profile.format.as_str() {
        "sgi-dial-box" => Box::new(SgiDialBox::new(profile.into())),
        "wacom-iv" => Box::new(WacomIv::new(profile.into(), 0)),
        "wacom-v" => Box::new(WacomV::new(profile.into(), 0)),
        "mm" => Box::new(SummagraphicsMm::new(mm::Model::of_profile(profile)?, 0)),
        "deej" => Box::new(Deej::new(profile.into())),
        "firmata" => Box::new(Firmata::new(profile.into())),
        "midi" => return midi_box::of_profile(&profile.key),
        _ => return None,
    })
}
