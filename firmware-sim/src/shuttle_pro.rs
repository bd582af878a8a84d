//! The Contour ShuttlePRO v2: a ring on a spring, a wheel that turns for ever inside it, fifteen buttons.
//!
//! Five bytes a report without id: shuttle −7 to 7, the wheel's own counter, nothing, and the buttons. The counter
//! wraps and the first report bears wherever it stands: only differences mean anything.
//! Source: `docs/simulators.md`, "ShuttlePRO" (VRPN `vrpn_Contour.C`, nanosyzygy/ShuttlePRO).

use crate::hands::Touch;
use crate::usb_device::{
    Chassis, Descriptor, HidInterface, Inside, Moment, Ramps, Report, UsbDevice, UsbFacts, Waiting,
};

/// Clicks of the wheel in a turn.
pub const CLICKS_PER_TURN: u32 = 10;
/// Steps of the shuttle either way.
const SHUTTLE_MAX: i32 = 7;
const BUTTONS: u8 = 15;
/// Between reports. Ours; no reader depends on it.
const INTERVAL_US: u64 = 8_000;
/// Where the wheel's counter stands when the power comes. Ours, near its end so that it soon wraps.
const JOG_AT_POWER: u8 = 0xFD;

/// A ShuttlePRO v2, plugged in.
pub fn shuttle_pro() -> Box<dyn UsbDevice> {
    Box::new(Chassis::new(ShuttlePro {
        now: State {
            jog: JOG_AT_POWER,
            ..State::default()
        },
        ..ShuttlePro::default()
    }))
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct State {
    shuttle: i8,
    jog: u8,
    buttons: u16,
}

impl State {
    fn bytes(self) -> Vec<u8> {
        let [low, high] = self.buttons.to_le_bytes();
        vec![self.shuttle as u8, self.jog, 0, low, high]
    }
}

/// Numbers of what moves, for the ramps.
const JOG: u8 = 0;
const SHUTTLE: u8 = 1;

#[derive(Debug, Default)]
struct ShuttlePro {
    now: State,
    waiting: Waiting<State>,
    ramps: Ramps,
}

impl ShuttlePro {
    fn push(&mut self) {
        let state = self.now;
        // A shuttle that springs back through several steps tells where it is, a pressed button each time.
        self.waiting.push(state, |last, new| {
            let joins = last.buttons == new.buttons;
            if joins {
                *last = *new;
            }
            joins
        });
    }

    fn turn_jog(&mut self, by: i32) {
        self.now.jog = self.now.jog.wrapping_add(by as u8);
        self.push();
    }
}

impl Inside for ShuttlePro {
    fn facts(&self) -> UsbFacts {
        let descriptor = Descriptor::application(0x0C, 0x01)
            .page(0x01)
            .inputs(&[0x38], 8, [-SHUTTLE_MAX, SHUTTLE_MAX])
            .inputs(&[0x37], 8, [0, 255])
            .padding(8)
            .page(0x09)
            .bits(1, u16::from(BUTTONS))
            .padding(1)
            .end();
        UsbFacts {
            vendor: 0x0B33,
            product: 0x0030,
            release_bcd: 0x0100,
            manufacturer: "Contour Design",
            name: "ShuttlePRO v2",
            serial: None,
            interfaces: vec![HidInterface {
                descriptor: descriptor.build(),
                usage: [0x0C, 0x01],
                input_bytes: 5,
                output_bytes: 0,
                feature_bytes: 0,
                numbered: false,
                poll_ms: 8,
            }],
            main: 0,
        }
    }

    fn interval_us(&self) -> u64 {
        INTERVAL_US
    }

    fn lose_power(&mut self) {
        self.now.jog = JOG_AT_POWER;
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
                let clicks = by.counts(CLICKS_PER_TURN);
                if over_us > 0 {
                    self.ramps.begin(at.now_us, JOG, clicks, over_us);
                } else if clicks != 0 {
                    self.turn_jog(clicks);
                }
                true
            }
            Touch::Axis {
                control: 0,
                to,
                over_us,
            } => {
                let target = (to.clamp(-1.0, 1.0) * f64::from(SHUTTLE_MAX)).round() as i8;
                self.ramps.stop(SHUTTLE);
                if over_us > 0 {
                    let way = i32::from(target - self.now.shuttle);
                    self.ramps.begin(at.now_us, SHUTTLE, way, over_us);
                } else if self.now.shuttle != target {
                    self.now.shuttle = target;
                    self.push();
                }
                true
            }
            Touch::Button { control, down } if control < BUTTONS => {
                let bit = 1 << control;
                let buttons = if down {
                    self.now.buttons | bit
                } else {
                    self.now.buttons & !bit
                };
                if buttons != self.now.buttons {
                    self.now.buttons = buttons;
                    self.push();
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
        let now = &mut self.now;
        self.ramps.step(at_us, |what, by| {
            if what == JOG {
                now.jog = now.jog.wrapping_add(by as u8);
            } else {
                now.shuttle += by as i8;
            }
        });
        self.push();
    }

    fn has_report(&self) -> bool {
        !self.waiting.is_empty()
    }

    fn take_report(&mut self) -> Option<Report> {
        let bytes = self.waiting.pop()?.bytes();
        Some(Report { interface: 0, bytes })
    }

    fn same_again(&self) -> Option<Report> {
        Some(Report {
            interface: 0,
            bytes: self.now.bytes(),
        })
    }
}

#[cfg(test)]
mod tests;
