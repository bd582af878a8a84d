//! The table of forms: `docs/ps300/language.md` says what it says, fuzzing begins with its examples (`UPDATE_PAGES=1`
//! writes the page's second half and the seeds anew), its capitals are what the parser takes, its examples run.

use std::collections::BTreeSet;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

use ps300::Machine;
use ps300::language::{FORMS, Form, KEYWORDS, parse, print};

/// Everything before this line of the page is written by hand.
const MARK: &str = "<!-- From here on written by `UPDATE_PAGES=1 cargo test -p ps300 --test language_page`; change the \
                    tables in `host/ps300/src/language/forms`. -->\n";

const HEAD: &str = "
## Reference

Capitals are the least that must be written of a keyword; `[ ]` may be left out, `/` separates choices, `…` goes on in
the same way. How far a form can be trusted: *used*, *high*, *medium*, *low* as for functions; *project*, ours.
";

fn forms() -> impl Iterator<Item = &'static Form> {
    FORMS.iter().flat_map(|section| section.forms)
}

fn reference() -> String {
    let mut page = String::from(HEAD);
    for section in FORMS {
        // Writing to a string cannot fail, here and below.
        let _ = write!(page, "\n### {}\n", section.title);
        for form in section.forms {
            let written = form.form.replace('\n', "` `");
            let _ = write!(
                page,
                "\n#### {}\n\n`{written}`\n\n{}\n",
                form.keyword, form.meaning
            );
            let _ = write!(page, "\n```ps300\n{}\n```\n", form.example);
            let _ = write!(page, "\n{} · {}\n", form.confidence.name(), form.source);
        }
    }
    page
}

fn place() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/ps300/language.md")
}

#[test]
fn the_page_is_the_table() {
    let found = fs::read_to_string(place()).expect("docs/ps300/language.md");
    let found = found.replace("\r\n", "\n");
    let (by_hand, _) = found
        .split_once(MARK)
        .expect("the page says where the reference begins");
    let wanted = format!("{by_hand}{MARK}{}", reference());
    if std::env::var_os("UPDATE_PAGES").is_some_and(|set| set == "1") {
        fs::write(place(), &wanted).expect("docs/ can be written");
        return;
    }
    assert!(
        found == wanted,
        "docs/ps300/language.md is not what the forms say; \
         write it with: UPDATE_PAGES=1 cargo test -p ps300 --test language_page"
    );
}

/// What fuzzing begins with: a file for each section, and the words.
fn fuzzing() -> Vec<(String, String)> {
    let mut files = Vec::new();
    for section in FORMS {
        let name = section.title.to_lowercase().replace(' ', "_");
        let examples: Vec<_> = section.forms.iter().map(|form| form.example).collect();
        files.push((format!("seeds/parser/{name}.ps300"), examples.join("\n\n") + "\n"));
    }
    let mut words = String::new();
    for (full, _) in KEYWORDS {
        let _ = writeln!(words, "\"{full}\"");
    }
    files.push(("parser.dict".to_owned(), words));
    files
}

#[test]
fn fuzzing_begins_with_every_example_and_word() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz");
    for (name, wanted) in fuzzing() {
        if std::env::var_os("UPDATE_PAGES").is_some_and(|set| set == "1") {
            fs::write(folder.join(&name), &wanted).expect("fuzz/ can be written");
        }
        let found = fs::read_to_string(folder.join(&name))
            .unwrap_or_default()
            .replace("\r\n", "\n");
        assert!(
            found == wanted,
            "fuzz/{name} is not what the forms say; \
             write it with: UPDATE_PAGES=1 cargo test -p ps300 --test language_page"
        );
    }
}

#[test]
fn every_example_is_read_printed_and_executed() {
    for form in forms() {
        let (commands, diagnostics) = parse(form.example);
        assert!(diagnostics.is_empty(), "{}: {diagnostics:#?}", form.keyword);
        let printed: String = commands
            .iter()
            .map(|located| print(&located.what) + "\n")
            .collect();
        let (again, diagnostics) = parse(&printed);
        assert!(diagnostics.is_empty(), "{printed}\n{diagnostics:#?}");
        assert!(
            commands
                .iter()
                .map(|located| &located.what)
                .eq(again.iter().map(|located| &located.what)),
            "{printed}"
        );
        let mut machine = Machine::new();
        let diagnostics = machine.load(form.example);
        assert!(diagnostics.is_empty(), "{}: {diagnostics:#?}", form.keyword);
        let reports = machine.reports();
        assert!(reports.is_empty(), "{}: {reports:#?}", form.keyword);
        let text = machine.network_text();
        let mut second = Machine::new();
        let diagnostics = second.load(&text);
        assert!(
            diagnostics.is_empty(),
            "{}\n{text}\n{diagnostics:#?}",
            form.keyword
        );
        assert_eq!(second.network_text(), text, "{}", form.keyword);
    }
}

/// The words of a form that are written in capitals, at least at their beginning.
fn capital_words(form: &str) -> impl Iterator<Item = &str> {
    form.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_'))
        .filter(|word| word.starts_with(|c: char| c.is_ascii_uppercase()))
}

#[test]
fn capitals_are_the_least_the_parser_takes() {
    let mut shown = BTreeSet::new();
    for form in forms() {
        for word in capital_words(form.form) {
            let known = KEYWORDS.iter().find(|(full, _)| full.eq_ignore_ascii_case(word));
            let Some((full, least)) = known else {
                panic!("{word} in {} is no keyword", form.form);
            };
            let capitals = word.find(|c: char| c.is_ascii_lowercase()).unwrap_or(word.len());
            let capitals = word[..capitals].trim_end_matches('_').len();
            assert_eq!(capitals, *least, "{word} in {}", form.form);
            shown.insert(*full);
        }
    }
    // These stand in values, which the page explains before the table.
    let elsewhere = ["FIX", "CHAR", "V2D", "V3D", "V4D", "M2D", "M3D", "M4D", "M4X3"];
    let hidden: Vec<_> = KEYWORDS
        .iter()
        .map(|(full, _)| *full)
        .filter(|full| !shown.contains(full) && !elsewhere.contains(full))
        .collect();
    assert!(hidden.is_empty(), "no form shows {hidden:?}");
}

/// Every keyword, at every length that is enough, in every example that has it.
#[test]
fn shortened_keywords_mean_the_same() {
    let mut seen = BTreeSet::new();
    for form in forms() {
        let (commands, _) = parse(form.example);
        let canonical: Vec<_> = commands.iter().map(|located| print(&located.what)).collect();
        let text = canonical.join("\n");
        for (full, least) in KEYWORDS {
            if !words(&text).any(|word| word == *full) {
                continue;
            }
            seen.insert(*full);
            for length in *least..full.len() {
                let short = with_word_cut(&text, full, length);
                let (read, diagnostics) = parse(&short);
                assert!(diagnostics.is_empty(), "{short}\n{diagnostics:#?}");
                let printed: Vec<_> = read.iter().map(|located| print(&located.what)).collect();
                assert_eq!(printed, canonical, "{short}");
            }
        }
    }
    let shortened = KEYWORDS.iter().filter(|(full, least)| *least < full.len());
    let missing: Vec<_> = shortened
        .map(|(full, _)| *full)
        .filter(|full| !seen.contains(full))
        .collect();
    assert!(missing.is_empty(), "no example shows {missing:?}");
}

fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_'))
}

/// The text with this word cut to so many letters wherever it stands as a whole.
fn with_word_cut(text: &str, full: &str, length: usize) -> String {
    let mut cut = String::new();
    for piece in text.split_inclusive(|c: char| !(c.is_ascii_alphanumeric() || c == '_')) {
        match piece.strip_prefix(full) {
            Some(rest) if rest.len() <= 1 => {
                cut.push_str(&full[..length]);
                cut.push_str(rest);
            }
            _ => cut.push_str(piece),
        }
    }
    cut
}
