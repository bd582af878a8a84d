//! A byte stream over TCP: serial servers, and simulated buses on another machine.

use super::{Boundary, Transport, TransportError, descriptor};
use crate::clock::{Clock, Instant};
use rustix::fd::{AsFd, BorrowedFd};
use std::io;
use std::net::{TcpListener, TcpStream, ToSocketAddrs};
use std::time::Duration;

/// How long a far machine may take to answer; a local one answers in well under a millisecond.
const CONNECT_LIMIT: Duration = Duration::from_secs(3);

const HINT: &str = "a firewall or the system refuses it; choose a port above 1023";

/// An open connection. Line speeds are the far end's affair.
#[derive(Debug)]
pub struct TcpTransport {
    address: String,
    stream: TcpStream,
}

/// Connects to `host` (a name or an address) at `port`.
pub fn connect(host: &str, port: u16) -> Result<TcpTransport, TransportError> {
    let address = format!("tcp:{host}:{port}");
    let sort = |e: io::Error| sorted(&address, e);
    let mut last = io::Error::new(io::ErrorKind::NotFound, "the name has no address");
    for target in (host, port).to_socket_addrs().map_err(sort)? {
        match TcpStream::connect_timeout(&target, CONNECT_LIMIT) {
            Ok(stream) => return TcpTransport::from_stream(stream, address),
            Err(e) => last = e,
        }
    }
    Err(sorted(&address, last))
}

/// Waits at `address` (`HOST:PORT`; port 0 lets the system choose) for programs to connect.
pub fn listen(address: &str) -> Result<TcpListener, TransportError> {
    let shown = format!("tcp:{address}");
    let listener = TcpListener::bind(address).map_err(|e| sorted(&shown, e))?;
    listener.set_nonblocking(true).map_err(|e| sorted(&shown, e))?;
    Ok(listener)
}

/// The program that has connected since the last call, if one has.
pub fn accept(listener: &TcpListener) -> Result<Option<TcpTransport>, TransportError> {
    match listener.accept() {
        Ok((stream, from)) => TcpTransport::from_stream(stream, format!("tcp:{from}")).map(Some),
        Err(e) if e.kind() == io::ErrorKind::WouldBlock => Ok(None),
        Err(e) => Err(sorted("tcp", e)),
    }
}

fn sorted(address: &str, error: io::Error) -> TransportError {
    if error.kind() == io::ErrorKind::AddrInUse {
        return TransportError::Busy {
            address: address.to_owned(),
        };
    }
    TransportError::from_io(address, HINT, error)
}

impl TcpTransport {
    fn from_stream(stream: TcpStream, address: String) -> Result<Self, TransportError> {
        // A servo's packet must not wait for company.
        stream
            .set_nodelay(true)
            .and_then(|()| stream.set_nonblocking(true))
            .map_err(|e| sorted(&address, e))?;
        Ok(Self { address, stream })
    }
}

impl Transport for TcpTransport {
    fn boundary(&self) -> Boundary {
        Boundary::Stream
    }

    fn read(&mut self, buffer: &mut [u8]) -> Result<usize, TransportError> {
        descriptor::read(self.stream.as_fd(), buffer).map_err(|e| sorted(&self.address, e))
    }

    fn write(&mut self, bytes: &[u8]) -> Result<(), TransportError> {
        descriptor::write(self.stream.as_fd(), bytes).map_err(|e| sorted(&self.address, e))
    }

    fn wait(&mut self, clock: &dyn Clock, until: Instant) {
        descriptor::wait(self.stream.as_fd(), clock, until);
    }

    fn ready(&mut self) -> bool {
        descriptor::ready(self.stream.as_fd())
    }

    fn descriptor(&self) -> Option<BorrowedFd<'_>> {
        Some(self.stream.as_fd())
    }
}
