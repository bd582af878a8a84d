//! The only loop with a deadline: ticks a player at a fixed period, on a thread of its own.

use crate::order::Order;
use crate::player::Player;
use device::{Clock, Instant, Transport};
use std::ops::ControlFlow;
use std::time::Duration;

/// How long the loop goes on after it was told to end, for joints to come to a stand and torque to go off.
const END_MAX: Duration = Duration::from_secs(5);

/// A period of nothing would never wait.
const PERIOD_MIN: Duration = Duration::from_micros(500);
/// Above it the limiter would take every period for a pause of the host.
const PERIOD_MAX: Duration = Duration::from_millis(50);

/// Whoever sits at the other end of the loop. Nothing here may wait: the servos would wait with it.
pub trait Operator {
    /// The next order that has come since the last tick.
    fn order(&mut self) -> Option<Order>;

    /// A line that is back, by its bus's name. The player stays faulted until somebody resets it.
    fn returned_line(&mut self) -> Option<(String, Box<dyn Transport>)> {
        None
    }

    /// After each tick; breaking ends the loop.
    fn seen(&mut self, player: &Player) -> ControlFlow<()>;
}

/// Ticks at `period`, 0.5 to 50 ms, until the operator breaks. Between ticks the lines are listened to, so that the
/// rest of a period can be used.
///
/// However the loop ends, the player is stopped first if it may have torque: it decelerates, releases, and
/// only then the function returns.
pub fn run(player: &mut Player, clock: &dyn Clock, period: Duration, operator: &mut dyn Operator) {
    let period = period.clamp(PERIOD_MIN, PERIOD_MAX);
    player.config.period = period;
    let mut due = clock.now();
    let mut ending: Option<Instant> = None;
    let mut last_orders = [Order::Stop, Order::Reset].into_iter();
    loop {
        while let Some((bus, line)) = operator.returned_line() {
            if let Err(error) = player.reconnect(&bus, line) {
                tracing::warn!(%error, "a line that came back cannot be used");
            }
        }
        let now = clock.now();
        let report = if ending.is_none() {
            player.tick(now, &mut std::iter::from_fn(|| operator.order()))
        } else {
            player.tick(now, &mut last_orders)
        };
        let torque = report.torque;
        if operator.seen(player).is_break() && ending.is_none() {
            ending = Some(now.after(END_MAX));
        }
        if ending.is_some_and(|ending| !torque || now >= ending) {
            return;
        }
        due = due.after(period);
        let now = clock.now();
        if now > due.after(period) {
            // So far behind that catching up would be a burst: go on from here.
            due = now;
        }
        listen(player, clock, due);
    }
}

fn listen(player: &mut Player, clock: &dyn Clock, until: Instant) {
    while clock.now() < until {
        player.wait(clock, until);
        player.poll(clock.now());
    }
}
