//! The board of input devices: pictures to be looked at, and what hands on it want.

use egui_kittest::kittest::{NodeT, Queryable};
use rig::{Command, ControlView, DeviceHealth, DeviceView, LearnCommand, LearningView, OutputView, Snapshot};
use ui::panels::Board;
use ui::render::picture::Picture;

use crate::studio::{Bench, at_scale, harness, keep, no_card};
use crate::walker;

pub(crate) fn controls(kind: &'static str, count: u8, first: u8) -> impl Iterator<Item = ControlView> {
    (0..count).map(move |index| ControlView {
        number: first + index,
        name: format!("{kind} {}", index + 1),
        kind,
        value: match kind {
            "button" => f64::from(index == 2),
            "axis" => f64::from(index) / 4.0 - 0.5,
            _ => f64::from(index) * 0.13,
        },
        unit: match kind {
            "dial" => "turns",
            "button" => "",
            _ => "share",
        },
        range: match kind {
            "dial" | "button" => None,
            "axis" => Some([-1.0, 1.0]),
            _ => Some([0.0, 1.0]),
        },
        picked_up: index != 1 || kind == "dial",
        awaits: (index == 1 && kind != "dial" && kind != "button").then_some(0.7),
        live: index == 2,
        bound: if index % 3 == 0 {
            vec![format!("rua<{}>", index + 1)]
        } else {
            Vec::new()
        },
        label: if index % 2 == 0 {
            format!("X-Rot {index}")
        } else {
            String::new()
        },
        mode: "pickup",
        comes_to: match kind {
            "dial" => "256.0 a turn".to_owned(),
            "button" => String::new(),
            "axis" => "-350 to 350".to_owned(),
            _ => "0 to 1023".to_owned(),
        },
        calibrated: index == 2 && kind != "button",
    })
}

pub(crate) fn device(
    name: &str,
    title: &str,
    health: DeviceHealth,
    controls: Vec<ControlView>,
) -> DeviceView {
    DeviceView {
        name: name.to_owned(),
        instance: name.to_uppercase().replace('-', ""),
        profile: name.to_owned(),
        title: title.to_owned(),
        address: format!("sim:{name}"),
        slot: 1,
        rate_hz: if health == DeviceHealth::Present {
            125.0
        } else {
            0.0
        },
        jitter_ms: 0.4,
        events: 2381,
        page: 1,
        health,
        controls,
        ..DeviceView::default()
    }
}

/// Six devices: some well, one away, one that may not be opened, one that a driver holds.
pub(crate) fn six() -> Snapshot {
    let rule = "KERNEL==\"hidraw*\", ATTRS{idVendor}==\"256c\", ATTRS{idProduct}==\"006d\", TAG+=\"uaccess\"";
    let mut dials = device(
        "dial-box",
        "Dial box with displays",
        DeviceHealth::Present,
        controls("dial", 8, 1).chain(controls("button", 12, 9)).collect(),
    );
    let lamp = |number: u16| OutputView {
        number,
        kind: "lamp",
        of_kind: number + 1,
        control: None,
        shows: if number == 3 {
            "on".to_owned()
        } else {
            String::new()
        },
        ..OutputView::default()
    };
    dials.outputs = (0..20).map(lamp).collect();
    let mut faders = device(
        "nanokontrol2",
        "Korg nanoKONTROL2",
        DeviceHealth::Present,
        controls("fader", 8, 1)
            .chain(controls("knob", 8, 9))
            .chain(controls("button", 24, 17))
            .collect(),
    );
    (faders.dropped, faders.rejected) = (3, 1);
    Snapshot {
        devices: vec![
            dials,
            device(
                "pth-660",
                "Wacom Intuos Pro M",
                DeviceHealth::Held {
                    driver: "hid-wacom".into(),
                },
                Vec::new(),
            ),
            faders,
            device(
                "spacemouse",
                "3Dconnexion SpaceNavigator",
                DeviceHealth::Present,
                controls("axis", 6, 1).chain(controls("button", 2, 7)).collect(),
            ),
            device(
                "hs610",
                "Huion HS610",
                DeviceHealth::Forbidden { rule: rule.into() },
                Vec::new(),
            ),
            device(
                "powermate",
                "Griffin PowerMate",
                DeviceHealth::Lost,
                controls("dial", 1, 1).collect(),
            ),
        ],
        ..walker::posing()
    }
}

pub(crate) fn board(
    seen: Snapshot,
    chosen: Option<&str>,
    size: [f32; 2],
    card: bool,
) -> egui_kittest::Harness<'static, Bench> {
    let mut harness = harness(seen, size, card);
    let choices = harness.state_mut().studio.choices();
    choices.board = Board::Controls;
    choices.device = chosen.map(str::to_owned);
    harness.run_steps(3);
    harness
}

pub(crate) fn drawn(seen: Snapshot, chosen: Option<&str>, size: [f32; 2], name: &str) -> Picture {
    let mut harness = board(seen, chosen, size, true);
    let image = harness.render().expect("the adapter that started also draws");
    let picture = Picture {
        width: image.width(),
        height: image.height(),
        rgba: image.into_raw(),
    };
    keep(&picture, &format!("controls-{name}-{}.png", size[0]));
    picture
}

#[test]
fn every_device_has_a_picture() {
    if no_card() {
        return;
    }
    for size in [[1280.0, 720.0], [1920.0, 1080.0]] {
        for name in [
            "dial-box",
            "nanokontrol2",
            "spacemouse",
            "hs610",
            "pth-660",
            "powermate",
        ] {
            let picture = drawn(six(), Some(name), size, name);
            assert!(
                picture.rgba.chunks_exact(4).any(|p| p[0] > 200),
                "{name} shows nothing"
            );
        }
    }
    let mut learning = six();
    learning.learning = Some(LearningView {
        control: Some(("nanokontrol2".to_owned(), 3)),
        parameter: None,
    });
    drawn(learning, Some("nanokontrol2"), [1280.0, 720.0], "learning");
}

#[test]
fn the_device_in_need_of_help_comes_first() {
    let harness = board(six(), None, [1280.0, 720.0], false);
    assert!(
        harness.query_by_label("copy the rule").is_none(),
        "the tablet held by a driver is before it"
    );
    let harness = board(six(), Some("hs610"), [1280.0, 720.0], false);
    assert!(harness.query_by_label("copy the rule").is_some());
}

#[test]
fn a_click_on_a_control_stands_for_touching_it() {
    let mut harness = board(six(), Some("dial-box"), [1280.0, 720.0], false);
    harness.get_by_label("dial 3 of dial-box").click();
    harness.run_steps(2);
    let touched = Command::Learn(LearnCommand::Control {
        device: "dial-box".into(),
        control: 3,
    });
    assert!(
        harness.state().said.contains(&touched),
        "{:?}",
        harness.state().said
    );
}

#[test]
fn a_label_is_written_by_typing() {
    let mut harness = board(six(), Some("dial-box"), [1280.0, 720.0], false);
    harness.get_by_label("label of dial 2 of dial-box").click();
    harness.run_steps(3);
    harness.event(egui::Event::Text("Elbow".to_owned()));
    harness.run_steps(2);
    harness.key_press(egui::Key::Enter);
    harness.run_steps(2);
    let written = Command::SetControlLabel {
        device: "dial-box".into(),
        control: 2,
        text: "Elbow".into(),
    };
    assert!(
        harness.state().said.contains(&written),
        "{:?}",
        harness.state().said
    );
}

#[test]
fn keys_alone_write_a_label_and_try_an_output() {
    let mut harness = board(six(), Some("dial-box"), [1280.0, 720.0], false);
    harness.get_by_label("label of dial 2 of dial-box").focus();
    harness.run_steps(2);
    harness.key_press(egui::Key::Enter);
    harness.run_steps(3);
    assert!(
        !harness
            .state()
            .said
            .iter()
            .any(|it| matches!(it, Command::SetControlLabel { .. }))
    );
    harness.event(egui::Event::Text("Elbow".to_owned()));
    harness.run_steps(2);
    harness.key_press(egui::Key::Enter);
    harness.run_steps(2);
    harness.get_by_label("try lamp 2 of dial-box").focus();
    harness.run_steps(2);
    harness.key_press(egui::Key::Enter);
    harness.run_steps(2);
    let written = Command::SetControlLabel {
        device: "dial-box".into(),
        control: 2,
        text: "Elbow".into(),
    };
    let tried = Command::TestOutput {
        device: "dial-box".into(),
        output: 1,
    };
    let said = &harness.state().said;
    assert!(said.contains(&written) && said.contains(&tried), "{said:?}");
}

#[test]
fn the_tab_key_gets_to_controls_that_are_scrolled_away() {
    let mut harness = board(six(), Some("nanokontrol2"), [1280.0, 720.0], false);
    assert!(
        harness.query_by_label("button 24 of nanokontrol2").is_none(),
        "it is far below"
    );
    for _ in 0..200 {
        harness.key_press(egui::Key::Tab);
        harness.run_steps(2);
        let there = harness.query_by_label("button 24 of nanokontrol2");
        if there.is_some_and(|node| node.accesskit_node().is_focused()) {
            return;
        }
    }
    panic!("the last control is out of reach of the keys");
}

#[test]
fn ten_devices_fit_on_a_small_and_on_a_fine_screen() {
    if no_card() {
        return;
    }
    for scale in [1.0, 2.0] {
        let mut seen = six();
        for nth in 2..6 {
            let slot = DeviceView {
                slot: nth,
                ..device(
                    &format!("powermate{nth}"),
                    "Griffin PowerMate",
                    DeviceHealth::Present,
                    controls("dial", 1, 1).collect(),
                )
            };
            seen.devices.push(slot);
        }
        let mut harness = at_scale(seen, [1280.0, 800.0], true, scale);
        let choices = harness.state_mut().studio.choices();
        choices.board = Board::Controls;
        choices.device = Some("nanokontrol2".to_owned());
        harness.run_steps(3);
        let image = harness.render().expect("the adapter that started also draws");
        let picture = Picture {
            width: image.width(),
            height: image.height(),
            rgba: image.into_raw(),
        };
        assert_eq!(picture.width, (1280.0 * scale) as u32);
        keep(&picture, &format!("controls-ten-at-{scale}.png"));
    }
}

#[test]
fn an_output_is_tried_and_a_card_chooses() {
    let mut harness = board(six(), Some("dial-box"), [1920.0, 1080.0], false);
    harness.get_by_label("try lamp 4 of dial-box").click();
    harness.run_steps(2);
    let tried = Command::TestOutput {
        device: "dial-box".into(),
        output: 3,
    };
    assert!(
        harness.state().said.contains(&tried),
        "{:?}",
        harness.state().said
    );
    harness.get_by_label("controls of Huion HS610").click();
    harness.run_steps(2);
    assert_eq!(
        harness.state_mut().studio.choices().device.as_deref(),
        Some("hs610")
    );
}
