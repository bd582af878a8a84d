//! Outcomes as JUnit XML, which continuous integration systems read: one test case a scenario.
//!
//! Source: the de-facto schema of Apache Ant's JUnit task (`testsuites`, `testsuite`, `testcase`, `failure`,
//! `properties`).

use std::fmt::Write;

use super::Outcome;

/// The outcomes as one file.
pub fn junit(outcomes: &[Outcome]) -> String {
    let failed = outcomes.iter().filter(|outcome| !outcome.passed()).count();
    let secs: f64 = outcomes.iter().map(|outcome| outcome.secs).sum();
    let mut xml = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n");
    // Writing to a string cannot fail.
    let _ = writeln!(
        xml,
        "  <testsuite name=\"scenarios\" tests=\"{}\" failures=\"{failed}\" errors=\"0\" time=\"{secs:.3}\">",
        outcomes.len()
    );
    for outcome in outcomes {
        case(&mut xml, outcome);
    }
    xml.push_str("  </testsuite>\n</testsuites>\n");
    xml
}

fn case(xml: &mut String, outcome: &Outcome) {
    let name = escaped(&outcome.name);
    let _ = writeln!(
        xml,
        "    <testcase classname=\"scenarios\" name=\"{name}\" time=\"{:.3}\">",
        outcome.secs
    );
    let _ = writeln!(
        xml,
        "      <properties><property name=\"seed\" value=\"{}\"/></properties>",
        outcome.seed
    );
    if let Some(first) = outcome.failures.first() {
        let _ = writeln!(xml, "      <failure message=\"{}\">", escaped(&first.message));
        for failure in &outcome.failures {
            let place = format!("{}.scn:{}:{}", outcome.name, failure.line, failure.column);
            let _ = writeln!(xml, "{}: {}", escaped(&place), escaped(&failure.message));
        }
        xml.push_str("      </failure>\n");
    }
    xml.push_str("    </testcase>\n");
}

/// Text that may stand in attributes and elements; control characters, which XML 1.0 has no way to say, go.
fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\n' | '\t' => escaped.push(' '),
            _ if letter.is_control() => {}
            _ => escaped.push(letter),
        }
    }
    escaped
}
