//! What is shipped inside the program: the example show, its network, and the hardware profiles.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use device_profiles::{ProfileError, Profiles};

use crate::document::NetworkFile;

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

/// The network that figures are posed with, for shows that have none.
pub fn figure_network() -> NetworkFile {
    NetworkFile {
        name: "figure".to_owned(),
        text: include_str!("../../../networks/figure.ps300").to_owned(),
    }
}

/// Where users keep profiles of their own: `$XDG_CONFIG_HOME/dialrig/profiles`, else `~/.config/dialrig/profiles`.
pub fn user_profiles_folder() -> Option<PathBuf> {
    let set = |name: &str| {
        std::env::var_os(name)
            .filter(|value| !value.is_empty())
            .map(PathBuf::from)
    };
    let config = set("XDG_CONFIG_HOME").or_else(|| set("HOME").map(|home| home.join(".config")))?;
    Some(config.join("dialrig").join("profiles"))
}

/// The shipped profiles and those of `user`, which win. A folder that is not there is no error.
pub fn profiles(user: Option<&Path>) -> Result<Profiles, Vec<ProfileError>> {
    let shipped = Profiles::builtin();
    match user {
        Some(folder) if folder.is_dir() => shipped.with_user_folder(folder),
        _ => Ok(shipped),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document;

    #[test]
    fn the_shipped_show_is_whole() {
        let show = document::from_texts(&salute()).expect("it loads");
        assert!(show.figure.is_some() && show.current_clip().is_some_and(|c| c.keys.len() >= 3));
        assert_eq!(show.networks.len(), 1);
        let profiles = profiles(None).expect("they are shipped");
        assert!(show.puppet.is_some_and(|name| profiles.puppet(&name).is_ok()));
    }
}
