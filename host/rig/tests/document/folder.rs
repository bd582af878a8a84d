//! Show folders: what is written comes back, saving is whole or not at all, and every fault has a place.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use super::{rich, salute};
use rig::document::disk::{Disk, RealDisk};
use rig::document::save::{discard_autosave, save_through};
use rig::document::{self, ClipDoc, Show, check};

#[test]
fn what_is_saved_is_what_was_there() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let show = rich();
    document::save(&show, folder.path()).expect("saves");
    let loaded = document::load(&folder.path().join("show.toml")).expect("loads");
    assert_eq!(loaded.show, show);
    assert_eq!(loaded.folder, folder.path());
    document::save(&loaded.show, folder.path()).expect("saves again");
    assert_eq!(check::check_file(folder.path()).errors, []);
}

/// Fails the n-th operation, or that and all after it.
struct Failing {
    left: u32,
    for_good: bool,
}

impl Failing {
    fn step<T>(&mut self, done: impl FnOnce(&mut RealDisk) -> io::Result<T>) -> io::Result<T> {
        self.left = self.left.saturating_sub(1);
        if self.left == 0 {
            self.left = if self.for_good { 1 } else { u32::MAX };
            return Err(io::Error::other("the disk is full"));
        }
        done(&mut RealDisk)
    }
}

impl Disk for Failing {
    fn make_folder(&mut self, folder: &Path) -> io::Result<()> {
        self.step(|disk| disk.make_folder(folder))
    }
    fn write_aside(&mut self, folder: &Path, text: &str) -> io::Result<PathBuf> {
        self.step(|disk| disk.write_aside(folder, text))
    }
    fn rename(&mut self, from: &Path, to: &Path) -> io::Result<()> {
        self.step(|disk| disk.rename(from, to))
    }
    fn remove(&mut self, file: &Path) -> io::Result<()> {
        self.step(|disk| disk.remove(file))
    }
}

/// `rich` with something changed in most of its files.
fn changed(show: &Show) -> Show {
    let mut clip = show.clips["salute"].as_ref().clone();
    clip.keys.pop();
    let mut changed = show
        .with_clip("salute", clip.clone())
        .with_clip("third", clip)
        .with_patch("INITIALISE;");
    changed.name = "changed".into();
    changed
}

#[test]
fn saving_fails_at_any_step_and_nothing_is_lost() {
    let (old, new) = (rich(), changed(&rich()));
    for for_good in [false, true] {
        let mut failures = 0;
        for n in 1.. {
            let folder = tempfile::tempdir().expect("a temporary folder");
            document::save(&old, folder.path()).expect("saves");
            let mut disk = Failing { left: n, for_good };
            if save_through(&mut disk, &new, folder.path()).is_ok() {
                assert_eq!(document::load(folder.path()).expect("loads").show, new);
                break;
            }
            failures += 1;
            let found = document::load(folder.path()).expect("still loads").show;
            if !for_good {
                assert_eq!(found, old, "failure {n}");
                let strays = files_below(folder.path())
                    .into_iter()
                    .filter(|path| is_temporary(path));
                assert_eq!(strays.collect::<Vec<_>>(), Vec::<PathBuf>::new(), "failure {n}");
            }
            // A disk that stays broken cannot be put back, but every file is whole, old or new.
            for (name, clip) in &found.clips {
                assert!(
                    old.clips.get(name) == Some(clip) || new.clips.get(name) == Some(clip),
                    "failure {n}"
                );
            }
        }
        assert!(failures >= 8, "only {failures} steps failed");
    }
}

fn is_temporary(path: &Path) -> bool {
    path.file_name()
        .is_some_and(|name| name.to_string_lossy().starts_with(".writing-"))
}

fn files_below(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).expect("a folder").flatten() {
        if entry.path().is_dir() {
            files.extend(files_below(&entry.path()));
        } else {
            files.push(entry.path());
        }
    }
    files
}

#[test]
fn an_autosave_is_offered_until_the_show_is_saved() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (old, new) = (rich(), changed(&rich()));
    document::save(&old, folder.path()).expect("saves");
    document::autosave(&old, folder.path()).expect("autosaves");
    document::autosave(&new, folder.path()).expect("autosaves again");

    let loaded = document::load(folder.path()).expect("loads");
    assert_eq!(loaded.show, old, "the saved state is not touched");
    let kept = loaded.autosave.expect("an autosave is offered");
    assert_eq!(document::load(&kept).expect("loads").show, new);

    document::save(&new, folder.path()).expect("saves");
    assert_eq!(document::load(folder.path()).expect("loads").autosave, None);
    assert!(!kept.exists());

    document::autosave(&old, folder.path()).expect("autosaves");
    discard_autosave(folder.path()).expect("discards");
    assert_eq!(document::load(folder.path()).expect("loads").autosave, None);
}

#[test]
fn version_0_is_still_read() {
    let here = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/document");
    let loaded = document::load(&here.join("version-0")).expect("an old show loads");
    let show = loaded.show;
    assert_eq!((show.name.as_str(), show.clip.as_str()), ("Old wave", "wave"));
    let clip = show.current_clip().expect("a clip");
    assert_eq!(clip.times_secs(), [0.0, 0.5, 1.25]);
    assert_eq!(clip.frame_secs, Some(1.0 / 24.0));
    let pose = &clip.keys[1].pose;
    assert!(pose.links[0].direction.distance(glam::DVec3::NEG_Y) < 1e-12);
    assert!((pose.links[0].twist_rad.to_degrees() - 45.0).abs() < 1e-9);
    assert_eq!(show.networks[0].name, "old");

    let folder = tempfile::tempdir().expect("a temporary folder");
    document::save(&show, folder.path()).expect("saves");
    let text = fs::read_to_string(folder.path().join("clips/wave.toml")).expect("is there");
    assert!(text.starts_with("version = 1\n"));
    let again = document::load(folder.path()).expect("loads").show;
    assert_eq!(
        again.current_clip().expect("a clip").times_secs(),
        clip.times_secs()
    );
}

#[test]
fn names_that_cannot_be_files_are_refused_before_writing() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let clip = ClipDoc::default();
    let error = document::save(&salute().with_clip("a/b", clip), folder.path()).expect_err("refused");
    assert!(error.to_string().contains("`a/b`"), "{error}");
    assert_eq!(files_below(folder.path()), Vec::<PathBuf>::new());
}
