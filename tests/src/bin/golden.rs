//! Answers a golden file: `golden IN.json > OUT.json`, or `-` for standard input.
//!
//! The file's format is the golden README's; what a case expects is not looked at and may be missing. Exit 1
//! with the reason when the file cannot be read, is not JSON, or has no cases.

use std::io::{Read, Write};
use std::process::ExitCode;

use anyhow::{Context, bail};
use dialrig_tests::golden;
use serde_json::Value;

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("golden: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn run() -> anyhow::Result<()> {
    let mut arguments = std::env::args().skip(1);
    let (Some(path), None) = (arguments.next(), arguments.next()) else {
        bail!("expected one golden file: golden IN.json > OUT.json");
    };
    let text = read(&path)?;
    let file: Value = serde_json::from_str(&text).map_err(|error| {
        anyhow::anyhow!(
            "{path}:{}:{}: error: expected JSON: {error}",
            error.line(),
            error.column()
        )
    })?;
    let answers = golden::answers(&file).with_context(|| path.clone())?;
    let mut out = std::io::stdout().lock();
    serde_json::to_writer_pretty(&mut out, &answers).context("standard output")?;
    writeln!(out).context("standard output")
}

fn read(path: &str) -> anyhow::Result<String> {
    if path == "-" {
        let mut text = String::new();
        std::io::stdin()
            .read_to_string(&mut text)
            .context("standard input")?;
        return Ok(text);
    }
    std::fs::read_to_string(path).with_context(|| format!("{path}: expected a readable golden file"))
}
