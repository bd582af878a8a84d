//! Thirteen lamps around a dial: which are lit for a value, for the host's own numbers, and for a V-Pot's.

/// All thirteen.
const ALL: u16 = (1 << 13) - 1;
/// The middle one, from 0.
const MIDDLE: u32 = 6;

/// How a dial draws its own value. The words are the maker's; what exactly they light is ours.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Style {
    /// One lamp.
    #[default]
    Single,
    /// From the middle to the value.
    Pan,
    /// From the left to the value.
    Fan,
    /// From the middle to both sides.
    Spread,
    /// As pan, with the middle always lit.
    Trim,
}

impl Style {
    /// As the host names it; none for what the maker says is ignored.
    pub(super) fn of(value: u8) -> Option<Self> {
        Some(match value {
            0 => Self::Single,
            1 => Self::Pan,
            2 => Self::Fan,
            3 => Self::Spread,
            4 => Self::Trim,
            _ => return None,
        })
    }
}

/// Lamps `from` to `to`, both lit.
fn run(from: u32, to: u32) -> u16 {
    (from.min(to)..=from.max(to)).fold(0, |lamps, lamp| lamps | 1 << lamp)
}

/// The lamps a dial lights for its value, 0 to 127.
pub(super) fn value_lamps(value: i32, style: Style) -> u16 {
    let value = value.clamp(0, 127) as u32;
    let lamp = (value * 12 + 63) / 127;
    match style {
        Style::Single => run(lamp, lamp),
        Style::Pan => run(MIDDLE, lamp),
        Style::Fan => run(0, lamp),
        Style::Spread => {
            let half = (value * 6 + 63) / 127;
            run(MIDDLE - half, MIDDLE + half)
        }
        Style::Trim => run(lamp, lamp) | run(MIDDLE, MIDDLE),
    }
}

/// Standard mode, drawn by the host: lamps and whether they blink; none for what is ignored.
pub(super) fn remote_lamps(value: u8) -> Option<(u16, bool)> {
    Some(match value {
        0 => (0, false),
        1..=13 => (1 << (value - 1), false),
        14..=26 => (1 << (value - 14), true),
        27 => (ALL, false),
        28 => (ALL, true),
        _ => return None,
    })
}

/// MC mode: a V-Pot's eleven lamps, of which Behringer's ring shows the inner ones, and the lamp below as the middle.
pub(super) fn v_pot_lamps(value: u8) -> u16 {
    let position = u32::from(value & 0x0F).min(11);
    let eleven: u32 = match (position, value >> 4 & 3) {
        (0, _) => 0,
        // One dot.
        (p, 0) => 1 << (p - 1),
        // Between the sixth and the position.
        (p, 1) => (5.min(p - 1)..6.max(p)).fold(0, |lamps, lamp| lamps | 1 << lamp),
        // From the left.
        (p, 2) => (1 << p) - 1,
        // To both sides of the sixth.
        (p, _) => {
            let p = p.min(6);
            (6 - p..5 + p).fold(0, |lamps, lamp| lamps | 1 << lamp)
        }
    };
    let centre = u16::from(value >> 6 & 1) << MIDDLE;
    (eleven as u16) << 1 | centre
}
