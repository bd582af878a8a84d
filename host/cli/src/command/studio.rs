//! `dialrig [SHOW]`: the studio's window.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use bench::world::Equipment;
use rig::{Command, Live, Snapshot};
use ui::studio::Session;

use crate::console::Console;
use crate::failure::{Exit, Failure};
use crate::interrupt::Interrupt;
use crate::setup::{self, LiveSetup};

/// Control cycles of the puppet.
const PERIOD: Duration = Duration::from_millis(10);

pub(crate) fn run(show: Option<&PathBuf>, console: &Console) -> Result<Exit, Failure> {
    // Before anything else, so that a machine without a display hears of it at once.
    ui::studio::check().map_err(|error| Failure::refused(error.to_string()))?;
    let (mut show, folder) = setup::show(show.map(PathBuf::as_path), console)?;
    if show.networks.is_empty() {
        // A show made from motion capture has none yet; without one no control would do anything.
        show.networks.push(Arc::new(rig::shipped::figure_network()));
    }
    let equipment = Equipment {
        puppet: show.puppet.clone(),
        ..Equipment::default()
    };
    let setup = LiveSetup {
        show,
        folder,
        profiles: setup::profiles()?,
        equipment,
        inputs: Vec::new(),
        ports: Vec::new(),
        period: PERIOD,
        heartbeat: None,
    };
    let live = Arc::new(setup.start(|_| {})?);
    let session = Seat {
        live: Arc::clone(&live),
        interrupt: Interrupt::listen(),
    };
    let shown = ui::studio::run(Box::new(session));
    // The window is gone, and with it the other owner; the rig lets go of the puppet before the program ends.
    let released = Arc::into_inner(live).is_none_or(Live::close);
    shown.map_err(|error| Failure::refused(error.to_string()))?;
    if released {
        Ok(Exit::Done)
    } else {
        Err(Failure::torque_unknown())
    }
}

/// The window's end of the rig: Ctrl-C closes it as its button would, so that the puppet is let go.
struct Seat {
    live: Arc<Live>,
    interrupt: Interrupt,
}

impl Session for Seat {
    fn snapshot(&self) -> Arc<Snapshot> {
        self.live.snapshot()
    }

    fn send(&self, command: Command) {
        self.live.send(command);
    }

    fn is_over(&self) -> bool {
        self.interrupt.came()
    }
}
