//! The shipped puppets: every one against its servos, and those with limbs against the way they bend.

mod kinematics;
mod marionette;
mod shipped;
