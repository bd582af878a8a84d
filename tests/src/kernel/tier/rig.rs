//! A whole rig on a real kernel: what is plugged in drives the network, what is pulled out holds still.

use std::sync::Arc;
use std::time::Duration;

use anyhow::{Context, bail, ensure};
use firmware_sim::NanoKontrol2;
use rig::document::{NetworkFile, Show};
use rig::{
    Command, DeviceHealth, DeviceView, NetworkEdit, Profiles, Rig, RigOptions, Snapshot, SystemPorts,
    ViewCommand,
};

use super::boxes::{replug, shown, touch};
use super::midi::{self, LIT, slide};
use super::{Claim, PATIENCE, same};
use crate::kernel::cable::{Cable, Watch};
use crate::kernel::function::Midi;

pub(super) const CLAIMS: &[Claim] = &[Claim {
    name: "rig: a fader box plugged in drives the view; pulled out the view holds; back it is the same one, its lamp lit, and nothing steps",
    show: fader_box,
}];

/// The first fader on the view's azimuth, 0 to 90 degrees; written before the box was ever there.
const PROGRAM: &str = "s := F:MULC; SEND 90 TO <2>s; CONNECT NANOKONTROL2<1>:<1>s; CONNECT s<1>:<5>VIEW;";
/// Between two steps, as the studio's.
const PERIOD: Duration = Duration::from_millis(10);

/// A rig that is stepped by hand, with the machine's own ports.
struct Bench<'a> {
    watch: &'a Watch,
    rig: Rig,
    seen: Arc<Snapshot>,
}

impl<'a> Bench<'a> {
    fn new(watch: &'a Watch, folder: &std::path::Path) -> anyhow::Result<Self> {
        let show = Show {
            name: "hands".into(),
            networks: vec![Arc::new(NetworkFile {
                name: "hands".into(),
                text: PROGRAM.into(),
            })],
            ..Show::default()
        };
        let profiles = Arc::new(Profiles::builtin());
        let clock = rig::real_time();
        let ports =
            SystemPorts::knowing(Arc::clone(&clock), Arc::clone(&profiles), Some(folder)).watching()?;
        let options = RigOptions {
            show,
            folder: None,
            profiles,
            inputs: Vec::new(),
            calibrations: rig::controls_calibration::Store::in_memory(),
            puppet: None,
            recorder: None,
        };
        let mut bench = Self {
            watch,
            rig: Rig::new(clock, Box::new(ports), options)?,
            seen: Arc::default(),
        };
        bench.step(&[]);
        Ok(bench)
    }

    fn step(&mut self, commands: &[Command]) {
        self.watch.pause(PERIOD);
        self.seen = self.rig.step(&mut commands.iter().cloned());
    }

    fn azimuth_deg(&self) -> f64 {
        self.seen.view.azimuth_rad.to_degrees()
    }

    fn device(&self) -> Option<&DeviceView> {
        self.seen
            .devices
            .iter()
            .find(|device| device.name == "nanokontrol2")
    }

    /// Steps until it is so.
    fn until(&mut self, what: &str, so: impl Fn(&Self) -> bool) -> anyhow::Result<()> {
        let until_us = self.watch.now_us() + PATIENCE.as_micros() as u64;
        while !so(self) {
            if self.watch.now_us() > until_us {
                let devices = self.seen.devices.iter();
                let devices: Vec<_> = devices.map(|device| (&device.name, &device.health)).collect();
                bail!(
                    "waited for {what}: azimuth {:.3}, {devices:?}, notes {:?}",
                    self.azimuth_deg(),
                    self.seen.notes
                );
            }
            self.step(&[]);
        }
        Ok(())
    }

    fn until_health(&mut self, wanted: &DeviceHealth) -> anyhow::Result<()> {
        self.until(&format!("{wanted:?}"), |bench| {
            bench.device().is_some_and(|device| device.health == *wanted)
        })
    }

    /// Slides the first fader, and steps until the rig has heard where it ends.
    fn slide(&mut self, cable: &Cable<Midi<NanoKontrol2>>, to: f64) -> anyhow::Result<()> {
        touch(cable, &slide(0, to, 500_000))?;
        let share = (to * 127.0).round() / 127.0;
        self.until(&format!("the fader at {share:.3}"), |bench| {
            let fader = bench.device().and_then(|device| device.controls.first());
            fader.is_some_and(|fader| (fader.value - share).abs() < 1e-9)
        })?;
        // What it sends is heard with the next step.
        self.step(&[]);
        self.step(&[]);
        Ok(())
    }

    fn is_at(&self, azimuth_deg: f64, when: &str) -> anyhow::Result<()> {
        ensure!(
            (self.azimuth_deg() - azimuth_deg).abs() < 1e-6,
            "{when}: azimuth {:.3}, wanted {azimuth_deg:.3}",
            self.azimuth_deg()
        );
        Ok(())
    }
}

fn fader_box(watch: &Watch) -> anyhow::Result<()> {
    let folder = tempfile::tempdir()?;
    let mut bench = Bench::new(watch, folder.path())?;
    let azimuth_by_rad = 45f64.to_radians() - bench.seen.view.azimuth_rad;
    bench.step(&[Command::View(ViewCommand::Turn {
        azimuth_by_rad,
        elevation_by_rad: 0.0,
    })]);
    let cable = midi::nano(watch);
    bench.until_health(&DeviceHealth::Present)?;
    bench.slide(&cable, 0.2)?;
    bench.is_at(45.0, "a fader that has not reached what it drives")?;
    bench.slide(&cable, 1.0)?;
    bench.is_at(90.0, "a fader that went through what it drives")?;
    // Lamps have the numbers of their controls: eight sliders, eight knobs, then the buttons.
    let lamp = "SEND TRUE TO <17>NANOKONTROL2_LAMP;".to_owned();
    bench.step(&[Command::Network(NetworkEdit::Commands(lamp))]);
    bench.step(&[]);
    bench.until("its lamp lit", |_| shown(&cable).contains(&LIT))?;
    let slot = bench.device().context("it is there")?.slot;
    // Out while it moves.
    touch(&cable, &slide(0, 0.9, 300_000))?;
    bench.until("the fader on its way", |bench| bench.azimuth_deg() < 89.0)?;
    cable.plug(false);
    bench.until_health(&DeviceHealth::Lost)?;
    let held = bench.azimuth_deg();
    let told = |bench: &Bench<'_>| {
        let mut notes = bench.seen.notes.iter();
        notes.any(|note| note.text.contains("what it drives stays where it is"))
    };
    bench.until("a note", told)?;
    touch(&cable, &slide(0, 0.1, 0))?;
    bench.is_at(held, "while it is out")?;
    replug(&cable)?;
    bench.until_health(&DeviceHealth::Present)?;
    let device = bench.device().context("it is there")?;
    same(
        &(device.slot, bench.seen.devices.len()),
        &(slot, 1),
        "it is the same one",
    )?;
    bench.is_at(held, "after its return")?;
    bench.until("its lamp lit again", |_| shown(&cable).contains(&LIT))?;
    bench.slide(&cable, 0.3)?;
    bench.is_at(held, "a first touch after its return")?;
    bench.slide(&cable, 1.0)?;
    bench.slide(&cable, 0.5)?;
    bench.is_at(90.0 * 64.0 / 127.0, "a fader that has taken hold again")
}
