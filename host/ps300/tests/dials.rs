//! The dial network of every PS 300 program: eight dials turn, scale and move one object.
//! Source: `docs/protocols/ps300.md`, "Canonical dial network".

use glam::{DMat3, DMat4, DVec3};
use ps300::Machine;

const NETWORK: &str = "
    rx := F:DXROTATE; SEND 0 TO <2>rx; SEND 200 TO <3>rx; CONNECT DIALS<1>:<1>rx; CONNECT rx<1>:<1>obj.rotx;
    ry := F:DYROTATE; SEND 0 TO <2>ry; SEND 200 TO <3>ry; CONNECT DIALS<2>:<1>ry; CONNECT ry<1>:<1>obj.roty;
    rz := F:DZROTATE; SEND 0 TO <2>rz; SEND 200 TO <3>rz; CONNECT DIALS<3>:<1>rz; CONNECT rz<1>:<1>obj.rotz;
    sc := F:DSCALE; SEND 1 TO <2>sc; SEND 0.2 TO <3>sc; SEND 1000 TO <4>sc; SEND 0.01 TO <5>sc;
    CONNECT DIALS<4>:<1>sc; CONNECT sc<1>:<1>obj.size;
    tx := F:XVECTOR; ty := F:YVECTOR; tz := F:ZVECTOR; tr := F:ACCUMULATE;
    SEND V3D(0,0,0) TO <2>tr; SEND 100 TO <4>tr;
    CONNECT DIALS<5>:<1>tx; CONNECT DIALS<6>:<1>ty; CONNECT DIALS<7>:<1>tz;
    CONNECT tx<1>:<1>tr; CONNECT ty<1>:<1>tr; CONNECT tz<1>:<1>tr; CONNECT tr<1>:<1>obj.place;
    coarse := F:MULC; SEND 50 TO <2>coarse; CONNECT DIALS<8>:<1>coarse; CONNECT coarse<1>:<1>sc;
";

const TREE: &str = "
    obj := BEGIN_STRUCTURE
        pivot := TRANSLATE BY 1,2,3;
        rotx := ROTATE IN X 0; roty := ROTATE IN Y 0; rotz := ROTATE IN Z 0;
        size := SCALE BY 1;
        back := TRANSLATE BY -1,-2,-3;
        place := TRANSLATE BY 0,0,0;
        VECTOR_LIST N=2 0,0,0 1,1,1;
    END_STRUCTURE;
    DISPLAY obj;
";

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
    assert_eq!(machine.load(TREE), []);
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
    machine.load(TREE);
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
