//! Bits, levels, phases: what sets them, and what depends on them.

use super::Form;
use crate::intrinsic::Confidence::{High, Medium};

pub(super) const FORMS: &[Form] = &[
    Form {
        keyword: "SET CONDITIONAL_BIT",
        form: "n := SET CONDitional_bit k ON/OFF;\nn := SET COND_BIT k ON/OFF;",
        example: "line := VECTOR_LIST 0,0 1,0;\nshown := IF CONDITIONAL_BIT 3 IS ON THEN line;\n\
            chosen := SET CONDITIONAL_BIT 3 ON THEN shown;\nDISPLAY chosen;",
        meaning: "A bit below it, k from 0 to 14. All are off at the top.",
        source: "recollected; operands as in D0's call PSEBIT; the range less surely",
        confidence: High,
    },
    Form {
        keyword: "IF CONDITIONAL_BIT",
        form: "n := IF CONDitional_bit k IS ON/OFF [THEN m];",
        example: "line := VECTOR_LIST 0,0 1,0;\nshown := IF CONDITIONAL_BIT 3 IS OFF THEN line;\nDISPLAY shown;",
        meaning: "What is below, or follows in the structure, is there only then.",
        source: "recollected; operands as in D0's call PIFBIT",
        confidence: High,
    },
    Form {
        keyword: "SET LEVEL_OF_DETAIL",
        form: "n := SET LEVel_of_detail TO i;",
        example: "line := VECTOR_LIST 0,0 1,0;\nfine := IF LEVEL_OF_DETAIL >= 3 THEN line;\n\
            chosen := SET LEVEL_OF_DETAIL TO 5 THEN fine;\nDISPLAY chosen;",
        meaning: "A whole number below it; 0 at the top.",
        source: "recollected; the 0 ours",
        confidence: High,
    },
    Form {
        keyword: "INCREMENT LEVEL_OF_DETAIL",
        form: "n := INCRement LEVel_of_detail;\nn := DECRement LEVel_of_detail;",
        example: "line := VECTOR_LIST 0,0 1,0;\nless := DECREMENT LEVEL_OF_DETAIL THEN line;\n\
            more := INCREMENT LEVEL_OF_DETAIL THEN less;\nDISPLAY more;",
        meaning: "One more, one less, below it.",
        source: "recollected",
        confidence: High,
    },
    Form {
        keyword: "IF LEVEL_OF_DETAIL",
        form: "n := IF LEVel_of_detail =/</<=/>/>=/<> i [THEN m];",
        example: "a := VECTOR_LIST 0,0 1,0;\nb := IF LEVEL_OF_DETAIL = 0 THEN a;\nc := IF LEVEL_OF_DETAIL < 1 THEN b;\n\
            d := IF LEVEL_OF_DETAIL <= 0 THEN c;\ne := IF LEVEL_OF_DETAIL > -1 THEN d;\nf := IF LEVEL_OF_DETAIL >= 0 THEN e;\n\
            g := IF LEVEL_OF_DETAIL <> 1 THEN f;\nDISPLAY g;",
        meaning: "What is below is there only when the level compares so with i.",
        source: "recollected; the six comparisons from the makers' constants file",
        confidence: High,
    },
    Form {
        keyword: "SET RATE",
        form: "n := SET RATE on off [ON/OFF] [delay];",
        example: "line := VECTOR_LIST 0,0 1,0;\nblinks := IF PHASE IS ON THEN line;\nclock := SET RATE 30 15 OFF 60 THEN blinks;\n\
            DISPLAY clock;",
        meaning: "A phase below it that is on for so many displayed frames and off for so many, in turn. It begins on \
            unless written; the first phase lasts the delay, if there is one.",
        source: "recollected; that it counts frames, and the delay, less surely",
        confidence: Medium,
    },
    Form {
        keyword: "SET RATE EXTERNAL",
        form: "n := SET RATE EXTernal;",
        example: "line := VECTOR_LIST 0,0 1,0;\nblinks := IF PHASE IS ON THEN line;\nled := SET RATE EXTERNAL THEN blinks;\n\
            DISPLAY led;",
        meaning: "A phase below it that messages turn on and off.",
        source: "recollected",
        confidence: Medium,
    },
    Form {
        keyword: "IF PHASE",
        form: "n := IF PHASE IS ON/OFF [THEN m];",
        example: "line := VECTOR_LIST 0,0 1,0;\nshown := IF PHASE IS OFF THEN line;\nDISPLAY shown;",
        meaning: "What is below is there only in this phase. Without SET RATE above it is off.",
        source: "recollected; the last ours",
        confidence: Medium,
    },
];
