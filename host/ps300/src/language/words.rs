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
    VIEWPORT = "VIEWPORT" 4;
    SET = "SET";
    IF = "IF";
    VECTOR_LIST = "VECTOR_LIST" 3;
    CHARACTERS = "CHARACTERS" 4;
    // After SET or IF.
    COLOR = "COLOR";
    INTENSITY = "INTENSITY" 5;
    DEPTH_CLIPPING = "DEPTH_CLIPPING" 8;
    PICKING = "PICKING" 4;
    IDENTIFIER = "IDENTIFIER" 2;
    CONDITIONAL_BIT = "CONDITIONAL_BIT" 4;
    COND_BIT = "COND_BIT";
    ON = "ON";
    OFF = "OFF";
    // Vector lists and characters.
    CONNECTED = "CONNECTED" 4;
    SEPARATE = "SEPARATE" 3;
    DOTS = "DOTS" 3;
    ITEMIZED = "ITEMIZED" 4;
    BLOCK_NORMALIZED = "BLOCK_NORMALIZED" 5;
    N = "N";
    P = "P";
    L = "L";
    I = "I";
    STEP = "STEP";
    // Values.
    TRUE = "TRUE";
    FALSE = "FALSE";
    FIX = "FIX";
    CHAR = "CHAR";
    VALUE = "VALUE";
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
pub(super) const COMMANDS: [Word; 16] = [
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
    BEGIN_STRUCTURE,
    END_STRUCTURE,
];

/// What can stand after `:=`, beside `F:`.
pub(super) const NODES: [Word; 18] = [
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
    VIEWPORT,
    SET,
    IF,
    VECTOR_LIST,
    CHARACTERS,
];

/// What can stand after SET.
pub(super) const ATTRIBUTES: [Word; 5] = [COLOR, INTENSITY, DEPTH_CLIPPING, PICKING, CONDITIONAL_BIT];

/// Words of the PS 300 that are read nowhere here. Named so that a message can tell them from typing errors.
const ABSENT: [Word; 28] = [
    Word::new("BEGIN", 5),
    Word::new("OPTIMIZE", 4),
    Word::whole("RESERVE_WORKING_STORAGE"),
    Word::new("COMMAND", 3),
    Word::whole("EYE"),
    Word::new("LABELS", 5),
    Word::new("PATTERN", 3),
    Word::whole("BSPLINE"),
    Word::new("POLYNOMIAL", 5),
    Word::new("RATIONAL", 3),
    Word::new("POLYGON", 4),
    Word::new("ATTRIBUTES", 4),
    Word::new("ILLUMINATION", 5),
    Word::new("SURFACE_RENDERING", 12),
    Word::new("SOLID_RENDERING", 10),
    Word::new("SECTIONING_PLANE", 7),
    Word::whole("COPY"),
    Word::whole("XFORM"),
    Word::new("INCREMENT", 4),
    Word::new("DECREMENT", 4),
    Word::new("BEGIN_FONT", 7),
    Word::new("STANDARD", 3),
    Word::whole("RATE"),
    Word::new("LEVEL_OF_DETAIL", 3),
    Word::whole("CONTRAST"),
    Word::new("PLOTTER", 4),
    Word::new("LINE_TEXTURE", 4),
    Word::new("TABULATED", 3),
];

/// Two differences are a typing error, more are another word. Our choice.
const DISTANCE_MAX: usize = 2;
/// Nothing longer than the longest keyword with two letters too many is compared.
const COMPARED_CHARACTERS_MAX: usize = 17;

/// What to tell somebody who wrote `written` where one of `known` belongs.
pub(super) fn hint(written: &str, known: &[Word]) -> Option<String> {
    if ABSENT.iter().any(|word| word.matches(written)) {
        return Some("the PS 300 had this, dialrig does not".to_owned());
    }
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
