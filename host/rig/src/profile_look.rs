//! Profiles as people and programs look at them: a list, one as text, what is wrong with a new one, the rules that
//! grant the right to open what they describe, and the options by which the kernel shows it.

use std::path::Path;

use device_profiles::{InputProfile, Kind, Profiles, Status};

use crate::document::Findings;
use crate::document::check::check_file;
use crate::document::fault::FileError;

pub use device::discovery::{MODPROBE_FILE, RULES_FILE, module_options, rules};

/// One profile in a list.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ProfileRow {
    /// What programs ask for.
    pub profile: String,
    /// What people call it.
    pub name: String,
    /// What sort of thing it is: `tablet`, `knobs` and so on; `servo`, `puppet`.
    pub kind: String,
    /// `vendor:product` of USB and Bluetooth, each once.
    pub ids: Vec<String>,
    /// How far it was tried.
    pub status: &'static str,
}

/// Input devices, by key; with `all` servos and puppets too.
pub fn list(profiles: &Profiles, all: bool) -> Vec<ProfileRow> {
    let mut rows: Vec<ProfileRow> = profiles.inputs().map(input).collect();
    if all {
        let other = |key: &str, name: &str, kind: &str, status: Status| ProfileRow {
            profile: key.to_owned(),
            name: name.to_owned(),
            kind: kind.to_owned(),
            ids: Vec::new(),
            status: status.word(),
        };
        rows.extend(
            profiles
                .servos()
                .map(|p| other(&p.key, &p.name, "servo", p.status)),
        );
        rows.extend(
            profiles
                .puppets()
                .map(|p| other(&p.key, &p.name, "puppet", p.status)),
        );
    }
    rows
}

fn input(profile: &InputProfile) -> ProfileRow {
    ProfileRow {
        profile: profile.key.clone(),
        name: profile.name.clone(),
        kind: profile.kind.word().to_owned(),
        ids: profile.ids(),
        status: profile.status.word(),
    }
}

/// A profile as its file would have it; an input device's layout behind it. An error in words.
pub fn text(profiles: &Profiles, name: &str) -> Result<String, String> {
    if let Ok(profile) = profiles.input(name) {
        let mut text = written(profile)?;
        if let Some(layout) = profile
            .layout
            .as_deref()
            .and_then(|key| profiles.layout(key).ok())
        {
            text = format!("{text}\n# Its layout, {}:\n{}", layout.key, written(layout)?);
        }
        return Ok(text);
    }
    if let Ok(profile) = profiles.servo(name) {
        return written(profile);
    }
    if let Ok(profile) = profiles.puppet(name) {
        return written(profile);
    }
    let known: Vec<String> = list(profiles, true).into_iter().map(|row| row.profile).collect();
    Err(format!(
        "there is no profile \"{name}\"; there are: {}",
        known.join(", ")
    ))
}

fn written(profile: &impl serde::Serialize) -> Result<String, String> {
    toml::to_string(profile).map_err(|error| error.to_string())
}

/// Everything that is wrong with a profile's file, in itself and beside those there are.
pub fn check(file: &Path, profiles: &Profiles) -> Findings {
    let mut findings = check_file(file);
    if !findings.errors.is_empty() {
        return findings;
    }
    let Ok(Kind::Input(profile)) = device_profiles::read_file_among(file, profiles) else {
        return findings;
    };
    for rival in rivals(&profile, profiles) {
        let message = format!("a device of its [[match]] is \"{rival}\" already");
        let hint =
            "ask for more, such as strings or lengths, or call the file as that profile to take its place";
        findings.error(FileError::whole(file, message).with_hint(hint));
    }
    findings
}

/// Profiles that claim a device in the very same words.
fn rivals(profile: &InputProfile, profiles: &Profiles) -> Vec<String> {
    profiles
        .inputs()
        .filter(|other| other.key != profile.key)
        .filter(|other| {
            let mut own = profile.matches.iter().filter(|m| m.id().is_some());
            own.any(|m| other.matches.contains(m))
        })
        .map(|other| other.key.clone())
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_profile_is_listed_and_its_text_is_read_back() {
        let profiles = Profiles::builtin();
        let rows = list(&profiles, false);
        assert!(
            rows.iter()
                .any(|row| row.profile == "sgi-dialbox" && row.kind == "knobs")
        );
        assert_eq!(rows.len(), profiles.inputs().count());
        assert!(list(&profiles, true).len() > rows.len());
        let folder = tempfile::tempdir().expect("a folder");
        for row in &rows {
            let own = profiles.input(&row.profile).expect("it is listed");
            let file = folder.path().join(format!("{}.toml", row.profile));
            std::fs::write(&file, written(own).expect("it can be written")).expect("room");
            let read = device_profiles::read_file_among(&file, &profiles).expect(&row.profile);
            let Kind::Input(read) = read else {
                panic!("{} is read as something else", row.profile);
            };
            // A layout is found among all profiles, not in the file; all that is in the file is the same.
            let again = written(&read).expect("it can be written");
            assert_eq!(again, written(own).expect("it can be written"), "{}", row.profile);
            assert!(text(&profiles, &row.profile).is_ok());
        }
        assert!(
            text(&profiles, "no-such")
                .expect_err("there is none")
                .contains("sgi-dialbox")
        );
    }

    #[test]
    fn a_second_profile_for_the_same_device_is_refused() {
        let profiles = Profiles::builtin();
        let folder = tempfile::tempdir().expect("a folder");
        let Some(own) = profiles
            .inputs()
            .find(|p| p.matches.iter().any(|m| m.id().is_some()))
        else {
            panic!("none of the shipped profiles has ids");
        };
        let file = folder.path().join("mine.toml");
        std::fs::write(&file, written(own).expect("it can be written")).expect("room");
        let found = check(&file, &profiles);
        assert!(
            found
                .errors
                .iter()
                .any(|error| error.to_string().contains(&own.key)),
            "{:?}",
            found.errors
        );
        let same_key = folder.path().join(format!("{}.toml", own.key));
        std::fs::rename(&file, &same_key).expect("it is there");
        assert!(
            check(&same_key, &profiles).errors.is_empty(),
            "one's own copy takes its place"
        );
    }
}
