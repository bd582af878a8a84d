//! The display tree: what is drawn, what messages change, what is refused.

use std::fmt::Write;

use glam::{DMat3, DMat4, DVec3};
use ps300::display::{Cut, DisplayList};
use ps300::language::Input;
use ps300::{Machine, Stroke, Value};

fn machine(program: &str) -> Machine {
    let mut machine = Machine::new();
    let diagnostics = machine.load(program);
    assert!(diagnostics.is_empty(), "{diagnostics:?}");
    machine
}

fn ends(list: &DisplayList) -> Vec<(DVec3, DVec3)> {
    list.strokes
        .iter()
        .map(|stroke| (stroke.from, stroke.to))
        .collect()
}

fn near(a: DVec3, b: [f64; 3]) -> bool {
    (a - DVec3::from_array(b)).length() < 1e-12
}

/// The figure parts shipped with the thesis: shared lines under colours, scales and instances.
const PARTS: &str = "
    linel := vector connected n=2 0,0,0 0,0,0.1;
    line := set color 60,1 then linel;
    trl := vector connected n=4 -0.05,0,0 0.05,0,0 0,0,0.1 -0.05,0,0;
    tr := set color 90,1 then trl;
    rxtr := rot x 180 then tr;
    itr := trans by 0,0,0.1 then rxtr;
    head := scale by 1,1,2 then tr;
    rua := scale by 2.0 then line;
    lua := inst of rua;
    pelv := scale by 0.9,1,1 then itr;
";

#[test]
fn the_parts_of_the_printed_figure_are_drawn() {
    let m = machine(PARTS);
    let arm = m.display_of("LUA", DMat4::from_translation(DVec3::X));
    let expected = Stroke {
        from: DVec3::X,
        to: DVec3::new(1.0, 0.0, 0.2),
        hue_deg: 60.0,
        saturation: 1.0,
        intensity: [1.0; 2],
        view: 0,
    };
    assert_eq!(arm.strokes, [expected]);
    assert_eq!(arm.views[0].screen_from_world, None);
    let pelvis = m.display_of("pelv", DMat4::IDENTITY);
    assert_eq!(pelvis.strokes.len(), 3);
    // Scaled, lifted, then turned half round: the tip points down to the origin.
    assert!(near(pelvis.strokes[0].from, [-0.045, 0.0, 0.1]));
    assert!(near(pelvis.strokes[1].to, [0.0, 0.0, 0.0]));
    assert_eq!(m.display(), DisplayList::default());
}

#[test]
fn state_holds_below_and_is_restored_beside() {
    let m = machine(
        "dot := VECTOR_LIST DOTS N=1 1,0,0; red := SET COLOR 120,1 THEN dot; both := INSTANCE OF red, dot;
         s := BEGIN_STRUCTURE TRANSLATE BY 0,1,0; INSTANCE OF dot; SET COLOR 240,1; SCALE BY 2; INSTANCE OF dot; END_STRUCTURE;
         all := INSTANCE OF both, s, dot; DISPLAY all;",
    );
    let list = m.display();
    let seen: Vec<_> = list
        .strokes
        .iter()
        .map(|s| (s.to.to_array(), s.hue_deg))
        .collect();
    assert_eq!(
        seen,
        [
            ([1.0, 0.0, 0.0], 120.0),
            ([1.0, 0.0, 0.0], 0.0),
            ([1.0, 1.0, 0.0], 0.0),
            ([2.0, 1.0, 0.0], 240.0),
            ([1.0, 0.0, 0.0], 0.0),
        ]
    );
    assert!(list.strokes.iter().all(|s| s.from == s.to));
}

#[test]
fn classes_of_vectors_decide_what_is_drawn() {
    let m = machine(
        "c := VECTOR_LIST CONNECTED N=3 0,0 1,0 2,0; s := VECTOR_LIST SEPARATE N=4 0,0 1,0 2,0 3,0;
         d := VECTOR_LIST DOTS N=2 0,0 1,0; i := VECTOR_LIST ITEMIZED N=4 P 0,0 L 1,0 P 2,0 L 3,0;
         DISPLAY c; DISPLAY s; DISPLAY d; DISPLAY i;",
    );
    let xs: Vec<_> = ends(&m.display())
        .iter()
        .map(|(from, to)| (from.x, to.x))
        .collect();
    let (c, s, d) = (
        [(0.0, 1.0), (1.0, 2.0)],
        [(0.0, 1.0), (2.0, 3.0)],
        [(0.0, 0.0), (1.0, 1.0)],
    );
    assert_eq!(xs, [c, s, d, s].concat());
}

#[test]
fn redefining_a_name_changes_everything_that_refers_to_it() {
    let mut m = machine("DISPLAY top; top := INSTANCE OF part; part := VECTOR_LIST N=2 0,0 1,0;");
    assert_eq!(m.display().strokes.len(), 1);
    m.load("part := VECTOR_LIST N=3 0,0 1,0 2,0;");
    assert_eq!(m.display().strokes.len(), 2);
    m.load("FORGET part;");
    assert_eq!(m.display().strokes.len(), 2);
    m.load("part := NIL;");
    assert_eq!(m.display().strokes.len(), 2);
    m.load("DELETE top;");
    assert_eq!(m.display().strokes.len(), 0);
    m.load("top := VECTOR_LIST N=2 0,0 1,0;");
    assert_eq!(m.display().strokes.len(), 1);
    m.load("REMOVE top;");
    assert_eq!(m.display().strokes.len(), 0);
}

#[test]
fn names_nothing_defines_are_warned_of_at_their_place() {
    let mut m = Machine::new();
    let got: Vec<_> = m
        .load("a := INSTANCE OF b, c;\nb := NIL; DISPLAY d;")
        .iter()
        .map(ToString::to_string)
        .collect();
    assert_eq!(
        got,
        [
            "1:1: warning: c is used here and nothing defines it",
            "2:11: warning: d is used here and nothing defines it"
        ]
    );
    assert_eq!(m.display(), DisplayList::default());
}

#[test]
fn what_would_contain_itself_is_refused() {
    let mut m = machine(
        "l := VECTOR_LIST N=2 0,0 1,0; c := INSTANCE OF l; b := SCALE BY 2 THEN c; a := INSTANCE OF b; DISPLAY a;",
    );
    for program in [
        "c := INSTANCE OF l, a;",
        "INCLUDE a IN c;",
        "INCLUDE c IN c;",
        "x := INSTANCE OF x;",
        "l := BEGIN_STRUCTURE m := INSTANCE OF b; END_STRUCTURE;",
    ] {
        let got = m.load(program);
        assert!(
            got.len() == 1 && got[0].message.contains("would contain itself"),
            "{program} {got:?}"
        );
    }
    assert_eq!(m.display().strokes.len(), 1);
    assert_eq!(m.display().cuts, []);
}

#[test]
fn include_and_remove_edit_an_instance() {
    let mut m = machine(
        "l := VECTOR_LIST N=2 0,0 1,0; a := INSTANCE OF l; k := VECTOR_LIST N=2 0,0 2,0; INCLUDE k IN a; DISPLAY a;",
    );
    assert_eq!(m.display().strokes.len(), 2);
    m.load("REMOVE l FROM a;");
    assert_eq!(ends(&m.display()), [(DVec3::ZERO, DVec3::new(2.0, 0.0, 0.0))]);
    let got = m.load("REMOVE l FROM a; INCLUDE l IN k;");
    assert!(got[0].message.contains("l is not in a"), "{got:?}");
    assert!(
        got[1].message.contains("k is VECTOR_LIST, not an INSTANCE"),
        "{got:?}"
    );
}

#[test]
fn prefix_stands_above_and_follow_below() {
    let mut m = machine("l := VECTOR_LIST N=2 0,0 1,0; t := TRANSLATE BY 1,0,0 THEN l; DISPLAY t;");
    m.load("PREFIX t WITH SCALE BY 10; FOLLOW t WITH SCALE BY 3;");
    let expected = [(DVec3::new(10.0, 0.0, 0.0), DVec3::new(40.0, 0.0, 0.0))];
    assert_eq!(ends(&m.display()), expected);
    m.load("PREFIX t WITH TRANSLATE BY 0,1,0; FOLLOW t WITH TRANSLATE BY 1,0,0; SEND V3D(2,0,0) TO <1>t;");
    // Outermost first: scale 10, up 1, the node (now 2), along 1, scale 3.
    let expected = [(DVec3::new(30.0, 10.0, 0.0), DVec3::new(60.0, 10.0, 0.0))];
    assert_eq!(ends(&m.display()), expected);
    let again = machine(&m.network_text().replace("BY 1,0,0 THEN l", "BY 2,0,0 THEN l"));
    assert_eq!(again.display_of("t", DMat4::IDENTITY).strokes.len(), 1);
    assert!(
        m.load("FOLLOW l WITH SCALE BY 2;")[0]
            .message
            .contains("not an operation")
    );
}

#[test]
fn conditional_bits_choose_what_is_drawn() {
    let mut m = machine(
        "l := VECTOR_LIST N=2 0,0 1,0; k := VECTOR_LIST N=3 0,0 1,0 2,0;
         on := IF CONDITIONAL_BIT 3 IS ON THEN l; off := IF CONDITIONAL_BIT 3 IS OFF THEN k;
         s := BEGIN_STRUCTURE bit := SET CONDITIONAL_BIT 3 ON; INSTANCE OF on, off; IF CONDITIONAL_BIT 3 IS OFF; INSTANCE OF k; END_STRUCTURE;
         DISPLAY s;",
    );
    assert_eq!(m.display().strokes.len(), 1);
    m.load("SEND FALSE TO <1>s.bit;");
    assert_eq!(m.display().strokes.len(), 4);
}

#[test]
fn views_stand_apart_from_world_space() {
    let mut m = machine(
        "cube := VECTOR_LIST N=2 0,0,0 1,0,0; turned := ROTATE IN Z 90 THEN cube;
         look := LOOK AT 0,0,0 FROM 0,0,-5 THEN turned; fov := FIELD_OF_VIEW 90 FRONT BOUNDARY=1 BACK BOUNDARY=9 THEN look;
         port := VIEWPORT HORIZONTAL=0:1 VERTICAL=-1:1 THEN fov; DISPLAY port; DISPLAY turned;",
    );
    let list = m.display();
    assert_eq!(list.views.len(), 2);
    assert_eq!(list.views[0].viewport.horizontal, [0.0, 1.0]);
    assert!(near(list.strokes[0].to, [0.0, 1.0, 0.0]) && near(list.strokes[1].to, [0.0, 1.0, 0.0]));
    let screen = list.views[0].screen_from_world.expect("two viewing nodes");
    let seen = screen.project_point3(list.strokes[0].to);
    assert!((seen.y - 0.2).abs() < 1e-12, "{seen}");
    m.load("w := F:WINDOW; SEND -2 TO <2>w; SEND 2 TO <3>w; SEND -2 TO <4>w; SEND 2 TO <5>w; SEND 0 TO <6>w; SEND 9 TO <7>w;
            CONNECT w<1>:<1>fov; SEND TRUE TO <1>w;");
    let list = m.display();
    let screen = list.views[0].screen_from_world.expect("still two");
    assert!((screen.project_point3(list.strokes[0].to).y - 0.5).abs() < 1e-12);
}

#[test]
fn views_that_are_none_are_refused_with_the_reason() {
    let mut m = Machine::new();
    let got = m.load(
        "a := LOOK AT 1,1,1 FROM 1,1,1 THEN b; w := WINDOW X=1:1 Y=0:1 THEN b; f := FIELD_OF_VIEW 0 THEN b;",
    );
    let text: Vec<_> = got.iter().map(|d| d.message.as_str()).collect();
    assert!(
        text[0].contains("a: the eye is at the point it looks at"),
        "{text:?}"
    );
    assert!(
        text[1].contains("width") && text[2].contains("between 0 and 180"),
        "{text:?}"
    );
}

#[test]
fn messages_change_nodes_and_leave_the_program() {
    let mut m = machine(
        "l := VECTOR_LIST N=2 0,0,0 1,0,0; s := SCALE BY 1 THEN l; c := SET COLOR 0,0 THEN s; i := SET INTENSITY ON 0.5:1 THEN c; DISPLAY i;",
    );
    let before = m.network_text();
    let revision = m.picture_revision();
    m.load("SEND 3 TO <1>s; SEND V2D(200,0.5) TO <1>c; SEND 0.25 TO <2>c; SEND V2D(0,0.5) TO <2>i;");
    let stroke = m.display().strokes[0];
    assert_eq!(
        (stroke.to.x, stroke.hue_deg, stroke.saturation, stroke.intensity),
        (3.0, 200.0, 0.25, [0.5; 2])
    );
    // Without a projection of its own, what is farther is the host's affair.
    assert_eq!(m.display().views[0].cue, Some([0.0, 0.5]));
    m.load("SEND V3D(4,1,1) TO <1>s;");
    assert_eq!(m.display().strokes[0].to.x, 4.0);
    m.send("s", Input::Number(1), DMat3::from_diagonal(DVec3::splat(5.0)))
        .unwrap();
    assert_eq!(m.display().strokes[0].to.x, 5.0);
    assert!(m.picture_revision() > revision);
    assert_eq!(m.network_text(), before);
    assert!(m.send("s", Input::Number(1), Value::Boolean(true)).is_err());
}

#[test]
fn vector_lists_are_inked_by_message() {
    let mut m = machine("ink := VECTOR_LIST CONNECTED N=2 0,0 1,0; DISPLAY ink;");
    let xs = |m: &Machine| -> Vec<_> {
        ends(&m.display())
            .iter()
            .map(|(from, to)| (from.x, to.x))
            .collect()
    };
    m.load("SEND V2D(2,0) TO <append>ink; SEND V3D(3,0,0) TO <append>ink;");
    assert_eq!(xs(&m), [(0.0, 1.0), (1.0, 2.0), (2.0, 3.0)]);
    m.load("SEND V2D(9,0) TO <last>ink; SEND V2D(5,0) TO <2>ink; SEND FIX(1) TO <delete>ink;");
    assert_eq!(xs(&m), [(0.0, 5.0), (5.0, 2.0)]);
    m.load("SEND V2D(7,0) TO <position>ink; SEND V2D(8,0) TO <append>ink;");
    assert_eq!(xs(&m), [(0.0, 5.0), (5.0, 2.0), (7.0, 8.0)]);
    m.load("SEND V2D(0,0) TO <99>ink; SEND FIX(-1) TO <delete>ink;");
    let reports: Vec<_> = m.reports().iter().map(ToString::to_string).collect();
    assert_eq!(
        reports,
        [
            "the vector list has no vector of that number; input <99> had V2D(0,0)",
            "a count of deletions is not negative; input <delete> had FIX(-1)"
        ]
        .map(|why| format!(
            "ink (VECTOR_LIST node, made at line 1 \"ink := VECTOR_LIST CONNECTED N=2 0,0 1,0;\"): {why}"
        ))
    );
    m.load("SEND TRUE TO <clear>ink; SEND FIX(9) TO <delete>ink; SEND V2D(1,0) TO <append>ink; SEND V2D(2,0) TO <append>ink;");
    assert_eq!(xs(&m), [(1.0, 2.0)]);
}

#[test]
fn characters_are_placed_and_rewritten() {
    let mut m = machine("t := CHARACTERS 1,2 STEP 1,0 'abc'; s := SCALE BY 2 THEN t; DISPLAY s;");
    m.load("SEND 'de' TO <append>t; SEND FIX(1) TO <delete>t; SEND 'X' TO <1>t; SEND 'Z' TO <last>t; SEND V2D(0,-1) TO <step>t; SEND V2D(3,3) TO <position>t;");
    let written = machine("t := CHARACTERS 3,3 STEP 0,-1 'XbcZ'; s := SCALE BY 2 THEN t; DISPLAY s;");
    assert_eq!(m.display().strokes, written.display().strokes);
}

#[test]
fn labels_are_reached_through_their_structure_and_go_with_it() {
    let mut m = machine(
        "s := BEGIN_STRUCTURE r := ROTATE IN Z 0; in := BEGIN_STRUCTURE t := TRANSLATE BY 0,0,0; VECTOR_LIST N=2 0,0 1,0; END_STRUCTURE; END_STRUCTURE; DISPLAY s;",
    );
    m.load("z := F:ZROTATE; CONNECT z<1>:<1>s.r; SEND 90 TO <1>z; SEND V3D(1,0,0) TO <1>s.in.t;");
    let (from, to) = ends(&m.display())[0];
    assert!(
        near(from, [0.0, 1.0, 0.0]) && near(to, [0.0, 2.0, 0.0]),
        "{from} {to}"
    );
    let got = m.load("DELETE s.r;");
    assert!(
        got[0].message.contains("s.r is a label inside a structure"),
        "{got:?}"
    );
    let again = machine(&m.network_text());
    assert_eq!(again.connections(), m.connections());
    m.load("s := NIL;");
    assert!(!m.is_defined("s.r") && m.connections().is_empty());
    assert!(m.load("SEND 0 TO <1>z;").is_empty());
}

#[test]
fn deep_and_wide_trees_are_cut_and_said_so() {
    let mut deep = String::from("n0 := VECTOR_LIST N=2 0,0 1,0;\n");
    for level in 1..2000 {
        let _ = writeln!(deep, "n{level} := SCALE BY 1 THEN n{};", level - 1);
    }
    let m = machine(&deep);
    let list = m.display_of("n1999", DMat4::IDENTITY);
    assert!(
        list.strokes.is_empty() && matches!(list.cuts[..], [Cut::Depth { .. }]),
        "{:?}",
        list.cuts
    );
    assert_eq!(m.display_of("n200", DMat4::IDENTITY).strokes.len(), 1);

    let mut wide = String::from("w0 := VECTOR_LIST N=2 0,0 1,0;\n");
    for level in 1..60 {
        let _ = writeln!(
            wide,
            "w{level} := INSTANCE OF w{0}, v{0}; v{level} := INSTANCE OF w{0};",
            level - 1
        );
    }
    wide.push_str("v0 := NIL; DISPLAY w59;");
    let m = machine(&wide);
    let list = m.display();
    assert!(list.strokes.len() <= 1 << 19);
    assert!(
        list.cuts.iter().any(|cut| matches!(cut, Cut::Size { .. })),
        "{:?}",
        list.cuts
    );
}

#[test]
fn structures_nested_without_end_are_refused() {
    let mut text = String::from("s := ");
    text.push_str(&"BEGIN_STRUCTURE ".repeat(5000));
    text.push_str(&"END_STRUCTURE; ".repeat(5000));
    let mut m = Machine::new();
    assert!(!m.load(&text).is_empty());
}
