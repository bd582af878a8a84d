//! The simulated tablet, heard by a reader that knows the documented packets and nothing else, and by our codec.
//!
//! Source: `docs/protocols/wacom-iv.md`, with the bits of each byte as the Linux driver and xf86-input-wacom read
//! them.

use super::{in_time, pause};
use device::codec::{InputEvent, Tool};
use device::transport::serial;
use device::{Clock, Device, MonotonicClock};
use device_profiles::{InputProfile, Profiles};
use dialrig_tests::simulated::Served;
use firmware_sim::hands::{Hands, Pen, Puck, Touch};
use firmware_sim::{WacomIv, wacom_iv::Model};
use serialport::SerialPort;
use std::io::{Read, Write};
use std::time::Duration;

const BAUD: u32 = 9600;

/// What points at the tablet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum End {
    Pen,
    Eraser,
    Puck,
}

/// One report as anybody would describe it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Seen {
    end: End,
    in_range: bool,
    x: u16,
    y: u16,
    pressure: u16,
    tip: bool,
    /// Side buttons of a pen, or a puck's, bit 0 is button 1.
    buttons: u8,
    wheel: i8,
    /// Of a pen in range, where the tablet says it.
    tilt: Option<[i8; 2]>,
}

/// What is held over the tablet, one after the other.
fn touches(tilt: bool) -> Vec<Touch> {
    let lean = if tilt { [-30, 12] } else { [0, 0] };
    let pen = |x: f64, y: f64| Pen {
        x,
        y,
        tilt_deg: lean,
        ..Pen::default()
    };
    let puck = |x: f64, y: f64| Puck {
        x,
        y,
        ..Puck::default()
    };
    // A puck that lies still is not reported again, so only one with a wheel has a third report.
    let scrolled = (!tilt).then_some(Touch::Puck(Puck {
        buttons: 0b101,
        wheel: -2,
        ..puck(0.5, 0.4)
    }));
    let mut all = vec![
        Touch::Pen(pen(-1.0, 1.0)),
        Touch::Pen(Pen {
            tip: true,
            pressure: 1.0,
            ..pen(0.25, -0.5)
        }),
        Touch::Pen(Pen {
            tip: true,
            pressure: 0.37,
            buttons: 1,
            ..pen(1.0, -1.0)
        }),
        Touch::Away,
        Touch::Pen(Pen {
            eraser: true,
            ..pen(0.1, 0.2)
        }),
        Touch::Pen(Pen {
            eraser: true,
            tip: true,
            pressure: 0.5,
            ..pen(0.1, 0.2)
        }),
        Touch::Away,
        Touch::Puck(puck(0.5, 0.5)),
        Touch::Puck(Puck {
            buttons: 0b101,
            ..puck(0.5, 0.4)
        }),
    ];
    all.extend(scrolled);
    all.push(Touch::Away);
    all
}

/// What each of those is in counts, from the meaning of script coordinates: −1…1 over each side, y up, while the
/// tablet counts from its upper left corner.
fn wanted(profile: &InputProfile) -> Vec<Seen> {
    let [wide, high] = profile.area().counts;
    let tilted = profile.area().tilt();
    let place = |x: f64, y: f64| {
        let count = |share: f64, most: f64| (share * most).round() as u16;
        [
            count(f64::midpoint(x, 1.0), f64::from(wide)),
            count(f64::midpoint(-y, 1.0), f64::from(high)),
        ]
    };
    let mut last = Seen {
        end: End::Pen,
        in_range: false,
        x: 0,
        y: 0,
        pressure: 0,
        tip: false,
        buttons: 0,
        wheel: 0,
        tilt: None,
    };
    let mut seen = Vec::new();
    for touch in touches(tilted) {
        last = match touch {
            Touch::Pen(pen) => {
                let [x, y] = place(pen.x, pen.y);
                let pressure = (pen.pressure * f64::from(profile.area().pressure)).round() as u16;
                // The tablet counts y towards the user.
                let tilt = tilted.then_some([pen.tilt_deg[0], -pen.tilt_deg[1]]);
                let (tip, buttons) = (pen.tip, pen.buttons);
                Seen {
                    end: if pen.eraser { End::Eraser } else { End::Pen },
                    in_range: true,
                    x,
                    y,
                    pressure,
                    tip,
                    buttons,
                    wheel: 0,
                    tilt,
                }
            }
            Touch::Puck(puck) => {
                let [x, y] = place(puck.x, puck.y);
                let (buttons, wheel) = (puck.buttons, puck.wheel as i8);
                let (end, pressure, tip) = (End::Puck, 0, false);
                Seen {
                    end,
                    in_range: true,
                    x,
                    y,
                    pressure,
                    tip,
                    buttons,
                    wheel,
                    tilt: None,
                }
            }
            _ => gone(last),
        };
        seen.push(last);
    }
    seen
}

/// What has left stands where it was, with nothing pressed.
fn gone(last: Seen) -> Seen {
    Seen {
        in_range: false,
        pressure: 0,
        tip: false,
        buttons: 0,
        wheel: 0,
        tilt: None,
        ..last
    }
}

/// Waits until the set-up has reached the tablet, then does it all.
fn act(served: &Served<WacomIv>, tilt: bool, mut meanwhile: impl FnMut()) {
    in_time("the tablet was told to start", || {
        meanwhile();
        served.with(|tablet, _| tablet.reporting_since_us().is_some())
    });
    for touch in touches(tilt) {
        assert!(
            served.with(|tablet, now_us| tablet.touch(now_us, &touch)),
            "{touch:?}"
        );
        // Two packets of nine bytes at a millisecond each: nothing is merged.
        pause(25);
    }
}

/// A program of its own: a serial port and the documented packets.
struct Reader {
    port: Box<dyn SerialPort>,
    /// Bytes of a packet: seven, or nine with tilt.
    length: usize,
    /// Bits of pressure beyond the seven of the last byte.
    extra_bits: u32,
    /// The bit of byte 3's buttons that an eraser sets.
    eraser_bit: u8,
    packet: Vec<u8>,
    /// Whether the tool that is in range came as an eraser.
    eraser: bool,
    last: Option<Seen>,
    seen: Vec<Seen>,
}

impl Reader {
    fn open(path: &str, profile: &InputProfile) -> Self {
        let port = serialport::new(path, BAUD)
            .timeout(Duration::from_millis(120))
            .open();
        Self {
            port: port.expect("the terminal opens"),
            length: if profile.area().tilt() { 9 } else { 7 },
            extra_bits: if profile.area().pressure > 255 { 2 } else { 1 },
            eraser_bit: profile.wacom.as_ref().map_or(0, |w| w.eraser_bit),
            packet: Vec::new(),
            eraser: false,
            last: None,
            seen: Vec::new(),
        }
    }

    fn send(&mut self, text: &str) {
        self.port.write_all(text.as_bytes()).expect("the tablet is there");
    }

    /// Sends a question and reads its answer to the return; again, if the tablet was still deaf from its reset.
    fn ask(&mut self, question: &str) -> String {
        let mut answer = Vec::new();
        let mut byte = [0; 1];
        in_time("the answer ends", || {
            answer.clear();
            self.send(question);
            while !answer.ends_with(b"\r") && self.port.read(&mut byte).is_ok_and(|count| count == 1) {
                answer.push(byte[0]);
            }
            answer.ends_with(b"\r")
        });
        // A second answer to a question that was asked twice.
        while self.port.read(&mut byte).is_ok_and(|count| count == 1) {}
        String::from_utf8(answer).expect("answers are ASCII")
    }

    fn set_up(&mut self, tilt: bool) {
        self.send("\r#");
        pause(200);
        for command in ["MU1\r", "OC1\r", "~M0\r", "IT0\r", "IN0\r", "SR\r", "ZF1\r"] {
            self.send(command);
        }
        if tilt {
            self.send("FM1\r");
        }
        self.send("ST\r");
        pause(60);
    }

    fn listen(&mut self) {
        let mut bytes = [0; 64];
        let Ok(count) = self.port.read(&mut bytes) else {
            return;
        };
        for &byte in &bytes[..count] {
            if byte & 0x80 != 0 {
                assert!(self.packet.is_empty(), "cut short: {:02x?}", self.packet);
            }
            self.packet.push(byte);
            if self.packet.len() == self.length {
                let packet = std::mem::take(&mut self.packet);
                self.read(&packet);
            }
        }
    }

    fn read(&mut self, packet: &[u8]) {
        let wide = |at: usize| u16::from(packet[at]);
        let in_range = packet[0] & 0x40 != 0;
        if !in_range {
            // Where a tool that has left stands is not said.
            let gone = gone(self.last.expect("it came"));
            self.eraser = false;
            self.last = Some(gone);
            return self.seen.push(gone);
        }
        let pen = packet[0] & 0x20 != 0;
        let raw = packet[3] >> 3 & 0x0F;
        assert_eq!(
            packet[0] & 0x08 != 0,
            raw != 0,
            "the bit for any button: {packet:02x?}"
        );
        let came = self.last.is_none_or(|last| !last.in_range);
        if came {
            self.eraser = pen && raw >> self.eraser_bit & 1 == 1;
        }
        let last_byte = wide(6);
        let high = (last_byte & 0x7F) ^ 0x40;
        let [middle, low] = [wide(3) >> 2 & 1, wide(0) >> 2 & 1];
        let pressure = if self.extra_bits == 2 {
            high << 2 | middle << 1 | low
        } else {
            high << 1 | middle
        };
        let clicks = (last_byte >> 4 & 3) as i8;
        let lean = |at: usize| ((packet[at] << 1) as i8) >> 1;
        let seen = Seen {
            end: match (pen, self.eraser) {
                (true, false) => End::Pen,
                (true, true) => End::Eraser,
                (false, _) => End::Puck,
            },
            in_range,
            x: (wide(0) & 3) << 14 | wide(1) << 7 | wide(2),
            y: (wide(3) & 3) << 14 | wide(4) << 7 | wide(5),
            pressure: if pen { pressure } else { 0 },
            tip: pen && raw & 1 == 1,
            buttons: if pen {
                raw >> 1 & 3 & !(u8::from(self.eraser) << (self.eraser_bit - 1))
            } else {
                raw
            },
            wheel: if pen {
                0
            } else if last_byte & 0x40 != 0 {
                -clicks
            } else {
                clicks
            },
            tilt: (pen && self.length == 9).then(|| [lean(7), lean(8)]),
        };
        self.last = Some(seen);
        self.seen.push(seen);
    }
}

fn tablet(key: &str) -> (InputProfile, Served<WacomIv>) {
    let profiles = Profiles::builtin();
    let profile = profiles.input(key).expect("it is built in").clone();
    let served = Served::start(WacomIv::new(Model::from(&profile), 0)).expect("a pseudo-terminal");
    (profile, served)
}

#[test]
fn a_reader_of_the_documented_packets_sees_every_touch() {
    for key in ["graphire-serial", "digitizer-ii"] {
        let (profile, served) = tablet(key);
        let mut reader = Reader::open(&served.path_text(), &profile);
        reader.send("\r#");
        pause(200);
        let model = reader.ask("~#");
        assert!(
            model.starts_with("~#") && model[2..].starts_with(profile.answer_prefix()),
            "{model}"
        );
        if profile.wacom.as_ref().is_some_and(|w| w.answers_size) {
            let [x, y] = profile.area().counts;
            assert_eq!(reader.ask("~C\r"), format!("~C{x:05},{y:05}\r"));
            let fine = reader.ask("~R\r");
            let [across, up] = profile.area().counts_per_inch.expect("it is said");
            assert!(
                fine.starts_with("~R") && fine.ends_with(&format!(",{across},{up}\r")),
                "{fine}"
            );
        }
        reader.set_up(profile.area().tilt());
        act(&served, profile.area().tilt(), || ());
        let wanted = wanted(&profile);
        in_time("all packets have come", || {
            reader.listen();
            // Reporting that begins while a tool is there reports it again.
            reader.seen.dedup();
            reader.seen.len() >= wanted.len()
        });
        assert_eq!(reader.seen, wanted, "{key}");
        assert_eq!(served.with(|tablet, _| tablet.unknown_commands()), 0, "{key}");
    }
}

#[test]
fn our_codec_sees_the_same() {
    for key in ["graphire-serial", "digitizer-ii"] {
        let (profile, served) = tablet(key);
        let line = serial::open(&served.path_text(), BAUD).expect("the terminal opens");
        let mut device = Device::of_profile("tablet", &profile, Box::new(line)).expect("its format is known");
        let clock = MonotonicClock::new();
        let mut seen = Vec::new();
        let listen = |device: &mut Device, seen: &mut Vec<Seen>| {
            let mut events = Vec::new();
            device.wait(&clock, clock.now().after(Duration::from_millis(5)));
            device.poll(clock.now(), &mut events);
            for event in events {
                if let InputEvent::Pen(sample) = event.what {
                    seen.push(Seen {
                        end: match sample.tool {
                            Tool::Pen => End::Pen,
                            Tool::Eraser => End::Eraser,
                            Tool::Puck | Tool::Mouse => End::Puck,
                        },
                        in_range: sample.in_range,
                        x: sample.x_counts as u16,
                        y: sample.y_counts as u16,
                        pressure: sample.pressure_counts as u16,
                        tip: sample.tip,
                        buttons: sample.buttons as u8,
                        wheel: sample.wheel as i8,
                        tilt: sample.tilt.map(|tilt| tilt.map(|steps| steps as i8)),
                    });
                }
            }
        };
        // Resets at three speeds and all questions take some two seconds.
        in_time("the tablet has answered", || {
            for _ in 0..10 {
                listen(&mut device, &mut seen);
            }
            device.started()
        });
        act(&served, profile.area().tilt(), || listen(&mut device, &mut seen));
        let wanted = wanted(&profile);
        in_time("all packets have come", || {
            listen(&mut device, &mut seen);
            seen.dedup();
            seen.len() >= wanted.len()
        });
        assert_eq!(seen, wanted, "{key}");
    }
}
