//! What the tree draws, in closed form: depth, levels, blinking, dashes, letters, curves, faces, picks.

use glam::{DMat4, DVec2, DVec3};
use proptest::prelude::*;
use ps300::display::{DisplayList, Fill};
use ps300::language::Input;
use ps300::{Machine, Value};

fn machine(program: &str) -> Machine {
    let mut machine = Machine::new();
    let diagnostics = machine.load(program);
    assert!(diagnostics.is_empty(), "{program}\n{diagnostics:?}");
    machine
}

fn shown(program: &str) -> DisplayList {
    machine(program).display()
}

/// x of both ends of every stroke.
fn xs(list: &DisplayList) -> Vec<[f64; 2]> {
    list.strokes.iter().map(|s| [s.from.x, s.to.x]).collect()
}

fn near(a: [f64; 2], b: [f64; 2]) -> bool {
    a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-9)
}

const LINE: &str = "l := VECTOR_LIST N=2 0,0,2 0,0,6; ";

#[test]
fn brightness_falls_from_front_to_back() {
    // Depth is 0 at z = 2 and 1 at z = 6; (far, near) and what both ends of a line between them show.
    for (above, wanted) in [
        ("SET INTENSITY ON 0.2:0.8", [0.8, 0.2]),
        ("SET INTENSITY OFF 0.2:0.8", [1.0, 1.0]),
        (
            "VIEWPORT HORIZONTAL=-1:1 VERTICAL=-1:1 INTENSITY=0.5:1",
            [1.0, 0.5],
        ),
        ("SET CONTRAST TO 0.5", [1.0, 1.0]),
    ] {
        let list = shown(&format!(
            "{LINE} w := WINDOW X=-1:1 Y=-1:1 FRONT BOUNDARY=2 BACK BOUNDARY=6 THEN l; a := {above} THEN w; DISPLAY a;"
        ));
        assert!(
            near(list.strokes[0].intensity, wanted),
            "{above}: {:?}",
            list.strokes
        );
    }
    let list = shown(&format!(
        "{LINE} w := WINDOW X=-1:1 Y=-1:1 FRONT BOUNDARY=2 BACK BOUNDARY=6 THEN c; c := SET CONTRAST TO 0.5 THEN i;
         i := SET INTENSITY ON 0:1 THEN l; DISPLAY w;"
    ));
    assert!(near(list.strokes[0].intensity, [1.0, 0.5]));
}

#[test]
fn depth_is_cut_only_where_that_is_set() {
    let program = "l := VECTOR_LIST N=2 0,0,-2 0,0,10; d := SET DEPTH_CLIPPING OFF THEN w;
        w := WINDOW X=-1:1 Y=-1:1 FRONT BOUNDARY=2 BACK BOUNDARY=6 THEN l; DISPLAY d;";
    let mut m = machine(program);
    let z = |m: &Machine| m.display().strokes.iter().map(|s| [s.from.z, s.to.z]).next();
    assert_eq!(z(&m), Some([-2.0, 10.0]));
    m.load("SEND TRUE TO <1>d;");
    assert!(near(z(&m).expect("part of it is seen"), [2.0, 6.0]));
    let list = shown("l := VECTOR_LIST N=2 -3,0 3,0; w := WINDOW X=-1:1 Y=-1:1 THEN l; DISPLAY w;");
    assert!(near(xs(&list)[0], [-1.0, 1.0]));
}

#[test]
fn levels_of_detail_choose() {
    for (level, wanted) in [("TO 0", 1), ("TO 1", 2), ("TO 2", 1)] {
        let list = shown(&format!(
            "a := VECTOR_LIST N=2 0,0 1,0; low := IF LEVEL_OF_DETAIL < 2 THEN a; one := IF LEVEL_OF_DETAIL = 1 THEN a;
             two := IF LEVEL_OF_DETAIL >= 2 THEN a; all := INSTANCE OF low, one, two;
             s := SET LEVEL_OF_DETAIL {level} THEN all; DISPLAY s;"
        ));
        assert_eq!(list.strokes.len(), wanted, "{level}");
    }
    let mut m = machine(
        "a := VECTOR_LIST N=2 0,0 1,0; i := IF LEVEL_OF_DETAIL = 3 THEN a; up := INCREMENT LEVEL_OF_DETAIL THEN i;
         down := DECREMENT LEVEL_OF_DETAIL THEN up; s := SET LEVEL_OF_DETAIL TO 3 THEN down; DISPLAY s;",
    );
    assert_eq!(m.display().strokes.len(), 1);
    m.load("SEND FIX(2) TO <1>up; SEND FIX(2) TO <1>s;");
    assert_eq!(m.display().strokes.len(), 1);
    m.load("SEND FIX(0) TO <1>s;");
    assert_eq!(m.display().strokes.len(), 0);
}

#[test]
fn what_blinks_goes_by_displayed_frames() {
    let mut m = machine(
        "a := VECTOR_LIST N=2 0,0 1,0; i := IF PHASE IS ON THEN a; r := SET RATE 3 2 OFF 4 THEN i; DISPLAY r;",
    );
    let mut seen = Vec::new();
    let mut revisions = vec![m.picture_revision()];
    for frame in 0..16 {
        m.tick(f64::from(frame) / 60.0, frame as u64, 10);
        seen.push(m.display().strokes.len());
        revisions.push(m.picture_revision());
    }
    // Off for the delay of four, then three on, two off.
    assert_eq!(seen, [0, 0, 0, 0, 1, 1, 1, 0, 0, 1, 1, 1, 0, 0, 1, 1]);
    for (frame, pair) in seen.windows(2).enumerate() {
        let changed = revisions[frame + 2] != revisions[frame + 1];
        assert_eq!(changed, pair[0] != pair[1], "frame {frame}");
    }
    let mut m = machine(
        "a := VECTOR_LIST N=2 0,0 1,0; i := IF PHASE IS OFF THEN a; r := SET RATE EXTERNAL THEN i; DISPLAY r;",
    );
    assert_eq!(m.display().strokes.len(), 0);
    m.load("SEND FALSE TO <1>r;");
    assert_eq!(m.display().strokes.len(), 1);
}

#[test]
fn patterns_dash_lists_and_curves() {
    let mut m = machine(
        "p := PATTERN 1 1 NOMATCH LENGTH 2; l := VECTOR_LIST N=2 0,0 5,0; c := BSPLINE ORDER=2 0,0 4,0 CHORDS=1;
         PATTERN l WITH p; DISPLAY l;",
    );
    assert_eq!(xs(&m.display()), [[0.0, 1.0], [2.0, 3.0], [4.0, 5.0]]);
    let again = machine(&m.network_text());
    assert_eq!(again.display(), m.display());
    m.load("PATTERN c WITH p; REMOVE l; DISPLAY c;");
    assert_eq!(xs(&m.display()), [[0.0, 1.0], [2.0, 3.0]]);
    let list = shown("l := VECTOR_LIST N=2 0,0 0.1,0; t := SET LINE_TEXTURE 64 THEN l; DISPLAY t;");
    assert!(near(xs(&list)[0], [0.0, 0.1 / 7.0]) && list.strokes.len() == 1);
}

#[test]
fn letters_are_strokes_of_a_font() {
    let program = "own := BEGIN_FONT C[65]: N=2 P 0,0 L 0.5,1; END_FONT; t := CHARACTERS 1,0 'AA'; f := CHARACTER FONT own THEN t;
        s := CHARACTER SCALE 2 THEN f; DISPLAY s;";
    assert_eq!(xs(&shown(program)), [[1.0, 2.0], [3.0, 4.0]]);
    let standard = shown("t := CHARACTERS 'A'; DISPLAY t;");
    assert!(standard.strokes.len() >= 3);
    let turned = shown("t := LABELS 0,0 'I' 5,5 'I'; r := CHARACTER ROTATE 90 THEN t; DISPLAY r;");
    let beyond = turned.strokes.iter().filter(|s| s.to.x > 3.0).count();
    assert_eq!(beyond * 2, turned.strokes.len());
    let sized =
        shown("t := CHARACTERS 'L'; z := TEXT SIZE 1 THEN t; s := CHARACTER SCALE 9 THEN z; DISPLAY s;");
    assert_eq!(sized.strokes, shown("t := CHARACTERS 'L'; DISPLAY t;").strokes);
}

#[test]
fn curves_and_labels_are_edited_by_message() {
    let mut m = machine("c := BSPLINE ORDER=2 0,0 1,0 CHORDS=1; t := LABELS 0,0 'I'; DISPLAY c;");
    m.load("SEND V2D(3,0) TO <last>c;");
    assert_eq!(xs(&m.display()), [[0.0, 3.0]]);
    m.load("SEND V2D(4,0) TO <append>c; SEND V2D(1,0) TO <1>c; SEND FIX(1) TO <delete>c;");
    assert_eq!(xs(&m.display()), [[1.0, 3.0]]);
    m.load("REMOVE c; DISPLAY t; SEND 'I' TO <append>t; SEND V2D(7,0) TO <position>t; SEND '' TO <1>t;");
    assert!(m.display().strokes.iter().all(|s| s.to.x >= 7.0));
    let text = m.network_text_with_state();
    assert_eq!(machine(&text).display(), m.display());
}

const CUBE: &str = "
cube := POLYGON -1,-1,-1 -1,1,-1 1,1,-1 1,-1,-1 POLYGON 1,-1,1 1,1,1 -1,1,1 -1,-1,1
  POLYGON -1,-1,1 -1,1,1 -1,1,-1 -1,-1,-1 POLYGON 1,-1,-1 1,1,-1 1,1,1 1,-1,1
  POLYGON -1,1,-1 -1,1,1 1,1,1 1,1,-1 POLYGON -1,-1,1 -1,-1,-1 1,-1,-1 1,-1,1;
plane := POLYGON -2,-2,0 -2,2,0 2,2,0 2,-2,0; cut := SECTIONING_PLANE THEN plane;
parts := INSTANCE OF cut, cube; solid := SOLID_RENDERING THEN parts;
w := WINDOW X=-4:4 Y=-4:4 FRONT BOUNDARY=-4 BACK BOUNDARY=4 THEN solid; DISPLAY w;
";

#[test]
fn rendering_nodes_do_as_they_are_told_and_say_when() {
    let mut m = machine(CUBE);
    assert_eq!((m.display().strokes.len(), m.display().faces.len()), (28, 0));
    m.load("told := F:NOP; CONNECT solid<1>:<1>told; SEND FIX(3) TO <1>solid;");
    assert!(m.watch("told", 1));
    for (message, fill, one_sided) in [
        ("FIX(3)", Fill::Empty, true),
        ("FIX(4)", Fill::Hides, true),
        ("FIX(5)", Fill::Wash, true),
        ("FIX(6)", Fill::Flat, true),
        ("FIX(7)", Fill::Smooth, true),
    ] {
        m.load(&format!("SEND {message} TO <1>solid;"));
        let list = m.display();
        assert_eq!(list.faces.len(), 6, "{message}");
        assert!(
            list.faces
                .iter()
                .all(|f| f.fill == fill && f.one_sided == one_sided)
        );
    }
    assert_eq!(m.drain_watched().count(), 5);
    m.load("SEND FALSE TO <2>solid;");
    assert!(m.display().faces.iter().all(|face| !face.one_sided));
    m.load("SEND FALSE TO <1>solid;");
    assert!(m.display().faces.is_empty());
    m.load("SEND TRUE TO <1>solid;");
    assert_eq!(m.display().faces[0].fill, Fill::Smooth);
    m.load("SEND FIX(0) TO <1>solid;");
    assert!(m.display().faces.is_empty());
    let again = machine(&m.network_text_with_state());
    assert_eq!(
        (again.display(), again.connections()),
        (m.display(), m.connections())
    );
    m.load("SEND FIX(8) TO <1>solid;");
    assert_eq!(m.reports().len(), 1);
}

/// What a node sends could only be watched once something had been connected to it, and afterwards for ever.
#[test]
fn a_rendering_node_is_watched_whether_or_not_it_is_connected() {
    let text = "f := VECTOR_LIST N=2 0,0 1,1; s := SURFACE_RENDERING THEN f; n := F:NOP;";
    let mut machine = Machine::new();
    assert_eq!(machine.load(text), []);
    let listed = machine.instances().len();
    assert!(machine.watch("s", 1), "it has an output");
    assert!(!machine.watch("f", 1), "it has none");
    assert_eq!(machine.load("SEND FIX(3) TO <1>s;"), []);
    assert_eq!(machine.drain_watched().count(), 1);
    assert_eq!(machine.load("CONNECT s<1>:<1>n; DISCONNECT s<1>:<1>n;"), []);
    assert_eq!(machine.instances().len(), listed, "a node is not a function");
}

#[test]
fn a_section_keeps_what_is_behind_its_plane_and_closes_it() {
    let mut m = machine(CUBE);
    m.load("SEND FIX(2) TO <1>solid;");
    let list = m.display();
    // The plane looks clockwise from the front: what is farther stays, five sides and the cut itself.
    assert!(list.corners.iter().all(|corner| corner.at.z >= -1e-9));
    assert_eq!(list.faces.len(), 6);
    m.load("SEND FIX(1) TO <1>solid;");
    let list = m.display();
    assert_eq!(list.faces.len(), 1);
    assert_eq!(list.edges.len(), 4);
    assert!(
        list.edges
            .iter()
            .all(|edge| edge.from.z == 0.0 && edge.to.z == 0.0)
    );
}

#[test]
fn lights_shine_where_they_stand() {
    let list = shown(
        "f := POLYGON 0,0,0 0,1,0 1,0,0; sun := ILLUMINATION 0,0,-2 COLOR 120,1,1 AMBIENT 0.5; turned := ROTATE IN Y 90 THEN sun;
         a := INSTANCE OF turned, f; s := SURFACE_RENDERING THEN a; DISPLAY s; VARIABLE v;",
    );
    assert!(list.lights.is_empty() && list.faces.is_empty());
    let mut m = machine(
        "f := POLYGON 0,0,0 0,1,0 1,0,0; sun := ILLUMINATION 0,0,-2 COLOR 120,1,1 AMBIENT 0.5; turned := ROTATE IN Y 90 THEN sun;
         a := INSTANCE OF turned, f; s := SURFACE_RENDERING THEN a; DISPLAY s;",
    );
    m.load("SEND FIX(6) TO <1>s;");
    let list = m.display();
    assert_eq!(list.faces[0].lights, 0..1);
    let light = list.lights[0];
    assert!((light.towards - DVec3::NEG_X).length() < 1e-12);
    assert_eq!((light.colour, light.ambient), (DVec3::X, 0.5));
}

#[test]
fn picks_find_the_nearest_and_say_where() {
    let mut m = machine(
        "a := VECTOR_LIST N=3 -1,0 0,0 1,0; b := VECTOR_LIST N=2 0,0.05 1,0.05; c := SET PICKING OFF THEN b;
         ida := SET PICKING IDENTIFIER=a_line THEN a; both := INSTANCE OF c, ida; on := SET PICKING ON THEN both;
         t := TRANSLATE BY 0.1,0.2 THEN on; DISPLAY t; info := F:PICKINFO; CONNECT PICK<1>:<1>info;
         SEND TRUE TO <2>PICK; SEND V2D(0.1,0.1) TO <2>PICK_LOCATION;",
    );
    for output in 1..=9 {
        m.watch("info", output);
    }
    m.emit("TABLETIN", 1, DVec2::new(0.6, 0.22));
    m.settle();
    m.load("SEND TRUE TO <1>PICK;");
    let got: Vec<_> = m.drain_watched().map(|w| (w.output, w.value)).collect();
    assert_eq!(got[0], (1, Value::Integer(3)));
    assert_eq!(got[1], (2, Value::from("a_line")));
    let Value::Vector2(at) = &got[2].1 else {
        panic!("{got:?}");
    };
    assert!((*at - DVec2::new(0.5, 0.0)).length() < 1e-12, "{at}");
    m.set_camera(DMat4::from_translation(DVec3::new(0.0, 9.0, 0.0)));
    m.watch("PICK", 2);
    m.load("SEND TRUE TO <1>PICK;");
    let got: Vec<_> = m
        .drain_watched()
        .map(|w| (w.name.to_string(), w.output))
        .collect();
    assert_eq!(got, [("PICK".to_owned(), 2)]);
}

#[test]
fn a_cursor_is_shown_where_the_tablet_is() {
    let mut m = machine("CURSOR := VECTOR_LIST N=2 0,0 0.1,0;");
    m.emit("TABLETIN", 1, DVec2::new(0.5, 0.25));
    let before = m.picture_revision();
    m.tick(0.1, 1, 100);
    assert_ne!(m.picture_revision(), before);
    let list = m.display();
    assert!(near(xs(&list)[0], [0.5, 0.6]));
    assert_eq!(list.views[0].screen_from_world, Some(DMat4::IDENTITY));
}

const PARTS: [&str; 24] = [
    "VECTOR_LIST N=3 0,0,0 1,1,1 2,0,1",
    "VECTOR_LIST ITEMIZED COLOR N=2 P 0,0 L 1,1 I=120",
    "LABELS 0,0 'ab' 1,1 'c'",
    "CHARACTERS 'xyz'",
    "BSPLINE ORDER=4 CLOSED 0,0 1,0 1,1 0,1 CHORDS=9",
    "RATIONAL POLYNOMIAL ORDER=1 0,1,1 1,0,0 CHORDS=5",
    "POLYGON S 0,0,0 0,1,0 1,1,0 POLYGON COPLANAR 0.2,0.4,0 0.2,0.6,0 0.4,0.6,0",
    "ILLUMINATION 0,0,-1",
    "WINDOW X=-1:1 Y=-1:1 FRONT BOUNDARY=0 BACK BOUNDARY=2 THEN a",
    "FIELD_OF_VIEW 60 FRONT BOUNDARY=1 BACK BOUNDARY=5 THEN b",
    "EYE BACK 2 RIGHT 1 FROM SCREEN AREA 3 WIDE THEN c",
    "LOOK AT 0,0,0 FROM 0,0,-3 THEN a",
    "SET DEPTH_CLIPPING ON THEN b",
    "SET RATE 1 2 THEN c",
    "IF PHASE IS ON THEN a",
    "SOLID_RENDERING THEN b",
    "SECTIONING_PLANE THEN c",
    "XFORM VECTOR_LIST THEN a",
    "INCREMENT LEVEL_OF_DETAIL THEN b",
    "CHARACTER SCALE 0 THEN c",
    "SCALE BY 0,1,1 THEN a",
    "SET PICKING ON THEN b",
    "INSTANCE OF a, b, c",
    "BEGIN_STRUCTURE SOLID_RENDERING; INSTANCE OF a, c; SECTIONING_PLANE; INSTANCE OF b; END_STRUCTURE",
];

proptest! {
    #![proptest_config(ProptestConfig { cases: 96, failure_persistence: None, ..ProptestConfig::default() })]

    /// Whatever tree: it is walked to its end, everything drawn is a number, and picks and transforms answer.
    #[test]
    fn random_trees_are_drawn_and_end(dice in prop::collection::vec(any::<[u8; 3]>(), 1..24), code in -1_i32..9) {
        let mut m = Machine::new();
        let names = ["a", "b", "c", "d", "e"];
        for [name, part, other] in &dice {
            let name = names[usize::from(*name) % 5];
            let part = PARTS[usize::from(*part) % PARTS.len()];
            let other = names[usize::from(*other) % 5];
            m.load(&format!("{name} := {part}; DISPLAY {other};"));
            let _ = m.send(name, Input::Number(1), Value::Integer(code));
        }
        m.load("x := F:XFORMDATA; SEND 'd' TO <2>x; SEND TRUE TO <1>x; SEND V2D(1,1) TO <2>PICK_LOCATION; SEND TRUE TO <1>PICK;");
        m.tick(0.1, u64::from(dice[0][0]), 1000);
        let list = m.display();
        for stroke in list.strokes.iter().chain(&list.edges) {
            prop_assert!(stroke.from.is_finite() && stroke.to.is_finite(), "{stroke:?}");
            prop_assert!(stroke.intensity.iter().all(|i| (0.0..=1.0).contains(i)), "{stroke:?}");
        }
        for face in &list.faces {
            prop_assert!(list.corners.get(face.corners.start as usize..face.corners.end as usize).is_some());
            prop_assert!(list.lights.get(usize::from(face.lights.start)..usize::from(face.lights.end)).is_some());
        }
        prop_assert!(list.corners.iter().all(|corner| corner.at.is_finite() && corner.normal.is_finite()));
    }
}
