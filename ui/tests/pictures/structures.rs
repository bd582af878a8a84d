//! What networks show by themselves, each picture from a program beside this file.
//!
//! Looked at by a person when they were made; `UPDATE_PICTURES=1` leaves them in the tests' own folder and
//! prints the hash to write here.

use std::path::{Path, PathBuf};

use glam::{DVec2, DVec3};
use ps300::Machine;
use ui::render::camera::Camera;
use ui::render::film::write_png;
use ui::render::offscreen::Headless;
use ui::render::picture::Picture;
use ui::render::scene::Scene;
use ui::render::{raster, structures, theme};

const SIZE: [u32; 2] = [960, 640];

fn loaded(name: &str) -> Machine {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/pictures/structures");
    let path = folder.join(format!("{name}.ps300"));
    let program = std::fs::read_to_string(&path).expect("the programs lie beside the tests");
    let mut machine = Machine::new();
    let diagnostics = machine.load(&program);
    assert!(diagnostics.is_empty(), "{name}: {}", diagnostics[0]);
    machine
}

fn scene(machine: &mut Machine) -> Scene {
    let mut scene = Scene::new(Camera::turned(0.0, 0.0, DVec3::ZERO, 1.0));
    let list = machine.display();
    assert!(list.cuts.is_empty(), "{:?}", list.cuts);
    structures::add(&mut scene, &list);
    let reports = machine.reports();
    assert!(reports.is_empty(), "{}", reports[0]);
    scene
}

/// Draws what a machine shows, leaves it where a person can look at it, and compares its hash.
fn shows(machine: &mut Machine, name: &str, hash: u64) -> Picture {
    let picture = raster::draw(&scene(machine), SIZE[0], SIZE[1], 1.0);
    let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("structures-{name}.png"));
    let file = std::fs::File::create(&path).expect("the folder is the tests' own");
    write_png(&picture, file).expect("a picture is a PNG");
    if std::env::var_os("UPDATE_PICTURES").is_some() {
        println!("{name}: {:#018x} in {}", picture.hash(), path.display());
    } else {
        assert_eq!(picture.hash(), hash, "{name} is {:#018x}", picture.hash());
    }
    picture
}

/// How many pixels are clearly brighter than the ground.
fn inked(picture: &Picture) -> usize {
    let theme::Rgb(r, g, b) = theme::GROUND;
    let ground = u32::from(r) + u32::from(g) + u32::from(b);
    let bright = |p: &&[u8]| p[..3].iter().map(|&c| u32::from(c)).sum::<u32>() > ground + 60;
    picture.rgba.chunks_exact(4).filter(bright).count()
}

#[test]
fn text_in_all_sizes_and_directions() {
    shows(&mut loaded("text"), "text", 0x2b77_5768_adf0_f7a0);
}

#[test]
fn a_font_of_dancers() {
    shows(&mut loaded("fonts"), "fonts", 0xdc49_79ca_aa92_a525);
}

#[test]
fn levels_of_detail_of_a_snowflake() {
    shows(&mut loaded("detail"), "detail", 0xb9c9_dc3d_b775_5fc0);
}

#[test]
fn conditional_bits_light_segments() {
    shows(&mut loaded("bits"), "bits", 0xcb8d_0c78_3eda_970b);
}

#[test]
fn depth_takes_brightness_from_a_knot() {
    shows(&mut loaded("depth"), "depth", 0x1ff8_6a27_5ae5_7ce2);
}

#[test]
fn what_is_picked_lights_up() {
    let mut machine = loaded("picking");
    let before = inked(&raster::draw(&scene(&mut machine), SIZE[0], SIZE[1], 1.0));
    let at = DVec2::new(0.196, 0.386);
    machine.emit("TABLETIN", 1, at);
    machine.settle();
    machine.emit("TABLETIN", 6, at);
    machine.settle();
    let lit = shows(&mut machine, "picking", 0x3056_17d2_77ea_9abd);
    assert_ne!(inked(&lit), before);
}

#[test]
fn six_renderings_of_a_solid() {
    let mut machine = loaded("rendering");
    let picture = shows(&mut machine, "rendering", 0xa627_b5e6_a14a_44df);
    match Headless::start() {
        Err(error) => eprintln!("SKIPPED: {error}"),
        Ok(card) => {
            let theirs = card.draw(&scene(&mut machine), SIZE[0], SIZE[1], 1.0);
            let theirs = theirs.expect("a started adapter draws");
            let pairs = theirs.rgba.iter().zip(&picture.rgba);
            let sum: f64 = pairs.map(|(a, b)| f64::from(a.abs_diff(*b))).sum();
            let mean = sum / picture.rgba.len() as f64;
            assert!(mean < 0.8, "{}: mean difference {mean:.3}", card.adapter);
        }
    }
}
