//! From what was seen and what was expected to findings. Pure: nothing here asks anybody anything.

mod health;
mod line;
mod presence;
mod settings;
mod travel;

use super::facts::{Expected, Joint, Patient, Seen};
use super::finding::Finding;
use super::kind::Kind;

/// Everything that is wrong with one line, in the order of kinds, then of ids.
pub fn judge(seen: &Seen, expected: &Expected) -> Vec<Finding> {
    let mut case = Case {
        seen,
        expected,
        findings: Vec::new(),
    };
    presence::judge(&mut case);
    line::judge(&mut case);
    for patient in &seen.patients {
        let Some(model) = &patient.profile else { continue };
        settings::judge(&mut case, patient, model);
        health::judge(&mut case, patient, model);
        // Another model's counts say nothing of this joint.
        if let Some(joint) = expected.joint(patient.id)
            && joint.model.model_number == patient.model_number
        {
            travel::judge(&mut case, patient, joint);
        }
    }
    health::judge_supply(&mut case);
    let mut findings = case.findings;
    findings.sort_by_key(|finding| (finding.kind, finding.id));
    findings
}

/// A line under examination.
struct Case<'a> {
    seen: &'a Seen,
    expected: &'a Expected,
    findings: Vec<Finding>,
}

impl<'a> Case<'a> {
    /// A finding about the whole bus, yet to be noted.
    fn of_bus(&self, kind: Kind, what: impl Into<String>) -> Finding {
        Finding::of_bus(kind, &self.seen.bus, what.into())
    }

    /// A finding about one servo, yet to be noted.
    fn of_servo(&self, kind: Kind, id: u8, what: impl Into<String>) -> Finding {
        Finding {
            joint: self.expected.joint(id).map(|joint| joint.name.clone()),
            id: Some(id),
            ..self.of_bus(kind, what)
        }
    }

    fn note(&mut self, finding: Finding) {
        self.findings.push(finding);
    }

    /// The beginning of a command for this line, up to and with the port.
    fn command(&self, words: &str) -> String {
        format!(
            "dialrig servo {words} --port {} --baud {}",
            self.seen.port, self.seen.baud
        )
    }

    fn answered(&self, joint: &Joint) -> Option<&'a Patient> {
        self.seen.patient(joint.id)
    }
}
