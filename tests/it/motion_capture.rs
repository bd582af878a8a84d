//! Motion capture from a file, through a show, to a puppet that keeps its limits.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

use bench::world::{Equipment, World, WorldOptions};
use rig::document::{Show, convert};
use rig::{Command, PuppetCommand, PuppetState, TransportCommand};

use crate::source::root;

/// A walk of 23 s, beside the checkout; `None`, said aloud, where it is not.
fn walk() -> Option<PathBuf> {
    let path = root().join("../shared/data/cmu_01_01.bvh");
    if path.exists() {
        return Some(path);
    }
    println!("SKIPPED: {} is not here", path.display());
    None
}

fn world(show: Show) -> World {
    let equipment = Equipment {
        knobs: None,
        tablet: None,
        puppet: Some("marionette".to_owned()),
        ..Equipment::default()
    };
    let options = WorldOptions {
        equipment,
        ..WorldOptions::new(show)
    };
    World::new(options).expect("the bench stands")
}

#[test]
fn a_walk_plays_on_the_marionette() {
    let Some(path) = walk() else { return };
    let (show, _) = convert::read_show(&path).expect("the file is sound");
    let mut world = world(show);
    // The walk's last stretch is enough; from there the puppet approaches from where it stands.
    world.step([
        Command::Transport(TransportCommand::Seek { secs: 19.0 }),
        Command::Puppet(PuppetCommand::Arm),
    ]);
    let state = |wanted: PuppetState| {
        move |seen: &rig::Snapshot, _: &bench::Stand| seen.puppet.as_ref().is_some_and(|p| p.state == wanted)
    };
    world
        .run_until("holding", 5.0, state(PuppetState::Holding))
        .expect("it arms");
    // Its 2,752 frames are judged before anything moves.
    let judged = |seen: &rig::Snapshot, _: &bench::Stand| {
        let view = seen.feasibility.as_ref();
        view.is_some_and(|view| view.progress >= 1.0)
    };
    world.run_until("judged", 20.0, judged).expect("it is judged");
    world.step([Command::Puppet(PuppetCommand::Play)]);
    world
        .run_until("playing", 2.0, state(PuppetState::Playing))
        .expect("it plays");
    let mut fastest: BTreeMap<String, f64> = BTreeMap::new();
    let mut furthest_rad: f64 = 0.0;
    let done = world.run_until("the end of the walk", 30.0, |seen, stand| {
        for joint in stand.joints() {
            let ratio = joint.velocity_rad_per_s.abs() / joint.speed_max_rad_per_s;
            let seen = fastest.entry(joint.joint).or_default();
            *seen = seen.max(ratio);
        }
        let puppet = seen.puppet.as_ref();
        for joint in puppet
            .iter()
            .filter(|p| p.clip_secs > Some(19.5))
            .flat_map(|p| &p.joints)
        {
            let away_rad = joint.goal_rad.unwrap_or(0.0) - joint.measured_rad.unwrap_or(f64::INFINITY);
            furthest_rad = furthest_rad.max(away_rad.abs());
        }
        puppet.is_some_and(|p| p.state != PuppetState::Playing)
    });
    let done = done.expect("the walk ends");
    let puppet = done.puppet.as_ref().expect("there is one");
    assert_eq!(puppet.state, PuppetState::Holding, "{:?}", puppet.fault);
    assert!(
        furthest_rad < 0.35,
        "measured joints stay near their goals, at most {furthest_rad} rad away"
    );
    // Rounding goals to counts may make a shaft 2 % faster for a moment.
    let too_fast: Vec<_> = fastest.iter().filter(|(_, ratio)| **ratio > 1.02).collect();
    assert!(too_fast.is_empty(), "{too_fast:?}");
    assert!(
        fastest.values().any(|ratio| *ratio > 0.2),
        "it walks at all: {fastest:?}"
    );
    assert!(world.close(), "torque is off at the end");
}

#[test]
fn a_walk_comes_back_as_it_was() {
    let Some(path) = walk() else { return };
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (show, back) = (folder.path().join("walk"), folder.path().join("back.bvh"));
    convert::convert(&path, &show).expect("becomes a show");
    convert::convert(&show, &back).expect("becomes a file again");
    let ends = |path: &PathBuf| {
        let (show, _) = convert::read_show(path).expect("reads");
        let figure = Arc::clone(&show.figure.as_ref().expect("a figure").figure);
        let clip = show
            .current_clip()
            .expect("a clip")
            .clip(&figure)
            .expect("builds")
            .expect("has keys");
        let mut rows = Vec::new();
        let mut placed = Vec::new();
        for frame in (0..2752).step_by(125) {
            clip.place(f64::from(frame) / 120.0, &mut placed);
            rows.extend(placed.iter().map(|link| link.start));
        }
        rows
    };
    let (before, after) = (ends(&path), ends(&back));
    assert_eq!(before.len(), after.len());
    let low = before.iter().map(|p| p.y).fold(f64::INFINITY, f64::min);
    let high = before.iter().map(|p| p.y).fold(f64::NEG_INFINITY, f64::max);
    let worst = before
        .iter()
        .zip(&after)
        .map(|(a, b)| a.distance(*b))
        .fold(0.0, f64::max);
    assert!(worst < 0.001 * (high - low), "{worst} of {}", high - low);
}
