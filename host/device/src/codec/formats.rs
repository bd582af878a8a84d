//! Which codec reads which format: the one list of them.

use super::Codec;
use super::handshake::Handshake;
use super::sgi_dial_box::SgiDialBox;
use super::wacom_iv::WacomIv;
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

/// The codec for a device of this profile, new; its handshake goes before it.
pub fn of_profile(profile: &InputProfile, stand: Stand) -> Result<Box<dyn Codec>, UnknownFormat> {
    let reports = stand == Stand::Reporting;
    let codec: Box<dyn Codec> = match profile.format.as_str() {
        "sgi-dial-box" if reports => Box::new(SgiDialBox::listening(profile)),
        "sgi-dial-box" => Box::new(SgiDialBox::new(profile)),
        "wacom-iv" if reports => Box::new(WacomIv::listening(profile)),
        "wacom-iv" => Box::new(WacomIv::new(profile)),
        other => {
            return Err(UnknownFormat {
                profile: profile.key.clone(),
                format: other.to_owned(),
            });
        }
    };
    Ok(if reports || profile.init.is_empty() {
        codec
    } else {
        Box::new(Handshake::new(profile, codec))
    })
}

/// A profile's format that no codec here reads.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("profile \"{profile}\" has format \"{format}\", which no codec here reads")]
pub struct UnknownFormat {
    /// The profile's key.
    pub profile: String,
    /// What it says.
    pub format: String,
}
