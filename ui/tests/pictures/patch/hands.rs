//! Hands and keys on the patch panel, and the network they leave behind.

use egui::{Key, Modifiers, vec2};

use super::Room;
use super::machine::{Link, sorted};
use super::networks::{DIALS, OBJECT, SINKS};

const SMALL: [f32; 2] = [1280.0, 720.0];

fn room(program: &str) -> Room {
    Room::new(Link::new(program, SINKS), SMALL, false)
}

#[test]
fn the_canonical_rotate_path_by_dragging_and_tab_alone() {
    let mut room = room(OBJECT);
    // Tab over the table, a device by name.
    let middle = room.area().center();
    room.harness.hover_at(middle - vec2(260.0, 60.0));
    room.step();
    room.press(Modifiers::NONE, Key::Tab);
    room.write("dials");
    room.press(Modifiers::NONE, Key::Enter);
    // A wire let go over nothing offers what takes it.
    let from = room.output("DIALS", 0);
    room.drag(from, middle + vec2(-20.0, -60.0));
    room.write("rx:dxr");
    room.press(Modifiers::NONE, Key::Enter);
    // The node, by name, then a wire onto its input.
    room.harness.hover_at(middle + vec2(230.0, -40.0));
    room.step();
    room.press(Modifiers::NONE, Key::Tab);
    room.write("obj.rotx");
    room.press(Modifiers::NONE, Key::Enter);
    let (from, to) = (room.output("rx", 0), room.input("obj.rotx", 0));
    room.drag(from, to);
    // The gain, where it stands.
    let gain = room.input("rx", 2);
    room.click_twice(gain);
    room.write("200");
    room.press(Modifiers::NONE, Key::Enter);
    let zero = room.input("rx", 1);
    room.click_twice(zero);
    room.write("0");
    room.press(Modifiers::NONE, Key::Enter);
    let want = format!(
        "{OBJECT} rx := F:DXROTATE; CONNECT DIALS<1>:<1>rx; CONNECT rx<1>:<1>obj.rotx; SEND 0 TO <2>rx; \
         SEND 200 TO <3>rx;"
    );
    assert_eq!(sorted(&room.link.text()), sorted(&want), "{}", room.link.text());
    // It works: a quarter of a turn of the dial reaches the node.
    room.turn(&[(1, 0.25)]);
    let (look, _) = room.link.look();
    assert_eq!(
        look.activity.outputs.iter().map(|output| output.sent).max(),
        Some(1)
    );
}

#[test]
fn a_wire_that_cannot_carry_anything_is_not_made() {
    let mut room = room(DIALS);
    let before = room.link.text();
    let (from, to) = (room.output("rx", 0), room.input("sc", 1));
    room.drag(from, to);
    assert_eq!(room.link.text(), before);
}

#[test]
fn an_edit_is_one_step_and_can_be_taken_back() {
    let mut room = room(DIALS);
    let before = room.link.text();
    let at = room.place("tr").center_top() + vec2(0.0, 8.0);
    room.click(at);
    room.press(Modifiers::NONE, Key::Delete);
    assert!(
        !room.link.text().contains("tr := F:ACCUMULATE"),
        "{}",
        room.link.text()
    );
    room.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(sorted(&room.link.text()), sorted(&before));
    let again = Modifiers {
        shift: true,
        ..Modifiers::COMMAND
    };
    room.press(again, Key::Z);
    assert!(!room.link.text().contains("tr := F:ACCUMULATE"));
}

#[test]
fn a_wire_taken_off_its_input_can_be_put_on_another() {
    let mut room = room(DIALS);
    let (from, to) = (room.input("obj.rotx", 0), room.input("obj.roty", 0));
    room.drag(from, to);
    let text = room.link.text();
    assert!(text.contains("CONNECT rx<1>:<1>obj.roty;"), "{text}");
    assert!(!text.contains("CONNECT rx<1>:<1>obj.rotx;"), "{text}");
    // Let go over nothing, it is gone.
    let (from, over_nothing) = (
        room.input("obj.rotz", 0),
        room.area().left_bottom() + vec2(40.0, -30.0),
    );
    room.drag(from, over_nothing);
    assert!(!room.link.text().contains("obj.rotz;"), "{}", room.link.text());
}

#[test]
fn a_literal_that_does_not_fit_is_refused_where_it_is_typed() {
    let mut room = room(DIALS);
    let before = room.link.text();
    let gain = room.input("rx", 2);
    room.click_twice(gain);
    room.write("'fast'");
    room.press(Modifiers::NONE, Key::Enter);
    assert_eq!(room.link.text(), before);
    room.press(Modifiers::COMMAND, Key::A);
    room.write("90");
    room.press(Modifiers::NONE, Key::Enter);
    assert!(
        room.link.text().contains("SEND 90 TO <3>rx;"),
        "{}",
        room.link.text()
    );
}

#[test]
fn copies_keep_constants_and_inner_wires() {
    let mut room = room(DIALS);
    let (from, to) = (room.place("tx").left_top(), room.place("tr").right_bottom());
    room.drag(from - vec2(20.0, 6.0), to.max(from) + vec2(12.0, 6.0));
    room.press(Modifiers::COMMAND, Key::D);
    let text = room.link.text();
    for line in ["tr2 := F:ACCUMULATE;", "SEND 100 TO <4>tr2;"] {
        assert!(text.contains(line), "{line}: {text}");
    }
    assert!(text.contains("CONNECT tx2<1>:<1>tr2;"), "{text}");
}

#[test]
fn folding_keeps_the_wires_that_cross_the_border() {
    let mut room = room(DIALS);
    let area = room.area();
    room.harness.state_mut().studio.patch().fold(&"obj".into(), true);
    room.step();
    room.step();
    let folded = room.place("obj");
    assert!(area.contains_rect(folded), "{folded:?}");
    let found = room
        .harness
        .state_mut()
        .studio
        .patch()
        .place_of(area, &"obj.rotx".into());
    assert_eq!(found, None, "members are inside");
    room.click_twice(folded.center_top() + vec2(0.0, 8.0));
    room.step();
    assert!(room.place("obj.rotx").is_positive());
}

#[test]
fn the_text_is_the_network_when_it_is_right_and_applied() {
    let mut room = room(DIALS);
    room.harness.state_mut().studio.patch().show_text(true);
    room.step();
    let inside = room.area().right_center() - vec2(120.0, 0.0);
    let before = room.link.text();
    for (typed, taken) in [("a := F:NOPE;", false), ("a := F:NOP;", true)] {
        room.click(inside);
        room.press(Modifiers::COMMAND, Key::A);
        room.write(typed);
        assert_eq!(room.link.text(), before, "nothing happens while one types");
        room.press(Modifiers::COMMAND, Key::Enter);
        assert_eq!(room.link.text().trim() == typed, taken, "{}", room.link.text());
    }
    room.press(Modifiers::NONE, Key::F);
    assert!(room.place("a").is_positive());
}

#[test]
fn what_is_typed_is_no_order() {
    let mut room = room(OBJECT);
    room.harness.hover_at(room.area().center());
    room.step();
    room.press(Modifiers::NONE, Key::Tab);
    room.said.clear();
    for key in [Key::A, Key::P, Key::Space, Key::Delete] {
        room.press(Modifiers::NONE, key);
    }
    assert_eq!(room.said, []);
}
