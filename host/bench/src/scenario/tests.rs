use super::*;
use std::path::Path;

fn parse(text: &str) -> Result<Scenario, Vec<ScenarioError>> {
    Scenario::parse("test", Path::new("."), text)
}

fn outcome(text: &str) -> Outcome {
    run(&parse(text).expect("reads"), &RunOptions::default())
}

/// What is wrong, where it is told to be, and some of the words.
const WRONG: &[(&str, u32, u32, &str)] = &[
    ("at", 1, 3, "expected a time in seconds"),
    ("at 1 dance", 1, 6, "expected turn, press"),
    (
        "at 1 turn knob 9 by 3",
        1,
        16,
        "expected a dial, 1 to 8, found `9`",
    ),
    (
        "at 1 turn knob 1 by 3 over",
        1,
        27,
        "expected a duration in seconds",
    ),
    (
        "at 2 undo\nat 1 undo",
        2,
        4,
        "no earlier than the line before, 2 s, found 1",
    ),
    ("by 1 perform arm", 1, 6, "expected player, joint"),
    (
        "by 1 player is dancing",
        1,
        16,
        "expected released, arming, holding, playing or faulted",
    ),
    (
        "by 1 label dial 1 is Turn",
        1,
        22,
        "expected a text in quotes, found `Turn`",
    ),
    ("at 1 fault servo 3 asleep on upper", 1, 20, "found `asleep`"),
    (
        "at 1 touch box dial x +1",
        1,
        21,
        "expected a dial, 0 to 254, found `x`",
    ),
    (
        "by 1 output BOX is 1",
        1,
        13,
        "expected an output such as KNOB<1>",
    ),
    (
        "by 1 device box shows lamp",
        1,
        23,
        "expected something it shows in quotes",
    ),
    (
        "by 1 device box counts",
        1,
        17,
        "expected shows, events, rejected or dropped",
    ),
    ("use device knob", 1, 16, "expected a profile or another kind"),
    ("at 1 fault noise", 1, 12, "expected a fault, `on` and a bus"),
    ("use puppet marionette, hat red", 1, 24, "expected show, puppet"),
    (
        "use puppet marionette knobs x",
        1,
        23,
        "expected the end of the line, found `knobs`",
    ),
    (
        "always servos within reason",
        1,
        22,
        "expected limits, range or speed",
    ),
    (
        "at 1 do {\"undo\": 3}",
        1,
        18,
        "expected a command as in journals",
    ),
    (
        "sometimes it rains",
        1,
        1,
        "expected use, at, by, within, always or never, found `sometimes`",
    ),
    ("by 1 joint a is 1 within -2", 1, 26, "expected a tolerance"),
    (
        "at 1 hand slaps left_elbow",
        1,
        11,
        "expected turns, holds, pulls or lets",
    ),
    ("at 1 hand turns left_elbow to up", 1, 31, "expected an angle"),
    ("at 1 fault servo 3 stuk on upper", 1, 20, "did you mean `stuck`?"),
    (
        "use stops of left_elbow at 1 and 0.5",
        1,
        34,
        "an angle above the lower end",
    ),
    (
        "by 1 register homing of left_elbow is 3",
        1,
        15,
        "a register's role such as homing-offset",
    ),
    (
        "by 1 life of left_elbow jumps at most 1",
        1,
        25,
        "expected reboots, shutdowns",
    ),
];

#[test]
fn errors_have_a_place_and_say_what_was_expected() {
    for (text, line, column, words) in WRONG {
        let errors = parse(text).expect_err(text);
        let error = &errors[0];
        assert!(error.message.contains(words), "{text}: {error}");
        assert_eq!((error.line, error.column), (*line, *column), "{text}: {error}");
    }
}

#[test]
fn every_wrong_line_is_told() {
    assert_eq!(
        parse("at x undo\n# fine\nby 1 nothing\nat 2 undo\n")
            .expect_err("two are wrong")
            .len(),
        2
    );
}

#[test]
fn the_tolerance_on_hardware_may_stand_behind() {
    parse("by 1 joint walker.elbow is 0.2 within 0.001  hil within 0.02").expect("reads");
}

#[test]
fn a_failure_says_where_and_what_was_found() {
    let outcome = outcome("by 0.05 transport is playing\nat 1 undo\n");
    assert!(!outcome.passed());
    let failure = &outcome.failures[0];
    assert_eq!((failure.line, failure.column), (1, 1));
    assert_eq!(failure.message, "at 0.05 s time is 0.000");
}

#[test]
fn always_and_never_are_judged_at_every_step_and_told_once() {
    let outcome = outcome(
        "always transport is playing\nnever from 0.2 transport is paused\nnever to 0.1 keys are 7\nat 0.5 undo\n",
    );
    let lines: Vec<u32> = outcome.failures.iter().map(|failure| failure.line).collect();
    assert_eq!(lines, [1, 2]);
}

#[test]
fn what_cannot_begin_is_a_failure_too() {
    let outcome = outcome("use show no/such/show\n");
    assert!(
        outcome.failures[0].message.contains("no/such/show"),
        "{:?}",
        outcome.failures
    );
    assert_eq!(outcome.failures[0].line, 0);
}

#[test]
fn hands_that_are_refused_are_the_failure_of_their_line() {
    let outcome = outcome("use seed 3\n  at 0.1 unplug toaster\n");
    let failure = &outcome.failures[0];
    assert_eq!((failure.line, failure.column, outcome.seed), (2, 3, 3));
    assert!(
        failure.message.contains("there are: dial-box, tablet"),
        "{failure:?}"
    );
}

#[test]
fn junit_is_escaped_and_names_the_seed() {
    let mut one = outcome("by 0.02 label dial 1 is \"<&>\"\n");
    one.failures[0].message.push_str(" \"<&>\"\u{1}");
    let fine = outcome("at 0.1 undo\n");
    let xml = junit(&[one, fine]);
    assert!(xml.contains("tests=\"2\" failures=\"1\""), "{xml}");
    assert!(xml.contains("&quot;&lt;&amp;&gt;&quot;\""), "{xml}");
    assert!(
        xml.contains("name=\"seed\" value=\"0\"") && xml.contains("test.scn:1:1: at 0.02 s"),
        "{xml}"
    );
}

#[test]
fn hands_turn_horns_and_the_truth_is_judged() {
    for shafts in ["ideal", "real"] {
        let text = format!(
            "use puppet marionette, shafts {shafts}, pose left_elbow at 10 deg, stops of left_elbow at -20 deg and 45 deg
at 0.1   torque of left_elbow is off
at 0.1   shaft left_elbow position is 10 deg within 0.1 deg
at 0.2   hand turns left_elbow to 30 deg over 1s
at 0.7   shaft left_elbow speed is 0.6 within 0.2
at 2     shaft left_elbow position is 30 deg within 2 deg
at 2     joint left_elbow is 30 deg within 2 deg
at 2     hand turns left_elbow by 90 deg over 500ms
at 4     joint left_elbow really is 45 deg within 0.01 deg
at 4     hand lets go of left_elbow
at 5     joint left_elbow really is 45 deg within 0.5 deg
at 5     hand pulls left_elbow with -0.3 Nm
at 7     shaft left_elbow position is -20 deg within 0.01 deg
at 7     hand holds left_elbow
at 7     life of left_elbow torque-ons at most 0
at 7     register torque-enable of left_elbow is 0
at 7     shaft left_elbow temperature is 25 within 1
at 7     shaft left_elbow effort is 0 within 0.001
"
        );
        let outcome = outcome(&text);
        assert_eq!(outcome.failures, [], "{shafts}");
    }
}

#[test]
fn faults_that_would_strike_nothing_are_refused() {
    let outcome = outcome("use puppet marionette\nat 0.1 fault servo 200 stuck on upper\n");
    assert_eq!(outcome.failures.len(), 1);
    assert!(
        outcome.failures[0]
            .message
            .contains("there is no servo 200; there are: "),
        "{:?}",
        outcome.failures
    );
}

#[test]
fn with_a_device_under_test_a_person_is_asked_and_time_is_real() {
    // A terminal that never answers stands for the real box; the tablet stays simulated.
    let pty = device::transport::pty::Pty::open().expect("a terminal");
    let dut = crate::dut::Dut {
        ports: BTreeMap::from([("dial-box".to_owned(), pty.path().display().to_string())]),
    };
    let text = "at 0.1 turn dial 1 by 64 # slowly\nby 3 device tablet is present\nby 3 device dial-box is starting\n";
    let mut asked = Vec::new();
    let scenario = parse(text).expect("reads");
    let outcome = run_on(&scenario, &RunOptions::default(), &dut, &mut |doing| {
        asked.push(doing.to_owned());
    });
    assert_eq!(outcome.failures, []);
    assert_eq!(asked, ["turn dial 1 by 64"]);
    assert!(outcome.secs > 0.1, "{outcome:?}");
}
