//! Functions that build a string up from several: until a terminator comes, or the Return key.

use super::function::{Fault, Function, Inputs, Outputs, TEXT_MAX_BYTES, domain};
use super::recalled::{Recalled, restore};
use super::spec::{Confidence, InputSpec, OutputSpec, Preset, Spec};
use crate::value::{Kinds, Value};

const TEXT: InputSpec = InputSpec::active(Kinds::STRING);
const OUT: OutputSpec = OutputSpec::of(Kinds::STRING);

pub(super) const TABLE: &[Spec] = &[
    Spec::stateful(
        "GATHER_STRING",
        &[
            TEXT,
            InputSpec::constant(Kinds::STRING, Preset::Rule("a carriage return, CHAR(13)")),
        ],
        &[OUT],
        |_| Box::<Gather>::default(),
    )
    .says(
        "Collects what comes to <1> until the terminator <2> is in it, then sends what stands \
             before it and begins anew with what stands behind. More than 4096 bytes without a \
             terminator are reported and forgotten; so is a terminator of no characters.",
    )
    .known(
        Confidence::Low,
        "recollected: collects up to a terminator; pins and default ours",
    )
    .example("<2> ';' | <1> 'ar' | <1> 'm;le' | <1> 'g;' -> <1> 'arm' | <1> 'leg'"),
    Spec::stateful("LINEEDITOR", &[TEXT], &[OUT, OUT], |_| {
        Box::<LineEditor>::default()
    })
    .says(
        "Makes lines of keyed characters. Return, CHAR(13) or CHAR(10), sends the line on output \
             <1> and begins the next; CHAR(8) and CHAR(127) take the last character back; CHAR(21) \
             clears the line; other control characters are ignored. Output <2> the line as it stands, \
             after every message. Characters that would make it longer than 4096 bytes are reported \
             and left out.",
    )
    .known(
        Confidence::Low,
        "recollected: keyboard input into lines; keys and pins ours",
    )
    .example(
        "<1> 'arn' | <1> CHAR(8) | <1> 'm' | <1> CHAR(13) -> <2> 'arn' | <2> 'ar' | <2> 'arm' | \
             <1> 'arm' | <2> ''",
    ),
];

#[derive(Default)]
struct Gather {
    text: String,
}

impl Function for Gather {
    fn fire(&mut self, inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
        let terminator = match inputs.find(2) {
            Some(_) => inputs.text(2)?,
            None => "\r",
        };
        if terminator.is_empty() {
            return domain("a terminator has at least one character");
        }
        self.text.push_str(inputs.text(1)?);
        let mut sent = 0;
        while let Some(at) = self.text[sent..].find(terminator) {
            outputs.send(1, &self.text[sent..sent + at]);
            sent += at + terminator.len();
        }
        self.text.drain(..sent);
        if self.text.len() > TEXT_MAX_BYTES {
            self.text.clear();
            return domain("no terminator came within 4096 bytes; they were forgotten");
        }
        Ok(())
    }

    fn remembered(&self) -> Vec<Value> {
        text_state(&self.text)
    }

    fn recall(&mut self, state: &[Value]) -> bool {
        restore(&mut self.text, String::new(), state, Recalled::text)
    }
}

/// A line of a terminal, as it is being written.
#[derive(Default)]
struct LineEditor {
    line: String,
}

impl Function for LineEditor {
    fn fire(&mut self, inputs: &Inputs<'_>, outputs: &mut Outputs<'_>) -> Result<(), Fault> {
        let mut left_out = false;
        for c in inputs.text(1)?.chars() {
            match c {
                '\r' | '\n' => {
                    outputs.send(1, self.line.as_str());
                    self.line.clear();
                }
                '\u{8}' | '\u{7f}' => {
                    self.line.pop();
                }
                '\u{15}' => self.line.clear(),
                control if control.is_control() => {}
                c if self.line.len() + c.len_utf8() > TEXT_MAX_BYTES => left_out = true,
                c => self.line.push(c),
            }
        }
        outputs.send(2, self.line.as_str());
        if left_out {
            return domain("the line is full: 4096 bytes; what came after was left out");
        }
        Ok(())
    }

    fn remembered(&self) -> Vec<Value> {
        text_state(&self.line)
    }

    fn recall(&mut self, state: &[Value]) -> bool {
        restore(&mut self.line, String::new(), state, Recalled::text)
    }
}

fn text_state(text: &str) -> Vec<Value> {
    Some(text)
        .filter(|text| !text.is_empty())
        .map(Value::from)
        .into_iter()
        .collect()
}
