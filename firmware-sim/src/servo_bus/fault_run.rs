//! Faults while they last: when they begin and end, and what they do to servos and bytes.

use super::bus::ServoBus;
use super::fault::{Fault, FaultKind};
use super::hardware::Supply;

/// Parts in a whole for the shares of faults.
const MILLION: u32 = 1_000_000;

/// A fault that has been brought in.
#[derive(Clone, Copy, Debug)]
pub(super) struct Running {
    fault: Fault,
    from_ns: u64,
    until_ns: Option<u64>,
    begun: bool,
    over: bool,
}

impl Running {
    pub(super) fn new(fault: Fault, now_ns: u64) -> Self {
        let from_ns = now_ns + fault.at_us.unwrap_or(0) * 1000;
        Self {
            fault,
            from_ns,
            until_ns: fault.for_us.map(|us| from_ns + us * 1000),
            begun: false,
            over: false,
        }
    }

    /// When it next begins or ends.
    fn next_ns(&self) -> Option<u64> {
        match (self.begun, self.over) {
            (_, true) => None,
            (false, false) => Some(self.from_ns),
            (true, false) => self.until_ns,
        }
    }

    fn lasts(&self) -> bool {
        self.begun && !self.over
    }
}

impl ServoBus {
    /// When the next fault begins or ends.
    pub(super) fn next_fault_ns(&self) -> Option<u64> {
        self.faults.iter().filter_map(Running::next_ns).min()
    }

    /// Begins and ends every fault due at `at_ns`.
    pub(super) fn change_faults(&mut self, at_ns: u64) {
        for index in 0..self.faults.len() {
            let running = &mut self.faults[index];
            if running.next_ns().is_none_or(|due| due > at_ns) {
                continue;
            }
            let kind = running.fault.kind;
            if running.begun {
                running.over = true;
                self.end_fault(at_ns, kind);
            } else {
                running.begun = true;
                running.over = matches!(kind, FaultKind::Reboot(_) | FaultKind::HardwareError(..));
                self.begin_fault(at_ns, kind);
            }
        }
        self.faults.retain(|running| !running.over);
    }

    /// Ends what lasts and forgets what was to come.
    pub(super) fn end_all_faults(&mut self, at_ns: u64) {
        for running in std::mem::take(&mut self.faults) {
            if running.lasts() {
                self.end_fault(at_ns, running.fault.kind);
            }
        }
    }

    fn begin_fault(&mut self, at_ns: u64, kind: FaultKind) {
        match kind {
            FaultKind::Stuck(id) => self.each(id, |servo| {
                servo.advance(at_ns);
                servo.plant.stuck = true;
            }),
            FaultKind::Silent(id) => self.each(id, |servo| servo.silent = true),
            FaultKind::Hot(id, celsius) => self.each(id, |servo| servo.set_temperature(at_ns, Some(celsius))),
            FaultKind::HardwareError(id, bits) => self.each(id, |servo| servo.raise(at_ns, bits)),
            FaultKind::Load(id, share) => self.each(id, |servo| {
                servo.advance(at_ns);
                servo.plant.load = share;
            }),
            FaultKind::Reboot(id) => self.each(id, |servo| servo.reboot(at_ns)),
            FaultKind::CableCut(after) => self.cut_after(at_ns, after),
            FaultKind::Supply(volts) => {
                for servo in &mut self.servos {
                    servo.set_supply(
                        at_ns,
                        Supply {
                            volts,
                            ..servo.supply
                        },
                    );
                }
            }
            FaultKind::Echo
            | FaultKind::Drop(_)
            | FaultKind::Late(_)
            | FaultKind::Noise(_)
            | FaultKind::Stall => {}
        }
    }

    fn end_fault(&mut self, at_ns: u64, kind: FaultKind) {
        match kind {
            FaultKind::Stuck(id) => self.each(id, |servo| {
                servo.advance(at_ns);
                servo.plant.stuck = false;
            }),
            FaultKind::Silent(id) => self.each(id, |servo| servo.silent = false),
            FaultKind::Hot(id, _) => self.each(id, |servo| servo.set_temperature(at_ns, None)),
            FaultKind::Load(id, _) => self.each(id, |servo| {
                servo.advance(at_ns);
                servo.plant.load = 0.0;
            }),
            FaultKind::CableCut(_) => self.cut_after(at_ns, usize::MAX),
            FaultKind::Supply(_) => {
                for servo in &mut self.servos {
                    let volts = servo.nominal_volts();
                    servo.set_supply(
                        at_ns,
                        Supply {
                            volts,
                            ..servo.supply
                        },
                    );
                }
            }
            _ => {}
        }
    }

    fn cut_after(&mut self, at_ns: u64, after: usize) {
        for (place, servo) in self.servos.iter_mut().enumerate() {
            servo.set_supply(
                at_ns,
                Supply {
                    cable: place < after,
                    ..servo.supply
                },
            );
        }
    }

    fn each(&mut self, id: u8, mut act: impl FnMut(&mut super::servo::Servo)) {
        self.servos
            .iter_mut()
            .filter(|servo| servo.id() == id)
            .for_each(&mut act);
    }

    /// Whether the answer about to be sent is lost.
    pub(super) fn loses_answer(&mut self) -> bool {
        let mut lost = false;
        for running in self.faults.iter_mut().filter(|running| running.lasts()) {
            if let FaultKind::Drop(ppm) = running.fault.kind
                && self.random.u32(0..MILLION) < ppm
            {
                lost = true;
                running.over = running.fault.once;
            }
        }
        lost
    }

    /// How much later the answer about to be sent begins.
    pub(super) fn lateness_ns(&mut self) -> u64 {
        let mut late_ns = 0;
        for running in self.faults.iter_mut().filter(|running| running.lasts()) {
            if let FaultKind::Late(us) = running.fault.kind {
                late_ns += us * 1000;
                running.over = running.fault.once;
            }
        }
        late_ns
    }

    /// `byte` as it arrives.
    pub(super) fn through_noise(&mut self, byte: u8) -> u8 {
        let mut byte = byte;
        for running in self.faults.iter_mut().filter(|running| running.lasts()) {
            if let FaultKind::Noise(ppm) = running.fault.kind
                && self.random.u32(0..MILLION) < ppm
            {
                byte ^= 1 << self.random.u32(0..8);
                running.over = running.fault.once;
            }
        }
        byte
    }

    /// Whether a fault of this kind lasts.
    pub(super) fn suffers(&self, kind: FaultKind) -> bool {
        self.faults
            .iter()
            .any(|running| running.lasts() && running.fault.kind == kind)
    }
}
