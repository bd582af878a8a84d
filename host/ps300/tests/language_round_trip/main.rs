//! Printing is the exact inverse of reading, for every command there is.
//!
//! Commands are made from a seed that is printed with a failure: `DIALRIG_SEED=n DIALRIG_CASES=m` runs others.

mod atoms;
mod commands;
mod data;
mod operations;
mod variants;

use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestCaseError, TestRng, TestRunner};
use ps300::language::{Command, Definition, Node, parse, print};

use commands::command;

/// Cases in an ordinary run; a night takes more.
const CASES: u32 = 2000;

fn setting(name: &str, usual: u64) -> u64 {
    std::env::var(name)
        .ok()
        .and_then(|text| text.parse().ok())
        .unwrap_or(usual)
}

/// Runs `test` on what the seed makes.
fn run<S: Strategy>(strategy: &S, test: impl Fn(S::Value) -> Result<(), TestCaseError>)
where
    S::Value: std::fmt::Debug,
{
    let seed = setting("DIALRIG_SEED", 1);
    let cases = setting("DIALRIG_CASES", u64::from(CASES)) as u32;
    let config = Config {
        cases,
        failure_persistence: None,
        ..Config::default()
    };
    let mut bytes = [0; 32];
    bytes[..8].copy_from_slice(&seed.to_le_bytes());
    let mut runner = TestRunner::new_with_rng(config, TestRng::from_seed(RngAlgorithm::ChaCha, &bytes));
    if let Err(failure) = runner.run(strategy, test) {
        panic!("DIALRIG_SEED={seed} DIALRIG_CASES={cases}: {failure}");
    }
}

#[test]
fn what_is_printed_reads_back() {
    run(&command(), |command| {
        let printed = print(&command);
        let (read, diagnostics) = parse(&printed);
        prop_assert!(diagnostics.is_empty(), "{printed}\n{diagnostics:#?}");
        prop_assert_eq!(read.len(), 1, "{}", printed);
        // By debug text as well: it tells -0 from 0 and the case of names, which equality does not.
        prop_assert_eq!(
            format!("{:?}", read[0].what),
            format!("{command:?}"),
            "{}",
            printed
        );
        prop_assert_eq!(&read[0].what, &command);
        prop_assert_eq!(print(&read[0].what), printed);
        Ok(())
    });
}

#[test]
fn programs_read_back_whole() {
    run(&prop::collection::vec(command(), 0..6), |commands| {
        let program: String = commands.iter().map(|command| print(command) + "\n").collect();
        let (read, diagnostics) = parse(&program);
        prop_assert!(diagnostics.is_empty(), "{program}\n{diagnostics:#?}");
        prop_assert_eq!(
            read.into_iter().map(|command| command.what).collect::<Vec<_>>(),
            commands
        );
        Ok(())
    });
}

#[test]
fn any_text_is_read_without_panic() {
    run(&any::<String>(), |source| {
        parse(&source);
        Ok(())
    });
}

/// Commands with a piece cut out of the middle: most of the grammar's ways to fail. What is understood of them
/// prints as something that reads back.
#[test]
fn damaged_commands_spare_what_follows() {
    run(
        &(command(), 0.0..1.0_f64, 1..6_usize),
        |(command, cut, length)| {
            let printed = print(&command);
            let characters: Vec<char> = printed.chars().collect();
            let start = (cut * characters.len() as f64) as usize;
            let end = (start + length).min(characters.len());
            let damaged: String = characters[..start].iter().chain(&characters[end..]).collect();
            let (read, _) = parse(&format!(
                "{damaged}\n;\nEND_FONT;\nEND_STRUCTURE;\nlast := NIL;\n'}} ;\nlast := NIL;"
            ));
            // Damage that opens a comment, quote, font or structure may hide the rest, nothing else may.
            let last = Command::Define {
                name: "last".into(),
                definition: Definition::Node(Node::Nil),
            };
            let seen = read.iter().any(|command| command.what == last);
            prop_assert!(seen || hides(&printed), "{damaged}");
            let again: String = read.iter().map(|command| print(&command.what)).collect();
            let (reread, diagnostics) = parse(&again);
            prop_assert!(
                diagnostics
                    .iter()
                    .all(|said| said.message.starts_with("the name")),
                "{diagnostics:#?}"
            );
            prop_assert_eq!(reread.len(), read.len(), "{}", again);
            Ok(())
        },
    );
}

fn hides(printed: &str) -> bool {
    let lower = printed.to_lowercase();
    printed.contains(['{', '\'']) || lower.contains("begin_s") || lower.contains("begin_f")
}
