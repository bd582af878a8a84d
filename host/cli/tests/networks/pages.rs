//! Pages whose commands are run as they stand: what a page says is printed is printed.

use std::fs;

use crate::session::{Desk, Session, is_updating, root};

/// Pages about networks. Every `console` block of one is run, in order, on one desk.
const PAGES: &[&str] = &["docs/networks.md"];

#[test]
fn pages_print_what_their_commands_do() {
    let mut wrong = Vec::new();
    for page in PAGES {
        let path = root().join(page);
        let text = fs::read_to_string(&path).expect("the page is there");
        let desk = Desk::new();
        let mut written = String::new();
        let mut block: Option<String> = None;
        let mut ran = 0;
        for line in text.lines() {
            match &mut block {
                None => {
                    block = (line == "```console").then(String::new);
                }
                Some(sessions) if line == "```" => {
                    for mut session in Session::read(sessions).unwrap_or_else(|why| panic!("{page}: {why}")) {
                        if is_updating() {
                            session.printed = desk.run(&session.command);
                        } else {
                            wrong.extend(desk.fault(&session).map(|fault| format!("{page}\n{fault}")));
                        }
                        session.write(&mut written);
                        ran += 1;
                    }
                    block = None;
                }
                Some(sessions) => {
                    sessions.push_str(line);
                    sessions.push('\n');
                    continue;
                }
            }
            written.push_str(line);
            written.push('\n');
        }
        assert!(ran > 0, "{page} runs nothing");
        if is_updating() {
            fs::write(&path, written).expect("writes");
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
