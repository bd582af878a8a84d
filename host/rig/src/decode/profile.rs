//! A profile out of a file, for a device that nobody has installed a profile for yet.

use std::path::Path;

use device_profiles::{Kind, ProfileError, Profiles, read_file, read_file_among};

/// Reads an input device's profile and adds it to a copy of the profiles there are; gives its key. A layout that is
/// not among them is looked for beside the file, and in `layouts/` there or next to its folder.
pub fn with_file(file: &Path, profiles: &Profiles) -> Result<(String, Profiles), Vec<ProfileError>> {
    let mut all = profiles.clone();
    if let Kind::Input(input) = read_file(file)?
        && let Some(layout) = input.layout.as_ref().filter(|key| all.layout(key).is_err())
    {
        let folder = file.parent().unwrap_or(Path::new(""));
        let name = format!("{layout}.toml");
        for place in [
            folder.to_owned(),
            folder.join("layouts"),
            folder.join("../layouts"),
        ] {
            if let Ok(found @ Kind::Layout(_)) = read_file(&place.join(&name)) {
                all.add(found);
                break;
            }
        }
    }
    let profile = read_file_among(file, &all)?;
    let Kind::Input(input) = &profile else {
        return Err(vec![ProfileError::Absent {
            kind: "input device",
            name: file.display().to_string(),
            known: "none in this file, which is of another kind".to_owned(),
        }]);
    };
    let key = input.key.clone();
    all.add(profile);
    Ok((key, all))
}
