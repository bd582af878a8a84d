//! Who ticks the player: the rig's own step, or a thread that nothing else can hold up.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

use crossbeam_channel::{Receiver, Sender, TryRecvError, bounded};
use device::clock::{Clock, Instant};
use device::transport::Transport;
use device_profiles::PuppetProfile;
use player::{Fault, Operator, Order, Player, PlayerConfig, Puppet, Report, State};

use super::{LOOK_AGAIN, Pace};
use crate::ports::Ports;
use crate::snapshot::NoteLevel;

/// Orders that may wait for the player; a person gives a few a second, a live pose a hundred.
const ORDERS_MAX: usize = 64;
/// A rig that has not stepped for so long is not in charge any more. Longer than baking a long clip takes.
const RIG_SILENT_MAX: Duration = Duration::from_secs(3);
/// Longest wait for joints to stand and torque to go off when the rig closes.
const CLOSE_MAX: Duration = Duration::from_secs(5);

/// One serial line of the puppet.
#[derive(Clone, Debug)]
pub(super) struct Line {
    pub(super) bus: String,
    pub(super) address: String,
    pub(super) baud: u32,
}

/// The player and who ticks it.
pub(super) enum Runner {
    /// Not all lines are open yet.
    Waiting,
    /// Ticked by the rig's step.
    Inline(Box<Inline>),
    /// On a thread of its own.
    Threaded(Threaded),
}

pub(super) struct Inline {
    player: Player,
    orders: Vec<Order>,
    told: Told,
}

pub(super) struct Threaded {
    messages: Sender<Message>,
    /// Set for a stop, past all that waits.
    stop: Arc<AtomicBool>,
    seen: Arc<Mutex<Seen>>,
    thread: Option<JoinHandle<()>>,
    told: Told,
    /// When a lost line is looked for again; none once it was given back, until the fault is left.
    look_at: Option<Instant>,
}

enum Message {
    Order(Order),
    Reconnect(String, Box<dyn Transport>),
    End,
}

/// What the thread shows to the others: a copy of its latest report.
#[derive(Default)]
struct Seen {
    report: Report,
    refusals: Vec<String>,
    /// Counts refusals, so that each is told once.
    refused: u64,
}

/// What the person has been told already.
#[derive(Default)]
struct Told {
    faulted: bool,
    backing_off: Option<(player::Trouble, usize)>,
    refused: u64,
    rejected: Option<String>,
}

/// Opens all lines and seats the player, or says which line failed.
pub(super) fn open(
    puppet: &Puppet,
    lines: &[Line],
    ports: &mut dyn Ports,
    config: &PlayerConfig,
    pace: Pace,
) -> Result<Player, String> {
    let buses = lines
        .iter()
        .map(|line| {
            let transport = ports
                .open(&line.address, line.baud)
                .map_err(|error| error.to_string())?;
            puppet
                .connect(&line.bus, transport)
                .map_err(|error| error.to_string())
        })
        .collect::<Result<Vec<_>, _>>()?;
    let mut config = config.clone();
    if pace == Pace::OwnThread {
        // Whoever ticks the player in its own step cannot be silent while it ticks.
        config.operator_max.get_or_insert(RIG_SILENT_MAX);
    }
    Player::new(puppet.clone(), buses, config).map_err(|error| error.to_string())
}

impl Runner {
    pub(super) fn start(player: Player, pace: Pace, clock: &Arc<dyn Clock>) -> Self {
        match pace {
            Pace::WithTheRig => Self::Inline(Box::new(Inline {
                player,
                orders: Vec::new(),
                told: Told::default(),
            })),
            Pace::OwnThread => Self::Threaded(Threaded::start(player, Arc::clone(clock))),
        }
    }

    /// Hands an order over; fails when nobody is there to take it.
    pub(super) fn order(&mut self, order: Order) -> Result<(), ()> {
        match self {
            Self::Inline(inline) if inline.orders.len() < ORDERS_MAX || matches!(order, Order::Stop) => {
                inline.orders.push(order);
                Ok(())
            }
            Self::Waiting | Self::Inline(_) => Err(()),
            // However many orders wait: a stop goes past them.
            Self::Threaded(threaded) if matches!(order, Order::Stop) => {
                threaded.stop.store(true, Ordering::Release);
                Ok(())
            }
            Self::Threaded(threaded) => threaded.messages.try_send(Message::Order(order)).map_err(|_| ()),
        }
    }

    pub(super) fn report(&self, look: &mut dyn FnMut(&Report)) {
        match self {
            Self::Waiting => {}
            Self::Inline(inline) => look(inline.player.report()),
            Self::Threaded(threaded) => look(
                &threaded
                    .seen
                    .lock()
                    .unwrap_or_else(PoisonError::into_inner)
                    .report,
            ),
        }
    }

    /// Ticks the player if it is the rig's to tick, brings lost lines back when a reset asks for it, and
    /// collects what a person should know.
    pub(super) fn advance(
        &mut self,
        now: Instant,
        lines: &[Line],
        profile: &PuppetProfile,
        ports: &mut dyn Ports,
        remarks: &mut Vec<(NoteLevel, String)>,
    ) {
        match self {
            Self::Waiting => {}
            Self::Inline(inline) => {
                if inline.orders.iter().any(|order| matches!(order, Order::Reset))
                    && let Some(line) = lost_line(inline.player.state(), lines)
                {
                    let back = ports
                        .open(&line.address, line.baud)
                        .map_err(|error| error.to_string());
                    let back =
                        back.and_then(|t| inline.player.reconnect(&line.bus, t).map_err(|e| e.to_string()));
                    if let Err(why) = back {
                        remarks.push((NoteLevel::Warning, why));
                    }
                }
                let report = inline.player.tick(now, &mut inline.orders.drain(..));
                inline.told.about(report, profile, remarks);
                if report.arming_refused {
                    let refusals = inline.player.refusals().map(ToString::to_string);
                    remarks.extend(refusals.map(|refusal| (NoteLevel::Warning, refusal)));
                }
            }
            Self::Threaded(threaded) => threaded.tell(now, lines, profile, ports, remarks),
        }
    }

    /// Stops and lets go. Returns whether torque is known to be off.
    pub(super) fn close(self, clock: &dyn Clock) -> bool {
        match self {
            Self::Waiting => true,
            Self::Inline(mut inline) => {
                let (mut off, mut known) = (false, false);
                let began = clock.now();
                let mut orders = vec![Order::Stop, Order::Reset];
                while !off && clock.now().since(began) < CLOSE_MAX {
                    let report = inline.player.tick(clock.now(), &mut orders.drain(..));
                    off = !report.torque;
                    known = !report.torque_unknown;
                    clock.sleep_until(clock.now().after(inline.player.config().period));
                }
                off && known
            }
            Self::Threaded(mut threaded) => {
                // The thread stops the player before it ends, whatever made it end.
                let _ = threaded
                    .messages
                    .send_timeout(Message::End, Duration::from_secs(1));
                if let Some(thread) = threaded.thread.take() {
                    let _ = thread.join();
                }
                let seen = threaded.seen.lock().unwrap_or_else(PoisonError::into_inner);
                !seen.report.torque && !seen.report.torque_unknown
            }
        }
    }
}

/// The line whose loss is the player's fault, if that is what it is.
fn lost_line<'a>(state: &State, lines: &'a [Line]) -> Option<&'a Line> {
    let State::Faulted(Fault::BusLost { bus, .. }) = state else {
        return None;
    };
    lines.iter().find(|line| line.bus == *bus)
}

impl Told {
    fn about(&mut self, report: &Report, profile: &PuppetProfile, remarks: &mut Vec<(NoteLevel, String)>) {
        if report.backing_off != self.backing_off {
            self.backing_off = report.backing_off;
            remarks.push(match super::view::backing_off(profile, report) {
                Some(why) => (NoteLevel::Warning, format!("puppet backs off: {why}")),
                None => (NoteLevel::Info, "puppet no longer backs off".to_owned()),
            });
        }
        let faulted = matches!(report.state, State::Faulted(_));
        if let (State::Faulted(fault), false) = (&report.state, self.faulted) {
            remarks.push((NoteLevel::Error, format!("puppet stopped: {fault}")));
        }
        self.faulted = faulted;
        let rejected = report.rejected.as_ref().map(ToString::to_string);
        if let Some(why) = rejected
            .as_ref()
            .filter(|why| self.rejected.as_ref() != Some(why))
        {
            remarks.push((NoteLevel::Warning, format!("puppet: {why}")));
        }
        self.rejected = rejected;
    }
}

impl Threaded {
    fn start(player: Player, clock: Arc<dyn Clock>) -> Self {
        let (messages, inbox) = bounded(ORDERS_MAX);
        let seen = Arc::new(Mutex::new(Seen::default()));
        let shown = Arc::clone(&seen);
        let stop = Arc::new(AtomicBool::new(false));
        let stop_there = Arc::clone(&stop);
        let thread = std::thread::Builder::new()
            .name("puppet".into())
            .spawn(move || live(player, &*clock, &inbox, &stop_there, &shown))
            .map_err(|error| tracing::error!("the puppet's thread did not start: {error}"))
            .ok();
        Self {
            messages,
            stop,
            seen,
            thread,
            told: Told::default(),
            look_at: Some(Instant::ZERO),
        }
    }

    fn tell(
        &mut self,
        now: Instant,
        lines: &[Line],
        profile: &PuppetProfile,
        ports: &mut dyn Ports,
        remarks: &mut Vec<(NoteLevel, String)>,
    ) {
        // Each step is a sign of life; a queue that is full of orders is one, too.
        let _ = self.messages.try_send(Message::Order(Order::Alive));
        let seen = self.seen.lock().unwrap_or_else(PoisonError::into_inner);
        self.told.about(&seen.report, profile, remarks);
        if seen.refused != self.told.refused {
            self.told.refused = seen.refused;
            remarks.extend(seen.refusals.iter().map(|why| (NoteLevel::Warning, why.clone())));
        }
        let lost = lost_line(&seen.report.state, lines).cloned();
        drop(seen);
        let Some(line) = lost else {
            self.look_at = Some(Instant::ZERO);
            return;
        };
        // A line that is back is given to the player once; the fault stands until the reset.
        if self.look_at.is_some_and(|due| now >= due) {
            self.look_at = Some(now.after(LOOK_AGAIN));
            if let Ok(transport) = ports.open(&line.address, line.baud)
                && self
                    .messages
                    .try_send(Message::Reconnect(line.bus, transport))
                    .is_ok()
            {
                self.look_at = None;
            }
        }
    }
}

/// The thread: runs the player until the end is asked for.
fn live(
    mut player: Player,
    clock: &dyn Clock,
    inbox: &Receiver<Message>,
    stop: &AtomicBool,
    seen: &Mutex<Seen>,
) {
    let period = player.config().period;
    let mut post = Post {
        inbox,
        stop,
        seen,
        returned: None,
        refused: false,
        ended: false,
    };
    player::run(&mut player, clock, period, &mut post);
    let refused = std::mem::take(&mut post.refused);
    show(&player, refused, seen);
}

/// The rig as the player's thread knows it: an inbox, and a place to show reports.
struct Post<'a> {
    inbox: &'a Receiver<Message>,
    stop: &'a AtomicBool,
    seen: &'a Mutex<Seen>,
    returned: Option<(String, Box<dyn Transport>)>,
    /// A refusal that nobody could be shown yet.
    refused: bool,
    ended: bool,
}

impl Operator for Post<'_> {
    fn order(&mut self) -> Option<Order> {
        if self.stop.swap(false, Ordering::Acquire) {
            return Some(Order::Stop);
        }
        match self.inbox.try_recv() {
            Ok(Message::Order(order)) => Some(order),
            // Given to the player before its next tick; what else waits comes with that one.
            Ok(Message::Reconnect(bus, line)) => {
                self.returned = Some((bus, line));
                None
            }
            Ok(Message::End) | Err(TryRecvError::Disconnected) => {
                self.ended = true;
                None
            }
            Err(TryRecvError::Empty) => None,
        }
    }

    fn returned_line(&mut self) -> Option<(String, Box<dyn Transport>)> {
        self.returned.take()
    }

    fn seen(&mut self, player: &Player) -> ControlFlow<()> {
        self.refused |= player.report().arming_refused;
        if show(player, self.refused, self.seen) {
            self.refused = false;
        }
        if self.ended {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    }
}

/// Copies the report for others without waiting for them: a reader at this moment sees the one before. Returns
/// whether it was copied.
fn show(player: &Player, refused: bool, seen: &Mutex<Seen>) -> bool {
    let Ok(mut seen) = seen.try_lock() else {
        return false;
    };
    let report = player.report();
    let mut joints = std::mem::take(&mut seen.report.joints);
    joints.clone_from(&report.joints);
    seen.report = Report {
        joints,
        state: report.state.clone(),
        rejected: report.rejected.clone(),
        ..*report
    };
    if refused {
        seen.refused += 1;
        seen.refusals = player.refusals().map(ToString::to_string).collect();
    }
    true
}
