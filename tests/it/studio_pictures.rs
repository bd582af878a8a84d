//! The studio's pictures, made from a whole rig on the bench and drawn by whatever graphics adapter is there.
//!
//! They are what the manual shows and what a person looks at after a change; what can be asserted about a
//! picture without looking is asserted here. Where no adapter exists, the tests say so and pass.

use std::path::Path;
use std::sync::Arc;

use bench::hands::Movement;
use bench::world::{DIAL_BOX, Equipment, TABLET, World, WorldOptions};
use firmware_sim::hands::Turn;
use rig::{Command, DeviceHealth, PoseCommand, PuppetCommand, PuppetState, Snapshot, TransportCommand};
use ui::render::film::write_png;
use ui::render::picture::Picture;
use ui::studio::Studio;

/// Windows the studio must look right in: the smallest, a laptop's, a desk's.
const SIZES: [(u32, u32); 3] = [(1280, 720), (1440, 900), (1920, 1080)];

fn world() -> World {
    let show = rig::document::from_texts(&rig::shipped::salute()).expect("the shipped show is whole");
    let equipment = Equipment { puppet: show.puppet.clone(), ..Equipment::default() };
    let profiles = Arc::new(rig::shipped::profiles(None).expect("the shipped profiles are whole"));
    let options = WorldOptions { show, profiles, equipment, journal: None, dut: None };
    let mut world = World::new(options).expect("the bench stands");
    world
        .run_until("devices answering", 3.0, |seen, _| {
            seen.devices.iter().all(|device| device.health == DeviceHealth::Present)
        })
        .expect("they answer");
    world
}

/// Nothing touched yet.
pub fn first() -> Arc<Snapshot> {
    Arc::clone(world().run_for(0.5))
}

/// A hand turns a dial of the box.
fn turn(world: &mut World, dial: u8, turns: f64, over_secs: f64) {
    let by = Turn::Turns(turns);
    let control = dial - 1;
    world.hands().begin(DIAL_BOX, 0.0, Movement::Turn { control, by, over_secs });
}

/// A view from which depth can be seen, by dials 1 and 2.
fn turn_view(world: &mut World) {
    turn(world, 1, 0.13, 0.4);
    turn(world, 2, 0.09, 0.4);
    world.run_for(1.0);
}

/// Both hands at work: the right one moves the puck over the tablet, and with it the forearm.
pub fn posing() -> Arc<Snapshot> {
    let mut world = world();
    turn_view(&mut world);
    world.step([
        Command::Transport(TransportCommand::Seek { secs: 1.95 }),
        Command::Pose(PoseCommand::Select(6)),
    ]);
    world.run_for(0.1);
    let to = beside(&world, 6, [0.55, 0.45]);
    world.hands().begin(TABLET, 0.0, Movement::Glide { to, over_secs: 0.5 });
    turn(&mut world, 4, 0.2, 0.6);
    Arc::clone(world.run_for(0.5))
}

/// The place on the tablet that is `off` link lengths away from where a link starts, as seen from the front.
fn beside(world: &World, link: usize, off: [f64; 2]) -> [f64; 2] {
    let seen = world.seen();
    let figure = seen.figure.as_ref().expect("the show has a figure");
    let (view, link) = (&seen.view, figure.placed[link]);
    let start = view.view_from_world() * (link.start - view.centre);
    let length = link.start.distance(link.end);
    let surface = world.stand().surface(TABLET).expect("it is there").expect("it is a tablet");
    surface.script_from_cursor([start.x + off[0] * length, start.y + off[1] * length].map(|at| at * view.scale))
}

fn armed() -> World {
    let mut world = world();
    world.step([Command::Puppet(PuppetCommand::Arm)]);
    world
        .run_until("the puppet holding", 5.0, |seen, _| state(seen) == Some(PuppetState::Holding))
        .expect("it arms");
    world
}

fn state(seen: &Snapshot) -> Option<PuppetState> {
    seen.puppet.as_ref().map(|puppet| puppet.state)
}

/// The puppet in the middle of its salute.
fn performing() -> World {
    let mut world = armed();
    turn_view(&mut world);
    world.step([Command::Pose(PoseCommand::Select(4)), Command::Puppet(PuppetCommand::Play)]);
    let there = |seen: &Snapshot, _: &_| seen.puppet.as_ref().is_some_and(|p| p.clip_secs > Some(1.75));
    world.run_until("the salute", 20.0, there).expect("it performs");
    world
}

pub fn playing() -> Arc<Snapshot> {
    Arc::clone(performing().seen())
}

/// The same, and the cable of a bus is pulled out.
pub fn faulted() -> Arc<Snapshot> {
    let mut world = performing();
    world.stand().plug("upper", false).expect("the bus is there");
    world
        .run_until("the fault", 2.0, |seen, _| state(seen) == Some(PuppetState::Faulted))
        .expect("it is noticed");
    Arc::clone(world.run_for(0.3))
}

fn keep(picture: &Picture, name: &str) {
    let folder = std::env::var("PICS").unwrap_or_else(|_| env!("CARGO_TARGET_TMPDIR").to_owned());
    let folder = Path::new(&folder);
    let file = std::fs::File::create(folder.join(format!("studio-{name}.png"))).expect("writable");
    write_png(picture, file).expect("a picture is a PNG");
}

#[test]
fn all() {
    for (name, seen) in [("first", first()), ("posing", posing()), ("playing", playing()), ("faulted", faulted())] {
        for size in SIZES {
            let picture = ui::still::draw(&mut Studio::new(), &seen, size, 1.0).expect("an adapter");
            keep(&picture, &format!("{name}-{}", size.0));
        }
    }
}
