//! The run queue: who fires next.

use super::connection::InstanceId;

/// A ring of a power of two places. An instance is in it once at most, so that [`Ring::reserve`] when an
/// instance is made is all the growing it ever does.
#[derive(Default)]
pub(super) struct Ring {
    places: Box<[InstanceId]>,
    /// Both count up for ever; the place is the count modulo the number of places.
    first: usize,
    end: usize,
}

impl Ring {
    pub(super) fn len(&self) -> usize {
        self.end - self.first
    }

    pub(super) fn is_empty(&self) -> bool {
        self.first == self.end
    }

    /// Makes room for `count` instances in all.
    pub(super) fn reserve(&mut self, count: usize) {
        if count > self.places.len() {
            let mut places = vec![InstanceId(0); count.next_power_of_two().max(64)].into_boxed_slice();
            for (place, id) in places.iter_mut().zip(self.iter()) {
                *place = id;
            }
            (self.end, self.first) = (self.len(), 0);
            self.places = places;
        }
    }

    #[inline]
    fn place(&self, count: usize) -> usize {
        count & self.places.len().wrapping_sub(1)
    }

    #[inline]
    pub(super) fn push(&mut self, id: InstanceId) {
        let place = self.place(self.end);
        if let Some(place) = self.places.get_mut(place) {
            *place = id;
            self.end += 1;
        }
    }

    #[inline]
    pub(super) fn front(&self) -> Option<InstanceId> {
        if self.is_empty() {
            return None;
        }
        self.places.get(self.place(self.first)).copied()
    }

    #[inline]
    pub(super) fn pop(&mut self) -> Option<InstanceId> {
        let front = self.front()?;
        self.first += 1;
        Some(front)
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = InstanceId> + '_ {
        let places = (self.first..self.end).map(|count| self.place(count));
        places.filter_map(|place| self.places.get(place).copied())
    }

    pub(super) fn retain(&mut self, keep: impl Fn(InstanceId) -> bool) {
        let mut end = self.first;
        for count in self.first..self.end {
            let from = self.place(count);
            if self.places.get(from).is_some_and(|&id| keep(id)) {
                let to = self.place(end);
                self.places.swap(from, to);
                end += 1;
            }
        }
        self.end = end;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn first_in_first_out_while_it_wraps_grows_and_loses_some() {
        let mut ring = Ring::default();
        assert_eq!(ring.front(), None);
        ring.reserve(3);
        let mut next_in = 0;
        let mut next_out = 0;
        for round in 0..50 {
            for _ in 0..40 {
                ring.push(InstanceId(next_in));
                next_in += 1;
            }
            ring.reserve(64 + round);
            while ring.len() > 20 {
                assert_eq!(ring.front(), Some(InstanceId(next_out)));
                assert_eq!(ring.pop(), Some(InstanceId(next_out)));
                next_out += 1;
            }
        }
        ring.retain(|id| id.0 % 2 == 0);
        let left: Vec<_> = ring.iter().map(|id| id.0).collect();
        assert_eq!(
            left,
            (next_out..next_in).filter(|n| n % 2 == 0).collect::<Vec<_>>()
        );
    }
}
