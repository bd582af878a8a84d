//! `networks/dials.ps300` against its closed form, a product of seven matrices.
//! Source: `docs/protocols/ps300.md`, "Canonical dial network".

use std::fmt::Write;

use glam::{DMat3, DMat4, DVec3};
use ps300::Machine;

use crate::record::{Record, is_near, last, records};
use crate::session::{Desk, root};

/// Turns of dials 1 to 8, with the time of each: every dial comes up again and again, in both directions.
fn turns() -> Vec<(usize, f64, f64)> {
    (0..96_u32)
        .map(|step| {
            let dial = (step * 5 % 8) as usize;
            let turned = f64::from(step * 37 % 23) * 0.03125 - 0.3125;
            (dial, turned, f64::from(step) / 64.0)
        })
        .collect()
}

/// What the seven nodes hold after the dials have been turned by so much altogether.
struct Expected {
    rotations: [DMat3; 3],
    factor: f64,
    place: DVec3,
}

impl Expected {
    fn new(turned: [f64; 8]) -> Self {
        let angle = |dial: usize| (200.0 * turned[dial]).to_radians();
        Self {
            rotations: [
                DMat3::from_rotation_x(angle(0)),
                DMat3::from_rotation_y(angle(1)),
                DMat3::from_rotation_z(angle(2)),
            ],
            factor: 1.0 + 0.2 * (turned[3] + 10.0 * turned[7]),
            place: 100.0 * DVec3::new(turned[4], turned[5], turned[6]),
        }
    }

    /// The pivot nodes are where the file leaves them, at the origin.
    fn whole(&self) -> DMat4 {
        let [x, y, z] = self.rotations;
        DMat4::from_mat3(x * y * z * self.factor) * DMat4::from_translation(self.place)
    }
}

fn rows(m: DMat3) -> Vec<f64> {
    m.transpose().to_cols_array().to_vec()
}

#[test]
fn dials_make_the_matrices_of_the_closed_form() {
    let mut command = "dialrig net run networks/dials.ps300".to_owned();
    let mut altogether = [0.0; 8];
    for (dial, turned, secs) in turns() {
        altogether[dial] += turned;
        let _ = write!(command, " --dial {}:{turned}@{secs}", dial + 1);
    }
    for watched in ["rot_x<1>", "rot_y<1>", "rot_z<1>", "scale<1>", "move<1>"] {
        let _ = write!(command, " --watch '{watched}'");
    }
    let seen = records(&Desk::new(), &command);
    // One message for each turn: nothing is lost, nothing comes twice.
    assert_eq!(seen.len(), turns().len());
    let expected = Expected::new(altogether);
    let check = |from: &str, numbers: &[f64]| {
        let got = last(&seen, from).map(Record::numbers).unwrap_or_default();
        assert!(is_near(&got, numbers), "{from}: {got:?}, expected {numbers:?}");
    };
    for (from, rotation) in ["rot_x<1>", "rot_y<1>", "rot_z<1>"]
        .into_iter()
        .zip(expected.rotations)
    {
        check(from, &rows(rotation));
    }
    check(
        "scale<1>",
        &rows(DMat3::from_diagonal(DVec3::splat(expected.factor))),
    );
    check("move<1>", &expected.place.to_array());
}

#[test]
fn the_picture_is_where_the_product_of_the_seven_puts_it() {
    let mut machine = Machine::new();
    let text = std::fs::read_to_string(root().join("networks/dials.ps300")).expect("readable");
    assert_eq!(machine.load(&text), []);
    let before = machine.display_of("arrow", DMat4::IDENTITY).strokes;
    let mut altogether = [0.0; 8];
    for (step, (dial, turned, secs)) in turns().into_iter().enumerate() {
        altogether[dial] += turned;
        assert!(machine.emit("DIALS", dial as u8 + 1, turned));
        machine.tick(secs, step as u64, 1000);
        let whole = Expected::new(altogether).whole();
        let now = machine.display_of("object", DMat4::IDENTITY).strokes;
        assert_eq!(now.len(), before.len());
        for (now, before) in now.iter().zip(&before) {
            let far = (now.to - whole.transform_point3(before.to)).length();
            assert!(far < 1e-9 * (1.0 + before.to.length()), "step {step}: {far}");
        }
    }
    assert_eq!(machine.reports(), []);
}

#[test]
fn scale_stays_between_its_limits_and_home_puts_everything_back() {
    let run = "dialrig net run networks/dials.ps300 --dial 8:-3@0 --dial 4:0.05@0.1 --dial 8:900@0.2 --dial 4:-5@0.3 \
               --dial 2:0.3@0.3 --dial 7:1@0.3 --key 1@0.4 --watch 'scale<2>' --watch 'rot_y<2>' --watch 'move<1>'";
    let seen = records(&Desk::new(), run);
    let factors: Vec<f64> = seen
        .iter()
        .filter(|record| record.from == "scale<2>")
        .filter_map(|record| record.value.as_f64())
        .collect();
    assert!(
        is_near(&factors, &[0.01, 0.02, 1000.0, 999.0, 1.0]),
        "{factors:?}"
    );
    let home = |from| last(&seen, from).map(Record::numbers);
    assert_eq!(home("rot_y<2>"), Some(vec![0.0]));
    assert_eq!(home("move<1>"), Some(vec![0.0; 3]));
}
