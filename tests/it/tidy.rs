//! House rules that no compiler checks: sizes, names, leftovers, sources of numbers.

use proc_macro2::Span;
use syn::spanned::Spanned;
use syn::visit::{self, Visit};

use crate::source::{SourceFile, files, rust_files};

const OURS: &[&str] = &["device-profiles", "host", "firmware-sim", "ui", "tests"];

/// No file is longer. The best of the field keep theirs far below; a file that needs more is two files.
const FILE_LINES_MAX: usize = 600;
/// The middle file is a concept on two screens.
const FILE_LINES_MEDIAN: usize = 200;
/// One function, one screen.
const FUNCTION_LINES_MAX: usize = 70;

fn all_rust_files() -> Vec<SourceFile> {
    OURS.iter().flat_map(|folder| rust_files(folder)).collect()
}

#[test]
fn files_are_about_one_thing() {
    let mut lengths: Vec<(usize, String)> = all_rust_files()
        .into_iter()
        .map(|f| (f.text.lines().count(), f.path))
        .collect();
    lengths.sort();
    let long: Vec<_> = lengths
        .iter()
        .filter(|(lines, _)| *lines > FILE_LINES_MAX)
        .collect();
    assert!(long.is_empty(), "files over {FILE_LINES_MAX} lines: {long:?}");
    let (median, _) = lengths[lengths.len() / 2];
    assert!(
        median <= FILE_LINES_MEDIAN,
        "the median file has {median} lines, wanted {FILE_LINES_MEDIAN} at most"
    );
}

#[test]
fn functions_fit_a_screen() {
    let mut wrong = Vec::new();
    for file in all_rust_files() {
        let mut lengths = FunctionLengths::default();
        lengths.visit_file(&file.parse());
        for (name, line, lines) in lengths.found {
            if lines > FUNCTION_LINES_MAX {
                wrong.push(format!("{}:{line}: {name} has {lines} lines", file.path));
            }
        }
    }
    assert!(
        wrong.is_empty(),
        "functions over {FUNCTION_LINES_MAX} lines:\n{}",
        wrong.join("\n")
    );
}

#[derive(Default)]
struct FunctionLengths {
    found: Vec<(String, usize, usize)>,
}

impl FunctionLengths {
    fn measure(&mut self, name: &syn::Ident, body: Span) {
        // As clippy counts: what stands between the braces.
        let (first, last) = (body.start().line, body.end().line);
        let lines = (last - first).saturating_sub(1);
        self.found.push((name.to_string(), first, lines));
    }
}

impl<'ast> Visit<'ast> for FunctionLengths {
    fn visit_item_fn(&mut self, item: &'ast syn::ItemFn) {
        self.measure(&item.sig.ident, item.block.span());
        visit::visit_item_fn(self, item);
    }

    fn visit_impl_item_fn(&mut self, item: &'ast syn::ImplItemFn) {
        self.measure(&item.sig.ident, item.block.span());
        visit::visit_impl_item_fn(self, item);
    }
}

#[test]
fn every_file_says_what_it_is() {
    let silent: Vec<String> = all_rust_files()
        .into_iter()
        // A module's own tests, in a file beside it, are what their name says.
        .filter(|f| !f.path.ends_with("/tests.rs"))
        .filter(|f| !f.text.trim_start().starts_with("//!"))
        .map(|f| f.path)
        .collect();
    assert!(
        silent.is_empty(),
        "these do not begin with what they are: {silent:?}"
    );
}

#[test]
fn no_drawers() {
    let drawers = [
        "util", "utils", "helper", "helpers", "common", "misc", "manager", "types",
    ];
    let wrong: Vec<String> = all_rust_files()
        .into_iter()
        .map(|f| f.path)
        .filter(|path| {
            path.split('/')
                .any(|part| drawers.contains(&part.trim_end_matches(".rs")))
        })
        .collect();
    assert!(wrong.is_empty(), "name these after what is in them: {wrong:?}");
}

#[test]
fn no_leftovers() {
    // Written apart so that this file does not find itself.
    let leftovers = [
        concat!("TO", "DO"),
        concat!("FIX", "ME"),
        concat!("to", "do!("),
        concat!("unimpl", "emented!("),
        concat!("dbg", "!("),
        concat!("#[ig", "nore"),
    ];
    let mut wrong = Vec::new();
    for file in all_rust_files()
        .iter()
        .chain(&files("docs", "md"))
        .chain(&files("networks", "ps300"))
    {
        for (index, line) in file.text.lines().enumerate() {
            if leftovers.iter().any(|word| line.contains(word)) {
                wrong.push(format!("{}:{}: {}", file.path, index + 1, line.trim()));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn profiles_name_their_source_and_no_code() {
    let mut wrong = Vec::new();
    for file in files("device-profiles", "toml")
        .iter()
        .filter(|f| !f.path.ends_with("Cargo.toml"))
    {
        if !file.text.contains("source") {
            wrong.push(format!("{}: no source", file.path));
        }
        if file.text.contains("::") {
            wrong.push(format!("{}: names a Rust path", file.path));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
