//! A take begins from how the controls stood: faders that had not caught their value, pages turned, keys held, devices
//! that come and go. Done again, on any day and wherever the controls are by then, the same keys come of it.
//!
//! `DIALRIG_SEED=n DIALRIG_CASES=m` takes others.

use std::path::Path;
use std::sync::Arc;

use bench::Movement;
use bench::hands::Tool;
use bench::world::{DIAL_BOX, TABLET, World, WorldOptions};
use firmware_sim::hands::Touch;
use rig::document::{self, Show};
use rig::take::TakeTolerance;
use rig::{Command, ControlCommand, NetworkEdit, NoteLevel, PoseCommand, TakeCommand};

/// The first two potentiometers twist a link each, all round; on the second page two others, and what was told to one
/// control: that it goes with its value whatever that is.
const NETWORK: &str = "p := F:MULC; SEND 360 TO <2>p; pa := F:ADDC; SEND -180 TO <2>pa;
    CONNECT DIAL_BOX<1>:<1>p; CONNECT p<1>:<1>pa; CONNECT pa<1>:<2>FIGURE.rua;
    q := F:MULC; SEND 360 TO <2>q; qa := F:ADDC; SEND -180 TO <2>qa;
    CONNECT DIAL_BOX<2>:<1>q; CONNECT q<1>:<1>qa; CONNECT qa<1>:<2>FIGURE.lua;
    r := F:MULC; SEND 360 TO <2>r; ra := F:ADDC; SEND -180 TO <2>ra;
    CONNECT DIAL_BOX_PAGE2<1>:<1>r; CONNECT r<1>:<1>ra; CONNECT ra<1>:<2>FIGURE.lfa;
    SEND 'relative' TO <2>DIAL_BOX_MODE;";

/// Numbers that look like none, from a seed (xorshift).
struct Numbers(u64);

impl Numbers {
    fn below(&mut self, count: u64) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) % count
    }

    fn share(&mut self) -> f64 {
        self.below(1001) as f64 / 1000.0
    }
}

fn setting(name: &str, unless: u64) -> u64 {
    let set = std::env::var(name).ok().and_then(|text| text.parse().ok());
    set.unwrap_or(unless)
}

fn world(show: Show) -> World {
    let mut options = WorldOptions::new(show);
    options.equipment.puppet = None;
    options.equipment.knobs = Some("deej".into());
    let mut world = World::new(options).expect("the bench stands");
    // The board starts anew when its port is opened.
    world.run_for(5.0);
    world
}

fn shipped() -> Show {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shows/salute");
    document::load(&folder).expect("the shipped show loads").show
}

/// Something that hands, cables or people do.
fn something(world: &mut World, numbers: &mut Numbers) {
    match numbers.below(8) {
        0..=3 => {
            let over_us = 50_000 + numbers.below(400_000);
            let touch = Touch::Axis {
                control: numbers.below(2) as u8,
                to: numbers.share(),
                over_us,
            };
            world.stand().touch(DIAL_BOX, &touch).expect("it has five");
        }
        4 => {
            let page = 1 + numbers.below(2) as u8;
            let device = DIAL_BOX.to_owned();
            world.step([Command::Controls(ControlCommand::Page { device, page })]);
        }
        5 => {
            let device = [DIAL_BOX, TABLET][numbers.below(2) as usize];
            world.stand().plug(device, false).expect("it has a cable");
            world.run_for(0.1 + numbers.share());
            world.stand().plug(device, true).expect("it has a cable");
            world.run_for(3.5);
        }
        6 => {
            let twist_rad = 4.0 * numbers.share() - 2.0;
            let link = 1 + numbers.below(4) as u16;
            world.step([Command::Pose(PoseCommand::LinkTwist { link, twist_rad })]);
        }
        _ => {
            let to = [numbers.share() - 0.5, numbers.share() - 0.5];
            world.hands().begin(TABLET, 0.0, Movement::Take(Tool::Puck));
            world
                .hands()
                .begin(TABLET, 0.05, Movement::Glide { to, over_secs: 0.3 });
        }
    }
    let secs = numbers.share() * 0.4;
    world.run_for(secs);
}

fn take(command: TakeCommand) -> [Command; 1] {
    [Command::Take(command)]
}

fn again(clip: &str) -> [Command; 1] {
    take(TakeCommand::Rerun {
        take: "wave".to_owned(),
        clip: Some(clip.to_owned()),
        tolerance: Some(TakeTolerance::default()),
    })
}

fn finish(world: &mut World) {
    world
        .run_until("the keys of the take", 120.0, |seen, _| seen.take.is_none())
        .expect("they come");
}

/// All numbers of the keys of a clip, bit for bit.
fn bits(world: &World, clip: &str) -> Vec<u64> {
    let show = Arc::clone(world.rig().show());
    let clip = show.clips.get(clip).unwrap_or_else(|| panic!("clip {clip}"));
    let mut bits = Vec::new();
    for key in &clip.keys {
        bits.push(key.secs.to_bits());
        bits.extend(key.pose.root.to_array().map(f64::to_bits));
        for link in &key.pose.links {
            bits.extend(link.direction.to_array().map(f64::to_bits));
            bits.extend([link.twist_rad, link.length].map(f64::to_bits));
        }
    }
    bits
}

/// What the take's keys differ from, if they do.
fn doubts(world: &World) -> Vec<String> {
    let notes = world.seen().notes.iter();
    let warned = notes.filter(|note| note.level == NoteLevel::Warning);
    let all = warned.map(|note| note.text.clone());
    all.filter(|text| text.contains("not quite what was seen") || text.contains("take"))
        .collect()
}

fn commands(world: &mut World, text: &str) {
    world.step([Command::Network(NetworkEdit::Commands(text.to_owned()))]);
}

fn performed(seed: u64) -> World {
    let mut numbers = Numbers(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1);
    let mut world = world(shipped());
    commands(&mut world, NETWORK);
    for _ in 0..numbers.below(8) {
        something(&mut world, &mut numbers);
    }
    world.step(take(TakeCommand::Start {
        name: "wave".to_owned(),
        devices: Vec::new(),
        tolerance: Some(TakeTolerance::default()),
    }));
    for _ in 0..4 + numbers.below(5) {
        something(&mut world, &mut numbers);
    }
    // Something that any network shows, with whatever hold the fader has by then.
    let push = |to: f64| Touch::Axis {
        control: 1,
        to,
        over_us: 300_000,
    };
    for to in [0.1, 0.9] {
        world.stand().touch(DIAL_BOX, &push(to)).expect("it has five");
        world.run_for(0.5);
    }
    world.step(take(TakeCommand::Stop));
    finish(&mut world);
    world
}

#[test]
fn wherever_the_controls_stood_the_same_keys_come_again_and_others_through_another_network() {
    let first = setting("DIALRIG_SEED", 1);
    let mut differed = 0;
    for seed in first..first + setting("DIALRIG_CASES", 4) {
        let mut world = performed(seed);
        assert_eq!(doubts(&world), Vec::<String>::new(), "DIALRIG_SEED={seed}");
        let keys = bits(&world, "wave");
        // Meanwhile the controls are elsewhere.
        let mut numbers = Numbers(seed + 77);
        for _ in 0..3 {
            something(&mut world, &mut numbers);
        }
        world.step(again("again"));
        finish(&mut world);
        assert_eq!(bits(&world, "again"), keys, "DIALRIG_SEED={seed}");

        let before = world.rig().show().program_text();
        commands(&mut world, "SEND 90 TO <2>q; SEND 90 TO <2>p; SEND 90 TO <2>r;");
        world.step(again("other"));
        finish(&mut world);
        differed += u64::from(bits(&world, "other") != keys);

        world.step([Command::Network(NetworkEdit::Program(before))]);
        world.step(again("back"));
        finish(&mut world);
        assert_eq!(bits(&world, "back"), keys, "DIALRIG_SEED={seed}");

        // Another day: the show out of its folder, the devices as they come up.
        let folder = tempfile::tempdir().expect("a folder");
        document::save(world.rig().show(), folder.path()).expect("it is saved");
        let loaded = document::load(&folder.path().join("show.toml")).expect("it loads");
        let [read, kept] = [&loaded.show, &**world.rig().show()].map(|show| format!("{:#?}", show.takes));
        let differs = read.lines().zip(kept.lines()).find(|(read, kept)| read != kept);
        assert_eq!(differs, None, "DIALRIG_SEED={seed}");
        let mut later = self::world(loaded.show);
        later.step(again("later"));
        finish(&mut later);
        assert_eq!(bits(&later, "later"), keys, "DIALRIG_SEED={seed}");
    }
    assert!(differed > 0, "another network made no difference");
}

/// A fader that had not caught its value when the take began does not take hold of it in a re-run, and one that had does.
#[test]
fn hold_at_the_beginning_belongs_to_the_take() {
    for held in [false, true] {
        let mut world = world(shipped());
        commands(&mut world, NETWORK);
        let push = |world: &mut World, to: f64| {
            let touch = Touch::Axis {
                control: 0,
                to,
                over_us: 1_000_000,
            };
            world.stand().touch(DIAL_BOX, &touch).expect("it has five");
            world.run_for(1.3);
        };
        push(&mut world, 0.2);
        if held {
            // Slowly through where the link stands.
            push(&mut world, 1.0);
            push(&mut world, 0.2);
        }
        let picked_up = world.seen().devices[0].controls[0].picked_up;
        assert_eq!(picked_up, held, "{:?}", world.seen().devices[0].controls[0]);
        world.step(take(TakeCommand::Start {
            name: "wave".to_owned(),
            devices: Vec::new(),
            tolerance: None,
        }));
        push(&mut world, 0.3);
        world.step(take(TakeCommand::Stop));
        finish(&mut world);
        assert_eq!(doubts(&world), Vec::<String>::new(), "held: {held}");
        let count = world.rig().show().clips["wave"].keys.len();
        let moved = {
            let show = Arc::clone(world.rig().show());
            let keys = &show.clips["wave"].keys;
            let twist = |at: usize| keys[at].pose.links.iter().map(|link| link.twist_rad).sum::<f64>();
            (twist(0) - twist(count - 1)).abs() > 0.1
        };
        assert_eq!(moved, held, "{count} keys");
    }
}
