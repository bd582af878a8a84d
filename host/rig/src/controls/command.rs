//! What can be asked of physical controls: learning, binding, labels, pages, tests of outputs, slots.
//!
//! Whatever of it is to last becomes text of the network: one step of undo, saved with the show.

use serde::{Deserialize, Serialize};

/// One request about a device. Devices go by the name in [`crate::DeviceView::name`], controls by the number of
/// their output in the network ([`crate::ControlView::number`]).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ControlCommand {
    /// Sets how a control gets hold of its value, or what a button sends: a word of `NAME_MODE`.
    Mode {
        /// The device.
        device: String,
        /// The control, from 1.
        control: u8,
        /// `pickup`, `jump`, `scaled`, `relative`; of buttons `hold`, `press`, `toggle`.
        mode: String,
    },
    /// Multiplies what a relative control sends.
    Gear {
        /// The device.
        device: String,
        /// The control, from 1.
        control: u8,
        /// Any number but 0; negative turns it round.
        factor: f64,
    },
    /// How much farther a relative control goes when it is turned fast.
    Curve {
        /// The device.
        device: String,
        /// The control, from 1.
        control: u8,
        /// 0 no farther, 1 twice, 2 four times, 3 eight times.
        curve: u8,
    },
    /// Fine gear for all controls while on: a tenth.
    Fine(bool),
    /// Goes to a page and stays there.
    Page {
        /// The device.
        device: String,
        /// From 1.
        page: u8,
    },
    /// Lets a page follow the selected link or joint, or stay.
    PageFollows {
        /// The device.
        device: String,
        /// Whether it follows.
        on: bool,
    },
    /// Has a page come up when a link or joint is selected.
    PageFor {
        /// The device.
        device: String,
        /// From 1.
        page: u8,
        /// The link or joint; empty for none.
        focus: String,
    },
}

/// Learning: a control is touched, a parameter is touched, and they are connected.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LearnCommand {
    /// From now on the control and the parameter that are touched next are connected.
    Begin,
    /// Touches a control without touching it.
    Control {
        /// The device.
        device: String,
        /// The control, from 1.
        control: u8,
    },
    /// Touches an inlet of a parameter without moving it.
    Parameter {
        /// Its name in the network.
        name: String,
        /// From 1.
        inlet: u8,
    },
    /// Goes back to where nothing is learnt.
    Cancel,
}

/// A connection to be made between a control and an inlet of the network.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Binding {
    /// The device.
    pub device: String,
    /// The control, from 1.
    pub control: u8,
    /// The page on which it is to hold, from 1; the present one unless said.
    #[serde(default)]
    pub page: Option<u8>,
    /// What it is to drive: a parameter, function or display node of the network.
    pub to: String,
    /// Which inlet of it, from 1.
    pub inlet: u8,
    /// What the ends of the control come to, in the inlet's unit; the parameter's own range unless said.
    #[serde(default)]
    pub range: Option<[f64; 2]>,
}
