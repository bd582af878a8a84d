//! What is shown of every simulated input device: its handshake, its moves, its outputs and its faults, each by a
//! scenario (the unmodified rig in front of it) and by an exchange (the codec and the device, each by itself).
//!
//! The kinds come from the firmware, the aspects from the profiles, the proofs from the files: a kind that is added
//! without them is missing here. What the files expect is judged by the tests that play them.

use crate::source::root;
use device_profiles::{InputProfile, Profiles};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

/// What there is to show of a device.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Aspect {
    Handshake,
    Moves,
    Outputs,
    Faults,
}

const ASPECTS: [Aspect; 4] = [Aspect::Handshake, Aspect::Moves, Aspect::Outputs, Aspect::Faults];

type Shown = BTreeMap<String, BTreeSet<Aspect>>;

/// Every simulated kind, with the profile of the real device.
fn kinds(profiles: &Profiles) -> Vec<(String, &InputProfile)> {
    let on_usb = firmware_sim::USB_KINDS.iter().map(|kind| {
        let profile = profiles
            .input(kind.profile)
            .expect("every kind names its profile");
        (kind.name.to_owned(), profile)
    });
    let on_lines = profiles
        .inputs()
        .filter(|profile| firmware_sim::usb_kind(&profile.key).is_none())
        .filter(|profile| firmware_sim::serial_device(profile).is_some())
        .map(|profile| (profile.key.clone(), profile));
    on_usb.chain(on_lines).collect()
}

fn files(folder: &str, extension: &str) -> Vec<String> {
    let mut waiting = vec![root().join(folder)];
    let mut texts = Vec::new();
    while let Some(next) = waiting.pop() {
        for entry in std::fs::read_dir(&next).expect("the folder is there") {
            let path = entry.expect("it can be read").path();
            if path.is_dir() {
                waiting.push(path);
            } else if path.extension().is_some_and(|it| it == extension) {
                texts.push(std::fs::read_to_string(&path).expect("it is text"));
            }
        }
    }
    texts
}

/// The words of a line without its time.
fn words(line: &str) -> Vec<&str> {
    let line = line.split('#').next().unwrap_or_default();
    let mut words = line.split_whitespace();
    if words
        .next()
        .is_some_and(|first| matches!(first, "at" | "by" | "within"))
    {
        words.next();
        return words.collect();
    }
    line.split_whitespace().collect()
}

/// The devices a scenario names, with their kinds.
fn devices(text: &str) -> Vec<(&str, &str)> {
    let settings = text.lines().filter_map(|line| line.strip_prefix("use "));
    let named = settings.flat_map(|line| line.split(','));
    named
        .filter_map(|thing| match thing.split_whitespace().collect::<Vec<_>>()[..] {
            ["device", name, kind] => Some((name, kind)),
            _ => None,
        })
        .collect()
}

/// What one scenario shows of a device in it.
fn in_scenario(text: &str, name: &str) -> BTreeSet<Aspect> {
    let instance = format!("{}<", name.to_uppercase());
    let lines: Vec<Vec<&str>> = text.lines().map(words).collect();
    let any = |is: &dyn Fn(&[&str]) -> bool| lines.iter().any(|line| is(line));
    let is_present = any(&|line| *line == ["device", name, "is", "present"]);
    let touched = any(&|line| line.starts_with(&["touch", name]));
    let arrived = any(&|line| {
        line.first() == Some(&"output")
            && line.get(1).is_some_and(|outlet| outlet.starts_with(&instance))
            && line.get(2) == Some(&"is")
    });
    let shows = |no: bool| {
        any(&|line| line.starts_with(&["device", name, "shows"]) && (line.get(3) == Some(&"no")) == no)
    };
    let struck = any(&|line| {
        line.starts_with(&["touch", name, "noise"])
            || (line.first() == Some(&"fault") && line.ends_with(&["on", name]))
    });
    let counted = any(&|line| line.starts_with(&["device", name, "rejected", "at", "least"]));
    let pulled = any(&|line| *line == ["unplug", name]) && any(&|line| *line == ["plug", name]);
    let proofs = [
        (Aspect::Handshake, is_present),
        (Aspect::Moves, touched && arrived),
        (Aspect::Outputs, shows(false) && shows(true)),
        (
            Aspect::Faults,
            struck && pulled && (counted || text.contains(" is lost")),
        ),
    ];
    proofs
        .into_iter()
        .filter_map(|(aspect, shown)| shown.then_some(aspect))
        .collect()
}

fn by_scenario() -> Shown {
    let mut shown = Shown::new();
    for text in files("tests/scenarios", "scn") {
        for (name, kind) in devices(&text) {
            shown
                .entry(kind.to_owned())
                .or_default()
                .extend(in_scenario(&text, name));
        }
    }
    shown
}

fn by_exchange() -> Shown {
    let mut shown = Shown::new();
    for text in files("tests/exchanges", "txt") {
        let Some(kind) = text.lines().find_map(|line| line.strip_prefix("simulator: ")) else {
            continue;
        };
        let has = |begins: &str| text.lines().any(|line| line.starts_with(begins));
        let proofs = [
            (Aspect::Handshake, has("event  started") || has("host   >")),
            (Aspect::Moves, has("hand ") && has("event ")),
            (Aspect::Outputs, has("show ") && has("host   >")),
            (
                Aspect::Faults,
                has("hand   noise") && has("device gone") && has("device back"),
            ),
        ];
        let proven = proofs
            .into_iter()
            .filter_map(|(aspect, shown)| shown.then_some(aspect));
        shown.entry(kind.trim().to_owned()).or_default().extend(proven);
    }
    shown
}

/// What a device of this profile has to be shown to do.
fn due(profile: &InputProfile, aspect: Aspect, begins_by_itself: bool) -> bool {
    match aspect {
        Aspect::Handshake => !begins_by_itself,
        Aspect::Outputs => !profile.outputs.is_empty(),
        Aspect::Moves | Aspect::Faults => true,
    }
}

#[test]
fn every_simulated_device_is_shown_to_begin_move_show_and_suffer() {
    let profiles = Profiles::builtin();
    let shown = [("scenario", by_scenario()), ("exchange", by_exchange())];
    let mut table = String::new();
    let mut missing = Vec::new();
    for (kind, profile) in kinds(&profiles) {
        let _ = write!(table, "\n{kind:22}");
        for aspect in ASPECTS {
            for (by, shown) in &shown {
                // Nobody needs to say anything to a device on USB whose profile asks for nothing.
                let silent =
                    *by == "exchange" && firmware_sim::usb_kind(&kind).is_some() && profile.init.is_empty();
                let there = shown.get(&kind).is_some_and(|aspects| aspects.contains(&aspect));
                let is_due = due(profile, aspect, silent);
                let _ = write!(
                    table,
                    " {}",
                    if there {
                        "yes"
                    } else if is_due {
                        "NO "
                    } else {
                        " - "
                    }
                );
                if is_due && !there {
                    missing.push(format!("{kind}: no {by} shows its {aspect:?}"));
                }
            }
        }
    }
    assert!(
        missing.is_empty(),
        "{}\n\n(handshake, moves, outputs, faults; each by scenario and exchange){table}",
        missing.join("\n")
    );
}

/// Otherwise the test above could not fail.
#[test]
fn a_scenario_that_shows_nothing_is_not_taken_for_a_proof() {
    let text = "use device knob powermate\nby 1.0 device knob is present\nat 1 touch knob dial 0 +1\n";
    assert_eq!(devices(text), [("knob", "powermate")]);
    assert_eq!(in_scenario(text, "knob"), BTreeSet::from([Aspect::Handshake]));
    let more =
        format!("{text}within 0.1 output KNOB<1> is 0.01\nat 2 fault short on knob\nat 3 unplug knob\n");
    let found = in_scenario(&more, "knob");
    assert_eq!(found, BTreeSet::from([Aspect::Handshake, Aspect::Moves]));
}
