//! Several interfaces of one device as one line: some tablets have their pen on one and their keys on another.

use super::{Boundary, Transport, TransportError};
use crate::clock::Instant;
use crate::codec::outline::{Outline, ReportKind};

/// Lines of reports that belong together. The first is the device's own: strings and its descriptor are asked there.
pub struct Merged {
    lines: Vec<(Outline, Box<dyn Transport>)>,
    /// The line asked next, so that a busy one cannot silence the others.
    next: usize,
    arrived: Option<Instant>,
}

impl Merged {
    /// One line out of `lines`; none, if there are none.
    pub fn new(lines: Vec<Box<dyn Transport>>) -> Option<Self> {
        let outlined = lines.into_iter().map(|mut line| {
            let descriptor = line.report_descriptor().unwrap_or_default();
            (Outline::of(&descriptor), line)
        });
        let lines: Vec<_> = outlined.collect();
        (!lines.is_empty()).then_some(Self {
            lines,
            next: 0,
            arrived: None,
        })
    }

    fn own(&mut self) -> &mut dyn Transport {
        // There is one: `new` saw to it.
        self.lines[0].1.as_mut()
    }

    /// The line that has this report; the first where none says so.
    fn with(&mut self, kind: ReportKind, id: u8) -> &mut dyn Transport {
        let place = self
            .lines
            .iter()
            .position(|(outline, _)| outline.bytes(kind, id).is_some());
        self.lines[place.unwrap_or(0)].1.as_mut()
    }
}

impl Transport for Merged {
    fn boundary(&self) -> Boundary {
        Boundary::Reports
    }

    fn read(&mut self, buffer: &mut [u8]) -> Result<usize, TransportError> {
        for _ in 0..self.lines.len() {
            let turn = self.next;
            self.next = (turn + 1) % self.lines.len();
            let (_, line) = &mut self.lines[turn];
            // Where one is gone the device is.
            let count = line.read(buffer)?;
            if count > 0 {
                self.arrived = line.arrived();
                return Ok(count);
            }
        }
        Ok(0)
    }

    fn write(&mut self, bytes: &[u8]) -> Result<(), TransportError> {
        let id = bytes.first().copied().unwrap_or(0);
        self.with(ReportKind::Output, id).write(bytes)
    }

    fn write_feature(&mut self, bytes: &[u8]) -> Result<Option<()>, TransportError> {
        let id = bytes.first().copied().unwrap_or(0);
        self.with(ReportKind::Feature, id).write_feature(bytes)
    }

    fn read_feature(&mut self, id: u8, buffer: &mut [u8]) -> Result<Option<usize>, TransportError> {
        self.with(ReportKind::Feature, id).read_feature(id, buffer)
    }

    fn read_string(&mut self, index: u8) -> Result<Option<Vec<u8>>, TransportError> {
        self.own().read_string(index)
    }

    fn report_descriptor(&mut self) -> Result<Vec<u8>, TransportError> {
        self.own().report_descriptor()
    }

    fn arrived(&self) -> Option<Instant> {
        self.arrived
    }

    fn dropped(&self) -> u64 {
        self.lines.iter().map(|(_, line)| line.dropped()).sum()
    }

    fn ready(&mut self) -> bool {
        self.lines.iter_mut().any(|(_, line)| line.ready())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::transport::memory::reports::{self, Noticed};

    #[test]
    fn all_are_heard_in_turn_and_each_gets_its_own_reports() {
        let (pen, pen_far) = reports::pair("sim:pen");
        let (pad, pad_far) = reports::pair("sim:pad");
        pad_far.set_descriptor(&[0x85, 9, 0x75, 8, 0x95, 3, 0x91, 2]);
        let mut line = Merged::new(vec![Box::new(pen), Box::new(pad)]).expect("two");
        for n in 0..3 {
            pen_far.report_at(&[1, n], Instant::from_nanos(n.into()));
        }
        pad_far.report(&[2, 0]);
        let mut buffer = [0; 8];
        let mut ids = Vec::new();
        while line.read(&mut buffer).expect("both are there") > 0 {
            ids.push(buffer[0]);
        }
        assert_eq!(ids, [1, 2, 1, 1], "the busy one does not silence the other");
        line.write(&[9, 1]).expect("it is there");
        line.write(&[7, 1]).expect("it is there");
        assert_eq!(pad_far.noticed(), Some(Noticed::Output(vec![9, 1])));
        assert_eq!(pen_far.noticed(), Some(Noticed::Output(vec![7, 1])));
        drop(pad_far);
        assert!(line.read(&mut buffer).expect_err("one half is gone").is_gone());
        assert!(Merged::new(Vec::new()).is_none());
    }
}
