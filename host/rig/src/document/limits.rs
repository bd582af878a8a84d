//! Bounds on what is read, so that a wrong file is an error and not a machine without memory.

/// Most keys, or frames, in one clip: a quarter of an hour at 120 frames a second.
pub const KEYS_MAX: usize = 100_000;

/// Most links in one figure. The largest known here (hands with fingers) have about 80.
pub const LINKS_MAX: usize = 4096;

/// Most files of one kind in a show.
pub const FILES_MAX: usize = 1000;
