//! One packet builder for each instruction, for whichever protocol a servo speaks.

use super::error::FramingError;
use super::instruction::{Backup, Instruction, Keep, code};
use super::summed::narrow;
use super::{dynamixel1, dynamixel2, feetech};
use device_profiles::ServoProtocol::{self, Dynamixel1, Dynamixel2, Scs, Sts};

type Built = Result<(), FramingError>;

/// Appends a ping. By broadcast all answer in turn in protocol 2.0 and on STS; elsewhere at once, over each other.
pub fn ping(protocol: ServoProtocol, out: &mut Vec<u8>, id: u8) -> Built {
    match protocol {
        Dynamixel2 => dynamixel2::ping(out, id),
        Dynamixel1 | Sts | Scs => dynamixel1::ping(out, id),
    }
}

/// Appends a read of `length` bytes from `address`.
pub fn read(protocol: ServoProtocol, out: &mut Vec<u8>, id: u8, address: u16, length: u16) -> Built {
    match protocol {
        Dynamixel2 => dynamixel2::read(out, id, address, length),
        Dynamixel1 | Sts | Scs => {
            let address = narrow(protocol, "address", address)?;
            dynamixel1::read(out, id, address, narrow(protocol, "length", length)?)
        }
    }
}

/// Appends a write of `bytes` at `address`. A broadcast is obeyed by all and answered by none.
pub fn write(protocol: ServoProtocol, out: &mut Vec<u8>, id: u8, address: u16, bytes: &[u8]) -> Built {
    match protocol {
        Dynamixel2 => dynamixel2::write(out, id, address, bytes),
        Dynamixel1 | Sts | Scs => dynamixel1::write(out, id, narrow(protocol, "address", address)?, bytes),
    }
}

/// Appends a write that waits for [`action`].
pub fn reg_write(protocol: ServoProtocol, out: &mut Vec<u8>, id: u8, address: u16, bytes: &[u8]) -> Built {
    match protocol {
        Dynamixel2 => dynamixel2::reg_write(out, id, address, bytes),
        Dynamixel1 | Sts | Scs => {
            dynamixel1::reg_write(out, id, narrow(protocol, "address", address)?, bytes)
        }
    }
}

/// Appends what sets off registered writes.
pub fn action(protocol: ServoProtocol, out: &mut Vec<u8>, id: u8) -> Built {
    match protocol {
        Dynamixel2 => dynamixel2::action(out, id),
        Dynamixel1 | Sts | Scs => dynamixel1::action(out, id),
    }
}

/// Appends a factory reset. No protocol but 2.0 lets one choose what is kept: 1.0 keeps nothing, Feetech the id.
pub fn factory_reset(protocol: ServoProtocol, out: &mut Vec<u8>, id: u8, keep: Keep) -> Built {
    match (protocol, keep) {
        (Dynamixel2, _) => dynamixel2::factory_reset(out, id, keep),
        (Dynamixel1, Keep::Nothing) => dynamixel1::factory_reset(out, id),
        (Sts | Scs, Keep::Id) => feetech::recovery(out, id),
        _ => lacks(protocol, Instruction::FactoryReset),
    }
}

/// Appends a reboot. A Dynamixel comes back with torque off and RAM registers at their start values.
pub fn reboot(protocol: ServoProtocol, out: &mut Vec<u8>, id: u8) -> Built {
    match protocol {
        Dynamixel2 => dynamixel2::reboot(out, id),
        Sts | Scs => feetech::reboot(out, id),
        Dynamixel1 => lacks(protocol, Instruction::Reboot),
    }
}

/// Appends what forgets the turns counted.
pub fn clear(protocol: ServoProtocol, out: &mut Vec<u8>, id: u8) -> Built {
    match protocol {
        Dynamixel2 => dynamixel2::clear_turns(out, id),
        Sts | Scs => feetech::reset(out, id),
        Dynamixel1 => lacks(protocol, Instruction::Clear),
    }
}

/// Appends what copies the control table, or brings the copy back.
pub fn backup(protocol: ServoProtocol, out: &mut Vec<u8>, id: u8, way: Backup) -> Built {
    match (protocol, way) {
        (Dynamixel2, _) => dynamixel2::backup(out, id, way),
        (Sts | Scs, Backup::Store) => feetech::backup(out, id),
        _ => lacks(protocol, Instruction::Backup),
    }
}

/// Appends what makes the present position the middle.
pub fn calibrate(protocol: ServoProtocol, out: &mut Vec<u8>, id: u8) -> Built {
    code(protocol, Instruction::Calibrate)?;
    feetech::calibrate(out, id)
}

/// Appends a read of the same block from each of `ids`, who answer in this order.
pub fn sync_read(
    protocol: ServoProtocol,
    out: &mut Vec<u8>,
    address: u16,
    length: u16,
    ids: impl IntoIterator<Item = u8>,
) -> Built {
    code(protocol, Instruction::SyncRead)?;
    if protocol == Dynamixel2 {
        return dynamixel2::sync_read(out, address, length, ids);
    }
    let address = narrow(protocol, "address", address)?;
    feetech::sync_read(out, address, narrow(protocol, "length", length)?, ids)
}

/// Appends a write of the same block to each servo named; the first one's bytes give the width for all.
pub fn sync_write<Bytes: AsRef<[u8]>>(
    protocol: ServoProtocol,
    out: &mut Vec<u8>,
    address: u16,
    items: impl IntoIterator<Item = (u8, Bytes)>,
) -> Built {
    match protocol {
        Dynamixel2 => dynamixel2::sync_write(out, address, items),
        Dynamixel1 | Sts | Scs => dynamixel1::sync_write(out, narrow(protocol, "address", address)?, items),
    }
}

/// Appends a sync read that is answered in a single packet.
pub fn fast_sync_read(
    protocol: ServoProtocol,
    out: &mut Vec<u8>,
    address: u16,
    length: u16,
    ids: impl IntoIterator<Item = u8>,
) -> Built {
    code(protocol, Instruction::FastSyncRead)?;
    dynamixel2::fast_sync_read(out, address, length, ids)
}

/// Appends a read of a block of its own from each servo: id, address, length.
pub fn bulk_read(
    protocol: ServoProtocol,
    out: &mut Vec<u8>,
    items: impl IntoIterator<Item = (u8, u16, u16)>,
) -> Built {
    code(protocol, Instruction::BulkRead)?;
    if protocol == Dynamixel2 {
        return dynamixel2::bulk_read(out, items);
    }
    // The first that does not fit ends the list, and the whole packet with it.
    let start = out.len();
    let mut wide = None;
    let items = items.into_iter().map_while(|(id, address, length)| {
        let narrowed = narrow(protocol, "address", address)
            .and_then(|address| Ok((id, address, narrow(protocol, "length", length)?)));
        narrowed.map_err(|error| wide = Some(error)).ok()
    });
    dynamixel1::bulk_read(out, items)?;
    wide.map_or(Ok(()), |error| {
        out.truncate(start);
        Err(error)
    })
}

/// Appends a bulk read that is answered in a single packet.
pub fn fast_bulk_read(
    protocol: ServoProtocol,
    out: &mut Vec<u8>,
    items: impl IntoIterator<Item = (u8, u16, u16)>,
) -> Built {
    code(protocol, Instruction::FastBulkRead)?;
    dynamixel2::fast_bulk_read(out, items)
}

/// Appends a write of a block of its own to each servo: id, address, bytes.
pub fn bulk_write<Bytes: AsRef<[u8]>>(
    protocol: ServoProtocol,
    out: &mut Vec<u8>,
    items: impl IntoIterator<Item = (u8, u16, Bytes)>,
) -> Built {
    code(protocol, Instruction::BulkWrite)?;
    dynamixel2::bulk_write(out, items)
}

fn lacks(protocol: ServoProtocol, instruction: Instruction) -> Built {
    Err(FramingError::Lacks {
        protocol,
        instruction,
    })
}
