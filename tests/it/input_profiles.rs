//! Every shipped input device has a codec, a page of its wire format and an exchange; and one more tablet of a
//! known layout is a text file.

use crate::source::{files, root};
use device::codec::{InputEvent, PenSample, Stand, Tool, of_profile};
use device_profiles::{FORMATS, Profiles};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

#[test]
fn every_profile_has_a_codec() {
    let mut wrong = Vec::new();
    for profile in Profiles::builtin().inputs() {
        for stand in [Stand::Unasked, Stand::Reporting] {
            if let Err(error) = of_profile(profile, stand) {
                wrong.push(error.to_string());
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_format_has_a_page() {
    let missing: Vec<_> = FORMATS
        .iter()
        .filter(|format| !root().join(format!("docs/protocols/{format}.md")).is_file())
        .collect();
    assert!(
        missing.is_empty(),
        "no page of their own in docs/protocols for {missing:?}"
    );
}

#[test]
fn every_profile_has_an_exchange() {
    let profiles = Profiles::builtin();
    let told: BTreeSet<String> = files("tests/exchanges", "txt")
        .iter()
        .filter_map(|file| {
            let line = file.text.lines().find_map(|line| line.strip_prefix("profile:"))?;
            Some(line.trim().to_owned())
        })
        .collect();
    let missing: Vec<_> = profiles
        .inputs()
        .map(|profile| &profile.key)
        .filter(|key| !told.contains(*key))
        .collect();
    assert!(
        missing.is_empty(),
        "no exchange in tests/exchanges for {missing:?}"
    );
    let unknown: Vec<_> = told.iter().filter(|key| profiles.input(key).is_err()).collect();
    assert!(unknown.is_empty(), "exchanges of nobody's: {unknown:?}");
}

/// The example that `docs/profiles.md` gives.
fn example() -> String {
    let page = std::fs::read_to_string(root().join("docs/profiles.md")).expect("the page is there");
    let (_, rest) = page
        .split_once("## A tablet of a known layout")
        .expect("the chapter is there");
    let (_, block) = rest.split_once("```toml\n").expect("it has an example");
    block.split_once("```").expect("the example ends").0.to_owned()
}

fn folder(name: &str, files: &[(&str, &str)]) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).expect("the build's folder can be written");
    for (file, text) in files {
        std::fs::write(folder.join(file), text).expect("the build's folder can be written");
    }
    folder
}

/// What comes of reports of a device that reports already.
fn heard(profiles: &Profiles, key: &str, reports: &[&[u8]]) -> Vec<InputEvent> {
    let profile = profiles.input(key).expect("it was just added");
    let mut codec = of_profile(profile, Stand::Reporting).expect("its layout is known");
    let mut events = Vec::new();
    for report in reports {
        codec.decode(report, &mut |event| events.push(event));
    }
    events
}

#[test]
fn one_more_tablet_of_a_known_layout_is_a_text_file() {
    let mine = folder("one-more-tablet", &[("h950p.toml", &example())]);
    let profiles = Profiles::builtin()
        .with_user_folder(&mine)
        .expect("the page's example is right");
    assert_eq!(
        profiles.inputs().count(),
        Profiles::builtin().inputs().count() + 1
    );
    // 44200 and 27600 at full pressure with the upper button; then the sixth key.
    let pen = [8, 0x85, 0xA8, 0xAC, 0xD0, 0x6B, 0xFF, 0x1F, 0, 0, 0, 0];
    let key = [8, 0xE0, 1, 1, 0x20, 0, 0, 0, 0, 0, 0, 0];
    let events = heard(&profiles, "h950p", &[&pen, &key]);
    let sample = PenSample {
        pressure_counts: 8191,
        buttons: 0b10,
        tip: true,
        ..PenSample::hovering(Tool::Pen, 44200, 27600)
    };
    let down = InputEvent::Button {
        control: 5,
        down: true,
    };
    assert_eq!(events, [InputEvent::Pen(sample), down]);
}

/// A layout of the user's own, read by two of his profiles, one of which has a byte in front.
#[test]
fn a_layout_of_the_users_own_is_shared_and_shifted() {
    let layout = "name = \"My layout\"\nstatus = \"untested\"\nsource = \"measured on my desk\"\n\n[[report]]\nid = 5\n\
                  bytes = [4, 4]\nemits = \"controls\"\nfield = [{ name = \"dial1\", byte = 1, signed = true }, \
                  { name = \"key1\", byte = 2 }]\n";
    let profile = |name: &str, product: u16, more: &str| {
        format!(
            "name = \"{name}\"\nstatus = \"untested\"\nkind = \"knobs\"\nformat = \"hid\"\n\
             source = \"measured on my desk\"\nlayout = \"mine\"\n{more}\n[[match]]\nbus = \"usb\"\n\
             vendor = 0x1209\nproduct = {product}\n\n[[control]]\nkind = \"dial\"\nname = \"dial\"\n\n\
             [[control]]\nkind = \"button\"\nname = \"key\"\n"
        )
    };
    let (plain, shifted) = (profile("Plain", 1, ""), profile("Shifted", 2, "skip_bytes = 1\n"));
    // Files are read in the order of their names: the layout comes last of all.
    let mine = folder(
        "own-layout",
        &[
            ("a-plain.toml", &plain),
            ("b-shifted.toml", &shifted),
            ("mine.toml", layout),
        ],
    );
    let profiles = Profiles::builtin()
        .with_user_folder(&mine)
        .expect("they are right");
    let turned = InputEvent::Dial {
        control: 0,
        delta_counts: -3,
    };
    let down = InputEvent::Button {
        control: 0,
        down: true,
    };
    for (key, report) in [
        ("a-plain", &[5, 0xFD, 1, 0][..]),
        ("b-shifted", &[0x11, 5, 0xFD, 1, 0]),
    ] {
        let events = heard(&profiles, key, &[report]);
        assert!(
            events.len() == 2 && events.contains(&turned) && events.contains(&down),
            "{key}: {events:?}"
        );
    }
}
