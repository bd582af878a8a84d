//! The desk: what dials, keys and tablet say becomes tokens of the network's device instances.
//!
//! Scaling follows `docs/ps300/functions.md`: a dial sends 1.0 for a full turn, clockwise positive; the tablet
//! sends −1…1 on its longer side, the shorter one centred with the aspect kept, y up.

use device::codec::{InputEvent, Surface};
use ps300::machine::Panel;
use ps300::value::Value;

use crate::controls::tablet::Tablet;
use crate::controls_calibration::TabletMapping;
use crate::snapshot::DeskView;

/// How long a dial is drawn as live after it moved, seconds.
const LIVE_SECS: f64 = 0.5;

/// Outputs of TABLETIN.
const TABLETIN_OUTPUTS: u8 = 6;

/// Where a token goes: device instance, output, value.
pub(crate) type Emit<'a> = dyn FnMut(&'static str, u8, Value) + 'a;

/// What is known about the device an event is from.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Source {
    /// Counts of a dial's full turn.
    pub(crate) counts_per_turn: f64,
    /// The tablet's area, if it is one.
    pub(crate) surface: Option<Surface>,
}

/// State of the desk.
#[derive(Debug, Default)]
pub(crate) struct Desk {
    view: DeskView,
    moved_at_secs: [Option<f64>; 8],
    tablet: Tablet,
}

impl Desk {
    /// Turns one event into tokens, in the order the original's outputs would have sent them.
    pub(crate) fn hear(&mut self, event: &InputEvent, source: Source, now_secs: f64, emit: &mut Emit<'_>) {
        match event {
            InputEvent::Dial {
                control,
                delta_counts,
            } => {
                let turns = f64::from(*delta_counts) / source.counts_per_turn;
                if let (Some(dial), Some(moved)) = (
                    self.view.dials.get_mut(usize::from(*control)),
                    self.moved_at_secs.get_mut(usize::from(*control)),
                ) {
                    dial.turns += turns;
                    *moved = Some(now_secs);
                    emit("DIALS", *control as u8 + 1, Value::Real(turns));
                }
            }
            InputEvent::Button { control, down } => {
                let number = i32::from(*control) + 1;
                if let Some(key) = self.view.keys.get_mut(usize::from(*control)) {
                    key.down = *down;
                    if *down {
                        emit("FKEYS", 1, Value::Integer(number));
                    }
                }
                if *down {
                    emit("BUTTONSIN", 1, Value::Integer(number));
                }
            }
            InputEvent::Pen(sample) => {
                let Some(surface) = source.surface else { return };
                self.tablet.hear(sample, surface, &mut |output, value| {
                    tabletin(emit, output, value);
                });
            }
            // Of the rest the original's devices have nothing.
            InputEvent::Started
            | InputEvent::Restarted
            | InputEvent::Moved { .. }
            | InputEvent::Touch { .. }
            | InputEvent::Axis { .. }
            | InputEvent::AxisTouched { .. }
            | InputEvent::Ring { .. } => {}
        }
    }

    /// The tablet takes another mapping.
    pub(crate) fn calibrate(&mut self, mapping: Option<&TabletMapping>, emit: &mut Emit<'_>) {
        self.tablet.calibrate(mapping, &mut |output, value| {
            tabletin(emit, output, value);
        });
    }

    /// The tablet begins or ends being calibrated.
    pub(crate) fn mute(&mut self, on: bool, emit: &mut Emit<'_>) {
        self.tablet.mute(on, &mut |output, value| {
            tabletin(emit, output, value);
        });
    }

    /// The tablet is gone.
    pub(crate) fn gone(&mut self) {
        self.tablet.gone();
    }

    /// The desk as it looks now: labels and lamps are the network's.
    pub(crate) fn view(&self, panel: &Panel, now_secs: f64, simulated_device: Option<String>) -> DeskView {
        let mut view = self.view.clone();
        for (index, dial) in view.dials.iter_mut().enumerate() {
            dial.live = self.moved_at_secs[index].is_some_and(|at| now_secs - at < LIVE_SECS);
            dial.label.clone_from(&panel.dial_labels[index]);
        }
        for (index, key) in view.keys.iter_mut().enumerate() {
            key.lit = panel.lamps & (1 << index) != 0;
            key.label.clone_from(&panel.key_labels[index]);
        }
        view.simulated_device = simulated_device;
        view
    }
}

/// TABLETIN has but the first outputs of a surface.
fn tabletin(emit: &mut Emit<'_>, output: u8, value: Value) {
    if output <= TABLETIN_OUTPUTS {
        emit("TABLETIN", output, value);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use device::codec::{PenSample, Tool};

    const SURFACE: Surface = Surface::flat([4000, 2000], [1000.0, 1000.0], 255);
    const SOURCE: Source = Source {
        counts_per_turn: 200.0,
        surface: Some(SURFACE),
    };

    fn puck(x_counts: u32, y_counts: u32, buttons: u32, in_range: bool) -> InputEvent {
        InputEvent::Pen(PenSample {
            buttons,
            in_range,
            ..PenSample::hovering(Tool::Puck, x_counts, y_counts)
        })
    }

    fn heard(desk: &mut Desk, events: &[InputEvent]) -> Vec<String> {
        let mut tokens = Vec::new();
        for event in events {
            desk.hear(event, SOURCE, 0.0, &mut |name, port, value| {
                tokens.push(format!("{name}<{port}> {value:?}"));
            });
        }
        tokens
    }

    #[test]
    fn a_dial_sends_turns() {
        let mut desk = Desk::default();
        let tokens = heard(
            &mut desk,
            &[InputEvent::Dial {
                control: 2,
                delta_counts: -50,
            }],
        );
        assert_eq!(tokens, ["DIALS<3> Real(-0.25)"]);
        let at = |secs: f64| desk.view(&Panel::default(), secs, None).dials[2].clone();
        assert_eq!(at(0.4).turns, -0.25);
        assert!(at(0.4).live && !at(0.6).live);
    }

    #[test]
    fn a_key_sends_its_number_once() {
        let mut desk = Desk::default();
        let tokens = heard(
            &mut desk,
            &[
                InputEvent::Button {
                    control: 3,
                    down: true,
                },
                InputEvent::Button {
                    control: 3,
                    down: false,
                },
                InputEvent::Button {
                    control: 20,
                    down: true,
                },
            ],
        );
        assert_eq!(
            tokens,
            [
                "FKEYS<1> Integer(4)",
                "BUTTONSIN<1> Integer(4)",
                "BUTTONSIN<1> Integer(21)"
            ]
        );
    }

    #[test]
    fn the_puck_presses_and_leaves() {
        let mut desk = Desk::default();
        let tokens = heard(
            &mut desk,
            &[
                puck(4000, 0, 0, true),
                puck(4000, 0, 2, true),
                puck(2000, 1000, 0, true),
                puck(2000, 1000, 0, false),
            ],
        );
        let corner = "Vector2(DVec2(1.0, 0.5))";
        assert_eq!(
            tokens,
            [
                "TABLETIN<5> Boolean(true)".to_owned(),
                format!("TABLETIN<1> {corner}"),
                format!("TABLETIN<1> {corner}"),
                "TABLETIN<2> Boolean(true)".to_owned(),
                "TABLETIN<3> Integer(2)".to_owned(),
                format!("TABLETIN<6> {corner}"),
                "TABLETIN<1> Vector2(DVec2(0.0, 0.0))".to_owned(),
                "TABLETIN<2> Boolean(false)".to_owned(),
                "TABLETIN<3> Integer(0)".to_owned(),
                "TABLETIN<5> Boolean(false)".to_owned(),
            ]
        );
    }

    #[test]
    fn labels_and_lamps_are_the_networks() {
        let mut panel = Panel::default();
        panel.dial_labels[1] = "Tilt".into();
        panel.lamps = 2;
        let view = Desk::default().view(&panel, 0.0, None);
        assert_eq!(view.dials[1].label, "Tilt");
        assert!(view.keys[1].lit && !view.keys[0].lit);
    }
}
