//! The reference page of functions and devices: `docs/ps300/functions.md`.

use std::fmt::Write;

use ps300::intrinsic::{ABSENT, FAMILIES, InputSpec, Preset, Spec, Times};
use ps300::machine::devices::{READOUTS, SOURCES};

const HEAD: &str = "\
# Functions of the network

<!-- Written by `dialrig net functions --markdown`; change the tables in `host/ps300/src/intrinsic`. -->

`name := F:TYPE;` makes an instance, `name := F:TYPE(n);` one of a sized type. It fires when every active input
has a message, and uses up one of each. An input marked *c* is constant: it keeps its latest message, and setting it
fires nothing. After *=* stands what a constant input holds at first; without it the function waits for a value.

How far a row can be trusted: *used*, working programs of the time agree with it; *high*, *medium*, *low*,
recollected, less and less surely; *project*, dialrig's own rule or function. Sources D0 are programs of 1989;
*ours* is what this project decided where nothing is on record. An example ends with what comes out, in braces.
";

const DEVICES: &str = "
## Devices

Every machine has these names; commands connect them and cannot redefine them.

| name | sends | source | confidence |
|---|---|---|---|
";

const READOUTS_HEAD: &str = "
| name | takes | shows |
|---|---|---|
";

const ABSENT_HEAD: &str = "
## Known by name only

These existed and cannot be run.

| function | was for | is absent because |
|---|---|---|
";

/// The whole page.
pub(super) fn page() -> String {
    let mut page = String::from(HEAD);
    for family in FAMILIES {
        let links = family
            .functions()
            .map(|spec| format!("[{0}](#{1})", spec.name, anchor(spec)));
        let links = links.collect::<Vec<_>>().join(", ");
        // Writing to a string cannot fail.
        let _ = writeln!(page, "\n{}: {links}.", family.title);
    }
    for family in FAMILIES {
        let _ = writeln!(page, "\n## {}", family.title);
        family.functions().for_each(|spec| function(&mut page, spec));
    }
    page.push_str(DEVICES);
    for source in &SOURCES {
        row(
            &mut page,
            &[
                source.name,
                source.behaviour,
                source.source,
                source.confidence.name(),
            ],
        );
    }
    page.push_str(READOUTS_HEAD);
    for readout in &READOUTS {
        let name = match readout.numbers {
            Some((first, last)) => format!("{0}{first} … {0}{last}", readout.name),
            None => readout.name.to_owned(),
        };
        let takes = match readout.inputs {
            [kinds] => format!("<1> {kinds}"),
            several => format!("<1> … <{}> {}", several.len(), several[0]),
        };
        row(&mut page, &[&name, &takes, readout.behaviour]);
    }
    page.push_str(ABSENT_HEAD);
    for absent in ABSENT {
        row(&mut page, &[absent.name, absent.purpose, absent.why]);
    }
    page
}

fn row(page: &mut String, cells: &[&str]) {
    let cells: Vec<String> = cells.iter().map(|cell| escaped(cell)).collect();
    // Writing to a string cannot fail.
    let _ = writeln!(page, "| {} |", cells.join(" | "));
}

fn function(page: &mut String, spec: &Spec) {
    // Writing to a string cannot fail, here and below.
    let _ = writeln!(page, "\n### {}\n\n{}\n", heading(spec), escaped(spec.behaviour));
    let mut range = Range::default();
    for input in spec.inputs {
        let number = escaped(&range.next(input.times));
        let _ = writeln!(
            page,
            "- in {number}{} {}{}",
            mark(input),
            input.kinds,
            preset(input)
        );
    }
    let mut range = Range::default();
    for output in spec.outputs {
        let number = escaped(&range.next(output.times));
        let _ = writeln!(page, "- out {number} {}", output.kinds);
    }
    let _ = writeln!(page, "\n{} · {}", spec.confidence.name(), escaped(spec.source));
    let _ = writeln!(page, "\n```ps300\n{}```", example(spec));
}

/// The steps of an example as commands, network time and the messages that come out as comments.
fn example(spec: &Spec) -> String {
    let (steps, messages) = spec.example.split_once(" -> ").unwrap_or((spec.example, ""));
    let sized = steps.strip_prefix('(').and_then(|rest| rest.split_once(") | "));
    let (size, steps) = sized.map_or((String::new(), steps), |(size, rest)| (format!("({size})"), rest));
    let mut text = format!("f := F:{}{size};\n", spec.name);
    for step in steps.split(" | ") {
        let sent = step.strip_prefix('<').and_then(|rest| rest.split_once("> "));
        // Writing to a string cannot fail, here and below.
        let _ = match (sent, step.strip_prefix('@')) {
            (Some((input, value)), _) => writeln!(text, "SEND {value} TO <{input}>f;"),
            (None, Some(secs)) => writeln!(text, "{{ at {secs} s }}"),
            (None, None) => writeln!(text, "{step};"),
        };
    }
    let _ = writeln!(text, "{{ {} }}", messages.replace(" | ", ", "));
    text
}

/// The name, with the sizes of a sized type.
fn heading(spec: &Spec) -> String {
    match spec.sizes {
        Some((least, most)) => format!("{}(n), n from {least} to {most}", spec.name),
        None => spec.name.to_owned(),
    }
}

/// Where a page of Markdown puts a heading: small letters, hyphens for spaces, no other signs.
fn anchor(spec: &Spec) -> String {
    let heading = heading(spec).to_lowercase().replace(' ', "-");
    heading.replace(['(', ')', ','], "")
}

fn mark(input: &InputSpec) -> &'static str {
    if input.constant { " *c*" } else { "" }
}

fn preset(input: &InputSpec) -> String {
    match (input.preset, input.preset.text()) {
        (Preset::Rule(words), _) => format!("; {}", escaped(words)),
        (_, Some(text)) => format!(" = {text}"),
        (_, None) => String::new(),
    }
}

/// Numbers of ports in order: `<1>`, `<2> … <n>`, `<n>`. No row but the last stands behind several.
#[derive(Default)]
struct Range {
    single: usize,
    /// Ports less than the size among those before, once there was a row that stands for several.
    after_sized: Option<usize>,
}

impl Range {
    fn next(&mut self, times: Times) -> String {
        let first = self.single + 1;
        match (times, &mut self.after_sized) {
            (Times::Once, None) => {
                self.single += 1;
                format!("<{first}>")
            }
            (Times::Once, Some(0)) => "<n+1>".to_owned(),
            (Times::Once, Some(_)) => "<n>".to_owned(),
            (Times::Size, after) => {
                *after = Some(0);
                match self.single {
                    0 => "<1> … <n>".to_owned(),
                    before => format!("<{first}> … <n+{before}>"),
                }
            }
            (Times::SizeLessOne, after) => {
                *after = Some(1);
                format!("<{first}> … <n-1>")
            }
        }
    }
}

/// Text that is not taken for HTML or for the bounds of a cell.
fn escaped(text: &str) -> String {
    text.replace('<', "\\<").replace('|', "\\|").replace('*', "\\*")
}
