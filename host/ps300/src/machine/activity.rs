//! What moves through the network, for a picture of it: messages waiting, sent, withheld, and troubles.
//!
//! Flat, in the order of the picture's boxes, and filled anew in place every frame.

use super::Machine;
use super::picture::Picture;
use crate::names::Thing;
use crate::network::{InputPort, OutputPort, SinkId};
use crate::value::Value;

/// The state of every port of a [`Picture`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Activity {
    /// [`Picture::revision`] of the picture it belongs to.
    pub revision: u64,
    /// Box by box, from [`super::picture::BoxPicture::first_input`].
    pub inputs: Vec<InputActivity>,
    /// Box by box, from [`super::picture::BoxPicture::first_output`].
    pub outputs: Vec<OutputActivity>,
    /// Per box, how often something went wrong there since the machine began.
    pub reports: Vec<u64>,
}

/// One input.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct InputActivity {
    /// Messages waiting; a constant does not wait.
    pub waiting: u32,
    /// What the next firing sees here; what a label or parameter got last.
    pub front: Option<Value>,
    /// Whether a constant was sent rather than preset.
    pub is_set: bool,
}

/// One output.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OutputActivity {
    /// Messages sent so far.
    pub sent: u64,
    /// What it sent last.
    pub last: Option<Value>,
    /// Whether what it would send is withheld.
    pub frozen: bool,
    /// Messages withheld so far.
    pub withheld: u64,
}

impl InputActivity {
    fn of(port: &InputPort) -> Self {
        Self {
            waiting: port.waiting() as u32,
            front: port.front().cloned(),
            is_set: port.is_set(),
        }
    }
}

impl OutputActivity {
    fn of(port: &OutputPort) -> Self {
        Self {
            sent: port.sent,
            last: port.last.clone(),
            frozen: port.is_frozen(),
            withheld: port.withheld.into(),
        }
    }
}

impl Machine {
    /// What moves through the boxes of `picture`, which must be of the present revision.
    pub fn activity(&self, picture: &Picture) -> Activity {
        let mut activity = Activity::default();
        self.activity_into(picture, &mut activity);
        activity
    }

    /// The same into a value whose memory is used again.
    pub fn activity_into(&self, picture: &Picture, activity: &mut Activity) {
        let Activity {
            revision,
            inputs,
            outputs,
            reports,
        } = activity;
        *revision = picture.revision;
        inputs.clear();
        outputs.clear();
        reports.clear();
        for (thing, shown) in picture.things.iter().zip(&picture.boxes) {
            match *thing {
                Thing::Instance(id) => {
                    if let Some(instance) = self.network.instance(id) {
                        inputs.extend(instance.input_ports().iter().map(InputActivity::of));
                    }
                }
                Thing::Sink(id) => {
                    inputs.extend((1..=shown.inputs.len() as u8).map(|input| self.sink_activity(id, input)));
                }
                Thing::Node(_) => {}
            }
            // Nodes keep no messages; and a picture of another revision must not shift what follows.
            inputs.resize_with(shown.first_input + shown.inputs.len(), InputActivity::default);
            if let Some(sender) = self.sender(*thing).and_then(|id| self.network.instance(id)) {
                outputs.extend(sender.output_ports().iter().map(OutputActivity::of));
            }
            outputs.resize_with(shown.first_output + shown.outputs.len(), OutputActivity::default);
            reports.push(self.network.reports.counted(&shown.name));
        }
    }

    fn sink_activity(&self, id: SinkId, input: u8) -> InputActivity {
        let front = self.network.sink_last(id, input).cloned();
        InputActivity {
            waiting: 0,
            is_set: front.is_some(),
            front,
        }
    }
}
