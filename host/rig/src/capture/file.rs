//! The file of a capture: an exchange, written line by line as things pass.
//!
//! It is written beside its place and takes its place when it ends, so that a file of that name is always a whole one.
//! Every write is of whole lines and goes to the system at once: what is there when the program is killed can be read.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::time::Duration;

use device::exchange::{self, Exchange, Head, Record, What};

use super::CaptureError;

/// A file that is being written.
pub(crate) struct CaptureFile {
    out: File,
    part: PathBuf,
    place: PathBuf,
    latest: Duration,
    /// Lines, and events among them.
    records: u64,
    events: u64,
    /// Bytes that are in the file.
    bytes: u64,
    /// What is to be written next.
    text: String,
}

impl CaptureFile {
    /// Begins a file beside `place`, in the place of an older piece of that name.
    pub(crate) fn create(place: &Path, head: Head) -> Result<Self, CaptureError> {
        let mut options = OpenOptions::new();
        options.write(true).create(true).truncate(true);
        Self::open(place, head, &options)
    }

    /// Begins a file in a folder, which is made if need be, under a name that is not taken: `NAME-1.txt` and on.
    pub(crate) fn create_in(folder: &Path, name: &str, head: &Head) -> Result<Self, CaptureError> {
        fs::create_dir_all(folder).map_err(|source| fault(folder, source))?;
        let mut options = OpenOptions::new();
        options.write(true).create_new(true);
        for number in 1..=u32::MAX {
            let place = folder.join(format!("{name}-{number}.txt"));
            if place.exists() {
                continue;
            }
            match Self::open(&place, head.clone(), &options) {
                Err(CaptureError::File { source, .. }) if source.kind() == io::ErrorKind::AlreadyExists => {}
                opened => return opened,
            }
        }
        Err(fault(folder, io::ErrorKind::AlreadyExists.into()))
    }

    fn open(place: &Path, head: Head, options: &OpenOptions) -> Result<Self, CaptureError> {
        let mut part = place.as_os_str().to_owned();
        part.push(".part");
        let part = PathBuf::from(part);
        let out = options.open(&part).map_err(|source| fault(&part, source))?;
        let text = exchange::write(&Exchange {
            head,
            records: Vec::new(),
        });
        let mut file = Self {
            out,
            part,
            place: place.to_owned(),
            latest: Duration::ZERO,
            records: 0,
            events: 0,
            bytes: 0,
            text,
        };
        file.write_out()?;
        Ok(file)
    }

    /// Adds a line. Times never run backwards in an exchange: what is told after something is told with its time at
    /// least.
    pub(crate) fn add(&mut self, at: Duration, what: What) {
        self.latest = self.latest.max(at);
        self.records += 1;
        self.events += u64::from(matches!(what, What::Event(_)));
        exchange::write_record(&mut self.text, &Record::new(self.latest, what));
    }

    /// Adds a remark for people.
    pub(crate) fn remark(&mut self, words: &str) {
        self.text.push_str("# ");
        self.text.push_str(&words.replace(['\n', '\r'], " "));
        self.text.push('\n');
    }

    /// Writes the lines that were added. Where the disk takes only a piece of them, none of them is in the file.
    pub(crate) fn write_out(&mut self) -> Result<(), CaptureError> {
        if self.text.is_empty() {
            return Ok(());
        }
        let written = self.out.write_all(self.text.as_bytes());
        let length = self.text.len() as u64;
        self.text.clear();
        if let Err(source) = written {
            // A disk that is full still makes files shorter; if it does not, a line is cut, which readers bear.
            let _ = self.out.set_len(self.bytes);
            return Err(fault(&self.part, source));
        }
        self.bytes += length;
        Ok(())
    }

    /// Where it is as long as it is written.
    pub(crate) fn part(&self) -> &Path {
        &self.part
    }

    pub(crate) fn events(&self) -> u64 {
        self.events
    }

    pub(crate) fn bytes(&self) -> u64 {
        self.bytes
    }

    /// Ends it: the file takes its place. Gives that, and how many lines it has.
    pub(crate) fn finish(mut self) -> Result<(PathBuf, u64), CaptureError> {
        self.write_out()?;
        let moved = self
            .out
            .sync_all()
            .and_then(|()| fs::rename(&self.part, &self.place));
        moved.map_err(|source| fault(&self.place, source))?;
        Ok((self.place, self.records))
    }
}

fn fault(file: &Path, source: io::Error) -> CaptureError {
    CaptureError::File {
        file: file.display().to_string(),
        source,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Linux has a disk that is always full.
    #[cfg(target_os = "linux")]
    #[test]
    fn a_full_disk_is_said_and_what_was_written_before_stays() {
        let folder = tempfile::tempdir().expect("a folder");
        let place = folder.path().join("box.txt");
        let mut file = CaptureFile::create(&place, Head::default()).expect("it begins");
        file.add(Duration::from_millis(5), What::Device(vec![0x20]));
        file.write_out().expect("it is written");
        let whole = fs::read(file.part()).expect("it is there");
        file.out = File::options()
            .write(true)
            .open("/dev/full")
            .expect("it is there");
        file.add(Duration::from_millis(6), What::Device(vec![0x33]));
        let error = file.write_out().expect_err("it is full").to_string();
        assert!(error.contains("box.txt.part: cannot write: "), "{error}");
        assert_eq!(fs::read(file.part()).expect("it is there"), whole);
        let (read, errors) = exchange::read_readable(&String::from_utf8(whole).expect("text"));
        assert_eq!((read.records.len(), errors.len()), (1, 0));
    }

    #[test]
    fn no_name_is_taken_twice_and_pieces_of_others_stay() {
        let folder = tempfile::tempdir().expect("a folder");
        let inside = folder.path().join("a/b");
        let new = || CaptureFile::create_in(&inside, "box", &Head::default()).expect("it begins");
        let (one, two) = (new(), new());
        assert!(one.part().ends_with("a/b/box-1.txt.part") && two.part().ends_with("a/b/box-2.txt.part"));
        assert!(one.finish().expect("it ends").0.ends_with("box-1.txt"));
        assert!(new().part().ends_with("box-3.txt.part"));
    }
}
