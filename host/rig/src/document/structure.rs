//! The thesis's structure file (`.str`): links, their lengths and where others hang on them.
//!
//! The first line is a comment. Then, for each link, a line `number name freedoms length`, followed by one
//! line `number x y z` for each link attached to it: where that link starts, in this link's frame. Blank
//! lines end a link. Source: the thesis, figure 5.1, whose file is read unchanged.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use glam::DVec3;
use motion::{Figure, FigureError, FigureWarning, Freedom, LinkSpec};

use super::fault::{FileError, Findings};
use super::limits::LINKS_MAX;
use super::source::{Source, finite, words};

/// A word with its column.
type Word<'a> = (u32, &'a str);

/// What has been read so far, and on which line.
struct Reader<'a> {
    source: &'a Source,
    specs: Vec<LinkSpec>,
    /// Line of each link, and of each of its attachments.
    lines: Vec<(u32, Vec<u32>)>,
    names: BTreeMap<String, u32>,
}

/// Reads a structure file.
pub fn read(source: &Source, found: &mut Findings) -> Option<Figure> {
    let mut reader = Reader {
        source,
        specs: Vec::new(),
        lines: Vec::new(),
        names: BTreeMap::new(),
    };
    let mut inside = false;
    for (index, line) in source.text().lines().enumerate().skip(1) {
        let number = index as u32 + 1;
        let words: Vec<Word<'_>> = words(line).collect();
        let Some(&(_, first)) = words.first() else {
            inside = false;
            continue;
        };
        // A name where an attachment has a coordinate: a new link without the blank line before it.
        let named = words.get(1).is_some_and(|(_, word)| word.parse::<f64>().is_err());
        if inside && !named && first.parse::<u32>().is_ok() {
            reader.attachment(number, &words, found);
        } else {
            inside = true;
            reader.link(number, &words, found);
        }
        if reader.specs.len() > LINKS_MAX {
            found.error(source.error_at((number, 1), format!("more than {LINKS_MAX} links")));
            return None;
        }
    }
    reader.figure(found)
}

impl Reader<'_> {
    fn fault(&self, line: u32, column: u32, message: impl Into<String>) -> FileError {
        self.source.error_at((line, column), message)
    }

    /// Refuses a line that has not exactly `count` words.
    fn counted(&self, line: u32, words: &[Word<'_>], count: usize, form: &str, found: &mut Findings) -> bool {
        if words.len() == count {
            return true;
        }
        let column = words.get(count).or(words.last()).map_or(1, |&(column, _)| column);
        let message = format!("expected `{form}`, found {} words", words.len());
        found.error(self.fault(line, column, message));
        false
    }

    fn number<T: std::str::FromStr>(
        &self,
        line: u32,
        word: Word<'_>,
        what: &str,
        found: &mut Findings,
    ) -> Option<T> {
        let value = word.1.parse().ok();
        if value.is_none() {
            found.error(self.fault(line, word.0, format!("expected {what}, found `{}`", word.1)));
        }
        value
    }

    fn measure(&self, line: u32, word: Word<'_>, found: &mut Findings) -> Option<f64> {
        finite(word.1)
            .map_err(|message| found.error(self.fault(line, word.0, message)))
            .ok()
    }

    fn link(&mut self, line: u32, words: &[Word<'_>], found: &mut Findings) {
        // A broken link still takes the attachments below it, so that they are not misread.
        let mut spec = LinkSpec {
            dof: 2,
            length: 1.0,
            ..LinkSpec::default()
        };
        if self.counted(line, words, 4, "number name freedoms length", found) {
            spec.number = self
                .number(line, words[0], "a link's number", found)
                .unwrap_or_default();
            words[1].1.clone_into(&mut spec.name);
            spec.dof = self
                .number(line, words[2], "degrees of freedom", found)
                .unwrap_or(2);
            spec.length = self.measure(line, words[3], found).unwrap_or(1.0);
            if let Some(before) = self.names.insert(spec.name.clone(), line) {
                let message = format!("the link on line {before} is called `{}` too", spec.name);
                found.error(
                    self.fault(line, words[1].0, message)
                        .with_hint("give each link its own name"),
                );
            }
        }
        self.specs.push(spec);
        self.lines.push((line, Vec::new()));
    }

    fn attachment(&mut self, line: u32, words: &[Word<'_>], found: &mut Findings) {
        if !self.counted(line, words, 4, "number x y z", found) {
            return;
        }
        let child = self.number(line, words[0], "a link's number", found);
        let place = [1, 2, 3].map(|word| self.measure(line, words[word], found));
        let (Some(child), [Some(x), Some(y), Some(z)]) = (child, place) else {
            return;
        };
        if let (Some(spec), Some((_, lines))) = (self.specs.last_mut(), self.lines.last_mut()) {
            spec.children.push((child, DVec3::new(x, y, z)));
            lines.push(line);
        }
    }

    fn figure(self, found: &mut Findings) -> Option<Figure> {
        if !found.errors.is_empty() {
            return None;
        }
        match Figure::new(&self.specs) {
            Ok((figure, warnings)) => {
                for warning in warnings {
                    let FigureWarning::FourFreedoms { link } = warning;
                    found.warn(self.fault(self.line_of(link), 1, warning.to_string()));
                }
                Some(figure)
            }
            Err(error) => {
                found.error(self.fault(self.place_of(&error), 1, error.to_string()));
                None
            }
        }
    }

    /// The last line that declares a link of this number.
    fn line_of(&self, number: u32) -> u32 {
        let place = self.specs.iter().rposition(|spec| spec.number == number);
        place.map_or(1, |place| self.lines[place].0)
    }

    /// The last line that attaches `child`, to `parent` if given.
    fn line_attaching(&self, child: u32, parent: u32) -> u32 {
        let place = self.specs.iter().rposition(|spec| spec.number == parent);
        let line = place.and_then(|place| {
            let at = self.specs[place]
                .children
                .iter()
                .rposition(|&(number, _)| number == child)?;
            self.lines[place].1.get(at).copied()
        });
        line.unwrap_or(1)
    }

    fn place_of(&self, error: &FigureError) -> u32 {
        match *error {
            FigureError::DuplicateNumber { number } => self.line_of(number),
            FigureError::BadFreedom { link, .. } | FigureError::BadLength { link, .. } => self.line_of(link),
            FigureError::NotFinite { link, child } | FigureError::MissingChild { link, child } => {
                self.line_attaching(child, link)
            }
            FigureError::TwoParents { child, second, .. } => self.line_attaching(child, second),
            FigureError::RootCount { .. } | FigureError::TooMany { .. } => 1,
        }
    }
}

/// A structure file of a figure. `comment` becomes the first line; names lose their white space.
pub fn write(figure: &Figure, comment: &str) -> String {
    let mut out = comment.replace(['\n', '\r'], " ");
    out.push('\n');
    for (index, link) in figure.links().iter().enumerate() {
        let freedom = match link.freedom {
            Freedom::Two => 2,
            Freedom::Three => 3,
        };
        let gap = if index == 0 { "" } else { "\n" };
        let name = word(&link.name);
        // Writing to a string cannot fail.
        let _ = writeln!(out, "{gap}{} {name} {freedom} {}", link.number, real(link.length));
        for attachment in &link.attachments {
            let Some(child) = figure.link(attachment.child) else {
                continue;
            };
            let DVec3 { x, y, z } = attachment.offset;
            let _ = writeln!(out, "    {} {} {} {}", child.number, real(x), real(y), real(z));
        }
    }
    out
}

/// A name as one word.
pub(super) fn word(name: &str) -> String {
    name.split_whitespace().collect::<Vec<_>>().join("_")
}

fn real(value: f64) -> String {
    format!("{:?}", value + 0.0)
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    fn figure(text: &str) -> (Option<Figure>, Findings) {
        let mut found = Findings::default();
        let figure = read(&Source::from_text(Path::new("a.str"), text), &mut found);
        (figure, found)
    }

    #[test]
    fn what_is_written_is_read_back() {
        let text = "a bird\r\n7 body 3 0.5\r\n  3 0.1 -0.2 1e-3\r\n  4 0 0 .5\r\n\r\n3 wing 2 1.25\n\n\n4 beak 2 0.05\n";
        let (bird, found) = figure(text);
        assert_eq!(found, Findings::default());
        let written = write(bird.as_ref().expect("a bird"), "a\nbird");
        assert!(
            written.starts_with("a bird\n7 body 3 0.5\n    3 0.1 -0.2 0.001\n"),
            "{written}"
        );
        assert_eq!(figure(&written).0, bird);
    }

    #[test]
    fn blank_lines_between_links_may_be_missing() {
        let (chain, _) = figure("c\n0 a 2 1\n 1 0 0 1\n1 b 2 1\n 2 0 0 1\n2 c 2 1");
        assert_eq!(chain.map(|figure| figure.len()), Some(3));
    }

    #[test]
    fn all_faults_are_found_with_their_places() {
        let (_, found) = figure("c\n0 a 2\n  x 0 0 1\n  1 0 nan 1\n\n1 b two -1\n");
        let places: Vec<(u32, u32)> = found.errors.iter().map(|e| (e.line, e.column)).collect();
        assert_eq!(places, [(2, 5), (3, 3), (4, 7), (6, 5)], "{:#?}", found.errors);
        let table = [
            ("c\n", 1, "exactly one root"),
            ("c\n0 a 2 1\n 0 0 0 1\n", 1, "loops"),
            ("c\n0 a 2 0\n", 2, "above zero"),
            ("c\n0 a 2 1\n\n0 b 2 1\n", 4, "the number 0"),
            ("c\n0 a 2 1\n 5 0 0 1\n", 3, "link 5"),
        ];
        for (text, line, words) in table {
            let (_, found) = figure(text);
            let error = found.errors.first().expect(words);
            assert!(error.line == line && error.message.contains(words), "{error}");
        }
    }
}
