//! What a panel shows of a calibration: words for the hand, and the numbers of the picture.

use super::flow::{Calibrating, Phase, RESTS};
use super::subject::Control;
use super::view::{CalibrationView, Measured};
use super::{Area, AxisCalibration, ControlsCalibration, PressureCurve, Sheet, TabletMapping};

/// What the three steps of a pen's pressure ask for.
const PRESSING: [&str; 3] = [
    "hover over the tablet without touching, then go on",
    "touch as lightly as you will draw, then go on",
    "press as hard as you ever will, then go on",
];

impl Calibrating {
    /// What a panel shows.
    pub fn view(&self) -> CalibrationView {
        let (steps, at) = self.steps();
        let done = self.proposed.is_some();
        CalibrationView {
            device: self.subject.device.clone(),
            control: self.control(),
            what: self.what(),
            step: if done { steps } else { at },
            steps,
            instruction: if done {
                "keep this, or cancel".into()
            } else {
                self.instruction()
            },
            seen: self.seen(),
            result: self.proposed.as_ref().map(|proposed| self.words(proposed)),
            replaces: self.words(&self.subject.holds),
            fault: self.fault(),
            measured: self.numbers(),
        }
    }

    /// What is calibrated.
    fn what(&self) -> String {
        match &self.phase {
            Phase::Dial { control, .. } | Phase::Ends { control, .. } | Phase::Rest { control, .. } => {
                control.name.clone()
            }
            Phase::Corners { .. } => "area".into(),
            Phase::Pressure { .. } => "pressure".into(),
        }
    }

    /// How many steps there are, the keeping among them, and at which it is.
    fn steps(&self) -> (u8, u8) {
        match &self.phase {
            Phase::Dial { .. } | Phase::Ends { .. } => (2, 1),
            Phase::Rest { resting, .. } => (RESTS as u8 + 1, resting.times() as u8 + 1),
            Phase::Corners { touched_mm, .. } => (3, touched_mm.len() as u8 + 1),
            Phase::Pressure { stage, .. } => (4, *stage as u8 + 1),
        }
    }

    fn instruction(&self) -> String {
        match &self.phase {
            Phase::Dial { control, turns, .. } => {
                let name = &control.name;
                let turns = match turns {
                    1 => "once round".to_owned(),
                    turns => format!("round {turns} times"),
                };
                format!("turn {name} {turns}, clockwise, from mark to mark; then go on")
            }
            Phase::Ends { control, .. } => {
                let name = &control.name;
                format!("take {name} to its lower end, then to its upper; then go on")
            }
            Phase::Rest { control, resting, .. } => {
                let (name, nth) = (&control.name, resting.times() + 1);
                format!("push {name} aside and let go; then go on ({nth} of {RESTS})")
            }
            Phase::Corners { touched_mm, .. } => {
                let which = if touched_mm.is_empty() {
                    "a corner of the area that you will draw on"
                } else {
                    "the opposite corner"
                };
                format!("touch {which}")
            }
            Phase::Pressure { stage, .. } => (*PRESSING.get(*stage).unwrap_or(&"")).to_owned(),
        }
    }

    fn seen(&self) -> String {
        match &self.phase {
            Phase::Dial { turning, .. } => format!("{} counts", turning.counts()),
            Phase::Ends { sweeping, .. } => sweeping
                .seen()
                .map(|[low, high]| format!("{low} to {high}"))
                .unwrap_or_default(),
            Phase::Rest { resting, .. } => format!("rested {} times", resting.times()),
            Phase::Corners { touched_mm, .. } => format!("{} of 2 corners", touched_mm.len()),
            Phase::Pressure { stage, most, .. } => most
                .get(*stage)
                .copied()
                .flatten()
                .map(|most| format!("up to {most} counts"))
                .unwrap_or_default(),
        }
    }

    /// What of a calibration is what this one is about, in words.
    fn words(&self, of: &ControlsCalibration) -> String {
        let built = |known: bool| if known { "" } else { ", the profile's" };
        match &self.phase {
            Phase::Dial { control, .. } => {
                let known = of.dials.contains_key(&control.of_class);
                format!("{:.1} counts in a turn{}", control.per_turn(of), built(known))
            }
            Phase::Ends { control, .. } | Phase::Rest { control, .. } => {
                let known = of.axes.contains_key(&control.of_class);
                format!("{}{}", axis_words(control, of), built(known))
            }
            Phase::Corners { sheet, .. } => {
                let area = of.tablet.as_ref().and_then(|tablet| tablet.area);
                area.map_or_else(|| whole_words(sheet), area_words)
            }
            Phase::Pressure { .. } => {
                let curve = pressure(of);
                let known = curve != PressureCurve::default();
                let percent = |share: f64| share * 100.0;
                format!(
                    "nothing up to {:.1} %, the tip from {:.1} %, full at {:.0} %{}",
                    percent(curve.nothing),
                    percent(curve.tip_down),
                    percent(curve.full),
                    built(known)
                )
            }
        }
    }

    fn numbers(&self) -> Measured {
        let (holds, proposed) = (&self.subject.holds, self.proposed.as_ref());
        match &self.phase {
            Phase::Dial {
                control,
                turns,
                turning,
            } => Measured::Turn {
                counts: turning.counts(),
                turns: *turns,
                holds: control.per_turn(holds),
                proposed: proposed.map(|it| control.per_turn(it)),
            },
            Phase::Ends {
                control,
                sweeping,
                last,
            } => travel(control, (*last, sweeping.seen()), &[], (holds, proposed)),
            Phase::Rest {
                control,
                last,
                resting,
                ..
            } => travel(control, (*last, None), resting.all(), (holds, proposed)),
            Phase::Corners {
                sheet,
                last_mm,
                touched_mm,
                ..
            } => Measured::Area {
                size_mm: sheet.size_mm(),
                at_mm: *last_mm,
                touched_mm: touched_mm.clone(),
                holds: tablet(holds),
                proposed: proposed.map(tablet),
            },
            Phase::Pressure { last, most, .. } => {
                let full = f64::from(self.subject.pressure_max.max(1));
                let share = |counts: u32| f64::from(counts) / full;
                Measured::Pressure {
                    at: last.map(share),
                    most: most.map(|most| most.map(share)),
                    holds: pressure(holds),
                    proposed: proposed.map(pressure),
                }
            }
        }
    }
}

fn whole_words(sheet: &Sheet) -> String {
    let [width, height] = sheet.size_mm();
    format!("all of it, {width:.1} × {height:.1} mm")
}

fn area_words(area: Area) -> String {
    let [width, height] = area.size_mm;
    let [x, y] = area.corner_mm;
    format!("{width:.1} × {height:.1} mm, {x:.1} mm from the left and {y:.1} mm from the top")
}

fn axis_words(control: &Control, of: &ControlsCalibration) -> String {
    let AxisCalibration {
        ends: [from, to],
        rest,
        dead_counts,
    } = control.axis(of);
    let rest = rest.map(|rest| format!(", at rest at {rest} \u{b1} {dead_counts}"));
    format!("from {from} to {to} counts{}", rest.unwrap_or_default())
}

fn travel(
    control: &Control,
    (at, seen): (Option<i32>, Option<[i32; 2]>),
    rests: &[i32],
    (holds, proposed): (&ControlsCalibration, Option<&ControlsCalibration>),
) -> Measured {
    Measured::Travel {
        range: control.range,
        at,
        seen,
        rests: rests.to_vec(),
        holds: control.axis(holds),
        proposed: proposed.map(|it| control.axis(it)),
    }
}

fn tablet(of: &ControlsCalibration) -> TabletMapping {
    of.tablet.clone().unwrap_or_default()
}

fn pressure(of: &ControlsCalibration) -> PressureCurve {
    of.tablet
        .as_ref()
        .map_or_else(PressureCurve::default, |it| it.pressure)
}
