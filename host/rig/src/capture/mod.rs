//! Captures: everything that passes on the line of an input device as an exchange file, and such files played back.
//!
//! *Knows* exchanges and how they are put in place (`file`), one device without a show ([`Capture`]), the devices of a
//! rig that runs (`running`), and how a file is played through its codec ([`replay`]). *Must not know* formats.

mod file;
mod replay;
mod running;
mod single;

pub use replay::{Played, replay};
pub(crate) use running::{Captures, Subject};
pub use single::Capture;

use crate::listen::ListenError;

/// A device cannot be captured.
#[derive(Debug, thiserror::Error)]
pub enum CaptureError {
    /// It cannot be listened to, or is gone. What came before is kept.
    #[error(transparent)]
    Listen(#[from] ListenError),
    /// The file cannot be written.
    #[error("{file}: cannot write: {source}")]
    File {
        /// The file being written.
        file: String,
        /// Why.
        source: std::io::Error,
    },
}
