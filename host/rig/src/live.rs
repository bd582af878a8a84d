//! The rig in real time: a thread that steps it at a fixed period, commands going in and snapshots coming out.

use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

use crossbeam_channel::{Receiver, Sender, TrySendError, bounded};
use device::clock::Clock;

use crate::command::{Command, PuppetCommand};
use crate::rig::Rig;
use crate::snapshot::Snapshot;

/// Steps a second: twice the rate of a screen, so that no turn of a dial waits for two frames.
const PERIOD: Duration = Duration::from_millis(10);
/// Commands that may wait for a step. A person gives a handful; a dragged dial a few dozen.
const COMMANDS_MAX: usize = 1024;

/// A rig that runs.
pub struct Live {
    commands: Sender<Command>,
    /// Stops, past all that waits.
    stops: Sender<()>,
    snapshot: Arc<Mutex<Arc<Snapshot>>>,
    stop: Sender<()>,
    thread: Option<JoinHandle<bool>>,
}

/// The rig's thread could not be started.
#[derive(Debug, thiserror::Error)]
#[error("the rig's thread did not start: {0}")]
pub struct LiveError(#[from] std::io::Error);

impl Live {
    /// Steps `rig` until [`Live::close`]. `seen` is called on the rig's thread after each step; it must be quick.
    pub fn start(
        mut rig: Rig,
        clock: Arc<dyn Clock>,
        mut seen: impl FnMut(&Arc<Snapshot>) + Send + 'static,
    ) -> Result<Self, LiveError> {
        let (commands, inbox) = bounded(COMMANDS_MAX);
        let (stops, pressed) = bounded(1);
        let (stop, stopped) = bounded(1);
        let first = rig.step(&mut std::iter::empty());
        let snapshot = Arc::new(Mutex::new(first));
        let shown = Arc::clone(&snapshot);
        let thread = std::thread::Builder::new().name("rig".into()).spawn(move || {
            run(&mut rig, &*clock, &(inbox, pressed), &stopped, &mut |snapshot| {
                seen(snapshot);
                *shown.lock().unwrap_or_else(PoisonError::into_inner) = Arc::clone(snapshot);
            });
            rig.close()
        })?;
        Ok(Self {
            commands,
            stops,
            snapshot,
            stop,
            thread: Some(thread),
        })
    }

    /// What was seen last.
    pub fn snapshot(&self) -> Arc<Snapshot> {
        Arc::clone(&self.snapshot.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// Asks for something. A flood beyond the queue is dropped and said so in the log, but a stop of the puppet
    /// goes past whatever waits.
    pub fn send(&self, command: Command) {
        if command == Command::Puppet(PuppetCommand::Stop) {
            // A full queue holds a stop already.
            let _ = self.stops.try_send(());
            return;
        }
        if let Err(TrySendError::Full(command)) = self.commands.try_send(command) {
            tracing::warn!("the rig is {COMMANDS_MAX} commands behind; dropped {command:?}");
        }
    }

    /// Lets go of the puppet and ends. Returns whether torque is known to be off.
    pub fn close(mut self) -> bool {
        self.end()
    }

    fn end(&mut self) -> bool {
        let _ = self.stop.try_send(());
        // A panic of the thread ends in the servos' own watchdogs; whether torque is off is then not known.
        self.thread
            .take()
            .is_none_or(|thread| thread.join().unwrap_or(false))
    }
}

impl Drop for Live {
    fn drop(&mut self) {
        self.end();
    }
}

fn run(
    rig: &mut Rig,
    clock: &dyn Clock,
    (inbox, pressed): &(Receiver<Command>, Receiver<()>),
    stopped: &Receiver<()>,
    seen: &mut dyn FnMut(&Arc<Snapshot>),
) {
    let mut due = clock.now();
    while stopped.try_recv().is_err() {
        let waiting = inbox.len();
        let stop = pressed
            .try_iter()
            .take(1)
            .map(|()| Command::Puppet(PuppetCommand::Stop));
        let snapshot = rig.step(&mut stop.chain(inbox.try_iter().take(waiting)));
        seen(&snapshot);
        due = due.after(PERIOD);
        let now = clock.now();
        if due < now {
            // Behind by a whole step: go on from here, catching up would be a burst.
            due = now;
        }
        clock.sleep_until(due);
    }
}
