//! Calibrating step by step: what a person is asked to do, what has been seen, and what came of it.
//!
//! One thing at a time on one device. Each step says in words what the hand is to do next; a panel draws the view and
//! sends the commands, and so does a scenario. What was measured is kept only when it is taken.

use device::codec::{InputEvent, PenSample};
use serde::{Deserialize, Serialize};

use super::measure::{Resting, Sweeping, Turning};
use super::tablet::Sheet;
use super::{Area, AxisCalibration, ControlsCalibration, PressureCurve, TabletMapping};

/// What is asked of a calibration. Devices go by the name in [`crate::DeviceView::name`], controls by their number
/// within their kind, from 0.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CalibrateControl {
    /// Counts in a dial's turn, by turning it round.
    Dial {
        /// The device.
        device: String,
        /// The dial.
        control: u16,
        /// Whole turns that will be made; more are more exact.
        turns: u32,
    },
    /// Ends of a fader, potentiometer or axis, by moving it from one to the other.
    Ends {
        /// The device.
        device: String,
        /// The axis.
        control: u16,
    },
    /// Rest of what springs back, by letting go of it a few times; its ends must be known or are the profile's.
    Rest {
        /// The device.
        device: String,
        /// The axis.
        control: u16,
    },
    /// A tablet's area, by touching two opposite corners of it.
    Corners {
        /// The device.
        device: String,
    },
    /// A pen's pressure: hovering, lightly, as hard as it will be pressed.
    Pressure {
        /// The device.
        device: String,
    },
    /// A tablet's mapping outright: turn, mirror, aspect, or anything of it.
    Tablet {
        /// The device.
        device: String,
        /// All of it.
        mapping: TabletMapping,
    },
    /// The hand is done with this step: on to the next, or to the result.
    Next,
    /// Keeps the result.
    Take,
    /// Forgets it; what was before stays.
    Cancel,
    /// Forgets everything calibrated on a device.
    Forget {
        /// The device.
        device: String,
    },
}

/// What is to be known of a device to calibrate it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Subject {
    /// Its tablet, if it is one.
    pub sheet: Option<Sheet>,
    /// Its tablet's full pressure.
    pub pressure_max: u32,
    /// The range of each axis, from the profile.
    pub ranges: Vec<[i32; 2]>,
    /// How many dials it has.
    pub dials: u16,
}

/// A calibration on its way.
#[derive(Clone, Debug, PartialEq)]
pub struct Calibrating {
    device: String,
    subject: Subject,
    phase: Phase,
    /// What came of it, and in words.
    result: Option<(Outcome, String)>,
    /// What was wrong with the last step.
    fault: Option<String>,
}

#[derive(Clone, Debug, PartialEq)]
enum Phase {
    Dial {
        control: u16,
        turns: u32,
        turning: Turning,
    },
    Ends {
        control: u16,
        sweeping: Sweeping,
    },
    Rest {
        control: u16,
        last: Option<i32>,
        resting: Resting,
    },
    Corners {
        last_mm: Option<[f64; 2]>,
        was_down: bool,
        touched_mm: Vec<[f64; 2]>,
    },
    Pressure {
        stage: usize,
        most: [u32; 3],
    },
}

#[derive(Clone, Debug, PartialEq)]
enum Outcome {
    Dial(u16, f64),
    Ends(u16, [i32; 2]),
    Rest(u16, i32, i32),
    Area(Area),
    Pressure(PressureCurve),
}

/// What a panel shows of it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CalibrationView {
    /// The device.
    pub device: String,
    /// What the hand is to do now.
    pub instruction: String,
    /// What was seen so far.
    pub seen: String,
    /// What came of it; it is kept by [`CalibrateControl::Take`].
    pub result: Option<String>,
    /// What was wrong with the last step; it is to be done again.
    pub fault: Option<String>,
}

impl Subject {
    fn dial(&self, control: u16, turns: u32) -> Result<Phase, String> {
        if control >= self.dials {
            return Err(format!(
                "there is no dial {control}; the device has {}",
                self.dials
            ));
        }
        Ok(Phase::Dial {
            control,
            turns: turns.clamp(1, 20),
            turning: Turning::default(),
        })
    }

    fn axis(&self, control: u16) -> Result<u16, String> {
        let count = self.ranges.len();
        if usize::from(control) < count {
            Ok(control)
        } else {
            Err(format!("there is no axis {control}; the device has {count}"))
        }
    }

    fn tablet(&self, device: &str) -> Result<(), String> {
        match self.sheet {
            Some(_) => Ok(()),
            None => Err(format!(
                "{device} is no tablet, or has not said how large it is yet"
            )),
        }
    }
}

/// What the three steps of a pen's pressure ask for.
const PRESSING: [&str; 3] = [
    "hover over the tablet without touching, then go on",
    "touch as lightly as you will draw, then go on",
    "press as hard as you ever will, then go on",
];

impl Calibrating {
    /// Begins; the error says what the device lacks for it.
    pub fn begin(command: &CalibrateControl, subject: Subject) -> Result<Self, String> {
        let (device, phase) = match command {
            CalibrateControl::Dial {
                device,
                control,
                turns,
            } => (device, subject.dial(*control, *turns)?),
            CalibrateControl::Ends { device, control } => {
                let control = subject.axis(*control)?;
                let sweeping = Sweeping::default();
                (device, Phase::Ends { control, sweeping })
            }
            CalibrateControl::Rest { device, control } => {
                let (control, last) = (subject.axis(*control)?, None);
                let resting = Resting::default();
                (
                    device,
                    Phase::Rest {
                        control,
                        last,
                        resting,
                    },
                )
            }
            CalibrateControl::Corners { device } => {
                subject.tablet(device)?;
                let (last_mm, was_down, touched_mm) = (None, false, Vec::new());
                (
                    device,
                    Phase::Corners {
                        last_mm,
                        was_down,
                        touched_mm,
                    },
                )
            }
            CalibrateControl::Pressure { device } => {
                subject.tablet(device)?;
                let (stage, most) = (0, [0; 3]);
                (device, Phase::Pressure { stage, most })
            }
            _ => return Err("this begins no calibration".into()),
        };
        Ok(Self {
            device: device.clone(),
            subject,
            phase,
            result: None,
            fault: None,
        })
    }

    /// Whose it is.
    pub fn device(&self) -> &str {
        &self.device
    }

    /// The device said something.
    pub fn hear(&mut self, event: &InputEvent) {
        if self.result.is_some() {
            return;
        }
        match (&mut self.phase, event) {
            (
                Phase::Dial { control, turning, .. },
                InputEvent::Dial {
                    control: moved,
                    delta_counts,
                },
            ) if control == moved => turning.moved(*delta_counts),
            (
                Phase::Ends { control, sweeping },
                InputEvent::Axis {
                    control: moved,
                    value,
                },
            ) if control == moved => {
                sweeping.moved(*value);
            }
            (
                Phase::Rest { control, last, .. },
                InputEvent::Axis {
                    control: moved,
                    value,
                },
            ) if control == moved => {
                *last = Some(*value);
            }
            (Phase::Corners { .. }, InputEvent::Pen(sample)) => self.touch(sample),
            (Phase::Pressure { stage, most }, InputEvent::Pen(sample)) if sample.in_range => {
                if let Some(most) = most.get_mut(*stage) {
                    *most = (*most).max(sample.pressure_counts);
                }
            }
            _ => {}
        }
    }

    /// A pen that touches, or a puck whose button is pressed, marks a corner.
    fn touch(&mut self, sample: &PenSample) {
        let (
            Phase::Corners {
                last_mm,
                was_down,
                touched_mm,
            },
            Some(sheet),
        ) = (&mut self.phase, &self.subject.sheet)
        else {
            return;
        };
        let down = sample.in_range && (sample.tip || sample.buttons != 0);
        if sample.in_range {
            *last_mm = Some(sheet.place_mm([sample.x_counts, sample.y_counts]));
        }
        if down && !std::mem::replace(was_down, down) {
            touched_mm.extend(*last_mm);
        }
        *was_down = down;
        if touched_mm.len() >= 2 {
            self.next();
        }
    }

    /// The hand is done with this step.
    pub fn next(&mut self) {
        self.fault = None;
        let done = match &mut self.phase {
            Phase::Dial {
                control,
                turns,
                turning,
            } => turning.per_turn(*turns).map(|per_turn| {
                let words = format!("dial {control}: {per_turn:.1} counts in a turn");
                Some((Outcome::Dial(*control, per_turn), words))
            }),
            Phase::Ends { control, sweeping } => {
                let range = self
                    .subject
                    .ranges
                    .get(usize::from(*control))
                    .copied()
                    .unwrap_or_default();
                sweeping.ends(range).map(|[from, to]| {
                    let words = format!("axis {control}: from {from} to {to}");
                    Some((Outcome::Ends(*control, [from, to]), words))
                })
            }
            Phase::Rest {
                control,
                last,
                resting,
            } => {
                resting.rests_at(last.take());
                if resting.times() < 3 {
                    Ok(None)
                } else {
                    resting.rest().map(|(rest, dead)| {
                        let words = format!(
                            "axis {control}: rests at {rest}, {dead} counts to either side mean nothing"
                        );
                        Some((Outcome::Rest(*control, rest, dead), words))
                    })
                }
            }
            Phase::Corners { touched_mm, .. } => area(touched_mm, self.subject.sheet.as_ref()),
            Phase::Pressure { stage, most } => {
                *stage += 1;
                if *stage < PRESSING.len() {
                    Ok(None)
                } else {
                    curve(*most, self.subject.pressure_max)
                }
            }
        };
        match done {
            Ok(result) => self.result = result,
            Err(fault) => {
                self.fault = Some(fault);
                self.anew();
            }
        }
    }

    /// The step is to be done again from its beginning.
    fn anew(&mut self) {
        match &mut self.phase {
            Phase::Dial { turning, .. } => *turning = Turning::default(),
            Phase::Ends { sweeping, .. } => *sweeping = Sweeping::default(),
            Phase::Rest { resting, .. } => *resting = Resting::default(),
            Phase::Corners { touched_mm, .. } => touched_mm.clear(),
            Phase::Pressure { stage, most } => (*stage, *most) = (0, [0; 3]),
        }
    }

    /// Puts the result into what is known of the device; the error says that there is none.
    pub fn take(&self, calibration: &mut ControlsCalibration) -> Result<(), String> {
        let Some((outcome, _)) = &self.result else {
            return Err("there is no result to keep yet".into());
        };
        match outcome {
            Outcome::Dial(control, per_turn) => drop(calibration.dials.insert(*control, *per_turn)),
            Outcome::Ends(control, ends) => {
                let axis = calibration.axes.entry(*control).or_insert(AxisCalibration {
                    ends: *ends,
                    rest: None,
                    dead_counts: 0,
                });
                axis.ends = *ends;
            }
            Outcome::Rest(control, rest, dead_counts) => {
                let range = self
                    .subject
                    .ranges
                    .get(usize::from(*control))
                    .copied()
                    .unwrap_or_default();
                let axis = calibration.axes.entry(*control).or_insert(AxisCalibration {
                    ends: range,
                    rest: None,
                    dead_counts: 0,
                });
                (axis.rest, axis.dead_counts) = (Some(*rest), *dead_counts);
            }
            Outcome::Area(area) => calibration.tablet.get_or_insert_default().area = Some(*area),
            Outcome::Pressure(curve) => calibration.tablet.get_or_insert_default().pressure = *curve,
        }
        Ok(())
    }

    /// What a panel shows.
    pub fn view(&self) -> CalibrationView {
        let (instruction, seen) = match &self.phase {
            Phase::Dial {
                control,
                turns,
                turning,
            } => {
                let turns = if *turns == 1 {
                    "once round".to_owned()
                } else {
                    format!("round {turns} times")
                };
                let instruction =
                    format!("turn dial {control} {turns}, clockwise, from mark to mark; then go on");
                (instruction, format!("{} counts", turning.counts()))
            }
            Phase::Ends { control, sweeping } => {
                let instruction =
                    format!("take control {control} from its lower end to its upper; then go on");
                let seen = sweeping.seen().map(|[low, high]| format!("{low} to {high}"));
                (instruction, seen.unwrap_or_default())
            }
            Phase::Rest { control, resting, .. } => {
                let instruction = format!("push control {control} aside and let go; then go on; three times");
                (instruction, format!("rested {} times", resting.times()))
            }
            Phase::Corners { touched_mm, .. } => {
                let which = if touched_mm.is_empty() {
                    "the upper left"
                } else {
                    "the lower right"
                };
                (
                    format!("touch {which} corner of the area"),
                    format!("{} corners", touched_mm.len()),
                )
            }
            Phase::Pressure { stage, most } => {
                let seen = most.get(*stage).map(|most| format!("up to {most} counts"));
                (
                    PRESSING.get(*stage).unwrap_or(&"").to_string(),
                    seen.unwrap_or_default(),
                )
            }
        };
        CalibrationView {
            device: self.device.clone(),
            instruction: if self.result.is_some() {
                "keep this, or cancel".into()
            } else {
                instruction
            },
            seen,
            result: self.result.as_ref().map(|(_, words)| words.clone()),
            fault: self.fault.clone(),
        }
    }
}

type Done = Result<Option<(Outcome, String)>, String>;

/// The area between two corners, in whichever order they were touched.
fn area(touched_mm: &[[f64; 2]], sheet: Option<&Sheet>) -> Done {
    let ([a, b], Some(sheet)) = (touched_mm, sheet) else {
        return Ok(None);
    };
    let area = Area {
        corner_mm: [a[0].min(b[0]), a[1].min(b[1])],
        size_mm: [(a[0] - b[0]).abs(), (a[1] - b[1]).abs()],
    };
    let mapping = TabletMapping {
        area: Some(area),
        ..TabletMapping::default()
    };
    if let Some(fault) = mapping.fault(sheet) {
        return Err(fault);
    }
    let [width, height] = area.size_mm;
    let words = format!("an area of {width:.1} × {height:.1} mm");
    Ok(Some((Outcome::Area(area), words)))
}

/// The curve of a pen that hovered, touched lightly and pressed hard.
fn curve([hovering, lightly, hard]: [u32; 3], max: u32) -> Done {
    if !(hovering <= lightly && lightly < hard) {
        return Err(format!(
            "hovering gave {hovering}, lightly {lightly}, hard {hard} counts; each must be more than the one before"
        ));
    }
    let share = |counts: u32| f64::from(counts) / f64::from(max.max(1));
    let (nothing, light) = (share(hovering), share(lightly));
    // The tip is down half-way from hovering to a light touch, and up a quarter of the way.
    let tip_down = (nothing + (light - nothing) * 0.5).max(nothing + 0.002);
    let curve = PressureCurve {
        nothing,
        full: share(hard).min(1.0),
        tip_down,
        tip_up: nothing + (tip_down - nothing) * 0.5,
        gamma: 1.0,
    };
    if let Some(fault) = curve.fault() {
        return Err(fault);
    }
    let tip = curve.tip_down * f64::from(max);
    let words = format!("nothing up to {hovering} counts, the tip from {tip:.0}, full at {hard}");
    Ok(Some((Outcome::Pressure(curve), words)))
}

#[cfg(test)]
#[path = "flow_tests.rs"]
mod tests;
