//! Whether a puppet can do a show's clips: every stretch that asks too much of a joint.

use std::path::Path;

use rig::StretchView;
use rig::feasibility::{JudgedClip, judge};
use serde::Serialize;

use crate::console::Console;
use crate::failure::Failure;
use crate::setup;

/// One stretch, for programs.
#[derive(Serialize)]
struct StretchRecord<'a> {
    show: String,
    clip: &'a str,
    puppet: &'a str,
    from_secs: f64,
    to_secs: f64,
    joint: &'a str,
    kind: &'a str,
    factor: f64,
    slowable: bool,
}

/// What a clip comes to, for programs.
#[derive(Serialize)]
struct ClipRecord<'a> {
    show: String,
    clip: &'a str,
    puppet: &'a str,
    stretches: usize,
    slow_down: f64,
    follows_within_deg: f64,
    unjudged: &'a [String],
}

/// Judges one show; true if the puppet can do all of it.
pub(super) fn check(file: &Path, puppet: &str, console: &Console) -> Result<bool, Failure> {
    let (show, _) = rig::document::convert::read_show(file)?;
    let judged = judge(&show, puppet, &*setup::profiles()?)
        .map_err(|error| Failure::refused(format!("{}: {error}", file.display())))?;
    if judged.is_empty() {
        return Err(Failure::refused(format!("{}: no clip has keys", file.display()))
            .with_hint("pose the figure, or the puppet, and store a key first"));
    }
    for clip in &judged {
        if console.json() {
            records(file, clip, puppet, console)?;
        } else {
            lines(file, clip, puppet, console)?;
        }
    }
    Ok(judged.iter().all(|clip| clip.feasibility.stretches.is_empty()))
}

fn records(file: &Path, judged: &JudgedClip, puppet: &str, console: &Console) -> Result<(), Failure> {
    let show = || file.display().to_string();
    for stretch in &*judged.feasibility.stretches {
        console.record(&StretchRecord {
            show: show(),
            clip: &judged.clip,
            puppet,
            from_secs: stretch.from_secs,
            to_secs: stretch.to_secs,
            joint: &stretch.joint,
            kind: stretch.kind.word(),
            factor: stretch.factor,
            slowable: stretch.slowable,
        })?;
    }
    console.record(&ClipRecord {
        show: show(),
        clip: &judged.clip,
        puppet,
        stretches: judged.feasibility.stretches.len(),
        slow_down: judged.feasibility.slow_down,
        follows_within_deg: judged.error_rad.to_degrees(),
        unjudged: &judged.feasibility.unjudged,
    })
}

fn lines(file: &Path, judged: &JudgedClip, puppet: &str, console: &Console) -> Result<(), Failure> {
    let feasibility = &judged.feasibility;
    let clip = &judged.clip;
    for stretch in &*feasibility.stretches {
        console.line(format_args!(
            "{}: clip {clip}: {stretch}{}",
            file.display(),
            help(stretch)
        ))?;
    }
    for words in &*feasibility.unjudged {
        console.remark(format_args!("clip {clip}: not judged: {words}"));
    }
    let error_deg = judged.error_rad.to_degrees();
    if error_deg > 0.0 {
        console.remark(format_args!(
            "clip {clip}: {puppet} follows within {error_deg:.1} degrees of the figure"
        ));
    }
    match feasibility.stretches.len() {
        0 => console.remark(format_args!("clip {clip}: {puppet} can do all of it")),
        count => console.remark(format_args!(
            "clip {clip}: {puppet} is asked too much on {count} stretches; slowing all of it by {:.2} is enough \
             where slowing helps",
            feasibility.slow_down
        )),
    }
    Ok(())
}

fn help(stretch: &StretchView) -> &'static str {
    if stretch.slowable {
        ""
    } else {
        "; slowing does not help, change the pose"
    }
}
