//! Writing one message as a packet.

use crate::codec::Outgoing;
use rosc::{OscMessage, OscPacket, OscType};

/// Appends a packet with this one message.
pub(super) fn send(address: &str, args: Vec<OscType>, out: &mut Outgoing) {
    let message = OscPacket::Message(OscMessage {
        addr: address.to_owned(),
        args,
    });
    // A packet is a report of its own: two of them must not be joined.
    match rosc::encoder::encode(&message) {
        Ok(bytes) => out.report(&bytes),
        Err(error) => tracing::debug!(address, ?error, "an OSC message cannot be written"),
    }
}
