//! The rows beside this file: what goes into a function and what comes out, in the form of
//! [`ps300::intrinsic::Spec::example`].
//!
//! A file is a family. `F:NAME` or `F:NAME(size)` begins a function's rows, each indented:
//! `steps -> messages`, followed by ` ! part of the report` where one is expected.
//! `total` in place of a row says that no message of a kind it takes is ever refused.

use std::fs;
use std::path::{Path, PathBuf};

/// What is done to the instance `f`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Step {
    /// A literal sent to an input.
    Send { input: u16, literal: String },
    /// Network time passes to so many seconds.
    Time(f64),
    /// A command, without the semicolon.
    Command(String),
}

/// A message that comes out of `f`, or of another instance.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Wanted {
    pub name: String,
    pub output: u8,
    pub literal: String,
}

/// One row.
#[derive(Clone, Debug)]
pub(crate) struct Row {
    /// File and line, for messages.
    pub place: String,
    /// Without `F:`.
    pub function: String,
    /// `(3)`, or nothing.
    pub size: String,
    pub steps: Vec<Step>,
    pub wanted: Vec<Wanted>,
    /// Part of what is reported; empty where nothing is.
    pub report: String,
}

/// All rows of all families, and the functions said to be total.
pub(crate) struct Rows {
    pub rows: Vec<Row>,
    pub total: Vec<String>,
}

impl Rows {
    pub(crate) fn read() -> Self {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/functions/rows");
        let mut files: Vec<PathBuf> = fs::read_dir(folder)
            .expect("the folder of rows")
            .map(|entry| entry.expect("a file of rows").path())
            .collect();
        files.sort();
        let mut all = Self {
            rows: Vec::new(),
            total: Vec::new(),
        };
        for file in &files {
            all.add(file);
        }
        all
    }

    fn add(&mut self, file: &Path) {
        let text = fs::read_to_string(file).expect("UTF-8");
        let file = file
            .file_name()
            .map_or(String::new(), |name| name.to_string_lossy().into_owned());
        let (mut function, mut size) = ("", "");
        for (index, line) in text.lines().enumerate() {
            if let Some(named) = line.strip_prefix("F:") {
                let cut = named.find('(').unwrap_or(named.len());
                (function, size) = named.split_at(cut);
            } else if line.trim() == "total" {
                self.total.push(function.to_owned());
            } else if !line.trim().is_empty() && !line.starts_with('#') {
                let place = format!("{file}:{}", index + 1);
                self.rows.push(Row::read(place, function, size, line));
            }
        }
    }
}

impl Row {
    pub(crate) fn read(place: String, function: &str, size: &str, text: &str) -> Self {
        let (text, report) = match text.split_once("! ") {
            Some((text, report)) => (text, report),
            None => (text, ""),
        };
        let (steps, wanted) = text
            .split_once("->")
            .unwrap_or_else(|| panic!("{place}: no -> in {text:?}"));
        let parts = |text: &str| -> Vec<String> {
            let parts = text.split(" | ").map(|part| part.trim().to_owned());
            parts.filter(|part| !part.is_empty()).collect()
        };
        let mut row = Self {
            function: function.to_owned(),
            size: size.to_owned(),
            steps: Vec::new(),
            wanted: parts(wanted)
                .iter()
                .map(|message| Wanted::read(&place, message))
                .collect(),
            report: report.trim().to_owned(),
            place,
        };
        for step in parts(steps) {
            if step.starts_with('(') {
                row.size = step;
            } else {
                row.steps.push(Step::read(&step));
            }
        }
        row
    }

    /// Whether a step sends to this input of `f`.
    pub(crate) fn feeds(&self, number: u16) -> bool {
        self.steps
            .iter()
            .any(|step| matches!(step, Step::Send { input, .. } if *input == number))
    }
}

impl Step {
    fn read(text: &str) -> Self {
        if let Some(secs) = text.strip_prefix('@') {
            return Self::Time(secs.parse().expect("seconds"));
        }
        match text.strip_prefix('<').and_then(|rest| rest.split_once("> ")) {
            Some((input, literal)) => Self::Send {
                input: input.parse().expect("the number of an input"),
                literal: literal.to_owned(),
            },
            None => Self::Command(text.to_owned()),
        }
    }
}

impl Wanted {
    fn read(place: &str, text: &str) -> Self {
        let parts = text.strip_prefix('<').and_then(|rest| rest.split_once('>'));
        let (output, rest) = parts.unwrap_or_else(|| panic!("{place}: {text:?} is no message"));
        let (name, literal) = rest.split_once(' ').expect("a literal");
        Self {
            name: if name.is_empty() { "f" } else { name }.to_owned(),
            output: output.parse().expect("the number of an output"),
            literal: literal.trim().to_owned(),
        }
    }
}
