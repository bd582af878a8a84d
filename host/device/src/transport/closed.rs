//! A line that somebody let go of.

use super::{Boundary, Transport, TransportError};

/// The far end is gone, and nothing holds the port any more.
#[derive(Debug)]
pub(crate) struct Closed {
    /// Whose line it was.
    pub(crate) name: String,
}

impl Closed {
    fn gone(&self) -> TransportError {
        TransportError::Gone {
            address: self.name.clone(),
        }
    }
}

impl Transport for Closed {
    fn boundary(&self) -> Boundary {
        Boundary::Stream
    }

    fn read(&mut self, _buffer: &mut [u8]) -> Result<usize, TransportError> {
        Err(self.gone())
    }

    fn write(&mut self, _bytes: &[u8]) -> Result<(), TransportError> {
        Err(self.gone())
    }
}
