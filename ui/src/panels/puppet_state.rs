//! What the puppet does and why, in words: its state, torque, pace, what it backs off for, who teaches it.

use egui::{Align2, Rect, Ui, pos2, vec2};
use rig::{Command, PuppetCommand, PuppetState, PuppetView, Snapshot, TeachCommand};

use super::Commands;
use super::button::{Button, Tone};
use super::style::{self, ink};
use crate::render::theme::{self, Rgb};
use crate::render::timeline::clock_text;

/// Height of a line of what there is to say, points.
pub const LINE: f32 = 15.0;
/// Width and height of a switch beside the state, points.
pub const SWITCH: [f32; 2] = [42.0, 17.0];

/// A state in words and in its colour.
fn state_word(state: PuppetState) -> (&'static str, Rgb) {
    match state {
        PuppetState::Released => ("released", theme::DIM),
        PuppetState::Arming => ("arming", theme::LIVE),
        PuppetState::Holding => ("holding", theme::LIVE),
        PuppetState::Playing => ("playing", theme::LIVE),
        PuppetState::Faulted => ("faulted", theme::FAULTED),
    }
}

/// The state, large; beneath it the torque, or the clip's time while it plays and how much slower than asked.
pub fn show(ui: &Ui, area: Rect, puppet: &PuppetView, seen: &Snapshot) {
    let driven = seen.puppet.is_some();
    let (word, colour) = match state_word(puppet.state) {
        _ if !driven => ("on screen", theme::DIM),
        _ if seen.teaching => ("teaching", theme::LIVE),
        (word, theme::LIVE) if puppet.backing_off.is_some() => (word, theme::TOO_MUCH),
        state => state,
    };
    let painter = ui.painter();
    let upper = area.top() + 8.0;
    let lamp = pos2(area.left() + 5.0, upper);
    if puppet.state == PuppetState::Released && !seen.teaching {
        painter.circle_stroke(lamp, 4.0, egui::Stroke::new(1.5, ink(colour)));
    } else {
        painter.circle_filled(lamp, 4.5, ink(colour));
    }
    let left = area.left() + 18.0;
    let width = area.right() - SWITCH[0] - left;
    let font = style::words(theme::SIZE_TITLE);
    let (at, lower) = (pos2(left, upper), pos2(left, area.top() + 27.0));
    style::line(painter, at, Align2::LEFT_CENTER, (word, font), colour, width);
    let Some(secs) = puppet.clip_secs else {
        let torque = match (driven, puppet.torque_unknown, puppet.torque) {
            (false, ..) => "not driven",
            (.., false) if seen.teaching => "floating",
            (.., true) if seen.teaching => "letting go",
            (_, true, _) => "torque unknown",
            (_, _, true) => "torque on",
            _ => "no torque",
        };
        let text = (torque, style::words(theme::SIZE_SMALL));
        style::line(painter, lower, Align2::LEFT_CENTER, text, theme::DIM, width);
        return;
    };
    let font = style::digits(theme::SIZE_SMALL);
    let text = format!("{} s", clock_text(secs));
    let drawn = painter.text(lower, Align2::LEFT_CENTER, text, font.clone(), ink(theme::LIVE));
    if puppet.backing_off.is_some() || puppet.pace < 0.995 {
        let text = format!("×{:.1}", puppet.pace);
        let at = drawn.right_center() + vec2(6.0, 0.0);
        painter.text(at, Align2::LEFT_CENTER, text, font, ink(theme::TOO_MUCH));
    }
}

/// The lead for lag, and teaching.
pub fn switches(ui: &mut Ui, area: Rect, seen: &Snapshot, commands: &mut Commands<'_>) {
    let puppet = seen.puppet.as_ref();
    let leads = puppet.is_some_and(|p| p.compensates_lag);
    let size = vec2(SWITCH[0], SWITCH[1]);
    let rect = |row: f32| {
        let top = area.top() - 1.0 + row * (size.y + 2.0);
        Rect::from_min_size(pos2(area.right() - size.x, top), size)
    };
    let tip = "Goals ahead of time by as much as each joint lags, so that the puppet is where the clip is.";
    let lead = Button::new("Lead", tip, "Shift-L")
        .named("puppet lead")
        .switch(leads);
    let lead = lead.size(theme::SIZE_SMALL).enabled(puppet.is_some());
    if lead.show(ui, rect(0.0)).clicked() {
        commands.push(Command::Puppet(PuppetCommand::CompensateLag(!leads)));
    }
    let tip = "Lets go of the puppet, so that hands can pose it: hold its limbs first. The screen shows where its \
               servos are, and K stores that.";
    let teach = Button::new("Teach", tip, "Shift-T").named("puppet teach");
    let tone = if seen.teaching { Tone::Live } else { Tone::Off };
    let teach = teach.tone(tone).size(theme::SIZE_SMALL).enabled(puppet.is_some());
    if teach.show(ui, rect(1.0)).clicked() {
        commands.push(teach_command(seen));
    }
}

/// Begins to teach, or ends it.
pub fn teach_command(seen: &Snapshot) -> Command {
    Command::Teach(if seen.teaching {
        TeachCommand::End
    } else {
        TeachCommand::Begin
    })
}

/// The most important thing there is to say.
pub fn remark(ui: &Ui, area: Rect, puppet: &PuppetView, seen: &Snapshot) {
    let (text, colour) = match (&puppet.fault, &puppet.backing_off) {
        _ if seen.puppet.is_none() => (
            "Posed and judged on screen only: nobody drives its servos.".to_owned(),
            theme::DIM,
        ),
        (Some(fault), _) => (fault.clone(), theme::TEXT),
        _ if puppet.state == PuppetState::Faulted => ("Stopped. Reset, then arm.".to_owned(), theme::TEXT),
        _ if seen.teaching => (floating(puppet), theme::TEXT),
        (None, Some(why)) => (why.clone(), theme::TOO_MUCH),
        (None, None) => (doings(puppet), theme::DIM),
    };
    let mut job = egui::text::LayoutJob::single_section(
        text.clone(),
        egui::TextFormat::simple(style::words(theme::SIZE_SMALL + 1.0), ink(colour)),
    );
    job.wrap = egui::text::TextWrapping {
        max_width: area.width(),
        max_rows: (area.height() / LINE) as usize,
        ..Default::default()
    };
    let galley = ui.painter().layout_job(job);
    let cut = galley.elided;
    ui.painter().galley(area.min, galley, ink(colour));
    let response = ui.interact(area, ui.scope_id().with("remark"), egui::Sense::hover());
    if cut {
        response.on_hover_text(text);
    }
}

/// What hands can move while somebody teaches.
fn floating(puppet: &PuppetView) -> String {
    if puppet.torque {
        return "Letting go: hold its limbs.".to_owned();
    }
    let mute: Vec<&str> = puppet
        .joints
        .iter()
        .filter(|joint| !joint.present)
        .map(|joint| joint.name.as_str())
        .collect();
    let all = puppet.joints.len();
    if mute.is_empty() {
        format!("All {all} joints float: pose them by hand, K stores where they are. Arm ends it.")
    } else {
        let floating = all - mute.len();
        format!(
            "{floating} of {all} joints float; no answer from {}: nothing can be stored.",
            mute.join(", ")
        )
    }
}

/// What the servo loop noticed, in one line.
fn doings(puppet: &PuppetView) -> String {
    let counts = [
        (puppet.interventions, "goal", "limited"),
        (puppet.stale_discarded, "answer", "too late"),
        (puppet.late_cycles, "cycle", "late"),
    ];
    let said: Vec<String> = counts
        .iter()
        .filter(|(count, ..)| *count > 0)
        .map(|(count, what, how)| format!("{count} {what}{} {how}", if *count == 1 { "" } else { "s" }))
        .collect();
    if said.is_empty() {
        "nothing limited, nothing late".to_owned()
    } else {
        said.join(", ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rig::JointView;

    #[test]
    fn what_floats_is_counted_and_what_does_not_answer_is_named() {
        let joint = |name: &str, present| JointView {
            name: name.into(),
            present,
            ..JointView::default()
        };
        let mut puppet = PuppetView {
            joints: vec![joint("a", true), joint("b", true)],
            torque: true,
            ..PuppetView::default()
        };
        assert!(floating(&puppet).starts_with("Letting go"));
        puppet.torque = false;
        assert!(floating(&puppet).starts_with("All 2 joints float"));
        puppet.joints[1].present = false;
        assert!(floating(&puppet).starts_with("1 of 2 joints float; no answer from b"));
    }
}
