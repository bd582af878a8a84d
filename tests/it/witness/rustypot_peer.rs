//! `rustypot` 1.13.1 on the simulated bus. Where it is known to be wrong, that is asserted as it is.

use super::{
    BAUD, GOAL_POSITION, INDIRECT_DATA, LED, MODEL, PRESENT_POSITION, PWM_LIMIT, TORQUE_ENABLE, in_time,
    inject, patiently, register, served,
};
use dialrig_tests::simulated::Served;
use firmware_sim::ServoBus;
use firmware_sim::servo_bus::{Absent, BusOptions};
use rustypot::{DynamixelProtocolHandler, SyncReadError};
use serialport::SerialPort;
use std::time::Duration;

struct Peer {
    protocol: DynamixelProtocolHandler,
    port: Box<dyn SerialPort>,
}

type Answer<T> = Result<T, Box<dyn std::error::Error>>;

impl Peer {
    fn open(served: &Served<ServoBus>, timeout_ms: u64) -> Self {
        let port = serialport::new(served.path_text(), BAUD)
            .timeout(Duration::from_millis(timeout_ms))
            .open();
        Self {
            protocol: DynamixelProtocolHandler::v2(),
            port: port.expect("the terminal opens"),
        }
    }

    fn ping(&mut self, id: u8) -> Answer<bool> {
        self.protocol.ping(self.port.as_mut(), id)
    }

    fn read(&mut self, id: u8, address: u8, length: u8) -> Answer<Vec<u8>> {
        self.protocol.read(self.port.as_mut(), id, address, length)
    }

    fn write(&mut self, id: u8, address: u8, data: &[u8]) -> Answer<()> {
        self.protocol.write(self.port.as_mut(), id, address, data)
    }

    fn sync_read(&mut self, ids: &[u8], address: u8, length: u8) -> Answer<Vec<Vec<u8>>> {
        self.protocol.sync_read(self.port.as_mut(), ids, address, length)
    }

    fn positions(&mut self, ids: &[u8]) -> Answer<Vec<u32>> {
        let read = self.sync_read(ids, PRESENT_POSITION, 4)?;
        let counts = read
            .iter()
            .map(|data| Ok(u32::from_le_bytes(data.as_slice().try_into()?)));
        counts.collect()
    }
}

#[test]
fn it_finds_reads_writes_and_moves_servos() {
    let served = served(4, &[], BusOptions::default());
    let mut peer = Peer::open(&served, 200);
    assert!(patiently("ping", || peer.ping(2)));
    let found = patiently("broadcast ping", || {
        let ids = peer
            .protocol
            .broadcast_ping(peer.port.as_mut())
            .map_err(|error| error.to_string())?;
        if ids.len() == 4 {
            Ok(ids)
        } else {
            Err(format!("{ids:?}"))
        }
    });
    assert_eq!(found, [1, 2, 3, 4]);
    let model = patiently("read", || peer.read(1, 0, 2));
    assert_eq!(model, MODEL.to_le_bytes());
    patiently("write", || peer.write(3, LED, &[1]));
    assert_eq!(register(&served, 3, "LED"), 1);

    let ids = [1, 2, 3, 4];
    for id in ids {
        patiently("torque", || peer.write(id, TORQUE_ENABLE, &[1]));
    }
    let goals = [2000_u32, 2010, 2100, 2040];
    let bytes = goals.map(|goal| goal.to_le_bytes().to_vec());
    let write = |peer: &mut Peer| {
        peer.protocol
            .sync_write(peer.port.as_mut(), &ids, GOAL_POSITION, &bytes)
    };
    patiently("sync write", || write(&mut peer));
    in_time("the servos are where they were sent", || {
        patiently("sync read", || peer.positions(&ids)) == goals
    });
    // One packet for all: firmware 45 and later.
    peer.protocol = DynamixelProtocolHandler::v2().with_fast_sync_read();
    assert_eq!(patiently("fast sync read", || peer.positions(&ids)), goals);
}

#[test]
fn it_stuffs_both_ways_whatever_the_bytes() {
    let served = served(1, &[], BusOptions::default());
    let mut peer = Peer::open(&served, 200);
    for bytes in [
        [0xFF, 0xFF, 0xFD, 0xFD, 0x00, 0xFF],
        [0xFF, 0xFF, 0xFF, 0xFD, 0xFD, 0x77],
        [0xFF, 0xFF, 0xFD, 0x00, 0xFF, 0xFF],
        [0xFD, 0xFF, 0xFF, 0xFF, 0xFF, 0xFD],
    ] {
        patiently("write", || peer.write(1, INDIRECT_DATA, &bytes));
        for (at, byte) in (INDIRECT_DATA..).zip(bytes) {
            // One byte is never stuffed.
            assert_eq!(patiently("one byte", || peer.read(1, at, 1)), [byte]);
        }
        assert_eq!(patiently("read", || peer.read(1, INDIRECT_DATA, 6)), bytes);
    }
}

/// Known gap: the error of a status packet is dropped, so a write that the servo refused is `Ok`.
#[test]
fn a_refused_write_is_well_for_it() {
    let served = served(1, &[], BusOptions::default());
    let mut peer = Peer::open(&served, 200);
    patiently("the write", || peer.write(1, PRESENT_POSITION, &[5, 0, 0, 0]));
    let refused = served.with(|bus, _| bus.servo(1).expect("it is there").counters().refused_writes);
    assert!(refused >= 1, "the servo did refuse");
    let error = patiently("the error byte", || {
        let port = peer.port.as_mut();
        peer.protocol
            .write_with_error(port, 1, PRESENT_POSITION, &[5, 0, 0, 0])
    });
    assert_eq!(error.v2_instruction_error(), 7);
}

/// Known gap: a sync read is an error as a whole when one servo is missing; what the others said is dropped. It
/// does name the servo. Our bus keeps the others.
#[test]
fn one_absent_servo_costs_it_the_whole_read() {
    let options = BusOptions {
        absent: Absent::GoOnAfter(200),
        ..BusOptions::default()
    };
    let served = served(4, &[2], options);
    let mut peer = Peer::open(&served, 60);
    let blamed = patiently("the blame", || match peer.positions(&[1, 2, 3, 4]) {
        Err(error) => match error.downcast_ref::<SyncReadError>() {
            Some(error) if error.id == 2 => Ok(2),
            _ => Err(error.to_string()),
        },
        Ok(read) => Err(format!("it read {read:?}")),
    });
    assert_eq!(blamed, 2);
    drop(peer);
    assert_eq!(
        super::hands::readings(&served, 4, &[1, 3, 4]),
        [1, 3, 4],
        "our bus"
    );
}

/// Known gap: no resynchronisation, so its own instruction heard back is an error.
#[test]
fn an_echo_makes_it_fail() {
    let served = served(
        1,
        &[],
        BusOptions {
            echo: true,
            ..BusOptions::default()
        },
    );
    let mut peer = Peer::open(&served, 60);
    let read = peer.read(1, 0, 2);
    assert!(read.is_err(), "it is mended: {read:?}");
}

/// Known fault, as with every library tried: after an answer that comes late, the next question gets the answer to
/// the one before.
#[test]
fn a_late_answer_is_taken_for_the_next_one_s() {
    let served = served(1, &[], BusOptions::default());
    let mut peer = Peer::open(&served, 30);
    let wrong = patiently("a stale value", || {
        inject(&served, "stall for 50ms");
        let first = peer.read(1, 0, 2);
        let second = peer.read(1, PWM_LIMIT, 2);
        match (first, second) {
            (Err(_), Ok(answer)) if answer == MODEL.to_le_bytes() => Ok(answer),
            other => Err(format!("{other:?}")),
        }
    });
    assert_eq!(
        (wrong.as_slice(), register(&served, 1, "PWM Limit")),
        (&MODEL.to_le_bytes()[..], 885)
    );
}
