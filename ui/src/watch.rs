//! When the window draws: once for each change of what is seen, and not while nothing changes.
//!
//! The rig steps a hundred times a second whether or not anything happens. A picture takes milliseconds on a
//! graphics card and a good part of a processor without one, so somebody has to look first.

use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::Arc;
use std::sync::mpsc::{RecvTimeoutError, SyncSender, sync_channel};
use std::thread::JoinHandle;
use std::time::Duration;

use glam::DVec3;
use ps300::display::DisplayList;
use rig::{FigureView, NetworkLook, NoteLevel, PuppetView, Snapshot};

use crate::panels::{joints, view};
use crate::studio::Session;

/// Time between looks: no screen shows more than sixty pictures a second to any use.
const PERIOD: Duration = Duration::from_millis(16);

/// A thread that looks at a session and asks for a picture when something has changed. Ends when dropped.
pub(crate) struct Watch {
    stop: SyncSender<()>,
    thread: Option<JoinHandle<()>>,
}

impl Watch {
    /// Begins to look; `changed` is called on the watch's own thread.
    pub(crate) fn start(
        session: Arc<dyn Session>,
        changed: impl Fn() + Send + 'static,
    ) -> std::io::Result<Watch> {
        let (stop, stopped) = sync_channel(1);
        let thread = std::thread::Builder::new().name("watch".into()).spawn(move || {
            let mut last = None;
            while stopped.recv_timeout(PERIOD) == Err(RecvTimeoutError::Timeout) {
                let now = Some(fingerprint(&session.snapshot()));
                if now != last {
                    last = now;
                    changed();
                }
            }
        })?;
        Ok(Watch {
            stop,
            thread: Some(thread),
        })
    }
}

impl Drop for Watch {
    fn drop(&mut self) {
        // Where the thread is gone already there is nobody to tell, and nothing to wait for.
        let _ = self.stop.send(());
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

/// A number that changes when a picture of `seen` would. Counts of steps, ages and what only tooltips say are
/// left out: a tooltip is as fresh as the picture it stands on.
pub(crate) fn fingerprint(seen: &Snapshot) -> u64 {
    let mut hasher = DefaultHasher::new();
    let h = &mut hasher;
    (&seen.show, seen.unsaved, &seen.clip_name, &seen.undo, &seen.redo).hash(h);
    if let Some(figure) = &seen.figure {
        hash_figure(figure, h);
    }
    // A clip is never changed, only replaced.
    seen.clip.as_ref().map(|clip| Arc::as_ptr(clip).addr()).hash(h);
    for key in &seen.keys {
        (key.secs.to_bits(), key.selected).hash(h);
    }
    (&seen.kinetics.mode, seen.kinetics.selected).hash(h);
    let kinetics = &seen.kinetics;
    for pair in kinetics
        .curve
        .iter()
        .chain(&kinetics.coefficients)
        .chain(&kinetics.reversals)
    {
        pair.map(f64::to_bits).hash(h);
    }
    let transport = &seen.transport;
    [
        transport.secs,
        transport.start_secs,
        transport.end_secs,
        transport.speed,
    ]
    .map(f64::to_bits)
    .hash(h);
    (transport.playing, transport.looped).hash(h);
    [seen.view.azimuth_rad, seen.view.elevation_rad, seen.view.scale]
        .map(f64::to_bits)
        .hash(h);
    hash_point(seen.view.centre, h);
    for stroke in &seen.display.strokes {
        hash_point(stroke.from, h);
        hash_point(stroke.to, h);
        let [begin, end] = stroke.intensity;
        [stroke.hue_deg, stroke.saturation, begin, end]
            .map(f64::to_bits)
            .hash(h);
    }
    hash_faces(&seen.display, h);
    hash_desk(seen, h);
    if let Some(network) = &seen.network {
        hash_network(network, h);
    }
    if let Some(puppet) = &seen.puppet {
        hash_puppet(puppet, h);
    }
    let note = view::current_remark(seen);
    note.map(|note| (note.at_secs.to_bits(), note.level == NoteLevel::Info, &note.text))
        .hash(h);
    hasher.finish()
}

fn hash_point(point: DVec3, h: &mut DefaultHasher) {
    point.to_array().map(f64::to_bits).hash(h);
}

fn hash_faces(display: &DisplayList, h: &mut DefaultHasher) {
    for face in &display.faces {
        (face.fill as u8, face.front, face.back, face.lights.start).hash(h);
    }
    for corner in &display.corners {
        hash_point(corner.at, h);
        hash_point(corner.normal, h);
    }
    for material in &display.materials {
        hash_point(material.colour, h);
        [material.opaque, material.diffuse, material.specular]
            .map(f64::to_bits)
            .hash(h);
    }
    for light in &display.lights {
        hash_point(light.towards, h);
        hash_point(light.colour, h);
        light.ambient.to_bits().hash(h);
    }
}

fn hash_figure(figure: &FigureView, h: &mut DefaultHasher) {
    for placed in &figure.placed {
        hash_point(placed.start, h);
        hash_point(placed.end, h);
        placed.world_from_link.to_cols_array().map(f64::to_bits).hash(h);
    }
    (figure.selected, figure.posing).hash(h);
    figure.cursor.map(|at| at.to_array().map(f64::to_bits)).hash(h);
    for &candidate in &figure.candidates {
        hash_point(candidate, h);
    }
}

fn hash_desk(seen: &Snapshot, h: &mut DefaultHasher) {
    for dial in &seen.desk.dials {
        (&dial.label, dial.turns.to_bits(), dial.live).hash(h);
    }
    for key in &seen.desk.keys {
        (&key.label, key.lit, key.down).hash(h);
    }
    for device in &seen.devices {
        (&device.name, &device.health, device.events).hash(h);
    }
}

/// What the patch panel shows that moves; a picture and a text are never changed, only replaced.
fn hash_network(network: &NetworkLook, h: &mut DefaultHasher) {
    (network.picture.revision, network.can_undo, network.can_redo).hash(h);
    Arc::as_ptr(&network.text).addr().hash(h);
    network.diagnostics.len().hash(h);
    let activity = &network.activity;
    activity.reports.hash(h);
    for output in &activity.outputs {
        (output.sent, output.frozen, output.withheld).hash(h);
    }
    for input in &activity.inputs {
        (input.waiting, input.is_set).hash(h);
    }
}

fn hash_puppet(puppet: &PuppetView, h: &mut DefaultHasher) {
    (&puppet.name, puppet.state as u8, &puppet.fault, puppet.torque).hash(h);
    (puppet.interventions, puppet.stale_discarded, puppet.late_cycles).hash(h);
    puppet.clip_secs.map(f64::to_bits).hash(h);
    for joint in &puppet.joints {
        // Half a degree is less than a bar can show: a servo that cannot decide between two counts is at rest.
        let seen = |rad: Option<f64>| rad.map(|rad| (rad.to_degrees() * 2.0).round() as i64);
        (seen(joint.goal_rad), seen(joint.measured_rad)).hash(h);
        (joint.present, joints::is_old(joint), joint.error.is_some()).hash(h);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rig::{JointView, Note, PuppetState};
    use std::sync::Mutex;
    use std::sync::mpsc::Receiver;

    fn rested() -> Snapshot {
        let joint = JointView {
            measured_rad: Some(0.2),
            present: true,
            ..JointView::default()
        };
        Snapshot {
            at_secs: 5.0,
            notes: vec![Note {
                at_secs: 1.0,
                level: NoteLevel::Info,
                text: "tablet is there".into(),
            }],
            puppet: Some(PuppetView {
                joints: vec![joint],
                ..PuppetView::default()
            }),
            ..Snapshot::default()
        }
    }

    #[test]
    fn what_is_seen_counts_and_nothing_else() {
        let before = fingerprint(&rested());
        let unseen: [fn(&mut Snapshot); 3] = [
            |seen| (seen.step, seen.at_secs) = (99, 5.01),
            |seen| seen.puppet.as_mut().unwrap().joints[0].age_secs = 0.01,
            |seen| seen.puppet.as_mut().unwrap().joints[0].measured_rad = Some(0.2005),
        ];
        let shown: [fn(&mut Snapshot); 7] = [
            |seen| seen.transport.secs = 0.1,
            |seen| seen.desk.dials[2].turns = 0.01,
            |seen| seen.desk.keys[2].lit = true,
            |seen| seen.puppet.as_mut().unwrap().state = PuppetState::Holding,
            |seen| seen.puppet.as_mut().unwrap().joints[0].measured_rad = Some(0.23),
            |seen| seen.puppet.as_mut().unwrap().joints[0].age_secs = 3.0,
            // The remark has been there long enough.
            |seen| seen.at_secs = 60.0,
        ];
        let cases = unseen
            .iter()
            .map(|c| (c, false))
            .chain(shown.iter().map(|c| (c, true)));
        for (index, (change, want)) in cases.enumerate() {
            let mut seen = rested();
            change(&mut seen);
            assert_eq!(fingerprint(&seen) != before, want, "case {index}");
        }
    }

    struct Still(Mutex<Arc<Snapshot>>);

    impl Session for Still {
        fn snapshot(&self) -> Arc<Snapshot> {
            self.0.lock().unwrap().clone()
        }

        fn send(&self, _command: rig::Command) {}
    }

    #[test]
    fn a_watch_tells_of_each_change_once_and_lets_go_of_the_session() {
        let session = Arc::new(Still(Mutex::new(Arc::new(rested()))));
        let (told, heard) = sync_channel(8);
        let watch = Watch::start(session.clone(), move || {
            let _ = told.send(());
        })
        .unwrap();
        let next = |heard: &Receiver<()>| heard.recv_timeout(Duration::from_secs(20)).is_ok();
        assert!(next(&heard), "the first picture");
        assert!(heard.recv_timeout(PERIOD * 8).is_err(), "nothing has changed");
        *session.0.lock().unwrap() = Arc::new(Snapshot::default());
        assert!(next(&heard), "a change");
        drop(watch);
        assert_eq!(Arc::strong_count(&session), 1);
    }
}
