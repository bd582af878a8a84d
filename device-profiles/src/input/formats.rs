//! The wire formats there are.

/// Every format that a profile may name, in alphabetical order. Each has a page of its name in
/// `docs/protocols/` and a codec on the host's side.
pub const FORMATS: &[&str] = &[
    "calcomp",
    "deej",
    "firmata",
    "gtco",
    "hid",
    "hp-dial-box",
    "midi",
    "mm",
    "monome-arc",
    "osc",
    "sgi-dial-box",
    "spectragraphics-dial-box",
    "wacom-iv",
    "wacom-v",
];
