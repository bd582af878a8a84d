//! Commands in, snapshots out: where the other crates meet.
