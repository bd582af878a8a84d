//! What the host wants shown, through its own device, codec and line, to what the device behind the kernel shows.

use std::sync::Arc;
use std::time::Duration;

use anyhow::{bail, ensure};
use device::clock::{Clock, MonotonicClock};
use device::codec::{Feedback, RingStyle};
use device::discovery::{self, Places};
use device::{Device, Health};
use device_profiles::{InputProfile, Profiles};
use firmware_sim::dial_box::{Options, Output};
use firmware_sim::midi_box::Glow;
use firmware_sim::usb_device::Shown;
use firmware_sim::{MidiShown, SgiDialBox};

use super::boxes::{replug, shown};
use super::open::{find_one, plugged, with};
use super::{Claim, PATIENCE, midi, same, serial};
use crate::kernel::cable::{Cable, Watch};
use crate::kernel::function::Acm;

pub(super) const CLAIMS: &[Claim] = &[
    Claim {
        name: "feedback: the brightness wanted of a PowerMate's lamp is its brightness, before and after the cable was out",
        show: lamp,
    },
    Claim {
        name: "feedback: rings and lamps of an X-Touch Mini are lit as wanted, before and after the cable was out",
        show: rings,
    },
];

pub(super) const SERIAL_CLAIMS: &[Claim] = &[Claim {
    name: "feedback: labels and lamps of a dial box with a display are as wanted, before and after the cable was out",
    show: labels,
}];

/// An input device of the host, looked at as the rig does.
struct Seat {
    device: Device,
    profile: InputProfile,
    clock: Arc<dyn Clock>,
}

impl Seat {
    /// The device of `profile` at `address`, answering.
    fn take(watch: &Watch, profile: &str, address: &str) -> anyhow::Result<Self> {
        let profiles = Profiles::builtin();
        let profile = profiles.input(profile)?.clone();
        let clock: Arc<dyn Clock> = Arc::new(MonotonicClock::new());
        let line = discovery::open(
            &Places::default(),
            &address.parse()?,
            profile.line.as_ref(),
            &clock,
        )?;
        let device = Device::of_profile("here", &profile, line)?;
        let mut seat = Self {
            device,
            profile,
            clock,
        };
        seat.until(watch, Health::Present)?;
        Ok(seat)
    }

    /// Looks at it once.
    fn look(&mut self) -> Health {
        self.device.poll(self.clock.now(), &mut Vec::new())
    }

    /// Looks at it until it is so.
    fn until(&mut self, watch: &Watch, wanted: Health) -> anyhow::Result<()> {
        let until_us = watch.now_us() + PATIENCE.as_micros() as u64;
        loop {
            let health = self.look();
            if health == wanted {
                return Ok(());
            }
            if watch.now_us() > until_us {
                bail!("{health:?}, not {wanted:?}: {:?}", self.device.trouble());
            }
            watch.pause(Duration::from_millis(2));
        }
    }

    /// Goes on with a new line to the same device.
    fn come_back(&mut self, watch: &Watch, address: &str) -> anyhow::Result<()> {
        let line = self.profile.line.as_ref();
        let line = discovery::open(&Places::default(), &address.parse()?, line, &self.clock)?;
        self.device.reconnect(line);
        self.until(watch, Health::Present)
    }

    /// Wants something shown, and looks at the device until `shown` tells it; what else was told before.
    fn shows<T: PartialEq + std::fmt::Debug>(
        &mut self,
        watch: &Watch,
        feedback: &[Feedback],
        wanted: &[T],
        shown: impl Fn() -> Vec<T>,
    ) -> anyhow::Result<Vec<T>> {
        for one in feedback {
            self.device.show(one)?;
        }
        let until_us = watch.now_us() + PATIENCE.as_micros() as u64;
        let mut all = Vec::new();
        while !wanted.iter().all(|one| all.contains(one)) {
            // A codec may have to wait before it can send.
            self.look();
            all.extend(shown());
            ensure!(
                watch.now_us() < until_us,
                "it was to show {wanted:?}, and showed {all:?}"
            );
            watch.pause(Duration::from_millis(2));
        }
        Ok(all)
    }
}

fn lamp(watch: &Watch) -> anyhow::Result<()> {
    let cable = plugged("powermate", 1, watch)?;
    let mut seat = Seat::take(watch, "powermate", &find_one(watch, "powermate")?.address)?;
    let shown = || -> Vec<Shown> {
        let new = with(&cable, |device, _| device.drain_shown());
        new.into_iter().map(|(_, shown)| shown).collect()
    };
    let mut all = Vec::new();
    let levels = [0x80, 0x01, 0xFF, 0x20];
    for level in levels {
        all.extend(seat.shows(watch, &[light(0, level)], &[Shown::Level(level)], shown)?);
    }
    same(
        &all,
        &levels.map(Shown::Level).to_vec(),
        "everything it was made to show",
    )?;
    cable.plug(false);
    seat.until(watch, Health::Lost)?;
    // Wanted while it is away: shown when it is back, and nothing older.
    seat.device.show(&light(0, 0x66))?;
    cable.plug(true);
    seat.come_back(watch, &find_one(watch, "powermate")?.address)?;
    let all = seat.shows(watch, &[], &[Shown::Level(0x66)], shown)?;
    same(&all, &vec![Shown::Level(0x66)], "what it shows after its return")
}

fn light(control: u16, level: u8) -> Feedback {
    Feedback::Lamp {
        control,
        level,
        colour: None,
    }
}

fn rings(watch: &Watch) -> anyhow::Result<()> {
    let cable = midi::x_touch(watch);
    let mut seat = Seat::take(watch, "x-touch-mini", &find_one(watch, "x-touch-mini")?.address)?;
    let ring = Feedback::Ring {
        control: 2,
        value: Some(0.5),
        style: RingStyle::Dot,
    };
    // The middle one of thirteen; the buttons of the rows follow eight pushes.
    let middle = MidiShown::Ring {
        control: 2,
        lamps: 1 << 6,
        blinking: false,
    };
    let lit = |control| MidiShown::Lamp {
        control,
        glow: Glow::On,
    };
    let wanted = [middle, lit(8), lit(23)].map(Output::Midi);
    let feedback = [ring, light(0, 255), light(15, 255)];
    seat.shows(watch, &feedback, &wanted, || shown(&cable))?;
    cable.plug(false);
    seat.until(watch, Health::Lost)?;
    replug(&cable)?;
    seat.come_back(watch, &find_one(watch, "x-touch-mini")?.address)?;
    seat.shows(watch, &[], &wanted, || shown(&cable))?;
    Ok(())
}

fn labels(watch: &Watch) -> anyhow::Result<()> {
    let options = Options {
        labels: true,
        ..Options::default()
    };
    let cable = Cable::plug_in(Acm::new(SgiDialBox::new(options), serial::BOX), 9, watch);
    let port = serial::port(watch, serial::BOX[2])?;
    let mut seat = Seat::take(watch, "sgi-dialbox-display", &port)?;
    let label = Feedback::Label {
        control: 0,
        text: "ELBOW".to_owned(),
    };
    let written = Output::Label {
        control: 0,
        text: "ELBOW   ".to_owned(),
    };
    let wanted = [written, Output::Lamps(1 << 5)];
    seat.shows(watch, &[label, Feedback::Lamps(1 << 5)], &wanted, || {
        shown(&cable)
    })?;
    cable.plug(false);
    seat.until(watch, Health::Lost)?;
    replug(&cable)?;
    let port = serial::port(watch, serial::BOX[2])?;
    seat.come_back(watch, &port)?;
    seat.shows(watch, &[], &wanted, || shown(&cable))?;
    Ok(())
}
