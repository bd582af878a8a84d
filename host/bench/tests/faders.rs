//! A box of potentiometers from its bytes to the view: it takes hold without a step, through a cable that was out.

use std::sync::Arc;

use bench::world::{DIAL_BOX, World, WorldOptions};
use firmware_sim::hands::Touch;
use rig::document::{NetworkFile, Show};
use rig::{Command, DeviceHealth, ViewCommand};

/// The first potentiometer turns the view, 0 to 90 degrees.
const PROGRAM: &str = "s := F:MULC; SEND 90 TO <2>s; CONNECT DIAL_BOX<1>:<1>s; CONNECT s<1>:<5>VIEW;";

fn world() -> World {
    let show = Show {
        name: "pots".into(),
        networks: vec![Arc::new(NetworkFile {
            name: "pots".into(),
            text: PROGRAM.into(),
        })],
        ..Show::default()
    };
    let mut options = WorldOptions::new(show);
    options.equipment.knobs = Some("deej".into());
    let mut world = World::new(options).expect("the bench stands");
    // The board starts anew when its port is opened.
    world.run_for(5.0);
    assert_eq!(
        world.seen().devices[0].health,
        DeviceHealth::Present,
        "{:?}",
        world.seen().notes
    );
    world
}

fn push(world: &mut World, to: f64, over_secs: f64) -> f64 {
    let touch = Touch::Axis {
        control: 0,
        to,
        over_us: (over_secs * 1e6) as u64,
    };
    world.stand().touch(DIAL_BOX, &touch).expect("it has five");
    world.run_for(over_secs + 0.5);
    azimuth_deg(world)
}

fn azimuth_deg(world: &World) -> f64 {
    world.seen().view.azimuth_rad.to_degrees()
}

#[test]
fn a_potentiometer_takes_hold_and_never_steps() {
    let mut world = world();
    push(&mut world, 0.1, 1.0);
    let to_rad = 81_f64.to_radians() - world.seen().view.azimuth_rad;
    world.step([Command::View(ViewCommand::Turn {
        azimuth_by_rad: to_rad,
        elevation_by_rad: 0.0,
    })]);
    assert!((push(&mut world, 0.5, 1.0) - 81.0).abs() < 1e-9, "far from it");
    assert!(!world.seen().devices[0].controls[0].picked_up);
    assert_eq!(world.seen().devices[0].controls[0].bound, ["VIEW<5>"]);
    assert!(
        (push(&mut world, 1.0, 1.0) - 90.0).abs() < 0.2,
        "through it and along"
    );
    assert!(world.seen().devices[0].controls[0].picked_up);
    assert!(
        world.seen().devices[0].rate_hz > 20.0,
        "{:?}",
        world.seen().devices[0]
    );

    world.stand().plug(DIAL_BOX, false).expect("it has a cable");
    world.run_for(1.0);
    let lost = world
        .seen()
        .notes
        .iter()
        .any(|note| note.text.contains("what it drives stays where it is"));
    assert!(lost, "{:?}", world.seen().notes);
    push(&mut world, 0.2, 0.2);
    world.stand().plug(DIAL_BOX, true).expect("it has a cable");
    world.run_for(6.0);
    let after = azimuth_deg(&world);
    assert!((after - 90.0).abs() < 0.2, "a return moves nothing: {after}");
    let far = push(&mut world, 0.6, 1.0);
    assert!((far - after).abs() < 1e-9, "nor does it before it is there again");
    push(&mut world, 1.0, 1.0);
    assert!(
        (push(&mut world, 0.5, 1.0) - 45.0).abs() < 1.5,
        "then it goes along"
    );
}
