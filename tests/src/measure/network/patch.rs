//! The measured graphs as patches of Pure Data.
//!
//! A patch checks itself once, then times its own loop a few times and quits; everything it has to say it prints.
//!
//! What computes what. A function of a row or fan is one `[+ 1]`. A D?ROTATE is `[* 200]`, a sum kept in the right
//! inlet of `[+ 0]`, degrees to radians, `[sin]` and `[cos]`, and `[pack]` of the nine numbers of the matrix.
//! DSCALE is the same with `[clip]` and three numbers; MULC is `[* 50]` in front of it. X-, Y-, ZVECTOR with
//! ACCUMULATE are done as users of Pure Data do: three sums of scalars and one `[pack f f f]`. A display node is
//! `[list append]`, whose right inlet keeps the matrix or vector, as a node does.
//!
//! Where Pure Data stops at 1000 objects that call each other in a row, a number is put down in `[f]` and the row
//! goes on from there: two messages more, which are not counted.
//! Source of the format: the unofficial patch file format reference, `puredata.info/docs/developer/PdFileFormat`.

use super::shape::{ADDEND, DIAL_MESSAGES, STEP};

/// Objects that call each other before a number is put down: well below Pure Data's 1000.
const IN_A_ROW: usize = 500;

/// What is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Graph {
    /// The dial network.
    Dials,
    /// So many functions, each connected to the next.
    Chain(usize),
    /// One output connected to so many functions.
    FanOut(usize),
}

impl Graph {
    /// Messages to inputs that one event of every dial makes.
    pub(super) fn messages(self) -> usize {
        match self {
            Self::Dials => DIAL_MESSAGES,
            Self::Chain(count) | Self::FanOut(count) => count,
        }
    }

    /// What stands at the ends after one event of every dial: functions by name, and their numbers.
    pub(super) fn ends(self) -> Vec<(String, Vec<f64>)> {
        let named = |name: &str, numbers: &[f64]| (name.to_owned(), numbers.to_vec());
        match self {
            Self::Dials => {
                let (s, c) = (200.0 * STEP).to_radians().sin_cos();
                let size = 1.0 + 0.2 * (STEP + 50.0 * STEP);
                vec![
                    named("rx", &[1.0, 0.0, 0.0, 0.0, c, -s, 0.0, s, c]),
                    named("ry", &[c, 0.0, s, 0.0, 1.0, 0.0, -s, 0.0, c]),
                    named("rz", &[c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0]),
                    named("sc", &[size, 0.0, 0.0, 0.0, size, 0.0, 0.0, 0.0, size]),
                    named("tr", &[100.0 * STEP; 3]),
                ]
            }
            Self::Chain(count) => vec![(format!("n{}", count - 1), vec![STEP + count as f64 * ADDEND])],
            Self::FanOut(count) => vec![(format!("n{}", count - 1), vec![STEP + ADDEND])],
        }
    }

    /// The patch that times so many turns, so many times.
    pub(super) fn patch(self, turns: usize, timings: usize) -> String {
        let mut patch = Patch::default();
        let driver = Driver::new(&mut patch, turns, timings);
        match self {
            Self::Dials => dials(&mut patch, &driver),
            Self::Chain(count) => chain(&mut patch, &driver, count),
            Self::FanOut(count) => fan_out(&mut patch, &driver, count),
        }
        patch.text()
    }
}

/// An object or message of a patch.
#[derive(Clone, Copy)]
struct Item(usize);

/// Objects, messages and cords, in the order of their making.
#[derive(Default)]
struct Patch {
    items: Vec<String>,
    cords: Vec<String>,
}

impl Patch {
    fn object(&mut self, text: &str) -> Item {
        self.items.push(format!("#X obj 10 10 {text};"));
        Item(self.items.len() - 1)
    }

    fn message(&mut self, text: &str) -> Item {
        self.items.push(format!("#X msg 10 10 {text};"));
        Item(self.items.len() - 1)
    }

    fn cord(&mut self, (from, outlet): (Item, usize), (to, inlet): (Item, usize)) {
        let (from, to) = (from.0, to.0);
        self.cords
            .push(format!("#X connect {from} {outlet} {to} {inlet};"));
    }

    /// An object whose left inlet is fed by the left outlet of another.
    fn then(&mut self, from: Item, text: &str) -> Item {
        let to = self.object(text);
        self.cord((from, 0), (to, 0));
        to
    }

    fn text(&self) -> String {
        let head = "#N canvas 0 0 600 400 10;".to_owned();
        let mut lines = vec![head];
        lines.extend_from_slice(&self.items);
        lines.extend_from_slice(&self.cords);
        lines.join("\n") + "\n"
    }
}

/// What turns the dials, checks, times and quits.
struct Driver {
    /// Says what the dials send.
    forth: Item,
    back: Item,
    /// Bangs when what is kept at the ends is to be printed.
    ask: Item,
}

impl Driver {
    fn new(patch: &mut Patch, turns: usize, timings: usize) -> Self {
        let start = patch.object("loadbang");
        // From right to left: forth, ask, back, time, quit.
        let steps = patch.then(start, "t b b b b b");
        let forth = patch.message(&STEP.to_string());
        let back = patch.message(&(-STEP).to_string());
        let ask = patch.object("bang");
        patch.cord((steps, 4), (forth, 0));
        patch.cord((steps, 3), (ask, 0));
        patch.cord((steps, 2), (back, 0));

        let times = patch.message(&timings.to_string());
        patch.cord((steps, 1), (times, 0));
        let again = patch.then(times, "until");
        // From right to left: start the clock, run, stop the clock.
        let timing = patch.then(again, "t b b b");
        let clock = patch.object("realtime");
        patch.cord((timing, 2), (clock, 0));
        let pairs = patch.message(&turns.div_ceil(2).to_string());
        patch.cord((timing, 1), (pairs, 0));
        patch.cord((timing, 0), (clock, 1));
        patch.then(clock, "print ms");
        let turn = patch.then(pairs, "until");
        let pair = patch.then(turn, "t b b");
        patch.cord((pair, 1), (forth, 0));
        patch.cord((pair, 0), (back, 0));

        let quit = patch.message("quit");
        patch.cord((steps, 0), (quit, 0));
        patch.then(quit, "s pd");
        Self { forth, back, ask }
    }

    /// Feeds an inlet with what the dials send.
    fn feed(&self, patch: &mut Patch, to: Item) {
        patch.cord((self.forth, 0), (to, 0));
        patch.cord((self.back, 0), (to, 0));
    }

    /// Has what `keeper` keeps printed under a name.
    fn print(&self, patch: &mut Patch, keeper: Item, name: &str) {
        patch.cord((self.ask, 0), (keeper, 0));
        patch.then(keeper, &format!("print {name}"));
    }
}

fn chain(patch: &mut Patch, driver: &Driver, count: usize) {
    let start = patch.object("f");
    driver.feed(patch, start);
    let mut before = start;
    for at in 0..count {
        if at > 0 && at.is_multiple_of(IN_A_ROW) {
            before = put_down(patch, driver, before);
        }
        before = patch.then(before, &format!("+ {ADDEND}"));
    }
    let end = patch.object("f");
    patch.cord((before, 0), (end, 1));
    driver.print(patch, end, &format!("n{}", count - 1));
}

/// Puts a number down and takes it up again when what brought it has returned.
fn put_down(patch: &mut Patch, driver: &Driver, from: Item) -> Item {
    let held = patch.object("f");
    patch.cord((from, 0), (held, 1));
    // Cords of one outlet act in the order of their making: the row up to here first.
    let resume = patch.object("bang");
    driver.feed(patch, resume);
    patch.cord((resume, 0), (held, 0));
    held
}

fn fan_out(patch: &mut Patch, driver: &Driver, count: usize) {
    let start = patch.object("f");
    driver.feed(patch, start);
    let mut last = start;
    for _ in 0..count {
        last = patch.then(start, &format!("+ {ADDEND}"));
    }
    let end = patch.object("f");
    patch.cord((last, 0), (end, 1));
    driver.print(patch, end, &format!("n{}", count - 1));
}

/// The cells of a rotation matrix, row by row: `c`, `s` and `n` for cosine, sine and its negative.
const ROTATIONS: [(&str, [&str; 9]); 3] = [
    ("rx", ["1", "0", "0", "0", "c", "n", "0", "s", "c"]),
    ("ry", ["c", "0", "s", "0", "1", "0", "n", "0", "c"]),
    ("rz", ["c", "n", "0", "s", "c", "0", "0", "0", "1"]),
];

fn dials(patch: &mut Patch, driver: &Driver) {
    // Outlets send from right to left: dial 1 is the rightmost.
    let dials = patch.object("t f f f f f f f f");
    driver.feed(patch, dials);
    let dial = |number: usize| (dials, 8 - number);
    for (number, (name, cells)) in (1..).zip(ROTATIONS) {
        let gain = patch.object("* 200");
        patch.cord(dial(number), (gain, 0));
        let angle = sum(patch, gain, 0.0, None);
        rotation(patch, driver, angle, name, cells);
    }
    let gain = patch.object("* 0.2");
    patch.cord(dial(4), (gain, 0));
    let coarse = patch.object("* 50");
    patch.cord(dial(8), (coarse, 0));
    patch.cord((coarse, 0), (gain, 0));
    let size = sum(patch, gain, 1.0, Some("clip 0.01 1000"));
    let matrix = patch.object("pack f 0 0 0 f 0 0 0 f");
    spread(patch, size, matrix, &[8, 4, 0]);
    node(patch, driver, matrix, "sc");

    let place = patch.object("pack f f f");
    for axis in 0..3 {
        let gain = patch.object("* 100");
        patch.cord(dial(5 + axis), (gain, 0));
        let along = sum(patch, gain, 0.0, None);
        if axis == 0 {
            patch.cord((along, 0), (place, 0));
        } else {
            let then_send = patch.then(along, "t b f");
            patch.cord((then_send, 1), (place, axis));
            patch.cord((then_send, 0), (place, 0));
        }
    }
    node(patch, driver, place, "tr");
}

/// A sum that begins at `start`, and perhaps what keeps it in bounds; the answer sends it.
fn sum(patch: &mut Patch, addend: Item, start: f64, bounds: Option<&str>) -> Item {
    let added = patch.then(addend, &format!("+ {start}"));
    let bounded = bounds.map_or(added, |bounds| patch.then(added, bounds));
    let sum = patch.then(bounded, "t f f");
    patch.cord((sum, 1), (added, 1));
    sum
}

fn rotation(patch: &mut Patch, driver: &Driver, angle_deg: Item, name: &str, cells: [&str; 9]) {
    let angle_rad = patch.then(angle_deg, "* 0.017453293");
    // The sine first: what the cosine brings completes the matrix.
    let both = patch.then(angle_rad, "t f f");
    let sine = patch.object("sin");
    patch.cord((both, 1), (sine, 0));
    let cosine = patch.object("cos");
    patch.cord((both, 0), (cosine, 0));
    let negative = patch.then(sine, "* -1");
    let kept = cells.map(|cell| if cell.parse::<f64>().is_ok() { cell } else { "f" });
    let matrix = patch.object(&format!("pack {}", kept.join(" ")));
    let places = |of: &str| -> Vec<usize> { (0..9).rev().filter(|&at| cells[at] == of).collect() };
    for at in places("n") {
        patch.cord((negative, 0), (matrix, at));
    }
    for at in places("s") {
        patch.cord((sine, 0), (matrix, at));
    }
    let mut completing = places("c");
    if cells[0] == "1" {
        // The left inlet sends, and has to be told its own number.
        completing.push(0);
        let told = patch.then(cosine, "t b f f");
        for (outlet, &at) in (0..3).rev().zip(&completing) {
            patch.cord((told, outlet), (matrix, at));
        }
    } else {
        spread(patch, cosine, matrix, &completing);
    }
    node(patch, driver, matrix, name);
}

/// One number to several inlets, in the order given.
fn spread(patch: &mut Patch, from: Item, to: Item, inlets: &[usize]) {
    let outlets = vec!["f"; inlets.len()].join(" ");
    let each = patch.then(from, &format!("t {outlets}"));
    for (outlet, &inlet) in (0..inlets.len()).rev().zip(inlets) {
        patch.cord((each, outlet), (to, inlet));
    }
}

/// Keeps what is sent to it.
fn node(patch: &mut Patch, driver: &Driver, from: Item, name: &str) {
    let node = patch.object("list append");
    patch.cord((from, 0), (node, 1));
    driver.print(patch, node, name);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cords_join_what_there_is() {
        for (graph, objects) in [
            (Graph::Dials, 50),
            (Graph::Chain(1200), 1200),
            (Graph::FanOut(30), 30),
        ] {
            let text = graph.patch(10, 3);
            let items = text
                .lines()
                .filter(|line| !line.starts_with("#X connect"))
                .count()
                - 1;
            assert!(items > objects, "{graph:?}: {items}");
            for line in text.lines().filter_map(|line| line.strip_prefix("#X connect ")) {
                let ends: Vec<usize> = line
                    .trim_end_matches(';')
                    .split(' ')
                    .map(|end| end.parse().expect("a number"))
                    .collect();
                assert!(
                    ends.len() == 4 && ends[0] < items && ends[2] < items,
                    "{graph:?}: {line}"
                );
            }
        }
    }

    #[test]
    fn a_row_is_never_too_long_for_the_peer() {
        let rests = |count: usize| Graph::Chain(count).patch(1, 1).matches("obj 10 10 f;").count() - 2;
        assert_eq!([rests(500), rests(501), rests(1000), rests(1001)], [0, 1, 1, 2]);
    }
}
