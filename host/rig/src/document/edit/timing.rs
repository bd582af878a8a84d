//! Changes of timing alone: the path from key to key never moves.

use motion::{KineticsError, KineticsMode};

use super::{EditError, Edited, current, done};
use crate::command;
use crate::document::show::Show;

/// Adds to a kinetic coefficient, on top of earlier adjustments; one gesture a coefficient.
pub(super) fn adjust(show: &Show, coefficient: usize, by: f64) -> Result<Edited, EditError> {
    let mut clip = current(show)?;
    if clip.kinetics != KineticsMode::Natural {
        return Err(KineticsError::NoCoefficients { mode: clip.kinetics }.into());
    }
    let edits = &mut clip.coefficient_edits;
    match edits.binary_search_by_key(&coefficient, |&(index, _)| index) {
        Ok(place) => edits[place].1 += by,
        Err(place) => edits.insert(place, (coefficient, by)),
    }
    edits.retain(|&(_, by)| by != 0.0);
    let words = format!("Adjust timing at coefficient {coefficient}");
    done(show, clip, words, Some(format!("coefficient {coefficient}")))
}

/// Takes all adjustments back.
pub(super) fn reset(show: &Show) -> Result<Edited, EditError> {
    let mut clip = current(show)?;
    clip.coefficient_edits.clear();
    done(show, clip, "Reset timing".to_owned(), None)
}

/// Chooses how key times become the kinetic spline. Adjustments wait for a mode that has coefficients.
pub(super) fn choose_mode(show: &Show, mode: command::KineticsMode) -> Result<Edited, EditError> {
    let mut clip = current(show)?;
    let (kinetics, word) = match mode {
        command::KineticsMode::Natural => (KineticsMode::Natural, "natural"),
        command::KineticsMode::Monotone => (KineticsMode::Monotone, "monotone"),
        command::KineticsMode::Linear => (KineticsMode::Linear, "linear"),
    };
    clip.kinetics = kinetics;
    done(show, clip, format!("Make timing {word}"), None)
}
