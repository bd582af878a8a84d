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
