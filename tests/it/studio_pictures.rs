//! The studio's pictures, made from a whole rig on the bench and drawn by whatever graphics adapter is there.
//!
//! They lie in the target's `tmp` folder for people to look at; `studio.png` and `studio-faulted.png` in
//! `docs/pictures` are from here. What can be said of a picture without looking is said here. Where no adapter
//! exists, the tests say so and pass.

use std::path::PathBuf;
use std::sync::Arc;

use bench::hands::Movement;
use bench::world::{DIAL_BOX, Equipment, TABLET, World, WorldOptions};
use firmware_sim::hands::Turn;
use rig::{
    Command, DeviceHealth, NetworkEdit, PoseCommand, PuppetCommand, PuppetState, Snapshot, TransportCommand,
};
use ui::panels::layout::Areas;
use ui::render::film::write_png;
use ui::render::offscreen::Headless;
use ui::render::picture::Picture;
use ui::render::theme::{self, Rgb};
use ui::studio::{Studio, window_rect};

/// Windows the studio must look right in: the smallest, a laptop's, a desk's.
pub(crate) const SIZES: [(u32, u32); 3] = [(1280, 720), (1440, 900), (1920, 1080)];

/// The left forearm and hand, by their places in the shipped figure.
const FOREARM: u16 = 6;
const HAND: u16 = 7;
/// A key of the clip at which the right hand salutes and the left arm hangs.
const SALUTE_SECS: f64 = 1.95;
/// When both arms are spread wide and moving.
const SPREAD_SECS: f64 = 3.4;

/// The shipped show with its simulated devices, all of which answer.
pub(crate) fn world() -> World {
    let show = rig::document::from_texts(&rig::shipped::salute()).expect("the shipped show is whole");
    let equipment = Equipment {
        puppet: show.puppet.clone(),
        ..Equipment::default()
    };
    let profiles = rig::shipped::profiles(None).expect("the shipped profiles are whole");
    let options = WorldOptions {
        show,
        profiles: Arc::new(profiles),
        equipment,
        calibrations: <_>::default(),
        journal: None,
        dut: None,
    };
    let mut world = World::new(options).expect("the bench stands");
    let present = |seen: &Snapshot| seen.devices.iter().all(|d| d.health == DeviceHealth::Present);
    world
        .run_until("devices answering", 3.0, |seen, _| present(seen))
        .expect("they answer");
    world.run_for(0.5);
    world
}

/// A hand turns a dial of the box.
fn turn(world: &mut World, dial: u8, turns: f64, over_secs: f64) {
    let movement = Movement::Turn {
        control: dial - 1,
        by: Turn::Turns(turns),
        over_secs,
    };
    world.hands().begin(DIAL_BOX, 0.0, movement);
}

/// Dials 1 and 2 turn the view until depth can be seen.
fn look_from_aside(world: &mut World) {
    turn(world, 1, 0.13, 0.4);
    turn(world, 2, 0.09, 0.4);
    world.run_for(1.0);
}

/// The place on the tablet that is `off` link lengths away from where a link starts, as seen from the front.
fn beside(world: &World, link: u16, off: [f64; 2]) -> [f64; 2] {
    let seen = world.seen();
    let figure = seen.figure.as_ref().expect("the show has a figure");
    let link = figure.placed[usize::from(link)];
    let start = seen.view.view_from_world() * (link.start - seen.view.centre);
    let length = link.start.distance(link.end);
    let cursor = [start.x + off[0] * length, start.y + off[1] * length];
    let surface = world.stand().surface(TABLET).expect("it is there");
    let surface = surface.expect("a tablet has one");
    surface.script_from_cursor(cursor.map(|at| at * seen.view.scale))
}

/// Both hands at work: the right one moves the puck and with it the forearm, the left one turns the twist dial.
fn posing() -> World {
    let mut world = world();
    look_from_aside(&mut world);
    world.step([
        Command::Transport(TransportCommand::Seek { secs: SALUTE_SECS }),
        Command::Pose(PoseCommand::Select(FOREARM)),
    ]);
    world.run_for(0.1);
    let to = beside(&world, FOREARM, [0.55, 0.45]);
    let glide = Movement::Glide { to, over_secs: 0.5 };
    world.hands().begin(TABLET, 0.0, glide);
    turn(&mut world, 4, 0.2, 0.6);
    world.run_for(0.5);
    world
}

pub(crate) fn state(seen: &Snapshot) -> Option<PuppetState> {
    seen.puppet.as_ref().map(|puppet| puppet.state)
}

/// The puppet performs, arms spread, while a hand turns the view a little.
pub(crate) fn playing() -> World {
    let mut world = world();
    world.step([Command::Puppet(PuppetCommand::Arm)]);
    let holding = |seen: &Snapshot| state(seen) == Some(PuppetState::Holding);
    world
        .run_until("the puppet holding", 5.0, |seen, _| holding(seen))
        .expect("it arms");
    look_from_aside(&mut world);
    world.step([
        Command::Pose(PoseCommand::Select(HAND)),
        Command::Puppet(PuppetCommand::Play),
    ]);
    let at = |seen: &Snapshot, secs| seen.puppet.as_ref().is_some_and(|p| p.clip_secs >= Some(secs));
    world
        .run_until("the clip well begun", 20.0, |seen, _| at(seen, SPREAD_SECS - 0.3))
        .expect("it performs");
    turn(&mut world, 1, 0.03, 0.4);
    world
        .run_until("arms spread", 5.0, |seen, _| at(seen, SPREAD_SECS))
        .expect("it performs on");
    world
}

/// The same, and somebody pulls out the cable of a bus.
fn faulted() -> World {
    let mut world = playing();
    world
        .stand()
        .plug("upper", false)
        .expect("it is a bus of the marionette");
    let faulted = |seen: &Snapshot| state(seen) == Some(PuppetState::Faulted);
    world
        .run_until("the fault", 2.0, |seen, _| faulted(seen))
        .expect("a missing bus is noticed");
    world.run_for(0.3);
    world
}

/// Says aloud that there is nothing to draw with.
pub(crate) fn no_adapter() -> bool {
    Headless::start()
        .inspect_err(|error| eprintln!("SKIPPED: {error}"))
        .is_err()
}

pub(crate) fn draw(seen: &Snapshot, size: (u32, u32)) -> Picture {
    ui::still::draw(&mut Studio::new(), seen, size, 1.0).expect("the adapter that started also draws")
}

/// Leaves a picture where a person can look at it.
pub(crate) fn keep(picture: &Picture, name: &str) {
    let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("rig-{name}-{}.png", picture.width));
    let file = std::fs::File::create(&path).expect("the folder is the tests' own");
    write_png(picture, file).expect("a picture is a PNG");
}

/// How many pixels are nearly `colour`.
pub(crate) fn count(picture: &Picture, colour: Rgb) -> usize {
    let near = |p: &[u8]| {
        let channels = [(p[0], colour.0), (p[1], colour.1), (p[2], colour.2)];
        channels.iter().all(|(a, b)| a.abs_diff(*b) < 24)
    };
    picture.rgba.chunks_exact(4).filter(|p| near(p)).count()
}

/// The texts a dial box of the bench shows, dials first, blanks cut off.
fn displays(world: &World) -> Vec<String> {
    let shown = world.stand().shown(DIAL_BOX).expect("it is a dial box");
    (0..20)
        .map(|control| {
            shown
                .labels
                .get(&control)
                .map_or(String::new(), |text| text.trim_end().to_owned())
        })
        .collect()
}

#[test]
fn the_patch_panel_shows_the_rigs_own_network_and_its_edits() {
    if no_adapter() {
        return;
    }
    let mut world = world();
    world.step([Command::LookAtNetwork(true)]);
    turn(&mut world, 1, 0.1, 0.2);
    world.run_for(0.3);
    let mut studio = Studio::new();
    studio.choices().board = ui::panels::Board::Patch;
    let size = (1440, 900);
    let picture =
        ui::still::draw(&mut studio, world.seen(), size, 1.0).expect("the adapter that started also draws");
    keep(&picture, "patch");
    assert_eq!(count(&picture, theme::FAULTED), 0, "red where nothing is faulted");
    let text = "listener := F:NOP; CONNECT DIALS<1>:<1>listener;";
    world.step([Command::Network(NetworkEdit::Commands(text.into()))]);
    turn(&mut world, 1, 0.1, 0.2);
    world.run_for(0.3);
    let network = world.seen().network.as_ref().expect("somebody looks");
    let listener = network.picture.find(&"listener".into()).expect("it was made");
    let sent = &network.activity.outputs[network.picture.boxes[listener].first_output];
    assert!(sent.sent > 0, "it hears the dial");
    assert!(network.can_undo && network.text.contains("listener"));
    world.step([Command::Network(NetworkEdit::Undo)]);
    world.run_for(0.05);
    let network = world.seen().network.as_ref().expect("somebody still looks");
    assert_eq!(network.picture.find(&"listener".into()), None);
}

/// Makes a studio in one state.
type Make = fn() -> World;

#[test]
fn each_colour_has_one_meaning_in_every_state_and_size() {
    if no_adapter() {
        return;
    }
    let worlds: [(&str, Make); 4] = [
        ("first", world),
        ("posing", posing),
        ("playing", playing),
        ("faulted", faulted),
    ];
    for (name, make) in worlds {
        let world = make();
        let seen = world.seen();
        for size in SIZES {
            let picture = draw(seen, size);
            keep(&picture, name);
            let (red, live) = (count(&picture, theme::FAULTED), count(&picture, theme::LIVE));
            let selected = count(&picture, theme::SELECTED);
            if name == "faulted" {
                assert!(
                    red > 4000,
                    "{name} {size:?}: a fault must be found at once, {red} pixels"
                );
            } else {
                assert_eq!(red, 0, "{name} {size:?}: red where nothing is faulted");
            }
            assert!(
                selected > 100,
                "{name} {size:?}: {selected} pixels of what is selected"
            );
            // The play head and the lamps of two devices are always there; a body and its joints are more.
            let least = if name == "playing" { 900 } else { 100 };
            assert!(live > least, "{name} {size:?}: {live} pixels of what is live");
            let line = count(&picture, theme::LINE);
            assert!(
                line > 1500,
                "{name} {size:?}: {line} pixels as bright as the figure"
            );
            assert!(
                draw(seen, size) == picture,
                "{name} {size:?}: drawn twice, two pictures"
            );
        }
    }
}

#[test]
fn the_desk_reads_what_the_box_displays() {
    let mut world = world();
    let labels = |seen: &Snapshot| -> Vec<String> {
        let dials = seen.desk.dials.iter().map(|dial| &dial.label);
        dials
            .chain(seen.desk.keys.iter().map(|key| &key.label))
            .cloned()
            .collect()
    };
    let before = labels(world.seen());
    assert_eq!(before, displays(&world));
    assert_eq!((before[0].as_str(), before[8].as_str()), ("Turn", "Place"));
    // F3 turns the page; twenty bytes of it are on their way for a while.
    let press = Movement::Press {
        control: 2,
        for_secs: 0.05,
    };
    world.hands().begin(DIAL_BOX, 0.0, press);
    world.run_for(1.0);
    let after = labels(world.seen());
    assert_eq!(after, displays(&world));
    assert_eq!(after[0], "Root X");
}

#[test]
fn a_label_changes_its_display_and_nothing_else() {
    if no_adapter() {
        return;
    }
    let world = world();
    let mut seen = Snapshot::clone(world.seen());
    let size = SIZES[0];
    let before = draw(&seen, size);
    seen.desk.dials[0].label = "Root X".to_owned();
    let after = draw(&seen, size);
    let desk = Areas::of(window_rect([size.0 as f32, size.1 as f32])).desk;
    let pixels = before.rgba.chunks_exact(4).zip(after.rgba.chunks_exact(4));
    let changed: Vec<[f32; 2]> = pixels
        .enumerate()
        .filter(|(_, (a, b))| a != b)
        .map(|(index, _)| [index as u32 % size.0, index as u32 / size.0].map(|at| at as f32))
        .collect();
    assert!(changed.len() > 40, "{} pixels", changed.len());
    let eighth = desk.left() + desk.width() * 0.535 / 8.0;
    let inside = |[x, y]: &[f32; 2]| *x < eighth && *y > desk.top() && *y < desk.top() + 32.0;
    assert!(changed.iter().all(inside), "outside of the first dial's display");
}
