//! Wrong usage, help, version.

use crate::{ANY, call, check};

#[test]
fn wrong_usage_is_2_and_help_is_0() {
    check(
        &[],
        &[
            call("--help", 0, &["Commands:", "figure", "net", "Examples:"], &[]),
            call("--version", 0, &["dialrig 0."], &[]),
            call("net run --help", 0, &["--watch <NAME<N>>", "Examples:"], &[]),
            call(
                "nonsense",
                2,
                &[],
                &["`nonsense` is neither a command nor a show"],
            ),
            call("figure", 2, &[], &["<FILE.str>"]),
            call(
                "figure a.str --colour",
                2,
                &[],
                &["unexpected argument '--colour'"],
            ),
            call("--quiet -v figure a.str", 2, &[], &["cannot be used with"]),
            call("curve", 2, &[], &["Usage: dialrig curve"]),
            call("curve fit", 2, &[], &["<POINTS>"]),
            call("curve fit - --order 0", 2, &[], &["0 is not in 1..=64"]),
            call("curve sample - --count 1", 2, &[], &["1 is not in"]),
            call("curve sample - --at 0,x", 2, &[], &["expected a number"]),
            call(
                "curve sample - --at 0 --count 5",
                2,
                &[],
                &["cannot be used with"],
            ),
            call("sample", 2, &[], &["<SHOW>"]),
            call(
                "sample shows/salute --fps 0",
                2,
                &[],
                &["expected a number above zero"],
            ),
            call(
                "sample shows/salute --fps nan",
                2,
                &[],
                &["expected a number above zero"],
            ),
            call(
                "sample shows/salute --at 0,inf",
                2,
                &[],
                &["expected a finite number"],
            ),
            call(
                "sample shows/salute --of hats",
                2,
                &[],
                &["possible values: links"],
            ),
            call("convert shows/salute", 2, &[], &["<OUT>"]),
            call("check", 2, &[], &["<FILE>"]),
            call("net run", 2, &[], &["<FILE>"]),
            call("net run - --watch turn", 2, &[], &["expected NAME<N>"]),
            call(
                "net run - --dial 9:1@0",
                2,
                &[],
                &["there are dials 1 to 8, not 9"],
            ),
            call("net run - --dial 1:1", 2, &[], &["expected N:TURNS@SECS"]),
            call("net run - --until -1", 2, &[], ANY),
        ],
    );
}

#[test]
fn options_stand_before_a_command_too_but_a_show_does_not() {
    check(
        &[],
        &[
            call(
                "--quiet --json figure shows/salute/figure/ar.str",
                0,
                &[r#"{"link":0"#],
                &[],
            ),
            call("shows/salute figure a.str", 2, &[], &["cannot be given together"]),
        ],
    );
}
