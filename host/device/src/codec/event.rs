//! What input devices say and can show, in their own counts.

use crate::clock::Instant;

/// Something, and when it was noticed.
#[derive(Clone, Debug, PartialEq)]
pub struct Stamped<T> {
    /// Machine time.
    pub at: Instant,
    /// The thing.
    pub what: T,
}

/// One thing a device has said. Controls and buttons are numbered as the device numbers them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum InputEvent {
    /// A tool on or over a tablet, or leaving it.
    Pen(PenSample),
    /// A dial has been turned.
    Dial {
        /// From 0.
        control: u8,
        /// Clockwise positive; the profile knows how many make a turn.
        delta_counts: i32,
    },
    /// A button has been pressed or let go.
    Button {
        /// From 0.
        control: u8,
        /// Pressed.
        down: bool,
    },
    /// The device has answered for the first time and reports from now on.
    Started,
    /// The device was switched off and on, and reports again. What it held was let go before.
    Restarted,
}

/// One report of a tool.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PenSample {
    /// Which tool.
    pub tool: Tool,
    /// 0 at the left edge, up to [`Surface::max_counts`]; where it was last, when it leaves.
    pub x_counts: u16,
    /// 0 at the far (upper) edge: downwards is positive.
    pub y_counts: u16,
    /// 0 to [`Surface::pressure_max`]; 0 for a puck.
    pub pressure_counts: u16,
    /// Bit 0 is button 1. A pen's tip is not among them.
    pub buttons: u8,
    /// False once, when the tool leaves; then nothing is pressed.
    pub in_range: bool,
    /// The pen's or eraser's point is down.
    pub tip: bool,
    /// x and y in steps of the tablet, −64 to 63; `None` where it does not say.
    pub tilt: Option<[i8; 2]>,
    /// Clicks of a puck's wheel since the last report, −3 to 3.
    pub wheel: i8,
}

/// The kinds of tool.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tool {
    /// A pen's point.
    Pen,
    /// A pen's other end.
    Eraser,
    /// A cursor lying on the surface.
    Puck,
}

/// A tablet's active area, as the tablet itself says, or else its profile.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Surface {
    /// Largest x and y.
    pub max_counts: [u16; 2],
    /// Lines per inch, x and y.
    pub counts_per_inch: [u16; 2],
    /// Largest pressure.
    pub pressure_max: u16,
}

/// Something for a device to show.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Feedback {
    /// All lamps at once; bit 0 is lamp 0.
    Lamps(u32),
    /// Text beside a control.
    Label {
        /// From 0; keys follow dials.
        control: u8,
        /// Cut and padded to what the display holds; what is not printable ASCII becomes `?`.
        text: String,
    },
}
