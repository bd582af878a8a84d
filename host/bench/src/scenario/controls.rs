//! Words for controls: calibrating them with a hand, where they stand, and what was said of it.

use rig::{CalibrateControl, Snapshot};

use super::words::{Parsed, Words};

/// What may stand behind `calibrate`, of controls.
pub(super) const STEPS: [&str; 9] = [
    "dial", "ends", "rest", "corners", "pressure", "next", "take", "cancel", "forget",
];

/// Reads what stands behind one of [`STEPS`].
pub(super) fn calibrate(step: &str, words: &mut Words<'_>) -> Parsed<CalibrateControl> {
    Ok(match step {
        "dial" => {
            let (control, device) = control(words)?;
            words.expect("by")?;
            let turns = words.whole("whole turns", 1..=20)? as u32;
            let _ = words.take("turns") || words.take("turn");
            CalibrateControl::Dial {
                device,
                control,
                turns,
            }
        }
        "ends" | "rest" => {
            words.expect("of")?;
            let (control, device) = control(words)?;
            if step == "ends" {
                CalibrateControl::Ends { device, control }
            } else {
                CalibrateControl::Rest { device, control }
            }
        }
        "corners" => CalibrateControl::Corners { device: of(words)? },
        "pressure" => CalibrateControl::Pressure { device: of(words)? },
        "next" => CalibrateControl::Next,
        "take" => CalibrateControl::Take,
        "cancel" => CalibrateControl::Cancel,
        _ => {
            let device = words.text("a device")?;
            CalibrateControl::Forget {
                device,
                control: None,
            }
        }
    })
}

/// `N of DEVICE`, N the number of the control's output.
pub(super) fn control(words: &mut Words<'_>) -> Parsed<(u8, String)> {
    let control = words.whole("a control by the number of its output", 1..=127)? as u8;
    Ok((control, of(words)?))
}

fn of(words: &mut Words<'_>) -> Parsed<String> {
    words.expect("of")?;
    words.text("a device")
}

/// What the calibration under way is expected to say.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Said {
    /// Words of its instruction, of what it has seen, of its result or of what was wrong.
    Words(String),
    /// Whether there is one.
    UnderWay(bool),
}

impl Said {
    pub(super) fn judge(&self, seen: &Snapshot) -> Result<(), String> {
        let now = seen.calibration.as_ref();
        match (self, now) {
            (Self::UnderWay(wanted), _) if *wanted == now.is_some() => Ok(()),
            (_, None) => Err("no control is being calibrated".into()),
            (Self::UnderWay(_), Some(now)) => Err(format!("{} of {} is", now.what, now.device)),
            (Self::Words(words), Some(now)) => {
                let result = now.result.clone().unwrap_or_default();
                let fault = now.fault.clone().unwrap_or_default();
                let said = [&now.instruction, &now.seen, &result, &fault];
                if said.iter().any(|it| it.contains(words)) {
                    return Ok(());
                }
                Err(format!("calibration says {said:?}"))
            }
        }
    }
}

/// Where a control stands, as the board of devices shows it.
pub(super) fn place(seen: &Snapshot, device: &str, number: u8) -> Result<Option<f64>, String> {
    let view = seen.devices.iter().find(|view| view.name == device);
    let view = view.ok_or_else(|| format!("there is no device {device}"))?;
    Ok(view
        .controls
        .iter()
        .find(|control| control.number == number)
        .map(|control| control.value))
}
