//! What must hold for every session.

use super::edits::makes_the_same;
use super::session::{Act, LATE, Play, limits, machine_like};
use ps300::language::Severity;
use ps300::{Machine, Ran};

/// Plays a session and checks all laws.
pub(crate) fn hold(acts: &[Act]) {
    let mut play = played(acts, true);
    let other = played(acts, false);
    assert_eq!(play.heard, other.heard, "budgets show");
    play.heard.check();
    can_be_looked_at(&play.machine);
    its_text_can_be_read(&play.machine);
    if !play.edits.forgetful() {
        it_becomes_any_program(&played(&acts[..acts.len() / 2], true).machine, &play.machine);
    }
    if matches!(play.machine.settle(), Ran::Quiet { .. }) {
        its_text_goes_on(play, acts);
    }
}

fn played(acts: &[Act], as_said: bool) -> Play {
    let mut play = Play::at(0);
    for act in acts {
        play.act(act, as_said);
        queues_are_bounded(&play.machine);
    }
    play.end();
    play
}

fn queues_are_bounded(machine: &Machine) {
    let instances = machine.instances();
    let waiting = || {
        instances
            .iter()
            .flat_map(|it| &it.inputs)
            .map(|input| input.waiting)
    };
    assert!(waiting().all(|waiting| waiting <= limits().queue_max));
    let behind: usize = waiting().map(|waiting| waiting.saturating_sub(1)).sum();
    assert!(
        behind <= limits().behind_max,
        "{behind} messages wait behind others"
    );
}

/// Pictures of every kind can be made of it.
fn can_be_looked_at(machine: &Machine) {
    assert!(machine.dot().starts_with("digraph"));
    machine.display();
    let picture = machine.picture();
    machine.activity(&picture);
}

/// What it is written as is a program without errors.
fn its_text_can_be_read(of: &Machine) {
    let text = of.network_text();
    let mut again = machine_like(of);
    let diagnostics = again.load(&text);
    let errors: Vec<_> = diagnostics
        .iter()
        .filter(|it| it.severity == Severity::Error)
        .collect();
    assert!(errors.is_empty(), "{text}\n--\n{errors:?}");
}

/// While it runs it can be changed into what a program makes.
fn it_becomes_any_program(of: &Machine, into: &Machine) {
    let text = of.network_text_with_state();
    let mut changed = machine_like(if into.is_defined(LATE) { into } else { of });
    changed.load(&text);
    let program: Vec<_> = into.program();
    changed.patch(&program);
    let (now, wanted) = (changed.network_text(), into.network_text());
    assert!(
        makes_the_same(&now, &wanted),
        "from\n{text}\nto\n{wanted}\nis\n{now}"
    );
}

/// At rest and written with its state, it goes on elsewhere as it does here.
fn its_text_goes_on(of: Play, acts: &[Act]) {
    let text = of.machine.network_text_with_state();
    if text.contains("\nFORGET ") {
        // A thing without a name cannot be watched; one that nothing feeds any more is not made again.
        return;
    }
    let mut again = Play::like(&of);
    let diagnostics = again.machine.load(&text);
    let errors: Vec<_> = diagnostics
        .iter()
        .filter(|it| it.severity == Severity::Error)
        .collect();
    assert!(errors.is_empty(), "{text}\n--\n{errors:?}");
    assert_eq!(again.machine.network_text_with_state(), text);
    assert_eq!(again.machine.network_text(), of.machine.network_text());
    let after = |mut play: Play| {
        play.forget();
        play.watch();
        for act in acts.iter().filter(|act| act.is_a_message()) {
            play.act(act, true);
        }
        play.end();
        play.heard
    };
    assert_eq!(after(of), after(again), "{text}");
}
