//! The USB adapter behind a serial port, and its latency timer: how long the chip keeps the last bytes of an
//! answer before it hands them over.
//!
//! Sources: Linux `ftdi_sio` (sysfs attribute `latency_timer`, milliseconds; it reads 1 as well while the port has
//! `ASYNC_LOW_LATENCY` set), and FTDI's vendor requests for systems and users that may not write there (`ftdi`).
//! Apart from the transports because a program that only moves bytes needs none of it.

mod ftdi;
mod sysfs;

use std::path::{Path, PathBuf};

pub use ftdi::{ControlRequests, UsbRequests};

/// FTDI's vendor number.
pub const FTDI: u16 = 0x0403;
/// The timer's setting that every answer should meet: the smallest one the chip knows besides "each USB frame".
pub const LATENCY_WANTED_MS: u8 = 1;
/// The rule that keeps an FTDI adapter's timer at 1 ms after every plugging.
pub const LATENCY_RULE: &str =
    r#"ACTION=="add", SUBSYSTEM=="usb-serial", DRIVER=="ftdi_sio", ATTR{latency_timer}="1""#;

/// Where a device hangs on USB.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct UsbPlace {
    /// Bus number.
    pub bus: u8,
    /// Address on that bus.
    pub address: u8,
    /// Which of the chip's ports, from 0.
    pub interface: u8,
}

/// A USB adapter as the system describes it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Adapter {
    /// Name of the port in the system, such as `ttyUSB0`.
    pub tty: String,
    /// The maker's number.
    pub vendor: u16,
    /// The maker's number for the product.
    pub product: u16,
    /// Distinguishes two of a kind; empty where the maker did not take the trouble.
    pub serial: String,
    /// Where it hangs.
    pub place: Option<UsbPlace>,
    /// The kernel's file for the timer, if its driver has one.
    timer: Option<PathBuf>,
}

/// How a timer was read or set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// The kernel's file.
    Sysfs,
    /// A request to the chip.
    Request,
}

/// A timer could not be read or set.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum AdapterError {
    /// The adapter has none, or none that anybody knows of.
    #[error("{tty}: this adapter has no latency timer that could be set; FTDI chips have one")]
    NoTimer {
        /// The port.
        tty: String,
    },
    /// Neither the kernel nor the chip took it from this user.
    #[error(
        "{tty}: the latency timer was not set ({why}); as root: `echo {ms} > {file}`, or without root \
         `setserial /dev/{tty} low_latency`; for good, put this line into /etc/udev/rules.d/60-servo-latency.rules: {rule}"
    )]
    Refused {
        /// The port.
        tty: String,
        /// What kernel and chip said.
        why: String,
        /// What was to be set.
        ms: u8,
        /// The kernel's file.
        file: String,
        /// [`LATENCY_RULE`].
        rule: &'static str,
    },
    /// It was set and reads otherwise.
    #[error(
        "{tty}: the latency timer reads {found} ms after {wanted} ms was set; plug the adapter out and in"
    )]
    NotTaken {
        /// The port.
        tty: String,
        /// Set.
        wanted: u8,
        /// Read.
        found: u8,
    },
}

/// Finds adapters and their timers: through a folder such as `/sys`, and requests to the chip.
pub struct Adapters {
    sysfs: PathBuf,
    requests: Box<dyn ControlRequests>,
}

impl Default for Adapters {
    fn default() -> Self {
        Self::new(Path::new("/sys"), Box::new(UsbRequests))
    }
}

impl Adapters {
    /// With the kernel's devices described below `sysfs`, and `requests` to talk to chips.
    pub fn new(sysfs: &Path, requests: Box<dyn ControlRequests>) -> Self {
        Self {
            sysfs: sysfs.to_owned(),
            requests,
        }
    }

    /// The adapter behind a port's path (a link such as those in `/dev/serial/by-id` is followed); none for what
    /// does not hang on USB.
    pub fn of_port(&self, path: &str) -> Option<Adapter> {
        let real = std::fs::canonicalize(path).unwrap_or_else(|_| PathBuf::from(path));
        sysfs::adapter(&self.sysfs, real.file_name()?.to_str()?)
    }

    /// The timer in milliseconds and how it was read; none for an adapter without one.
    pub fn latency_ms(&mut self, adapter: &Adapter) -> Option<(u8, Way)> {
        if let Some(ms) = adapter.timer.as_deref().and_then(sysfs::read_timer) {
            return Some((ms, Way::Sysfs));
        }
        let place = adapter.ftdi_place()?;
        match self.requests.latency_ms(place, adapter.product) {
            Ok(ms) => Some((ms, Way::Request)),
            Err(why) => {
                tracing::debug!("{}: latency timer: {why}", adapter.tty);
                None
            }
        }
    }

    /// Sets the timer and reads it back, by the kernel's file or, where that is refused, by a request to the chip.
    pub fn set_latency_ms(&mut self, adapter: &Adapter, ms: u8) -> Result<Way, AdapterError> {
        let mut why = Vec::new();
        if let Some(timer) = &adapter.timer {
            match std::fs::write(timer, ms.to_string()) {
                Ok(()) => return adapter.verify(ms, sysfs::read_timer(timer), Way::Sysfs),
                Err(error) => why.push(format!("{}: {error}", timer.display())),
            }
        }
        if let Some(place) = adapter.ftdi_place() {
            match self.requests.set_latency_ms(place, adapter.product, ms) {
                Ok(()) => {
                    let found = self.requests.latency_ms(place, adapter.product).ok();
                    return adapter.verify(ms, found, Way::Request);
                }
                Err(error) => why.push(format!("request to the chip: {error}")),
            }
        }
        let tty = adapter.tty.clone();
        if why.is_empty() {
            return Err(AdapterError::NoTimer { tty });
        }
        let file = adapter.timer.as_deref().map_or_else(
            || format!("/sys/class/tty/{tty}/device/latency_timer"),
            |timer| timer.display().to_string(),
        );
        Err(AdapterError::Refused {
            tty,
            why: why.join("; "),
            ms,
            file,
            rule: LATENCY_RULE,
        })
    }
}

impl Adapter {
    /// Where to send an FTDI chip's requests; none for other makes.
    fn ftdi_place(&self) -> Option<UsbPlace> {
        self.place.filter(|_| self.vendor == FTDI)
    }

    fn verify(&self, wanted: u8, found: Option<u8>, way: Way) -> Result<Way, AdapterError> {
        match found {
            Some(found) if found != wanted => Err(AdapterError::NotTaken {
                tty: self.tty.clone(),
                wanted,
                found,
            }),
            // A chip that takes a setting but does not tell it again is believed.
            _ => Ok(way),
        }
    }

    /// The rule that lets whoever sits at the machine open the port.
    pub fn permission_rule(&self) -> String {
        permission_rule(Some((self.vendor, self.product)))
    }
}

/// The udev rule that lets whoever sits at the machine open a USB serial port, of one make or of any.
pub fn permission_rule(ids: Option<(u16, u16)>) -> String {
    match ids {
        Some((vendor, product)) => format!(
            r#"SUBSYSTEM=="tty", ATTRS{{idVendor}}=="{vendor:04x}", ATTRS{{idProduct}}=="{product:04x}", TAG+="uaccess""#
        ),
        None => r#"SUBSYSTEM=="tty", SUBSYSTEMS=="usb", TAG+="uaccess""#.to_owned(),
    }
}

#[cfg(test)]
mod tests;
