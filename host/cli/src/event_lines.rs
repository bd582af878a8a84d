//! The event lines of `monitor` and `decode`: JSON for programs, columns for people.
//!
//! Apart because both commands must write the same; what an event is called is `rig::telling`'s to say.

use rig::listen::InputEvent;
use rig::telling::{Said, Tally, Teller, Told};
use serde_json::{Map, Value, json};

use crate::console::Console;
use crate::failure::Failure;

/// Writes events with their times.
pub(crate) struct EventLines<'a> {
    console: &'a Console,
    teller: Teller,
    /// When the first event or report came; times are told from then.
    first_secs: Option<f64>,
    told: Vec<Told>,
}

impl<'a> EventLines<'a> {
    /// Nothing written yet.
    pub(crate) fn new(console: &'a Console, teller: Teller) -> Self {
        Self {
            console,
            teller,
            first_secs: None,
            told: Vec::new(),
        }
    }

    /// What was written so far.
    pub(crate) fn tally(&self) -> &Tally {
        self.teller.tally()
    }

    /// Writes what there is to say of one event.
    pub(crate) fn tell(&mut self, at_secs: f64, event: &InputEvent) -> Result<(), Failure> {
        let t = at_secs - *self.first_secs.get_or_insert(at_secs);
        let told = &mut self.told;
        self.teller.tell(event, &mut |one| told.push(one));
        for one in self.told.drain(..) {
            write(self.console, t, &one)?;
        }
        Ok(())
    }
}

fn write(console: &Console, t: f64, told: &Told) -> Result<(), Failure> {
    if console.json() {
        return console.record(&record_of(t, told));
    }
    let fields = told
        .fields
        .iter()
        .map(|&(name, value)| format!("{name} {}", value_of(value)));
    let fields: Vec<String> = fields.collect();
    console.line(format_args!("{t:10.3}  {:<9} {}", told.event, fields.join("  ")))
}

/// One event as a JSON object; `t` in seconds.
pub(crate) fn record_of(t: f64, told: &Told) -> Map<String, Value> {
    let mut record = Map::new();
    record.insert("t".into(), json!((t * 1e6).round() / 1e6));
    record.insert("event".into(), json!(told.event));
    let fields = told.fields.iter();
    record.extend(fields.map(|&(name, value)| (name.to_owned(), value_of(value))));
    record
}

fn value_of(said: Said) -> Value {
    match said {
        Said::Number(number) => json!(number),
        Said::Flag(flag) => json!(flag),
        Said::Word(word) => json!(word),
        Said::Nothing => Value::Null,
    }
}
