//! What devices say, as the event lines of `monitor` and `decode`: names, fields, and which changes are edges.
//!
//! A sample is one line; what changed with it (in range, tip, eraser, buttons) follows as one line each. Other
//! programs rely on these names (`docs/cli.md`).

use std::borrow::Cow;
use std::collections::BTreeMap;

use device::codec::{InputEvent, PenSample, Tool};

/// One event, named.
#[derive(Clone, Debug, PartialEq)]
pub struct Told {
    /// `sample`, `tip`, `key1`, `dial` and so on.
    pub event: Cow<'static, str>,
    /// Its fields in order.
    pub fields: Vec<(&'static str, Said)>,
}

/// A field's value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Said {
    /// Counts and numbers.
    Number(i64),
    /// Pressed, in range.
    Flag(bool),
    /// A tool.
    Word(&'static str),
    /// A finger that has left.
    Nothing,
}

/// What the numbers of the buttons of a device are called.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Buttons {
    /// `button` with the device's number, from 0: boxes.
    #[default]
    Numbered,
    /// `key1` and on: the keys beside a tablet's surface.
    Keys,
    /// `button1` and on: those of a mouse, as a tool's are called.
    Pointer,
}

/// Names events, remembers what changes are told against, and keeps tallies.
#[derive(Clone, Debug, Default)]
pub struct Teller {
    buttons: Buttons,
    without_pressure: bool,
    before: Before,
    tally: Tally,
}

#[derive(Clone, Copy, Debug, Default)]
struct Before {
    in_range: bool,
    tip: bool,
    eraser: bool,
    buttons: u32,
}

/// What was told so far.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Lines.
    pub events: u64,
    /// Smallest and largest of every axis.
    pub axes: BTreeMap<Cow<'static, str>, [i64; 2]>,
    /// Changes of everything that is on or off.
    pub edges: BTreeMap<String, u64>,
}

impl Teller {
    /// For a device whose buttons are called so.
    pub fn new(buttons: Buttons) -> Self {
        Self {
            buttons,
            ..Self::default()
        }
    }

    /// Leaves the pressure out of samples: the tools of this device press nothing.
    pub fn leave_pressure_out(&mut self, out: bool) {
        self.without_pressure = out;
    }

    /// So far.
    pub fn tally(&self) -> &Tally {
        &self.tally
    }

    /// Tells one event. What is no line (a start) tells nothing.
    pub fn tell(&mut self, event: &InputEvent, told: &mut dyn FnMut(Told)) {
        match *event {
            InputEvent::Pen(sample) => self.sample(&sample, told),
            InputEvent::Moved { dx, dy, wheel } => {
                let fields = [("dx", dx), ("dy", dy), ("wheel", wheel.into())];
                self.moved(&fields, told);
            }
            InputEvent::Touch { id, at } => {
                let place = |axis: usize| at.map_or(Said::Nothing, |at| Said::Number(at[axis].into()));
                if let Some([x, y]) = at {
                    self.reach("touch_x", x.into());
                    self.reach("touch_y", y.into());
                }
                let fields = vec![("id", Said::Number(id.into())), ("x", place(0)), ("y", place(1))];
                self.line("touch", fields, told);
            }
            InputEvent::Dial {
                control,
                delta_counts,
            } => {
                let delta = Said::Number(delta_counts.into());
                self.line("dial", vec![number(control), ("delta", delta)], told);
            }
            InputEvent::Button { control, down } => self.button(control, down, told),
            InputEvent::Axis { control, value } => {
                self.reach(format!("axis{control}"), value.into());
                let value = Said::Number(value.into());
                self.line("axis", vec![number(control), ("value", value)], told);
            }
            InputEvent::AxisTouched { control, down } => {
                self.edge(format!("axis{control}_touched"));
                self.line(
                    "axis_touched",
                    vec![number(control), ("value", Said::Flag(down))],
                    told,
                );
            }
            InputEvent::Ring { control, value } => {
                if let Some(value) = value {
                    self.reach("ring", value.into());
                }
                let value = value.map_or(Said::Nothing, |value| Said::Number(value.into()));
                let mut fields = vec![("value", value)];
                if control > 0 {
                    fields.insert(0, number(control));
                }
                self.line("ring", fields, told);
            }
            InputEvent::Started | InputEvent::Restarted => {}
        }
    }

    /// A sample, then one line for each thing that changed. Out of range the place is an old one: nothing to tell
    /// but the leaving.
    fn sample(&mut self, sample: &PenSample, told: &mut dyn FnMut(Told)) {
        if sample.in_range {
            let fields = self.fields(sample);
            self.line("sample", fields, told);
        }
        let now = Before {
            in_range: sample.in_range,
            tip: sample.tip,
            eraser: sample.in_range && sample.tool == Tool::Eraser,
            buttons: sample.buttons,
        };
        let before = std::mem::replace(&mut self.before, now);
        let flags = [
            ("in_range", before.in_range, now.in_range),
            ("tip", before.tip, now.tip),
            ("eraser", before.eraser, now.eraser),
        ];
        for (name, was, is) in flags {
            if was != is {
                self.edge(name.to_owned());
                self.line(name, vec![("value", Said::Flag(is))], told);
            }
        }
        let changed = before.buttons ^ now.buttons;
        for bit in (0..32).filter(|bit| changed >> bit & 1 == 1) {
            let name = format!("button{}", bit + 1);
            self.edge(name.clone());
            let is = Said::Flag(now.buttons >> bit & 1 == 1);
            self.line(name, vec![("value", is)], told);
        }
    }

    fn fields(&mut self, sample: &PenSample) -> Vec<(&'static str, Said)> {
        let stylus = matches!(sample.tool, Tool::Pen | Tool::Eraser);
        let pressure = (stylus && !self.without_pressure).then_some(i64::from(sample.pressure_counts));
        let tilt = |axis: usize| sample.tilt.map(|tilt| i64::from(tilt[axis]));
        let axes = [
            ("x", Some(i64::from(sample.x_counts))),
            ("y", Some(i64::from(sample.y_counts))),
            ("pressure", pressure),
            ("tilt_x", tilt(0)),
            ("tilt_y", tilt(1)),
            ("twist", sample.twist.map(i64::from)),
            ("distance", sample.distance.map(i64::from)),
            (
                "wheel",
                Some(i64::from(sample.wheel)).filter(|&clicks| clicks != 0),
            ),
        ];
        let tool = match sample.tool {
            Tool::Pen => "pen",
            Tool::Eraser => "eraser",
            Tool::Puck => "puck",
            Tool::Mouse => "mouse",
        };
        let mut fields = vec![("tool", Said::Word(tool))];
        for (name, value) in axes {
            if let Some(value) = value {
                self.reach(name, value);
                fields.push((name, Said::Number(value)));
            }
        }
        for (name, value) in [
            ("serial", sample.tool_serial.map(|serial| serial as i64)),
            ("tool_type", sample.tool_type.map(i64::from)),
        ] {
            fields.extend(value.map(|value| (name, Said::Number(value))));
        }
        fields
    }

    fn moved(&mut self, by: &[(&'static str, i32)], told: &mut dyn FnMut(Told)) {
        let mut fields = vec![("tool", Said::Word("mouse"))];
        for &(name, value) in by {
            self.reach(name, value.into());
            fields.push((name, Said::Number(value.into())));
        }
        self.line("sample", fields, told);
    }

    fn button(&mut self, control: u16, down: bool, told: &mut dyn FnMut(Told)) {
        let value = ("value", Said::Flag(down));
        match self.buttons {
            Buttons::Keys | Buttons::Pointer => {
                let class = if self.buttons == Buttons::Keys {
                    "key"
                } else {
                    "button"
                };
                let name = format!("{class}{}", u32::from(control) + 1);
                self.edge(name.clone());
                self.line(name, vec![value], told);
            }
            Buttons::Numbered => {
                self.edge(format!("button{control}"));
                self.line("button", vec![number(control), value], told);
            }
        }
    }

    fn line(
        &mut self,
        event: impl Into<Cow<'static, str>>,
        fields: Vec<(&'static str, Said)>,
        told: &mut dyn FnMut(Told),
    ) {
        self.tally.events += 1;
        told(Told {
            event: event.into(),
            fields,
        });
    }

    fn reach(&mut self, axis: impl Into<Cow<'static, str>>, value: i64) {
        let [low, high] = self.tally.axes.entry(axis.into()).or_insert([value; 2]);
        (*low, *high) = (value.min(*low), value.max(*high));
    }

    fn edge(&mut self, name: String) {
        *self.tally.edges.entry(name).or_default() += 1;
    }
}

fn number(control: u16) -> (&'static str, Said) {
    ("control", Said::Number(control.into()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all(teller: &mut Teller, event: &InputEvent) -> Vec<String> {
        let mut lines = Vec::new();
        teller.tell(event, &mut |told| {
            let fields = told
                .fields
                .iter()
                .map(|(name, value)| format!(" {name}={value:?}"));
            lines.push(format!("{}{}", told.event, fields.collect::<String>()));
        });
        lines
    }

    #[test]
    fn a_sample_comes_before_its_edges_and_leaving_tells_no_place() {
        let mut teller = Teller::default();
        let mut sample = PenSample {
            pressure_counts: 9,
            buttons: 0b10,
            tip: true,
            distance: Some(3),
            ..PenSample::hovering(Tool::Eraser, 5, 6)
        };
        assert_eq!(
            all(&mut teller, &InputEvent::Pen(sample)),
            [
                "sample tool=Word(\"eraser\") x=Number(5) y=Number(6) pressure=Number(9) distance=Number(3)",
                "in_range value=Flag(true)",
                "tip value=Flag(true)",
                "eraser value=Flag(true)",
                "button2 value=Flag(true)",
            ]
        );
        sample.x_counts = 11;
        assert_eq!(all(&mut teller, &InputEvent::Pen(sample)).len(), 1);
        assert_eq!(
            all(&mut teller, &InputEvent::Pen(sample.leaving())),
            [
                "in_range value=Flag(false)",
                "tip value=Flag(false)",
                "eraser value=Flag(false)",
                "button2 value=Flag(false)",
            ]
        );
        let tally = teller.tally();
        assert_eq!(tally.events, 10);
        assert_eq!(tally.axes["x"], [5, 11]);
        assert_eq!(tally.edges["button2"], 2);
    }

    #[test]
    fn keys_of_a_tablet_count_from_one_and_buttons_of_a_box_from_zero() {
        let down = InputEvent::Button {
            control: 0,
            down: true,
        };
        assert_eq!(
            all(&mut Teller::new(Buttons::Keys), &down),
            ["key1 value=Flag(true)"]
        );
        assert_eq!(
            all(&mut Teller::default(), &down),
            ["button control=Number(0) value=Flag(true)"]
        );
    }

    #[test]
    fn a_finger_that_leaves_has_no_place() {
        let mut teller = Teller::default();
        let touch = |at| InputEvent::Touch { id: 2, at };
        assert_eq!(
            all(&mut teller, &touch(Some([7, 8]))),
            ["touch id=Number(2) x=Number(7) y=Number(8)"]
        );
        assert_eq!(
            all(&mut teller, &touch(None)),
            ["touch id=Number(2) x=Nothing y=Nothing"]
        );
        let ring = InputEvent::Ring {
            control: 0,
            value: None,
        };
        assert_eq!(all(&mut teller, &ring), ["ring value=Nothing"]);
    }
}
