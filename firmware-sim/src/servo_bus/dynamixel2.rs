//! DYNAMIXEL protocol 2.0: packets with a two-byte length, byte stuffing and a CRC.
//!
//! Source: the maker's protocol 2.0 page.

pub(super) mod crc;
pub(super) mod orders;
pub(super) mod packet;
pub(super) mod receiver;
