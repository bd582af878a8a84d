//! Hands on the simulated controls: movements that take time, made of touches at each step of the world.
//!
//! A movement eases in and out as a hand's does: the minimum-jerk course of Flash and Hogan (1985),
//! s = 10 t³ − 15 t⁴ + 6 t⁵. Places on a tablet are script coordinates: −1…1 over the whole of each side.

use std::collections::BTreeMap;
use std::time::Duration;

use device::clock::Instant;
use firmware_sim::hands::{Pen, Puck, Touch, Turn};

use crate::stand::{HandError, Stand};

/// One movement of a hand. Controls are numbered as the device numbers them.
#[derive(Clone, Debug, PartialEq)]
pub enum Movement {
    /// Turns a dial, easing in and out.
    Turn {
        /// Dial, from 0.
        control: u8,
        /// How far; clockwise positive.
        by: Turn,
        /// Duration.
        over_secs: f64,
    },
    /// Takes a fader, knob or axis to a place.
    Slide {
        /// Which of them, from 0.
        control: u8,
        /// Share of its travel, 0 to 1; −1 to 1 where it springs back to the middle.
        to: f64,
        /// Duration.
        over_secs: f64,
    },
    /// Presses a key and lets it go.
    Press {
        /// Key, from 0.
        control: u8,
        /// How long it is down.
        for_secs: f64,
    },
    /// Presses a key.
    Down {
        /// Key, from 0.
        control: u8,
    },
    /// Lets a key go.
    Up {
        /// Key, from 0.
        control: u8,
    },
    /// Switches the device off and on.
    PowerCycle,
    /// Moves the tool to a place; one that was away comes down there.
    Glide {
        /// Where to.
        to: [f64; 2],
        /// Duration.
        over_secs: f64,
    },
    /// Changes the tool in hand.
    Take(Tool),
    /// Holds these buttons of the tool, bit 0 is button 1.
    Buttons(u8),
    /// Presses a button of the tool, from 1, and lets it go.
    Click {
        /// Button, from 1.
        button: u8,
        /// How long it is down.
        for_secs: f64,
    },
    /// Presses a button of the tool and lifts the tool away with it.
    ClickAway {
        /// Button, from 1.
        button: u8,
        /// How long until it is lifted.
        for_secs: f64,
    },
    /// Puts a pen's point down at this pressure (0 to 1), or lifts it (0).
    Tip {
        /// Pressure.
        pressure: f64,
    },
    /// Lifts the tool out of reach.
    Away,
}

/// A tool for a tablet.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tool {
    /// The cursor with buttons.
    #[default]
    Puck,
    /// The pen.
    Pen,
}

#[derive(Clone, Debug)]
struct Course {
    device: String,
    movement: Movement,
    from: Instant,
    begun: bool,
    /// Where a glide began.
    origin: [f64; 2],
    /// Counts a turn has made so far.
    counts: i32,
}

/// What is held over a tablet.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Held {
    tool: Tool,
    at: Option<[f64; 2]>,
    buttons: u8,
    pressure: f64,
}

impl Held {
    fn touch(self) -> Touch {
        match (self.at, self.tool) {
            (None, _) => Touch::Away,
            (Some([x, y]), Tool::Puck) => Touch::Puck(Puck {
                x,
                y,
                buttons: self.buttons,
                ..Puck::default()
            }),
            (Some([x, y]), Tool::Pen) => Touch::Pen(Pen {
                x,
                y,
                pressure: self.pressure,
                tip: self.pressure > 0.0,
                buttons: self.buttons,
                ..Pen::default()
            }),
        }
    }
}

/// The hands, and what they are in the middle of.
pub struct Hands {
    stand: Stand,
    courses: Vec<Course>,
    held: BTreeMap<String, Held>,
}

impl Hands {
    /// Hands beside a stand, touching nothing.
    pub fn new(stand: Stand) -> Self {
        Self {
            stand,
            courses: Vec::new(),
            held: BTreeMap::new(),
        }
    }

    /// Begins a movement `after_secs` from now. Movements go on side by side, as with two hands.
    pub fn begin(&mut self, device: &str, after_secs: f64, movement: Movement) {
        let from = self
            .stand
            .clock()
            .now()
            .after(Duration::from_secs_f64(after_secs.max(0.0)));
        let device = device.to_owned();
        self.courses.push(Course {
            device,
            movement,
            from,
            begun: false,
            origin: [0.0; 2],
            counts: 0,
        });
    }

    /// Whether a movement is under way or still to come.
    pub fn are_busy(&self) -> bool {
        !self.courses.is_empty()
    }

    /// Where the tool over a tablet is; `None` when it is away.
    pub fn tool_at(&self, tablet: &str) -> Option<[f64; 2]> {
        self.held.get(tablet)?.at
    }

    /// Makes the touches that are due by now. Each movement that a device refuses is an error; the others go on.
    pub fn advance(&mut self) -> Vec<HandError> {
        let now = self.stand.clock().now();
        let mut errors = Vec::new();
        let before = self.held.clone();
        let mut courses = std::mem::take(&mut self.courses);
        courses.retain_mut(|course| {
            if now < course.from {
                return true;
            }
            let lasts = self.follow(course, now);
            lasts.unwrap_or_else(|error| {
                errors.push(error);
                false
            })
        });
        self.courses = courses;
        for (device, held) in &self.held {
            if before.get(device) != Some(held)
                && let Err(error) = self.stand.touch(device, &held.touch())
            {
                errors.push(error);
            }
        }
        errors
    }

    /// Does what of a movement is due. A movement that ends is seen to begin first, so that the shortest press
    /// still is one. Gives whether it goes on.
    fn follow(&mut self, course: &mut Course, now: Instant) -> Result<bool, HandError> {
        let passed_secs = now.since(course.from).as_secs_f64();
        let first = !std::mem::replace(&mut course.begun, true);
        let stand = self.stand.clone();
        let touch = |touch: Touch| stand.touch(&course.device, &touch);
        match course.movement {
            Movement::Turn {
                control,
                by,
                over_secs,
            } => {
                let per_turn = stand.counts_per_turn(&course.device)?.unwrap_or(1);
                let share = share(passed_secs, over_secs);
                let counts = (f64::from(by.counts(per_turn)) * ease(share)).round() as i32;
                let step = counts - std::mem::replace(&mut course.counts, counts);
                touch(Touch::Dial {
                    control,
                    by: Turn::Counts(step),
                    over_us: 0,
                })?;
                Ok(share < 1.0)
            }
            Movement::Slide {
                control,
                to,
                over_secs,
            } => touch(Touch::Axis {
                control,
                to,
                over_us: (over_secs.max(0.0) * 1e6) as u64,
            })
            .map(|()| false),
            Movement::Press { control, for_secs } => {
                let down = first || passed_secs < for_secs;
                if first || !down {
                    touch(Touch::Button { control, down })?;
                }
                Ok(down)
            }
            Movement::Down { control } => touch(Touch::Button { control, down: true }).map(|()| false),
            Movement::Up { control } => touch(Touch::Button { control, down: false }).map(|()| false),
            Movement::PowerCycle => touch(Touch::PowerCycle).map(|()| false),
            _ => Ok(self.hold(course, first, passed_secs)),
        }
    }

    /// The movements over a tablet: they change what is held, which becomes one touch at the end of the step.
    fn hold(&mut self, course: &mut Course, first: bool, passed_secs: f64) -> bool {
        let held = self.held.entry(course.device.clone()).or_default();
        match course.movement {
            Movement::Glide { to, over_secs } => {
                if first {
                    course.origin = held.at.unwrap_or(to);
                }
                let share = share(passed_secs, over_secs);
                let [x, y] = course.origin;
                let along = ease(share);
                // The end exactly: a blend would miss it by a rounding.
                let place = [x + (to[0] - x) * along, y + (to[1] - y) * along];
                held.at = Some(if share < 1.0 { place } else { to });
                share < 1.0
            }
            Movement::Click { button, for_secs } | Movement::ClickAway { button, for_secs } => {
                let bit = 1u8.checked_shl(u32::from(button.max(1)) - 1).unwrap_or(0);
                let down = first || passed_secs < for_secs;
                if down {
                    held.buttons |= bit;
                } else {
                    held.buttons &= !bit;
                    if matches!(course.movement, Movement::ClickAway { .. }) {
                        held.at = None;
                    }
                }
                down
            }
            Movement::Take(tool) => {
                *held = Held {
                    tool,
                    ..Held::default()
                };
                false
            }
            Movement::Buttons(buttons) => {
                held.buttons = buttons;
                false
            }
            Movement::Tip { pressure } => {
                held.pressure = pressure;
                false
            }
            Movement::Away => {
                *held = Held {
                    tool: held.tool,
                    ..Held::default()
                };
                false
            }
            _ => false,
        }
    }
}

fn share(passed_secs: f64, over_secs: f64) -> f64 {
    if over_secs > 0.0 {
        (passed_secs / over_secs).clamp(0.0, 1.0)
    } else {
        1.0
    }
}

fn ease(share: f64) -> f64 {
    share * share * share * (10.0 - share * (15.0 - 6.0 * share))
}
