//! Every example of `docs/simulator.md` reads, and is seen: a conversation with it differs from one without.

use super::*;
use proptest::prelude::*;

/// Servos on the bus: enough that every example has one before and one behind it.
const IDS: [u8; 4] = [1, 2, 3, 4];
/// The page.
const PAGE: &str = include_str!("../../../../docs/simulator.md");

/// Lines of the page's blocks of faults.
fn examples() -> Vec<&'static str> {
    let mut inside = false;
    let mut found = Vec::new();
    for line in PAGE.lines() {
        match line {
            "```faults" => inside = true,
            "```" => inside = false,
            _ if inside => found.push(line),
            _ => {}
        }
    }
    found
}

/// What a host hears in a second of everything, with the time of every byte to `poll_us`.
fn conversation(faults: &[&str], poll_us: u64) -> Vec<(u64, u8)> {
    let profiles = Profiles::builtin();
    let mut bus = ServoBus::new(BusOptions {
        seed: 11,
        ..BusOptions::default()
    });
    let unit = |id| Unit {
        return_delay_us: Some(100),
        plant: PlantKind::Real,
        ..Unit::new(id)
    };
    for id in IDS {
        bus.add(profiles.servo("xl430-w250").expect("shipped"), unit(id))
            .expect("fits");
    }
    bus.add(profiles.servo("sts3215").expect("shipped"), unit(5))
        .expect("fits");
    for text in faults {
        let fault = Fault::parse(text).unwrap_or_else(|error| panic!("{text}: {error}"));
        assert_eq!(bus.misfit(&fault), None, "{text}");
        bus.inject(0, &fault);
    }
    let mut host = Recording {
        bus,
        now_us: 0,
        heard: Vec::new(),
        poll_us,
    };
    host.say(&packet(254, 3, &[64, 0, 1]));
    for turn in 0..25u32 {
        let goal = if turn < 12 { 2300u32 } else { 1900 };
        host.say(&packet(254, 3, &[&[116, 0][..], &goal.to_le_bytes()].concat()));
        for id in IDS {
            host.say(&packet(id, 1, &[]));
            host.say(&write(id, 65, &[1]));
        }
        host.say(&packet(254, 0x82, &[&[120, 0, 27, 0][..], &IDS].concat()));
        host.say(&packet(254, 0x8A, &[&[120, 0, 27, 0][..], &IDS].concat()));
        host.say(&read(3, 0, 20));
        // Servo 5: its lock off for the first half, on for the second.
        if turn == 0 || turn == 12 {
            host.say(&summed(5, 3, &[55, u8::from(turn > 0)]));
        }
        host.say(&summed(5, 3, &[42, 0, 8]));
        host.say(&summed(5, 2, &[55, 15]));
    }
    host.heard
}

/// A packet of the framing with a sum.
fn summed(id: u8, code: u8, params: &[u8]) -> Vec<u8> {
    let mut packet = vec![0xFF, 0xFF, id, params.len() as u8 + 2, code];
    packet.extend_from_slice(params);
    let sum = packet[2..].iter().fold(0u8, |sum, &byte| sum.wrapping_add(byte));
    packet.push(!sum);
    packet
}

struct Recording {
    bus: ServoBus,
    now_us: u64,
    heard: Vec<(u64, u8)>,
    poll_us: u64,
}

impl Recording {
    fn say(&mut self, bytes: &[u8]) {
        self.bus.receive(self.now_us, bytes);
        let mut out = Vec::new();
        for _ in 0..4000 / self.poll_us {
            self.now_us += self.poll_us;
            self.bus.transmit(self.now_us, &mut out);
            let now_us = self.now_us;
            self.heard.extend(out.drain(..).map(|byte| (now_us, byte)));
        }
    }
}

#[test]
fn every_example_of_the_page_reads_and_is_seen() {
    let examples = examples();
    assert!(examples.len() > 40, "{}", examples.len());
    let healthy = conversation(&[], 100);
    assert!(
        conversation(&[], 100) == healthy,
        "nothing but the fault may make a difference"
    );
    for text in examples {
        assert!(
            conversation(&[text], 100) != healthy,
            "{text} makes no difference"
        );
        let fault = Fault::parse(text).expect(text);
        assert_eq!(Fault::parse(&fault.to_string()), Ok(fault), "{text} as {fault}");
    }
}

#[test]
fn every_word_the_parser_knows_is_on_the_page() {
    for word in crate::servo_bus::fault::words_of_faults() {
        assert!(
            PAGE.contains(&format!("`{word}")) || PAGE.contains(&format!(" {word}")),
            "{word} is not on the page"
        );
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn whatever_goes_wrong_together_how_calls_are_cut_up_changes_no_byte(picks in proptest::collection::vec(any::<prop::sample::Index>(), 2..6)) {
        let examples = examples();
        let faults: Vec<&str> = picks.iter().map(|pick| *pick.get(&examples)).collect();
        let bytes = |poll_us| -> Vec<u8> {
            conversation(&faults, poll_us).into_iter().map(|(_, byte)| byte).collect()
        };
        prop_assert!(bytes(4000) == bytes(500), "{faults:?}");
    }
}
