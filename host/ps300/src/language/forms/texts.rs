//! Characters, labels, fonts.

use super::Form;
use crate::intrinsic::Confidence::{High, Medium};

pub(super) const FORMS: &[Form] = &[
    Form {
        keyword: "CHARACTERS",
        form: "n := CHARacters [x,y[,z]] [STEP dx,dy] 'text';",
        example: "title := CHARACTERS 0,1 STEP 1,0 'it''s here';\nDISPLAY title;",
        meaning: "Text in space, its lower left corner at a point. The step from one to the next is in widths and heights. \
            Text is one or more quoted pieces and `CHAR(n)`, a character by its code.",
        source: "recollected; operands as in D0's call PCHS; several pieces ours",
        confidence: High,
    },
    Form {
        keyword: "LABELS",
        form: "n := LABELS [x,y[,z] 'text' …];",
        example: "marks := LABELS 0,0 'zero' 1,0 'one' 2,0 'two';\nDISPLAY marks;",
        meaning: "Many short texts as one node.",
        source: "recollected",
        confidence: High,
    },
    Form {
        keyword: "CHARACTER SCALE",
        form: "n := CHARacter SCAle sx[,sy];",
        example: "title := CHARACTERS 'big';\nbig := CHARACTER SCALE 2,3 THEN title;\nDISPLAY big;",
        meaning: "Size of the characters below, without moving them.",
        source: "recollected; operands as in D0's call PCHSCA",
        confidence: High,
    },
    Form {
        keyword: "CHARACTER ROTATE",
        form: "n := CHARacter ROTate degrees;",
        example: "title := CHARACTERS 'up';\nturned := CHARACTER ROTATE 90 THEN title;\nDISPLAY turned;",
        meaning: "Turns the line of text, anticlockwise.",
        source: "recollected",
        confidence: High,
    },
    Form {
        keyword: "TEXT SIZE",
        form: "n := TEXT SIZE s;",
        example: "title := CHARACTERS 'small';\nsmall := TEXT SIZE 0.05 THEN title;\nDISPLAY small;",
        meaning: "The size of the characters below, whatever CHARACTER SCALE stands above.",
        source: "recollected by name; its operand ours",
        confidence: Medium,
    },
    Form {
        keyword: "BEGIN_FONT",
        form: "n := BEGIN_Font [C[code]: [N=k] [P/L x,y …]; …] END_Font;",
        example: "runes := BEGIN_FONT\n  C[65]: N=5 P 0,0 L 0.5,1 L 1,0 P 0.2,0.4 L 0.8,0.4;\n  C[32]: N=0;\nEND_FONT;\n\
            title := CHARACTERS 'A A';\nset := CHARACTER FONT runes THEN title;\nDISPLAY set;",
        meaning: "A font: characters by code, each with vectors as in an itemized list, in a cell of 0 to 1 each way. \
            Characters it has not are blank.",
        source: "first and last word recollected; between them ours",
        confidence: Medium,
    },
    Form {
        keyword: "CHARACTER FONT",
        form: "n := CHARacter FONT f;\nn := STANdard FONT;",
        example: "runes := BEGIN_FONT C[65]: P 0,0 L 0.5,1 L 1,0; END_FONT;\ntitle := CHARACTERS 'A';\n\
            own := STANDARD FONT THEN title;\nset := CHARACTER FONT runes THEN own;\nDISPLAY set;",
        meaning: "The font of the characters below; the machine's own.",
        source: "recollected",
        confidence: High,
    },
];
