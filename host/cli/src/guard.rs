//! A second process that lets go of a puppet when the first has died without doing so.
//!
//! A servo whose host is gone can stand by itself, but none can let go. A puppet whose policy for a lost host is to
//! release therefore gets a guard: a process of its own, which knows the lines and waits for the end of its standard
//! input. Killed, crashed or hung up, the first process leaves the pipe closed; the guard then opens the lines and
//! switches torque off. What takes the whole machine, or the cable, takes the guard as well.

use std::io::{self, BufRead, Write};
use std::os::unix::process::CommandExt;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use crate::failure::Exit;

/// Said when all was let go in order.
const DISMISSED: &str = "dismissed";
/// A line is tried so often: the kernel may still be closing it for the one that died.
const TRIES: u32 = 20;
/// Between two tries.
const PAUSE: Duration = Duration::from_millis(100);

/// The guard as the first process knows it. Dropping it without dismissing it lets it do its work.
#[derive(Debug)]
pub(crate) struct Guard {
    child: Child,
}

impl Guard {
    /// Starts a guard over lines: address and line speed of each.
    pub(crate) fn start(lines: &[(String, u32)]) -> io::Result<Self> {
        let mut child = Command::new(std::env::current_exe()?)
            .arg("guard")
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            // A group of its own: Ctrl-C and a closed terminal are for the first process to answer.
            .process_group(0)
            .spawn()?;
        if let Some(input) = &mut child.stdin {
            for (port, baud) in lines {
                writeln!(input, "{baud} {port}")?;
            }
            input.flush()?;
        }
        Ok(Self { child })
    }

    /// Everything was let go: there is nothing left to do.
    pub(crate) fn dismiss(mut self) {
        if let Some(mut input) = self.child.stdin.take() {
            // A guard that is gone already needs no telling.
            let _ = writeln!(input, "{DISMISSED}");
        }
        let _ = self.child.wait();
    }
}

/// What the guard does: waits, and lets go if nobody dismissed it.
pub(crate) fn run() -> Exit {
    let mut lines: Vec<(String, u32)> = Vec::new();
    for line in io::stdin().lock().lines() {
        let Ok(line) = line else { break };
        if line == DISMISSED {
            return Exit::Done;
        }
        if let Some((baud, port)) = line.split_once(' ')
            && let Ok(baud) = baud.parse()
        {
            lines.push((port.to_owned(), baud));
        }
    }
    let mut safe = true;
    for (port, baud) in &lines {
        safe &= (0..TRIES).any(|_| {
            let off = release(port, *baud);
            if !off {
                std::thread::park_timeout(PAUSE);
            }
            off
        });
    }
    if safe {
        Exit::FaultSafe
    } else {
        Exit::FaultUnconfirmed
    }
}

/// Torque off on a line, as `dialrig servo release` does it; whether all who answer say so.
fn release(port: &str, baud: u32) -> bool {
    let Ok(program) = std::env::current_exe() else {
        return false;
    };
    let baud = baud.to_string();
    let done = Command::new(program)
        .args(["servo", "release", "--port", port, "--baud", &baud])
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status();
    done.is_ok_and(|status| status.success())
}
