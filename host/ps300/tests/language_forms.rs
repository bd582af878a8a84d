//! Forms that mean the same, and the one each is printed as.

use ps300::language::{Name, parse, print};

/// What was written, and its canonical text.
const FORMS: &[(&str, &str)] = &[
    // Functions and connections.
    ("n := F:ADDC;", "n := F:ADDC;"),
    ("Switch:=f:route(4);", "Switch := F:route(4);"),
    ("conn dials<1>:<1>View;", "CONNECT dials<1>:<1>View;"),
    ("disc a<1>:<2>b;", "DISCONNECT a<1>:<2>b;"),
    ("disc a<1>:all;", "DISCONNECT a<1>:ALL;"),
    ("disconnect a:ALL;", "DISCONNECT a:ALL;"),
    ("setup cness true <2>f;", "SETUP CNESS TRUE <2>f;"),
    ("var v,w;", "VARIABLE v,w;"),
    ("connect seg.irx<1>:<1>DLABEL1;", "CONNECT seg.irx<1>:<1>DLABEL1;"),
    // Values.
    ("send 5 to <1>a;", "SEND 5 TO <1>a;"),
    ("send fix(5) to <1>a;", "SEND FIX(5) TO <1>a;"),
    ("send +.5e1 to <1>a;", "SEND 5 TO <1>a;"),
    ("send -0.0 to <1>a;", "SEND -0 TO <1>a;"),
    ("send 1e-300 to <1>a;", "SEND 1e-300 TO <1>a;"),
    ("send true to <1>a;", "SEND TRUE TO <1>a;"),
    ("send 'it''s' to <1>a;", "SEND 'it''s' TO <1>a;"),
    ("send \"it's\" to <1>a;", "SEND 'it''s' TO <1>a;"),
    ("send 'a' char(10) 'b' to <1>a;", "SEND 'a' CHAR(10) 'b' TO <1>a;"),
    ("send char(65) to <1>a;", "SEND 'A' TO <1>a;"),
    ("send '' to <1>a;", "SEND '' TO <1>a;"),
    ("send v2d(1,2) to <append>list;", "SEND V2D(1,2) TO <append>list;"),
    (
        "send v3d( 1, 2, 3 ) to <Last>list;",
        "SEND V3D(1,2,3) TO <last>list;",
    ),
    (
        "send v4d(1,2,3,4) to <300>list;",
        "SEND V4D(1,2,3,4) TO <300>list;",
    ),
    ("send m2d(1,2,3,4) to <1>a;", "SEND M2D(1,2 3,4) TO <1>a;"),
    (
        "send m3d(1,2,3 4,5,6 7,8,9) to <1>a;",
        "SEND M3D(1,2,3 4,5,6 7,8,9) TO <1>a;",
    ),
    (
        "send m4d(1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16) to <1>a;",
        "SEND M4D(1,2,3,4 5,6,7,8 9,10,11,12 13,14,15,16) TO <1>a;",
    ),
    (
        "send m4x3(1,0,0,7 0,1,0,8 0,0,1,9) to <1>a;",
        "SEND M4X3(1,0,0,7 0,1,0,8 0,0,1,9) TO <1>a;",
    ),
    ("send value(v) to <1>a;", "SEND VALUE(v) TO <1>a;"),
    ("store 1.5 in <1>v;", "STORE 1.5 IN <1>v;"),
    // Structure and display.
    ("a := inst b,c;", "a := INSTANCE OF b,c;"),
    ("a := inst;", "a := INSTANCE;"),
    ("incl a in n;", "INCLUDE a IN n;"),
    ("rem a from n;", "REMOVE a FROM n;"),
    ("rem a;", "REMOVE a;"),
    ("disp a;", "DISPLAY a;"),
    ("del a;", "DELETE a;"),
    ("del seg.a*;", "DELETE seg.a*;"),
    ("for a;", "FORGET a;"),
    ("a := nil;", "a := NIL;"),
    (
        "fol a with set cond 3 on;",
        "FOLLOW a WITH SET CONDITIONAL_BIT 3 ON;",
    ),
    ("pre a with rot in z 90;", "PREFIX a WITH ROTATE IN Z 90;"),
    ("init;", "INITIALIZE;"),
    ("init conn;", "INITIALIZE CONNECTIONS;"),
    // Operations.
    (
        "a := rot y -30 applied to b;",
        "a := ROTATE IN Y -30 APPLIED TO b;",
    ),
    ("a := rot y -30 appl b;", "a := ROTATE IN Y -30 APPLIED TO b;"),
    ("a := trans 1,2 then b;", "a := TRANSLATE BY 1,2,0 APPLIED TO b;"),
    ("a := sca by 1,2 then b;", "a := SCALE BY 1,2,1 APPLIED TO b;"),
    ("a := scale by 2,2,2;", "a := SCALE BY 2;"),
    ("a := matrix_2X2 1,2 3,4;", "a := MATRIX_2x2 1,2 3,4;"),
    (
        "a := matrix_4x3 1,0,0,7 0,1,0,8 0,0,1,9;",
        "a := MATRIX_4x3 1,0,0,7 0,1,0,8 0,0,1,9;",
    ),
    (
        "a := look from 0,0,-5 at 0,0,0 then b;",
        "a := LOOK AT 0,0,0 FROM 0,0,-5 APPLIED TO b;",
    ),
    (
        "a := look at 0,0,0 from 0,0,-5 up 0,1,-5;",
        "a := LOOK AT 0,0,0 FROM 0,0,-5 UP 0,1,-5;",
    ),
    ("a := fov 30 then b;", "a := FIELD_OF_VIEW 30 APPLIED TO b;"),
    (
        "a := field_of_view 30 front=1 back bound=10 then b;",
        "a := FIELD_OF_VIEW 30 FRONT BOUNDARY=1 BACK BOUNDARY=10 APPLIED TO b;",
    ),
    ("a := window x=-1:1 y = -2 : 2;", "a := WINDOW X=-1:1 Y=-2:2;"),
    (
        "a := view hor=-1:0 vert=0:1 inten=.5:1 then b;",
        "a := VIEWPORT HORIZONTAL=-1:0 VERTICAL=0:1 INTENSITY=0.5:1 APPLIED TO b;",
    ),
    (
        "a := set inten on .75:1 then b;",
        "a := SET INTENSITY ON 0.75:1 APPLIED TO b;",
    ),
    (
        "a := set depth_cl off then b;",
        "a := SET DEPTH_CLIPPING OFF APPLIED TO b;",
    ),
    ("a := set pick on then b;", "a := SET PICKING ON APPLIED TO b;"),
    (
        "a := set pick id=arm then b;",
        "a := SET PICKING IDENTIFIER=arm APPLIED TO b;",
    ),
    (
        "a := if cond_bit 2 is off then b;",
        "a := IF CONDITIONAL_BIT 2 IS OFF THEN b;",
    ),
    // Data.
    ("a := vec 0,0 1,1;", "a := VECTOR_LIST CONNECTED N=2 0,0 1,1;"),
    (
        "a := vec p 0,0,0 l 1,1,1 i=.5;",
        "a := VECTOR_LIST ITEMIZED N=2 P 0,0,0 L 1,1,1 I=0.5;",
    ),
    (
        "a := vec item 0,0,0 1,1,1;",
        "a := VECTOR_LIST ITEMIZED N=2 P 0,0,0 L 1,1,1;",
    ),
    (
        "a := vec sep block color n=2 0,0,0 1,1,1;",
        "a := VECTOR_LIST SEPARATE BLOCK_NORMALIZED COLOR N=2 0,0,0 1,1,1;",
    ),
    ("a := vec dots;", "a := VECTOR_LIST DOTS N=0;"),
    ("a := char 'x';", "a := CHARACTERS 'x';"),
    (
        "a := char 1,2 step 2,0 'x';",
        "a := CHARACTERS 1,2,0 STEP 2,0 'x';",
    ),
    // Groups and housekeeping.
    ("begin disp a; end;", "BEGIN; DISPLAY a; END;"),
    ("begin; end;", "BEGIN; END;"),
    (
        "opt stru; a := nil; end opt;",
        "OPTIMIZE STRUCTURE; a := NIL; END OPTIMIZE;",
    ),
    (
        "reserve_working_storage 100000;",
        "RESERVE_WORKING_STORAGE 100000;",
    ),
    ("com stat;", "COMMAND STATUS;"),
    ("! reset;", "!RESET;"),
    ("setup state 1,'a',fix(2) in f;", "SETUP STATE 1,'a',FIX(2) IN f;"),
    ("setup state in in;", "SETUP STATE IN in;"),
    ("pat list with dashes;", "PATTERN list WITH dashes;"),
    ("send vl(list) to <1>a;", "SEND VL(list) TO <1>a;"),
    ("send vl(dots) to <1>a;", "SEND VL(dots) TO <1>a;"),
    ("send vl(dots n=0) to <1>a;", "SEND VL(DOTS N=0) TO <1>a;"),
    (
        "send vl(p 0,0 l 1,1 i=.5) to <1>a;",
        "SEND VL(ITEMIZED N=2 P 0,0 L 1,1 I=0.5) TO <1>a;",
    ),
    (
        "send vl(0,0,0 1,1) to <1>a;",
        "SEND VL(CONNECTED N=2 0,0,0 1,1,0) TO <1>a;",
    ),
    // Attributes and conditions.
    (
        "a := eye back 5 from screen area 2 wide;",
        "a := EYE BACK 5 FROM SCREEN AREA 2 WIDE;",
    ),
    (
        "a := eye back 5 left 1 down 2 from screen 2 wide front=1 back=9 then b;",
        "a := EYE BACK 5 LEFT 1 DOWN 2 FROM SCREEN AREA 2 WIDE FRONT BOUNDARY=1 BACK BOUNDARY=9 APPLIED TO b;",
    ),
    (
        "a := eye back 5 right -1 from screen 2 wide;",
        "a := EYE BACK 5 LEFT 1 FROM SCREEN AREA 2 WIDE;",
    ),
    (
        "a := set pick loc=0,0 .1,.1;",
        "a := SET PICKING LOCATION=0,0 0.1,0.1;",
    ),
    ("a := set lev to 3;", "a := SET LEVEL_OF_DETAIL TO 3;"),
    ("a := set lev 3;", "a := SET LEVEL_OF_DETAIL TO 3;"),
    (
        "a := incr lev then b;",
        "a := INCREMENT LEVEL_OF_DETAIL APPLIED TO b;",
    ),
    (
        "a := decr lev then b;",
        "a := DECREMENT LEVEL_OF_DETAIL APPLIED TO b;",
    ),
    ("a := if lev = 1 then b;", "a := IF LEVEL_OF_DETAIL = 1 THEN b;"),
    ("a := if lev<1 then b;", "a := IF LEVEL_OF_DETAIL < 1 THEN b;"),
    (
        "a := if lev < = 1 then b;",
        "a := IF LEVEL_OF_DETAIL <= 1 THEN b;",
    ),
    ("a := if lev>-1 then b;", "a := IF LEVEL_OF_DETAIL > -1 THEN b;"),
    ("a := if lev>=1 appl b;", "a := IF LEVEL_OF_DETAIL >= 1 THEN b;"),
    ("a := if lev<>1 then b;", "a := IF LEVEL_OF_DETAIL <> 1 THEN b;"),
    ("a := set rate 30 10;", "a := SET RATE 30 10;"),
    ("a := set rate 30 10 5;", "a := SET RATE 30 10 5;"),
    (
        "a := set rate 30 10 off then b;",
        "a := SET RATE 30 10 OFF APPLIED TO b;",
    ),
    (
        "a := set rate 30 10 on 5 then b;",
        "a := SET RATE 30 10 ON 5 APPLIED TO b;",
    ),
    ("a := set rate ext;", "a := SET RATE EXTERNAL;"),
    ("a := if phase is off then b;", "a := IF PHASE IS OFF THEN b;"),
    ("a := set contrast .5;", "a := SET CONTRAST TO 0.5;"),
    ("a := set disp 0 off;", "a := SET DISPLAY 0 OFF;"),
    ("a := set plot on;", "a := SET PLOTTER ON;"),
    ("a := set line 85;", "a := SET LINE_TEXTURE 85;"),
    (
        "a := set line around 85;",
        "a := SET LINE_TEXTURE AROUND_CORNERS 85;",
    ),
    ("a := set color blen .5;", "a := SET COLOR BLENDING 0.5;"),
    ("a := xform matrix then b;", "a := XFORM MATRIX APPLIED TO b;"),
    ("a := xform vec then b;", "a := XFORM VECTOR_LIST APPLIED TO b;"),
    ("a := char sca 2 then b;", "a := CHARACTER SCALE 2 APPLIED TO b;"),
    ("a := characters scale 2,3;", "a := CHARACTER SCALE 2,3;"),
    ("a := char rot 90;", "a := CHARACTER ROTATE 90;"),
    (
        "a := char font font then font;",
        "a := CHARACTER FONT font APPLIED TO font;",
    ),
    ("a := stan font;", "a := STANDARD FONT;"),
    ("a := text size .1 then b;", "a := TEXT SIZE 0.1 APPLIED TO b;"),
    (
        "a := surface_rend appl b;",
        "a := SURFACE_RENDERING APPLIED TO b;",
    ),
    ("a := solid_rend then b;", "a := SOLID_RENDERING APPLIED TO b;"),
    ("a := sect then b;", "a := SECTIONING_PLANE APPLIED TO b;"),
    // More data.
    (
        "a := vec tab p 0,0 l 1,1 t=9;",
        "a := VECTOR_LIST TABULATED N=2 P 0,0 L 1,1 T=9;",
    ),
    (
        "a := labels 0,0 'x' 1,1,1 'y' 'z';",
        "a := LABELS 0,0,0 'x' 1,1,1 'yz';",
    ),
    ("a := labels;", "a := LABELS;"),
    (
        "a := pattern 3 1,2 1 around nomatch length=.5;",
        "a := PATTERN 3 1 2 1 AROUND_CORNERS NOMATCH LENGTH 0.5;",
    ),
    ("a := pat 1 1 length 2;", "a := PATTERN 1 1 MATCH LENGTH 2;"),
    (
        "a := bspline order=3 0,0 1,1 2,0 chords=9;",
        "a := BSPLINE ORDER=3 OPEN NONPERIODIC N=3 VERTICES= 0,0 1,1 2,0 CHORDS=9;",
    ),
    (
        "a := bspline order=2 closed n=2 vertices=0,0,1 1,1 knots=0,1 2 chords=9;",
        "a := BSPLINE ORDER=2 CLOSED PERIODIC N=2 VERTICES= 0,0,1 1,1,0 KNOTS= 0 1 2 CHORDS=9;",
    ),
    (
        "a := rat bspline chords=9 order=2 0,0,1 1,1,2 0 1 2;",
        "a := RATIONAL BSPLINE ORDER=2 OPEN NONPERIODIC N=2 VERTICES= 0,0,1 1,1,2 KNOTS= 0 1 2 CHORDS=9;",
    ),
    (
        "a := rat bspline order=2 0,0,1,.5 1,1,2,1 chords=9;",
        "a := RATIONAL BSPLINE ORDER=2 OPEN NONPERIODIC N=2 VERTICES= 0,0,1,0.5 1,1,2,1 CHORDS=9;",
    ),
    (
        "a := poly order=1 coefficients=1,0 0,1 chords=4;",
        "a := POLYNOMIAL ORDER=1 COEFFICIENTS= 1,0 0,1 CHORDS=4;",
    ),
    (
        "a := rat poly order=0 1,0,0,1 chords=1;",
        "a := RATIONAL POLYNOMIAL ORDER=0 COEFFICIENTS= 1,0,0,1 CHORDS=1;",
    ),
    (
        "a := poly 0,0 1,0 s 1,1,1 n 0,0,1;",
        "a := POLYGON 0,0,0 1,0,0 S 1,1,1 N 0,0,1;",
    ),
    (
        "a := polyg with attr b with outline 60 coplanar 0,0 1,0 1,1;",
        "a := POLYGON WITH ATTRIBUTES b WITH OUTLINE 60 COPLANAR 0,0,0 1,0,0 1,1,0;",
    ),
    (
        "a := polygon coplanar with outline 60 attributes b 0,0 1,0 1,1;",
        "a := POLYGON WITH ATTRIBUTES b WITH OUTLINE 60 COPLANAR 0,0,0 1,0,0 1,1,0;",
    ),
    (
        "a := poly 0,0 1,0 1,1 poly coplanar 0,0 1,0 1,1;",
        "a := POLYGON 0,0,0 1,0,0 1,1,0\n    POLYGON COPLANAR 0,0,0 1,0,0 1,1,0;",
    ),
    ("a := attr;", "a := ATTRIBUTES;"),
    (
        "a := attr color 120 opaque .5 diffuse .75 specular 5 and color 0,0,.5;",
        "a := ATTRIBUTES COLOR 120,1,1 OPAQUE 0.5 DIFFUSE 0.75 SPECULAR 5 AND COLOR 0,0,0.5;",
    ),
    (
        "a := illum 0,0,1 ambient .2 color 60,.5;",
        "a := ILLUMINATION 0,0,1 COLOR 60,0.5,1 AMBIENT 0.2;",
    ),
    (
        "a := begin_f c[65]: n=3 p 0,0 l .5,1 1,0; c [32]:; end_f;",
        "a := BEGIN_FONT\n    C[65]: N=3 P 0,0 L 0.5,1 L 1,0;\n    C[32]: N=0;\nEND_FONT;",
    ),
    ("a := copy b;", "a := COPY b;"),
    (
        "a := copy start start=2, count=3;",
        "a := COPY start START=2 COUNT=3;",
    ),
    ("a := copy b count=3;", "a := COPY b COUNT=3;"),
    (
        "s := begin_s f := f:route(3); g := f:add; end_s;",
        "s := BEGIN_STRUCTURE\n    f := F:route(3);\n    g := F:add;\nEND_STRUCTURE;",
    ),
    // Layout, comments, words that are keywords elsewhere.
    (";;\n  disp{ here; }a\n;;", "DISPLAY a;"),
    ("{ { not nested } disp a;", "DISPLAY a;"),
    ("\u{feff}disp a;", "DISPLAY a;"),
    ("to := inst of of,then;", "to := INSTANCE OF of,then;"),
    ("of := inst of;", "of := INSTANCE OF of;"),
    (
        "f := set color 1,1 applied to to;",
        "f := SET COLOR 1,1 APPLIED TO to;",
    ),
    ("disc all:all;", "DISCONNECT all:ALL;"),
    ("rem from from from;", "REMOVE from FROM from;"),
    ("Größe$1 := nil;", "Größe$1 := NIL;"),
];

#[test]
fn each_form_is_printed_canonically() {
    for (written, canonical) in FORMS {
        let (commands, diagnostics) = parse(written);
        assert!(diagnostics.is_empty(), "{written}: {diagnostics:#?}");
        let printed: Vec<String> = commands.iter().map(|command| print(&command.what)).collect();
        assert_eq!(printed.join(" "), *canonical, "{written}");
    }
}

#[test]
fn canonical_text_is_its_own_canonical_text() {
    for (_, canonical) in FORMS {
        let (commands, diagnostics) = parse(canonical);
        assert!(diagnostics.is_empty(), "{canonical}: {diagnostics:#?}");
        let printed: Vec<String> = commands.iter().map(|command| print(&command.what)).collect();
        assert_eq!(printed.join(" "), *canonical);
    }
}

#[test]
fn structures_are_printed_a_member_a_line() {
    let written = "arm := begin_s turn:= rot x 0; hand := begin_structure set color 0,1; inst of line; end_s;\
                   long := vec 0,0 1,1 2,2 3,3 4,4; end_structure;";
    let canonical = "\
arm := BEGIN_STRUCTURE
    turn := ROTATE IN X 0;
    hand := BEGIN_STRUCTURE
        SET COLOR 0,1;
        INSTANCE OF line;
    END_STRUCTURE;
    long := VECTOR_LIST CONNECTED N=5
        0,0
        1,1
        2,2
        3,3
        4,4;
END_STRUCTURE;";
    let (commands, diagnostics) = parse(written);
    assert!(diagnostics.is_empty(), "{diagnostics:#?}");
    assert_eq!(print(&commands[0].what), canonical);
    assert_eq!(parse(canonical).0[0].what, commands[0].what);
}

#[test]
fn positions_count_lines_and_characters_from_one() {
    let (commands, _) = parse("disp a;\n  { ü } disp ü; disp b;\r\n\tdisp c;");
    let places: Vec<_> = commands
        .iter()
        .map(|command| (command.at.line, command.at.column))
        .collect();
    assert_eq!(places, [(1, 1), (2, 9), (2, 17), (3, 2)]);
}

#[test]
fn names_differ_by_more_than_case() {
    assert_eq!(Name::new("Dials"), Name::new("DIALS"));
    assert_eq!(
        Name::new("Dials").cmp(&Name::new("dIALS")),
        std::cmp::Ordering::Equal
    );
    assert_ne!(Name::new("dial"), Name::new("dials"));
    assert_eq!(Name::new("Dials").as_str(), "Dials");
    for (text, valid) in [
        ("a", true),
        ("a.b", true),
        ("a_$9", true),
        ("", false),
        ("9a", false),
        ("a.", false),
        ("a b", false),
    ] {
        assert_eq!(Name::is_valid(text), valid, "{text}");
    }
}
