//! `dialrig net`.

use crate::{ANY, call, check, fed};

const TURN: &[u8] = b"turn := F:MULC;
SEND 180 TO <2>turn;
CONNECT DIALS<1>:<1>turn;
SEND 'Turn' TO <1>DLABEL1;
";

#[test]
fn networks_run_in_virtual_time() {
    check(
        &[
            ("turn.ps300", TURN),
            ("clock.ps300", b"tick := F:CLFRAMES; SEND FIX(30) TO <1>tick;"),
            (
                "kinds.ps300",
                b"z := F:ZROTATE; l := F:LOOKAT; v := F:XVECTOR; a := F:ADDC; SEND FIX(1) TO <2>a;",
            ),
            (
                "kinds.txt",
                b"# every shape of value\nat 0 SEND 90 TO <1>z;\nat 0 SEND 2 TO <1>v;\nat 0.25 SEND FIX(4) TO <1>a;\n",
            ),
            ("late.txt", b"at 0 later := F:NOP;\nat 1 SEND TRUE TO <1>later;\n"),
        ],
        &[
            call(
                "net run turn.ps300 --dial 1:0.25@0.505 --watch turn<1> --watch dlabel1<1>",
                0,
                &[
                    r#"{"t":0.0,"from":"DLABEL1<1>","kind":"string","value":"Turn"}"#,
                    r#"{"t":0.505,"from":"turn<1>","kind":"real","value":45.0}"#,
                ],
                &[],
            ),
            call(
                "net run clock.ps300 --until 1 --watch tick<1> --watch tick<2>",
                0,
                &[
                    r#"{"t":0.5,"from":"tick<1>","kind":"integer","value":0}"#,
                    r#"{"t":0.5,"from":"tick<2>","kind":"boolean","value":true}"#,
                    r#"{"t":1.0,"from":"tick<1>","kind":"integer","value":1}"#,
                ],
                &[],
            ),
            call("net run clock.ps300 --watch tick<1>", 0, &[], &[]),
            call(
                "net run kinds.ps300 --events kinds.txt --watch z<1> --watch v<1> --watch a<1>",
                0,
                &[
                    r#""from":"z<1>","kind":"matrix3","value":[["#,
                    r#""from":"v<1>","kind":"vector3","value":[2.0,0.0,0.0]"#,
                    r#"{"t":0.25,"from":"a<1>","kind":"integer","value":5}"#,
                ],
                &[],
            ),
            call(
                "net run turn.ps300 --events late.txt --watch later<1>",
                0,
                &[r#"{"t":1.0,"from":"later<1>","kind":"boolean","value":true}"#],
                &[],
            ),
            call(
                "net run turn.ps300 --events late.txt --until 0.5 --watch later<1>",
                0,
                &[],
                &["1 events come after 0.5 s"],
            ),
            call(
                "net run networks/figure.ps300 --dial 1:0.25@0.5 --watch VIEW<1>",
                0,
                &[r#"{"t":0.5,"from":"VIEW<1>","kind":"real","value":45.0}"#],
                &[],
            ),
        ],
    );
}

#[test]
fn devices_send_what_hands_do() {
    check(
        &[
            (
                "keys.ps300",
                b"all := F:NOP; CONNECT DIALS<8>:<1>all; CONNECT FKEYS<1>:<1>all; CONNECT TABLETIN<1>:<1>all;
                  CONNECT KEYBOARD<1>:<1>all;",
            ),
            (
                "pen.txt",
                b"at 0.5 EMIT V2D(0.5,-0.25) FROM TABLETIN<1>;\nat 0.5 emit ' from ' from keyboard<1>",
            ),
        ],
        &[
            // A device has no input; what it sends is emitted. At one time dials come first, then keys, then events.
            call(
                "net run keys.ps300 --events pen.txt --key 36@0.5 --dial 8:-1@0.5 --watch all<1>",
                0,
                &[
                    r#"{"t":0.5,"from":"all<1>","kind":"real","value":-1.0}"#,
                    r#"{"t":0.5,"from":"all<1>","kind":"integer","value":36}"#,
                    r#"{"t":0.5,"from":"all<1>","kind":"vector2","value":[0.5,-0.25]}"#,
                    r#"{"t":0.5,"from":"all<1>","kind":"string","value":" from "}"#,
                ],
                &[],
            ),
        ],
    );
}

#[test]
fn what_is_lost_while_running_is_told_and_no_failure() {
    check(
        &[
            ("turn.ps300", TURN),
            (
                "lossy.ps300",
                b"a := F:ADDC; SEND 1 TO <2>a;\nSEND 'x' TO <1>a; SEND 2 TO <1>a;",
            ),
            (
                "wrong.txt",
                b"at 0.5 SEND 'x' TO <1>turn;\nat 0.6 SEND 1 TO <1>turn;",
            ),
            (
                "nobody.txt",
                b"at 0.5 EMIT 1 FROM NOBODY<1>;\nat 0.6 EMIT 1 FROM DIALS<1>;",
            ),
        ],
        &[
            call(
                "net run lossy.ps300 --watch a<1>",
                0,
                &[r#""from":"a<1>","kind":"real","value":3.0"#],
                &["lossy.ps300:2:1: warning: input <1> of a takes ", "not string"],
            ),
            call(
                "net run turn.ps300 --events wrong.txt --watch turn<1>",
                0,
                &[r#"{"t":0.6,"from":"turn<1>","kind":"real","value":180.0}"#],
                &["wrong.txt:1:8: warning: input <1> of turn takes ", "not string"],
            ),
            call(
                "net run turn.ps300 --events nobody.txt --watch turn<1>",
                0,
                &[r#"{"t":0.6,"from":"turn<1>","kind":"real","value":180.0}"#],
                &["nobody.txt:1:8: warning: there is no output NOBODY<1>"],
            ),
            fed(
                "net run - --until 0.1",
                "a := F:NOP; b := F:NOP; CONNECT a<1>:<1>b; CONNECT b<1>:<1>a; SEND 1 TO <1>a;",
                0,
                &[],
                &["report: from 0 s: ", "did not come to rest", "times)"],
            ),
            fed(
                "net run - --json",
                "r := F:ROUTE(2); SEND FIX(7) TO <1>r; SEND 1 TO <2>r;",
                0,
                &[],
                &[
                    r#"{"report":"r (F:ROUTE"#,
                    r#""name":"r","#,
                    r#""count":1,"t":0.0}"#,
                ],
            ),
        ],
    );
}

#[test]
fn networks_that_cannot_run_are_refused() {
    check(
        &[
            ("turn.ps300", TURN),
            ("bad.ps300", b"a := F:NOSUCH;\nCONNECT a<1>:<1>b;\nSEND TO b;\n"),
            (
                "bad.txt",
                b"at 1 SEND 1 TO <1>turn;\nat 0.5 SEND 1 TO <1>turn;\nSEND 1;\nat 2 SEND 1 TA <1>turn;",
            ),
            ("folder/inside", b""),
        ],
        &[
            call(
                "net run bad.ps300",
                1,
                &[],
                &["bad.ps300:1:1: error: ", "F:NOSUCH", "bad.ps300:3:"],
            ),
            call("net run nowhere.ps300", 1, &[], &["nowhere.ps300:1:1: error: "]),
            call("net run folder", 1, &[], &["folder:1:1: error: this is a folder"]),
            call(
                "net run turn.ps300 --watch tirn<1>",
                1,
                &[],
                &["error: there is no output tirn<1>", "hint:"],
            ),
            call(
                "net run turn.ps300 --watch turn<2>",
                1,
                &[],
                &["error: there is no output turn<2>", "<1> only"],
            ),
            call(
                "net run turn.ps300 --watch VIEW<9>",
                1,
                &[],
                &["error: there is no output VIEW<9>"],
            ),
            call(
                "net run turn.ps300 --events bad.txt",
                1,
                &[],
                &[
                    "bad.txt:2:4: error: ",
                    "bad.txt:3:1: error: expected `at SECS COMMAND;`",
                    "bad.txt:4:",
                ],
            ),
            call("net check turn.ps300", 0, &[], &["in order"]),
            call("net check bad.ps300", 1, &[], &["bad.ps300:1:1: error: "]),
            call(
                "net check bad.ps300 --json",
                1,
                &[r#"{"error":"#, r#""file":"bad.ps300","line":1"#],
                &[],
            ),
            call("net dot bad.ps300", 1, &[], &["bad.ps300:1:1: error: "]),
            call("net print bad.ps300", 1, &[], &["bad.ps300:3:"]),
            call(
                "net functions NOSUCH",
                1,
                &[],
                &["error: there is no function F:NOSUCH", "hint:"],
            ),
        ],
    );
}

#[test]
fn networks_are_printed_drawn_and_looked_up() {
    check(
        &[("turn.ps300", TURN)],
        &[
            fed(
                "net print -",
                "a:=f:addc;conn a<1>:<2>b{x};send fix(1) to <1>a;",
                0,
                &["a := F:addc;\nCONNECT a<1>:<2>b;\nSEND FIX(1) TO <1>a;\n"],
                &[],
            ),
            fed(
                "net print - --json",
                "disp a;",
                0,
                &[r#"{"file":"-","line":1,"column":1,"command":"DISPLAY a;"}"#],
                &[],
            ),
            fed("net print -", "", 0, &[], &[]),
            call("net dot turn.ps300", 0, &["digraph", "DIALS", "turn", "}"], &[]),
            call("net functions", 0, &["function", "ACCUMULATE", "absent"], &[]),
            call("net functions f:accumulate", 0, &["ACCUMULATE"], &[]),
            call(
                "net functions ADDC CLFRAMES ROUTE ATSCALE --json",
                0,
                &[
                    r#"{"name":"ADDC","family":"Arithmetic and logic","inputs":[{"number":1,"kinds":["#,
                    r#""number":2"#,
                    r#""constant":true,"default":null"#,
                    r#""outputs":[{"number":1,"kinds":["#,
                    r#""behaviour":"#,
                    r#""confidence":"used","example":"<2> 1"#,
                    r#"{"name":"ROUTE""#,
                    r#""times":"size""#,
                    r#"{"name":"CLFRAMES""#,
                    r#""default":1"#,
                    r#"{"name":"ATSCALE","inputs":[],"outputs":[]"#,
                    r#""absent":true,"why":"what it did is not on record"}"#,
                ],
                &[],
            ),
            call("net functions --json", 0, ANY, &[]),
        ],
    );
}

#[test]
fn a_network_is_patched_while_it_runs_and_printed_as_it_then_is() {
    check(
        &[
            ("sum.ps300", b"sum := F:ACCUMULATE; CONNECT DIALS<1>:<1>sum;"),
            (
                "patch.txt",
                b"at 0.2 twice := F:MULC;\nat 0.2 SEND 2 TO <2>twice;\nat 0.2 CONNECT sum<1>:<1>twice;\n\
                at 0.4 DELETE twice;\nat 0.5 later := F:ACCUMULATE;\n",
            ),
        ],
        &[
            call(
                "net run sum.ps300 --events patch.txt --dial 1:0.5@0.1 --dial 1:0.5@0.3 --watch twice<1> --state",
                0,
                &[
                    r#"{"t":0.3,"from":"twice<1>","kind":"real","value":2.0}"#,
                    "sum := F:ACCUMULATE;",
                    "later := F:ACCUMULATE;",
                    "CONNECT DIALS<1>:<1>sum;",
                    "SETUP STATE 1,1 IN sum;",
                ],
                &[],
            ),
            call(
                "--json net run sum.ps300 --until 0 --state",
                0,
                &[r#"{"network":"sum := "#],
                &[],
            ),
        ],
    );
}
