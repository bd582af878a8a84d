//! Wacom's serial protocol IV: Graphire, Digitizer II and their like.
//!
//! Source: `docs/protocols/wacom-iv.md`.

pub(in crate::codec) mod answer;
mod conversation;
mod packet;

use super::{Codec, Counters, Feedback, InputEvent, Outgoing, PenSample, Surface, Tool};
use crate::clock::Instant;
use answer::Identity;
use conversation::Conversation;
use device_profiles::{InputProfile, Tool as ToolKind};
use packet::{Format, Packets, Raw};
use std::time::Duration;

/// A packet is nine bytes at most, 9.4 ms at 9600 baud; one that has not ended long after that never will.
const PACKET_LIMIT: Duration = Duration::from_millis(100);

/// The host's side of the tablet.
#[derive(Debug)]
pub struct WacomIv {
    profile: InputProfile,
    conversation: Conversation,
    /// Whether `Started` has been said.
    known: bool,
    identity: Option<Identity>,
    surface: Surface,
    packets: Packets,
    /// When an unfinished packet was first noticed.
    unfinished_since: Option<Instant>,
    /// The last sample of a tool in range.
    held: Option<PenSample>,
    counters: Counters,
}

impl WacomIv {
    /// For a tablet that has yet to be asked.
    pub fn new(profile: &InputProfile) -> Self {
        let surface = surface_of(profile);
        Self {
            profile: profile.clone(),
            conversation: Conversation::default(),
            known: false,
            identity: None,
            packets: Packets::new(Format::new(profile, None)),
            surface,
            unfinished_since: None,
            held: None,
            counters: Counters::default(),
        }
    }

    /// For a recording that begins when the tablet already reports, set up as [`Codec::start`] does.
    pub fn listening(profile: &InputProfile) -> Self {
        let mut codec = Self::new(profile);
        codec.conversation = Conversation::Running;
        codec.known = true;
        codec
    }

    /// A byte while questions are open: part of an answer, or left over from before.
    fn take_answer_byte(&mut self, byte: u8) {
        let Some(line) = self.conversation.push(byte) else {
            return;
        };
        let question = self.conversation.question();
        match question.and_then(|q| answer::read(q, &line)) {
            Some(answer) => {
                self.counters.reports += 1;
                self.conversation.answered();
                self.learn(answer);
            }
            None => self.counters.rejected += 1,
        }
    }

    fn learn(&mut self, answer: answer::Answer) {
        match answer {
            answer::Answer::Identity(identity) => {
                if !identity.model.starts_with(self.profile.answer_prefix()) {
                    // Another model than the profile's: its own numbers still hold where it gives them.
                    self.counters.rejected += 1;
                }
                self.packets = Packets::new(Format::new(&self.profile, Some(&identity)));
                self.surface.pressure_max = self.packets.format().pressure_max.into();
                self.identity = Some(identity);
            }
            answer::Answer::Size(counts) => self.surface.max_counts = counts.map(u32::from),
            answer::Answer::Resolution(lines) => self.surface.counts_per_inch = lines.map(f64::from),
        }
    }

    fn take_packet(&mut self, raw: Raw, emit: &mut dyn FnMut(InputEvent)) {
        self.counters.reports += 1;
        if !raw.in_range {
            self.let_go(emit);
            return;
        }
        let tool = self.tool_of(raw);
        if self.held.is_some_and(|held| held.tool != tool) {
            self.let_go(emit);
        }
        let sample = self.sample(raw, tool);
        self.held = Some(sample);
        emit(InputEvent::Pen(sample));
    }

    /// Where the eraser shares its bit with the pen's second button, only coming into range tells them apart
    /// (xf86-input-wacom does the same).
    fn tool_of(&self, raw: Raw) -> Tool {
        if !raw.stylus {
            return Tool::Puck;
        }
        let eraser_bit = self.profile.wacom.as_ref().map_or(0, |w| w.eraser_bit);
        let shared = usize::from(eraser_bit) <= usize::from(self.buttons_of(ToolKind::Pen));
        match self.held {
            Some(PenSample {
                tool: tool @ (Tool::Pen | Tool::Eraser),
                ..
            }) if shared => tool,
            _ if raw.buttons >> eraser_bit & 1 == 1 => Tool::Eraser,
            _ => Tool::Pen,
        }
    }

    fn buttons_of(&self, kind: ToolKind) -> u8 {
        self.profile.tool_buttons(kind)
    }

    fn sample(&self, raw: Raw, tool: Tool) -> PenSample {
        let (kind, side_buttons) = match tool {
            Tool::Pen => (ToolKind::Pen, raw.buttons >> 1),
            Tool::Eraser => (ToolKind::Eraser, raw.buttons >> 1),
            Tool::Puck | Tool::Mouse => (ToolKind::Puck, raw.buttons),
        };
        let stylus = tool != Tool::Puck;
        // Bits of buttons that the tool does not have mean something else, as the eraser's does.
        let there = (1_u16 << self.buttons_of(kind).min(8)) - 1;
        let has_wheel = self
            .profile
            .tools
            .iter()
            .any(|t| t.tool == ToolKind::Puck && t.wheel == Some(true));
        PenSample {
            pressure_counts: if stylus { raw.pressure.into() } else { 0 },
            buttons: (side_buttons & there as u8).into(),
            tip: stylus && raw.buttons & 1 == 1,
            tilt: raw.tilt.filter(|_| stylus).map(|tilt| tilt.map(i16::from)),
            wheel: if !stylus && has_wheel { raw.wheel.into() } else { 0 },
            ..PenSample::hovering(tool, raw.x.into(), raw.y.into())
        }
    }

    fn give_up_late_packet(&mut self, now: Instant) {
        if !self.packets.unfinished() {
            self.unfinished_since = None;
            return;
        }
        let since = *self.unfinished_since.get_or_insert(now);
        if now.since(since) > PACKET_LIMIT {
            self.packets.reset();
            self.unfinished_since = None;
            self.counters.rejected += 1;
        }
    }
}

impl Codec for WacomIv {
    fn start(&mut self, now: Instant, out: &mut Outgoing) {
        self.packets.reset();
        self.conversation = Conversation::begin(now, out);
    }

    fn decode(&mut self, bytes: &[u8], emit: &mut dyn FnMut(InputEvent)) {
        for &byte in bytes {
            if !matches!(self.conversation, Conversation::Running) {
                self.take_answer_byte(byte);
                continue;
            }
            let pushed = self.packets.push(byte);
            self.counters.unknown += u64::from(pushed.unknown);
            self.counters.rejected += u64::from(pushed.rejected);
            if pushed.rejected {
                // What begins in place of something unfinished has a time of its own.
                self.unfinished_since = None;
            }
            for raw in pushed.packets.into_iter().flatten() {
                // The next one has its own time.
                self.unfinished_since = None;
                self.take_packet(raw, emit);
            }
        }
    }

    fn advance(&mut self, now: Instant, out: &mut Outgoing, emit: &mut dyn FnMut(InputEvent)) {
        self.give_up_late_packet(now);
        if let Some(line) = self.conversation.unended_answer(now) {
            // A PenPartner ends its answers with silence instead of a return.
            match self.conversation.question().and_then(|q| answer::read(q, &line)) {
                Some(answer) => {
                    self.counters.reports += 1;
                    self.learn(answer);
                    self.conversation.answered();
                }
                None => self.counters.rejected += 1,
            }
        }
        let tilt = self.packets.format().tilt;
        if self.conversation.advance(now, &self.profile, tilt, out) {
            emit(if self.known {
                InputEvent::Restarted
            } else {
                InputEvent::Started
            });
            self.known = true;
        }
    }

    /// A tablet of this kind shows nothing.
    fn encode(&mut self, _feedback: &Feedback, _out: &mut Outgoing) {}

    fn let_go(&mut self, emit: &mut dyn FnMut(InputEvent)) {
        if let Some(held) = self.held.take() {
            emit(InputEvent::Pen(held.leaving()));
        }
    }

    fn started(&self) -> bool {
        matches!(self.conversation, Conversation::Running)
    }

    fn counters(&self) -> Counters {
        self.counters
    }

    fn surface(&self) -> Option<Surface> {
        Some(self.surface)
    }

    fn identity(&self) -> Option<&str> {
        self.identity.as_ref().map(|i| i.text.as_str())
    }
}

fn surface_of(profile: &InputProfile) -> Surface {
    let area = profile.area();
    Surface {
        tilt_steps_per_rad: area.tilt_steps_per_rad,
        ..Surface::flat(area.counts, area.per_inch(), area.pressure)
    }
}

#[cfg(test)]
mod tests;
