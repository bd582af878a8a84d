//! A cable between a function and the kernel: one thread that serves its transfers, comes and goes with it.
//!
//! The kernel's `vhci_hcd` takes any stream socket for a device far away; here the far end is this program. Closing the
//! socket is pulling the cable.

use std::collections::VecDeque;
use std::io::{self, Write};
use std::os::fd::AsRawFd;
use std::os::unix::net::UnixStream;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

use device::clock::{Clock, Instant, MonotonicClock};
use rustix::event::{PollFd, PollFlags, Timespec, poll};

use super::function::{Function, Setup};
use super::usbip::{self, Imported, Inbox, Message, Submit};

/// Where `vhci_hcd` is told of devices.
const ATTACH: &str = "/sys/devices/platform/vhci_hcd.0/attach";
const STATUS: &str = "/sys/devices/platform/vhci_hcd.0/status";
const CONTROLLER: &str = "/sys/devices/platform/vhci_hcd.0";
/// Speed of the root hub that takes full-speed devices, as the kernel writes it.
const HUB_SPEED: &str = "480";
/// How long the kernel may take to forget a device whose cable was pulled.
const FORGETS_IN: Duration = Duration::from_secs(30);
/// How long a transfer may wait for data that is there, nanoseconds: less than a poll of a full-speed bus while something
/// goes on, and so long when nothing does that ten idle devices leave an emulated processor to others.
const LOOK_NS: i64 = 500_000;
const LOOK_IDLE_NS: i64 = 3_000_000;
/// Something goes on for so long after the last transfer, microseconds.
const BUSY_FOR_US: u64 = 50_000;
const GET_DESCRIPTOR: u8 = 6;
const GET_STATUS: u8 = 0;
const SET_ADDRESS: u8 = 5;
const SET_CONFIGURATION: u8 = 9;
const SET_INTERFACE: u8 = 11;
const CLEAR_FEATURE: u8 = 1;

/// Microseconds since a common beginning.
#[derive(Clone)]
pub struct Watch {
    clock: Arc<MonotonicClock>,
    began: Instant,
}

impl Watch {
    /// Begins now.
    pub fn start() -> Self {
        let clock = Arc::new(MonotonicClock::new());
        let began = clock.now();
        Self { clock, began }
    }

    /// Since the beginning.
    pub fn now_us(&self) -> u64 {
        self.clock.now().since(self.began).as_micros() as u64
    }

    /// Sleeps.
    pub fn pause(&self, span: Duration) {
        self.clock.sleep_until(self.clock.now().after(span));
    }
}

/// A function and whether its cable is in.
struct Shared<F> {
    function: Mutex<F>,
    plugged: AtomicBool,
    stop: AtomicBool,
}

/// A function on the kernel's bus. Dropping it pulls the cable, and returns when the kernel has forgotten the device.
pub struct Cable<F: Function + 'static> {
    shared: Arc<Shared<F>>,
    watch: Watch,
    thread: Option<JoinHandle<()>>,
}

impl<F: Function + 'static> Cable<F> {
    /// Puts the function on the bus, as number `device` of it, and serves it from a thread of its own.
    pub fn plug_in(function: F, device: u32, watch: &Watch) -> Self {
        let shared = Arc::new(Shared {
            function: Mutex::new(function),
            plugged: AtomicBool::new(true),
            stop: AtomicBool::new(false),
        });
        let (far, clock) = (Arc::clone(&shared), watch.clone());
        let thread = std::thread::spawn(move || serve(&far, device, &clock));
        Self {
            shared,
            watch: watch.clone(),
            thread: Some(thread),
        }
    }

    /// The function, for hands.
    pub fn function(&self) -> MutexGuard<'_, F> {
        lock(&self.shared.function)
    }

    /// Does something to the function now.
    pub fn with<T>(&self, act: impl FnOnce(&mut F, u64) -> T) -> T {
        let now_us = self.watch.now_us();
        act(&mut self.function(), now_us)
    }

    /// Pulls the cable out or puts it in.
    pub fn plug(&self, is_in: bool) {
        self.with(|function, now_us| function.plugged(now_us, is_in));
        self.shared.plugged.store(is_in, Ordering::SeqCst);
    }
}

impl<F: Function + 'static> Drop for Cable<F> {
    fn drop(&mut self) {
        self.shared.stop.store(true, Ordering::SeqCst);
        if let Some(thread) = self.thread.take() {
            // A thread that has panicked has said so on standard error.
            let _ = thread.join();
        }
    }
}

fn lock<F>(function: &Mutex<F>) -> MutexGuard<'_, F> {
    function.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Onto the bus whenever the cable is in and the function wants to be there.
fn serve<F: Function>(shared: &Shared<F>, device: u32, watch: &Watch) {
    while !shared.stop.load(Ordering::SeqCst) {
        let arrival = if shared.plugged.load(Ordering::SeqCst) {
            lock(&shared.function).arrival(watch.now_us())
        } else {
            0
        };
        if arrival == 0 {
            watch.pause(Duration::from_millis(5));
            continue;
        }
        if let Err(error) = attend(shared, device, arrival, watch) {
            eprintln!("device {device}: {error}");
            watch.pause(Duration::from_millis(100));
        }
    }
}

/// One stay on the bus, until the kernel has forgotten the device: what comes next must not find what was before.
fn attend<F: Function>(shared: &Shared<F>, device: u32, arrival: u32, watch: &Watch) -> io::Result<()> {
    let (far, port) = import(shared, device)?;
    let stayed = stay(shared, arrival, far, watch);
    let place = place_of(port)?;
    let until_us = watch.now_us() + FORGETS_IN.as_micros() as u64;
    while place.exists() {
        if watch.now_us() > until_us {
            return Err(io::Error::other(format!("{} is still there", place.display())));
        }
        watch.pause(Duration::from_millis(2));
    }
    stayed
}

/// Gives the kernel one end of a socket; the other end, and the port it has put the device at.
fn import<F: Function>(shared: &Shared<F>, device: u32) -> io::Result<(UnixStream, u32)> {
    let (near, mut far) = UnixStream::pair()?;
    let (ids, interfaces) = {
        let function = lock(&shared.function);
        (function.ids(), function.configuration()[4])
    };
    let who = Imported {
        vendor: ids[0],
        product: ids[1],
        device,
        interfaces,
    };
    let importing = std::thread::spawn(move || hand_over(near, device));
    usbip::export(&mut far, who)?;
    let port = importing
        .join()
        .map_err(|_| io::Error::other("the import ended badly"))??;
    Ok((far, port))
}

/// Where the kernel describes what is at a port of the virtual hub.
fn place_of(port: u32) -> io::Result<PathBuf> {
    for entry in std::fs::read_dir(CONTROLLER)? {
        let hub = entry?.path();
        let speed = std::fs::read_to_string(hub.join("speed")).unwrap_or_default();
        let name = hub.file_name().and_then(|name| name.to_str());
        if let Some(bus) = name.and_then(|name| name.strip_prefix("usb"))
            && speed.trim() == HUB_SPEED
        {
            // Ports of a hub are counted from 1, those of the controller from 0.
            return Ok(hub.join(format!("{bus}-{}", port + 1)));
        }
    }
    Err(io::Error::other("the virtual controller has no root hub"))
}

/// Serves the device's transfers as long as its cable is in.
fn stay<F: Function>(shared: &Shared<F>, arrival: u32, far: UnixStream, watch: &Watch) -> io::Result<()> {
    far.set_nonblocking(true)?;
    let mut link = Link {
        far,
        inbox: Inbox::default(),
        waiting: VecDeque::new(),
        listened: 0,
        busy_until_us: 0,
    };
    loop {
        let now_us = watch.now_us();
        let gone = shared.stop.load(Ordering::SeqCst)
            || !shared.plugged.load(Ordering::SeqCst)
            || lock(&shared.function).arrival(now_us) != arrival;
        if gone {
            // Closing the socket is all there is to it.
            return Ok(());
        }
        if !link.inbox.fill(&mut link.far)? {
            return Err(io::Error::other("the kernel has let go of the device"));
        }
        let mut function = lock(&shared.function);
        while let Some(message) = link.inbox.take()? {
            link.busy_until_us = now_us + BUSY_FOR_US;
            link.take(&mut *function, message, now_us)?;
        }
        link.complete(&mut *function, now_us)?;
        drop(function);
        link.rest(now_us);
    }
}

/// Imports the device and gives the socket to the kernel, which keeps it.
fn hand_over(mut near: UnixStream, device: u32) -> io::Result<u32> {
    let (id, speed) = usbip::import(&mut near, device)?;
    let _one_at_a_time = PORTS.lock().unwrap_or_else(PoisonError::into_inner);
    let port = free_port()?;
    std::fs::write(ATTACH, format!("{port} {} {id} {speed}", near.as_raw_fd()))?;
    Ok(port)
}

/// One thread at a time may look for a port and take it.
static PORTS: Mutex<()> = Mutex::new(());

/// The first free port of the full-speed hub.
fn free_port() -> io::Result<u32> {
    let status = std::fs::read_to_string(STATUS)?;
    // "hs  0000 004 000 ...": hub, port, and 004 for a port with nothing on it.
    let free = status.lines().find_map(|line| {
        let mut words = line.split_whitespace();
        let (hub, port, state) = (words.next()?, words.next()?, words.next()?);
        (hub == "hs" && state == "004").then(|| port.parse().ok())?
    });
    free.ok_or_else(|| io::Error::other("every port of the virtual hub is taken"))
}

/// A device's end of the socket.
struct Link {
    far: UnixStream,
    inbox: Inbox,
    /// Transfers that wait for the device to have something to say.
    waiting: VecDeque<Submit>,
    /// Endpoints the host asks, bit n for endpoint n.
    listened: u16,
    busy_until_us: u64,
}

impl Link {
    fn take(&mut self, function: &mut dyn Function, message: Message, now_us: u64) -> io::Result<()> {
        match message {
            Message::Unlink { sequence, victim } => {
                let at = self.waiting.iter().position(|submit| submit.sequence == victim);
                let called_back = at.and_then(|at| self.waiting.remove(at));
                self.say(&usbip::unlinked(sequence, called_back.is_some()))?;
                if let Some(submit) = called_back
                    && !self.waiting.iter().any(|other| other.endpoint == submit.endpoint)
                {
                    self.listened &= !(1 << submit.endpoint);
                    function.listened(now_us, submit.endpoint, false);
                }
                Ok(())
            }
            Message::Submit(submit) if submit.endpoint == 0 => {
                let setup = Setup::read(submit.setup);
                let answer = control(function, now_us, setup, &submit.data);
                self.say(&usbip::completed(&submit, answer.as_deref()))
            }
            Message::Submit(submit) if submit.inward => {
                if self.listened >> submit.endpoint & 1 == 0 {
                    self.listened |= 1 << submit.endpoint;
                    function.listened(now_us, submit.endpoint, true);
                }
                self.waiting.push_back(submit);
                Ok(())
            }
            Message::Submit(submit) => {
                let done = function.send(now_us, submit.endpoint, &submit.data).ok();
                self.say(&usbip::completed(&submit, done.map(|()| &[][..])))
            }
        }
    }

    /// Answers the transfers whose endpoint has something to say, each endpoint's in their order.
    fn complete(&mut self, function: &mut dyn Function, now_us: u64) -> io::Result<()> {
        let mut silent = 0u16;
        let mut at = 0;
        while let Some(submit) = self.waiting.get(at) {
            let bit = 1 << submit.endpoint;
            let bytes = if silent & bit == 0 {
                function.fetch(now_us, submit.endpoint, submit.length)
            } else {
                None
            };
            if let Some(bytes) = bytes {
                let answer = usbip::completed(submit, Some(&bytes));
                self.waiting.remove(at);
                self.say(&answer)?;
            } else {
                silent |= bit;
                at += 1;
            }
        }
        Ok(())
    }

    fn say(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.far.set_nonblocking(false)?;
        let said = self.far.write_all(bytes);
        self.far.set_nonblocking(true)?;
        said
    }

    /// Until the kernel says something, or the device may.
    fn rest(&self, now_us: u64) {
        let busy = now_us < self.busy_until_us;
        let limit = Timespec {
            tv_sec: 0,
            tv_nsec: if busy { LOOK_NS } else { LOOK_IDLE_NS },
        };
        let mut watched = [PollFd::new(&self.far, PollFlags::IN)];
        // An interrupted wait is a short one.
        let _ = poll(&mut watched, Some(&limit));
    }
}

/// Requests on the control pipe: those every device answers alike, then the function's own.
fn control(function: &mut dyn Function, now_us: u64, setup: Setup, data: &[u8]) -> Option<Vec<u8>> {
    let [index, what] = setup.value.to_le_bytes();
    let answer = match (setup.kind, setup.request) {
        (0x80, GET_DESCRIPTOR) => match what {
            1 => Ok(function.device_descriptor()),
            2 => Ok(function.configuration()),
            3 => function.string(now_us, index),
            _ => return None,
        },
        (0x80..=0x82, GET_STATUS) => Ok(vec![0, 0]),
        (0x00, SET_ADDRESS | SET_CONFIGURATION) | (0x01, SET_INTERFACE) | (0x00..=0x02, CLEAR_FEATURE) => {
            Ok(Vec::new())
        }
        _ => function.control(now_us, setup, data),
    };
    let mut bytes = answer.ok()?;
    bytes.truncate(usize::from(setup.length));
    Some(bytes)
}
