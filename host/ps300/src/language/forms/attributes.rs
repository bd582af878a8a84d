//! Colour, brightness, picking, devices.

use super::Form;
use crate::intrinsic::Confidence::{High, Medium};

pub(super) const FORMS: &[Form] = &[
    Form {
        keyword: "SET COLOR",
        form: "n := SET COLOR hue,saturation;",
        example: "line := VECTOR_LIST 0,0 1,0;\nred := SET COLOR 120,1 THEN line;\nDISPLAY red;",
        meaning: "Hue in degrees: 0 blue, 60 magenta, 120 red, 180 yellow, 240 green, 300 cyan. Saturation 0 is white.",
        source: "recollected; operands as in D0's call PSECOL; hues of three converters",
        confidence: High,
    },
    Form {
        keyword: "SET COLOR BLENDING",
        form: "n := SET COLOR BLENding saturation;",
        example: "line := VECTOR_LIST COLOR 0,0 I=120 1,0 I=240;\nblended := SET COLOR BLENDING 1 THEN line;\nDISPLAY blended;",
        meaning: "The saturation of vectors that have hues of their own.",
        source: "recollected; its operand ours",
        confidence: Medium,
    },
    Form {
        keyword: "SET INTENSITY",
        form: "n := SET INTENsity ON/OFF far:near;",
        example: "line := VECTOR_LIST 0,0 1,0;\ncued := SET INTENSITY ON 0.25:1 THEN line;\nDISPLAY cued;",
        meaning: "Brightness of the farthest and the nearest, 0 to 1.",
        source: "recollected; operands as in BRL-CAD's call PSetInt",
        confidence: High,
    },
    Form {
        keyword: "SET CONTRAST",
        form: "n := SET CONTRAST TO c;",
        example: "line := VECTOR_LIST 0,0 1,0;\nhard := SET CONTRAST TO 0.5 THEN line;\nDISPLAY hard;",
        meaning: "Contrast of the lines, 0 to 1.",
        source: "recollected; its operand ours",
        confidence: Medium,
    },
    Form {
        keyword: "SET DEPTH_CLIPPING",
        form: "n := SET DEPTH_CLipping ON/OFF;",
        example: "line := VECTOR_LIST 0,0,0 1,0,9;\ncut := SET DEPTH_CLIPPING ON THEN line;\n\
            picture := WINDOW X=-1:1 Y=-1:1 FRONT=0 BACK=1 THEN cut;\nDISPLAY picture;",
        meaning: "Whether what lies before FRONT and behind BACK is cut off.",
        source: "recollected; operands as in D0's call PSEDCL",
        confidence: High,
    },
    Form {
        keyword: "SET PICKING",
        form: "n := SET PICKing ON/OFF;",
        example: "line := VECTOR_LIST 0,0 1,0;\ntouchable := SET PICKING ON THEN line;\nDISPLAY touchable;",
        meaning: "Whether what is below can be picked.",
        source: "recollected; operands as in D0's call PSEPOF",
        confidence: High,
    },
    Form {
        keyword: "SET PICKING IDENTIFIER",
        form: "n := SET PICKing IDentifier=id;",
        example: "line := VECTOR_LIST 0,0 1,0;\nmarked := SET PICKING IDENTIFIER=edge THEN line;\n\
            touchable := SET PICKING ON THEN marked;\nDISPLAY touchable;",
        meaning: "What a pick of anything below is told apart by; any word.",
        source: "recollected; operands as in D0's call PSEPID",
        confidence: High,
    },
    Form {
        keyword: "SET PICKING LOCATION",
        form: "n := SET PICKing LOCation=x,y sx,sy;",
        example: "line := VECTOR_LIST 0,0 1,0;\nhere := SET PICKING LOCATION=0,0 0.01,0.01 THEN line;\nDISPLAY here;",
        meaning: "Where below it picks are looked for: the middle and half the size of the window.",
        source: "recollected; D0 has the same size at the device PICK_LOCATION",
        confidence: High,
    },
    Form {
        keyword: "SET DISPLAY",
        form: "n := SET DISPlay k ON/OFF;",
        example: "line := VECTOR_LIST 0,0 1,0;\nsecond := SET DISPLAY 1 ON THEN line;\nDISPLAY second;",
        meaning: "Whether what is below appears on screen k of several, 0 to 255.",
        source: "recollected; its numbers ours",
        confidence: Medium,
    },
    Form {
        keyword: "SET PLOTTER",
        form: "n := SET PLOTter ON/OFF;",
        example: "line := VECTOR_LIST 0,0 1,0;\ndrawn := SET PLOTTER ON THEN line;\nDISPLAY drawn;",
        meaning: "Whether what is below is plotted.",
        source: "recollected; its operand ours",
        confidence: Medium,
    },
    Form {
        keyword: "SET LINE_TEXTURE",
        form: "n := SET LINE_texture [AROUND_corners] t;",
        example: "line := VECTOR_LIST 0,0 1,0;\ndashed := SET LINE_TEXTURE AROUND_CORNERS 85 THEN line;\nDISPLAY dashed;",
        meaning: "Dashes: the seven bits of t, 1 to 127, highest first, a one is line. 127 is solid. With AROUND_CORNERS \
            the dashes go on from vector to vector.",
        source: "recollected; its operand ours",
        confidence: Medium,
    },
];
