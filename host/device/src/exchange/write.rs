//! From records to text. What is written reads back as the same.

use super::{Exchange, Record, What, event_words, show_words};
use crate::codec::{Answer, Step};
use std::fmt::Write;
use std::time::Duration;

/// The text of an exchange.
pub fn write(exchange: &Exchange) -> String {
    let mut text = String::new();
    let head = &exchange.head;
    let interface = head.interface.map(|number| number.to_string());
    let lines = [
        ("profile", head.profile.as_deref()),
        ("source", head.source.as_deref()),
        ("simulator", head.simulator.as_deref()),
        ("interface", interface.as_deref()),
        ("begins", head.reporting.then_some("reporting")),
    ];
    for (key, value) in lines {
        if let Some(value) = value {
            let _ = writeln!(text, "{key}: {}", value.replace(['\n', '\r'], " "));
        }
    }
    for record in &exchange.records {
        write_record(&mut text, record);
    }
    text
}

/// Appends one line. A picture, which no text holds, is left out.
pub fn write_record(text: &mut String, record: &Record) {
    let start = text.len();
    // Writing to a string cannot fail.
    let _ = match &record.what {
        What::Host(step) => write!(text, "host   > {}", step_words(step)),
        What::Device(bytes) => write!(text, "device < {}", hex(bytes)),
        What::Answer(answer) => write!(text, "device < {}", answer_words(answer)),
        What::Gone => write!(text, "device gone"),
        What::Back => write!(text, "device back"),
        What::Event(event) => write!(text, "event  {}", event_words(event)),
        What::Surface {
            max_counts: [x, y],
            pressure_max,
        } => write!(text, "surface {x} {y} pressure {pressure_max}"),
        What::Show(feedback) => match show_words(feedback) {
            Some(words) => write!(text, "show   {words}"),
            None => return,
        },
        What::Hand(words) => write!(text, "hand   {words}"),
        What::Pause => write!(text, "pause"),
    };
    if let Some(at) = record.at {
        // The times stand in one column where the bytes leave room for it.
        let width = text.len() - start;
        let _ = write!(
            text,
            "{:1$}@ {2}",
            "",
            40_usize.saturating_sub(width).max(1),
            time_words(at)
        );
    }
    text.push('\n');
}

/// Seconds, exact: at least three decimals, at most nine.
pub fn time_words(at: Duration) -> String {
    let mut words = format!("{}.{:09}", at.as_secs(), at.subsec_nanos());
    while words.ends_with('0') && words.len() > words.find('.').map_or(0, |point| point + 4) {
        words.pop();
    }
    words
}

fn hex(bytes: &[u8]) -> String {
    let pairs: Vec<String> = bytes.iter().map(|byte| format!("{byte:02x}")).collect();
    pairs.join(" ")
}

fn step_words(step: &Step) -> String {
    match step {
        Step::Bytes(bytes) => hex(bytes),
        Step::Report(bytes) => format!("report {}", hex(bytes)),
        Step::Baud(baud) => format!("baud {baud}"),
        Step::Feature(bytes) => format!("feature {}", hex(bytes)),
        Step::AskFeature { id, bytes } => format!("ask feature {id:02x} {bytes}"),
        Step::AskString(index) => format!("ask string {index}"),
        Step::AskDescriptor => "ask descriptor".to_owned(),
        Step::Wait(span) => format!("wait {}", time_words(*span)),
    }
}

fn answer_words(answer: &Answer) -> String {
    let (head, bytes) = match answer {
        // The id stands first in the report as well.
        Answer::Feature { id, bytes } => (
            format!("feature {id:02x}"),
            bytes.as_ref().map(|report| report.get(1..).unwrap_or_default()),
        ),
        Answer::Text { index, raw } => (format!("string {index}"), raw.as_ref().map(Vec::as_slice)),
        Answer::Descriptor(bytes) => ("descriptor".to_owned(), bytes.as_ref().map(Vec::as_slice)),
    };
    match bytes {
        Ok([]) => head,
        Ok(bytes) => format!("{head} {}", hex(bytes)),
        Err(why) => format!("{head} refused {}", one_line(why)),
    }
}

/// Reasons are other programs' words; marks that mean something here are taken out of them.
fn one_line(text: &str) -> String {
    let plain: String = text
        .chars()
        .map(|letter| match letter {
            '#' | '"' | '@' => '\'',
            letter if letter.is_control() => ' ',
            letter => letter,
        })
        .collect();
    plain.split_whitespace().collect::<Vec<_>>().join(" ")
}
