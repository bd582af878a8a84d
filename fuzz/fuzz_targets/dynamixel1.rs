//! What comes on a line of Dynamixel protocol 1.0 servos: see the library's laws.

#![no_main]

use device_profiles::ServoProtocol;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| dialrig_fuzz::line::run(ServoProtocol::Dynamixel1, bytes));
