//! What every wire format and every layout says, out of the exchanges that the codecs are held against.
//!
//! The list is the profiles' own: a format or layout that somebody adds is measured without a line here, and one
//! whose exchange says nothing is an error.

use anyhow::Context;
use device::codec::{Codec, Stand, of_profile};
use device::exchange::{self, Exchange, What};
use device_profiles::{InputProfile, Profiles};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// A codec in the middle of a conversation, and what the device says in it.
pub(super) struct Recorded {
    /// The layout, or the format where there is none.
    pub(super) name: String,
    pub(super) codec: Box<dyn Codec>,
    pub(super) pieces: Vec<Vec<u8>>,
}

/// What profiles are told apart by here: how their bytes are read.
pub(super) fn subject(profile: &InputProfile) -> &str {
    profile.layout.as_deref().unwrap_or(&profile.format)
}

/// One for each layout and format, by name: the exchange in which the device says most.
pub(super) fn all() -> anyhow::Result<Vec<Recorded>> {
    let profiles = Profiles::builtin();
    let mut most: BTreeMap<&str, (usize, &InputProfile, Exchange)> = BTreeMap::new();
    for profile in profiles.inputs() {
        for exchange in exchanges(&profile.key)? {
            let said = pieces(&exchange).len();
            let known = most.get(subject(profile)).map_or(0, |(said, ..)| *said);
            if said > known {
                most.insert(subject(profile), (said, profile, exchange));
            }
        }
    }
    for profile in profiles.inputs() {
        let name = subject(profile);
        anyhow::ensure!(most.contains_key(name), "no exchange has a word of {name}");
    }
    most.into_iter()
        .map(|(name, (_, profile, exchange))| {
            let stand = if exchange.head.reporting {
                Stand::Reporting
            } else {
                Stand::Unasked
            };
            let mut codec = of_profile(profile, stand).with_context(|| name.to_owned())?;
            // The conversation up to its end: what is asked first is answered.
            exchange::play(&exchange, codec.as_mut());
            Ok(Recorded {
                name: name.to_owned(),
                codec,
                pieces: pieces(&exchange),
            })
        })
        .collect()
}

fn pieces(exchange: &Exchange) -> Vec<Vec<u8>> {
    let said = exchange.records.iter().filter_map(|record| match &record.what {
        What::Device(bytes) => Some(bytes.clone()),
        _ => None,
    });
    said.collect()
}

fn exchanges(profile: &str) -> anyhow::Result<Vec<Exchange>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("exchanges")
        .join(profile);
    let mut files: Vec<_> = fs::read_dir(&folder)
        .with_context(|| folder.display().to_string())?
        .map(|entry| entry.map(|entry| entry.path()))
        .collect::<Result<_, _>>()?;
    files.sort();
    files
        .iter()
        .map(|file| {
            let read = exchange::read(&fs::read_to_string(file)?);
            read.map_err(|errors| anyhow::anyhow!("{}: {errors:?}", file.display()))
        })
        .collect()
}
