//! The studio as a picture, without a window: the same panels, drawn once by whatever graphics adapter is
//! there. Manuals and tests come from here.

use egui::{RawInput, Rect, pos2, vec2};
use egui_wgpu::{Renderer, RendererOptions, ScreenDescriptor};
use rig::Snapshot;

use crate::panels::{canvas, style};
use crate::render::offscreen::{GpuError, Headless, Texture};
use crate::render::picture::Picture;
use crate::studio::Studio;

/// Draws `studio` over `seen`, `width` by `height` pixels, `scale` pixels a point.
/// Nothing is touched: what the studio would have wanted done is thrown away.
pub fn draw(
    studio: &mut Studio,
    seen: &Snapshot,
    (width, height): (u32, u32),
    scale: f32,
) -> Result<Picture, GpuError> {
    let card = Headless::start()?;
    let (device, queue) = card.device_and_queue();
    let target = Texture::new(device, [width, height]);
    let mut renderer = Renderer::new(device, Texture::FORMAT, RendererOptions::PREDICTABLE);
    canvas::install(&mut renderer.callback_resources, device, Texture::FORMAT);
    let ctx = egui::Context::default();
    style::apply(&ctx);
    let [width, height] = target.size();
    let points = vec2(width as f32, height as f32) / scale.max(0.1);
    let mut input = RawInput {
        screen_rect: Some(Rect::from_min_size(pos2(0.0, 0.0), points)),
        ..Default::default()
    };
    input
        .viewports
        .entry(egui::ViewportId::ROOT)
        .or_default()
        .native_pixels_per_point = Some(scale.max(0.1));
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let mut output = egui::FullOutput::default();
    // Twice: sizes that a first pass only guesses are known in the second.
    for _ in 0..2 {
        output.append(ctx.run_ui(input.clone(), |ui| {
            studio.ui(ui, seen);
        }));
    }
    for (id, deltas) in &output.textures_delta.set {
        for delta in deltas {
            renderer.update_texture(device, queue, *id, delta);
        }
    }
    output.textures_delta.clear();
    let shapes = ctx.tessellate(output.shapes, output.pixels_per_point);
    let screen = ScreenDescriptor {
        size_in_pixels: [width, height],
        pixels_per_point: output.pixels_per_point,
    };
    let before = renderer.update_buffers(device, queue, &mut encoder, &shapes, &screen);
    {
        let pass = target.pass(&mut encoder);
        renderer.render(&mut pass.forget_lifetime(), &shapes, &screen);
    }
    queue.submit(before.into_iter().chain([encoder.finish()]));
    target.read(device, queue)
}
