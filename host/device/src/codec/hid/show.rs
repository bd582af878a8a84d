//! What a device shows and lets feel, where its profile says which report does it: lamps, brightness, clicks.
//!
//! A shadow is kept of what the device was told: only changes go out, and everything when it starts again.

use crate::codec::{Feedback, Outgoing, Step};
use device_profiles::{InputProfile, Output, OutputKind, Place};

/// All outputs of one device.
#[derive(Clone, Debug, Default)]
pub(super) struct Shown {
    groups: Vec<Group>,
}

/// Equal outputs.
#[derive(Clone, Debug)]
struct Group {
    output: Output,
    template: Vec<u8>,
    /// Number of the first among the lamps, or among what clicks.
    first: u16,
    wanted: Vec<Option<u32>>,
    sent: Vec<Option<u32>>,
}

impl Shown {
    /// Each kind is numbered from 0.
    pub(super) fn new(profile: &InputProfile) -> Self {
        let mut groups = Vec::new();
        for kind in [OutputKind::Lamp, OutputKind::Level, OutputKind::Haptic] {
            let mut first = 0;
            for output in profile.outputs.iter().filter(|o| o.kind == kind) {
                groups.extend(Group::new(output, first));
                first += output.count;
            }
        }
        Self { groups }
    }

    /// Notes what is wanted; what the device does not have is left out. Clicks go out at once.
    pub(super) fn want(&mut self, feedback: &Feedback, started: bool, out: &mut Outgoing) {
        match *feedback {
            Feedback::Lamps(mask) => {
                for group in self
                    .groups
                    .iter_mut()
                    .filter(|g| g.output.kind == OutputKind::Lamp)
                {
                    for (number, wanted) in (group.first..64).zip(&mut group.wanted) {
                        let lit = mask >> number & 1 == 1;
                        *wanted = Some(steps(&group.output, if lit { u8::MAX } else { 0 }));
                    }
                }
            }
            Feedback::Lamp { control, level, .. } => self.light(OutputKind::Lamp, control, level),
            Feedback::Level { control, level } => self.light(OutputKind::Level, control, level),
            Feedback::Haptic {
                control,
                clicks: clicks @ 1..,
                apart_ms,
            } if started => {
                let feel = self.groups.iter().find(|g| {
                    g.output.kind == OutputKind::Haptic
                        && (g.first..g.first + g.output.count).contains(&control)
                });
                if let Some(group) = feel {
                    group.click(clicks, apart_ms, out);
                }
            }
            _ => {}
        }
        if started {
            self.send_changes(out);
        }
    }

    fn light(&mut self, kind: OutputKind, control: u16, level: u8) {
        for group in self.groups.iter_mut().filter(|g| g.output.kind == kind) {
            let at = control.checked_sub(group.first).map(usize::from);
            if let Some(wanted) = at.and_then(|at| group.wanted.get_mut(at)) {
                *wanted = Some(steps(&group.output, level));
            }
        }
    }

    /// After a start: the device shows nothing we know of.
    pub(super) fn send_everything(&mut self, out: &mut Outgoing) {
        for group in &mut self.groups {
            group.sent.fill(None);
        }
        self.send_changes(out);
    }

    fn send_changes(&mut self, out: &mut Outgoing) {
        for group in &mut self.groups {
            group.send_changes(out);
        }
    }
}

/// A brightness of 0 to 255 in the output's own steps. Of three steps the third blinks (X-keys), so that the second is
/// all the light there is.
fn steps(output: &Output, level: u8) -> u32 {
    match output.levels.unwrap_or(2) {
        0..=3 => u32::from(level > 0),
        levels => (u32::from(level) * (levels - 1) + 127) / 255,
    }
}

impl Group {
    /// `None` where the profile does not say how it is sent.
    fn new(output: &Output, first: u16) -> Option<Self> {
        let template = output.output.as_ref().or(output.feature.as_ref())?;
        let mut template = template.0.clone();
        if let Some(bytes) = output.bytes {
            template.resize(template.len().max(bytes.into()), 0);
        }
        Some(Self {
            output: output.clone(),
            template,
            first,
            wanted: vec![None; output.count.into()],
            sent: vec![None; output.count.into()],
        })
    }

    fn send_changes(&mut self, out: &mut Outgoing) {
        if self.wanted == self.sent {
            return;
        }
        let together = self.output.level.is_some_and(|place| place.stride > 0);
        if together {
            let mut report = self.template.clone();
            for (n, wanted) in (0..).zip(&self.wanted) {
                put(&mut report, self.output.level, n, wanted.unwrap_or(0));
            }
            self.send(report, out);
        } else {
            for (n, (wanted, sent)) in (0..).zip(self.wanted.iter().zip(&self.sent)) {
                let Some(wanted) = wanted.filter(|_| wanted != sent) else {
                    continue;
                };
                let mut report = self.template.clone();
                put(&mut report, self.output.index, 0, n);
                put(&mut report, self.output.level, 0, wanted);
                self.send(report, out);
            }
        }
        self.sent.clone_from(&self.wanted);
    }

    /// One click is no repetition. The time between goes where the profile has an index.
    fn click(&self, clicks: u8, apart_ms: u16, out: &mut Outgoing) {
        let mut report = self.template.clone();
        put(&mut report, self.output.level, 0, u32::from(clicks) - 1);
        put(&mut report, self.output.index, 0, apart_ms.into());
        self.send(report, out);
    }

    fn send(&self, report: Vec<u8>, out: &mut Outgoing) {
        if self.output.feature.is_some() {
            out.step(Step::Feature(report));
        } else {
            out.report(&report);
        }
    }
}

/// Puts a number into a report's bits; `nth` of a row. What lies outside is left out.
fn put(report: &mut [u8], place: Option<Place>, nth: u32, value: u32) {
    let Some(place) = place else { return };
    let value = value + u32::from(place.add);
    let first = u32::from(place.byte) * 8 + u32::from(place.bit) + u32::from(place.stride) * nth;
    for bit in 0..u32::from(place.width.min(32)) {
        let at = first + bit;
        if let Some(byte) = report.get_mut((at / 8) as usize) {
            let mask = 1 << (at % 8);
            if value >> bit & 1 == 1 {
                *byte |= mask;
            } else {
                *byte &= !mask;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use device_profiles::Profiles;

    fn shown(profile: &str) -> Shown {
        Shown::new(Profiles::builtin().input(profile).expect("it is built in"))
    }

    fn sent(shown: &mut Shown, feedback: &Feedback) -> Vec<Step> {
        let mut out = Outgoing::new();
        shown.want(feedback, true, &mut out);
        out.drain().collect()
    }

    fn lamp(control: u16, level: u8) -> Feedback {
        Feedback::Lamp {
            control,
            level,
            colour: None,
        }
    }

    /// Sources: `docs/protocols/hid.md`, outputs.
    #[test]
    fn lamps_go_out_as_their_devices_want_them() {
        let report = |bytes: &[u8]| vec![Step::Report(bytes.to_vec())];
        let mut powermate = shown("powermate");
        assert_eq!(sent(&mut powermate, &lamp(0, 128)), report(&[0, 128]));
        assert_eq!(sent(&mut powermate, &lamp(0, 128)), []);
        let mut cap = shown("spacenavigator");
        assert_eq!(sent(&mut cap, &Feedback::Lamps(1)), report(&[4, 1]));
        assert_eq!(sent(&mut cap, &Feedback::Lamps(0)), report(&[4, 0]));
        assert_eq!(sent(&mut cap, &lamp(1, 255)), []);
        // Both lamps stand in one report: green bit 6, red bit 7.
        let mut keys = shown("xkeys-desktop");
        assert_eq!(
            sent(&mut keys, &lamp(1, 255)),
            report(&[0, 0, 0, 0, 0, 0, 0, 0, 0x80])
        );
        assert_eq!(
            sent(&mut keys, &lamp(0, 9)),
            report(&[0, 0, 0, 0, 0, 0, 0, 0, 0xC0])
        );
        // A report for each lamp: 6 green, 7 red; lit is 1, 2 would blink.
        let mut jog = shown("xk-12-jog");
        let mut red = vec![0, 0xB3, 7, 1];
        red.resize(36, 0);
        assert_eq!(sent(&mut jog, &lamp(1, 255)), [Step::Report(red)]);
    }

    #[test]
    fn brightness_is_a_feature_and_clicks_repeat() {
        let mut deck = shown("stream-deck-plus");
        let mut half = vec![3, 8, 50];
        half.resize(32, 0);
        let level = Feedback::Level {
            control: 0,
            level: 128,
        };
        assert_eq!(sent(&mut deck, &level), [Step::Feature(half)]);
        assert_eq!(sent(&mut deck, &lamp(0, 128)), [], "it has no lamps");
        let mut dial = shown("surface-dial");
        let clicks = |clicks, apart_ms| Feedback::Haptic {
            control: 0,
            clicks,
            apart_ms,
        };
        assert_eq!(
            sent(&mut dial, &clicks(3, 300)),
            [Step::Report(vec![1, 2, 3, 0x2C, 1])]
        );
        assert_eq!(sent(&mut dial, &clicks(3, 300)).len(), 1);
        assert_eq!(sent(&mut dial, &clicks(0, 300)), []);
    }

    #[test]
    fn what_was_wanted_before_the_start_comes_with_it() {
        let mut powermate = shown("powermate");
        let mut out = Outgoing::new();
        powermate.want(&lamp(0, 255), false, &mut out);
        assert!(out.is_empty());
        powermate.send_everything(&mut out);
        powermate.send_everything(&mut out);
        assert_eq!(out.drain().count(), 2);
    }
}
