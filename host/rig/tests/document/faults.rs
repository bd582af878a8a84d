//! Faults in show folders: each is found, with its place and what to do, together with all the others.

use std::fs;
use std::path::Path;

use super::rich;
use rig::document::{self, check};

#[test]
fn a_newer_version_is_refused_with_advice() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    fs::write(
        folder.path().join("show.toml"),
        "version = 2\nname = \"x\"\nshiny = true\n",
    )
    .expect("writes");
    let errors = document::load(folder.path()).expect_err("newer").0;
    assert_eq!(errors.len(), 1);
    assert_eq!((errors[0].line, errors[0].column), (1, 11));
    assert!(
        errors[0].message.contains("version 2") && errors[0].hint.is_some(),
        "{}",
        errors[0]
    );
}

/// Replaces text in one file of a saved show and returns the errors of loading it, as `line:column: text`.
fn faults(file: &str, from: &str, to: &str) -> Vec<String> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    document::save(&rich(), folder.path()).expect("saves");
    let path = folder.path().join(file);
    let text = fs::read_to_string(&path).expect("is there");
    assert!(text.contains(from), "{from} is not in {file}");
    fs::write(&path, text.replacen(from, to, 1)).expect("writes");
    let errors = document::load(folder.path()).expect_err(to).0;
    let relative = |path: &Path| {
        path.strip_prefix(folder.path())
            .map(Path::to_path_buf)
            .unwrap_or_default()
    };
    errors
        .iter()
        .map(|e| {
            format!(
                "{}:{}:{}: {}",
                relative(&e.file).display(),
                e.line,
                e.column,
                e.message
            )
        })
        .collect()
}

const CLIP: &str = "clips/salute.toml";

/// A file, what is replaced in it, by what, and a part of an error that must follow.
const FAULTS: [(&str, &str, &str, &str); 24] = [
    (
        CLIP,
        "secs = 0.9",
        "secs = 1e-9",
        "clips/salute.toml:27:1: key at 0.000000001 s follows one at 0 s",
    ),
    (
        CLIP,
        "secs = 6.0",
        "secs = 6e300",
        "times lie within 10000000 s of 0",
    ),
    (
        "show.toml",
        "version = 1\n",
        "",
        "show.toml:1:1: `version` is missing",
    ),
    (
        "show.toml",
        "clip = \"",
        "klip = \"",
        "show.toml:5:1: unknown key `klip`",
    ),
    (
        "show.toml",
        "clip = \"salute\"",
        "clip = \"walk\"",
        "show.toml:5:8: there is no clip `walk`",
    ),
    (
        "show.toml",
        "clip = \"salute\"",
        "clip = 3",
        "show.toml:5:8: expected a string, found an integer",
    ),
    (
        "show.toml",
        "\"empty\"",
        "\"../empty\"",
        "show.toml:4:26: `../empty` cannot be the name of a file",
    ),
    (
        "show.toml",
        "\"empty\"",
        "\"nowhere\"",
        "show.toml:4:26: there is no file",
    ),
    (
        "show.toml",
        "networks/more.ps300",
        "/etc/more.ps300",
        "is not a relative path of a .ps300 file",
    ),
    ("show.toml", "scale = 0.75", "scale = -1", "must be above 0"),
    ("show.toml", "name = ", "name = = ", "show.toml:2:"),
    (
        "figure/ar.str",
        "2 rua 2 0.2",
        "2 rua 2 nan",
        "figure/ar.str:10:9: `nan` is not a finite number",
    ),
    (
        "figure/ar.str",
        "8 0.0 0.0 0.3",
        "1 0.0 0.0 0.3",
        "figure/ar.str:8:1:",
    ),
    (
        "figure/ar.str",
        "4 rh 2 0.1",
        "4 rh 7 0.1",
        "figure/ar.str:16:1: link 4 has 7 degrees",
    ),
    (
        "figure/ar.str",
        "6 lfa 2",
        "6 rua 2",
        "figure/ar.str:21:3: the link on line 10 is called `rua` too",
    ),
    (CLIP, "secs = 0.9", "secs = nan", "is not finite"),
    (
        CLIP,
        "secs = 0.9",
        "secs = 0.0",
        "clips/salute.toml:27:1: key at 0 s follows one at 0 s",
    ),
    (
        CLIP,
        "secs = 0.9",
        "when = 0.9",
        "clips/salute.toml:28:1: unknown key `when`",
    ),
    (
        CLIP,
        "rua = {",
        "arm = {",
        "clips/salute.toml:13:1: the figure has no link `arm`",
    ),
    (
        CLIP,
        "rua = {",
        "rua = 3 #",
        "clips/salute.toml:13:7: expected a table, found an integer",
    ),
    (
        CLIP,
        "twist = \"transport\"",
        "twist = \"wild\"",
        "clips/salute.toml:3:9: expected one of transport, zyz",
    ),
    (
        CLIP,
        "root = [0.0, ",
        "root = [",
        "clips/salute.toml:8:8: expected 3 numbers, found 2",
    ),
    (
        "clips/a second one.toml",
        "length = 0.175",
        "length = 0",
        "must be above 0",
    ),
    (
        "clips/a second one.toml",
        "adjust = [[2",
        "adjust = [[99",
        "clips/a second one.toml:6:10: the timing cannot be: there is no kinetic coefficient 99",
    ),
];

#[test]
fn every_fault_has_a_place_and_words() {
    for (file, from, to, words) in FAULTS {
        let found = faults(file, from, to);
        assert!(
            found.iter().any(|error| error.contains(words)),
            "{to}: expected `{words}`, found {found:#?}"
        );
    }
}

#[test]
fn faults_of_several_files_are_reported_together() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    document::save(&rich(), folder.path()).expect("saves");
    for (file, from, to) in [
        ("clips/salute.toml", "secs = 0.9", "secs = \"soon\""),
        ("clips/a second one.toml", "frame_secs = 0.04", "frame_secs = 0"),
        ("show.toml", "elevation_deg", "elevation"),
    ] {
        let path = folder.path().join(file);
        let text = fs::read_to_string(&path).expect("is there");
        fs::write(&path, text.replacen(from, to, 1)).expect("writes");
    }
    let errors = document::load(folder.path()).expect_err("broken").0;
    let files: std::collections::BTreeSet<_> = errors.iter().map(|error| error.file.clone()).collect();
    assert_eq!(files.len(), 3, "{errors:#?}");
    assert_eq!(check::check_file(folder.path()).errors.len(), errors.len());
}

#[test]
fn a_cut_or_binary_file_is_an_error() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    document::save(&rich(), folder.path()).expect("saves");
    let path = folder.path().join("clips/salute.toml");
    let text = fs::read_to_string(&path).expect("is there");
    for cut in (1..text.len()).step_by(97) {
        fs::write(&path, &text[..cut]).expect("writes");
        // A cut between two keys cannot be told from a shorter clip; any other place must be refused.
        let whole = text[cut..].starts_with("\n[[key]]") || text[cut..].starts_with("[[key]]");
        assert!(
            document::load(folder.path()).is_err() || whole || cut < 80,
            "cut at {cut}"
        );
    }
    fs::write(&path, [0xff, 0xfe, 0x00]).expect("writes");
    assert!(
        document::load(folder.path())
            .expect_err("binary")
            .to_string()
            .contains("not UTF-8")
    );
}

/// Networks load whatever is wrong in them; a check says what that is, names and kinds included.
#[test]
fn a_check_loads_the_networks_into_one_machine() {
    for (from, to, part) in [
        ("turn := F:MULC", "turn := F:MULT", "there is no function F:MULT"),
        ("<1>turn;", "<9>turn;", "turn has no input <9>"),
        ("<1>turn;", "<1>turn", "expected"),
    ] {
        let folder = tempfile::tempdir().expect("a temporary folder");
        document::save(&rich(), folder.path()).expect("saves");
        let path = folder.path().join("networks/figure.ps300");
        let text = fs::read_to_string(&path).expect("is there");
        assert!(text.contains(from), "{from}");
        assert_eq!(check::check_file(folder.path()).errors, []);
        fs::write(&path, text.replacen(from, to, 1)).expect("writes");
        let errors = check::check_file(folder.path()).errors;
        let told = errors
            .iter()
            .any(|error| error.file == path && error.message.contains(part));
        assert!(told, "{to}: {errors:?}");
        assert!(document::load(folder.path()).is_ok(), "{to}");
    }
}

#[test]
fn a_clip_alone_is_checked_against_the_show_around_it() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    document::save(&rich(), folder.path()).expect("saves");
    let path = folder.path().join("clips/salute.toml");
    assert_eq!(check::check_file(&path).errors, []);
    let text = fs::read_to_string(&path)
        .expect("is there")
        .replacen("rua = {", "arm = {", 1);
    fs::write(&path, text).expect("writes");
    assert_eq!(
        check::check_file(&path).errors.len(),
        2,
        "an unknown link, and one not placed"
    );
    assert_eq!(check::check_file(&folder.path().join("x.obj")).errors.len(), 1);
}
