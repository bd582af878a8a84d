//! What the codecs of serial devices are told, out of a profile.
//!
//! Apart from the codecs, which know bytes and nothing of files.

use super::calcomp::{CalComp, Code, Meaning};
use super::deej::{Deej, Key};
use super::dial_reports::{Counts, DialReports, Maker};
use super::firmata::{Firmata, Lamp, Switch};
use super::gtco::Gtco;
use super::mm::{Buttons, Framing, Mm};
use super::monome_arc::MonomeArc;
use super::wacom_v::WacomV;
use super::{Codec, Surface, Tool, calcomp, deej, dial_reports, firmata, gtco, mm, monome_arc, wacom_v};
use device_profiles::{ControlClass, ControlKind, InputProfile, MmFraming, OutputKind};
use std::time::Duration;

/// The codec of a serial format, for a device that `reports` already or has yet to be asked; `None` for other formats.
pub fn codec(profile: &InputProfile, reports: bool) -> Option<Box<dyn Codec>> {
    // Each has the two ways of beginning, by the same names.
    macro_rules! either {
        ($codec:ident, $settings:expr) => {
            if reports {
                Box::new($codec::listening($settings))
            } else {
                Box::new($codec::new($settings))
            }
        };
    }
    Some(match profile.format.as_str() {
        "wacom-v" => either!(WacomV, wacom_v(profile)),
        "mm" => either!(Mm, mm(profile)),
        "calcomp" => either!(CalComp, calcomp(profile)),
        "gtco" => either!(Gtco, gtco(profile)),
        "monome-arc" => either!(MonomeArc, monome_arc(profile)),
        "firmata" => either!(Firmata, firmata(profile)),
        // A board that prints lines is not asked for anything.
        "deej" => Box::new(Deej::new(deej(profile))),
        "spectragraphics-dial-box" => either!(DialReports, dial_reports(profile, Maker::Spectragraphics)),
        "hp-dial-box" => {
            let absolute = profile.hp.is_none_or(|hp| hp.absolute);
            let counts = if absolute { Counts::Absolute } else { Counts::Moved };
            either!(
                DialReports,
                dial_reports(profile, Maker::HewlettPackard { counts })
            )
        }
        _ => return None,
    })
}

fn surface(profile: &InputProfile) -> Surface {
    let area = profile.area();
    Surface {
        tilt_signs: [1; 2],
        max_counts: area.counts,
        counts_per_inch: area.per_inch(),
        pressure_max: area.pressure,
        tilt_steps_per_rad: area.tilt_steps_per_rad,
        twist_steps_per_turn: area.twist_steps_per_turn.map(f64::from),
    }
}

/// What lies on the tablet when nothing says so: the first tool of its profile.
fn tool(profile: &InputProfile) -> Tool {
    match profile.tools.first().map(|t| t.tool) {
        Some(device_profiles::Tool::Pen) => Tool::Pen,
        _ => Tool::Puck,
    }
}

fn leave_after(profile: &InputProfile) -> Option<Duration> {
    profile.leave_after_ms.map(|ms| Duration::from_millis(ms.into()))
}

/// Whole lines per inch, as tablets are told them.
fn lines_per_inch(profile: &InputProfile) -> u32 {
    let [x, _] = profile.area().per_inch();
    x.round() as u32
}

fn wacom_v(profile: &InputProfile) -> wacom_v::Settings {
    wacom_v::Settings {
        prefix: profile.answer_prefix().to_owned(),
        baud: profile.baud(),
        surface: surface(profile),
        tip_pressure: profile.area().tip_pressure.unwrap_or(0),
    }
}

fn mm(profile: &InputProfile) -> mm::Settings {
    let mm = profile.mm;
    mm::Settings {
        framing: match mm.map(|mm| mm.framing) {
            Some(MmFraming::Relative) => Framing::Relative,
            Some(MmFraming::Flair) => Framing::Flair,
            Some(MmFraming::Ascii) => Framing::Ascii,
            Some(MmFraming::Absolute) | None => Framing::Absolute,
        },
        tool: tool(profile),
        buttons: if mm.is_some_and(|mm| mm.buttons_are_bits) {
            Buttons::Mask
        } else {
            Buttons::Number
        },
        lines_per_inch: lines_per_inch(profile),
        increment: mm.map_or(0, |mm| mm.increment),
        y_up: mm.is_some_and(|mm| mm.y_up),
        surface: surface(profile),
        leave_after: leave_after(profile),
    }
}

fn meaning(profile: &InputProfile) -> Meaning {
    let packets = profile.calcomp.unwrap_or_default();
    let tip = profile.area().tip_pressure.unwrap_or(0);
    Meaning {
        tool: tool(profile),
        proximity_bit: packets
            .proximity_bit
            .map_or(0, |bit| 1_u8.checked_shl(bit.into()).unwrap_or(0)),
        code: if packets.pressure_for_buttons {
            Code::Pressure {
                tip: u8::try_from(tip).unwrap_or(u8::MAX),
            }
        } else {
            Code::Buttons
        },
        y_up: packets.y_up,
    }
}

fn calcomp(profile: &InputProfile) -> calcomp::Settings {
    calcomp::Settings {
        meaning: meaning(profile),
        lines_per_inch: lines_per_inch(profile),
        surface: surface(profile),
        leave_after: leave_after(profile),
    }
}

fn gtco(profile: &InputProfile) -> gtco::Settings {
    gtco::Settings {
        meaning: meaning(profile),
        surface: surface(profile),
    }
}

fn monome_arc(profile: &InputProfile) -> monome_arc::Settings {
    monome_arc::Settings {
        rings: narrow(profile.count(ControlClass::Dial)),
    }
}

fn dial_reports(profile: &InputProfile, maker: Maker) -> dial_reports::Settings {
    dial_reports::Settings {
        maker,
        dials: narrow(profile.count(ControlClass::Dial)),
    }
}

fn narrow(count: u16) -> u8 {
    u8::try_from(count).unwrap_or(u8::MAX)
}

fn deej(profile: &InputProfile) -> deej::Settings {
    let knob = profile.controls.first();
    let lines = profile.lines.as_ref();
    let label = lines.and_then(|lines| lines.label.as_deref());
    deej::Settings {
        controls: profile.count(ControlClass::Axis),
        separator: lines
            .and_then(|lines| lines.separator.bytes().next())
            .unwrap_or(b'|'),
        key: label
            .and_then(|label| label.split_once("{n}"))
            .map(|(before, after)| Key {
                before: before.to_owned(),
                after: after.to_owned(),
            }),
        hexadecimal: lines.is_some_and(|lines| lines.hexadecimal),
        max: knob.and_then(|knob| knob.range).map_or(1023, |[_, most]| most),
        noise: knob.and_then(|knob| knob.noise_share).unwrap_or(0.0),
        invert: lines.is_some_and(|lines| lines.inverted),
    }
}

fn firmata(profile: &InputProfile) -> firmata::Settings {
    let of_class = |class| profile.controls.iter().filter(move |c| c.kind.class() == class);
    let knobs = || of_class(ControlClass::Axis);
    let buttons = profile.controls.iter().filter(|c| c.kind == ControlKind::Button);
    let lamps = profile.outputs.iter().filter(|o| o.kind == OutputKind::Lamp);
    firmata::Settings {
        analog: knobs().flat_map(|c| c.pins.iter().copied()).collect(),
        analog_max: knobs().find_map(|c| c.range).map_or(1023, |[_, most]| most),
        digital: buttons
            .flat_map(|c| {
                c.pins.iter().map(|&pin| Switch {
                    pin,
                    pull_up: c.pull_up,
                })
            })
            .collect(),
        encoders: of_class(ControlClass::Dial)
            .flat_map(|c| c.pins.chunks_exact(2).map(|pair| [pair[0], pair[1]]))
            .collect(),
        lamps: lamps
            .flat_map(|o| {
                let dimmed = o.levels.is_some_and(|levels| levels > 2);
                o.pins.iter().map(move |&pin| Lamp { pin, dimmed })
            })
            .collect(),
        // The protocol's own, 19 ms, unless the profile has another.
        interval_ms: profile.firmata.map_or(firmata::INTERVAL_MS, |f| f.interval_ms),
        boot_wait_ms: profile.line.map_or(0, |line| line.boot_wait_ms.into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use device_profiles::Profiles;

    #[test]
    fn every_serial_profile_gets_a_codec_with_its_own_area() {
        let all = Profiles::builtin();
        let serial = [
            "wacom-v",
            "mm",
            "calcomp",
            "gtco",
            "monome-arc",
            "firmata",
            "deej",
            "spectragraphics-dial-box",
            "hp-dial-box",
        ];
        let mut formats = std::collections::BTreeSet::new();
        for profile in all.inputs() {
            for reports in [false, true] {
                let Some(made) = codec(profile, reports) else {
                    assert!(!serial.contains(&profile.format.as_str()), "{}", profile.key);
                    continue;
                };
                formats.insert(profile.format.clone());
                let relative = profile.mm.is_some_and(|mm| mm.framing == MmFraming::Relative);
                let area = profile.surface.filter(|_| !relative).map(|area| area.counts);
                assert_eq!(made.surface().map(|s| s.max_counts), area, "{}", profile.key);
            }
        }
        assert_eq!(formats.len(), serial.len(), "each is used: {formats:?}");
    }

    #[test]
    fn pins_labels_and_bits_are_where_the_profile_has_them() {
        let all = Profiles::builtin();
        let of = |key: &str| all.input(key).expect("it is built in");
        let board = firmata(of("firmata"));
        assert_eq!(board.encoders, [[2, 3], [4, 5]]);
        assert_eq!(board.digital.len(), 4);
        assert!(board.digital.iter().all(|switch| switch.pull_up));
        assert_eq!(board.lamps.iter().filter(|lamp| lamp.dimmed).count(), 1);
        let labelled = deej(of("csv-lines")).key.expect("it names its controls");
        assert_eq!((labelled.before.as_str(), labelled.after.as_str()), ("A", ":"));
        assert_eq!(meaning(of("drawingboard")).proximity_bit, 0x40);
        assert_eq!(
            meaning(of("drawingboard-pressure")).code,
            Code::Pressure { tip: 16 }
        );
        assert_eq!(mm(of("bit-pad-two")).lines_per_inch, 200);
        assert_eq!(wacom_v(of("intuos2-serial")).prefix, "XD");
    }
}
