//! What lies under the pointer: a port before its box, a box before a wire, a wire before a frame's title.

use glam::Vec2;
use ps300::language::Name;

use super::area::Area;
use super::layout;
use super::route::Route;
use super::scene::Scene;

/// Something that can be pointed at; boxes and ports by their places in the scene.
#[derive(Clone, Debug, PartialEq)]
pub enum Hit {
    /// A box, and one of its outputs.
    Output(usize, usize),
    /// A box, and one of its inputs.
    Input(usize, usize),
    /// A box.
    Box(usize),
    /// A wire.
    Wire(usize),
    /// The title of an unfolded structure.
    Frame(Name),
}

/// How near a pointer must come to a port's mark, points of the plane at zoom 1.
const PORT: f32 = 11.0;
/// How near to a wire.
const WIRE: f32 = 6.0;

/// Where everything is.
#[derive(Clone, Debug, Default)]
pub struct Seating {
    /// By box of the scene.
    pub areas: Vec<Area>,
    /// By wire of the scene.
    pub routes: Vec<Route>,
    /// By frame of the scene.
    pub frames: Vec<(Name, Area)>,
}

impl Seating {
    /// Boxes at their corners, wires along their lanes.
    pub fn new(scene: &Scene, corners: &[Vec2], lanes: &[Vec<[Vec2; 2]>]) -> Seating {
        let areas: Vec<Area> = scene
            .boxes
            .iter()
            .zip(corners)
            .map(|(shown, &at)| Area::new(at, shown.size))
            .collect();
        let frame = |frame: &super::scene::Frame| {
            let members = frame
                .members
                .iter()
                .filter_map(|&member| areas.get(member).copied());
            Some((frame.name.clone(), layout::frame_around(members)?))
        };
        let frames = scene.frames.iter().filter_map(frame).collect();
        let mut seating = Seating {
            areas,
            routes: Vec::new(),
            frames,
        };
        let none = Vec::new();
        let route = |(index, _)| seating.route(scene, index, lanes.get(index).unwrap_or(&none));
        seating.routes = scene.wires.iter().enumerate().map(route).collect();
        seating
    }

    /// The way of one wire.
    pub fn route(&self, scene: &Scene, index: usize, lanes: &[[Vec2; 2]]) -> Route {
        let wire = scene.wires[index];
        let bottom = self.areas[wire.from.0].max.y.max(self.areas[wire.to.0].max.y);
        Route::new(
            self.output(scene, wire.from.0, wire.from.1),
            lanes,
            self.input(scene, wire.to.0, wire.to.1),
            bottom,
        )
    }

    /// The mark of an output.
    pub fn output(&self, scene: &Scene, node: usize, port: usize) -> Vec2 {
        let area = self.areas[node];
        Vec2::new(area.max.x, area.min.y + scene.boxes[node].port_y(port))
    }

    /// The mark of an input.
    pub fn input(&self, scene: &Scene, node: usize, port: usize) -> Vec2 {
        let area = self.areas[node];
        Vec2::new(area.min.x, area.min.y + scene.boxes[node].port_y(port))
    }

    /// All that is there.
    pub fn extent(&self) -> Option<Area> {
        let frames = self.frames.iter().map(|(_, area)| *area);
        self.areas.iter().copied().chain(frames).reduce(Area::union)
    }

    /// What is under `at`; marks keep their size on the screen down to `zoom`.
    pub fn hit(&self, scene: &Scene, at: Vec2, zoom: f32) -> Option<Hit> {
        let reach = PORT / zoom.max(0.6);
        let near = |&(_, area): &(usize, &Area)| area.grown(reach).contains(at);
        let mut boxes: Vec<usize> = self
            .areas
            .iter()
            .enumerate()
            .filter(near)
            .map(|(n, _)| n)
            .collect();
        // The one painted last lies on top.
        boxes.reverse();
        let port = boxes.iter().find_map(|&node| self.port(scene, node, at, reach));
        port.or_else(|| {
            let inside = boxes.iter().find(|&&node| self.areas[node].contains(at));
            inside.map(|&node| Hit::Box(node))
        })
        .or_else(|| {
            let title = |area: &Area| Area::new(area.min, Vec2::new(area.size().x, layout::FRAME_TITLE));
            let found = self.frames.iter().find(|(_, area)| title(area).contains(at));
            found.map(|(name, _)| Hit::Frame(name.clone()))
        })
        .or_else(|| self.wire(at, WIRE / zoom.max(0.3)))
    }

    fn port(&self, scene: &Scene, node: usize, at: Vec2, reach: f32) -> Option<Hit> {
        let shown = &scene.boxes[node];
        let outputs =
            (0..shown.outputs.len()).map(|port| (Hit::Output(node, port), self.output(scene, node, port)));
        let inputs =
            (0..shown.inputs.len()).map(|port| (Hit::Input(node, port), self.input(scene, node, port)));
        outputs
            .chain(inputs)
            .map(|(hit, mark)| (hit, mark.distance(at)))
            .filter(|(_, distance)| *distance <= reach)
            .min_by(|a, b| a.1.total_cmp(&b.1))
            .map(|(hit, _)| hit)
    }

    fn wire(&self, at: Vec2, reach: f32) -> Option<Hit> {
        let near = self
            .routes
            .iter()
            .enumerate()
            .filter(|(_, route)| route.area.grown(reach).contains(at));
        near.map(|(index, route)| (index, route.distance(at)))
            .filter(|(_, distance)| *distance <= reach)
            .min_by(|a, b| a.1.total_cmp(&b.1))
            .map(|(index, _)| Hit::Wire(index))
    }

    /// The boxes that a rubber band touches.
    pub fn within(&self, band: Area) -> impl Iterator<Item = usize> + '_ {
        let touched = move |(_, area): &(usize, &Area)| area.meets(band);
        self.areas
            .iter()
            .enumerate()
            .filter(touched)
            .map(|(node, _)| node)
    }
}
