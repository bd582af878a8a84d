//! `dialrig curve`.

use crate::{call, check, fed};

#[test]
fn curves_are_fitted_and_sampled() {
    check(
        &[
            ("line.csv", b"x,y\n0,0\n1,1\n3,3\n"),
            ("one.json", b"[1, 2, 4]"),
            (
                "fit.json",
                br#"{"kind":"bspline","points":[[0,0,0],[1,2,0],[3,2,1],[4,0,1]],"order":4}"#,
            ),
        ],
        &[
            call(
                "curve fit line.csv",
                0,
                &["natural cubic through 3 points, 0 merged", "params", "knots"],
                &[],
            ),
            call(
                "curve fit one.json --json",
                0,
                &[
                    r#"{"kind":"natural","points":[[1.0],[2.0],[4.0]],"kept":[0,1,2],"params":[0.0,1.0,3.0],"knots":["#,
                ],
                &[],
            ),
            call(
                "curve fit one.json --order 2 --json",
                0,
                &[
                    r#""kind":"bspline""#,
                    r#""order":2,"order_in_use":2,"knots":[0.0,0.0,1.0,2.0,2.0],"greville":[0.0,1.0,2.0]"#,
                ],
                &[],
            ),
            // The worked example of the notes on mathematics: a Bézier curve at its middle.
            call(
                "curve sample fit.json --at 0.5 --json",
                0,
                &[r#"{"u":0.5,"point":[2.0,1.5,0.5]}"#],
                &[],
            ),
            call(
                "curve sample fit.json --count 3",
                0,
                &["u,x,y,z\n0,0,0,0\n0.5,2,1.5,0.5\n1,4,0,1\n"],
                &[],
            ),
            call("curve sample one.json --at -5,99", 0, &["u,x\n0,1\n3,4\n"], &[]),
            call(
                "curve sample line.csv --count 2 --derivatives 2",
                0,
                &["u,x,y,d1x,d1y,d2x,d2y\n0,0,0,0.70710"],
                &[],
            ),
            fed(
                "curve fit - --json",
                "0;0\n0;0\n1;1",
                0,
                &[r#""kept":[0,2]"#],
                &[],
            ),
        ],
    );
}

#[test]
fn curves_are_measured() {
    check(
        &[("line.csv", b"0,0\n3,4\n6,8\n")],
        &[
            call("curve length line.csv", 0, &["10\n"], &[]),
            call(
                "curve length line.csv --from 2.5 --to 99 --json",
                0,
                &[r#"{"from":2.5,"to":10.0,"length":7.5"#],
                &[],
            ),
            fed("curve length -", "1\n", 0, &["0\n"], &[]),
            fed("curve length - --order 3", "0,0 0\n", 1, &[], &["-:1:3: error: "]),
            fed(
                "curve length - --order 3",
                "0,0\n1,0\n2,4\n",
                0,
                &["4.6467837624\n"],
                &[],
            ),
        ],
    );
}

#[test]
fn points_that_make_no_curve_are_refused_with_their_place() {
    check(
        &[
            ("cut.json", b"[[0,0],[1,"),
            ("ragged.csv", b"0,1\n2\n"),
            ("noise.csv", b"\xff"),
        ],
        &[
            fed(
                "curve fit -",
                "",
                1,
                &[],
                &["-:1:1: error: there are no points here", "hint:"],
            ),
            fed(
                "curve fit - --json",
                "",
                1,
                &[],
                &[r#"{"error":"there are no points here","file":"-","line":1"#],
            ),
            fed(
                "curve fit -",
                "0,0\n1,nan\n",
                1,
                &[],
                &["-:2:3: error: `nan` is not finite"],
            ),
            fed(
                "curve fit -",
                "0,0\n1,b\n",
                1,
                &[],
                &["-:2:3: error: expected a number, found `b`"],
            ),
            fed(
                "curve fit -",
                "1,2,3,4\n",
                1,
                &[],
                &["-:1:1: error: expected one to three coordinates"],
            ),
            fed(
                "curve fit - --order 1",
                "1\n2\n",
                1,
                &[],
                &["-:1:1: error: an order of at least 2"],
            ),
            call("curve fit cut.json", 1, &[], &["cut.json:1:10: error: EOF"]),
            call(
                "curve fit ragged.csv",
                1,
                &[],
                &["ragged.csv:2:1: error: expected 2 coordinates as before"],
            ),
            call(
                "curve fit noise.csv",
                1,
                &[],
                &["noise.csv:1:1: error: byte 0xff"],
            ),
            call("curve fit nowhere.csv", 1, &[], &["nowhere.csv:1:1: error: "]),
        ],
    );
}
