//! The whole rig under test.
