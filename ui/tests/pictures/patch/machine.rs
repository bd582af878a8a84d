//! A network at the other end of the patch panel: a machine of its own, so that the panel can be tried by itself.

use std::sync::Arc;

use ps300::language;
use ps300::{Kinds, Machine, Value};
use rig::{NetworkEdit, NetworkLook, Note, NoteLevel};
use ui::patch::look::Picture;

/// Firings a tick may take: more than any network here needs.
const FIRINGS: u32 = 100_000;

/// The machine, and what a panel is told of it.
pub(crate) struct Link {
    machine: Machine,
    sinks: Vec<(String, Vec<Kinds>)>,
    notes: Vec<Note>,
    past: Vec<String>,
    future: Vec<String>,
    picture: Option<Arc<Picture>>,
    ticks: u64,
}

impl Link {
    /// A machine with this program and the given parameters.
    pub(crate) fn new(program: &str, sinks: &[(&str, &[Kinds])]) -> Link {
        let mut link = Link {
            machine: Machine::new(),
            sinks: sinks
                .iter()
                .map(|(name, kinds)| ((*name).to_owned(), kinds.to_vec()))
                .collect(),
            notes: Vec::new(),
            past: Vec::new(),
            future: Vec::new(),
            picture: None,
            ticks: 0,
        };
        link.load(program);
        link
    }

    fn load(&mut self, program: &str) {
        let mut machine = Machine::new();
        for (name, kinds) in &self.sinks {
            machine.declare_sink(name, kinds).expect("the names are new");
        }
        let wrong = machine.load(program);
        assert!(wrong.is_empty(), "{wrong:?}");
        self.machine = machine;
        self.picture = None;
    }

    pub(crate) fn text(&self) -> String {
        self.machine.network_text()
    }

    /// Does what a hand wanted. Commands that are refused are left out.
    pub(crate) fn edit(&mut self, edit: &NetworkEdit) {
        let before = self.text();
        let (from, to) = match edit {
            NetworkEdit::Undo => (&mut self.past, &mut self.future),
            NetworkEdit::Redo => (&mut self.future, &mut self.past),
            NetworkEdit::Commands(text) => {
                self.machine.load(text);
                self.past.push(before);
                self.future.clear();
                return;
            }
            NetworkEdit::Program(text) => {
                self.load(text);
                self.past.push(before);
                self.future.clear();
                return;
            }
            NetworkEdit::Freeze { name, output, on } => {
                assert!(self.machine.freeze(name, *output, *on), "{edit:?}");
                return;
            }
        };
        if let Some(text) = from.pop() {
            to.push(before);
            self.load(&text);
        }
    }

    pub(crate) fn emit(&mut self, device: &str, output: u8, value: impl Into<Value>) {
        assert!(self.machine.emit(device, output, value), "{device}<{output}>");
    }

    pub(crate) fn tick(&mut self) {
        self.ticks += 1;
        let at_secs = self.ticks as f64 / 60.0;
        self.machine.tick(at_secs, self.ticks, FIRINGS);
        let reports = self.machine.reports();
        self.notes.extend(reports.iter().map(|report| Note {
            at_secs,
            level: NoteLevel::Warning,
            text: report.to_string(),
        }));
    }

    /// What the panel is told now.
    pub(crate) fn look(&mut self) -> (NetworkLook, Vec<Note>) {
        let revision = self.machine.topology_revision();
        let known = self.picture.take().filter(|picture| picture.revision == revision);
        let picture = known.unwrap_or_else(|| Arc::new(self.machine.picture()));
        self.picture = Some(picture.clone());
        let look = NetworkLook {
            activity: Arc::new(self.machine.activity(&picture)),
            text: self.text().into(),
            can_undo: !self.past.is_empty(),
            can_redo: !self.future.is_empty(),
            diagnostics: Arc::default(),
            picture,
        };
        (look, self.notes.clone())
    }
}

/// A text that says the same as another, whatever the order of its commands.
pub(crate) fn sorted(text: &str) -> Vec<String> {
    let (commands, wrong) = language::parse(text);
    assert!(wrong.is_empty(), "{wrong:?}");
    let mut lines: Vec<String> = commands
        .iter()
        .map(|command| language::print(&command.what))
        .collect();
    lines.sort();
    lines
}
