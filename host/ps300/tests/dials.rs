//! The dial network of every PS 300 program: eight dials turn, scale and move one object.
//! Source: `docs/protocols/ps300.md`, "Canonical dial network".

use glam::{DMat3, DMat4, DVec3};
use ps300::Machine;

const NETWORK: &str = include_str!("data/dials.ps300");

/// What the tree must hold after the dials have been turned by `turns`, worked out without a network.
fn closed_form(turns: [f64; 8]) -> DMat4 {
    let pivot = DVec3::new(1.0, 2.0, 3.0);
    let [x, y, z] = [0, 1, 2].map(|dial| (200.0 * turns[dial]).to_radians());
    let factor = 1.0 + 0.2 * (turns[3] + 50.0 * turns[7]);
    let turned = DMat3::from_rotation_x(x) * DMat3::from_rotation_y(y) * DMat3::from_rotation_z(z);
    DMat4::from_translation(pivot)
        * DMat4::from_mat3(turned * factor)
        * DMat4::from_translation(-pivot)
        * DMat4::from_translation(100.0 * DVec3::new(turns[4], turns[5], turns[6]))
}

fn drawn(machine: &Machine) -> (DVec3, DVec3) {
    let list = machine.display();
    assert_eq!(list.strokes.len(), 1);
    (list.strokes[0].from, list.strokes[0].to)
}

#[test]
fn eight_dials_place_the_object_as_the_closed_form_does() {
    let mut machine = Machine::new();
    assert_eq!(machine.load(NETWORK), []);
    let mut turns = [0.0; 8];
    for step in 0_u32..200 {
        for (dial, turned) in turns.iter_mut().enumerate() {
            let delta = f64::from((step * 7 + dial as u32 * 13) % 11) * 0.001 - 0.004;
            *turned += delta;
            assert!(machine.emit("DIALS", dial as u8 + 1, delta));
        }
        machine.tick(f64::from(step) / 60.0, step.into(), 1000);
        let expected = closed_form(turns);
        let (from, to) = drawn(&machine);
        assert!(
            (from - expected.transform_point3(DVec3::ZERO)).length() < 1e-9,
            "step {step}"
        );
        assert!(
            (to - expected.transform_point3(DVec3::ONE)).length() < 1e-9,
            "step {step}"
        );
    }
    assert_eq!(machine.reports(), []);
}

#[test]
fn the_scale_stops_at_its_limit_and_turns_back_at_once() {
    let mut machine = Machine::new();
    machine.load(NETWORK);
    machine.emit("DIALS", 8, -99.0);
    machine.emit("DIALS", 4, 0.05);
    machine.tick(0.0, 0, 100);
    let (from, to) = drawn(&machine);
    // The fast dial passes one more function, so the slow one's message arrives first; both end clamped.
    assert!((to - from - DVec3::splat(0.01)).length() < 1e-12);
    machine.emit("DIALS", 4, 0.05);
    machine.tick(0.1, 1, 100);
    let (from, to) = drawn(&machine);
    assert!((to - from - DVec3::splat(0.02)).length() < 1e-12);
}
