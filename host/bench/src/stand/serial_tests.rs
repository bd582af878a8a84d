//! Devices on serial lines: the host's own codecs against the simulated firmware, which was written apart from them,
//! through the ports the rig uses, in virtual time.

use super::{SimPorts, Stand};
use device::clock::{Clock, VirtualClock};
use device::codec::PenSample;
use device::{Device, Health, InputEvent, Tool};
use device_profiles::Profiles;
use firmware_sim::hands::{Puck, Touch, Turn};
use rig::Ports;
use std::sync::{Arc, LazyLock};
use std::time::Duration;

static PROFILES: LazyLock<Profiles> = LazyLock::new(Profiles::builtin);
const STEP: Duration = Duration::from_millis(2);

struct Table {
    clock: Arc<VirtualClock>,
    stand: Stand,
    ports: SimPorts,
    device: Device,
    events: Vec<InputEvent>,
}

impl Table {
    fn new(kind: &str) -> Self {
        let clock = Arc::new(VirtualClock::new());
        let profile = PROFILES.input(kind).expect("shipped");
        let stand = Stand::builder(Arc::clone(&clock) as Arc<dyn Clock>)
            .input("it", profile)
            .expect("simulated")
            .build();
        let mut ports = SimPorts::new(stand.clone());
        let line = ports
            .open_input("sim:it", profile.line.as_ref())
            .expect("it is there");
        let device = Device::of_profile("it", profile, line).expect("its format is known");
        Self {
            clock,
            stand,
            ports,
            device,
            events: Vec::new(),
        }
    }

    fn started(kind: &str) -> Self {
        let mut table = Self::new(kind);
        assert_eq!(
            table.pass(12.0),
            Health::Present,
            "{kind}: {:?}",
            table.device.counters()
        );
        assert!(table.events.contains(&InputEvent::Started), "{kind}");
        table.events.clear();
        table
    }

    fn pass(&mut self, secs: f64) -> Health {
        let until = self.clock.now().after(Duration::from_secs_f64(secs));
        let mut health = Health::Lost;
        while self.clock.now() < until {
            self.clock.advance(STEP);
            let mut events = Vec::new();
            health = self.device.poll(self.clock.now(), &mut events);
            self.events.extend(events.into_iter().map(|event| event.what));
        }
        health
    }

    /// What comes of a touch within a fifth of a second.
    fn touch(&mut self, touch: &Touch) -> Vec<InputEvent> {
        self.events.clear();
        self.stand.touch("it", touch).expect("it has such a control");
        self.pass(0.2);
        std::mem::take(&mut self.events)
    }

    fn samples(&mut self, touch: &Touch) -> Vec<PenSample> {
        let samples = self.touch(touch).into_iter().filter_map(|event| match event {
            InputEvent::Pen(sample) => Some(sample),
            _ => None,
        });
        samples.collect()
    }
}

fn puck(x: f64, y: f64, buttons: u8) -> Touch {
    Touch::Puck(Puck {
        x,
        y,
        buttons,
        ..Puck::default()
    })
}

#[test]
fn an_mm_tablet_is_woken_asked_for_its_size_and_read() {
    let mut table = Table::started("summasketch");
    let area = table.device.surface().expect("a tablet");
    let last = *table.samples(&puck(1.0, 1.0, 0b10)).last().expect("laid down");
    assert_eq!((last.x_counts, last.y_counts), (area.max_counts[0], 0));
    assert_eq!((last.tool, last.buttons), (Tool::Puck, 0b10));
    let last = *table.samples(&puck(-1.0, -1.0, 0)).last().expect("moved");
    assert_eq!(
        (last.x_counts, last.y_counts, last.buttons),
        (0, area.max_counts[1], 0)
    );
    let gone = table.samples(&Touch::Away);
    assert!(gone.last().is_some_and(|sample| !sample.in_range));
}

#[test]
fn deej_pots_are_read_whatever_the_line_says_at_first() {
    let mut table = Table::started("deej");
    table.pass(0.5);
    let moved = table.touch(&Touch::Axis {
        control: 3,
        to: 1.0,
        over_us: 0,
    });
    let value = moved.iter().rev().find_map(|event| match event {
        InputEvent::Axis { control: 3, value } => Some(*value),
        _ => None,
    });
    assert!(value.is_some_and(|value| value >= 1020), "{moved:?}");
    // Nonsense between two lines loses at most those lines.
    table.touch(&Touch::Noise(40));
    let back = table.touch(&Touch::Axis {
        control: 3,
        to: 0.0,
        over_us: 0,
    });
    assert!(
        back.iter()
            .any(|event| matches!(event, InputEvent::Axis { control: 3, value } if *value <= 3))
    );
}

#[test]
fn a_firmata_board_boots_and_reports_knobs_buttons_and_encoders() {
    let mut table = Table::started("firmata");
    table.pass(0.5);
    let axis = table.touch(&Touch::Axis {
        control: 2,
        to: 0.5,
        over_us: 0,
    });
    assert!(axis.contains(&InputEvent::Axis {
        control: 2,
        value: 512
    }));
    let button = |control, down| Touch::Button { control, down };
    assert_eq!(
        table.touch(&button(1, true)),
        [InputEvent::Button {
            control: 1,
            down: true
        }]
    );
    assert_eq!(
        table.touch(&button(1, false)),
        [InputEvent::Button {
            control: 1,
            down: false
        }]
    );
    let turned = table.touch(&Touch::Dial {
        control: 1,
        by: Turn::Counts(-7),
        over_us: 0,
    });
    let delta: i32 = turned
        .iter()
        .map(|event| match event {
            InputEvent::Dial {
                control: 1,
                delta_counts,
            } => *delta_counts,
            other => panic!("{other:?}"),
        })
        .sum();
    assert_eq!(delta, -7);
}

#[test]
fn the_cable_may_come_out_at_any_step_of_a_beginning() {
    for kind in ["intuos-serial", "summasketch", "deej", "firmata"] {
        for calls in (0..40).step_by(3) {
            let mut table = Table::new(kind);
            table.stand.unplug_after_calls("it", calls).expect("it is there");
            assert_eq!(table.pass(6.0), Health::Lost, "{kind} after {calls} calls");
            table.stand.plug("it", true).expect("it is there");
            let line = table
                .ports
                .open_input("sim:it", PROFILES.input(kind).expect("shipped").line.as_ref())
                .expect("it is back");
            table.device.reconnect(line);
            assert_eq!(table.pass(14.0), Health::Present, "{kind} after {calls} calls");
        }
    }
}
