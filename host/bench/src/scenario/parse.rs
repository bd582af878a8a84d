//! From a text to a scenario. Every flaw is found, each with its line and column.

use std::path::{Path, PathBuf};

use firmware_sim::servo_bus::PlantKind;

use super::check::{Check, SUBJECTS};
use super::doing::{Doing, VERBS};
use super::words::{Parsed, Words};
use super::{Line, Scenario, ScenarioError, Setting, What, When};

impl Scenario {
    /// Reads a scenario. Paths in it are relative to `folder`; `name` is for reports.
    pub fn parse(name: &str, folder: &Path, text: &str) -> Result<Self, Vec<ScenarioError>> {
        let mut scenario = Self {
            name: name.to_owned(),
            folder: folder.to_owned(),
            setting: Setting::default(),
            lines: Vec::new(),
        };
        let mut errors = Vec::new();
        let mut latest_secs = 0.0;
        for (number, text) in (1..).zip(text.lines()) {
            let read = Words::new(text).and_then(|words| scenario.line(number, words, &mut latest_secs));
            if let Err(flaw) = read {
                errors.push(ScenarioError {
                    line: number,
                    column: flaw.column,
                    message: flaw.message,
                });
            }
        }
        if errors.is_empty() {
            Ok(scenario)
        } else {
            Err(errors)
        }
    }

    fn line(&mut self, number: u32, mut words: Words<'_>, latest_secs: &mut f64) -> Parsed<()> {
        if words.is_at_end() {
            return Ok(());
        }
        let column = words.column();
        let when = match words.one_of(&["use", "at", "by", "within", "always", "never"])? {
            0 => return self.setting.read(&mut words, &self.folder),
            1 => When::At(time(&mut words, latest_secs)?),
            2 => When::By(time(&mut words, latest_secs)?),
            3 => When::Within(words.secs("a duration in seconds")?),
            always => {
                let from_secs = if words.take("from") {
                    words.secs("a time in seconds")?
                } else {
                    0.0
                };
                let to_secs = if words.take("to") {
                    words.secs("a time in seconds")?
                } else {
                    f64::INFINITY
                };
                if always == 4 {
                    When::Always { from_secs, to_secs }
                } else {
                    When::Never { from_secs, to_secs }
                }
            }
        };
        let text = words.clone().rest("what is done or expected")?.to_owned();
        let what = match when {
            When::At(_) => doing_or_check(&mut words)?,
            _ => What::Check(Check::parse(&mut words)?),
        };
        words.end()?;
        self.lines.push(Line {
            text,
            number,
            column,
            when,
            what,
        });
        Ok(())
    }
}

/// A time that is no earlier than the one before: a scenario reads from top to bottom.
fn time(words: &mut Words<'_>, latest_secs: &mut f64) -> Parsed<f64> {
    let mut wrong = words.wrong("");
    let secs = words.secs("a time in seconds")?;
    if secs < *latest_secs {
        wrong.message =
            format!("expected a time no earlier than the line before, {latest_secs} s, found {secs}");
        return Err(wrong);
    }
    *latest_secs = secs;
    Ok(secs)
}

fn doing_or_check(words: &mut Words<'_>) -> Parsed<What> {
    // Expectations begin with a noun and doings with a verb; no word is both.
    let known: Vec<&str> = VERBS.iter().chain(SUBJECTS).copied().collect();
    let mut ahead = words.clone();
    let place = ahead.one_of(&known)?;
    if place < VERBS.len() {
        Doing::parse(words).map(What::Do)
    } else {
        Check::parse(words).map(What::Check)
    }
}

impl Setting {
    /// What stands on the bench, several things in a line with commas between them.
    fn read(&mut self, words: &mut Words<'_>, folder: &Path) -> Parsed<()> {
        let path = |words: &mut Words<'_>| -> Parsed<PathBuf> { Ok(folder.join(words.text("a path")?)) };
        loop {
            match words.one_of(&[
                "show", "puppet", "knobs", "tablet", "script", "pose", "sag", "shafts", "stops", "horn",
                "device", "seed",
            ])? {
                0 => self.show = Some(path(words)?),
                1 => self.puppet = Some(words.text("a puppet profile")?),
                2 => self.knobs = Some(words.text("a knob box profile")?),
                3 => self.tablet = Some(words.text("a tablet profile")?),
                4 => self.scripts.push(path(words)?),
                5 => {
                    let joint = words.text("a joint")?;
                    words.expect("at")?;
                    self.start_rad.insert(joint, words.angle("an angle")?);
                }
                6 => self.sag_rad_per_s = Some(words.number("radians a second", 0.0..=100.0)?),
                7 => self.plant = [PlantKind::Ideal, PlantKind::Real][words.one_of(&["ideal", "real"])?],
                8 => {
                    words.expect("of")?;
                    let joint = words.text("a joint")?;
                    words.expect("at")?;
                    let low_rad = words.angle("the lower end")?;
                    words.expect("and")?;
                    let wrong = words.wrong("an angle above the lower end");
                    let high_rad = words.angle("the upper end")?;
                    if high_rad <= low_rad {
                        return Err(wrong);
                    }
                    self.stops_rad.insert(joint, [low_rad, high_rad]);
                }
                9 => self.horn(words)?,
                10 => {
                    let name = words.text("a name for the device")?;
                    self.devices
                        .push((name, words.text("a profile or another kind")?));
                }
                _ => self.seed = words.whole("a seed", 0..=u64::from(u32::MAX))?,
            }
            if !words.take(",") {
                return words.end();
            }
        }
    }

    /// `horn JOINT off by ANGLE`, `horn JOINT reversed`.
    fn horn(&mut self, words: &mut Words<'_>) -> Parsed<()> {
        let horn = self.horns.entry(words.text("a joint")?).or_default();
        if words.one_of(&["off", "reversed"])? == 1 {
            horn.reversed = true;
        } else {
            words.expect("by")?;
            horn.off_rad = words.angle("an angle")?;
        }
        Ok(())
    }
}
