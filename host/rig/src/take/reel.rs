//! What a device said, in few bytes: 16 for each thing besides what it is.
//!
//! An hour of a dial box is a million reports of three bytes each; as records of their own they would take forty
//! times as much. It must not know what the bytes mean.

use std::collections::{BTreeMap, VecDeque};
use std::time::Duration;

use device::exchange::{Record, What};

/// Where among all things said something is, from 0.
pub(crate) type Mark = u64;

/// Things said, in order, the oldest of which may be forgotten.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reel {
    /// Things that were in front of the first one.
    begins: Mark,
    heads: VecDeque<Head>,
    /// What all of them said, one after another.
    bytes: VecDeque<u8>,
    /// What is no bytes of the device's: answers, the line gone or back.
    others: BTreeMap<Mark, What>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Head {
    at_nanos: u64,
    bytes: u32,
}

impl Head {
    fn at(self) -> Duration {
        Duration::from_nanos(self.at_nanos)
    }
}

fn nanos(at: Duration) -> u64 {
    // 584 years are enough.
    u64::try_from(at.as_nanos()).unwrap_or(u64::MAX)
}

impl Reel {
    /// One that takes so many things and bytes without asking for memory.
    pub(crate) fn with_room(things: usize, bytes: usize) -> Self {
        Self {
            heads: VecDeque::with_capacity(things),
            bytes: VecDeque::with_capacity(bytes),
            ..Self::default()
        }
    }

    /// How many things it has.
    pub fn len(&self) -> usize {
        self.heads.len()
    }

    /// Whether it has none.
    pub fn is_empty(&self) -> bool {
        self.heads.is_empty()
    }

    /// Bytes the device said.
    pub fn bytes(&self) -> usize {
        self.bytes.len()
    }

    /// The number that the next thing gets.
    pub(crate) fn next(&self) -> Mark {
        self.begins + self.heads.len() as Mark
    }

    /// The device said this.
    pub(crate) fn hear(&mut self, at: Duration, bytes: &[u8]) {
        self.bytes.extend(bytes);
        self.heads.push_back(Head {
            at_nanos: nanos(at),
            // The largest piece is a reading buffer.
            bytes: bytes.len() as u32,
        });
    }

    /// Something else happened, or the same.
    pub(crate) fn put(&mut self, at: Duration, what: What) {
        if let What::Device(bytes) = &what {
            self.hear(at, bytes);
            return;
        }
        self.others.insert(self.next(), what);
        self.heads.push_back(Head {
            at_nanos: nanos(at),
            bytes: 0,
        });
    }

    /// When the oldest happened.
    pub(crate) fn front_at(&self) -> Option<Duration> {
        self.heads.front().map(|head| head.at())
    }

    /// What the oldest is, where it is no bytes.
    pub(crate) fn front_other(&self) -> Option<&What> {
        self.others.get(&self.begins)
    }

    /// Forgets the oldest.
    pub(crate) fn forget(&mut self) {
        if let Some(head) = self.heads.pop_front() {
            self.bytes.drain(..head.bytes as usize);
            self.others.remove(&self.begins);
            self.begins += 1;
        }
    }

    /// Forgets everything, and how much that was.
    pub(crate) fn clear(&mut self) {
        self.begins = 0;
        self.heads.clear();
        self.bytes.clear();
        self.others.clear();
    }

    /// Takes bytes of the oldest, as many as fit; how many. What does not fit stays, unless `whole` reports are kept
    /// apart, of which the rest is lost.
    pub(crate) fn read_front(&mut self, buffer: &mut [u8], whole: bool) -> usize {
        let Some(head) = self.heads.front_mut() else {
            return 0;
        };
        let count = buffer.len().min(head.bytes as usize);
        for (to, from) in buffer.iter_mut().zip(self.bytes.drain(..count)) {
            *to = from;
        }
        head.bytes -= count as u32;
        if whole || head.bytes == 0 {
            self.forget();
        }
        count
    }

    /// Times of everything.
    pub(crate) fn times(&self) -> impl Iterator<Item = Duration> {
        self.heads.iter().map(|head| head.at())
    }

    /// Everything.
    pub fn records(&self) -> impl Iterator<Item = Record> {
        self.latest(self.heads.len())
    }

    /// The latest so many.
    pub(crate) fn latest(&self, count: usize) -> impl Iterator<Item = Record> {
        let skipped = self.heads.len().saturating_sub(count);
        let latest = self.heads.range(skipped..);
        let bytes: usize = latest.clone().map(|head| head.bytes as usize).sum();
        let mut bytes = self.bytes.range(self.bytes.len() - bytes..).copied();
        (self.begins + skipped as Mark..)
            .zip(latest)
            .map(move |(mark, head)| {
                let said: Vec<u8> = bytes.by_ref().take(head.bytes as usize).collect();
                let what = self.others.get(&mark).cloned();
                Record::new(head.at(), what.unwrap_or(What::Device(said)))
            })
    }

    /// Copies everything from number `from` on to the end of one reel, and what is before to that of another. Times
    /// never run backwards in them: what happened earlier than `latest` is told with that time.
    pub(crate) fn split_onto(&self, from: Mark, latest: &mut Duration, [before, after]: [&mut Self; 2]) {
        let mut bytes = 0;
        for (mark, head) in (self.begins..).zip(&self.heads) {
            *latest = head.at().max(*latest);
            let to = if mark < from { &mut *before } else { &mut *after };
            if let Some(other) = self.others.get(&mark) {
                to.put(*latest, other.clone());
                continue;
            }
            let end = bytes + head.bytes as usize;
            to.bytes.extend(self.bytes.range(bytes..end));
            to.heads.push_back(Head {
                at_nanos: nanos(*latest),
                bytes: head.bytes,
            });
            bytes = end;
        }
    }
}

impl FromIterator<Record> for Reel {
    fn from_iter<I: IntoIterator<Item = Record>>(records: I) -> Self {
        let mut reel = Self::default();
        for record in records {
            reel.put(record.at.unwrap_or_default(), record.what);
        }
        reel
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use device::codec::Answer;
    use proptest::prelude::*;

    fn what() -> impl Strategy<Value = What> {
        prop_oneof![
            6 => prop::collection::vec(any::<u8>(), 1..70).prop_map(What::Device),
            1 => Just(What::Gone),
            1 => Just(What::Back),
            1 => any::<u8>().prop_map(|index| What::Answer(Answer::Text { index, raw: Ok(vec![index]) })),
        ]
    }

    proptest! {
        /// What goes in comes out, also after the oldest was forgotten, and read piece by piece.
        #[test]
        fn it_gives_back_what_it_was_given(
            whats in prop::collection::vec(what(), 0..60),
            forgotten in 0..20_usize,
            buffer in 1..100_usize,
        ) {
            let records = (0..).zip(whats).map(|(n, what)| Record::new(Duration::from_nanos(n * 7), what));
            let records: Vec<Record> = records.collect();
            let mut reel: Reel = records.iter().cloned().collect();
            prop_assert_eq!(reel.records().collect::<Vec<_>>(), records.clone());
            let forgotten = forgotten.min(records.len());
            (0..forgotten).for_each(|_| reel.forget());
            let left = &records[forgotten..];
            prop_assert_eq!(reel.records().collect::<Vec<_>>(), left.to_vec());
            prop_assert_eq!(reel.next(), records.len() as Mark);
            let three = reel.latest(3).collect::<Vec<_>>();
            prop_assert_eq!(three, left[left.len().saturating_sub(3)..].to_vec());
            let (mut before, mut after) = (Reel::default(), Reel::default());
            let cut = (forgotten + left.len() / 2) as Mark;
            let mut latest = Duration::ZERO;
            reel.split_onto(cut, &mut latest, [&mut before, &mut after]);
            prop_assert_eq!(before.len(), left.len() / 2);
            let both: Vec<_> = before.records().chain(after.records()).collect();
            prop_assert_eq!(both, left.to_vec());
            let mut read = Vec::new();
            let mut buffer = vec![0; buffer];
            while !reel.is_empty() {
                if reel.front_other().is_some() {
                    reel.forget();
                } else {
                    let count = reel.read_front(&mut buffer, false);
                    read.extend_from_slice(&buffer[..count]);
                }
            }
            let said = left.iter().filter_map(|record| match &record.what {
                What::Device(bytes) => Some(bytes.as_slice()),
                _ => None,
            });
            prop_assert_eq!(read, said.collect::<Vec<_>>().concat());
            prop_assert_eq!(reel.bytes(), 0);
        }
    }
}
