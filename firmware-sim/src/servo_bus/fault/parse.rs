//! From a text to a fault.

use super::words::Words;
use super::{BusFault, Fault, FaultError, FaultKind, ServoFault};

/// Share of bytes that plain `noise` spoils, in parts per million.
const NOISE_PPM: u32 = 10_000;
/// Volts of a plain `brownout`: below what any known model allows, above where its controller stops.
const BROWN_OUT_VOLTS: f64 = 3.2;
/// Degrees of a plain `hot`.
const HOT_C: f64 = 95.0;
/// Most a supply can be set to, volts.
const VOLTS_MAX: f64 = 60.0;

/// Words that begin a fault.
const FIRST: &[&str] = &[
    "servo", "every", "silent", "stuck", "refuse", "firmware", "lock", "cable", "data", "drop", "late",
    "noise", "brownout", "supply", "stall", "host", "echo", "adapter",
];
/// Words that may follow `servo N`.
const OF_A_SERVO: &[&str] = &[
    "stuck", "silent", "deaf", "hot", "error", "load", "carries", "backlash", "jitter", "reboot", "id",
    "baud", "refuses", "firmware", "without", "locked", "unlocked", "has", "drop", "late", "flips",
    "babbles", "drift",
];
/// Words of the times.
const TIMES: &[&str] = &["at", "for", "from", "every", "once"];

/// Every word that begins a fault or says what is wrong with a servo.
#[cfg(test)]
pub(in crate::servo_bus) fn words_of_faults() -> impl Iterator<Item = &'static str> {
    FIRST.iter().chain(OF_A_SERVO).chain(TIMES).copied()
}

impl Fault {
    /// Reads a fault such as `servo 3 stuck at 2s`, `cable cut after 4 at 5s`, `drop 1%`, `late 30ms once`,
    /// `brownout 1s`, `servo 2 silent from 1s to 3s`.
    pub fn parse(text: &str) -> Result<Self, FaultError> {
        let mut words = Words::new(text);
        let mut fault = Self::from(kind(&mut words)?);
        let may_say_how_long = matches!(
            fault.kind,
            FaultKind::Bus(BusFault::Supply(_) | BusFault::Stall | BusFault::HostStall)
        );
        if may_say_how_long && words.a_time_follows() {
            fault.for_us = Some(words.micros()?);
        }
        while !words.is_at_end() {
            fault.when(&mut words)?;
            if fault
                .every_us
                .is_some_and(|every| every <= fault.for_us.unwrap_or(0))
            {
                return Err(words.wrong("the time of `every` to be longer than that of `for`"));
            }
        }
        Ok(fault)
    }

    fn when(&mut self, words: &mut Words<'_>) -> Result<(), FaultError> {
        let expected = "`at TIME`, `for TIME`, `from TIME to TIME`, `every TIME` or `once`";
        match words.one_of(TIMES, expected)? {
            "at" => self.at_us = Some(words.micros()?),
            "for" => self.for_us = Some(words.micros()?),
            "from" => {
                let from_us = words.micros()?;
                words.expect("to")?;
                let span = words.micros()?.checked_sub(from_us).filter(|&span| span > 0);
                self.at_us = Some(from_us);
                self.for_us = Some(span.ok_or_else(|| words.wrong("a later time than the first"))?);
            }
            "every" => self.every_us = Some(words.micros()?),
            _ => self.once = true,
        }
        Ok(())
    }
}

fn kind(words: &mut Words<'_>) -> Result<FaultKind, FaultError> {
    let of = |fault: ServoFault, words: &mut Words<'_>| Ok(FaultKind::Servo(words.id()?, fault));
    let first = words.one_of(
        FIRST,
        "servo, every servo, refuse writes, firmware without fast read, lock left on, cable cut, data cut, drop, late, \
         noise, brownout, supply, stall, host stall, echo or adapter latency",
    )?;
    match first {
        "servo" => {
            let id = words.id()?;
            Ok(FaultKind::Servo(id, of_a_servo(words)?))
        }
        "every" => {
            words.expect("servo")?;
            of_a_servo(words).map(FaultKind::Everyone)
        }
        "silent" => of(ServoFault::Silent, words),
        "stuck" => of(ServoFault::Stuck, words),
        "refuse" => {
            words.expect("writes")?;
            words.expect("servo")?;
            of(ServoFault::RefusesWrites, words)
        }
        "firmware" => {
            without_fast_read(words)?;
            Ok(FaultKind::Everyone(ServoFault::NoFastRead))
        }
        "lock" => {
            words.expect("left")?;
            let on = words.one_of(&["on", "off"], "`on` or `off`")? == "on";
            words.expect("servo")?;
            of(ServoFault::Lock(on), words)
        }
        wire => of_the_bus(wire, words).map(FaultKind::Bus),
    }
}

fn without_fast_read(words: &mut Words<'_>) -> Result<(), FaultError> {
    ["without", "fast", "read"]
        .into_iter()
        .try_for_each(|word| words.expect(word))
}

fn of_the_bus(first: &str, words: &mut Words<'_>) -> Result<BusFault, FaultError> {
    Ok(match first {
        "cable" => match words.with_unit("ohm") {
            Some(ohms) if (0.0..=100.0).contains(&ohms) => BusFault::Resistance(ohms),
            Some(_) => return Err(words.wrong("a resistance from 0 to 100 ohm")),
            None => {
                words.one_of(&["cut"], "`cut` or a resistance such as 0.1ohm")?;
                BusFault::CableCut(after(words)?)
            }
        },
        "data" => {
            words.expect("cut")?;
            BusFault::DataCut(after(words)?)
        }
        "drop" => BusFault::Drop(words.share()?),
        "late" => BusFault::Late(words.micros()?),
        "noise" if words.a_number_follows() => BusFault::Noise(words.share()?),
        "noise" => BusFault::Noise(NOISE_PPM),
        "brownout" if words.a_number_follows() && !words.a_time_follows() => {
            BusFault::Supply(words.number("V", 0.0, VOLTS_MAX)?)
        }
        "brownout" => BusFault::Supply(BROWN_OUT_VOLTS),
        "supply" => BusFault::Supply(words.number("V", 0.0, VOLTS_MAX)?),
        "stall" => BusFault::Stall,
        "host" => {
            words.expect("stall")?;
            BusFault::HostStall
        }
        "echo" => BusFault::Echo,
        _ => {
            words.expect("latency")?;
            BusFault::AdapterLatency(words.micros()?)
        }
    })
}

/// `after K`, the servos of the chain that come before the cut.
fn after(words: &mut Words<'_>) -> Result<usize, FaultError> {
    if words.take("after") { words.place() } else { Ok(0) }
}

fn of_a_servo(words: &mut Words<'_>) -> Result<ServoFault, FaultError> {
    let expected = format!("what is wrong with it: {}", OF_A_SERVO.join(", "));
    Ok(match words.one_of(OF_A_SERVO, &expected)? {
        "stuck" => ServoFault::Stuck,
        "silent" => ServoFault::Silent,
        "deaf" => ServoFault::Deaf,
        "hot" if words.a_number_follows() => ServoFault::Hot(words.number("C", -40.0, 200.0)?),
        "hot" => ServoFault::Hot(HOT_C),
        "error" => ServoFault::HardwareError(words.whole(0, 255)?),
        "load" => load(words)?,
        "carries" => {
            let kg = words.number("kg", 0.0, 100.0)?;
            words.expect("at")?;
            let metres = words.number("m", 0.0, 10.0)?;
            ServoFault::Carries { kg, metres }
        }
        "backlash" => ServoFault::Backlash(words.number("deg", 0.0, 45.0)?),
        "jitter" => ServoFault::Jitter(words.number("", 0.0, 1000.0)?),
        "reboot" => ServoFault::Reboot,
        "id" => ServoFault::Id(words.id()?),
        "baud" => ServoFault::Baud(words.whole(300, 10_000_000)?),
        "refuses" => {
            words.expect("writes")?;
            ServoFault::RefusesWrites
        }
        "firmware" => ServoFault::Firmware(words.whole(0, 255)?),
        "without" => {
            words.expect("fast")?;
            words.expect("read")?;
            ServoFault::NoFastRead
        }
        "locked" => ServoFault::Lock(true),
        "unlocked" => ServoFault::Lock(false),
        "has" => ServoFault::Has(
            words.role()?,
            words.whole(i64::from(i32::MIN), i64::from(i32::MAX))?,
        ),
        "drop" => ServoFault::Drop(words.share()?),
        "late" => ServoFault::Late(words.micros()?),
        "flips" => ServoFault::Flips(words.share()?),
        "babbles" => ServoFault::Babbles,
        _ => ServoFault::Drift(words.number("ppm", -200_000.0, 200_000.0)?.round() as i32),
    })
}

/// A share of what the motor has, or newton metres.
fn load(words: &mut Words<'_>) -> Result<ServoFault, FaultError> {
    if let Some(nm) = words.with_unit("Nm") {
        return if (-1000.0..=1000.0).contains(&nm) {
            Ok(ServoFault::Pull(nm))
        } else {
            Err(words.wrong("a torque from -1000 to 1000 Nm"))
        };
    }
    words.number("", -1.0, 1.0).map(ServoFault::Load)
}
