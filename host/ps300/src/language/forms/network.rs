//! Functions, connections, messages.

use super::Form;
use crate::intrinsic::Confidence::{High, Medium, Project};

pub(super) const FORMS: &[Form] = &[
    Form {
        keyword: "F:",
        form: "n := F:type;\nn := F:type(k);",
        example: "sum := F:ADDC;\nswitch := F:ROUTE(4);",
        meaning: "Makes an instance of a function; types that route or join have a size. The same name again makes a \
            new one, with empty queues and no connections.",
        source: "recollected; operands as in D0's calls PFN, PFNN",
        confidence: High,
    },
    Form {
        keyword: "CONNECT",
        form: "CONNect a<i>:<j>b;",
        example: "spin := F:DZROTATE;\nCONNECT DIALS<1>:<1>spin;\n\
            turned := ROTATE IN Z 0;\nCONNECT spin<1>:<1>turned;\nink := VECTOR_LIST;\nplace := F:XVECTOR;\n\
            CONNECT place<1>:<append>ink;",
        meaning: "Output i of a to input j of b. The input of a data node may be a word: `append`, `delete`, `clear`, \
            `step`, `position`, `last`, `substitute`; a number there is that of an element. Connecting twice changes \
            nothing.",
        source: "recollected; operands as in D0's call PCONN; names of inputs from the makers' constants file",
        confidence: High,
    },
    Form {
        keyword: "DISCONNECT",
        form: "DISConnect a<i>:<j>b;\nDISConnect a<i>:ALL;\nDISConnect a:ALL;",
        example: "a := F:NOP;\nCONNECT DIALS<1>:<1>a;\nCONNECT DIALS<2>:<1>a;\nDISCONNECT DIALS<1>:<1>a;\n\
            DISCONNECT DIALS<2>:ALL;\nDISCONNECT a:ALL;",
        meaning: "One connection, all of one output, all of all outputs. Messages that wait stay.",
        source: "recollected; operands as in D0's calls PDI, PDIALL",
        confidence: High,
    },
    Form {
        keyword: "SEND",
        form: "SEND value TO <j>b;",
        example: "sum := F:ADDC;\nSEND 2.5 TO <2>sum;\nSEND FIX(1) TO <1>sum;\nwords := F:NOP;\n\
            SEND 'it''s' CHAR(10) TO <1>words;\nSEND V3D(1,2,3) TO <1>words;\nSEND M2D(1,0 0,1) TO <1>words;",
        meaning: "A message to an input, as if connected. The literals are above, under Values.",
        source: "recollected; operands as in D0's calls PSNBOO, PSNFIX, PSNREA, PSNST, PSNV2D, PSNV3D",
        confidence: High,
    },
    Form {
        keyword: "VALUE",
        form: "SEND VALUE(v) TO <j>b;",
        example: "VARIABLE home;\nSTORE V3D(0,1,0) IN <1>home;\nplace := F:ACCUMULATE;\nSEND VALUE(home) TO <2>place;",
        meaning: "What the variable v holds when the command is executed.",
        source: "recollected",
        confidence: Medium,
    },
    Form {
        keyword: "VL",
        form: "SEND VL(a) TO <j>b;",
        example: "list := VECTOR_LIST ITEMIZED P 0,0 L 1,1;\nhold := F:CONSTANT;\nSEND VL(list) TO <2>hold;",
        meaning: "The vectors of the list a, as they are when the command is executed.",
        source: "recollected",
        confidence: Medium,
    },
    Form {
        keyword: "VL, written out",
        form: "SEND VL([class] [N=k] …) TO <j>b;",
        example: "hold := F:CONSTANT;\nSEND VL(ITEMIZED P 0,0,0 L 1,1,1) TO <2>hold;",
        meaning: "Vectors written out, as after VECTOR_LIST. A single word is the name of a list: `VL(DOTS)` is a name, \
            `VL(DOTS N=0)` an empty list of dots. What PICK finds has no literal.",
        source: "ours, so that a network with such a message can be written down",
        confidence: Project,
    },
    Form {
        keyword: "STORE",
        form: "STORE value IN <j>b;",
        example: "VARIABLE v;\nSTORE 1.5 IN <1>v;",
        meaning: "As SEND; the usual word for variables.",
        source: "recollected",
        confidence: Medium,
    },
    Form {
        keyword: "VARIABLE",
        form: "VARiable v[,w…];",
        example: "VARIABLE v,w;\nCONNECT DIALS<1>:<1>v;",
        meaning: "Remembers the last message of input 1, for F:FETCH and VALUE.",
        source: "recollected",
        confidence: Medium,
    },
    Form {
        keyword: "SETUP CNESS",
        form: "SETUP CNESS TRUE/FALSE <j>b;",
        example: "sum := F:ADD;\nSETUP CNESS TRUE <2>sum;\nSEND 10 TO <2>sum;\nSEND 1 TO <1>sum;",
        meaning: "Makes an input of one instance constant, or active.",
        source: "recollected",
        confidence: High,
    },
    Form {
        keyword: "SETUP STATE",
        form: "SETUP STATE [value,…] IN f;",
        example: "place := F:ACCUMULATE;\nSETUP STATE IN place;",
        meaning: "Gives a function what it remembered when the network was written down with its state. Without values \
            it is as new.",
        source: "ours: a PS 300 could not write down a running network",
        confidence: Project,
    },
];
