//! What the pages say is there: crates, files, headings, functions, commands, and text in the network's language.

mod commands;

use crate::source::{SourceFile, files, root, rust_files};
use std::collections::BTreeSet;
use std::path::{Component, Path, PathBuf};

/// Every page of the project.
fn pages() -> Vec<SourceFile> {
    let mut pages = files("docs", "md");
    for name in ["README.md", "CHANGELOG.md"] {
        if let Ok(text) = std::fs::read_to_string(root().join(name)) {
            let path = name.to_owned();
            pages.push(SourceFile { path, text });
        }
    }
    pages
}

/// The lines of a page outside fenced blocks, with their numbers from 1.
fn prose(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let mut fenced = false;
    text.lines().enumerate().filter_map(move |(at, line)| {
        let fence = line.trim_start().starts_with("```");
        fenced ^= fence;
        (!fenced && !fence).then_some((at + 1, line))
    })
}

/// What stands between back quotes in a line.
fn quoted(line: &str) -> impl Iterator<Item = &str> {
    line.split('`').skip(1).step_by(2)
}

/// Fenced blocks of a kind: the line each begins after, and its text.
fn fenced(text: &str, kinds: &[&str]) -> Vec<(usize, String)> {
    let mut blocks: Vec<(usize, String)> = Vec::new();
    let mut inside: Option<bool> = None;
    for (at, line) in text.lines().enumerate() {
        let line = line.trim_start();
        match (line.strip_prefix("```"), inside) {
            (Some(kind), None) => {
                let wanted = kinds.contains(&kind.trim());
                inside = Some(wanted);
                if wanted {
                    blocks.push((at + 1, String::new()));
                }
            }
            (Some(_), Some(_)) => inside = None,
            (None, Some(true)) => {
                if let Some((_, block)) = blocks.last_mut() {
                    block.push_str(line);
                    block.push('\n');
                }
            }
            (None, _) => {}
        }
    }
    blocks
}

/// The page's headings as their anchors: lower case, spaces as hyphens, everything else but letters, digits,
/// hyphens and underlines left out.
fn anchors(text: &str) -> BTreeSet<String> {
    let headings = prose(text).filter_map(|(_, line)| line.strip_prefix('#'));
    headings
        .map(|heading| {
            let heading = heading.trim_start_matches('#').trim().to_lowercase();
            let kept = heading
                .chars()
                .filter(|c| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_'));
            kept.map(|c| if c == ' ' { '-' } else { c }).collect()
        })
        .collect()
}

/// `path` without `.` and `..`.
fn tidied(path: &Path) -> PathBuf {
    let mut out = PathBuf::new();
    for part in path.components() {
        match part {
            Component::ParentDir => {
                out.pop();
            }
            Component::CurDir => {}
            other => out.push(other),
        }
    }
    out
}

#[test]
fn every_crate_is_in_the_architecture() {
    let metadata = cargo_metadata::MetadataCommand::new()
        .manifest_path(root().join("Cargo.toml"))
        .no_deps()
        .other_options(["--offline".to_owned()])
        .exec()
        .expect("cargo describes the workspace");
    let page = std::fs::read_to_string(root().join("docs/ARCHITECTURE.md")).expect("the page is there");
    let named: BTreeSet<&str> = prose(&page).flat_map(|(_, line)| quoted(line)).collect();
    let workspace = metadata.workspace_root.as_std_path();
    let folders: Vec<String> = metadata
        .packages
        .iter()
        .filter_map(|package| {
            let folder = package.manifest_path.parent()?.as_std_path();
            Some(
                folder
                    .strip_prefix(workspace)
                    .ok()?
                    .to_string_lossy()
                    .replace('\\', "/"),
            )
        })
        .collect();
    let missing: Vec<&String> = folders
        .iter()
        .filter(|folder| !named.contains(folder.as_str()))
        .collect();
    assert!(
        missing.is_empty(),
        "docs/ARCHITECTURE.md does not name {missing:?}"
    );
}

#[test]
fn links_lead_somewhere() {
    let mut wrong = Vec::new();
    for page in pages() {
        for (line, text) in prose(&page.text) {
            for link in text.split("](").skip(1).filter_map(|rest| rest.split(')').next()) {
                if let Err(why) = follow(&page, link) {
                    wrong.push(format!("{}:{line}: {link}: {why}", page.path));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

fn follow(page: &SourceFile, link: &str) -> Result<(), String> {
    if link.contains("://") || link.starts_with("mailto:") {
        return Ok(());
    }
    let (path, anchor) = link.split_once('#').unwrap_or((link, ""));
    let folder = Path::new(&page.path).parent().unwrap_or(Path::new(""));
    let target = tidied(&folder.join(path));
    let whole = root().join(&target);
    if !path.is_empty() && !whole.exists() {
        return Err("there is no such file".to_owned());
    }
    if anchor.is_empty() {
        return Ok(());
    }
    let text = if path.is_empty() {
        page.text.clone()
    } else {
        std::fs::read_to_string(whole).map_err(|error| error.to_string())?
    };
    let known = anchors(&text);
    if known.contains(anchor) {
        Ok(())
    } else {
        Err(format!("no such heading; there are {known:?}"))
    }
}

#[test]
fn pages_and_comments_cite_pages_that_there_are() {
    let mut wrong = Vec::new();
    let sources = ["host", "ui", "firmware-sim", "tests", "device-profiles"];
    let all = sources
        .iter()
        .flat_map(|folder| rust_files(folder))
        .chain(pages());
    for file in all {
        for (at, line) in file.text.lines().enumerate() {
            let cited = line.split("docs/").skip(1).filter_map(|rest| {
                let end = rest.find(|c: char| !(c.is_alphanumeric() || "/_-.".contains(c)));
                let path = rest[..end.unwrap_or(rest.len())].trim_end_matches('.');
                let is_page = Path::new(path).extension().is_some_and(|end| end == "md");
                is_page.then(|| format!("docs/{path}"))
            });
            // Only from the root: `../docs` and the documents of others are something else.
            let ours = !line.contains("://") && !line.contains("/docs/");
            wrong.extend(
                cited
                    .filter(|path| ours && !root().join(path).exists())
                    .map(|path| format!("{}:{}: {path}", file.path, at + 1)),
            );
        }
    }
    assert!(
        wrong.is_empty(),
        "these pages are cited and not there:\n{}",
        wrong.join("\n")
    );
}

#[test]
fn files_named_in_pages_are_there() {
    let mut wrong = Vec::new();
    for page in pages() {
        for (line, text) in prose(&page.text) {
            for name in quoted(text) {
                let is_file = [".rs", ".ps300", ".scn", "Cargo.toml"]
                    .iter()
                    .any(|end| name.ends_with(end));
                let plain = name.chars().all(|c| c.is_alphanumeric() || "/_-.".contains(c));
                let ours = [
                    "host/",
                    "ui/",
                    "firmware-sim/",
                    "tests/",
                    "device-profiles/",
                    "networks/",
                    "shows/",
                ];
                if is_file
                    && plain
                    && ours.iter().any(|folder| name.starts_with(folder))
                    && !root().join(name).exists()
                {
                    wrong.push(format!("{}:{line}: {name}", page.path));
                }
            }
        }
    }
    assert!(
        wrong.is_empty(),
        "these files are named and not there:\n{}",
        wrong.join("\n")
    );
}

#[test]
fn functions_named_in_the_architecture_are_there() {
    let page = std::fs::read_to_string(root().join("docs/ARCHITECTURE.md")).expect("the page is there");
    let sources: String = ["host", "ui", "firmware-sim", "device-profiles"]
        .iter()
        .flat_map(|folder| rust_files(folder))
        .map(|file| file.text)
        .collect();
    let mut wrong = Vec::new();
    for (line, text) in prose(&page) {
        for name in quoted(text) {
            let is_path = name.chars().all(|c| c.is_alphanumeric() || ":_".contains(c));
            let Some((_, last)) = name.rsplit_once("::").filter(|_| is_path) else {
                continue;
            };
            let found = ["fn ", "mod ", "struct ", "enum ", "trait ", "type "]
                .iter()
                .any(|kind| sources.contains(&format!("{kind}{last}")))
                || sources.contains(&format!("    {last},"))
                || sources.contains(&format!("    {last}("))
                || sources.contains(&format!("    {last} {{"));
            if !found {
                wrong.push(format!("docs/ARCHITECTURE.md:{line}: {name}"));
            }
        }
    }
    assert!(
        wrong.is_empty(),
        "these are named and not there:\n{}",
        wrong.join("\n")
    );
}

#[test]
fn text_in_the_network_s_language_is_understood() {
    let mut wrong = Vec::new();
    let mut blocks = 0;
    for page in pages() {
        for (line, block) in fenced(&page.text, &["ps300"]) {
            blocks += 1;
            let (_, diagnostics) = ps300::language::parse(&block);
            wrong.extend(diagnostics.iter().map(|diagnostic| {
                let at = line + diagnostic.line as usize;
                format!("{}:{at}: {}", page.path, diagnostic.message)
            }));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(blocks > 0, "no page shows the language");
}
