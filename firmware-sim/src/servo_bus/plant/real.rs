//! A body with a motor: voltage makes current, current makes torque, torque moves inertia against friction.
//!
//! A step solves the linear part (inertia, back EMF, viscous friction) exactly and takes the rest as constant
//! through it, so that it is stable however light the rotor; dry friction never turns a motion round, it ends it.

use super::motor::MotorFacts;
use super::{Gains, Order, STEP_SECS};

/// Speed at which breaking away has given way to sliding, radians a second (BAM: 1.1 to 2 for MX-64 and XL330).
const STRIBECK_RAD_PER_S: f64 = 1.0;
/// Slower than this it stands, radians a second: a hundredth of a count a second.
const STANDS_RAD_PER_S: f64 = 1e-5;
/// Velocity loop: duty for a share of no-load speed, and for the same share over a second. The X series' own
/// defaults (P 100/128, I 1000/65536 a millisecond, of 885) for its 0.229 rpm a count come to about this.
const SPEED_P: f64 = 0.25;
const SPEED_I: f64 = 5.0;

/// The shaft, counts and counts per second.
#[derive(Clone, Debug)]
pub(super) struct Real {
    pub(super) position: f64,
    velocity: f64,
    motor: MotorFacts,
    sum: f64,
    error_before: Option<f64>,
}

/// What a powered step came to.
pub(super) struct Outcome {
    pub(super) duty: f64,
    pub(super) amperes: f64,
}

impl Real {
    pub(super) fn new(position: f64, motor: &MotorFacts) -> Self {
        Self {
            position,
            velocity: 0.0,
            motor: *motor,
            sum: 0.0,
            error_before: None,
        }
    }

    /// Something other than the motor puts it there.
    pub(super) fn place(&mut self, position: f64, velocity: f64) {
        (self.position, self.velocity) = (position, velocity);
    }

    /// The loops begin anew; the shaft keeps its motion.
    pub(super) fn forget(&mut self) {
        self.sum = 0.0;
        self.error_before = None;
    }

    #[expect(clippy::too_many_arguments, reason = "all that surrounds a motor for a step")]
    pub(super) fn drive(
        &mut self,
        order: Order,
        encoder: f64,
        volts: f64,
        outside_nm: f64,
        load_kg_m2: f64,
        stuck: bool,
        rad_per_count: f64,
    ) -> Outcome {
        let motor = self.motor;
        let rad_per_s = self.velocity * rad_per_count;
        let duty = match order {
            Order::Position {
                counts,
                velocity,
                gains,
            } => self.position_loop(counts - encoder.round(), velocity, &gains),
            Order::Speed { velocity, .. } => self.speed_loop(velocity * rad_per_count - rad_per_s),
            Order::Current { share, .. } => {
                // The current loop is far faster than a step: it finds the voltage it needs, if there is as much.
                let wanted = share * motor.stall_a * motor.ohms + motor.volts_s * rad_per_s;
                if volts > 0.0 { wanted / volts } else { 0.0 }
            }
            Order::Duty { share, .. } => share,
        };
        let duty = duty.clamp(-1.0, 1.0);
        let pull_nm = motor.nm_per_a * duty * volts / motor.ohms;
        let damping = motor.nm_per_a * motor.volts_s / motor.ohms + motor.viscous_nm_s;
        if stuck {
            self.velocity = 0.0;
        } else {
            self.turn(pull_nm + outside_nm, damping, load_kg_m2, rad_per_count);
        }
        let emf = motor.volts_s * self.velocity * rad_per_count;
        Outcome {
            duty,
            amperes: (duty * volts - emf) / motor.ohms,
        }
    }

    /// Without power the bridge is open: no current, no brake.
    pub(super) fn coast(&mut self, outside_nm: f64, load_kg_m2: f64, rad_per_count: f64) {
        self.turn(outside_nm, self.motor.viscous_nm_s, load_kg_m2, rad_per_count);
    }

    fn position_loop(&mut self, error: f64, velocity: f64, gains: &Gains) -> f64 {
        let change = (error - self.error_before.unwrap_or(error)) / STEP_SECS;
        self.error_before = Some(error);
        let punch = if error.abs() >= 1.0 {
            gains.punch.copysign(error)
        } else {
            0.0
        };
        let wanted =
            punch + gains.p * error + gains.d * change + gains.feed_forward * velocity + gains.i * self.sum;
        // The sum stands still while the motor has no more to give.
        if wanted.abs() < gains.duty_max {
            self.sum += error * STEP_SECS;
        }
        wanted.clamp(-gains.duty_max, gains.duty_max)
    }

    fn speed_loop(&mut self, error_rad_per_s: f64) -> f64 {
        let share = error_rad_per_s / self.motor.no_load_rad_per_s;
        let wanted = SPEED_P * share + SPEED_I * self.sum;
        if wanted.abs() < 1.0 {
            self.sum += share * STEP_SECS;
        }
        wanted
    }

    /// One step of motion under `torque_nm` with `damping` newton metres for a radian a second.
    fn turn(&mut self, torque_nm: f64, damping: f64, load_kg_m2: f64, rad_per_count: f64) {
        let motor = &self.motor;
        let before = self.velocity * rad_per_count;
        let stands = before.abs() < STANDS_RAD_PER_S;
        if stands && torque_nm.abs() <= motor.break_away_nm {
            self.velocity = 0.0;
            return;
        }
        let sense = if stands {
            torque_nm.signum()
        } else {
            before.signum()
        };
        let sliding = (-(before / STRIBECK_RAD_PER_S).powi(2)).exp();
        let friction = motor.friction_nm + (motor.break_away_nm - motor.friction_nm) * sliding;
        let net_nm = torque_nm - sense * friction;
        let inertia = motor.inertia_kg_m2 + load_kg_m2;
        // J dv/dt = net − damping v, solved over the step.
        let settled = net_nm / damping;
        let mut after = settled + (before - settled) * (-damping * STEP_SECS / inertia).exp();
        if after * sense < 0.0 {
            after = 0.0;
        }
        self.velocity = after / rad_per_count;
        self.position += f64::midpoint(before, after) / rad_per_count * STEP_SECS;
    }

    pub(super) fn stop_within(&mut self, low: f64, high: f64) {
        let inside = self.position.clamp(low, high);
        if inside != self.position {
            self.position = inside;
            self.velocity = 0.0;
        }
    }
}
