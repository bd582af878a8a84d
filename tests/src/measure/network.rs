//! How many messages a second the function network delivers to inputs.
//!
//! Three shapes: the dial network of every PS 300 program (eight dial events make 20 messages), 1000 functions in
//! a row, and one output connected to 1000 inputs. Before anything is timed each shape is checked to do what it
//! should. Source of the dial network: `docs/protocols/ps300.md`, "Canonical dial network".

use super::rig_step::nanos_per;
use super::{Row, Subject, Tell, repeated};
use ps300::Machine;
use std::fmt::Write;
use std::hint::black_box;

/// Name of the measure.
pub const NAME: &str = "network";

/// Functions in the row, and inputs of the fan.
pub const WIDE: usize = 1000;
/// Messages that eight dial events make in the dial network.
pub const DIAL_MESSAGES: usize = 20;
/// Firings a tick may take: more than any shape needs.
const FIRINGS_MAX: u32 = 10_000;
/// Many and short, so that most are over before anything else gets the processor.
const ROUNDS: usize = 201;
const SECS_A_FRAME: f64 = 1.0 / 60.0;

const DIALS: &str = "
    obj := BEGIN_STRUCTURE
        to_pivot := TRANSLATE BY 1,2,3;
        rotx := ROTATE IN X 0; roty := ROTATE IN Y 0; rotz := ROTATE IN Z 0;
        size := SCALE BY 1;
        from_pivot := TRANSLATE BY -1,-2,-3;
        place := TRANSLATE BY 0,0,0;
        VECTOR_LIST N=2 0,0,0 1,1,1;
    END_STRUCTURE;
    DISPLAY obj;
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

/// One of the three networks, with what drives it.
pub struct Shape {
    machine: Machine,
    dials: u8,
    messages: usize,
    frame: u64,
}

impl Shape {
    /// The dial network.
    pub fn dials() -> anyhow::Result<Self> {
        Self::loaded(DIALS, 8, DIAL_MESSAGES)
    }

    /// [`WIDE`] functions, each connected to the next.
    pub fn chain() -> anyhow::Result<Self> {
        let mut text = String::from("n0 := F:NOP; CONNECT DIALS<1>:<1>n0;\n");
        for at in 1..WIDE {
            let before = at - 1;
            writeln!(text, "n{at} := F:NOP; CONNECT n{before}<1>:<1>n{at};")?;
        }
        let mut shape = Self::loaded(&text, 1, WIDE)?;
        let last = format!("n{}", WIDE - 1);
        anyhow::ensure!(shape.reaches(&last), "the chain's end hears nothing");
        Ok(shape)
    }

    /// One dial connected to [`WIDE`] functions.
    pub fn fan_out() -> anyhow::Result<Self> {
        let mut text = String::new();
        for at in 0..WIDE {
            writeln!(text, "n{at} := F:NOP; CONNECT DIALS<1>:<1>n{at};")?;
        }
        let mut shape = Self::loaded(&text, 1, WIDE)?;
        let last = format!("n{}", WIDE - 1);
        anyhow::ensure!(shape.reaches(&last), "the fan's last input hears nothing");
        Ok(shape)
    }

    fn loaded(text: &str, dials: u8, messages: usize) -> anyhow::Result<Self> {
        let mut machine = Machine::new();
        if let Some(diagnostic) = machine.load(text).first() {
            anyhow::bail!("the measured network does not load: {diagnostic:?}");
        }
        Ok(Self {
            machine,
            dials,
            messages,
            frame: 0,
        })
    }

    /// Messages that one [`Shape::turn`] delivers to inputs.
    pub fn messages(&self) -> usize {
        self.messages
    }

    /// One event of every dial in use, and the network run until it is quiet.
    pub fn turn(&mut self) -> ps300::Ran {
        for dial in 1..=self.dials {
            self.machine.emit("DIALS", dial, 1.0 / 256.0);
        }
        self.frame += 1;
        self.machine
            .tick(self.frame as f64 * SECS_A_FRAME, self.frame, FIRINGS_MAX)
    }

    fn reaches(&mut self, last: &str) -> bool {
        self.machine.watch(last, 1);
        self.turn();
        let heard = self.machine.drain_watched().count() == 1;
        self.machine.unwatch(last, 1);
        heard
    }
}

/// Takes the measure.
pub fn take(tell: &mut Tell<'_>) -> anyhow::Result<()> {
    let mut subjects = [
        subject("dials", Shape::dials()?, 200),
        subject("chain", Shape::chain()?, 8),
        subject("fan-out", Shape::fan_out()?, 8),
    ];
    let taken = repeated(&mut subjects, ROUNDS)?;
    for (subject, taken) in subjects.iter().zip(taken) {
        tell(&Row {
            measure: NAME,
            row: subject.row.clone(),
            subject: subject.name,
            value: taken.median,
            best: taken.most,
            unit: "messages/s",
            limit: None,
            ratio: None,
        });
    }
    Ok(())
}

fn subject(row: &str, mut shape: Shape, turns: usize) -> Subject<'static> {
    let repeat = move || {
        let mut quiet = true;
        let nanos = nanos_per(turns * shape.messages(), || {
            for _ in 0..turns {
                quiet &= matches!(black_box(shape.turn()), ps300::Ran::Quiet { .. });
            }
        });
        anyhow::ensure!(quiet, "the network was not quiet after its events");
        Ok(1e9 / nanos)
    };
    Subject {
        row: row.to_owned(),
        name: "dialrig",
        repeat: Box::new(repeat),
    }
}
