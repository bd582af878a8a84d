//! Text of a BVH file to a skeleton and its rows of channel values.
//!
//! The hierarchy is a stream of words; the motion section goes by lines, one frame each. Nesting is kept
//! on an explicit stack, so depth is bounded by the number of joints and not by the machine's stack.

use glam::DVec3;

use super::positions;
use super::skeleton::{CHANNEL_WORDS, Channel, PositionStyle, Skeleton, SkeletonJoint};
use crate::document::fault::{FileErrors, Findings};
use crate::document::limits::{KEY_GAP_SECS_MIN, KEYS_MAX, LINKS_MAX, SECS_MAX};
use crate::document::source::{Source, finite, words};

/// A file as read: rows still in the file's units (degrees).
#[derive(Clone, Debug, PartialEq)]
pub struct BvhFile {
    /// Joints and channels.
    pub skeleton: Skeleton,
    /// Seconds from frame to frame.
    pub frame_secs: f64,
    /// Channel values, row after row.
    pub values: Vec<f64>,
}

impl BvhFile {
    /// Number of frames.
    pub fn frame_count(&self) -> usize {
        self.values.len() / self.skeleton.column_count().max(1)
    }

    /// The channel values of one frame.
    pub fn row(&self, frame: usize) -> &[f64] {
        let columns = self.skeleton.column_count();
        &self.values[frame * columns..(frame + 1) * columns]
    }
}

/// A word with its place.
#[derive(Clone, Copy, Debug)]
struct Word<'a> {
    at: (u32, u32),
    text: &'a str,
}

/// Where reading stands in the file.
struct Reader<'a> {
    source: &'a Source,
    lines: std::iter::Enumerate<std::str::Lines<'a>>,
    /// Words of the present line not yet taken, last first.
    pending: Vec<Word<'a>>,
    line: u32,
    found: Findings,
}

/// Reading cannot go on; the reason is among the findings.
struct Stop;

/// Reads a whole file. Warnings are returned beside the result.
pub fn read(source: &Source) -> Result<(BvhFile, Vec<super::FileError>), FileErrors> {
    let mut reader = Reader {
        source,
        lines: source.text().lines().enumerate(),
        pending: Vec::new(),
        line: 1,
        found: Findings::default(),
    };
    let file = reader.file().ok();
    reader.found.accept(file, source.path())
}

impl<'a> Reader<'a> {
    fn stop(&mut self, at: (u32, u32), message: impl Into<String>) -> Stop {
        self.found.error(self.source.error_at(at, message));
        Stop
    }

    /// The next line as it stands; words pending are dropped.
    fn next_line(&mut self) -> Option<&'a str> {
        let (index, line) = self.lines.next()?;
        self.line = index as u32 + 1;
        Some(line)
    }

    fn word(&mut self, expected: &str) -> Result<Word<'a>, Stop> {
        while self.pending.is_empty() {
            let Some(line) = self.next_line() else {
                let end = self.source.line_column(self.source.text().len());
                return Err(self.stop(
                    end,
                    format!("the file ends where {expected} should follow; it is cut off"),
                ));
            };
            let at = self.line;
            self.pending = words(line)
                .map(|(column, text)| Word {
                    at: (at, column),
                    text,
                })
                .collect();
            self.pending.reverse();
        }
        Ok(self.pending.pop().expect("the loop ends with a word pending"))
    }

    fn expect(&mut self, expected: &str) -> Result<Word<'a>, Stop> {
        let word = self.word(&format!("`{expected}`"))?;
        if word.text.eq_ignore_ascii_case(expected) {
            return Ok(word);
        }
        Err(self.stop(word.at, format!("expected `{expected}`, found `{}`", word.text)))
    }

    fn number(&mut self, what: &str) -> Result<f64, Stop> {
        let word = self.word(what)?;
        match finite(word.text) {
            Ok(value) => Ok(value),
            Err(message) => {
                self.found.error(self.source.error_at(word.at, message));
                Ok(0.0)
            }
        }
    }

    fn offset(&mut self) -> Result<DVec3, Stop> {
        self.expect("OFFSET")?;
        Ok(DVec3::new(
            self.number("an offset")?,
            self.number("an offset")?,
            self.number("an offset")?,
        ))
    }

    fn file(&mut self) -> Result<BvhFile, Stop> {
        self.expect("HIERARCHY")?;
        let mut skeleton = self.hierarchy()?;
        self.expect("MOTION")?;
        let (frames, frame_secs) = self.frames()?;
        let values = self.rows(frames, skeleton.column_count())?;
        if self.found.errors.is_empty() {
            positions::tell_styles(self.source, &mut skeleton, &values, &mut self.found);
        }
        Ok(BvhFile {
            skeleton,
            frame_secs,
            values,
        })
    }

    fn hierarchy(&mut self) -> Result<Skeleton, Stop> {
        self.expect("ROOT")?;
        let mut joints = vec![self.joint(None)?];
        let mut open = vec![0_usize];
        while let Some(&parent) = open.last() {
            let word = self.word("`JOINT`, `End Site` or `}`")?;
            match word.text.to_ascii_uppercase().as_str() {
                "JOINT" if joints.len() == LINKS_MAX => {
                    return Err(self.stop(word.at, format!("more than {LINKS_MAX} joints")));
                }
                "JOINT" => {
                    open.push(joints.len());
                    let joint = self.joint(Some(parent))?;
                    joints.push(joint);
                }
                "END" => {
                    let end = self.end_site()?;
                    joints[parent].ends.push(end);
                }
                "}" => {
                    open.pop();
                }
                _ => {
                    return Err(self.stop(
                        word.at,
                        format!("expected `JOINT`, `End Site` or `}}`, found `{}`", word.text),
                    ));
                }
            }
        }
        Ok(Skeleton { joints })
    }

    /// Name, `{`, offset and channels; the members of the joint are left to the caller.
    fn joint(&mut self, parent: Option<usize>) -> Result<SkeletonJoint, Stop> {
        let name = self.name()?;
        let offset = self.offset()?;
        let channels = self.channels()?;
        Ok(SkeletonJoint {
            name,
            parent,
            offset,
            channels,
            ends: Vec::new(),
            positions: PositionStyle::Added,
        })
    }

    /// A name may hold spaces: it reaches to the end of the line or to a `{`.
    fn name(&mut self) -> Result<String, Stop> {
        let first = self.word("a joint's name")?;
        if first.text == "{" {
            return Err(self.stop(first.at, "expected a joint's name, found `{`"));
        }
        let mut name = first.text.to_owned();
        loop {
            let word = self.word("`{`")?;
            if word.text == "{" {
                return Ok(name);
            }
            if word.at.0 != first.at.0 {
                return Err(self.stop(word.at, format!("expected `{{`, found `{}`", word.text)));
            }
            name.push(' ');
            name.push_str(word.text);
        }
    }

    fn end_site(&mut self) -> Result<DVec3, Stop> {
        self.expect("Site")?;
        self.expect("{")?;
        let offset = self.offset()?;
        self.expect("}")?;
        Ok(offset)
    }

    fn channels(&mut self) -> Result<Vec<Channel>, Stop> {
        self.expect("CHANNELS")?;
        let count = self.word("the number of channels")?;
        let Some(count) = count.text.parse::<usize>().ok().filter(|count| *count <= 6) else {
            return Err(self.stop(
                count.at,
                format!("expected 0 to 6 channels, found `{}`", count.text),
            ));
        };
        let mut channels = Vec::with_capacity(count);
        let mut at = (self.line, 1);
        for _ in 0..count {
            let word = self.word("a channel")?;
            at = word.at;
            let known = CHANNEL_WORDS
                .iter()
                .find(|(name, _)| name.eq_ignore_ascii_case(word.text));
            match known {
                Some((_, channel)) if channels.contains(channel) => {
                    self.found.error(
                        self.source
                            .error_at(word.at, format!("`{}` is named twice", word.text)),
                    );
                }
                Some(&(_, channel)) => channels.push(channel),
                None => {
                    let error = self
                        .source
                        .error_at(word.at, format!("unknown channel `{}`", word.text));
                    self.found.error(
                        error.with_hint("Xposition to Zposition and Xrotation to Zrotation are known"),
                    );
                }
            }
        }
        let rotations = channels
            .iter()
            .filter(|channel| matches!(channel, Channel::Rotation(_)))
            .count();
        if !matches!(rotations, 0 | 3) && self.found.errors.is_empty() {
            let error = self
                .source
                .error_at(at, format!("{rotations} rotation channels; 3 or none are read"));
            self.found
                .error(error.with_hint("name the missing rotations and give them columns of zeros"));
        }
        Ok(channels)
    }

    fn frames(&mut self) -> Result<(usize, f64), Stop> {
        self.expect("Frames:")?;
        let word = self.word("the number of frames")?;
        let frames = match word.text.parse::<u64>() {
            Ok(frames) if frames <= KEYS_MAX as u64 => frames as usize,
            Ok(frames) => {
                return Err(self.stop(word.at, format!("{frames} frames; at most {KEYS_MAX} are read")));
            }
            Err(_) => {
                return Err(self.stop(
                    word.at,
                    format!("expected the number of frames, found `{}`", word.text),
                ));
            }
        };
        self.expect("Frame")?;
        self.expect("Time:")?;
        let word = self.word("the frame time")?;
        match finite(word.text) {
            Ok(secs) if secs >= KEY_GAP_SECS_MIN && secs * frames as f64 <= SECS_MAX => Ok((frames, secs)),
            Ok(secs) if secs > 0.0 => {
                let message = format!("{frames} frames of {} s each cannot be meant", word.text);
                Err(self.stop(word.at, message))
            }
            Ok(_) => Err(self.stop(
                word.at,
                format!("the frame time must be above 0 s, not `{}`", word.text),
            )),
            Err(message) => Err(self.stop(word.at, message)),
        }
    }

    fn rows(&mut self, frames: usize, columns: usize) -> Result<Vec<f64>, Stop> {
        let mut values = Vec::with_capacity((frames * columns).min(self.source.text().len()));
        let mut seen = 0;
        while let Some(line) = self.next_line() {
            if line.trim().is_empty() {
                continue;
            }
            if seen == frames {
                self.warn_of_more_rows(frames);
                break;
            }
            seen += 1;
            self.row(line, columns, &mut values);
        }
        if seen < frames {
            let end = self.source.line_column(self.source.text().len());
            let message =
                format!("`Frames:` promises {frames} rows, the file ends after {seen}; it is cut off");
            return Err(self.stop(end, message));
        }
        Ok(values)
    }

    fn row(&mut self, line: &str, columns: usize, values: &mut Vec<f64>) {
        let before = values.len();
        for (column, word) in words(line) {
            match finite(word) {
                Ok(value) => values.push(value),
                Err(message) => {
                    self.found
                        .error(self.source.error_at((self.line, column), message));
                    values.push(0.0);
                }
            }
        }
        let count = values.len() - before;
        if count != columns {
            let end = (self.line, line.trim_end().chars().count() as u32 + 1);
            let message = format!("a row of {count} values; the hierarchy has {columns} channels");
            self.found.error(self.source.error_at(end, message));
            values.resize(before + columns, 0.0);
        }
    }

    fn warn_of_more_rows(&mut self, frames: usize) {
        let at = (self.line, 1);
        let mut more = 1;
        while let Some(line) = self.next_line() {
            more += usize::from(!line.trim().is_empty());
        }
        let message = format!("{more} rows beyond the {frames} that `Frames:` promises are ignored");
        self.found.warn(self.source.error_at(at, message));
    }
}
