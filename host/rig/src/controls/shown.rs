//! What a device's outputs show: what the network sends there, else what the control beside them is bound to.
//!
//! A shadow is kept of what each output shows, and only changes are sent. Nothing is sent back to a control with a
//! place of its own while a hand is on it; afterwards it gets what it then lacks. Rings around dials without end are
//! no echo: the device cannot know what they are to show.

use std::fmt::Write as _;

use device::codec::{Feedback, Picture, RingStyle};
use device_profiles::{InputProfile, OutputKind};
use ps300::machine::Panel;
use ps300::value::Value;

use super::control::Control;
use super::inlets::PAGES;

/// How long an output shows that it is tried, seconds.
const TEST_SECS: f64 = 1.0;
/// How long a label shows the value after the control moved, seconds.
pub(crate) const VALUE_SECS: f64 = 1.0;
/// From one click to the next, milliseconds: apart to a finger, together to a hand that turns.
const CLICKS_APART_MS: u16 = 120;
/// Steps of what does not say how many it has: finer than any that is known.
const LEVELS: u32 = 1024;

/// Something sent, as the device has it.
#[derive(Clone, Debug, PartialEq)]
enum Sent {
    Lamp(u8, Option<[u8; 3]>),
    Level(u8),
    /// The colour all over it.
    Picture([u8; 3]),
    /// How many.
    Clicks(u8),
    /// In steps of the ring; none is dark.
    Ring(Option<u32>),
    Label(String),
    /// In steps of the motor.
    Motor(u32),
}

/// One output of a device.
#[derive(Debug)]
pub(crate) struct Output {
    pub(crate) kind: OutputKind,
    /// Which of its kind, from 0: as feedback numbers it.
    pub(crate) of_kind: u16,
    /// Place of the control beside it.
    pub(crate) control: Option<usize>,
    /// `n` of its inlet.
    pub(crate) inlet: u8,
    characters: usize,
    levels: u32,
    /// What the network sent, for each page.
    told: [Option<Value>; PAGES as usize],
    /// Red, green and blue, for each page.
    colours: [Option<[u8; 3]>; PAGES as usize],
    /// Clicks that are still to be felt.
    clicks: u8,
    shown: Option<Sent>,
    tested_until: Option<f64>,
    /// Where a text is put together; kept, so that looking does not allocate.
    text: String,
}

/// What a device is shown with.
pub(crate) struct Light<'a> {
    pub(crate) controls: &'a [Control],
    /// From 1.
    pub(crate) page: u8,
    pub(crate) now_secs: f64,
    /// Texts and lamps by number of label and lamp, where the device is the desk.
    pub(crate) panel: Option<&'a Panel>,
}

/// All outputs of a profile, each beside its control.
pub(crate) fn outputs(profile: &InputProfile, controls: &[Control]) -> Vec<Output> {
    let mut outputs = Vec::new();
    let mut counts = std::collections::BTreeMap::<OutputKind, u16>::new();
    // Those of the device as a whole are numbered on behind its controls.
    let mut spare = controls.last().map_or(0, |last| last.number);
    for group in &profile.outputs {
        let first = group.of.as_ref().and_then(|of| {
            let mut place = 0;
            for known in &profile.controls {
                if known.name == *of {
                    return Some(place);
                }
                place += usize::from(known.count);
            }
            None
        });
        for nth in 0..group.count {
            let count = counts.entry(group.kind).or_default();
            let control = first.map(|first| first + usize::from(nth));
            let control = control.filter(|&place| place < controls.len());
            let inlet = control.and_then(|place| controls.get(place)).map(|it| it.number);
            outputs.push(Output {
                kind: group.kind,
                of_kind: *count,
                control,
                inlet: inlet.unwrap_or_else(|| {
                    spare = spare.saturating_add(1).min(127);
                    spare
                }),
                characters: group.characters.map_or(0, usize::from),
                levels: group.levels.filter(|it| *it > 1).unwrap_or(LEVELS),
                told: Default::default(),
                colours: Default::default(),
                clicks: 0,
                shown: None,
                tested_until: None,
                text: String::new(),
            });
            *count += 1;
        }
    }
    outputs
}

impl Output {
    /// The network says what it is to show on a page.
    pub(crate) fn tell(&mut self, page: u8, value: Option<Value>) {
        if let Some(told) = self.told.get_mut(usize::from(page).wrapping_sub(1)) {
            *told = value;
        }
    }

    /// The network says of which colour it is to be on a page.
    pub(crate) fn colour(&mut self, page: u8, value: Option<&Value>) {
        if let Some(colour) = self.colours.get_mut(usize::from(page).wrapping_sub(1)) {
            *colour = match value {
                Some(Value::Vector3(v)) => Some(v.to_array().map(of_255)),
                _ => None,
            };
        }
    }

    /// It is to click so often, as soon as it can.
    pub(crate) fn click(&mut self, clicks: f64) {
        self.clicks = clicks.round().clamp(0.0, 255.0) as u8;
    }

    /// Shows what it can for a moment.
    pub(crate) fn test(&mut self, now_secs: f64) {
        self.tested_until = Some(now_secs + TEST_SECS);
        self.clicks = 1;
    }

    /// The control itself is there now: a motor or a ring that goes with it shows that already.
    pub(crate) fn follows_hand(&mut self, share: f64) {
        match self.kind {
            OutputKind::Motor => self.shown = Some(Sent::Motor(self.step(share))),
            OutputKind::Ring => self.shown = Some(Sent::Ring(Some(self.step(share)))),
            _ => {}
        }
    }

    /// What has to be sent so that it shows what it is to show.
    pub(crate) fn change(&mut self, light: &Light<'_>) -> Option<Feedback> {
        let tested = self.tested_until.is_some_and(|until| light.now_secs < until);
        if !tested {
            self.tested_until = None;
        }
        let control = self.control.and_then(|place| light.controls.get(place));
        if self.kind == OutputKind::Haptic {
            return self.felt();
        }
        let is_own = matches!(self.kind, OutputKind::Motor | OutputKind::Ring);
        let in_hand = control.is_some_and(|it| it.is_absolute() && it.is_in_hand(light.now_secs));
        if is_own && in_hand {
            return None;
        }
        if self.kind == OutputKind::Label {
            return self.change_label(light, control, tested);
        }
        let want = if tested {
            self.tried(light)
        } else {
            self.want(light, control)
        }?;
        if self.shown.as_ref() == Some(&want) {
            return None;
        }
        let begins_dark = self.shown.is_none() && want.is_nothing();
        let feedback = self.feedback(&want, control);
        self.shown = Some(want);
        feedback.filter(|_| !begins_dark)
    }

    fn change_label(
        &mut self,
        light: &Light<'_>,
        control: Option<&Control>,
        tested: bool,
    ) -> Option<Feedback> {
        let mut text = std::mem::take(&mut self.text);
        text.clear();
        if tested {
            // Writing to a string cannot fail.
            let _ = write!(text, "TEST {}", self.of_kind + 1);
            let room = if self.characters == 0 {
                usize::MAX
            } else {
                self.characters
            };
            let end = text.char_indices().nth(room).map(|(end, _)| end);
            text.truncate(end.unwrap_or(text.len()));
        } else {
            self.write_label(&mut text, light, control);
        }
        let (is_shown, was_shown) = match &self.shown {
            Some(Sent::Label(shown)) => (*shown == text, true),
            _ => (false, false),
        };
        let feedback = (!is_shown && (was_shown || !text.is_empty())).then(|| Feedback::Label {
            control: self.of_kind,
            text: text.clone(),
        });
        if !is_shown {
            self.shown = Some(Sent::Label(text.clone()));
        }
        self.text = text;
        feedback
    }

    /// What the network sends, else what the panel has, else what the control says of itself.
    fn write_label(&self, text: &mut String, light: &Light<'_>, control: Option<&Control>) {
        let told = self.told.get(usize::from(light.page).wrapping_sub(1));
        let number = usize::from(self.of_kind);
        let panel = light.panel.and_then(|panel| {
            let mut labels = panel.dial_labels.iter().chain(&panel.key_labels);
            labels.nth(number)
        });
        match (told, panel.filter(|it| !it.is_empty()), control) {
            (Some(Some(Value::String(own))), ..) if !own.is_empty() => text.push_str(own),
            (_, Some(own), _) => text.push_str(own),
            (_, _, Some(control)) => {
                control.write_label(text, light.page, self.characters, light.now_secs);
            }
            _ => {}
        }
    }

    /// Clicks are felt once and not shown again.
    fn felt(&mut self) -> Option<Feedback> {
        let clicks = std::mem::take(&mut self.clicks);
        (clicks > 0)
            .then(|| self.feedback(&Sent::Clicks(clicks), None))
            .flatten()
    }

    fn want(&self, light: &Light<'_>, control: Option<&Control>) -> Option<Sent> {
        let told = self.told.get(usize::from(light.page).wrapping_sub(1))?.as_ref();
        let colour = self
            .colours
            .get(usize::from(light.page).wrapping_sub(1))
            .copied()
            .flatten();
        let bound = control.and_then(Control::shown_share);
        Some(match self.kind {
            OutputKind::Lamp => {
                let panel = light.panel.map_or(0, |panel| u64::from(panel.lamps));
                let by_panel = panel
                    .checked_shr(self.of_kind.into())
                    .is_some_and(|bits| bits & 1 == 1);
                let own = light.panel.is_none()
                    && control.is_some_and(|it| !it.bound.is_empty() && it.button.lit());
                let level = match told {
                    Some(Value::Boolean(on)) => f64::from(u8::from(*on)),
                    Some(value) => value.as_number().unwrap_or(0.0),
                    None => f64::from(u8::from(by_panel || own)),
                };
                Sent::Lamp(of_255(level), colour)
            }
            OutputKind::Ring => {
                let share = told.and_then(Value::as_number).or(bound);
                let lit = share.filter(|share| *share >= 0.0);
                Sent::Ring(lit.map(|share| self.step(share)))
            }
            OutputKind::Motor => Sent::Motor(self.step(told.and_then(Value::as_number).or(bound)?)),
            // A meter without a word shows where what is bound stands; a device's brightness is its own affair.
            OutputKind::Level => Sent::Level(of_255(told.and_then(Value::as_number).or(bound)?)),
            OutputKind::Picture => Sent::Picture(colour.unwrap_or_default()),
            OutputKind::Label | OutputKind::Haptic => return None,
        })
    }

    /// What it shows while it is tried.
    fn tried(&self, light: &Light<'_>) -> Option<Sent> {
        let left = self.tested_until.map_or(0.0, |until| until - light.now_secs);
        let share = (1.0 - left / TEST_SECS).clamp(0.0, 1.0);
        Some(match self.kind {
            OutputKind::Lamp => Sent::Lamp(255, None),
            OutputKind::Level => Sent::Level(of_255(share)),
            OutputKind::Picture => Sent::Picture([255; 3]),
            OutputKind::Ring => Sent::Ring(Some(self.step(share))),
            // There and back, not to an end.
            OutputKind::Motor => Sent::Motor(self.step(0.25 + share / 2.0)),
            OutputKind::Label | OutputKind::Haptic => return None,
        })
    }

    fn step(&self, share: f64) -> u32 {
        (share.clamp(0.0, 1.0) * f64::from(self.levels - 1)).round() as u32
    }

    fn feedback(&self, sent: &Sent, control: Option<&Control>) -> Option<Feedback> {
        let number = self.of_kind;
        let share = |step: u32| f64::from(step) / f64::from(self.levels - 1);
        Some(match sent {
            Sent::Label(text) => Feedback::Label {
                control: number,
                text: text.clone(),
            },
            Sent::Lamp(level, colour) => Feedback::Lamp {
                control: number,
                level: *level,
                colour: *colour,
            },
            Sent::Level(level) => Feedback::Level {
                control: number,
                level: *level,
            },
            Sent::Picture(colour) => Feedback::Picture {
                control: number,
                picture: Picture::new(1, 1, colour.to_vec())?,
            },
            Sent::Clicks(clicks) => Feedback::Haptic {
                control: number,
                clicks: *clicks,
                apart_ms: CLICKS_APART_MS,
            },
            Sent::Ring(step) => Feedback::Ring {
                control: number,
                value: step.map(share),
                style: match control.and_then(Control::ends) {
                    Some([low, _]) if low < 0.0 => RingStyle::Pan,
                    _ => RingStyle::Fan,
                },
            },
            Sent::Motor(step) => Feedback::Motor {
                control: control?.of_class,
                value: control?.counts_at(share(*step)),
            },
        })
    }

    /// What it shows, as it was told; nothing where it was never told anything that can be seen.
    pub(crate) fn shows(&self, controls: &[Control]) -> Option<Feedback> {
        let shown = self.shown.as_ref().filter(|shown| !shown.is_nothing())?;
        self.feedback(shown, self.control.and_then(|place| controls.get(place)))
    }

    /// What it shows, in words.
    pub(crate) fn words(&self) -> String {
        let percent = |step: u32| format!("{:.0} %", 100.0 * f64::from(step) / f64::from(self.levels - 1));
        match &self.shown {
            None | Some(Sent::Ring(None)) => String::new(),
            Some(Sent::Label(text)) => text.clone(),
            Some(Sent::Picture(colour)) => format!("{colour:?}"),
            Some(Sent::Clicks(clicks)) => format!("{clicks} clicks"),
            Some(Sent::Lamp(level, _) | Sent::Level(level)) => match level {
                0 => "off".to_owned(),
                255 => "on".to_owned(),
                level => format!("{:.0} %", 100.0 * f64::from(*level) / 255.0),
            },
            Some(Sent::Ring(Some(step)) | Sent::Motor(step)) => percent(*step),
        }
    }
}

/// A share in 255 steps.
fn of_255(share: f64) -> u8 {
    (share.clamp(0.0, 1.0) * 255.0).round() as u8
}

impl Sent {
    /// What a device shows that was never told anything.
    fn is_nothing(&self) -> bool {
        match self {
            Self::Lamp(level, _) | Self::Level(level) => *level == 0,
            Self::Picture(colour) => *colour == [0; 3],
            Self::Clicks(clicks) => *clicks == 0,
            Self::Ring(step) => step.is_none(),
            Self::Label(text) => text.is_empty(),
            Self::Motor(_) => false,
        }
    }
}
