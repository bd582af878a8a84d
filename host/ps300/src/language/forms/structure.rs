//! Names, structures, what is on the screen, and housekeeping.

use super::Form;
use crate::intrinsic::Confidence::{High, Medium, Project};

pub(super) const FORMS: &[Form] = &[
    Form {
        keyword: "BEGIN_STRUCTURE",
        form: "n := BEGIN_Structure [[label :=] node; …] END_Structure;",
        example: "arm := BEGIN_STRUCTURE\n  shoulder := ROTATE IN Z 0;\n  VECTOR_LIST 0,0 0,1;\n  TRANSLATE BY 0,1;\n\
            \x20 elbow := ROTATE IN Z 45;\n  VECTOR_LIST 0,0 0,1;\nEND_STRUCTURE;\nbend := F:ZROTATE;\n\
            CONNECT bend<1>:<1>arm.elbow;\nDISPLAY arm;",
        meaning: "Several nodes as one. An operation holds for all after it. What has a label is `n.label` outside. \
            A structure inside a structure is ours, up to 32 deep.",
        source: "recollected; operands as in D0's calls PBEGS, PENDS; the dotted names D0's",
        confidence: High,
    },
    Form {
        keyword: "F: in a structure",
        form: "n := BEGIN_Structure label := F:type[(k)]; … END_Structure;",
        example: "wheel := BEGIN_STRUCTURE\n  spin := F:DZROTATE;\n  turned := ROTATE IN Z 0;\n  VECTOR_LIST 0,0 1,0;\n\
            END_STRUCTURE;\nCONNECT DIALS<1>:<1>wheel.spin;\nCONNECT wheel.spin<1>:<1>wheel.turned;\nDISPLAY wheel;",
        meaning: "A function that belongs to a structure: the instance `n.label`, made and deleted with it. It needs a \
            label.",
        source: "ours, so that a picture and what moves it can be one thing",
        confidence: Project,
    },
    Form {
        keyword: "INSTANCE",
        form: "n := INSTance [OF a[,b…]];",
        example: "line := VECTOR_LIST 0,0 1,0;\nturned := ROTATE IN Z 90 THEN line;\ncross := INSTANCE OF line,turned;\n\
            DISPLAY cross;",
        meaning: "All of these, in this order. They may be defined later. Of nothing, as REMOVE can leave it: empty.",
        source: "recollected; operands as in D0's call PINST; of nothing ours",
        confidence: High,
    },
    Form {
        keyword: "INCLUDE",
        form: "INCLude a IN n;\nREMove a FROM n;",
        example: "all := INSTANCE OF one;\none := VECTOR_LIST 0,0 1,0;\ntwo := VECTOR_LIST 0,0 0,1;\nINCLUDE two IN all;\n\
            REMOVE one FROM all;\nDISPLAY all;",
        meaning: "Changes what an INSTANCE shows. A name is in it once.",
        source: "recollected; operands as in D0's calls PINCL, PREMFR",
        confidence: High,
    },
    Form {
        keyword: "DISPLAY",
        form: "DISPlay n;\nREMove n;",
        example: "line := VECTOR_LIST 0,0 1,0;\nDISPLAY line;\nREMOVE line;",
        meaning: "On the screen, and off it.",
        source: "recollected; operands as in D0's call PDISP",
        confidence: High,
    },
    Form {
        keyword: "DELETE",
        form: "DELete n;\nDELete prefix*;",
        example: "a1 := F:NOP;\na2 := F:NOP;\nb := F:NOP;\nDELETE b;\nDELETE a*;",
        meaning: "The name and what it denotes; all names that begin so.",
        source: "recollected; operands as in D0's calls PDELET, PDELW",
        confidence: High,
    },
    Form {
        keyword: "FORGET",
        form: "FORget n;",
        example: "line := VECTOR_LIST 0,0 1,0;\nred := SET COLOR 120,1 THEN line;\nFORGET line;\nDISPLAY red;",
        meaning: "The name only: what it denotes stays where something refers to it.",
        source: "recollected",
        confidence: High,
    },
    Form {
        keyword: "NIL",
        form: "n := NIL;",
        example: "hidden := NIL;\nall := INSTANCE OF hidden;\nDISPLAY all;",
        meaning: "A name with nothing below it.",
        source: "recollected",
        confidence: High,
    },
    Form {
        keyword: "COPY",
        form: "n := COPY a [START=i] [,] [COUNT=k];",
        example: "line := VECTOR_LIST 0,0 1,0 1,1 0,1;\ntail := COPY line START=2 COUNT=3;\nDISPLAY tail;",
        meaning: "The elements of a data node, from the i-th, k of them, as they are when the command is executed.",
        source: "recollected",
        confidence: Medium,
    },
    Form {
        keyword: "FOLLOW",
        form: "FOLlow n WITH operation;",
        example: "line := VECTOR_LIST 0,0 1,0;\nturned := ROTATE IN Z 90 THEN line;\nFOLLOW turned WITH SCALE BY 2;\n\
            DISPLAY turned;",
        meaning: "An operation directly below the operation n.",
        source: "recollected; named by the makers' constants file",
        confidence: High,
    },
    Form {
        keyword: "PREFIX",
        form: "PREfix n WITH operation;",
        example: "line := VECTOR_LIST 0,0 1,0;\nPREFIX line WITH SET COLOR 120,1;\nDISPLAY line;",
        meaning: "An operation directly above n, wherever n is used.",
        source: "recollected; named by the makers' constants file",
        confidence: High,
    },
    Form {
        keyword: "INITIALIZE",
        form: "INITialize [CONNections / DISPlay / NAMEs];",
        example: "a := F:NOP;\nINITIALIZE CONNECTIONS;\nINITIALIZE DISPLAY;\nINITIALIZE NAMES;\nINITIALIZE;",
        meaning: "Deletes all that commands have made, or only connections, what is displayed, names. Devices stay.",
        source: "recollected; operands as in D0's call PINIT",
        confidence: High,
    },
    Form {
        keyword: "BEGIN",
        form: "BEGIN command; … END;",
        example: "a := VECTOR_LIST 0,0 1,0;\nBEGIN\n  a := VECTOR_LIST 0,0 0,1;\n  DISPLAY a;\nEND;",
        meaning: "The commands between take effect in one update: the network runs and the picture changes only at END. \
            A semicolon after BEGIN is allowed.",
        source: "recollected; the semicolon ours",
        confidence: Medium,
    },
    Form {
        keyword: "OPTIMIZE STRUCTURE",
        form: "OPTimize STRUcture; … END OPTimize;",
        example: "OPTIMIZE STRUCTURE;\nline := VECTOR_LIST 0,0 1,0;\nEND OPTIMIZE;",
        meaning: "Structures made between were stored compactly. Taken, and without effect here.",
        source: "recollected; that it does nothing ours",
        confidence: Medium,
    },
    Form {
        keyword: "RESERVE_WORKING_STORAGE",
        form: "RESERVE_WORKING_STORAGE n;",
        example: "RESERVE_WORKING_STORAGE 100000;",
        meaning: "Memory for rendering, needed before polygons were rendered. Taken, and without effect here.",
        source: "recollected; operand as in D0's call PRSVST; that it does nothing ours",
        confidence: High,
    },
    Form {
        keyword: "COMMAND STATUS",
        form: "COMmand STATus;",
        example: "COMMAND STATUS;",
        meaning: "Writes on the message line what is open, and how much there is.",
        source: "recollected; what it says ours",
        confidence: Medium,
    },
    Form {
        keyword: "!RESET",
        form: "!RESET;",
        example: "BEGIN\n!RESET;",
        meaning: "Ends what is open.",
        source: "recollected; what it ends ours",
        confidence: Medium,
    },
];
