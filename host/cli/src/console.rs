//! Where results and remarks go: results to standard output, everything else to standard error.
//!
//! Apart so that no command decides for itself about JSON, colour, `--quiet` or a reader that went away.

use std::cell::RefCell;
use std::fmt::Display;
use std::io::{self, BufWriter, IsTerminal, Stdout, Write};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use rig::document::FileError;
use serde::Serialize;
use tracing_subscriber::EnvFilter;

use crate::args::Showing;
use crate::failure::{Exit, Failure};
use crate::table::Table;

/// Both streams, and how to write on them.
pub(crate) struct Console {
    showing: Showing,
    colour: bool,
    progress: bool,
    /// Results on a terminal appear line by line, elsewhere in blocks.
    live: bool,
    out: RefCell<BufWriter<Stdout>>,
}

/// How much a remark about a file matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Weight {
    /// It must be mended.
    Error,
    /// It may not be meant.
    Warning,
}

impl Weight {
    fn word(self) -> &'static str {
        match self {
            Self::Error => "error",
            Self::Warning => "warning",
        }
    }

    /// Red and yellow, bold.
    fn colour(self) -> &'static str {
        match self {
            Self::Error => "\x1b[1;31m",
            Self::Warning => "\x1b[1;33m",
        }
    }
}

/// A remark as JSON: the weight's word is the key of the text.
#[derive(Debug, Serialize)]
pub(crate) struct RemarkRecord<'a> {
    #[serde(skip_serializing_if = "Option::is_none")]
    error: Option<&'a str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    warning: Option<&'a str>,
    file: Option<String>,
    line: Option<u32>,
    column: Option<u32>,
    hint: Option<&'a str>,
}

impl<'a> RemarkRecord<'a> {
    fn new(weight: Weight, message: &'a str, hint: Option<&'a str>) -> Self {
        Self {
            error: (weight == Weight::Error).then_some(message),
            warning: (weight == Weight::Warning).then_some(message),
            file: None,
            line: None,
            column: None,
            hint,
        }
    }

    /// A remark about a place in a file.
    pub(crate) fn of_file(weight: Weight, error: &'a FileError) -> Self {
        Self {
            file: Some(error.file.display().to_string()),
            line: Some(error.line),
            column: Some(error.column),
            ..Self::new(weight, &error.message, error.hint.as_deref())
        }
    }
}

impl Console {
    /// As the command line and the environment ask for.
    pub(crate) fn new(showing: Showing) -> Self {
        let terminal = io::stderr().is_terminal();
        let set = |name: &str| std::env::var_os(name).is_some_and(|value| !value.is_empty());
        let dumb = std::env::var_os("TERM").is_some_and(|term| term == "dumb");
        log_to_stderr(showing);
        Self {
            showing,
            colour: terminal && !set("NO_COLOR") && !dumb && !showing.json,
            progress: terminal && !dumb && !showing.quiet && !showing.json,
            live: io::stdout().is_terminal(),
            out: RefCell::new(BufWriter::new(io::stdout())),
        }
    }

    /// Whether results are for a program.
    pub(crate) fn json(&self) -> bool {
        self.showing.json
    }

    /// Writes one line of the result.
    pub(crate) fn line(&self, text: impl Display) -> Result<(), Failure> {
        let mut out = self.out.borrow_mut();
        writeln!(out, "{text}").map_err(Failure::Output)?;
        if self.live {
            out.flush().map_err(Failure::Output)?;
        }
        Ok(())
    }

    /// Writes one JSON object as a line of the result.
    pub(crate) fn record(&self, record: &impl Serialize) -> Result<(), Failure> {
        match serde_json::to_string(record) {
            Ok(text) => self.line(text),
            Err(error) => Err(Failure::Output(error.into())),
        }
    }

    /// Hands over what was written, to a reader that waits for it.
    pub(crate) fn flush(&self) -> Result<(), Failure> {
        self.out.borrow_mut().flush().map_err(Failure::Output)
    }

    /// Writes a table as the result.
    pub(crate) fn table(&self, table: &Table) -> Result<(), Failure> {
        table.lines().try_for_each(|line| self.line(line))
    }

    /// Says something by the way; not with `--quiet`.
    pub(crate) fn remark(&self, text: impl Display) {
        if !self.showing.quiet {
            self.stderr(text);
        }
    }

    /// Shows warnings about files; not with `--quiet`.
    pub(crate) fn warn(&self, warnings: &[FileError]) {
        if !self.showing.quiet {
            for warning in warnings {
                self.file(Weight::Warning, warning);
            }
        }
    }

    /// Shows errors in files.
    pub(crate) fn errors(&self, errors: &[FileError]) {
        for error in errors {
            self.file(Weight::Error, error);
        }
    }

    /// A bar for long work, on a terminal that results are not written to as well.
    pub(crate) fn progress(&self, steps: u64, what: &'static str) -> ProgressBar {
        if !self.progress || self.live {
            return ProgressBar::hidden();
        }
        let bar = ProgressBar::with_draw_target(Some(steps), ProgressDrawTarget::stderr());
        let style = ProgressStyle::with_template("{msg} {wide_bar} {pos}/{len} {eta}");
        bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        bar.with_message(what)
    }

    /// Shows how a command failed, if it did, and says how the program ends.
    pub(crate) fn finish(&self, result: Result<Exit, Failure>) -> Exit {
        let flushed = self.out.borrow_mut().flush().map_err(Failure::Output);
        match result.and_then(|exit| flushed.map(|()| exit)) {
            Ok(exit) => exit,
            Err(Failure::Files(errors)) => {
                self.errors(&errors.0);
                Exit::Refused
            }
            Err(Failure::Refused { message, hint }) => {
                self.plain(Weight::Error, &message, hint.as_deref());
                Exit::Refused
            }
            Err(Failure::Device { message, safe }) => {
                let hint = (!safe)
                    .then_some("torque could not be confirmed to be off; switch the puppet's power off");
                self.plain(
                    Weight::Error,
                    &message,
                    hint.filter(|hint| !message.contains(hint)),
                );
                if safe {
                    Exit::FaultSafe
                } else {
                    Exit::FaultUnconfirmed
                }
            }
            // The reader has seen enough: `| head` is no failure.
            Err(Failure::Output(error)) if error.kind() == io::ErrorKind::BrokenPipe => Exit::Done,
            Err(Failure::Output(error)) => {
                self.plain(Weight::Error, &format!("cannot write the result: {error}"), None);
                Exit::Refused
            }
        }
    }

    fn file(&self, weight: Weight, error: &FileError) {
        if self.showing.json {
            return self.stderr_record(&RemarkRecord::of_file(weight, error));
        }
        let FileError {
            file, line, column, ..
        } = error;
        let place = format!("{}:{line}:{column}: ", file.display());
        self.shown(&place, weight, &error.message, error.hint.as_deref());
    }

    fn plain(&self, weight: Weight, message: &str, hint: Option<&str>) {
        if self.showing.json {
            return self.stderr_record(&RemarkRecord::new(weight, message, hint));
        }
        self.shown("", weight, message, hint);
    }

    fn shown(&self, place: &str, weight: Weight, message: &str, hint: Option<&str>) {
        let (on, off) = if self.colour {
            (weight.colour(), "\x1b[0m")
        } else {
            ("", "")
        };
        self.stderr(format_args!("{place}{on}{}:{off} {message}", weight.word()));
        if let Some(hint) = hint {
            self.stderr(format_args!("  hint: {hint}"));
        }
    }

    /// Writes a JSON object to standard error.
    pub(crate) fn stderr_record(&self, record: &impl Serialize) {
        if let Ok(text) = serde_json::to_string(record) {
            self.stderr(text);
        }
    }

    fn stderr(&self, text: impl Display) {
        // Results written so far come first where both streams go to one place.
        let _ = self.out.borrow_mut().flush();
        // There is nowhere left to say that standard error is gone.
        let _ = writeln!(io::stderr(), "{text}");
    }
}

/// `-v` shows what our crates say, `-vv` in detail; other crates only when something is wrong.
fn log_to_stderr(showing: Showing) {
    let level = match showing.verbose {
        0 => return,
        1 => "info",
        _ => "debug",
    };
    let ours = ["dialrig", "rig", "bench", "player", "device", "ui"].map(|name| format!("{name}={level}"));
    let filter = EnvFilter::new(format!("warn,{}", ours.join(",")));
    tracing_subscriber::fmt()
        .with_env_filter(filter)
        .with_writer(io::stderr)
        .with_ansi(false)
        .without_time()
        .init();
}
