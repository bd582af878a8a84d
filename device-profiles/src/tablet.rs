//! Tablets on a serial line: surface, tools, and how the host recognises the model's own answer.

use crate::Status;
use crate::read::{Check, Flaw};
use serde::{Deserialize, Serialize};

/// One tablet model.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TabletProfile {
    /// The file's name without its ending; what programs ask for.
    #[serde(skip)]
    pub key: String,
    /// What people call it.
    pub name: String,
    /// How far it was tried.
    pub status: Status,
    /// Wire format: the name of a page in `docs/protocols/`.
    pub format: String,
    /// Where the numbers are from.
    pub source: String,
    /// Line speed after the handshake.
    pub baud: u32,
    /// How it answers when asked who it is.
    pub identify: Identify,
    /// The active area.
    pub surface: Surface,
    /// What may be used on it.
    #[serde(rename = "tool")]
    pub tools: Vec<SerialTool>,
}

/// The answer to `~#`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Identify {
    /// The two letters a model number begins with.
    pub prefix: String,
    /// Model text as a simulated tablet answers it, without the version.
    pub model: String,
    /// ROM version as a simulated tablet answers it.
    pub version: String,
    /// Whether it answers the question for its size.
    pub answers_size: bool,
}

/// The active area; used where the tablet does not say itself.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Surface {
    /// Largest x and y.
    pub counts: [u32; 2],
    /// Lines per inch, x and y.
    pub counts_per_inch: [u32; 2],
    /// Largest pressure: 120 (7 bits), 255 or 511.
    pub pressure: u16,
    /// Whether pens report their tilt.
    pub tilt: bool,
    /// Which of the four button bits a pen's eraser end sets: 3, or 2, which it shares with button 2.
    pub eraser_bit: u8,
}

/// One kind of tool.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SerialTool {
    /// pen, eraser or puck.
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
    /// A cursor lying on the surface.
    Puck,
}

impl Check for TabletProfile {
    fn flaws(&self, flaws: &mut Vec<Flaw>) {
        if self.surface.counts.contains(&0) || self.surface.counts_per_inch.contains(&0) {
            flaws.push(Flaw::at_header(
                "[surface]",
                0,
                "counts and counts_per_inch must be above 0",
            ));
        }
    }
}
