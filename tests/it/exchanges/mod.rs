//! Every file of `tests/exchanges` against the codec, and separately against the simulated device it names.
//!
//! Neither side sees the other's code, so that a mistake in one cannot agree with itself in the other.

mod simulator;

use crate::source::root;
use device::codec::{Codec, Stand, of_profile};
use device::exchange::{Exchange, ExchangeError, What, play, read, write};
use device_profiles::Profiles;
use std::path::{Path, PathBuf};

/// Every exchange: its path inside the folder, and its text.
fn files() -> Vec<(String, String)> {
    let folder = root().join("tests/exchanges");
    let mut waiting = vec![folder.clone()];
    let mut paths: Vec<PathBuf> = Vec::new();
    while let Some(next) = waiting.pop() {
        for entry in std::fs::read_dir(&next).expect("the folder is there") {
            let path = entry.expect("it can be read").path();
            if path.is_dir() {
                waiting.push(path);
            } else if path.extension().is_some_and(|extension| extension == "txt") {
                paths.push(path);
            }
        }
    }
    paths.sort();
    assert!(
        !paths.is_empty(),
        "there are no exchanges in {}",
        folder.display()
    );
    let name = |path: &Path| {
        let inside = path.strip_prefix(&folder).unwrap_or(path);
        inside.to_string_lossy().replace('\\', "/")
    };
    let read = |path: PathBuf| (name(&path), std::fs::read_to_string(&path).expect("it is text"));
    paths.into_iter().map(read).collect()
}

fn parsed() -> Vec<(String, Exchange)> {
    let parse = |(name, text): (String, String)| {
        let exchange = read(&text).unwrap_or_else(|errors| panic!("{}", listed(&name, &errors)));
        (name, exchange)
    };
    files().into_iter().map(parse).collect()
}

fn listed(name: &str, errors: &[ExchangeError]) -> String {
    let lines: Vec<String> = errors
        .iter()
        .map(|error| format!("tests/exchanges/{name}:{error}"))
        .collect();
    lines.join("\n")
}

/// The codec of the exchange's profile, new.
fn codec(profiles: &Profiles, exchange: &Exchange) -> Result<Box<dyn Codec>, String> {
    let name = exchange.head.profile.as_deref().unwrap_or_default();
    let profile = profiles.input(name).map_err(|error| error.to_string())?;
    let stand = if exchange.head.reporting {
        Stand::Reporting
    } else {
        Stand::Unasked
    };
    of_profile(profile, stand).map_err(|error| error.to_string())
}

#[test]
fn every_exchange_says_whose_it_is_and_has_something_to_check() {
    let profiles = Profiles::builtin();
    let mut wrong = Vec::new();
    for (name, exchange) in parsed() {
        let head = &exchange.head;
        let has = |is: fn(&What) -> bool| exchange.records.iter().any(|record| is(&record.what));
        if head.source.as_deref().unwrap_or_default().len() < 8 {
            wrong.push(format!("{name}: has no `source:`"));
        }
        if let Err(error) = codec(&profiles, &exchange) {
            wrong.push(format!("{name}: {error}"));
        }
        if !has(|what| matches!(what, What::Device(_) | What::Answer(_))) {
            wrong.push(format!("{name}: the device says nothing"));
        }
        if !has(|what| matches!(what, What::Host(_) | What::Event(_))) {
            wrong.push(format!("{name}: nothing of what the codec does is told"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn what_is_written_reads_back() {
    for (name, exchange) in parsed() {
        let mut again = read(&write(&exchange)).unwrap_or_else(|errors| panic!("{}", listed(&name, &errors)));
        for (record, original) in again.records.iter_mut().zip(&exchange.records) {
            record.line = original.line;
        }
        assert_eq!(again, exchange, "{name}");
    }
}

#[test]
fn codecs_say_and_make_of_it_what_the_exchanges_tell() {
    let profiles = Profiles::builtin();
    let mut wrong = Vec::new();
    for (name, exchange) in parsed() {
        let Ok(mut codec) = codec(&profiles, &exchange) else {
            continue;
        };
        for difference in play(&exchange, codec.as_mut()).differences {
            wrong.push(format!("tests/exchanges/{name}: {difference}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Whatever a file tells of the codec: told otherwise, it is noticed. Otherwise the test above could not fail.
#[test]
fn an_exchange_told_otherwise_is_noticed() {
    use device::codec::{InputEvent, Step};
    let profiles = Profiles::builtin();
    for (name, exchange) in parsed() {
        for index in 0..exchange.records.len() {
            let mut other = exchange.clone();
            match &mut other.records[index].what {
                What::Event(event @ InputEvent::Dial { .. }) => {
                    *event = InputEvent::Axis { control: 9, value: 1 };
                }
                What::Event(event) => {
                    *event = InputEvent::Dial {
                        control: 99,
                        delta_counts: 7,
                    };
                }
                What::Host(Step::Bytes(bytes) | Step::Report(bytes) | Step::Feature(bytes)) => bytes[0] ^= 1,
                _ => continue,
            }
            let mut codec = codec(&profiles, &exchange).expect("checked elsewhere");
            assert!(
                !play(&other, codec.as_mut()).differences.is_empty(),
                "{name}, line {}: changed, and nobody noticed",
                other.records[index].line
            );
        }
    }
}

#[test]
fn simulated_devices_say_what_the_exchanges_tell() {
    let profiles = Profiles::builtin();
    let mut wrong = Vec::new();
    let mut played = 0;
    for (name, exchange) in parsed() {
        let Some(simulator) = &exchange.head.simulator else {
            continue;
        };
        played += 1;
        for difference in simulator::play(&exchange, simulator, &profiles) {
            wrong.push(format!("tests/exchanges/{name}: {difference}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(played > 0, "no exchange names a simulated device");
}
