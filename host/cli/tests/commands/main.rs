//! The program as others call it: command lines, exit codes, and what appears on which stream.

mod captures;
mod curve;
mod documents;
mod figure;
mod killed;
mod live;
mod net;
mod streams;
mod usage;

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

/// One call. Snippets must occur in the order given; an empty list means that the stream stays empty.
struct Call {
    /// Words separated by spaces.
    args: &'static str,
    stdin: &'static str,
    exit: i32,
    out: &'static [&'static str],
    err: &'static [&'static str],
}

/// Whatever is on a stream.
const ANY: &[&str] = &[""];

/// A call without input.
const fn call(
    args: &'static str,
    exit: i32,
    out: &'static [&'static str],
    err: &'static [&'static str],
) -> Call {
    fed(args, "", exit, out, err)
}

/// A call with input.
const fn fed(
    args: &'static str,
    stdin: &'static str,
    exit: i32,
    out: &'static [&'static str],
    err: &'static [&'static str],
) -> Call {
    Call {
        args,
        stdin,
        exit,
        out,
        err,
    }
}

/// The repository's root: the shipped shows and networks are test material too.
fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn dialrig(args: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_dialrig"));
    command
        .args(args.split_whitespace())
        .current_dir(root())
        .env_remove("NO_COLOR")
        .env_remove("DISPLAY")
        .env_remove("WAYLAND_DISPLAY")
        .env_remove("WAYLAND_SOCKET")
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped());
    command
}

/// Presses Ctrl-C. A bare system has no program called `kill`, but every shell has one built in.
fn interrupt(child: &Child) {
    let sent = Command::new("sh")
        .args(["-c", &format!("kill -INT {}", child.id())])
        .status();
    assert!(sent.expect("a shell").success());
}

/// Makes every call in a folder with these files and tells of all that differ from what was expected.
fn check(files: &[(&str, &[u8])], calls: &[Call]) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (name, content) in files {
        let path = folder.path().join(name);
        let parent = path.parent().expect("inside the folder");
        fs::create_dir_all(parent)
            .and_then(|()| fs::write(&path, content))
            .expect("writes");
    }
    std::os::unix::fs::symlink(root().join("shows"), folder.path().join("shows")).expect("links");
    std::os::unix::fs::symlink(root().join("networks"), folder.path().join("networks")).expect("links");
    let faults: Vec<String> = calls
        .iter()
        .filter_map(|call| fault(folder.path(), call))
        .collect();
    assert!(faults.is_empty(), "{}", faults.join("\n\n"));
}

fn fault(folder: &Path, call: &Call) -> Option<String> {
    let mut child = dialrig(call.args).current_dir(folder).spawn().expect("starts");
    let mut stdin = child.stdin.take().expect("piped");
    // A program that refuses its arguments does not read.
    let _ = stdin.write_all(call.stdin.as_bytes());
    drop(stdin);
    let output = child.wait_with_output().expect("ends");
    let (out, err) = (
        String::from_utf8_lossy(&output.stdout),
        String::from_utf8_lossy(&output.stderr),
    );
    let right = output.status.code() == Some(call.exit) && has(&out, call.out) && has(&err, call.err);
    (!right).then(|| {
        format!(
            "dialrig {}\n  exit {:?}, expected {}\n  stdout {:?}, expected {:?}\n  stderr {:?}, expected {:?}",
            call.args,
            output.status.code(),
            call.exit,
            out,
            call.out,
            err,
            call.err
        )
    })
}

fn has(text: &str, snippets: &[&str]) -> bool {
    let mut rest = text;
    for snippet in snippets {
        let Some(at) = rest.find(snippet) else {
            return false;
        };
        rest = &rest[at + snippet.len()..];
    }
    !snippets.is_empty() || text.is_empty()
}
