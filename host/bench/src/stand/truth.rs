//! What a test may know about a simulated joint that no byte on the wire tells.

use super::Horn;
use device_profiles::{PuppetJoint, ServoProfile};
use firmware_sim::servo_bus::{Counters, Servo};

/// How a joint's angle and its servo's shaft belong together, and what the profile allows.
#[derive(Clone, Debug)]
pub(crate) struct Mount {
    pub(crate) joint: String,
    pub(crate) bus: String,
    pub(crate) id: u8,
    pub(crate) range_rad: [f64; 2],
    pub(crate) speed_max_rad_per_s: f64,
    pub(crate) accel_max_rad_per_s2: f64,
    sign: f64,
    /// Shaft angle, from the middle of the servo's range, where the joint's angle is 0.
    shaft_zero_rad: f64,
}

impl Mount {
    pub(crate) fn new(joint: &PuppetJoint, servo: &ServoProfile) -> Self {
        Self {
            joint: joint.name.clone(),
            bus: joint.bus.clone(),
            id: joint.id,
            range_rad: [joint.min_rad, joint.max_rad],
            speed_max_rad_per_s: joint.speed_max_rad_per_s,
            accel_max_rad_per_s2: joint.accel_max_rad_per_s2,
            sign: f64::from(joint.sign),
            shaft_zero_rad: f64::from(joint.zero_counts - servo.centre_counts) * servo.rad_per_count(),
        }
    }

    /// The same with its horn on another way.
    pub(super) fn with_horn(mut self, horn: Horn) -> Self {
        self.shaft_zero_rad += horn.off_rad;
        if horn.reversed {
            self.sign = -self.sign;
        }
        self
    }

    pub(crate) fn shaft_rad(&self, joint_rad: f64) -> f64 {
        self.shaft_zero_rad + self.sign * joint_rad
    }

    /// 1 where the joint's angle rises with the shaft's, else −1.
    pub(crate) fn sense(&self) -> f64 {
        self.sign
    }

    pub(crate) fn joint_rad(&self, shaft_rad: f64) -> f64 {
        self.sign * (shaft_rad - self.shaft_zero_rad)
    }

    /// A real joint: all that is known is what the rig has read.
    pub(crate) fn seen(&self, position_rad: f64, torque: bool, connected: bool) -> JointTruth {
        JointTruth {
            joint: self.joint.clone(),
            bus: self.bus.clone(),
            id: self.id,
            position_rad,
            velocity_rad_per_s: 0.0,
            torque,
            connected,
            effort: 0.0,
            temperature_c: 0.0,
            life: Counters::default(),
            range_rad: self.range_rad,
            speed_max_rad_per_s: self.speed_max_rad_per_s,
            accel_max_rad_per_s2: self.accel_max_rad_per_s2,
        }
    }

    pub(crate) fn truth(&self, servo: &Servo) -> JointTruth {
        JointTruth {
            joint: self.joint.clone(),
            bus: self.bus.clone(),
            id: self.id,
            position_rad: self.joint_rad(servo.true_position_rad()),
            velocity_rad_per_s: self.sign * servo.true_velocity_rad_per_s(),
            torque: servo.torque_is_on(),
            connected: servo.is_connected(),
            effort: self.sign * servo.effort(),
            temperature_c: servo.temperature_c(),
            life: *servo.counters(),
            range_rad: self.range_rad,
            speed_max_rad_per_s: self.speed_max_rad_per_s,
            accel_max_rad_per_s2: self.accel_max_rad_per_s2,
        }
    }
}

/// A simulated joint as it really is.
#[derive(Clone, Debug, PartialEq)]
pub struct JointTruth {
    /// The joint's name in the puppet profile.
    pub joint: String,
    /// Its bus.
    pub bus: String,
    /// Its servo's id.
    pub id: u8,
    /// Where it is, radians.
    pub position_rad: f64,
    /// How fast it turns.
    pub velocity_rad_per_s: f64,
    /// Whether the motor holds.
    pub torque: bool,
    /// Whether the servo has power and a cable.
    pub connected: bool,
    /// What its motor does, −1 to 1 of what it can, in the sense of the joint's rising angle.
    pub effort: f64,
    /// What its motor's sensor would read, degrees Celsius.
    pub temperature_c: f64,
    /// What has happened to its servo.
    pub life: Counters,
    /// What the profile allows.
    pub range_rad: [f64; 2],
    /// What the profile allows.
    pub speed_max_rad_per_s: f64,
    /// What the profile allows.
    pub accel_max_rad_per_s2: f64,
}
