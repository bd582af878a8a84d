//! `dialrig sample`, `check`, `convert`: the files of shows.

use crate::{ANY, call, check, fed};

const WALK: &[u8] = b"HIERARCHY
ROOT Hips
{
  OFFSET 0 0 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  End Site
  {
    OFFSET 0 1 0
  }
}
MOTION
Frames: 3
Frame Time: 0.5
0 0 0 0 0 0
1 0 0 0 0 0
2 0 0 0 0 0
";

#[test]
fn motion_is_sampled() {
    check(
        &[("walk.bvh", WALK), ("still.str", b"x\n0 a 2 1\n")],
        &[
            call(
                "sample shows/salute --at 0",
                0,
                &[r#"{"t":0.0,"name":"head","start":[0.0,1.0934,0.0177],"end":["#],
                ANY,
            ),
            call(
                "sample shows/salute/show.toml --at 0 -q",
                0,
                &[r#""name":"lf""#],
                &[],
            ),
            call(
                "sample walk.bvh",
                0,
                &[r#"{"t":0.0,"#, r#"{"t":0.5,"#, r#"{"t":1.0,"#],
                ANY,
            ),
            call(
                "sample walk.bvh --fps 1 --json",
                0,
                &[r#"{"t":0.0,"#, r#"{"t":1.0,"name":"Hips","start":[2.0,"#],
                ANY,
            ),
            call(
                "sample still.str",
                1,
                &[],
                &["error: still.str: the clip has no keys", "hint:"],
            ),
            call(
                "sample nowhere",
                1,
                &[],
                &["nowhere/show.toml:1:1: error: ", "hint: a show is a folder"],
            ),
            call(
                "sample nowhere.png",
                1,
                &[],
                &["nowhere.png:1:1: error: cannot read a `.png` file"],
            ),
        ],
    );
}

#[test]
fn files_are_checked_all_together() {
    check(
        &[
            ("walk.bvh", WALK),
            ("cut.bvh", &WALK[..WALK.len() - 30]),
            ("bad.ps300", b"a := F:ADD\nCONNECT a<1>;\nSEND TO a;\n"),
            ("nan.str", b"x\n0 a 2 nan\n"),
            ("picture.png", b"\x89PNG"),
            ("folder/inside", b""),
        ],
        &[
            call(
                "check shows/salute networks/figure.ps300 walk.bvh -q",
                0,
                &[],
                &[],
            ),
            call("check walk.bvh", 0, &[], &["1 file in order"]),
            call(
                "check cut.bvh bad.ps300 nan.str picture.png nowhere.bvh",
                1,
                &[],
                &[
                    "cut.bvh:",
                    "bad.ps300:2:",
                    "bad.ps300:3:",
                    "nan.str:2:7:",
                    "picture.png:1:1:",
                    "nowhere.bvh:1:1:",
                ],
            ),
            call(
                "check nan.str --json",
                1,
                &[r#"{"error":"#, r#""file":"nan.str","line":2,"column":7,"hint":"#],
                &[],
            ),
            call("check folder", 1, &[], &["folder/show.toml:1:1: error: "]),
            fed("check -", "x", 1, &[], &["error: "]),
        ],
    );
}

#[test]
fn files_are_converted() {
    check(
        &[
            ("walk.bvh", WALK),
            ("cut.bvh", &WALK[..120]),
            ("folder/mine.txt", b"keep"),
        ],
        &[
            call("convert walk.bvh walk", 0, &[], &["wrote walk"]),
            call(
                "convert walk again.bvh --json",
                0,
                &["{\"wrote\":\"again.bvh\"}"],
                ANY,
            ),
            call("convert walk walk.csv -q", 0, &[], &[]),
            call("check walk again.bvh -q", 0, &[], &[]),
            call("sample again.bvh --at 0.5 -q", 0, &[r#""start":[1.0,"#], &[]),
            call("convert cut.bvh cut", 1, &[], &["cut.bvh:", ": error: "]),
            call(
                "convert walk.bvh folder",
                1,
                &[],
                &["folder:1:1: error: there is something else here"],
            ),
            call(
                "convert walk.bvh walk.png",
                1,
                &[],
                &["walk.png:1:1: error: cannot write a `.png`"],
            ),
            call("convert nowhere.bvh walk", 1, &[], &["nowhere.bvh:1:1: error: "]),
        ],
    );
}
