//! What events of each kind of control become.

use super::*;

fn group(kind: &str, more: &str) -> Group {
    // As a profile's file would say it.
    let text = format!("kind = \"{kind}\"\nname = \"it\"\n{more}");
    toml::from_str(&text).expect("a control")
}

fn at(secs: f64) -> At {
    At {
        secs,
        step: (secs * 100.0) as u64,
        fine: false,
    }
}

fn real(value: Option<Value>) -> Option<f64> {
    value.and_then(|value| value.as_number())
}

#[test]
fn dials_send_turns_in_their_gear() {
    let mut dial = Control::new(1, &group("dial", "counts_per_turn = 24.0"), 0);
    assert_eq!(real(Some(dial.turned(6, at(0.0)))), Some(0.25));
    dial.gear.factor = -2.0;
    assert_eq!(real(Some(dial.turned(6, at(1.0)))), Some(-0.5));
    let fine = At {
        fine: true,
        ..at(2.0)
    };
    assert!((real(Some(dial.turned(6, fine))).unwrap_or(0.0) + 0.05).abs() < 1e-12);
    assert_eq!(dial.value, 0.75, "where it is has no gear");
}

#[test]
fn faders_send_shares_once_they_are_picked_up() {
    let mut fader = Control::new(1, &group("fader", "range = [0, 127]"), 0);
    fader.target = Some(0.5);
    assert_eq!(real(fader.stands(0, at(0.0))), None);
    assert_eq!(real(fader.stands(20, at(1.0))), None);
    assert_eq!(real(fader.stands(64, at(2.0))), Some(64.0 / 127.0));
    assert!(fader.picked_up());
    assert_eq!(fader.lost(), None, "what it drives stays");
    assert!(!fader.picked_up());
    assert_eq!(real(fader.stands(127, at(3.0))), None);
}

#[test]
fn noise_is_no_movement_and_the_ends_are_reached() {
    let mut knob = Control::new(1, &group("knob", "range = [0, 1023]\nnoise_share = 0.02"), 0);
    knob.set_mode("jump");
    let places = [500, 510, 490, 505, 540, 1015, 1023];
    let sent: Vec<bool> = (0..)
        .zip(places)
        .map(|(n, it)| knob.stands(it, at(f64::from(n))).is_some())
        .collect();
    assert_eq!(sent, [false, false, false, false, true, true, true]);
}

#[test]
fn what_springs_back_is_let_go_with_its_device() {
    let mut axis = Control::new(1, &group("axis", "range = [-350, 350]\ndead_zone = 35"), 0);
    assert_eq!(real(axis.stands(20, at(0.0))), None);
    assert_eq!(real(axis.stands(350, at(0.1))), Some(1.0));
    assert_eq!(real(axis.lost()), Some(0.0));
    assert_eq!(axis.lost(), None);
}

#[test]
fn a_ring_is_turned_the_short_way_round() {
    let mut ring = Control::new(1, &group("ring", "range = [0, 71]"), 0);
    assert_eq!(ring.fingered(Some(70), at(0.0)), None, "a finger lands");
    assert_eq!(real(ring.fingered(Some(1), at(1.0))), Some(3.0 / 72.0));
    assert_eq!(real(ring.fingered(Some(71), at(2.0))), Some(-2.0 / 72.0));
    assert_eq!(ring.fingered(None, at(3.0)), None);
    assert_eq!(ring.fingered(Some(30), at(4.0)), None);
}

#[test]
fn a_strip_goes_as_far_as_the_finger() {
    let mut strip = Control::new(1, &group("strip", "range = [0, 100]"), 0);
    strip.target = Some(0.5);
    assert_eq!(strip.fingered(Some(90), at(0.0)), None);
    let sent = real(strip.fingered(Some(80), at(1.0))).expect("it was moved");
    assert!((sent - 0.4).abs() < 1e-12);
    strip.fingered(None, at(2.0));
    strip.target = Some(0.4);
    assert_eq!(
        strip.fingered(Some(10), at(3.0)),
        None,
        "another finger, another place"
    );
}

#[test]
fn modes_are_taken_by_their_words() {
    let mut fader = Control::new(1, &group("fader", "range = [0, 127]"), 0);
    assert!(fader.set_mode("SCALED") && !fader.set_mode("toggle") && fader.set_mode(""));
    assert_eq!(fader.mode(), "pickup");
    let mut button = Control::new(1, &group("button", ""), 0);
    assert!(button.set_mode("toggle") && !button.set_mode("jump"));
    let mut dial = Control::new(1, &group("dial", "counts_per_turn = 1.0"), 0);
    assert!(!dial.set_mode("jump"));
}
