//! The snapshot: what can be seen of the rig after a step.

use std::sync::Arc;

use motion::Kinetics;

use super::{Rig, rehearse};
use crate::snapshot::{KeyView, KineticsView, Snapshot};

/// Samples of the kinetic curve for drawing.
const CURVE_SAMPLES: usize = 129;

impl Rig {
    pub(super) fn look(&mut self) -> Snapshot {
        let now_secs = self.secs();
        let network = self.network_look();
        let key_here = self.timeline.key_here();
        let show = self.history.present();
        let keys = show.key_times_secs();
        let mut kinetics = self.kinetics_view.clone();
        kinetics.selected = (!kinetics.coefficients.is_empty()).then_some(self.coefficient);
        Snapshot {
            at_secs: now_secs,
            step: self.steps,
            show: show.name.clone(),
            unsaved: !Arc::ptr_eq(&self.saved, show),
            figure: self.stage.as_ref().map(crate::stage::Stage::view),
            clip: self.clip.clone(),
            clip_name: show.clip.clone(),
            keys: keys
                .into_iter()
                .enumerate()
                .map(|(i, secs)| KeyView {
                    secs,
                    selected: key_here == Some(i),
                })
                .collect(),
            kinetics,
            transport: self.timeline.view().clone(),
            view: self.view.clone(),
            display: self.wiring.picture(),
            desk: self
                .desk
                .view(self.wiring.panel(), now_secs, self.inputs.simulated_desk()),
            puppet: self.puppet.as_mut().map(|puppet| puppet.view(self.now)),
            teaching: self.is_teaching(),
            puppet_pose: self.rehearsing.as_mut().map(rehearse::Rehearsing::pose_view),
            feasibility: self.rehearsing.as_ref().map(rehearse::Rehearsing::feasibility),
            devices: self.device_views(),
            learning: self.learning_view(),
            calibration: self.calibrations.view(),
            take: self.take_view(),
            takes: show.takes.keys().cloned().collect(),
            undo: self.history.undo_words().map(str::to_owned),
            redo: self.history.redo_words().map(str::to_owned),
            notes: self.notes.view(),
            network,
        }
    }
}

/// The kinetic spline as it is drawn.
pub(super) fn kinetics(kinetics: Option<&Kinetics>) -> KineticsView {
    let Some(kinetics) = kinetics else {
        return KineticsView::default();
    };
    let (start_secs, span_secs) = (kinetics.domain().start, kinetics.domain().length());
    let curve = (0..CURVE_SAMPLES)
        .map(|i| {
            let secs = start_secs + span_secs * i as f64 / (CURVE_SAMPLES - 1) as f64;
            [secs, kinetics.u(secs)]
        })
        .collect();
    let knots = kinetics.knots();
    // A cubic's coefficient acts around the mean of the three knots after its first (Greville).
    let coefficients = kinetics
        .coefficients()
        .iter()
        .enumerate()
        .filter_map(|(i, &u)| Some([knots.get(i + 1..i + 4)?.iter().sum::<f64>() / 3.0, u]))
        .collect();
    KineticsView {
        mode: format!("{:?}", kinetics.mode()).to_lowercase(),
        curve,
        coefficients,
        selected: None,
        reversals: kinetics.reversals().iter().map(|i| [i.start, i.end]).collect(),
    }
}
