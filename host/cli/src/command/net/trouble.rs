//! What went wrong while a network ran, one line for each kind of trouble however often it came.

use ps300::Report;
use ps300::network::Cause;
use serde::Serialize;

use super::message::nanos;
use crate::console::Console;

/// Reports added up.
#[derive(Default)]
pub(super) struct Troubles {
    /// With the time of the first.
    listed: Vec<(f64, Report)>,
}

/// One line of them.
#[derive(Serialize)]
struct TroubleRecord<'a> {
    report: String,
    name: &'a str,
    what: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    made: Option<String>,
    count: u32,
    t: f64,
}

impl Troubles {
    /// Adds what came up at `secs`.
    pub(super) fn add(&mut self, secs: f64, reports: Vec<Report>) {
        for report in reports {
            let alike = |listed: &&mut (f64, Report)| {
                listed.1.cause == report.cause && listed.1.name == report.name && listed.1.what == report.what
            };
            match self.listed.iter_mut().find(alike) {
                Some((_, known)) => known.count = known.count.saturating_add(report.count),
                None => self.listed.push((secs, report)),
            }
        }
    }

    /// Shows all, in the order in which each first came.
    pub(super) fn show(&self, console: &Console) {
        for (secs, report) in &self.listed {
            if console.json() {
                console.stderr_record(&TroubleRecord {
                    report: report.to_string(),
                    name: report.name.as_str(),
                    what: &report.what,
                    made: report.made.as_ref().map(ToString::to_string),
                    count: report.count,
                    t: nanos(*secs),
                });
            } else if report.cause == Cause::Unlisted || report.count == 1 {
                console.remark(format_args!("report: at {} s: {report}", nanos(*secs)));
            } else {
                console.remark(format_args!("report: from {} s: {report}", nanos(*secs)));
            }
        }
    }
}
