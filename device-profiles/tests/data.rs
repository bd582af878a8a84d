//! The shipped files, held to what their schema cannot say.

use device_profiles::{Kind, Profiles, read_file};
use std::path::{Path, PathBuf};

fn all_files() -> Vec<PathBuf> {
    let mut folders: Vec<_> = ["servos", "puppets", "inputs", "layouts"]
        .map(|f| Path::new(env!("CARGO_MANIFEST_DIR")).join(f))
        .into();
    let mut files = Vec::new();
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else {
                files.push(path);
            }
        }
    }
    files.sort();
    files
}

fn key_name_source(profile: &Kind) -> (&str, &str, &str) {
    match profile {
        Kind::Servo(p) => (&p.key, &p.name, &p.source),
        Kind::Puppet(p) => (&p.key, &p.name, &p.source),
        Kind::Input(p) => (&p.key, &p.name, &p.source),
        Kind::Layout(l) => (&l.key, &l.name, &l.source),
    }
}

fn printed(profile: &Kind) -> String {
    match profile {
        Kind::Servo(p) => toml::to_string(p),
        Kind::Puppet(p) => toml::to_string(p),
        Kind::Input(p) => toml::to_string(p),
        Kind::Layout(l) => toml::to_string(l),
    }
    .unwrap()
}

#[test]
fn every_file_reads_bears_its_source_and_a_name_of_its_own() {
    let mut keys = Vec::new();
    let mut names = Vec::new();
    for file in all_files() {
        let profile = read_file(&file).unwrap_or_else(|errors| panic!("{}", errors[0]));
        let (key, name, source) = key_name_source(&profile);
        assert!(
            source.len() > 10,
            "{}: a source is wanted, found \"{source}\"",
            file.display()
        );
        // A profile may bear the name of its layout: nobody asks for one where the other could be meant.
        let shelf = usize::from(matches!(profile, Kind::Layout(_)));
        keys.push((shelf, key.to_owned()));
        names.push((shelf, name.to_lowercase()));
    }
    for list in [&mut keys, &mut names] {
        let count = list.len();
        list.sort();
        list.dedup();
        assert_eq!(list.len(), count, "two profiles share a key or a name: {list:?}");
    }
}

/// Canonical: printed and read again nothing is added, dropped or written in another type; and the text keeps
/// to one way of laying out.
#[test]
fn every_file_is_in_canonical_form() {
    for file in all_files() {
        let shown = file.display();
        let text = std::fs::read_to_string(&file).unwrap();
        let table: toml::Table = text.parse().unwrap();
        let again: toml::Table = printed(&read_file(&file).unwrap()).parse().unwrap();
        assert_eq!(table, again, "{shown}");
        assert!(
            text.ends_with('\n') && !text.ends_with("\n\n"),
            "{shown}: one line end at the end"
        );
        let untidy = |line: &str| line.contains(['\t', '\r']) || line.ends_with(' ');
        assert_eq!(text.lines().find(|line| untidy(line)), None, "{shown}");
        let first: Vec<&str> = text
            .lines()
            .filter(|l| !l.starts_with('#'))
            .filter_map(|l| l.split(" = ").next())
            .take(2)
            .collect();
        assert_eq!(first, ["name", "status"], "{shown}: name and status come first");
    }
}

#[test]
fn builtin_profiles_are_found_by_key_and_by_name() {
    let all = Profiles::builtin();
    assert_eq!(all.servo("XL330-M288").unwrap().model_number, 1200);
    assert_eq!(all.servo("xl430-w250").unwrap().model_number, 1060);
    assert_eq!(all.servo_by_model(1060).unwrap().name, "XL430-W250");
    assert_eq!(all.puppet("marionette").unwrap().joints().count(), 22);
    assert_eq!(all.input("SGI dial and button box").unwrap().key, "sgi-dialbox");
    assert_eq!(all.input("graphire-serial").unwrap().area().counts, [5103, 3711]);
    let missing = all.servo("mx-29").unwrap_err().to_string();
    assert!(
        missing.starts_with("there is no servo profile named \"mx-29\"; there are: ax-12a, mx-28, mx-28-2, "),
        "{missing}"
    );
}

#[test]
fn no_two_profiles_claim_the_same_device() {
    let all = Profiles::builtin();
    let mut models: Vec<_> = all.servos().map(|s| s.model_number).collect();
    let count = models.len();
    models.sort_unstable();
    models.dedup();
    assert_eq!(models.len(), count);
}
