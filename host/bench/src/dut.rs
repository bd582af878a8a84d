//! The device under test: which names of the bench are real ports, so that the same scenario runs on hardware.
//!
//! Whatever is not named stays simulated: a real bus can be driven by a simulated dial box, and the other way
//! round. On hardware time is real.

use std::collections::BTreeMap;

use device::transport::{self, Address, Transport, TransportError};
use device_profiles::Line;
use rig::{Found, InputSpec, Ports, PuppetSpec, Touch, TouchError};
use serde::Deserialize;

use crate::stand::{SCHEME, SimPorts};

/// Real ports by the bench's names (`dial-box`, `tablet`, a bus).
#[derive(Clone, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Dut {
    /// Name to address: `/dev/ttyUSB0`, `tcp:HOST:PORT`, `usb:SERIAL`.
    pub ports: BTreeMap<String, String>,
}

/// A file that describes no device under test.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{line}:{column}: {message}")]
pub struct DutError {
    /// Line, from 1.
    pub line: u32,
    /// Column in characters, from 1.
    pub column: u32,
    /// What was expected and what was found.
    pub message: String,
}

impl Dut {
    /// Reads a file such as `[ports]`, `upper = "/dev/ttyUSB0"`.
    pub fn parse(text: &str) -> Result<Self, DutError> {
        toml::from_str(text).map_err(|error: toml::de::Error| {
            let at = error.span().map_or(0, |span| span.start).min(text.len());
            let before = text.get(..at).unwrap_or_default();
            let start = before.rfind('\n').map_or(0, |end| end + 1);
            DutError {
                line: before.matches('\n').count() as u32 + 1,
                column: before[start..].chars().count() as u32 + 1,
                message: error.message().to_owned(),
            }
        })
    }

    /// Whether the device of that name is real.
    pub fn has(&self, name: &str) -> bool {
        self.ports.contains_key(name)
    }

    fn real(&self, address: &str) -> Option<&String> {
        self.ports.get(address.strip_prefix(SCHEME)?)
    }

    pub(crate) fn redirect_inputs(&self, inputs: &mut [InputSpec]) {
        for input in inputs {
            if let Some(real) = self.real(&input.address) {
                input.address.clone_from(real);
            }
        }
    }

    pub(crate) fn redirect_puppet(&self, puppet: &mut PuppetSpec) {
        for address in puppet.ports.values_mut() {
            if let Some(real) = self.real(address) {
                address.clone_from(real);
            }
        }
    }
}

/// Simulated ports by `sim:`, real ones by every other address.
pub struct MixedPorts {
    sim: SimPorts,
}

impl MixedPorts {
    /// Real ports beside those of a stand.
    pub fn new(sim: SimPorts) -> Self {
        Self { sim }
    }
}

impl Ports for MixedPorts {
    fn list(&mut self) -> Vec<Found> {
        self.sim.list()
    }

    fn open(&mut self, address: &str, baud: u32) -> Result<Box<dyn Transport>, TransportError> {
        match address.parse::<Address>()? {
            Address::Sim(_) => self.sim.open(address, baud),
            real => transport::open(&real, baud),
        }
    }

    fn open_input(
        &mut self,
        address: &str,
        line: Option<&Line>,
    ) -> Result<Box<dyn Transport>, TransportError> {
        match (address.parse::<Address>()?, line) {
            (Address::Sim(_), line) => self.sim.open_input(address, line),
            (Address::Path(path), Some(line)) => Ok(Box::new(transport::serial::open_line(&path, line)?)),
            (real, line) => transport::open(&real, line.map_or(0, |line| line.baud)),
        }
    }

    fn touch(&mut self, address: &str, touch: &Touch) -> Result<(), TouchError> {
        self.sim.touch(address, touch)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ports_are_read_and_flaws_have_a_place() {
        let dut = Dut::parse("# bench a\n[ports]\nupper = \"/dev/ttyUSB0\"\n").expect("reads");
        assert!(dut.has("upper") && !dut.has("lower"));
        let error = Dut::parse("[ports]\nupper = 3\n").expect_err("not a text");
        assert_eq!((error.line, error.column), (2, 9), "{error}");
        assert!(
            Dut::parse("[port]\n")
                .expect_err("unknown")
                .to_string()
                .contains("unknown field")
        );
    }
}
