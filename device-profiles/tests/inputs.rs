//! The shipped input devices, held to what their schema cannot say.

use device_profiles::{ControlClass, Emits, FORMATS, FieldName, InputProfile, Profiles, Quirk};
use std::collections::{BTreeMap, BTreeSet};

fn all() -> Profiles {
    Profiles::builtin()
}

#[test]
fn there_are_at_least_forty() {
    let count = all().inputs().count();
    assert!(count >= 40, "{count}");
}

#[test]
fn no_two_claim_one_device() {
    let all = all();
    let inputs: Vec<&InputProfile> = all.inputs().collect();
    let mut wrong = Vec::new();
    for (at, one) in inputs.iter().enumerate() {
        for other in &inputs[at + 1..] {
            for a in &one.matches {
                for b in other.matches.iter().filter(|b| a.overlaps(b)) {
                    wrong.push(format!("{} and {}: {a:?} and {b:?}", one.key, other.key));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Otherwise the test above could not fail.
#[test]
fn two_claims_are_told_apart_by_what_both_say_and_by_nothing_else() {
    let all = all();
    let of = |key: &str| all.input(key).unwrap().matches[0].clone();
    let hs610 = of("hs610");
    assert!(hs610.overlaps(&hs610));
    assert!(!hs610.overlaps(&of("hs611")), "another string 201");
    let mut nameless = hs610.clone();
    nameless.strings.clear();
    assert!(nameless.overlaps(&hs610), "one that does not ask may be either");
    let mut shorter = nameless.clone();
    shorter.input_report_bytes = vec![8];
    assert!(!shorter.overlaps(&hs610), "another length");
    let mut not = nameless.clone();
    not.not_strings = BTreeMap::from([(201, vec!["HUION_T1".to_owned()])]);
    assert!(!not.overlaps(&hs610), "a string it must not have");
    let mut prefix = hs610.clone();
    prefix.strings = BTreeMap::from([(201, "HUION_".to_owned())]);
    assert!(prefix.overlaps(&hs610), "the beginning of the other's");
    assert!(!of("graphire-serial").overlaps(&of("digitizer-ii")));
    assert!(of("deej").by_hand_only() && !of("deej").overlaps(&of("deej")));
}

/// Devices that share an id say so, and what says so shares one.
#[test]
fn shared_ids_are_named_as_a_quirk() {
    let all = all();
    let mut claims: BTreeMap<String, BTreeSet<&str>> = BTreeMap::new();
    for input in all.inputs() {
        for id in input.ids() {
            claims.entry(id).or_default().insert(&input.key);
        }
    }
    // Interfaces of one device, told apart by their length, are no other device.
    let of_one_maker_by_length = |id: &str| id.starts_with("056a:");
    for (id, keys) in claims.iter().filter(|(id, _)| !of_one_maker_by_length(id)) {
        for key in keys.iter().filter(|_| keys.len() > 1) {
            let quirks = &all.input(key).unwrap().quirks;
            assert!(
                quirks.contains(&Quirk::SharedIds),
                "{key} shares {id} with {keys:?}"
            );
        }
    }
}

#[test]
fn every_format_is_used_and_has_a_name_a_page_can_have() {
    let all = all();
    let used: BTreeSet<&str> = all.inputs().map(|p| p.format.as_str()).collect();
    assert_eq!(used.into_iter().collect::<Vec<_>>(), FORMATS);
}

#[test]
fn every_layout_is_used_and_quirks_stand_once() {
    let all = all();
    let used: BTreeSet<&str> = all.inputs().filter_map(|p| p.layout.as_deref()).collect();
    let there: BTreeSet<&str> = all.layouts().map(|l| l.key.as_str()).collect();
    assert_eq!(used, there);
    for input in all.inputs() {
        let once: BTreeSet<_> = input.quirks.iter().collect();
        assert_eq!(once.len(), input.quirks.len(), "{}", input.key);
    }
}

/// Fields speak of controls that the profile has, and of every one of them.
#[test]
fn reports_and_controls_agree() {
    let all = all();
    let mut wrong = Vec::new();
    for input in all.inputs().filter(|p| p.format == "hid") {
        let reports = input.reports(&all).unwrap();
        if reports.reports.is_empty() {
            wrong.push(format!("{}: no reports", input.key));
        }
        let mut told: BTreeMap<ControlClass, BTreeSet<u16>> = BTreeMap::new();
        for field in reports.reports.iter().flat_map(|r| &r.fields) {
            for row in 0..field.repeat.map_or(1, |r| r.count) {
                let (class, number) = match field.name.on_by(row) {
                    FieldName::Key(n) => (ControlClass::Button, n),
                    FieldName::Dial(n) => (ControlClass::Dial, n),
                    FieldName::Axis(n) => (ControlClass::Axis, n),
                    FieldName::Ring(n) => (ControlClass::Ring, n),
                    _ => continue,
                };
                told.entry(class).or_default().insert(number);
            }
        }
        for class in [
            ControlClass::Button,
            ControlClass::Dial,
            ControlClass::Axis,
            ControlClass::Ring,
        ] {
            let told = told.get(&class).cloned().unwrap_or_default();
            // A layout may tell of more than the smallest of its tablets has; never of less.
            let missing: Vec<u16> = (1..=input.count(class)).filter(|n| !told.contains(n)).collect();
            if !missing.is_empty() {
                wrong.push(format!("{}: no report tells of {class:?} {missing:?}", input.key));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// A tablet has an area and a tool; what tells a place is told where that ends.
#[test]
fn tablets_have_areas_tools_and_ways_to_leave() {
    let all = all();
    let mut wrong = Vec::new();
    for input in all.inputs() {
        let reports = input.reports(&all).unwrap();
        let names: BTreeSet<FieldName> = reports
            .reports
            .iter()
            .flat_map(|r| &r.fields)
            .map(|f| f.name)
            .collect();
        let tablet = input.kind == device_profiles::InputKind::Tablet;
        if tablet && (input.surface.is_none() || input.tools.is_empty()) {
            wrong.push(format!("{}: no surface or no tool", input.key));
        }
        if tablet && input.format == "hid" {
            let leaves = reports.leave_after_ms.is_some()
                || names.contains(&FieldName::InRange)
                || reports.reports.iter().any(|r| r.emits == Emits::Leave);
            let tip = names.contains(&FieldName::Tip) || input.area().tip_pressure.is_some();
            let mouse_or_bits = input.area().pressure == 0;
            if !leaves || !(tip || mouse_or_bits) {
                wrong.push(format!("{}: never leaves, or its tip is never down", input.key));
            }
            let tilts = names.contains(&FieldName::TiltX);
            if input.area().tilt() && !tilts {
                wrong.push(format!("{}: tilt in its surface, none in its reports", input.key));
            }
        }
        for (field, there) in [("line", input.line.is_some()), ("baud", input.baud() > 0)] {
            let serial = input
                .matches
                .iter()
                .any(|m| m.bus == device_profiles::Bus::Serial);
            if serial != there {
                wrong.push(format!("{}: {field} and serial go together", input.key));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
