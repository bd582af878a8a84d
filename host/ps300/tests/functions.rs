//! One row or more for every intrinsic function: what goes in, what comes out, what is refused.

use glam::DMat4;
use ps300::intrinsic;
use ps300::language::{Input, literal};
use ps300::{Machine, Value};

/// Function, messages as `<input> literal` in order, expected messages as `<output> literal`, and part of
/// the report that is expected, if one is.
type Row = (
    &'static str,
    &'static [&'static str],
    &'static [&'static str],
    &'static str,
);

const NONE: &str = "";

#[rustfmt::skip]
const ROWS: &[Row] = &[
    ("ACCUMULATE", &["<1> 2", "<1> 0.5"], &["<1> 2", "<1> 2.5"], NONE),
    ("ACCUMULATE", &["<1> FIX(2)", "<1> FIX(3)"], &["<1> FIX(2)", "<1> FIX(5)"], NONE),
    ("ACCUMULATE", &["<1> FIX(2)", "<1> 0.5", "<1> FIX(1)"], &["<1> FIX(2)", "<1> 2.5", "<1> 3.5"], NONE),
    ("ACCUMULATE", &["<2> FIX(10)", "<4> 0.25", "<1> FIX(3)", "<1> FIX(3)"], &["<1> FIX(10)", "<1> FIX(11)"], NONE),
    ("ACCUMULATE", &["<1> V3D(1,0,0)", "<1> V3D(0,2,0)"], &["<1> V3D(1,0,0)", "<1> V3D(1,2,0)"], NONE),
    ("ACCUMULATE", &["<2> V3D(1,1,1)", "<4> 100", "<1> V3D(1,0,-1)"], &["<1> V3D(101,1,-99)"], NONE),
    ("ACCUMULATE", &["<2> V2D(0,0)", "<5> 1", "<6> V2D(-1,-2)", "<1> V2D(5,-5)", "<1> V2D(-0.5,0.5)"], &["<1> V2D(1,-2)", "<1> V2D(0.5,-1.5)"], NONE),
    ("ACCUMULATE", &["<5> 1", "<1> 9", "<1> -0.25"], &["<1> 1", "<1> 0.75"], NONE),
    ("ACCUMULATE", &["<3> 1", "<1> 0.5", "<1> 0.25", "<1> 0.25", "<1> 0.5"], &["<1> 1"], NONE),
    ("ACCUMULATE", &["<1> 3", "<2> 10", "<1> 1"], &["<1> 3", "<1> 11"], NONE),
    ("ACCUMULATE", &["<1> M2D(0,-1,1,0)", "<1> M2D(2,0,0,1)"], &["<1> M2D(0,-1,1,0)", "<1> M2D(0,-2,1,0)"], NONE),
    ("ACCUMULATE", &["<2> 0", "<1> V3D(1,2,3)", "<1> 4"], &["<1> 4"], "input <1> takes integer or real, got vector3"),
    ("DSCALE", &["<1> 1"], &["<1> M3D(2,0,0, 0,2,0, 0,0,2)", "<2> 2"], NONE),
    ("DSCALE", &["<2> 1", "<3> 0.2", "<4> 1000", "<5> 0.01", "<1> -99", "<1> 5"], &["<1> M3D(0.01,0,0, 0,0.01,0, 0,0,0.01)", "<2> 0.01", "<1> M3D(1.01,0,0, 0,1.01,0, 0,0,1.01)", "<2> 1.01"], NONE),
    ("ADD", &["<1> 1", "<1> 2", "<2> 10", "<2> 20"], &["<1> 11", "<1> 22"], NONE),
    ("ADD", &["<1> FIX(1)", "<2> FIX(2)"], &["<1> FIX(3)"], NONE),
    ("ADD", &["<1> FIX(1)", "<2> 0.5"], &["<1> 1.5"], NONE),
    ("ADD", &["<1> FIX(2147483647)", "<2> FIX(1)"], &[], "does not fit an integer"),
    ("ADD", &["<1> V2D(1,2)", "<2> V3D(1,2,3)", "<2> V2D(3,4)"], &["<1> V2D(4,6)"], "input <2> takes vector2, got vector3"),
    ("ADD", &["<1> M2D(1,2,3,4)", "<2> M2D(1,1,1,1)"], &["<1> M2D(2,3,4,5)"], NONE),
    ("ADDC", &["<2> 1", "<1> 1", "<2> 2", "<1> 1"], &["<1> 2", "<1> 3"], NONE),
    ("SUB", &["<1> 5", "<2> 3"], &["<1> 2"], NONE),
    ("SUB", &["<1> V4D(1,2,3,4)", "<2> V4D(1,1,1,1)"], &["<1> V4D(0,1,2,3)"], NONE),
    ("SUBC", &["<2> FIX(1)", "<1> FIX(5)"], &["<1> FIX(4)"], NONE),
    ("CSUB", &["<1> 10", "<2> 3"], &["<1> 7"], NONE),
    ("MUL", &["<1> 2", "<2> V3D(1,2,3)"], &["<1> V3D(2,4,6)"], NONE),
    ("MUL", &["<1> M2D(1,2,3,4)", "<2> V2D(1,0)"], &["<1> V2D(1,3)"], NONE),
    ("MUL", &["<1> V2D(1,0)", "<2> M2D(1,2,3,4)"], &["<1> V2D(1,3)"], NONE),
    ("MUL", &["<1> M2D(1,2,3,4)", "<2> M2D(0,1,1,0)"], &["<1> M2D(2,1,4,3)"], NONE),
    ("MUL", &["<1> FIX(3)", "<2> FIX(4)"], &["<1> FIX(12)"], NONE),
    ("MUL", &["<1> V3D(1,2,3)", "<2> M2D(1,0,0,1)"], &[], "takes integer or real or vector3 or matrix3, got matrix2"),
    ("MULC", &["<2> 0.2", "<1> 10"], &["<1> 2"], NONE),
    ("CMUL", &["<1> M3D(1,0,0, 0,0,-1, 0,1,0)", "<2> V3D(0,1,0)"], &["<1> V3D(0,0,1)"], NONE),
    ("DIV", &["<1> 1", "<2> 0", "<1> 9", "<2> 2"], &["<1> 4.5"], "division by zero"),
    ("DIV", &["<1> FIX(7)", "<2> FIX(-2)"], &["<1> FIX(-3)"], NONE),
    ("DIV", &["<1> V2D(4,6)", "<2> 2"], &["<1> V2D(2,3)"], NONE),
    ("DIVC", &["<2> 4", "<1> 1"], &["<1> 0.25"], NONE),
    ("CDIV", &["<1> 1", "<2> 4"], &["<1> 0.25"], NONE),
    ("MOD", &["<1> FIX(-7)", "<2> FIX(3)"], &["<1> FIX(-1)"], NONE),
    ("MODC", &["<2> FIX(0)", "<1> FIX(7)"], &[], "division by zero"),
    ("MODC", &["<2> FIX(4)", "<1> FIX(7)"], &["<1> FIX(3)"], NONE),
    ("ROUND", &["<1> 2.5", "<1> -2.5"], &["<1> FIX(3)", "<1> FIX(-3)"], NONE),
    ("ROUND", &["<1> 3000000000"], &[], "32 bits"),
    ("CEILING", &["<1> 2.1", "<1> -2.9"], &["<1> FIX(3)", "<1> FIX(-2)"], NONE),
    ("FIX", &["<1> 2.9", "<1> -2.9"], &["<1> FIX(2)", "<1> FIX(-2)"], NONE),
    ("FLOAT", &["<1> FIX(4)"], &["<1> 4"], NONE),
    ("SINCOS", &["<1> 30"], &["<1> 0.5", "<2> 0.8660254037844386"], NONE),
    ("SQROOT", &["<1> -1", "<1> 9"], &["<1> 3"], "square root of a negative number"),
    ("AVERAGE", &["<1> 3", "<1> 5"], &["<1> 3", "<1> 5"], NONE),
    ("AVERAGE", &["<2> FIX(2)", "<1> 3", "<1> 5", "<1> 7"], &["<1> 3", "<1> 4", "<1> 6"], NONE),
    ("AVERAGE", &["<2> FIX(0)", "<1> 3"], &[], "between 1 and 1024"),
    ("AND", &["<1> TRUE", "<2> FALSE"], &["<1> FALSE"], NONE),
    ("AND", &["<1> FIX(6)", "<2> FIX(3)"], &["<1> FIX(2)"], NONE),
    ("ANDC", &["<2> TRUE", "<1> TRUE"], &["<1> TRUE"], NONE),
    ("OR", &["<1> TRUE", "<2> FALSE"], &["<1> TRUE"], NONE),
    ("ORC", &["<2> FIX(1)", "<1> FIX(6)"], &["<1> FIX(7)"], NONE),
    ("XOR", &["<1> TRUE", "<2> TRUE"], &["<1> FALSE"], NONE),
    ("XOR", &["<1> TRUE", "<2> FIX(1)"], &[], "input <2> takes boolean, got integer"),
    ("XORC", &["<2> TRUE", "<1> FALSE"], &["<1> TRUE"], NONE),
    ("NOT", &["<1> TRUE", "<1> FIX(0)"], &["<1> FALSE", "<1> FIX(-1)"], NONE),
    ("EQ", &["<1> 1", "<2> FIX(1)"], &["<1> TRUE"], NONE),
    ("EQ", &["<1> 'a'", "<2> 'b'"], &["<1> FALSE"], NONE),
    ("EQ", &["<1> 'a'", "<2> 1"], &[], "input <2> takes string, got real"),
    ("EQC", &["<2> V2D(1,2)", "<1> V2D(1,2)"], &["<1> TRUE"], NONE),
    ("NE", &["<1> 1", "<2> 1"], &["<1> FALSE"], NONE),
    ("NEC", &["<2> TRUE", "<1> FALSE"], &["<1> TRUE"], NONE),
    ("LT", &["<1> 1", "<2> 2"], &["<1> TRUE"], NONE),
    ("LTC", &["<2> 2", "<1> 2"], &["<1> FALSE"], NONE),
    ("CLT", &["<1> 1", "<2> 2"], &["<1> TRUE"], NONE),
    ("LE", &["<1> 2", "<2> 2"], &["<1> TRUE"], NONE),
    ("LEC", &["<2> 2", "<1> 3"], &["<1> FALSE"], NONE),
    ("CLE", &["<1> 3", "<2> 2"], &["<1> FALSE"], NONE),
    ("GT", &["<1> 2", "<2> 2"], &["<1> FALSE"], NONE),
    ("GTC", &["<2> 2", "<1> FIX(3)"], &["<1> TRUE"], NONE),
    ("CGT", &["<1> 3", "<2> 2"], &["<1> TRUE"], NONE),
    ("GE", &["<1> 2", "<2> 2"], &["<1> TRUE"], NONE),
    ("GEC", &["<2> 2", "<1> 1"], &["<1> FALSE"], NONE),
    ("CGE", &["<1> 1", "<2> 2"], &["<1> FALSE"], NONE),
    ("CONSTANT", &["<1> TRUE", "<2> 'x'", "<1> 5"], &["<1> 'x'", "<1> 'x'"], NONE),
    ("NOP", &["<1> 'x'"], &["<1> 'x'"], NONE),
    ("PASSTHRU(3)", &["<2> 1", "<3> 'x'", "<1> TRUE", "<2> 2"], &["<2> 1", "<3> 'x'", "<1> TRUE", "<2> 2"], NONE),
    ("ROUTE(3)", &["<1> FIX(2)", "<2> 'b'", "<1> FIX(4)", "<2> 'd'", "<1> FIX(0)", "<2> 'z'", "<1> FIX(3)", "<2> 'c'"], &["<2> 'b'", "<3> 'c'"], "no output of that number (2 times)"),
    ("ROUTEC(2)", &["<2> 'v'", "<1> FIX(2)", "<1> FIX(1)"], &["<2> 'v'", "<1> 'v'"], NONE),
    ("CROUTE(2)", &["<1> FIX(2)", "<2> 'v'", "<1> FIX(1)", "<2> 'w'"], &["<2> 'v'", "<1> 'w'"], NONE),
    ("BROUTE", &["<1> TRUE", "<2> 1", "<1> FALSE", "<2> 2"], &["<1> 1", "<2> 2"], NONE),
    ("BROUTEC", &["<2> 9", "<1> FALSE"], &["<2> 9"], NONE),
    ("CBROUTE", &["<1> TRUE", "<2> 9"], &["<1> 9"], NONE),
    ("BOOLEAN_CHOOSE", &["<2> 'yes'", "<3> 'no'", "<1> FALSE", "<1> TRUE"], &["<1> 'no'", "<1> 'yes'"], NONE),
    ("INPUTS_CHOOSE(3)", &["<1> 'a'", "<2> 'b'", "<3> FIX(2)", "<3> FIX(3)"], &["<1> 'b'"], "no stored input of that number"),
    ("SYNC(2)", &["<2> 'b'", "<2> 'd'", "<1> 'a'"], &["<1> 'a'", "<2> 'b'"], NONE),
    ("LIMIT", &["<1> 7"], &["<1> 7"], NONE),
    ("LIMIT", &["<2> 5", "<3> -5", "<1> 7", "<1> -7", "<1> FIX(9)"], &["<1> 5", "<1> -5", "<1> FIX(5)"], NONE),
    ("DELTA", &["<1> 1", "<1> 1"], &["<1> 1", "<1> 1"], NONE),
    ("DELTA", &["<2> FIX(1)", "<1> FIX(4)", "<1> FIX(4)", "<1> FIX(5)"], &["<1> FIX(4)", "<1> FIX(5)"], NONE),
    ("EDGE_DETECT", &["<1> TRUE", "<1> TRUE", "<1> FALSE", "<1> TRUE"], &["<1> TRUE", "<1> TRUE"], NONE),
    ("EDGE_DETECT", &["<2> FALSE", "<1> TRUE", "<1> FALSE"], &["<1> FALSE"], NONE),
    ("SEND", &["<1> 4", "<2> 'nowhere'", "<3> FIX(1)"], &[], "there is no \"nowhere\""),
    ("FETCH", &["<2> 'store'", "<1> TRUE"], &["<1> 12"], NONE),
    ("FETCH", &["<2> 'dials'", "<1> TRUE"], &[], "there is no \"dials\""),
    ("XVECTOR", &["<1> 2"], &["<1> V3D(2,0,0)"], NONE),
    ("YVECTOR", &["<1> 2"], &["<1> V3D(0,2,0)"], NONE),
    ("ZVECTOR", &["<1> FIX(2)"], &["<1> V3D(0,0,2)"], NONE),
    ("VEC", &["<1> 1", "<2> 2"], &["<1> V2D(1,2)"], NONE),
    ("VEC", &["<1> V2D(1,2)", "<2> 3"], &["<1> V3D(1,2,3)"], NONE),
    ("VECC", &["<2> 4", "<1> V3D(1,2,3)"], &["<1> V4D(1,2,3,4)"], NONE),
    ("CVEC", &["<1> 1", "<2> 2"], &["<1> V2D(1,2)"], NONE),
    ("PARTS", &["<1> V3D(1,2,3)"], &["<1> 1", "<2> 2", "<3> 3"], NONE),
    ("XROTATE", &["<1> 90"], &["<1> M3D(1,0,0, 0,0,-1, 0,1,0)"], NONE),
    ("YROTATE", &["<1> 90"], &["<1> M3D(0,0,1, 0,1,0, -1,0,0)"], NONE),
    ("ZROTATE", &["<1> 90"], &["<1> M3D(0,-1,0, 1,0,0, 0,0,1)"], NONE),
    ("DXROTATE", &["<1> 90"], &["<1> M3D(1,0,0, 0,0,-1, 0,1,0)", "<2> 90"], NONE),
    ("DYROTATE", &["<2> 45", "<1> 45"], &["<1> M3D(0,0,1, 0,1,0, -1,0,0)", "<2> 90"], NONE),
    ("DZROTATE", &["<3> 200", "<1> 0.2", "<1> 0.25"], &["<1> M3D(0.766044443118978,-0.6427876096865393,0, 0.6427876096865393,0.766044443118978,0, 0,0,1)", "<2> 40", "<1> M3D(0,-1,0, 1,0,0, 0,0,1)", "<2> 90"], NONE),
    ("MATRIX2", &["<1> V2D(1,2)", "<2> V2D(3,4)"], &["<1> M2D(1,2,3,4)"], NONE),
    ("MATRIX3", &["<1> V3D(1,2,3)", "<2> V3D(4,5,6)", "<3> V3D(7,8,9)"], &["<1> M3D(1,2,3,4,5,6,7,8,9)"], NONE),
    ("MATRIX4", &["<1> V4D(1,2,3,4)", "<2> V4D(5,6,7,8)", "<3> V4D(9,1,2,3)", "<4> V4D(4,5,6,7)"], &["<1> M4D(1,2,3,4,5,6,7,8,9,1,2,3,4,5,6,7)"], NONE),
    ("SCALE", &["<1> 2", "<1> V3D(1,2,3)"], &["<1> M3D(2,0,0, 0,2,0, 0,0,2)", "<1> M3D(1,0,0, 0,2,0, 0,0,3)"], NONE),
    ("CROTATE", &["<1> 90"], &["<1> M2D(0,-1,1,0)"], NONE),
    ("CSCALE", &["<1> 2", "<1> V2D(1,3)"], &["<1> M2D(2,0,0,2)", "<1> M2D(1,0,0,3)"], NONE),
    ("LOOKAT", &["<2> V3D(0,0,-5)", "<1> V3D(0,0,0)"], &["<1> M4X3 1 0 0 0 0 1 0 0 0 0 1 5"], NONE),
    ("LOOKAT", &["<2> V3D(0,0,0)", "<1> V3D(0,0,0)"], &[], "the eye is at the point it looks at"),
    ("LOOKFROM", &["<2> V3D(0,0,0)", "<1> V3D(-5,0,0)"], &["<1> M4X3 0 0 -1 0 0 1 0 0 1 0 0 5"], NONE),
    ("LOOKFROM", &["<2> V3D(0,0,0)", "<3> V3D(-9,0,0)", "<1> V3D(-5,0,0)"], &[], "in line"),
    ("FOV", &["<2> 90", "<3> 1", "<4> 2", "<1> TRUE"], &["<1> M4D(1,0,0,0, 0,1,0,0, 0,0,2,-2, 0,0,1,0)"], NONE),
    ("FOV", &["<2> 90", "<3> 2", "<4> 1", "<1> 1.0"], &[], "front before back"),
    ("WINDOW", &["<2> 0", "<3> 4", "<4> -1", "<5> 1", "<6> 0", "<7> 10", "<1> TRUE"], &["<1> M4D(0.5,0,0,-1, 0,1,0,0, 0,0,0.1,0, 0,0,0,1)"], NONE),
    ("PRINT", &["<1> FIX(12)", "<1> V2D(0.5,-1)", "<1> TRUE", "<1> 'x'"], &["<1> '12'", "<1> 'V0.5,-1'", "<1> 'TRUE'", "<1> 'x'"], NONE),
    ("CONCATENATE", &["<1> 'a'", "<2> 'b'"], &["<1> 'ab'"], NONE),
    ("CONCATENATEC", &["<2> 'b'", "<1> 'a'"], &["<1> 'ab'"], NONE),
    ("CCONCATENATE", &["<1> 'a'", "<2> 'b'"], &["<1> 'ab'"], NONE),
    ("LENGTH_STRING", &["<1> 'abc'"], &["<1> FIX(3)"], NONE),
    ("STRING_TO_NUM", &["<1> ' 1.5 '", "<1> 'x'"], &["<1> 1.5"], "not a number"),
    ("CLCSECONDS", &["<1> FIX(50)"], &["<1> FIX(0)", "<2> TRUE"], NONE),
    ("CLFRAMES", &["<1> FIX(30)", "<3> FIX(5)", "<4> FIX(2)"], &["<1> FIX(5)", "<2> TRUE", "<1> FIX(7)", "<2> TRUE"], NONE),
    ("CLTICKS", &[], &["<1> FIX(0)", "<2> TRUE"], NONE),
    ("CLTICKS", &["<2> FALSE"], &[], NONE),
    ("CLTICKS", &["<1> FIX(0)"], &[], "at least 1"),
];

/// The messages a function sends for a row; then the reports.
fn outcome(function: &str, messages: &[&str]) -> (Vec<(u8, Value)>, String) {
    let mut machine = Machine::new();
    let definition = format!("VARIABLE store; STORE 12 IN <1>store; f := F:{function};");
    assert_eq!(machine.load(&definition), []);
    let send = |message: &&str| {
        let (input, value) = message.split_once(' ').expect("an input and a literal");
        format!("SEND {value} TO {input}f;")
    };
    let rest: String = messages.iter().map(send).collect();
    for output in 1..=127 {
        machine.watch("f", output);
    }
    assert_eq!(machine.load(&rest), [], "{function}");
    machine.tick(0.995, 60, 1000);
    let sent = machine
        .drain_watched()
        .map(|watched| (watched.output, watched.value))
        .collect();
    let reports: Vec<_> = machine.reports().iter().map(ToString::to_string).collect();
    (sent, reports.join("; "))
}

/// The same literal the row has, read back; `M4X3` followed by twelve numbers stands for the kind that has
/// no literal everywhere.
fn expected(text: &str) -> Value {
    if let Some(rows) = text.strip_prefix("M4X3 ") {
        let mut n: Vec<f64> = rows.split(' ').map(|n| n.parse().expect("a number")).collect();
        n.extend([0.0, 0.0, 0.0, 1.0]);
        let columns: [f64; 16] = n.try_into().expect("twelve numbers");
        return Value::from(glam::DAffine3::from_mat4(
            DMat4::from_cols_array(&columns).transpose(),
        ));
    }
    let mut machine = Machine::new();
    assert_eq!(machine.load(&format!("VARIABLE v; STORE {text} IN <1>v;")), []);
    machine.held("v").expect("just stored").clone()
}

fn components(value: &Value) -> Vec<f64> {
    match value {
        Value::Real(x) => vec![*x],
        Value::Vector2(v) => v.to_array().to_vec(),
        Value::Vector3(v) => v.to_array().to_vec(),
        Value::Vector4(v) => v.to_array().to_vec(),
        Value::Matrix2(m) => m.to_cols_array().to_vec(),
        Value::Matrix3(m) => m.to_cols_array().to_vec(),
        Value::Matrix4(m) => m.to_cols_array().to_vec(),
        Value::Matrix4x3(m) => m.to_cols_array().to_vec(),
        _ => Vec::new(),
    }
}

fn alike(a: &Value, b: &Value) -> bool {
    let (x, y) = (components(a), components(b));
    let near = x.len() == y.len() && x.iter().zip(&y).all(|(x, y)| (x - y).abs() < 1e-12);
    a.kind() == b.kind() && if x.is_empty() { a == b } else { near }
}

#[test]
fn functions_do_what_the_table_says() {
    for (function, messages, want, report) in ROWS {
        let (got, reports) = outcome(function, messages);
        let shown: Vec<_> = got
            .iter()
            .map(|(output, value)| format!("<{output}> {}", literal(value)))
            .collect();
        assert_eq!(
            got.len(),
            want.len(),
            "F:{function} {messages:?}: got {shown:?}, {reports}"
        );
        for ((output, value), want) in got.iter().zip(*want) {
            let (port, text) = want.split_once(' ').expect("an output and a literal");
            let right = port == format!("<{output}>") && alike(value, &expected(text));
            assert!(right, "F:{function} {messages:?}: got {shown:?}, wanted {want}");
        }
        assert!(
            reports.contains(report),
            "F:{function} {messages:?}: {reports:?} lacks {report:?}"
        );
        assert_eq!(
            reports.is_empty(),
            report.is_empty(),
            "F:{function} {messages:?}: {reports:?}"
        );
    }
}

#[test]
fn every_function_has_a_row() {
    for spec in intrinsic::table() {
        let tested = ROWS
            .iter()
            .any(|(function, ..)| function.split('(').next() == Some(spec.name));
        assert!(tested, "F:{} has no row", spec.name);
    }
}

#[test]
fn names_are_unique_and_rows_are_complete() {
    let mut names: Vec<_> = intrinsic::table().map(|spec| spec.name).collect();
    names.extend(intrinsic::ABSENT.iter().map(|absent| absent.name));
    let count = names.len();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), count);
    for spec in intrinsic::table() {
        assert!(
            !spec.behaviour.is_empty() && !spec.source.is_empty(),
            "F:{}",
            spec.name
        );
        let size = spec.sizes.map_or(0, |(least, _)| least);
        assert!(spec.inputs_of(size).count() > 0, "F:{}", spec.name);
    }
}

/// A value no input of one kind takes: every typed input refuses it by name and goes on.
#[test]
fn every_typed_input_refuses_other_kinds_and_goes_on() {
    for spec in intrinsic::table() {
        let size = spec.sizes.map_or(0, |(least, _)| least);
        for (number, input) in (1..).zip(spec.inputs_of(size)) {
            let wrong = [Value::Boolean(true), Value::from("text")]
                .into_iter()
                .find(|value| !input.kinds.has(value.kind()));
            let Some(wrong) = wrong else { continue };
            let mut machine = Machine::new();
            let sized = if size > 0 {
                format!("({size})")
            } else {
                String::new()
            };
            assert_eq!(
                machine.load(&format!("f := F:{}{sized}; n := F:NOP;", spec.name)),
                []
            );
            let refused = machine.send("f", Input::Number(number), wrong.clone());
            assert!(refused.is_err(), "F:{} <{number}>", spec.name);
            assert_eq!(machine.load(&format!("CONNECT n<1>:<{number}>f;")), []);
            machine
                .send("n", Input::Number(1), wrong.clone())
                .expect("NOP takes everything");
            machine.tick(0.0, 0, 10);
            let reports = machine.reports();
            assert_eq!(reports.len(), 1, "F:{} <{number}>", spec.name);
            let text = reports[0].to_string();
            assert!(
                text.contains(&format!("f (F:{}{sized}): input <{number}> takes", spec.name)),
                "{text}"
            );
            assert!(text.contains(&format!("got {}", wrong.kind())), "{text}");
        }
    }
}
