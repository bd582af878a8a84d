//! Pages whose commands are run as they stand: what a page says is printed is printed, and a file that it shows is
//! that file.

use std::fs;

use crate::session::{Desk, Session, is_updating, root};

/// Pages about networks. The `console` blocks of one are run in order, on one desk; a block of the language below a
/// line with nothing but a path is that file.
const PAGES: &[&str] = &["docs/networks.md", "docs/tutorial/first-network.md"];

#[test]
fn pages_print_what_their_commands_do_and_show_the_files_they_name() {
    let mut wrong = Vec::new();
    for page in PAGES {
        let path = root().join(page);
        let text = fs::read_to_string(&path).expect("the page is there");
        let anew = written_anew(&text);
        if is_updating() {
            fs::write(&path, &anew).expect("writes");
        } else if anew != text {
            wrong.push(format!("{page}\n{}", first_difference(&text, &anew)));
        }
    }
    assert!(
        wrong.is_empty(),
        "{}\nUPDATE_PAGES=1 writes what is printed now",
        wrong.join("\n")
    );
}

/// The page as it should be.
fn written_anew(text: &str) -> String {
    let desk = Desk::new();
    let mut anew = String::new();
    let mut lines = text.lines();
    let mut named: Option<String> = None;
    let mut ran = 0;
    while let Some(line) = lines.next() {
        anew.push_str(line);
        anew.push('\n');
        let block = |lines: &mut std::str::Lines<'_>| -> String {
            let inside = lines.by_ref().take_while(|line| *line != "```");
            inside.flat_map(|line| [line, "\n"]).collect()
        };
        match (line, &named) {
            ("", _) => continue,
            ("```console", _) => {
                let shown = block(&mut lines);
                for mut session in Session::read(&shown).unwrap_or_else(|why| panic!("{why}")) {
                    session.printed = desk.run(&session.command);
                    session.write(&mut anew);
                    ran += 1;
                }
                anew.push_str("```\n");
            }
            ("```ps300", Some(file)) => {
                block(&mut lines);
                anew.push_str(&fs::read_to_string(root().join(file)).unwrap_or_else(|_| panic!("no {file}")));
                anew.push_str("```\n");
            }
            _ => {}
        }
        named = path_alone(line);
    }
    assert!(ran > 0, "a page runs nothing");
    anew
}

/// The path on a line that has nothing else.
fn path_alone(line: &str) -> Option<String> {
    let path = line.strip_prefix('`')?.strip_suffix('`')?;
    (path.contains('/') && !path.contains('`')).then(|| path.to_owned())
}

fn first_difference(text: &str, anew: &str) -> String {
    let at = text.lines().zip(anew.lines()).take_while(|(a, b)| a == b).count();
    let line = |text: &str| text.lines().nth(at).unwrap_or("(the end)").to_owned();
    format!(
        "line {}, after the command before it:\nexpected: {}\nprinted:  {}",
        at + 1,
        line(text),
        line(anew)
    )
}
