//! Finding an entry by a few letters: `dxr`, `route 4`, `adder:addc`, or a word of what it does.

use super::catalogue::{Entry, Want};

/// What was typed, taken apart.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Query {
    /// The name wanted for the new instance.
    pub name: Option<String>,
    /// What is looked for, in small letters.
    pub words: String,
    /// The size wanted.
    pub size: Option<u16>,
}

impl Query {
    /// Reads `name : words size`; the name and the size may be missing.
    pub fn read(text: &str) -> Query {
        let (name, rest) = match text.split_once(':') {
            Some((name, rest)) if !name.trim().eq_ignore_ascii_case("f") => {
                (Some(name.trim().to_owned()), rest.trim_start_matches('='))
            }
            Some((_, rest)) => (None, rest),
            None => (None, text),
        };
        let rest = rest.trim().replace(['(', ')'], " ");
        let (words, size) = match rest.trim().rsplit_once(' ') {
            Some((words, last)) if last.parse::<u16>().is_ok() => {
                (words.trim().to_owned(), last.parse().ok())
            }
            _ => (rest.trim().to_owned(), None),
        };
        let words = words.to_lowercase();
        Query {
            name: name.filter(|name| !name.is_empty()),
            words: words.strip_prefix("f:").unwrap_or(&words).to_owned(),
            size,
        }
    }
}

/// The entries that fit, best first; by their places in `entries`.
pub fn find(entries: &[Entry], query: &Query, want: Want) -> Vec<usize> {
    let fitting = entries
        .iter()
        .enumerate()
        .filter(|(_, entry)| want.port(entry).is_some());
    let mut found: Vec<(u32, usize, usize)> = fitting
        .filter_map(|(index, entry)| Some((score(entry, &query.words)?, entry.title.len(), index)))
        .collect();
    found.sort_unstable();
    found.into_iter().map(|(_, _, index)| index).collect()
}

/// Smaller is better; nothing where the entry does not fit at all.
fn score(entry: &Entry, words: &str) -> Option<u32> {
    if words.is_empty() {
        return Some(0);
    }
    let title = entry.title.to_lowercase();
    if title == words {
        return Some(0);
    }
    if title.starts_with(words) {
        return Some(1);
    }
    if let Some(at) = title.find(words) {
        return Some(2 + at as u32);
    }
    if let Some(gaps) = subsequence(&title, words) {
        return Some(100 + gaps);
    }
    let behaviour = entry.behaviour.to_lowercase();
    let all = words
        .split_whitespace()
        .all(|word| behaviour.contains(word) || title.contains(word));
    all.then_some(1000)
}

/// How many letters lie between those looked for, if all are there in order.
fn subsequence(title: &str, words: &str) -> Option<u32> {
    let mut letters = title.chars();
    let mut gaps = 0;
    let mut begun = false;
    for wanted in words.chars().filter(|c| !c.is_whitespace()) {
        loop {
            match letters.next() {
                Some(letter) if letter == wanted => break,
                Some(_) => gaps += u32::from(begun),
                None => return None,
            }
        }
        begun = true;
    }
    Some(gaps)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::patch::catalogue;
    use crate::patch::look::Picture;
    use ps300::{Kind, Kinds};

    fn first(text: &str, want: Want) -> String {
        let entries = catalogue::entries(&Picture::default());
        let found = find(&entries, &Query::read(text), want);
        found
            .first()
            .map(|&index| entries[index].title.clone())
            .unwrap_or_default()
    }

    #[test]
    fn a_few_letters_find_it() {
        for (text, want) in [
            ("dxr", "DXROTATE"),
            ("route 4", "ROUTE"),
            ("f:addc", "ADDC"),
            ("adder:addc", "ADDC"),
            ("xvec", "XVECTOR"),
            ("variable", "VARIABLE"),
        ] {
            assert_eq!(first(text, Want::Any), want, "{text}");
        }
    }

    #[test]
    fn only_what_fits_is_offered() {
        let entries = catalogue::entries(&Picture::default());
        let matrix = Want::Takes(Kinds::of(&[Kind::Matrix3]));
        let found = find(&entries, &Query::default(), matrix);
        assert!(!found.is_empty());
        for index in found {
            let takes = |kinds: &Kinds| kinds.has(Kind::Matrix3);
            assert!(
                entries[index].inputs.iter().any(takes),
                "{}",
                entries[index].title
            );
        }
    }

    #[test]
    fn name_and_size_are_read_from_the_query() {
        let query = Query::read(" switch := F:Route(4) ");
        assert_eq!(
            (query.name.as_deref(), query.words.as_str(), query.size),
            (Some("switch"), "route", Some(4))
        );
    }
}
