//! From a snapshot of the rig to a scene: floor, ghosts, trails, the figure, the cursor.

use glam::{DVec2, DVec3};
use rig::{FigureView, Snapshot, StretchView, ViewState};

use super::camera::Camera;
use super::figure::{self, Style};
use super::puppet;
use super::scene::{Ink, Layer, Mark, Place, Scene};
use super::structures;
use super::theme;
use super::trail::{self, Samples};

/// What is drawn beside the figure itself.
// Four switches that a person sets one by one; any combination is legal.
#[allow(clippy::struct_excessive_bools)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// Poses before and after.
    pub onion: bool,
    /// How many on each side.
    pub onion_count: u32,
    /// Time between them, seconds, above 0.
    pub onion_step_secs: f64,
    /// Trajectories with equal-time ticks.
    pub ticks: bool,
    /// Time between ticks, seconds, above 0.
    pub tick_secs: f64,
    /// A grid under the feet.
    pub floor: bool,
    /// The selection, its name, the cursor and what it offers; off for films.
    pub editing: bool,
}

impl Default for Look {
    fn default() -> Self {
        Look {
            onion: true,
            onion_count: 3,
            onion_step_secs: 0.12,
            ticks: true,
            tick_secs: 1.0 / 12.0,
            floor: true,
            editing: true,
        }
    }
}

impl Look {
    /// As films show it: nothing that only the person at the desk needs.
    pub fn film() -> Look {
        Look {
            editing: false,
            ..Look::default()
        }
    }
}

/// The rig's picture reaches from −1 to 1, but a tablet's shorter side only to about 0.7, and a fitted figure
/// to 0.55: pictures show this much of it, so that the figure fills them and every place a hand can reach is
/// still seen.
pub const SHOWN_HALF_HEIGHT: f64 = 0.72;

/// The camera of a rig's view.
pub fn camera(view: &ViewState) -> Camera {
    let half_height = if view.scale > 1e-9 {
        SHOWN_HALF_HEIGHT / view.scale
    } else {
        SHOWN_HALF_HEIGHT
    };
    Camera::turned(view.azimuth_rad, view.elevation_rad, view.centre, half_height)
}

/// Everything the front view shows; the side view is [`Scene::side`] of it.
pub fn scene(seen: &Snapshot, look: &Look) -> Scene {
    let mut scene = Scene::new(camera(&seen.view));
    let samples = seen.clip.as_ref().map(|clip| Samples::of(clip, look.tick_secs));
    let shown = seen.figure.as_ref();
    let alone = seen.puppet_pose.as_ref().filter(|_| shown.is_none());
    let anything = shown.is_some() || samples.is_some() || alone.is_some() || !seen.display.is_empty();
    if look.floor && anything {
        let lowest = samples
            .as_ref()
            .and_then(Samples::lowest)
            .or_else(|| trail::lowest(shown.iter().flat_map(|figure| &figure.placed)))
            .or_else(|| alone.map(puppet::floor));
        add_floor(&mut scene, lowest.unwrap_or(0.0));
    }
    if let (true, Some(clip), Some(figure)) = (look.onion, &seen.clip, shown) {
        let steps = (look.onion_count, look.onion_step_secs);
        trail::add_onion(&mut scene, clip, &figure.shapes, seen.transport.secs, steps);
    }
    if let (true, Some(samples), Some(figure)) = (look.ticks, &samples, shown) {
        let now = (seen.keys.as_slice(), seen.transport.secs);
        add_trails(&mut scene, samples, figure, look, now);
        if look.editing {
            add_strained_trails(&mut scene, samples, figure, seen);
        }
    }
    structures::add(&mut scene, &seen.display);
    if let Some(pose) = alone {
        puppet::add(&mut scene, pose, seen.puppet.as_ref());
    }
    if let Some(figure) = shown {
        let selected = figure.selected.filter(|_| look.editing).map(usize::from);
        figure::add(
            &mut scene,
            &figure.placed,
            &figure.shapes,
            Style::present(selected),
        );
        if look.editing {
            add_strained_links(&mut scene, figure, seen);
            add_editing(&mut scene, figure);
        }
    }
    scene
}

/// How far before and after the present moment the ways of the extremities are shown, seconds.
const NEARBY_SECS: f64 = 0.5;

/// A little of the ways of all extremities, and the selected link's whole way with its keys.
fn add_trails(
    scene: &mut Scene,
    samples: &Samples,
    figure: &FigureView,
    look: &Look,
    (keys, now_secs): (&[rig::KeyView], f64),
) {
    let selected = figure.selected.filter(|_| look.editing).map(usize::from);
    let nearby = [now_secs - NEARBY_SECS, now_secs + NEARBY_SECS];
    let ink = Ink::new(theme::DIM, Layer::Trail).faded(0.7);
    for (link, _) in extremities(figure).filter(|(link, _)| selected != Some(*link)) {
        samples.add_trail(scene, link, nearby, ink, &[]);
    }
    if let Some(link) = selected {
        let key_secs: Vec<f64> = keys.iter().map(|key| key.secs).collect();
        let ink = Ink::new(theme::SELECTED, Layer::Trail).faded(0.7);
        let always = [f64::NEG_INFINITY, f64::INFINITY];
        samples.add_trail(scene, link, always, ink, &key_secs);
    }
}

/// Stretches of the clip in which a joint of a link is asked too much, with the link's place in the figure.
fn strained(seen: &Snapshot) -> impl Iterator<Item = (usize, &StretchView)> {
    let all = seen.feasibility.iter().flat_map(|view| view.stretches.iter());
    all.filter_map(|stretch| Some((usize::from(stretch.link?), stretch)))
}

/// Where on its way a link is asked too much: of extremities around the present moment, of the selected link always.
fn add_strained_trails(scene: &mut Scene, samples: &Samples, figure: &FigureView, seen: &Snapshot) {
    let now_secs = seen.transport.secs;
    // Over the ticks of the same way.
    let ink = Ink::new(theme::TOO_MUCH, Layer::Figure);
    for (link, stretch) in strained(seen) {
        let [from, to] = if figure.selected.map(usize::from) == Some(link) {
            [stretch.from_secs, stretch.to_secs]
        } else {
            [
                stretch.from_secs.max(now_secs - NEARBY_SECS),
                stretch.to_secs.min(now_secs + NEARBY_SECS),
            ]
        };
        if from < to {
            samples.add_stretch(scene, link, [from, to], ink);
        }
    }
}

/// The links that are asked too much at the present moment.
fn add_strained_links(scene: &mut Scene, figure: &FigureView, seen: &Snapshot) {
    let now_secs = seen.transport.secs;
    let ink = Ink::new(theme::TOO_MUCH, Layer::Figure);
    for (link, stretch) in strained(seen) {
        if (stretch.from_secs..=stretch.to_secs).contains(&now_secs)
            && let Some(placed) = figure.placed.get(link)
        {
            scene.stroke(placed.start, placed.end, theme::WIDTH_SELECTED, ink);
        }
    }
}

/// Links that carry no other.
fn extremities(figure: &FigureView) -> impl Iterator<Item = (usize, &motion::figure::Link)> {
    figure
        .figure
        .links()
        .iter()
        .enumerate()
        .filter(|(_, link)| link.attachments.is_empty())
}

/// Lines of the floor's grid on each side of the middle.
const FLOOR_LINES: i32 = 7;
/// Strength of the grid in its middle.
const FLOOR_STRENGTH: f64 = 0.7;
/// Below this sine of the angle the floor is seen on edge, as one line.
const ON_EDGE: f64 = 0.02;

/// A grid that fades out around its middle: ground to stand on, not a frame around the picture.
fn add_floor(scene: &mut Scene, height: f64) {
    let step = nice_step(scene.camera.half_height / 3.0);
    let middle = |v: f64| (v / step).round() * step;
    let centre = DVec3::new(
        middle(scene.camera.centre.x),
        height,
        middle(scene.camera.centre.z),
    );
    // On edge all lines of a direction would lie over each other, and the faintest over all.
    let on_edge = (scene.camera.view_from_world * DVec3::Y).z.abs() < ON_EDGE;
    let lines = if on_edge {
        0..=0
    } else {
        -FLOOR_LINES..=FLOOR_LINES
    };
    let ink = Ink::new(theme::FAINT, Layer::Ground);
    for line in lines {
        for cell in -FLOOR_LINES..FLOOR_LINES {
            let (across, along) = (f64::from(line), f64::from(cell));
            let off = across.hypot(along + 0.5) / f64::from(FLOOR_LINES);
            let strength = FLOOR_STRENGTH * (1.0 - off * off).max(0.0).powi(2);
            if strength < 0.02 {
                continue;
            }
            let ink = ink.faded(strength as f32);
            for (forward, sideways) in [(DVec3::X, DVec3::Z), (DVec3::Z, DVec3::X)] {
                let at = centre + sideways * (across * step);
                let ends = [along, along + 1.0].map(|cells| at + forward * (cells * step));
                scene.stroke(ends[0], ends[1], theme::WIDTH_GRID, ink);
            }
        }
    }
}

/// The largest of 1, 2, 5, 10, … times a power of ten that is not above `length`.
fn nice_step(length: f64) -> f64 {
    if !(length.is_finite() && length > 0.0) {
        return 1.0;
    }
    let power = 10_f64.powi(length.log10().floor() as i32);
    let times = length / power;
    power
        * if times >= 5.0 {
            5.0
        } else if times >= 2.0 {
            2.0
        } else {
            1.0
        }
}

/// The selected link's name, the cursor's line through the picture, and the two ends it offers.
fn add_editing(scene: &mut Scene, figure: &FigureView) {
    let Some(selected) = figure.selected.map(usize::from) else {
        return;
    };
    let Some(link) = figure.placed.get(selected) else {
        return;
    };
    let name = figure
        .figure
        .links()
        .get(selected)
        .map_or("", |link| link.name.as_str());
    let ink = Ink::new(theme::SELECTED, Layer::Overlay).flat();
    scene.label(Place::World(link.end, [10.0, -16.0]), name, theme::SIZE_BODY, ink);
    for candidate in &figure.candidates {
        scene.stroke(link.start, *candidate, theme::WIDTH_GHOST, ink.faded(0.5));
        scene.dot(*candidate, 4.0, Mark::Ring, ink);
    }
    // After posing it says only where it was last.
    if let Some(cursor) = figure.cursor.filter(|_| figure.posing) {
        add_cursor(scene, cursor);
    }
}

/// The cursor is a line along the view direction: a point from the front, a line from the side.
fn add_cursor(scene: &mut Scene, cursor: DVec2) {
    let camera = scene.camera;
    let world_from_view = camera.view_from_world.transpose();
    let at =
        camera.centre + world_from_view * (cursor * (camera.half_height / SHOWN_HALF_HEIGHT)).extend(0.0);
    let along = world_from_view.z_axis * camera.half_height * 3.0;
    let ink = Ink::new(theme::LIVE, Layer::Overlay).flat();
    scene.stroke(at - along, at + along, theme::WIDTH_GRID, ink.faded(0.6));
    let arm = camera.half_height * 0.03;
    for axis in [world_from_view.x_axis, world_from_view.y_axis] {
        scene.stroke(at - axis * arm, at + axis * arm, theme::WIDTH_GHOST, ink);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_empty_rig_is_an_empty_picture() {
        let scene = scene(&Snapshot::default(), &Look::default());
        assert!(scene.strokes.is_empty() && scene.labels.is_empty() && scene.dots.is_empty());
    }

    #[test]
    fn steps_are_nice() {
        for (length, want) in [(0.7, 0.5), (0.34, 0.2), (1.0, 1.0), (19.0, 10.0), (f64::NAN, 1.0)] {
            assert!((nice_step(length) - want).abs() < 1e-12, "{length}");
        }
    }
}
