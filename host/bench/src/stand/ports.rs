//! The stand as the place the rig gets its transports from.

use std::sync::Arc;

use device::transport::{Transport, TransportError};
use device_profiles::{Line, Parity as ProfileParity};
use firmware_sim::Parity;
use firmware_sim::hands::{Puck, Touch as Hand, Turn};
use rig::{Found, Ports, Touch, TouchError};

use super::{HandError, SCHEME, SimReports, SimTransport, Stand, lock};

/// Ports of simulated devices. Addresses are `sim:NAME`.
#[derive(Clone)]
pub struct SimPorts {
    stand: Stand,
}

impl SimPorts {
    /// The ports of a stand.
    pub fn new(stand: Stand) -> Self {
        Self { stand }
    }
}

impl Ports for SimPorts {
    fn list(&mut self) -> Vec<Found> {
        let plugged = self.stand.seats.values().filter_map(|seat| {
            let seat = lock(seat);
            seat.is_connected().then(|| Found {
                address: format!("{SCHEME}{}", seat.name),
                description: seat.description.clone(),
                matches: seat.matches.clone(),
                ..Found::default()
            })
        });
        let now_us = self.stand.now_us();
        let on_usb = self.stand.usb.values().filter_map(|seat| {
            let mut seat = lock(seat);
            seat.is_connected(now_us).then(|| Found {
                address: format!("{SCHEME}{}", seat.name),
                description: seat.description.clone(),
                matches: seat.matches.clone(),
                ..Found::default()
            })
        });
        let mut found: Vec<Found> = plugged.chain(on_usb).collect();
        found.sort_by(|a, b| a.address.cmp(&b.address));
        found
    }

    fn open(&mut self, address: &str, baud: u32) -> Result<Box<dyn Transport>, TransportError> {
        self.open_at(address, baud, Parity::None)
    }

    fn open_input(
        &mut self,
        address: &str,
        line: Option<&Line>,
    ) -> Result<Box<dyn Transport>, TransportError> {
        let baud = line.map_or(0, |line| line.baud);
        let parity = match line.map(|line| line.parity) {
            None | Some(ProfileParity::None) => Parity::None,
            Some(ProfileParity::Odd) => Parity::Odd,
            Some(ProfileParity::Even) => Parity::Even,
        };
        self.open_at(address, baud, parity)
    }

    fn touch(&mut self, address: &str, touch: &Touch) -> Result<(), TouchError> {
        self.lay_hand(address, touch)
    }
}

impl SimPorts {
    fn open_at(
        &mut self,
        address: &str,
        baud: u32,
        parity: Parity,
    ) -> Result<Box<dyn Transport>, TransportError> {
        let not_found = || TransportError::NotFound {
            address: address.to_owned(),
        };
        let name = address.strip_prefix(SCHEME).ok_or_else(not_found)?;
        if let Some(seat) = self.stand.usb.get(name) {
            let clock = Arc::clone(&self.stand.clock);
            let reports = SimReports::open(address, seat, clock).ok_or_else(not_found)?;
            return Ok(Box::new(reports));
        }
        let seat = self.stand.seats.get(name).ok_or_else(not_found)?;
        let opening = lock(seat)
            .open(self.stand.now_us(), baud, parity)
            .ok_or_else(not_found)?;
        let clock = Arc::clone(&self.stand.clock);
        Ok(Box::new(SimTransport::new(
            address.to_owned(),
            Arc::clone(seat),
            clock,
            opening,
        )))
    }

    fn lay_hand(&self, address: &str, touch: &Touch) -> Result<(), TouchError> {
        let hand = match *touch {
            Touch::Cable { connected } => {
                return self
                    .stand
                    .plug(address, connected)
                    .map_err(|error| refused(address, &error));
            }
            Touch::Dial { control, turns } => Hand::Dial {
                control,
                by: Turn::Turns(turns),
                over_us: 0,
            },
            Touch::Button { control, down } => Hand::Button { control, down },
            Touch::Tablet {
                at: Some([x, y]),
                buttons,
            } => Hand::Puck(Puck {
                x,
                y,
                buttons,
                ..Puck::default()
            }),
            Touch::Tablet { at: None, .. } => Hand::Away,
        };
        self.stand
            .touch(address, &hand)
            .map_err(|error| refused(address, &error))
    }
}

fn refused(address: &str, error: &HandError) -> TouchError {
    let address = address.to_owned();
    match error {
        HandError::NoSuchControl { control, .. } => TouchError::NoSuchControl {
            address,
            control: control.clone(),
        },
        _ => TouchError::NotSimulated { address },
    }
}
