//! What cannot be built, and that nothing built can be misread.

use super::*;
use ServoProtocol::{Dynamixel1, Dynamixel2, Scs, Sts};
use proptest::prelude::*;

const ALL: [ServoProtocol; 4] = [Dynamixel2, Dynamixel1, Sts, Scs];

/// What came of building something, and why it should be refused.
type Refused = (Result<(), FramingError>, FramingError);

/// Each is refused so, and the caller's buffer is as it was.
fn check_refused<const ROWS: usize>(build: &dyn Fn(&mut Vec<u8>) -> [Refused; ROWS]) {
    let mut out = vec![1, 2, 3];
    for (got, want) in build(&mut out) {
        assert_eq!(got, Err(want));
    }
    assert_eq!(out, [1, 2, 3]);
}

#[test]
fn what_does_not_fit_is_refused_and_leaves_no_trace() {
    let wide = |what, value, protocol| FramingError::TooWide {
        what,
        value,
        protocol,
    };
    let long = |bytes| FramingError::TooLong { bytes };
    let no_id = |id, max| FramingError::NotAnId { id, max };
    check_refused(&|o| {
        [
            (dynamixel2::encode(o, 1, 3, &vec![0; 70_000]), long(70_000)),
            (dynamixel1::encode(o, 1, 3, &[0; 254]), long(254)),
            (read(Dynamixel2, o, 253, 0, 1), no_id(253, 252)),
            (read(Sts, o, 254, 0, 1), no_id(254, 253)),
            (reboot(Dynamixel2, o, BROADCAST_ID), no_id(254, 252)),
            (read(Dynamixel1, o, 1, 256, 1), wide("address", 256, Dynamixel1)),
            (sync_read(Sts, o, 1, 300, [1]), wide("length", 300, Sts)),
        ]
    });
    let width = |id, want, got| FramingError::Width { id, want, got };
    let twice = FramingError::Twice { id: 1 };
    check_refused(&|o| {
        [
            (
                bulk_read(Dynamixel1, o, [(1, 3, 1), (2, 256, 1)]),
                wide("address", 256, Dynamixel1),
            ),
            (bulk_read(Dynamixel2, o, [(1, 3, 1), (1, 4, 1)]), twice),
            (bulk_read(Dynamixel1, o, [(1, 3, 1), (1, 4, 1)]), twice),
            (bulk_write(Dynamixel2, o, [(1, 3, [1]), (1, 4, [1])]), twice),
            (
                sync_write(Dynamixel2, o, 3, [(1, vec![1]), (2, vec![1, 2])]),
                width(2, 1, 2),
            ),
            (sync_write(Scs, o, 3, [(1, vec![1]), (2, vec![])]), width(2, 1, 0)),
        ]
    });
}

#[test]
fn what_a_protocol_does_not_have_is_named() {
    use Instruction as I;
    let lacks = |protocol, instruction| FramingError::Lacks {
        protocol,
        instruction,
    };
    check_refused(&|o| {
        [
            (sync_read(Scs, o, 3, 1, [1]), lacks(Scs, I::SyncRead)),
            (
                sync_read(Dynamixel1, o, 3, 1, [1]),
                lacks(Dynamixel1, I::SyncRead),
            ),
            (fast_sync_read(Sts, o, 3, 1, [1]), lacks(Sts, I::FastSyncRead)),
            (
                fast_bulk_read(Dynamixel1, o, [(1, 1, 1)]),
                lacks(Dynamixel1, I::FastBulkRead),
            ),
            (bulk_read(Sts, o, [(1, 1, 1)]), lacks(Sts, I::BulkRead)),
            (bulk_write(Sts, o, [(1, 1, [1])]), lacks(Sts, I::BulkWrite)),
            (reboot(Dynamixel1, o, 1), lacks(Dynamixel1, I::Reboot)),
            (clear(Dynamixel1, o, 1), lacks(Dynamixel1, I::Clear)),
            (calibrate(Scs, o, 1), lacks(Scs, I::Calibrate)),
            (
                factory_reset(Sts, o, 1, Keep::Nothing),
                lacks(Sts, I::FactoryReset),
            ),
            (
                factory_reset(Dynamixel1, o, 1, Keep::Id),
                lacks(Dynamixel1, I::FactoryReset),
            ),
            (backup(Scs, o, 1, Backup::Restore), lacks(Scs, I::Backup)),
        ]
    });
    assert_eq!(
        lacks(Scs, I::SyncRead).to_string(),
        "Feetech SCS has no sync read"
    );
}

#[test]
fn instructions_of_feetech_have_the_codes_of_their_maker() {
    for (build, code) in [
        (
            feetech::recovery as fn(&mut Vec<u8>, u8) -> Result<(), FramingError>,
            0x06,
        ),
        (feetech::reboot, 0x08),
        (feetech::backup, 0x09),
        (feetech::reset, 0x0a),
        (feetech::calibrate, 0x0b),
    ] {
        let mut out = Vec::new();
        build(&mut out, 7).unwrap();
        assert_eq!(out, [0xff, 0xff, 7, 2, code, !(7 + 2 + code)]);
    }
}

/// Bytes that headers and stuffing are made of, in runs.
fn runs(most: usize) -> impl Strategy<Value = Vec<u8>> {
    let byte = prop_oneof![Just(0x00), Just(0x01), Just(0xfd), Just(0xfe), Just(0xff)];
    let run = (byte, 1_usize..6).prop_map(|(byte, count)| vec![byte; count]);
    proptest::collection::vec(run, 0..most).prop_map(|runs| runs.concat())
}

fn status_packet(protocol: ServoProtocol, id: u8, error: u8, data: &[u8]) -> Vec<u8> {
    let mut out = Vec::new();
    match protocol {
        Dynamixel2 => {
            dynamixel2::encode(&mut out, id, dynamixel2::STATUS, &[&[error], data].concat()).unwrap();
        }
        _ => dynamixel1::encode(&mut out, id, error, data).unwrap(),
    }
    out
}

/// Feeds `wire` in pieces and gives every answer.
fn statuses(decoder: &mut Decoder, wire: &[u8], pieces: &[usize]) -> Vec<(u8, u8, Vec<u8>)> {
    let mut got = Vec::new();
    let mut take = |heard: Heard<'_>| {
        if let Some(status) = heard.status() {
            got.push((status.id, status.error.raw(), status.data.to_vec()));
        }
    };
    let mut rest = wire;
    let mut sizes = pieces.iter().copied().cycle();
    while !rest.is_empty() {
        let (now, later) = rest.split_at(sizes.next().unwrap_or(1).min(rest.len()));
        decoder.push(now, &mut take);
        rest = later;
    }
    decoder.give_up(&mut take);
    got
}

proptest! {
    #[test]
    fn any_data_come_back_from_any_pieces(
        which in 0_usize..4,
        data in runs(20),
        id in 0_u8..=252,
        pieces in proptest::collection::vec(1_usize..20, 1..8),
    ) {
        let wire = status_packet(ALL[which], id, 0x21, &data);
        let mut decoder = Decoder::new(ALL[which]);
        prop_assert_eq!(statuses(&mut decoder, &wire, &pieces), [(id, 0x21, data)]);
        prop_assert_eq!(decoder.counters().skipped_bytes, 0);
    }

    /// In protocol 2.0, where garbage cannot make a packet but by a right CRC, every packet in it is found.
    #[test]
    fn stuffed_packets_in_garbage_are_found(
        noise in proptest::collection::vec(runs(6), 4),
        data in runs(10),
        pieces in proptest::collection::vec(1_usize..40, 1..8),
    ) {
        let mut wire = Vec::new();
        for (at, noise) in noise.iter().enumerate() {
            wire.extend_from_slice(noise);
            wire.extend(status_packet(Dynamixel2, at as u8 + 10, 0, &data));
        }
        let mut decoder = Decoder::new(Dynamixel2);
        let want: Vec<_> = (10..14).map(|id| (id, 0, data.clone())).collect();
        prop_assert_eq!(statuses(&mut decoder, &wire, &pieces), want);
    }

    /// The 8-bit sum lets one garbled packet in 256 through; but garbage before a packet costs no packet behind the
    /// first header, and what was not sent by anyone has a right sum at least.
    #[test]
    fn summed_packets_behind_garbage_are_found(
        which in 1_usize..4,
        noise in runs(6),
        data in proptest::collection::vec(0_u8..0xfe, 0..12),
        pieces in proptest::collection::vec(1_usize..40, 1..8),
    ) {
        let protocol = ALL[which];
        let mut wire = noise;
        // A header in the garbage may claim what comes next, once.
        wire.extend([0; 300]);
        for id in 20..24 {
            wire.extend(status_packet(protocol, id, 0, &data));
        }
        let mut decoder = Decoder::new(protocol);
        let got = statuses(&mut decoder, &wire, &pieces);
        let want: Vec<_> = (20..24).map(|id| (id, 0, data.clone())).collect();
        prop_assert!(got.ends_with(&want), "{:?}", got);
    }

    #[test]
    fn a_stuffed_body_never_holds_a_header(params in runs(20)) {
        let mut wire = Vec::new();
        dynamixel2::encode(&mut wire, 7, 0x03, &params).unwrap();
        let body = &wire[4..wire.len() - 2];
        prop_assert!(!body.windows(4).any(|bytes| bytes == dynamixel2::HEADER));
    }

    #[test]
    fn instructions_are_their_own_echo_in_any_pieces(
        which in 0_usize..4,
        data in runs(8),
        pieces in proptest::collection::vec(1_usize..20, 1..8),
    ) {
        let protocol = ALL[which];
        let mut sent = Vec::new();
        let items: Vec<(u8, Vec<u8>)> = (1..4).map(|id| (id, data.clone())).collect();
        sync_write(protocol, &mut sent, 30, items).unwrap();
        read(protocol, &mut sent, 3, 36, 2).unwrap();
        let mut decoder = Decoder::new(protocol);
        decoder.sent(&sent);
        let mut wire = sent.clone();
        wire.extend(status_packet(protocol, 3, 0, &[1, 2]));
        prop_assert_eq!(statuses(&mut decoder, &wire, &pieces), [(3, 0, vec![1, 2])]);
        prop_assert_eq!(decoder.counters().echoes, 2);
        prop_assert_eq!(decoder.counters().skipped_bytes, 0);
    }
}
