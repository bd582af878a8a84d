//! The small networks of `networks/firing`: one for each rule of firing, with what it prints beside it in `.out`.
//!
//! The page that shows them is made from both.

use std::fmt::Write;
use std::fs;
use std::path::PathBuf;

use crate::session::{Desk, Session, is_updating, root};

const HEAD: &str = "\
# How messages flow

<!-- Written by `UPDATE_PAGES=1 cargo test -p dialrig --test networks`; change the files in `networks/firing`. -->

Every rule of firing as a network of a few lines that can be run, and what it prints. The rules and where they are
known from are in [the protocol page](../protocols/ps300.md#tokens-queues-firing).
";

/// One example.
struct Example {
    /// Without folder and ending.
    name: String,
    text: String,
    out: PathBuf,
    sessions: Vec<Session>,
}

fn examples() -> Vec<Example> {
    let folder = root().join("networks/firing");
    let mut names: Vec<String> = fs::read_dir(&folder)
        .expect("the folder is there")
        .filter_map(|entry| {
            let name = entry.expect("readable").file_name().into_string().ok()?;
            name.strip_suffix(".ps300").map(str::to_owned)
        })
        .collect();
    names.sort();
    let read = |name: String| {
        let text = fs::read_to_string(folder.join(format!("{name}.ps300"))).expect("readable");
        let out = folder.join(format!("{name}.out"));
        let kept = fs::read_to_string(&out).unwrap_or_else(|_| panic!("{name} has no .out beside it"));
        let sessions = Session::read(&kept).unwrap_or_else(|why| panic!("{name}.out: {why}"));
        assert!(!sessions.is_empty(), "{name}.out runs nothing");
        Example {
            name,
            text,
            out,
            sessions,
        }
    };
    names.into_iter().map(read).collect()
}

#[test]
fn every_rule_of_firing_prints_what_stands_beside_it() {
    let desk = Desk::new();
    let mut wrong = Vec::new();
    for mut example in examples() {
        let file = format!("networks/firing/{}.ps300", example.name);
        if !example
            .sessions
            .iter()
            .any(|session| session.command.contains(&file))
        {
            wrong.push(format!("{}.out does not run {file}", example.name));
        }
        if is_updating() {
            let mut text = String::new();
            for session in &mut example.sessions {
                session.printed = desk.run(&session.command);
                session.write(&mut text);
            }
            fs::write(&example.out, text).expect("writes");
        }
        wrong.extend(example.sessions.iter().filter_map(|session| desk.fault(session)));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    the_page_is_current();
}

/// A file's comment at the top as a heading and paragraphs, and what follows it.
fn explained(text: &str) -> Option<(String, String, &str)> {
    let (comment, code) = text.strip_prefix('{')?.split_once('}')?;
    let lines: Vec<&str> = comment.lines().map(str::trim).collect();
    let comment = lines.join("\n");
    let (heading, paragraphs) = comment.split_once("\n\n")?;
    let heading = heading.trim().trim_end_matches('.').replace('\n', " ");
    Some((heading, paragraphs.trim().replace('<', "\\<"), code.trim()))
}

/// After the files, so that one call writes both.
fn the_page_is_current() {
    let mut page = HEAD.to_owned();
    for example in examples() {
        let (heading, paragraphs, code) =
            explained(&example.text).unwrap_or_else(|| panic!("{} does not explain itself", example.name));
        let _ = write!(
            page,
            "\n## {heading}\n\n{paragraphs}\n\n```ps300\n{code}\n```\n\n```console\n"
        );
        for session in &example.sessions {
            session.write(&mut page);
        }
        page.push_str("```\n");
    }
    let path = root().join("docs/ps300/firing.md");
    if is_updating() {
        fs::write(&path, &page).expect("docs/ps300 can be written");
    }
    assert!(
        fs::read_to_string(&path).unwrap_or_default() == page,
        "docs/ps300/firing.md is not what the files say; \
         write it with: UPDATE_PAGES=1 cargo test -p dialrig --test networks"
    );
}
