//! The raw MIDI nodes of Linux: `class/sound/midiC1D0` leads to its sound card, above it the USB device; the port's
//! name stands in `asound/card1/midi0` below `/proc`. On systems without these folders nothing is found.
//!
//! Source: Linux `sound/core/rawmidi.c` (`snd_rawmidi_proc_info_read`), `sound/core/sound.c`.

use super::{Found, Places, sysfs};
use device_profiles::Bus;

/// All nodes.
pub(super) fn nodes(places: &Places) -> Vec<Found> {
    let Ok(entries) = std::fs::read_dir(places.sys.join("class/sound")) else {
        return Vec::new();
    };
    let names = entries.filter_map(|entry| entry.ok()?.file_name().into_string().ok());
    names.filter_map(|name| node(places, &name)).collect()
}

/// One node, if `name` is one's: `midiC1D0` is device 0 of card 1.
fn node(places: &Places, name: &str) -> Option<Found> {
    let (card, device) = name.strip_prefix("midiC")?.split_once('D')?;
    let numbers = [card, device].map(str::parse::<u16>);
    if numbers.iter().any(Result::is_err) {
        return None;
    }
    let path = places.dev.join("snd").join(name);
    let mut found = Found::new(path.to_str()?, Bus::Midi);
    found.access = sysfs::access(&path);
    if let Ok(folder) = std::fs::canonicalize(places.sys.join("class/sound").join(name).join("device")) {
        sysfs::above(&folder, &mut found);
    }
    let about = places.proc.join(format!("asound/card{card}/midi{device}"));
    if let Some(port) = sysfs::text(&about)
        && let Some(first) = port.lines().next()
    {
        first.trim().clone_into(&mut found.title);
    }
    Some(found)
}

/// The ports of the system's own library, where it was asked for at building. On Linux the nodes are the devices, and
/// programs' ports no input devices.
pub(super) fn library_ports() -> Vec<Found> {
    #[cfg(feature = "midir")]
    if !cfg!(target_os = "linux") {
        let port = |name: String| Found {
            title: name.clone(),
            ..Found::new(&format!("midi:{name}"), Bus::Midi)
        };
        return crate::transport::midi_ports::names()
            .into_iter()
            .map(port)
            .collect();
    }
    Vec::new()
}
