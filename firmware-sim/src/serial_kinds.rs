//! The simulated devices on serial lines, each made from the profile of the real one by the profile's format.

use crate::deej::Deej;
use crate::dial_box::Output;
use crate::firmata::Firmata;
use crate::firmware::Firmware;
use crate::hands::Hands;
use crate::midi_box;
use crate::mm::{self, SummagraphicsMm};
use crate::script::{Device, Script};
use crate::uart::Parity;
use crate::wacom_v::WacomV;
use device_profiles::InputProfile;

/// A simulated input device on a serial line: bytes at one end, hands at the other.
pub trait SerialDevice: Firmware + Hands + Send {
    /// Plays `script` as well, its times counted from when the host first switched reporting on.
    fn play(&mut self, script: &Script);

    /// Whether every scripted touch has been made.
    fn script_is_done(&self) -> bool;

    /// Takes what the host has made it show, each with its time in microseconds.
    fn drain_outputs(&mut self, _take: &mut dyn FnMut(u64, Output)) {}

    /// Speed and parity at which a host's port must begin.
    fn line(&self) -> (u32, Parity);

    /// What scripts may do to it.
    fn controls(&self) -> Device;
}

/// The device that `profile` describes, switched on, with a clock that is right; none where nothing of its format is
/// simulated here.
pub fn serial_device(profile: &InputProfile) -> Option<Box<dyn SerialDevice>> {
    Some(match profile.format.as_str() {
        "wacom-v" => Box::new(WacomV::new(profile.into(), 0)),
        "mm" => Box::new(SummagraphicsMm::new(mm::Model::of_profile(profile)?, 0)),
        "deej" => Box::new(Deej::new(profile.into())),
        "firmata" => Box::new(Firmata::new(profile.into())),
        "midi" => return midi_box::of_profile(&profile.key),
        _ => return None,
    })
}
