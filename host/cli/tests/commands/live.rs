//! Commands that speak to devices: what they refuse, and whole conversations between two of them.

use std::io::{BufRead, BufReader};
use std::process::{Child, Output};

use crate::{ANY, call, check, dialrig, interrupt};

#[test]
fn what_cannot_be_opened_is_refused_in_words() {
    check(
        &[],
        &[
            call("", 1, &[], &["there is no display", "dialrig demo"]),
            call("shows/salute", 1, &[], &["there is no display"]),
            call(
                "servo ping --port /dev/nothing-here 1",
                1,
                &[],
                &["/dev/nothing-here: not found"],
            ),
            call(
                "servo ping --port nowhere 1",
                1,
                &[],
                &["\"nowhere\" is not an address"],
            ),
            call(
                "servo ping --port /dev/null 300",
                2,
                &[],
                &["300 is not in 0..=253"],
            ),
            call(
                "monitor sim:dial-box --profile nonsense",
                1,
                &[],
                &["nonsense", "sgi-dialbox"],
            ),
            call(
                "play shows/salute --puppet nobody",
                1,
                &[],
                &["nobody", "marionette"],
            ),
            call(
                "play shows/salute --port tcp:127.0.0.1:1",
                1,
                &[],
                &["2 buses", "1 ports were given", "--port"],
            ),
            call("play shows/salute --from 6", 1, &[], &["the clip ends at 6 s"]),
            call("play shows/salute --rate 9999", 2, &[], &["expected 10 to 500"]),
            call("devices --json", 0, &[r#"{"address":"sim:dial-box""#], ANY),
        ],
    );
}

#[test]
fn simulators_and_scenarios_are_refused_in_words() {
    check(
        &[
            ("wrong.scn", b"at 0.1 turn dial\n"),
            (
                "fails.scn",
                b"at 0.1 turn dial 1 by 0.25 turns\nby 0.2 player is holding\n",
            ),
        ],
        &[
            call("sim servo-bus --servo XL430-W250:1", 2, &[], &["--pty <PATH>"]),
            call(
                "sim servo-bus --servo NOSUCH:1 --tcp 127.0.0.1:0",
                1,
                &[],
                &["NOSUCH"],
            ),
            call(
                "sim servo-bus --servo XL430-W250:9-1 --tcp 127.0.0.1:0",
                1,
                &[],
                ANY,
            ),
            call(
                "sim dial-box --script nosuch.txt --tcp 127.0.0.1:0",
                1,
                &[],
                &["nosuch.txt"],
            ),
            call("bench run wrong.scn", 1, &[], &["wrong.scn:1:"]),
            call("bench run fails.scn", 1, &["FAIL fails"], ANY),
            call("bench run nosuch.scn", 1, &[], &["nosuch.scn"]),
        ],
    );
}

/// A simulated device on a TCP port, and where it is.
pub(crate) struct Simulated {
    child: Child,
    pub(crate) address: String,
    gone: bool,
}

impl Simulated {
    pub(crate) fn start(args: &str) -> Self {
        let mut child = dialrig(&format!("{args} --tcp 127.0.0.1:0"))
            .spawn()
            .expect("starts");
        let mut line = String::new();
        BufReader::new(child.stdout.take().expect("piped"))
            .read_line(&mut line)
            .expect("a line");
        let address = line
            .trim()
            .strip_prefix("ready ")
            .expect("it says where it is")
            .to_owned();
        Self {
            child,
            address,
            gone: false,
        }
    }
}

impl Simulated {
    /// Takes the device away as it stands.
    pub(crate) fn kill(&mut self) {
        self.child.kill().expect("it runs");
        self.child.wait().expect("it ran");
        self.gone = true;
    }
}

impl Drop for Simulated {
    fn drop(&mut self) {
        if self.gone {
            return;
        }
        interrupt(&self.child);
        let _ = self.child.wait();
    }
}

#[test]
fn servos_are_found_read_and_let_go() {
    let bus = Simulated::start("sim servo-bus --servo XL430-W250:2-3,XL330-M288:7 --wire none");
    let run = |args: &str| {
        let output = dialrig(&args.replace("PORT", &bus.address))
            .output()
            .expect("runs");
        (
            output.status.code(),
            String::from_utf8_lossy(&output.stdout).into_owned(),
        )
    };
    let (exit, found) = run("servo scan --port PORT --only --json");
    let ids: Vec<&str> = found.lines().map(|line| &line[..7]).collect();
    assert_eq!(
        (exit, ids),
        (Some(0), vec![r#"{"id":2"#, r#"{"id":3"#, r#"{"id":7"#]),
        "{found}"
    );
    let (exit, pinged) = run("servo ping --port PORT 7");
    assert_eq!(
        (exit, pinged.as_str()),
        (
            Some(0),
            "servo 7: XL330-M288 (DYNAMIXEL 2.0), firmware 53, 57600 baud\n"
        )
    );
    let (exit, read) = run("servo read --port PORT 3 ID --json");
    assert_eq!(exit, Some(0));
    assert!(read.contains(r#""register":"ID","address":7,"raw":3"#), "{read}");
    assert_eq!(run("servo release --port PORT").0, Some(0));
    assert_eq!(
        run("servo ping --port PORT 99").0,
        Some(3),
        "a servo that is silent is a device's fault"
    );
}

/// `dialrig servo` on that bus; a name between single quotes is one word.
fn servo(bus: &Simulated, line: &str) -> Output {
    let (command, rest) = line.split_once(' ').unwrap_or((line, ""));
    let mut args = vec!["servo", command, "--port", &bus.address, "--baud", "1000000"];
    let words: Vec<&str> = rest.split('\'').collect();
    for (at, word) in words.iter().enumerate() {
        // Between quotes a name is one word.
        if at % 2 == 1 {
            args.push(word);
        } else {
            args.extend(word.split_whitespace());
        }
    }
    dialrig("").args(args).output().expect("runs")
}

/// Every subcommand that changes a servo, on one line with four protocols: exit code, words on standard output, words on
/// standard error.
#[test]
fn servos_of_every_make_are_set_up_from_the_command_line() {
    let bus = Simulated::start(
        "sim servo-bus --servo XL330-M288:1,AX-12A:2,STS3215:3,SCS0009:4 --baud 1000000 --wire none",
    );
    for (line, exit, out, err) in [
        ("scan --only", 0, "AX-12A", ""),
        ("write 3 'Return Delay Time' 0", 0, "Return Delay Time is 0", ""),
        (
            "write 2 temperature-limit 66 --json",
            0,
            r#""register":"Temperature Limit","address":11,"raw":66"#,
            "",
        ),
        ("write 1 max-position 1 --si --json", 0, r#""raw":652"#, ""),
        (
            "write 1 goal-position 5",
            1,
            "",
            "goals and torque go through the player",
        ),
        (
            "write 1 'Torque Enable' 1",
            1,
            "",
            "goals and torque go through the player",
        ),
        ("write 1 led 0.5", 1, "", "whole number"),
        (
            "write 1 temperature-limit 300",
            1,
            "",
            "give a value from 0 to 100",
        ),
        ("write 9 led 1", 3, "", "servo 9 does not answer"),
        ("set-id 4 14", 0, "servo 14: SCS0009 (Feetech SCS)", ""),
        ("set-id 14 3", 1, "", "id 3 is in use"),
        ("set-baud 3 500000", 1, "", "cannot change its speed from here"),
        ("reboot 1", 0, "XL330-M288", ""),
        ("reboot 2", 1, "", "DYNAMIXEL 1.0 has no reboot"),
        ("clear 1", 0, "", "counts from this turn"),
        ("backup 1", 0, "", "keeps a copy"),
        ("factory-reset 1", 1, "", "give --yes"),
        (
            "factory-reset 1 --keep id --yes",
            1,
            "",
            "cannot change its speed from here",
        ),
        ("factory-reset 1 --yes", 0, "1000000 baud", ""),
        ("monitor 2 --count 1 --json", 0, r#""load":"#, ""),
        (
            "read 14 present-position --protocol scs --json",
            0,
            r#""register":"Present Position","address":56"#,
            "",
        ),
        ("ping 14 --protocol sts", 1, "", "servo 14 speaks Feetech SCS"),
        ("release", 0, "", "torque is off on 4 servos"),
    ] {
        let output = servo(&bus, line);
        let [said, complained] = [&output.stdout, &output.stderr].map(|text| String::from_utf8_lossy(text));
        assert_eq!(output.status.code(), Some(exit), "{line}: {said}{complained}");
        assert!(said.contains(out), "{line}: {said}");
        assert!(complained.contains(err), "{line}: {complained}");
    }
}

#[test]
fn torque_that_nobody_speaks_of_is_not_called_off() {
    let bus = Simulated::start("sim servo-bus --servo XL430-W250:1 --wire none --fault stall");
    let output = dialrig(&format!("servo release --port {}", bus.address))
        .output()
        .expect("runs");
    assert_eq!(output.status.code(), Some(4));
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(said.contains("no servo answered at 57600 baud"), "{said}");
}

#[test]
fn a_puppet_without_one_of_its_servos_is_not_armed() {
    let upper = Simulated::start("sim servo-bus --servo XL330-M288:1-3,XL330-M288:11-14 --baud 1000000");
    let lower = Simulated::start(
        "sim servo-bus --servo XL430-W250:1-3,XL430-W250:11-14,XL430-W250:21-24 --baud 1000000",
    );
    let args = format!(
        "play shows/salute --port {} --port {}",
        upper.address, lower.address
    );
    let output = dialrig(&args).output().expect("runs");
    let said = String::from_utf8_lossy(&output.stderr);
    // Nothing was switched on, but whoever does not answer may hold from before: that is not called safe.
    assert_eq!(output.status.code(), Some(4), "{said}");
    assert!(said.contains("puppet Marionette cannot be armed"), "{said}");
}
