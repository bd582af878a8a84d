//! The tool over a tablet: what comes, hovers, touches, turns over and leaves, whatever the layout.
//!
//! The legal transitions are those of Microsoft's pen state table (as Linux's `test_tablet.py` checks them): the two
//! ends of a pen never change without leaving in between, so where a device goes from one to the other in one step,
//! the old one leaves first. A report without valid place makes no sample.

use crate::codec::{PenSample, Tool};

/// What one report says about the tool; `None` where it does not say.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Frame {
    pub(super) x: Option<i64>,
    pub(super) y: Option<i64>,
    pub(super) pressure: Option<i64>,
    pub(super) tilt_x: Option<i64>,
    pub(super) tilt_y: Option<i64>,
    pub(super) twist: Option<i64>,
    pub(super) distance: Option<i64>,
    pub(super) wheel: Option<i64>,
    pub(super) in_range: Option<bool>,
    pub(super) proximity: Option<bool>,
    pub(super) ready: Option<bool>,
    pub(super) tip: Option<bool>,
    pub(super) eraser: Option<bool>,
    pub(super) invert: Option<bool>,
    pub(super) buttons: u32,
    /// Which buttons the report speaks of.
    pub(super) buttons_told: u32,
    pub(super) serial: Option<u64>,
    pub(super) tool_type: Option<u32>,
}

/// Who is over the surface.
#[derive(Clone, Debug, Default)]
pub(super) struct Held {
    sample: Option<PenSample>,
    /// What the tool said when it came.
    entered: Entered,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Entered {
    tool: Option<Tool>,
    serial: Option<u64>,
    tool_type: Option<u32>,
}

impl Held {
    /// Whether a tool is in range.
    pub(super) fn is_some(&self) -> bool {
        self.sample.is_some()
    }

    /// A tool comes and says which it is; its place follows with the next report.
    pub(super) fn enter(&mut self, frame: &Frame, tool: Option<Tool>, emit: &mut dyn FnMut(PenSample)) {
        let entered = Entered {
            tool,
            serial: frame.serial,
            tool_type: frame.tool_type,
        };
        if self.sample.is_some() && entered != self.entered {
            self.leave(emit);
        }
        self.entered = entered;
    }

    /// The tool leaves, or is taken to have left.
    pub(super) fn leave(&mut self, emit: &mut dyn FnMut(PenSample)) {
        if let Some(sample) = self.sample.take() {
            emit(sample.leaving());
        }
        self.entered = Entered::default();
    }

    /// The tool reports. False where the report has no place to report although it should.
    pub(super) fn report(
        &mut self,
        frame: &Frame,
        named: Option<Tool>,
        tip_from_counts: u32,
        emit: &mut dyn FnMut(PenSample),
    ) -> bool {
        if frame.in_range == Some(false) {
            self.leave(emit);
            return true;
        }
        if frame.proximity == Some(false) {
            return true;
        }
        let tool = self.tool_of(frame, named);
        let before = self.sample;
        // Firmware says 0 until it has heard a pen's number: that is no other pen.
        let told = frame.serial.filter(|&serial| serial != 0).or(self.entered.serial);
        let serial = told.or(before.and_then(|held| held.tool_serial));
        let other = |was: u64| told.is_some_and(|told| told != was);
        let stranger = |held: &PenSample| held.tool != tool || held.tool_serial.is_some_and(other);
        if before.is_some_and(|held| stranger(&held)) {
            let entered = self.entered;
            self.leave(emit);
            self.entered = entered;
        }
        let serial = self.sample.map_or(told, |_| serial);
        let before = self.sample;
        let count = |now: Option<i64>, was: fn(PenSample) -> u32| match now {
            Some(now) => Some(u32::try_from(now.max(0)).unwrap_or(u32::MAX)),
            None => before.map(was),
        };
        let (Some(x), Some(y)) = (
            count(frame.x, |held| held.x_counts),
            count(frame.y, |held| held.y_counts),
        ) else {
            return false;
        };
        let mut sample = PenSample {
            tool_serial: serial,
            tool_type: frame
                .tool_type
                .filter(|&kind| kind != 0)
                .or(self.entered.tool_type),
            ..PenSample::hovering(tool, x, y)
        };
        frame.press(&mut sample, before.as_ref(), tip_from_counts);
        frame.lean(&mut sample, before.as_ref());
        self.sample = Some(sample);
        emit(sample);
        true
    }

    fn tool_of(&self, frame: &Frame, named: Option<Tool>) -> Tool {
        let turned = frame.invert == Some(true) || frame.eraser == Some(true);
        match self.entered.tool.or(named).unwrap_or(Tool::Pen) {
            Tool::Pen if turned => Tool::Eraser,
            tool => tool,
        }
    }
}

impl Frame {
    /// Tip, pressure and buttons; what this report leaves out stays as it was.
    fn press(&self, sample: &mut PenSample, before: Option<&PenSample>, tip_from_counts: u32) {
        if self.ready == Some(false) {
            return;
        }
        let stylus = matches!(sample.tool, Tool::Pen | Tool::Eraser);
        let told = self.buttons_told;
        sample.buttons = self.buttons & told | before.map_or(0, |held| held.buttons & !told);
        sample.pressure_counts = match self.pressure {
            Some(pressure) if stylus => u32::try_from(pressure.max(0)).unwrap_or(u32::MAX),
            None if stylus => before.map_or(0, |held| held.pressure_counts),
            _ => 0,
        };
        // With a bit for holding it the other way round, the eraser's bit is its contact.
        let rubs = self.invert.is_some() && self.eraser == Some(true);
        sample.tip = match (self.tip, self.pressure) {
            _ if !stylus => false,
            (Some(tip), _) => tip || rubs,
            (None, _) if rubs => true,
            (None, Some(pressure)) => pressure > i64::from(tip_from_counts),
            (None, None) => before.is_some_and(|held| held.tip),
        };
    }

    /// Tilt, twist, distance and wheel.
    fn lean(&self, sample: &mut PenSample, before: Option<&PenSample>) {
        let narrow = |value: i64| value.clamp(i16::MIN.into(), i16::MAX.into()) as i16;
        sample.tilt = match (self.tilt_x, self.tilt_y) {
            (None, None) => before.and_then(|held| held.tilt),
            (x, y) => Some([narrow(x.unwrap_or(0)), narrow(y.unwrap_or(0))]),
        };
        sample.twist = self.twist.map(narrow).or(before.and_then(|held| held.twist));
        let distance = self.distance.map(|value| value.clamp(0, u16::MAX.into()) as u16);
        sample.distance = distance.or(before.and_then(|held| held.distance));
        sample.wheel = self.wheel.map_or(0, narrow);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(x: i64, y: i64) -> Frame {
        Frame {
            x: Some(x),
            y: Some(y),
            in_range: Some(true),
            tip: Some(false),
            ..Frame::default()
        }
    }

    fn said(held: &mut Held, frame: Frame) -> Vec<(Tool, bool, bool)> {
        let mut all = Vec::new();
        held.report(&frame, None, 10, &mut |s| all.push((s.tool, s.in_range, s.tip)));
        all
    }

    /// Microsoft's states, as in-range, tip, invert and eraser bits.
    #[test]
    fn ends_of_a_pen_change_only_by_leaving() {
        let state = |tip, invert, eraser| Frame {
            tip: Some(tip),
            invert: Some(invert),
            eraser: Some(eraser),
            ..at(1, 2)
        };
        let gone = Frame {
            in_range: Some(false),
            ..at(0, 0)
        };
        let mut held = Held::default();
        let (pen, eraser) = (Tool::Pen, Tool::Eraser);
        let rows = [
            (state(false, false, false), vec![(pen, true, false)]),
            (state(true, false, false), vec![(pen, true, true)]),
            // Straight to the eraser's end: the point leaves first.
            (
                state(false, true, false),
                vec![(pen, false, false), (eraser, true, false)],
            ),
            (state(false, false, true), vec![(eraser, true, true)]),
            (state(false, true, false), vec![(eraser, true, false)]),
            (gone, vec![(eraser, false, false)]),
            (gone, vec![]),
            (state(false, false, true), vec![(eraser, true, true)]),
        ];
        for (nth, (frame, want)) in rows.into_iter().enumerate() {
            assert_eq!(said(&mut held, frame), want, "step {nth}");
        }
    }

    #[test]
    fn a_place_that_is_not_valid_makes_no_sample() {
        let mut held = Held::default();
        said(&mut held, at(5, 6));
        let lost = Frame {
            proximity: Some(false),
            ..at(0, 0)
        };
        assert_eq!(said(&mut held, lost), []);
        assert!(held.is_some());
        let mut nowhere = Held::default();
        assert!(!nowhere.report(
            &Frame {
                in_range: Some(true),
                ..Frame::default()
            },
            None,
            10,
            &mut |_| panic!("no place"),
        ));
    }

    #[test]
    fn what_is_not_ready_presses_nothing() {
        let frame = Frame {
            ready: Some(false),
            tip: Some(true),
            pressure: Some(99),
            buttons: 1,
            buttons_told: 3,
            ..at(1, 1)
        };
        let mut all = Vec::new();
        Held::default().report(&frame, None, 10, &mut |s| all.push(s));
        assert_eq!(all, [PenSample::hovering(Tool::Pen, 1, 1)]);
    }

    #[test]
    fn a_report_about_less_keeps_the_rest() {
        let mut held = Held::default();
        let full = Frame {
            pressure: Some(300),
            tip: None,
            tilt_x: Some(5),
            tilt_y: Some(-5),
            buttons: 2,
            buttons_told: 3,
            ..at(10, 20)
        };
        said(&mut held, full);
        let turned = Frame {
            twist: Some(-90),
            x: Some(11),
            y: Some(20),
            ..Frame::default()
        };
        let mut all = Vec::new();
        held.report(&turned, None, 10, &mut |s| all.push(s));
        let want = PenSample {
            pressure_counts: 300,
            tip: true,
            tilt: Some([5, -5]),
            twist: Some(-90),
            buttons: 2,
            ..PenSample::hovering(Tool::Pen, 11, 20)
        };
        assert_eq!(all, [want]);
    }

    #[test]
    fn another_tools_serial_is_another_tool() {
        let mut held = Held::default();
        let mut all = Vec::new();
        let enter = |serial| Frame {
            serial: Some(serial),
            tool_type: Some(0x10804),
            ..Frame::default()
        };
        held.enter(&enter(7), Some(Tool::Pen), &mut |s| all.push(s));
        held.report(&at(1, 1), None, 10, &mut |s| all.push(s));
        held.enter(&enter(8), Some(Tool::Eraser), &mut |s| all.push(s));
        held.report(&at(2, 2), Some(Tool::Pen), 10, &mut |s| all.push(s));
        let seen: Vec<_> = all.iter().map(|s| (s.tool, s.tool_serial, s.in_range)).collect();
        assert_eq!(
            seen,
            [
                (Tool::Pen, Some(7), true),
                (Tool::Pen, Some(7), false),
                (Tool::Eraser, Some(8), true)
            ]
        );
    }
}
