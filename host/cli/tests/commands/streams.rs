//! What happens to output when its reader goes away or somebody presses Ctrl-C.

use std::io::{BufRead, BufReader, Read, Write};
use std::process::Child;

use crate::{dialrig, interrupt};

/// A run that would last for hours and prints all the while, after its first line.
fn endless() -> (Child, BufReader<std::process::ChildStdout>) {
    let mut child = dialrig("net run - --until 1e9 --watch tick<1>")
        .spawn()
        .expect("starts");
    let mut stdin = child.stdin.take().expect("piped");
    stdin.write_all(b"tick := F:CLFRAMES;").expect("reads");
    drop(stdin);
    let mut out = BufReader::new(child.stdout.take().expect("piped"));
    let mut line = String::new();
    out.read_line(&mut line).expect("a line");
    assert!(line.ends_with("}\n"), "{line}");
    (child, out)
}

fn errors(child: &mut Child) -> String {
    let mut text = String::new();
    let mut err = child.stderr.take().expect("piped");
    err.read_to_string(&mut text).expect("text");
    text
}

#[test]
fn a_reader_that_goes_away_is_no_failure() {
    let (mut child, out) = endless();
    drop(out);
    assert_eq!(errors(&mut child), "");
    assert_eq!(child.wait().expect("ends").code(), Some(0));
}

#[test]
fn an_interrupt_leaves_whole_lines() {
    let (mut child, mut out) = endless();
    interrupt(&child);
    let mut rest = Vec::new();
    out.read_to_end(&mut rest).expect("reads");
    assert!(rest.is_empty() || rest.ends_with(b"}\n"));
    assert!(errors(&mut child).contains("error: interrupted"));
    assert_eq!(child.wait().expect("ends").code(), Some(1));
}
