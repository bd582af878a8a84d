//! Sessions with a machine: commands, live edits, messages and ticks at any budget, under the laws that the property
//! tests of `host/ps300/tests/random.rs` check too.

#![no_main]

use libfuzzer_sys::fuzz_target;

#[allow(dead_code, reason = "the property tests use more of it")]
#[path = "../../host/ps300/tests/chance/mod.rs"]
mod chance;

fuzz_target!(|bytes: &[u8]| chance::laws::hold(&chance::session::acts(bytes)));
