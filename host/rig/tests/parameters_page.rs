//! `docs/parameters.md` says what the table in `rig::parameters` says; `UPDATE_PAGES=1` writes it anew.

use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

use ps300::value::Kinds;
use rig::parameters::{JOINT, LINK, PARAMETERS};

const HEAD: &str = "\
# Parameters

<!-- Written by `UPDATE_PAGES=1 cargo test -p rig --test parameters_page`; change the table in
     `host/rig/src/parameters.rs`. -->

What a function network can drive besides its own display nodes: names with inlets like any adder's. They are there
before a network is loaded, and commands can neither redefine nor delete them.

```text
gain := F:MULC;
SEND 180 TO <2>gain;
CONNECT DIALS<1>:<1>gain;
CONNECT gain<1>:<1>VIEW;
```

What arrives is done once a step of the rig, in the order of arrival, after the network has run. What is done can be
undone where it changes the show. A value that makes no sense (an infinite number, a step that rounds to 0, a vector
of two where three are meant) asks for nothing; one of a kind the inlet does not take is dropped and reported.

Angles are in degrees here, as everywhere in networks; lengths in metres, times in seconds. *Added* means that each
message is a movement: connect dials directly, without an accumulator between.
";

const LINK_HEAD: &str = "
## FIGURE.link

One for each link of the show's figure, by the link's name: `FIGURE.rua`. A link whose name the command language
cannot spell (motion capture has such) has none.
";

const JOINT_HEAD: &str = "
## PUPPET.joint

One for each joint of the show's puppet, by the joint's name: `PUPPET.elbow`. It poses the puppet as it is on screen;
the servos follow where the puppet follows. A joint whose name the command language cannot spell has none.
";

const COLUMNS: &str = "
| inlet | takes | does |
|---|---|---|
";

fn page() -> String {
    let mut page = String::from(HEAD);
    for parameter in PARAMETERS {
        // Writing to a string cannot fail, here and below.
        let _ = write!(page, "\n## {}\n{COLUMNS}", parameter.name);
        let inlets = parameter.inlets.iter();
        rows(&mut page, inlets.map(|inlet| (inlet.kinds, inlet.meaning)));
    }
    let _ = write!(page, "{LINK_HEAD}{COLUMNS}");
    rows(&mut page, LINK.iter().copied());
    let _ = write!(page, "{JOINT_HEAD}{COLUMNS}");
    rows(&mut page, JOINT.iter().copied());
    page
}

fn rows(page: &mut String, inlets: impl Iterator<Item = (Kinds, &'static str)>) {
    for (number, (kinds, meaning)) in (1..).zip(inlets) {
        let meaning = meaning.replace('|', "\\|");
        let _ = writeln!(page, "| \\<{number}> | {kinds} | {meaning} |");
    }
}

fn place() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/parameters.md")
}

#[test]
fn the_page_is_the_table() {
    let wanted = page();
    if std::env::var_os("UPDATE_PAGES").is_some_and(|set| set == "1") {
        fs::write(place(), &wanted).expect("docs/ can be written");
    }
    let found = fs::read_to_string(place())
        .unwrap_or_default()
        .replace("\r\n", "\n");
    assert!(
        found == wanted,
        "docs/parameters.md is not what rig::parameters says; \
         write it with: UPDATE_PAGES=1 cargo test -p rig --test parameters_page"
    );
}

#[test]
fn every_inlet_says_what_it_does() {
    let all = PARAMETERS.iter().flat_map(|parameter| parameter.inlets);
    let meanings = all
        .map(|inlet| inlet.meaning)
        .chain(LINK.iter().chain(JOINT).map(|(_, meaning)| *meaning));
    for meaning in meanings {
        assert!(
            !meaning.is_empty() && !meaning.contains('\n'),
            "{meaning:?} does not fit a cell"
        );
    }
}
