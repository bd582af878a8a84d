//! What somebody beside the bench can do to the servos of a bus: hands, weights, end stops.

use super::bus::ServoBus;
use super::plant::{Hand, STEP_NS};
use super::servo::Servo;
use super::unit::Sag;

impl ServoBus {
    /// The first servo with number `id`, brought up to `now_us`.
    fn servo_at(&mut self, now_us: u64, id: u8) -> Option<&mut Servo> {
        self.catch_up(now_us);
        self.servo_mut(id)
    }

    /// A hand turns the horn of servo `id` by `rad` at once. False: there is no such servo.
    pub fn push(&mut self, now_us: u64, id: u8, rad: f64) -> bool {
        let Some(servo) = self.servo_at(now_us, id) else {
            return false;
        };
        let powered = servo.torque_is_on();
        servo.plant.push(rad / servo.facts.rad_per_count, powered);
        true
    }

    /// A hand takes the horn of servo `id`, or lets go of it. False: there is no such servo.
    ///
    /// A hand is as strong as a hand: a motor that holds may hold against it.
    pub fn hand(&mut self, now_us: u64, id: u8, hand: Option<Hand>) -> bool {
        let servo = self.servo_at(now_us, id);
        servo.map(|servo| servo.plant.grip(hand)).is_some()
    }

    /// Gravity on servo `id` while its torque is off. False: there is no such servo.
    pub fn set_sag(&mut self, now_us: u64, id: u8, sag: Option<Sag>) -> bool {
        let servo = self.servo_at(now_us, id);
        servo.map(|servo| servo.sag = sag).is_some()
    }

    /// Where the horn of servo `id` meets an end either way, radians from the middle of the position range.
    /// False: there is no such servo.
    pub fn set_stops(&mut self, now_us: u64, id: u8, stops_rad: Option<[f64; 2]>) -> bool {
        let servo = self.servo_at(now_us, id);
        servo.map(|servo| servo.set_stops(stops_rad)).is_some()
    }

    /// The supply line has this resistance from one servo to the next.
    pub(super) fn set_resistance(&mut self, at_ns: u64, ohms: f64) {
        self.advance_servos(at_ns);
        self.ohms = ohms;
        if ohms <= 0.0 {
            for servo in &mut self.servos {
                servo.set_line_drop(at_ns, 0.0);
            }
        }
    }

    /// Brings every servo to `to_ns`; those that share a line with resistance go step by step together, because
    /// what one draws the others lack.
    pub(super) fn advance_servos(&mut self, to_ns: u64) {
        if self.ohms > 0.0 {
            let first_ns = self
                .servos
                .iter()
                .map(|servo| servo.stepped_ns)
                .min()
                .unwrap_or(to_ns);
            let mut at_ns = first_ns + STEP_NS;
            while at_ns <= to_ns {
                for servo in &mut self.servos {
                    servo.advance(at_ns);
                }
                self.share_the_supply(at_ns);
                at_ns += STEP_NS;
            }
        }
        for servo in &mut self.servos {
            servo.advance(to_ns);
        }
    }

    /// Each stretch of the line carries what all servos behind it draw.
    fn share_the_supply(&mut self, at_ns: u64) {
        let mut behind_a: f64 = self.servos.iter().map(Servo::drawn_amperes).sum();
        let mut drop = 0.0;
        for servo in &mut self.servos {
            drop += behind_a * self.ohms;
            behind_a -= servo.drawn_amperes();
            servo.set_line_drop(at_ns, drop);
        }
    }
}

impl Servo {
    pub(super) fn set_stops(&mut self, stops_rad: Option<[f64; 2]>) {
        let facts = &self.facts;
        self.plant.stops = stops_rad.map(|stops| stops.map(|rad| facts.centre + rad / facts.rad_per_count));
    }
}
