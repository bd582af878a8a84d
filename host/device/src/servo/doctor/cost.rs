//! What a control cycle takes on the wire, so that a finding can say what it costs.
//!
//! A cycle is one goal to and one position from every servo. Bytes after the protocols' packet formats: group
//! write and group read where the family has one, single reads elsewhere.

use super::facts::Seen;
use device_profiles::{Role, ServoProfile, ServoProtocol};

/// Bits on the wire for a byte.
const BITS_PER_BYTE: f64 = 10.0;
/// Overhead of a DYNAMIXEL 2.0 group instruction, and of a status.
const P2_GROUP_BYTES: usize = 14;
const P2_STATUS_BYTES: usize = 11;
/// What a fast read's common status and each servo's part of it cost beside the data.
const P2_FAST_BYTES: usize = 8;
const P2_FAST_PART_BYTES: usize = 4;
/// The same of DYNAMIXEL 1.0 and Feetech.
const P1_GROUP_BYTES: usize = 8;
const P1_STATUS_BYTES: usize = 6;
const P1_READ_BYTES: usize = 8;

/// One cycle of everybody on the line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Cycle {
    pub(super) secs: f64,
}

impl Cycle {
    /// As things are.
    pub(super) fn now(seen: &Seen) -> Self {
        Self::at(seen, seen.baud, &|_, delay_secs| delay_secs)
    }

    /// At another line speed, or with other return delays: `delay` gets an id and its delay as it is.
    pub(super) fn at(seen: &Seen, baud: u32, delay: &dyn Fn(u8, f64) -> f64) -> Self {
        let mut bytes = 0;
        let mut delays_secs = 0.0;
        for protocol in [
            ServoProtocol::Dynamixel2,
            ServoProtocol::Dynamixel1,
            ServoProtocol::Sts,
            ServoProtocol::Scs,
        ] {
            let group: Vec<(&ServoProfile, f64, bool)> = seen
                .patients
                .iter()
                .filter_map(|patient| {
                    let model = patient
                        .profile
                        .as_ref()
                        .filter(|model| model.protocol == protocol)?;
                    let own_secs = patient.get_si(Role::ReturnDelay).unwrap_or(0.0);
                    let fast = model
                        .fast_sync_read_from_firmware
                        .is_some_and(|from| patient.firmware >= from);
                    Some((model, delay(patient.id, own_secs), fast))
                })
                .collect();
            if group.is_empty() {
                continue;
            }
            let (its_bytes, waits_for_each) = bytes_of(protocol, &group);
            bytes += its_bytes;
            let delays = group.iter().map(|(_, delay_secs, _)| *delay_secs);
            delays_secs += if waits_for_each {
                delays.sum::<f64>()
            } else {
                delays.fold(0.0, f64::max)
            };
        }
        Self {
            secs: bytes as f64 * BITS_PER_BYTE / f64::from(baud.max(1)) + delays_secs,
        }
    }

    /// Longer by so much.
    pub(super) fn plus(self, secs: f64) -> Self {
        Self {
            secs: self.secs + secs,
        }
    }

    /// Cycles in a second; 0 for a line without servos.
    pub(super) fn hz(self) -> f64 {
        if self.secs > 0.0 { 1.0 / self.secs } else { 0.0 }
    }
}

/// Bytes of one cycle, and whether every servo's return delay counts.
fn bytes_of(protocol: ServoProtocol, group: &[(&ServoProfile, f64, bool)]) -> (usize, bool) {
    let count = group.len();
    let size = |role| -> usize {
        group
            .iter()
            .map(|(model, ..)| model.role(role).map_or(2, |row| usize::from(row.size)))
            .sum()
    };
    let (goals, positions) = (size(Role::GoalPosition), size(Role::PresentPosition));
    match protocol {
        ServoProtocol::Dynamixel2 if group.iter().all(|(_, _, fast)| *fast) => {
            let write = P2_GROUP_BYTES + count + goals;
            let read = P2_GROUP_BYTES + count + P2_FAST_BYTES + count * P2_FAST_PART_BYTES + positions;
            (write + read, false)
        }
        ServoProtocol::Dynamixel2 => {
            let write = P2_GROUP_BYTES + count + goals;
            let read = P2_GROUP_BYTES + count + count * P2_STATUS_BYTES + positions;
            (write + read, true)
        }
        ServoProtocol::Dynamixel1 | ServoProtocol::Sts | ServoProtocol::Scs => {
            let write = P1_GROUP_BYTES + count + goals;
            let read = if group.iter().all(|(model, ..)| model.sync_read) {
                P1_GROUP_BYTES + count + count * P1_STATUS_BYTES + positions
            } else {
                count * (P1_READ_BYTES + P1_STATUS_BYTES) + positions
            };
            (write + read, true)
        }
    }
}

/// `0.50 ms`.
pub(super) fn ms(secs: f64) -> String {
    format!("{:.2} ms", secs * 1e3)
}

/// `69 Hz`.
pub(super) fn hz(cycle: Cycle) -> String {
    let hz = cycle.hz();
    if hz < 10.0 {
        format!("{hz:.1} Hz")
    } else {
        format!("{hz:.0} Hz")
    }
}
