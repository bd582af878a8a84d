//! The show's networks as one text, for editing as a whole, and back into files.
//!
//! Each file stands under a comment line with its path in the show's folder; a show with one network file and no
//! patches is that file as it is.

use std::sync::Arc;

use super::show::{NetworkFile, Show, is_file_name};
use super::show_file::PATCHES;

/// Name of the network a show without one gets.
const FIRST: &str = "network";

impl Show {
    /// All network text, in the order it is executed.
    pub fn program_text(&self) -> String {
        if let ([file], true) = (self.networks.as_slice(), self.patches.is_empty()) {
            return file.text.clone();
        }
        let mut text = String::new();
        let mut section = |path: &str, part: &str| {
            text.push_str(&heading(path));
            text.push('\n');
            text.push_str(part);
            if !part.is_empty() && !part.ends_with('\n') {
                text.push('\n');
            }
        };
        for file in &self.networks {
            section(&path_of(&file.name), &file.text);
        }
        if !self.patches.is_empty() {
            section(PATCHES, &self.patches);
        }
        text
    }

    /// The show with such a text in place of its networks. What stands before the first heading, or all of a
    /// text without, belongs to the first network; a file whose heading is gone is dropped.
    #[must_use]
    pub fn with_program(&self, text: &str) -> Self {
        let first = self.networks.first().map_or(FIRST, |file| file.name.as_str());
        let mut networks: Vec<(String, String)> = Vec::new();
        let mut patches = String::new();
        let mut place = Place::Network(first.to_owned());
        for line in text.split_inclusive('\n') {
            if let Some(found) = heading_in(line) {
                if let Place::Network(name) = &found {
                    part(&mut networks, name);
                }
                place = found;
                continue;
            }
            match &place {
                Place::Network(name) => part(&mut networks, name).push_str(line),
                Place::Patches => patches.push_str(line),
            }
        }
        let same = |name: &str, text: &str| {
            let mut files = self.networks.iter();
            files.find(|file| file.name == name && file.text.trim_end() == text.trim_end())
        };
        Self {
            networks: networks
                .into_iter()
                .map(|(name, text)| {
                    same(&name, &text).map_or_else(|| Arc::new(NetworkFile { name, text }), Arc::clone)
                })
                .collect(),
            patches: patches.trim_end().into(),
            ..self.clone()
        }
    }
}

enum Place {
    Network(String),
    Patches,
}

fn part<'a>(networks: &'a mut Vec<(String, String)>, name: &str) -> &'a mut String {
    let at = networks.iter().position(|(known, _)| known == name);
    let at = at.unwrap_or_else(|| {
        networks.push((name.to_owned(), String::new()));
        networks.len() - 1
    });
    &mut networks[at].1
}

fn path_of(name: &str) -> String {
    format!("networks/{name}.ps300")
}

fn heading(path: &str) -> String {
    format!("{{ ---- {path} ---- }}")
}

fn heading_in(line: &str) -> Option<Place> {
    let path = line.trim().strip_prefix("{ ---- ")?.strip_suffix(" ---- }")?;
    if path == PATCHES {
        return Some(Place::Patches);
    }
    let name = path.strip_prefix("networks/")?.strip_suffix(".ps300")?;
    is_file_name(name).then(|| Place::Network(name.to_owned()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn show(files: &[(&str, &str)], patches: &str) -> Show {
        let file = |&(name, text): &(&str, &str)| {
            Arc::new(NetworkFile {
                name: name.into(),
                text: text.into(),
            })
        };
        Show {
            networks: files.iter().map(file).collect(),
            patches: patches.into(),
            ..Show::default()
        }
    }

    #[test]
    fn a_program_is_read_back() {
        for (files, patches) in [
            (&[][..], ""),
            (&[], "a := F:NOP;"),
            (&[("a", "x := F:NOP;\n")], ""),
            (&[("a", "x := F:NOP;\n"), ("b", "{ nothing }\n")], ""),
            (&[("a", "x := F:NOP;"), ("b", "")], "SEND 1 TO <1>x;"),
        ] {
            let before = show(files, patches);
            let text = before.program_text();
            let after = before.with_program(&text);
            if !files.is_empty() || !patches.is_empty() {
                assert_eq!(after, before, "{text}");
            }
            assert_eq!(after.program_text(), text);
        }
    }

    #[test]
    fn an_edited_program_finds_its_files() {
        let before = show(&[("a", "x := F:NOP;\n"), ("b", "y := F:NOP;\n")], "");
        let text = before.program_text().replace("y :=", "z :=");
        let after = before.with_program(&text);
        assert!(Arc::ptr_eq(&before.networks[0], &after.networks[0]));
        assert_eq!(after.networks[1].text, "z := F:NOP;\n");
        let plain = before.with_program("w := F:NOP;\n");
        assert_eq!(plain.networks.len(), 1);
        assert_eq!(plain.networks[0].name, "a");
        let added = before.with_program(
            "{ ---- networks/c.ps300 ---- }\nw := F:NOP;\n{ ---- patches.ps300 ---- }\nDISPLAY w;",
        );
        assert_eq!(
            (added.networks[0].name.as_str(), &*added.patches),
            ("c", "DISPLAY w;")
        );
        assert_eq!(show(&[], "").with_program("w := F:NOP;").networks[0].name, FIRST);
    }
}
