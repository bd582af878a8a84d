//! What does one turn of a dial do? Loads a network, turns, and shows the label and the line.
//!
//! `cargo run -p ps300 --example one_dial`

use ps300::Machine;

const PROGRAM: &str = "
    hand := VECTOR_LIST N=2 0,0 0,1;
    clock := ROTATE IN Z 0 THEN hand;
    DISPLAY clock;
    turn := F:DZROTATE;
    SEND -360 TO <3>turn;
    CONNECT DIALS<1>:<1>turn;
    CONNECT turn<1>:<1>clock;
    angle := F:PRINT;
    CONNECT turn<2>:<1>angle;
    CONNECT angle<1>:<1>DLABEL1;
";

fn main() {
    let mut machine = Machine::new();
    for diagnostic in machine.load(PROGRAM) {
        eprintln!("{diagnostic}");
    }
    for quarter in 1..=4_u32 {
        machine.emit("DIALS", 1, 0.25);
        machine.tick(f64::from(quarter), quarter.into(), 1000);
        let tip = machine.display().strokes[0].to;
        println!(
            "{:>8}: tip at {:.3}, {:.3}",
            machine.panel().dial_labels[0],
            tip.x,
            tip.y
        );
    }
    for report in machine.reports() {
        eprintln!("{report}");
    }
}
