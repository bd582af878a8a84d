//! A scene inside the window: drawn by the graphics card into a target of its own, copied where it belongs.

use std::collections::BTreeMap;

use egui::{Align2, Rect, Ui};
use egui_wgpu::{CallbackResources, CallbackTrait, RenderState, ScreenDescriptor};

use super::style;
use crate::render::flat::{Flat, Viewport};
use crate::render::lines::LinePipeline;
use crate::render::offscreen::{Blit, Shown, Target};
use crate::render::scene::Scene;
use crate::render::theme;

/// What the card keeps between pictures.
struct Card {
    pipeline: LinePipeline,
    blit: Blit,
    views: BTreeMap<&'static str, (Target, Shown)>,
}

/// Prepares a window's card; once, before the first picture.
pub fn setup(state: &RenderState) {
    let resources = &mut state.renderer.write().callback_resources;
    install(resources, &state.device, state.target_format);
}

/// The same for a renderer without a window, whose pictures have the format `onto`.
pub fn install(resources: &mut CallbackResources, device: &wgpu::Device, onto: wgpu::TextureFormat) {
    let pipeline = LinePipeline::new(device);
    resources.insert(Card {
        pipeline,
        blit: Blit::new(device, onto),
        views: BTreeMap::new(),
    });
}

struct View {
    name: &'static str,
    flat: Flat,
    size: [u32; 2],
    corner: [u32; 2],
}

impl CallbackTrait for View {
    fn prepare(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        _screen: &ScreenDescriptor,
        encoder: &mut wgpu::CommandEncoder,
        resources: &mut CallbackResources,
    ) -> Vec<wgpu::CommandBuffer> {
        let Some(card) = resources.get_mut::<Card>() else {
            return Vec::new();
        };
        let Card {
            pipeline,
            blit,
            views,
        } = card;
        let fits = views
            .get(self.name)
            .is_some_and(|(target, _)| target.texture().size() == self.size);
        if !fits {
            let target = Target::new(device, pipeline, self.size);
            let shown = blit.bind(device, &target);
            views.insert(self.name, (target, shown));
        }
        if let Some((target, shown)) = views.get_mut(self.name) {
            target.render((device, queue), encoder, pipeline, &self.flat);
            shown.place(queue, self.corner[0], self.corner[1]);
        }
        Vec::new()
    }

    fn paint(
        &self,
        _info: egui::PaintCallbackInfo,
        pass: &mut wgpu::RenderPass<'static>,
        resources: &CallbackResources,
    ) {
        let Some(card) = resources.get::<Card>() else {
            return;
        };
        if let Some((_, shown)) = card.views.get(self.name) {
            card.blit.draw(shown, pass);
        }
    }
}

/// How much a name hides of what it stands on.
const PLATE: f32 = 0.75;

/// Shows `scene` in `rect`; `name` tells views of one window apart.
pub fn show(ui: &Ui, rect: Rect, name: &'static str, scene: &Scene) {
    let scale = ui.ctx().pixels_per_point();
    let pixel = |points: f32| (points * scale).round().max(0.0) as u32;
    let corner = [pixel(rect.left()), pixel(rect.top())];
    let size = [pixel(rect.right()) - corner[0], pixel(rect.bottom()) - corner[1]].map(|side| side.max(1));
    let mut flat = Flat::new(scene, &Viewport::of_size(size[0], size[1]).scaled(scale));
    let painter = ui.painter().with_clip_rect(rect);
    let texts = std::mem::take(&mut flat.texts);
    let view = View {
        name,
        flat,
        size,
        corner,
    };
    painter.add(egui_wgpu::Callback::new_paint_callback(rect, view));
    for text in texts {
        let at = rect.min + egui::vec2(text.at[0], text.at[1]) / scale;
        let anchor = if text.from_right {
            Align2::RIGHT_TOP
        } else {
            Align2::LEFT_TOP
        };
        let font = style::digits((text.size / scale).max(theme::SIZE_SMALL));
        let galley = painter.layout_no_wrap(text.text, font, style::ink(text.colour));
        let rect = anchor.anchor_size(at, galley.size());
        // On the ground's own colour: names stand beside lines, and often over some.
        let plate = style::ink(theme::GROUND).gamma_multiply(PLATE);
        painter.rect_filled(
            rect.expand2(egui::vec2(theme::STEP / 2.0, 0.0)),
            style::round(),
            plate,
        );
        painter.galley(rect.min, galley, style::ink(text.colour));
    }
}
