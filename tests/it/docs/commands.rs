//! Commands that pages show exist: those of `dialrig`, as its source lists them, and those of cargo, as far as they
//! name packages, programs and examples of this workspace.

use super::{fenced, pages, prose, quoted};
use crate::source::{root, rust_files};
use std::collections::{BTreeMap, BTreeSet};

/// What may follow `dialrig`, and what may follow each of those: empty where a command has no commands of its own.
/// Read from the enums that clap makes commands of.
fn known() -> BTreeMap<String, BTreeSet<String>> {
    let folder = "host/cli/src/command/";
    let mut all: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for file in rust_files("host/cli/src/command") {
        let Some(place) = file
            .path
            .strip_prefix(folder)
            .and_then(|path| path.strip_suffix("mod.rs"))
        else {
            continue;
        };
        let names = subcommands(&file.parse());
        match place.trim_end_matches('/') {
            "" => names.into_iter().for_each(|name| {
                all.entry(name).or_default();
            }),
            parent => all.entry(parent.replace('_', "-")).or_default().extend(names),
        }
    }
    all
}

/// The variants of the enum that is derived from `Subcommand`, as they are typed.
fn subcommands(file: &syn::File) -> Vec<String> {
    let enums = file.items.iter().filter_map(|item| match item {
        syn::Item::Enum(item) => Some(item),
        _ => None,
    });
    let derived = enums.filter(|item| {
        item.attrs.iter().any(|attr| {
            let mut found = false;
            if attr.path().is_ident("derive") {
                // What is not a list of names is not a derive.
                let _ = attr.parse_nested_meta(|meta| {
                    found |= meta.path.is_ident("Subcommand");
                    Ok(())
                });
            }
            found
        })
    });
    derived
        .flat_map(|item| {
            item.variants
                .iter()
                .map(|variant| typed(&variant.ident.to_string()))
        })
        .collect()
}

/// `ServoBus` as `servo-bus`.
fn typed(variant: &str) -> String {
    let mut out = String::new();
    for letter in variant.chars() {
        if letter.is_uppercase() && !out.is_empty() {
            out.push('-');
        }
        out.extend(letter.to_lowercase());
    }
    out
}

/// A word that can be a command: lower case and hyphens.
fn is_word(word: &str) -> bool {
    !word.is_empty() && word.chars().all(|c| c.is_ascii_lowercase() || c == '-') && !word.starts_with('-')
}

/// What is wrong with a line of a shell, if anything.
fn judge(line: &str, known: &BTreeMap<String, BTreeSet<String>>) -> Option<String> {
    let line = line
        .trim()
        .trim_start_matches("$ ")
        .split(" #")
        .next()
        .unwrap_or_default();
    let words: Vec<&str> = line.split_whitespace().collect();
    match words.first().copied() {
        Some("dialrig") => dialrig(&words[1..], known),
        Some("cargo") => cargo(&words[1..], known),
        _ => None,
    }
}

fn dialrig(words: &[&str], known: &BTreeMap<String, BTreeSet<String>>) -> Option<String> {
    let first = words.first().filter(|word| is_word(word))?;
    // A folder or file that is there is a show.
    if root().join(first).exists() && !known.contains_key(*first) {
        return None;
    }
    let Some(below) = known.get(*first) else {
        return Some(format!("dialrig has no command {first}"));
    };
    let second = words.get(1).filter(|word| is_word(word))?;
    (!below.is_empty() && !below.contains(*second))
        .then(|| format!("dialrig {first} has no command {second}"))
}

fn cargo(words: &[&str], known: &BTreeMap<String, BTreeSet<String>>) -> Option<String> {
    let after = |option: &str| {
        let at = words.iter().position(|word| *word == option)?;
        words.get(at + 1).copied()
    };
    let package = after("-p").or(after("--package"));
    let (given, behind) = match words.iter().position(|word| *word == "--") {
        Some(at) => (&words[..at], &words[at + 1..]),
        None => (words, &[][..]),
    };
    let metadata = cargo_metadata::MetadataCommand::new()
        .manifest_path(root().join("Cargo.toml"))
        .no_deps()
        .other_options(["--offline".to_owned()])
        .exec()
        .expect("cargo describes the workspace");
    if let Some(package) = package {
        let Some(package) = metadata
            .packages
            .iter()
            .find(|known| known.name.as_str() == package)
        else {
            return Some(format!("there is no package {package}"));
        };
        for kind in ["--bin", "--example", "--test", "--bench"] {
            let missing =
                after(kind).filter(|name| !package.targets.iter().any(|target| target.name == **name));
            if let Some(name) = missing {
                return Some(format!("{} has no {} {name}", package.name, &kind[2..]));
            }
        }
        return None;
    }
    // `cargo run` without a package is the one binary.
    (given.first() == Some(&"run"))
        .then(|| dialrig(behind, known))
        .flatten()
}

#[test]
fn commands_in_pages_exist() {
    let known = known();
    assert!(
        known.contains_key("demo") && known["net"].contains("run"),
        "{known:?}"
    );
    let mut wrong = Vec::new();
    let mut judged = 0;
    for page in pages() {
        let blocks = fenced(&page.text, &["sh", "console", "bash"]);
        let fenced = blocks.iter().flat_map(|(line, block)| {
            block
                .lines()
                .enumerate()
                .map(move |(at, text)| (line + at + 1, text.to_owned()))
        });
        let inline =
            prose(&page.text).flat_map(|(line, text)| quoted(text).map(move |text| (line, text.to_owned())));
        for (line, text) in fenced.chain(inline) {
            judged += usize::from(text.trim_start().starts_with("dialrig ") || text.starts_with("cargo "));
            if let Some(why) = judge(&text, &known) {
                wrong.push(format!("{}:{line}: {why}", page.path));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(judged > 10, "only {judged} commands in all pages");
}

#[test]
fn commands_are_told_from_what_only_looks_like_one() {
    let known = known();
    for good in [
        "dialrig",
        "dialrig --help",
        "dialrig shows/salute",
        "dialrig net run networks/figure.ps300",
        "cargo run --release -- demo     # the whole chain",
        "cargo run -q -p dialrig-tests --bin golden -- IN.json",
        "cargo test --workspace",
        "ls dialrig",
    ] {
        assert_eq!(judge(good, &known), None, "{good}");
    }
    for bad in [
        "dialrig levitate",
        "$ dialrig net levitate",
        "cargo run -- levitate",
        "cargo run -p nowhere",
        "cargo run -p dialrig-tests --bin levitate",
    ] {
        assert!(judge(bad, &known).is_some(), "{bad}");
    }
}
