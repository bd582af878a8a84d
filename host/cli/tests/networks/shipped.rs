//! What holds for every network that comes with dialrig: it is in order, prints as something that reads the same, and
//! goes on the same when it is saved in the midst of things and loaded again.

use std::fs;
use std::path::Path;

use glam::DVec2;

use crate::hands::{Draws, Hands};
use crate::session::{Desk, root};

/// Files that are loaded after others.
const AFTER: &[(&str, &[&str])] = &[
    ("mirror/dials-to-lamp.ps300", &["mirror/lamp.ps300"]),
    ("mirror/dials-to-figure.ps300", &["mirror/figure.ps300"]),
    ("mirror/dials-to-camera.ps300", &["mirror/camera.ps300"]),
    (
        "mirror/switch.ps300",
        &["mirror/lamp.ps300", "mirror/figure.ps300", "mirror/camera.ps300"],
    ),
];

/// All network files below `networks`, as paths from there.
pub(crate) fn shipped() -> Vec<String> {
    fn collect(folder: &Path, into: &mut Vec<String>) {
        for entry in fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("readable").path();
            if path.is_dir() {
                collect(&path, into);
            } else if path.extension().is_some_and(|end| end == "ps300") {
                let name = path.strip_prefix(root().join("networks")).expect("below it");
                into.push(name.to_string_lossy().into_owned());
            }
        }
    }
    let mut names = Vec::new();
    collect(&root().join("networks"), &mut names);
    names.sort();
    assert!(names.len() > 20, "only {names:?}");
    names
}

/// What is loaded to have one, in order.
pub(crate) fn with_what_it_needs(name: &str) -> Vec<&str> {
    let needed = AFTER.iter().find(|(after, _)| *after == name);
    let mut names: Vec<&str> = needed.map(|(_, before)| before.to_vec()).unwrap_or_default();
    names.push(name);
    names
}

#[test]
fn every_network_is_in_order_and_prints_as_something_that_reads_the_same() {
    let desk = Desk::new();
    for name in shipped() {
        let files: String = with_what_it_needs(&name)
            .iter()
            .flat_map(|name| [" networks/", name])
            .collect();
        let checked = desk.run(&format!("dialrig net check{files}"));
        // One of those for the rules of firing loses a message, which is no fault of the file.
        let lines = checked.lines().filter(|line| !line.starts_with("report: "));
        assert!(lines.eq(["in order"]), "{name}: {checked}");
        desk.run(&format!(
            "cat{files} > all.ps300; dialrig net print all.ps300 > once.ps300"
        ));
        let twice = desk.run("dialrig net print once.ps300");
        assert!(!twice.is_empty() && desk.run("cat once.ps300") == twice, "{name}");
        let drawing = desk.run(&format!("dialrig net dot{files}"));
        assert!(drawing.starts_with("digraph"), "{name}: {drawing}");
    }
}

#[test]
fn every_shipped_show_is_in_order() {
    let printed = Desk::new().run("for show in shows/*; do dialrig check $show -q || echo $show; done");
    assert_eq!(printed, "");
}

/// What a hand does next.
pub(crate) fn act(draws: &mut Draws) -> impl Fn(&mut Hands) + use<> {
    let (what, key, dial) = (
        draws.below(3),
        draws.below(12) as i32 + 1,
        draws.below(8) as u8 + 1,
    );
    let (turns, at, down) = (
        draws.unit(),
        DVec2::new(draws.unit(), draws.unit()),
        draws.below(3) > 0,
    );
    move |hands| match what {
        0 => hands.press(key),
        1 => hands.turn(dial, turns),
        _ => hands.pen(at, down),
    }
}

#[test]
fn every_network_goes_on_the_same_after_it_was_saved_and_loaded_again() {
    let mut wrong = Vec::new();
    for name in &shipped() {
        let mut kept = Hands::on(&with_what_it_needs(name));
        let mut draws = Draws(300);
        for _ in 0..150 {
            act(&mut draws)(&mut kept);
        }
        let text = kept.machine.network_text_with_state();
        let mut loaded = kept.moved_to(&text);
        for step in 0..150 {
            let act = act(&mut draws);
            for hands in [&mut kept, &mut loaded] {
                act(hands);
            }
            let same = [
                (
                    "dials",
                    kept.machine.panel().dial_labels == loaded.machine.panel().dial_labels,
                ),
                (
                    "keys",
                    kept.machine.panel().key_labels == loaded.machine.panel().key_labels,
                ),
                (
                    "message",
                    kept.machine.panel().message == loaded.machine.panel().message,
                ),
                ("picture", kept.machine.display() == loaded.machine.display()),
            ];
            if let Some((what, _)) = same.iter().find(|(_, same)| !same) {
                wrong.push(format!("{name}, step {step}: {what}"));
                break;
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
