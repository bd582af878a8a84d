use super::*;
use crate::codec::trial::{Trial, assert_cut_invariant, bytes, counted};
use proptest::prelude::*;

const SPECTRAGRAPHICS: Settings = Settings {
    maker: Maker::Spectragraphics,
    dials: 8,
};

fn hp(counts: Counts) -> Settings {
    Settings {
        maker: Maker::HewlettPackard { counts },
        dials: 8,
    }
}

fn dial(control: u16, delta_counts: i32) -> InputEvent {
    InputEvent::Dial {
        control,
        delta_counts,
    }
}

#[test]
fn a_box_is_there_once_its_line_is_open() {
    for (settings, sent) in [
        (SPECTRAGRAPHICS, vec![bytes(&[0x20, 0x50, 0x00, 0xFF])]),
        (hp(Counts::Moved), vec![]),
    ] {
        let mut trial = Trial::new(DialReports::new(settings));
        assert_eq!(trial.start(), sent);
        trial.after_ms(0);
        assert_eq!(trial.told(), [InputEvent::Started]);
        trial.start();
        trial.after_ms(0);
        assert_eq!(trial.told(), [InputEvent::Restarted]);
    }
}

#[test]
fn a_spectragraphics_dial_has_moved_by_a_difference() {
    let mut trial = Trial::new(DialReports::listening(SPECTRAGRAPHICS));
    let rows = [
        ([0x30, 5, 0], vec![dial(0, 5)]),
        ([0x37, 0, 5], vec![dial(7, -5)]),
        ([0x33, 255, 0], vec![dial(3, 255)]),
        ([0x33, 0, 255], vec![dial(3, -255)]),
        ([0x31, 9, 9], vec![]),
    ];
    for (report, want) in rows {
        assert_eq!(trial.said(&report), want, "{report:02X?}");
    }
}

#[test]
fn an_hp_dial_tells_moves_or_counts_that_wrap() {
    let mut trial = Trial::new(DialReports::listening(hp(Counts::Moved)));
    for (report, want) in [
        ([0x80, 0x00, 0x05], dial(0, 5)),
        ([0x87, 0xFF, 0xFB], dial(7, -5)),
        ([0x82, 0x7F, 0xFF], dial(2, 32_767)),
    ] {
        assert_eq!(trial.said(&report), [want], "{report:02X?}");
    }
    let mut trial = Trial::new(DialReports::listening(hp(Counts::Absolute)));
    assert_eq!(trial.said(&[0x81, 0x7F, 0xFE]), [], "it says where it stands");
    assert_eq!(trial.said(&[0x81, 0x80, 0x01]), [dial(1, 3)]);
    assert_eq!(trial.said(&[0x81, 0x7F, 0xFF]), [dial(1, -2)]);
}

#[test]
fn damage_is_counted_and_skipped() {
    let mut trial = Trial::new(DialReports::listening(SPECTRAGRAPHICS));
    assert_eq!(trial.said(&[0x38, 0x20, 0x30, 1, 0]), [dial(0, 1)]);
    assert_eq!(trial.codec.counters(), counted(1, 2, 0));
    trial.hear(&[0x30, 1]);
    trial.after_ms(101);
    assert_eq!(trial.said(&[0x31, 2, 0]), [dial(1, 2)]);
    assert_eq!(trial.codec.counters(), counted(2, 2, 1));
}

proptest! {
    #[test]
    fn cutting_the_stream_changes_nothing(stream in prop::collection::vec(any::<u8>(), 0..200), cut in 0_usize..200) {
        for settings in [SPECTRAGRAPHICS, hp(Counts::Moved), hp(Counts::Absolute)] {
            assert_cut_invariant(|| DialReports::listening(settings), &stream, cut);
        }
    }
}
