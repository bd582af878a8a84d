//! `dialrig net functions`: the reference table, from the rows the network itself runs by.

use ps300::intrinsic::{self, ABSENT, Absent, FAMILIES, Family, InputSpec, OutputSpec, Preset, Spec, Times};
use ps300::value::Kinds;
use serde::Serialize;

use super::markdown;
use crate::console::Console;
use crate::failure::{Exit, Failure};
use crate::table::{Side, Table};

const EXAMPLES: &str = "\
Examples:
  dialrig net functions
  dialrig net functions ROUTE SYNC
  dialrig net functions --json | jq -r 'select(.absent | not) | .name'";

/// The reference table of functions
///
/// What `name := F:TYPE;` can make: inputs, outputs, behaviour, and where that is known from.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct Args {
    /// These functions only, with or without `F:`
    #[arg(value_name = "NAME")]
    names: Vec<String>,
    /// The page docs/ps300/functions.md
    #[arg(long, hide = true)]
    markdown: bool,
}

#[derive(Serialize)]
struct FunctionRecord {
    name: &'static str,
    /// The heading it stands under in the reference; of today's functions "Functions of today".
    #[serde(skip_serializing_if = "str::is_empty")]
    family: &'static str,
    inputs: Vec<InputRecord>,
    outputs: Vec<OutputRecord>,
    behaviour: &'static str,
    source: &'static str,
    confidence: &'static str,
    /// What goes in and what comes out.
    #[serde(skip_serializing_if = "str::is_empty")]
    example: &'static str,
    /// Least and greatest size of a sized type.
    #[serde(skip_serializing_if = "Option::is_none")]
    sizes: Option<(u8, u8)>,
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    absent: bool,
    /// Why it is absent.
    #[serde(skip_serializing_if = "str::is_empty")]
    why: &'static str,
}

#[derive(Serialize)]
struct InputRecord {
    /// From 1. A row with `times` stands for several and counts as one, since how many is the instance's affair.
    number: usize,
    kinds: Vec<&'static str>,
    constant: bool,
    default: serde_json::Value,
    #[serde(skip_serializing_if = "Option::is_none")]
    times: Option<&'static str>,
}

#[derive(Serialize)]
struct OutputRecord {
    number: usize,
    kinds: Vec<&'static str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    times: Option<&'static str>,
}

pub(super) fn run(args: &Args, console: &Console) -> Result<Exit, Failure> {
    if args.markdown {
        console.line(markdown::page().trim_end())?;
        return Ok(Exit::Done);
    }
    let wanted: Vec<&str> = args.names.iter().map(|name| bare(name)).collect();
    for name in &wanted {
        let known = intrinsic::find(name).is_some()
            || ABSENT.iter().any(|absent| absent.name.eq_ignore_ascii_case(name));
        if !known {
            let failure = Failure::refused(format!("there is no function F:{name}"));
            return Err(failure.with_hint("`dialrig net functions` lists all"));
        }
    }
    let is_wanted =
        |name: &str| wanted.is_empty() || wanted.iter().any(|wanted| wanted.eq_ignore_ascii_case(name));
    let rows: Vec<&Spec> = intrinsic::table().filter(|spec| is_wanted(spec.name)).collect();
    let absent: Vec<&Absent> = ABSENT.iter().filter(|absent| is_wanted(absent.name)).collect();
    if console.json() {
        rows.iter().try_for_each(|spec| console.record(&record(spec)))?;
        absent
            .iter()
            .try_for_each(|absent| console.record(&absent_record(absent)))?;
    } else {
        console.table(&table(&rows, &absent))?;
    }
    Ok(Exit::Done)
}

/// The name without `F:`.
fn bare(name: &str) -> &str {
    match name.get(..2) {
        Some(prefix) if prefix.eq_ignore_ascii_case("F:") => &name[2..],
        _ => name,
    }
}

fn record(spec: &Spec) -> FunctionRecord {
    FunctionRecord {
        name: spec.name,
        family: family(spec),
        inputs: (1..).zip(spec.inputs).map(input_record).collect(),
        outputs: (1..).zip(spec.outputs).map(output_record).collect(),
        behaviour: spec.behaviour,
        source: spec.source,
        confidence: spec.confidence.name(),
        example: spec.example,
        sizes: spec.sizes,
        absent: false,
        why: "",
    }
}

fn family(spec: &Spec) -> &'static str {
    let holds = |family: &&Family| family.functions().any(|other| other.name == spec.name);
    FAMILIES.iter().find(holds).map_or("", |family| family.title)
}

fn input_record((number, input): (usize, &InputSpec)) -> InputRecord {
    InputRecord {
        number,
        kinds: kinds(input.kinds),
        constant: input.constant,
        default: match input.preset {
            Preset::Required => serde_json::Value::Null,
            Preset::Boolean(b) => b.into(),
            Preset::Integer(n) => n.into(),
            Preset::Real(x) => x.into(),
            Preset::Text(text) => text.into(),
            Preset::Rule(words) => words.into(),
        },
        times: times(input.times),
    }
}

fn output_record((number, output): (usize, &OutputSpec)) -> OutputRecord {
    OutputRecord {
        number,
        kinds: kinds(output.kinds),
        times: times(output.times),
    }
}

fn absent_record(absent: &Absent) -> FunctionRecord {
    FunctionRecord {
        name: absent.name,
        family: "",
        inputs: Vec::new(),
        outputs: Vec::new(),
        behaviour: absent.purpose,
        source: "recollected by name",
        confidence: "low",
        example: "",
        sizes: None,
        absent: true,
        why: absent.why,
    }
}

fn kinds(kinds: Kinds) -> Vec<&'static str> {
    kinds.iter().map(ps300::Kind::name).collect()
}

fn times(times: Times) -> Option<&'static str> {
    match times {
        Times::Once => None,
        Times::Size => Some("size"),
        Times::SizeLessOne => Some("size-1"),
    }
}

fn table(rows: &[&Spec], absent: &[&Absent]) -> Table {
    let mut table = Table::new(&[
        ("function", Side::Left),
        ("in", Side::Right),
        ("out", Side::Right),
        ("confidence", Side::Left),
        ("behaviour", Side::Left),
    ]);
    for spec in rows {
        table.row(vec![
            spec.name.to_owned(),
            ports(spec.inputs.iter().map(|input| input.times)),
            ports(spec.outputs.iter().map(|output| output.times)),
            spec.confidence.name().to_owned(),
            spec.behaviour.to_owned(),
        ]);
    }
    for absent in absent {
        table.row(vec![
            absent.name.to_owned(),
            "-".to_owned(),
            "-".to_owned(),
            "absent".to_owned(),
            format!("Absent ({}): {}.", absent.why, absent.purpose),
        ]);
    }
    table
}

/// How many ports: `3`, `n`, `n+1`.
fn ports(rows: impl Iterator<Item = Times>) -> String {
    let (mut single, mut sized) = (0_i32, false);
    for times in rows {
        match times {
            Times::Once => single += 1,
            Times::Size => sized = true,
            Times::SizeLessOne => {
                sized = true;
                single -= 1;
            }
        }
    }
    match (sized, single) {
        (false, count) => count.to_string(),
        (true, 0) => "n".to_owned(),
        (true, more) => format!("n{more:+}"),
    }
}
