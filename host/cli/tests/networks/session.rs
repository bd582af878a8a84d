//! Sessions: a command line behind `$` and the lines it prints, as pages show them and `.out` files keep them.
//!
//! Standard output comes first, then standard error; which came when is not part of a session. Run by a shell, in a
//! folder of its own in which `networks`, `shows` and `docs` are the repository's, so that what a page tells a reader
//! to type can be typed.

use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// A command and what it is expected to print.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Session {
    /// Without the `$`.
    pub(crate) command: String,
    /// Ends in a line feed unless empty.
    pub(crate) printed: String,
}

impl Session {
    /// All sessions of a text; lines before the first `$` are an error.
    pub(crate) fn read(text: &str) -> Result<Vec<Self>, String> {
        let mut sessions: Vec<Self> = Vec::new();
        for line in text.lines() {
            if let Some(command) = line.strip_prefix("$ ") {
                sessions.push(Self {
                    command: command.to_owned(),
                    printed: String::new(),
                });
            } else if let Some(session) = sessions.last_mut() {
                session.printed.push_str(line);
                session.printed.push('\n');
            } else {
                return Err(format!("expected `$ COMMAND`, found `{line}`"));
            }
        }
        Ok(sessions)
    }

    /// As it stands in a text.
    pub(crate) fn write(&self, text: &mut String) {
        let _ = writeln!(text, "$ {}", self.command);
        text.push_str(&self.printed);
    }
}

/// The repository.
pub(crate) fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Whether pages and expectations are to be written anew instead of compared.
pub(crate) fn is_updating() -> bool {
    std::env::var_os("UPDATE_PAGES").is_some_and(|set| set == "1")
}

/// Where sessions run one after the other; a file that one writes is there for the next.
pub(crate) struct Desk {
    folder: tempfile::TempDir,
}

impl Desk {
    pub(crate) fn new() -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder");
        for name in ["networks", "shows", "docs"] {
            let from = fs::canonicalize(root().join(name)).expect("is there");
            std::os::unix::fs::symlink(from, folder.path().join(name)).expect("links");
        }
        Self { folder }
    }

    /// What a command line prints.
    pub(crate) fn run(&self, command: &str) -> String {
        let program = Path::new(env!("CARGO_BIN_EXE_dialrig"));
        let mut path = program.parent().expect("in a folder").as_os_str().to_owned();
        if let Some(others) = std::env::var_os("PATH") {
            path.push(":");
            path.push(others);
        }
        let output = Command::new("sh")
            .args(["-c", command])
            .current_dir(self.folder.path())
            .env("PATH", path)
            .env("NO_COLOR", "1")
            .stdin(Stdio::null())
            .output()
            .expect("a shell");
        let printed = [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).expect("UTF-8"));
        printed.concat()
    }

    /// What differs between a session and what its command prints, in words.
    pub(crate) fn fault(&self, session: &Session) -> Option<String> {
        let printed = self.run(&session.command);
        (printed != session.printed).then(|| {
            format!(
                "$ {}\nexpected:\n{}printed:\n{printed}",
                session.command, session.printed
            )
        })
    }
}
