//! A user's own profiles: taken in place of the built-in ones, or refused with the place of what is wrong.

use device_profiles::{ProfileError, Profiles};
use std::path::{Path, PathBuf};

/// A user's folder of this test's own, in the build's folder.
fn folder(name: &str, files: &[(&str, &str)]) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    for (file, text) in files {
        std::fs::write(folder.join(file), text).unwrap();
    }
    folder
}

#[test]
fn a_users_profile_takes_the_built_in_ones_place() {
    let text =
        include_str!("../knobs/sgi-dialbox.toml").replace("counts_per_turn = 256", "counts_per_turn = 200");
    let folder = folder(
        "own",
        &[("sgi-dialbox.toml", &text), ("notes.txt", "not a profile")],
    );
    let all = Profiles::builtin().with_user_folder(&folder).unwrap();
    assert_eq!(all.knobs("sgi-dialbox").unwrap().counts_per_turn, 200);
    assert_eq!(all.all_knobs().count(), Profiles::builtin().all_knobs().count());
    assert_eq!(
        Profiles::builtin()
            .with_user_folder(Path::new("no-such"))
            .unwrap(),
        Profiles::builtin()
    );
}

/// Writes `text` as the only profile of a user and reads it.
fn read_own(name: &str, text: &str) -> Result<Profiles, Vec<ProfileError>> {
    Profiles::builtin().with_user_folder(&folder(name, &[("own.toml", text)]))
}

/// The first error must say `message` and point at text that begins with `place`.
fn check_refused(name: &str, text: &str, message: &str, place: &str) {
    let errors = read_own(name, text).unwrap_err();
    let (line, column, found) = match &errors[0] {
        ProfileError::Syntax {
            line,
            column,
            message,
            ..
        }
        | ProfileError::Contradiction {
            line,
            column,
            message,
            ..
        } => (*line, *column, message),
        other => panic!("{other}"),
    };
    assert!(
        found.contains(message),
        "{name}: wanted {message:?}, found {found:?}"
    );
    let rest: String = text
        .lines()
        .nth(line - 1)
        .unwrap_or("")
        .chars()
        .skip(column - 1)
        .collect();
    assert!(
        rest.starts_with(place),
        "{name}: points at {line}:{column} {rest:?}"
    );
    let shown = errors[0].to_string();
    assert!(
        shown.contains(&format!("own.toml:{line}:{column}: error: ")),
        "{shown}"
    );
}

const KNOBS: &str = include_str!("../knobs/sgi-dialbox.toml");
const PUPPET: &str = include_str!("../puppets/marionette.toml");
const SERVO: &str = include_str!("../servos/xl330-m288.toml");

#[test]
fn wrong_shapes_are_refused_at_their_place() {
    let rows = [
        (
            "baud = 9600",
            "speed = 9600",
            "unknown field `speed`",
            "speed = 9600",
        ),
        ("baud = 9600\n", "", "missing field `baud`", ""),
        (
            "\"untested\"",
            "\"mostly\"",
            "unknown variant `mostly`",
            "\"mostly\"",
        ),
        ("baud = ", "baud == ", "", "= 9600"),
        (
            "lamps = 32",
            "lamps = 33",
            "lamps must be at most 32, found 33",
            "lamps",
        ),
    ];
    for (at, (from, to, message, place)) in rows.into_iter().enumerate() {
        check_refused(&format!("shape-{at}"), &KNOBS.replace(from, to), message, place);
    }
}

#[test]
fn contradictions_are_refused_at_their_place() {
    let rows = [
        (
            PUPPET,
            "id = 2\n",
            "id = 1\n",
            "id 1 is taken on bus \"upper\"",
            "[[group.joint]]",
        ),
        (
            PUPPET,
            "parent = \"rua\"",
            "parent = \"rfa\"",
            "hangs from \"rfa\"",
            "[[group]]",
        ),
        (
            PUPPET,
            "max_rad = 2.5",
            "max_rad = -2.5",
            "min_rad must lie below",
            "[[group.joint]]",
        ),
        (
            PUPPET,
            "axis = [1.0, 0.0, 0.0]",
            "axis = [1.0, 1.0, 0.0]",
            "axis must be a unit",
            "[[group.joint]]",
        ),
        (
            PUPPET,
            "sign = 1",
            "sign = 2",
            "sign must be 1 or -1, found 2",
            "[[group.joint]]",
        ),
        (
            SERVO,
            "address = 132",
            "address = 130",
            "overlaps the row before it",
            "name = \"Pr",
        ),
        (
            SERVO,
            "name = \"PWM Limit\"",
            "name = \"PWM Bound\"",
            "bounded by \"PWM Limit\"",
            "name = \"Goal PWM",
        ),
    ];
    for (at, (text, from, to, message, place)) in rows.into_iter().enumerate() {
        check_refused(
            &format!("contradiction-{at}"),
            &text.replace(from, to),
            message,
            place,
        );
    }
}

#[test]
fn all_errors_are_said_and_not_only_the_first() {
    let text = KNOBS
        .replace("lamps = 32", "lamps = 33")
        .replace("dials = 8", "dials = 17");
    assert_eq!(read_own("all", &text).unwrap_err().len(), 2);
}

#[test]
fn a_file_of_no_kind_is_told_which_kinds_there_are() {
    let folder = folder("no-kind", &[("x.toml", "name = \"x\"\n")]);
    let errors = Profiles::builtin().with_user_folder(&folder).unwrap_err();
    assert!(
        errors[0].to_string().contains("expected `registers` (servo)"),
        "{}",
        errors[0]
    );
}
