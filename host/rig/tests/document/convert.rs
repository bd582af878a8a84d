//! Converting by file name: tables and figures come out right, and a person's files are never overwritten.

use std::fs;
use std::path::Path;

use super::{salute, salute_folder};
use rig::document::convert::convert;
use rig::document::{self, csv};

#[test]
fn a_table_has_a_row_for_each_frame_and_link() {
    let show = salute();
    let table = csv::export(&show).expect("exports");
    let rows: Vec<Vec<&str>> = table.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!(rows.len(), 1 + 181 * 15, "6 s at 30 frames a second, both ends");
    assert!(rows.iter().all(|row| row.len() == 11));
    assert_eq!(rows[0][..5], ["t_secs", "link", "start_x", "start_y", "start_z"]);
    assert_eq!(rows[1][..5], ["0", "head", "0", "1.0934", "0.0177"]);
    assert_eq!((rows[2715][0], rows[2715][1]), ("6", "lf"));

    // The trunk starts where the head ends, and its angles give its direction back.
    let numbers =
        |row: &[&str]| -> Vec<f64> { row[2..].iter().map(|n| n.parse().expect("a number")).collect() };
    let (head, trunk) = (numbers(&rows[31]), numbers(&rows[32]));
    assert_eq!(head[3..6], trunk[..3]);
    let (alpha, beta) = (trunk[6].to_radians(), trunk[7].to_radians());
    let direction = [alpha.cos() * beta.sin(), alpha.sin() * beta.sin(), beta.cos()];
    for axis in 0..3 {
        assert!((trunk[axis] + 0.3 * direction[axis] - trunk[3 + axis]).abs() < 1e-8);
    }
}

#[test]
fn a_structure_file_becomes_a_show_with_its_shapes() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let made = folder.path().join("human");
    let converted = convert(&salute_folder().join("figure/ar.str"), &made).expect("converts");
    assert_eq!(converted.warnings.len(), 2, "the thighs");
    let show = document::load(&made.join("show.toml")).expect("loads").show;
    assert_eq!(show.figure, salute().figure);
    for file in ["ar.str", "ar.pri", "ar.shp"] {
        let bytes = |folder: &Path| fs::read(folder.join("figure").join(file)).expect(file);
        assert_eq!(
            bytes(&made),
            bytes(&salute_folder()),
            "{file} is kept to the byte"
        );
    }
}

#[test]
fn lengths_that_change_are_missed_in_bvh_and_said_so() {
    let mut show = salute();
    let mut clip = show.current_clip().expect("a clip").as_ref().clone();
    let mut key = clip.keys[3].as_ref().clone();
    key.pose.links[3].length *= 1.5;
    clip.keys[3] = key.into();
    show = show.with_clip("salute", clip);
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (made, out) = (folder.path().join("long"), folder.path().join("long.bvh"));
    document::save(&show, &made).expect("saves");
    let warnings = convert(&made, &out).expect("converts").warnings;
    assert!(
        warnings.iter().any(|w| w.message.contains("changes of length")),
        "{warnings:#?}"
    );
}

#[test]
fn what_cannot_be_converted_is_refused_and_nothing_is_written() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = |name: &str| folder.path().join(name);
    fs::create_dir(path("photos")).expect("a folder");
    fs::write(path("photos/cat.png"), "meow").expect("writes");
    fs::write(path("broken.bvh"), "HIERARCHY\n").expect("writes");
    fs::write(path("still.str"), "one link\n0 a 2 1\n").expect("writes");
    let cases = [
        (salute_folder(), path("photos"), "something else here"),
        (salute_folder(), path("x.obj"), "cannot write a `.obj`"),
        (path("x.obj"), path("y"), "cannot read a `.obj`"),
        (path("nowhere"), path("y"), "cannot open"),
        (path("broken.bvh"), path("y"), "cut off"),
        (path("still.str"), path("y.bvh"), "no keys"),
    ];
    for (from, to, words) in cases {
        let error = convert(&from, &to).expect_err(words).to_string();
        assert!(error.contains(words), "{error}");
    }
    let mut left: Vec<_> = fs::read_dir(folder.path())
        .expect("a folder")
        .flatten()
        .map(|e| e.file_name())
        .collect();
    left.sort();
    assert_eq!(left, ["broken.bvh", "photos", "still.str"]);
}
