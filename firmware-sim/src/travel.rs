//! A fader's or knob's place while a hand moves it: where it is at any moment, without steps of its own.

/// One control with a place; 0 is one end of its travel and 1 the other.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Travel {
    from: f64,
    to: f64,
    begun_ns: u64,
    span_ns: u64,
}

impl Travel {
    /// Moves it evenly from where it is at `now_ns` to `to`, which is kept within its travel.
    pub(crate) fn go(&mut self, now_ns: u64, to: f64, span_ns: u64) {
        *self = Self {
            from: self.at(now_ns),
            to: to.clamp(0.0, 1.0),
            begun_ns: now_ns,
            span_ns,
        };
    }

    /// Where it is.
    pub(crate) fn at(&self, now_ns: u64) -> f64 {
        let gone_ns = now_ns.saturating_sub(self.begun_ns);
        if gone_ns >= self.span_ns {
            return self.to;
        }
        self.from + (self.to - self.from) * gone_ns as f64 / self.span_ns as f64
    }
}
