//! Inlets of a device's instance: names, kinds, and what arrives there.
//!
//! `NAME_LABEL<n>`, `NAME_LAMP<n>`, `NAME_COLOUR<n>`, `NAME_RING<n>`, `NAME_MOTOR<n>`, `NAME_LEVEL<n>` and
//! `NAME_HAPTIC<n>` show something beside control `n`, or let it be felt; the others set how controls work. Pages have instances of their own, with inlets of their own to show.

use ps300::value::{Kind, Kinds};

/// Pages a device has: as many as a hand finds without looking.
pub(crate) const PAGES: u8 = 4;

/// What an inlet is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Inlet {
    /// How controls get hold, or what buttons send.
    Mode,
    /// What relative controls are multiplied with.
    Gear,
    /// How much farther they go when turned fast.
    Curve,
    /// The quiet middle of what springs back, a share of its way.
    Zone,
    /// <1> fine gear.
    Fine,
    /// <1> goes to a page and stays, <2> whether pages follow the selected link or joint, <3> to <6> for which link
    /// or joint each page comes up.
    Page,
    /// Text beside a control, on a page.
    Label(u8),
    /// Light of a lamp, on a page: TRUE, FALSE, or a share.
    Lamp(u8),
    /// Light of a ring, on a page: a share; negative is dark.
    Ring(u8),
    /// Place of a motor fader, on a page: a share.
    Motor(u8),
    /// A meter, or a brightness of the whole device, on a page: a share.
    Level(u8),
    /// Colour of a lamp, or under a label that is drawn, on a page: shares of red, green and blue.
    Colour(u8),
    /// Clicks to be felt, each time a number comes.
    Haptic,
}

/// The instance of a page.
pub(crate) fn instance(name: &str, page: u8) -> String {
    match page {
        0 | 1 => name.to_owned(),
        page => format!("{name}_PAGE{page}"),
    }
}

/// The names of all inlets of a device, what they are for and what each takes. `count` is the greatest number.
pub(crate) fn all(name: &str, count: u8) -> Vec<(String, Inlet, Vec<Kinds>)> {
    let each = |kinds: Kinds| vec![kinds; usize::from(count.max(1))];
    let lit = Kinds::BOOLEAN.or(Kinds::NUMBER);
    let mut page = vec![Kinds::NUMBER, Kinds::BOOLEAN];
    page.extend(vec![Kinds::STRING; usize::from(PAGES)]);
    let mut inlets = vec![
        (format!("{name}_MODE"), Inlet::Mode, each(Kinds::STRING)),
        (format!("{name}_GEAR"), Inlet::Gear, each(Kinds::NUMBER)),
        (format!("{name}_CURVE"), Inlet::Curve, each(Kinds::NUMBER)),
        (format!("{name}_ZONE"), Inlet::Zone, each(Kinds::NUMBER)),
        (format!("{name}_FINE"), Inlet::Fine, vec![Kinds::BOOLEAN]),
        (format!("{name}_PAGE"), Inlet::Page, page),
        (format!("{name}_HAPTIC"), Inlet::Haptic, each(lit)),
    ];
    for number in 1..=PAGES {
        let name = instance(name, number);
        inlets.push((format!("{name}_LABEL"), Inlet::Label(number), each(Kinds::STRING)));
        inlets.push((format!("{name}_LAMP"), Inlet::Lamp(number), each(lit)));
        inlets.push((format!("{name}_RING"), Inlet::Ring(number), each(Kinds::NUMBER)));
        inlets.push((format!("{name}_MOTOR"), Inlet::Motor(number), each(Kinds::NUMBER)));
        inlets.push((format!("{name}_LEVEL"), Inlet::Level(number), each(Kinds::NUMBER)));
        let colour = Kinds::of(&[Kind::Vector3]);
        inlets.push((format!("{name}_COLOUR"), Inlet::Colour(number), each(colour)));
    }
    inlets
}

/// The device that a name of one of its pages or inlets speaks of.
pub(crate) fn device_of(name: &str) -> &str {
    const WORDS: [&str; 12] = [
        "MODE", "GEAR", "CURVE", "ZONE", "FINE", "LABEL", "LAMP", "RING", "MOTOR", "LEVEL", "COLOUR",
        "HAPTIC",
    ];
    let cut = |word: &&str| name.strip_suffix(*word)?.strip_suffix('_');
    let stem = WORDS.iter().find_map(cut).unwrap_or(name);
    let page = stem.rsplit_once("_PAGE");
    let page = page.filter(|(_, number)| number.len() <= 1 && number.chars().all(|c| c.is_ascii_digit()));
    page.map_or(stem, |(device, _)| device)
}

/// A name for the network from any other: letters, digits, `_`, in capitals, beginning with a letter.
pub(crate) fn spelled(name: &str) -> String {
    let mut spelled: String = name
        .chars()
        .map(|c| {
            if c.is_ascii_alphanumeric() {
                c.to_ascii_uppercase()
            } else {
                '_'
            }
        })
        .collect();
    if !spelled.starts_with(|c: char| c.is_ascii_alphabetic()) {
        spelled.insert_str(0, "DEVICE_");
    }
    spelled
}

#[cfg(test)]
mod tests {
    use super::*;
    use ps300::language::Name;

    #[test]
    fn names_lead_back_to_their_device() {
        for (inlet, ..) in all("NANO_2", 3) {
            assert_eq!(device_of(&inlet), "NANO_2", "{inlet}");
        }
        for page in 1..=PAGES {
            assert_eq!(device_of(&instance("NANO", page)), "NANO");
        }
    }

    #[test]
    fn every_name_can_be_written() {
        for (name, spelt) in [
            ("dial-box", "DIAL_BOX"),
            ("2 pots", "DEVICE_2_POTS"),
            ("nano", "NANO"),
            ("µ", "DEVICE__"),
            ("", "DEVICE_"),
        ] {
            assert_eq!(spelled(name), spelt);
            for (inlet, _, kinds) in all(&spelled(name), 127) {
                assert!(
                    Name::is_valid(&inlet) && !kinds.is_empty() && kinds.len() <= 127,
                    "{inlet}"
                );
            }
        }
        assert_eq!([1, 2].map(|page| instance("NANO", page)), ["NANO", "NANO_PAGE2"]);
    }
}
