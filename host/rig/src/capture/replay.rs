//! Exchanges played back through the codec of their profile, or of the description in them.

use std::path::Path;

use device::codec::hid::HidCodec;
use device::codec::{Answer, Codec, InputEvent, Stand, of_profile};
use device::exchange::{self, Exchange, What};
use device_profiles::Profiles;

use crate::document::FileError;
use crate::listen::Heard;
use crate::telling::{Buttons, Teller};

/// What a codec makes of an exchange.
pub struct Played {
    /// Its events, with the exchange's times.
    pub events: Vec<Heard>,
    /// Where it did otherwise than the exchange tells; by line.
    pub differences: Vec<FileError>,
    /// How the events are named.
    pub teller: Teller,
}

/// Plays the text of an exchange through the codec of its profile, or of another. `file` is for what is wrong with it.
pub fn replay(
    file: &Path,
    text: &str,
    profile: Option<&str>,
    profiles: &Profiles,
) -> Result<Played, Vec<FileError>> {
    let at = |line: u32, column: u32, message: String| FileError {
        line,
        column,
        ..FileError::whole(file, message)
    };
    let exchange = exchange::read(text).map_err(|errors| {
        let place = |error: exchange::ExchangeError| at(error.line, error.column, error.message);
        errors.into_iter().map(place).collect::<Vec<_>>()
    })?;
    let mut codec = codec(&exchange, profile, profiles).map_err(|error| {
        let whole = FileError::whole(file, error);
        vec![match profile {
            Some(_) => whole,
            None => whole.with_hint("name a profile with --profile, or in a line `profile: NAME`"),
        }]
    })?;
    let played = exchange::play(&exchange, codec.as_mut());
    let buttons = if codec.surface().is_some() {
        Buttons::Keys
    } else {
        Buttons::Numbered
    };
    let difference = |difference: exchange::Difference| {
        let message = format!("expected {}, found {}", difference.expected, difference.found);
        at(difference.line, 1, message)
    };
    let heard = |event: device::codec::Stamped<InputEvent>| Heard {
        at_secs: event.at.as_secs_f64(),
        what: event.what,
    };
    Ok(Played {
        events: played.events.into_iter().map(heard).collect(),
        differences: played.differences.into_iter().map(difference).collect(),
        teller: Teller::new(buttons),
    })
}

/// The codec of the profile asked for, else of the one named, else of what the device described itself with.
fn codec(exchange: &Exchange, profile: Option<&str>, profiles: &Profiles) -> Result<Box<dyn Codec>, String> {
    if let Some(name) = profile.or(exchange.head.profile.as_deref()) {
        let known = profiles.input(name).map_err(|error| error.to_string())?;
        let stand = if exchange.head.reporting {
            Stand::Reporting
        } else {
            Stand::Unasked
        };
        return of_profile(known, stand).map_err(|error| error.to_string());
    }
    let described = exchange.records.iter().find_map(|record| match &record.what {
        What::Answer(Answer::Descriptor(Ok(descriptor))) => Some(descriptor),
        _ => None,
    });
    let descriptor = described.ok_or("this exchange names no profile and has no report descriptor")?;
    match HidCodec::generic(descriptor) {
        Ok(codec) => Ok(Box::new(codec)),
        Err(error) => Err(error.to_string()),
    }
}
