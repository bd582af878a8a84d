//! Profiles that no file tells: for a device that describes itself.

use super::{Control, ControlKind, InputKind, InputProfile};
use crate::Status;

impl InputProfile {
    /// A profile with nothing in it but what every one has; its key is `format`.
    pub fn bare(name: &str, kind: InputKind, format: &str, source: &str) -> Self {
        Self {
            key: format.to_owned(),
            name: name.to_owned(),
            status: Status::Untested,
            kind,
            format: format.to_owned(),
            source: source.to_owned(),
            quirks: Vec::new(),
            layout: None,
            of_layout: None,
            skip_bytes: 0,
            leave_after_ms: None,
            matches: Vec::new(),
            line: None,
            init: Vec::new(),
            surface: None,
            tools: Vec::new(),
            own_reports: Vec::new(),
            controls: Vec::new(),
            outputs: Vec::new(),
            wacom: None,
            mm: None,
            calcomp: None,
            hp: None,
            sgi: None,
            firmata: None,
            lines: None,
            osc: None,
        }
    }
}

impl Control {
    /// One control of which only its name and sort are known.
    pub fn bare(kind: ControlKind, name: &str) -> Self {
        Self {
            kind,
            name: name.to_owned(),
            count: 1,
            names: Vec::new(),
            range: None,
            counts_per_turn: None,
            unit: None,
            dead_zone: 0,
            noise_share: None,
            encoding: None,
            midi: None,
            touch: None,
            address: None,
            pins: Vec::new(),
            pull_up: false,
        }
    }
}
