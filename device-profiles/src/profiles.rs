//! All profiles at hand: the embedded ones, and over them the user's own.

use crate::read::{fitting, key_of, parse, text_of};
use crate::{InputProfile, Layout, ProfileError, PuppetProfile, ServoProfile};
use include_dir::{Dir, include_dir};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

static SERVOS: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/servos");
static PUPPETS: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/puppets");
static INPUTS: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/inputs");
static LAYOUTS: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/layouts");

/// Every profile the program can use, by key, in alphabetical order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Profiles {
    servos: BTreeMap<String, ServoProfile>,
    puppets: BTreeMap<String, PuppetProfile>,
    inputs: BTreeMap<String, InputProfile>,
    layouts: BTreeMap<String, Layout>,
}

/// A profile of any kind.
#[derive(Clone, Debug, PartialEq)]
pub enum Kind {
    /// A servo model.
    Servo(Box<ServoProfile>),
    /// A puppet.
    Puppet(Box<PuppetProfile>),
    /// An input device.
    Input(Box<InputProfile>),
    /// What the reports of several input devices mean.
    Layout(Box<Layout>),
}

impl Profiles {
    /// The profiles that are compiled in.
    pub fn builtin() -> Self {
        let mut all = Self::default();
        for folder in [&SERVOS, &PUPPETS, &LAYOUTS, &INPUTS] {
            all.add_embedded(folder);
        }
        all
    }

    fn add_embedded(&mut self, folder: &Dir<'_>) {
        for file in folder
            .files()
            .filter(|f| f.path().extension().is_some_and(|e| e == "toml"))
        {
            let text = file
                .contents_utf8()
                .expect("embedded profiles are UTF-8: tests/data.rs reads them");
            let profile = parse(&file.path().display().to_string(), &key_of(file.path()), text)
                .expect("embedded profiles are right: tests/data.rs reads them");
            self.add(profile);
        }
        for inner in folder.dirs() {
            self.add_embedded(inner);
        }
    }

    /// Adds every `.toml` below `folder`; one with an embedded profile's key takes its place.
    /// A folder that does not exist adds nothing; every wrong file is reported, not only the first, and so is a
    /// puppet that does not fit the servos there are once all are added, or an input device without its layout.
    pub fn with_user_folder(self, folder: &Path) -> Result<Self, Vec<ProfileError>> {
        let (all, read, mut errors) = self.with_files(folder);
        // Against a servo or layout that could not be read, nothing is judged: one mistake, one message.
        if errors.is_empty() {
            for file in &read {
                errors.extend(file.fitting(&all).err().into_iter().flatten());
            }
        }
        if errors.is_empty() { Ok(all) } else { Err(errors) }
    }

    /// The same, and goes on without the files that are wrong. Nothing stands in for such a file: who has corrected a
    /// puppet does not get the shipped one because of a misspelt key.
    pub fn with_right_files(self, folder: &Path) -> (Self, Vec<ProfileError>) {
        let (mut all, read, mut errors) = self.with_files(folder);
        for file in &read {
            if let Err(found) = file.fitting(&all) {
                all.remove(&file.key);
                errors.extend(found);
            }
        }
        (all, errors)
    }

    /// Adds the files that are right in themselves; those that are not leave nothing under their key.
    fn with_files(mut self, folder: &Path) -> (Self, Vec<Read>, Vec<ProfileError>) {
        let (mut files, mut read, mut errors) = (Vec::new(), Vec::new(), Vec::new());
        if folder.exists() {
            collect(folder, &mut files, &mut errors);
        }
        for path in files {
            let (file, key) = (path.display().to_string(), key_of(&path));
            match text_of(&path).and_then(|text| Ok((parse(&file, &key, &text)?, text))) {
                Ok((profile, text)) => {
                    self.add(profile.clone());
                    read.push(Read {
                        file,
                        key,
                        text,
                        profile,
                    });
                }
                Err(found) => {
                    self.remove(&key);
                    errors.extend(found);
                }
            }
        }
        (self, read, errors)
    }

    /// Takes out every profile of that key. Layouts stay: what was read with one keeps it.
    fn remove(&mut self, key: &str) {
        self.servos.remove(key);
        self.puppets.remove(key);
        self.inputs.remove(key);
    }

    /// The profile with its layout in it, where it has one.
    pub(crate) fn resolved(&self, mut profile: Kind) -> Kind {
        if let Kind::Input(input) = &mut profile {
            let layout = input.layout.as_ref().and_then(|key| self.layouts.get(key));
            input.of_layout = layout.cloned().map(Arc::new);
        }
        profile
    }

    /// Adds one profile, in place of another with its key.
    pub fn add(&mut self, profile: Kind) {
        match self.resolved(profile) {
            Kind::Servo(p) => drop(self.servos.insert(p.key.clone(), *p)),
            Kind::Puppet(p) => drop(self.puppets.insert(p.key.clone(), *p)),
            Kind::Input(p) => drop(self.inputs.insert(p.key.clone(), *p)),
            Kind::Layout(l) => {
                let shared = Arc::new((*l).clone());
                let users = self.inputs.values_mut();
                for profile in users.filter(|p| p.layout.as_ref() == Some(&l.key)) {
                    profile.of_layout = Some(Arc::clone(&shared));
                }
                self.layouts.insert(l.key.clone(), *l);
            }
        }
    }

    /// The servo whose key or name this is, whatever the case of its letters.
    pub fn servo(&self, name: &str) -> Result<&ServoProfile, ProfileError> {
        find(&self.servos, "servo", name, |p| &p.name)
    }

    /// The puppet whose key or name this is.
    pub fn puppet(&self, name: &str) -> Result<&PuppetProfile, ProfileError> {
        find(&self.puppets, "puppet", name, |p| &p.name)
    }

    /// The input device whose key or name this is.
    pub fn input(&self, name: &str) -> Result<&InputProfile, ProfileError> {
        find(&self.inputs, "input device", name, |p| &p.name)
    }

    /// The layout whose key or name this is.
    pub fn layout(&self, name: &str) -> Result<&Layout, ProfileError> {
        find(&self.layouts, "layout", name, |l| &l.name)
    }

    /// The servo that answers a ping with this model number.
    pub fn servo_by_model(&self, model_number: u16) -> Option<&ServoProfile> {
        self.servos().find(|p| p.model_number == model_number)
    }

    /// All servos, by key.
    pub fn servos(&self) -> impl Iterator<Item = &ServoProfile> {
        self.servos.values()
    }

    /// All puppets, by key.
    pub fn puppets(&self) -> impl Iterator<Item = &PuppetProfile> {
        self.puppets.values()
    }

    /// All input devices, by key.
    pub fn inputs(&self) -> impl Iterator<Item = &InputProfile> {
        self.inputs.values()
    }

    /// All layouts, by key.
    pub fn layouts(&self) -> impl Iterator<Item = &Layout> {
        self.layouts.values()
    }
}

/// A user's file that is right in itself.
struct Read {
    file: String,
    key: String,
    text: String,
    profile: Kind,
}

impl Read {
    fn fitting(&self, all: &Profiles) -> Result<(), Vec<ProfileError>> {
        fitting(&self.file, &self.text, &self.profile, all)
    }
}

fn find<'a, P>(
    among: &'a BTreeMap<String, P>,
    kind: &'static str,
    name: &str,
    title: impl Fn(&P) -> &str,
) -> Result<&'a P, ProfileError> {
    let by_title = || among.values().find(|p| title(p).eq_ignore_ascii_case(name));
    among
        .get(&name.to_lowercase())
        .or_else(by_title)
        .ok_or_else(|| ProfileError::Absent {
            kind,
            name: name.to_owned(),
            known: among.keys().cloned().collect::<Vec<_>>().join(", "),
        })
}

/// Every `.toml` below `folder`, in alphabetical order, so that which of two equal keys wins is always the same.
fn collect(folder: &Path, files: &mut Vec<PathBuf>, errors: &mut Vec<ProfileError>) {
    let entries = match std::fs::read_dir(folder) {
        Ok(entries) => entries,
        Err(e) => {
            errors.push(ProfileError::Unreadable {
                path: folder.to_owned(),
                why: e.to_string(),
            });
            return;
        }
    };
    let mut paths: Vec<_> = entries.filter_map(|e| e.ok().map(|e| e.path())).collect();
    paths.sort();
    for path in paths {
        if path.is_dir() {
            collect(&path, files, errors);
        } else if path.extension().is_some_and(|e| e == "toml") {
            files.push(path);
        }
    }
}
