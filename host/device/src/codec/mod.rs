//! What the bytes of an input device say, and how to talk back. State machines over bytes and time: no
//! transport, no clock. One file per wire format, named as the page in `docs/protocols/`.

pub mod calcomp;
pub mod deej;
pub mod dial_reports;
mod dialogue;
mod event;
pub mod firmata;
mod formats;
pub mod gtco;
mod handshake;
mod held;
pub mod hid;
mod lines;
pub mod midi;
pub mod mm;
pub mod monome_arc;
mod motors;
pub mod osc;
mod outgoing;
pub mod outline;
mod overdue;
mod phased;
pub mod serial_formats;
pub mod sgi_dial_box;
#[cfg(test)]
mod trial;
pub mod usb_text;
pub mod wacom_iv;
pub mod wacom_v;

pub use event::{Feedback, InputEvent, PenSample, Picture, RingStyle, Stamped, Surface, Tool};
pub use formats::{Stand, UnknownFormat, of_profile};
pub use handshake::Handshake;
pub use osc::due as osc_due;
pub use outgoing::{Answer, Outgoing, Step};

use crate::clock::Instant;

/// One end of a conversation with a device.
///
/// The caller brings bytes to [`decode`](Codec::decode) as they come, calls [`advance`](Codec::advance) after
/// that and whenever time has passed, and sends what was put out. How the bytes of a stream are cut into pieces
/// makes no difference to the events; where the line keeps reports apart, one call is one report, exactly as the
/// device sent it: with its id first only where the device numbers its reports.
pub trait Codec: Send {
    /// Begins (or begins again) whatever the device needs before it reports.
    fn start(&mut self, now: Instant, out: &mut Outgoing);

    /// Takes bytes from the device. Malformed ones are counted and skipped.
    fn decode(&mut self, bytes: &[u8], emit: &mut dyn FnMut(InputEvent));

    /// Takes what came back for a question, in the order they were asked.
    fn answer(&mut self, answer: Answer, now: Instant, out: &mut Outgoing) {
        let _ = (answer, now, out);
    }

    /// Goes on with the conversation: next questions, time limits, restarts.
    fn advance(&mut self, now: Instant, out: &mut Outgoing, emit: &mut dyn FnMut(InputEvent));

    /// Has the device show something. Only changes are sent; before the device has started, or when it
    /// starts again, everything is kept and sent then.
    fn encode(&mut self, feedback: &Feedback, out: &mut Outgoing);

    /// The device is gone: everything held is let go.
    fn let_go(&mut self, emit: &mut dyn FnMut(InputEvent));

    /// Whether the device has answered and reports.
    fn started(&self) -> bool;

    /// What has been counted so far.
    fn counters(&self) -> Counters;

    /// The tablet's active area; `None` for what has none.
    fn surface(&self) -> Option<Surface> {
        None
    }

    /// Why the device has not started, in words, where that is known.
    fn trouble(&self) -> Option<&str> {
        None
    }

    /// What the device calls itself; `None` before it said so, or if it never does.
    fn identity(&self) -> Option<&str> {
        None
    }
}

/// Tallies of one codec since it was made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counters {
    /// Well-formed reports.
    pub reports: u64,
    /// Bytes that begin nothing known.
    pub unknown: u64,
    /// Reports and answers that began well and went wrong.
    pub rejected: u64,
}
