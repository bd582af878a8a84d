//! Pictures of the rig, with and without a window.
