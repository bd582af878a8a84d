//! The patch panel at two thousand boxes: what a layout costs, and what a picture costs while messages move.
//!
//! A picture is all that happens on the processor: the panel's own work and egui's triangles. A screen that shows
//! sixty pictures a second leaves 16.7 ms for it. Prints medians; nothing fails where they are long.

use std::fmt::Write;
use std::hint::black_box;
use std::sync::Arc;
use std::time::Instant;

use egui::{Context, Event, Modifiers, RawInput, Rect, pos2, vec2};
use glam::Vec2;
use ps300::Machine;
use ui::panels::patch::Patch;
use ui::panels::style;
use ui::patch::layout::{self, Edge, Graph, Node};
use ui::patch::look::Look;

/// Boxes of the large network.
const BOXES: usize = 2000;
const SIZE: [f32; 2] = [1920.0, 1080.0];
/// A picture's share of a second at sixty a second.
const FRAME_MS: f64 = 1000.0 / 60.0;
/// Runs of which the median is taken.
const ROUNDS: usize = 41;

/// Chains of functions from dials, as pages of controls are made of.
fn program(boxes: usize) -> String {
    let mut text = String::new();
    for index in 0..boxes / 4 {
        let dial = index % 8 + 1;
        let _ = writeln!(
            text,
            "pick{index} := F:CROUTE(3); SEND FIX(1) TO <1>pick{index}; CONNECT DIALS<{dial}>:<2>pick{index};
             gain{index} := F:MULC; SEND {dial} TO <2>gain{index}; CONNECT pick{index}<1>:<1>gain{index};
             sum{index} := F:ACCUMULATE; SEND 0 TO <2>sum{index}; SEND 1 TO <4>sum{index};
             CONNECT gain{index}<1>:<1>sum{index}; CONNECT pick{index}<2>:<1>sum{index};
             text{index} := F:PRINT; CONNECT sum{index}<1>:<1>text{index};
             CONNECT text{index}<1>:<1>DLABEL{dial}; CONNECT pick{index}<3>:<1>text{index};"
        );
    }
    text
}

/// The same network as a graph: two wires a box, most of them short.
fn graph(boxes: usize) -> Graph {
    let mut graph = Graph::default();
    for index in 0..boxes {
        graph.nodes.push(Node {
            size: Vec2::new(160.0, 50.0 + 18.0 * (index % 5) as f32),
            first: index < 4,
            ..Node::default()
        });
        for back in [1 + index * 7 % 31, 1 + index * 13 % 40] {
            if index >= back {
                graph.edges.push(Edge {
                    from: index - back,
                    to: index,
                    from_y: 30.0,
                    to_y: 30.0,
                });
            }
        }
    }
    graph
}

/// A panel in a window of its own, and the network it shows.
struct Window {
    context: Context,
    patch: Patch,
    machine: Machine,
    look: Look,
    frame: u64,
}

impl Window {
    fn new() -> Window {
        let mut machine = Machine::new();
        let wrong = machine.load(&program(BOXES));
        assert!(wrong.is_empty(), "{wrong:?}");
        let look = Look {
            picture: Arc::new(machine.picture()),
            ..Look::default()
        };
        let context = Context::default();
        style::apply(&context);
        let mut window = Window {
            context,
            patch: Patch::default(),
            machine,
            look,
            frame: 0,
        };
        // Large layouts are made on a thread: until it is done the table is empty.
        while window.triangles(Vec::new()) < 10_000 {
            std::thread::yield_now();
        }
        window
    }

    /// All dials move, and the panel is told.
    fn turn(&mut self) {
        for dial in 1..=8 {
            self.machine.emit("DIALS", dial, 0.01);
        }
        self.frame += 1;
        self.machine.tick(self.frame as f64 / 60.0, self.frame, 1_000_000);
        self.look.activity = Arc::new(self.machine.activity(&self.look.picture));
    }

    /// The panel is drawn.
    fn triangles(&mut self, events: Vec<Event>) -> usize {
        let input = RawInput {
            screen_rect: Some(Rect::from_min_size(pos2(0.0, 0.0), SIZE.into())),
            time: Some(self.frame as f64 / 60.0),
            events,
            ..RawInput::default()
        };
        let mut output = self.context.run_ui(input, |ui| {
            self.patch.ui(ui, Some(&self.look));
        });
        output.textures_delta.clear();
        let shapes = self.context.tessellate(output.shapes, output.pixels_per_point);
        shapes
            .iter()
            .map(|shape| match &shape.primitive {
                egui::epaint::Primitive::Mesh(mesh) => mesh.indices.len() / 3,
                egui::epaint::Primitive::Callback(_) => 0,
            })
            .sum()
    }

    /// Turns the wheel over the middle.
    fn zoom(&mut self, by: f32) {
        let middle = pos2(SIZE[0] / 2.0, SIZE[1] / 2.0);
        self.triangles(vec![Event::PointerMoved(middle)]);
        self.triangles(vec![Event::MouseWheel {
            unit: egui::MouseWheelUnit::Point,
            delta: vec2(0.0, by),
            modifiers: Modifiers::NONE,
            phase: egui::TouchPhase::Move,
            source: egui::MouseWheelSource::Wheel,
        }]);
        for _ in 0..60 {
            self.triangles(Vec::new());
        }
    }
}

/// The median of several runs, each of which is prepared for, milliseconds.
#[allow(clippy::disallowed_methods, reason = "a bench is where time is measured")]
fn median_ms<T>(subject: &mut T, prepare: impl Fn(&mut T), mut run: impl FnMut(&mut T)) -> f64 {
    let mut taken: Vec<f64> = (0..ROUNDS)
        .map(|_| {
            prepare(subject);
            let start = Instant::now();
            run(subject);
            start.elapsed().as_secs_f64() * 1e3
        })
        .collect();
    taken.sort_by(f64::total_cmp);
    taken[ROUNDS / 2]
}

fn main() {
    for boxes in [200, 1000, BOXES] {
        let run = |graph: &mut Graph| {
            black_box(layout::arrange(graph));
        };
        let taken = median_ms(&mut graph(boxes), |_| {}, run);
        println!("layout   {boxes:>5} boxes  {taken:8.2} ms");
    }
    let mut window = Window::new();
    for (name, wheel) in [("all", 0.0), ("names", 700.0), ("near", 500.0)] {
        if wheel > 0.0 {
            window.zoom(wheel);
        }
        let mut triangles = 0;
        let taken = median_ms(&mut window, Window::turn, |window| {
            triangles = window.triangles(Vec::new());
        });
        let share = taken / FRAME_MS;
        println!("picture  {name:>5}  {triangles:>7} triangles  {taken:8.2} ms  {share:5.2} of a frame");
    }
}
