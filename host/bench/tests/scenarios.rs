//! Every scenario in `tests/scenarios` is played on the simulated bench.

use std::path::Path;

use bench::scenario::{RunOptions, Scenario, run};

#[test]
fn every_scenario_passes() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/scenarios");
    let mut paths: Vec<_> = std::fs::read_dir(&folder)
        .expect("the folder")
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "scn"))
        .collect();
    paths.sort();
    assert!(paths.len() >= 10, "{paths:?}");
    let mut failures = Vec::new();
    for path in paths {
        let name = path.file_stem().expect("a name").to_string_lossy().into_owned();
        let text = std::fs::read_to_string(&path).expect("reads");
        let scenario = match Scenario::parse(&name, &folder, &text) {
            Ok(scenario) => scenario,
            Err(errors) => {
                failures.extend(errors.iter().map(|error| format!("{name}.scn:{error}")));
                continue;
            }
        };
        let outcome = run(&scenario, &RunOptions::default());
        let seed = outcome.seed;
        let told = outcome.failures.iter();
        failures
            .extend(told.map(|f| format!("{name}.scn:{}:{}: {} (seed {seed})", f.line, f.column, f.message)));
    }
    assert!(failures.is_empty(), "\n{}\n", failures.join("\n"));
}
