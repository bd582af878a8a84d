//! The ports and the time of this machine, and the ports of a bench beside them.

use std::sync::Arc;

use device::clock::{Clock, MonotonicClock};
use device::transport::{self, Address, Transport, TransportError, ports};

use crate::command::Touch;
use crate::ports::{Found, Ports, TouchError};

/// This machine's monotonic time, beginning now.
pub fn real_time() -> Arc<dyn Clock> {
    Arc::new(MonotonicClock::new())
}

/// Serial ports, pseudo-terminals and sockets of this machine.
#[derive(Clone, Copy, Debug, Default)]
pub struct SystemPorts;

impl Ports for SystemPorts {
    fn list(&mut self) -> Vec<Found> {
        ports::list()
            .into_iter()
            .map(|port| {
                let description = port.usb.as_ref().map_or_else(
                    || "serial port".to_owned(),
                    |usb| {
                        let text = format!("{} {}", usb.manufacturer, usb.name);
                        let ids = format!("{:04x}:{:04x} {}", usb.vendor, usb.product, usb.serial);
                        format!("{} ({})", text.trim(), ids.trim())
                    },
                );
                Found {
                    address: port.path,
                    description,
                    // Nothing on a serial line says what hangs on it before it is asked.
                    matches: Vec::new(),
                    allowed: if port.allowed {
                        Ok(())
                    } else {
                        Err(ports::PERMISSION_HINT.to_owned())
                    },
                }
            })
            .collect()
    }

    fn open(&mut self, address: &str, baud: u32) -> Result<Box<dyn Transport>, TransportError> {
        transport::open(&address.parse::<Address>()?, baud)
    }
}

/// Simulated devices at `sim:` addresses, the machine's own at all others.
pub struct WithBench {
    bench: Box<dyn Ports>,
    system: SystemPorts,
}

impl WithBench {
    /// Puts a bench beside the machine's ports.
    pub fn new(bench: Box<dyn Ports>) -> Self {
        Self {
            bench,
            system: SystemPorts,
        }
    }

    fn for_address(&mut self, address: &str) -> &mut dyn Ports {
        if address.starts_with("sim:") {
            self.bench.as_mut()
        } else {
            &mut self.system
        }
    }
}

impl Ports for WithBench {
    fn list(&mut self) -> Vec<Found> {
        let mut found = self.system.list();
        found.extend(self.bench.list());
        found
    }

    fn open(&mut self, address: &str, baud: u32) -> Result<Box<dyn Transport>, TransportError> {
        self.for_address(address).open(address, baud)
    }

    fn touch(&mut self, address: &str, touch: &Touch) -> Result<(), TouchError> {
        self.for_address(address).touch(address, touch)
    }
}
