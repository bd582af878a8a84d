//! Changing the network while it runs: edits by command or as a whole text, and back.
//!
//! The running machine is never replaced. An edit changes what it names; undo and redo change it into what it was
//! before or after, and what was not edited keeps its messages and sums.

use std::sync::Arc;

use ps300::Diagnostic;

use super::Rig;
use crate::command::NetworkEdit;
use crate::document::Show;
use crate::network_look::Looking;
use crate::snapshot::NetworkLook;

impl Rig {
    pub(super) fn edit_network(&mut self, edit: &NetworkEdit) -> Result<(), String> {
        match edit {
            NetworkEdit::Commands(text) => {
                let before = self.wiring.text_with_state();
                let done = self.wiring.execute(text);
                if !done.accepted.is_empty() {
                    let show = self.history.present().with_patch(&done.accepted);
                    self.network_changed(show, "network commands", done.gesture, before);
                }
                self.told(&done.found)
            }
            NetworkEdit::Program(text) => {
                let show = self.history.present().with_program(text);
                let before = self.wiring.text_with_state();
                let from = self.history.present().program_text();
                let found = self.wiring.edit_program(&from, text);
                if !found.iter().any(is_error) && from != *text {
                    self.network_changed(show, "network program", None, before);
                    self.tell_devices_again(&[from, text.clone()]);
                }
                self.told(&found)
            }
            NetworkEdit::Undo => self.undo(),
            NetworkEdit::Redo => self.redo(),
            NetworkEdit::Freeze { name, output, on } => self.wiring.freeze(name, *output, *on),
        }
    }

    fn network_changed(&mut self, show: Show, words: &str, gesture: Option<String>, before: String) {
        let from = Arc::clone(self.history.present());
        self.change(show, words.to_owned(), gesture);
        let merged = !self
            .history
            .previous()
            .is_some_and(|previous| Arc::ptr_eq(previous, &from));
        let shows = [from, Arc::clone(self.history.present())];
        let after = self.wiring.text_with_state();
        self.network_steps
            .note(shows, [before.into(), after.into()], merged);
    }

    /// Takes the network over that undo or redo brought back.
    pub(super) fn network_changed_from(&mut self, before: &Arc<Show>) {
        let show = Arc::clone(self.history.present());
        if show.patches == before.patches && show.networks == before.networks {
            return;
        }
        let programs = [before.program_text(), show.program_text()];
        if let Some([from, to]) = self.network_steps.between(before, &show) {
            self.wiring.restore(&from, &to);
        } else {
            // The change is too old to be known; what the documents say still is.
            self.wiring
                .edit_program(&before.program_text(), &show.program_text());
        }
        self.tell_devices_again(&programs);
    }

    pub(super) fn look_at_network(&mut self, on: bool) {
        if on != self.looking.is_some() {
            self.looking = on.then(|| Looking::new(self.history.present()));
        }
    }

    pub(super) fn network_look(&mut self) -> Option<NetworkLook> {
        let steps = [
            self.history.undo_words().is_some(),
            self.history.redo_words().is_some(),
        ];
        let show = Arc::clone(self.history.present());
        let looking = self.looking.as_mut()?;
        Some(looking.look(self.wiring.machine(), &show, steps))
    }

    /// Passes on what was wrong with an edit: to the panel with its places, and as one remark.
    fn told(&mut self, found: &[Diagnostic]) -> Result<(), String> {
        if let Some(looking) = &mut self.looking {
            looking.found(found);
        }
        if found.is_empty() {
            return Ok(());
        }
        let words: Vec<String> = found.iter().map(ToString::to_string).collect();
        Err(words.join("; "))
    }
}

fn is_error(diagnostic: &Diagnostic) -> bool {
    diagnostic.severity == ps300::language::Severity::Error
}
