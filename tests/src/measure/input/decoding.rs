//! Bytes to events: time and allocations for each, in every layout.

use super::super::rig_step::nanos_per;
use super::frames::{LAYOUTS, described, described_reports};
use super::recorded;
use device::codec::Codec;
use std::hint::black_box;

/// Times all reports of a layout are gone through in one repetition: long enough that reading the clock does not count.
const TIMES: usize = 40;

/// One layout or format with what devices say in it.
pub(super) struct Decoded {
    pub(super) name: String,
    codec: Box<dyn Codec>,
    reports: Vec<Vec<u8>>,
    /// Events that all its reports make together.
    events: usize,
}

/// All layouts and formats by their exchanges; then reports that each make an event: of layouts again, of boxes that
/// have none, and of the pen that describes itself.
pub(super) fn all() -> anyhow::Result<Vec<Decoded>> {
    let mut all = Vec::new();
    for one in recorded::all()? {
        all.push((one.name, one.codec, one.pieces, 1));
    }
    let moving = |name: &str, codec, reports: Vec<Vec<u8>>| {
        let least = reports.len();
        (format!("{name}, moving"), codec, reports, least)
    };
    for layout in &LAYOUTS {
        all.push(moving(layout.name, layout.codec()?, layout.reports()));
    }
    all.push(moving("descriptor", described()?, described_reports()));
    all.into_iter()
        .map(|(name, mut codec, reports, least)| {
            // The first round settles what only the first report tells.
            decode(codec.as_mut(), &reports);
            let events = decode(codec.as_mut(), &reports);
            anyhow::ensure!(
                events >= least,
                "{name}: {events} events of {} reports",
                reports.len()
            );
            Ok(Decoded {
                name,
                codec,
                reports,
                events,
            })
        })
        .collect()
}

fn decode(codec: &mut dyn Codec, reports: &[Vec<u8>]) -> usize {
    let mut events = 0;
    for report in reports {
        codec.decode(black_box(report), &mut |event| {
            black_box(event);
            events += 1;
        });
    }
    events
}

impl Decoded {
    /// Nanoseconds for each event.
    pub(super) fn nanos(&mut self) -> f64 {
        let (codec, reports) = (self.codec.as_mut(), &self.reports);
        nanos_per(self.events * TIMES, || {
            for _ in 0..TIMES {
                black_box(decode(codec, reports));
            }
        })
    }

    /// Allocations for each event.
    pub(super) fn allocations(&mut self) -> f64 {
        let (codec, reports) = (self.codec.as_mut(), &self.reports);
        let counted = allocation_counter::measure(|| {
            black_box(decode(codec, reports));
        });
        counted.count_total as f64 / self.events as f64
    }
}
