//! A tablet's active area, and the tools used on it.

use super::is_default;
use serde::{Deserialize, Serialize};

/// Millimetres in an inch.
const MM_PER_INCH: f64 = 25.4;

/// The active area; used where the tablet does not say itself. Exactly one of `size_mm` and `counts_per_inch`
/// is given.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Surface {
    /// Largest x and y.
    pub counts: [u32; 2],
    /// Width and height in millimetres.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub size_mm: Option<[f64; 2]>,
    /// Lines per inch, x and y.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub counts_per_inch: Option<[u32; 2]>,
    /// Largest pressure; 0 where none is felt.
    #[serde(default, skip_serializing_if = "is_default")]
    pub pressure: u32,
    /// Pressure above which the tip is down, where no bit says so.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tip_pressure: Option<u32>,
    /// Steps of tilt in a radian; absent: no tilt is reported.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tilt_steps_per_rad: Option<f64>,
    /// Steps of twist in a whole turn; absent: no twist is reported.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub twist_steps_per_turn: Option<u32>,
    /// Largest distance above the surface; absent: none is reported.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub distance: Option<u32>,
    /// Largest x and y of touch; absent: fingers are not reported.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub touch_counts: Option<[u32; 2]>,
    /// Fingers reported at once.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub touches: Option<u8>,
}

impl Surface {
    /// Whether pens report their tilt.
    pub fn tilt(&self) -> bool {
        self.tilt_steps_per_rad.is_some()
    }

    /// Counts in an inch, x and y.
    pub fn per_inch(&self) -> [f64; 2] {
        let [x, y] = self.counts.map(f64::from);
        match (self.counts_per_inch, self.size_mm) {
            (Some(per_inch), _) => per_inch.map(f64::from),
            (None, Some([wide, high])) => [x / wide * MM_PER_INCH, y / high * MM_PER_INCH],
            (None, None) => [0.0; 2],
        }
    }

    /// Width and height in millimetres.
    pub fn mm(&self) -> [f64; 2] {
        let [x, y] = self.counts.map(f64::from);
        let [per_x, per_y] = self.per_inch().map(|n| n.max(f64::MIN_POSITIVE));
        self.size_mm
            .unwrap_or([x / per_x * MM_PER_INCH, y / per_y * MM_PER_INCH])
    }
}

/// One kind of tool.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ToolProfile {
    /// pen, eraser, puck or mouse.
    pub tool: Tool,
    /// Number of buttons, numbered from 1; the tip is not one.
    pub buttons: u8,
    /// Whether it has a wheel.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wheel: Option<bool>,
}

/// The kinds of tool.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Tool {
    /// The writing end.
    Pen,
    /// The other end.
    Eraser,
    /// A cursor lying on the surface, with a lens or without.
    Puck,
    /// A mouse that is used on the tablet only, and tells its place there.
    Mouse,
}
