//! Transforms and views.

use super::Form;
use crate::intrinsic::Confidence::High;

pub(super) const FORMS: &[Form] = &[
    Form {
        keyword: "APPLIED TO",
        form: "n := operation [APPLied TO m];\nn := operation [THEN m];",
        example: "line := VECTOR_LIST 0,0 1,0;\nturned := ROTATE IN Z 90 APPLIED TO line;\nred := SET COLOR 120,1 THEN turned;\n\
            DISPLAY red;",
        meaning: "Every operation below may end so; inside a structure that is left out, and it holds for what follows.",
        source: "recollected; operands as in D0's calls",
        confidence: High,
    },
    Form {
        keyword: "ROTATE",
        form: "n := ROTate IN X/Y/Z degrees;",
        example: "line := VECTOR_LIST 0,0 1,0;\nturned := ROTATE IN Z 90 THEN line;\nDISPLAY turned;",
        meaning: "Turns about an axis, by the right-hand formula.",
        source: "recollected; operands as in D0's calls PROTX, PROTY, PROTZ",
        confidence: High,
    },
    Form {
        keyword: "TRANSLATE",
        form: "n := TRANslate BY x,y[,z];",
        example: "line := VECTOR_LIST 0,0 1,0;\nmoved := TRANSLATE BY 0,1,0 THEN line;\nDISPLAY moved;",
        meaning: "Moves; z is 0 unless written.",
        source: "recollected; operands as in D0's call PTRANS",
        confidence: High,
    },
    Form {
        keyword: "SCALE",
        form: "n := SCAle BY s;\nn := SCAle BY sx,sy[,sz];",
        example: "line := VECTOR_LIST 0,0 1,0;\nlong := SCALE BY 2 THEN line;\nflat := SCALE BY 2,0.5 THEN line;\nDISPLAY long;",
        meaning: "One factor for all axes; of two, z keeps 1.",
        source: "recollected; operands as in D0's call PSCALE",
        confidence: High,
    },
    Form {
        keyword: "MATRIX",
        form: "n := MATRIX_2X2 numbers;\nn := MATRIX_3X3 numbers;\nn := MATRIX_4X3 numbers;\nn := MATRIX_4X4 numbers;",
        example: "line := VECTOR_LIST 0,0 1,0;\nturned := MATRIX_3x3 0,-1,0 1,0,0 0,0,1 THEN line;\n\
            moved := MATRIX_4x3 1,0,0,5 0,1,0,0 0,0,1,0 THEN line;\nsame := MATRIX_4x4 1,0,0,0 0,1,0,0 0,0,1,0 0,0,0,1 THEN line;\n\
            text := CHARACTERS 'slanted';\nslanted := MATRIX_2x2 1,0.3 0,1 THEN text;\nDISPLAY turned;",
        meaning: "Row by row; acts on column vectors. The 2×2 turns and scales characters, the last column of the 4×3 is \
            a translation, a 4×4 whose last row is not 0,0,0,1 is a view.",
        source: "recollected; operands as in D0's call PMAT44; the side ours",
        confidence: High,
    },
    Form {
        keyword: "LOOK",
        form: "n := LOOK AT x,y,z FROM x,y,z [UP x,y,z];",
        example: "line := VECTOR_LIST 0,0 1,0;\nseen := LOOK AT 0,0,0 FROM 0,1,-5 UP 0,2,-5 THEN line;\n\
            picture := FIELD_OF_VIEW 30 FRONT=1 BACK=10 THEN seen;\nDISPLAY picture;",
        meaning: "The eye. UP is a point above it, straight up unless written; the three in any order.",
        source: "recollected; operands as in D0's call PLOOKA; that UP is a point ours",
        confidence: High,
    },
    Form {
        keyword: "FIELD_OF_VIEW",
        form: "n := FIELD_of_view degrees [FRONT BOUNDary=f BACK BOUNDary=b];\nn := FOV …;",
        example: "line := VECTOR_LIST 0,0 1,0;\npicture := FIELD_OF_VIEW 30 FRONT BOUNDARY=1 BACK BOUNDARY=10 THEN line;\n\
            DISPLAY picture;",
        meaning: "Perspective with this full angle; f and b are distances from the eye.",
        source: "recollected; operands as in D0's call PFOV",
        confidence: High,
    },
    Form {
        keyword: "WINDOW",
        form: "n := WINDOW X=a:b Y=c:d [FRONT BOUNDary=f BACK BOUNDary=b];",
        example: "line := VECTOR_LIST 0,0 1,0;\npicture := WINDOW X=-2:2 Y=-2:2 THEN line;\nDISPLAY picture;",
        meaning: "Parallel projection of this part of space.",
        source: "recollected; operands as in D0's call PWINDO",
        confidence: High,
    },
    Form {
        keyword: "EYE",
        form: "n := EYE BACK z [LEFT/RIGHT x] [UP/DOWN y] FROM SCREEN AREA w WIDE [FRONT BOUNDary=f BACK BOUNDary=b];",
        example: "line := VECTOR_LIST 0,0 1,0;\nleft := EYE BACK 24 LEFT 1.25 FROM SCREEN AREA 10 WIDE FRONT=20 BACK=40 THEN line;\n\
            DISPLAY left;",
        meaning: "Perspective of an eye z behind a screen w wide and as high, beside its middle by x and y: with two of \
            them, a stereo pair.",
        source: "recollected; operands as in D0's call PEYEBK",
        confidence: High,
    },
    Form {
        keyword: "VIEWPORT",
        form: "n := VIEWport HORizontal=a:b VERTical=c:d [INTENsity=i:j];",
        example: "line := VECTOR_LIST 0,0 1,0;\nhalf := VIEWPORT HORIZONTAL=-1:0 VERTICAL=-1:1 INTENSITY=0.5:1 THEN line;\n\
            DISPLAY half;",
        meaning: "Part of the screen, -1 to 1 each way; brightness of the farthest and the nearest, 0 to 1.",
        source: "recollected; operands as in D0's call PVIEWP",
        confidence: High,
    },
    Form {
        keyword: "XFORM",
        form: "n := XFORM MATRIX/VECtor_list;",
        example: "line := VECTOR_LIST 0,0 1,0;\nhere := XFORM MATRIX THEN line;\nlist := XFORM VECTOR_LIST THEN line;\n\
            turned := ROTATE IN Z 90 THEN here;\nDISPLAY turned;",
        meaning: "A place where F:XFORMDATA reads what the operations above have come to, or the vectors below as they \
            are transformed.",
        source: "recollected; operands as in D0's call PXFMAT",
        confidence: High,
    },
];
