//! Remarks for the person at the rig, a bounded number of them.

use std::collections::VecDeque;

use crate::snapshot::{Note, NoteLevel};

/// How many remarks are kept; a window shows fewer.
const KEPT: usize = 64;

/// The latest remarks, oldest first. A remark equal to the last one only renews its time.
#[derive(Debug, Default)]
pub(crate) struct Notes {
    kept: VecDeque<Note>,
}

impl Notes {
    pub(crate) fn add(&mut self, at_secs: f64, level: NoteLevel, text: impl Into<String>) {
        let text = text.into();
        if let Some(last) = self.kept.back_mut()
            && last.text == text
        {
            last.at_secs = at_secs;
            return;
        }
        if self.kept.len() == KEPT {
            self.kept.pop_front();
        }
        match level {
            NoteLevel::Info => tracing::info!("{text}"),
            NoteLevel::Warning => tracing::warn!("{text}"),
            NoteLevel::Error => tracing::error!("{text}"),
        }
        self.kept.push_back(Note { at_secs, level, text });
    }

    pub(crate) fn view(&self) -> Vec<Note> {
        self.kept.iter().cloned().collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn repeated_remarks_are_one() {
        let mut notes = Notes::default();
        notes.add(1.0, NoteLevel::Info, "a");
        notes.add(2.0, NoteLevel::Info, "a");
        notes.add(3.0, NoteLevel::Info, "b");
        assert_eq!(
            notes
                .view()
                .iter()
                .map(|n| (n.at_secs, n.text.as_str()))
                .collect::<Vec<_>>(),
            [(2.0, "a"), (3.0, "b")]
        );
    }

    #[test]
    fn a_flood_of_remarks_keeps_the_latest() {
        let mut notes = Notes::default();
        for i in 0..1000 {
            notes.add(f64::from(i), NoteLevel::Info, i.to_string());
        }
        let kept = notes.view();
        assert_eq!(kept.len(), KEPT);
        assert_eq!(kept.last().map(|n| n.text.as_str()), Some("999"));
    }
}
