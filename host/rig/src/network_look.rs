//! The network as snapshots show it, kept from step to step so that only what changed is made anew.

use std::sync::Arc;

use ps300::Diagnostic;
use ps300::machine::Activity;
use ps300::machine::Machine;
use ps300::machine::picture::Picture;

use crate::document::Show;
use crate::snapshot::NetworkLook;

/// What was shown last.
pub(crate) struct Looking {
    picture: Arc<Picture>,
    activity: Arc<Activity>,
    /// Filled every step, so that comparing with what was shown does not allocate.
    filled: Activity,
    show: Arc<Show>,
    text: Arc<str>,
    diagnostics: Arc<[Diagnostic]>,
}

impl Looking {
    pub(crate) fn new(show: &Arc<Show>) -> Self {
        Self {
            picture: Arc::default(),
            activity: Arc::default(),
            filled: Activity::default(),
            show: Arc::clone(show),
            text: show.program_text().into(),
            diagnostics: [].into(),
        }
    }

    /// What was wrong with the last edit.
    pub(crate) fn found(&mut self, diagnostics: &[Diagnostic]) {
        if *self.diagnostics != *diagnostics {
            self.diagnostics = diagnostics.into();
        }
    }

    pub(crate) fn look(
        &mut self,
        machine: &Machine,
        show: &Arc<Show>,
        [can_undo, can_redo]: [bool; 2],
    ) -> NetworkLook {
        if !Arc::ptr_eq(&self.show, show) {
            if self.show.networks != show.networks || self.show.patches != show.patches {
                self.text = show.program_text().into();
            }
            self.show = Arc::clone(show);
        }
        if self.picture.revision != machine.topology_revision() {
            self.picture = Arc::new(machine.picture());
        }
        machine.activity_into(&self.picture, &mut self.filled);
        if *self.activity != self.filled {
            self.activity = Arc::new(self.filled.clone());
        }
        NetworkLook {
            picture: Arc::clone(&self.picture),
            activity: Arc::clone(&self.activity),
            text: Arc::clone(&self.text),
            can_undo,
            can_redo,
            diagnostics: Arc::clone(&self.diagnostics),
        }
    }
}
