//! The two renderers: the processor's bytes are fixed, the graphics card's picture agrees with them.

use glam::DVec3;
use ui::render::camera::Camera;
use ui::render::offscreen::Headless;
use ui::render::raster;
use ui::render::scene::{Ink, Layer, Mark, Scene};
use ui::render::theme;

/// A helix with marks: every kind of piece, every layer, all depths.
fn helix() -> Scene {
    let mut scene = Scene::new(Camera::turned(0.3, 0.4, DVec3::ZERO, 1.2));
    let ink = Ink::new(theme::LINE, Layer::Figure);
    let at = |step: i32| {
        let turn = f64::from(step) * 0.2;
        DVec3::new(turn.cos() * 0.8, f64::from(step) * 0.015 - 0.9, turn.sin() * 0.8)
    };
    let points: Vec<DVec3> = (0..120).map(at).collect();
    scene.polyline(&points, 2.5, ink);
    scene.stroke(
        DVec3::NEG_X,
        DVec3::X,
        1.0,
        Ink::new(theme::FAINT, Layer::Ground).faded(0.5),
    );
    scene.dot(at(10), 6.0, Mark::Disc, Ink::new(theme::SELECTED, Layer::Overlay));
    scene.dot(
        at(40),
        8.0,
        Mark::Ring,
        Ink::new(theme::LIVE, Layer::Overlay).flat(),
    );
    scene.dot(
        at(80),
        7.0,
        Mark::Diamond,
        Ink::new(theme::FAULTED, Layer::Overlay),
    );
    scene
}

/// Changes only on purpose: look at the picture before you write the new number here.
const HELIX_HASH: u64 = 0xefc6_c5b9_e9f4_5c68;

#[test]
fn the_processors_picture_is_the_same_everywhere() {
    let picture = raster::draw(&helix(), 320, 240, 1.0);
    assert_eq!(picture.hash(), raster::draw(&helix(), 320, 240, 1.0).hash());
    assert_eq!(picture.hash(), HELIX_HASH, "hash is {:#018x}", picture.hash());
}

#[test]
fn the_cards_picture_agrees_with_the_processors() {
    let card = match Headless::start() {
        Ok(card) => card,
        Err(error) => {
            eprintln!("SKIPPED: {error}");
            return;
        }
    };
    let theirs = card
        .draw(&helix(), 320, 240, 1.0)
        .expect("a started adapter draws");
    let ours = raster::draw(&helix(), 320, 240, 1.0);
    let apart = theirs
        .rgba
        .iter()
        .zip(&ours.rgba)
        .map(|(a, b)| f64::from(a.abs_diff(*b)));
    let (sum, worst) = apart.fold((0.0, 0.0_f64), |(sum, worst), d| (sum + d, worst.max(d)));
    let mean = sum / ours.rgba.len() as f64;
    assert!(
        mean < 0.6,
        "{}: mean difference {mean:.3}, worst {worst}",
        card.adapter
    );
}
