//! `networks/pickup-banks.ps300` against the table of soft takeover: p the value, q where the fader was, n where it is.
//!
//! | q and n relative to p | q | n | timing | |
//! |---|---|---|---|---|
//! | any | any | near | any | takes hold |
//! | opposite sides | any | far | within 50 ms | takes hold |
//! | opposite sides | any | far | late | swallowed |
//! | same side | near | far | within 50 ms | takes hold |
//! | same side | near | far | late | swallowed |
//! | same side | far | far | any | swallowed |
//!
//! Source: Mixxx, `src/controllers/softtakeover.cpp`.

use ps300::language::Input;

use crate::hands::{Draws, Hands};

const NEAR: f64 = 3.0 / 128.0;
const NAMES: [[&str; 4]; 4] = [
    ["ArmTurn", "ArmTilt", "Elbow", "Wrist"],
    ["LegTurn", "LegTilt", "Knee", "Ankle"],
    ["Neck", "Look", "Nod", "Jaw"],
    ["Light", "Hue", "Zoom", "Roll"],
];

/// One value, and what its hold remembers of the fader.
#[derive(Clone, Copy)]
struct Held {
    value: f64,
    /// Where the fader was when it last spoke to this value.
    was: Option<f64>,
    /// When it last had hold, in fiftieths of a second.
    accepted: Option<u64>,
}

impl Held {
    fn hear(&mut self, now: f64, frame: u64) -> bool {
        let is_near = |at: f64| (at - self.value).abs() <= NEAR;
        // Frames are 20 ms apart: two of them are within 50 ms, three are late.
        let quick = self.accepted.is_some_and(|accepted| frame - accepted <= 2);
        let taken = match self.was {
            None => false,
            Some(was) => {
                let opposite = (was - self.value) * (now - self.value) < 0.0;
                is_near(now) || (quick && (opposite || is_near(was)))
            }
        };
        self.was = Some(now);
        if taken {
            self.value = now;
            self.accepted = Some(frame);
        }
        taken
    }
}

struct Model {
    banks: [[Held; 4]; 4],
    faders: [f64; 4],
    bank: usize,
}

impl Model {
    fn label(&self, fader: usize) -> String {
        let gap = self.banks[self.bank][fader].value - self.faders[fader];
        let arrow = if gap > NEAR {
            ">"
        } else if gap < -NEAR {
            "<"
        } else {
            ""
        };
        format!("{}{arrow}", NAMES[self.bank][fader])
    }
}

/// The bank and fader, from 0, of `value_B_N`.
fn place(name: &str) -> Option<(usize, usize)> {
    let (bank, fader) = name.strip_prefix("value_")?.split_once('_')?;
    Some((bank.parse::<usize>().ok()? - 1, fader.parse::<usize>().ok()? - 1))
}

/// Sends to an instance of the network, and lets a frame pass.
fn send(hands: &mut Hands, name: &str, value: f64) {
    let sent = hands.machine.send(name, Input::Number(1), value);
    assert!(sent.is_ok(), "{name}: {sent:?}");
    hands.rest();
}

fn page() -> (Hands, Model) {
    let mut hands = Hands::on(&["pickup-banks.ps300"]);
    for bank in 1..=4 {
        for fader in 1..=4 {
            assert!(hands.machine.watch(&format!("value_{bank}_{fader}"), 1));
        }
    }
    let unheard = Held {
        value: 0.5,
        was: None,
        accepted: None,
    };
    let model = Model {
        banks: [[unheard; 4]; 4],
        faders: [0.0; 4],
        bank: 0,
    };
    (hands, model)
}

#[test]
fn values_move_when_the_table_says_so_and_labels_tell_where_to_look() {
    let (mut hands, mut model) = page();
    let mut draws = Draws(128);
    let mut frame = 0;
    let mut taken = 0;
    for step in 0..4000 {
        frame += 1;
        let mut expected = Vec::new();
        match draws.below(40) {
            0 => {
                model.bank = draws.below(4) as usize;
                hands.press(model.bank as i32 + 1);
            }
            1 => {
                let (bank, fader) = (draws.below(4) as usize, draws.below(4) as usize);
                let value = draws.below(129) as f64 / 128.0;
                send(&mut hands, &format!("set_{}_{}", bank + 1, fader + 1), value);
                model.banks[bank][fader].value = value;
                expected.push(((bank, fader), value));
            }
            2..=6 => hands.rest(),
            _ => {
                // Mostly small steps of one fader, at times a large one.
                let fader = if draws.below(4) == 0 {
                    draws.below(4) as usize
                } else {
                    0
                };
                let far = if draws.below(6) == 0 { 0.5 } else { 0.05 };
                let now = (model.faders[fader] + far * draws.unit()).clamp(0.0, 1.0);
                send(&mut hands, &format!("fader_{}", fader + 1), now);
                model.faders[fader] = now;
                if model.banks[model.bank][fader].hear(now, frame) {
                    taken += 1;
                    expected.push(((model.bank, fader), now));
                }
            }
        }
        let seen: Vec<_> = hands.machine.drain_watched().collect();
        let moved: Vec<_> = seen
            .iter()
            .filter_map(|seen| Some((place(seen.name.as_str())?, seen.value.as_number()?)))
            .collect();
        assert_eq!(moved, expected, "step {step}");
        for fader in 0..4 {
            let label = &hands.machine.panel().dial_labels[fader];
            assert_eq!(*label, model.label(fader), "step {step}, fader {fader}");
        }
        assert_eq!(hands.machine.panel().lamps, 1 << model.bank);
    }
    assert!(taken > 200, "the faders got hold of a value {taken} times only");
    assert_eq!(hands.machine.reports(), []);
}

#[test]
fn a_bank_that_comes_back_does_not_jump() {
    let (mut hands, _) = page();
    let value = |hands: &mut Hands| {
        let seen: Vec<_> = hands.machine.drain_watched().collect();
        seen.last().and_then(|seen| seen.value.as_number())
    };
    // Up to the value, hold of it, and on to 0.8.
    for step in 0..=16 {
        send(&mut hands, "fader_1", f64::from(step) * 0.05);
    }
    assert_eq!(value(&mut hands), Some(0.8));
    assert_eq!(hands.machine.panel().dial_labels[0], "ArmTurn");
    hands.press(2);
    for step in (0..=16).rev() {
        send(&mut hands, "fader_1", f64::from(step) * 0.05);
        hands.rest();
        hands.rest();
    }
    hands.press(1);
    value(&mut hands);
    assert_eq!(hands.machine.panel().dial_labels[0], "ArmTurn>");
    for step in 0..15 {
        send(&mut hands, "fader_1", f64::from(step) * 0.05);
        assert_eq!(value(&mut hands), None, "{step}");
    }
    send(&mut hands, "fader_1", 0.79);
    assert_eq!(value(&mut hands), Some(0.79));
    assert_eq!(hands.machine.panel().dial_labels[0], "ArmTurn");
}
