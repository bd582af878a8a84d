//! What the box shows, and what it should: only differences are sent.

use crate::codec::{Feedback, Outgoing};
use device_profiles::{InputProfile, OutputKind};
use std::collections::BTreeMap;

/// Lamps: four bytes, lamps 0–7 first, bit 0 of each its first lamp.
const LAMPS: u8 = 0x75;
/// Text: the control, then the characters.
const LABEL: u8 = 0x61;

/// Shadow of lamps and labels.
#[derive(Debug)]
pub(super) struct Shown {
    lamps_mask: u32,
    /// Number of displays, and characters on each.
    labels: u16,
    characters: usize,
    lamps: u32,
    lamps_sent: Option<u32>,
    text: BTreeMap<u8, Vec<u8>>,
    text_sent: BTreeMap<u8, Vec<u8>>,
}

impl Shown {
    pub(super) fn new(profile: &InputProfile) -> Self {
        Self {
            lamps_mask: super::low_bits(profile.output_count(OutputKind::Lamp).min(32) as u8),
            labels: profile.output_count(OutputKind::Label),
            characters: profile.label_characters().into(),
            lamps: 0,
            lamps_sent: None,
            text: BTreeMap::new(),
            text_sent: BTreeMap::new(),
        }
    }

    /// Notes what is wanted; what the box does not have is left out.
    pub(super) fn want(&mut self, feedback: &Feedback) {
        match feedback {
            Feedback::Lamps(mask) => self.lamps = *mask as u32 & self.lamps_mask,
            Feedback::Lamp { control, level, .. } => {
                let lamp = 1_u32.checked_shl(u32::from(*control)).unwrap_or(0) & self.lamps_mask;
                self.lamps = if *level > 0 {
                    self.lamps | lamp
                } else {
                    self.lamps & !lamp
                };
            }
            Feedback::Label { control, text } => {
                let there = u8::try_from(*control)
                    .ok()
                    .filter(|&c| u16::from(c) < self.labels);
                if let Some(control) = there {
                    self.text.insert(control, padded(text, self.characters));
                }
            }
            _ => {}
        }
    }

    /// After a start: the box shows nothing we know of.
    pub(super) fn send_everything(&mut self, out: &mut Outgoing) {
        self.lamps_sent = None;
        self.text_sent.clear();
        self.send_changes(out);
    }

    pub(super) fn send_changes(&mut self, out: &mut Outgoing) {
        if self.lamps_mask != 0 && self.lamps_sent != Some(self.lamps) {
            out.bytes(&[LAMPS]);
            out.bytes(&self.lamps.to_le_bytes());
            self.lamps_sent = Some(self.lamps);
        }
        for (control, text) in &self.text {
            if self.text_sent.get(control) != Some(text) {
                out.bytes(&[LABEL, *control]);
                out.bytes(text);
                self.text_sent.insert(*control, text.clone());
            }
        }
    }
}

/// Exactly `characters` bytes of printable ASCII.
fn padded(text: &str, characters: usize) -> Vec<u8> {
    let printable = |c: char| {
        if c.is_ascii_graphic() || c == ' ' {
            c as u8
        } else {
            b'?'
        }
    };
    text.chars()
        .map(printable)
        .chain(std::iter::repeat(b' '))
        .take(characters)
        .collect()
}
