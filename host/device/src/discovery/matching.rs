//! Which profile a device is: on data only.

use super::{Access, Found};
use crate::codec::outline::ReportKind;
use device_profiles::{Bus, InputProfile, Match, Profiles};
use std::collections::BTreeMap;

/// What came out.
#[derive(Clone, Debug, PartialEq)]
pub enum Verdict<'a> {
    /// This one.
    One(&'a InputProfile),
    /// These fit equally well: whoever uses the device must say which it is.
    Several(Vec<&'a InputProfile>),
    /// Nobody knows it, but its own description says what it is: usage page and usage.
    Generic([u16; 2]),
    /// A line that says nothing of what hangs on it. These are asked over a line; asking an unknown device could do
    /// anything, so somebody must say it.
    Line(Vec<&'a InputProfile>),
    /// None, and why.
    Nobody(String),
}

/// How much a match asked for, the weightiest first: strings, their characters, lengths, texts, usage and interface,
/// ids.
type Rank = (usize, usize, usize, usize, usize, usize);

/// Why a match does not hold; `near` where the ids did.
struct Miss {
    near: bool,
    why: String,
}

/// Usages that are controls and work by their description: digitizers and pens, joysticks, multi-axis controllers,
/// knobs. Mice and keyboards are the system's.
const GENERIC: [[u16; 2]; 6] = [
    [0x0D, 1],
    [0x0D, 2],
    [0x01, 4],
    [0x01, 5],
    [0x01, 8],
    [0x01, 0x0E],
];

/// Holds a device against all profiles. `string` reads a USB string, and is asked only where everything else fits.
pub fn judge<'a>(
    found: &Found,
    profiles: &'a Profiles,
    string: &mut dyn FnMut(u8) -> Result<String, String>,
) -> Verdict<'a> {
    let mut best: Vec<(&InputProfile, Rank)> = Vec::new();
    let mut asked_on_line = Vec::new();
    let mut misses = Vec::new();
    for profile in profiles.inputs() {
        let mut ranks = Vec::new();
        for m in &profile.matches {
            if m.bus == Bus::Serial && found.bus == Bus::Serial && !names_something(m) {
                asked_on_line.push(profile);
                continue;
            }
            match fit(m, found, string) {
                Ok(rank) => ranks.push(rank),
                Err(miss) if miss.near => misses.push(format!("{}: {}", profile.key, miss.why)),
                Err(_) => {}
            }
        }
        if is_sibling(profile, found) {
            ranks.push(Rank::default());
        }
        if let Some(rank) = ranks.into_iter().max() {
            best.push((profile, rank));
        }
    }
    let Some(most) = best.iter().map(|(_, rank)| *rank).max() else {
        return nobody(found, asked_on_line, &misses);
    };
    best.retain(|(_, rank)| *rank == most);
    match best.as_slice() {
        [(only, _)] => Verdict::One(only),
        several => Verdict::Several(several.iter().map(|(profile, _)| *profile).collect()),
    }
}

/// Whether a match on a serial line has anything that can be seen without asking.
fn names_something(m: &Match) -> bool {
    m.vendor.is_some() || m.product_text.is_some() || m.maker_text.is_some() || m.serial_text.is_some()
}

/// Some devices return from their handshake as another product. Of their interfaces it is that which has all that a
/// match asks for but the ids; strings were answered before, and are not asked for again.
fn is_sibling(profile: &InputProfile, found: &Found) -> bool {
    let siblings = profile.init.iter().filter_map(|step| step.expect_sibling);
    siblings.into_iter().any(|[vendor, product]| {
        profile.matches.iter().any(|m| {
            let returned = Match {
                vendor: Some(vendor),
                product: Some(product),
                strings: BTreeMap::new(),
                not_strings: BTreeMap::new(),
                ..m.clone()
            };
            m.bus == Bus::Usb && fit(&returned, found, &mut |_| Err(String::new())).is_ok()
        })
    })
}

fn nobody<'a>(found: &Found, mut on_line: Vec<&'a InputProfile>, misses: &[String]) -> Verdict<'a> {
    if found.bus == Bus::Serial && !on_line.is_empty() {
        on_line.dedup_by_key(|profile| profile.key.clone());
        return Verdict::Line(on_line);
    }
    if !misses.is_empty() {
        return Verdict::Nobody(format!("its ids are known, but {}", misses.join("; ")));
    }
    if let Some(usage) = found.outline.usages.iter().find(|usage| GENERIC.contains(usage)) {
        return Verdict::Generic(*usage);
    }
    Verdict::Nobody(match found.id() {
        Some(id) => format!("no profile has the ids {id}"),
        None => "no profile fits".to_owned(),
    })
}

/// How well a match fits, all that it asks for being so.
fn fit(m: &Match, found: &Found, string: &mut dyn FnMut(u8) -> Result<String, String>) -> Result<Rank, Miss> {
    let far = || Miss {
        near: false,
        why: String::new(),
    };
    if m.bus != found.bus {
        return Err(far());
    }
    let same = |wanted: Option<u16>, there: Option<u16>| wanted.is_none_or(|wanted| there == Some(wanted));
    if !same(m.vendor, found.vendor) || !same(m.product, found.product) {
        return Err(far());
    }
    if found.access == Access::Nodeless {
        // Nothing but its ids can be seen.
        let by_ids = m.vendor.is_some() && m.product.is_some();
        return if by_ids { Ok(Rank::default()) } else { Err(far()) };
    }
    // Whoever names only a vendor, or nothing, is not near to all of his products.
    let near = m.product.is_some();
    let miss = |why: String| Miss { near, why };
    if let Some(interface) = m.interface
        && found.interface != Some(interface)
    {
        // The device's other interfaces are no news.
        return Err(far());
    }
    if let Some(usage) = m.usage
        && found.outline.usages.first() != Some(&usage)
    {
        return Err(far());
    }
    let lengths = lengths_fit(m, found).map_err(miss)?;
    let texts = texts_fit(m, found).map_err(miss)?;
    let (strings, characters) = strings_fit(m, string).map_err(miss)?;
    let count = |flags: [bool; 2]| flags.into_iter().filter(|flag| *flag).count();
    Ok((
        strings,
        characters,
        lengths,
        texts,
        count([m.usage.is_some(), m.interface.is_some()]),
        count([m.vendor.is_some(), m.product.is_some()]),
    ))
}

fn lengths_fit(m: &Match, found: &Found) -> Result<usize, String> {
    let kinds = [
        (&m.input_report_bytes, ReportKind::Input, "input"),
        (&m.output_report_bytes, ReportKind::Output, "output"),
        (&m.feature_report_bytes, ReportKind::Feature, "feature"),
    ];
    let mut asked = 0;
    for (wanted, kind, word) in kinds {
        if wanted.is_empty() {
            continue;
        }
        asked += 1;
        let longest = found.outline.longest(kind);
        if !wanted.contains(&longest) {
            let wanted: Vec<_> = wanted.iter().map(u16::to_string).collect();
            return Err(format!(
                "expected {word} reports of {} bytes, its longest has {longest}",
                wanted.join(" or ")
            ));
        }
    }
    Ok(asked)
}

fn texts_fit(m: &Match, found: &Found) -> Result<usize, String> {
    let texts = [
        (&m.maker_text, &found.maker, "maker"),
        (&m.product_text, &found.title, "product"),
        (&m.serial_text, &found.serial, "serial number"),
    ];
    let mut asked = 0;
    for (wanted, there, word) in texts {
        let Some(wanted) = wanted else { continue };
        asked += 1;
        if !there.starts_with(wanted.as_str()) {
            return Err(format!(
                "expected a {word} that begins with \"{wanted}\", found \"{there}\""
            ));
        }
    }
    Ok(asked)
}

/// How many strings were asked for, and how many characters of them.
fn strings_fit(
    m: &Match,
    string: &mut dyn FnMut(u8) -> Result<String, String>,
) -> Result<(usize, usize), String> {
    let mut characters = 0;
    for (&index, wanted) in &m.strings {
        let there = string(index).map_err(|why| format!("its string {index} could not be read: {why}"))?;
        if !there.starts_with(wanted.as_str()) {
            return Err(format!(
                "expected its string {index} to begin with \"{wanted}\", found \"{there}\""
            ));
        }
        characters += wanted.len();
    }
    for (&index, unwanted) in &m.not_strings {
        // What cannot be read is not one of those.
        let there = string(index).unwrap_or_default();
        if let Some(is) = unwanted.iter().find(|text| there.starts_with(text.as_str())) {
            return Err(format!("its string {index} begins with \"{is}\""));
        }
    }
    Ok((m.strings.len() + m.not_strings.len(), characters))
}
