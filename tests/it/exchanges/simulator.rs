//! A simulated device played through an exchange: it is given what the host says, and must answer as told.

use device::codec::{Answer, Step};
use device::exchange::{Difference, Exchange, What};
use device_profiles::Profiles;
use firmware_sim::hands::Hands;
use firmware_sim::script::{Device, Script};
use firmware_sim::{SerialDevice, UsbDevice, serial_device, usb_kind};
use std::collections::VecDeque;

/// How long an answer is waited for; the slowest is a tablet that was reset.
const PATIENCE_US: u64 = 3_000_000;
/// How long a device is listened to after the last line.
const AFTERWARDS_US: u64 = 100_000;
/// How often it is looked at.
const LOOK_US: u64 = 250;

/// The far end of the conversation.
enum Far {
    Line(Box<dyn SerialDevice>),
    /// And the interface that is spoken with.
    Usb(Box<dyn UsbDevice>, u8),
}

/// The devices that exchanges may name, and what their hands can do.
fn build(name: &str, exchange: &Exchange, profiles: &Profiles) -> Result<(Far, Device), String> {
    if let Some(kind) = usb_kind(name) {
        let interface = exchange.head.interface.unwrap_or(0);
        let mut device = (kind.make)();
        device.listen(0, interface, true);
        return Ok((Far::Usb(device, interface), kind.controls));
    }
    let described = profiles.input(name).map_err(|error| error.to_string())?;
    let mut line = serial_device(described).ok_or_else(|| format!("nothing like {name} is simulated"))?;
    let controls = line.controls();
    open(line.as_mut(), 0);
    Ok((Far::Line(line), controls))
}

/// The host opens the port as the device begins.
fn open(line: &mut dyn SerialDevice, now_us: u64) {
    let (baud, parity) = line.line();
    line.set_line_baud(now_us, baud);
    line.set_line_parity(now_us, parity);
    line.port_opened(now_us);
}

/// Plays it; gives where the device did otherwise.
pub(super) fn play(exchange: &Exchange, name: &str, profiles: &Profiles) -> Vec<Difference> {
    let (far, hands) = match build(name, exchange, profiles) {
        Ok(built) => built,
        Err(found) => {
            let expected = "a simulated device".to_owned();
            return vec![Difference {
                line: 1,
                expected,
                found,
            }];
        }
    };
    let mut playing = Playing {
        far,
        hands,
        now_us: 0,
        unplugged: false,
        left_by_itself: false,
        bytes: VecDeque::new(),
        reports: VecDeque::new(),
        answers: VecDeque::new(),
        differences: Vec::new(),
        line: 0,
    };
    for record in &exchange.records {
        playing.line = record.line;
        if let Some(at) = record.at {
            playing.listen_until(at.as_micros() as u64, |_| false);
        }
        playing.record(&record.what);
    }
    playing.line += 1;
    playing.listen_until(playing.now_us + AFTERWARDS_US, |_| false);
    if !playing.bytes.is_empty() {
        let found = format!("{:02x?}", playing.bytes);
        playing.differ("the device to say nothing more", found);
    }
    if let Some(report) = playing.reports.pop_front() {
        playing.differ("no more reports", format!("{report:02x?}"));
    }
    playing.differences
}

struct Playing {
    far: Far,
    hands: Device,
    now_us: u64,
    /// The cable of a serial line is out.
    unplugged: bool,
    /// A USB device dropped off the bus without anybody's doing.
    left_by_itself: bool,
    /// Bytes of a line that nothing has told yet, and reports likewise.
    bytes: VecDeque<u8>,
    reports: VecDeque<Vec<u8>>,
    /// Answers that were given and nothing has told yet.
    answers: VecDeque<Answer>,
    differences: Vec<Difference>,
    line: u32,
}

impl Playing {
    fn record(&mut self, what: &What) {
        match what {
            What::Host(Step::Wait(span)) => {
                self.listen_until(self.now_us + span.as_micros() as u64, |_| false);
            }
            What::Host(step) => self.tell(step),
            What::Device(bytes) => match self.far {
                Far::Line(_) => self.expect_bytes(bytes),
                Far::Usb(..) => self.expect_report(bytes),
            },
            What::Answer(answer) => self.expect_answer(answer),
            What::Hand(words) => self.touch(words),
            What::Gone => self.plug(false),
            What::Back => self.plug(true),
            // What the host makes of it is the host's.
            What::Event(_) | What::Surface { .. } | What::Show(_) | What::Pause => {}
        }
    }

    fn tell(&mut self, step: &Step) {
        let now_us = self.now_us;
        let told = match (&mut self.far, step) {
            (Far::Line(line), Step::Bytes(bytes)) => {
                line.receive(now_us, bytes);
                Some(())
            }
            (Far::Line(line), Step::Baud(baud)) => {
                line.set_line_baud(now_us, *baud);
                Some(())
            }
            (Far::Usb(device, interface), step) => {
                let answer = ask(device.as_mut(), *interface, now_us, step);
                self.answers.extend(answer);
                Some(())
            }
            _ => None,
        };
        if told.is_none() {
            self.differ("something a serial line can carry", format!("{step:?}"));
        }
    }

    fn listen_until(&mut self, until_us: u64, done: impl Fn(&Self) -> bool) {
        let mut heard = Vec::new();
        loop {
            match &mut self.far {
                Far::Line(line) => {
                    heard.clear();
                    line.transmit(self.now_us, &mut heard);
                    if !self.unplugged {
                        self.bytes.extend(&heard);
                    }
                }
                Far::Usb(device, interface) => {
                    while let Some(report) = device.report(self.now_us) {
                        if report.interface == *interface {
                            self.reports.push_back(report.bytes);
                        }
                    }
                }
            }
            if self.now_us >= until_us || done(self) {
                return;
            }
            self.now_us = until_us.min(self.now_us + LOOK_US);
        }
    }

    fn expect_bytes(&mut self, bytes: &[u8]) {
        self.listen_until(self.now_us + PATIENCE_US, |playing| {
            playing.bytes.len() >= bytes.len()
        });
        let count = self.bytes.len().min(bytes.len());
        let came: Vec<u8> = self.bytes.drain(..count).collect();
        if came != bytes {
            self.differ(&format!("the device to say {bytes:02x?}"), format!("{came:02x?}"));
        }
    }

    fn expect_report(&mut self, bytes: &[u8]) {
        self.listen_until(self.now_us + PATIENCE_US, |playing| !playing.reports.is_empty());
        let came = self.reports.pop_front();
        if came.as_deref() != Some(bytes) {
            self.differ(&format!("the report {bytes:02x?}"), format!("{came:02x?}"));
        }
    }

    fn expect_answer(&mut self, expected: &Answer) {
        let came = self.answers.pop_front();
        let same = match (&came, expected) {
            // Why something is refused is said in the words of whoever was asked.
            (
                Some(Answer::Feature { id, bytes: Err(_) }),
                Answer::Feature {
                    id: wanted,
                    bytes: Err(_),
                },
            ) => id == wanted,
            (
                Some(Answer::Text { index, raw: Err(_) }),
                Answer::Text {
                    index: wanted,
                    raw: Err(_),
                },
            ) => index == wanted,
            (came, expected) => came.as_ref() == Some(expected),
        };
        if !same {
            self.differ(&format!("the answer {expected:02x?}"), format!("{came:02x?}"));
        }
    }

    fn touch(&mut self, words: &str) {
        match Script::parse(self.hands, &format!("at 0 {words}")) {
            Err(errors) => self.differ("something a hand can do", format!("{errors:?}")),
            Ok(script) => {
                for action in script.actions {
                    let hands: &mut dyn Hands = match &mut self.far {
                        Far::Line(line) => line.as_mut(),
                        Far::Usb(device, _) => device.as_mut(),
                    };
                    if !hands.touch(self.now_us, &action.touch) {
                        self.differ("a control that the device has", words.to_owned());
                    }
                }
            }
        }
    }

    fn plug(&mut self, connected: bool) {
        match &mut self.far {
            Far::Usb(..) => self.plug_usb(connected),
            // The device keeps its power; what it says is lost until somebody opens the port again.
            Far::Line(line) => {
                line.transmit(self.now_us, &mut Vec::new());
                if connected {
                    open(line.as_mut(), self.now_us);
                }
                self.unplugged = !connected;
            }
        }
    }

    /// One that has left the bus by itself is waited for, not pulled out.
    fn plug_usb(&mut self, connected: bool) {
        let Far::Usb(device, interface) = &mut self.far else {
            return;
        };
        let (now_us, interface) = (self.now_us, *interface);
        if !connected {
            self.left_by_itself = device.arrival(now_us) == 0;
            if !self.left_by_itself {
                device.plug(now_us, false);
            }
            return;
        }
        if !self.left_by_itself {
            device.plug(now_us, true);
        }
        let end_us = now_us + PATIENCE_US;
        while device.arrival(self.now_us) == 0 && self.now_us < end_us {
            self.now_us += LOOK_US;
        }
        device.listen(self.now_us, interface, true);
    }

    fn differ(&mut self, expected: &str, found: String) {
        let (line, expected) = (self.line, expected.to_owned());
        self.differences.push(Difference {
            line,
            expected,
            found,
        });
    }
}

/// Asks or tells a USB device; what comes back, if anything does. A report that bears no number on the wire has 0 for
/// it in an exchange.
pub(super) fn ask(device: &mut dyn UsbDevice, interface: u8, now_us: u64, step: &Step) -> Option<Answer> {
    let on_wire = |bytes: &[u8]| match bytes {
        [0, rest @ ..] => rest.to_vec(),
        bytes => bytes.to_vec(),
    };
    let refused = |stall: firmware_sim::usb_device::Stall| stall.to_string();
    match step {
        Step::Bytes(bytes) | Step::Report(bytes) => {
            // A refused output report is the host's to bear; nothing comes back.
            let _ = device.output(now_us, interface, &on_wire(bytes));
            None
        }
        Step::Feature(bytes) => {
            let id = bytes.first().copied().unwrap_or(0);
            let set = device.set_feature(now_us, interface, &on_wire(bytes));
            set.err().map(|stall| Answer::Feature {
                id,
                bytes: Err(refused(stall)),
            })
        }
        Step::AskFeature { id, .. } => Some(Answer::Feature {
            id: *id,
            bytes: device.feature(now_us, interface, *id).map_err(refused),
        }),
        Step::AskString(index) => Some(Answer::Text {
            index: *index,
            raw: device.string(now_us, *index).map_err(refused),
        }),
        Step::AskDescriptor => {
            let facts = device.facts().interfaces.get(usize::from(interface));
            let descriptor = facts.map(|facts| facts.descriptor.clone());
            Some(Answer::Descriptor(
                descriptor.ok_or_else(|| "no such interface".into()),
            ))
        }
        Step::Baud(_) | Step::Wait(_) => None,
    }
}
