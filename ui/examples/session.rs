//! How does a program open the studio on a session of its own? This one has an arm of three links that
//! follows the first three dials; everything else the window asks for is printed.
//!
//! `cargo run -p ui --example session`

use std::sync::{Arc, Mutex, PoisonError};

use glam::DVec3;
use motion::figure::{Figure, LinkSpec};
use rig::{Command, FigureView, Snapshot, Touch};
use ui::studio::{Session, run};

struct Arm(Mutex<Snapshot>);

impl Session for Arm {
    fn snapshot(&self) -> Arc<Snapshot> {
        Arc::new(self.0.lock().unwrap_or_else(PoisonError::into_inner).clone())
    }

    fn send(&self, command: Command) {
        let mut seen = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        match command {
            Command::Touch {
                touch: Touch::Dial { control, turns },
                ..
            } => {
                if let Some(dial) = seen.desk.dials.get_mut(usize::from(control)) {
                    dial.turns += turns;
                    dial.live = true;
                }
                bend(&mut seen);
            }
            other => eprintln!("{other:?}"),
        }
    }
}

/// Points link after link where the dials add up to.
fn bend(seen: &mut Snapshot) {
    let turns = [0, 1, 2].map(|dial| seen.desk.dials[dial].turns);
    let Some(view) = &mut seen.figure else { return };
    let mut angle_rad = 0.3;
    for (link, turns) in view.pose.links.iter_mut().zip(turns) {
        angle_rad += turns * std::f64::consts::TAU - 0.4;
        link.direction = DVec3::new(angle_rad.sin(), angle_rad.cos(), 0.2).normalize_or_zero();
    }
    view.figure.place(&view.pose, &mut view.placed);
}

fn main() {
    let link = |number: u32, next: &[u32]| LinkSpec {
        number,
        name: format!("link {number}"),
        dof: 2,
        length: 0.4,
        children: next
            .iter()
            .map(|&child| (child, DVec3::new(0.0, 0.0, 0.4)))
            .collect(),
    };
    let specs = [link(0, &[1]), link(1, &[2]), link(2, &[])];
    let figure = Arc::new(Figure::new(&specs).expect("three links in a row are a figure").0);
    let mut seen = Snapshot {
        show: "an arm".into(),
        ..Snapshot::default()
    };
    seen.figure = Some(FigureView {
        shapes: Arc::new(vec![Vec::new(); 3]),
        pose: figure.rest_pose(),
        placed: Vec::new(),
        selected: Some(2),
        cursor: None,
        candidates: Vec::new(),
        posing: false,
        figure,
    });
    seen.view.centre = DVec3::new(0.0, 0.4, 0.0);
    seen.view.scale = 0.8;
    seen.desk.simulated_device = Some("dials".into());
    for (dial, label) in seen.desk.dials.iter_mut().zip(["shoulder", "elbow", "wrist"]) {
        dial.label = label.into();
    }
    bend(&mut seen);
    if let Err(error) = run(Box::new(Arm(Mutex::new(seen)))) {
        eprintln!("{error}");
        std::process::exit(1);
    }
}
