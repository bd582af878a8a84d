//! Who somebody is: protocol, model and firmware.
//!
//! Protocol 2.0 says so in answer to a ping. In the frame of 1.0 a ping's answer is empty, and cannot be told from an
//! error by a line that echoes, so three bytes are read instead: at 3 to 5 a Dynamixel has its id, line speed and
//! return delay, a Feetech its model number and its id. Sources: the control tables in `device-profiles/servos/`.

use super::find::Found;
use super::{Known, Maintenance, MaintenanceError, Model, is_feetech, is_stuffed};
use crate::clock::Clock;
use crate::servo::framing;
use crate::servo::register::{Sign, decode};
use device_profiles::{ServoProtocol, WordOrder};

/// Data bytes of a ping's answer in protocol 2.0: model number and firmware.
pub(super) const PING_DATA_BYTES: usize = 3;
/// Where the three bytes are that tell Dynamixel 1.0 from Feetech.
pub(super) const TELLING_ADDRESS: u16 = 3;
/// How many they are.
pub(super) const TELLING_BYTES: u16 = 3;
/// Feetech's byte "End": 0 where words have their low byte first.
const END_ADDRESS: u16 = 2;

impl Maintenance {
    /// Asks one servo who it is, in each protocol until it answers.
    pub fn ping(&mut self, id: u8, clock: &dyn Clock) -> Result<Found, MaintenanceError> {
        let known = self.known(id).map(|known| is_stuffed(known.protocol));
        let stuffed = self.protocols.contains(&ServoProtocol::Dynamixel2);
        let summed = self.protocols.iter().any(|&protocol| !is_stuffed(protocol));
        let frames = if known == Some(false) {
            [false, true]
        } else {
            [true, false]
        };
        for frame in frames {
            let found = match frame {
                true if stuffed => self.ping_dynamixel2(id, clock),
                false if summed => self.look_closer(id, clock),
                _ => continue,
            };
            match found {
                Err(MaintenanceError::Silent { .. }) => {}
                Ok(found) => {
                    self.remember(&found);
                    return Ok(found);
                }
                error => return error,
            }
        }
        Err(self.silent(id))
    }

    fn ping_dynamixel2(&mut self, id: u8, clock: &dyn Clock) -> Result<Found, MaintenanceError> {
        let protocol = ServoProtocol::Dynamixel2;
        let data = self.ask(protocol, id, PING_DATA_BYTES, clock, &|out| {
            framing::ping(protocol, out, id)
        })?;
        pinged(self.line.baud(), id, &data).ok_or_else(|| self.silent(id))
    }

    /// Who it is that speaks in the frame of 1.0.
    pub(super) fn look_closer(&mut self, id: u8, clock: &dyn Clock) -> Result<Found, MaintenanceError> {
        let frame = self.summed();
        let telling = self.read_from(frame, id, TELLING_ADDRESS, TELLING_BYTES, clock)?;
        let &[first, second, third] = telling.as_slice() else {
            return Err(self.silent(id));
        };
        let mut candidates = Vec::new();
        if first == id && self.protocols.contains(&ServoProtocol::Dynamixel1) {
            candidates.push(self.as_dynamixel1(id, clock)?);
        }
        if third == id && self.protocols.iter().any(|&protocol| is_feetech(protocol)) {
            candidates.push(self.as_feetech(id, [first, second], clock)?);
        }
        // Only by chance both, and then the model number decides.
        let known = candidates
            .iter()
            .find(|found| self.model(found.protocol, found.model_number).is_some());
        let found = known.or(candidates.first()).copied();
        found.ok_or(MaintenanceError::Unidentified { id })
    }

    fn as_dynamixel1(&mut self, id: u8, clock: &dyn Clock) -> Result<Found, MaintenanceError> {
        let protocol = ServoProtocol::Dynamixel1;
        let data = self.read_from(protocol, id, 0, 3, clock)?;
        let mut found = pinged(self.line.baud(), id, &data).ok_or_else(|| self.silent(id))?;
        found.protocol = protocol;
        Ok(found)
    }

    fn as_feetech(&mut self, id: u8, model: [u8; 2], clock: &dyn Clock) -> Result<Found, MaintenanceError> {
        let number = |order| decode(&model, order, Sign::None) as u16;
        let known = [ServoProtocol::Sts, ServoProtocol::Scs]
            .into_iter()
            .flat_map(|protocol| [(protocol, WordOrder::Little), (protocol, WordOrder::Big)])
            .find(|&(protocol, order)| {
                let model = self.model(protocol, number(order));
                model.is_some_and(|model| model.order == order)
            });
        let (protocol, order) = match known {
            Some(known) => known,
            None => self.family_by_end(id, clock)?,
        };
        if !self.protocols.contains(&protocol) {
            return Err(MaintenanceError::OtherProtocol { id, protocol });
        }
        let version = self.read_from(protocol, id, 0, 1, clock)?;
        Ok(Found {
            protocol,
            baud: self.line.baud(),
            id,
            model_number: number(order),
            firmware: version.first().copied().unwrap_or_default(),
        })
    }

    /// For a model nobody knows.
    fn family_by_end(
        &mut self,
        id: u8,
        clock: &dyn Clock,
    ) -> Result<(ServoProtocol, WordOrder), MaintenanceError> {
        let little = (ServoProtocol::Sts, WordOrder::Little);
        let big = (ServoProtocol::Scs, WordOrder::Big);
        if !self.protocols.contains(&big.0) {
            return Ok(little);
        }
        if !self.protocols.contains(&little.0) {
            return Ok(big);
        }
        match self.read_from(little.0, id, END_ADDRESS, 1, clock) {
            Ok(end) if end == [0] => Ok(little),
            Ok(_) | Err(MaintenanceError::Silent { .. } | MaintenanceError::Refused { .. }) => Ok(big),
            Err(error) => Err(error),
        }
    }

    /// The protocol in whose name packets of the frame of 1.0 are sent while it is not known whose they are.
    pub(super) fn summed(&self) -> ServoProtocol {
        let summed = self.protocols.iter().find(|&&protocol| !is_stuffed(protocol));
        summed.copied().unwrap_or(ServoProtocol::Dynamixel1)
    }

    /// The protocol of a servo; asks if it is not known.
    pub(super) fn protocol_of(
        &mut self,
        id: u8,
        clock: &dyn Clock,
    ) -> Result<ServoProtocol, MaintenanceError> {
        match (self.known(id), self.protocols.as_slice()) {
            (Some(known), _) => Ok(known.protocol),
            (None, &[only]) => Ok(only),
            (None, _) => Ok(self.ping(id, clock)?.protocol),
        }
    }

    pub(super) fn remember(&mut self, found: &Found) {
        self.known.retain(|known| known.id != found.id);
        let torque = match self.model(found.protocol, found.model_number) {
            Some(model) => model.torque,
            None => None,
        };
        self.known.push(Known {
            id: found.id,
            protocol: found.protocol,
            torque: torque.unwrap_or(match found.protocol {
                ServoProtocol::Dynamixel2 => super::TORQUE_OF_DYNAMIXEL2,
                ServoProtocol::Dynamixel1 => super::TORQUE_OF_DYNAMIXEL1,
                ServoProtocol::Sts | ServoProtocol::Scs => super::TORQUE_OF_FEETECH,
            }),
        });
    }

    fn known(&self, id: u8) -> Option<Known> {
        self.known.iter().find(|known| known.id == id).copied()
    }

    fn model(&self, protocol: ServoProtocol, number: u16) -> Option<Model> {
        let is_it = |model: &&Model| model.protocol == protocol && model.number == number;
        self.models.iter().find(is_it).copied()
    }
}

/// Model number and firmware as Dynamixels give them.
pub(super) fn pinged(baud: u32, id: u8, data: &[u8]) -> Option<Found> {
    let &[low, high, firmware] = data else { return None };
    Some(Found {
        protocol: ServoProtocol::Dynamixel2,
        baud,
        id,
        model_number: u16::from_le_bytes([low, high]),
        firmware,
    })
}
