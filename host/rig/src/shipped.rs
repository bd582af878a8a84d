//! What is shipped inside the program: the example show, its network, and the hardware profiles.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use device_profiles::{ProfileError, Profiles, PuppetProfile};
use motion::{JointKey, KineticsMode};

use crate::document::{JointClipDoc, NetworkFile, Show};

/// The example show as texts, as [`crate::document::from_texts`] takes them.
pub fn salute() -> BTreeMap<String, String> {
    // In the repository shows share one network; a show of its own carries a copy.
    let show = include_str!("../../../shows/salute/show.toml").replace("../../networks/", "networks/");
    [
        ("show.toml", show.as_str()),
        (
            "figure/ar.str",
            include_str!("../../../shows/salute/figure/ar.str"),
        ),
        (
            "figure/ar.pri",
            include_str!("../../../shows/salute/figure/ar.pri"),
        ),
        (
            "figure/ar.shp",
            include_str!("../../../shows/salute/figure/ar.shp"),
        ),
        (
            "clips/salute.toml",
            include_str!("../../../shows/salute/clips/salute.toml"),
        ),
        (
            "networks/figure.ps300",
            include_str!("../../../networks/figure.ps300"),
        ),
    ]
    .into_iter()
    .map(|(path, text)| (path.to_owned(), text.to_owned()))
    .collect()
}

/// The arm's show as texts, as [`crate::document::from_texts`] takes them.
pub fn arm() -> BTreeMap<String, String> {
    [
        ("show.toml", include_str!("../../../shows/arm/show.toml")),
        (
            "clips/greeting.toml",
            include_str!("../../../shows/arm/clips/greeting.toml"),
        ),
    ]
    .into_iter()
    .map(|(path, text)| (path.to_owned(), text.to_owned()))
    .collect()
}

/// Joints of a made clip go this share of their way to the nearer end of their range.
const SWEEP_SHARE: f64 = 0.5;
/// They rest at least this share of their range away from its ends.
const REST_ROOM_SHARE: f64 = 0.15;
/// They take this many times what their speed limit would let them.
const SWEEP_SLOWNESS: f64 = 3.0;
/// And no less than this for one way, seconds.
const SWEEP_SECS_MIN: f64 = 0.6;

/// A show for a puppet that has none: one joint after the other, there and back.
pub fn sweep(profile: &PuppetProfile) -> Show {
    let leads = |name: &str| profile.coupling(name).is_none();
    let joints: Vec<_> = profile.joints().filter(|joint| leads(&joint.name)).collect();
    let rest: BTreeMap<String, f64> = joints
        .iter()
        .map(|joint| {
            // Away from the ends of the range, which a smooth path overshoots between keys.
            let room = REST_ROOM_SHARE * (joint.max_rad - joint.min_rad);
            let rest = 0.0_f64.clamp(joint.min_rad + room, joint.max_rad - room);
            (joint.name.clone(), rest)
        })
        .collect();
    let mut keys = vec![JointKey {
        secs: 0.0,
        angles_rad: rest.clone(),
    }];
    let mut secs = 0.0;
    for joint in joints {
        let from = rest[&joint.name];
        let nearer = if (joint.max_rad - from).abs() < (from - joint.min_rad).abs() {
            joint.min_rad
        } else {
            joint.max_rad
        };
        let to = from + SWEEP_SHARE * (nearer - from);
        let way_secs = (SWEEP_SLOWNESS * (to - from).abs() / joint.speed_max_rad_per_s).max(SWEEP_SECS_MIN);
        for angle in [to, from] {
            secs += way_secs;
            let mut angles_rad = rest.clone();
            angles_rad.insert(joint.name.clone(), angle);
            keys.push(JointKey { secs, angles_rad });
        }
    }
    let clip = JointClipDoc {
        keys: keys.into_iter().map(Arc::new).collect(),
        kinetics: KineticsMode::Monotone,
        ..JointClipDoc::default()
    };
    let show = Show {
        name: profile.name.clone(),
        puppet: Some(profile.key.clone()),
        clip: "sweep".to_owned(),
        ..Show::default()
    };
    show.with_joint_clip("sweep", clip)
}

/// The network that figures are posed with, for shows that have none.
pub fn figure_network() -> NetworkFile {
    NetworkFile {
        name: "figure".to_owned(),
        text: include_str!("../../../networks/figure.ps300").to_owned(),
    }
}

/// Where users keep profiles of their own: `$XDG_CONFIG_HOME/dialrig/profiles`, else `~/.config/dialrig/profiles`.
pub fn user_profiles_folder() -> Option<PathBuf> {
    Some(user_folder()?.join("profiles"))
}

/// What belongs to the user: `$XDG_CONFIG_HOME/dialrig`, else `~/.config/dialrig`.
pub fn user_folder() -> Option<PathBuf> {
    let set = |name: &str| {
        std::env::var_os(name)
            .filter(|value| !value.is_empty())
            .map(PathBuf::from)
    };
    let config = set("XDG_CONFIG_HOME").or_else(|| set("HOME").map(|home| home.join(".config")))?;
    Some(config.join("dialrig"))
}

/// The shipped profiles and those of `user`, which win. A folder that is not there is no error.
pub fn profiles(user: Option<&Path>) -> Result<Profiles, Vec<ProfileError>> {
    let shipped = Profiles::builtin();
    match user {
        Some(folder) if folder.is_dir() => shipped.with_user_folder(folder),
        _ => Ok(shipped),
    }
}

/// The same without the files of `user` that are wrong, and what is wrong with them: the others work.
pub fn right_profiles(user: Option<&Path>) -> (Profiles, Vec<ProfileError>) {
    let shipped = Profiles::builtin();
    match user {
        Some(folder) if folder.is_dir() => shipped.with_right_files(folder),
        _ => (shipped, Vec::new()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document;

    #[test]
    fn the_arm_can_do_its_show() {
        let show = document::from_texts(&arm()).expect("it loads");
        let puppet = show.puppet.clone().expect("a puppet");
        let profiles = profiles(None).expect("they are shipped");
        let judged = crate::feasibility::judge(&show, &puppet, &profiles).expect("it is judged");
        assert_eq!(judged.len(), 1);
        let feasibility = &judged[0].feasibility;
        assert!(feasibility.stretches.is_empty(), "{:?}", feasibility.stretches);
        assert!(feasibility.unjudged.is_empty(), "{:?}", feasibility.unjudged);
    }

    #[test]
    fn every_puppet_can_do_its_sweep() {
        let profiles = profiles(None).expect("they are shipped");
        for profile in profiles.puppets() {
            let judged = crate::feasibility::judge(&sweep(profile), &profile.key, &profiles).expect("judged");
            let too_much: Vec<_> = judged[0]
                .feasibility
                .stretches
                .iter()
                .filter(|stretch| stretch.kind != crate::StretchKind::Torque)
                .collect();
            assert!(too_much.is_empty(), "{}: {too_much:?}", profile.key);
        }
    }

    #[test]
    fn the_shipped_show_is_whole() {
        let show = document::from_texts(&salute()).expect("it loads");
        assert!(show.figure.is_some() && show.current_clip().is_some_and(|c| c.keys.len() >= 3));
        assert_eq!(show.networks.len(), 1);
        let profiles = profiles(None).expect("they are shipped");
        assert!(show.puppet.is_some_and(|name| profiles.puppet(&name).is_ok()));
    }
}
