//! A line inside the program that keeps reports apart and knows features and strings, as HID devices do.

use crate::clock::Instant;
use crate::transport::stamped::StampedQueue;
use crate::transport::{Boundary, Transport, TransportError};
use std::collections::{BTreeMap, VecDeque};
use std::io;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// What the host did that the device noticed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Noticed {
    /// An output report, id first.
    Output(Vec<u8>),
    /// A feature report was set, id first.
    Feature(Vec<u8>),
    /// A feature report was asked for.
    AskedFeature(u8),
    /// A string was asked for.
    AskedString(u8),
}

#[derive(Debug)]
struct Line {
    reports: StampedQueue,
    noticed: VecDeque<Noticed>,
    features: BTreeMap<u8, Vec<u8>>,
    strings: BTreeMap<u8, Vec<u8>>,
    descriptor: Vec<u8>,
    /// Questions that are still answered with "not yet".
    late: u32,
    host_there: bool,
    device_there: bool,
}

/// The host's end.
#[derive(Debug)]
pub struct ReportTransport {
    name: String,
    line: Arc<Mutex<Line>>,
    arrived: Option<Instant>,
}

/// The device's end. Dropping it unplugs the device.
#[derive(Debug)]
pub struct ReportDevice {
    line: Arc<Mutex<Line>>,
}

/// A line with two ends; `name` is the address in errors.
pub fn pair(name: &str) -> (ReportTransport, ReportDevice) {
    let line = Arc::new(Mutex::new(Line {
        reports: StampedQueue::new(),
        noticed: VecDeque::new(),
        features: BTreeMap::new(),
        strings: BTreeMap::new(),
        descriptor: Vec::new(),
        late: 0,
        host_there: true,
        device_there: true,
    }));
    let host = ReportTransport {
        name: name.to_owned(),
        line: Arc::clone(&line),
        arrived: None,
    };
    (host, ReportDevice { line })
}

fn lock(line: &Mutex<Line>) -> MutexGuard<'_, Line> {
    // A panic elsewhere leaves queues, which have no broken state.
    line.lock().unwrap_or_else(PoisonError::into_inner)
}

impl ReportDevice {
    /// Sends a report whose arrival nobody notes.
    pub fn report(&self, bytes: &[u8]) {
        lock(&self.line).reports.push(bytes, None);
    }

    /// Sends a report that arrives at `at`.
    pub fn report_at(&self, bytes: &[u8], at: Instant) {
        lock(&self.line).reports.push(bytes, Some(at));
    }

    /// What the host did next, oldest first.
    pub fn noticed(&self) -> Option<Noticed> {
        lock(&self.line).noticed.pop_front()
    }

    /// Answers the feature report `id` with `bytes`, id first; unset ones are refused.
    pub fn set_feature(&self, id: u8, bytes: &[u8]) {
        lock(&self.line).features.insert(id, bytes.to_vec());
    }

    /// Answers the string `index` with `raw`, head and all; unset ones are refused.
    pub fn set_string(&self, index: u8, raw: &[u8]) {
        lock(&self.line).strings.insert(index, raw.to_vec());
    }

    /// The report descriptor.
    pub fn set_descriptor(&self, bytes: &[u8]) {
        lock(&self.line).descriptor = bytes.to_vec();
    }

    /// Answers the next `looks` questions with "not yet".
    pub fn answer_late(&self, looks: u32) {
        lock(&self.line).late = looks;
    }

    /// Whether the host still has its end.
    pub fn host_there(&self) -> bool {
        lock(&self.line).host_there
    }
}

impl Drop for ReportDevice {
    fn drop(&mut self) {
        lock(&self.line).device_there = false;
    }
}

impl Drop for ReportTransport {
    fn drop(&mut self) {
        lock(&self.line).host_there = false;
    }
}

impl ReportTransport {
    /// The line, unless the device has gone.
    fn there(&self) -> Result<MutexGuard<'_, Line>, TransportError> {
        let line = lock(&self.line);
        if line.device_there {
            return Ok(line);
        }
        drop(line);
        Err(TransportError::Gone {
            address: self.name.clone(),
        })
    }

    fn refused(&self, what: &str) -> TransportError {
        TransportError::Io {
            address: self.name.clone(),
            source: io::Error::other(format!("the device refused {what}")),
        }
    }

    /// Answers a question: what the device has for it, later if it is late.
    fn answer(
        &self,
        question: Noticed,
        find: impl Fn(&Line) -> Option<Vec<u8>>,
    ) -> Result<Option<Vec<u8>>, TransportError> {
        let mut line = self.there()?;
        if line.late > 0 {
            line.late -= 1;
            return Ok(None);
        }
        let words = format!("{question:?}");
        line.noticed.push_back(question);
        let found = find(&line);
        drop(line);
        found.map(Some).ok_or_else(|| self.refused(&words))
    }
}

impl Transport for ReportTransport {
    fn boundary(&self) -> Boundary {
        Boundary::Reports
    }

    fn read(&mut self, buffer: &mut [u8]) -> Result<usize, TransportError> {
        let popped = lock(&self.line).reports.pop(buffer);
        if let Some((count, at)) = popped {
            self.arrived = at;
            return Ok(count);
        }
        // What was sent before the device went is still delivered.
        self.there().map(|_| 0)
    }

    fn write(&mut self, bytes: &[u8]) -> Result<(), TransportError> {
        self.there()?.noticed.push_back(Noticed::Output(bytes.to_vec()));
        Ok(())
    }

    fn write_feature(&mut self, bytes: &[u8]) -> Result<Option<()>, TransportError> {
        let done = self.answer(Noticed::Feature(bytes.to_vec()), |_| Some(Vec::new()))?;
        Ok(done.map(drop))
    }

    fn read_feature(&mut self, id: u8, buffer: &mut [u8]) -> Result<Option<usize>, TransportError> {
        let found = self.answer(Noticed::AskedFeature(id), |line| line.features.get(&id).cloned())?;
        Ok(found.map(|bytes| {
            for (place, byte) in buffer.iter_mut().zip(&bytes) {
                *place = *byte;
            }
            bytes.len().min(buffer.len())
        }))
    }

    fn read_string(&mut self, index: u8) -> Result<Option<Vec<u8>>, TransportError> {
        self.answer(Noticed::AskedString(index), |line| {
            line.strings.get(&index).cloned()
        })
    }

    fn report_descriptor(&mut self) -> Result<Vec<u8>, TransportError> {
        Ok(self.there()?.descriptor.clone())
    }

    fn arrived(&self) -> Option<Instant> {
        self.arrived
    }

    fn dropped(&self) -> u64 {
        lock(&self.line).reports.dropped()
    }

    fn ready(&mut self) -> bool {
        let line = lock(&self.line);
        !line.reports.is_empty() || !line.device_there
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reports_stay_apart_and_keep_their_times() {
        let (mut host, far) = pair("sim:pad");
        far.report_at(&[1, 2], Instant::from_nanos(7));
        far.report(&[3]);
        let mut buffer = [0; 8];
        assert_eq!(host.read(&mut buffer).unwrap(), 2);
        assert_eq!(host.arrived(), Some(Instant::from_nanos(7)));
        assert_eq!(host.read(&mut buffer).unwrap(), 1);
        assert_eq!(host.arrived(), None);
        assert_eq!(host.read(&mut buffer).unwrap(), 0);
        far.report(&[4]);
        drop(far);
        assert_eq!(host.read(&mut buffer).unwrap(), 1);
        assert!(host.read(&mut buffer).unwrap_err().is_gone());
    }

    #[test]
    fn questions_are_answered_refused_or_late() {
        let (mut host, far) = pair("sim:pad");
        far.set_string(200, &[4, 3, 65, 0]);
        far.answer_late(1);
        assert_eq!(host.read_string(200).unwrap(), None);
        assert_eq!(host.read_string(200).unwrap(), Some(vec![4, 3, 65, 0]));
        let refusal = host.read_string(100).unwrap_err();
        assert!(!refusal.is_gone());
        far.set_feature(2, &[2, 9]);
        let mut buffer = [0; 4];
        assert_eq!(host.read_feature(2, &mut buffer).unwrap(), Some(2));
        assert_eq!(host.write_feature(&[2, 2]).unwrap(), Some(()));
        let all: Vec<_> = std::iter::from_fn(|| far.noticed()).collect();
        assert_eq!(
            all,
            [
                Noticed::AskedString(200),
                Noticed::AskedString(100),
                Noticed::AskedFeature(2),
                Noticed::Feature(vec![2, 2])
            ]
        );
        drop(far);
        assert!(host.write(&[0]).unwrap_err().is_gone());
        assert!(host.read_string(200).unwrap_err().is_gone());
    }
}
