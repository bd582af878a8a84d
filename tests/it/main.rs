//! The whole rig under test, in one binary.

mod anomalies;
mod directions;
mod docs;
mod exchanges;
mod golden;
mod input_profiles;
mod measures;
mod motion_capture;
mod properties;
mod puppet_pictures;
mod rehearsal;
mod replay;
mod simulated_inputs;
mod source;
mod studio_pictures;
mod tidy;
mod witness;
