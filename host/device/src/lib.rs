//! Transports, codecs, clocks and the servo bus: bytes and units, no meaning.
