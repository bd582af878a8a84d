//! Events in words: what stands behind `event` in an exchange.

use super::read::ExchangeError;
use super::words::Words;
use crate::codec::{InputEvent, PenSample, Tool};
use std::fmt::Write;

const TOOLS: [(&str, Tool); 4] = [
    ("pen", Tool::Pen),
    ("eraser", Tool::Eraser),
    ("puck", Tool::Puck),
    ("mouse", Tool::Mouse),
];

/// An event in the words that [`read_event`] reads, such as `dial 3 +64`.
pub fn event_words(event: &InputEvent) -> String {
    match *event {
        InputEvent::Pen(sample) => sample_words(&sample),
        InputEvent::Moved { dx, dy, wheel } => {
            let mut words = format!("moved {dx:+} {dy:+}");
            if wheel != 0 {
                let _ = write!(words, " wheel {wheel:+}");
            }
            words
        }
        InputEvent::Touch { id, at: Some([x, y]) } => format!("touch {id} {x} {y}"),
        InputEvent::Touch { id, at: None } => format!("touch {id} away"),
        InputEvent::Dial {
            control,
            delta_counts,
        } => format!("dial {control} {delta_counts:+}"),
        InputEvent::Button { control, down } => {
            format!("button {control} {}", if down { "down" } else { "up" })
        }
        InputEvent::Axis { control, value } => format!("axis {control} {value}"),
        InputEvent::AxisTouched { control, down } => {
            format!("axis {control} {}", if down { "touched" } else { "free" })
        }
        InputEvent::Ring {
            control,
            value: Some(value),
        } => format!("ring {control} {value}"),
        InputEvent::Ring { control, value: None } => format!("ring {control} away"),
        InputEvent::Started => "started".to_owned(),
        InputEvent::Restarted => "restarted".to_owned(),
    }
}

/// Writing to a string cannot fail, so what `write!` says is not looked at.
fn sample_words(sample: &PenSample) -> String {
    let mut words = TOOLS
        .iter()
        .find(|(_, tool)| *tool == sample.tool)
        .map_or("pen", |(word, _)| word)
        .to_owned();
    if !sample.in_range {
        words.push_str(" away");
        return words;
    }
    let _ = write!(words, " {} {}", sample.x_counts, sample.y_counts);
    if sample.pressure_counts != 0 {
        let _ = write!(words, " pressure {}", sample.pressure_counts);
    }
    if sample.tip {
        words.push_str(" tip");
    }
    for button in (0..32).filter(|bit| sample.buttons >> bit & 1 == 1) {
        let _ = write!(words, " button {}", button + 1);
    }
    if let Some([x, y]) = sample.tilt {
        let _ = write!(words, " tilt {x} {y}");
    }
    if let Some(twist) = sample.twist {
        let _ = write!(words, " twist {twist}");
    }
    if let Some(distance) = sample.distance {
        let _ = write!(words, " distance {distance}");
    }
    if sample.wheel != 0 {
        let _ = write!(words, " wheel {:+}", sample.wheel);
    }
    if let Some(serial) = sample.tool_serial {
        let _ = write!(words, " serial 0x{serial:x}");
    }
    if let Some(kind) = sample.tool_type {
        let _ = write!(words, " type 0x{kind:x}");
    }
    words
}

/// Reads an event in its words; what is unsaid of a tool is 0, up, or not told by the tablet.
pub fn read_event(text: &str) -> Result<InputEvent, ExchangeError> {
    let mut words = Words::cut(1, text)?;
    let event = event(&mut words)?;
    words.end().map(|()| event)
}

pub(super) fn event(words: &mut Words) -> Result<InputEvent, ExchangeError> {
    let first = words.word("an event")?;
    if let Some((_, tool)) = TOOLS.iter().find(|(word, _)| *word == first.text) {
        return sample(*tool, words).map(InputEvent::Pen);
    }
    Ok(match first.text.as_str() {
        "moved" => InputEvent::Moved {
            dx: words.number("counts to the right")?,
            dy: words.number("counts towards the user")?,
            wheel: if words.skip("wheel") {
                words.number("clicks")?
            } else {
                0
            },
        },
        "touch" => InputEvent::Touch {
            id: words.number("a finger's number")?,
            at: if words.skip("away") {
                None
            } else {
                Some([words.number("x in counts")?, words.number("y in counts")?])
            },
        },
        "dial" => InputEvent::Dial {
            control: words.number("a dial's number")?,
            delta_counts: words.number("counts such as +64")?,
        },
        "button" => InputEvent::Button {
            control: words.number("a button's number")?,
            down: either(words, "down", "up")?,
        },
        "axis" => axis(words)?,
        "ring" => InputEvent::Ring {
            control: words.number("a ring's number")?,
            value: if words.skip("away") {
                None
            } else {
                Some(words.number("a place on the ring, or `away`")?)
            },
        },
        "started" => InputEvent::Started,
        "restarted" => InputEvent::Restarted,
        other => {
            let known =
                "pen, eraser, puck, mouse, moved, touch, dial, button, axis, ring, started, restarted";
            return Err(words.at(&first, format!("expected an event ({known}), found `{other}`")));
        }
    })
}

fn axis(words: &mut Words) -> Result<InputEvent, ExchangeError> {
    let control = words.number("an axis's number")?;
    Ok(if words.skip("touched") {
        InputEvent::AxisTouched { control, down: true }
    } else if words.skip("free") {
        InputEvent::AxisTouched { control, down: false }
    } else {
        let value = words.number("a value in counts, `touched` or `free`")?;
        InputEvent::Axis { control, value }
    })
}

fn either(words: &mut Words, yes: &str, no: &str) -> Result<bool, ExchangeError> {
    let word = words.word(&format!("`{yes}` or `{no}`"))?;
    match word.text.as_str() {
        text if text == yes => Ok(true),
        text if text == no => Ok(false),
        other => Err(words.at(&word, format!("expected `{yes}` or `{no}`, found `{other}`"))),
    }
}

fn sample(tool: Tool, words: &mut Words) -> Result<PenSample, ExchangeError> {
    if words.skip("away") {
        return Ok(PenSample::hovering(tool, 0, 0).leaving());
    }
    let x = words.number("x in counts, or `away`")?;
    let mut sample = PenSample::hovering(tool, x, words.number("y in counts")?);
    while let Some(word) = words.take() {
        match word.text.as_str() {
            "pressure" => sample.pressure_counts = words.number("counts of pressure")?,
            "tip" => sample.tip = true,
            "button" => {
                let button: u32 = words.number("a button's number from 1")?;
                let bit = button.checked_sub(1).and_then(|bit| 1_u32.checked_shl(bit));
                sample.buttons |= bit.ok_or_else(|| words.fault("buttons of a tool are 1 to 32"))?;
            }
            "tilt" => sample.tilt = Some([words.number("tilt along x")?, words.number("tilt along y")?]),
            "twist" => sample.twist = Some(words.number("steps of twist")?),
            "distance" => sample.distance = Some(words.number("steps of distance")?),
            "wheel" => sample.wheel = words.number("clicks of the wheel")?,
            "serial" => sample.tool_serial = Some(words.number("the tool's own number")?),
            "type" => sample.tool_type = Some(words.number("the code of the kind of tool")?),
            other => {
                let known = "pressure, tip, button, tilt, twist, distance, wheel, serial, type";
                return Err(words.at(&word, format!("expected one of {known}, found `{other}`")));
            }
        }
    }
    Ok(sample)
}
