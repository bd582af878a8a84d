//! The diagnostics of one source text, bounded.

use super::{Diagnostic, Severity};

/// A megabyte of noise must not become gigabytes of remarks. Our choice: more than a person reads.
const DIAGNOSTICS_MAX: usize = 500;

/// Collects remarks until there are too many, then only counts errors.
#[derive(Default)]
pub(super) struct Reports {
    kept: Vec<Diagnostic>,
    left_out: Option<(Diagnostic, usize)>,
}

impl Reports {
    /// Whether what is said from now on is only counted, so that thinking of a hint is wasted.
    pub(super) fn is_full(&self) -> bool {
        self.kept.len() >= DIAGNOSTICS_MAX
    }

    pub(super) fn push(&mut self, diagnostic: Diagnostic) {
        if self.kept.len() < DIAGNOSTICS_MAX {
            self.kept.push(diagnostic);
        } else if diagnostic.severity == Severity::Error || self.left_out.is_none() {
            let count = self.left_out.take().map_or(0, |(_, count)| count);
            self.left_out = Some((diagnostic, count + 1));
        }
    }

    /// Everything kept, in the order of the text, and one line about the rest.
    pub(super) fn finish(mut self) -> Vec<Diagnostic> {
        self.kept
            .sort_by_key(|diagnostic| (diagnostic.line, diagnostic.column));
        if let Some((mut last, count)) = self.left_out {
            last.message = format!("{count} more remarks up to here are left out");
            last.expected = None;
            last.hint = Some("correct the first ones and read the text again".to_owned());
            self.kept.push(last);
        }
        self.kept
    }
}
