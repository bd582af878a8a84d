//! Polygons, attributes, lights, rendering nodes.

use super::Form;
use crate::intrinsic::Confidence::High;

pub(super) const FORMS: &[Form] = &[
    Form {
        keyword: "POLYGON",
        form: "n := POLYgon [WITH ATTRibutes a] [WITH OUTLINE h] [COPLANAR] [S] x,y[,z] [N nx,ny,nz] … [POLYgon …];",
        example: "paint := ATTRIBUTES COLOR 120;\n\
            frame := POLYGON WITH ATTRIBUTES paint WITH OUTLINE 240 0,0,0 4,0,0 4,4,0 0,4,0\n\
            \x20 POLYGON COPLANAR 1,1,0 1,2,0 2,2,0;\n\
            round := POLYGON S 1,0,0 N 1,0,0 S 0,1,0 N 0,1,0 0,0,1 N 0,0,1;\nDISPLAY frame;",
        meaning: "Faces, each of three corners or more. S: the edge from here on is soft, not drawn and shaded across. \
            N: the normal for smooth shading. WITH OUTLINE: the hue of the edges. COPLANAR: in the plane of the face \
            before, of which it may be a hole.",
        source: "recollected; operands as in D0's calls PPLYGB, PPLYGA, PPLYGO, PPLYGL; several in one command ours",
        confidence: High,
    },
    Form {
        keyword: "ATTRIBUTES",
        form: "n := ATTRibutes [COLOR h[,s[,i]]] [OPAQUE t] [DIFFUSE d] [SPECULAR p] [AND …];",
        example: "glass := ATTRIBUTES COLOR 300,0.5,1 OPAQUE 0.6 DIFFUSE 0.75 SPECULAR 5 AND COLOR 120;\n\
            pane := POLYGON WITH ATTRIBUTES glass 0,0,0 1,0,0 0,1,0;\nDISPLAY pane;",
        meaning: "How faces look: colour, how much light stays, how much is scattered, how sharp highlights are. After \
            AND the back. s and i are 1 unless written.",
        source: "recollected; operands as in D0's call PATTR",
        confidence: High,
    },
    Form {
        keyword: "ILLUMINATION",
        form: "n := ILLUMination x,y,z [COLOR h[,s[,i]]] [AMBIENT a];",
        example: "sun := ILLUMINATION 0,0,-1 COLOR 180,0.2,0.9 AMBIENT 0.3;\nface := POLYGON 0,0,0 1,0,0 0,1,0;\n\
            scene := INSTANCE OF sun,face;\nshaded := SURFACE_RENDERING THEN scene;\nDISPLAY shaded;",
        meaning: "Light from a direction, which the operations above turn; a is what is everywhere of it. White unless \
            written.",
        source: "recollected; operands as in D0's call PILLUM, the last two inferred",
        confidence: High,
    },
    Form {
        keyword: "SURFACE_RENDERING",
        form: "n := SURFACE_RENDering [APPLied TO m];\nn := SOLID_RENDering [APPLied TO m];",
        example: "face := POLYGON 0,0,0 1,0,0 0,1,0;\nsheet := SURFACE_RENDERING APPLIED TO face;\n\
            solid := SOLID_RENDERING APPLIED TO face;\nDISPLAY sheet;",
        meaning: "Where messages ask for a rendering of the polygons below: as open sheets, of which both sides count, or \
            as a closed volume.",
        source: "recollected; operands as in D0's call PSURRE",
        confidence: High,
    },
    Form {
        keyword: "SECTIONING_PLANE",
        form: "n := SECTioning_plane [APPLied TO m];",
        example: "face := POLYGON 0,0,0 1,0,0 0,1,0;\ncut := SECTIONING_PLANE APPLIED TO face;\nDISPLAY cut;",
        meaning: "The first polygon below gives the plane that sectioned renderings cut with; operations above move it.",
        source: "recollected",
        confidence: High,
    },
];
