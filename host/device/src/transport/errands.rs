//! A thread that does what may take a device long: writes, feature reports, strings. In the order they were given.
//!
//! A device that does not answer holds a system call for seconds; whoever polls must not wait that long.

use super::TransportError;
use std::io;
use std::sync::mpsc::{Receiver, SyncSender, TrySendError, sync_channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Errands that wait; more are refused, so that a device that takes nothing cannot fill the memory.
const WAITING_MAX: usize = 256;

/// The device's side. Errors are sorted by the address they bear.
pub(super) trait Talking: Send {
    /// Sends an output report.
    fn write(&mut self, bytes: &[u8]) -> Result<(), TransportError>;
    /// Sets a feature report.
    fn write_feature(&mut self, bytes: &[u8]) -> Result<(), TransportError>;
    /// Reads a feature report of at most so many bytes.
    fn read_feature(&mut self, id: u8, bytes: usize) -> Result<Vec<u8>, TransportError>;
    /// Reads a string descriptor.
    fn read_string(&mut self, index: u8) -> Result<Vec<u8>, TransportError>;
}

/// What somebody waits for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Question {
    SetFeature(Vec<u8>),
    Feature { id: u8, bytes: usize },
    Text(u8),
}

enum Errand {
    Write(Vec<u8>),
    Ask(Question),
}

/// The near end of the thread. One question is open at a time; another one takes its place.
pub(super) struct Errands {
    address: String,
    to: SyncSender<Errand>,
    shared: Arc<Mutex<Shared>>,
    open: Option<Question>,
}

#[derive(Default)]
struct Shared {
    answers: Vec<(Question, Result<Vec<u8>, TransportError>)>,
    refused: Option<TransportError>,
}

impl Errands {
    /// Begins to work; `name` is the thread's.
    pub(super) fn spawn(address: &str, name: &str, talking: Box<dyn Talking>) -> io::Result<Self> {
        let (to, from) = sync_channel(WAITING_MAX);
        let shared = Arc::new(Mutex::new(Shared::default()));
        let theirs = Arc::clone(&shared);
        std::thread::Builder::new()
            .name(format!("out {name}"))
            .spawn(move || work(&from, &theirs, talking))?;
        Ok(Self {
            address: address.to_owned(),
            to,
            shared,
            open: None,
        })
    }

    /// Hands a report over. The error is that of an earlier one: later than it happened, but not lost.
    pub(super) fn write(&mut self, bytes: &[u8]) -> Result<(), TransportError> {
        if let Some(error) = lock(&self.shared).refused.take() {
            return Err(error);
        }
        self.send(Errand::Write(bytes.to_vec()))
    }

    /// The answer, once it has come.
    pub(super) fn ask(&mut self, question: Question) -> Result<Option<Vec<u8>>, TransportError> {
        if self.open.as_ref() != Some(&question) {
            self.send(Errand::Ask(question.clone()))?;
            self.open = Some(question);
            return Ok(None);
        }
        // Answers to questions that nobody waits for any more go with it.
        let answers: Vec<_> = lock(&self.shared).answers.drain(..).collect();
        match answers.into_iter().find(|(asked, _)| *asked == question) {
            None => Ok(None),
            Some((_, answer)) => {
                self.open = None;
                answer.map(Some)
            }
        }
    }

    fn send(&self, errand: Errand) -> Result<(), TransportError> {
        self.to.try_send(errand).map_err(|error| match error {
            TrySendError::Full(_) => TransportError::Io {
                address: self.address.clone(),
                source: io::Error::new(
                    io::ErrorKind::WouldBlock,
                    format!(
                        "the device has left {WAITING_MAX} reports untaken; is it hung? plug it out and in"
                    ),
                ),
            },
            TrySendError::Disconnected(_) => super::intake::gone(&self.address),
        })
    }
}

fn lock(shared: &Mutex<Shared>) -> MutexGuard<'_, Shared> {
    // A panic elsewhere leaves answers, which have no broken state.
    shared.lock().unwrap_or_else(PoisonError::into_inner)
}

fn work(from: &Receiver<Errand>, shared: &Mutex<Shared>, mut talking: Box<dyn Talking>) {
    // Ends when the near end is dropped.
    while let Ok(errand) = from.recv() {
        match errand {
            Errand::Write(bytes) => {
                if let Err(error) = talking.write(&bytes) {
                    lock(shared).refused = Some(error);
                }
            }
            Errand::Ask(question) => {
                let answer = match &question {
                    Question::SetFeature(bytes) => talking.write_feature(bytes).map(|()| Vec::new()),
                    Question::Feature { id, bytes } => talking.read_feature(*id, *bytes),
                    Question::Text(index) => talking.read_string(*index),
                };
                lock(shared).answers.push((question, answer));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Answers what it was asked with its number; refuses report 9.
    struct Echo;

    impl Talking for Echo {
        fn write(&mut self, bytes: &[u8]) -> Result<(), TransportError> {
            if bytes == [9] {
                return Err(TransportError::Unsupported { what: "report 9" });
            }
            Ok(())
        }
        fn write_feature(&mut self, _bytes: &[u8]) -> Result<(), TransportError> {
            Ok(())
        }
        fn read_feature(&mut self, id: u8, bytes: usize) -> Result<Vec<u8>, TransportError> {
            Ok(vec![id; bytes])
        }
        fn read_string(&mut self, index: u8) -> Result<Vec<u8>, TransportError> {
            Ok(vec![2, index])
        }
    }

    fn answer(errands: &mut Errands, question: &Question) -> Vec<u8> {
        loop {
            if let Some(answer) = errands.ask(question.clone()).expect("the thread works") {
                return answer;
            }
            std::thread::yield_now();
        }
    }

    #[test]
    fn questions_are_answered_in_order_and_old_ones_do_not_answer_new_ones() {
        let mut errands = Errands::spawn("pad", "pad", Box::new(Echo)).expect("there are threads");
        assert_eq!(errands.ask(Question::Text(1)).unwrap(), None);
        // Given up for another one.
        assert_eq!(answer(&mut errands, &Question::Text(2)), [2, 2]);
        assert_eq!(
            answer(&mut errands, &Question::Feature { id: 7, bytes: 3 }),
            [7, 7, 7]
        );
        assert!(answer(&mut errands, &Question::SetFeature(vec![2, 2])).is_empty());
        assert_eq!(
            answer(&mut errands, &Question::Text(2)),
            [2, 2],
            "asked again, answered again"
        );
    }

    #[test]
    fn a_refused_report_is_told_with_the_next() {
        let mut errands = Errands::spawn("pad", "pad", Box::new(Echo)).expect("there are threads");
        errands.write(&[9]).unwrap();
        answer(&mut errands, &Question::Text(1));
        assert!(errands.write(&[1]).unwrap_err().to_string().contains("report 9"));
        errands.write(&[1]).unwrap();
    }
}
