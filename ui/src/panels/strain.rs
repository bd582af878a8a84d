//! What the puppet cannot do, over the strip of time: a bar wherever a joint is asked too much, higher for more.
//!
//! Judging is the rig's ([`rig::FeasibilityView`]); here it is only shown. Bars of the same stretch of time lie
//! over each other, so the highest is seen and the tooltip lists them all.

use egui::accesskit::Role;
use egui::{Rect, Sense, Ui, pos2, vec2};
use rig::{Snapshot, StretchKind, StretchView};

use super::button;
use super::style::{self, ink};
use crate::render::theme;
use crate::render::timeline::Timeline;

/// Least and greatest height of a bar, points.
const HEIGHT: [f32; 2] = [4.0, 14.0];
/// A bar is highest where this many times too much is asked.
const FACTOR_FULL: f64 = 2.0;
/// Least width, points: a short peak must be seen, too.
const WIDTH_MIN: f32 = 3.0;

/// The stretches around a moment.
pub fn at(seen: &Snapshot, secs: f64) -> impl Iterator<Item = &StretchView> {
    let all = seen.feasibility.iter().flat_map(|view| view.stretches.iter());
    all.filter(move |stretch| (stretch.from_secs..=stretch.to_secs).contains(&secs))
}

/// Whether `joint` is asked too much at the present moment, and the worst of it.
pub fn of_joint<'a>(seen: &'a Snapshot, joint: &str) -> Option<&'a StretchView> {
    let here = at(seen, seen.transport.secs).filter(|stretch| stretch.joint == joint);
    here.max_by(|a, b| a.factor.total_cmp(&b.factor))
}

/// Shows the bars, hanging from the top of `area`.
pub fn show(ui: &Ui, area: Rect, line: &Timeline, seen: &Snapshot) {
    let Some(view) = seen
        .feasibility
        .as_ref()
        .filter(|view| !view.stretches.is_empty())
    else {
        return;
    };
    let painter = ui.painter().with_clip_rect(area);
    // What was judged of the clip as it was before a change is shown as past.
    let fresh = if view.progress < 1.0 { 0.5 } else { 1.0 };
    for stretch in view.stretches.iter() {
        let bar = bar(area, line, stretch);
        let strength = fresh
            * if stretch.kind == StretchKind::Reach {
                0.55
            } else {
                1.0
            };
        let colour = theme::GROUND.mix(theme::TOO_MUCH, strength);
        painter.rect_filled(bar, 1.0, ink(colour));
    }
    if let Some(worst) = view.stretches.iter().max_by(|a, b| a.factor.total_cmp(&b.factor)) {
        let bar = bar(area, line, worst);
        let font = style::words(theme::SIZE_SMALL);
        let words = style::layout(&painter, (&short(worst), font), theme::TOO_MUCH, area.width());
        // Under its bar, on the ground's own colour: bars stand close, and the curve goes through.
        let left = bar.left().min(area.right() - words.size().x).max(area.left());
        let at = pos2(left, area.top() + HEIGHT[1] + 2.0).round();
        let plate = Rect::from_min_size(at, words.size()).expand2(vec2(theme::STEP, 0.0));
        painter.rect_filled(plate, style::round(), ink(theme::GROUND));
        painter.galley(at, words, ink(theme::TOO_MUCH));
    }
    tell(ui, area, line, seen);
}

fn bar(area: Rect, line: &Timeline, stretch: &StretchView) -> Rect {
    let share = ((stretch.factor - 1.0) / (FACTOR_FULL - 1.0)).clamp(0.0, 1.0) as f32;
    let height = HEIGHT[0] + (HEIGHT[1] - HEIGHT[0]) * share;
    let (from, to) = (line.x(stretch.from_secs), line.x(stretch.to_secs));
    let width = (to - from).max(WIDTH_MIN);
    let left = f32::midpoint(from, to) - width / 2.0;
    Rect::from_min_size(pos2(left, area.top()), vec2(width, height))
}

fn short(stretch: &StretchView) -> String {
    let joint = stretch.joint.replace('_', " ");
    format!("{joint}: {:.1}× {}", stretch.factor, stretch.kind.word())
}

/// Lists what is asked too much where the pointer is; clicks go through to what lies beneath.
fn tell(ui: &Ui, area: Rect, line: &Timeline, seen: &Snapshot) {
    let band = Rect::from_min_size(area.min, vec2(area.width(), HEIGHT[1]));
    let id = ui.scope_id().with("strain");
    let response = button::spot(ui, band, id, Sense::hover(), (Role::Label, "asked too much"));
    let Some(pointer) = response.hover_pos() else {
        return;
    };
    let secs = line.secs(pointer.x);
    let mut lines: Vec<String> = at(seen, secs).map(ToString::to_string).collect();
    if lines.is_empty() {
        return;
    }
    if at(seen, secs).any(|stretch| stretch.slowable) {
        lines.push("Slow to fit gives the keys the time it needs.".to_owned());
    }
    response.on_hover_text_at_pointer(lines.join("\n"));
}

#[cfg(test)]
mod tests {
    use super::*;
    use rig::FeasibilityView;

    fn stretch(joint: &str, from_secs: f64, to_secs: f64, factor: f64) -> StretchView {
        StretchView {
            from_secs,
            to_secs,
            joint: joint.to_owned(),
            link: None,
            kind: StretchKind::Speed,
            factor,
            slowable: true,
        }
    }

    #[test]
    fn a_short_peak_is_wide_enough_to_see_and_a_bad_one_is_high() {
        let line = Timeline::new(0.0, 10.0, 0.0, 500.0);
        let area = Rect::from_min_size(pos2(0.0, 0.0), vec2(500.0, 60.0));
        let peak = bar(area, &line, &stretch("a", 5.0, 5.001, 1.0));
        assert!((peak.width() - WIDTH_MIN).abs() < 1e-3 && (peak.center().x - 250.0).abs() < 0.1);
        assert_eq!(peak.height(), HEIGHT[0]);
        assert_eq!(bar(area, &line, &stretch("a", 5.0, 6.0, 9.0)).height(), HEIGHT[1]);
    }

    #[test]
    fn the_worst_of_a_joint_is_that_of_the_present() {
        let mut seen = Snapshot {
            feasibility: Some(FeasibilityView {
                stretches: [
                    stretch("a", 0.0, 1.0, 3.0),
                    stretch("a", 1.5, 2.0, 1.2),
                    stretch("a", 1.6, 2.0, 1.4),
                    stretch("b", 0.0, 9.0, 2.0),
                ]
                .into(),
                ..FeasibilityView::default()
            }),
            ..Snapshot::default()
        };
        seen.transport.secs = 1.7;
        assert_eq!(of_joint(&seen, "a").map(|stretch| stretch.factor), Some(1.4));
        seen.transport.secs = 1.2;
        assert_eq!(of_joint(&seen, "a"), None);
        assert_eq!(at(&seen, 1.2).count(), 1);
    }
}
