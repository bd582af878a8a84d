//! How the controls of a device stand: what a performance begins from besides network and figure.
//!
//! Where a fader was, and whether it held its value, came of everything that had happened before; a take cannot ask
//! for that again. It must not know takes.

use device_profiles::ControlKind;
use serde::{Deserialize, Serialize};

use super::Controls;
use super::control::Control;
use super::gears::Curve;
use super::instance::Instance;
use super::pickup::Pickup;

/// One device.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
#[allow(clippy::struct_excessive_bools, reason = "each is a fact of its own")]
pub struct DeviceStanding {
    /// `NAME` of `NAME<n>`.
    pub instance: String,
    /// Its dials and keys, or its surface, are the desk's.
    pub is_desk: bool,
    /// Whether it was there.
    pub present: bool,
    /// The page that is up, from 1.
    pub page: u8,
    /// Whether a selection may change it.
    pub follows: bool,
    /// For which link or joint each page comes up; empty for none.
    pub pages_for: Vec<String>,
    /// Its own fine gear.
    pub fine: bool,
    /// Its controls, by the number of their output.
    #[serde(rename = "control")]
    pub controls: Vec<ControlStanding>,
}

/// One control. Shares are of its range, times seconds since the rig began.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ControlStanding {
    /// `n` of its output.
    pub number: u8,
    /// Where it is, in its unit.
    pub value: f64,
    /// The word of its mode.
    pub mode: String,
    /// What its turns are multiplied with.
    pub gear: f64,
    /// How much farther it goes when it is turned fast, 0 to 3.
    pub curve: i32,
    /// The share of its deflection that is the middle.
    pub zone: f64,
    /// When it was last turned.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub turned_secs: Option<f64>,
    /// Until when it has sent how far it came, where it goes by its speed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sent_secs: Option<f64>,
    /// The place of the finger on a ring, counts.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub finger: Option<i32>,
    /// A finger is on it.
    pub touched: bool,
    /// The last of every two presses was the first.
    pub on: bool,
    /// It must come to its middle before it does anything.
    pub waits: bool,
    /// How it has hold of its value.
    #[serde(flatten)]
    pub pickup: PickupStanding,
}

/// How a control has hold of its value; see [`super::pickup`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct PickupStanding {
    /// Where it is.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub place: Option<f64>,
    /// When it last moved.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub moved_secs: Option<f64>,
    /// What it set last.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub set: Option<f64>,
    /// In which step of the rig.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub set_step: Option<u64>,
    /// Where what it drives stood after that.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub answer: Option<f64>,
    /// It holds its value.
    pub holds: bool,
}

impl DeviceStanding {
    /// Whether every number of it is one.
    pub(crate) fn is_sound(&self) -> bool {
        self.controls.iter().all(|it| {
            let held = &it.pickup;
            let maybe = [
                it.turned_secs,
                it.sent_secs,
                held.place,
                held.moved_secs,
                held.set,
                held.answer,
            ];
            let always = [it.value, it.gear, it.zone];
            always
                .into_iter()
                .chain(maybe.into_iter().flatten())
                .all(f64::is_finite)
        })
    }
}

impl Controls {
    /// How every device stands, by the name the rig gave it.
    pub(crate) fn standing(&self) -> impl Iterator<Item = (String, DeviceStanding)> {
        let all = self.instances.iter();
        all.map(|it| (it.device.clone(), it.standing()))
    }

    /// Whose devices are the desk's, and what each is called: to be set before they are declared.
    pub(crate) fn rename<'s>(&mut self, standing: &dyn Fn(&str) -> Option<&'s DeviceStanding>) {
        let mut desk = [None; 2];
        for (place, instance) in self.instances.iter_mut().enumerate() {
            if let Some(stood) = standing(&instance.device) {
                instance.name.clone_from(&stood.instance);
                instance.is_desk = stood.is_desk;
            }
            if instance.is_desk {
                desk[usize::from(instance.tablet.is_some())] = Some(place);
            }
        }
        self.desk = desk;
    }
}

impl Instance {
    fn standing(&self) -> DeviceStanding {
        DeviceStanding {
            instance: self.name.clone(),
            is_desk: self.is_desk,
            present: self.present,
            page: self.pages.now,
            follows: self.pages.follows,
            pages_for: self.pages.focus.to_vec(),
            fine: self.fine,
            controls: self.controls.iter().map(Control::standing).collect(),
        }
    }

    /// Which page is up.
    pub(crate) fn resume_page(&mut self, stood: &DeviceStanding) {
        self.pages.go(stood.page);
        self.pages.follows = stood.follows;
        for (focus, stood) in self.pages.focus.iter_mut().zip(&stood.pages_for) {
            focus.clone_from(stood);
        }
        self.fine = stood.fine;
        self.present = stood.present;
    }

    /// How its controls stood; what they drive is known by now.
    pub(crate) fn resume_controls(&mut self, stood: &DeviceStanding) {
        for stood in &stood.controls {
            if let Some(control) = self.control(stood.number) {
                control.resume(stood);
            }
        }
    }
}

impl Control {
    fn standing(&self) -> ControlStanding {
        ControlStanding {
            number: self.number,
            value: self.value,
            mode: self.mode().to_owned(),
            gear: self.gear.factor,
            curve: self.gear.curve.number(),
            zone: self.zone,
            turned_secs: self.gear.turned_secs,
            sent_secs: self.sent_secs,
            finger: self.finger,
            touched: self.touched,
            on: self.button.on,
            waits: self.waits,
            pickup: self.pickup.standing(),
        }
    }

    fn resume(&mut self, stood: &ControlStanding) {
        self.set_mode(&stood.mode);
        self.value = stood.value;
        self.gear.factor = stood.gear;
        self.gear.curve = Curve::numbered(stood.curve).unwrap_or_default();
        self.gear.turned_secs = stood.turned_secs;
        self.zone = stood.zone;
        self.sent_secs = stood.sent_secs;
        self.finger = stood.finger;
        self.touched = stood.touched;
        self.button.on = stood.on;
        // Of a button the value says whether it is down.
        self.button.down = self.kind == ControlKind::Button && stood.value != 0.0;
        self.waits = stood.waits;
        self.pickup.resume(&stood.pickup);
    }
}

impl Pickup {
    fn standing(&self) -> PickupStanding {
        PickupStanding {
            place: self.place,
            moved_secs: self.moved_secs,
            set: self.set.map(|(set, _)| set),
            set_step: self.set.map(|(_, step)| step),
            answer: self.answer,
            holds: self.holds,
        }
    }

    fn resume(&mut self, stood: &PickupStanding) {
        self.place = stood.place;
        self.moved_secs = stood.moved_secs;
        self.set = stood.set.zip(stood.set_step);
        self.answer = stood.answer;
        self.holds = stood.holds;
    }
}
