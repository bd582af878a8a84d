//! Takes as files: `takes/NAME.toml` in the show folder. What devices said stands in it in the words of exchanges.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use device::exchange::{self, Exchange, time_words};
use glam::DVec3;
use motion::{FigurePose, LinkPose};
use serde::{Deserialize, Serialize};

use super::{Heard, Reel, STEPS_MAX, StageStart, Start, Take};
use crate::command::{Command, Side};
use crate::controls::standing::DeviceStanding;
use crate::controls_calibration::ControlsCalibration;
use crate::document::FileError;
use crate::snapshot::{TransportView, ViewState};

/// The version written. Version 1 does not say how the controls stood.
const VERSION: u64 = 2;

#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    version: u64,
    /// Steps as `COUNTxNANOSECONDS` apart, the first from the start.
    steps: String,
    /// `STEP JSON`, one a line.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    commands: String,
    start: StartFile,
    #[serde(default, rename = "device", skip_serializing_if = "Vec::is_empty")]
    devices: Vec<DeviceFile>,
}

#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(clippy::struct_excessive_bools, reason = "each is a fact of its own")]
struct StartFile {
    /// Seconds since the rig began.
    at: String,
    frame: u64,
    clip: String,
    secs: f64,
    playing: bool,
    looped: bool,
    speed: f64,
    azimuth_rad: f64,
    elevation_rad: f64,
    scale: f64,
    centre: [f64; 3],
    coefficient: usize,
    program: String,
    network: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    stage: Option<StageFile>,
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    joints_rad: BTreeMap<String, f64>,
    #[serde(default)]
    joints_by_hand: bool,
    #[serde(default)]
    step: u64,
    #[serde(default)]
    fine: bool,
    #[serde(default, skip_serializing_if = "String::is_empty")]
    focus: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    joint_in_hand: Option<String>,
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    controls: BTreeMap<String, DeviceStanding>,
}

#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct StageFile {
    selected: u16,
    side: Side,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    cursor: Option<[f64; 2]>,
    posing: bool,
    root: [f64; 3],
    /// Direction, twist in radians and length of each link.
    links: Vec<[f64; 5]>,
}

#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct DeviceFile {
    name: String,
    profile: String,
    address: String,
    #[serde(default)]
    reports: bool,
    opened: String,
    before: String,
    during: String,
    #[serde(default, skip_serializing_if = "ControlsCalibration::is_empty")]
    calibration: ControlsCalibration,
}

/// The text of a take.
pub(crate) fn write(take: &Take) -> String {
    let commands = take.commands.iter().filter_map(|(step, command)| {
        // Commands are plain data and were written to journals before.
        Some(format!("{step} {}\n", serde_json::to_string(command).ok()?))
    });
    let device = |(name, heard): (&String, &Heard)| DeviceFile {
        name: name.clone(),
        profile: heard.profile.clone(),
        address: heard.address.clone(),
        reports: heard.reports,
        calibration: heard.calibration.clone(),
        opened: time_words(heard.opened),
        before: said(&heard.before),
        during: said(&heard.during),
    };
    let file = File {
        version: VERSION,
        steps: steps_text(take.start.at, &take.steps),
        commands: commands.collect(),
        start: start_file(&take.start),
        devices: take.devices.iter().map(device).collect(),
    };
    // All of it are texts, numbers and tables of them, which TOML has.
    toml::to_string_pretty(&file).unwrap_or_default()
}

fn said(said: &Reel) -> String {
    let mut text = String::from("\n");
    for record in said.records() {
        exchange::write_record(&mut text, &record);
    }
    text
}

/// Times as runs of equal distances: a rig that keeps its period is one line, however long.
fn steps_text(from: Duration, steps: &[Duration]) -> String {
    let (mut runs, mut before): (Vec<(u64, u128)>, Duration) = (Vec::new(), from);
    for &step in steps {
        let apart = step.saturating_sub(before).as_nanos();
        before = step;
        match runs.last_mut() {
            Some((count, same)) if *same == apart => *count += 1,
            _ => runs.push((1, apart)),
        }
    }
    let mut text = String::from("\n");
    for chunk in runs.chunks(8) {
        let words: Vec<String> = chunk
            .iter()
            .map(|(count, apart)| format!("{count}x{apart}"))
            .collect();
        text.push_str(&words.join(" "));
        text.push('\n');
    }
    text
}

fn start_file(start: &Start) -> StartFile {
    let transport = &start.transport;
    StartFile {
        at: time_words(start.at),
        frame: start.frame,
        clip: start.clip.clone(),
        secs: transport.secs,
        playing: transport.playing,
        looped: transport.looped,
        speed: transport.speed,
        azimuth_rad: start.view.azimuth_rad,
        elevation_rad: start.view.elevation_rad,
        scale: start.view.scale,
        centre: start.view.centre.to_array(),
        coefficient: start.coefficient,
        program: start.program.clone(),
        network: start.network.clone(),
        stage: start.stage.as_ref().map(stage_file),
        joints_rad: start.joints_rad.clone(),
        joints_by_hand: start.joints_by_hand,
        step: start.step,
        fine: start.fine,
        focus: start.focus.clone(),
        joint_in_hand: start.joint_in_hand.clone(),
        controls: start.controls.clone(),
    }
}

fn stage_file(stage: &StageStart) -> StageFile {
    let link = |link: &LinkPose| {
        let [x, y, z] = link.direction.to_array();
        [x, y, z, link.twist_rad, link.length]
    };
    StageFile {
        selected: stage.selected,
        side: stage.side,
        cursor: stage.cursor,
        posing: stage.posing,
        root: stage.pose.root.to_array(),
        links: stage.pose.links.iter().map(link).collect(),
    }
}

/// Reads a take. The error names the file and the place.
pub(crate) fn read(path: &Path, text: &str) -> Result<Take, FileError> {
    let fault = |at: usize, message: String| at_byte(path, text, at, message);
    let file: File = toml::from_str(text).map_err(|error| {
        fault(
            error.span().map_or(0, |span| span.start),
            error.message().to_owned(),
        )
    })?;
    if !(1..=VERSION).contains(&file.version) {
        let message = format!(
            "this take has version {}; versions 1 to {VERSION} are known here",
            file.version
        );
        return Err(fault(0, message).with_hint("it was written by a newer dialrig: update this one"));
    }
    let within =
        |part: &str, message: String| fault(text.find(part).unwrap_or(0), format!("{part}: {message}"));
    let at = time(&file.start.at).ok_or_else(|| within("at", "expected seconds".into()))?;
    let steps = read_steps(at, &file.steps).map_err(|message| within("steps", message))?;
    let commands =
        read_commands(&file.commands, steps.len()).map_err(|message| within("commands", message))?;
    let mut devices = BTreeMap::new();
    for device in file.devices {
        let name = device.name.clone();
        let heard = read_device(device).map_err(|message| within("device", format!("{name}: {message}")))?;
        if devices.insert(name.clone(), heard).is_some() {
            return Err(within("device", format!("{name} is there twice")));
        }
    }
    let start = read_start(file.start, at);
    if let Some(what) = unsound(&start) {
        return Err(within("start", format!("{what} must be a finite number")));
    }
    Ok(Take {
        start: Arc::new(start),
        steps,
        commands,
        devices,
    })
}

fn at_byte(path: &Path, text: &str, at: usize, message: String) -> FileError {
    let before = text.get(..at).unwrap_or_default();
    let line = before.rsplit('\n').next().unwrap_or_default();
    FileError {
        line: before.matches('\n').count() as u32 + 1,
        column: line.chars().count() as u32 + 1,
        ..FileError::whole(path, message)
    }
}

/// Seconds in the words of exchanges.
fn time(text: &str) -> Option<Duration> {
    let record = exchange::read(&format!("pause @ {text}")).ok()?;
    record.records.first()?.at
}

fn read_steps(from: Duration, text: &str) -> Result<Vec<Duration>, String> {
    let mut steps = Vec::new();
    let mut at = from;
    for word in text.split_whitespace() {
        let run = word
            .split_once('x')
            .and_then(|(count, apart)| Some((count.parse::<usize>().ok()?, apart.parse::<u64>().ok()?)));
        let Some((count, apart)) = run else {
            return Err(format!("expected COUNTxNANOSECONDS, found `{word}`"));
        };
        if count > STEPS_MAX - steps.len() {
            return Err(format!("more than {STEPS_MAX} steps"));
        }
        for _ in 0..count {
            at = at
                .checked_add(Duration::from_nanos(apart))
                .ok_or("the end of time is passed")?;
            steps.push(at);
        }
    }
    Ok(steps)
}

fn read_commands(text: &str, steps: usize) -> Result<Vec<(usize, Command)>, String> {
    let mut commands: Vec<(usize, Command)> = Vec::new();
    for line in text.lines().filter(|line| !line.trim().is_empty()) {
        let (step, json) = line
            .split_once(' ')
            .ok_or_else(|| format!("expected a step and a command, found `{line}`"))?;
        let step: usize = step
            .parse()
            .ok()
            .filter(|&step| step < steps && commands.last().is_none_or(|(before, _)| *before <= step))
            .ok_or_else(|| {
                format!("expected a step below {steps}, not before the last one, found `{step}`")
            })?;
        commands.push((
            step,
            serde_json::from_str(json).map_err(|error| error.to_string())?,
        ));
    }
    Ok(commands)
}

fn read_device(file: DeviceFile) -> Result<Heard, String> {
    let records = |text: &str| -> Result<Reel, String> {
        let read: Exchange = exchange::read(text).map_err(|errors| {
            let words: Vec<String> = errors.iter().map(ToString::to_string).collect();
            words.join("; ")
        })?;
        Ok(read.records.into_iter().collect())
    };
    if let Some(fault) = file.calibration.unsound() {
        return Err(format!("calibration: {fault}"));
    }
    Ok(Heard {
        reports: file.reports,
        calibration: file.calibration,
        opened: time(&file.opened).ok_or("expected seconds as `opened`")?,
        before: records(&file.before)?,
        during: records(&file.during)?,
        profile: file.profile,
        address: file.address,
    })
}

fn read_start(file: StartFile, at: Duration) -> Start {
    Start {
        at,
        frame: file.frame,
        program: file.program,
        network: file.network,
        clip: file.clip,
        stage: file.stage.as_ref().map(read_stage),
        joints_rad: file.joints_rad,
        joints_by_hand: file.joints_by_hand,
        transport: TransportView {
            secs: file.secs,
            playing: file.playing,
            looped: file.looped,
            speed: file.speed,
            ..TransportView::default()
        },
        view: ViewState {
            azimuth_rad: file.azimuth_rad,
            elevation_rad: file.elevation_rad,
            scale: file.scale,
            centre: DVec3::from_array(file.centre),
        },
        coefficient: file.coefficient,
        step: file.step,
        fine: file.fine,
        focus: file.focus,
        joint_in_hand: file.joint_in_hand,
        controls: file.controls,
    }
}

fn read_stage(file: &StageFile) -> StageStart {
    let link = |&[x, y, z, twist_rad, length]: &[f64; 5]| LinkPose {
        direction: DVec3::new(x, y, z),
        twist_rad,
        length,
    };
    StageStart {
        pose: FigurePose {
            root: DVec3::from_array(file.root),
            links: file.links.iter().map(link).collect(),
        },
        selected: file.selected,
        side: file.side,
        cursor: file.cursor,
        posing: file.posing,
    }
}

/// What of it is not finite.
fn unsound(start: &Start) -> Option<&'static str> {
    let view = &start.view;
    let numbers = [
        view.azimuth_rad,
        view.elevation_rad,
        view.scale,
        start.transport.secs,
        start.transport.speed,
    ];
    let stage = start.stage.as_ref().is_none_or(|stage| {
        let pose = &stage.pose;
        let links = pose
            .links
            .iter()
            .all(|link| link.direction.is_finite() && link.twist_rad.is_finite() && link.length.is_finite());
        pose.root.is_finite() && links && stage.cursor.is_none_or(|at| at.iter().all(|it| it.is_finite()))
    });
    if !numbers.iter().all(|it| it.is_finite()) || !view.centre.is_finite() {
        Some("every number of view and time")
    } else if !stage {
        Some("every number of the pose")
    } else if !start.joints_rad.values().all(|it| it.is_finite()) {
        Some("every joint's angle")
    } else if !start.controls.values().all(DeviceStanding::is_sound) {
        Some("every number of a control")
    } else {
        None
    }
}
