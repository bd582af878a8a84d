//! Whether a window can be opened at all, found out before anything is tried: the window library panics
//! where one X11 library is missing, and a panic is no error message.

use std::path::{Path, PathBuf};

use crate::studio::StudioError;

/// Libraries the window library loads on X11, and the Debian package of each.
const X11_LIBRARIES: [(&str, &str); 4] = [
    ("libX11.so.6", "libx11-6"),
    ("libXcursor.so.1", "libxcursor1"),
    ("libXi.so.6", "libxi6"),
    ("libxkbcommon-x11.so.0", "libxkbcommon-x11-0"),
];

/// Folders that a loader searches on common systems.
const FOLDERS: [&str; 10] = [
    "/lib",
    "/lib64",
    "/usr/lib",
    "/usr/lib64",
    "/usr/local/lib",
    "/lib/x86_64-linux-gnu",
    "/usr/lib/x86_64-linux-gnu",
    "/lib/aarch64-linux-gnu",
    "/usr/lib/aarch64-linux-gnu",
    "/run/current-system/sw/lib",
];

/// Refuses with the reason where a window cannot be opened.
pub(crate) fn check() -> Result<(), StudioError> {
    if !cfg!(target_os = "linux") {
        return Ok(());
    }
    let set = |name: &str| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    let wayland = set("WAYLAND_DISPLAY") || set("WAYLAND_SOCKET");
    judge(wayland, set("DISPLAY"), &|library| found(library))
}

fn judge(wayland: bool, x11: bool, found: &dyn Fn(&str) -> bool) -> Result<(), StudioError> {
    match (wayland, x11) {
        (true, _) => Ok(()),
        (false, false) => Err(StudioError::NoDisplay),
        (false, true) => {
            let missing = X11_LIBRARIES.into_iter().find(|(library, _)| !found(library));
            missing.map_or(Ok(()), |(library, package)| {
                Err(StudioError::MissingLibrary { library, package })
            })
        }
    }
}

/// Whether a library's file lies in a usual folder, in `LD_LIBRARY_PATH`, or in the loader's cache.
fn found(library: &str) -> bool {
    let named = std::env::var_os("LD_LIBRARY_PATH");
    let named = named.iter().flat_map(std::env::split_paths);
    let mut folders = FOLDERS.iter().map(PathBuf::from).chain(named);
    folders.any(|folder| folder.join(library).exists()) || in_cache(Path::new("/etc/ld.so.cache"), library)
}

/// The cache is a table followed by zero-ended paths; a name that is in it is in it as text.
fn in_cache(cache: &Path, library: &str) -> bool {
    let Ok(bytes) = std::fs::read(cache) else {
        return false;
    };
    let name = [b"/", library.as_bytes(), b"\0"].concat();
    bytes.windows(name.len()).any(|window| window == name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_message_names_the_remedy() {
        let all = |_: &str| true;
        let told = |result: Result<(), StudioError>| result.unwrap_err().to_string();
        assert!(told(judge(false, false, &all)).contains("dialrig demo"));
        assert!(judge(false, true, &all).is_ok());
        let without = |library: &str| library != "libxkbcommon-x11.so.0";
        assert!(told(judge(false, true, &without)).contains("libxkbcommon-x11-0"));
        assert!(judge(true, false, &|_| false).is_ok());
    }

    #[test]
    fn what_is_nowhere_is_not_found() {
        assert!(!found("libthere-is-no-such-library.so.7"));
        assert!(!in_cache(Path::new("/nonexistent"), "libX11.so.6"));
    }
}
