//! Ctrl-C as a flag, for commands that write many lines or hold something that must be put down.
//!
//! Commands that do not ask for it are ended by the signal itself, which is safe: files are put in place
//! whole, by renaming.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

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

    /// Whether to end now.
    pub(crate) fn came(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}
