//! The table without a window: what moves when the network is edited, and what must not.

use std::collections::BTreeMap;
use std::sync::Arc;

use ps300::Machine;
use ui::patch::area::Area;
use ui::patch::look::Picture;
use ui::patch::table::{Change, Table};

use super::networks::{DIALS, pages};

fn machine(program: &str) -> Machine {
    let mut machine = Machine::new();
    for name in ["VIEW", "TIME"] {
        machine
            .declare_sink(name, &[ps300::Kinds::NUMBER; 3])
            .expect("the name is new");
    }
    let wrong = machine.load(program);
    assert!(wrong.is_empty(), "{wrong:?}");
    machine
}

fn picture(machine: &Machine) -> Arc<Picture> {
    Arc::new(machine.picture())
}

/// Looks until the layout is there.
fn settle(table: &mut Table, picture: &Arc<Picture>) {
    while table.see(picture) == Change::None {
        std::thread::yield_now();
    }
    table.see(picture);
}

fn places(table: &Table) -> BTreeMap<String, Area> {
    let boxes = table.scene.boxes.iter().zip(&table.seating.areas);
    boxes
        .map(|(shown, &area)| (shown.name.to_string(), area))
        .collect()
}

fn assert_apart(table: &Table) {
    let areas = &table.seating.areas;
    for (index, a) in areas.iter().enumerate() {
        for (other, b) in areas.iter().enumerate().skip(index + 1) {
            let (a_name, b_name) = (&table.scene.boxes[index].name, &table.scene.boxes[other].name);
            assert!(!a.meets(*b), "{a_name} {a:?} lies on {b_name} {b:?}");
        }
    }
}

#[test]
fn a_frame_holds_its_own_boxes_and_no_others() {
    let program = format!(
        "{DIALS} kit := BEGIN_STRUCTURE a := F:ADDC; b := F:MULC; END_STRUCTURE;
         CONNECT DIALS<1>:<1>kit.a; CONNECT kit.a<1>:<1>kit.b; CONNECT kit.b<1>:<1>sc;"
    );
    let machine = machine(&program);
    let mut table = Table::default();
    settle(&mut table, &picture(&machine));
    assert_apart(&table);
    assert_eq!(table.seating.frames.len(), 2);
    for (frame, (name, area)) in table.scene.frames.iter().zip(&table.seating.frames) {
        for (index, inside) in table.seating.areas.iter().enumerate() {
            let member = frame.members.contains(&index);
            let shown = &table.scene.boxes[index].name;
            assert_eq!(inside.meets(*area), member, "{shown} and the frame of {name}");
        }
    }
}

#[test]
fn an_edit_moves_only_what_it_makes() {
    let mut machine = machine(DIALS);
    let mut table = Table::default();
    settle(&mut table, &picture(&machine));
    for step in 0..12 {
        let before = places(&table);
        let wrong = machine.load(&format!("more{step} := F:NOP; CONNECT rx<2>:<1>more{step};"));
        assert!(wrong.is_empty(), "{wrong:?}");
        assert_eq!(table.see(&picture(&machine)), Change::Edited);
        let after = places(&table);
        for (name, area) in &before {
            assert_eq!(after.get(name), Some(area), "{name} moved");
        }
        assert_apart(&table);
        let made = after[&format!("more{step}")];
        assert!(
            made.min.x > before["rx"].max.x,
            "to the right of what feeds it: {made:?}"
        );
    }
}

#[test]
fn folding_and_unfolding_is_as_if_nothing_had_been() {
    let machine = machine(DIALS);
    let picture = picture(&machine);
    let mut table = Table::default();
    settle(&mut table, &picture);
    let before = places(&table);
    table.fold(&"obj".into(), true);
    table.see(&picture);
    assert_apart(&table);
    let folded = places(&table);
    assert!(
        folded.contains_key("obj") && !folded.contains_key("obj.rotx"),
        "{folded:?}"
    );
    let shown = &table.scene.boxes[table.scene.find(&"obj".into()).expect("it is folded")];
    assert_eq!(
        shown.inputs.len(),
        5,
        "one input for each wire that crosses the border"
    );
    table.fold(&"obj".into(), false);
    table.see(&picture);
    assert_eq!(places(&table), before);
}

#[test]
fn a_large_network_is_laid_out_beside_the_window() {
    let machine = machine(&pages(1200));
    let mut table = Table::default();
    let picture = picture(&machine);
    assert_eq!(table.see(&picture), Change::None);
    assert!(table.is_waiting());
    settle(&mut table, &picture);
    assert!(table.scene.boxes.len() > 1200);
    assert_apart(&table);
}
