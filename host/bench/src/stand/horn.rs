//! What somebody beside the bench does to a puppet's joints, and finds out about their servos.

use device_profiles::Role;
use firmware_sim::servo_bus::Hand;

use super::{HandError, Stand};

impl Stand {
    /// A hand takes a joint to `rad` within `over_secs` and holds it there, as far as a hand is strong enough.
    pub fn guide(&self, joint: &str, rad: f64, over_secs: f64) -> Result<(), HandError> {
        let to_rad = self.mount(joint)?.shaft_rad(rad);
        self.grip(joint, Some(Hand::Guide { to_rad, over_secs }))
    }

    /// A hand pulls a joint with `nm` newton metres, in the sense of its rising angle.
    pub fn pull(&self, joint: &str, nm: f64) -> Result<(), HandError> {
        let sense = self.mount(joint)?.sense();
        self.grip(joint, Some(Hand::Pull { nm: sense * nm }))
    }

    /// The hand lets go of a joint.
    pub fn let_go(&self, joint: &str) -> Result<(), HandError> {
        self.grip(joint, None)
    }

    fn grip(&self, joint: &str, hand: Option<Hand>) -> Result<(), HandError> {
        let mount = self.mount(joint)?;
        self.with_bus(&mount.bus, |bus, now_us| bus.hand(now_us, mount.id, hand))?;
        Ok(())
    }

    /// What a joint's servo has in its register of that role; none if the model has no such register.
    pub fn register(&self, joint: &str, role: Role) -> Result<Option<i64>, HandError> {
        let mount = self.mount(joint)?;
        self.with_bus(&mount.bus, |bus, _| {
            bus.servo(mount.id).and_then(|servo| servo.register_of(role))
        })
    }
}
