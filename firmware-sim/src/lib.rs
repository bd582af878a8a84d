//! Simulated device firmware, byte-exact, with its own clock and faults.
