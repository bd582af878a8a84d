//! `dialrig figure`.

use crate::{ANY, call, check, fed};

const ARM: &[u8] = b"an arm\n0 upper 3 0.3\n    1 0 0 0.3\n\n1 lower 2 0.25\n";

#[test]
fn the_printed_human_is_read_with_two_warnings() {
    check(
        &[],
        &[
            call(
                "figure shows/salute/figure/ar.str",
                0,
                &[
                    "link  name",
                    "   0  head",
                    "   2      rua         2     0.2  0.125 0 0",
                    "15 links, 33 degrees",
                ],
                &[
                    "ar.str:30:1: warning: link 9 has 4 degrees of freedom; read as 2",
                    "ar.str:38:1: warning: link 12 has 4",
                ],
            ),
            call(
                "figure shows/salute/figure/ar.str --json",
                0,
                &[
                    r#"{"link":0,"name":"head","parent":null,"at":[0.0,0.0,0.0],"dof":3,"length":0.2}"#,
                    r#"{"link":2,"name":"rua","parent":1,"at":[0.125,0.0,0.0],"dof":2,"length":0.2}"#,
                    r#"{"link":9,"name":"rt","parent":8,"at":[0.05,0.0,0.1],"dof":2,"length":0.25}"#,
                ],
                &[
                    r#"{"warning":"link 9 has 4 degrees of freedom; read as 2","file":"#,
                    r#""line":30,"column":1"#,
                ],
            ),
            call("figure shows/salute/figure/ar.str -q", 0, &["15 links"], &[]),
            call(
                "figure shows/salute/figure/ar.str --pri shows/salute/figure/ar.pri --shp shows/salute/figure/ar.shp -q",
                0,
                &["15 links"],
                &[],
            ),
        ],
    );
}

#[test]
fn what_is_wrong_is_said_with_its_place() {
    check(
        &[
            ("arm.str", ARM),
            ("cut.str", &ARM[..ARM.len() - 8]),
            ("nan.str", b"x\n0 a 2 nan\n"),
            ("two.str", b"x\n0 a 2 1\n\n0 b 5 1\n"),
            ("words.str", b"x\n0 a two 1\n    1 0 zero 0\n"),
            ("noise.str", b"x\n0 \xff\xfe 2 1\n"),
            ("empty.str", b""),
            ("folder/inside", b""),
        ],
        &[
            call("figure arm.str", 0, &["2 links, 5 degrees of freedom"], &[]),
            call(
                "figure nowhere.str",
                1,
                &[],
                &["nowhere.str:1:1: error: cannot open it: No such file"],
            ),
            call(
                "figure nowhere.str --json",
                1,
                &[],
                &[r#"{"error":"cannot open"#, r#""file":"nowhere.str""#],
            ),
            call("figure folder", 1, &[], &["folder:1:1: error: this is a folder"]),
            call(
                "figure cut.str",
                1,
                &[],
                &["cut.str:5:", ": error: expected `number name freedoms length`"],
            ),
            call(
                "figure nan.str",
                1,
                &[],
                &["nan.str:2:7: error: `nan` is not a finite number"],
            ),
            call("figure two.str", 1, &[], &["two.str:4:1: error: "]),
            call(
                "figure words.str",
                1,
                &[],
                &["words.str:2:5: error: ", "words.str:3:9: error: "],
            ),
            call(
                "figure noise.str",
                1,
                &[],
                &["noise.str:2:3: error: byte 0xff is not UTF-8", "hint:"],
            ),
            call("figure empty.str", 1, &[], &["empty.str:1:1: error: "]),
            fed("figure -", "", 1, &[], &["-:1:1: error: "]),
            fed("figure - --json", "x\n0 a 2 1\n", 0, &[r#""name":"a""#], &[]),
        ],
    );
}

#[test]
fn shapes_are_held_against_links() {
    check(
        &[
            ("arm.str", ARM),
            ("bad.shp", b"upper := SCALE BY ;\n"),
            ("half.shp", b"upper := SCALE BY 2 THEN line;\n"),
        ],
        &[
            call(
                "figure arm.str --shp bad.shp",
                1,
                &[],
                &["bad.shp:1:", ": error: "],
            ),
            call(
                "figure arm.str --pri nowhere.pri",
                1,
                &[],
                &["nowhere.pri:1:1: error: "],
            ),
            call(
                "figure arm.str --shp half.shp",
                0,
                ANY,
                &[
                    "half.shp:1:1: warning: link 1 (`lower`) has no shape here",
                    "hint: add `lower := …;`",
                ],
            ),
        ],
    );
}
