//! Hands on, and eyes for, the devices behind serial and MIDI functions.

use std::time::Duration;

use anyhow::{Context, ensure};
use firmware_sim::dial_box::Output;
use firmware_sim::hands::{Hands, Touch};
use firmware_sim::{SerialDevice, SgiDialBox};

use super::PATIENCE;
use crate::kernel::cable::{Cable, Watch};
use crate::kernel::function::{Acm, Function, Midi};

/// A function with a device of bytes inside.
pub(super) trait Inside: Function {
    /// Lays a hand on the device. False: it has no such control.
    fn touch(&mut self, now_us: u64, doing: &Touch) -> bool;

    /// Takes what it was made to show.
    fn drain(&mut self, shown: &mut Vec<Output>);
}

impl Inside for Acm<SgiDialBox> {
    fn touch(&mut self, now_us: u64, doing: &Touch) -> bool {
        self.firmware().touch(now_us, doing)
    }

    fn drain(&mut self, shown: &mut Vec<Output>) {
        shown.extend(self.firmware().drain_outputs().map(|(_, output)| output));
    }
}

impl<F: SerialDevice> Inside for Midi<F> {
    fn touch(&mut self, now_us: u64, doing: &Touch) -> bool {
        self.firmware().touch(now_us, doing)
    }

    fn drain(&mut self, shown: &mut Vec<Output>) {
        self.firmware().take_outputs(&mut |_, output| shown.push(output));
    }
}

/// Lays a hand on it.
pub(super) fn touch(cable: &Cable<impl Inside + 'static>, doing: &Touch) -> anyhow::Result<()> {
    let done = cable.with(|function, now_us| function.touch(now_us, doing));
    done.then_some(())
        .with_context(|| format!("no such control: {doing:?}"))
}

/// Puts the cable in again: the device had no power meanwhile.
pub(super) fn replug(cable: &Cable<impl Inside + 'static>) -> anyhow::Result<()> {
    touch(cable, &Touch::PowerCycle)?;
    cable.plug(true);
    Ok(())
}

/// Everything it was made to show since the last call.
pub(super) fn shown(cable: &Cable<impl Inside + 'static>) -> Vec<Output> {
    let mut shown = Vec::new();
    cable.with(|function, now_us| {
        // Hearing is a part of living: the device is looked at up to now.
        function.touch(now_us, &Touch::Noise(0));
        function.drain(&mut shown);
    });
    shown
}

/// Waits until it is made to show something, among other things.
pub(super) fn until_shown(
    watch: &Watch,
    cable: &Cable<impl Inside + 'static>,
    wanted: &Output,
) -> anyhow::Result<()> {
    let until_us = watch.now_us() + PATIENCE.as_micros() as u64;
    let mut all = Vec::new();
    while !all.contains(wanted) {
        all.extend(shown(cable));
        ensure!(
            watch.now_us() < until_us,
            "it was to show {wanted:?}, and showed {all:?}"
        );
        watch.pause(Duration::from_millis(5));
    }
    Ok(())
}
