//! HID descriptors and reports: see the library's laws.

#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| dialrig_fuzz::hid::run(bytes));
