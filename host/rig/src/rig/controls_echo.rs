//! What devices show is never an answer to the hand that moves them, and always what it should be in the end.

use std::collections::BTreeMap;

use device::codec::Feedback;
use proptest::prelude::*;

use super::bench::Bench;
use super::*;

/// Both faders, with their motors, on the view; the dial, with its ring, on its turn as well; the button's lamp by the
/// network.
const PROGRAM: &str = "s := F:MULC; SEND 360 TO <2>s; a := F:ADDC; SEND -180 TO <2>a;
    CONNECT NANO<1>:<1>s; CONNECT s<1>:<1>a; CONNECT a<1>:<5>VIEW;
    t := F:MULC; SEND 180 TO <2>t; b := F:ADDC; SEND -90 TO <2>b;
    CONNECT NANO<2>:<1>t; CONNECT t<1>:<1>b; CONNECT b<1>:<6>VIEW;
    d := F:MULC; SEND 90 TO <2>d; CONNECT NANO<3>:<1>d; CONNECT d<1>:<1>VIEW;
    CONNECT NANO<4>:<4>NANO_LAMP;";
/// Longer than a hand counts as being on a control that does not tell.
const REST_SECS: f64 = 0.3;

#[derive(Clone, Debug)]
enum Traffic {
    /// A fader goes there, told by so many reports, one a step.
    Fader(u16, i32, u8),
    /// A finger comes onto a fader, or leaves it.
    Finger(u16, bool),
    Dial(i32),
    Button(bool),
    /// Somebody else turns the view.
    Elsewhere(f64),
    Wait(u8),
    Replug,
}

fn traffic() -> impl Strategy<Value = Traffic> {
    prop_oneof![
        6 => (0..2_u16, 0..=1000, 1..6_u8).prop_map(|(fader, to, reports)| Traffic::Fader(fader, to, reports)),
        2 => (0..2_u16, any::<bool>()).prop_map(|(fader, down)| Traffic::Finger(fader, down)),
        2 => (-40..=40).prop_map(Traffic::Dial),
        1 => any::<bool>().prop_map(Traffic::Button),
        3 => (-170.0..170.0_f64).prop_map(Traffic::Elsewhere),
        3 => (1..50_u8).prop_map(Traffic::Wait),
        1 => Just(Traffic::Replug),
    ]
}

/// What the device can be seen to show: the last of each, and how a motor's fader is moved by it.
#[derive(Default)]
struct Device {
    places: [Option<i32>; 2],
    fingers: [bool; 2],
    last_moved: [f64; 2],
    shown: BTreeMap<String, Feedback>,
}

impl Device {
    /// Takes what it was told; what nobody may tell it now, in words.
    fn take(&mut self, told: &[Feedback], secs: f64) -> Result<(), String> {
        for feedback in told {
            let key = match feedback {
                Feedback::Motor { control, value } => {
                    let fader = usize::from(*control);
                    if self.fingers[fader] {
                        return Err(format!("motor {control} against a finger"));
                    }
                    if secs - self.last_moved[fader] < 0.1 {
                        return Err(format!("motor {control} to the hand that moves it"));
                    }
                    if self.places[fader] == Some(*value) {
                        return Err(format!("motor {control} to where it is, {value}"));
                    }
                    self.places[fader] = Some(*value);
                    format!("motor {control}")
                }
                Feedback::Ring { control, .. } => format!("ring {control}"),
                Feedback::Lamp { control, .. } => format!("lamp {control}"),
                Feedback::Label { control, .. } => format!("label {control}"),
                other => return Err(format!("{other:?}")),
            };
            if self.shown.get(&key) == Some(feedback) && !key.starts_with("motor") {
                return Err(format!("{key} is told twice: {feedback:?}"));
            }
            self.shown.insert(key, feedback.clone());
        }
        Ok(())
    }
}

fn steps(bench: &mut Bench, device: &mut Device, count: u32, secs: &mut f64) -> Result<(), String> {
    for _ in 0..count {
        bench.shown.clear();
        bench.step(&[]);
        *secs += 0.01;
        device.take(&bench.shown, *secs)?;
    }
    Ok(())
}

/// Where each fader has to be for the view as it stands, counts.
fn wanted(bench: &Bench) -> [f64; 2] {
    let view = &bench.seen.view;
    let [turn, tilt] = [view.azimuth_rad, view.elevation_rad].map(f64::to_degrees);
    [(turn + 180.0) / 360.0 * 1000.0, (tilt + 90.0) / 180.0 * 1000.0]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn feedback_never_echoes_and_comes_to_rest_where_things_stand(all in prop::collection::vec(traffic(), 1..40)) {
        let mut bench = Bench::new(PROGRAM);
        let (mut device, mut secs) = (Device::default(), 10.0);
        let said = |done: Result<(), String>| done.map_err(TestCaseError::fail);
        device.last_moved = [0.0; 2];
        let first = bench.shown.clone();
        said(device.take(&first, secs))?;
        for it in all {
            match it {
                Traffic::Fader(control, to, reports) => {
                    let fader = usize::from(control);
                    let from = device.places[fader].unwrap_or(0);
                    for report in 1..=i32::from(reports) {
                        let value = from + (to - from) * report / i32::from(reports);
                        // Saying the same again is no movement.
                        if device.places[fader].replace(value) != Some(value) {
                            device.last_moved[fader] = secs;
                        }
                        bench.say("nano", InputEvent::Axis { control, value });
                        said(steps(&mut bench, &mut device, 1, &mut secs))?;
                    }
                }
                Traffic::Finger(control, down) => {
                    device.fingers[usize::from(control)] = down;
                    bench.say("nano", InputEvent::AxisTouched { control, down });
                }
                Traffic::Dial(delta_counts) => bench.say("nano", InputEvent::Dial { control: 0, delta_counts }),
                Traffic::Button(down) => bench.say("nano", InputEvent::Button { control: 0, down }),
                Traffic::Elsewhere(by_deg) => {
                    bench.shown.clear();
                    bench.turn_view(by_deg);
                    let told = bench.shown.clone();
                    secs += 0.01;
                    said(device.take(&told, secs))?;
                }
                Traffic::Wait(count) => said(steps(&mut bench, &mut device, count.into(), &mut secs))?,
                Traffic::Replug => {
                    bench.rig.noticed(&Change::Gone("nano".into(), "out".into()));
                    device.fingers = [false; 2];
                    said(steps(&mut bench, &mut device, 5, &mut secs))?;
                    bench.rig.noticed(&Change::Came("nano".into()));
                }
            }
            said(steps(&mut bench, &mut device, 1, &mut secs))?;
        }
        // Hands off: every motor goes to where things stand, and then nothing more is said.
        for control in 0..2 {
            device.fingers[usize::from(control)] = false;
            bench.say("nano", InputEvent::AxisTouched { control, down: false });
        }
        said(steps(&mut bench, &mut device, 150, &mut secs))?;
        let wanted = wanted(&bench);
        for (fader, wanted) in wanted.into_iter().enumerate() {
            let at = f64::from(device.places[fader].unwrap_or_default());
            prop_assert!((at - wanted).abs() <= 1.0, "fader {fader} at {at}, {wanted} wanted");
        }
        let before = device.shown.clone();
        for _ in 0..(REST_SECS * 100.0) as u32 {
            bench.shown.clear();
            bench.step(&[]);
            prop_assert_eq!(&bench.shown, &[]);
        }
        prop_assert_eq!(before, device.shown);
    }
}
