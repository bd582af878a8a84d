//! Simulated devices on a real kernel's USB: the machinery of the kernel tier (`docs/kernel-tier.md`).
//!
//! *Knows* USB/IP, `vhci_hcd`, and the descriptors and requests of four kinds of function; the devices themselves are
//! `firmware-sim`'s. *Must not know* the host program but by its command line.
//! *Start reading* at [`cable`]; [`tier`] is what is shown with it.

pub mod cable;
pub mod function;
pub mod host;
pub mod tier;
pub mod usbip;
