//! A user's own profiles: taken in place of the built-in ones, or refused with the place of what is wrong.

use device_profiles::{Kind, ProfileError, Profiles, read_file_among};
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
    let text = include_str!("../inputs/boxes/sgi-dialbox.toml")
        .replace("counts_per_turn = 256.0", "counts_per_turn = 200.0");
    let folder = folder(
        "own",
        &[("sgi-dialbox.toml", &text), ("notes.txt", "not a profile")],
    );
    let all = Profiles::builtin().with_user_folder(&folder).unwrap();
    assert_eq!(all.input("sgi-dialbox").unwrap().counts_per_turn(), 200.0);
    assert_eq!(all.inputs().count(), Profiles::builtin().inputs().count());
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

const KNOBS: &str = include_str!("../inputs/boxes/sgi-dialbox.toml");
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
            "count = 8",
            "count = 17",
            "count of dial must be at most 16, found 17",
            "[[control]]",
        ),
    ];
    for (at, (from, to, message, place)) in rows.into_iter().enumerate() {
        check_refused(&format!("shape-{at}"), &KNOBS.replace(from, to), message, place);
    }
}

#[test]
fn contradictions_in_puppets_are_refused_at_their_place() {
    let rows = [
        (
            "id = 2\n",
            "id = 1\n",
            "id 1 is taken on bus \"upper\"",
            "[[group.joint]]",
        ),
        (
            "parent = \"rua\"",
            "parent = \"rfa\"",
            "hangs from \"rfa\"",
            "[[group]]",
        ),
        (
            "max_rad = 2.5",
            "max_rad = -2.5",
            "min_rad must lie below",
            "[[group.joint]]",
        ),
        (
            "axis = [1.0, 0.0, 0.0]",
            "axis = [1.0, 1.0, 0.0]",
            "axis must be a unit",
            "[[group.joint]]",
        ),
        (
            "sign = 1",
            "sign = 2",
            "sign must be 1 or -1, found 2",
            "[[group.joint]]",
        ),
        (
            "heartbeat_ms = 200",
            "heartbeat_ms = 5000",
            "heartbeat_ms must be 20 to 2540, found 5000",
            "heartbeat_ms",
        ),
        (
            "hot_c = 60.0",
            "hot_c = 140.0",
            "hot_c must be 30 to 100, found 140",
            "hot_c",
        ),
        (
            "on_lost_host = \"hold\"",
            "on_lost_host = \"back-off\"",
            "without a host nobody moves",
            "on_lost_host",
        ),
    ];
    for (at, (from, to, message, place)) in rows.into_iter().enumerate() {
        check_refused(
            &format!("puppets-{at}"),
            &PUPPET.replace(from, to),
            message,
            place,
        );
    }
}

#[test]
fn contradictions_in_servos_are_refused_at_their_place() {
    let rows = [
        (
            "address = 132",
            "address = 130",
            "overlaps the row before it",
            "name = \"Pr",
        ),
        (
            "name = \"PWM Limit\"",
            "name = \"PWM Bound\"",
            "bounded by \"PWM Limit\"",
            "name = \"Goal PWM",
        ),
        (
            "role = \"drive-mode\"",
            "role = \"id\"",
            "has role id, and so has \"Drive Mode\"",
            "name = \"ID",
        ),
        (
            "signed = true, init = 0, min = -1",
            "signed = true, sign_bit = 31, init = 0, min = -1",
            "both signed (two's complement) and sign_bit",
            "name = \"Homing",
        ),
        (
            "signed = true, init = 0, min = -1",
            "sign_bit = 32, init = 0, min = -1",
            "sign_bit in 1 to 31, found 32",
            "name = \"Homing",
        ),
        (
            "position_counts = [0, 4095]",
            "position_counts = [4095, 0]",
            "must rise and have centre_counts between",
            "position_counts",
        ),
        (
            "4000000]\n",
            "4000000]\nbaud_codes = [1]\n",
            "one value for each of bauds, found 1 for 7",
            "baud_codes",
        ),
    ];
    for (at, (from, to, message, place)) in rows.into_iter().enumerate() {
        check_refused(&format!("servos-{at}"), &SERVO.replace(from, to), message, place);
    }
}

#[test]
fn all_errors_are_said_and_not_only_the_first() {
    let text = KNOBS
        .replace("count = 32", "count = 33")
        .replace("count = 8", "count = 17");
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

/// What is wrong with a piece at the end of an otherwise right file, and where.
#[test]
fn wrong_variants_and_couplings_are_refused_at_their_place() {
    let rows = [
        (
            SERVO,
            "[[variant]]\nfirmware = [52, 38]\n",
            "must be [first, last], found [52, 38]",
        ),
        (
            SERVO,
            "[[variant]]\nfirmware = [38, 60]\n",
            "whose table `registers` gives",
        ),
        (
            SERVO,
            "[[variant]]\nfirmware = [38, 52]\nremoved = [\"LEDs\"]\n",
            "removes \"LEDs\", which the table does not have",
        ),
        (
            SERVO,
            "[[variant]]\nfirmware = [38, 52]\nregisters = [\n    { address = 117, size = 1, name = \"Odd\", area = \"ram\", \
             access = \"r\" },\n]\n",
            "with firmware [38, 52]: \"Odd\" at 117 overlaps",
        ),
        (
            PUPPET,
            "[[coupling]]\njoint = \"left_elbow\"\nfollows = \"left_elbow\"\nratio = 1.0\n",
            "which follows a joint itself",
        ),
        (
            PUPPET,
            "[[coupling]]\njoint = \"left_elbow\"\nfollows = \"tail\"\nratio = 1.0\n",
            "names joint \"tail\", which the puppet does not have",
        ),
        (
            PUPPET,
            "[[coupling]]\njoint = \"left_elbow\"\nfollows = \"right_elbow\"\nratio = -1.0\n",
            "would be led to between -2.5 and 0.05 rad",
        ),
        (
            PUPPET,
            "[[coupling]]\njoint = \"left_elbow\"\nfollows = \"right_elbow\"\nratio = 0.0\n",
            "must have a ratio other than 0",
        ),
    ];
    for (at, (text, piece, message)) in rows.into_iter().enumerate() {
        let header = piece.lines().next().unwrap();
        check_refused(
            &format!("piece-{at}"),
            &format!("{text}\n{piece}"),
            message,
            header,
        );
    }
}

#[test]
fn right_variants_and_couplings_are_taken() {
    let coupled = format!(
        "{PUPPET}\n[[coupling]]\njoint = \"left_elbow\"\nfollows = \"right_elbow\"\nratio = 0.5\noffset_rad = 0.1\n"
    );
    let all = read_own("coupled", &coupled).unwrap();
    let coupling = all.puppet("own").unwrap().coupling("left_elbow").unwrap();
    assert!((coupling.angle_rad(1.0) - 0.6).abs() < 1e-12);

    let older = format!(
        "{SERVO}\n[[variant]]\nfirmware = [50, 51]\nremoved = [\"Moving\"]\nregisters = [\n    {{ address = 122, size = \
         1, name = \"Spare\", area = \"ram\", access = \"r\" }},\n]\n"
    );
    let all = read_own("older", &older).unwrap();
    let servo = all.servo("own").unwrap();
    let names = |firmware| {
        let own = servo.at_firmware(firmware);
        let row = own.register_at(122).unwrap().name.clone();
        (own.firmware, row, own.registers.len())
    };
    let rows = servo.registers.len();
    assert_eq!(names(51), (51, "Spare".to_owned(), rows));
    assert_eq!(names(52), (52, "Moving".to_owned(), rows));
    assert_eq!(names(53), (53, "Moving".to_owned(), rows));
    assert_eq!(names(60), (53, "Moving".to_owned(), rows));
}

const ARM: &str = include_str!("../puppets/so-101.toml");

#[test]
fn a_puppet_that_does_not_fit_its_servos_is_refused_at_its_place() {
    let rows = [
        (
            "model = \"STS3215\"",
            "model = \"STS3512\"",
            "there is no servo profile named \"STS3512\"; there are: ax-12a, ",
            "[[group.joint]]",
        ),
        (
            "zero_counts = 1536",
            "zero_counts = 100",
            "joint \"gripper\": its range is counts -14 to 1238, and STS3215 takes goals from 0 to 4095; mount the horn",
            "[[group.joint]]",
        ),
        (
            "baud = 1000000",
            "baud = 2000000",
            "bus \"arm\" has 2000000 baud, which STS3215 cannot; it can 1000000, 500000, ",
            "[[bus]]",
        ),
    ];
    for (at, (from, to, message, place)) in rows.into_iter().enumerate() {
        check_refused(&format!("misfit-{at}"), &ARM.replace(from, to), message, place);
    }
}

/// A servo and the puppet that uses it, both the user's own, in either order of their names.
#[test]
fn a_users_puppet_may_use_a_users_servo() {
    let puppet = ARM.replace("STS3215", "mine");
    let servo = include_str!("../servos/sts3215.toml").replace("\"STS3215\"", "\"Mine\"");
    for names in [["a.toml", "mine.toml"], ["zebra.toml", "mine.toml"]] {
        let folder = folder(
            &format!("pair-{}", names[0]),
            &[(names[0], &puppet), (names[1], &servo)],
        );
        let all = Profiles::builtin().with_user_folder(&folder).unwrap();
        assert_eq!(all.servo("mine").unwrap().name, "Mine");
    }
    let alone = folder("alone", &[("a.toml", &puppet)]);
    assert!(Profiles::builtin().with_user_folder(&alone).is_err());
}

/// The wrong one is named with its place, the right one works, and the shipped one does not stand in.
#[test]
fn a_wrong_file_is_left_out_and_the_others_work() {
    let right = include_str!("../inputs/boxes/deej.toml").replace("name = \"", "name = \"My ");
    let wrong = include_str!("../inputs/boxes/sgi-dialbox.toml").replace("status", "statu");
    let lost = include_str!("../inputs/tablets/hs610.toml").replace("layout = \"", "layout = \"no-");
    let folder = folder(
        "some-right",
        &[
            ("my-deej.toml", &right),
            ("sgi-dialbox.toml", &wrong),
            ("hs610.toml", &lost),
        ],
    );
    let (all, errors) = Profiles::builtin().with_right_files(&folder);
    assert!(all.input("my-deej").unwrap().name.starts_with("My "));
    assert!(all.input("sgi-dialbox").is_err() && all.input("hs610").is_err());
    assert_eq!(all.inputs().count(), Profiles::builtin().inputs().count() - 1);
    let said: Vec<_> = errors.iter().map(ToString::to_string).collect();
    assert_eq!(said.len(), 2, "{said:?}");
    assert!(
        said[0].contains("sgi-dialbox.toml:") && said[0].contains("statu"),
        "{said:?}"
    );
    assert!(
        said[1].contains("hs610.toml:") && said[1].contains("no-uclogic"),
        "{said:?}"
    );
    assert!(Profiles::builtin().with_user_folder(&folder).is_err());
}

/// Read by itself beside the others, a profile has its layout as it has among them.
#[test]
fn a_file_read_among_others_has_its_layout() {
    let text = include_str!("../inputs/tablets/hs610.toml");
    let folder = folder("among", &[("mine.toml", text)]);
    let all = Profiles::builtin();
    let Ok(Kind::Input(mine)) = read_file_among(&folder.join("mine.toml"), &all) else {
        panic!("it is right");
    };
    assert!(!mine.tables().reports.is_empty());
    assert_eq!(mine.of_layout, all.input("hs610").unwrap().of_layout);
}

#[test]
fn what_a_field_of_a_servo_may_be_is_said() {
    let rows = [
        (
            "\"dynamixel2\"",
            "\"dynamixel3\"",
            "expected one of `dynamixel2`, `dynamixel1`, `sts`, `scs`",
            "\"dynamixel3",
        ),
        (
            "role = \"id\"",
            "role = \"identity\"",
            "unknown variant `identity`, expected one of `model-number`",
            "\"identity",
        ),
        (
            "firmware = 53\n",
            "firmware = 53\nword_order = \"middle\"\n",
            "expected `little` or `big`",
            "\"middle",
        ),
        (
            "overload = 5",
            "overload = 8",
            "fault_bits must be bits 0 to 7 of a byte, found 8 for overload",
            "fault_bits",
        ),
        (
            "overload = 5",
            "boredom = 5",
            "unknown variant `boredom`",
            "boredom",
        ),
        (
            "stall_torque_nm = 0.52",
            "stall_torque_nm = -0.5",
            "stall_torque_nm must be above 0, found -0.5",
            "stall_torque_nm",
        ),
        (
            "standby_current_a = 0.017",
            "standby_current_a = -1.0",
            "standby_current_a must be at least 0",
            "standby",
        ),
        ("sync_read = true\n", "", "missing field `sync_read`", ""),
        (
            "counts_per_turn = 4096.0",
            "counts_per_turn = 0.0",
            "counts_per_turn must be at least 1",
            "counts_per_turn",
        ),
    ];
    for (at, (from, to, message, place)) in rows.into_iter().enumerate() {
        check_refused(
            &format!("servo-field-{at}"),
            &SERVO.replace(from, to),
            message,
            place,
        );
    }
}

#[test]
fn what_a_field_of_a_puppet_may_be_is_said() {
    let rows = [
        (
            "on_heat = \"back-off\"",
            "on_heat = \"sweat\"",
            "expected one of `back-off`, `hold`, `release`",
            "\"sweat",
        ),
        (
            "baud = 1000000\n",
            "baud = 1000000\nusb_serial = 7\n",
            "expected a string",
            "7",
        ),
        (
            "length_m = 0.18\n",
            "length_m = 0.18\nmass_kg = -1.0\n",
            "mass_kg of at least 0",
            "[[group]]",
        ),
        (
            "accel_max_rad_per_s2 = 40.0\n",
            "accel_max_rad_per_s2 = 40.0\njerk_max_rad_per_s3 = 0.0\n",
            "jerk_max_rad_per_s3 must be above 0, found 0",
            "[[group.joint]]",
        ),
        (
            "accel_max_rad_per_s2 = 40.0\n",
            "accel_max_rad_per_s2 = 40.0\njerk_max_rad_per_s3 = 30.0\n",
            "jerk_max_rad_per_s3 must be at least accel_max_rad_per_s2, 40, or each change takes longer than 2 s; found 30",
            "[[group.joint]]",
        ),
    ];
    for (at, (from, to, message, place)) in rows.into_iter().enumerate() {
        check_refused(
            &format!("puppet-field-{at}"),
            &PUPPET.replace(from, to),
            message,
            place,
        );
    }
}
