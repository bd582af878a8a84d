//! How lately each output has sent: what makes wires glow.

use super::look::Activity;

/// After this long a glow has fallen to a third, seconds.
const FADE_SECS: f64 = 0.35;
/// Glows fainter than this are none.
const FAINT: f32 = 0.02;

/// By output, counts and times.
#[derive(Clone, Debug, Default)]
pub struct Traffic {
    revision: u64,
    sent: Vec<u64>,
    at_secs: Vec<f64>,
    latest_secs: f64,
}

impl Traffic {
    /// Takes note of what was sent since the last call. A network that was edited starts cold.
    pub fn see(&mut self, revision: u64, activity: &Activity, now_secs: f64) {
        let count = activity.outputs.len();
        if self.revision != revision || self.sent.len() != count {
            self.revision = revision;
            self.sent.clear();
            self.sent
                .extend(activity.outputs.iter().map(|output| output.sent));
            self.at_secs.clear();
            self.at_secs.resize(count, f64::NEG_INFINITY);
            return;
        }
        for ((known, at), output) in self.sent.iter_mut().zip(&mut self.at_secs).zip(&activity.outputs) {
            if *known != output.sent {
                (*known, *at) = (output.sent, now_secs);
                self.latest_secs = now_secs;
            }
        }
    }

    /// 1 when an output has just sent, 0 when that is long ago.
    pub fn glow(&self, output: usize, now_secs: f64) -> f32 {
        let Some(&at) = self.at_secs.get(output) else {
            return 0.0;
        };
        let glow = (-(now_secs - at) / FADE_SECS).exp() as f32;
        if glow < FAINT { 0.0 } else { glow.min(1.0) }
    }

    /// Whether anything glows: then the next picture will differ.
    pub fn is_warm(&self, now_secs: f64) -> bool {
        now_secs - self.latest_secs < FADE_SECS * 4.0
    }
}
