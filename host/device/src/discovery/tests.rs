use super::*;
use crate::codec::outline::ReportKind;
use device_profiles::{Bus, InitStep, InputKind, InputProfile, Kind, Match, Profiles};
use std::fs;
use std::os::unix::fs::symlink;

/// A vendor page with 12 bytes in report 8.
const TWELVE: [u8; 16] = [
    0x06, 0, 0xFF, 0x09, 1, 0xA1, 1, 0x85, 8, 0x75, 8, 0x95, 11, 0x81, 2, 0xC0,
];

/// A kernel's folders with one HID device on USB.
struct Machine {
    root: tempfile::TempDir,
}

struct Plugged<'a> {
    node: &'a str,
    place: &'a str,
    ids: [u16; 2],
    serial: &'a str,
    devnum: u8,
    driver: &'a str,
    descriptor: &'a [u8],
}

const HS610: Plugged<'_> = Plugged {
    node: "hidraw0",
    place: "1-2",
    ids: [0x256C, 0x006D],
    serial: "",
    devnum: 7,
    driver: "hid-generic",
    descriptor: &TWELVE,
};

impl Machine {
    fn new() -> Self {
        let root = tempfile::tempdir().expect("a folder");
        for folder in ["sys/class/hidraw", "sys/class/tty", "dev", "proc/17"] {
            fs::create_dir_all(root.path().join(folder)).expect("room");
        }
        Self { root }
    }

    fn places(&self) -> Places {
        Places {
            sys: self.root.path().join("sys"),
            dev: self.root.path().join("dev"),
            proc: self.root.path().join("proc"),
        }
    }

    fn plug(&self, what: &Plugged<'_>) {
        let sys = self.root.path().join("sys");
        let device = sys.join("devices/usb1").join(what.place);
        let interface = device.join(format!("{}:1.0", what.place));
        let [vendor, product] = what.ids;
        let hid = interface.join(format!("0003:{vendor:04X}:{product:04X}.0001"));
        let node = hid.join("hidraw").join(what.node);
        fs::create_dir_all(&node).expect("room");
        let write = |path: PathBuf, text: &str| fs::write(path, text).expect("room");
        write(device.join("idVendor"), &format!("{vendor:04x}\n"));
        write(device.join("busnum"), "1\n");
        write(device.join("devnum"), &format!("{}\n", what.devnum));
        write(device.join("manufacturer"), "HUION\n");
        write(device.join("product"), "Tablet\n");
        if !what.serial.is_empty() {
            write(device.join("serial"), what.serial);
        }
        write(interface.join("bInterfaceNumber"), "00\n");
        let about = format!(
            "HID_ID=0003:{vendor:08X}:{product:08X}\nHID_NAME=HUION Tablet\nHID_PHYS=usb-x/input0\nHID_UNIQ=\n"
        );
        write(hid.join("uevent"), &about);
        fs::write(hid.join("report_descriptor"), what.descriptor).expect("room");
        let driver = sys.join("bus/hid/drivers").join(what.driver);
        fs::create_dir_all(&driver).expect("room");
        symlink(&driver, hid.join("driver")).expect("room");
        symlink(&hid, node.join("device")).expect("room");
        symlink(&node, sys.join("class/hidraw").join(what.node)).expect("room");
        write(self.root.path().join("dev").join(what.node), "");
    }

    fn hid(&self) -> Vec<Found> {
        let places = self.places();
        let mut found = sysfs::hid(&places.sys, &places.dev);
        found.sort_by(|a, b| a.address.cmp(&b.address));
        found
    }
}

/// A tablet with these matches.
fn profile(key: &str, matches: Vec<Match>) -> InputProfile {
    let text =
        "name = \"x\"\nstatus = \"untested\"\nkind = \"tablet\"\nformat = \"hid\"\nsource = \"none\"\n";
    let mut profile: InputProfile = toml_of(text);
    profile.key = key.to_owned();
    profile.name = key.to_owned();
    profile.kind = InputKind::Tablet;
    profile.matches = matches;
    profile
}

fn toml_of(text: &str) -> InputProfile {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("x.toml");
    fs::write(&file, text).expect("room");
    match device_profiles::read_file(&file).expect("it is right") {
        Kind::Input(profile) => *profile,
        other => panic!("{other:?} is no input device"),
    }
}

fn usb(ids: [u16; 2], change: impl FnOnce(&mut Match)) -> Match {
    let text = "name = \"x\"\nstatus = \"untested\"\nkind = \"tablet\"\nformat = \"hid\"\nsource = \"none\"\n\
                [[match]]\nbus = \"usb\"\nvendor = 1\nproduct = 1\n";
    let mut m = toml_of(text).matches.remove(0);
    m.vendor = Some(ids[0]);
    m.product = Some(ids[1]);
    change(&mut m);
    m
}

fn among(all: Vec<InputProfile>) -> Profiles {
    let mut profiles = Profiles::default();
    for profile in all {
        profiles.add(Kind::Input(Box::new(profile)));
    }
    profiles
}

fn no_strings(_: u8) -> Result<String, String> {
    Err("there is no device".to_owned())
}

fn hs610() -> Found {
    let machine = Machine::new();
    machine.plug(&HS610);
    machine.hid().remove(0)
}

#[test]
fn the_kernel_s_folders_say_what_hangs_where() {
    let machine = Machine::new();
    assert!(machine.hid().is_empty());
    machine.plug(&HS610);
    let found = &machine.hid()[0];
    assert!(found.address.ends_with("/dev/hidraw0"));
    assert_eq!(found.id().as_deref(), Some("256c:006d"));
    assert_eq!((found.bus, found.interface), (Bus::Usb, Some(0)));
    assert_eq!(found.place.as_deref(), Some("1-2"));
    let usb = found.usb.expect("it hangs on USB");
    assert_eq!((usb.bus, usb.address), (1, 7));
    assert_eq!(found.outline.longest(ReportKind::Input), 12);
    assert_eq!(found.driver.as_deref(), Some("hid-generic"));
    assert_eq!(found.access, Access::Allowed);
    assert_eq!(
        found.description(),
        "HUION Tablet (256c:006d, interface 0, at 1-2)"
    );
    // The node comes after the folders.
    fs::remove_file(machine.root.path().join("dev/hidraw0")).expect("it is there");
    assert_eq!(machine.hid()[0].access, Access::NotYet);
}

#[test]
fn a_machine_without_these_folders_has_no_devices() {
    let nowhere = Path::new("/no/such/folder");
    assert!(sysfs::hid(nowhere, nowhere).is_empty());
    assert!(list(&Places::default()).is_sorted_by(|a, b| a.address <= b.address));
}

#[test]
fn strings_decide_between_equal_ids_and_are_asked_only_then() {
    let ids = [0x256C, 0x006D];
    let with = |prefix: &str| {
        usb(ids, |m| {
            m.input_report_bytes = vec![12];
            m.strings.insert(201, prefix.to_owned());
        })
    };
    let profiles = among(vec![
        profile("hs610", vec![with("HUION_T194_")]),
        profile("h640p", vec![with("HUION_T173_")]),
        profile("old", vec![with("HUION_T153_160607")]),
        profile("newer", vec![with("HUION_T153_")]),
        profile("any", vec![usb(ids, |m| m.input_report_bytes = vec![12])]),
        profile(
            "eight",
            vec![usb(ids, |m| {
                m.input_report_bytes = vec![8];
                m.strings.insert(200, "x".to_owned());
            })],
        ),
    ]);
    let found = hs610();
    let said = |text: &'static str| {
        move |index: u8| {
            assert_eq!(index, 201, "only what could decide is read");
            Ok(text.to_owned())
        }
    };
    for (text, want) in [
        ("HUION_T194_190307", "hs610"),
        ("HUION_T173_171215", "h640p"),
        ("HUION_T153_160607", "old"),
        ("HUION_T153_180101", "newer"),
        ("OEM", "any"),
    ] {
        let verdict = judge(&found, &profiles, &mut said(text));
        assert!(
            matches!(verdict, Verdict::One(profile) if profile.key == want),
            "{text}: {verdict:?}"
        );
    }
    let verdict = judge(&found, &profiles, &mut no_strings);
    assert!(
        matches!(verdict, Verdict::One(profile) if profile.key == "any"),
        "{verdict:?}"
    );
}

#[test]
fn why_nobody_fits_is_said() {
    let ids = [0x256C, 0x006D];
    let found = hs610();
    let lengths = among(vec![profile(
        "a",
        vec![usb(ids, |m| m.input_report_bytes = vec![8, 10])],
    )]);
    let why = |profiles: &Profiles| match judge(&found, profiles, &mut no_strings) {
        Verdict::Nobody(why) => why,
        other => panic!("{other:?}"),
    };
    assert_eq!(
        why(&lengths),
        "its ids are known, but a: expected input reports of 8 or 10 bytes, its longest has 12"
    );
    let strings = among(vec![profile(
        "b",
        vec![usb(ids, |m| {
            m.strings.insert(201, "HUION".to_owned());
        })],
    )]);
    assert!(why(&strings).ends_with("b: its string 201 could not be read: there is no device"));
    assert_eq!(why(&Profiles::default()), "no profile has the ids 256c:006d");
}

#[test]
fn equal_candidates_are_all_named() {
    let ids = [0x256C, 0x006D];
    let plain = || vec![usb(ids, |_| {})];
    let profiles = among(vec![profile("a", plain()), profile("b", plain())]);
    let verdict = judge(&hs610(), &profiles, &mut no_strings);
    assert!(
        matches!(&verdict, Verdict::Several(all) if all.len() == 2),
        "{verdict:?}"
    );
}

#[test]
fn strings_it_must_not_have_exclude_and_siblings_are_known() {
    let mut deco = profile(
        "deco",
        vec![usb([0x28BD, 0x0905], |m| {
            m.not_strings.insert(5, vec!["18-12-07".to_owned()]);
        })],
    );
    deco.init = vec![InitStep {
        string: Some(100),
        expect_sibling: Some([0x28BD, 0x1227]),
        ..InitStep::default()
    }];
    let profiles = among(vec![deco]);
    let mut found = hs610();
    (found.vendor, found.product) = (Some(0x28BD), Some(0x0905));
    let is_one = |found: &Found, text: &'static str| {
        matches!(
            judge(found, &profiles, &mut |_| Ok(text.to_owned())),
            Verdict::One(_)
        )
    };
    assert!(is_one(&found, "19-01-02"));
    assert!(!is_one(&found, "18-12-07_release"));
    found.product = Some(0x1227);
    assert!(is_one(&found, ""), "it has returned from its handshake");
}

/// Revision B of the Deco 01 V2 comes back with three interfaces; the keyboard's and the coarse pen's are not it.
#[test]
fn of_a_sibling_only_the_interface_that_reports_is_taken() {
    let profiles = Profiles::builtin();
    for (interface, is) in [(0, false), (1, false), (2, true)] {
        let mut found = hs610();
        (found.vendor, found.product) = (Some(0x28BD), Some(0x1227));
        found.interface = Some(interface);
        let verdict = judge(&found, &profiles, &mut no_strings);
        let deco = matches!(&verdict, Verdict::One(profile) if profile.key == "deco-01-v2");
        assert_eq!(deco, is, "interface {interface}: {verdict:?}");
    }
    // Without a match of its own the lengths of the reports tell.
    let mut deco = profile(
        "deco",
        vec![usb([0x28BD, 0x0905], |m| m.input_report_bytes = vec![12])],
    );
    deco.init = vec![InitStep {
        string: Some(100),
        expect_sibling: Some([0x28BD, 0x1227]),
        ..InitStep::default()
    }];
    let profiles = among(vec![deco]);
    let mut found = hs610();
    (found.vendor, found.product) = (Some(0x28BD), Some(0x1227));
    for (bytes, is) in [(12, true), (9, false)] {
        let length = 8 * (bytes - 1);
        // A vendor's report 2 of so many bytes.
        found.outline = crate::codec::outline::Outline::of(&[
            0x06, 0x0A, 0xFF, 0x09, 1, 0xA1, 1, 0x85, 2, 0x09, 2, 0x15, 0, 0x25, 1, 0x75, 1, 0x95, length,
            0x81, 2, 0xC0,
        ]);
        let one = matches!(judge(&found, &profiles, &mut no_strings), Verdict::One(_));
        assert_eq!(one, is, "{bytes} bytes");
    }
}

#[test]
fn what_describes_itself_needs_no_profile_and_lines_are_never_asked() {
    let mut found = hs610();
    found.outline = crate::codec::outline::Outline::of(&[0x05, 0x0D, 0x09, 2, 0xA1, 1, 0xC0]);
    let none = Profiles::default();
    let verdict = judge(&found, &none, &mut no_strings);
    assert_eq!(verdict, Verdict::Generic([0x0D, 2]));
    let line = Found::new("/dev/ttyS0", Bus::Serial);
    let profiles = Profiles::builtin();
    let Verdict::Line(asked) = judge(&line, &profiles, &mut no_strings) else {
        panic!("serial devices must be named");
    };
    assert!(asked.iter().any(|profile| profile.key == "sgi-dialbox"));
}

#[test]
fn drivers_and_programs_in_the_way_are_named() {
    let machine = Machine::new();
    machine.plug(&Plugged {
        driver: "uclogic",
        ..HS610
    });
    let holder = holder(&machine.hid()[0], &machine.places()).expect("it has it");
    assert_eq!(holder.name, "hid_uclogic");
    assert!(holder.remedy.contains("rmmod hid_uclogic"), "{}", holder.remedy);
    let mut port = Found::new("/dev/ttyACM0", Bus::Serial);
    port.driver = Some("cdc_acm".to_owned());
    assert_eq!(super::holder(&port, &machine.places()), None);
    fs::write(machine.root.path().join("proc/17/comm"), "ModemManager\n").expect("room");
    let holder = super::holder(&port, &machine.places()).expect("it runs");
    assert_eq!(holder.name, "ModemManager");
}

#[test]
fn rules_name_every_id_once_and_sort_before_the_seat() {
    let ids = [0x256C, 0x006D];
    let profiles = among(vec![
        profile("b", vec![usb(ids, |_| {})]),
        profile("a", vec![usb(ids, |_| {}), usb([0x077D, 0x0410], |_| {})]),
        profile("dial", vec![usb([0x045E, 0x091B], |m| m.bus = Bus::Bluetooth)]),
        profile("arc", vec![usb([0x0403, 0x6001], |m| m.bus = Bus::Serial)]),
    ]);
    let text = rules(&profiles);
    let rule = |begin: &str| text.lines().filter(|line| line.starts_with(begin)).count();
    assert_eq!(
        rule(r#"SUBSYSTEM=="hidraw", ATTRS{idVendor}=="256c", ATTRS{idProduct}=="006d", TAG+="uaccess""#),
        1
    );
    assert_eq!(
        rule(
            r#"SUBSYSTEM=="usb", ENV{DEVTYPE}=="usb_device", ATTR{idVendor}=="077d", ATTR{idProduct}=="0410""#
        ),
        1
    );
    assert_eq!(
        rule(r#"SUBSYSTEM=="hidraw", KERNELS=="0005:045E:091B.*", TAG+="uaccess""#),
        1
    );
    assert_eq!(
        rule(
            r#"SUBSYSTEM=="tty", ATTRS{idVendor}=="0403", ATTRS{idProduct}=="6001", TAG+="uaccess", ENV{ID_MM_DEVICE_IGNORE}="1""#
        ),
        1
    );
    assert!(text.contains("\n# a, b\n"));
    let file = RULES_FILE.rsplit('/').next().expect("it has a name");
    assert!(file < "73-seat-late.rules");
}

#[test]
fn every_profile_s_devices_are_in_the_rules() {
    let profiles = Profiles::builtin();
    let text = rules(&profiles);
    for profile in profiles.inputs() {
        for m in profile.matches.iter().filter(|m| m.bus == Bus::Usb) {
            let Some(vendor) = m.vendor else { continue };
            assert!(
                text.contains(&format!("ATTRS{{idVendor}}==\"{vendor:04x}\"")),
                "{}",
                profile.key
            );
        }
    }
}

#[test]
fn a_midi_node_has_its_ports_name_and_the_usb_device_above_its_card() {
    let machine = Machine::new();
    let root = machine.root.path();
    let sys = root.join("sys");
    let device = sys.join("devices/usb1/1-4");
    let card = device.join("1-4:1.0/sound/card2");
    fs::create_dir_all(card.join("midiC2D0")).expect("room");
    fs::create_dir_all(sys.join("class/sound")).expect("room");
    for (file, text) in [
        ("idVendor", "1397"),
        ("idProduct", "00b3"),
        ("busnum", "1"),
        ("devnum", "9"),
        ("product", "X-TOUCH MINI"),
    ] {
        fs::write(device.join(file), format!("{text}\n")).expect("room");
    }
    symlink(&card, card.join("midiC2D0/device")).expect("a link");
    symlink(card.join("midiC2D0"), sys.join("class/sound/midiC2D0")).expect("a link");
    symlink(&card, sys.join("class/sound/card2")).expect("a link");
    fs::create_dir_all(root.join("proc/asound/card2")).expect("room");
    fs::write(
        root.join("proc/asound/card2/midi0"),
        "X-TOUCH MINI\n\nOutput 0\n  Tx bytes : 0\n",
    )
    .expect("room");
    fs::create_dir_all(root.join("dev/snd")).expect("room");
    fs::write(root.join("dev/snd/midiC2D0"), "").expect("room");

    let found = list(&machine.places());
    let node = found.iter().find(|f| f.bus == Bus::Midi).expect("it is listed");
    assert!(node.address.ends_with("/dev/snd/midiC2D0"));
    assert_eq!(
        (node.title.as_str(), node.id().as_deref()),
        ("X-TOUCH MINI", Some("1397:00b3"))
    );
    assert_eq!(node.place.as_deref(), Some("1-4"));
    assert_eq!(node.access, Access::Allowed);
    let profiles = Profiles::builtin();
    match judge(node, &profiles, &mut |_| Err("not asked".to_owned())) {
        Verdict::One(profile) => assert_eq!(profile.key, "x-touch-mini"),
        other => panic!("{other:?}"),
    }
}
