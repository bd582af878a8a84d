//! What the two binaries, the benches and the tests of the whole rig share.
//!
//! *Knows* everything: it is an end, nothing depends on it. [`golden`] answers golden files, [`mod@measure`] makes
//! the comparisons that issues and docs quote, [`lunge`] asks whether a puppet ever does, [`simulated`] puts simulated
//! firmware behind a transport.
//! *Must not know* a window: whatever needs one is in `it/`, so that the two binaries build without it.
//! *Start reading* at `it/main.rs`.

pub mod golden;
pub mod kernel;
pub mod lunge;
pub mod measure;
pub mod simulated;
