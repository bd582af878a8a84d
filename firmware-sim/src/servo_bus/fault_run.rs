//! Faults while they last: when they begin and end, and what they do to servos and bytes.

use super::bus::ServoBus;
use super::fault::{BusFault, Fault, FaultKind, ServoFault};
use super::hardware::Supply;
use super::wire::Adapter;

/// Parts in a whole for the shares of faults.
const MILLION: u32 = 1_000_000;

/// How soon after an instruction a servo babbles, and how many bytes at most. Ours.
const BABBLE_NS: u64 = 1_000_000;
const BABBLE_BYTES: usize = 8;

/// A fault that has been brought in.
#[derive(Clone, Debug)]
pub(super) struct Running {
    fault: Fault,
    from_ns: u64,
    until_ns: Option<u64>,
    begun: bool,
    over: bool,
    /// Places in the chain of the servos it has, with what each was before.
    struck: Vec<(usize, i64)>,
    adapter_before: Option<Adapter>,
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
            struck: Vec::new(),
            adapter_before: None,
        }
    }

    /// When it next begins or ends.
    fn next_ns(&self) -> Option<u64> {
        match (self.begun, self.over) {
            (_, true) => self.fault.every_us.map(|us| self.from_ns + us * 1000),
            (false, false) => Some(self.from_ns),
            (true, false) => self.until_ns,
        }
    }

    fn lasts(&self) -> bool {
        self.begun && !self.over
    }

    /// It is over and comes again.
    fn come_again(&mut self) {
        self.from_ns += self.fault.every_us.unwrap_or(0) * 1000;
        self.until_ns = self.fault.for_us.map(|us| self.from_ns + us * 1000);
        (self.begun, self.over) = (false, false);
    }
}

impl ServoBus {
    /// Brings in `fault`; its times count from `now_us`.
    pub fn inject(&mut self, now_us: u64, fault: &Fault) {
        let now_ns = self.catch_up(now_us);
        self.faults.push(Running::new(*fault, now_ns));
        self.advance(now_ns);
    }

    /// Why `fault` would do nothing on this bus, if so. Of a later one nobody can tell: by then there may be a servo
    /// with that number.
    pub fn misfit(&self, fault: &Fault) -> Option<String> {
        match fault.kind {
            FaultKind::Servo(id, _) if fault.at_us.is_none() && self.servo(id).is_none() => {
                Some(self.nobody(id))
            }
            _ => None,
        }
    }

    pub(super) fn nobody(&self, id: u8) -> String {
        let ids: Vec<String> = self.servos.iter().map(|servo| servo.id().to_string()).collect();
        format!("there is no servo {id}; there are: {}", ids.join(", "))
    }

    /// Ends every fault that lasts or is still to come. What it has done stays done.
    pub fn mend(&mut self, now_us: u64) {
        let now_ns = self.catch_up(now_us);
        for running in std::mem::take(&mut self.faults) {
            if running.lasts() {
                self.end_fault(now_ns, &running);
            }
        }
    }

    /// When the next fault begins or ends.
    pub(super) fn next_fault_ns(&self) -> Option<u64> {
        self.faults.iter().filter_map(Running::next_ns).min()
    }

    /// Begins and ends every fault due at `at_ns`.
    pub(super) fn change_faults(&mut self, at_ns: u64) {
        let mut faults = std::mem::take(&mut self.faults);
        for running in &mut faults {
            if running.next_ns().is_none_or(|due| due > at_ns) {
                continue;
            }
            if running.over {
                running.come_again();
            }
            if running.begun {
                running.over = true;
                self.end_fault(at_ns, running);
            } else {
                running.begun = true;
                running.over = running.fault.kind.is_momentary();
                self.begin_fault(at_ns, running);
            }
        }
        faults.retain(|running| !running.over || running.fault.every_us.is_some());
        self.faults = faults;
    }

    fn begin_fault(&mut self, at_ns: u64, running: &mut Running) {
        match running.fault.kind {
            FaultKind::Servo(id, fault) => self.strike(at_ns, Some(id), fault, &mut running.struck),
            FaultKind::Everyone(fault) => self.strike(at_ns, None, fault, &mut running.struck),
            FaultKind::Bus(fault) => match fault {
                BusFault::CableCut(after) => self.cut_after(at_ns, after),
                BusFault::DataCut(after) => self.set_data_reach(after),
                BusFault::Supply(volts) => self.set_volts(at_ns, Some(volts)),
                BusFault::Resistance(ohms) => self.set_resistance(at_ns, ohms),
                BusFault::AdapterLatency(us) => {
                    let slow = Adapter {
                        latency_us: us as u32,
                        ..Adapter::default()
                    };
                    running.adapter_before = self.wire.adapter.replace(slow);
                }
                BusFault::HostStall => {
                    let until_ns = running.until_ns.unwrap_or(u64::MAX);
                    self.wire.hold_host_until(until_ns);
                }
                BusFault::Echo
                | BusFault::Drop(_)
                | BusFault::Late(_)
                | BusFault::Noise(_)
                | BusFault::Stall => {}
            },
        }
    }

    fn end_fault(&mut self, at_ns: u64, running: &Running) {
        match running.fault.kind {
            FaultKind::Servo(_, fault) | FaultKind::Everyone(fault) => {
                for &(place, before) in &running.struck {
                    self.servos[place].recover(at_ns, fault, before);
                }
            }
            FaultKind::Bus(fault) => match fault {
                BusFault::CableCut(_) => self.cut_after(at_ns, usize::MAX),
                BusFault::DataCut(_) => self.set_data_reach(usize::MAX),
                BusFault::Supply(_) => self.set_volts(at_ns, None),
                BusFault::Resistance(_) => self.set_resistance(at_ns, 0.0),
                BusFault::AdapterLatency(_) => self.wire.adapter = running.adapter_before,
                BusFault::HostStall => self.wire.hold_host_until(at_ns),
                _ => {}
            },
        }
    }

    fn strike(&mut self, at_ns: u64, id: Option<u8>, fault: ServoFault, struck: &mut Vec<(usize, i64)>) {
        struck.clear();
        for (place, servo) in self.servos.iter_mut().enumerate() {
            if id.is_none_or(|id| servo.id() == id) {
                struck.push((place, servo.suffer(at_ns, fault)));
            }
        }
    }

    fn set_volts(&mut self, at_ns: u64, volts: Option<f64>) {
        for servo in &mut self.servos {
            let volts = volts.unwrap_or_else(|| servo.nominal_volts());
            servo.set_supply(
                at_ns,
                Supply {
                    volts,
                    ..servo.supply
                },
            );
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

    fn set_data_reach(&mut self, after: usize) {
        for (place, servo) in self.servos.iter_mut().enumerate() {
            servo.supply.data = place < after;
        }
    }

    /// Whether the answer of `id` that is about to be sent is lost.
    pub(super) fn loses_answer(&mut self, id: u8) -> bool {
        let mut lost = false;
        for running in self.faults.iter_mut().filter(|running| running.lasts()) {
            let ppm = match running.fault.kind {
                FaultKind::Bus(BusFault::Drop(ppm)) | FaultKind::Everyone(ServoFault::Drop(ppm)) => ppm,
                FaultKind::Servo(its, ServoFault::Drop(ppm)) if its == id => ppm,
                _ => continue,
            };
            if self.random.u32(0..MILLION) < ppm {
                lost = true;
                running.over = running.fault.once;
            }
        }
        lost
    }

    /// How much later the answer of `id` that is about to be sent begins.
    pub(super) fn lateness_ns(&mut self, id: u8) -> u64 {
        let mut late_ns = 0;
        for running in self.faults.iter_mut().filter(|running| running.lasts()) {
            let us = match running.fault.kind {
                FaultKind::Bus(BusFault::Late(us)) | FaultKind::Everyone(ServoFault::Late(us)) => us,
                FaultKind::Servo(its, ServoFault::Late(us)) if its == id => us,
                _ => continue,
            };
            late_ns += us * 1000;
            running.over = running.fault.once;
        }
        late_ns
    }

    /// `byte` of servo `id`, or of the host, as it arrives.
    pub(super) fn through_noise(&mut self, id: Option<u8>, byte: u8) -> u8 {
        let mut byte = byte;
        for running in self.faults.iter_mut().filter(|running| running.lasts()) {
            let ppm = match running.fault.kind {
                FaultKind::Bus(BusFault::Noise(ppm)) => ppm,
                FaultKind::Everyone(ServoFault::Flips(ppm)) if id.is_some() => ppm,
                FaultKind::Servo(its, ServoFault::Flips(ppm)) if Some(its) == id => ppm,
                _ => continue,
            };
            if self.random.u32(0..MILLION) < ppm {
                byte ^= 1 << self.random.u32(0..8);
                running.over = running.fault.once;
            }
        }
        byte
    }

    /// An instruction ended at `at_ns`: whoever babbles begins within a moment, whoever else speaks.
    pub(super) fn babble(&mut self, at_ns: u64) {
        for index in 0..self.faults.len() {
            let running = &self.faults[index];
            let struck = match running.fault.kind {
                FaultKind::Servo(_, ServoFault::Babbles) | FaultKind::Everyone(ServoFault::Babbles)
                    if running.lasts() =>
                {
                    running.struck.len()
                }
                _ => continue,
            };
            for nth in 0..struck {
                let (place, _) = self.faults[index].struck[nth];
                if self.servos[place].is_connected() {
                    let start_ns = at_ns + self.random.u64(0..BABBLE_NS);
                    let mut bytes = [0; BABBLE_BYTES];
                    self.random.fill(&mut bytes);
                    let count = self.random.usize(1..=BABBLE_BYTES);
                    self.wire.servos_send(start_ns, &bytes[..count]);
                }
            }
            self.faults[index].over = self.faults[index].fault.once;
        }
    }

    /// Until when the host gets nothing, if it gets nothing now.
    pub(super) fn stalled_until_ns(&self) -> Option<u64> {
        let stalls = [BusFault::Stall, BusFault::HostStall];
        stalls
            .into_iter()
            .filter_map(|stall| self.suffers_until_ns(stall))
            .max()
    }

    /// Whether a fault of the bus lasts, and until when; far away if nobody knows.
    pub(super) fn suffers_until_ns(&self, fault: BusFault) -> Option<u64> {
        let lasting = self
            .faults
            .iter()
            .filter(|running| running.lasts() && running.fault.kind == FaultKind::Bus(fault));
        lasting.map(|running| running.until_ns.unwrap_or(u64::MAX)).max()
    }
}
