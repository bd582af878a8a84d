//! `docs/controls.md` says what the profiles of input devices say; `UPDATE_PAGES=1` writes it anew.

use device_profiles::{Bus, InputKind, InputProfile, Match, Profiles, Quirk};
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

const HEAD: &str = "\
# Controls

<!-- Written by `UPDATE_PAGES=1 cargo test -p device-profiles --test controls_page`; change the files in
     `device-profiles/inputs/` and `device-profiles/layouts/`. -->

Tablets, dial boxes and controllers that come with the program, from the profiles themselves. Each file has its sources in
full, and where they disagree, in comments at its top. *untested* means written from documents and recordings: nobody
has tried it on the real thing. What you try, tell us: a profile becomes *supported*, or *quirks* with the oddities in
its comments.

*Known by* is what the program looks at: USB ids, the length of reports (B), USB strings by index, an answer on a serial
line, the name of a MIDI port. *By hand* means that nothing tells the device: name its profile yourself.

[Profiles of your own](profiles.md) tells how to add a device.
";

const KINDS: [(InputKind, &str); 7] = [
    (InputKind::Tablet, "Tablets"),
    (InputKind::Knobs, "Dials and knobs"),
    (InputKind::SixAxis, "Six axes"),
    (InputKind::Shuttle, "Shuttles"),
    (InputKind::Pad, "Keys and touch"),
    (InputKind::Midi, "MIDI"),
    (InputKind::Osc, "OSC"),
];

const DEVICES: &str = "
| device | profile | known by | controls | outputs | format | status |
|---|---|---|---|---|---|---|
";

const QUIRKS: &str = "
## Quirks

| quirk | meaning | devices |
|---|---|---|
";

const LAYOUTS: &str = "
## Layouts

What the reports of a family mean. A tablet of a known layout needs a profile and nothing else.

| layout | profile | used by |
|---|---|---|
";

const SOURCES: &str = "
## Sources

| profile | from |
|---|---|
";

fn page() -> String {
    let all = Profiles::builtin();
    let mut page = String::from(HEAD);
    for (kind, title) in KINDS {
        // Writing to a string cannot fail.
        let _ = write!(page, "\n## {title}\n{DEVICES}");
        for input in all.inputs().filter(|p| p.kind == kind) {
            device_row(&mut page, input);
        }
    }
    page.push_str(QUIRKS);
    for quirk in Quirk::ALL {
        let bearers = keys(all.inputs().filter(|p| p.quirks.contains(quirk)));
        if !bearers.is_empty() {
            line(
                &mut page,
                &[format!("`{}`", quirk.word()), quirk.meaning().to_owned(), bearers],
            );
        }
    }
    page.push_str(LAYOUTS);
    for layout in all.layouts() {
        let users = keys(
            all.inputs()
                .filter(|p| p.layout.as_deref() == Some(layout.key.as_str())),
        );
        line(
            &mut page,
            &[layout.name.clone(), format!("`{}`", layout.key), users],
        );
    }
    page.push_str(SOURCES);
    let layouts = all.layouts().map(|l| (&l.key, &l.source));
    for (key, source) in all.inputs().map(|p| (&p.key, &p.source)).chain(layouts) {
        line(&mut page, &[format!("`{key}`"), source.clone()]);
    }
    page
}

fn line(page: &mut String, cells: &[String]) {
    let cells: Vec<String> = cells.iter().map(|cell| cell.replace('|', "\\|")).collect();
    let _ = writeln!(page, "| {} |", cells.join(" | "));
}

fn keys<'a>(inputs: impl Iterator<Item = &'a InputProfile>) -> String {
    inputs
        .map(|p| format!("`{}`", p.key))
        .collect::<Vec<_>>()
        .join(", ")
}

fn device_row(page: &mut String, input: &InputProfile) {
    let mut known: Vec<(Vec<String>, String)> = Vec::new();
    for m in &input.matches {
        let (name, rest) = known_by(m);
        match known.iter_mut().find(|(_, other)| *other == rest) {
            Some((names, _)) if names.contains(&name) => {}
            Some((names, _)) => names.push(name),
            None => known.push((vec![name], rest)),
        }
    }
    let known: Vec<String> = known
        .into_iter()
        .map(|(names, rest)| format!("{}{rest}", names.join(", ")))
        .collect();
    let mut controls = Vec::new();
    if let Some(surface) = &input.surface {
        let [wide, high] = surface.mm();
        controls.push(format!("{wide:.0} × {high:.0} mm"));
        if surface.pressure > 0 {
            controls.push(format!("pressure to {}", surface.pressure));
        }
        if surface.tilt() {
            controls.push("tilt".to_owned());
        }
    }
    let named = |count: u16, name: &str| {
        if count > 1 {
            format!("{count} × {name}")
        } else {
            name.to_owned()
        }
    };
    for control in &input.controls {
        let same = control.kind.word() == control.name;
        let kind = if same {
            String::new()
        } else {
            format!(" ({})", control.kind.word())
        };
        controls.push(format!("{}{kind}", named(control.count, &control.name)));
    }
    let outputs: Vec<String> = input
        .outputs
        .iter()
        .map(|o| named(o.count, o.kind.word()))
        .collect();
    line(
        page,
        &[
            input.name.clone(),
            format!("`{}`", input.key),
            if known.is_empty() {
                "by hand".to_owned()
            } else {
                known.join("; ")
            },
            controls.join(", "),
            outputs.join(", "),
            format!("`{}`", input.format),
            input.status.word().to_owned(),
        ],
    );
}

/// What it is called there, and what else must hold.
fn known_by(m: &Match) -> (String, String) {
    let name = match (m.bus, m.id()) {
        (Bus::Usb, Some(id)) => id,
        (bus, Some(id)) => format!("{} {id}", bus.word()),
        (_, None) if m.by_hand_only() => "by hand".to_owned(),
        (bus, None) => bus.word().to_owned(),
    };
    let mut said = String::new();
    if let Some([page, usage]) = m.usage {
        let _ = write!(said, " usage {page:04x}/{usage:02x}");
    }
    if !m.input_report_bytes.is_empty() {
        let lengths: Vec<String> = m.input_report_bytes.iter().map(u16::to_string).collect();
        let _ = write!(said, " {} B", lengths.join(" or "));
    }
    for (index, text) in &m.strings {
        let _ = write!(said, " string {index} `{text}…`");
    }
    for (what, text) in [
        ("maker", &m.maker_text),
        ("name", &m.product_text),
        ("serial number", &m.serial_text),
    ] {
        if let Some(text) = text {
            let _ = write!(said, " {what} `{text}…`");
        }
    }
    if let Some(identify) = &m.identify {
        let _ = write!(said, " answer `{}…` to `{}`", identify.prefix, identify.ask);
    }
    if let Some(port) = m.port {
        let _ = write!(said, " UDP port {port}");
    }
    (name, said)
}

fn place() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/controls.md")
}

#[test]
fn the_page_is_the_profiles() {
    let wanted = page();
    if std::env::var_os("UPDATE_PAGES").is_some_and(|set| set == "1") {
        fs::write(place(), &wanted).expect("docs/ can be written");
    }
    let found = fs::read_to_string(place())
        .unwrap_or_default()
        .replace("\r\n", "\n");
    assert!(
        found == wanted,
        "docs/controls.md is not what the profiles say; \
         write it with: UPDATE_PAGES=1 cargo test -p device-profiles --test controls_page"
    );
}

/// No device may be missing because nobody thought of its kind.
#[test]
fn every_device_is_on_the_page() {
    let page = page();
    for input in Profiles::builtin().inputs() {
        assert!(
            page.contains(&format!("| {} | `{}` |", input.name, input.key)),
            "{}",
            input.key
        );
    }
}
