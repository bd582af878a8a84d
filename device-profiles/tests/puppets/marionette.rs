//! The shipped puppet, worked through with its own small forward kinematics: it stands, and every joint bends
//! the way its comment says. Directions are in the trunk's frame: x right, y back, z down.

use crate::kinematics::{Pose, V, add, close, place, turn};
use device_profiles::{Profiles, PuppetProfile, Unit};
use std::f64::consts::FRAC_PI_2;

const RIGHT: V = [1.0, 0.0, 0.0];
const LEFT: V = [-1.0, 0.0, 0.0];
const BACK: V = [0.0, 1.0, 0.0];
const FORWARD: V = [0.0, -1.0, 0.0];
const DOWN: V = [0.0, 0.0, 1.0];
const UP: V = [0.0, 0.0, -1.0];

fn marionette() -> PuppetProfile {
    Profiles::builtin().puppet("marionette").unwrap().clone()
}

#[test]
fn at_rest_it_stands_with_hanging_arms() {
    let at = place(&marionette(), &[]);
    for (link, placed) in &at {
        let want = if ["rf", "lf"].contains(&link.as_str()) {
            FORWARD
        } else {
            DOWN
        };
        assert!(close(placed.direction(), want), "{link}");
        assert!(
            close(turn(placed.frame, RIGHT), RIGHT),
            "{link}: x stays to the right"
        );
    }
    // One body: each link begins where the one above it ends.
    for (above, below) in [
        ("rua", "rfa"),
        ("rfa", "rh"),
        ("rt", "rc"),
        ("rc", "rf"),
        ("lua", "lfa"),
        ("lt", "lc"),
    ] {
        assert!(close(at[above].end, at[below].start), "{above} to {below}");
    }
    assert!(
        close(at["head"].end, at["trunk"].start),
        "the head link ends at the neck"
    );
    assert!(
        close(at["trunk"].end, at["pelv"].start),
        "the trunk ends at the waist"
    );
    assert!(
        at["rua"].start[0] > 0.0 && at["lua"].start[0] < 0.0,
        "the right arm is on the right"
    );
    assert!(
        (at["rc"].end[2] - at["lc"].end[2]).abs() < 1e-12,
        "both feet are level"
    );
    let tall = at["rc"].end[2] - at["head"].start[2];
    assert!((0.6..0.8).contains(&tall), "{tall} m tall");
}

#[test]
fn every_joint_bends_the_way_its_comment_says() {
    let puppet = marionette();
    let q = 0.4;
    // Joint, link, and the direction towards which the link's end leans at a small positive angle.
    let rows = [
        ("neck_pitch", "head", BACK),
        ("neck_roll", "head", LEFT),
        ("waist_roll", "pelv", RIGHT),
        ("waist_pitch", "pelv", FORWARD),
        ("right_shoulder_pitch", "rua", FORWARD),
        ("left_shoulder_pitch", "lua", FORWARD),
        ("right_shoulder_roll", "rua", RIGHT),
        ("left_shoulder_roll", "lua", LEFT),
        ("right_elbow", "rfa", FORWARD),
        ("left_elbow", "lfa", FORWARD),
        ("right_hip_pitch", "rt", FORWARD),
        ("left_hip_pitch", "lt", FORWARD),
        ("right_hip_roll", "rt", RIGHT),
        ("left_hip_roll", "lt", LEFT),
        ("right_knee", "rc", BACK),
        ("left_knee", "lc", BACK),
    ];
    for (joint, link, towards) in rows {
        let direction = place(&puppet, &[(joint, q)])[link].direction();
        let want = add(DOWN.map(|c| c * f64::cos(q)), towards.map(|c| c * f64::sin(q)));
        assert!(close(direction, want), "{joint}: {link} points to {direction:?}");
    }
    // Where the face, and the pelvis under it, look.
    let rows = [
        ("neck_yaw", "head", [-q.sin(), -q.cos(), 0.0]),
        ("waist_yaw", "pelv", [q.sin(), -q.cos(), 0.0]),
    ];
    for (joint, link, want) in rows {
        let placed = place(&puppet, &[(joint, q)])[link];
        assert!(close(turn(placed.frame, FORWARD), want), "{joint}");
    }
    // Turns about a limb's own length show only when the next link is bent.
    let rows = [
        ("right_arm_yaw", "right_elbow", "rfa", LEFT, FORWARD),
        ("left_arm_yaw", "left_elbow", "lfa", RIGHT, FORWARD),
        ("right_leg_yaw", "right_knee", "rc", RIGHT, BACK),
        ("left_leg_yaw", "left_knee", "lc", LEFT, BACK),
    ];
    for (yaw, hinge, link, inwards, bent) in rows {
        let direction = place(&puppet, &[(yaw, q), (hinge, FRAC_PI_2)])[link].direction();
        let want = add(bent.map(|c| c * f64::cos(q)), inwards.map(|c| c * f64::sin(q)));
        assert!(close(direction, want), "{yaw}: {link} points to {direction:?}");
    }
}

#[test]
fn gestures_come_out_as_gestures() {
    let puppet = marionette();
    let rows: [(Pose<'_>, &str, V); 6] = [
        (&[("right_shoulder_pitch", FRAC_PI_2)], "rua", FORWARD),
        (&[("right_shoulder_roll", FRAC_PI_2)], "rua", RIGHT),
        (&[("left_shoulder_roll", FRAC_PI_2)], "lua", LEFT),
        // Embracing: upper arm sideways, forearm to the front.
        (
            &[
                ("right_shoulder_roll", FRAC_PI_2),
                ("right_arm_yaw", 0.0),
                ("right_elbow", FRAC_PI_2),
            ],
            "rfa",
            FORWARD,
        ),
        (
            &[("right_shoulder_pitch", FRAC_PI_2), ("right_elbow", FRAC_PI_2)],
            "rfa",
            UP,
        ),
        // Sitting: thigh forward, shank down again.
        (
            &[("left_hip_pitch", FRAC_PI_2), ("left_knee", FRAC_PI_2)],
            "lc",
            DOWN,
        ),
    ];
    for (angles, link, want) in rows {
        for (name, q) in angles {
            let joint = puppet.joint(name).unwrap();
            assert!((joint.min_rad..=joint.max_rad).contains(q), "{name} reaches {q}");
        }
        let direction = place(&puppet, angles)[link].direction();
        assert!(close(direction, want), "{angles:?}: {direction:?}");
    }
}

/// Of all directions, the part that a limb's first two joints reach inside their limits, by closed form:
/// pitch about x, then roll about ±y, gives (±sin r, −sin p cos r, cos p cos r).
fn reached(puppet: &PuppetProfile, pitch: &str, roll: &str, mirror: f64, wanted: impl Fn(V) -> bool) -> f64 {
    let within = |name: &str, q: f64| {
        let joint = puppet.joint(name).unwrap();
        (joint.min_rad..=joint.max_rad).contains(&q)
    };
    let (mut all, mut there) = (0.0, 0.0);
    for i in 0..2_000 {
        // Directions spread evenly by the golden angle.
        let z = 1.0 - 2.0 * (f64::from(i) + 0.5) / 2_000.0;
        let around = f64::from(i) * 2.399_963;
        let flat = (1.0 - z * z).sqrt();
        let d = [flat * around.cos(), flat * around.sin(), z];
        if !wanted(d) {
            continue;
        }
        all += 1.0;
        let r = (mirror * d[0]).asin();
        let p = (-d[1]).atan2(d[2]);
        there += f64::from(u8::from(within(pitch, p) && within(roll, r)));
    }
    there / all
}

#[test]
fn arms_and_legs_reach_where_a_humans_do() {
    let puppet = marionette();
    for (side, mirror) in [("right", 1.0), ("left", -1.0)] {
        let arm = [format!("{side}_shoulder_pitch"), format!("{side}_shoulder_roll")];
        let before = |d: V| d[1] < -0.05 && mirror * d[0] > -0.45;
        let part = reached(&puppet, &arm[0], &arm[1], mirror, before);
        assert!(
            part > 0.99,
            "the {side} arm reaches {part} of what lies before it"
        );
        let leg = [format!("{side}_hip_pitch"), format!("{side}_hip_roll")];
        let stride = |d: V| d[2] > 0.5 && d[1] < 0.5 && (-0.4..0.8).contains(&(mirror * d[0]));
        let part = reached(&puppet, &leg[0], &leg[1], mirror, stride);
        assert!(part > 0.99, "the {side} leg reaches {part} of a stride");
    }
}

#[test]
fn limits_lie_inside_what_the_servos_can_do() {
    let all = Profiles::builtin();
    let puppet = marionette();
    for joint in puppet.joints() {
        let servo = all.servo(&joint.model).unwrap();
        let counts_per_rad = 1.0 / servo.rad_per_count();
        for q in [joint.min_rad, joint.max_rad, 0.0] {
            let counts = f64::from(joint.zero_counts) + f64::from(joint.sign) * q * counts_per_rad;
            let last = servo.position_counts[1] as f64;
            assert!(
                (0.0..=last).contains(&counts),
                "{}: {q} rad is count {counts}",
                joint.name
            );
        }
        let limit = servo.register("Velocity Limit").unwrap();
        assert_eq!(limit.unit, Some(Unit::RadianPerSecond));
        let fastest = limit.init.unwrap() as f64 * limit.unit_per_count.unwrap();
        assert!(joint.speed_max_rad_per_s < fastest, "{}", joint.name);
        assert!(
            (joint.min_rad..=joint.max_rad).contains(&0.0),
            "{} can stand at rest",
            joint.name
        );
        assert!(
            servo.baud_code(puppet.bus(&joint.bus).unwrap().baud).is_some(),
            "{}",
            joint.name
        );
    }
    let on = |bus| puppet.joints_on(bus).count();
    assert_eq!((on("upper"), on("lower")), (11, 11));
}

/// The printed human's links, head first, each with what it hangs from.
const FIGURE: [(&str, &str); 14] = [
    ("trunk", "head"),
    ("rua", "trunk"),
    ("rfa", "rua"),
    ("rh", "rfa"),
    ("lua", "trunk"),
    ("lfa", "lua"),
    ("lh", "lfa"),
    ("pelv", "trunk"),
    ("rt", "pelv"),
    ("rc", "rt"),
    ("rf", "rc"),
    ("lt", "pelv"),
    ("lc", "lt"),
    ("lf", "lc"),
];

#[test]
fn its_groups_are_the_figures_links_hung_from_the_trunk() {
    let puppet = marionette();
    assert_eq!(puppet.groups.len(), 15);
    assert_eq!(puppet.groups[0].link, "trunk");
    for (link, parent) in FIGURE {
        let joined = |a: &str, b: &str| puppet.group(a).and_then(|g| g.parent.as_deref()) == Some(b);
        assert!(
            joined(link, parent) || joined(parent, link),
            "{link} and {parent} hang together"
        );
    }
}
