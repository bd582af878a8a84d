//! Lines of standard input as orders, without ever waiting for one.

use std::io::IsTerminal;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::time::Duration;

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::process::getpgrp;
use rustix::termios::tcgetpgrp;

/// Lines that may wait to be carried out.
const WAITING: usize = 64;
/// How often a job in the background looks whether it has come to the front.
const LOOK: Duration = Duration::from_millis(200);
/// Bytes taken at once.
const READ_BYTES: usize = 4096;

/// Orders as they come.
pub(super) struct Orders(Receiver<String>);

impl Orders {
    /// From now on, until standard input ends. The thread that reads it is left to the end of the program.
    pub(super) fn listen() -> Self {
        let (sender, receiver) = sync_channel(WAITING);
        std::thread::spawn(move || {
            let mut typed = Vec::new();
            while let Some(more) = typed_now() {
                typed.extend(more);
                while let Some(end) = typed.iter().position(|&byte| byte == b'\n') {
                    let line: Vec<u8> = typed.drain(..=end).collect();
                    if !send(&line, &sender) {
                        return;
                    }
                }
            }
            send(&typed, &sender);
        });
        Self(receiver)
    }

    /// The next order, if one has come.
    pub(super) fn next(&self) -> Option<String> {
        self.0.try_recv().ok()
    }
}

/// Passes a line on unless there is nothing in it. False: nobody listens any more.
fn send(line: &[u8], sender: &SyncSender<String>) -> bool {
    let text = String::from_utf8_lossy(line);
    let order = text.trim();
    order.is_empty() || order.starts_with('#') || sender.send(order.to_owned()).is_ok()
}

/// Waits a while for what is typed: nothing, if nothing was; none at the end of input.
fn typed_now() -> Option<Vec<u8>> {
    let stdin = std::io::stdin();
    // A job in the background that reads its terminal is stopped (SIGTTIN), and its servos with it.
    if stdin.is_terminal() && tcgetpgrp(&stdin).is_ok_and(|front| front != getpgrp()) {
        std::thread::park_timeout(LOOK);
        return Some(Vec::new());
    }
    let mut ready = [PollFd::new(&stdin, PollFlags::IN)];
    let wait = Timespec {
        tv_sec: 0,
        tv_nsec: LOOK.subsec_nanos().into(),
    };
    if !poll(&mut ready, Some(&wait)).is_ok_and(|count| count > 0) {
        return Some(Vec::new());
    }
    // Past the standard library's buffer, which `poll` does not see.
    let mut bytes = vec![0; READ_BYTES];
    let count = rustix::io::read(&stdin, &mut bytes)
        .ok()
        .filter(|&count| count > 0)?;
    bytes.truncate(count);
    Some(bytes)
}
