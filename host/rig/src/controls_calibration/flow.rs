//! Calibrating step by step: what a person is asked to do, what has been seen, and what came of it.
//!
//! One thing at a time on one device. Each step says in words what the hand is to do next; a panel draws the view and
//! sends the commands, and so does a scenario. What was measured is kept only when it is taken. A step that went wrong
//! says so and is done again; so is one during which the device was away. A result that is there already stays.

use device::codec::{InputEvent, PenSample};

use super::measure::{Resting, Sweeping, Turning};
use super::propose;
use super::subject::{Control, Subject};
use super::tablet::Sheet;
use super::{CalibrateControl, ControlsCalibration};

/// How often what springs back is let go of.
pub(super) const RESTS: usize = 3;
/// So far something else must move, of its range or of a turn, before it is said to be the wrong one: less is noise.
const MEANT: f64 = 0.1;

/// A calibration on its way.
#[derive(Clone, Debug, PartialEq)]
pub struct Calibrating {
    pub(super) subject: Subject,
    pub(super) phase: Phase,
    /// What would hold instead.
    pub(super) proposed: Option<ControlsCalibration>,
    /// What was wrong with the last step.
    fault: Option<String>,
    /// Something else that moved since the right one did last, and how far.
    other: Option<(String, f64)>,
    away: bool,
}

/// What is measured.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Phase {
    Dial {
        control: Control,
        turns: u32,
        turning: Turning,
    },
    Ends {
        control: Control,
        sweeping: Sweeping,
        last: Option<i32>,
    },
    Rest {
        control: Control,
        last: Option<i32>,
        moved: bool,
        resting: Resting,
    },
    Corners {
        sheet: Sheet,
        last_mm: Option<[f64; 2]>,
        was_down: bool,
        touched_mm: Vec<[f64; 2]>,
    },
    Pressure {
        stage: usize,
        last: Option<u32>,
        most: [Option<u32>; 3],
    },
}

impl Calibrating {
    /// Begins; the error says what the device lacks for it.
    pub fn begin(command: &CalibrateControl, subject: Subject) -> Result<Self, String> {
        let phase = match command {
            CalibrateControl::Dial { turns, .. } => Phase::Dial {
                control: subject.dial()?.clone(),
                turns: (*turns).clamp(1, 20),
                turning: Turning::default(),
            },
            CalibrateControl::Ends { .. } => {
                let control = subject.axis()?.clone();
                Phase::Ends {
                    sweeping: control.resting(),
                    last: control.at,
                    control,
                }
            }
            CalibrateControl::Rest { .. } => Phase::Rest {
                control: subject.sprung()?.clone(),
                last: None,
                moved: false,
                resting: Resting::default(),
            },
            CalibrateControl::Corners { .. } => Phase::Corners {
                sheet: subject.tablet()?,
                last_mm: None,
                was_down: false,
                touched_mm: Vec::new(),
            },
            CalibrateControl::Pressure { .. } => {
                subject.tablet()?;
                if subject.pressure_max == 0 {
                    return Err(format!("{} tells no pressure", subject.device));
                }
                Phase::Pressure {
                    stage: 0,
                    last: None,
                    most: [None; 3],
                }
            }
            _ => return Err("this begins no calibration".into()),
        };
        Ok(Self {
            subject,
            phase,
            proposed: None,
            fault: None,
            other: None,
            away: false,
        })
    }

    /// Whose it is.
    pub fn device(&self) -> &str {
        &self.subject.device
    }

    /// The control, by the number of its output; none for a tablet's surface.
    pub fn control(&self) -> Option<u8> {
        self.subject.control.as_ref().map(|control| control.number)
    }

    /// What would hold if it were taken now.
    pub fn proposed(&self) -> Option<&ControlsCalibration> {
        self.proposed.as_ref()
    }

    /// What was wrong with the last step, or stands in its way.
    pub fn fault(&self) -> Option<String> {
        let device = &self.subject.device;
        if self.away {
            return Some(if self.proposed.is_some() {
                format!("{device} is away; the result is there all the same")
            } else {
                format!("{device} is away; plug it in again, then do this step again")
            });
        }
        let other = self.other.as_ref().filter(|(_, by)| *by >= MEANT);
        let wrong = other.map(|(name, _)| format!("that was {name}; calibrated is {}", self.name()));
        wrong.or_else(|| self.fault.clone())
    }

    /// What is calibrated, in words with its device.
    pub(super) fn name(&self) -> String {
        let device = &self.subject.device;
        match &self.subject.control {
            Some(control) => format!("{} of {device}", control.name),
            None => format!("the surface of {device}"),
        }
    }

    /// The device said something. True if it was the right control.
    pub fn hear(&mut self, event: &InputEvent) -> bool {
        if self.proposed.is_some() {
            return false;
        }
        let right = match (&mut self.phase, event) {
            (
                Phase::Dial { control, turning, .. },
                InputEvent::Dial {
                    control: moved,
                    delta_counts,
                },
            ) if control.of_class == *moved => {
                turning.moved(*delta_counts);
                true
            }
            (
                Phase::Ends {
                    control,
                    sweeping,
                    last,
                },
                InputEvent::Axis {
                    control: moved,
                    value,
                },
            ) if control.of_class == *moved => {
                sweeping.moved(*value);
                last.replace(*value) != Some(*value)
            }
            (
                Phase::Rest {
                    control,
                    last,
                    moved: pushed,
                    ..
                },
                InputEvent::Axis {
                    control: moved,
                    value,
                },
            ) if control.of_class == *moved => {
                *pushed |= last.replace(*value).is_some_and(|before| before != *value);
                *pushed
            }
            (Phase::Corners { .. }, InputEvent::Pen(sample)) => {
                self.touch(sample);
                true
            }
            (Phase::Pressure { stage, last, most }, InputEvent::Pen(sample)) => {
                let pressed = sample.in_range.then_some(sample.pressure_counts);
                *last = pressed;
                if let Some(most) = most.get_mut(*stage) {
                    *most = (*most).max(pressed);
                }
                true
            }
            _ => false,
        };
        if right {
            self.other = None;
        }
        right
    }

    /// Another control moved by so much of its range or of a turn.
    pub fn hear_other(&mut self, name: &str, by: f64) {
        match &mut self.other {
            _ if self.proposed.is_some() => {}
            Some((before, moved)) if before == name => *moved += by,
            _ => self.other = Some((name.to_owned(), by)),
        }
    }

    /// The device went or came back. A step that it was away in is done again from its beginning.
    pub fn away(&mut self, away: bool) {
        self.away = away;
        if away && self.proposed.is_none() {
            self.fault = None;
            self.anew();
        }
    }

    /// A pen that touches, or a puck whose button is pressed, marks a corner.
    fn touch(&mut self, sample: &PenSample) {
        let Phase::Corners {
            sheet,
            last_mm,
            was_down,
            touched_mm,
        } = &mut self.phase
        else {
            return;
        };
        let down = sample.in_range && (sample.tip || sample.buttons != 0);
        *last_mm = sample
            .in_range
            .then(|| sheet.place_mm([sample.x_counts, sample.y_counts]));
        if down && !std::mem::replace(was_down, down) {
            self.fault = None;
            touched_mm.extend(*last_mm);
        }
        *was_down = down;
        if touched_mm.len() >= 2 {
            self.next();
        }
    }

    /// The hand is done with this step.
    pub fn next(&mut self) {
        if self.proposed.is_some() || self.away {
            return;
        }
        self.fault = None;
        self.other = None;
        match self.measured() {
            Ok(proposed) => self.proposed = proposed,
            Err(fault) => {
                self.fault = Some(fault);
                self.anew();
            }
        }
    }

    /// What came of it; none where there are steps to do yet.
    fn measured(&mut self) -> Result<Option<ControlsCalibration>, String> {
        let mut proposed = self.subject.holds.clone();
        match &mut self.phase {
            Phase::Dial {
                control,
                turns,
                turning,
            } => {
                let per_turn = turning.per_turn(*turns)?;
                proposed.dials.insert(control.of_class, per_turn);
            }
            Phase::Ends {
                control, sweeping, ..
            } => {
                let ends = sweeping.ends(control.range)?;
                let axis = propose::ends(ends, control.noise_counts, control.axis(&self.subject.holds));
                proposed.axes.insert(control.of_class, axis);
            }
            Phase::Rest {
                control,
                last,
                moved,
                resting,
            } => {
                if !std::mem::take(moved) {
                    return Err("the control did not move; push it aside, let go, then go on".into());
                }
                resting.rests_at(*last);
                if resting.times() < RESTS {
                    return Ok(None);
                }
                let axis = propose::rest(resting, control.axis(&self.subject.holds))?;
                proposed.axes.insert(control.of_class, axis);
            }
            Phase::Corners {
                sheet, touched_mm, ..
            } => {
                let area = propose::area(touched_mm, sheet)?;
                proposed.tablet.get_or_insert_default().area = Some(area);
            }
            Phase::Pressure { stage, most, .. } => {
                let Some(pressed) = pressed(*stage, most)? else {
                    *stage += 1;
                    return Ok(None);
                };
                let curve = propose::curve(pressed, self.subject.pressure_max)?;
                proposed.tablet.get_or_insert_default().pressure = curve;
            }
        }
        Ok(Some(proposed))
    }

    /// The step is to be done again; what was measured in steps before it stays where it can.
    fn anew(&mut self) {
        match &mut self.phase {
            Phase::Dial { turning, .. } => *turning = Turning::default(),
            Phase::Ends {
                control,
                sweeping,
                last,
            } => {
                control.at = last.take().filter(|_| !self.away);
                (*sweeping, *last) = (control.resting(), control.at);
            }
            Phase::Rest {
                resting, moved, last, ..
            } => {
                (*moved, *last) = (false, None);
                if resting.times() >= RESTS {
                    *resting = Resting::default();
                }
            }
            Phase::Corners {
                touched_mm,
                was_down,
                last_mm,
                ..
            } => {
                (*was_down, *last_mm) = (false, None);
                if touched_mm.len() >= 2 {
                    touched_mm.clear();
                }
            }
            Phase::Pressure { stage, most, last } => {
                *last = None;
                if let Some(most) = most.get_mut(*stage) {
                    *most = None;
                }
            }
        }
    }
}

/// The three pressures, if this was the last of them.
fn pressed(stage: usize, most: &[Option<u32>; 3]) -> Result<Option<[u32; 3]>, String> {
    const STAGES: [&str; 3] = ["hovering", "a light touch", "pressing hard"];
    let Some(now) = most.get(stage).copied().flatten() else {
        return Err("the pen was not seen; hold it over the tablet".into());
    };
    if let Some(before) = stage.checked_sub(1).and_then(|at| most[at])
        && now <= before
    {
        return Err(format!(
            "{} gave {now} counts and {} {before}; press harder, or cancel and begin again",
            STAGES[stage],
            STAGES[stage - 1],
        ));
    }
    Ok(match *most {
        [Some(hovering), Some(lightly), Some(hard)] => Some([hovering, lightly, hard]),
        _ => None,
    })
}

#[cfg(test)]
#[path = "flow_tests.rs"]
mod tests;
