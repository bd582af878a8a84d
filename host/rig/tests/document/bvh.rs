//! Motion capture in and out: what a BVH file says must come back, and what is broken is named in its place.

use std::path::{Path, PathBuf};

use super::salute;
use glam::DVec3;
use rig::document::Show;
use rig::document::bvh::{self, BvhFile};
use rig::document::convert::convert;
use rig::document::source::Source;

/// Joint positions worked out here from channels and offsets alone, another way than the importer does it.
fn joints(file: &BvhFile, frame: usize) -> Vec<DVec3> {
    use glam::DMat4;
    use rig::document::bvh::Channel;
    let mut worlds: Vec<DMat4> = Vec::new();
    let mut values = file.row(frame).iter();
    for (place, joint) in file.skeleton.joints.iter().enumerate() {
        let mut position = joint.offset;
        let mut turn = DMat4::IDENTITY;
        for channel in &joint.channels {
            let value = values.next().copied().unwrap_or_default();
            match channel {
                Channel::Position(axis) if place == 0 => position[usize::from(*axis)] += value,
                Channel::Position(_) => {}
                Channel::Rotation(0) => turn *= DMat4::from_rotation_x(value.to_radians()),
                Channel::Rotation(1) => turn *= DMat4::from_rotation_y(value.to_radians()),
                Channel::Rotation(_) => turn *= DMat4::from_rotation_z(value.to_radians()),
            }
        }
        let own = DMat4::from_translation(position) * turn;
        worlds.push(joint.parent.map_or(own, |parent| worlds[parent] * own));
    }
    worlds.iter().map(|world| world.w_axis.truncate()).collect()
}

fn read(text: &str) -> BvhFile {
    bvh::read(&Source::from_text(Path::new("a.bvh"), text))
        .expect("a sound file")
        .0
}

fn import(text: &str) -> Show {
    bvh::import(&Source::from_text(Path::new("a.bvh"), text), "a")
        .expect("a sound file")
        .show
}

/// Largest distance of any joint between two files, as a share of the figure's height.
fn worst_share(a: &BvhFile, b: &BvhFile) -> f64 {
    assert_eq!(a.frame_count(), b.frame_count());
    let worst = (0..a.frame_count())
        .flat_map(|frame| joints(a, frame).into_iter().zip(joints(b, frame)))
        .map(|(a, b)| a.distance(b))
        .fold(0.0, f64::max);
    worst / a.skeleton.height()
}

fn capture() -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/cmu_01_01.bvh");
    if path.exists() {
        return Some(path);
    }
    eprintln!(
        "SKIPPED: {} is not here; the capture is not part of the project",
        path.display()
    );
    None
}

#[test]
fn a_real_capture_survives_the_way_through_a_show_folder() {
    let Some(path) = capture() else { return };
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (show, back) = (folder.path().join("walk"), folder.path().join("back.bvh"));
    assert_eq!(convert(&path, &show).expect("imports").warnings, []);
    convert(&show, &back).expect("exports");

    let before = bvh::read(&Source::open(&path).expect("opens")).expect("reads").0;
    let after = bvh::read(&Source::open(&back).expect("opens")).expect("reads").0;
    assert_eq!(
        after.skeleton, before.skeleton,
        "names, hierarchy, offsets and channel order"
    );
    assert_eq!((after.frame_count(), after.frame_secs), (2752, 0.008_333_3));
    let share = worst_share(&before, &after);
    assert!(share < 2e-6, "joints moved by {share} of the figure's height");

    let clip = show.join("clips").join("cmu_01_01.toml");
    let size = |path: &Path| std::fs::metadata(path).expect("is there").len();
    assert!(size(&clip) < 2 * size(&path), "{} bytes", size(&clip));
}

#[test]
fn the_figure_of_a_capture_stands_where_the_capture_stands() {
    let Some(path) = capture() else { return };
    let source = Source::open(&path).expect("opens");
    let file = bvh::read(&source).expect("reads").0;
    let show = bvh::import(&source, "walk").expect("imports").show;
    let figure = &show.figure.as_ref().expect("a figure").figure;
    let clip = show
        .current_clip()
        .expect("a clip")
        .clip(figure)
        .expect("builds")
        .expect("keys");
    let mut placed = Vec::new();
    for frame in (0..file.frame_count()).step_by(97) {
        clip.place(frame as f64 * file.frame_secs, &mut placed);
        for (joint, link) in joints(&file, frame).into_iter().zip(&placed) {
            assert!(
                joint.distance(link.start) < 1e-6 * file.skeleton.height(),
                "frame {frame}"
            );
        }
    }
    // Between frames a link goes the short way: no whole turns where the twist angle wraps. The capture's
    // first frame is a calibration pose far from the others.
    let links = &show.current_clip().expect("a clip").keys;
    let (mut before, mut now) = (Vec::new(), Vec::new());
    for frame in (2..links.len()).step_by(13) {
        clip.place((frame as f64 - 1.0) * file.frame_secs, &mut before);
        clip.place((frame as f64 - 0.5) * file.frame_secs, &mut now);
        for (a, b) in before.iter().zip(&now) {
            assert!(
                a.world_from_link.x_axis.dot(b.world_from_link.x_axis) > 0.9,
                "frame {frame}"
            );
        }
    }
}

/// A root with a branch, ends, a nameless extent, and every order of rotation that fits.
fn branch(channels: &str, rows: &str) -> String {
    format!(
        "HIERARCHY\nROOT Hip bone\n{{\n OFFSET 1 2 3\n CHANNELS 6 Xposition Yposition Zposition {channels}\n \
         JOINT a {{ OFFSET 0 0 0 CHANNELS 3 {channels}\n  JOINT b {{ OFFSET 0 -4 0 CHANNELS 3 {channels} \
         End Site {{ OFFSET 0 -3 1 }} }} }}\n JOINT c {{ OFFSET 0 0 0 CHANNELS 3 {channels} }}\n}}\n\
         MOTION\nFrames: 3\nFrame Time: 0.04\n{rows}"
    )
}

const ROWS: &str = "0 0 0 0 0 0 0 0 0 0 0 0 0 0 0\n\
    1 2 3 10 20 30 -40 50 60 70 80 90 170 -170 5\n\
    1 2 4 15 95 30 -40 90 60 -170 80 90 -170 -170 365\n";

#[test]
fn every_order_of_rotations_comes_back() {
    let [x, y, z] = ["Xrotation", "Yrotation", "Zrotation"];
    for order in [[x, y, z], [x, z, y], [y, x, z], [y, z, x], [z, x, y], [z, y, x]] {
        let file = read(&branch(&order.join(" "), ROWS));
        let exported = bvh::export(&import(&branch(&order.join(" "), ROWS))).expect("exports");
        assert_eq!(exported.warnings, Vec::<String>::new());
        let back = read(&exported.text);
        assert_eq!(back.skeleton, file.skeleton, "{order:?}");
        assert!(worst_share(&file, &back) < 1e-6, "{order:?}");
    }
}

#[test]
fn names_become_words_and_joints_without_extent_a_short_link() {
    let show = import(&branch("Zrotation Yrotation Xrotation", ROWS));
    let figure = &show.figure.as_ref().expect("a figure").figure;
    let links: Vec<(&str, f64)> = figure
        .links()
        .iter()
        .map(|l| (l.name.as_str(), l.length))
        .collect();
    let end = 10.0_f64.sqrt();
    assert_eq!(links, [("Hip_bone", 0.07), ("a", 4.0), ("b", end), ("c", 0.07)]);
}

#[test]
fn rows_beyond_the_promised_are_ignored_and_said_so() {
    let text = branch("Zrotation Yrotation Xrotation", &format!("{ROWS}1 2\n\nfour\n"));
    let (file, warnings) = bvh::read(&Source::from_text(Path::new("a.bvh"), text)).expect("reads");
    assert_eq!(file.frame_count(), 3);
    assert_eq!(warnings.len(), 1);
    assert!(
        warnings[0].message.contains("2 rows beyond the 3"),
        "{}",
        warnings[0]
    );
}

#[test]
fn positions_below_the_root_may_only_repeat_what_the_skeleton_says() {
    let with = |value: &str| {
        format!(
            "HIERARCHY\nROOT r {{ OFFSET 0 0 0 CHANNELS 3 Zrotation Xrotation Yrotation JOINT a {{ OFFSET 0 2 0 \
             CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation End Site {{ OFFSET 0 1 0 }} }} }}\n\
             MOTION\nFrames: 2\nFrame Time: 0.1\n0 0 0 0 {value} 0 0 0 0\n1 2 3 0 {value} 0 4 5 6\n"
        )
    };
    for value in ["0", "2"] {
        let file = read(&with(value));
        let back = read(&bvh::export(&import(&with(value))).expect("exports").text);
        assert_eq!(back.skeleton, file.skeleton);
        assert_eq!(back.row(0)[4], value.parse::<f64>().expect("a number"));
        assert!(worst_share(&file, &back) < 1e-6);
    }
    let error = bvh::read(&Source::from_text(Path::new("a.bvh"), with("1"))).expect_err("moves");
    assert!(
        error.to_string().contains("`a` moves against its parent"),
        "{error}"
    );
}

/// What is replaced in a sound file, by what, where the error is, and what it says.
type Damage = (&'static str, &'static str, (u32, u32), &'static str);

const DAMAGE: [Damage; 15] = [
    ("HIERARCHY", "version = 1", (1, 1), "expected `HIERARCHY`"),
    ("0 0 0 0 0 0 0 0 0 0 0 0 0 0 0\n", "", (15, 1), "ends after 2"),
    ("170 -170 5", "170 -17O 5", (14, 39), "`-17O`"),
    ("170 -170 5", "170 nan 5", (14, 39), "not a finite"),
    ("OFFSET 0 -4 0", "OFFSET 0 -inf 0", (7, 22), "not a finite"),
    ("170 -170 5", "170 -170", (14, 43), "14 values"),
    ("6 Xposition", "6 Wposition", (5, 13), "unknown channel"),
    ("CHANNELS 6", "CHANNELS 7", (5, 11), "0 to 6"),
    ("Frames: 3", "Frames: 99999999", (11, 9), "at most"),
    ("Frames: 3", "Frames: three", (11, 9), "number of frames"),
    ("0.04", "0", (12, 13), "above 0"),
    ("0.04", "1e-9", (12, 13), "cannot be meant"),
    ("0.04", "4e9", (12, 13), "cannot be meant"),
    (
        "3 Zrotation Yrotation Xrotation\n",
        "1 Zrotation\n",
        (6, 36),
        "3 or none",
    ),
    ("6 Xposition Y", "6 Xposition X", (5, 23), "twice"),
];

#[test]
fn what_is_broken_is_named_in_its_place() {
    let good = branch("Zrotation Yrotation Xrotation", ROWS);
    let damaged = DAMAGE.map(|(from, to, place, words)| (good.replace(from, to), place, words));
    let cut = [
        (String::new(), (1, 1), "cut off"),
        (good[..60].to_owned(), (5, 21), "cut off"),
        (good[..good.len() - 60].to_owned(), (14, 36), "13 values"),
    ];
    for (text, place, words) in damaged.into_iter().chain(cut) {
        let errors = bvh::read(&Source::from_text(Path::new("a.bvh"), text))
            .expect_err(words)
            .0;
        let found = errors
            .iter()
            .any(|e| (e.line, e.column) == place && e.message.contains(words));
        assert!(found, "expected `{words}` at {place:?}, found {errors:#?}");
    }
}

#[test]
fn all_broken_values_are_reported_not_only_the_first() {
    let text = branch(
        "Zrotation Yrotation Xrotation",
        &ROWS.replace("10 20", "x y").replace("365", "z"),
    );
    let errors = bvh::read(&Source::from_text(Path::new("a.bvh"), text))
        .expect_err("broken")
        .0;
    assert_eq!(errors.len(), 3);
}

#[test]
fn too_deep_is_an_error_and_not_a_crash() {
    let text = format!(
        "HIERARCHY ROOT r {{ OFFSET 0 0 0 CHANNELS 0 {}",
        "JOINT j { OFFSET 0 1 0 CHANNELS 0 ".repeat(6000)
    );
    let error = bvh::read(&Source::from_text(Path::new("a.bvh"), text)).expect_err("too many");
    assert!(error.to_string().contains("more than 4096 joints"), "{error}");
}

#[test]
fn a_figure_of_the_thesis_goes_out_with_one_joint_a_link() {
    let show = salute();
    let file = read(&bvh::export(&show).expect("exports").text);
    let figure = &show.figure.as_ref().expect("a figure").figure;
    let names: Vec<&str> = file
        .skeleton
        .joints
        .iter()
        .map(|joint| joint.name.as_str())
        .collect();
    assert_eq!(
        names,
        figure
            .links()
            .iter()
            .map(|link| link.name.as_str())
            .collect::<Vec<_>>()
    );
    let clip = show
        .current_clip()
        .expect("a clip")
        .clip(figure)
        .expect("builds")
        .expect("keys");
    let mut placed = Vec::new();
    for frame in 0..file.frame_count() {
        clip.place(clip.start_secs() + frame as f64 * file.frame_secs, &mut placed);
        for (joint, link) in joints(&file, frame).into_iter().zip(&placed) {
            assert!(joint.distance(link.start) < 1e-6, "frame {frame}");
        }
    }
}
