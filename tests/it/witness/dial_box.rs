//! The simulated dial box, heard by a reader that knows the documented bytes and nothing else, and by our codec.
//!
//! The reader follows what three published programs agree on: initialise, dials by mask, buttons by mask; reports
//! of three bytes for a dial and of one for a button. Source: `docs/protocols/sgi-dial-box.md`.

use super::{in_time, pause};
use device::codec::InputEvent;
use device::transport::serial;
use device::{Clock, Device, Feedback, MonotonicClock};
use device_profiles::Profiles;
use dialrig_tests::simulated::Served;
use firmware_sim::SgiDialBox;
use firmware_sim::dial_box::{Options, Output};
use serialport::SerialPort;
use std::io::{Read, Write};
use std::time::Duration;

const BAUD: u32 = 9600;

/// What hands do while both listen: (dial, counts) and (button, down), in this order.
const TURNS: [(u8, i32); 6] = [(0, 5), (7, -3), (3, 300), (3, -40), (0, 1), (5, -700)];
const PRESSES: [(u8, bool); 6] = [
    (0, true),
    (31, true),
    (0, false),
    (9, true),
    (31, false),
    (9, false),
];

/// Dial and button as they end.
#[derive(Debug, Default, PartialEq, Eq)]
struct Heard {
    turned: [i32; 8],
    pressed: Vec<(u8, bool)>,
}

fn wanted() -> Heard {
    let mut wanted = Heard {
        pressed: PRESSES.to_vec(),
        ..Heard::default()
    };
    for (dial, counts) in TURNS {
        wanted.turned[usize::from(dial)] += counts;
    }
    wanted
}

fn act(served: &Served<SgiDialBox>) {
    for (dial, counts) in TURNS {
        assert!(served.with(|dial_box, now_us| dial_box.turn(now_us, dial, counts, 20_000)));
        pause(8);
    }
    for (button, down) in PRESSES {
        assert!(served.with(|dial_box, now_us| dial_box.press(now_us, button, down)));
        pause(4);
    }
}

/// A program of its own: a serial port and the documented bytes.
struct Reader {
    port: Box<dyn SerialPort>,
    heard: Heard,
    counts: [u16; 8],
    report: Vec<u8>,
}

impl Reader {
    fn open(path: &str) -> Self {
        let port = serialport::new(path, BAUD)
            .timeout(Duration::from_millis(50))
            .open();
        Self {
            port: port.expect("the terminal opens"),
            heard: Heard::default(),
            counts: [0; 8],
            report: Vec::new(),
        }
    }

    fn send(&mut self, bytes: &[u8]) {
        self.port.write_all(bytes).expect("the box is there");
    }

    fn initialise(&mut self) {
        self.send(&[0x20]);
        let mut answer = [0; 1];
        in_time("the box answers 20", || {
            self.port.read(&mut answer).is_ok_and(|count| count == 1)
        });
        assert_eq!(answer, [0x20]);
        self.send(&[0x50, 0x00, 0xFF]);
        for command in [0x71, 0x73] {
            self.send(&[command, 0xFF, 0xFF, 0xFF, 0xFF]);
        }
    }

    fn listen(&mut self) {
        let mut bytes = [0; 64];
        let Ok(count) = self.port.read(&mut bytes) else {
            return;
        };
        for &byte in &bytes[..count] {
            self.report.push(byte);
            match self.report[..] {
                [dial @ 0x30..=0x37, high, low] => {
                    let (at, stands) = (usize::from(dial - 0x30), u16::from(high) << 8 | u16::from(low));
                    let moved = stands.wrapping_sub(self.counts[at]) as i16;
                    self.counts[at] = stands;
                    self.heard.turned[at] += i32::from(moved);
                    self.report.clear();
                }
                [0x30..=0x37] | [0x30..=0x37, _] => {}
                [code] => {
                    self.heard.pressed.push(button(code));
                    self.report.clear();
                }
                _ => panic!("no report: {:02x?}", self.report),
            }
        }
    }
}

/// D8–DF are buttons 0–7 pressed, then D0–D7, C8–CF and C0–C7; bit 5 is set when one is let go.
fn button(code: u8) -> (u8, bool) {
    let pressed = code & !0x20;
    let first = match pressed {
        0xD8..=0xDF => 0xD8,
        0xD0..=0xD7 => 0xD0 - 8,
        0xC8..=0xCF => 0xC8 - 16,
        0xC0..=0xC7 => 0xC0 - 24,
        _ => panic!("{code:02x} is no button"),
    };
    (pressed - first, code & 0x20 == 0)
}

#[test]
fn a_reader_of_the_documented_bytes_hears_every_turn_and_press() {
    let served = Served::start(SgiDialBox::new(Options::default())).expect("a pseudo-terminal");
    let mut reader = Reader::open(&served.path_text());
    reader.initialise();
    // The set-up takes thirteen bytes at a millisecond each.
    pause(40);
    act(&served);
    in_time("everything was heard", || {
        reader.listen();
        reader.heard == wanted()
    });
    reader.send(&[0x75, 0x01, 0x00, 0x00, 0x80]);
    in_time("lamps 0 and 31 are lit", || {
        served.with(|dial_box, _| dial_box.lamps()) == 0x8000_0001
    });
    assert_eq!(served.with(|dial_box, _| dial_box.unknown_bytes()), 0);
}

#[test]
fn our_codec_hears_the_same() {
    let profiles = Profiles::builtin();
    let profile = profiles.input("sgi-dialbox-display").expect("it is built in");
    let served = Served::start(SgiDialBox::new(profile.into())).expect("a pseudo-terminal");
    let line = serial::open(&served.path_text(), BAUD).expect("the terminal opens");
    let mut device = Device::of_profile("box", profile, Box::new(line)).expect("its format is known");
    let clock = MonotonicClock::new();
    let mut heard = Heard::default();
    let listen = |device: &mut Device, heard: &mut Heard| {
        let mut events = Vec::new();
        device.wait(&clock, clock.now().after(Duration::from_millis(5)));
        device.poll(clock.now(), &mut events);
        for event in events {
            match event.what {
                InputEvent::Dial {
                    control,
                    delta_counts,
                } => {
                    heard.turned[usize::from(control)] += delta_counts;
                }
                InputEvent::Button { control, down } => heard.pressed.push((control as u8, down)),
                _ => {}
            }
        }
    };
    in_time("the box has answered", || {
        listen(&mut device, &mut heard);
        device.started()
    });
    let label = Feedback::Label {
        control: 2,
        text: "X-Trans".into(),
    };
    device
        .show(&Feedback::Lamps(0x8000_0001))
        .expect("the box is there");
    device.show(&label).expect("the box is there");
    in_time("the label is shown, and with it everything before", || {
        listen(&mut device, &mut heard);
        let shown =
            |output: &Output| matches!(output, Output::Label { control: 2, text } if text == "X-Trans ");
        served.with(|dial_box, _| dial_box.drain_outputs().any(|(_, output)| shown(&output)))
    });
    assert_eq!(served.with(|dial_box, _| dial_box.lamps()), 0x8000_0001);
    act(&served);
    in_time("everything was heard", || {
        listen(&mut device, &mut heard);
        heard == wanted()
    });
    assert_eq!(served.with(|dial_box, _| dial_box.unknown_bytes()), 0);
}
