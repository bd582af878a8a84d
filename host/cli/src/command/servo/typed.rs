//! What somebody types at the terminal while a command goes on, line by line.

use std::io::stdin;
use std::sync::mpsc::{Receiver, sync_channel};

/// Lines that may wait; a person types one at a time.
const WAITING: usize = 64;

/// Lines of standard input, heard on a thread of its own since reading one waits.
pub(super) struct Typed(Receiver<String>);

impl Typed {
    /// Listens from now on. The end of input is no line: whoever closes it must interrupt.
    pub(super) fn listen() -> Self {
        let (heard, lines) = sync_channel(WAITING);
        std::thread::spawn(move || {
            for line in stdin().lines().map_while(Result::ok) {
                if heard.send(line).is_err() {
                    return;
                }
            }
        });
        Self(lines)
    }

    /// The next line, if one has come.
    pub(super) fn next(&self) -> Option<String> {
        self.0.try_recv().ok()
    }
}
