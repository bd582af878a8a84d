//! Which codec reads which format: the one list of them.

use super::handshake::Handshake;
use super::hid::{HidCodec, PlanError};
use super::midi::Midi;
use super::osc::Osc;
use super::sgi_dial_box::SgiDialBox;
use super::wacom_iv::WacomIv;
use super::{Codec, serial_formats};
use device_profiles::InputProfile;

/// How a conversation stands when a codec comes in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Stand {
    /// The device is to be asked first.
    #[default]
    Unasked,
    /// It reports already, as in a recording that was begun in the middle.
    Reporting,
}

/// The codec for a device of this profile, new; its handshake goes before it. The profile comes out of
/// [`device_profiles::Profiles`], which know its layout.
pub fn of_profile(profile: &InputProfile, stand: Stand) -> Result<Box<dyn Codec>, UnknownFormat> {
    let reports = stand == Stand::Reporting;
    let codec: Box<dyn Codec> = match profile.format.as_str() {
        "hid" => Box::new(HidCodec::new(profile)?),
        "sgi-dial-box" if reports => Box::new(SgiDialBox::listening(profile)),
        "sgi-dial-box" => Box::new(SgiDialBox::new(profile)),
        "wacom-iv" if reports => Box::new(WacomIv::listening(profile)),
        "wacom-iv" => Box::new(WacomIv::new(profile)),
        // A MIDI controller is woken by its own codec, in the stream in which it answers.
        "midi" if reports => return Ok(Box::new(Midi::listening(profile))),
        "midi" => return Ok(Box::new(Midi::new(profile))),
        "osc" if reports => Box::new(Osc::listening(profile)),
        "osc" => Box::new(Osc::new(profile)),
        other => serial_formats::codec(profile, reports).ok_or_else(|| UnknownFormat::Format {
            profile: profile.key.clone(),
            format: other.to_owned(),
        })?,
    };
    Ok(if reports || profile.init.is_empty() {
        codec
    } else {
        Box::new(Handshake::new(profile, codec))
    })
}

/// A profile that no codec here reads.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum UnknownFormat {
    /// Nobody knows its format.
    #[error("profile \"{profile}\" has format \"{format}\", which no codec here reads")]
    Format {
        /// The profile's key.
        profile: String,
        /// What it says.
        format: String,
    },
    /// Its tables of reports cannot be used.
    #[error(transparent)]
    Tables(#[from] PlanError),
}

#[cfg(test)]
mod tests {
    use super::*;
    use device_profiles::{FORMATS, Profiles};
    use std::collections::BTreeSet;

    #[test]
    fn every_profile_of_every_format_has_a_codec() {
        let profiles = Profiles::builtin();
        let mut read = BTreeSet::new();
        for profile in profiles.inputs() {
            for stand in [Stand::Unasked, Stand::Reporting] {
                match of_profile(profile, stand) {
                    Ok(codec) => {
                        let reports = stand == Stand::Reporting;
                        assert!(reports || !codec.started(), "{} has not been asked", profile.key);
                        read.insert(profile.format.as_str());
                    }
                    Err(error) => panic!("{error}"),
                }
            }
        }
        let known: BTreeSet<&str> = FORMATS.iter().copied().collect();
        assert_eq!(read, known);
    }

    #[test]
    fn a_format_of_nobody_is_named() {
        let mut profile = Profiles::builtin().input("deej").expect("it is built in").clone();
        "morse".clone_into(&mut profile.format);
        let error = of_profile(&profile, Stand::Unasked)
            .err()
            .expect("nobody reads it");
        assert_eq!(
            error.to_string(),
            "profile \"deej\" has format \"morse\", which no codec here reads"
        );
    }
}
