//! The one kind of button: painted into a rectangle that is given, with a tooltip that names its key.

use egui::accesskit::Role;
use egui::{Align2, Id, Painter, Pos2, Rect, Response, Sense, Shape, Stroke, Ui, WidgetInfo, vec2};

use super::style::{self, ink};
use crate::render::theme::{self, Rgb};

/// Small pictures drawn with lines, so that they are sharp and of one family.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Icon {
    /// To the first key.
    Start,
    /// To the key before.
    Previous,
    /// Run time.
    Play,
    /// Stop time.
    Pause,
    /// To the next key.
    Next,
    /// To the last key.
    End,
    /// Start over at the end.
    Loop,
    /// Take back.
    Undo,
    /// Make again.
    Redo,
}

/// How a button is meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Tone {
    /// Like all others.
    #[default]
    Plain,
    /// A switch that is on.
    On,
    /// A switch that is off.
    Off,
    /// What it stands for is moving now.
    Live,
    /// The one that must be found at once.
    Loud,
    /// It answers something that is too much.
    TooMuch,
    /// A fault, and nothing else.
    Faulted,
}

/// A button before it is shown.
pub struct Button<'a> {
    name: &'a str,
    text: &'a str,
    icon: Option<Icon>,
    tip: &'a str,
    keys: &'a str,
    tone: Tone,
    enabled: bool,
    size: f32,
}

impl<'a> Button<'a> {
    /// A button that says `text`; `tip` says what it does, `keys` which keys do the same.
    pub fn new(text: &'a str, tip: &'a str, keys: &'a str) -> Button<'a> {
        Button {
            name: text,
            text,
            icon: None,
            tip,
            keys,
            tone: Tone::Plain,
            enabled: true,
            size: theme::SIZE_BODY,
        }
    }

    /// A button with a picture instead of words; `name` is what it is called.
    pub fn icon(icon: Icon, name: &'a str, tip: &'a str, keys: &'a str) -> Button<'a> {
        Button {
            icon: Some(icon),
            text: "",
            name,
            ..Button::new("", tip, keys)
        }
    }

    /// What it is called where its text alone would be ambiguous.
    #[must_use]
    pub fn named(self, name: &'a str) -> Self {
        Button { name, ..self }
    }

    /// A switch, on or off.
    #[must_use]
    pub fn switch(self, on: bool) -> Self {
        self.tone(if on { Tone::On } else { Tone::Off })
    }

    /// How it is meant.
    #[must_use]
    pub fn tone(self, tone: Tone) -> Self {
        Button { tone, ..self }
    }

    /// Greyed out, with the same tooltip, when `enabled` is false.
    #[must_use]
    pub fn enabled(self, enabled: bool) -> Self {
        Button { enabled, ..self }
    }

    /// Type size, points.
    #[must_use]
    pub fn size(self, size: f32) -> Self {
        Button { size, ..self }
    }

    /// Shows it in `rect`.
    pub fn show(self, ui: &mut Ui, rect: Rect) -> Response {
        let id = ui.scope_id().with(("button", self.name));
        let sense = if self.enabled {
            Sense::click()
        } else {
            Sense::hover()
        };
        let response = ui.interact(rect, id, sense);
        response.widget_info(|| WidgetInfo::labeled(Role::Button, self.enabled, self.name));
        let (fill, edge, content) = self.colours(&response);
        let painter = ui.painter();
        painter.rect(
            rect,
            style::round(),
            ink(fill),
            style::hair(edge),
            egui::StrokeKind::Inside,
        );
        if let Some(icon) = self.icon {
            paint_icon(painter, icon, rect.center(), content);
        } else {
            let text = (self.text, style::words(self.size));
            let width = rect.width() - theme::STEP;
            style::line(
                painter,
                rect.center(),
                Align2::CENTER_CENTER,
                text,
                content,
                width,
            );
        }
        focus_ring(ui, &response);
        tooltip(response, self.tip, self.keys)
    }

    fn colours(&self, response: &Response) -> (Rgb, Rgb, Rgb) {
        let (rest, edge, content) = match self.tone {
            _ if !self.enabled => return (theme::PANEL, theme::EDGE, theme::FAINT),
            Tone::Plain => (theme::RAISED, theme::EDGE, theme::TEXT),
            Tone::Off => (theme::PANEL, theme::EDGE, theme::DIM),
            // Not the accent of what is selected: a switch that is on is no target.
            Tone::On => (theme::PRESSED, theme::FAINT, theme::LINE),
            Tone::Live => (
                theme::LIVE.mix(theme::PANEL, 0.84),
                theme::LIVE.mix(theme::PANEL, 0.4),
                theme::LIVE,
            ),
            Tone::TooMuch => (
                theme::TOO_MUCH.mix(theme::PANEL, 0.84),
                theme::TOO_MUCH.mix(theme::PANEL, 0.4),
                theme::TOO_MUCH,
            ),
            Tone::Loud => (theme::TEXT, theme::TEXT, theme::GROUND),
            Tone::Faulted => (theme::FAULTED, theme::FAULTED, theme::GROUND),
        };
        let towards = if matches!(self.tone, Tone::Loud | Tone::Faulted) {
            theme::LINE
        } else {
            theme::PRESSED
        };
        let fill = if response.is_pointer_button_down_on() {
            rest.mix(towards, 0.9)
        } else if response.hovered() {
            rest.mix(towards, 0.5)
        } else {
            rest
        };
        (fill, edge, content)
    }
}

/// The mark of the control that the Enter key would press; whatever scrolls brings it to light.
pub fn focus_ring(ui: &Ui, response: &Response) {
    if response.gained_focus() {
        response.scroll_to_me(None);
    }
    if response.has_focus() {
        let rect = response.rect.expand(1.0);
        ui.painter().rect_stroke(
            rect,
            style::round(),
            Stroke::new(1.5, ink(theme::TEXT)),
            egui::StrokeKind::Outside,
        );
    }
}

/// A tooltip: what it does, then the keys that do the same.
pub fn tooltip(response: Response, tip: &str, keys: &str) -> Response {
    response.on_hover_ui(|ui| tip_lines(ui, tip, keys))
}

/// The same for something large: beside the pointer, wherever that is.
pub fn tooltip_at_pointer(response: Response, tip: &str, keys: &str) -> Response {
    response.on_hover_ui_at_pointer(|ui| tip_lines(ui, tip, keys))
}

fn tip_lines(ui: &mut Ui, tip: &str, keys: &str) {
    ui.set_max_width(300.0);
    ui.label(tip);
    if !keys.is_empty() {
        let font = style::digits(theme::SIZE_SMALL);
        ui.label(egui::RichText::new(keys).font(font).color(ink(theme::DIM)));
    }
}

/// A place in a panel that can be clicked or dragged; it has a role and a name, as everything has.
pub fn spot(ui: &Ui, rect: Rect, id: Id, sense: Sense, (role, name): (Role, &str)) -> Response {
    let response = ui.interact(rect, id, sense);
    response.widget_info(|| WidgetInfo::labeled(role, true, name));
    response
}

fn paint_icon(painter: &Painter, icon: Icon, centre: Pos2, colour: Rgb) {
    let c = centre.round();
    let fill = ink(colour);
    let triangle = |x: f32, direction: f32| {
        let tip = c + vec2(x + direction * 5.0, 0.0);
        let base = x - direction * 4.0;
        let corners = vec![tip, c + vec2(base, -6.0), c + vec2(base, 6.0)];
        painter.add(Shape::convex_polygon(corners, fill, Stroke::NONE));
    };
    let bar = |x: f32| {
        painter.rect_filled(
            Rect::from_center_size(c + vec2(x, 0.0), vec2(2.0, 12.0)),
            0.0,
            fill,
        );
    };
    let diamond = |x: f32| {
        let at = c + vec2(x, 0.0);
        let corners = vec![
            at + vec2(0.0, -4.0),
            at + vec2(4.0, 0.0),
            at + vec2(0.0, 4.0),
            at + vec2(-4.0, 0.0),
        ];
        painter.add(Shape::convex_polygon(corners, fill, Stroke::NONE));
    };
    match icon {
        Icon::Play => triangle(0.0, 1.3),
        Icon::Pause => [-3.0, 3.0].into_iter().for_each(|x| {
            painter.rect_filled(
                Rect::from_center_size(c + vec2(x, 0.0), vec2(3.5, 13.0)),
                0.0,
                fill,
            );
        }),
        Icon::Start => {
            bar(-5.0);
            triangle(2.0, -1.0);
        }
        Icon::End => {
            triangle(-2.0, 1.0);
            bar(5.0);
        }
        Icon::Previous => {
            triangle(-4.0, -1.0);
            diamond(6.0);
        }
        Icon::Next => {
            triangle(4.0, 1.0);
            diamond(-6.0);
        }
        Icon::Loop => paint_turn(painter, c, colour, &[(-2.7, 1.0), (0.44, 1.0)]),
        Icon::Undo => paint_turn(painter, c, colour, &[(0.3, -1.55)]),
        Icon::Redo => paint_turn(painter, c, colour, &[(2.84, 1.55)]),
    }
}

/// Arcs with arrow heads: (start angle, length in half turns and direction).
fn paint_turn(painter: &Painter, c: Pos2, colour: Rgb, arcs: &[(f32, f32)]) {
    let radius = 5.5;
    for &(start, length) in arcs {
        let sweep = length * 2.3;
        let on = |share: f32| c + egui::Vec2::angled(start + sweep * share) * radius;
        let points: Vec<Pos2> = (0..=12).map(|i| on(i as f32 / 12.0)).collect();
        painter.line(points, Stroke::new(1.6, ink(colour)));
        let end = start + sweep;
        let ahead = egui::Vec2::angled(end + std::f32::consts::FRAC_PI_2 * length.signum());
        let out = egui::Vec2::angled(end);
        let tip = c + out * radius + ahead * 3.4;
        let base = c + out * radius - ahead * 1.2;
        let corners = vec![tip, base + out * 3.2, base - out * 3.2];
        painter.add(Shape::convex_polygon(corners, ink(colour), Stroke::NONE));
    }
}
