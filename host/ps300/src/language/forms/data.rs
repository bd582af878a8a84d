//! Vector lists, patterns, curves.

use super::Form;
use crate::intrinsic::Confidence::{High, Medium};

pub(super) const FORMS: &[Form] = &[
    Form {
        keyword: "VECTOR_LIST",
        form: "n := VECtor_list [CONNected/SEParate/DOTs/ITEMized] [BLOCK_normalized] [N=k] [P/L] x,y[,z] [I=i] …;",
        example: "square := VECTOR_LIST CONNECTED N=5 -1,-1 1,-1 1,1 -1,1 -1,-1;\n\
            two := VECTOR_LIST SEPARATE 0,0,0 1,0,0 0,1,0 1,1,0;\nstars := VECTOR_LIST DOTS 0,0 I=0.5 1,1;\n\
            cross := VECTOR_LIST ITEMIZED BLOCK_NORMALIZED P -1,0 L 1,0 P 0,-1 L 0,1;\nDISPLAY cross;",
        meaning: "One polyline, pairs, dots, or moves (P) and lines (L) as marked; `I=` is brightness, 0 to 1. A list \
            that names no class is itemized if it has marks and connected otherwise. A list without z stays \
            two-dimensional. BLOCK_NORMALIZED is kept and does nothing; `N=` is checked.",
        source: "recollected; operands as in D0's calls PVCBEG, PVCLIS; classes from the makers' constants file; what \
            is left out ours",
        confidence: High,
    },
    Form {
        keyword: "VECTOR_LIST COLOR",
        form: "n := VECtor_list [class] COLOR [N=k] [P/L] x,y[,z] [I=hue] …;",
        example: "line := VECTOR_LIST CONNECTED COLOR 0,0 I=0 1,0 I=120 2,0 I=240;\nDISPLAY line;",
        meaning: "Each vector has its own hue, in degrees as SET COLOR, in place of its brightness.",
        source: "that there were such lists: the makers' constants file; that I is a hue ours",
        confidence: Medium,
    },
    Form {
        keyword: "VECTOR_LIST TABULATED",
        form: "n := VECtor_list TABulated [N=k] P/L x,y[,z] [T=t] …;",
        example: "line := VECTOR_LIST TABULATED P 0,0 L 1,0 T=0 L 2,0 T=64;\nDISPLAY line;",
        meaning: "As itemized; `T=` is the entry of a table of 128 colours, 0 to 127.",
        source: "recollected by name; T ours",
        confidence: Medium,
    },
    Form {
        keyword: "PATTERN",
        form: "n := PATtern i j … [AROUND_corners] [MATCH/NOMATCH] LENGTH r;",
        example: "dashes := PATTERN 3 1 1 1 AROUND_CORNERS NOMATCH LENGTH 0.5;",
        meaning: "Lengths of line and gap in turn, relative to each other; r is the length of the whole. AROUND_CORNERS: \
            it goes on from vector to vector. MATCH, as without a word: a whole number of them fits.",
        source: "recollected; operands as in D0's call PDEFPA",
        confidence: High,
    },
    Form {
        keyword: "PATTERN WITH",
        form: "PATtern list WITH n;",
        example: "dashes := PATTERN 1 1 LENGTH 0.2;\nline := VECTOR_LIST 0,0 1,0;\nPATTERN line WITH dashes;\nDISPLAY line;",
        meaning: "Dashes a list or curve.",
        source: "recollected; operands as in D0's call PPATWI",
        confidence: High,
    },
    Form {
        keyword: "BSPLINE",
        form: "n := BSPLINE ORDER=k [OPEN/CLOSED] [NONPERIODIC/PERIODIC] [N=v] [VERTICES=] x,y[,z] … [KNOTS=] [t …] CHORDS=q;",
        example: "arc := BSPLINE ORDER=4 OPEN NONPERIODIC N=4 VERTICES=0,0 1,2 3,2 4,0 CHORDS=20;\n\
            loop := BSPLINE ORDER=3 CLOSED PERIODIC VERTICES=0,0 1,0 1,1 0,1 CHORDS=40;\n\
            knotted := BSPLINE ORDER=3 0,0 1,1 2,1 3,0 KNOTS=0 0 0 0.5 1 1 1 CHORDS=20;\nDISPLAY arc;",
        meaning: "A curve of degree k-1, drawn as q lines. Closed curves are periodic and open ones not, unless written; \
            knots not written follow from that. k is at most 16; the parts in any order.",
        source: "recollected; defaults and bounds ours",
        confidence: High,
    },
    Form {
        keyword: "RATIONAL BSPLINE",
        form: "n := RATional BSPLINE … x,y[,z],w …;",
        example: "quarter := RATIONAL BSPLINE ORDER=3 OPEN NONPERIODIC VERTICES=1,0,1 1,1,0.70710678 0,1,1 CHORDS=16;\n\
            DISPLAY quarter;",
        meaning: "The same with a weight after each vertex.",
        source: "recollected; where the weight stands ours",
        confidence: High,
    },
    Form {
        keyword: "POLYNOMIAL",
        form: "n := POLYnomial ORDER=i [COEFFICIENTS=] x,y[,z] … CHORDS=q;",
        example: "parabola := POLYNOMIAL ORDER=2 COEFFICIENTS=0,1 2,0 -1,0 CHORDS=20;\nDISPLAY parabola;",
        meaning: "A curve over 0 to 1 of degree i, at most 16: i+1 coefficients, that of the highest power first.",
        source: "recollected; the order of coefficients and the bound ours",
        confidence: High,
    },
    Form {
        keyword: "RATIONAL POLYNOMIAL",
        form: "n := RATional POLYnomial … x,y[,z],w …;",
        example: "arc := RATIONAL POLYNOMIAL ORDER=2 COEFFICIENTS=-1,0,1 0,2,0 1,0,1 CHORDS=20;\nDISPLAY arc;",
        meaning: "The same, divided by the polynomial of the w.",
        source: "recollected; where w stands ours",
        confidence: High,
    },
];
