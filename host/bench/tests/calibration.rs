//! What a calibration leaves behind: the profile reads as it was proposed, nothing is written twice, and what was
//! replaced comes back.

use std::sync::Arc;

use bench::stand::{Horn, PuppetPlan, SimPorts, Stand};
use device::clock::VirtualClock;
use device_profiles::{Profiles, Role};
use rig::calibration::{Backup, Calibrator, Reading, profile_text};
use rig::ward::Ward;

/// The starter on a bench, its pan horn 40 degrees off.
fn bench() -> (Stand, VirtualClock, [Ward; 1]) {
    let clock = VirtualClock::new();
    let profiles = Profiles::builtin();
    let mut plan = PuppetPlan::default();
    let off_rad = 40_f64.to_radians();
    plan.horns.insert(
        "pan".into(),
        Horn {
            off_rad,
            reversed: false,
        },
    );
    let stand = Stand::builder(Arc::new(clock.clone()))
        .puppet(profiles.puppet("starter").expect("shipped"), &profiles, &plan)
        .expect("fits")
        .build();
    let ward = Ward {
        bus: "usb".into(),
        address: "sim:usb".into(),
        baud: 57_600,
    };
    (stand, clock, [ward])
}

fn begin(stand: &Stand, clock: &VirtualClock, wards: &[Ward], profiles: &Profiles) -> Calibrator {
    let mut ports = SimPorts::new(stand.clone());
    Calibrator::begin(
        &mut ports,
        Arc::new(clock.clone()),
        profiles,
        "starter",
        wards,
        None,
    )
    .expect("begins")
}

/// Both joints there and back again, the positive way first.
fn sweep(calibrator: &mut Calibrator, stand: &Stand) {
    calibrator.sample().expect("reads");
    calibrator.mark_zero();
    for (by, steps) in [(0.1, 12), (-0.1, 24), (0.1, 12)] {
        for _ in 0..steps {
            stand.push("pan", by).expect("there");
            stand.push("tilt", by).expect("there");
            calibrator.sample().expect("reads");
        }
    }
}

#[test]
fn what_is_written_is_found_again_and_comes_back() {
    let (stand, clock, wards) = bench();
    let profiles = Profiles::builtin();
    let folder = tempfile::tempdir().expect("a folder");
    let mut calibrator = begin(&stand, &clock, &wards, &profiles);
    sweep(&mut calibrator, &stand);
    let proposals = calibrator.propose(Reading::default());
    let written = calibrator.write(&proposals, folder.path()).expect("writes");
    assert_eq!(written.settings.len(), 4, "{written:?}");

    let mine = Profiles::builtin()
        .with_user_folder(folder.path())
        .expect("reads");
    let pan = mine
        .puppet("starter")
        .expect("there")
        .joint("pan")
        .expect("there")
        .clone();
    assert_eq!((pan.zero_counts, pan.sign), (2048 + 455, 1));
    let text = std::fs::read_to_string(&written.profile).expect("there");
    assert_eq!(
        text,
        profile_text(mine.puppet("starter").expect("there")).expect("a text")
    );

    // Once more: everything is as it should be, and nothing is written.
    let mut again = begin(&stand, &clock, &wards, &mine);
    sweep(&mut again, &stand);
    let proposals = again.propose(Reading::default());
    let plans: Vec<_> = proposals
        .iter()
        .map(|proposal| proposal.plan.clone().expect("possible"))
        .collect();
    assert!(
        plans
            .iter()
            .all(|plan| plan.limits.is_none() && plan.homing_offset.is_none()),
        "{plans:?}"
    );
    assert_eq!(plans[0].zero_counts, pan.zero_counts);

    // And back: settings, and no profile where there was none.
    let backup = Backup::read(&written.backup).expect("reads");
    let restored = again.restore(&backup).expect("restores");
    assert!(restored.len() >= 4, "{restored:?}");
    assert!(!written.profile.exists());
    let limits =
        [Role::MinPosition, Role::MaxPosition].map(|role| stand.register("pan", role).expect("there"));
    assert_eq!(limits, [Some(0), Some(4095)]);
}

#[test]
fn one_refusal_refuses_the_whole() {
    let (stand, clock, wards) = bench();
    let folder = tempfile::tempdir().expect("a folder");
    let mut calibrator = begin(&stand, &clock, &wards, &Profiles::builtin());
    calibrator.sample().expect("reads");
    calibrator.mark_zero();
    for _ in 0..12 {
        stand.push("pan", 0.1).expect("there");
        calibrator.sample().expect("reads");
    }
    let proposals = calibrator.propose(Reading::default());
    assert!(
        proposals[0].plan.is_ok() && proposals[1].plan.is_err(),
        "{proposals:?}"
    );
    let refused = calibrator
        .write(&proposals, folder.path())
        .expect_err("refused")
        .to_string();
    assert!(
        refused.contains("tilt") && refused.contains("move it by hand"),
        "{refused}"
    );
    assert_eq!(std::fs::read_dir(folder.path()).expect("there").count(), 0);
}
