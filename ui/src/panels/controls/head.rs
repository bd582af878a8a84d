//! Above the controls: which device, where it is, its page, and what can be done with all of it.

use egui::{Align2, Rect, Ui, pos2, vec2};
use rig::{CaptureView, Command, ControlCommand, DeviceHealth, DeviceView, LearnCommand, Snapshot, Touch};

use super::super::button::{Button, Tone};
use super::super::{Commands, style};
use super::list;
use crate::render::theme;

/// Width of a button, points.
const WIDTH: f32 = 76.0;

/// Shows it.
pub(super) fn show(
    ui: &mut Ui,
    area: Rect,
    (seen, device): (&Snapshot, &DeviceView),
    measuring: (&mut bool, bool),
    commands: &mut Commands<'_>,
) {
    let top = pos2(area.left(), area.top() + 9.0);
    list::lamp(ui, top + vec2(4.0, 0.0), device);
    let name = list::title(device);
    let text = (name.as_str(), style::words(theme::SIZE_TITLE));
    let painter = ui.painter();
    style::line(
        painter,
        top + vec2(theme::MARGIN + 2.0, 0.0),
        Align2::LEFT_CENTER,
        text,
        theme::TEXT,
        area.width() - theme::MARGIN,
    );
    let facts = facts(device);
    let text = (facts.as_str(), style::digits(theme::SIZE_SMALL));
    let at = pos2(area.left(), area.top() + 26.0);
    style::line(painter, at, Align2::LEFT_TOP, text, theme::DIM, area.width());
    let y = area.bottom() - theme::ROW - theme::STEP;
    let mut x = area.left();
    let mut next = |width: f32| {
        let rect = Rect::from_min_size(pos2(x, y), vec2(width, theme::ROW));
        x += width + theme::STEP;
        rect
    };
    learn(ui, next(WIDTH), seen, commands);
    calibrate(ui, next(WIDTH), device, measuring);
    capture(ui, next(WIDTH), device, commands);
    cable(ui, &mut next, device, commands);
    pages(ui, &mut next, device, commands);
    if let Some(said) = learning(seen) {
        let at = pos2(x + theme::GAP, y + theme::ROW / 2.0);
        let text = (said.as_str(), style::words(theme::SIZE_BODY));
        let width = area.right() - at.x;
        style::line(
            ui.painter(),
            at,
            Align2::LEFT_CENTER,
            text,
            theme::SELECTED,
            width,
        );
    }
}

fn facts(device: &DeviceView) -> String {
    let instance = match device.instance.as_str() {
        "" => String::new(),
        name => format!("{name}<n>   "),
    };
    let captured = device.capture.as_ref().map(captured).unwrap_or_default();
    format!(
        "{instance}{}   {}   {} events{captured}",
        device.profile, device.address, device.events
    )
}

fn learn(ui: &mut Ui, rect: Rect, seen: &Snapshot, commands: &mut Commands<'_>) {
    let on = seen.learning.is_some();
    let tip = "Touch a control, then touch a parameter: they are connected, as text of the network that undo takes back.";
    let button = Button::new("Learn", tip, "").tone(if on { Tone::On } else { Tone::Plain });
    if button.show(ui, rect).clicked() {
        let asked = if on {
            LearnCommand::Cancel
        } else {
            LearnCommand::Begin
        };
        commands.push(Command::Learn(asked));
    }
}

/// What counts come to, instead of the controls. While something is measured that is what is shown.
fn calibrate(ui: &mut Ui, rect: Rect, device: &DeviceView, (on, under_way): (&mut bool, bool)) {
    let tip = "What its counts come to: turns of dials, ends of faders, a tablet's area and pressure, measured by hand.";
    let name = format!("calibrate {}", device.name);
    let button = Button::new("Calibrate", tip, "")
        .named(&name)
        .switch(*on || under_way)
        .enabled(!under_way);
    if button.show(ui, rect).clicked() {
        *on = !*on;
    }
}

/// Everything said on its line goes into a file while this is on.
fn capture(ui: &mut Ui, rect: Rect, device: &DeviceView, commands: &mut Commands<'_>) {
    let running = device.capture.as_ref().is_some_and(|capture| capture.running);
    let tip = "Writes everything this device and dialrig say to each other into a file that replay, decode and tests \
               read.";
    let name = format!(
        "{} {}",
        if running { "Stop capturing" } else { "Capture" },
        device.name
    );
    let button = Button::new("Capture", tip, "").named(&name);
    let tone = if running { Tone::On } else { Tone::Plain };
    if button.tone(tone).show(ui, rect).clicked() {
        let devices = vec![device.name.clone()];
        commands.push(if running {
            Command::StopCapture { devices }
        } else {
            Command::StartCapture { devices }
        });
    }
}

/// The capture in words: while it runs how much there is, then where it is, or why it ended.
fn captured(capture: &CaptureView) -> String {
    match &capture.trouble {
        Some(trouble) => format!("   capture ended: {trouble}"),
        None if capture.running => format!(
            "   capturing {:.0} s, {} events: {}",
            capture.secs, capture.events, capture.file
        ),
        None => format!("   captured: {}", capture.file),
    }
}

/// The cable of a simulated device can be pulled, as a test.
fn cable(ui: &mut Ui, next: &mut impl FnMut(f32) -> Rect, device: &DeviceView, commands: &mut Commands<'_>) {
    if !device.address.starts_with("sim:") {
        return;
    }
    let lost = device.health == DeviceHealth::Lost;
    let text = if lost { "Plug in" } else { "Unplug" };
    let tip = "Takes the cable of this simulated device out, or puts it back, as a test.";
    let name = format!("{text} {} on the board", device.name);
    if Button::new(text, tip, "")
        .named(&name)
        .show(ui, next(WIDTH))
        .clicked()
    {
        commands.push(Command::Touch {
            device: device.name.clone(),
            touch: Touch::Cable { connected: lost },
        });
    }
}

/// Its pages: which is up, and whether that follows what is selected.
fn pages(ui: &mut Ui, next: &mut impl FnMut(f32) -> Rect, device: &DeviceView, commands: &mut Commands<'_>) {
    if device.page == 0 {
        return;
    }
    let ask = |command| Command::Controls(command);
    let turn = |page: u8| {
        ask(ControlCommand::Page {
            device: device.name.clone(),
            page,
        })
    };
    let back = Button::new("\u{2039}", "The page before.", "")
        .named("page before")
        .enabled(device.page > 1);
    if back.show(ui, next(theme::ROW)).clicked() {
        commands.push(turn(device.page - 1));
    }
    let text = format!("page {}", device.page);
    let rect = next(52.0);
    let text = (text.as_str(), style::words(theme::SIZE_BODY));
    style::line(
        ui.painter(),
        rect.center(),
        Align2::CENTER_CENTER,
        text,
        theme::TEXT,
        rect.width(),
    );
    let on = Button::new(
        "\u{203a}",
        "The next page. No parameter moves: controls take hold again.",
        "",
    )
    .named("next page");
    if on.show(ui, next(theme::ROW)).clicked() {
        commands.push(turn(device.page.saturating_add(1)));
    }
    let tip = "The page follows the link or joint that is selected, or stays.";
    let follows = Button::new("Follows", tip, "").switch(device.page_follows);
    if follows.show(ui, next(WIDTH)).clicked() {
        commands.push(ask(ControlCommand::PageFollows {
            device: device.name.clone(),
            on: !device.page_follows,
        }));
    }
}

/// What to do next while something is learnt.
fn learning(seen: &Snapshot) -> Option<String> {
    let learning = seen.learning.as_ref()?;
    Some(match (&learning.control, &learning.parameter) {
        (None, None) => "touch a control".to_owned(),
        (Some((device, number)), None) => {
            format!("{device}, control {number}: now touch what it is to drive")
        }
        (None, Some((name, inlet))) => format!("{name}<{inlet}>: now touch a control"),
        (Some(_), Some(_)) => "connecting".to_owned(),
    })
}
