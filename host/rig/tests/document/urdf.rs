//! Robots from URDF: geometry as the file says it, and errors where they can be mended.

use std::fmt::Write as _;
use std::path::Path;

use device_profiles::{Profiles, PuppetProfile};
use glam::DVec3;
use motion::{Chain, Interval, Joint, JointIndex, JointKind, Rigid};
use rig::document::FileErrors;
use rig::document::convert::convert_robot;
use rig::document::urdf::{Imported, import};

const CLAW: &str = include_str!("urdf/claw.urdf");
const SERVOS: &str = include_str!("urdf/claw.map.toml");

fn read(urdf: &str, map: &str) -> Result<Imported, FileErrors> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (robot, servos) = (folder.path().join("claw.urdf"), folder.path().join("servos.toml"));
    std::fs::write(&robot, urdf).expect("writes");
    std::fs::write(&servos, map).expect("writes");
    import(&robot, &servos, &Profiles::builtin())
}

/// Where the joints are at some angles, reckoned from the profile alone.
fn places(profile: &PuppetProfile, angles: &[f64]) -> Vec<DVec3> {
    let (mut joints, mut last) = (Vec::new(), Vec::<Option<JointIndex>>::new());
    for group in &profile.groups {
        let parent = group
            .parent
            .as_ref()
            .and_then(|p| profile.groups.iter().position(|g| g.link == *p));
        let mut hangs_from = parent.and_then(|parent| last[parent]);
        for joint in &group.joints {
            let index = JointIndex(joints.len() as u16);
            joints.push(Joint {
                name: joint.name.clone(),
                parent: hangs_from,
                parent_from_joint: Rigid::from_xyz_rpy(
                    DVec3::from_array(joint.origin_xyz_m),
                    DVec3::from_array(joint.origin_rpy_rad),
                ),
                kind: JointKind::Revolute {
                    axis: DVec3::from_array(joint.axis),
                },
                range_rad: Interval::new(joint.min_rad, joint.max_rad),
                speed_max_rad_per_s: joint.speed_max_rad_per_s,
            });
            hangs_from = Some(index);
        }
        last.push(hangs_from);
    }
    let (chain, mut placed) = (Chain::new(joints).expect("a chain"), Vec::new());
    chain.place(&Rigid::IDENTITY, angles, &mut placed);
    placed.iter().map(|rigid| rigid.translation).collect()
}

#[test]
fn a_small_arm_becomes_a_puppet() {
    let Imported {
        profile, warnings, ..
    } = read(CLAW, SERVOS).expect("a puppet");
    assert!(warnings.is_empty(), "{warnings:?}");
    let names: Vec<&str> = profile.groups.iter().map(|g| g.link.as_str()).collect();
    assert_eq!(names, ["base", "arm", "finger", "thumb"]);
    // Base and mount are one: 0.2 kg at 0.02 and 0.1 kg at 0.05.
    let base = &profile.groups[0];
    assert!((base.mass_kg.expect("known") - 0.3).abs() < 1e-12);
    assert!((base.centre_of_mass_xyz_m[2] - (0.2 * 0.02 + 0.1 * 0.05) / 0.3).abs() < 1e-12);
    // A shape without mass is not known; a frame without anything weighs nothing.
    assert_eq!(
        (profile.groups[1].mass_kg, profile.groups[2].mass_kg),
        (Some(0.05), None)
    );
    assert_eq!(profile.groups[1].also, ["RightArm"]);
    let joints: Vec<_> = profile.joints().collect();
    // The mount is turned by a quarter, so the joint sits at +y of the base.
    assert!(DVec3::from_array(joints[0].origin_xyz_m).abs_diff_eq(DVec3::new(0.0, 0.03, 0.06), 1e-12));
    assert_eq!((joints[0].axis, joints[0].min_rad), ([0.0, 0.0, 1.0], -3.13));
    // The slower of robot and mapping.
    assert_eq!(
        (joints[0].speed_max_rad_per_s, joints[1].speed_max_rad_per_s),
        (4.0, 2.5)
    );
    assert_eq!(
        (joints[1].sign, joints[1].bus.as_str(), joints[2].id),
        (-1, "arm", 3)
    );
    let [coupling] = profile.couplings.as_slice() else {
        panic!("one coupling")
    };
    assert_eq!(
        (coupling.joint.as_str(), coupling.follows.as_str()),
        ("oppose", "close")
    );
    assert_eq!((coupling.ratio, coupling.offset_rad), (-1.0, 0.05));
    // The arm reaches to its fingers.
    assert!((profile.groups[1].length_m - 0.1_f64.hypot(0.01)).abs() < 1e-12);
}

#[test]
fn the_written_profile_is_one_that_the_program_reads() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = |name: &str| folder.path().join(name);
    std::fs::write(path("claw.urdf"), CLAW).expect("writes");
    std::fs::write(path("claw.map.toml"), SERVOS).expect("writes");
    let builtin = Profiles::builtin();
    let convert = |out: &str| convert_robot(&path("claw.urdf"), &path("claw.map.toml"), &path(out), &builtin);
    convert("my-claw.toml").expect("converts");
    std::fs::create_dir(path("puppets")).expect("a folder");
    std::fs::rename(path("my-claw.toml"), path("puppets/my-claw.toml")).expect("moves");
    let profiles = Profiles::builtin()
        .with_user_folder(&path("puppets"))
        .expect("reads");
    let profile = profiles.puppet("my-claw").expect("it is there");
    assert_eq!((profile.name.as_str(), profile.joints().count()), ("Claw", 3));
    assert!(convert("claw.bvh").is_err());
}

/// The shipped arm's structure written as the URDF it came from: every joint a link of its own, with a fixed frame at
/// the gripper.
fn as_urdf(profile: &PuppetProfile) -> String {
    let numbers = |v: [f64; 3]| format!("{:?} {:?} {:?}", v[0], v[1], v[2]);
    let mut text = String::from("<robot name=\"so101\">");
    for group in &profile.groups {
        let _ = write!(
            text,
            "<link name=\"{}\"><inertial><origin xyz=\"{}\"/><mass value=\"{:?}\"/>\
             <inertia ixx=\"0\" ixy=\"0\" ixz=\"0\" iyy=\"0\" iyz=\"0\" izz=\"0\"/></inertial></link>",
            group.link,
            numbers(group.centre_of_mass_xyz_m),
            group.mass_kg.unwrap_or(0.0)
        );
        let (Some(parent), [joint]) = (&group.parent, group.joints.as_slice()) else {
            continue;
        };
        let _ = write!(
            text,
            "<joint name=\"{}\" type=\"revolute\"><origin xyz=\"{}\" rpy=\"{}\"/><parent link=\"{parent}\"/>\
             <child link=\"{}\"/><axis xyz=\"{}\"/><limit lower=\"{:?}\" upper=\"{:?}\" effort=\"10\" velocity=\"10\"/></joint>",
            joint.name,
            numbers(joint.origin_xyz_m),
            numbers(joint.origin_rpy_rad),
            group.link,
            numbers(joint.axis),
            joint.min_rad,
            joint.max_rad
        );
    }
    text + "<link name=\"gripper_frame\"/><joint name=\"gripper_frame_joint\" type=\"fixed\">\
            <origin xyz=\"-0.0079 -0.0002 -0.0981\"/><parent link=\"gripper\"/><child link=\"gripper_frame\"/></joint></robot>"
}

#[test]
fn the_so_101_comes_out_as_it_is_shipped() {
    let profiles = Profiles::builtin();
    let shipped = profiles.puppet("so-101").expect("it is shipped");
    let mut map = String::from(
        "[[bus]]\nname = \"arm\"\nbaud = 1000000\n[defaults]\nmodel = \"STS3215\"\nzero_counts = 2048\n\
         speed_max_rad_per_s = 3.5\naccel_max_rad_per_s2 = 25.0\n",
    );
    for joint in shipped.joints() {
        let _ = write!(
            map,
            "[joint.{}]\nid = {}\nzero_counts = {}\nsign = {}\n",
            joint.name, joint.id, joint.zero_counts, joint.sign
        );
    }
    let Imported { profile, .. } = read(&as_urdf(shipped), &map).expect("a puppet");
    let joints: Vec<_> = profile.joints().collect();
    for (made, shipped) in joints.iter().zip(shipped.joints()) {
        assert_eq!(
            (&made.name, made.id, made.zero_counts, made.min_rad),
            (&shipped.name, shipped.id, shipped.zero_counts, shipped.min_rad)
        );
    }
    for step in 0..20 {
        let angles: Vec<f64> = (0..joints.len())
            .map(|j| (f64::from(step) + j as f64 * 1.7).sin())
            .collect();
        for (made, wanted) in places(&profile, &angles).iter().zip(places(shipped, &angles)) {
            assert!(made.abs_diff_eq(wanted, 1e-9), "{made} for {wanted}");
        }
    }
    // The gripper is drawn to the frame that is fixed to it.
    let gripper = profile.group("gripper").expect("a group");
    assert!((gripper.length_m - DVec3::new(-0.0079, -0.0002, -0.0981).length()).abs() < 1e-9);
}

#[test]
fn what_is_wrong_is_said_where_it_is() {
    let cases: [(&str, &str, bool, &str, &str); 9] = [
        ("<robot", "<rabbit", true, "no URDF", "xacro"),
        ("link=\"finger\"", "link=\"fist\"", true, "link fist", ""),
        (
            "child link=\"thumb\"",
            "child link=\"finger\"",
            true,
            "hangs from two joints",
            "loops",
        ),
        ("[joint.close]", "[joint.shut]", false, "no joint shut", "close"),
        ("id = 2\n", "", false, "joint close has no id", "[joint.close]"),
        (
            "[joint.turn]\nid = 1",
            "",
            false,
            "turns, but the mapping has no servo",
            "rigid",
        ),
        ("upper=\"0.8\"", "upper=\"-1\"", true, "no range", "min_rad"),
        (
            "type=\"continuous\"",
            "type=\"prismatic\"",
            true,
            "prismatic",
            "linkage",
        ),
        (
            "baud = 1000000",
            "bauds = 1000000",
            false,
            "bauds",
            "[joint.NAME]",
        ),
    ];
    for (from, to, in_robot, message, hint) in cases {
        let change = |text: &str, here: bool| {
            if here {
                text.replacen(from, to, 1)
            } else {
                text.to_owned()
            }
        };
        let (robot, servos) = (change(CLAW, in_robot), change(SERVOS, !in_robot));
        assert!(robot != CLAW || servos != SERVOS, "{from} is in neither file");
        let errors = read(&robot, &servos).expect_err(message).0;
        let told = errors.iter().find(|error| error.message.contains(message));
        let told = told.unwrap_or_else(|| panic!("{message} in {errors:?}"));
        assert!(told.hint.clone().unwrap_or_default().contains(hint), "{told}");
        let file = told.file.file_name().and_then(|name| name.to_str());
        assert!(Path::new(file.unwrap_or_default()).extension().is_some() && told.line >= 1);
    }
}

#[test]
fn what_has_no_servo_may_be_named_rigid() {
    let without = SERVOS.replace("[joint.oppose]\nid = 3\n", "");
    let Imported {
        profile, warnings, ..
    } = read(CLAW, &without).expect("a puppet");
    assert_eq!((profile.joints().count(), warnings.len()), (2, 1));
    let named = format!("rigid = [\"oppose\"]\n{without}");
    assert!(read(CLAW, &named).expect("a puppet").warnings.is_empty());
}
