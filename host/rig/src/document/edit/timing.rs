//! Changes of timing alone: the path from key to key never moves.

use std::sync::Arc;

use motion::{KineticsError, KineticsMode};

use super::{EditError, Said};
use crate::command;
use crate::document::clip::{ClipDoc, Keyed};
use crate::document::limits::{KEY_GAP_SECS_MIN, SECS_MAX};

/// Adds to a kinetic coefficient, on top of earlier adjustments; one gesture a coefficient.
pub(super) fn adjust<K>(clip: &mut ClipDoc<K>, coefficient: usize, by: f64) -> Result<Said, EditError> {
    if clip.kinetics != KineticsMode::Natural {
        return Err(KineticsError::NoCoefficients { mode: clip.kinetics }.into());
    }
    let edits = &mut clip.coefficient_edits;
    match edits.binary_search_by_key(&coefficient, |&(index, _)| index) {
        Ok(place) => edits[place].1 += by,
        Err(place) => edits.insert(place, (coefficient, by)),
    }
    edits.retain(|&(_, by)| by != 0.0);
    Ok(Said {
        words: format!("Adjust timing at coefficient {coefficient}"),
        gesture: Some(format!("coefficient {coefficient}")),
    })
}

/// Takes all adjustments back.
pub(super) fn reset<K>(clip: &mut ClipDoc<K>) -> Said {
    clip.coefficient_edits.clear();
    Said {
        words: "Reset timing".to_owned(),
        gesture: None,
    }
}

/// Chooses how key times become the kinetic spline. Adjustments wait for a mode that has coefficients.
pub(super) fn choose_mode<K>(clip: &mut ClipDoc<K>, mode: command::KineticsMode) -> Said {
    let (kinetics, word) = match mode {
        command::KineticsMode::Natural => (KineticsMode::Natural, "natural"),
        command::KineticsMode::Monotone => (KineticsMode::Monotone, "monotone"),
        command::KineticsMode::Linear => (KineticsMode::Linear, "linear"),
    };
    clip.kinetics = kinetics;
    Said {
        words: format!("Make timing {word}"),
        gesture: None,
    }
}

/// Gives every key another time, in order; adjustments stay, since they are counted in keys.
pub(super) fn retime<K: Keyed>(clip: &mut ClipDoc<K>, times_secs: &[f64]) -> Result<Said, EditError> {
    let in_order = times_secs
        .windows(2)
        .all(|pair| pair[1] - pair[0] >= KEY_GAP_SECS_MIN);
    if times_secs.len() != clip.keys.len() || !in_order {
        return Err(EditError::BadTimes {
            given: times_secs.len(),
            wanted: clip.keys.len(),
        });
    }
    if let Some(&secs) = times_secs
        .iter()
        .find(|secs| secs.is_nan() || secs.abs() > SECS_MAX)
    {
        return Err(EditError::BadTime { secs });
    }
    for (key, &secs) in clip.keys.iter_mut().zip(times_secs) {
        *key = Arc::new(key.at(secs));
    }
    Ok(Said {
        words: "Retime".to_owned(),
        gesture: None,
    })
}
