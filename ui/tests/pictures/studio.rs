//! The studio's window on a software rasteriser: what must be seen, and what must not.

use std::path::PathBuf;

use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use rig::{Command, Snapshot};
use ui::panels::{canvas, style};
use ui::render::film::write_png;
use ui::render::offscreen::Headless;
use ui::render::picture::Picture;
use ui::render::{frame, sheet, stage, theme};
use ui::studio::Studio;

use crate::walker;

/// A studio on one snapshot, and everything hands wanted so far.
pub(crate) struct Bench {
    pub(crate) studio: Studio,
    pub(crate) seen: Snapshot,
    pub(crate) said: Vec<Command>,
}

/// A window of `size`; with `card`, one that can also be drawn.
pub(crate) fn harness(seen: Snapshot, size: [f32; 2], card: bool) -> Harness<'static, Bench> {
    at_scale(seen, size, card, 1.0)
}

/// The same on a screen with so many pixels to a point.
pub(crate) fn at_scale(seen: Snapshot, size: [f32; 2], card: bool, scale: f32) -> Harness<'static, Bench> {
    let mut builder = Harness::builder()
        .with_size(size)
        .with_pixels_per_point(scale)
        // A screen's own pace: two clicks of a hand come within a few pictures.
        .with_step_dt(1.0 / 60.0)
        .with_context_setup(style::apply);
    if card {
        let state = egui_kittest::wgpu::create_render_state(
            egui_kittest::wgpu::default_wgpu_setup(),
            egui_wgpu::RendererOptions::PREDICTABLE,
        );
        canvas::setup(&state);
        builder = builder.renderer(egui_kittest::wgpu::WgpuTestRenderer::from_render_state(state));
    }
    let draw = |ui: &mut egui::Ui, bench: &mut Bench| {
        let said = bench.studio.ui(ui, &bench.seen);
        bench.said.extend(said);
    };
    builder.build_ui_state(
        draw,
        Bench {
            studio: Studio::new(),
            seen,
            said: Vec::new(),
        },
    )
}

/// Says aloud that there is nothing to draw with.
pub(crate) fn no_card() -> bool {
    Headless::start()
        .inspect_err(|error| eprintln!("SKIPPED: {error}"))
        .is_err()
}

/// Leaves a picture where a person can look at it.
pub(crate) fn keep(picture: &Picture, name: &str) {
    let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    let file = std::fs::File::create(&path).expect("the folder is the tests' own");
    write_png(picture, file).expect("a picture is a PNG");
}

pub(crate) fn drawn(seen: Snapshot, size: [f32; 2], name: &str) -> Picture {
    let mut harness = harness(seen, size, true);
    harness.run_steps(2);
    let image = harness.render().expect("the adapter that started also draws");
    let picture = Picture {
        width: image.width(),
        height: image.height(),
        rgba: image.into_raw(),
    };
    keep(&picture, &format!("studio-{name}-{}.png", size[0]));
    picture
}

/// How many pixels are nearly `colour`.
pub(crate) fn count(picture: &Picture, colour: theme::Rgb) -> usize {
    let near = |p: &[u8]| {
        [(p[0], colour.0), (p[1], colour.1), (p[2], colour.2)]
            .iter()
            .all(|(a, b)| a.abs_diff(*b) < 24)
    };
    picture.rgba.chunks_exact(4).filter(|p| near(p)).count()
}

#[test]
fn each_accent_has_one_meaning() {
    if no_card() {
        return;
    }
    for size in [[1280.0, 720.0], [1920.0, 1080.0]] {
        let empty = drawn(Snapshot::default(), size, "empty");
        let playing = drawn(walker::playing(), size, "playing");
        let posing = drawn(walker::posing(), size, "posing");
        assert_eq!(count(&empty, theme::FAULTED), 0, "red where nothing is faulted");
        assert_eq!(count(&playing, theme::FAULTED), 0, "red where nothing is faulted");
        assert!(
            count(&posing, theme::FAULTED) > 5000,
            "a fault must be found at once"
        );
        assert_eq!(
            count(&empty, theme::SELECTED),
            0,
            "amber where nothing is selected"
        );
        assert_eq!(
            count(&playing, theme::SELECTED),
            0,
            "amber where nothing is selected"
        );
        assert!(count(&posing, theme::SELECTED) > 150);
        assert!(count(&playing, theme::LIVE) > 300);
        assert!(
            count(&playing, theme::LINE) > 1000,
            "the figure is the brightest thing on the ground"
        );
    }
}

#[test]
fn what_the_puppet_cannot_do_is_seen_on_the_strip_and_the_path() {
    if no_card() {
        return;
    }
    let size = [1280.0, 720.0];
    let playing = drawn(walker::playing(), size, "playing");
    let strained = drawn(walker::strained(), size, "strained");
    assert_eq!(
        count(&playing, theme::TOO_MUCH),
        0,
        "violet where nothing is too much"
    );
    assert!(count(&strained, theme::TOO_MUCH) > 1200);
    assert_eq!(count(&strained, theme::FAULTED), 0, "nothing has failed yet");
    let mut harness = harness(walker::strained(), size, false);
    harness.run_steps(2);
    harness.get_by_label("slow to fit").click();
    harness.run_steps(2);
    assert_eq!(harness.state().said, [Command::SlowToFit]);
}

#[test]
fn the_help_page_and_sharper_screens() {
    if no_card() {
        return;
    }
    let mut studio = Studio::new();
    studio.choices().help = true;
    let help = ui::still::draw(&mut studio, &walker::playing(), (1280, 720), 1.0).expect("an adapter");
    keep(&help, "studio-help.png");
    let sharp =
        ui::still::draw(&mut Studio::new(), &walker::playing(), (2560, 1440), 2.0).expect("an adapter");
    assert_eq!((sharp.width, sharp.height), (2560, 1440));
    keep(&sharp, "studio-sharp.png");
}

/// Changes only on purpose: look at `frame.png` and `poses.png` before you write new numbers here.
const FRAME_HASH: u64 = 0x3b80_bb17_504a_4d0e;
const SHEET_HASH: u64 = 0x35da_0eb1_032d_6eba;

#[test]
fn films_and_sheets_are_the_same_bytes_everywhere() {
    let seen = walker::playing();
    let picture = frame::draw(&seen, &stage::Look::film(), 960, 540);
    keep(&picture, "frame.png");
    let camera = stage::camera(&seen.view);
    let clip = walker::clip(&walker::figure());
    let layout = sheet::Layout::default();
    let poses = sheet::draw(
        &clip,
        &walker::shapes(),
        &walker::KEY_SECS,
        &camera,
        &layout,
        "first steps: walk",
    );
    keep(&poses, "poses.png");
    let hashes = (picture.hash(), poses.hash());
    assert_eq!(
        hashes,
        (FRAME_HASH, SHEET_HASH),
        "they are {:#018x} and {:#018x}",
        hashes.0,
        hashes.1
    );
}
