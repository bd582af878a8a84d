//! A clip taken apart into frames for files that know no keys.

use motion::{Clip, ClipError, FigurePose};
use thiserror::Error;

use super::figure::FigureDoc;
use super::show::Show;

/// Why a show has no frames.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ExportError {
    /// Nobody moves.
    #[error("this show has no figure, so there is no motion to write")]
    NoFigure,
    /// Nothing moves.
    #[error("clip `{0}` has no keys, so there is no motion to write")]
    NoKeys(String),
    /// The keys make no motion.
    #[error(transparent)]
    Clip(#[from] ClipError),
    /// The frames are too many to be meant.
    #[error("clip `{0}` would give more than a million frames; look at its first and last key")]
    TooManyFrames(String),
}

/// The current clip of a show at even times.
pub(super) struct Frames<'s> {
    pub(super) figure: &'s FigureDoc,
    pub(super) clip: Clip,
    pub(super) times_secs: Vec<f64>,
    /// Seconds from frame to frame.
    pub(super) step_secs: f64,
}

impl<'s> Frames<'s> {
    /// Prepares the clip being edited.
    pub(super) fn of(show: &'s Show) -> Result<Self, ExportError> {
        let figure = show.figure.as_deref().ok_or(ExportError::NoFigure)?;
        let no_keys = || ExportError::NoKeys(show.clip.clone());
        let doc = show.current_clip().ok_or_else(no_keys)?;
        let clip = doc.clip(&figure.figure)?.ok_or_else(no_keys)?;
        let times_secs = doc
            .frame_times_secs()
            .ok_or_else(|| ExportError::TooManyFrames(show.clip.clone()))?;
        Ok(Self {
            figure,
            clip,
            times_secs,
            step_secs: doc.export_frame_secs(),
        })
    }

    /// Hands out every frame in order: time, pose.
    pub(super) fn each(&self, mut take: impl FnMut(f64, &FigurePose)) {
        let mut pose = FigurePose::default();
        for &secs in &self.times_secs {
            self.clip.sample(secs, &mut pose);
            take(secs, &pose);
        }
    }
}
