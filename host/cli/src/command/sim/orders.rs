//! Lines of standard input as orders, without ever waiting for one.

use std::io::{BufRead, IsTerminal};
use std::sync::mpsc::{Receiver, sync_channel};
use std::time::Duration;

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::process::getpgrp;
use rustix::termios::tcgetpgrp;

/// Lines that may wait to be carried out.
const WAITING: usize = 64;
/// How often a job in the background looks whether it has come to the front.
const LOOK: Duration = Duration::from_millis(200);

/// Orders as they come.
pub(super) struct Orders(Receiver<String>);

impl Orders {
    /// From now on, until standard input ends. The thread that reads it is left to the end of the program.
    pub(super) fn listen() -> Self {
        let (sender, receiver) = sync_channel(WAITING);
        std::thread::spawn(move || {
            let mut line = String::new();
            while let Some(read) = next_line(&mut line) {
                if !read {
                    continue;
                }
                let order = line.trim();
                if !order.is_empty() && !order.starts_with('#') && sender.send(order.to_owned()).is_err() {
                    return;
                }
            }
        });
        Self(receiver)
    }

    /// The next order, if one has come.
    pub(super) fn next(&self) -> Option<String> {
        self.0.try_recv().ok()
    }
}

/// Waits a while for a line: whether it has come; none at the end of input.
fn next_line(line: &mut String) -> Option<bool> {
    let stdin = std::io::stdin();
    // A job in the background that reads its terminal is stopped (SIGTTIN), and its servos with it.
    if stdin.is_terminal() && tcgetpgrp(&stdin).is_ok_and(|front| front != getpgrp()) {
        std::thread::park_timeout(LOOK);
        return Some(false);
    }
    let mut ready = [PollFd::new(&stdin, PollFlags::IN)];
    let wait = Timespec {
        tv_sec: 0,
        tv_nsec: LOOK.subsec_nanos().into(),
    };
    if !poll(&mut ready, Some(&wait)).is_ok_and(|count| count > 0) {
        return Some(false);
    }
    line.clear();
    match stdin.lock().read_line(line) {
        Ok(0) | Err(_) => None,
        Ok(_) => Some(true),
    }
}
