//! How the servos fare, in one line: the hottest, the lowest voltage, the one that lags most.

use egui::accesskit::Role;
use egui::{Align2, Rect, Sense, Ui, pos2};
use rig::{JointView, PuppetView};

use super::{button, style};
use crate::render::theme::{self, Rgb};

/// Height of the line, points.
pub const HEIGHT: f32 = 16.0;
/// From left to right, shares of the width: a temperature, a voltage, a lag.
const SHARES: [f32; 3] = [0.39, 0.22, 0.39];

/// One of the values.
struct Vital {
    value: String,
    joint: String,
    colour: Rgb,
    told: String,
}

/// Shows what is known of them; nothing where nothing is.
pub fn show(ui: &Ui, area: Rect, puppet: &PuppetView) {
    let vitals = [hottest(puppet), lowest(puppet), latest(puppet)];
    let mut left = area.left();
    for (vital, share) in vitals.iter().zip(SHARES) {
        let right = left + area.width() * share;
        if let Some(vital) = vital {
            let cell = Rect::from_x_y_ranges(left..=right - theme::STEP, area.y_range());
            cell_of(ui, cell, vital);
        }
        left = right;
    }
}

fn cell_of(ui: &Ui, cell: Rect, vital: &Vital) {
    let painter = ui.painter();
    let middle = cell.center().y.round();
    let font = style::digits(theme::SIZE_SMALL);
    let value = style::layout(painter, (&vital.value, font), vital.colour, cell.width());
    let after = cell.left() + value.size().x + 5.0;
    let top = middle - value.size().y / 2.0;
    painter.galley(pos2(cell.left(), top).round(), value, style::ink(vital.colour));
    let room = cell.right() - after;
    if room > 18.0 {
        let name = vital.joint.replace('_', " ");
        let name = (name.as_str(), style::words(theme::SIZE_SMALL));
        let at = pos2(after, middle);
        style::line(painter, at, Align2::LEFT_CENTER, name, theme::DIM, room);
    }
    let id = ui.scope_id().with(("vital", &vital.told));
    let response = button::spot(ui, cell, id, Sense::hover(), (Role::Label, &vital.told));
    response.on_hover_text(&vital.told);
}

/// The joint of the greatest of some value.
fn greatest(puppet: &PuppetView, value: impl Fn(&JointView) -> Option<f64>) -> Option<(f64, &JointView)> {
    let known = puppet.joints.iter().filter(|joint| joint.present);
    let known = known.filter_map(|joint| Some((value(joint)?, joint)));
    known.max_by(|a, b| a.0.total_cmp(&b.0))
}

fn in_trouble(puppet: &PuppetView, trouble: &str) -> Rgb {
    let has = |joint: &JointView| joint.trouble == Some(trouble);
    if puppet.joints.iter().any(has) {
        theme::TOO_MUCH
    } else {
        theme::TEXT
    }
}

fn hottest(puppet: &PuppetView) -> Option<Vital> {
    let (celsius, joint) = greatest(puppet, |joint| joint.temperature_c)?;
    Some(Vital {
        value: format!("{celsius:.0} °C"),
        joint: joint.name.clone(),
        colour: in_trouble(puppet, "heat"),
        told: format!("hottest: {} at {celsius:.0} °C", joint.name),
    })
}

fn lowest(puppet: &PuppetView) -> Option<Vital> {
    let (volts, joint) = greatest(puppet, |joint| joint.voltage_v.map(|volts| -volts))?;
    let volts = -volts;
    Some(Vital {
        value: format!("{volts:.1} V"),
        joint: String::new(),
        colour: in_trouble(puppet, "brown-out"),
        told: format!("lowest voltage: {volts:.1} V at {}", joint.name),
    })
}

fn latest(puppet: &PuppetView) -> Option<Vital> {
    let (lag, joint) = greatest(puppet, |joint| joint.lag_secs)?;
    let ms = |secs: f64| (secs * 1e3).round();
    let left = joint.tracking.behind_clip_secs.filter(|_| puppet.compensates_lag);
    let (value, told) = match left {
        Some(left) => (
            format!("{:.0}→{:.0} ms", ms(lag), ms(left)),
            format!(
                "lags most: {} by {:.0} ms, {:.0} ms behind the clip with the lead",
                joint.name,
                ms(lag),
                ms(left)
            ),
        ),
        None => (
            format!("{:.0} ms", ms(lag)),
            format!("lags most: {} by {:.0} ms", joint.name, ms(lag)),
        ),
    };
    Some(Vital {
        value,
        joint: joint.name.clone(),
        colour: theme::TEXT,
        told,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn joint(name: &str, celsius: f64, volts: f64, lag_secs: f64) -> JointView {
        JointView {
            name: name.into(),
            present: true,
            temperature_c: Some(celsius),
            voltage_v: Some(volts),
            lag_secs: Some(lag_secs),
            ..JointView::default()
        }
    }

    #[test]
    fn the_worst_of_each_is_told_with_its_joint() {
        let mut puppet = PuppetView {
            joints: vec![joint("a", 40.0, 11.0, 0.08), joint("b", 61.0, 11.8, 0.02)],
            ..PuppetView::default()
        };
        let told = |puppet: &PuppetView| {
            [hottest(puppet), lowest(puppet), latest(puppet)].map(|vital| vital.expect("all are known").told)
        };
        assert_eq!(
            told(&puppet),
            [
                "hottest: b at 61 °C",
                "lowest voltage: 11.0 V at a",
                "lags most: a by 80 ms"
            ]
        );
        puppet.joints[0].present = false;
        assert_eq!(
            told(&puppet)[1],
            "lowest voltage: 11.8 V at b",
            "an absent one says nothing"
        );
        puppet.joints[1].trouble = Some("heat");
        let colour = |vital: Option<Vital>| vital.map(|vital| vital.colour);
        assert_eq!(colour(hottest(&puppet)), Some(theme::TOO_MUCH));
        assert_eq!(colour(lowest(&puppet)), Some(theme::TEXT));
    }
}
