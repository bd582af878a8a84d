//! Transports, codecs, clocks and the servo bus: bytes and units, no meaning.
//!
//! Knows: how bytes come and go ([`transport`]), what they say ([`codec`], `servo::framing`), how counts become
//! radians and which goals a servo may get (`servo`), and what time it is ([`clock`]). Must not know: figures,
//! networks, shows, or what anybody wants with a knob. Codecs and framing must not know transports either:
//! they run as well on a file of bytes.
//!
//! Start at [`transport::Transport`], then [`Device::poll`].

pub mod clock;
pub mod codec;
mod device;
pub mod discovery;
pub mod exchange;
pub mod servo;
pub mod tap;
pub mod transport;

pub use clock::{Clock, Instant, MonotonicClock, VirtualClock};
pub use codec::UnknownFormat;
pub use codec::{Codec, Feedback, InputEvent, PenSample, Stamped, Tool};
pub use device::{Device, Health};
pub use transport::{Boundary, Transport, TransportError};
