//! Cutting, searching and changing strings.
//!
//! Apart from `text`, which prints and joins, because of these the record has the names only. Characters are
//! counted from 1, as inputs and vectors are.

use std::cmp::Ordering;

use super::function::{Fault, Inputs, Outputs, domain};
use super::spec::{Confidence, InputSpec, OutputSpec, Preset, Spec, Times};
use crate::value::Kinds;

const TEXT: InputSpec = InputSpec::active(Kinds::STRING);
const STORED: InputSpec = InputSpec::required(Kinds::STRING);
const OUT: OutputSpec = OutputSpec::of(Kinds::STRING);
const TRUTH: OutputSpec = OutputSpec::of(Kinds::BOOLEAN);
const WHOLE: OutputSpec = OutputSpec::of(Kinds::INTEGER);
const SOURCE: &str = "name recollected; pins and behaviour ours";

pub(super) const TABLE: &[Spec] = &[
    Spec::pure("COMP_STRING", &[TEXT, TEXT], &[TRUTH, TRUTH, TRUTH], compare)
        .says(
            "Compares two strings character by character. Output <1> whether <1> comes before <2>, \
             output <2> whether they are the same, output <3> whether <1> comes after.",
        )
        .known(Confidence::Low, SOURCE)
        .example("<1> 'arm' | <2> 'leg' -> <1> TRUE | <2> FALSE | <3> FALSE"),
    Spec::pure("SPLIT", &[TEXT, STORED], &[OUT, OUT, OUT], split)
        .says(
            "Cuts <1> at the first delimiter <2>: output <1> what stands before, <2> the delimiter, \
             <3> what stands behind. Without a delimiter in it the whole string leaves on output <1> \
             alone. A delimiter of no characters is reported.",
        )
        .known(
            Confidence::Low,
            "recollected: a string cut in three; the rest ours",
        )
        .example("<2> ': ' | <1> 'arm: 12' -> <1> 'arm' | <2> ': ' | <3> '12'"),
    Spec::pure(
        "TAKE_STRING",
        &[
            TEXT,
            InputSpec::constant(Kinds::INTEGER, Preset::Integer(1)),
            InputSpec::constant(Kinds::INTEGER, Preset::Rule("to the end")),
        ],
        &[OUT],
        take,
    )
    .says(
        "The part of <1> that begins with character <2> and has <3> characters, or as many as \
             there are. A first character below 1 or a count below 0 is reported.",
    )
    .known(Confidence::Low, SOURCE)
    .example("<2> FIX(3) | <3> FIX(4) | <1> 'upperarm' -> <1> 'pera'"),
    Spec::pure(
        "PUT_STRING",
        &[
            TEXT,
            STORED,
            InputSpec::constant(Kinds::INTEGER, Preset::Rule("behind the last character")),
        ],
        &[OUT],
        put,
    )
    .says("<1> with <2> put in before character <3>. A place the string does not have is reported.")
    .known(Confidence::Low, SOURCE)
    .example("<2> 'per' | <3> FIX(3) | <1> 'uparm' -> <1> 'upperarm'"),
    Spec::pure("FIND_STRING", &[TEXT, STORED], &[WHOLE, TRUTH], find)
        .says(
            "Looks for <2> in <1>. Output <1> the character it first begins with, 0 if it is nowhere; \
             output <2> whether it was found.",
        )
        .known(Confidence::Low, SOURCE)
        .example("<2> 'arm' | <1> 'upperarm' -> <1> FIX(6) | <2> TRUE"),
    Spec::pure("TRANS_STRING", &[TEXT, STORED, STORED], &[OUT], translate)
        .says(
            "<1> with each character that occurs in <2> replaced by the one at the same place in <3>; \
             characters of <2> without a fellow in <3> are left out.",
        )
        .known(Confidence::Low, SOURCE)
        .example("<2> 'abc-' | <3> 'ABC' | <1> 'cab-12' -> <1> 'CAB12'"),
    Spec::pure("MCAT_STRING", &[TEXT.times(Times::Size)], &[OUT], join)
        .sized(2, 127)
        .says("All inputs joined in order; at most 4096 bytes.")
        .known(Confidence::Low, "name and purpose recollected; pins ours")
        .example("(3) | <1> 'a' | <2> 'b' | <3> 'c' -> <1> 'abc'"),
    Spec::pure("CHARCONVERT", &[TEXT], &[WHOLE], codes)
        .says("The code of each character of a string, one message each, in order.")
        .known(
            Confidence::Low,
            "recollected: characters to integers; the rest ours",
        )
        .example("<1> 'AB' -> <1> FIX(65) | <1> FIX(66)"),
    Spec::pure(
        "CHARMASK",
        &[TEXT, InputSpec::constant(Kinds::INTEGER, Preset::Integer(127))],
        &[OUT],
        mask,
    )
    .says(
        "<1> with the code of each character masked bit by bit by <2>, which lies between 0 and \
             255; other masks are reported.",
    )
    .known(
        Confidence::Low,
        "recollected: characters masked; the default, seven bits, ours",
    )
    .example("<2> FIX(223) | <1> 'arm' -> <1> 'ARM'"),
];

fn compare(inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
    let order = inputs.text(1)?.cmp(inputs.text(2)?);
    outputs.send(1, order == Ordering::Less);
    outputs.send(2, order == Ordering::Equal);
    outputs.send(3, order == Ordering::Greater);
    Ok(())
}

fn split(inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
    let (text, delimiter) = (inputs.text(1)?, inputs.text(2)?);
    if delimiter.is_empty() {
        return domain("a delimiter has at least one character");
    }
    match text.split_once(&**delimiter) {
        Some((before, behind)) => {
            outputs.send(1, before);
            outputs.send(2, delimiter.clone());
            outputs.send(3, behind);
        }
        None => outputs.send(1, text.clone()),
    }
    Ok(())
}

fn take(inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
    let Some(skipped) = usize::try_from(inputs.integer(2)?)
        .ok()
        .and_then(|n| n.checked_sub(1))
    else {
        return domain("characters are counted from 1");
    };
    let count = match inputs.find(3) {
        None => usize::MAX,
        Some(_) => match usize::try_from(inputs.integer(3)?) {
            Ok(count) => count,
            Err(_) => return domain("a count is not negative"),
        },
    };
    let taken: String = inputs.text(1)?.chars().skip(skipped).take(count).collect();
    outputs.send(1, taken.as_str());
    Ok(())
}

fn put(inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
    let (text, added) = (inputs.text(1)?, inputs.text(2)?);
    let place = match inputs.find(3) {
        None => Some(text.len()),
        Some(_) => byte_of(text, inputs.integer(3)?),
    };
    let Some((before, behind)) = place.and_then(|place| text.split_at_checked(place)) else {
        return domain("the string has no character of that number to put before");
    };
    outputs.send_text(1, &[before, &**added, behind].concat())
}

/// Where character `number` begins; one more than there are characters is the end.
fn byte_of(text: &str, number: i32) -> Option<usize> {
    let before = usize::try_from(number).ok()?.checked_sub(1)?;
    let starts = text.char_indices().map(|(at, _)| at);
    starts.chain(std::iter::once(text.len())).nth(before)
}

fn find(inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
    let (text, sought) = (inputs.text(1)?, inputs.text(2)?);
    let at = text.find(&**sought);
    let number = at.map_or(0, |at| text[..at].chars().count() + 1);
    outputs.send(1, number as i32);
    outputs.send(2, at.is_some());
    Ok(())
}

fn translate(inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
    let (from, to) = (inputs.text(2)?, inputs.text(3)?);
    let changed = |c: char| match from.chars().position(|known| known == c) {
        Some(at) => to.chars().nth(at),
        None => Some(c),
    };
    let text: String = inputs.text(1)?.chars().filter_map(changed).collect();
    outputs.send_text(1, &text)
}

fn join(inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
    let mut joined = String::new();
    for number in 1..=inputs.count() {
        joined.push_str(inputs.text(number)?);
    }
    outputs.send_text(1, &joined)
}

fn codes(inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
    for c in inputs.text(1)?.chars() {
        outputs.send(1, c as i32);
    }
    Ok(())
}

fn mask(inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
    let Ok(mask) = u8::try_from(inputs.integer(2)?) else {
        return domain("a mask lies between 0 and 255");
    };
    let masked = |c: char| char::from((u32::from(c) as u8) & mask);
    let text: String = inputs.text(1)?.chars().map(masked).collect();
    outputs.send_text(1, &text)
}
