//! Which order fits which state.

use crate::config::Ending;
use crate::fault::Fault;
use crate::order::{Order, Rejection};
use crate::player::{Player, Stance, State, Stopping};
use crate::trouble::Troubled;
use device::Instant;

impl Player {
    /// Follows an order, or says why not.
    pub(crate) fn obey(&mut self, order: Order, now: Instant) {
        // A heartbeat is somebody else's sign of life.
        if !matches!(order, Order::Heartbeat) {
            self.heard_operator = now;
        }
        let verb = order.verb();
        let fits = match (&order, &self.state) {
            (Order::Alive, _) | (Order::Release, State::Released) => Ok(()),
            (Order::Heartbeat, _) => {
                self.heartbeat_at = Some(now);
                Ok(())
            }
            (Order::CompensateLag(on), _) => {
                self.report.compensates_lag = *on;
                Ok(())
            }
            (Order::Stop, _) => {
                self.fault(Fault::StopPressed, now);
                Ok(())
            }
            (Order::Reset, State::Faulted(_)) => {
                self.reset_pending = true;
                self.stopping
                    .get_or_insert(Stopping::new(now, Ending::Release))
                    .ending = Ending::Release;
                Ok(())
            }
            (_, State::Faulted(_)) => Err("reset first"),
            (Order::Reset, _) => Err("there is no fault to leave"),
            (Order::Arm, State::Released) if self.heartbeat_is_missing(now) => {
                Err("this puppet needs a heartbeat, and none comes; start whoever sends it")
            }
            (Order::Arm, State::Released) if self.lines.all_loose() => {
                self.arm(now);
                Ok(())
            }
            (Order::Arm, _) => Err("release first, and wait until that is done"),
            (Order::Release, State::Arming) => {
                self.lines.release_all(now);
                self.state = State::Released;
                Ok(())
            }
            (Order::Release, _) => {
                self.begin_hold();
                self.stopping = Some(Stopping::new(now, Ending::Release));
                Ok(())
            }
            (_, State::Released) => Err("arm first"),
            (_, State::Arming) => Err("wait until arming is done"),
            (Order::Hold, _) => {
                self.begin_hold();
                Ok(())
            }
            _ if self.stopping.is_some() => Err("torque is going off; arm again"),
            _ => {
                self.play(order);
                Ok(())
            }
        };
        if let Err(remedy) = fits {
            self.reject(Rejection::State {
                order: verb,
                state: self.state.name(),
                remedy,
            });
        }
    }

    pub(crate) fn reject(&mut self, rejection: Rejection) {
        tracing::debug!("{rejection}");
        self.report.rejected = Some(rejection);
    }

    fn arm(&mut self, now: Instant) {
        self.state = State::Arming;
        self.stopping = None;
        self.troubled.fill(Troubled::default());
        self.pace = 1.0;
        for at in 0..self.lines.all.len() {
            let Some(line) = self.lines.all.get_mut(at) else {
                continue;
            };
            if let Err(error) = line.arm(now) {
                self.lose(at, error.to_string(), now);
                return;
            }
        }
    }

    fn begin_hold(&mut self) {
        self.playback = None;
        self.stance = Stance::Stand;
        if self.state == State::Playing {
            self.state = State::Holding;
        }
    }
}
