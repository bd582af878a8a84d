//! What input devices say and can show, in their own counts. Whatever the wire, this is all that leaves a codec.

use crate::clock::Instant;
use std::sync::Arc;

/// Something, and when it came.
#[derive(Clone, Debug, PartialEq)]
pub struct Stamped<T> {
    /// Machine time at which the last byte of its report arrived; when it was noticed, where the transport
    /// cannot tell.
    pub at: Instant,
    /// The thing.
    pub what: T,
}

/// One thing a device has said. Controls are numbered from 0 within each class (dials, buttons, axes, rings), in
/// the order of the profile.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InputEvent {
    /// A tool on or over a tablet, or leaving it.
    Pen(PenSample),
    /// A pointer that knows no place has moved.
    Moved {
        /// Counts to the right.
        dx: i32,
        /// Counts towards the user.
        dy: i32,
        /// Clicks of the wheel, away from the user positive.
        wheel: i16,
    },
    /// A finger on a touch surface.
    Touch {
        /// Which finger; a number is used again once its finger has left.
        id: u16,
        /// x and y in counts from the upper left corner; `None` once, when it leaves.
        at: Option<[u32; 2]>,
    },
    /// A dial has been turned.
    Dial {
        /// From 0.
        control: u16,
        /// Clockwise positive; the profile knows how many make a turn.
        delta_counts: i32,
    },
    /// A button, key or pad has been pressed or let go; on tablets, the keys beside the surface.
    Button {
        /// From 0.
        control: u16,
        /// Pressed.
        down: bool,
    },
    /// Something with a place of its own has moved: fader, potentiometer, joystick, shuttle.
    Axis {
        /// From 0.
        control: u16,
        /// Counts; the profile knows the range.
        value: i32,
    },
    /// A finger is on a fader or strip, or has left it.
    AxisTouched {
        /// Number of the axis.
        control: u16,
        /// Touched.
        down: bool,
    },
    /// A finger on a ring or strip that tells places.
    Ring {
        /// From 0.
        control: u16,
        /// Steps from the profile's zero; `None` when the finger leaves.
        value: Option<u16>,
    },
    /// The device has answered for the first time and reports from now on.
    Started,
    /// The device was switched off and on, and reports again. What it held was let go before.
    Restarted,
}

/// One report of a tool. Only reports with a valid place become samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PenSample {
    /// Which tool.
    pub tool: Tool,
    /// 0 at the left edge, up to [`Surface::max_counts`]; where it was last, when it leaves.
    pub x_counts: u32,
    /// 0 at the far (upper) edge: downwards is positive.
    pub y_counts: u32,
    /// 0 to [`Surface::pressure_max`]; 0 for what presses nothing.
    pub pressure_counts: u32,
    /// Bit 0 is button 1. A pen's tip is not among them.
    pub buttons: u32,
    /// False once, when the tool leaves; then nothing is pressed.
    pub in_range: bool,
    /// The pen's or eraser's point is down.
    pub tip: bool,
    /// x and y as the tablet counts them; [`Surface::tilt_rad`] says which way that is. `None` where it does not
    /// say.
    pub tilt: Option<[i16; 2]>,
    /// The tool's turn about its own axis, in steps of [`Surface::twist_steps_per_turn`].
    pub twist: Option<i16>,
    /// How far above the surface, in the tablet's own steps; larger is farther.
    pub distance: Option<u16>,
    /// Clicks of a puck's wheel since the last report.
    pub wheel: i16,
    /// The tool's own number, where tools have one.
    pub tool_serial: Option<u64>,
    /// The maker's code of the kind of tool.
    pub tool_type: Option<u32>,
}

impl PenSample {
    /// A tool in range with nothing pressed.
    pub const fn hovering(tool: Tool, x_counts: u32, y_counts: u32) -> Self {
        Self {
            tool,
            x_counts,
            y_counts,
            pressure_counts: 0,
            buttons: 0,
            in_range: true,
            tip: false,
            tilt: None,
            twist: None,
            distance: None,
            wheel: 0,
            tool_serial: None,
            tool_type: None,
        }
    }

    /// The same tool leaving from there: everything let go.
    #[must_use]
    pub const fn leaving(self) -> Self {
        Self {
            in_range: false,
            tool_serial: self.tool_serial,
            tool_type: self.tool_type,
            ..Self::hovering(self.tool, self.x_counts, self.y_counts)
        }
    }
}

/// The kinds of tool.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Tool {
    /// A pen's point.
    Pen,
    /// A pen's other end.
    Eraser,
    /// A cursor lying on the surface, with a lens or without.
    Puck,
    /// A mouse that tells its place on the tablet.
    Mouse,
}

/// A tablet's active area, as the tablet itself says, or else its profile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// Largest x and y.
    pub max_counts: [u32; 2],
    /// Lines per inch, x and y.
    pub counts_per_inch: [f64; 2],
    /// Largest pressure.
    pub pressure_max: u32,
    /// Steps of tilt in a radian; `None` where there is no tilt, or nobody has measured it.
    pub tilt_steps_per_rad: Option<f64>,
    /// −1 where the tablet's count of a tilt falls to the right (x) or towards the user (y), 1 where it rises.
    pub tilt_signs: [i8; 2],
    /// Steps of twist in a turn; `None` likewise.
    pub twist_steps_per_turn: Option<f64>,
}

impl Surface {
    /// An area without tilt and twist.
    pub const fn flat(max_counts: [u32; 2], counts_per_inch: [f64; 2], pressure_max: u32) -> Self {
        Self {
            max_counts,
            counts_per_inch,
            pressure_max,
            tilt_steps_per_rad: None,
            tilt_signs: [1; 2],
            twist_steps_per_turn: None,
        }
    }

    /// A sample's tilt in radians, x to the right and y towards the user; `None` where the tablet does not say, or
    /// nobody knows its steps.
    pub fn tilt_rad(&self, sample: &PenSample) -> Option<[f64; 2]> {
        let steps_per_rad = self.tilt_steps_per_rad?;
        let [x, y] = sample.tilt?.map(f64::from);
        let [sign_x, sign_y] = self.tilt_signs.map(f64::from);
        Some([x * sign_x / steps_per_rad, y * sign_y / steps_per_rad])
    }
}

/// Something for a device to show. A device leaves out what it does not have.
#[derive(Clone, Debug, PartialEq)]
pub enum Feedback {
    /// All lamps at once; bit 0 is lamp 0.
    Lamps(u64),
    /// One lamp.
    Lamp {
        /// From 0.
        control: u16,
        /// 0 is off, 255 as bright as it goes.
        level: u8,
        /// Red, green and blue, where the lamp has colours; `None` leaves the colour to the device.
        colour: Option<[u8; 3]>,
    },
    /// A meter, or a brightness of the whole device.
    Level {
        /// From 0.
        control: u16,
        /// 0 to 255.
        level: u8,
    },
    /// The light of a ring.
    Ring {
        /// From 0.
        control: u16,
        /// Share of the way round, 0 to 1; `None` is dark.
        value: Option<f64>,
        /// How it is drawn.
        style: RingStyle,
    },
    /// Text beside a control.
    Label {
        /// From 0; keys follow dials.
        control: u16,
        /// Cut and padded to what the display holds; what is not printable ASCII becomes `?` where it cannot be drawn.
        text: String,
    },
    /// A picture beside a control, fitted to its screen; where a label is drawn there, it is drawn upon it.
    Picture {
        /// From 0.
        control: u16,
        /// The picture.
        picture: Picture,
    },
    /// Where a motor takes a fader.
    Motor {
        /// Number of the axis.
        control: u16,
        /// Counts, in the axis's range.
        value: i32,
    },
    /// Something to be felt.
    Haptic {
        /// From 0.
        control: u16,
        /// Clicks, one after another; 0 stops.
        clicks: u8,
        /// From one click to the next, milliseconds.
        apart_ms: u16,
    },
}

/// How a ring's light shows a value.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RingStyle {
    /// One dot.
    #[default]
    Dot,
    /// From the beginning to the value.
    Fan,
    /// From the middle to the value.
    Pan,
    /// From the middle to both sides.
    Spread,
}

/// An opaque picture, its rows from the top.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    width: u16,
    height: u16,
    rgb: Arc<[u8]>,
}

impl Picture {
    /// Three bytes a pixel, red first; `None` where there are not `width` × `height` of them.
    pub fn new(width: u16, height: u16, rgb: impl Into<Arc<[u8]>>) -> Option<Self> {
        let rgb = rgb.into();
        let fits = rgb.len() == usize::from(width) * usize::from(height) * 3 && !rgb.is_empty();
        fits.then_some(Self { width, height, rgb })
    }

    /// Pixels across and down.
    pub fn size(&self) -> [u16; 2] {
        [self.width, self.height]
    }

    /// Three bytes a pixel, red first.
    pub fn rgb(&self) -> &[u8] {
        &self.rgb
    }
}
