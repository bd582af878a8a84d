//! The words of a fault's text, each with its column, and what stands where another was expected.

use super::FaultError;
use crate::servo_bus::summed::packet::ID_MAX;
use device_profiles::Role;

/// Longest time a fault may name, microseconds: eleven days.
const TIME_MAX_US: f64 = 1e12;

/// The words of a fault, with the column of the one last taken.
pub(in crate::servo_bus) struct Words<'a> {
    text: &'a str,
    rest: std::iter::Peekable<std::str::SplitWhitespace<'a>>,
    last: Option<&'a str>,
}

impl<'a> Words<'a> {
    pub(in crate::servo_bus) fn new(text: &'a str) -> Self {
        Self {
            text,
            rest: text.split_whitespace().peekable(),
            last: None,
        }
    }

    pub(in crate::servo_bus) fn next(&mut self) -> Option<&'a str> {
        self.last = self.rest.next();
        self.last
    }

    pub(in crate::servo_bus) fn is_at_end(&mut self) -> bool {
        self.rest.peek().is_none()
    }

    /// Takes the next word if it is this one.
    pub(in crate::servo_bus) fn take(&mut self, word: &str) -> bool {
        let found = self.rest.next_if_eq(&word);
        if found.is_some() {
            self.last = found;
        }
        found.is_some()
    }

    /// The next word, which must be one of these; `expected` says it in words.
    pub(in crate::servo_bus) fn one_of(
        &mut self,
        known: &[&'static str],
        expected: &str,
    ) -> Result<&'static str, FaultError> {
        let word = self.next().unwrap_or("");
        known
            .iter()
            .find(|&&known| known == word)
            .copied()
            .ok_or_else(|| {
                let mut error = self.wrong(expected);
                if let Some(meant) = nearest(word, known) {
                    error.message = format!("{}; did you mean `{meant}`?", error.message);
                }
                error
            })
    }

    pub(in crate::servo_bus) fn expect(&mut self, word: &'static str) -> Result<(), FaultError> {
        self.one_of(&[word], &format!("`{word}`")).map(|_| ())
    }

    pub(in crate::servo_bus) fn a_number_follows(&mut self) -> bool {
        self.rest
            .peek()
            .is_some_and(|word| word.starts_with(|first: char| first.is_ascii_digit() || first == '-'))
    }

    pub(in crate::servo_bus) fn a_time_follows(&mut self) -> bool {
        self.rest.peek().is_some_and(|word| micros(word).is_some())
    }

    pub(in crate::servo_bus) fn id(&mut self) -> Result<u8, FaultError> {
        let word = self.next().and_then(|word| word.parse().ok());
        word.filter(|&id| id <= ID_MAX)
            .ok_or_else(|| self.wrong("a number from 0 to 253"))
    }

    /// What a register is for, as profiles say it.
    pub(in crate::servo_bus) fn role(&mut self) -> Result<Role, FaultError> {
        let role = self.next().and_then(|word| word.parse().ok());
        role.ok_or_else(|| self.wrong("a register's role such as homing-offset"))
    }

    /// A place in the chain, counted from the host.
    pub(in crate::servo_bus) fn place(&mut self) -> Result<usize, FaultError> {
        self.id().map(usize::from)
    }

    pub(in crate::servo_bus) fn whole<T: Copy + std::str::FromStr + PartialOrd + std::fmt::Display>(
        &mut self,
        min: T,
        max: T,
    ) -> Result<T, FaultError> {
        let value = self.next().and_then(|word| word.parse::<T>().ok());
        value
            .filter(|value| (&min..=&max).contains(&value))
            .ok_or_else(|| self.wrong(&format!("a whole number from {min} to {max}")))
    }

    /// A number in a range, with its unit right behind it or without one.
    pub(in crate::servo_bus) fn number(&mut self, unit: &str, min: f64, max: f64) -> Result<f64, FaultError> {
        let value = self.next().and_then(|word| {
            let bare = word.strip_suffix(unit).unwrap_or(word);
            bare.parse::<f64>().ok()
        });
        value
            .filter(|value| (min..=max).contains(value))
            .ok_or_else(|| self.wrong(&format!("a number from {min} to {max}{}", in_unit(unit))))
    }

    /// A number whose unit may not be left out, if the next word is one.
    pub(in crate::servo_bus) fn with_unit(&mut self, unit: &str) -> Option<f64> {
        let value = self.rest.peek()?.strip_suffix(unit)?.parse::<f64>().ok()?;
        self.next();
        Some(value)
    }

    /// A percentage, as parts per million.
    pub(in crate::servo_bus) fn share(&mut self) -> Result<u32, FaultError> {
        let value = self
            .next()
            .and_then(|word| word.strip_suffix('%'))
            .and_then(|word| word.parse::<f64>().ok());
        value
            .filter(|value| (0.0..=100.0).contains(value))
            .map(|percent| (percent * 1e4).round() as u32)
            .ok_or_else(|| self.wrong("a percentage such as 1%"))
    }

    pub(in crate::servo_bus) fn micros(&mut self) -> Result<u64, FaultError> {
        self.next()
            .and_then(micros)
            .ok_or_else(|| self.wrong("a time such as 2s, 30ms or 500us"))
    }

    /// The word last taken is not `expected`.
    pub(in crate::servo_bus) fn wrong(&self, expected: &str) -> FaultError {
        let (column, found) = match self.last {
            Some(word) => {
                let offset = word.as_ptr() as usize - self.text.as_ptr() as usize;
                (
                    self.text[..offset].chars().count() as u32 + 1,
                    format!("`{word}`"),
                )
            }
            None => (self.text.trim_end().chars().count() as u32 + 1, "the end".into()),
        };
        FaultError {
            column,
            message: format!("expected {expected}, found {found}"),
        }
    }
}

fn in_unit(unit: &str) -> String {
    if unit.is_empty() {
        String::new()
    } else {
        format!(" {unit}")
    }
}

/// Microseconds of a time such as `30ms`.
fn micros(word: &str) -> Option<u64> {
    let (number, us) = [("us", 1.0), ("ms", 1e3), ("s", 1e6)]
        .iter()
        .find_map(|&(suffix, us)| Some((word.strip_suffix(suffix)?, us)))?;
    let value = number.parse::<f64>().ok()? * us;
    (0.0..=TIME_MAX_US).contains(&value).then(|| value.round() as u64)
}

/// The known word that differs least from `word`, if it can be taken for a slip of the fingers.
fn nearest(word: &str, known: &[&'static str]) -> Option<&'static str> {
    let far = |known: &&'static str| (slips(word, known), known.len().abs_diff(word.len()));
    let best = known.iter().copied().min_by_key(far)?;
    // A third of the letters may be wrong, and at least one.
    (slips(word, best) <= (best.chars().count() / 3).max(1)).then_some(best)
}

/// Letters to put in, take out, change, or swap with their neighbours to make `b` of `a`.
fn slips(a: &str, b: &str) -> usize {
    let [a, b] = [a, b].map(|word| word.chars().collect::<Vec<char>>());
    // `rows[i][j]`: from the first i letters of a to the first j of b.
    let mut rows: Vec<Vec<usize>> = vec![(0..=b.len()).collect()];
    for (i, from) in a.iter().enumerate() {
        let mut row = vec![i + 1];
        for (j, to) in b.iter().enumerate() {
            let changed = rows[i][j] + usize::from(from != to);
            let mut least = changed.min(row[j] + 1).min(rows[i][j + 1] + 1);
            if i > 0 && j > 0 && a[i - 1] == *to && b[j - 1] == *from {
                least = least.min(rows[i - 1][j - 1] + 1);
            }
            row.push(least);
        }
        rows.push(row);
    }
    rows[a.len()][b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slips_are_counted_letter_by_letter() {
        assert_eq!(slips("stuck", "stuck"), 0);
        assert_eq!(slips("stuk", "stuck"), 1);
        assert_eq!(slips("slient", "silent"), 1);
        assert_eq!(nearest("slient", &["stuck", "silent", "hot"]), Some("silent"));
        assert_eq!(nearest("explode", &["stuck", "silent", "hot"]), None);
    }
}
