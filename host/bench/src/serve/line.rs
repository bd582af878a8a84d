//! The line a served device is on: a pseudo-terminal, or a TCP port that one program at a time connects to.

use std::net::TcpListener;
use std::path::PathBuf;

use device::clock::{Clock, Instant};
use device::transport::pty::Pty;
use device::transport::tcp::{self, TcpTransport};
use device::transport::{Transport, TransportError};
use rustix::termios::{OptionalActions, tcgetattr, tcsetattr};

/// Where to serve.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Place {
    /// A pseudo-terminal, found at this path as well if one is given.
    Pty(Option<PathBuf>),
    /// A TCP port, `HOST:PORT`; port 0 lets the system choose.
    Tcp(String),
}

/// An open line.
#[derive(Debug)]
pub struct ServeLine {
    end: End,
    path: String,
    /// Where a terminal that was pulled out comes back.
    place: Place,
    /// The device's own speed.
    home_baud: u32,
    baud: u32,
}

#[derive(Debug)]
enum End {
    Pty(Pty),
    Tcp(TcpListener, Option<TcpTransport>),
    /// The cable is out: what is said is lost.
    Out,
}

impl ServeLine {
    /// Opens a line for a device that speaks at `baud`; from here on programs can open [`ServeLine::path`].
    pub fn open(place: &Place, baud: u32) -> Result<Self, TransportError> {
        let (end, path) = match place {
            Place::Pty(link) => {
                let pty = match link {
                    Some(link) => Pty::open_at(link)?,
                    None => Pty::open()?,
                };
                let path = pty.path().display().to_string();
                (End::Pty(pty), path)
            }
            Place::Tcp(address) => {
                let listener = tcp::listen(address)?;
                let bound = listener
                    .local_addr()
                    .map_or_else(|_| address.clone(), |bound| bound.to_string());
                (End::Tcp(listener, None), format!("tcp:{bound}"))
            }
        };
        let place = match place {
            // The port that the system chose stays.
            Place::Tcp(_) => Place::Tcp(path.trim_start_matches("tcp:").to_owned()),
            pty @ Place::Pty(_) => pty.clone(),
        };
        let line = Self {
            end,
            path,
            place,
            home_baud: baud,
            baud,
        };
        line.settle_baud();
        Ok(line)
    }

    /// Takes the cable out: whoever has the port open finds it gone, and nobody finds it.
    pub(super) fn unplug(&mut self) {
        self.end = End::Out;
    }

    /// Puts the cable back. A pseudo-terminal without a path of its own has another name then.
    pub(super) fn plug(&mut self) -> Result<(), TransportError> {
        if matches!(self.end, End::Out) {
            *self = Self::open(&self.place.clone(), self.home_baud)?;
        }
        Ok(())
    }

    /// What other programs open, an address as dialrig takes them.
    pub fn path(&self) -> &str {
        &self.path
    }

    /// The line speed the host has set, as far as is known.
    pub(super) fn baud(&self) -> u32 {
        self.baud
    }

    /// Sets the line to the device's own speed, where programs that set none find it. A fresh terminal stands
    /// at 38400, which no real port beside this device would.
    fn settle_baud(&self) {
        let baud = self.baud;
        if let End::Pty(pty) = &self.end {
            let set = rustix::fs::open(
                pty.path(),
                rustix::fs::OFlags::RDWR | rustix::fs::OFlags::NOCTTY | rustix::fs::OFlags::NONBLOCK,
                rustix::fs::Mode::empty(),
            )
            .and_then(|near| {
                let mut settings = tcgetattr(&near)?;
                settings.set_speed(baud)?;
                tcsetattr(&near, OptionalActions::Now, &settings)
            });
            if let Err(error) = set {
                tracing::debug!("{}: line speed {baud} could not be set: {error}", self.path);
            }
        }
    }

    /// The speed the host has set since the last call, if it has.
    pub(super) fn new_baud(&mut self) -> Option<u32> {
        let End::Pty(pty) = &self.end else { return None };
        let baud = pty.host_baud().filter(|&baud| baud > 0 && baud != self.baud)?;
        self.baud = baud;
        Some(baud)
    }

    /// What the host has written; 0 is nothing. A program that goes makes room for the next.
    pub(super) fn read(&mut self, buffer: &mut [u8]) -> Result<usize, TransportError> {
        match &mut self.end {
            End::Pty(pty) => pty.read(buffer),
            End::Tcp(listener, client) => {
                if client.is_none() {
                    *client = tcp::accept(listener)?;
                }
                let Some(there) = client else { return Ok(0) };
                match there.read(buffer) {
                    Err(error) if error.is_gone() => {
                        *client = None;
                        Ok(0)
                    }
                    other => other,
                }
            }
            End::Out => Ok(0),
        }
    }

    /// Hands bytes to the host; without a host they are lost, as on a wire.
    pub(super) fn write(&mut self, bytes: &[u8]) -> Result<(), TransportError> {
        match &mut self.end {
            End::Pty(pty) => pty.write(bytes),
            End::Tcp(_, None) | End::Out => Ok(()),
            End::Tcp(_, client) => {
                let gone = client.as_mut().is_some_and(|there| there.write(bytes).is_err());
                if gone {
                    *client = None;
                }
                Ok(())
            }
        }
    }

    pub(super) fn wait(&mut self, clock: &dyn Clock, until: Instant) {
        match &mut self.end {
            End::Pty(pty) => pty.wait(clock, until),
            End::Tcp(_, Some(client)) => client.wait(clock, until),
            End::Tcp(_, None) | End::Out => clock.sleep_until(until),
        }
    }
}
