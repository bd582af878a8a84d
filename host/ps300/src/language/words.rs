//! Keywords, how far each may be shortened, and what a mistyped one probably meant.
//!
//! Source: `docs/protocols/ps300.md`, section "Commands"; the letters printed there in capitals are the
//! least that must be written. Keywords are known by their place, so every one of them is also a legal
//! name.

/// A keyword: the whole word and how many of its letters are enough.
#[derive(Clone, Copy, Debug)]
pub(super) struct Word {
    pub(super) full: &'static str,
    least: usize,
}

impl Word {
    const fn new(full: &'static str, least: usize) -> Self {
        Self { full, least }
    }

    const fn whole(full: &'static str) -> Self {
        Self::new(full, full.len())
    }

    /// Whether `written` is this word or a permitted beginning of it, in any case.
    pub(super) fn matches(self, written: &str) -> bool {
        let (written, full) = (written.as_bytes(), self.full.as_bytes());
        written.len() >= self.least
            && full
                .get(..written.len())
                .is_some_and(|beginning| beginning.eq_ignore_ascii_case(written))
    }
}

macro_rules! words {
    ($($constant:ident = $full:literal $($least:literal)?;)*) => {
        $(pub(super) const $constant: Word = words!(@one $full $($least)?);)*

        /// Every keyword of the language with the number of letters that are enough of it.
        pub const KEYWORDS: &[(&str, usize)] = &[$(($constant.full, $constant.least)),*];
    };
    (@one $full:literal $least:literal) => { Word::new($full, $least) };
    (@one $full:literal) => { Word::whole($full) };
}

words! {
    // Commands.
    CONNECT = "CONNECT" 4;
    DISCONNECT = "DISCONNECT" 4;
    SEND = "SEND";
    STORE = "STORE";
    VARIABLE = "VARIABLE" 3;
    SETUP = "SETUP";
    CNESS = "CNESS";
    INCLUDE = "INCLUDE" 4;
    REMOVE = "REMOVE" 3;
    DISPLAY = "DISPLAY" 4;
    DELETE = "DELETE" 3;
    FORGET = "FORGET" 3;
    FOLLOW = "FOLLOW" 3;
    PREFIX = "PREFIX" 3;
    INITIALIZE = "INITIALIZE" 4;
    STATE = "STATE";
    BEGIN = "BEGIN";
    END = "END";
    OPTIMIZE = "OPTIMIZE" 3;
    STRUCTURE = "STRUCTURE" 4;
    RESERVE_WORKING_STORAGE = "RESERVE_WORKING_STORAGE";
    COMMAND = "COMMAND" 3;
    STATUS = "STATUS" 4;
    RESET = "RESET";
    CONNECTIONS = "CONNECTIONS" 4;
    NAMES = "NAMES" 4;
    // What a name can denote.
    FUNCTION = "F";
    NIL = "NIL";
    INSTANCE = "INSTANCE" 4;
    BEGIN_STRUCTURE = "BEGIN_STRUCTURE" 7;
    END_STRUCTURE = "END_STRUCTURE" 5;
    ROTATE = "ROTATE" 3;
    TRANSLATE = "TRANSLATE" 4;
    SCALE = "SCALE" 3;
    MATRIX2 = "MATRIX_2x2";
    MATRIX3 = "MATRIX_3x3";
    MATRIX4X3 = "MATRIX_4x3";
    MATRIX4 = "MATRIX_4x4";
    LOOK = "LOOK";
    FIELD_OF_VIEW = "FIELD_OF_VIEW" 5;
    FOV = "FOV";
    WINDOW = "WINDOW";
    EYE = "EYE";
    VIEWPORT = "VIEWPORT" 4;
    SET = "SET";
    IF = "IF";
    INCREMENT = "INCREMENT" 4;
    DECREMENT = "DECREMENT" 4;
    STANDARD = "STANDARD" 4;
    TEXT = "TEXT";
    XFORM = "XFORM";
    SURFACE_RENDERING = "SURFACE_RENDERING" 12;
    SOLID_RENDERING = "SOLID_RENDERING" 10;
    SECTIONING_PLANE = "SECTIONING_PLANE" 4;
    VECTOR_LIST = "VECTOR_LIST" 3;
    CHARACTERS = "CHARACTERS" 4;
    CHARACTER = "CHARACTER" 4;
    LABELS = "LABELS";
    RATIONAL = "RATIONAL" 3;
    BSPLINE = "BSPLINE";
    POLYNOMIAL = "POLYNOMIAL" 4;
    POLYGON = "POLYGON" 4;
    ATTRIBUTES = "ATTRIBUTES" 4;
    ILLUMINATION = "ILLUMINATION" 5;
    PATTERN = "PATTERN" 3;
    BEGIN_FONT = "BEGIN_FONT" 7;
    END_FONT = "END_FONT" 5;
    COPY = "COPY";
    // After SET or IF.
    COLOR = "COLOR";
    INTENSITY = "INTENSITY" 5;
    DEPTH_CLIPPING = "DEPTH_CLIPPING" 8;
    PICKING = "PICKING" 4;
    IDENTIFIER = "IDENTIFIER" 2;
    CONDITIONAL_BIT = "CONDITIONAL_BIT" 4;
    COND_BIT = "COND_BIT";
    LOCATION = "LOCATION" 3;
    LEVEL_OF_DETAIL = "LEVEL_OF_DETAIL" 3;
    RATE = "RATE";
    EXTERNAL = "EXTERNAL" 3;
    PHASE = "PHASE";
    CONTRAST = "CONTRAST";
    PLOTTER = "PLOTTER" 4;
    LINE_TEXTURE = "LINE_TEXTURE" 4;
    BLENDING = "BLENDING" 4;
    ON = "ON";
    OFF = "OFF";
    // After EYE, TEXT, STANDARD, XFORM, CHARACTER.
    LEFT = "LEFT";
    RIGHT = "RIGHT";
    DOWN = "DOWN";
    SCREEN = "SCREEN";
    AREA = "AREA";
    WIDE = "WIDE";
    FONT = "FONT";
    SIZE = "SIZE";
    MATRIX = "MATRIX";
    // Vector lists and characters.
    CONNECTED = "CONNECTED" 4;
    SEPARATE = "SEPARATE" 3;
    DOTS = "DOTS" 3;
    ITEMIZED = "ITEMIZED" 4;
    TABULATED = "TABULATED" 3;
    BLOCK_NORMALIZED = "BLOCK_NORMALIZED" 5;
    N = "N";
    P = "P";
    L = "L";
    I = "I";
    T = "T";
    S = "S";
    C = "C";
    STEP = "STEP";
    // Curves, patterns, copies.
    ORDER = "ORDER";
    OPEN = "OPEN";
    CLOSED = "CLOSED";
    NONPERIODIC = "NONPERIODIC";
    PERIODIC = "PERIODIC";
    VERTICES = "VERTICES";
    KNOTS = "KNOTS";
    CHORDS = "CHORDS";
    COEFFICIENTS = "COEFFICIENTS";
    AROUND_CORNERS = "AROUND_CORNERS" 6;
    MATCH = "MATCH";
    NOMATCH = "NOMATCH";
    LENGTH = "LENGTH";
    START = "START";
    COUNT = "COUNT";
    // Faces and lights.
    OUTLINE = "OUTLINE";
    COPLANAR = "COPLANAR";
    OPAQUE = "OPAQUE";
    DIFFUSE = "DIFFUSE";
    SPECULAR = "SPECULAR";
    AND = "AND";
    AMBIENT = "AMBIENT";
    // Values.
    TRUE = "TRUE";
    FALSE = "FALSE";
    FIX = "FIX";
    CHAR = "CHAR";
    VALUE = "VALUE";
    VL = "VL";
    V2D = "V2D";
    V3D = "V3D";
    V4D = "V4D";
    M2D = "M2D";
    M3D = "M3D";
    M4D = "M4D";
    M4X3 = "M4X3";
    // Between operands.
    APPLIED = "APPLIED" 4;
    THEN = "THEN";
    TO = "TO";
    OF = "OF";
    IN = "IN";
    BY = "BY";
    IS = "IS";
    FROM = "FROM";
    WITH = "WITH";
    ALL = "ALL";
    AT = "AT";
    UP = "UP";
    X = "X";
    Y = "Y";
    Z = "Z";
    HORIZONTAL = "HORIZONTAL" 3;
    VERTICAL = "VERTICAL" 4;
    FRONT = "FRONT";
    BACK = "BACK";
    BOUNDARY = "BOUNDARY" 5;
}

/// What a command can begin with, beside a name and `:=`.
pub(super) const COMMANDS: [Word; 22] = [
    CONNECT,
    DISCONNECT,
    SEND,
    STORE,
    VARIABLE,
    SETUP,
    INCLUDE,
    REMOVE,
    DISPLAY,
    DELETE,
    FORGET,
    FOLLOW,
    PREFIX,
    INITIALIZE,
    PATTERN,
    BEGIN,
    END,
    OPTIMIZE,
    RESERVE_WORKING_STORAGE,
    COMMAND,
    BEGIN_STRUCTURE,
    END_STRUCTURE,
];

/// What can stand after `:=`, beside `F:`.
pub(super) const NODES: [Word; 37] = [
    NIL,
    INSTANCE,
    BEGIN_STRUCTURE,
    ROTATE,
    TRANSLATE,
    SCALE,
    MATRIX2,
    MATRIX3,
    MATRIX4X3,
    MATRIX4,
    LOOK,
    FIELD_OF_VIEW,
    WINDOW,
    EYE,
    VIEWPORT,
    SET,
    IF,
    INCREMENT,
    DECREMENT,
    STANDARD,
    TEXT,
    XFORM,
    SURFACE_RENDERING,
    SOLID_RENDERING,
    SECTIONING_PLANE,
    VECTOR_LIST,
    CHARACTERS,
    LABELS,
    RATIONAL,
    BSPLINE,
    POLYNOMIAL,
    POLYGON,
    ATTRIBUTES,
    ILLUMINATION,
    PATTERN,
    BEGIN_FONT,
    COPY,
];

/// What can stand after SET.
pub(super) const ATTRIBUTE_WORDS: [Word; 11] = [
    COLOR,
    INTENSITY,
    DEPTH_CLIPPING,
    PICKING,
    CONDITIONAL_BIT,
    LEVEL_OF_DETAIL,
    RATE,
    CONTRAST,
    DISPLAY,
    PLOTTER,
    LINE_TEXTURE,
];

/// What can stand after IF.
pub(super) const CONDITIONS: [Word; 3] = [CONDITIONAL_BIT, LEVEL_OF_DETAIL, PHASE];

/// Two differences are a typing error, more are another word. Our choice.
const DISTANCE_MAX: usize = 2;
/// Nothing longer than the longest keyword with two letters too many is compared.
const COMPARED_CHARACTERS_MAX: usize = 25;

/// What to tell somebody who wrote `written` where one of `known` belongs.
pub(super) fn hint(written: &str, known: &[Word]) -> Option<String> {
    if written.chars().count() > COMPARED_CHARACTERS_MAX {
        return None;
    }
    let upper = written.to_ascii_uppercase();
    let nearest = known
        .iter()
        .map(|word| (distance(&upper, &word.full.to_ascii_uppercase()), word.full))
        .min()?;
    (nearest.0 <= DISTANCE_MAX && nearest.0 < upper.chars().count())
        .then(|| format!("did you mean {}?", nearest.1))
}

/// The keywords of a table as an expectation: `COLOR, INTENSITY or PICKING`.
pub(super) fn listed(known: &[Word]) -> String {
    let mut text = String::new();
    for (index, word) in known.iter().enumerate() {
        if index > 0 {
            text.push_str(if index + 1 == known.len() { " or " } else { ", " });
        }
        text.push_str(word.full);
    }
    text
}

/// Levenshtein's distance: insertions, deletions and substitutions of characters.
fn distance(from: &str, to: &str) -> usize {
    let to: Vec<char> = to.chars().collect();
    let mut row: Vec<usize> = (0..=to.len()).collect();
    for (index, character) in from.chars().enumerate() {
        let mut diagonal = index;
        row[0] = index + 1;
        for (column, &other) in to.iter().enumerate() {
            let substituted = diagonal + usize::from(character != other);
            diagonal = row[column + 1];
            row[column + 1] = substituted.min(row[column] + 1).min(diagonal + 1);
        }
    }
    row[to.len()]
}
