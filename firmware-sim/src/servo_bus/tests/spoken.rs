//! What is said to a running bus.

use super::*;

fn say(host: &mut Host, line: &str) -> Result<(), String> {
    let spoken = Spoken::parse(line)
        .map_err(|error| error.to_string())?
        .expect("not empty");
    host.bus.obey(host.now_us, &spoken)
}

#[test]
fn faults_and_hands_are_understood() {
    let mut host = Host::new(bus(BusOptions::default(), &[1, 2]));
    let good = host.ask(&packet(1, 1, &[]));
    assert_eq!(say(&mut host, "servo 1 silent  # a comment"), Ok(()));
    assert_eq!(host.ask(&packet(1, 1, &[])), []);
    assert_eq!(say(&mut host, "mend"), Ok(()));
    assert_eq!(host.ask(&packet(1, 1, &[])), good);
    assert_eq!(say(&mut host, "hand on 2 turns to 30 deg over 100ms"), Ok(()));
    host.wait(300);
    let turned = host.bus.servo(2).expect("there").true_position_rad().to_degrees();
    assert!((turned - 30.0).abs() < 0.1, "{turned}");
    assert_eq!(say(&mut host, "hand on 2 lets go"), Ok(()));
    assert_eq!(say(&mut host, "hand on 2 pulls 0.2Nm"), Ok(()));
    assert_eq!(Spoken::parse("   # nothing"), Ok(None));
    for line in [
        "mend",
        "hand on 3 lets go",
        "hand on 3 pulls -0.2Nm",
        "hand on 3 turns to 0 deg over 0.5s",
        "late 3us",
    ] {
        let spoken = Spoken::parse(line).expect(line).expect("not empty");
        assert_eq!(spoken.to_string(), line);
    }
}

#[test]
fn what_is_not_understood_has_its_place() {
    let mut host = Host::new(bus(BusOptions::default(), &[1]));
    for (line, words) in [
        ("servo 1 sielnt", "column 9: expected what is wrong with it"),
        ("servo 9 silent", "there is no servo 9; there are: 1"),
        ("hand on 9 lets go", "there is no servo 9; there are: 1"),
        ("hand on 1 truns to 3", "did you mean `turns`?"),
        ("mend all", "column 6: expected the end of the line, found `all`"),
    ] {
        let error = say(&mut host, line).expect_err(line);
        assert!(error.contains(words), "{line}: {error}");
    }
}
