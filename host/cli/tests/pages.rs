//! Pages about the network that must say what the program does.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

fn page(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../docs/ps300")
        .join(name)
}

fn dialrig(args: &[&str], stdin: &str) -> Output {
    let mut child = Command::new(env!("CARGO_BIN_EXE_dialrig"))
        .args(args)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("starts");
    let mut pipe = child.stdin.take().expect("piped");
    // `functions` does not read.
    let _ = pipe.write_all(stdin.as_bytes());
    drop(pipe);
    child.wait_with_output().expect("ends")
}

/// The page of functions is generated; `UPDATE_PAGES=1` writes it anew.
#[test]
fn the_page_of_functions_is_current() {
    let made = dialrig(&["net", "functions", "--markdown"], "");
    let made = String::from_utf8(made.stdout).expect("UTF-8");
    let path = page("functions.md");
    if std::env::var_os("UPDATE_PAGES").is_some_and(|set| set == "1") {
        fs::write(&path, &made).expect("docs/ps300 can be written");
    }
    let found = fs::read_to_string(&path)
        .unwrap_or_default()
        .replace("\r\n", "\n");
    assert!(
        found == made,
        "docs/ps300/functions.md is not what the tables say; \
         write it with: UPDATE_PAGES=1 cargo test -p dialrig --test pages"
    );
}

/// Fenced blocks of the language, with the line each begins on.
fn blocks(text: &str) -> Vec<(usize, String)> {
    let mut blocks = Vec::new();
    let mut inside: Option<(usize, String)> = None;
    for (index, line) in text.lines().enumerate() {
        match (&mut inside, line.trim_end()) {
            (Some(_), "```") => blocks.extend(inside.take()),
            (Some((_, block)), line) => {
                block.push_str(line);
                block.push('\n');
            }
            (None, "```ps300") => inside = Some((index + 2, String::new())),
            (None, _) => {}
        }
    }
    blocks
}

/// Each block is a program of its own: it is understood without remark, prints as something that reads the
/// same, and runs without losing a message.
#[test]
fn the_examples_of_the_language_run() {
    let text = fs::read_to_string(page("language.md")).expect("docs/ps300/language.md");
    let blocks = blocks(&text);
    assert!(blocks.len() >= 5, "only {} examples", blocks.len());
    for (line, block) in &blocks {
        for args in [&["net", "check", "-"][..], &["net", "run", "-", "--until", "1"]] {
            let output = dialrig(args, block);
            let said = String::from_utf8_lossy(&output.stderr);
            let quiet = said.is_empty() || said == "in order\n";
            assert!(output.status.success() && quiet, "line {line}, {args:?}: {said}");
        }
        let printed = dialrig(&["net", "print", "-"], block).stdout;
        let again = dialrig(&["net", "print", "-"], &String::from_utf8_lossy(&printed)).stdout;
        assert_eq!(printed, again, "line {line}");
    }
}
