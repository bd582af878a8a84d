//! What the network sends to the outputs of real profiles, as feedback.

use super::inlets::Inlet;
use super::*;
use device::codec::Picture;
use device_profiles::Profiles;
use glam::DVec3;

/// What a device is told after these messages came to its inlets.
struct Told {
    controls: Controls,
}

impl Told {
    fn new(profile: &str) -> Self {
        let profiles = Profiles::builtin();
        let mut controls = Controls::default();
        let at = controls.add("it", profiles.input(profile).expect("it is built in"));
        controls.instances[at].present = true;
        let mut told = Self { controls };
        told.after(&[]);
        told
    }

    fn after(&mut self, messages: &[(Inlet, u8, Value)]) -> Vec<Feedback> {
        for (inlet, number, value) in messages {
            self.controls.instances[0]
                .take(*inlet, *number, Some(value))
                .expect("it takes that");
        }
        let mut told = Vec::new();
        self.controls.show(&Panel::default(), 1.0, &mut |_, feedback| {
            told.push(feedback.clone());
        });
        told
    }
}

fn colour(r: f64, g: f64, b: f64) -> Value {
    Value::Vector3(DVec3::new(r, g, b))
}

#[test]
fn a_lamp_has_the_colour_it_is_told() {
    let mut told = Told::new("launch-control-xl");
    let lamp = |level, colour| Feedback::Lamp {
        control: 0,
        level,
        colour,
    };
    let on = (Inlet::Lamp(1), 1, Value::Boolean(true));
    assert_eq!(told.after(&[on]), [lamp(255, None)]);
    let green = || (Inlet::Colour(1), 1, colour(0.0, 1.0, 0.0));
    assert_eq!(told.after(&[green()]), [lamp(255, Some([0, 255, 0]))]);
    assert_eq!(told.after(&[green()]), []);
    let half = (Inlet::Lamp(1), 1, Value::Real(0.5));
    assert_eq!(told.after(&[half]), [lamp(128, Some([0, 255, 0]))]);
}

/// The second key of a Stream Deck + is its sixth control and its sixth picture; brightness is the device's.
#[test]
fn a_key_has_a_colour_under_its_label_and_a_deck_a_brightness() {
    let mut told = Told::new("stream-deck-plus");
    let picture = Picture::new(1, 1, vec![255, 51, 0]).expect("a pixel");
    assert_eq!(
        told.after(&[(Inlet::Colour(1), 6, colour(1.0, 0.2, 0.0))]),
        [Feedback::Picture { control: 5, picture }]
    );
    let label = Feedback::Label {
        control: 5,
        text: "Elbow".to_owned(),
    };
    assert_eq!(
        told.after(&[(Inlet::Label(1), 6, Value::String("Elbow".into()))]),
        [label]
    );
    // 4 dials, 8 keys, 4 pushes and the strip come before what is the whole device's.
    let level = Feedback::Level {
        control: 0,
        level: 64,
    };
    assert_eq!(told.after(&[(Inlet::Level(1), 18, Value::Real(0.25))]), [level]);
}

#[test]
fn clicks_are_felt_each_time_and_only_then() {
    let mut told = Told::new("surface-dial");
    let clicks = |clicks| Feedback::Haptic {
        control: 0,
        clicks,
        apart_ms: 120,
    };
    let three = || (Inlet::Haptic, 1, Value::Integer(3));
    assert_eq!(told.after(&[three()]), [clicks(3)]);
    assert_eq!(told.after(&[]), []);
    assert_eq!(told.after(&[three()]), [clicks(3)]);
    assert_eq!(
        told.after(&[(Inlet::Haptic, 1, Value::Boolean(true))]),
        [clicks(1)]
    );
    assert_eq!(told.after(&[(Inlet::Haptic, 1, Value::Boolean(false))]), []);
}

#[test]
fn the_second_of_a_name_that_ends_with_a_digit_is_told_apart() {
    let profiles = Profiles::builtin();
    let mut controls = Controls::default();
    for device in ["nano2", "nano2", "nano", "nano"] {
        controls.add(device, profiles.input("powermate").expect("it is built in"));
    }
    let names: Vec<_> = controls.instances.iter().map(|it| it.name.as_str()).collect();
    assert_eq!(names, ["NANO2", "NANO2_2", "NANO", "NANO3"]);
}
