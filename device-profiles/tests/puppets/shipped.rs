//! Every shipped puppet, held to its servos and to its own shape.

use crate::kinematics::{Placed, V, close, place, turn};
use device_profiles::{Profiles, PuppetProfile, Role};
use std::f64::consts::FRAC_PI_2;

/// Key, joints, buses, the servos' protocols, whether it follows a figure.
const PUPPETS: [(&str, usize, usize, &str, bool); 8] = [
    ("koch-v1-1", 6, 1, "DYNAMIXEL 2.0", false),
    ("marionette", 22, 2, "DYNAMIXEL 2.0", true),
    ("op3", 20, 1, "DYNAMIXEL 2.0", true),
    ("open-duck-mini-v2", 14, 1, "Feetech STS", false),
    ("openmanipulator-x", 5, 1, "DYNAMIXEL 2.0", false),
    ("so-101", 6, 1, "Feetech STS", false),
    ("stack-chan", 2, 1, "Feetech SCS", false),
    ("starter", 2, 1, "DYNAMIXEL 2.0", false),
];

#[test]
fn the_promised_puppets_are_there() {
    let all = Profiles::builtin();
    let found: Vec<_> = all
        .puppets()
        .map(|p| {
            let protocol = all.servo(&p.joints().next().unwrap().model).unwrap().protocol;
            (
                p.key.clone(),
                p.joints().count(),
                p.buses.len(),
                protocol.to_string(),
                p.figure.is_some(),
            )
        })
        .collect();
    let want = PUPPETS.map(|(key, joints, buses, protocol, figure)| {
        (key.to_owned(), joints, buses, protocol.to_owned(), figure)
    });
    assert_eq!(found, want);
}

#[test]
fn every_joint_lies_inside_what_its_servo_can_do() {
    let all = Profiles::builtin();
    for puppet in all.puppets() {
        for joint in puppet.joints() {
            let shown = format!("{}: {}", puppet.name, joint.name);
            let servo = all.servo(&joint.model).unwrap();
            let [first, last] = servo.position_counts.map(|c| c as f64);
            for q in [joint.min_rad, joint.max_rad, 0.0] {
                let counts = f64::from(joint.zero_counts) + f64::from(joint.sign) * q / servo.rad_per_count();
                assert!(
                    (first..=last).contains(&counts),
                    "{shown}: {q} rad is count {counts}"
                );
            }
            assert!(
                (joint.min_rad..=joint.max_rad).contains(&0.0),
                "{shown} can stand at rest"
            );
            let motor = servo.motor.as_ref().unwrap();
            assert!(
                joint.speed_max_rad_per_s < motor.no_load_speed_rad_per_s,
                "{shown} is too fast"
            );
            let bus = puppet.bus(&joint.bus).unwrap();
            assert!(
                servo.baud_code(bus.baud).is_some(),
                "{shown} has no {} baud",
                bus.baud
            );
            let limit_c = servo.role(Role::TemperatureLimit).unwrap().init.unwrap() as f64;
            assert!(
                puppet.policy.hot_c < limit_c,
                "{shown} lets go before it is called hot"
            );
        }
    }
}

#[test]
fn each_link_ends_where_the_next_begins() {
    for puppet in Profiles::builtin().puppets().filter(|p| p.figure.is_none()) {
        let at = place(puppet, &[]);
        for group in &puppet.groups {
            let children: Vec<_> = puppet
                .groups
                .iter()
                .filter(|g| g.parent.as_ref() == Some(&group.link))
                .collect();
            let [child] = children[..] else { continue };
            // The jaw sits beside the gripper, not at its tip.
            if child.link == "moving_jaw" {
                continue;
            }
            let joint = child.joints.first().unwrap();
            // The link's frame without the joint's own turn: the parent's end must be the child's origin.
            let end = at[&group.link].end;
            let gap = distance(end, origin(puppet, &at, &child.link));
            assert!(
                gap < 2e-4,
                "{}: {} to {}: {gap} m",
                puppet.name,
                group.link,
                joint.name
            );
        }
    }
}

fn distance(a: V, b: V) -> f64 {
    (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt()
}

/// Where a link's last joint is; links here start in it.
fn origin(puppet: &PuppetProfile, at: &std::collections::BTreeMap<String, Placed>, link: &str) -> V {
    let group = puppet.group(link).unwrap();
    assert_eq!(group.tool_xyz_m, [0.0; 3], "{link} starts in its joint");
    at[link].start
}

/// The model's own numbers: where tips are when all angles are 0, in metres.
#[test]
fn arms_reach_where_their_models_say() {
    let all = Profiles::builtin();
    let rows: [(&str, &str, V); 5] = [
        // The sums of the link lengths in the maker's drawing.
        ("openmanipulator-x", "fingers", [0.286, 0.0, 0.2045]),
        // mujoco_menagerie's frames, which give turns as quaternions: shoulder, elbow, wrist, hand.
        ("so-101", "shoulder", [0.0692, -0.0183, 0.1166]),
        ("so-101", "upper_arm", [0.0972, -0.0183, 0.2292]),
        ("so-101", "lower_arm", [0.2321, -0.0183, 0.2344]),
        ("so-101", "wrist", [0.2932, -0.0002, 0.2344]),
    ];
    for (puppet, link, want) in rows {
        let end = place(all.puppet(puppet).unwrap(), &[])[link].end;
        assert!(distance(end, want) < 2e-4, "{puppet}: {link} ends at {end:?}");
    }
}

// The robot's frame: x forward, y left, z up.
const FORWARD: V = [1.0, 0.0, 0.0];
const BACK: V = [-1.0, 0.0, 0.0];
const RIGHT: V = [0.0, -1.0, 0.0];
const UP: V = [0.0, 0.0, 1.0];
const DOWN: V = [0.0, 0.0, -1.0];

/// Angles of a left limb and of the right one that mirror each other.
type Mirror = &'static [(&'static str, f64, f64)];

#[test]
fn two_legged_puppets_are_the_same_on_both_sides() {
    let all = Profiles::builtin();
    let op3: Mirror = &[
        ("{}_sho_pitch", 0.3, -0.3),
        ("{}_sho_roll", 0.9, -0.9),
        ("{}_el", -0.5, 0.5),
        ("{}_hip_yaw", 0.2, -0.2),
        ("{}_hip_roll", 0.1, -0.1),
        ("{}_hip_pitch", -0.6, 0.6),
        ("{}_knee", 1.1, -1.1),
        ("{}_ank_pitch", 0.5, -0.5),
        ("{}_ank_roll", 0.15, -0.15),
    ];
    // The runtime's own pose for standing has equal knees and ankles and opposite hips.
    let duck: Mirror = &[
        ("{}_hip_yaw", 0.2, -0.2),
        ("{}_hip_roll", 0.1, -0.1),
        ("{}_hip_pitch", -0.4, 0.4),
        ("{}_knee", 0.8, 0.8),
        ("{}_ankle", -0.4, -0.4),
    ];
    let op3_links = [
        ("lua", "rua"),
        ("lfa", "rfa"),
        ("lt", "rt"),
        ("lc", "rc"),
        ("lf", "rf"),
    ];
    // The frames of thigh and shank lie on one side of either leg; where its ends are tells all the same.
    let duck_links = [
        ("left_hip", "right_hip"),
        ("left_hip_bracket", "right_hip_bracket"),
        ("left_foot", "right_foot"),
    ];
    for (key, sides, mirror, links) in [
        ("op3", ["l", "r"], op3, &op3_links[..]),
        ("open-duck-mini-v2", ["left", "right"], duck, &duck_links),
    ] {
        let puppet = all.puppet(key).unwrap();
        let named: Vec<(String, f64)> = mirror
            .iter()
            .flat_map(|&(name, left, right)| {
                [(sides[0], left), (sides[1], right)].map(|(s, q)| (name.replace("{}", s), q))
            })
            .collect();
        for (name, _) in &named {
            assert!(puppet.joint(name).is_some(), "{key} has no {name}");
        }
        let angles: Vec<(&str, f64)> = named.iter().map(|(n, q)| (n.as_str(), *q)).collect();
        for pose in [&angles[..], &[]] {
            let at = place(puppet, pose);
            for (left, right) in links {
                let [x, y, z] = at[*left].end;
                let gap = distance([x, -y, z], at[*right].end);
                // The duck's own model has its right knee 2.4 mm further out than its left one.
                assert!(
                    gap < 3e-3,
                    "{key}: {left} ends at {:?}, {right} at {:?}",
                    at[*left].end,
                    at[*right].end
                );
                assert!(y > 0.0, "{key}: {left} is on the left");
            }
        }
    }
}

/// Directions in the robot's frame: x forward, y left, z up.
#[test]
fn op3_stands_like_the_figure_when_its_arms_hang() {
    let all = Profiles::builtin();
    let puppet = all.puppet("op3").unwrap();
    let at = place(puppet, &[("l_sho_roll", FRAC_PI_2), ("r_sho_roll", -FRAC_PI_2)]);
    for (link, placed) in &at {
        let foot = ["rf", "lf"].contains(&link.as_str());
        let along = if foot { FORWARD } else { DOWN };
        assert!(
            close(placed.direction(), along),
            "{link} points to {:?}",
            placed.direction()
        );
        assert!(
            close(turn(placed.frame, [1.0, 0.0, 0.0]), [0.0, -1.0, 0.0]),
            "{link}: x is to the right"
        );
    }
    // The maker's data sheet: 0.51 m.
    let tall = at["head"].start[2] - at["lf"].start[2];
    assert!((0.49..0.52).contains(&tall), "{tall} m tall");
}

#[test]
fn op3_bends_the_way_its_comments_say() {
    let all = Profiles::builtin();
    let puppet = all.puppet("op3").unwrap();
    let hanging = [("l_sho_roll", FRAC_PI_2), ("r_sho_roll", -FRAC_PI_2)];
    let rows = [
        ("l_sho_pitch", &hanging[..], "lua", BACK),
        ("r_sho_pitch", &hanging, "rua", FORWARD),
        ("l_sho_roll", &[], "lua", DOWN),
        ("r_sho_roll", &[], "rua", UP),
        ("l_el", &[], "lfa", UP),
        ("r_el", &[], "rfa", DOWN),
        ("l_hip_roll", &[], "lt", RIGHT),
        ("r_hip_roll", &[], "rt", RIGHT),
        ("l_hip_pitch", &[], "lt", BACK),
        ("r_hip_pitch", &[], "rt", FORWARD),
        ("l_knee", &[], "lc", BACK),
        ("r_knee", &[], "rc", FORWARD),
        ("l_hip_yaw", &[], "lf", RIGHT),
        ("r_hip_yaw", &[], "rf", RIGHT),
        ("l_ank_pitch", &[], "lf", UP),
        ("r_ank_pitch", &[], "rf", DOWN),
    ];
    for (joint, pose, link, towards) in rows {
        let before = place(puppet, pose)[link].direction();
        let mut turned: Vec<_> = pose.iter().filter(|(n, _)| *n != joint).copied().collect();
        turned.push((joint, 0.2));
        let after = place(puppet, &turned)[link].direction();
        let moved: f64 = (0..3).map(|i| (after[i] - before[i]) * towards[i]).sum();
        assert!(
            (moved - 0.2_f64.sin()).abs() < 1e-6,
            "{joint}: {link} from {before:?} to {after:?}"
        );
    }
}
