//! What is said about a joint: in a word beside its bar, and everything in its tooltip.

use rig::{JointView, PuppetView, Snapshot, StretchKind};

use super::strain;

/// What a joint has or is asked too much of, in as few letters as the table has room for.
pub fn much(joint: &JointView, seen: &Snapshot) -> Option<String> {
    let strained = || {
        let stretch = strain::of_joint(seen, &joint.name)?;
        Some(match stretch.kind {
            StretchKind::Reach => "reach".to_owned(),
            _ => format!("×{:.1}", stretch.factor),
        })
    };
    match joint.trouble {
        _ if joint.error.is_some() || !joint.present => None,
        Some("heat") => joint.temperature_c.map(|celsius| format!("{celsius:.0} °C")),
        Some("brown-out") => joint.voltage_v.map(|volts| format!("{volts:.1}V")),
        Some(_) => Some("load".to_owned()),
        None => strained(),
    }
}

/// Everything known about a joint.
pub fn told(joint: &JointView, seen: &Snapshot) -> String {
    let degrees = |rad: Option<f64>| rad.map_or("none yet".to_owned(), |r| format!("{:.2}°", r.to_degrees()));
    let [low, high] = joint.range_rad.map(f64::to_degrees);
    let mut lines = vec![
        format!(
            "{}: goal {}, measured {}",
            joint.name,
            degrees(joint.goal_rad),
            degrees(joint.measured_rad)
        ),
        format!("range {low:.0}° to {high:.0}°{}", age(joint)),
    ];
    let celsius = joint.temperature_c.map(|celsius| format!("{celsius:.0} °C"));
    let volts = joint.voltage_v.map(|volts| format!("{volts:.1} V"));
    let health: Vec<String> = celsius.into_iter().chain(volts).collect();
    if !health.is_empty() {
        lines.push(health.join(", "));
    }
    lines.extend(lag(joint, seen.puppet.as_ref()));
    let stretch = strain::of_joint(seen, &joint.name);
    lines.extend(stretch.map(|stretch| format!("The clip asks too much of it: {stretch}")));
    lines.extend(joint.trouble.map(|trouble| trouble_words(trouble, joint.retreat)));
    lines.extend(joint.error.clone());
    if seen.puppet.is_none() {
        lines.push("Nobody drives it: this is the pose on screen.".to_owned());
    } else if !joint.present {
        lines.push("It does not answer: check its cable and its id.".to_owned());
    }
    lines.extend(posing(joint, seen));
    lines.join("\n")
}

fn age(joint: &JointView) -> String {
    if joint.age_secs.is_finite() && joint.measured_rad.is_some() {
        format!(", measured {:.0} ms ago", joint.age_secs * 1e3)
    } else {
        String::new()
    }
}

/// How it follows, before the lead for lag and with it.
fn lag(joint: &JointView, puppet: Option<&PuppetView>) -> Vec<String> {
    let tracking = &joint.tracking;
    let mut lines = Vec::new();
    if let Some(lag_secs) = joint.lag_secs {
        let before = format!("lag {:.0} ms", lag_secs * 1e3);
        lines.push(match tracking.behind_clip_secs {
            Some(left) if puppet.is_some_and(|p| p.compensates_lag) => {
                let lead = tracking.lead_secs * 1e3;
                format!(
                    "{before}; led by {lead:.0} ms, {:.0} ms behind the clip",
                    left * 1e3
                )
            }
            _ => before,
        });
    }
    if tracking.goal_samples > 0 {
        let goal = tracking.goal_error_rms_rad.to_degrees();
        let clip = tracking.clip_error_rms_rad.to_degrees();
        lines.push(if tracking.clip_samples > 0 {
            format!("off its goals by {goal:.2}°, off the clip by {clip:.2}° (root mean square)")
        } else {
            format!("off its goals by {goal:.2}° (root mean square)")
        });
    }
    lines
}

fn trouble_words(trouble: &str, retreat: f64) -> String {
    let retreat = (retreat * 100.0).round();
    if retreat > 0.0 {
        format!("{trouble}: its goal has gone back towards it by {retreat:.0} %")
    } else {
        format!("{trouble}: watched")
    }
}

fn posing(joint: &JointView, seen: &Snapshot) -> Option<String> {
    let pose = seen.puppet_pose.as_ref()?;
    let index = pose.names.iter().position(|name| *name == joint.name)?;
    if pose.led.get(index).copied().unwrap_or_default() {
        return Some("It follows another joint: pose that one.".to_owned());
    }
    let angle = pose.angles_rad.get(index)?.to_degrees();
    Some(format!("On screen {angle:.1}°: drag to pose it."))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hot() -> JointView {
        JointView {
            name: "r_elbow".into(),
            present: true,
            goal_rad: Some(0.5),
            measured_rad: Some(0.4),
            temperature_c: Some(71.4),
            lag_secs: Some(0.084),
            trouble: Some("heat"),
            retreat: 0.25,
            ..JointView::default()
        }
    }

    #[test]
    fn trouble_is_told_before_a_fault_takes_its_place() {
        let seen = Snapshot::default();
        assert_eq!(much(&hot(), &seen).as_deref(), Some("71 °C"));
        let failed = JointView {
            error: Some("overload".into()),
            ..hot()
        };
        assert_eq!(much(&failed, &seen), None);
    }

    #[test]
    fn a_tooltip_has_it_all() {
        let mut seen = Snapshot {
            puppet: Some(PuppetView::default()),
            ..Snapshot::default()
        };
        let mut joint = hot();
        let text = told(&joint, &seen);
        for part in ["goal 28.65°", "71 °C", "lag 84 ms", "back towards it by 25 %"] {
            assert!(text.contains(part), "{part} in {text}");
        }
        joint.tracking.behind_clip_secs = Some(0.004);
        joint.tracking.lead_secs = 0.08;
        assert!(!told(&joint, &seen).contains("behind"), "only with the lead on");
        if let Some(puppet) = &mut seen.puppet {
            puppet.compensates_lag = true;
        }
        let text = told(&joint, &seen);
        assert!(text.contains("led by 80 ms, 4 ms behind the clip"), "{text}");
    }
}
