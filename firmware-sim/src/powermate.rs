//! The Griffin PowerMate: one endless knob that is pressed, one blue lamp under it.
//!
//! Six bytes a report without id: button, turn since the last report, 0, and the lamp's settings said back. A report
//! carries at most seven counts either way; what is more waits for the next.
//! Source: `docs/simulators.md`, "PowerMate" (Linux `powermate.c`, VRPN `vrpn_Griffin.C`).

use crate::hands::Touch;
use crate::usb_device::{
    Chassis, Descriptor, HidInterface, Inside, Moment, Ramps, Report, Request, Shown, Stall, UsbDevice,
    UsbFacts, Waiting,
};

/// Counts in a turn; readers of the real knob say "about 94".
pub const COUNTS_PER_TURN: u32 = 94;
/// Largest turn in one report.
const STEP_MAX: i32 = 7;
/// Between reports: the interval its descriptor asks for. Ours; no reader depends on it.
const INTERVAL_US: u64 = 10_000;

/// Vendor request to set the lamp: type 0x41, request 1.
const LAMP_REQUEST: (u8, u8) = (0x41, 0x01);

/// A PowerMate, plugged in.
pub fn powermate() -> Box<dyn UsbDevice> {
    Box::new(Chassis::new(PowerMate::default()))
}

/// What happened since the last report: the button is as it is at the end, the turn is all of it.
#[derive(Clone, Copy, Debug, Default)]
struct Doing {
    down: bool,
    turn: i32,
}

#[derive(Debug, Default)]
struct PowerMate {
    down: bool,
    ramps: Ramps,
    waiting: Waiting<Doing>,
    lamp: Lamp,
}

/// The lamp's registers, which reports say back in bytes 3 to 5.
#[derive(Clone, Copy, Debug, Default)]
struct Lamp {
    brightness: u8,
    awake: bool,
    asleep: bool,
    /// Operation and argument of the pulse's speed.
    speed: [u8; 2],
}

impl PowerMate {
    fn push(&mut self, turn: i32) {
        let doing = Doing {
            down: self.down,
            turn,
        };
        self.waiting.push(doing, |last, new| {
            let joins = last.down == new.down;
            last.turn += if joins { new.turn } else { 0 };
            joins
        });
    }

    fn bytes(&self, down: bool, step: i32) -> Vec<u8> {
        let status = u8::from(self.lamp.awake) | u8::from(self.lamp.asleep) << 1;
        let lamp = [self.lamp.brightness, status, self.lamp.speed[1]];
        [&[u8::from(down), step as u8, 0][..], &lamp].concat()
    }

    /// Sets the lamp as request 1 of the vendor does.
    fn set_lamp(&mut self, at: &mut Moment<'_>, value: u16, index: u16) -> Result<(), Stall> {
        let [command, _table] = value.to_le_bytes();
        let [low, high] = index.to_le_bytes();
        match command {
            1 => {
                self.lamp.brightness = low;
                at.show(Shown::Level(low));
                return Ok(());
            }
            2 => self.lamp.asleep = low != 0,
            3 => self.lamp.awake = low != 0,
            // 0 divides, 1 is normal, 2 multiplies.
            4 if low <= 2 => self.lamp.speed = [low, high],
            _ => return Err(Stall),
        }
        at.show(Shown::Pulse {
            speed: self.lamp.speed,
            awake: self.lamp.awake,
            asleep: self.lamp.asleep,
        });
        Ok(())
    }
}

impl Inside for PowerMate {
    fn facts(&self) -> UsbFacts {
        // Consumer page, one button and one dial; the lamp's echo and settings are the vendor's own.
        let descriptor = Descriptor::application(0x0C, 0x01)
            .page(0x09)
            .bits(1, 1)
            .padding(7)
            .page(0x01)
            .relative(&[0x37], 8, [-127, 127])
            .page(0xFF00)
            .input_bytes(0x01, 4)
            .output_bytes(0x02, 1)
            .feature_bytes(0x03, 8)
            .end();
        UsbFacts {
            vendor: 0x077D,
            product: 0x0410,
            release_bcd: 0x0311,
            manufacturer: "Griffin Technology, Inc.",
            name: "Griffin PowerMate",
            serial: None,
            interfaces: vec![HidInterface {
                descriptor: descriptor.build(),
                usage: [0x0C, 0x01],
                input_bytes: 6,
                output_bytes: 1,
                feature_bytes: 8,
                numbered: false,
                poll_ms: 10,
            }],
            main: 0,
        }
    }

    fn interval_us(&self) -> u64 {
        INTERVAL_US
    }

    fn lose_power(&mut self) {
        self.lamp = Lamp::default();
    }

    fn begin_anew(&mut self) {
        self.waiting.clear();
    }

    fn touch(&mut self, at: &mut Moment<'_>, touch: &Touch) -> bool {
        match *touch {
            Touch::Dial {
                control: 0,
                by,
                over_us,
            } => {
                let counts = by.counts(COUNTS_PER_TURN);
                if over_us == 0 && counts != 0 {
                    self.push(counts);
                } else {
                    self.ramps.begin(at.now_us, 0, counts, over_us);
                }
                true
            }
            Touch::Button { control: 0, down } => {
                if self.down != down {
                    self.down = down;
                    self.push(0);
                }
                true
            }
            _ => false,
        }
    }

    fn next_step_us(&self) -> Option<u64> {
        self.ramps.next_us()
    }

    fn step(&mut self, at_us: u64) {
        let mut turned = 0;
        self.ramps.step(at_us, |_, by| turned += by);
        self.push(turned);
    }

    fn has_report(&self) -> bool {
        !self.waiting.is_empty()
    }

    fn take_report(&mut self) -> Option<Report> {
        let doing = self.waiting.pop()?;
        let step = doing.turn.clamp(-STEP_MAX, STEP_MAX);
        let rest = doing.turn - step;
        if rest != 0 {
            self.waiting.put_back(Doing { turn: rest, ..doing });
        }
        Some(Report {
            interface: 0,
            bytes: self.bytes(doing.down, step),
        })
    }

    fn same_again(&self) -> Option<Report> {
        Some(Report {
            interface: 0,
            bytes: self.bytes(self.down, 0),
        })
    }

    fn output(&mut self, at: &mut Moment<'_>, _interface: u8, bytes: &[u8]) -> Result<(), Stall> {
        let &[brightness, ..] = bytes else {
            return Err(Stall);
        };
        self.set_lamp(at, 1, u16::from(brightness))
    }

    fn set_feature(&mut self, at: &mut Moment<'_>, _interface: u8, bytes: &[u8]) -> Result<(), Stall> {
        // The vendor request written as a report: kind, request, value, index.
        let &[kind, request, command, table, low, high, ..] = bytes else {
            return Err(Stall);
        };
        if (kind, request) != LAMP_REQUEST {
            return Err(Stall);
        }
        let value = u16::from_le_bytes([command, table]);
        self.set_lamp(at, value, u16::from_le_bytes([low, high]))
    }

    fn request(&mut self, at: &mut Moment<'_>, request: Request, _data: &[u8]) -> Result<Vec<u8>, Stall> {
        if (request.kind, request.request) != LAMP_REQUEST {
            return Err(Stall);
        }
        self.set_lamp(at, request.value, request.index)
            .map(|()| Vec::new())
    }
}

#[cfg(test)]
mod tests;
