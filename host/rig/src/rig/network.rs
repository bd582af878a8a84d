//! Changing the network while it runs.

use std::sync::Arc;

use ps300::Diagnostic;

use super::Rig;
use crate::command::NetworkEdit;
use crate::network_look::Looking;
use crate::snapshot::NetworkLook;
use crate::wiring::Wiring;

impl Rig {
    pub(super) fn edit_network(&mut self, edit: &NetworkEdit) -> Result<(), String> {
        match edit {
            NetworkEdit::Commands(text) => {
                let found = self.wiring.execute(text);
                let show = self.history.present().with_patch(text);
                self.change(show, "network commands".into(), None);
                self.told(&found)
            }
            NetworkEdit::Program(text) => {
                let show = self.history.present().with_program(text);
                let (wiring, remarks) = Wiring::load(&show);
                self.take_wiring(wiring);
                self.change(show, "network program".into(), None);
                if remarks.is_empty() {
                    Ok(())
                } else {
                    Err(remarks.join("; "))
                }
            }
            NetworkEdit::Undo => self.undo(),
            NetworkEdit::Redo => self.redo(),
            NetworkEdit::Freeze { name, output, on } => self.wiring.freeze(name, *output, *on),
        }
    }

    pub(super) fn take_wiring(&mut self, wiring: Wiring) {
        self.wiring = wiring;
        if let Some(looking) = &mut self.looking {
            looking.forget();
        }
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
        let looking = self.looking.as_mut()?;
        Some(looking.look(self.wiring.machine(), &Arc::clone(self.history.present()), steps))
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
