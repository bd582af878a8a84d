//! Costs against the rates of the protocols' documents, and the page against the kinds. What findings come from
//! which trouble is shown on simulated servos (`host/bench/tests/doctor.rs`).

use super::cost::Cycle;
use super::*;
use device_profiles::{Profiles, Role};
use std::fmt::Write as _;

/// So many XL430 that answer, all alike.
fn seen(count: u8, baud: u32, delay_counts: i64, firmware: u8) -> Seen {
    let profile = Profiles::builtin().servo("XL430-W250").unwrap().clone();
    let patients = (1..=count).map(|id| Patient {
        id,
        model_number: profile.model_number,
        firmware,
        profile: Some(profile.clone()),
        registers: vec![(Role::ReturnDelay, delay_counts)],
        volts: vec![11.0],
        asked: 20,
        lost: 0,
    });
    Seen {
        bus: "arm".into(),
        port: "/dev/ttyUSB0".into(),
        baud,
        patients: patients.collect(),
        strays: Vec::new(),
        garbled_ids: Vec::new(),
        echo: false,
        asked: 20,
        lost: 0,
        damaged: 0,
        held_back_secs: Some(0.0),
        timer_ms: None,
    }
}

/// Cycles a second of a plain and of a fast bus: bytes of the packet formats times ten bits, and the delays.
#[test]
fn a_cycle_costs_what_its_bytes_and_delays_take() {
    const OLD: u8 = 40;
    const NEW: u8 = 50;
    for (count, baud, delay, firmware, hz) in [
        (6, 1_000_000, 0, OLD, 649),
        (6, 1_000_000, 0, NEW, 833),
        (20, 1_000_000, 0, OLD, 223),
        (20, 1_000_000, 0, NEW, 316),
        (20, 1_000_000, 250, OLD, 69),
        (20, 1_000_000, 250, NEW, 273),
        (20, 57_600, 0, OLD, 13),
        (20, 4_000_000, 0, NEW, 1266),
    ] {
        let cycle = Cycle::now(&seen(count, baud, delay, firmware));
        assert_eq!(cycle.hz().round() as i64, hz, "{count} at {baud}, delay {delay}");
    }
}

#[test]
fn costs_are_in_milliseconds_and_hertz() {
    let mut seen = seen(20, 1_000_000, 0, 40);
    seen.patients[2].registers = vec![(Role::ReturnDelay, 250)];
    let found = judge(&seen, &Expected::nobody(&Profiles::builtin()));
    let delay = found
        .iter()
        .find(|finding| finding.kind == Kind::ReturnDelay)
        .unwrap();
    assert_eq!(delay.id, Some(3));
    assert_eq!(
        delay.costs,
        "0.50 ms of a cycle of 4.98 ms: 201 Hz instead of 223 Hz"
    );
    let fix = Fix::Register {
        id: 3,
        role: Role::ReturnDelay,
        value: 0,
    };
    assert_eq!(delay.fix, Some(fix));
    seen.timer_ms = Some(16);
    let found = judge(&seen, &Expected::nobody(&Profiles::builtin()));
    assert_eq!(found[0].kind, Kind::AdapterLatency);
    assert_eq!(
        found[0].costs,
        "up to 16.00 ms in every cycle: at most 48 Hz where 167 Hz could be"
    );
}

/// Feetech's lock rests shut and AX's open; each is found where it does not rest.
#[test]
fn a_lock_is_found_where_it_does_not_rest() {
    for (model, lock, fixable) in [
        ("STS3215", 1, None),
        ("STS3215", 0, Some(true)),
        ("AX-12A", 0, None),
        ("AX-12A", 1, Some(false)),
    ] {
        let profile = Profiles::builtin().servo(model).unwrap().clone();
        let mut seen = seen(1, 1_000_000, 0, 50);
        seen.patients[0] = Patient {
            model_number: profile.model_number,
            profile: Some(profile),
            registers: vec![(Role::Lock, lock)],
            volts: Vec::new(),
            ..seen.patients[0].clone()
        };
        let found = judge(&seen, &Expected::nobody(&Profiles::builtin()));
        let told: Vec<_> = found
            .iter()
            .map(|finding| (finding.kind, finding.fix.is_some()))
            .collect();
        let expected: Vec<_> = fixable.map(|fixable| (Kind::Lock, fixable)).into_iter().collect();
        assert_eq!(told, expected, "{model} with lock {lock}");
    }
}

/// The page's table is made from the kinds; `UPDATE_PAGES=1` writes it anew.
#[test]
fn the_page_lists_every_kind() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/doctor.md");
    let page = std::fs::read_to_string(&path).unwrap().replace("\r\n", "\n");
    let (begin, end) = ("<!-- kinds -->\n", "<!-- end of kinds -->");
    let (before, rest) = page.split_once(begin).unwrap();
    let (_, after) = rest.split_once(end).unwrap();
    let mut table = String::from(
        "| finding | what is wrong | what it costs | what to do | `--fix` |\n|---|---|---|---|---|\n",
    );
    for kind in Kind::all() {
        let fixable = if kind.is_fixable() { "yes" } else { "" };
        let _ = writeln!(
            table,
            "| `{}` | {} | {} | {} | {fixable} |",
            kind.name(),
            kind.meaning(),
            kind.costs(),
            kind.remedy()
        );
    }
    let made = format!("{before}{begin}{table}{end}{after}");
    if std::env::var_os("UPDATE_PAGES").is_some_and(|set| set == "1") {
        std::fs::write(&path, &made).unwrap();
        return;
    }
    assert!(
        made == page,
        "docs/doctor.md is not what the kinds say; write it with: UPDATE_PAGES=1 cargo test -p device doctor"
    );
}
