//! Asking on a serial line who is there.
//!
//! Only where a person wants it: what these bytes do to a device that nobody knows, nobody knows. A port that somebody
//! has is left alone, since opening it fails.

use crate::clock::Clock;
use crate::transport::{Transport, TransportError, serial};
use device_profiles::{InputProfile, Line, Profiles};
use std::time::Duration;

/// How long an answer may take: a tablet at 9600 baud says its forty letters within 50 ms, and one that is
/// busy with a pen within ten times that. Ours.
const ANSWER_LIMIT: Duration = Duration::from_millis(500);
/// Before the question: what was on its way to somebody else, or comes by itself, is over or shows itself. Ours.
const QUIET: Duration = Duration::from_millis(100);
/// The longest answer that is read; a device that never stops talking is not asked for more.
const ANSWER_BYTES_MAX: usize = 512;
/// Every tablet that can be asked answers at this speed before it was set up.
const BAUD_BEFORE: u32 = 9_600;

/// What can be asked, and with which manners of the line.
type Question<'a> = (Line, &'a str);

/// Asks on the port at `path` whatever profiles can be asked, at each speed they give. The profile whose device
/// answered.
///
/// # Errors
/// When the port cannot be opened, or goes meanwhile.
pub fn ask<'a>(
    path: &str,
    profiles: &'a Profiles,
    clock: &dyn Clock,
) -> Result<Option<&'a InputProfile>, TransportError> {
    for (line, question) in questions(profiles) {
        let mut port = serial::open_line(path, &line)?;
        listen(&mut port, clock, QUIET)?;
        port.write(question.as_bytes())?;
        let answer = listen(&mut port, clock, ANSWER_LIMIT)?;
        if let Some(known) = whose(&answer, question, profiles) {
            return Ok(Some(known));
        }
    }
    Ok(None)
}

/// Every question once for each speed, in the order of the profiles.
fn questions(profiles: &Profiles) -> Vec<Question<'_>> {
    let mut all: Vec<Question<'_>> = Vec::new();
    for profile in profiles.inputs() {
        let asked = profile.matches.iter().filter_map(|m| m.identify.as_ref());
        for (identify, line) in asked.filter_map(|identify| Some((identify, profile.line?))) {
            let before = Line {
                baud: BAUD_BEFORE,
                ..line
            };
            for line in [before, line] {
                let question = (line, identify.ask.as_str());
                if !all.contains(&question) {
                    all.push(question);
                }
            }
        }
    }
    all
}

/// What comes within `limit`, or until it is a whole line.
fn listen(port: &mut dyn Transport, clock: &dyn Clock, limit: Duration) -> Result<Vec<u8>, TransportError> {
    let until = clock.now().after(limit);
    let mut heard = Vec::new();
    let mut buffer = [0; 64];
    while clock.now() < until && heard.len() < ANSWER_BYTES_MAX && !heard.ends_with(b"\r") {
        port.wait(clock, until);
        let count = port.read(&mut buffer)?;
        heard.extend_from_slice(buffer.get(..count).unwrap_or_default());
    }
    Ok(heard)
}

/// The profile whose answer this is: that with the longest beginning that fits. Tablets repeat the question.
fn whose<'a>(answer: &[u8], question: &str, profiles: &'a Profiles) -> Option<&'a InputProfile> {
    let answer = answer.strip_prefix(question.as_bytes()).unwrap_or(answer);
    let fits = |profile: &&InputProfile| {
        let mut asked = profile.matches.iter().filter_map(|m| m.identify.as_ref());
        asked
            .any(|it| it.ask == question && !it.prefix.is_empty() && answer.starts_with(it.prefix.as_bytes()))
    };
    profiles
        .inputs()
        .filter(fits)
        .max_by_key(|profile| profile.answer_prefix().len())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::clock::MonotonicClock;
    use crate::transport::pty::Pty;
    use std::sync::Arc;
    use std::sync::atomic::{AtomicBool, Ordering};

    /// Answers every question of that beginning, and notes all it hears.
    fn answering(
        question: &'static str,
        answer: &'static str,
    ) -> (String, Arc<AtomicBool>, std::thread::JoinHandle<Vec<u8>>) {
        let mut far = Pty::open().expect("a terminal");
        let path = far.path().to_string_lossy().into_owned();
        let stop = Arc::new(AtomicBool::new(false));
        let theirs = Arc::clone(&stop);
        let thread = std::thread::spawn(move || {
            let clock = MonotonicClock::new();
            let (mut heard, mut at) = (Vec::new(), 0);
            while !theirs.load(Ordering::Relaxed) {
                far.wait(&clock, clock.now().after(Duration::from_millis(5)));
                let mut buffer = [0; 64];
                let count = far.read(&mut buffer).unwrap_or(0);
                heard.extend_from_slice(&buffer[..count]);
                if heard[at..].ends_with(question.as_bytes()) {
                    at = heard.len();
                    far.write(answer.as_bytes()).expect("room");
                }
            }
            heard
        });
        (path, stop, thread)
    }

    #[test]
    fn who_answers_is_known_and_who_does_not_is_nobody() {
        let profiles = Profiles::builtin();
        let clock = MonotonicClock::new();
        for (question, answer, want) in [
            ("~#", "~#UD-1212-R00,V1.4-4\r", Some("digitizer-ii")),
            ("~#", "~#GD-0912-R00,V2.0-0\r", Some("intuos-serial")),
            ("z?", "MM1201", Some("summasketch")),
            ("~#", "~#QQ what?\r", None),
        ] {
            let (path, stop, thread) = answering(question, answer);
            let found = ask(&path, &profiles, &clock).expect("it opens");
            stop.store(true, Ordering::Relaxed);
            let heard = thread.join().expect("it ended");
            assert_eq!(
                found.map(|p| p.key.as_str()),
                want,
                "{}",
                String::from_utf8_lossy(&heard)
            );
            assert!(heard.starts_with(b"~#"), "the first question");
        }
    }

    #[test]
    fn each_question_is_asked_once_at_each_speed() {
        let profiles = Profiles::builtin();
        let all = questions(&profiles);
        let bauds = |ask| {
            all.iter()
                .filter(|(_, q)| *q == ask)
                .map(|(line, _)| line.baud)
                .collect::<Vec<_>>()
        };
        assert_eq!(bauds("z?"), [9_600]);
        let mut asked = bauds("~#");
        assert!(asked.contains(&9_600) && asked.len() > 1, "{asked:?}");
        asked.dedup();
        assert_eq!(asked.len(), bauds("~#").len());
    }

    #[test]
    fn a_port_that_is_not_there_is_said_so() {
        let profiles = Profiles::builtin();
        let error = ask("/dev/no-such-port", &profiles, &MonotonicClock::new());
        assert!(matches!(error, Err(TransportError::NotFound { .. })), "{error:?}");
    }
}
