//! What a button sends: every edge, presses alone, or every other press.
//!
//! Pure. Edges are never merged: a press and its release within one step are two messages.

/// What a button sends.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ButtonMode {
    /// TRUE when it goes down, FALSE when it comes up.
    #[default]
    Hold,
    /// TRUE when it goes down.
    Press,
    /// TRUE and FALSE in turn when it goes down.
    Toggle,
}

impl ButtonMode {
    /// All, with the words of `NAME_MODE`.
    pub const WORDS: [(&'static str, Self); 3] = [
        ("hold", Self::Hold),
        ("press", Self::Press),
        ("toggle", Self::Toggle),
    ];

    /// The word for it.
    pub fn word(self) -> &'static str {
        let found = Self::WORDS.iter().find(|(_, mode)| *mode == self);
        found.map_or("hold", |(word, _)| word)
    }
}

/// One button.
#[derive(Clone, Copy, Debug, Default)]
pub struct Button {
    /// What it sends.
    pub mode: ButtonMode,
    /// Whether it is held down.
    pub down: bool,
    /// Whether the last of every two presses was the first.
    pub on: bool,
}

impl Button {
    /// It went down or came up: what to send. What is no change is no edge.
    pub fn hear(&mut self, down: bool) -> Option<bool> {
        if self.down == down {
            return None;
        }
        self.down = down;
        match self.mode {
            ButtonMode::Hold => Some(down),
            ButtonMode::Press => down.then_some(true),
            ButtonMode::Toggle if down => {
                self.on = !self.on;
                Some(self.on)
            }
            ButtonMode::Toggle => None,
        }
    }

    /// Whether its own lamp is lit where nothing else lights it.
    pub fn lit(&self) -> bool {
        match self.mode {
            ButtonMode::Toggle => self.on,
            ButtonMode::Hold | ButtonMode::Press => self.down,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_mode_sends_what_it_is_called() {
        let edges = [true, false, true, false, false, true];
        let rows: [(ButtonMode, &[bool]); 3] = [
            (ButtonMode::Hold, &[true, false, true, false, true]),
            (ButtonMode::Press, &[true, true, true]),
            (ButtonMode::Toggle, &[true, false, true]),
        ];
        for (mode, sent) in rows {
            let mut button = Button {
                mode,
                ..Button::default()
            };
            let heard: Vec<bool> = edges.iter().filter_map(|&down| button.hear(down)).collect();
            assert_eq!(heard, sent, "{}", mode.word());
        }
    }
}
