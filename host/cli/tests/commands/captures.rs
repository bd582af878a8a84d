//! Capture, replay, decode and record: good use, wrong use, files that break off, devices that are not there, that go in
//! the middle, and a program that is killed.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Output;
use std::time::Duration;

use crate::live::Simulated;
use crate::{ANY, call, check, dialrig, fed, interrupt, root};

/// An exchange of a box that is asked and turned.
const GOOD: &[u8] = b"profile: sgi-dialbox\ndevice < 20 @ 0.012\nevent  started\n\
    device < 33 00 40 @ 0.250\nevent  dial 3 +64\n";
const WRONG_EVENT: &[u8] =
    b"profile: sgi-dialbox\ndevice < 20 @ 0.012\nevent  started\ndevice < 33 00 40 @ 0.250\n\
    event  dial 3 +65\n";

#[test]
fn captures_that_cannot_be_made_are_refused_in_words() {
    check(
        &[("file", b"")],
        &[
            call("capture", 2, &[], &["<DEVICE>"]),
            call("capture sim:dial-box", 2, &[], &["--out <FILE>"]),
            call(
                "capture sim:dial-box --out x.txt --secs 0",
                2,
                &[],
                &["expected a number above zero"],
            ),
            call(
                "capture /dev/nothing-here --out x.txt",
                1,
                &[],
                &["/dev/nothing-here: not found"],
            ),
            call(
                "capture nowhere --out x.txt",
                1,
                &[],
                &["\"nowhere\" is not an address"],
            ),
            call(
                "capture sim:dial-box --profile nonsense --out x.txt",
                1,
                &[],
                &["nonsense", "sgi-dialbox"],
            ),
            call(
                "capture sim:dial-box --out no/such/folder.txt --secs 1",
                1,
                &[],
                &["no/such/folder.txt.part: cannot write"],
            ),
            call(
                "capture sim:dial-box --out file/x.txt --secs 1",
                1,
                &[],
                &["file/x.txt.part: cannot write"],
            ),
            // Nothing was left behind by any of them.
            call("replay x.txt", 1, &[], &["x.txt"]),
            call("replay x.txt.part", 1, &[], &["x.txt.part"]),
        ],
    );
}

#[test]
fn exchanges_are_played_or_refused_by_line() {
    check(
        &[
            ("good.txt", GOOD),
            ("event.txt", WRONG_EVENT),
            ("nobody.txt", b"device < 20\n"),
            (
                "words.txt",
                b"profile: sgi-dialbox\ndevice < 20\ndevice < 3x\nhost < 20\n",
            ),
            (
                "torn.txt",
                b"profile: sgi-dialbox\ndevice < 20 @ 0.1\ndevice < 33 0",
            ),
        ],
        &[
            call("replay", 2, &[], &["<FILE>"]),
            call("replay nosuch.txt", 1, &[], &["nosuch.txt"]),
            call(
                "replay good.txt --json",
                0,
                &[r#""event":"dial","control":3,"delta":64"#],
                ANY,
            ),
            call(
                "replay event.txt",
                1,
                ANY,
                &["event.txt:5:1: error: expected", "dial 3 +65", "dial 3 +64"],
            ),
            call("replay nobody.txt", 1, &[], &["names no profile", "--profile"]),
            call("replay nobody.txt --profile nonsense", 1, &[], &["nonsense"]),
            call("replay nobody.txt --profile sgi-dialbox", 0, ANY, ANY),
            call(
                "replay words.txt",
                1,
                &[],
                &["words.txt:3:10: error:", "words.txt:4:"],
            ),
            call("replay torn.txt", 1, &[], &["torn.txt:3:13: error:"]),
            fed(
                "replay - --json",
                "profile: sgi-dialbox\ndevice < 20\ndevice < 33 00 40\n",
                0,
                &["dial"],
                ANY,
            ),
        ],
    );
}

#[test]
fn recordings_are_decoded_as_far_as_they_go() {
    let torn =
        b"profile: sgi-dialbox\ndevice < 20 @ 0.1\nevent started\ndevice < 33 00 40 @ 0.2\ndevice < 33 0";
    check(
        &[
            ("good.txt", GOOD),
            ("torn.txt", torn),
            ("empty.txt", b""),
            ("nobody.txt", b"device < 20\n"),
        ],
        &[
            call(
                "decode good.txt",
                0,
                &[
                    r#"{"t":0.238,"event":"dial","control":3,"delta":64}"#,
                    r#""event":"totals","reports":2,"events":1,"unknown":0,"rejected":0"#,
                ],
                &[],
            ),
            // Whole lines count, and what is left of the last is told of.
            call(
                "decode torn.txt",
                0,
                &[
                    r#""event":"dial","control":3,"delta":64"#,
                    r#""event":"totals""#,
                    r#""rejected":1"#,
                ],
                &["torn.txt:5:13: warning:"],
            ),
            call("decode empty.txt", 1, &[], &["expected hid-recorder text"]),
            call("decode nosuch.txt", 1, &[], &["nosuch.txt"]),
            call("decode nobody.txt", 1, &[], &["--profile"]),
            call("decode --profile nonsense good.txt", 1, &[], &["nonsense"]),
        ],
    );
}

#[test]
fn recordings_of_shows_are_refused_before_anything_is_performed() {
    check(
        &[("file", b""), ("there/show.toml", b"version = 1\nname = \"x\"\n")],
        &[
            call("record shows/salute --take wave", 2, &[], &["--device <DEVICE"]),
            call(
                "record shows/salute --device sim:dial-box",
                2,
                &[],
                &["--take <NAME>"],
            ),
            call(
                "record shows/salute --device sim:dial-box --take a/b",
                2,
                &[],
                &["a take's name has letters"],
            ),
            call(
                "record nosuch --device sim:dial-box --take wave",
                1,
                &[],
                &["nosuch"],
            ),
            call(
                "record shows/salute --device sim:dial-box --take salute --out x",
                1,
                &[],
                &["a clip salute that is no take's", "--replace"],
            ),
            call(
                "record shows/salute --device sim:dial-box --take wave --out there",
                1,
                &[],
                &["there: there is a show already"],
            ),
            call(
                "record shows/salute --device sim:dial-box --take wave --out file/x",
                1,
                &[],
                &["file/x:1:1: error: cannot write into it"],
            ),
            call(
                "record shows/salute --device sim:dial-box=nonsense --take wave --out x",
                1,
                &[],
                &["nonsense"],
            ),
        ],
    );
}

/// A dial box whose third dial turns for as long as it runs, and a folder to work in.
struct Bench {
    folder: tempfile::TempDir,
    device: Simulated,
}

impl Bench {
    fn new() -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let script = folder.path().join("turns.txt");
        fs::write(&script, "at 0.1 dial 3 +20000 over 40\n").expect("writes");
        let device = Simulated::start(&format!("sim dial-box --script {}", script.display()));
        Self { folder, device }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn run(&self, args: &str) -> Output {
        let args = args.replace("DEVICE", &self.device.address);
        let mut command = dialrig(&args);
        command.current_dir(self.folder.path());
        command.output().expect("runs")
    }

    /// Waits until so many events stand in a file that is being written; a busy machine needs longer for it.
    fn wait_for_events(&self, name: &str, events_min: usize) {
        for _ in 0..600 {
            let text = fs::read_to_string(self.path(name)).unwrap_or_default();
            if text.matches("event  dial").count() >= events_min {
                return;
            }
            pause(0.1);
        }
        panic!("after a minute {name} has not {events_min} events");
    }

    /// The file plays back as it was, and so many events at least are in it.
    fn check_exchange(&self, name: &str, events_min: usize) -> String {
        let played = self.run(&format!("replay {name} --json"));
        let said = String::from_utf8_lossy(&played.stderr);
        assert_eq!(played.status.code(), Some(0), "{said}");
        let turns = String::from_utf8_lossy(&played.stdout)
            .matches(r#""event":"dial""#)
            .count();
        assert!(turns >= events_min, "{turns} turns");
        let decoded = self.run(&format!("decode {name}"));
        assert_eq!(decoded.status.code(), Some(0));
        assert_eq!(
            String::from_utf8_lossy(&decoded.stdout)
                .matches(r#""event":"dial""#)
                .count(),
            turns
        );
        fs::read_to_string(self.path(name)).expect("it can be read")
    }
}

fn pause(secs: f64) {
    std::thread::park_timeout(Duration::from_secs_f64(secs));
}

#[test]
fn a_capture_is_an_exchange_of_everything_until_its_end() {
    let bench = Bench::new();
    let done = bench.run("capture DEVICE --out box.txt --secs 1.5");
    let said = String::from_utf8_lossy(&done.stderr);
    assert_eq!(done.status.code(), Some(0), "{said}");
    assert!(said.contains("box.txt: ") && said.contains(" events"), "{said}");
    let text = bench.check_exchange("box.txt", 20);
    assert!(
        text.contains("host   > 20") && text.contains("event  started"),
        "{text}"
    );
    assert!(!bench.path("box.txt.part").exists());
}

#[test]
fn ctrl_c_ends_a_capture_and_the_file_is_whole() {
    let bench = Bench::new();
    let mut command = dialrig(&format!("capture {} --out box.txt", bench.device.address));
    let child = command.current_dir(bench.folder.path()).spawn().expect("starts");
    bench.wait_for_events("box.txt.part", 25);
    interrupt(&child);
    let output = child.wait_with_output().expect("ends");
    assert_eq!(
        output.status.code(),
        Some(0),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    bench.check_exchange("box.txt", 20);
}

#[test]
fn a_device_that_goes_in_the_middle_is_exit_3_and_what_came_is_kept() {
    let mut bench = Bench::new();
    let mut command = dialrig(&format!("capture {} --out box.txt", bench.device.address));
    let child = command.current_dir(bench.folder.path()).spawn().expect("starts");
    bench.wait_for_events("box.txt.part", 25);
    bench.device.kill();
    let output = child.wait_with_output().expect("it ends by itself");
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(3), "{said}");
    let text = bench.check_exchange("box.txt", 20);
    assert!(text.contains("device gone"), "{text}");
}

#[test]
fn of_a_capture_that_is_killed_everything_up_to_then_can_be_read() {
    let bench = Bench::new();
    let mut command = dialrig(&format!("capture {} --out box.txt", bench.device.address));
    let mut child = command.current_dir(bench.folder.path()).spawn().expect("starts");
    bench.wait_for_events("box.txt.part", 25);
    child.kill().expect("it runs");
    child.wait().expect("it ran");
    assert!(!bench.path("box.txt").exists());
    bench.check_exchange("box.txt.part", 20);
}

/// All files of a folder.
fn files(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut all = BTreeMap::new();
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            all.extend(files(&path));
        } else {
            all.insert(path.clone(), fs::read(&path).expect("it can be read"));
        }
    }
    all
}

#[test]
fn a_recording_goes_where_it_was_told_and_the_show_stays_as_it_was() {
    let bench = Bench::new();
    let show = root().join("shows/salute");
    let before = files(&show);
    let done = bench.run(&format!(
        "record {} --device DEVICE --take wave --secs 1.5 --out mine",
        show.display()
    ));
    let said = String::from_utf8_lossy(&done.stderr);
    assert_eq!(done.status.code(), Some(0), "{said}");
    assert!(
        said.contains("will be saved into mine") && said.contains("keys of clip wave"),
        "{said}"
    );
    assert!(files(&show) == before, "the shipped show was changed");
    let take = fs::read_to_string(bench.path("mine/takes/wave.toml")).expect("a take");
    assert!(
        take.contains("device < 33") || take.contains("device < 32"),
        "{take}"
    );
    assert!(bench.path("mine/clips/wave.toml").exists());
    assert_eq!(bench.run("check mine/show.toml").status.code(), Some(0));
    // Now it is the user's own, and is recorded into as the studio would save it; a take is recorded over.
    let done = bench.run("record mine --device DEVICE --take wave --secs 0.5");
    assert_eq!(
        done.status.code(),
        Some(0),
        "{}",
        String::from_utf8_lossy(&done.stderr)
    );
    let again = fs::read_to_string(bench.path("mine/takes/wave.toml")).expect("a take");
    assert_ne!(again, take);
}

#[test]
fn a_device_that_goes_while_it_is_recorded_is_exit_3_and_the_take_is_kept() {
    let mut bench = Bench::new();
    let show = root().join("shows/salute");
    let args = format!(
        "record {} --device {} --take wave --secs 6 --out mine",
        show.display(),
        bench.device.address
    );
    let child = dialrig(&args)
        .current_dir(bench.folder.path())
        .spawn()
        .expect("starts");
    pause(3.5);
    bench.device.kill();
    let output = child.wait_with_output().expect("ends");
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(3), "{said}");
    assert!(
        said.contains("did not come back; what came before is kept"),
        "{said}"
    );
    let take = fs::read_to_string(bench.path("mine/takes/wave.toml")).expect("a take");
    assert!(take.contains("device gone"), "{take}");
}

#[test]
fn a_device_that_is_not_there_is_waited_for_and_then_exit_3() {
    let bench = Bench::new();
    let show = root().join("shows/salute");
    let args = format!(
        "record {} --device /dev/nothing-here --take wave --out mine",
        show.display()
    );
    let done = bench.run(&args);
    let said = String::from_utf8_lossy(&done.stderr);
    assert_eq!(done.status.code(), Some(3), "{said}");
    assert!(said.contains("no answer from /dev/nothing-here"), "{said}");
    assert!(!bench.path("mine/show.toml").exists());
}
