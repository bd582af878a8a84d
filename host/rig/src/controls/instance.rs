//! One device as an instance of the network: its controls in the order of the profile, its pages, its outputs.
//!
//! An instance appears when its device is first known and stays: it is never numbered anew, and what is connected to
//! it stays connected while the device is away.

use std::collections::BTreeMap;
use std::sync::Arc;

use device::codec::{InputEvent, Surface};
use device_profiles::{ControlClass, ControlKind, InputKind, InputProfile, OutputKind};
use ps300::machine::SourceId;
use ps300::value::{Kinds, Value};

use super::control::{At, Control};
use super::inlets::{self, Inlet, PAGES};
use super::pages::Pages;
use super::rhythm::Rhythm;
use super::shown::{self, Output};
use super::tablet::{self, Tablet};
use crate::controls_calibration::ControlsCalibration;

/// Greatest number of an output: the command language has no more.
const NUMBER_MAX: u8 = 127;

/// A device in the network.
#[allow(clippy::struct_excessive_bools, reason = "each is a fact of its own")]
pub(crate) struct Instance {
    /// What the rig calls the device.
    pub(crate) device: String,
    /// `NAME` of `NAME<n>`.
    pub(crate) name: String,
    pub(crate) title: String,
    pub(crate) controls: Vec<Control>,
    /// Places of controls, by class and number.
    classes: BTreeMap<ControlClass, Vec<usize>>,
    pub(crate) tablet: Option<Tablet>,
    /// By what it is known again, and what was calibrated on it.
    pub(crate) identity: String,
    pub(crate) calibration: Arc<ControlsCalibration>,
    pub(crate) pages: Pages,
    pub(crate) outputs: Vec<Output>,
    /// One sender for each page; none before it is declared.
    pub(crate) sources: Vec<SourceId>,
    pub(crate) rhythm: Rhythm,
    pub(crate) present: bool,
    /// Fine gear by its own inlet.
    pub(crate) fine: bool,
    /// Dials and keys of the desk, or its tablet, are this device's.
    pub(crate) is_desk: bool,
    /// Another page came up since bindings were looked for.
    pub(crate) page_turned: bool,
}

/// Something a hand did, for learning.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Touched {
    pub(crate) number: u8,
    /// How far, of a turn or of the range.
    pub(crate) by: f64,
}

impl Instance {
    /// The instance of a device with a profile; `name` is free in the network.
    pub(crate) fn new(device: &str, name: &str, profile: &InputProfile) -> Self {
        let is_tablet = profile.surface.is_some() || profile.kind == InputKind::Tablet;
        let first = if is_tablet { tablet::OUTPUTS + 1 } else { 1 };
        let mut controls: Vec<Control> = Vec::new();
        let mut classes = BTreeMap::<ControlClass, Vec<usize>>::new();
        for group in &profile.controls {
            for nth in 0..group.count {
                let Some(number) = u8::try_from(controls.len())
                    .ok()
                    .and_then(|place| place.checked_add(first))
                    .filter(|number| *number <= NUMBER_MAX)
                else {
                    break;
                };
                let class = classes.entry(group.kind.class()).or_default();
                let mut control = Control::new(number, group, nth);
                control.of_class = class.len() as u16;
                class.push(controls.len());
                controls.push(control);
            }
        }
        let outputs = shown::outputs(profile, &controls);
        Self {
            device: device.to_owned(),
            name: name.to_owned(),
            title: profile.name.clone(),
            controls,
            classes,
            tablet: is_tablet.then(Tablet::default),
            identity: String::new(),
            calibration: Arc::default(),
            pages: Pages::default(),
            outputs,
            sources: Vec::new(),
            rhythm: Rhythm::default(),
            present: false,
            fine: false,
            is_desk: false,
            page_turned: true,
        }
    }

    /// What the outputs of each of its pages send.
    pub(crate) fn kinds(&self) -> Vec<Kinds> {
        let surface = self.tablet.as_ref().map_or(&[][..], |_| &tablet::KINDS);
        let controls = self.controls.iter().map(Control::kinds);
        let mut kinds: Vec<Kinds> = surface.iter().copied().chain(controls).collect();
        if kinds.is_empty() {
            // An instance has at least one output; of a device without controls it is silent.
            kinds.push(Kinds::ANY);
        }
        kinds
    }

    /// Greatest number of an inlet.
    pub(crate) fn inlet_count(&self) -> u8 {
        let outputs = self.outputs.iter().map(|it| it.inlet);
        let controls = self.controls.iter().map(|it| it.number);
        outputs.chain(controls).max().unwrap_or(1)
    }

    /// The name of the instance of the page that is up.
    pub(crate) fn page_name(&self) -> String {
        inlets::instance(&self.name, self.pages.now)
    }

    /// The sender of the page that is up.
    pub(crate) fn source(&self) -> Option<SourceId> {
        let page = usize::from(self.pages.now.clamp(1, PAGES)) - 1;
        self.sources.get(page).copied()
    }

    pub(crate) fn control(&mut self, number: u8) -> Option<&mut Control> {
        self.controls.iter_mut().find(|it| it.number == number)
    }

    /// Takes an event; what is to be sent goes to `emit`, output by output. Returns what a hand did.
    pub(crate) fn hear(
        &mut self,
        event: &InputEvent,
        at: At,
        surface: Option<Surface>,
        emit: &mut tablet::Emit<'_>,
    ) -> Option<Touched> {
        let at = At {
            fine: at.fine || self.fine,
            ..at
        };
        match *event {
            InputEvent::Pen(sample) => {
                self.tablet.as_mut()?.hear(&sample, surface?, emit);
                None
            }
            InputEvent::Touch { id, at } => {
                self.tablet.as_mut()?.touch(id, at, surface?, emit);
                None
            }
            InputEvent::Moved { dx, dy, wheel } => {
                self.tablet.as_ref()?;
                Tablet::moved([dx, dy], wheel, emit);
                None
            }
            InputEvent::Dial {
                control,
                delta_counts,
            } => self.moves(ControlClass::Dial, control, emit, |it| {
                Some(it.turned(delta_counts, at))
            }),
            InputEvent::Button { control, down } => {
                self.moves(ControlClass::Button, control, emit, |it| it.pressed(down, at))
            }
            InputEvent::Axis { control, value } => {
                if let Some(control) = self.at(ControlClass::Axis, control) {
                    control.counts = Some(value);
                }
                let touched = self.moves(ControlClass::Axis, control, emit, |it| it.stands(value, at));
                self.shows_by_itself(control, at);
                touched
            }
            InputEvent::AxisTouched { control, down } => {
                self.at(ControlClass::Axis, control)?.touched = down;
                None
            }
            InputEvent::Ring { control, value } => {
                self.moves(ControlClass::Ring, control, emit, |it| it.fingered(value, at))
            }
            InputEvent::Started | InputEvent::Restarted => None,
        }
    }

    /// What its outputs show, to be told to somebody who does not know.
    pub(crate) fn shows(&self) -> Vec<device::codec::Feedback> {
        let outputs = self.outputs.iter();
        outputs.filter_map(|it| it.shows(&self.controls)).collect()
    }

    fn at(&mut self, class: ControlClass, number: u16) -> Option<&mut Control> {
        let place = *self.classes.get(&class)?.get(usize::from(number))?;
        self.controls.get_mut(place)
    }

    fn moves(
        &mut self,
        class: ControlClass,
        number: u16,
        emit: &mut tablet::Emit<'_>,
        hear: impl FnOnce(&mut Control) -> Option<Value>,
    ) -> Option<Touched> {
        let control = self.at(class, number).filter(|it| !it.muted)?;
        let (number, was, known) = (control.number, control.value, control.pickup.place().is_some());
        if let Some(value) = hear(control) {
            emit(number, value);
        }
        // The first value of something that has a place is no movement.
        let is_movement = known || !control.is_absolute();
        let by = (control.value - was).abs();
        is_movement.then_some(Touched { number, by })
    }

    /// A fader that a hand has moved is where it is: its motor has nothing to do.
    fn shows_by_itself(&mut self, axis: u16, at: At) {
        let Some(&place) = self
            .classes
            .get(&ControlClass::Axis)
            .and_then(|it| it.get(usize::from(axis)))
        else {
            return;
        };
        let Some(control) = self.controls.get_mut(place) else {
            return;
        };
        let Some(share) = control.pickup.place() else {
            return;
        };
        for output in self.outputs.iter_mut().filter(|it| it.control == Some(place)) {
            output.follows_hand(share);
            if output.kind == OutputKind::Motor {
                // Its motor may have taken it elsewhere meanwhile: that it is here again is a hand's doing.
                control.is_held(at);
            }
        }
    }

    /// Takes what was calibrated on it. Nothing that it drives moves by it.
    pub(crate) fn calibrate(&mut self, calibration: Arc<ControlsCalibration>, emit: &mut tablet::Emit<'_>) {
        for control in &mut self.controls {
            let (mut per_turn, mut axis) = (None, None);
            match control.kind.class() {
                ControlClass::Dial => per_turn = calibration.dials.get(&control.of_class).copied(),
                ControlClass::Axis => axis = calibration.axes.get(&control.of_class).copied(),
                ControlClass::Button | ControlClass::Ring => {}
            }
            if let Some(value) = control.calibrate(per_turn, axis) {
                emit(control.number, value);
            }
        }
        if let Some(tablet) = &mut self.tablet {
            tablet.calibrate(calibration.tablet.as_ref(), emit);
        }
        self.calibration = calibration;
    }

    /// One control, or the surface where none is named, begins or ends being calibrated.
    pub(crate) fn mute(&mut self, number: Option<u8>, on: bool, emit: &mut tablet::Emit<'_>) {
        match number {
            Some(number) => {
                if let Some(value) = self.control(number).and_then(|it| it.mute(on)) {
                    emit(number, value);
                }
            }
            None => {
                if let Some(tablet) = &mut self.tablet {
                    tablet.mute(on, emit);
                }
            }
        }
    }

    /// Whether a dial is being calibrated.
    pub(crate) fn mutes_dial(&mut self, number: u16) -> bool {
        self.at(ControlClass::Dial, number).is_some_and(|it| it.muted)
    }

    /// The device is gone: what springs back is let go, everything else stays where it is.
    pub(crate) fn lost(&mut self, emit: &mut tablet::Emit<'_>) {
        self.present = false;
        if let Some(tablet) = &mut self.tablet {
            tablet.gone();
        }
        for control in &mut self.controls {
            if let Some(value) = control.lost() {
                emit(control.number, value);
            }
        }
    }

    /// Other things are driven from now on.
    pub(crate) fn release(&mut self) {
        for control in &mut self.controls {
            control.release();
            control.bound.clear();
            control.target = None;
            control.reading = None;
        }
        self.page_turned = true;
    }

    /// Takes a message at one of its inlets; `None` is what was there before any came. Says what was wrong.
    pub(crate) fn take(&mut self, inlet: Inlet, number: u8, value: Option<&Value>) -> Result<(), String> {
        let real = value.and_then(Value::as_number).filter(|it| it.is_finite());
        let text = match value {
            Some(Value::String(text)) => text.to_string(),
            _ => String::new(),
        };
        let on = matches!(value, Some(Value::Boolean(true)));
        match inlet {
            Inlet::Mode => {
                let name = self.name.clone();
                let Some(control) = self.control(number) else {
                    return Ok(());
                };
                if !control.set_mode(&text) {
                    return Err(format!(
                        "{name}_MODE<{number}>: \"{text}\" is no mode of a {}; there are {}",
                        control.kind.word(),
                        modes(control),
                    ));
                }
            }
            Inlet::Gear => {
                if let Some(control) = self.control(number) {
                    control.gear.factor = real.filter(|it| *it != 0.0).unwrap_or(1.0);
                }
            }
            Inlet::Curve => {
                let curve = real.and_then(|it| super::gears::Curve::numbered(it.round() as i32));
                if let Some(control) = self.control(number) {
                    control.gear.curve = curve.unwrap_or_default();
                }
            }
            Inlet::Zone => {
                if let Some(control) = self.control(number) {
                    control.set_zone(real);
                }
            }
            Inlet::Fine => self.fine = on,
            Inlet::Page => return self.take_page(number, real, on, &text),
            Inlet::Label(page) => self.tell(OutputKind::Label, number, page, value),
            Inlet::Lamp(page) => self.tell(OutputKind::Lamp, number, page, value),
            Inlet::Ring(page) => self.tell(OutputKind::Ring, number, page, value),
            Inlet::Motor(page) => self.tell(OutputKind::Motor, number, page, value),
            Inlet::Level(page) => self.tell(OutputKind::Level, number, page, value),
            Inlet::Colour(page) => {
                for output in self.outputs.iter_mut().filter(|it| it.inlet == number) {
                    output.colour(page, value);
                }
            }
            Inlet::Haptic => {
                let clicks = real.unwrap_or(f64::from(u8::from(on)));
                let all = self.outputs.iter_mut();
                for output in all.filter(|it| it.kind == OutputKind::Haptic && it.inlet == number) {
                    output.click(clicks);
                }
            }
        }
        Ok(())
    }

    fn take_page(&mut self, number: u8, real: Option<f64>, on: bool, text: &str) -> Result<(), String> {
        match number {
            1 => match real {
                Some(page) if (1.0..=f64::from(PAGES)).contains(&page.round()) => {
                    self.go_to_page(page.round() as u8);
                }
                Some(page) => return Err(format!("{} has pages 1 to {PAGES}, not {page}", self.name)),
                None => {}
            },
            2 => self.pages.follows = on,
            number => {
                self.pages.come_up(number.saturating_sub(2), text);
            }
        }
        Ok(())
    }

    /// Goes to a page and stays there.
    pub(crate) fn go_to_page(&mut self, page: u8) {
        let before = self.pages.now;
        self.pages.go(page);
        if self.pages.now != before {
            self.release();
        }
    }

    /// A link or joint was selected.
    pub(crate) fn selected(&mut self, focus: &str) {
        let before = self.pages.now;
        self.pages.selected(focus);
        if self.pages.now != before {
            self.release();
        }
    }

    fn tell(&mut self, kind: OutputKind, number: u8, page: u8, value: Option<&Value>) {
        let mut all = self.outputs.iter_mut();
        if let Some(output) = all.find(|it| it.kind == kind && it.inlet == number) {
            output.tell(page, value.cloned());
        }
        if kind == OutputKind::Label
            && let Some(control) = self.control(number)
        {
            control.labelled(page, value);
        }
    }
}

fn modes(control: &Control) -> String {
    let ways = super::pickup::Way::WORDS.map(|(word, _)| word).join(", ");
    if control.kind == ControlKind::Axis {
        format!("{ways}, rate")
    } else if control.is_absolute() {
        ways
    } else if control.kind == ControlKind::Button {
        super::button::ButtonMode::WORDS.map(|(word, _)| word).join(", ")
    } else {
        "none".to_owned()
    }
}
