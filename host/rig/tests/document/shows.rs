//! The shipped shows: they load without errors, say what they should, and stand on the ground.

use super::{salute, salute_folder};
use rig::document::{self, check};

#[test]
fn the_printed_human_loads_with_a_warning_for_each_thigh() {
    let loaded = document::load(&salute_folder()).expect("loads");
    let places: Vec<(u32, bool)> = loaded
        .warnings
        .iter()
        .map(|w| (w.line, w.message.contains("4 degrees of freedom")))
        .collect();
    assert_eq!(places, [(30, true), (38, true)]);
    assert_eq!(loaded.autosave, None);
    let figure = loaded.show.figure.expect("a figure").figure.clone();
    let numbers: Vec<u32> = figure.links().iter().map(|link| link.number).collect();
    assert_eq!(numbers, (0..15).collect::<Vec<u32>>());
}

#[test]
fn checking_finds_nothing_wrong() {
    let found = check::check_file(&salute_folder());
    assert_eq!(found.errors, []);
    assert!(
        found
            .warnings
            .iter()
            .all(|w| w.message.contains("4 degrees of freedom")),
        "{:#?}",
        found.warnings
    );
}

#[test]
fn the_shared_network_is_read_and_a_copy_has_its_own() {
    let show = salute();
    let names: Vec<&str> = show
        .networks
        .iter()
        .map(|network| network.name.as_str())
        .collect();
    assert_eq!(names, ["figure"]);
    let copy = tempfile::tempdir().expect("a temporary folder");
    document::save(&show, copy.path()).expect("saves");
    assert!(copy.path().join("networks/figure.ps300").exists());
    assert_eq!(document::load(copy.path()).expect("loads").show, show);
}

#[test]
fn feet_stand_on_the_ground_and_time_never_runs_backwards() {
    let show = salute();
    let figure = &show.figure.as_ref().expect("a figure").figure;
    let doc = show.current_clip().expect("a clip");
    let clip = doc.clip(figure).expect("builds").expect("keys");
    assert_eq!(clip.kinetics().reversals(), []);
    assert_eq!(clip.warnings(), []);

    let feet = ["rf", "lf"].map(|name| figure.by_name(name).expect("a foot").index());
    let mut placed = Vec::new();
    let first: Vec<glam::DVec3> = {
        clip.place(clip.start_secs(), &mut placed);
        feet.iter().map(|&foot| placed[foot].start).collect()
    };
    for secs in doc.times_secs() {
        clip.place(secs, &mut placed);
        for (&foot, first) in feet.iter().zip(&first) {
            assert!(
                placed[foot].start.distance(*first) < 2e-4,
                "a foot slid until {secs} s"
            );
            assert!(
                placed[foot].end.y.abs() < 2e-4,
                "a toe left the ground at {secs} s"
            );
        }
    }
    // Between keys the root goes straight where the body swings on an arc.
    for step in 0..600 {
        clip.place(f64::from(step) * 0.01, &mut placed);
        for &foot in &feet {
            assert!(
                placed[foot].start.y.abs() < 0.015,
                "{} at step {step}",
                placed[foot].start.y
            );
        }
    }
}

#[test]
fn timing_is_visibly_apart_from_the_path() {
    let show = salute();
    let figure = &show.figure.as_ref().expect("a figure").figure;
    let clip = show
        .current_clip()
        .expect("a clip")
        .clip(figure)
        .expect("builds")
        .expect("keys");
    let kinetics = clip.kinetics();
    let speeds: Vec<f64> = (1..60)
        .map(|step| kinetics.derivative(f64::from(step) * 0.1, 1))
        .collect();
    let (slowest, fastest) = speeds
        .iter()
        .fold((f64::MAX, 0.0_f64), |(l, h), &v| (l.min(v), h.max(v)));
    assert!(
        slowest > 0.3 && fastest > 1.6 * slowest,
        "from {slowest} to {fastest} keys a second"
    );
}
