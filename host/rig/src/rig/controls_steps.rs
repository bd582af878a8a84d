//! No parameter ever steps, whatever happens to the device, the page, the program or the parameter.

use proptest::prelude::*;

use super::bench::Bench;
use super::*;
use crate::command::{LearnCommand, NetworkEdit};

/// What may happen while a hand is on the fader.
#[derive(Clone, Debug)]
enum Happening {
    Move(i32, bool),
    Replug(i32),
    Page(u8),
    Reload,
    Elsewhere(f64),
    Learn,
}

fn happening() -> impl Strategy<Value = Happening> {
    prop_oneof![
        8 => (0..=1000, any::<bool>()).prop_map(|(to, quick)| Happening::Move(to, quick)),
        1 => (0..=1000).prop_map(Happening::Replug),
        1 => (1..=3_u8).prop_map(Happening::Page),
        1 => Just(Happening::Reload),
        1 => (-80.0..80.0_f64).prop_map(Happening::Elsewhere),
        1 => Just(Happening::Learn),
    ]
}

/// Both angles of the view, on two pages.
const TWO_PAGES: &str = "s := F:MULC; a := F:ADDC; SEND 180 TO <2>s; SEND -90 TO <2>a;
    CONNECT NANO<1>:<1>s; CONNECT s<1>:<1>a; CONNECT a<1>:<5>VIEW;
    t := F:MULC; b := F:ADDC; SEND 180 TO <2>t; SEND -90 TO <2>b;
    CONNECT NANO_PAGE2<1>:<1>t; CONNECT t<1>:<1>b; CONNECT b<1>:<6>VIEW;";

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// Through moves, returns, pages, reloads, changes from elsewhere and learning, no parameter goes farther than
    /// the hand did, the pickup distance apart; what is no move changes nothing at all.
    #[test]
    fn no_parameter_ever_steps(happenings in prop::collection::vec(happening(), 1..40)) {
        let mut bench = Bench::new(TWO_PAGES);
        let mut place: Option<i32> = None;
        for it in happenings {
            let before = [bench.seen.view.azimuth_rad, bench.seen.view.elevation_rad].map(f64::to_degrees);
            let mut allowed_deg = 0.0;
            match it {
                Happening::Move(to, quick) => {
                    if !quick {
                        bench.wait(0.2);
                    }
                    bench.fader(0, to);
                    // The first value after a return only tells where it is.
                    allowed_deg = place.map_or(0.0, |from| {
                        180.0 * (f64::from((to - from).abs()) / 1000.0 + crate::controls::pickup::NEAR)
                    });
                    place = Some(to);
                }
                Happening::Replug(to) => {
                    bench.rig.noticed(&Change::Gone("nano".into(), "out".into()));
                    bench.step(&[]);
                    bench.rig.noticed(&Change::Came("nano".into()));
                    bench.fader(0, to);
                    place = Some(to);
                }
                Happening::Page(page) => {
                    bench.step(&[Command::Controls(ControlCommand::Page { device: "nano".into(), page })]);
                }
                Happening::Reload => {
                    let text = format!("{} {{ again }}", bench.rig.show().program_text());
                    bench.step(&[Command::Network(NetworkEdit::Program(text))]);
                }
                Happening::Elsewhere(by_deg) => {
                    bench.turn_view(by_deg);
                    continue;
                }
                Happening::Learn => {
                    bench.step(&[
                        Command::Learn(LearnCommand::Control { device: "nano".into(), control: 1 }),
                        Command::Learn(LearnCommand::Parameter { name: "VIEW".into(), inlet: 5 }),
                    ]);
                    allowed_deg = 0.0;
                }
            }
            bench.step(&[]);
            let after = [bench.seen.view.azimuth_rad, bench.seen.view.elevation_rad].map(f64::to_degrees);
            // Learnt, a fader goes all round.
            let allowed_deg = 2.0 * allowed_deg;
            for (before, after) in before.into_iter().zip(after) {
                let by = (after - before + 540.0).rem_euclid(360.0) - 180.0;
                prop_assert!(by.abs() <= allowed_deg + 1e-6, "{by} where {allowed_deg} are allowed");
            }
        }
    }
}
