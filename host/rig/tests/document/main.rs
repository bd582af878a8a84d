//! Documents: shows in folders and texts, edits of them, motion capture, and every fault in its place.

mod bvh;
mod convert;
mod edit;
mod faults;
mod folder;
mod shows;
mod texts;
mod urdf;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use rig::document::{self, ClipDoc, Demands, JointDemand, NetworkFile, Show};

/// Where the shipped show lies.
fn salute_folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shows/salute")
}

/// The shipped show.
fn salute() -> Show {
    document::load(&salute_folder())
        .expect("the shipped show loads")
        .show
}

/// A show that uses every part of the formats.
fn rich() -> Show {
    let mut show = salute().with_patch("SEND 90 TO <2>turn;");
    show.name = "With \"quotes\" and\ttabs".into();
    let mut keys = show.current_clip().expect("a clip").keys.clone();
    let mut stretched = keys[2].as_ref().clone();
    stretched.pose.links[3].length = 0.175;
    stretched.pose.links[0].twist_rad = 12.5;
    keys[2] = Arc::new(stretched);
    let clip = ClipDoc {
        keys,
        coefficient_edits: vec![(2, 0.125), (4, -0.25)],
        keep_forward: true,
        frame_secs: Some(0.04),
        twist_law: motion::TwistLaw::Zyz,
        direction_law: motion::DirectionLaw::Chord,
        ..ClipDoc::default()
    };
    show.demands = Demands {
        limits: BTreeMap::from([(
            "left elbow".to_owned(),
            JointDemand {
                min_rad: Some(-0.5),
                speed_max_rad_per_s: Some(1.25),
                ..JointDemand::default()
            },
        )]),
        on_heat: Some(rig::Reaction::Release),
        on_lost_host: Some(rig::Reaction::Hold),
        hot_c: Some(55.5),
        ..Demands::default()
    };
    show.view = Some(rig::ViewState {
        azimuth_rad: 0.0,
        elevation_rad: 0.0,
        scale: 0.75,
        centre: glam::DVec3::Y,
    });
    show.networks.push(Arc::new(NetworkFile {
        name: "more".into(),
        text: "{ nothing }\n".into(),
    }));
    show.with_clip("a second one", clip)
        .with_clip("empty", ClipDoc::default())
}
