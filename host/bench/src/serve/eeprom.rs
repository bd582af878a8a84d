//! Servos' memories in a folder: one file a servo, put in place whole, so that a program that is killed leaves the
//! old one or the new one.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use firmware_sim::ServoBus;
use firmware_sim::servo_bus::Servo;
use serde::{Deserialize, Serialize};

use super::ServeError;

/// Bytes on one line of a file.
const BYTES_A_LINE: usize = 16;

/// What is left of a servo without power, as a file has it.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Memory {
    /// File name of its profile.
    model: String,
    /// How often its EEPROM has been written to, since it came out of its box.
    writes: u64,
    /// The EEPROM from address 0, hexadecimal.
    eeprom: String,
}

/// The folder, and what it holds.
#[derive(Debug)]
pub struct Eeprom {
    /// File of each servo, in the order of the chain.
    paths: Vec<PathBuf>,
    /// What was last written, likewise.
    kept: Vec<(Vec<u8>, u64)>,
}

impl Eeprom {
    /// Brings back what the folder holds. Servos without a file are as they come out of the box. Files are named
    /// after the numbers the servos were put on the bus with; a servo that has been given another since has it still.
    pub(super) fn restore(folder: &Path, bus: &mut ServoBus) -> Result<Self, ServeError> {
        fs::create_dir_all(folder).map_err(|error| ServeError::io(folder.to_owned(), &error))?;
        let paths = paths(folder, bus);
        for (path, servo) in paths.iter().zip(bus.servos_mut()) {
            let text = match fs::read_to_string(path) {
                Ok(text) => text,
                Err(error) if error.kind() == io::ErrorKind::NotFound => continue,
                Err(error) => return Err(ServeError::io(path.clone(), &error)),
            };
            put_back(&text, servo).map_err(|why| ServeError::Eeprom {
                path: path.clone(),
                why: format!("{why}; delete the file, or name the model it is of"),
            })?;
        }
        let kept = bus.servos().iter().map(state).collect();
        Ok(Self { paths, kept })
    }

    /// Writes the memories that have changed.
    pub(super) fn keep(&mut self, bus: &ServoBus) -> Result<(), ServeError> {
        for ((servo, path), kept) in bus.servos().iter().zip(&self.paths).zip(&mut self.kept) {
            let now = state(servo);
            if *kept == now {
                continue;
            }
            let memory = Memory {
                model: servo.model().to_owned(),
                writes: now.1,
                eeprom: hex(&now.0),
            };
            let text = toml::to_string(&memory).map_err(|error| ServeError::Eeprom {
                path: path.clone(),
                why: error.to_string(),
            })?;
            replace(path, &text).map_err(|error| ServeError::io(path.clone(), &error))?;
            *kept = now;
        }
        Ok(())
    }
}

/// Its memory and its wear.
fn state(servo: &Servo) -> (Vec<u8>, u64) {
    (servo.eeprom().to_vec(), servo.counters().eeprom_writes)
}

/// One file a servo; of several with one number the second is `servo-1-2`.
fn paths(folder: &Path, bus: &ServoBus) -> Vec<PathBuf> {
    let ids: Vec<u8> = bus.servos().iter().map(Servo::id).collect();
    let named = ids.iter().enumerate().map(|(place, id)| {
        let before = ids.iter().take(place).filter(|&other| other == id).count();
        match before {
            0 => folder.join(format!("servo-{id}.toml")),
            more => folder.join(format!("servo-{id}-{}.toml", more + 1)),
        }
    });
    named.collect()
}

/// Puts a file's memory into `servo`, or says what is wrong with it.
fn put_back(text: &str, servo: &mut Servo) -> Result<(), String> {
    let memory: Memory = toml::from_str(text).map_err(|error| error.message().to_owned())?;
    if memory.model != servo.model() {
        return Err(format!(
            "expected the memory of {}, found that of {}",
            servo.model(),
            memory.model
        ));
    }
    let bytes = bytes(&memory.eeprom)?;
    let expected = servo.eeprom().len();
    if !servo.restore_eeprom(&bytes) {
        return Err(format!("expected {expected} bytes, found {}", bytes.len()));
    }
    servo.restore_wear(memory.writes);
    Ok(())
}

fn hex(bytes: &[u8]) -> String {
    let lines = bytes.chunks(BYTES_A_LINE).map(|line| {
        let words: Vec<String> = line.iter().map(|byte| format!("{byte:02x}")).collect();
        words.join(" ")
    });
    lines.collect::<Vec<_>>().join("\n")
}

fn bytes(text: &str) -> Result<Vec<u8>, String> {
    let byte = |word: &str| {
        u8::from_str_radix(word, 16).map_err(|_| format!("expected a byte in hexadecimal, found `{word}`"))
    };
    text.split_whitespace().map(byte).collect()
}

/// A new file in the place of the old one, if there is one, at once.
fn replace(path: &Path, text: &str) -> io::Result<()> {
    let beside = path.with_extension("toml.new");
    let mut file = fs::File::create(&beside)?;
    file.write_all(text.as_bytes())?;
    file.sync_all()?;
    fs::rename(&beside, path)
}
