//! What the shipped networks show, as drawings for their page: lines only, from the machine's own display list.
//!
//! The page has them as files so that it can be read anywhere; a drawing that is no longer what the network shows
//! fails here.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;

use glam::{DMat4, DVec2, DVec3};
use ps300::display::{Stroke, View};

use crate::hands::Hands;
use crate::session::{is_updating, root};

/// What hands do before a network is drawn.
type Done = fn(&mut Hands);

/// A drawing: its name, the files of `networks`, and what is done before it is drawn.
const DRAWINGS: &[(&str, &[&str], Done)] = &[
    ("dials", &["dials.ps300"], |hands| {
        turn(hands, &[(1, 0.15), (2, 0.1), (3, 0.1), (8, 0.5)]);
    }),
    ("light", &["pages/objects.ps300"], |hands| {
        hands.press(12);
        hands.press(12);
        hands.turn(5, 0.2);
        hands.turn(6, 0.3);
    }),
    ("color", &["pages/objects.ps300"], |hands| {
        for _ in 0..5 {
            hands.press(12);
        }
        hands.turn(1, 1.0);
        hands.press(12);
        turn(hands, &[(5, 0.2), (6, 0.2), (2, 1.0), (1, 1.0)]);
    }),
    ("path", &["pages/paths.ps300"], |hands| {
        hands.press(6);
        hands.press(6);
        turn(hands, &[(1, 1.0), (2, 0.3), (3, -0.6)]);
        hands.press(2);
    }),
    ("posing", &["pages/posing.ps300"], |hands| {
        hands.emit("TABLETIN", 1, DVec2::new(-0.1, 0.2));
        hands.turn(1, 0.1);
    }),
    ("inking", &["inking.ps300"], |hands| {
        for step in 0..90 {
            let angle = f64::from(step) * 0.2;
            hands.pen(DVec2::from_angle(angle) * (0.1 + angle * 0.04), true);
        }
        hands.pen(DVec2::new(0.75, -0.6), false);
        hands.press(2);
        hands.pen(DVec2::new(-0.8, -0.9), true);
        hands.pen(DVec2::new(0.8, -0.7), true);
    }),
    (
        "mirror",
        &[
            "mirror/lamp.ps300",
            "mirror/figure.ps300",
            "mirror/camera.ps300",
            "mirror/switch.ps300",
        ],
        |hands| {
            turn(hands, &[(1, 0.25), (2, 0.4), (3, 0.8)]);
            hands.press(2);
            turn(hands, &[(1, 0.25), (2, -0.8), (3, 0.4)]);
            hands.press(3);
            turn(hands, &[(1, -0.03), (2, 0.02)]);
        },
    ),
];

fn turn(hands: &mut Hands, dials: &[(u8, f64)]) {
    for &(dial, turns) in dials {
        hands.turn(dial, turns);
    }
}

/// Half the width of a drawing.
const HALF: f64 = 160.0;

/// Where the ends of a line are in the drawing, x right, y down.
fn placed(stroke: &Stroke, view: &View) -> [DVec2; 2] {
    // What has no view of its own lies in the rig's world, which the front view shows from a little above the ground.
    let front = DMat4::from_scale(DVec3::splat(0.4)) * DMat4::from_translation(DVec3::new(0.0, -0.6, 0.0));
    let screen = view.screen_from_world.unwrap_or(front);
    let [left, right] = view.viewport.horizontal;
    let [bottom, top] = view.viewport.vertical;
    let (low, high) = (DVec2::new(left, bottom), DVec2::new(right, top));
    [stroke.from, stroke.to].map(|at| {
        let seen = screen.project_point3(at).truncate();
        let at = low + (seen + DVec2::ONE) / 2.0 * (high - low);
        DVec2::new(HALF + at.x * HALF, HALF - at.y * HALF)
    })
}

/// Hue 0 is blue, 120 red, 240 green; without saturation it is white.
fn color(stroke: &Stroke) -> String {
    let channel = |at_deg: f64| {
        let away = ((stroke.hue_deg - at_deg + 180.0).rem_euclid(360.0) - 180.0).abs();
        let share = (2.0 - away / 60.0).clamp(0.0, 1.0);
        let bright = stroke.intensity[0] * (1.0 - stroke.saturation * (1.0 - share));
        (bright * 255.0).round() as u8
    };
    let [red, green, blue] = [120.0, 240.0, 0.0].map(channel);
    format!("#{red:02x}{green:02x}{blue:02x}")
}

fn drawing(hands: &Hands) -> String {
    let list = hands.machine.display();
    let mut paths: BTreeMap<String, String> = BTreeMap::new();
    for stroke in &list.strokes {
        let [from, to] = placed(stroke, &list.views[usize::from(stroke.view)]);
        let path = paths.entry(color(stroke)).or_default();
        let _ = write!(path, "M{:.0} {:.0}L{:.0} {:.0}", from.x, from.y, to.x, to.y);
    }
    let size = 2.0 * HALF;
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {size} {size}\" width=\"{size}\" height=\"{size}\">\n\
         <rect width=\"{size}\" height=\"{size}\"/>\n"
    );
    for (color, path) in paths {
        let _ = writeln!(out, "<path fill=\"none\" stroke=\"{color}\" d=\"{path}\"/>");
    }
    out + "</svg>\n"
}

#[test]
fn drawings_of_the_page_are_what_the_networks_show() {
    let folder = root().join("docs/pictures/networks");
    let mut wrong = Vec::new();
    for (name, files, done) in DRAWINGS {
        let mut hands = Hands::on(files);
        done(&mut hands);
        let drawn = drawing(&hands);
        let path = folder.join(format!("{name}.svg"));
        if is_updating() {
            fs::create_dir_all(&folder)
                .and_then(|()| fs::write(&path, &drawn))
                .expect("writes");
        } else if fs::read_to_string(&path).unwrap_or_default() != drawn {
            wrong.push(*name);
        }
        assert_eq!(hands.machine.reports(), [], "{name}");
    }
    assert!(
        wrong.is_empty(),
        "docs/pictures/networks: {wrong:?} are not what is shown; UPDATE_PAGES=1 draws them anew"
    );
}
