//! Taking what is plugged in: known devices get a seat of their own without being asked for, and keep it while they
//! are away.

use std::time::Duration;

use device::clock::Instant;

use super::{Change, InputSpec, Inputs, Seat};
use crate::controls::view::DeviceHealth;
use crate::ports::{Found, Plug, Ports};

/// Between two listings. With the lookout's own pause a device is taken within a second.
pub(super) const LIST_AGAIN: Duration = Duration::from_millis(400);
/// So long a node's rights may take to be set after the node is there; before that nobody is told of them.
const SETTLES_IN: Duration = Duration::from_secs(2);
/// Between two attempts to open in that time.
pub(super) const TRY_AGAIN_SOON: Duration = Duration::from_millis(250);

/// How a seat came to be without anybody naming it.
#[derive(Clone, Debug)]
pub(super) struct Taken {
    /// What such devices are called, and which of several equal ones it is.
    pub(super) kind: String,
    pub(super) slot: u16,
    /// When it was last plugged in.
    pub(super) since: Instant,
    /// Whether it was there at the latest listing.
    pub(super) there: bool,
    /// What has to be done before it may be opened.
    pub(super) rule: Option<String>,
}

impl Taken {
    /// Whether its rights may still be on their way.
    pub(super) fn settling(&self, now: Instant) -> bool {
        now.since(self.since) < SETTLES_IN
    }

    fn is(&self, plug: &Plug) -> bool {
        self.kind == plug.name && self.slot == plug.slot
    }
}

impl Inputs {
    /// Looks at what is plugged in, every now and then.
    pub(super) fn plug(&mut self, now: Instant, ports: &mut dyn Ports, noticed: &mut dyn FnMut(Change)) {
        if now < self.list_at {
            return;
        }
        self.list_at = now.after(self.list_again);
        let found = ports.list();
        for seat in &mut self.seats {
            let address = &seat.spec.address;
            let gone = || !found.iter().any(|f| f.address == *address && f.plug.is_some());
            if let Some(taken) = &mut seat.taken {
                taken.there &= !gone();
            }
        }
        self.refused
            .retain(|address| found.iter().any(|f| f.address == *address));
        for one in &found {
            if let Some(plug) = &one.plug {
                self.take_in(one, plug, now, ports, noticed);
            }
        }
    }

    fn take_in(
        &mut self,
        found: &Found,
        plug: &Plug,
        now: Instant,
        ports: &mut dyn Ports,
        noticed: &mut dyn FnMut(Change),
    ) {
        let named = |seat: &Seat| seat.taken.is_none() && seat.spec.address == found.address;
        if let Some(seat) = self.seats.iter_mut().find(|seat| named(seat)) {
            // Whoever named it knows what he wants of it.
            self.identified += u64::from(seat.is_known_by(plug));
            return;
        }
        let is_its = |seat: &Seat| seat.taken.as_ref().is_some_and(|taken| taken.is(plug));
        let its = self.seats.iter().position(is_its);
        let Some(place) = its.or_else(|| self.new_seat(found, plug, now, ports)) else {
            return;
        };
        if let (None, Some(held)) = (its, &found.held) {
            let name = self.seats[place].spec.name.clone();
            noticed(Change::Absent(name, held.remedy.clone()));
        }
        let Some(seat) = self.seats.get_mut(place) else {
            return;
        };
        self.identified += u64::from(seat.is_known_by(plug));
        if seat.open {
            return;
        }
        seat.come_back(found, now);
        let Some(taken) = &seat.taken else { return };
        if let (Some(rule), false) = (&taken.rule, taken.settling(now)) {
            // Whoever holds it may be the reason why it cannot be opened at all.
            let holder = found.held.as_ref().filter(|held| held.remedy == *rule);
            let health = match holder {
                Some(held) => DeviceHealth::Held {
                    driver: format!("the kernel's driver {}", held.driver),
                },
                None => DeviceHealth::Forbidden { rule: rule.clone() },
            };
            if seat.health != health {
                noticed(Change::Absent(seat.spec.name.clone(), rule.clone()));
                seat.health = health;
            }
        }
    }

    /// A seat for a device that was never here; its place. None where nothing says what it is.
    fn new_seat(&mut self, found: &Found, plug: &Plug, now: Instant, ports: &mut dyn Ports) -> Option<usize> {
        let spec = InputSpec {
            name: self.free_name(&plug.name, plug.slot),
            profile: plug.name.clone(),
            address: found.address.clone(),
        };
        let mut seat = if plug.profile.is_some() {
            Seat::new(spec, &self.profiles).ok()?
        } else {
            self.described(spec, found, ports)?
        };
        seat.taken = Some(Taken {
            kind: plug.name.clone(),
            slot: plug.slot,
            since: now,
            // Of one that had to be opened to know it, nothing more is to be found out.
            there: seat.open,
            rule: None,
        });
        // In the order of their names, as those that were named are.
        let place = self
            .seats
            .partition_point(|other| other.spec.name < seat.spec.name);
        self.seats.insert(place, seat);
        Some(place)
    }

    /// A seat for a device that only its own description says something of, open already. Each is tried once a plugging.
    fn described(&mut self, spec: InputSpec, found: &Found, ports: &mut dyn Ports) -> Option<Seat> {
        if found.allowed.is_err() || self.refused.contains(&found.address) {
            return None;
        }
        let line = ports
            .open_device(&spec.name, &found.address, None)
            .map_err(|error| error.to_string());
        match line.and_then(|line| Seat::described(spec, line)) {
            Ok(seat) => Some(seat),
            Err(why) => {
                tracing::debug!("{}: {why}", found.address);
                self.refused.insert(found.address.clone());
                None
            }
        }
    }

    /// The profile's key; the second of its kind has a 2 behind it, and so on, apart from a digit before.
    pub(super) fn free_name(&self, profile: &str, slot: u16) -> String {
        let free = |name: &String| self.seats.iter().all(|seat| seat.spec.name != *name);
        let own = if slot < 2 {
            profile.to_owned()
        } else if profile.ends_with(|c: char| c.is_ascii_digit()) {
            format!("{profile}-{slot}")
        } else {
            format!("{profile}{slot}")
        };
        let mut others = (2..=u16::MAX).map(|n| format!("{profile}-{n}"));
        if free(&own) {
            own
        } else {
            others.find(free).unwrap_or(own)
        }
    }

    /// Keeps a device's place among equal ones. The device that had that place changes with it.
    pub(crate) fn pin(&mut self, name: &str, slot: Option<u16>, ports: &mut dyn Ports) -> Result<(), String> {
        let seat = self.seats.iter().find(|seat| seat.spec.name == name);
        let seat = seat.ok_or_else(|| format!("there is no input device {name}"))?;
        let Some(taken) = seat.taken.clone() else {
            // An address that was given is the place.
            return Err(format!("{name} is kept at {} already", seat.spec.address));
        };
        ports.pin(&seat.spec.address, slot)?;
        let Some(slot) = slot.filter(|slot| *slot != taken.slot) else {
            return Ok(());
        };
        for seat in &mut self.seats {
            let same = |taken: &Taken, with: u16| taken.slot == with;
            let concerns = seat.taken.as_ref().is_some_and(|other| {
                other.kind == taken.kind && (same(other, slot) || same(other, taken.slot))
            });
            if concerns {
                // The next listing says which of them is where now. What was held on it is let go with the next poll.
                seat.close();
            }
        }
        self.list_at = Instant::ZERO;
        Ok(())
    }
}

impl Seat {
    /// Takes over by what it is told apart; whether that is news.
    fn is_known_by(&mut self, plug: &Plug) -> bool {
        if plug.identity.is_empty() || self.identity == plug.identity {
            return false;
        }
        self.identity.clone_from(&plug.identity);
        true
    }

    /// It is there (again), perhaps at another address, perhaps not to be opened yet.
    fn come_back(&mut self, found: &Found, now: Instant) {
        let moved = self.spec.address != found.address;
        let Some(taken) = &mut self.taken else { return };
        if moved || !taken.there {
            self.spec.address.clone_from(&found.address);
            taken.since = now;
            taken.there = true;
            self.look_at = now;
        }
        let rule = found.allowed.as_ref().err().cloned();
        if rule.is_none() && taken.rule.is_some() {
            self.look_at = now;
        }
        taken.rule = rule;
    }

    /// Lets go of the line. The device stays to tell what was held.
    fn close(&mut self) {
        if let Some(device) = &mut self.device {
            device.close();
        }
        self.open = false;
        self.health = DeviceHealth::Lost;
        self.spec.address.clear();
        if let Some(taken) = &mut self.taken {
            taken.there = false;
        }
    }
}
