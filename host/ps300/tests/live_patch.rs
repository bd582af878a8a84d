//! A network is edited a thousand times, back and forth, while dials stream; nothing that was not edited
//! notices, and what is there at the end is what its printed text makes.

use ps300::intrinsic::{self, Confidence};
use ps300::language::{Input, Severity};
use ps300::network::Watched;
use ps300::{Limits, Machine, Ran, Value};

const EDITS: usize = 1000;
const FUNCTIONS: u64 = 18;
const STEADY: usize = 8;

/// Splitmix: the same seed gives the same edits.
struct Dice(u64);

impl Dice {
    fn roll(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let x = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        x ^ (x >> 31)
    }

    fn below(&mut self, end: u64) -> u64 {
        self.roll() % end
    }

    fn pick<'a>(&mut self, from: &[&'a str]) -> &'a str {
        from[self.below(from.len() as u64) as usize]
    }

    fn turn(&mut self) -> f64 {
        (self.below(2001) as f64 - 1000.0) / 256.0
    }
}

/// What nobody edits: each dial into a sum, and the first into a part of the picture.
fn steady() -> String {
    let sums: Vec<String> = (1..=STEADY)
        .map(|k| format!("acc{k} := F:ACCUMULATE; SEND {k} TO <4>acc{k}; CONNECT DIALS<{k}>:<1>acc{k};\n"))
        .collect();
    let picture = "turn := F:XROTATE; CONNECT acc1<1>:<1>turn; rot := ROTATE IN X 0 THEN shape;
        CONNECT turn<1>:<1>rot; shape := VECTOR_LIST N=2 0,0 1,1; DISPLAY rot; dash := PATTERN 1 1 LENGTH 0.1;\n";
    sums.concat() + picture
}

fn limits() -> Limits {
    Limits {
        queue_max: 24,
        firings_per_command: 3000,
        firings_per_batch: 3000,
        firings_per_load: 100_000,
        ..Limits::default()
    }
}

const LITERALS: [&str; 12] = [
    "TRUE",
    "FALSE",
    "FIX(0)",
    "FIX(1)",
    "FIX(2)",
    "0",
    "-1.5",
    "2.25",
    "'text'",
    "V2D(0,1)",
    "V3D(1,2,3)",
    "M3D(1,0,0,0,1,0,0,0,1)",
];
const NODES: [&str; 10] = [
    "SURFACE_RENDERING THEN shape",
    "BSPLINE ORDER=2 N=2 0,0 1,1 CHORDS=4",
    "ROTATE IN Y 30 THEN shape",
    "SCALE BY 2 THEN shape",
    "TRANSLATE BY 1,2,3 THEN rot",
    "SET COLOR 120,1 THEN shape",
    "VECTOR_LIST N=2 0,0 1,1",
    "CHARACTERS 1,1 'abc'",
    "INSTANCE OF rot, shape",
    "NIL",
];
const MEMBERS: [&str; 6] = [
    "x := F:ACCUMULATE;",
    "y := F:DSCALE;",
    "y := F:ADDC;",
    "t := TRANSLATE BY 1,1,1;",
    "c := CHARACTERS 'inside';",
    "r := ROTATE IN Z 10;",
];

/// Any function but those that reach others by name, which could change a sum that the test predicts.
fn function(dice: &mut Dice) -> String {
    let specs: Vec<_> = intrinsic::table()
        .filter(|spec| !["SEND", "FETCH"].contains(&spec.name))
        .filter(|spec| spec.confidence != Confidence::Used || dice.below(2) == 0)
        .collect();
    let remembering: Vec<_> = specs.iter().copied().filter(|spec| spec.remembers()).collect();
    let from = if dice.below(2) == 0 { &specs } else { &remembering };
    let spec = from[dice.below(from.len() as u64) as usize];
    let size = spec.sizes.map_or(String::new(), |(least, most)| {
        format!("({})", (least.max(2) + dice.below(2) as u8).min(most))
    });
    format!("F:{}{size}", spec.name)
}

/// Wires lead from lower to higher, so that nothing goes round for ever; nothing leads to what the test predicts.
fn rank(name: &str) -> Option<u64> {
    if let Some(number) = name.strip_prefix('f') {
        return number.parse().ok().map(|number: u64| number + 1);
    }
    match name {
        "DIALS" | "BUTTONSIN" => Some(0),
        _ if name.starts_with("acc") || ["turn", "rot", "shape", "dash"].contains(&name) => None,
        _ => Some(if name.starts_with('s') {
            FUNCTIONS + 1
        } else if name.starts_with('n') {
            FUNCTIONS + 2
        } else {
            FUNCTIONS + 3
        }),
    }
}

/// A wire between two ends that are there and go together, if there is one among a few tried.
fn wire(dice: &mut Dice, machine: &Machine) -> String {
    let picture = machine.picture();
    let boxes: Vec<_> = picture.boxes.iter().chain(&picture.unwired).collect();
    for _ in 0..60 {
        let from = match dice.below(5) {
            0 => boxes[0],
            _ => boxes[dice.below(boxes.len() as u64) as usize],
        };
        let to = boxes[dice.below(boxes.len() as u64) as usize];
        let below = if from.name.as_str().starts_with("acc") {
            Some(0)
        } else {
            rank(from.name.as_str())
        };
        if from.outputs.is_empty()
            || to.inputs.is_empty()
            || rank(to.name.as_str()) <= below.or(Some(u64::MAX))
        {
            continue;
        }
        let output = &from.outputs[dice.below(from.outputs.len() as u64) as usize];
        let input = &to.inputs[dice.below(to.inputs.len() as u64) as usize];
        if output.kinds.meets(input.kinds) {
            return format!(
                "CONNECT {}<{}>:<{}>{};",
                from.name, output.input, input.input, to.name
            );
        }
    }
    String::new()
}

/// One edit as a person makes it: mostly one command, now and then a few in a group.
fn edit(dice: &mut Dice, machine: &Machine) -> String {
    let f = |dice: &mut Dice| format!("f{}", dice.below(FUNCTIONS));
    let n = |dice: &mut Dice| format!("n{}", dice.below(5));
    match dice.below(33) {
        0..=16 => wire(dice, machine),
        17 => format!("DISCONNECT {}:ALL;", f(dice)),
        18..=20 => format!("{} := {};", f(dice), function(dice)),
        21 => format!("DELETE {};", f(dice)),
        22..=24 => format!(
            "SEND {} TO <{}>{};",
            dice.pick(&LITERALS),
            1 + dice.below(4),
            f(dice)
        ),
        25 => format!(
            "SETUP CNESS {} <{}>{};",
            dice.pick(&["TRUE", "FALSE"]),
            1 + dice.below(3),
            f(dice)
        ),
        26 => format!("{} := {};", n(dice), dice.pick(&NODES)),
        27 => {
            let members: String = (0..dice.below(5)).map(|_| dice.pick(&MEMBERS)).collect();
            format!(
                "s{} := BEGIN_STRUCTURE {members} INSTANCE OF shape; END_STRUCTURE;",
                dice.below(2)
            )
        }
        28 => format!("{} {};", dice.pick(&["DISPLAY", "REMOVE", "DELETE"]), n(dice)),
        29 => format!(
            "{} {} WITH SCALE BY 0.5;",
            dice.pick(&["PREFIX", "FOLLOW"]),
            n(dice)
        ),
        30 => format!("VARIABLE v{}; DELETE s{};", dice.below(2), dice.below(2)),
        31 => format!("PATTERN {} WITH dash;", n(dice)),
        _ => format!(
            "BEGIN\n{}\n{}\n{}\nEND;",
            edit(dice, machine),
            edit(dice, machine),
            edit(dice, machine)
        ),
    }
}

/// The text without what messages have done.
fn topology(text: &str) -> Vec<&str> {
    let said = ["SEND ", "SETUP STATE", "BEGIN;", "END;"];
    text.lines()
        .filter(|line| !said.iter().any(|word| line.starts_with(word)))
        .collect()
}

struct Bench {
    machine: Machine,
    dice: Dice,
    /// What the steady sums must be.
    sums: [f64; STEADY],
    secs: f64,
    ticks: u64,
    /// The network's text before and after each edit.
    past: Vec<[String; 2]>,
    future: Vec<[String; 2]>,
    undone: usize,
}

impl Bench {
    fn new(seed: u64) -> Self {
        let mut machine = Machine::with_limits(limits());
        assert_eq!(machine.load(&steady()), []);
        Self {
            machine,
            dice: Dice(seed),
            sums: [0.0; STEADY],
            secs: 0.0,
            ticks: 0,
            past: Vec::new(),
            future: Vec::new(),
            undone: 0,
        }
    }

    fn stream(&mut self, messages: u64, budget: u32) {
        for _ in 0..messages {
            let dial = self.dice.below(STEADY as u64) as usize;
            let turn = self.dice.turn();
            self.machine.emit("DIALS", dial as u8 + 1, turn);
            self.sums[dial] += turn * (dial as f64 + 1.0);
        }
        self.tick(budget);
    }

    fn tick(&mut self, budget: u32) -> Ran {
        self.secs += 0.01;
        self.ticks += 1;
        self.machine.tick(self.secs, (self.secs * 60.0) as u64, budget)
    }

    fn step(&mut self) {
        let (messages, budget) = (self.dice.below(5), self.dice.below(12) as u32);
        self.stream(messages, budget);
        match self.dice.below(10) {
            0..=2 => self.undo(),
            3..=4 => self.redo(),
            _ => self.edit(),
        }
    }

    fn edit(&mut self) {
        let text = edit(&mut self.dice, &self.machine);
        let before = self.machine.network_text_with_state();
        if self.dice.below(4) == 0 {
            // As whoever edits the whole text does it.
            let all = format!("{before}{text}\n");
            self.machine.edit_program(&before, &all);
        } else {
            self.machine.load(&text);
        }
        let after = self.machine.network_text_with_state();
        self.past.push([before, after]);
        self.future.clear();
    }

    fn undo(&mut self) {
        if let Some([before, after]) = self.past.pop() {
            self.machine.restore(&after, &before);
            self.undone += 1;
            assert_eq!(topology(&self.machine.network_text()), topology(&before));
            self.future.push([before, after]);
        }
    }

    fn redo(&mut self) {
        if let Some([before, after]) = self.future.pop() {
            self.machine.restore(&before, &after);
            assert_eq!(topology(&self.machine.network_text()), topology(&after));
            self.past.push([before, after]);
        }
    }

    /// An edit that sends nothing, taken back before anything else happens, leaves no trace.
    fn edit_and_undo(&mut self) {
        self.rest();
        let text = edit(&mut self.dice, &self.machine);
        if text.contains("SEND") || text.contains("CNESS") {
            return;
        }
        let before = self.machine.network_text_with_state();
        self.machine.load(&text);
        let after = self.machine.network_text_with_state();
        self.machine.restore(&after, &before);
        assert_eq!(self.machine.network_text_with_state(), before, "{text}");
    }

    /// Runs until nothing is left to do.
    fn rest(&mut self) {
        for _ in 0..100 {
            if matches!(self.tick(10_000), Ran::Quiet { .. }) {
                return;
            }
        }
        panic!("wires lead upwards only, so the network comes to rest");
    }

    fn check_sums(&self) {
        for (dial, sum) in self.sums.iter().enumerate() {
            let remembered = self.machine.remembered(&format!("acc{}", dial + 1));
            let held = remembered.first().map_or(&Value::Real(0.0), |value| value);
            assert_eq!(held, &Value::Real(*sum), "the sum of dial {}", dial + 1);
        }
    }

    /// A machine made of this one's text, at the same time.
    fn reloaded(&self) -> Machine {
        let mut again = Machine::with_limits(limits());
        for _ in 0..self.ticks {
            again.tick(self.secs, (self.secs * 60.0) as u64, 0);
        }
        let text = self.machine.network_text_with_state();
        let found = again.load(&text);
        let errors = found.iter().filter(|it| it.severity == Severity::Error).count();
        assert_eq!(errors, 0, "{found:?}\n{text}");
        again
    }
}

fn watch_everything(machine: &mut Machine) {
    let outputs: Vec<_> = machine
        .instances()
        .iter()
        .map(|it| (it.name.to_string(), it.outputs.len() as u8))
        .collect();
    for (name, count) in outputs {
        for output in 1..=count {
            machine.watch(&name, output);
        }
    }
    machine.drain_watched().count();
}

/// The same tokens into a machine at the same moments; what came out.
fn answer(machine: &mut Machine, from_secs: f64, seed: u64) -> Vec<Watched> {
    watch_everything(machine);
    let mut dice = Dice(seed);
    let mut heard = Vec::new();
    for step in 1..=200 {
        match dice.below(3) {
            0 => {
                let name = format!("f{}", dice.below(FUNCTIONS));
                let input = Input::Number(1 + dice.below(3) as u16);
                let _ = machine.send(&name, input, dice.turn());
            }
            _ => {
                machine.emit("DIALS", 1 + dice.below(8) as u8, dice.turn());
            }
        }
        let secs = from_secs + f64::from(step) * 0.01;
        while matches!(
            machine.tick(secs, (secs * 60.0) as u64, 10_000),
            Ran::OutOfBudget { .. }
        ) {}
        heard.extend(machine.drain_watched());
    }
    heard
}

fn run(seed: u64, edits: usize) -> Bench {
    let mut bench = Bench::new(seed);
    for step in 0..edits {
        bench.step();
        if step % 5 == 0 {
            bench.edit_and_undo();
        }
        if step % 50 == 0 {
            bench.rest();
            bench.check_sums();
        }
    }
    bench.rest();
    bench.check_sums();
    bench
}

#[test]
fn a_thousand_edits_and_undos_while_dials_stream() {
    for seed in [1, 2, 3] {
        let mut bench = run(seed, EDITS);
        assert!(bench.undone > EDITS / 8, "{} undone", bench.undone);
        let mut again = bench.reloaded();
        let text = bench.machine.network_text_with_state();
        assert_eq!(again.network_text_with_state(), text, "seed {seed}");
        assert_eq!(again.display(), bench.machine.display(), "seed {seed}");
        let (one, other) = (bench.machine.picture(), again.picture());
        assert_eq!((one.boxes, one.wires), (other.boxes, other.wires), "seed {seed}");
        let heard = answer(&mut bench.machine, bench.secs, seed);
        let again_heard = answer(&mut again, bench.secs, seed);
        assert!(heard.len() > 200, "{} messages", heard.len());
        assert_eq!(heard, again_heard, "seed {seed}");
        assert_eq!(
            again.network_text_with_state(),
            bench.machine.network_text_with_state()
        );
    }
}
