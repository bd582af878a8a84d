//! Calibration of controls in the rig: what is asked of it, what devices say meanwhile, what holds after.
//!
//! A control that is being calibrated drives nothing, and whatever ends the calibration it has to be picked up again, a
//! tablet's tool to be lifted: so no parameter steps. What was taken is kept by what the device is known by, and holds
//! for it wherever and whenever it is plugged in.

use std::collections::BTreeMap;
use std::sync::Arc;

use device::codec::InputEvent;
use ps300::value::Value;

use super::Rig;
use crate::controls::instance::{Instance, Touched};
use crate::controls_calibration::subject::Control;
use crate::controls_calibration::{
    CalibrateControl, Calibrating, CalibrationView, ControlsCalibration, Sheet, Store, Subject, TabletMapping,
};
use crate::desk::Source;
use crate::inputs::Change;
use crate::snapshot::NoteLevel;

/// What was calibrated, and what is being.
#[derive(Debug, Default)]
pub(super) struct Calibrations {
    store: Store,
    now: Option<Calibrating>,
    /// State of the devices' identities that was taken over last.
    identified: u64,
}

impl Calibrations {
    pub(super) fn new(store: Store) -> Self {
        Self {
            store,
            now: None,
            identified: 0,
        }
    }

    pub(super) fn view(&self) -> Option<CalibrationView> {
        self.now.as_ref().map(Calibrating::view)
    }

    /// Why nothing will be kept, where that is so.
    pub(super) fn fault(&self) -> Option<String> {
        self.store.fault().map(str::to_owned)
    }

    pub(super) fn all(&self) -> &BTreeMap<String, ControlsCalibration> {
        self.store.devices()
    }

    /// What holds for a device now.
    pub(super) fn of(&self, identity: &str) -> ControlsCalibration {
        self.store.of(identity).cloned().unwrap_or_default()
    }
}

impl Rig {
    pub(super) fn calibrate_control(&mut self, command: &CalibrateControl) -> Result<(), String> {
        match command {
            CalibrateControl::Dial { device, control, .. }
            | CalibrateControl::Ends { device, control }
            | CalibrateControl::Rest { device, control } => {
                self.begin_calibration(command, device, Some(*control))
            }
            CalibrateControl::Corners { device } | CalibrateControl::Pressure { device } => {
                self.begin_calibration(command, device, None)
            }
            CalibrateControl::Tablet { device, mapping } => self.map_tablet(device, mapping),
            CalibrateControl::Next => {
                self.calibrating()?.next();
                Ok(())
            }
            CalibrateControl::Take => self.take_calibration(),
            CalibrateControl::Cancel => {
                let name = self.calibrating()?.device().to_owned();
                self.end_calibration();
                self.note(
                    NoteLevel::Info,
                    format!("{name} is as it was before its calibration"),
                );
                Ok(())
            }
            CalibrateControl::Forget { device, control } => self.forget_calibration(device, *control),
        }
    }

    fn calibrating(&mut self) -> Result<&mut Calibrating, String> {
        let now = self.calibrations.now.as_mut();
        now.ok_or_else(|| "nothing is being calibrated; begin with a device and a control".to_owned())
    }

    fn begin_calibration(
        &mut self,
        command: &CalibrateControl,
        device: &str,
        number: Option<u8>,
    ) -> Result<(), String> {
        if let Some(now) = &self.calibrations.now {
            let device = now.device();
            return Err(format!(
                "{device} is being calibrated already; keep what came of it, or cancel it first"
            ));
        }
        let at = self.place_of(device)?;
        let instance = &self.controls.instances[at];
        if !instance.present {
            return Err(format!("{device} does not answer; plug it in first"));
        }
        let control = number.map(|number| control_of(instance, number)).transpose()?;
        let surface = self.inputs.surface(device);
        let subject = Subject {
            device: device.to_owned(),
            control,
            sheet: surface.map(Sheet::from),
            pressure_max: surface.map_or(0, |surface| surface.pressure_max),
            holds: ControlsCalibration::clone(&instance.calibration),
        };
        self.calibrations.now = Some(Calibrating::begin(command, subject)?);
        self.controls.learn(false);
        self.mute(at, number, true);
        Ok(())
    }

    /// What is measured ends here, whatever became of it; the control drives again once it is picked up.
    fn end_calibration(&mut self) {
        let Some(now) = self.calibrations.now.take() else {
            return;
        };
        if let Ok(at) = self.place_of(now.device()) {
            self.mute(at, now.control(), false);
        }
    }

    fn take_calibration(&mut self) -> Result<(), String> {
        let now = self.calibrating()?;
        let Some(proposed) = now.proposed().cloned() else {
            return Err(format!("{}: there is no result to keep yet", now.device()));
        };
        let view = now.view();
        let at = self.place_of(&view.device)?;
        let result = view.result.unwrap_or_default();
        self.end_calibration();
        let (what, before) = (view.what, view.replaces);
        let words = format!("{what} of {}: {result} (before: {before})", view.device);
        self.note(NoteLevel::Info, words);
        self.keep_calibration(at, proposed)
    }

    fn map_tablet(&mut self, device: &str, mapping: &TabletMapping) -> Result<(), String> {
        let at = self.not_busy(device)?;
        let surface = self.inputs.surface(device);
        let sheet = surface.map(Sheet::from).ok_or_else(|| {
            format!("{device} is no tablet, or has not said how large it is yet; plug it in first")
        })?;
        if let Some(fault) = mapping.fault(&sheet) {
            return Err(format!("{device}: {fault}"));
        }
        let mut calibration = ControlsCalibration::clone(&self.controls.instances[at].calibration);
        calibration.tablet = (*mapping != TabletMapping::default()).then(|| mapping.clone());
        self.keep_calibration(at, calibration)
    }

    fn forget_calibration(&mut self, device: &str, number: Option<u8>) -> Result<(), String> {
        let at = self.not_busy(device)?;
        let instance = &self.controls.instances[at];
        let mut calibration = ControlsCalibration::default();
        if let Some(number) = number {
            let control = control_of(instance, number)?;
            calibration = ControlsCalibration::clone(&instance.calibration);
            calibration.forget(control.kind.class(), control.of_class);
        }
        self.note(NoteLevel::Info, format!("{device} is as its profile has it"));
        self.keep_calibration(at, calibration)
    }

    /// The place of a device that is not being calibrated.
    fn not_busy(&self, device: &str) -> Result<usize, String> {
        let busy = self
            .calibrations
            .now
            .as_ref()
            .is_some_and(|now| now.device() == device);
        if busy {
            return Err(format!(
                "{device} is being calibrated; keep what came of it, or cancel it first"
            ));
        }
        self.place_of(device)
    }

    /// From now on, and for that device wherever it is plugged in.
    fn keep_calibration(&mut self, at: usize, calibration: ControlsCalibration) -> Result<(), String> {
        let identity = self.controls.instances[at].identity.clone();
        let kept = self.calibrations.store.keep(&identity, calibration.clone());
        self.apply_calibration(at, calibration);
        kept.map_err(|error| error.to_string())
    }

    fn apply_calibration(&mut self, at: usize, calibration: ControlsCalibration) {
        let calibration = Arc::new(calibration);
        let mapping = Arc::clone(&calibration);
        self.passing(at, |instance, emit| instance.calibrate(calibration, emit));
        if self.is_desk_tablet(at) {
            let wiring = &mut self.wiring;
            self.desk
                .calibrate(mapping.tablet.as_ref(), &mut |instance, output, value| {
                    wiring.hear(instance, output, value);
                });
        }
    }

    fn mute(&mut self, at: usize, number: Option<u8>, on: bool) {
        self.passing(at, |instance, emit| instance.mute(number, on, emit));
        if number.is_none() && self.is_desk_tablet(at) {
            let wiring = &mut self.wiring;
            self.desk.mute(on, &mut |instance, output, value| {
                wiring.hear(instance, output, value);
            });
        }
    }

    fn is_desk_tablet(&self, at: usize) -> bool {
        let instance = self.controls.instances.get(at);
        instance.is_some_and(|it| it.is_desk && it.tablet.is_some())
    }

    /// Does something to an instance; what that sends goes into the network.
    fn passing(&mut self, at: usize, todo: impl FnOnce(&mut Instance, &mut dyn FnMut(u8, Value))) {
        let Some(instance) = self.controls.instances.get_mut(at) else {
            return;
        };
        let (from, wiring) = (instance.source(), &mut self.wiring);
        todo(instance, &mut |output, value| {
            if let Some(from) = from {
                wiring.hear_from(from.outlet(output), value);
            }
        });
    }

    /// Takes over what is kept of devices that are known since, or by something else.
    pub(super) fn recall_calibrations(&mut self) {
        let is_new = |it: &Instance| it.identity.is_empty();
        if self.calibrations.identified == self.inputs.identified
            && !self.controls.instances.iter().any(is_new)
        {
            return;
        }
        self.calibrations.identified = self.inputs.identified;
        for at in 0..self.controls.instances.len() {
            let instance = &mut self.controls.instances[at];
            let known = self.inputs.identity(&instance.device);
            let identity = known.unwrap_or(&instance.device).to_owned();
            if instance.identity != identity {
                let calibration = self.calibrations.of(&identity);
                instance.identity = identity;
                self.apply_calibration(at, calibration);
            }
        }
    }

    /// The counts of the dial that an event is of, as they were measured.
    pub(super) fn measured_source(&self, place: usize, event: &InputEvent, source: Source) -> Source {
        let instance = self.controls.instances.get(place);
        let per_turn = match (event, instance) {
            (InputEvent::Dial { control, .. }, Some(instance)) => instance.calibration.dials.get(control),
            _ => None,
        };
        Source {
            counts_per_turn: per_turn.copied().unwrap_or(source.counts_per_turn),
            ..source
        }
    }

    /// What a device says while one is calibrated, and what a hand did with it.
    pub(super) fn calibration_hears(&mut self, place: usize, event: &InputEvent, touched: Option<Touched>) {
        let Some(now) = &mut self.calibrations.now else {
            return;
        };
        let Some(instance) = self.controls.instances.get(place) else {
            return;
        };
        if now.device() == instance.device && now.hear(event) {
            return;
        }
        match (event, touched) {
            (InputEvent::Dial { .. } | InputEvent::Axis { .. }, Some(touched)) => {
                let control = instance.controls.iter().find(|it| it.number == touched.number);
                let name = control.map_or("another control", |it| it.name.as_str());
                now.hear_other(&format!("{name} of {}", instance.device), touched.by);
            }
            (InputEvent::Pen(sample), _) if sample.in_range && (sample.tip || sample.buttons != 0) => {
                let is_right = now.control().is_none() && now.device() == instance.device;
                if !is_right {
                    now.hear_other(&format!("the tool on {}", instance.device), 1.0);
                }
            }
            _ => {}
        }
    }

    /// A device came or went while one is calibrated.
    pub(super) fn calibration_notices(&mut self, change: &Change) {
        let Some(now) = &mut self.calibrations.now else {
            return;
        };
        match change {
            Change::Came(name) if now.device() == name => now.away(false),
            Change::Gone(name, _) if now.device() == name => now.away(true),
            _ => {}
        }
    }

    /// What was calibrated on a device, for a take, which is done again without what tells devices apart.
    pub(super) fn calibration_for_take(&self, device: &str) -> ControlsCalibration {
        let at = self.controls.find(device);
        let instance = at.and_then(|at| self.controls.instances.get(at));
        instance.map_or_else(ControlsCalibration::default, |it| {
            ControlsCalibration::clone(&it.calibration)
        })
    }
}

fn control_of(instance: &Instance, number: u8) -> Result<Control, String> {
    let control = instance.controls.iter().find(|it| it.number == number);
    let control = control.ok_or_else(|| {
        let all = instance.controls.iter().map(|it| it.number);
        match (all.clone().min(), all.max()) {
            (Some(first), Some(last)) => format!(
                "{} has no control {number}; they are numbered {first} to {last}",
                instance.device
            ),
            _ => format!("{} has no controls beside its surface", instance.device),
        }
    })?;
    let span = (f64::from(control.range[1]) - f64::from(control.range[0])).abs();
    Ok(Control {
        number,
        name: control.name.clone(),
        kind: control.kind,
        of_class: control.of_class,
        range: control.range,
        noise_counts: (control.noise * span).ceil() as i32,
        counts_per_turn: control.counts_per_turn_built,
        at: control.counts,
    })
}

#[cfg(test)]
#[path = "calibrate_tests.rs"]
mod tests;
