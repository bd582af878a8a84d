//! Bounds on what is read, so that a wrong file is an error and not a machine without memory.

/// Most keys, or frames, in one clip: a quarter of an hour at 120 frames a second.
pub const KEYS_MAX: usize = 100_000;

/// Most links in one figure. The largest known here (hands with fingers) have about 80.
pub const LINKS_MAX: usize = 4096;

/// Most files of one kind in a show.
pub const FILES_MAX: usize = 1000;

/// Key times lie within this of 0, seconds: 115 days either way, far beyond any show.
pub const SECS_MAX: f64 = 1e7;

/// Keys are at least this far apart, seconds. Closer ones are one key that was rounded twice, and would
/// make speeds that no number holds.
pub const KEY_GAP_SECS_MIN: f64 = 1e-6;
