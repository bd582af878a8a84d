//! What every intrinsic function does, as rows of data, and what holds for all of them.
//!
//! A function without rows for each of its defaults and for what it refuses fails here.

mod dice;
mod memory;
mod record;
mod rows;
mod time;
mod trial;

use dice::Dice;
use ps300::intrinsic::{self, InputSpec, Preset, Spec};
use ps300::language::{Input, literal};
use ps300::{Machine, Value};
use rows::{Row, Rows, Step};
use trial::{alike, run, run_as};

fn example(spec: &Spec) -> Row {
    assert!(!spec.example.is_empty(), "F:{} has no example", spec.name);
    Row::read("example".to_owned(), spec.name, "", spec.example)
}

/// The inputs of the instance a row makes, numbered from 1.
fn inputs(spec: &Spec, size: &str) -> Vec<(u16, InputSpec)> {
    let size = size.trim_matches(['(', ')']).parse().unwrap_or(0);
    (1..).zip(spec.inputs_of(size)).collect()
}

fn rows_of<'a>(rows: &'a Rows, spec: &'a Spec) -> impl Iterator<Item = &'a Row> {
    rows.rows.iter().filter(|row| row.function == spec.name)
}

#[test]
fn functions_do_what_the_rows_say() {
    for row in &Rows::read().rows {
        run(row).check(row, "");
    }
}

#[test]
fn every_function_has_an_example_that_is_true() {
    for spec in intrinsic::table() {
        let row = example(spec);
        run(&row).check(&row, "");
        assert!(
            !row.wanted.is_empty() && row.report.is_empty(),
            "F:{}: an example shows what it does",
            spec.name
        );
    }
}

/// Rows that answer, one where each default is in force, and one that is refused unless it is said that
/// none is.
#[test]
fn every_function_has_its_rows() {
    let rows = Rows::read();
    let mut wrong = Vec::new();
    for spec in intrinsic::table() {
        let answers: Vec<_> = rows_of(&rows, spec)
            .filter(|row| !row.wanted.is_empty())
            .collect();
        if answers.is_empty() {
            wrong.push(format!("F:{} has no row that answers", spec.name));
            continue;
        }
        for (number, input) in inputs(spec, &answers[0].size) {
            let defaults = input.constant && input.preset != Preset::Required;
            if defaults && answers.iter().all(|row| row.feeds(number)) {
                wrong.push(format!(
                    "F:{} has no row with the default of <{number}>",
                    spec.name
                ));
            }
        }
        let refused = rows_of(&rows, spec).any(|row| !row.report.is_empty());
        let total = rows.total.iter().any(|name| name == spec.name);
        if refused == total {
            wrong.push(format!(
                "F:{} has rows that are refused: {refused}, is said to be total: {total}",
                spec.name
            ));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    for row in &rows.rows {
        assert!(
            intrinsic::find(&row.function).is_some(),
            "{}: F:{}",
            row.place,
            row.function
        );
    }
}

#[test]
fn sending_a_default_changes_nothing() {
    for row in &Rows::read().rows {
        let spec = intrinsic::find(&row.function).expect("checked elsewhere");
        for (number, input) in inputs(spec, &row.size) {
            let value = match input.preset {
                Preset::Boolean(b) => Value::from(b),
                Preset::Integer(n) => n.into(),
                Preset::Real(x) => x.into(),
                Preset::Text(text) => text.into(),
                Preset::Required | Preset::Rule(_) => continue,
            };
            if row.feeds(number) {
                continue;
            }
            let mut row = row.clone();
            let literal = literal(&value);
            row.steps.insert(
                0,
                Step::Send {
                    input: number,
                    literal,
                },
            );
            run(&row).check(&row, &format!(" with the default sent to <{number}>"));
        }
    }
}

#[test]
fn without_a_constant_that_has_no_default_nothing_fires() {
    for spec in intrinsic::table() {
        let row = example(spec);
        for (number, input) in inputs(spec, &row.size) {
            if !input.constant || input.preset != Preset::Required {
                continue;
            }
            let mut row = row.clone();
            row.steps
                .retain(|step| !matches!(step, Step::Send { input, .. } if *input == number));
            let sent = run(&row).sent;
            assert!(sent.is_empty(), "F:{} without <{number}>: {sent:?}", spec.name);
        }
    }
}

/// A message of a kind an input does not take is named, dropped, and changes nothing else.
#[test]
fn every_typed_input_refuses_other_kinds_and_goes_on() {
    for spec in intrinsic::table() {
        let row = example(spec);
        for (number, input) in inputs(spec, &row.size) {
            let wrong = [Value::from(true), Value::from("text"), Value::from(7.5)]
                .into_iter()
                .find(|value| !input.kinds.has(value.kind()));
            let Some(wrong) = wrong else { continue };
            let mut row = row.clone();
            let lead = [
                "wrong := F:NOP".to_owned(),
                format!("CONNECT wrong<1>:<{number}>f"),
                format!("SEND {} TO <1>wrong", literal(&wrong)),
            ];
            row.steps.splice(0..0, lead.map(Step::Command));
            row.report = format!("input <{number}> takes {}, got {}", input.kinds, wrong.kind());
            let outcome = run(&row);
            outcome.check(&row, "");
            let named = format!("f (F:{}{}", spec.name, row.size);
            assert!(outcome.reports.starts_with(&named), "{}", outcome.reports);
            let mut machine = Machine::new();
            assert_eq!(machine.load(&format!("f := F:{}{};", spec.name, row.size)), []);
            let refused = machine.send("f", Input::Number(number), wrong);
            assert!(refused.is_err(), "F:{} <{number}>", spec.name);
        }
    }
}

/// The names with C before or behind differ only in which input is constant.
#[test]
fn forms_with_constants_are_their_base_with_a_constant() {
    let rows = Rows::read();
    let mut compared = 0;
    for row in &rows.rows {
        let name = row.function.as_str();
        let behind = name.strip_suffix('C').map(|base| (base, 2));
        let before = name.strip_prefix('C').map(|base| (base, 1));
        for (base, number) in [behind, before].into_iter().flatten() {
            let (Some(base), Some(form)) = (intrinsic::find(base), intrinsic::find(name)) else {
                continue;
            };
            let active = base.inputs.get(number - 1).is_some_and(|input| !input.constant);
            if !active || !form.inputs.get(number - 1).is_some_and(|input| input.constant) {
                continue;
            }
            let mut row = row.clone();
            let setup = format!("SETUP CNESS TRUE <{number}>f");
            row.steps.insert(0, Step::Command(setup));
            run_as(&row, base.name).check(&row, &format!(" as F:{}", base.name));
            compared += 1;
        }
    }
    assert!(compared >= 30, "{compared}");
}

/// Functions said to be total answer or wait, whatever comes.
#[test]
fn total_functions_refuse_nothing() {
    let rows = Rows::read();
    for name in &rows.total {
        let spec = intrinsic::find(name).unwrap_or_else(|| panic!("F:{name}"));
        let row = example(spec);
        for seed in 1..=16 {
            let mut dice = Dice::new(seed);
            let mut machine = Machine::new();
            assert_eq!(machine.load(&format!("f := F:{name}{};", row.size)), []);
            for step in 1..60 {
                for (number, input) in inputs(spec, &row.size) {
                    let value = dice.value(input);
                    machine
                        .send("f", Input::Number(number), value)
                        .expect("of a kind it takes");
                }
                machine.tick(f64::from(step) * 0.05, step as u64 * 3, 1000);
                let reports = machine.reports();
                assert!(reports.is_empty(), "F:{name}: {}", reports[0]);
            }
        }
    }
}

#[test]
fn names_are_unique_and_rows_are_complete() {
    let mut names: Vec<_> = intrinsic::table().map(|spec| spec.name).collect();
    names.extend(intrinsic::ABSENT.iter().map(|absent| absent.name));
    let count = names.len();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), count);
    for spec in intrinsic::table() {
        let said = [spec.behaviour, spec.source].iter().all(|text| !text.is_empty());
        assert!(said && !spec.inputs.is_empty(), "F:{}", spec.name);
    }
    assert!(alike(&1.0.into(), &(1.0 + 1e-15).into()));
}
