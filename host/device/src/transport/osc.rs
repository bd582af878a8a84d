//! Packets of a network controller: UDP, heard on one port and answered on another.
//!
//! Only this machine is heard unless another address is asked for, since a packet carries no proof of who sent it.
//! Answers go to whoever was heard last. Source: OSC 1.0, "OSC Packets"; hexler's TouchOSC manual (8000 to the host,
//! 9000 back); `docs/protocols/osc.md`.

mod held;

use super::intake::{Intake, Reading, gone};
use super::{Boundary, Transport, TransportError};
use crate::clock::{Clock, Instant};
use held::Held;
use std::io::{self, ErrorKind};
use std::net::{IpAddr, Ipv4Addr, SocketAddr, UdpSocket};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

const HINT: &str = "ports below 1024 are the system's; choose another";
/// From the port that is heard to the one that is answered, where none is named: 8000 and 9000 are usual.
const ANSWERS_AFTER: u16 = 1000;

/// Where a controller is heard and answered.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct OscPlace {
    /// Port that is heard.
    pub listen: u16,
    /// Port of the controller that is answered; none: 1000 above the one that is heard.
    pub send: Option<u16>,
    /// Address of this machine on which it is heard; none: only from this machine.
    pub on: Option<IpAddr>,
}

impl OscPlace {
    /// Reads `8000`, `8000-9000`, `8000-9000@0.0.0.0`.
    pub fn parse(text: &str) -> Option<Self> {
        let (ports, on) = match text.split_once('@') {
            Some((ports, on)) => (ports, Some(on.parse().ok()?)),
            None => (text, None),
        };
        let port = |text: &str| text.parse().ok().filter(|&port: &u16| port > 0);
        let (listen, send) = match ports.split_once('-') {
            Some((listen, send)) => (port(listen)?, Some(port(send)?)),
            None => (port(ports)?, None),
        };
        Some(Self { listen, send, on })
    }
}

impl std::fmt::Display for OscPlace {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}", self.listen)?;
        if let Some(send) = self.send {
            write!(f, "-{send}")?;
        }
        self.on.map_or(Ok(()), |on| write!(f, "@{on}"))
    }
}

/// When a packet is due, as the time of day since the beginning of 1970; none: now. Whoever opens the port knows the
/// format.
pub type Due = fn(&[u8]) -> Option<Duration>;

/// A packet due later than this from now is from a machine whose clock is another: it is taken at once.
const LATEST: Duration = Duration::from_mins(1);

/// The shortest wait for a packet; the system counts in microseconds.
const SHORTEST: Duration = Duration::from_micros(100);

/// Who was heard last.
type Peer = Arc<Mutex<Option<IpAddr>>>;

/// An open port.
#[derive(Debug)]
pub struct OscPort {
    address: String,
    socket: UdpSocket,
    intake: Intake,
    peer: Peer,
    send_port: u16,
}

/// Opens `place`; arrivals are noted by `clock`. A packet that `due` says is for later arrives then.
pub fn open(place: OscPlace, due: Due, clock: Arc<dyn Clock>) -> Result<OscPort, TransportError> {
    let address = format!("osc:{place}");
    let sort = |error: io::Error| match error.kind() {
        ErrorKind::AddrInUse => TransportError::Busy {
            address: address.clone(),
        },
        _ => TransportError::from_io(&address, HINT, error),
    };
    let on = place.on.unwrap_or(IpAddr::V4(Ipv4Addr::LOCALHOST));
    let socket = UdpSocket::bind((on, place.listen)).map_err(sort)?;
    let peer = Peer::new(Mutex::new(on.is_loopback().then_some(on)));
    let packets = Packets {
        socket: socket.try_clone().map_err(sort)?,
        peer: Arc::clone(&peer),
        limit: None,
        due,
        clock: Arc::clone(&clock),
        held: Held::default(),
    };
    let intake = Intake::spawn("osc", clock, Box::new(packets)).map_err(sort)?;
    Ok(OscPort {
        address,
        socket,
        intake,
        peer,
        send_port: place.send.unwrap_or(place.listen.saturating_add(ANSWERS_AFTER)),
    })
}

struct Packets {
    socket: UdpSocket,
    peer: Peer,
    limit: Option<Duration>,
    due: Due,
    clock: Arc<dyn Clock>,
    held: Held,
}

impl Packets {
    /// Whether the packet is kept for later.
    fn is_for_later(&mut self, packet: &[u8]) -> bool {
        let Some((due, today)) = (self.due)(packet).zip(self.clock.time_of_day()) else {
            return false;
        };
        let ahead = due.saturating_sub(today);
        !ahead.is_zero() && ahead <= LATEST && self.held.keep(self.clock.now().after(ahead), packet)
    }
}

impl Reading for Packets {
    fn read(&mut self, buffer: &mut [u8], limit: Duration) -> io::Result<usize> {
        let now = self.clock.now();
        if let Some(packet) = self.held.take(now) {
            let count = packet.len().min(buffer.len());
            buffer
                .iter_mut()
                .zip(&packet)
                .for_each(|(place, byte)| *place = *byte);
            return Ok(count);
        }
        // Not longer than until the next one is due; a limit of nothing is refused by the system.
        let until_due = self.held.next().map(|due| due.since(now).max(SHORTEST));
        let limit = until_due.map_or(limit, |due| due.min(limit));
        if self.limit != Some(limit) {
            self.socket.set_read_timeout(Some(limit))?;
            self.limit = Some(limit);
        }
        match self.socket.recv_from(buffer) {
            Ok((count, from)) => {
                *self.peer.lock().unwrap_or_else(PoisonError::into_inner) = Some(from.ip());
                let later = buffer
                    .get(..count)
                    .is_some_and(|packet| self.is_for_later(packet));
                Ok(if later { 0 } else { count })
            }
            // Nothing came; or the system has told that nobody takes our answers, which is nobody's end.
            Err(error)
                if matches!(
                    error.kind(),
                    ErrorKind::WouldBlock
                        | ErrorKind::TimedOut
                        | ErrorKind::Interrupted
                        | ErrorKind::ConnectionRefused
                ) =>
            {
                Ok(0)
            }
            Err(error) => Err(error),
        }
    }
}

impl Transport for OscPort {
    /// One read is one packet, and so is one write.
    fn boundary(&self) -> Boundary {
        Boundary::Reports
    }

    fn read(&mut self, buffer: &mut [u8]) -> Result<usize, TransportError> {
        self.intake.read(buffer).ok_or_else(|| gone(&self.address))
    }

    /// To whoever was heard last; lost where nobody was, or nobody listens, as packets are.
    fn write(&mut self, bytes: &[u8]) -> Result<(), TransportError> {
        let peer = *self.peer.lock().unwrap_or_else(PoisonError::into_inner);
        let Some(ip) = peer else { return Ok(()) };
        if let Err(error) = self.socket.send_to(bytes, SocketAddr::new(ip, self.send_port)) {
            tracing::debug!(address = self.address, %error, "a packet was not sent");
        }
        Ok(())
    }

    fn arrived(&self) -> Option<Instant> {
        self.intake.arrived()
    }

    fn dropped(&self) -> u64 {
        self.intake.dropped()
    }

    fn wait(&mut self, clock: &dyn Clock, until: Instant) {
        self.intake.wait(clock, until);
    }

    fn ready(&mut self) -> bool {
        self.intake.ready()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::clock::MonotonicClock;

    #[test]
    fn places_print_as_they_were_typed() {
        for text in [
            "8000",
            "8000-9000",
            "8000@0.0.0.0",
            "8000-9001@192.168.1.5",
            "8000@::1",
        ] {
            let place = OscPlace::parse(text).expect(text);
            assert_eq!(place.to_string(), text);
        }
        for text in ["", "0", "8000-0", "70000", "8000-", "8000@", "8000@nobody", "a"] {
            assert_eq!(OscPlace::parse(text), None, "{text}");
        }
    }

    #[test]
    fn packets_keep_their_edges_and_answers_find_their_way() {
        let clock = Arc::new(MonotonicClock::new());
        let controller = UdpSocket::bind("127.0.0.1:0").expect("a port");
        let answered = controller.local_addr().expect("bound").port();
        let free = UdpSocket::bind("127.0.0.1:0")
            .and_then(|s| s.local_addr())
            .expect("a port");
        let place = OscPlace {
            listen: free.port(),
            send: Some(answered),
            on: None,
        };
        let mut port = open(place, at_once, clock.clone()).expect("it is free");
        assert!(matches!(
            open(place, at_once, clock.clone()),
            Err(TransportError::Busy { .. })
        ));
        for packet in [&b"one"[..], b"three"] {
            controller.send_to(packet, free).expect("sent");
        }
        let until = clock.now().after(Duration::from_secs(5));
        let mut heard = Vec::new();
        while heard.len() < 2 && clock.now() < until {
            port.wait(clock.as_ref(), until);
            let mut buffer = [0; 64];
            let count = port.read(&mut buffer).expect("open");
            if count > 0 {
                heard.push(buffer[..count].to_vec());
            }
        }
        assert_eq!(heard, [b"one".to_vec(), b"three".to_vec()]);
        port.write(b"back").expect("sent");
        let mut buffer = [0; 64];
        controller
            .set_read_timeout(Some(Duration::from_secs(5)))
            .expect("set");
        let (count, _) = controller.recv_from(&mut buffer).expect("heard");
        assert_eq!(&buffer[..count], b"back");
    }

    fn at_once(_packet: &[u8]) -> Option<Duration> {
        None
    }

    /// A packet whose text is a time of day in milliseconds is due then.
    fn in_text(packet: &[u8]) -> Option<Duration> {
        let text = std::str::from_utf8(packet).ok()?;
        text.parse().ok().map(Duration::from_millis)
    }

    #[test]
    fn what_is_for_later_arrives_later_and_what_is_late_at_once() {
        let clock = Arc::new(MonotonicClock::new());
        let free = UdpSocket::bind("127.0.0.1:0").and_then(|s| s.local_addr());
        let free = free.expect("a port");
        let place = OscPlace {
            listen: free.port(),
            send: None,
            on: None,
        };
        let mut port = open(place, in_text, clock.clone()).expect("it is free");
        let controller = UdpSocket::bind("127.0.0.1:0").expect("a port");
        let today = clock.time_of_day().expect("a time of day");
        let at = |ms: u64| (today + Duration::from_millis(ms)).as_millis().to_string();
        let sent = clock.now();
        let packets = [at(400), at(200), "5".to_owned(), "now".to_owned(), at(3_600_000)];
        for packet in &packets {
            controller.send_to(packet.as_bytes(), free).expect("sent");
        }
        let until = sent.after(Duration::from_secs(5));
        let mut heard = Vec::new();
        while heard.len() < packets.len() && clock.now() < until {
            port.wait(clock.as_ref(), until);
            let mut buffer = [0; 64];
            let count = port.read(&mut buffer).expect("open");
            if count > 0 {
                let text = String::from_utf8_lossy(&buffer[..count]).into_owned();
                heard.push((text, port.arrived().expect("noted").since(sent)));
            }
        }
        let order: Vec<_> = heard.iter().map(|(text, _)| text.clone()).collect();
        // An hour ahead is a wrong clock.
        assert_eq!(order, [2, 3, 4, 1, 0].map(|n| packets[n].clone()));
        assert!(heard[3].1 >= Duration::from_millis(190), "{heard:?}");
        assert!(heard[4].1 >= Duration::from_millis(390), "{heard:?}");
    }

    #[test]
    fn only_this_machine_is_heard_unless_asked() {
        let clock = Arc::new(MonotonicClock::new());
        let open_on = |on| {
            let free = UdpSocket::bind("127.0.0.1:0").and_then(|s| s.local_addr());
            let place = OscPlace {
                listen: free.expect("a port").port(),
                send: None,
                on,
            };
            open(place, at_once, clock.clone()).expect("it is free")
        };
        let bound = |port: &OscPort| port.socket.local_addr().expect("bound").ip();
        assert!(bound(&open_on(None)).is_loopback());
        let everywhere = open_on(Some(IpAddr::V4(Ipv4Addr::UNSPECIFIED)));
        assert!(bound(&everywhere).is_unspecified());
        assert_eq!(
            *everywhere.peer.lock().expect("whole"),
            None,
            "nobody to answer yet"
        );
    }
}
