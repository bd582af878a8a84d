//! What is said about faulty text, where, and what is read in spite of it.

use ps300::language::{FORMS, Severity, parse, print};

struct Case {
    source: &'static str,
    /// `line:column`, then words of the message, then words of what was expected or hinted.
    said: &'static [(&'static str, &'static str, &'static str)],
    /// Canonical text of what was read.
    read: &'static [&'static str],
}

const CASES: &[Case] = &[
    Case {
        source: "connect a<1>:<1>b\n",
        said: &[("1:18", "not ended", "`;`")],
        read: &[],
    },
    Case {
        source: "connect a<1> <1>b; disp c;",
        said: &[("1:14", "found `<`", "`:`")],
        read: &["DISPLAY c;"],
    },
    Case {
        source: "connect a<0>:<1>b;",
        said: &[("1:11", "found the number 0", "an output number from 1 to 255")],
        read: &[],
    },
    Case {
        source: "connect a<1>:<1.5>b;",
        said: &[("1:15", "found the number 1.5", "an input number from 1 to 65535")],
        read: &[],
    },
    Case {
        source: "send 1 to <apend>b;",
        said: &[("1:12", "found `apend`", "append, delete, clear")],
        read: &[],
    },
    Case {
        source: "conect a<1>:<1>b;",
        said: &[("1:1", "found `conect`", "did you mean CONNECT?")],
        read: &[],
    },
    Case {
        source: "a := rotat in x 90;\nb := rotated x 90;",
        said: &[("2:6", "found `rotated`", "did you mean ROTATE?")],
        read: &["a := ROTATE IN X 90;"],
    },
    Case {
        source: "a := rot w 90;",
        said: &[("1:10", "found `w`", "X, Y or Z")],
        read: &[],
    },
    Case {
        source: "a := rot x;",
        said: &[("1:11", "found `;`", "an angle in degrees")],
        read: &[],
    },
    Case {
        source: "a := trans by 1 then b;",
        said: &[("1:17", "found `then`", "coordinate 2 of the translation")],
        read: &[],
    },
    Case {
        source: "a := set colour 1,1;",
        said: &[("1:10", "found `colour`", "did you mean COLOR?")],
        read: &[],
    },
    Case {
        source: "a := set rate on;",
        said: &[("1:15", "found `on`", "EXTERNAL, or how many frames on")],
        read: &[],
    },
    Case {
        source: "a := polygon 0,0,0;",
        said: &[("1:13", "a polygon of 1 corners", "three or more")],
        read: &[],
    },
    Case {
        source: "a := polygon 0,0 1,0 1,1\ns := nil;",
        said: &[("1:25", "not ended", "`;`")],
        read: &["s := NIL;"],
    },
    Case {
        source: "a := vec 0,0 1,1\np := nil;",
        said: &[("1:17", "not ended", "`;`")],
        read: &["p := NIL;"],
    },
    Case {
        source: "a := bspline 0,0 1,1 chords=9;",
        said: &[("1:13", "this curve has no ORDER", "the degree plus one")],
        read: &[],
    },
    Case {
        source: "a := bspline order=2 0,0 1,1 chord=9;",
        said: &[("1:30", "found `chord`", "CHORDS=20")],
        read: &[],
    },
    Case {
        source: "a := poly order=2 1,1 1,1 chords=9;",
        said: &[("1:10", "ORDER=2, but 2 coefficients", "3 coefficients")],
        read: &[],
    },
    Case {
        source: "a := rational rot;",
        said: &[("1:15", "found `rot`", "BSPLINE or POLYNOMIAL")],
        read: &[],
    },
    Case {
        source: "a := begin_font c[65: p 0,0; c[66]: p 0,0; end_font;",
        said: &[("1:21", "found `:`", "`]`")],
        read: &["a := BEGIN_FONT\n    C[66]: N=1 P 0,0;\nEND_FONT;"],
    },
    Case {
        source: "a := begin_font c[65]: p 0,0;\nb := nil;",
        said: &[("1:6", "font is never ended", "END_FONT")],
        read: &["b := NIL;"],
    },
    Case {
        source: "setup cnes true <1>a;",
        said: &[("1:7", "found `cnes`", "did you mean CNESS?")],
        read: &[],
    },
    Case {
        source: "setup state 1 2 in a;",
        said: &[("1:15", "found the number 2", "IN")],
        read: &[],
    },
    Case {
        source: "a := if lev ! 1 then b;",
        said: &[("1:13", "found `!`", "one of <, =")],
        read: &[],
    },
    Case {
        source: "!rest;",
        said: &[("1:2", "found `rest`", "did you mean RESET?")],
        read: &[],
    },
    Case {
        source: "a := if cond 15 is on then b;",
        said: &[("1:14", "found the number 15", "from 0 to 14")],
        read: &[],
    },
    Case {
        source: "a := look at 0,0,0 at 1,1,1;",
        said: &[("1:20", "AT is said twice", "")],
        read: &[],
    },
    Case {
        source: "send v3d(1,2) to <1>b;",
        said: &[("1:13", "found `)`", "number 3 of 3")],
        read: &[],
    },
    Case {
        source: "send fix(3000000000) to <1>b;",
        said: &[("1:10", "3000000000", "-2147483648 to 2147483647")],
        read: &[],
    },
    Case {
        source: "send 1e999 to <1>b;",
        said: &[("1:6", "the number 1e999 is too large", "1.8e308")],
        read: &[],
    },
    Case {
        source: "send char(55296) to <1>b;",
        said: &[("1:6", "55296 is not the code of a character", "")],
        read: &[],
    },
    Case {
        source: "send 'abc to <1>b; \ndisp a;",
        said: &[("1:6", "not closed on its line", "`'`")],
        read: &["DISPLAY a;"],
    },
    Case {
        source: "disp a; { never ended\ndisp b;",
        said: &[("1:9", "comment is never closed", "`}`")],
        read: &["DISPLAY a;"],
    },
    Case {
        source: "disp a # b; disp c;",
        said: &[("1:8", "found the character '#'", "`;`")],
        read: &["DISPLAY c;"],
    },
    Case {
        source: "a := rot x 90\nb := nil;\nconnect b<1>:<1>c\nsend 1 to <1>c;",
        said: &[("1:14", "not ended", "`;`"), ("3:18", "not ended", "`;`")],
        read: &["b := NIL;", "SEND 1 TO <1>c;"],
    },
    Case {
        source: "a := rot ( x\nb := nil;",
        said: &[("1:10", "found `(`", "X, Y or Z")],
        read: &["b := NIL;"],
    },
    Case {
        source: "s := begin_s\n rot q 1;\n i := inst of c;\n send 1 to <1>c;\n end_s; disp s;",
        said: &[
            ("2:6", "found `q`", "X, Y or Z"),
            ("4:2", "found `send`", "an element of the structure"),
        ],
        read: &[
            "s := BEGIN_STRUCTURE\n    i := INSTANCE OF c;\nEND_STRUCTURE;",
            "DISPLAY s;",
        ],
    },
    Case {
        source: "s := begin_s f:add; end_s;",
        said: &[("1:14", "this function has no label", "label := F:TYPE;")],
        read: &["s := BEGIN_STRUCTURE\nEND_STRUCTURE;"],
    },
    Case {
        source: "s := begin_s a.b := nil; end_s;",
        said: &[("1:14", "has a dot", "outside the structure")],
        read: &["s := BEGIN_STRUCTURE\nEND_STRUCTURE;"],
    },
    Case {
        source: "disp a; s := begin_s nil;",
        said: &[("1:14", "never ended", "END_STRUCTURE;")],
        read: &["DISPLAY a;"],
    },
    Case {
        source: "end_s; begin_s nil; disp a;",
        said: &[
            ("1:1", "END_STRUCTURE without", ""),
            ("1:8", "no name", "name := BEGIN_STRUCTURE"),
        ],
        read: &["DISPLAY a;"],
    },
    Case {
        source: "delete *;",
        said: &[("1:8", "without the beginning of a name", "INITIALIZE NAMES")],
        read: &[],
    },
    Case {
        source: "a := vec n=3 0,0,0 1,1,1;",
        said: &[("1:10", "N=3, but 2 vectors follow", "N=2")],
        read: &["a := VECTOR_LIST CONNECTED N=2 0,0,0 1,1,1;"],
    },
    Case {
        source: "a := vec conn p 0,0,0 p 1,1,1;",
        said: &[("1:15", "P and L do nothing", "ITEMIZED")],
        read: &["a := VECTOR_LIST CONNECTED N=2 0,0,0 1,1,1;"],
    },
    Case {
        source: "a := vec 0,0,0 tab 1,1,1;",
        said: &[("1:16", "found `tab`", "a vector x,y,z")],
        read: &[],
    },
];

#[test]
fn faults_are_placed_named_and_passed_over() {
    for case in CASES {
        let (commands, diagnostics) = parse(case.source);
        let read: Vec<String> = commands.iter().map(|command| print(&command.what)).collect();
        assert_eq!(read, case.read, "{}", case.source);
        assert_eq!(
            diagnostics.len(),
            case.said.len(),
            "{}\n{diagnostics:#?}",
            case.source
        );
        for (diagnostic, (place, message, remedy)) in diagnostics.iter().zip(case.said) {
            let shown = diagnostic.to_string();
            assert_eq!(
                format!("{}:{}", diagnostic.line, diagnostic.column),
                *place,
                "{}\n{shown}",
                case.source
            );
            assert!(diagnostic.message.contains(message), "{shown}");
            let remedies = [diagnostic.expected.as_deref(), diagnostic.hint.as_deref()];
            assert!(
                remedy.is_empty() || remedies.iter().flatten().any(|found| found.contains(remedy)),
                "{}: {shown}",
                case.source
            );
        }
    }
}

#[test]
fn a_diagnostic_is_one_readable_line() {
    let (_, diagnostics) = parse("conect a;");
    assert_eq!(
        diagnostics[0].to_string(),
        "1:1: error: found `conect`; expected a command, or a name and `:=`; did you mean CONNECT?"
    );
}

#[test]
fn names_over_240_characters_are_taken_with_a_warning() {
    let long = "n".repeat(241);
    let (commands, diagnostics) = parse(&format!("display {long};"));
    assert_eq!(print(&commands[0].what), format!("DISPLAY {long};"));
    assert_eq!(diagnostics.len(), 1);
    assert_eq!(diagnostics[0].severity, Severity::Warning);
    assert_eq!((diagnostics[0].line, diagnostics[0].column), (1, 9));
    assert_eq!(diagnostics[0].expected.as_deref(), Some("240 characters at most"));
    assert!(parse(&format!("display {};", "n".repeat(240))).1.is_empty());
}

#[test]
fn deep_nesting_is_refused_at_the_depth_it_begins() {
    let depth = 100_000;
    let source = format!(
        "s := {}nil; {}disp a;",
        "begin_s ".repeat(depth),
        "end_s; ".repeat(depth)
    );
    let (commands, diagnostics) = parse(&source);
    assert_eq!(diagnostics.len(), 1, "{diagnostics:#?}");
    assert!(diagnostics[0].message.contains("more than 32 deep"));
    assert_eq!(diagnostics[0].column, 6 + 32 * 8);
    assert_eq!(commands.len(), 2);
}

#[test]
fn megabytes_of_anything_are_read_with_bounded_remarks() {
    let noises = [
        "a;",
        "a := ",
        "begin_s ",
        "s := begin_s ",
        "((((",
        "'",
        "{",
        "1 ",
        "\n",
        "#",
        "é<1>",
        "f:f:",
        "a := begin_font c[65]:\n",
        "s := begin_s\n f := begin_font\n",
        "send vl(",
        "a := poly 0,0 ",
        "a := labels 0,0 'a' ",
        "a := bspline order=2 0,0 ",
        "if lev <",
        "'a' ",
        "!",
    ];
    for noise in noises {
        let (_, diagnostics) = parse(&noise.repeat(1_000_000 / noise.len()));
        assert!(diagnostics.len() <= 501, "{noise}: {}", diagnostics.len());
    }
    for (begin, part, end) in [
        ("v := vector_list ", "0.5,1e-3,-2 ", ";"),
        ("l := labels ", "0,0 'a' ", ";"),
        ("c := characters ", "'a' ", ";"),
        ("f := begin_font ", "c[65]: p 0,0 l 1,1;", "end_font;"),
        ("s := begin_s ", "f := f:add;", "end_s;"),
        ("b := bspline order=2 chords=9 ", "0,0 ", ";"),
        ("p := poly 0,0 1,0 1,1 ", "poly 0,0 1,0 1,1 ", ";"),
        ("setup state ", "vl(dots n=0),", "1 in f;"),
    ] {
        let (commands, diagnostics) = parse(&format!("{begin}{}{end}", part.repeat(1_000_000 / part.len())));
        assert!(diagnostics.is_empty(), "{begin}");
        assert_eq!(commands.len(), 1, "{begin}");
    }
}

/// A file that was only half written: whatever it ends in, what stands before is read.
#[test]
fn cut_texts_are_read_up_to_the_cut() {
    for example in FORMS
        .iter()
        .flat_map(|section| section.forms)
        .map(|form| form.example)
    {
        let whole = parse(example).0;
        for end in (0..example.len()).filter(|&end| example.is_char_boundary(end)) {
            let (commands, _) = parse(&example[..end]);
            let same = commands
                .iter()
                .zip(&whole)
                .take_while(|(cut, whole)| cut == whole)
                .count();
            // At most the command that was cut is something else.
            assert!(commands.len() - same <= 1, "{}", &example[..end]);
        }
    }
}

#[test]
fn remarks_left_out_are_counted() {
    let (_, diagnostics) = parse(&"a;\n".repeat(700));
    assert_eq!(diagnostics.len(), 501);
    assert_eq!(
        diagnostics[500].message,
        "200 more remarks up to here are left out"
    );
    assert_eq!(diagnostics[500].line, 700);
}
