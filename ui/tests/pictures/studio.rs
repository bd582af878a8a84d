//! The studio's window: pictures on a software rasteriser where there is one, hands and keys without.

use std::path::PathBuf;

use egui::{Key, Modifiers, Rect, pos2};
use egui_kittest::{Harness, kittest::Queryable};
use rig::{Command, EditCommand, PuppetCommand, Snapshot, Touch, TransportCommand};
use ui::panels::{canvas, style};
use ui::render::offscreen::Headless;
use ui::studio::Studio;

use crate::walker;

/// A studio on one snapshot, and everything hands wanted so far.
struct Bench {
    studio: Studio,
    seen: Snapshot,
    said: Vec<Command>,
}

impl Bench {
    fn new(seen: Snapshot) -> Bench {
        Bench {
            studio: Studio::new(),
            seen,
            said: Vec::new(),
        }
    }
}

fn harness(seen: Snapshot, size: [f32; 2], card: bool) -> Harness<'static, Bench> {
    let mut builder = Harness::builder()
        .with_size(size)
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
    builder.build_ui_state(draw, Bench::new(seen))
}

/// Where pictures are left to be looked at.
fn picture_path(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name)
}

#[test]
fn the_studio_looks_right_at_both_sizes() {
    if let Err(error) = Headless::start() {
        eprintln!("SKIPPED: {error}");
        return;
    }
    for (name, seen) in [
        ("playing", walker::playing()),
        ("posing", walker::posing()),
        ("empty", Snapshot::default()),
    ] {
        for size in [[1280.0, 720.0], [1920.0, 1080.0]] {
            let mut harness = harness(seen.clone(), size, true);
            harness.run_steps(2);
            let picture = harness.render().expect("the adapter that started also draws");
            picture
                .save(picture_path(&format!("studio-{name}-{}.png", size[0])))
                .expect("the folder is ours");
        }
    }
}

#[test]
fn a_film_frame_and_a_sheet_need_no_card() {
    let seen = walker::playing();
    let picture = ui::render::frame::draw(&seen, &ui::render::stage::Look::film(), 960, 540);
    let file = std::fs::File::create(picture_path("frame.png")).expect("the folder is ours");
    ui::render::film::write_png(&picture, file).expect("a picture is a PNG");
    let figure = walker::figure();
    let clip = walker::clip(&figure);
    let sheet = ui::render::sheet::draw(
        &clip,
        &walker::shapes(),
        &walker::KEY_SECS,
        &ui::render::stage::camera(&seen.view),
        &ui::render::sheet::Layout::default(),
        "first steps: walk",
    );
    let file = std::fs::File::create(picture_path("poses.png")).expect("the folder is ours");
    ui::render::film::write_png(&sheet, file).expect("a picture is a PNG");
}
