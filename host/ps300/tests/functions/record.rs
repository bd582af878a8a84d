//! Every function name of the record is known: it runs, or says why it does not.

use ps300::Machine;
use ps300::intrinsic::{self, ABSENT};
use ps300::language::Input;

/// `docs/protocols/ps300.md`, "Intrinsic functions": the names by section, C-forms written out.
const RECORD: &[&str] = &[
    "ACCUMULATE ADD ADDC SUB SUBC CSUB MUL MULC CMUL DIV DIVC CDIV MOD MODC AND ANDC OR ORC XOR XORC NOT AVERAGE",
    "ROUND CEILING FIX FLOAT SINCOS SQROOT",
    "EQ NE LT LE GT GE EQC NEC LTC LEC GTC GEC CLT CLE CGT CGE COMP_STRING",
    "CONSTANT NOP ROUTE ROUTEC CROUTE BROUTE BROUTEC CBROUTE BOOLEAN_CHOOSE INPUTS_CHOOSE RANGE_SELECT LIMIT",
    "DELTA SYNC PASSTHRU EDGE_DETECT SEND FETCH CHANGEQTYPE ATSCALE CHOP",
    "XVECTOR YVECTOR ZVECTOR XROTATE YROTATE ZROTATE DXROTATE DYROTATE DZROTATE SCALE DSCALE CROTATE CSCALE",
    "VEC VECC CVEC PARTS MATRIX2 MATRIX3 MATRIX4 LOOKAT LOOKFROM FOV WINDOW XFORMDATA",
    "PRINT LIST CONCATENATE CONCATENATEC CCONCATENATE SPLIT TAKE_STRING PUT_STRING FIND_STRING LENGTH_STRING",
    "TRANS_STRING MCAT_STRING GATHER_STRING STRING_TO_NUM CHARCONVERT CHARMASK LABEL LINEEDITOR",
    "CLCSECONDS CLFRAMES CLTICKS TIMEOUT",
    "PICK PICKINFO POSITION_LINE READDISK READSTREAM SCREENSAVE CIROUTE DEMUX",
];

#[test]
fn every_name_of_the_record_runs_or_says_why_not() {
    let names: Vec<&str> = RECORD.iter().flat_map(|line| line.split_whitespace()).collect();
    let absent = |name: &str| ABSENT.iter().find(|absent| absent.name == name);
    for name in &names {
        match (intrinsic::find(name), absent(name)) {
            (Some(_), None) => {}
            (None, Some(absent)) => assert!(!absent.why.is_empty(), "F:{name}"),
            (there, absent) => panic!("F:{name}: there {}, absent {}", there.is_some(), absent.is_some()),
        }
    }
    let present = names
        .iter()
        .filter(|name| intrinsic::find(name).is_some())
        .count();
    assert!(
        names.len() >= 110 && present >= 112,
        "{present} of {} run",
        names.len()
    );
    for spec in intrinsic::table() {
        let ours = spec.name.starts_with("DR_");
        assert_ne!(ours, names.contains(&spec.name), "F:{}", spec.name);
        assert_eq!(
            ours,
            spec.confidence == intrinsic::Confidence::Project,
            "F:{}",
            spec.name
        );
    }
}

/// What keeps messages keeps so many and says when it has no more room.
#[test]
fn what_keeps_messages_is_bounded() {
    for (set_up, kept, why) in [
        (
            "f := F:DR_DELAY; SEND 9 TO <2>f;",
            4096,
            "4096 messages wait already",
        ),
        (
            "f := F:DR_RECORDER; SEND TRUE TO <2>f;",
            16384,
            "16384 messages are kept already",
        ),
    ] {
        let mut machine = Machine::new();
        assert_eq!(machine.load(set_up), []);
        for number in 0..=kept {
            machine
                .send("f", Input::Number(1), f64::from(number))
                .expect("takes numbers");
            machine.settle();
            let reports: Vec<_> = machine.reports().iter().map(ToString::to_string).collect();
            let expected = number == kept;
            assert_eq!(reports.len(), usize::from(expected), "{set_up} {number}");
            assert!(reports.iter().all(|report| report.contains(why)), "{reports:?}");
        }
    }
}
