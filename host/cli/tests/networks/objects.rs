//! `networks/pages/objects.ps300`: what the labels say and where the parameters are, against a model of the page that
//! shares nothing with it but the table of dials.

use std::collections::BTreeMap;

use glam::{DMat3, DMat4, DVec3};
use ps300::Value;

use crate::hands::{Draws, Hands};

/// Things in the order of F12, and of which kind their eight dials are.
const THINGS: [(&str, Dials); 9] = [
    ("OBJ", Dials::Place),
    ("PLAN", Dials::Place),
    ("SUN", Dials::Light),
    ("MOON", Dials::Light),
    ("BACK", Dials::Light),
    ("OBJ1C", Dials::Place),
    ("OBJ1D", Dials::Surface),
    ("OBJ2C", Dials::Place),
    ("OBJ2D", Dials::Surface),
];

/// Their structures; OBJ1D is the same object as OBJ1C.
const NAMES: [&str; 7] = ["obj", "plan", "sun", "moon", "back", "obj1", "obj2"];

const VIEWPORTS: [(&str, [f64; 4]); 10] = [
    ("Square", [-0.84375, 0.84375, -1.0, 1.0]),
    ("Maximum", [-1.0, 1.0, -1.0, 1.0]),
    ("1/2", [-1.0, 0.0, -1.0, 1.0]),
    ("2/2", [0.0, 1.0, -1.0, 1.0]),
    ("1/6", [-1.0, -1.0 / 3.0, 0.0, 1.0]),
    ("2/6", [-1.0 / 3.0, 1.0 / 3.0, 0.0, 1.0]),
    ("3/6", [1.0 / 3.0, 1.0, 0.0, 1.0]),
    ("4/6", [-1.0, -1.0 / 3.0, -1.0, 0.0]),
    ("5/6", [-1.0 / 3.0, 1.0 / 3.0, -1.0, 0.0]),
    ("6/6", [1.0 / 3.0, 1.0, -1.0, 0.0]),
];

/// With the codes that F1 sends.
const RENDERINGS: [(&str, i32); 9] = [
    ("HIDDEN", 4),
    ("WASH", 5),
    ("FLAT", 6),
    ("SMOOTH", 7),
    ("XSECTION", 1),
    ("SECTION", 2),
    ("BACKFACE", 3),
    ("SAVE-SEC", -2),
    ("SAVE-HL", -4),
];

#[derive(Clone, Copy, PartialEq)]
enum Dials {
    Place,
    Light,
    Surface,
}

impl Dials {
    fn labels(self) -> [&'static str; 8] {
        let [a, b, c, h] = match self {
            Self::Place => ["X-Trans", "Y-Trans", "Z-Trans", "BackClip"],
            Self::Light => ["Hue", "Sat", "Int", "BackClip"],
            Self::Surface => ["Hue", "Sat", "Diffuse", "Specular"],
        };
        [a, b, c, "Scale", "X-Rot", "Y-Rot", "Z-Rot", h]
    }
}

/// What one thing is at after the dials have been turned.
#[derive(Clone, Copy)]
struct Thing {
    place: DVec3,
    turned_deg: [f64; 3],
    scale: f64,
    hue_deg: f64,
    saturation: f64,
    intensity: f64,
    diffuse: f64,
    specular: f64,
    on: bool,
}

impl Thing {
    const NEW: Self = Self {
        place: DVec3::ZERO,
        turned_deg: [0.0; 3],
        scale: 1.0,
        hue_deg: 0.0,
        saturation: 0.0,
        intensity: 1.0,
        diffuse: 0.75,
        specular: 5.0,
        on: true,
    };

    fn rotation(&self) -> DMat3 {
        let [x, y, z] = self.turned_deg.map(f64::to_radians);
        DMat3::from_rotation_x(x) * DMat3::from_rotation_y(y) * DMat3::from_rotation_z(z)
    }
}

/// The page as it is described, without a network.
struct Model {
    /// From 0.
    chosen: usize,
    /// As [`NAMES`].
    things: [Thing; 7],
    back_clip: f64,
    viewport: usize,
    rendering: usize,
    /// The thing whose colour was turned last, and the light, while nothing else was.
    colored: Option<usize>,
    turned: Option<usize>,
}

impl Model {
    fn new() -> Self {
        Self {
            chosen: 0,
            things: [Thing::NEW; 7],
            back_clip: 20.0,
            viewport: 0,
            rendering: 0,
            colored: None,
            turned: None,
        }
    }

    /// The number of the chosen thing; OBJ1C and OBJ1D are one.
    fn number(&self) -> usize {
        [0, 1, 2, 3, 4, 5, 5, 6, 6][self.chosen]
    }

    fn turn(&mut self, dial: u8, turns: f64) {
        let kind = THINGS[self.chosen].1;
        let number = self.number();
        let is_color = kind != Dials::Place && (dial < 3 || (dial == 3 && kind == Dials::Light));
        self.colored = is_color.then_some(number);
        self.turned = ((5..=7).contains(&dial) && kind == Dials::Light && self.chosen != 4).then_some(number);
        let thing = &mut self.things[number];
        match (dial, kind) {
            (1, Dials::Place) => thing.place.x += turns,
            (2, Dials::Place) => thing.place.y += turns,
            (3, Dials::Place) => thing.place.z += turns,
            (1, _) => thing.hue_deg += 120.0 * turns,
            (2, _) => thing.saturation = (thing.saturation + turns).clamp(0.0, 1.0),
            (3, Dials::Light) => thing.intensity = (thing.intensity + turns).clamp(0.0, 1.0),
            (3, Dials::Surface) => thing.diffuse = (thing.diffuse + turns).clamp(0.0, 1.0),
            (4, _) => thing.scale = (thing.scale + 0.2 * turns).clamp(0.01, 1000.0),
            (5..=7, _) => thing.turned_deg[usize::from(dial) - 5] += 200.0 * turns,
            (_, Dials::Surface) => thing.specular = (thing.specular + 5.0 * turns).clamp(0.0, 10.0),
            (_, _) => self.back_clip = (self.back_clip + 5.0 * turns).clamp(9.0, 60.0),
        }
    }

    fn press(&mut self, key: i32) {
        match key {
            2 => self.viewport = (self.viewport + 1) % 10,
            3 => self.rendering = (self.rendering + 1) % 9,
            10 => {
                for thing in &mut self.things {
                    *thing = Thing {
                        on: thing.on,
                        ..Thing::NEW
                    };
                }
                self.back_clip = 20.0;
            }
            11 => self.things[self.number()].on ^= true,
            12 => {
                self.chosen = (self.chosen + 1) % 9;
                (self.colored, self.turned) = (None, None);
            }
            _ => {}
        }
    }
}

/// The page, and the last message of each output that is watched.
struct Page {
    hands: Hands,
    sent: BTreeMap<String, Value>,
}

impl Page {
    fn new() -> Self {
        let mut hands = Hands::on(&["pages/objects.ps300"]);
        for name in WATCHED {
            assert!(hands.machine.watch(name, 1), "{name}");
        }
        let mut page = Self {
            hands,
            sent: BTreeMap::new(),
        };
        page.press(10);
        page
    }

    fn press(&mut self, key: i32) {
        self.hands.press(key);
        self.hear();
    }

    fn turn(&mut self, dial: u8, turns: f64) {
        self.hands.turn(dial, turns);
        self.hear();
    }

    fn hear(&mut self) {
        for seen in self.hands.machine.drain_watched() {
            self.sent.insert(seen.name.as_str().to_owned(), seen.value);
        }
    }

    fn number(&self, name: &str) -> f64 {
        self.sent.get(name).and_then(Value::as_number).unwrap_or(f64::NAN)
    }

    /// What differs from the model.
    fn differences(&self, model: &Model) -> Vec<String> {
        let mut wrong = Vec::new();
        let mut check = |what: &str, same: bool| {
            if !same {
                wrong.push(what.to_owned());
            }
        };
        let panel = self.hands.machine.panel();
        let kind = THINGS[model.chosen].1;
        check("dial labels", panel.dial_labels == kind.labels());
        let [viewport, rendering, switch, chosen] =
            [1, 2, 10, 11].map(|key: usize| panel.key_labels[key].as_str());
        check("F2", viewport == VIEWPORTS[model.viewport].0);
        check("F3", rendering == RENDERINGS[model.rendering].0);
        check("F11", (switch == "On") == model.things[model.number()].on);
        check("F12", chosen == THINGS[model.chosen].0);
        check("back clip", near(self.number("back_clip"), model.back_clip));
        for (number, thing) in model.things.iter().enumerate() {
            let name = NAMES[number];
            check(name, self.is_placed(number, thing, model.turned == Some(number)));
            if number >= 2 {
                check(&format!("{name}_swatch"), self.is_colored(number, thing, model));
            }
            if number >= 5 {
                check(
                    "diffuse",
                    near(self.number(&format!("{name}_diffuse")), thing.diffuse),
                );
                check(
                    "specular",
                    near(self.number(&format!("{name}_specular")), thing.specular),
                );
            }
            if let (2 | 3, Some(Value::Vector3(sent))) = (number, self.sent.get(&format!("{name}_direction")))
            {
                check("direction", (*sent - thing.rotation() * DVec3::Z).length() < 1e-9);
            }
        }
        wrong
    }

    /// Whether the structure of a thing shows its shape where the model has it.
    fn is_placed(&self, number: usize, thing: &Thing, is_turned: bool) -> bool {
        let shape = ["", "square", "ray", "ray", "", "cube", "spire"][number];
        if shape.is_empty() {
            return true;
        }
        let drawn = self
            .hands
            .machine
            .display_of(NAMES[number], DMat4::IDENTITY)
            .strokes;
        let is_light = shape == "ray";
        if !thing.on || (is_light && !is_turned) {
            return drawn.is_empty();
        }
        let written = self.hands.machine.display_of(shape, DMat4::IDENTITY).strokes;
        let size = if is_light { 3.0 * thing.scale } else { thing.scale };
        let placed = |at: DVec3| thing.place + thing.rotation() * at * size;
        drawn.len() == written.len()
            && drawn
                .iter()
                .zip(&written)
                .all(|(drawn, written)| (drawn.to - placed(written.to)).length() < 1e-9 * (1.0 + size))
    }

    /// Whether the swatch is seen when it should be, and in the thing's colour.
    fn is_colored(&self, number: usize, thing: &Thing, model: &Model) -> bool {
        let name = format!("{}_swatch", NAMES[number]);
        let drawn = self.hands.machine.display_of(&name, DMat4::IDENTITY).strokes;
        let bright = if number < 5 { thing.intensity } else { 1.0 };
        drawn.is_empty() != (model.colored == Some(number))
            && drawn.iter().all(|stroke| {
                near(stroke.hue_deg, thing.hue_deg)
                    && near(stroke.saturation, thing.saturation)
                    && near(stroke.intensity[0], bright)
            })
    }
}

const WATCHED: &[&str] = &[
    "back_clip",
    "obj1_diffuse",
    "obj1_specular",
    "obj2_diffuse",
    "obj2_specular",
    "sun_direction",
    "moon_direction",
    "frame_area",
    "render",
    "raster",
    "solid",
    "save_key",
    "clear",
    "read_keys",
    "next_frame",
];

fn near(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-9 * b.abs().max(1.0)
}

#[test]
fn keys_and_dials_do_what_the_table_says_in_any_order() {
    let mut page = Page::new();
    let mut model = Model::new();
    assert_eq!(page.differences(&model), [""; 0], "at first");
    let mut draws = Draws(12_345);
    for step in 0..1500 {
        let done = if draws.below(5) == 0 {
            let key = [2, 3, 10, 11, 12, 12, 12, 12][draws.below(8) as usize];
            page.press(key);
            model.press(key);
            format!("F{key}")
        } else {
            let dial = draws.below(8) as u8 + 1;
            let turns = draws.unit() / 2.0;
            page.turn(dial, turns);
            model.turn(dial, turns);
            format!("dial {dial} by {turns}")
        };
        let wrong = page.differences(&model);
        assert!(
            wrong.is_empty(),
            "step {step}, {done}, {}: {wrong:?}",
            THINGS[model.chosen].0
        );
    }
    assert_eq!(page.hands.machine.reports(), []);
}

#[test]
fn two_keys_cycle_viewports_and_renderings_and_a_third_asks_for_the_one_that_is_set() {
    let mut page = Page::new();
    let label = |page: &Page, key: usize| page.hands.machine.panel().key_labels[key - 1].clone();
    for round in 0..2 {
        for (name, [left, right, bottom, top]) in VIEWPORTS {
            assert_eq!(label(&page, 2), name, "round {round}");
            if let Some(Value::Matrix3(m)) = page.sent.get("frame_area") {
                let area = [m.row(0).x, m.row(0).y, m.row(1).x, m.row(1).y];
                let expected = [left, right, bottom, top];
                assert!(
                    area.iter().zip(expected).all(|(a, b)| near(*a, b)),
                    "{name}: {area:?}"
                );
            }
            page.press(2);
        }
        for (name, code) in RENDERINGS {
            assert_eq!(label(&page, 3), name, "round {round}");
            page.press(1);
            assert_eq!(page.sent.get("render"), Some(&Value::from(code)), "{name}");
            page.press(3);
        }
    }
}

#[test]
fn keys_that_switch_say_how_and_keys_that_ask_send() {
    let mut page = Page::new();
    for (key, name, labels) in [
        (4, "raster", ["Raster", "Vector"]),
        (7, "solid", ["Surface", "Solid"]),
    ] {
        for (label, value) in labels.into_iter().zip([key == 4, key != 4]) {
            page.press(key);
            assert_eq!(page.hands.machine.panel().key_labels[key as usize - 1], label);
            assert_eq!(page.sent.get(name), Some(&Value::from(value)), "{label}");
        }
    }
    for (key, name) in [(5, "save_key"), (6, "clear"), (8, "read_keys"), (9, "next_frame")] {
        assert!(!page.sent.contains_key(name));
        page.press(key);
        assert!(page.sent.contains_key(name), "{name}");
    }
}
