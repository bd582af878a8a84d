//! Pinned read-outs: the last messages of an output as a line and a value, in a column at the left.

use egui::{Align2, Color32, Rect, Sense, Stroke, Ui, pos2, vec2};
use ps300::language::Name;

use super::colour;
use crate::panels::style::{self, ink};
use crate::patch::edit::output_number;
use crate::patch::look::Look;
use crate::patch::probe::Probe;
use crate::patch::scene::{Port, Scene};
use crate::render::theme;

const SIZE: egui::Vec2 = egui::Vec2::new(208.0, 56.0);

/// The read-outs.
#[derive(Default)]
pub(super) struct Probes {
    pinned: Vec<Probe>,
}

impl Probes {
    /// Pins a read-out, or takes it away.
    pub(super) fn toggle(&mut self, port: &Port) {
        let (name, output) = (port.of.clone(), output_number(port));
        let known = self
            .pinned
            .iter()
            .position(|probe| probe.name == name && probe.output == output);
        match known {
            Some(index) => {
                self.pinned.remove(index);
            }
            None => self.pinned.push(Probe::new(name, output)),
        }
    }

    /// Takes note of what the pinned outputs sent.
    pub(super) fn see(&mut self, scene: &Scene, look: &Look) {
        for probe in &mut self.pinned {
            let seen = output(scene, &probe.name, probe.output)
                .and_then(|port| look.activity.outputs.get(port.activity?));
            if let Some(seen) = seen {
                probe.see(seen.sent, seen.last.as_ref());
            }
        }
    }

    pub(super) fn show(&mut self, ui: &Ui, area: Rect, scene: &Scene) {
        let mut gone = None;
        for (index, probe) in self.pinned.iter().enumerate() {
            let top = area.top() + 10.0 + index as f32 * (SIZE.y + 6.0);
            let rect = Rect::from_min_size(pos2(area.left() + 10.0, top), SIZE);
            if rect.bottom() > area.bottom() {
                break;
            }
            let kinds = output(scene, &probe.name, probe.output).map(|port| port.kinds);
            let colour = kinds.map_or(theme::FAINT, colour::of_port);
            paint(ui, rect, probe, colour);
            let close = Rect::from_min_size(rect.right_top() + vec2(-20.0, 2.0), vec2(18.0, 18.0));
            let id = ui.scope_id().with(("probe", index));
            let response = ui.interact(close, id, Sense::click());
            response.widget_info(|| {
                let name = format!("close {}<{}>", probe.name, probe.output);
                egui::WidgetInfo::labeled(egui::accesskit::Role::Button, true, name)
            });
            let ink_of = if response.hovered() {
                theme::TEXT
            } else {
                theme::FAINT
            };
            ui.painter().text(
                close.center(),
                Align2::CENTER_CENTER,
                "×",
                style::words(14.0),
                ink(ink_of),
            );
            if response.clicked() {
                gone = Some(index);
            }
        }
        if let Some(index) = gone {
            self.pinned.remove(index);
        }
    }
}

fn output<'a>(scene: &'a Scene, name: &Name, output: u8) -> Option<&'a Port> {
    let shown = scene.boxes.get(scene.find(name)?)?;
    shown.outputs.iter().find(|port| output_number(port) == output)
}

fn paint(ui: &Ui, rect: Rect, probe: &Probe, colour: theme::Rgb) {
    let painter = ui.painter().with_clip_rect(rect);
    painter.rect(
        rect,
        style::round(),
        ink(theme::PANEL),
        style::hair(theme::EDGE),
        egui::StrokeKind::Inside,
    );
    let title = format!("{}<{}>", probe.name, probe.output);
    let text = (title.as_str(), style::digits(theme::SIZE_SMALL));
    style::line(
        &painter,
        rect.min + vec2(8.0, 12.0),
        Align2::LEFT_CENTER,
        text,
        theme::DIM,
        SIZE.x * 0.5,
    );
    let text = (probe.last.as_str(), style::digits(theme::SIZE_SMALL));
    style::line(
        &painter,
        rect.right_top() + vec2(-24.0, 12.0),
        Align2::RIGHT_CENTER,
        text,
        theme::TEXT,
        SIZE.x * 0.4,
    );
    let field = Rect::from_min_max(rect.min + vec2(8.0, 24.0), rect.max - vec2(8.0, 7.0));
    let step = field.width() / (crate::patch::probe::KEPT - 1) as f32;
    let count = probe.heights().count();
    let first = field.right() - step * count.saturating_sub(1) as f32;
    let point = |(index, height): (usize, f32)| {
        pos2(
            first + step * index as f32,
            field.bottom() - height * field.height(),
        )
    };
    let points: Vec<egui::Pos2> = probe.heights().enumerate().map(point).collect();
    if let Some(&last) = points.last() {
        painter.line(points, Stroke::new(1.3, ink(colour)));
        painter.circle(last, 2.5, ink(colour), Stroke::new(0.0, Color32::TRANSPARENT));
    } else {
        let text = ("nothing sent yet", style::words(theme::SIZE_SMALL));
        style::line(
            &painter,
            field.center(),
            Align2::CENTER_CENTER,
            text,
            theme::FAINT,
            field.width(),
        );
    }
}
