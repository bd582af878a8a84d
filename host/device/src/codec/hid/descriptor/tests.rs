use super::*;

/// A pen as Microsoft's sample has it, with an array of keys behind.
const PEN: &[u8] = &[
    0x05, 0x0D, 0x09, 0x02, 0xA1, 0x01, 0x85, 0x07, 0x09, 0x20, 0xA1, 0x00, // pen, report 7, stylus
    0x09, 0x42, 0x09, 0x44, 0x09, 0x3C, 0x09, 0x45, 0x15, 0x00, 0x25, 0x01, 0x75, 0x01, 0x95, 0x04, 0x81,
    0x02, 0x95, 0x01, 0x81, 0x03, 0x09, 0x32, 0x81, 0x02, 0x95, 0x02, 0x81,
    0x03, // padding, in range, padding
    0x05, 0x01, 0x09, 0x30, 0x75, 0x10, 0x95, 0x01, 0xA4, 0x55, 0x0D, 0x65, 0x13, 0x35, 0x00, 0x46, 0x3A,
    0x20, 0x26, 0xF8, 0x52, 0x81, 0x02, 0x09, 0x31, 0x46, 0x2C, 0x18, 0x26, 0x6C, 0x3E, 0x81, 0x02,
    0xB4, // x, y
    0x05, 0x0D, 0x09, 0x30, 0x26, 0xFF, 0x00, 0x81, 0x02, // pressure
    0xC0, 0xC0,
];

#[test]
fn a_pen_is_taken_apart() {
    let descriptor = Descriptor::parse(PEN).expect("a real one");
    assert!(descriptor.numbered);
    assert_eq!(descriptor.report_bytes(Direction::Input, 7), Some(8));
    let rows: Vec<_> = descriptor
        .fields
        .iter()
        .map(|f| (f.usage().page, f.usage().id, f.bit, f.width, f.logical[1]))
        .collect();
    assert_eq!(
        rows,
        [
            (0x0D, 0x42, 0, 1, 1),
            (0x0D, 0x44, 1, 1, 1),
            (0x0D, 0x3C, 2, 1, 1),
            (0x0D, 0x45, 3, 1, 1),
            (0x0D, 0x32, 5, 1, 1),
            (0x01, 0x30, 8, 16, 21_240),
            (0x01, 0x31, 24, 16, 15_980),
            (0x0D, 0x30, 40, 16, 255),
        ]
    );
    let x = &descriptor.fields[5];
    // 8.250 inches of 21240 counts.
    assert!((x.counts_per_unit().expect("inches") * 25.4 - 21_240.0 / 8.25).abs() < 1e-6);
    assert_eq!(descriptor.application(x), Some(Usage::new(0x0D, 0x02)));
    // Popped: the pressure has no unit.
    assert_eq!(descriptor.fields[7].unit.kind(), UnitKind::Other);
}

#[test]
fn usages_come_as_ranges_long_words_and_choices() {
    type Row<'a> = (&'a [u8], &'a [(u16, u16)]);
    let rows: [Row<'_>; 7] = [
        (&[0x05, 0x09, 0x19, 0x01, 0x29, 0x03], &[(9, 1), (9, 2), (9, 3)]),
        // Too few: the last one is for all that are left.
        (
            &[0x05, 0x01, 0x09, 0x30, 0x09, 0x31],
            &[(1, 0x30), (1, 0x31), (1, 0x31)],
        ),
        // The page is the one in force at the main item, but not for four bytes.
        (
            &[0x09, 0x30, 0x0B, 0x42, 0x00, 0x0D, 0x00, 0x09, 0x31, 0x05, 0x01],
            &[(1, 0x30), (0x0D, 0x42), (1, 0x31)],
        ),
        // Of a delimited set the first.
        (
            &[
                0x05, 0x01, 0xA9, 0x01, 0x09, 0x30, 0x09, 0x36, 0xA9, 0x00, 0x09, 0x31, 0x09, 0x32,
            ],
            &[(1, 0x30), (1, 0x31), (1, 0x32)],
        ),
        (
            &[
                0x1B, 0x01, 0x00, 0x09, 0x00, 0x29, 0x02, 0x0B, 0x05, 0x00, 0x09, 0x00,
            ],
            &[(9, 1), (9, 2), (9, 5)],
        ),
        // A maximum on another page ends with the minimum's.
        (
            &[0x05, 0x09, 0x19, 0x01, 0x2B, 0x00, 0x00, 0x00, 0x05],
            &[(9, 1), (9, 2), (9, 3)],
        ),
        (
            &[0x1B, 0xFE, 0xFF, 0x09, 0x00, 0x2B, 0x01, 0x00, 0x0A, 0x00],
            &[(9, 0xFFFE), (9, 0xFFFF), (9, 0xFFFF)],
        ),
    ];
    for (locals, want) in rows {
        let head = [
            0x05, 0x01, 0x09, 0x05, 0xA1, 0x01, 0x25, 0x01, 0x75, 0x01, 0x95, 0x03,
        ];
        let bytes = [&head[..], locals, &[0x81, 0x02, 0xC0]].concat();
        let descriptor = Descriptor::parse(&bytes).expect("legal");
        let got: Vec<_> = descriptor
            .fields
            .iter()
            .map(|f| (f.usage().page, f.usage().id))
            .collect();
        assert_eq!(got, want, "{locals:02X?}");
    }
}

#[test]
fn what_lies_is_refused_with_its_place() {
    let long_report = [0x75, 0xFF, 0x96, 0xFF, 0xFF, 0x81, 0x03];
    let pushes = [0xA4; 80];
    let collections = [0xA1, 0x01].repeat(70);
    let rows: [(&[u8], usize, &str); 14] = [
        (&[0x05], 0, "an item of 2 bytes begins here"),
        (&[0x05, 0x01, 0x27, 1, 2, 3], 2, "an item of 5 bytes begins here"),
        (&[0xFE, 0x05, 0x10, 1], 0, "an item of 8 bytes begins here"),
        (&[0xC0], 0, "never begun"),
        (&[0xA1, 0x01], 2, "1 collections still open"),
        (&[0xB4], 0, "Pop without Push"),
        (&pushes, 64, "more than 64 pushes"),
        (&collections, 128, "more than 64 collections"),
        (&[0x85, 0x00], 0, "report id of 1 to 255, found 0"),
        (&[0x86, 0x00, 0x01], 0, "report id of 1 to 255, found 256"),
        (
            &[0x75, 0x08, 0x95, 0x01, 0x81, 0x03, 0x85, 0x01],
            6,
            "after fields without one",
        ),
        (&long_report, 5, "more than 16384 bytes hold"),
        (&[0xA9, 0x00], 0, "a delimiter is closed here"),
        (
            &[
                0x15, 0x05, 0x25, 0x01, 0x75, 0x08, 0x95, 0x01, 0x09, 0x30, 0x81, 0x02,
            ],
            10,
            "the logical range falls from 5 to 1",
        ),
    ];
    for (bytes, at, why) in rows {
        let error = Descriptor::parse(bytes).expect_err(why);
        assert_eq!(error.at, at, "{error}");
        assert!(error.to_string().contains(why), "{error}");
    }
    let endless = Descriptor::parse(&vec![0x05; 70_000]).expect_err("too long");
    assert!(endless.to_string().contains("at most 65535 bytes, found 70000"));
}

/// 64 KiB of the most expensive items there are: a number of fields, not of minutes.
#[test]
fn size_is_bounded() {
    let mut bytes = vec![0x05, 0x09, 0x75, 0x01, 0x96, 0xFF, 0x0F, 0x25, 0x01];
    while bytes.len() < DESCRIPTOR_BYTES_MAX - 8 {
        bytes.extend([0x19, 0x00, 0x2A, 0xFF, 0xFF, 0x81, 0x02]);
    }
    let error = Descriptor::parse(&bytes).expect_err("too many");
    assert_eq!(error.fault, DescriptorFault::TooManyFields { most: FIELDS_MAX });
}

#[test]
fn long_items_and_reserved_ones_are_passed_over() {
    let bytes = [
        0xFE, 0x02, 0xF0, 1, 2, 0x0F, 1, 2, 3, 4, 0x05, 0x01, 0x09, 0x36, 0xA1, 0x01, 0x09, 0x36, 0x26, 0xFF,
        0x03, 0x75, 0x0A, 0x95, 0x01, 0x81, 0x02, 0xC0,
    ];
    let descriptor = Descriptor::parse(&bytes).expect("legal");
    assert_eq!(descriptor.fields.len(), 1);
    assert_eq!(descriptor.report_bytes(Direction::Input, 0), Some(2));
}
