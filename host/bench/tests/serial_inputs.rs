//! Codecs of serial input devices against their simulated firmware, which was written from the same pages by others:
//! from the opening of the port to hands, in virtual time.

use device::Instant;
use device::codec::{Codec, InputEvent, Outgoing, PenSample, Stand, Step, Tool, of_profile};
use device_profiles::Profiles;
use firmware_sim::hands::{Held, Pen, Puck, Touch, Turn};
use firmware_sim::{SerialDevice, serial_device};
use std::time::Duration;

/// Longest time a device may need from the opening of its port: boards boot, tablets are reset at three speeds.
const START_MS: u64 = 8_000;

/// A codec and the device it talks to, looked at every millisecond.
struct Line {
    codec: Box<dyn Codec>,
    far: Box<dyn SerialDevice>,
    now_us: u64,
    events: Vec<InputEvent>,
}

impl Line {
    /// The port of the device is opened, and it is waited for.
    fn open(key: &str) -> Self {
        let profiles = Profiles::builtin();
        let profile = profiles.input(key).expect("it is built in");
        let mut far = serial_device(profile).expect("it is simulated");
        let (baud, parity) = far.line();
        far.set_line_baud(0, baud);
        far.set_line_parity(0, parity);
        far.port_opened(0);
        let mut line = Self {
            codec: of_profile(profile, Stand::Unasked).expect("its format is known"),
            far,
            now_us: 0,
            events: Vec::new(),
        };
        let mut out = Outgoing::new();
        line.codec.start(Instant::ZERO, &mut out);
        line.send(out);
        line.wait_for(START_MS, |event| *event == InputEvent::Started);
        line
    }

    fn send(&mut self, mut out: Outgoing) {
        for step in out.drain() {
            match step {
                Step::Bytes(bytes) => self.far.receive(self.now_us, &bytes),
                Step::Baud(baud) => self.far.set_line_baud(self.now_us, baud),
                other => panic!("no serial device understands {other:?}"),
            }
        }
    }

    fn run(&mut self, ms: u64) {
        for _ in 0..ms {
            self.now_us += 1_000;
            let mut bytes = Vec::new();
            self.far.transmit(self.now_us, &mut bytes);
            let now = Instant::ZERO.after(Duration::from_micros(self.now_us));
            let events = &mut self.events;
            self.codec.decode(&bytes, &mut |event| events.push(event));
            let mut out = Outgoing::new();
            self.codec.advance(now, &mut out, &mut |event| events.push(event));
            self.send(out);
        }
    }

    fn wait_for(&mut self, limit_ms: u64, wanted: impl Fn(&InputEvent) -> bool) {
        for _ in 0..limit_ms {
            self.run(1);
            if self.events.iter().any(&wanted) {
                return;
            }
        }
        panic!("not within {limit_ms} ms; heard: {:?}", self.events);
    }

    /// What a touch makes of it.
    fn touch(&mut self, touch: &Touch) -> Vec<InputEvent> {
        self.run(100);
        self.events.clear();
        assert!(self.far.touch(self.now_us, touch), "{touch:?}");
        self.run(200);
        std::mem::take(&mut self.events)
    }

    /// The last sample after a touch.
    fn sample(&mut self, touch: &Touch) -> PenSample {
        let mut samples = self.touch(touch).into_iter().filter_map(|event| match event {
            InputEvent::Pen(sample) => Some(sample),
            _ => None,
        });
        samples.next_back().expect("the tablet tells of it")
    }
}

fn near(value: u32, wanted: u32) -> bool {
    value.abs_diff(wanted) <= 1
}

#[test]
fn an_intuos_tells_two_tools_apart() {
    for key in ["intuos-serial", "intuos2-serial"] {
        let mut line = Line::open(key);
        let [right, bottom] = line.codec.surface().expect("a tablet has one").max_counts;
        let pen = line.sample(&Touch::Pen(Pen {
            pressure: 0.5,
            tip: true,
            buttons: 1,
            tilt_deg: [10, -20],
            ..Pen::default()
        }));
        assert_eq!((pen.tool, pen.tip, pen.buttons), (Tool::Pen, true, 1), "{key}");
        assert!(
            near(pen.x_counts, right / 2) && near(pen.y_counts, bottom / 2),
            "{pen:?}"
        );
        assert!(near(pen.pressure_counts, 512), "{pen:?}");
        let number = pen.tool_serial.expect("each tool has a number");
        line.run(100);
        line.events.clear();
        let corner = Puck {
            x: 1.0,
            y: 1.0,
            ..Puck::default()
        };
        let told = line.touch(&Touch::Puck(corner));
        let puck = told.iter().rev().find_map(|event| match event {
            InputEvent::Pen(sample) if sample.tool_serial != Some(number) => Some(*sample),
            _ => None,
        });
        let puck = puck.expect("the other tool is told");
        assert!(matches!(puck.tool, Tool::Puck | Tool::Mouse), "{puck:?}");
        assert!(near(puck.x_counts, right) && near(puck.y_counts, 0), "{puck:?}");
        let gone = line.touch(&Touch::Lift(Held::Puck));
        assert!(gone.contains(&InputEvent::Pen(puck.leaving())), "{gone:?}");
        assert!(
            !gone.contains(&InputEvent::Pen(pen.leaving())),
            "the pen is still there"
        );
        let gone = line.touch(&Touch::Away);
        let left = |event: &InputEvent| matches!(event, InputEvent::Pen(sample) if sample.tool_serial == Some(number) && !sample.in_range);
        assert!(gone.iter().any(left), "{gone:?}");
    }
}

#[test]
fn summagraphics_tablets_tell_places_and_moves() {
    for key in ["summasketch", "mm961"] {
        let mut line = Line::open(key);
        let max = line.codec.surface().expect("a tablet has one").max_counts;
        let puck = |x, y, buttons| {
            Touch::Puck(Puck {
                x,
                y,
                buttons,
                ..Puck::default()
            })
        };
        for (x, y, buttons, want) in [
            (-1.0, 1.0, 0, [0, 0]),
            (1.0, -1.0, 1, max),
            (0.0, 0.0, 0b1000, max.map(|most| most / 2)),
        ] {
            let got = line.sample(&puck(x, y, buttons));
            let there = near(got.x_counts, want[0]) && near(got.y_counts, want[1]);
            assert!(there && got.buttons == u32::from(buttons), "{key}: {got:?}");
        }
        assert!(!line.sample(&Touch::Away).in_range);
        assert_eq!(line.codec.counters().rejected, 0, "odd parity is kept");
    }
    let mut line = Line::open("summa-relative");
    line.touch(&Touch::Puck(Puck::default()));
    let moved = line.touch(&Touch::Puck(Puck {
        x: 0.05,
        y: 0.05,
        ..Puck::default()
    }));
    let sum = moved.iter().fold([0, 0], |[x, y], event| match event {
        InputEvent::Moved { dx, dy, .. } => [x + dx, y + dy],
        _ => [x, y],
    });
    assert!(sum[0] > 200 && sum[1] < -200, "right and away: {sum:?}");
}

#[test]
fn boards_tell_their_controls_and_come_back_from_a_restart() {
    let mut line = Line::open("deej");
    let told = line.touch(&Touch::Axis {
        control: 2,
        to: 1.0,
        over_us: 0,
    });
    let full = InputEvent::Axis {
        control: 2,
        value: 1023,
    };
    assert_eq!(told, [full], "and no noise of the others");

    let mut line = Line::open("firmata");
    let told = line.touch(&Touch::Dial {
        control: 1,
        by: Turn::Counts(-5),
        over_us: 0,
    });
    let turned = InputEvent::Dial {
        control: 1,
        delta_counts: -5,
    };
    assert_eq!(told, [turned]);
    let button = |down| InputEvent::Button { control: 3, down };
    let press = |down| Touch::Button { control: 3, down };
    assert_eq!(line.touch(&press(true)), [button(true)]);
    line.events.clear();
    line.far.touch(line.now_us, &Touch::PowerCycle);
    line.wait_for(START_MS, |event| *event == InputEvent::Restarted);
    assert!(line.events.contains(&button(false)), "what was held is let go");
}
