//! Calibrating a puppet by hand: torque goes off, somebody moves every joint through its travel, and what that tells
//! is written to the servos and to the user's profile of the puppet, after what it replaces has been put aside.
//!
//! The judgement is `device::servo::calibrate`; here are lines, the sweep of all joints at once, and files.
//! *Start reading* at [`Calibrator`].

mod backup;
mod error;
mod file;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use device::clock::Clock;
use device::servo::calibrate::{Bearings, Sweep, Wish, plan};
use device::servo::maintenance::{Maintenance, MaintenanceError};
use device_profiles::{Profiles, PuppetJoint, PuppetProfile, Role, ServoProfile, ServoProtocol};

pub use backup::{Backup, Kept};
pub use device::servo::calibrate::{Plan, Refusal};
pub use error::CalibrationError;
pub use file::profile_text;

use crate::ports::Ports;
use crate::ward::Ward;

/// Largest homing offset that a DYNAMIXEL applies in position mode, counts (e-manual, "Homing Offset").
const OFFSET_MAX_COUNTS: i64 = 1024;
/// DYNAMIXEL's position mode within one turn.
const POSITION_MODE: i64 = 3;

/// Where a joint's zero is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Zero {
    /// Where it stood when the zero was marked.
    #[default]
    Marked,
    /// So that the middle of its travel is the middle of its range in the profile.
    Middle,
}

/// How a sweep is read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Reading {
    /// Where the zeros are.
    pub zero: Zero,
    /// Signs stay as the profile has them; otherwise the first movement from the marked zero was the positive one.
    pub keep_signs: bool,
}

/// A joint while it is swept.
#[derive(Clone, Debug, PartialEq)]
pub struct SweepView {
    /// Its name.
    pub joint: String,
    /// Where it stands, counts as the servo tells them, unwound; none: it was never read.
    pub now_counts: Option<f64>,
    /// From end to end so far, radians.
    pub span_rad: f64,
    /// Times the count has jumped.
    pub jumps: u32,
    /// Readings that failed.
    pub lost: u32,
}

/// What a sweep tells of one joint.
#[derive(Clone, Debug, PartialEq)]
pub struct Proposal {
    /// The joint.
    pub joint: String,
    /// What is to be set, or why nothing can be.
    pub plan: Result<Plan, Refusal>,
    /// What the profile has now: zero, sign, range.
    pub before: (i32, i8, [f64; 2]),
}

/// What was done.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Written {
    /// The puppet's profile in the user's folder.
    pub profile: PathBuf,
    /// What was replaced.
    pub backup: PathBuf,
    /// Settings of servos that were written, in words; what held the value already is not among them.
    pub settings: Vec<String>,
}

/// A puppet being calibrated. Its torque is off.
pub struct Calibrator {
    clock: Arc<dyn Clock>,
    puppet: PuppetProfile,
    lines: Vec<Maintenance>,
    seats: Vec<Seat>,
}

/// One joint with its servo.
struct Seat {
    joint: PuppetJoint,
    line: usize,
    model: ServoProfile,
    bearings: Bearings,
    /// A homing offset is set that the servo does not apply.
    idle_offset: bool,
    sweep: Sweep,
    lost: u32,
}

impl Calibrator {
    /// Opens the puppet's lines, switches torque off, and looks at every joint (or at `only` one).
    pub fn begin(
        ports: &mut dyn Ports,
        clock: Arc<dyn Clock>,
        profiles: &Profiles,
        puppet: &str,
        wards: &[Ward],
        only: Option<&str>,
    ) -> Result<Self, CalibrationError> {
        let puppet = profiles.puppet(puppet)?.clone();
        if let Some(only) = only.filter(|only| puppet.joint(only).is_none()) {
            return Err(CalibrationError::no_joint(&puppet, only));
        }
        let mut begun = Self {
            clock,
            puppet,
            lines: Vec::new(),
            seats: Vec::new(),
        };
        for ward in wards {
            let joints: Vec<PuppetJoint> = begun
                .puppet
                .joints_on(&ward.bus)
                .filter(|joint| only.is_none_or(|only| joint.name == only))
                .cloned()
                .collect();
            if joints.is_empty() {
                continue;
            }
            let transport = ports.open(&ward.address, ward.baud)?;
            let mut line = Maintenance::new(transport, ward.baud)?.knowing(profiles);
            line.release(&*begun.clock)?;
            begun.lines.push(line);
            for joint in joints {
                begun.take(joint, profiles)?;
            }
        }
        Ok(begun)
    }

    /// Looks at the servo of a joint on the line opened last.
    fn take(&mut self, joint: PuppetJoint, profiles: &Profiles) -> Result<(), CalibrationError> {
        let line = self.lines.len() - 1;
        let model = profiles.servo(&joint.model)?;
        let found = self.lines[line].ping(joint.id, &*self.clock)?;
        if found.model_number != model.model_number {
            return Err(CalibrationError::OtherModel {
                joint: joint.name,
                wanted: model.name.clone(),
                found: found.model_number,
            });
        }
        let model = model.at_firmware(found.firmware).into_owned();
        self.lines[line].loosen(&model, joint.id, &*self.clock)?;
        let mut seat = Seat {
            line,
            bearings: Bearings::default(),
            idle_offset: false,
            sweep: Sweep::new(model.counts_per_turn),
            lost: 0,
            model,
            joint,
        };
        if self
            .read(&seat, Role::TorqueEnable)?
            .is_some_and(|torque| torque != 0)
        {
            return Err(CalibrationError::StillHolds {
                joint: seat.joint.name,
            });
        }
        let offset = self.read(&seat, Role::HomingOffset)?;
        seat.idle_offset = seat.model.protocol == ServoProtocol::Dynamixel2
            && self.read(&seat, Role::OperatingMode)? == Some(POSITION_MODE)
            && offset.is_some_and(|offset| offset.abs() > OFFSET_MAX_COUNTS);
        let low = self.read(&seat, Role::MinPosition)?;
        let high = self.read(&seat, Role::MaxPosition)?;
        seat.bearings = Bearings {
            homing_offset: if seat.idle_offset { Some(0) } else { offset },
            limits: low.zip(high).map(|(low, high)| [low, high]),
        };
        self.seats.push(seat);
        Ok(())
    }

    /// One register of a joint's servo, if it has it.
    fn read(&mut self, seat: &Seat, role: Role) -> Result<Option<i64>, MaintenanceError> {
        let Some(row) = seat.model.role(role) else {
            return Ok(None);
        };
        self.lines[seat.line]
            .read_register(&seat.model, seat.joint.id, &row.name, &*self.clock)
            .map(Some)
    }

    /// The puppet, as its profile was.
    pub fn puppet(&self) -> &PuppetProfile {
        &self.puppet
    }

    /// Reads where every joint is. A servo that does not answer is asked again next time.
    pub fn sample(&mut self) -> Result<(), CalibrationError> {
        let mut seats = std::mem::take(&mut self.seats);
        let mut failed = Ok(());
        for seat in &mut seats {
            match self.read(seat, Role::PresentPosition) {
                Ok(Some(counts)) => seat.sweep.add(counts),
                Ok(None) | Err(MaintenanceError::Silent { .. } | MaintenanceError::Refused { .. }) => {
                    seat.lost += 1;
                }
                Err(error) => failed = Err(error.into()),
            }
        }
        self.seats = seats;
        failed
    }

    /// Every joint stands at its zero now; the way each goes next is its positive one.
    pub fn mark_zero(&mut self) {
        for seat in &mut self.seats {
            seat.sweep.mark_zero();
        }
    }

    /// Where the sweep stands.
    pub fn sweeps(&self) -> Vec<SweepView> {
        let seen = self.seats.iter().map(|seat| SweepView {
            joint: seat.joint.name.clone(),
            now_counts: seat.sweep.now_counts(),
            span_rad: seat.sweep.span_counts() * seat.model.rad_per_count(),
            jumps: seat.sweep.jumps(),
            lost: seat.lost,
        });
        seen.collect()
    }

    /// What the sweep tells of every joint.
    pub fn propose(&self, reading: Reading) -> Vec<Proposal> {
        let proposals = self.seats.iter().map(|seat| {
            let joint = &seat.joint;
            let mut sweep = seat.sweep.clone();
            if reading.zero == Zero::Middle {
                let middle_rad = f64::midpoint(joint.min_rad, joint.max_rad);
                let off_counts = f64::from(joint.sign) * middle_rad / seat.model.rad_per_count();
                sweep.zero_below_middle(off_counts);
            }
            let wish = Wish {
                sign: joint.sign,
                range_rad: [joint.min_rad, joint.max_rad],
                sign_from_first_way: !reading.keep_signs && reading.zero == Zero::Marked,
            };
            let mut plan = plan(&seat.model, seat.bearings, wish, &sweep);
            if let (Ok(plan), true) = (&mut plan, seat.idle_offset) {
                plan.homing_offset = Some(0);
            }
            Proposal {
                joint: joint.name.clone(),
                plan,
                before: (joint.zero_counts, joint.sign, wish.range_rad),
            }
        });
        proposals.collect()
    }

    /// The puppet's profile with what is proposed; refusals leave a joint as it was.
    pub fn calibrated(&self, proposals: &[Proposal]) -> PuppetProfile {
        let mut puppet = self.puppet.clone();
        let joints = puppet.groups.iter_mut().flat_map(|group| &mut group.joints);
        for joint in joints {
            let of = proposals.iter().find(|proposal| proposal.joint == joint.name);
            if let Some(Ok(plan)) = of.map(|proposal| &proposal.plan) {
                joint.zero_counts = plan.zero_counts;
                joint.sign = plan.sign;
                [joint.min_rad, joint.max_rad] = plan.range_rad;
            }
        }
        puppet
    }

    /// Puts aside what is there, then writes settings and profile. Any refusal refuses the whole: half a calibration
    /// is none.
    pub fn write(&mut self, proposals: &[Proposal], user_folder: &Path) -> Result<Written, CalibrationError> {
        for proposal in proposals {
            if let Err(refusal) = &proposal.plan {
                return Err(CalibrationError::Refused {
                    joint: proposal.joint.clone(),
                    refusal: refusal.clone(),
                });
            }
        }
        let profile = file::place(user_folder, &self.puppet.key);
        let text = file::profile_text(&self.calibrated(proposals))?;
        let backup = self.keep(&profile)?.write(user_folder)?;
        let settings = self
            .write_settings(proposals)
            .map_err(|source| CalibrationError::HalfDone {
                backup: backup.clone(),
                source,
            })?;
        file::put(&profile, &text)?;
        Ok(Written {
            profile,
            backup,
            settings,
        })
    }

    /// All that [`Calibrator::write`] may change, as it is.
    fn keep(&mut self, profile: &Path) -> Result<Backup, CalibrationError> {
        let seats = std::mem::take(&mut self.seats);
        let mut kept = Vec::new();
        let mut failed = None;
        for seat in &seats {
            for role in [Role::HomingOffset, Role::MinPosition, Role::MaxPosition] {
                match self.read(seat, role) {
                    Ok(Some(value)) => kept.push(Kept {
                        joint: seat.joint.name.clone(),
                        bus: seat.joint.bus.clone(),
                        id: seat.joint.id,
                        register: role.to_string(),
                        value,
                    }),
                    Ok(None) => {}
                    Err(error) => failed = Some(error),
                }
            }
        }
        self.seats = seats;
        match failed {
            Some(error) => Err(error.into()),
            None => Backup::new(&self.puppet, profile, kept),
        }
    }

    fn write_settings(&mut self, proposals: &[Proposal]) -> Result<Vec<String>, MaintenanceError> {
        let seats = std::mem::take(&mut self.seats);
        let mut done = Vec::new();
        let mut failed = Ok(());
        for seat in &seats {
            let of = proposals
                .iter()
                .find(|proposal| proposal.joint == seat.joint.name);
            let Some(Ok(plan)) = of.map(|proposal| &proposal.plan) else {
                continue;
            };
            let settings = [
                (Role::HomingOffset, plan.homing_offset),
                (Role::MinPosition, plan.limits.map(|limits| limits[0])),
                (Role::MaxPosition, plan.limits.map(|limits| limits[1])),
            ];
            for (role, value) in settings {
                if let (Some(value), Ok(())) = (value, &failed) {
                    failed = self.set(seat, role, value);
                    done.push(format!(
                        "{role} of {} (id {}) to {value}",
                        seat.joint.name, seat.joint.id
                    ));
                }
            }
        }
        self.seats = seats;
        failed.map(|()| done)
    }

    fn set(&mut self, seat: &Seat, role: Role, value: i64) -> Result<(), MaintenanceError> {
        let Some(row) = seat.model.role(role) else {
            return Ok(());
        };
        self.lines[seat.line].write_register(&seat.model, seat.joint.id, &row.name, value, &*self.clock)
    }

    /// Writes back what a calibration replaced, settings first.
    pub fn restore(&mut self, backup: &Backup) -> Result<Vec<String>, CalibrationError> {
        let seats = std::mem::take(&mut self.seats);
        let mut done = Vec::new();
        let mut failed = Ok(());
        for kept in &backup.settings {
            let seat = seats.iter().find(|seat| seat.joint.name == kept.joint);
            let role = seat.and_then(|seat| {
                let rows = seat.model.registers.iter().filter_map(|row| row.role);
                rows.into_iter().find(|role| role.to_string() == kept.register)
            });
            if let (Some(seat), Some(role), Ok(())) = (seat, role, &failed) {
                failed = self.set(seat, role, kept.value);
                done.push(format!("{} of {} to {}", kept.register, kept.joint, kept.value));
            }
        }
        self.seats = seats;
        failed?;
        backup.restore_profile()?;
        Ok(done)
    }
}
