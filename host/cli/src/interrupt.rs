//! Ctrl-C as a flag, for commands that write many lines or hold something that must be put down.
//!
//! Commands that do not ask for it are ended by the signal itself, which is safe: files are put in place
//! whole, by renaming.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// How long Ctrl-C may go unnoticed while waiting.
const NAP: Duration = Duration::from_millis(50);

/// Whether Ctrl-C (or a polite request to end) has come.
#[derive(Clone, Debug)]
pub(crate) struct Interrupt(Arc<AtomicBool>);

impl Interrupt {
    /// From now on the signal sets the flag and does nothing else. Ask after all input has been read, since
    /// a read does not look at the flag.
    pub(crate) fn listen() -> Self {
        let flag = Arc::new(AtomicBool::new(false));
        let set = Arc::clone(&flag);
        // Refused only when somebody listens already or the system lacks signals: the default then holds.
        let _ = ctrlc::set_handler(move || set.store(true, Ordering::Relaxed));
        Self(flag)
    }

    /// Waits, but not beyond the signal.
    pub(crate) fn wait(&self, time: Duration) {
        // Short naps: nothing here has a deadline, and the signal's handler cannot wake a thread safely.
        let naps = (time.as_millis() / NAP.as_millis()).max(1);
        for _ in 0..naps {
            if self.came() {
                return;
            }
            std::thread::park_timeout(NAP.min(time));
        }
    }

    /// The flag itself, for loops that look at it on their own.
    pub(crate) fn flag(&self) -> &AtomicBool {
        &self.0
    }

    /// Whether to end now.
    pub(crate) fn came(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}
