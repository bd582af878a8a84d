//! What operations have set on the way down.

use glam::{DMat2, DMat4, DVec2};

use super::super::effect::Effect;
use super::super::frustum::Frustum;
use super::Walk;
use crate::display::{View, Viewport};
use crate::names::NameId;

/// Everything that holds for what is below.
// One switch for each command that sets one; any combination is legal.
#[allow(clippy::struct_excessive_bools)]
#[derive(Clone, Copy)]
pub(super) struct State {
    pub(super) world_from_here: DMat4,
    /// From the world to the space lights are in: what is below the last projection.
    pub(super) light_from_world: DMat4,
    pub(super) screen_from_world: Option<DMat4>,
    /// Whether depth runs from 0 to 1 between planes somebody chose.
    deep: bool,
    depth_clipping: bool,
    viewport: Viewport,
    /// Brightness of the farthest and the nearest, of the viewport and of SET INTENSITY.
    viewport_range: Option<[f64; 2]>,
    range: Option<[f64; 2]>,
    contrast: f64,
    pub(super) characters: DMat2,
    pub(super) font: Option<NameId>,
    pub(super) hue_deg: f64,
    pub(super) saturation: f64,
    /// Saturation of lists coloured vector by vector.
    pub(super) blending: f64,
    bits: u16,
    level: i32,
    phase: bool,
    pub(super) shown: bool,
    pub(super) texture: Option<(bool, u8)>,
    pub(super) picking: bool,
    /// The innermost pick identifier, in the walk's own list.
    pub(super) identifier: Option<u32>,
    /// Middle and half size of the pick window, where SET PICKING LOCATION says so.
    pub(super) window: Option<[DVec2; 2]>,
    /// The innermost rendering node, in the walk's own list.
    pub(super) rendition: Option<u16>,
    pub(super) sectioning: bool,
}

impl State {
    pub(super) fn new(world_from_model: DMat4) -> Self {
        Self {
            world_from_here: world_from_model,
            light_from_world: DMat4::IDENTITY,
            screen_from_world: None,
            deep: false,
            depth_clipping: false,
            viewport: Viewport::default(),
            viewport_range: None,
            range: None,
            contrast: 1.0,
            characters: DMat2::IDENTITY,
            font: None,
            hue_deg: 0.0,
            saturation: 0.0,
            blending: 1.0,
            bits: 0,
            level: 0,
            phase: true,
            shown: true,
            texture: None,
            picking: false,
            identifier: None,
            window: None,
            rendition: None,
            sectioning: false,
        }
    }

    /// On the screen itself: -1 to 1 each way.
    pub(super) fn on_screen() -> Self {
        Self {
            screen_from_world: Some(DMat4::IDENTITY),
            ..Self::new(DMat4::IDENTITY)
        }
    }

    pub(super) fn view(&self) -> View {
        View {
            screen_from_world: self.screen_from_world,
            viewport: self.viewport,
            cue: self.cue(),
        }
    }

    fn cue(&self) -> Option<[f64; 2]> {
        let [far, near] = self.range.or(self.viewport_range)?;
        let contrasted = |brightness: f64| 1.0 - self.contrast * (1.0 - brightness.clamp(0.0, 1.0));
        Some([contrasted(far), contrasted(near)])
    }

    /// Brightness at depth 0 and what is added towards depth 1.
    pub(super) fn brightness(&self) -> [f64; 2] {
        match (self.screen_from_world, self.cue()) {
            (Some(_), Some([far, near])) if self.deep => [near, far - near],
            (_, Some([_, near])) => [near, 0.0],
            _ => [1.0, 0.0],
        }
    }

    pub(super) fn frustum(&self) -> Frustum {
        Frustum::new(self.screen_from_world.as_ref(), self.deep && self.depth_clipping)
    }

    fn see(&mut self, onto: DMat4) {
        let above = self.screen_from_world.unwrap_or(DMat4::IDENTITY) * self.world_from_here;
        self.screen_from_world = Some(above * onto);
        self.world_from_here = DMat4::IDENTITY;
    }

    fn set_bit(&mut self, bit: u8, on: bool) {
        let mask = mask(bit);
        self.bits = if on { self.bits | mask } else { self.bits & !mask };
    }
}

fn mask(bit: u8) -> u16 {
    1_u16.checked_shl(u32::from(bit)).unwrap_or(0)
}

impl Walk<'_> {
    /// Lets an operation take effect; false where the traversal ends here.
    pub(super) fn apply(&mut self, effect: &Effect, state: &mut State) -> bool {
        match *effect {
            Effect::Model(m) => state.world_from_here *= m,
            Effect::Look(m) => {
                state.light_from_world = state.light_from_world * state.world_from_here * m;
                state.see(m);
            }
            Effect::View { onto, deep } => {
                state.light_from_world = DMat4::IDENTITY;
                state.deep = deep;
                state.see(onto);
            }
            Effect::Viewport { viewport, intensity } => {
                (state.viewport, state.viewport_range) = (viewport, intensity);
            }
            Effect::Characters(m) => state.characters *= m,
            Effect::CharactersOnly(m) => state.characters = m,
            Effect::Font(font) => state.font = font,
            Effect::Color { hue_deg, saturation } => {
                (state.hue_deg, state.saturation) = (hue_deg, saturation);
            }
            Effect::Blending(saturation) => state.blending = saturation,
            Effect::Intensity { on, range } => state.range = on.then_some(range),
            Effect::Contrast(contrast) => state.contrast = contrast.clamp(0.0, 1.0),
            Effect::Bit { bit, on } => state.set_bit(bit, on),
            Effect::IfBit { bit, on } => return (state.bits & mask(bit) != 0) == on,
            Effect::Level(level) => state.level = level,
            Effect::LevelBy(by) => state.level = state.level.saturating_add(by),
            Effect::IfLevel(comparison, level) => return comparison.holds(state.level, level),
            Effect::Rate(rate) => state.phase = rate.phase(self.frame),
            Effect::Phase(on) => state.phase = on,
            Effect::IfPhase(on) => return state.phase == on,
            Effect::DepthClipping(on) => state.depth_clipping = on,
            Effect::Picking(on) => state.picking = on,
            Effect::Identifier(name) => state.identifier = self.identify(name, state.identifier),
            Effect::PickWindow { center, half } => state.window = Some([center, half]),
            Effect::Shown(on) => state.shown = on,
            Effect::Texture { around_corners, mask } => state.texture = Some((around_corners, mask)),
            Effect::Rendering(rendering) => state.rendition = self.begin_rendition(rendering),
            Effect::Sectioning => state.sectioning = true,
            Effect::Unseen => {}
        }
        true
    }
}
