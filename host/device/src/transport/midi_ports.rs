//! MIDI ports of the system's own library: Core MIDI, WinMM, and on Linux the sequencer. What raw nodes are on Linux,
//! these are elsewhere; on Linux they are for programs and for devices that only the sequencer has.
//!
//! Ports are named by the beginning of their names, `midi:nanoKONTROL2`; that to a device and that from it bear the same.
//! Only with the cargo feature `midir`, since on Linux it needs ALSA's headers to build and its library to run.

use super::stamped::StampedQueue;
use super::{Boundary, Transport, TransportError};
use crate::clock::{Clock, Instant};
use midir::{Ignore, MidiIO, MidiInput, MidiInputConnection, MidiOutput, MidiOutputConnection};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};

/// What programs see us as.
const CLIENT: &str = "dialrig";

/// An open port, in one direction or both.
pub struct MidiPort {
    address: String,
    shared: Arc<Shared>,
    arrived: Option<Instant>,
    // The library's thread calls back for as long as this is kept.
    _input: Option<MidiInputConnection<()>>,
    output: Option<MidiOutputConnection>,
}

#[derive(Default)]
struct Shared {
    queue: Mutex<StampedQueue>,
    came: Condvar,
}

/// The names of all ports from which something can come, in their order.
pub fn names() -> Vec<String> {
    let Ok(input) = MidiInput::new(CLIENT) else {
        // A machine without sequencer has none.
        return Vec::new();
    };
    names_of(&input).into_iter().map(|(_, name)| name).collect()
}

/// Opens the ports whose names begin with `name`; arrivals are noted by `clock`.
pub fn open(name: &str, clock: Arc<dyn Clock>) -> Result<MidiPort, TransportError> {
    let address = format!("midi:{name}");
    let shared = Arc::new(Shared::default());
    let input = connect_input(name, &address, &shared, clock)?;
    let output = connect_output(name, &address)?;
    if input.is_none() && output.is_none() {
        return Err(TransportError::NotFound { address });
    }
    Ok(MidiPort {
        address,
        shared,
        arrived: None,
        _input: input,
        output,
    })
}

fn names_of<T: MidiIO>(io: &T) -> Vec<(T::Port, String)> {
    let named = io.ports().into_iter().filter_map(|port| {
        let name = io.port_name(&port).ok()?;
        Some((port, name))
    });
    named.collect()
}

fn first<T: MidiIO>(io: &T, name: &str) -> Option<T::Port> {
    let mut all = names_of(io).into_iter();
    all.find(|(_, known)| known.starts_with(name))
        .map(|(port, _)| port)
}

fn refused(address: &str, error: impl std::fmt::Display) -> TransportError {
    TransportError::Io {
        address: address.to_owned(),
        source: std::io::Error::other(error.to_string()),
    }
}

fn connect_input(
    name: &str,
    address: &str,
    shared: &Arc<Shared>,
    clock: Arc<dyn Clock>,
) -> Result<Option<MidiInputConnection<()>>, TransportError> {
    // Without sequencer there is no port, which is no error of the port.
    let Ok(mut input) = MidiInput::new(CLIENT) else {
        return Ok(None);
    };
    input.ignore(Ignore::None);
    let Some(port) = first(&input, name) else {
        return Ok(None);
    };
    let theirs = Arc::clone(shared);
    let take = move |_: u64, bytes: &[u8], (): &mut ()| {
        lock(&theirs.queue).push(bytes, Some(clock.now()));
        theirs.came.notify_all();
    };
    let connected = input.connect(&port, CLIENT, take, ());
    connected.map(Some).map_err(|error| refused(address, error))
}

fn connect_output(name: &str, address: &str) -> Result<Option<MidiOutputConnection>, TransportError> {
    let Ok(output) = MidiOutput::new(CLIENT) else {
        return Ok(None);
    };
    let Some(port) = first(&output, name) else {
        return Ok(None);
    };
    let connected = output.connect(&port, CLIENT);
    connected.map(Some).map_err(|error| refused(address, error))
}

fn lock(queue: &Mutex<StampedQueue>) -> MutexGuard<'_, StampedQueue> {
    // A panic elsewhere leaves a queue, which has no broken state.
    queue.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Transport for MidiPort {
    fn boundary(&self) -> Boundary {
        Boundary::Stream
    }

    fn read(&mut self, buffer: &mut [u8]) -> Result<usize, TransportError> {
        Ok(match lock(&self.shared.queue).pop(buffer) {
            Some((count, at)) => {
                self.arrived = at;
                count
            }
            None => 0,
        })
    }

    /// The library takes whole messages.
    fn write(&mut self, bytes: &[u8]) -> Result<(), TransportError> {
        let Some(output) = &mut self.output else {
            return Ok(());
        };
        for message in messages(bytes) {
            output
                .send(message)
                .map_err(|error| refused(&self.address, error))?;
        }
        Ok(())
    }

    fn arrived(&self) -> Option<Instant> {
        self.arrived
    }

    fn dropped(&self) -> u64 {
        lock(&self.shared.queue).dropped()
    }

    fn ready(&mut self) -> bool {
        !lock(&self.shared.queue).is_empty()
    }

    fn wait(&mut self, clock: &dyn Clock, until: Instant) {
        let queue = lock(&self.shared.queue);
        let limit = until.since(clock.now());
        let waited = self
            .shared
            .came
            .wait_timeout_while(queue, limit, |queue| queue.is_empty());
        let idle = waited.map_or_else(|e| e.into_inner().1.timed_out(), |(_, end)| end.timed_out());
        if idle {
            // For a real clock the time has passed; a virtual one learns it here.
            clock.sleep_until(until);
        }
    }
}

/// Whole messages: each begins with a status byte; what a codec writes has one in each.
fn messages(bytes: &[u8]) -> impl Iterator<Item = &[u8]> {
    let begins = |byte: u8| byte >= 0x80 && byte != 0xF7;
    let mut rest = bytes;
    std::iter::from_fn(move || {
        let (&status, behind) = rest.split_first()?;
        let more = behind.iter().position(|&byte| begins(byte) || !begins(status));
        let (message, after) = rest.split_at(more.map_or(rest.len(), |at| at + 1));
        rest = after;
        Some(message)
    })
    .filter(move |message| message.first().is_some_and(|&byte| begins(byte)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::clock::MonotonicClock;

    #[test]
    fn bytes_are_cut_into_whole_messages() {
        let bytes = [0xB0, 1, 2, 0xF0, 1, 2, 3, 0xF7, 0x90, 5, 6, 0xD0, 0x1C];
        let cut: Vec<&[u8]> = messages(&bytes).collect();
        let want: [&[u8]; 4] = [
            &[0xB0, 1, 2],
            &[0xF0, 1, 2, 3, 0xF7],
            &[0x90, 5, 6],
            &[0xD0, 0x1C],
        ];
        assert_eq!(cut, want);
        assert_eq!(messages(&[1, 2]).count(), 0);
    }

    #[test]
    fn a_port_that_is_not_there_is_said_so() {
        let error = open("no such port of anybody", Arc::new(MonotonicClock::new()));
        assert!(matches!(error, Err(TransportError::NotFound { .. })));
        assert!(!names().iter().any(|name| name.starts_with("no such port")));
    }

    /// Where the machine has a sequencer: our own port is heard by name.
    #[cfg(unix)]
    #[test]
    fn what_one_end_says_the_other_hears() {
        use midir::os::unix::VirtualInput;
        let Ok(far) = MidiInput::new("dialrig-test-far") else {
            // Containers have none.
            return;
        };
        let heard = Arc::new(Mutex::new(Vec::new()));
        let theirs = Arc::clone(&heard);
        let far = far.create_virtual(
            "dialrig-test-in",
            move |_, bytes, (): &mut ()| theirs.lock().expect("whole").extend_from_slice(bytes),
            (),
        );
        let Ok(_far) = far else { return };
        let clock = MonotonicClock::new();
        let mut near = open("dialrig-test-far", Arc::new(clock)).expect("it was just made");
        near.write(&[0xB0, 1, 2, 0x90, 3, 4]).expect("it takes");
        let until = clock.now().after(std::time::Duration::from_secs(5));
        while heard.lock().expect("whole").len() < 6 && clock.now() < until {
            clock.sleep_until(clock.now().after(std::time::Duration::from_millis(5)));
        }
        assert_eq!(*heard.lock().expect("whole"), [0xB0, 1, 2, 0x90, 3, 4]);
    }
}
