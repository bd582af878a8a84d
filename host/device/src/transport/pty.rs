//! The far side of a pseudo-terminal: what a simulated device talks through, so that any program can open it
//! like a serial port. Source: pty(7), pts(4).

use super::{Boundary, Transport, TransportError, descriptor};
use crate::clock::{Clock, Instant};
use rustix::fd::{AsFd, BorrowedFd, OwnedFd};
use rustix::fs::{Mode, OFlags};
use rustix::io::Errno;
use rustix::pty::OpenptFlags;
use rustix::termios::OptionalActions;
use std::io;
use std::os::unix::ffi::OsStringExt;
use std::path::{Path, PathBuf};

/// A pseudo-terminal whose near side programs open by [`Pty::path`]. Dropping it is pulling the plug.
#[derive(Debug)]
pub struct Pty {
    far: OwnedFd,
    /// Held open, because the far side reads an error while nobody holds the near side, and because the
    /// line speed is asked of the near side.
    near: OwnedFd,
    device: PathBuf,
    link: Option<PathBuf>,
}

const HINT: &str = "mount /dev/pts, or use --tcp instead of --pty";

impl Pty {
    /// A pseudo-terminal under the name the system gives it.
    pub fn open() -> Result<Self, TransportError> {
        Self::make().map_err(|e| TransportError::from_io("/dev/ptmx", HINT, e.into()))
    }

    /// A pseudo-terminal that is also found at `link`, a symbolic link that goes when it does.
    /// A link there that leads nowhere, or to another terminal, is replaced; anything else is left alone and
    /// refused.
    pub fn open_at(link: &Path) -> Result<Self, TransportError> {
        let mut pty = Self::open()?;
        let hint = "choose a path in a folder that you may write to";
        let sort = |e: io::Error| TransportError::from_io(&link.display().to_string(), hint, e);
        match std::fs::read_link(link) {
            Ok(target) if target.starts_with("/dev/pts") || !link.exists() => {
                std::fs::remove_file(link).map_err(sort)?;
            }
            _ => {}
        }
        std::os::unix::fs::symlink(&pty.device, link).map_err(sort)?;
        pty.link = Some(link.to_owned());
        Ok(pty)
    }

    fn make() -> Result<Self, Errno> {
        let far = rustix::pty::openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY | OpenptFlags::CLOEXEC)?;
        rustix::pty::grantpt(&far)?;
        rustix::pty::unlockpt(&far)?;
        let name = rustix::pty::ptsname(&far, Vec::new())?;
        let device = PathBuf::from(std::ffi::OsString::from_vec(name.into_bytes()));
        let flags = OFlags::RDWR | OFlags::NOCTTY | OFlags::CLOEXEC | OFlags::NONBLOCK;
        let near = rustix::fs::open(&device, flags, Mode::empty())?;
        // Raw from the start: a program that writes before it configures must not have its bytes echoed.
        let mut settings = rustix::termios::tcgetattr(&near)?;
        settings.make_raw();
        rustix::termios::tcsetattr(&near, OptionalActions::Now, &settings)?;
        let flags = rustix::fs::fcntl_getfl(&far)?;
        rustix::fs::fcntl_setfl(&far, flags | OFlags::NONBLOCK)?;
        Ok(Self {
            far,
            near,
            device,
            link: None,
        })
    }

    /// Where programs open it: the link if there is one, else the device.
    pub fn path(&self) -> &Path {
        self.link.as_deref().unwrap_or(&self.device)
    }

    /// The line speed the program at the other end has set; before it has, the system's own default.
    /// The terminal does not slow anything down: a simulator that wants wire time must keep it itself.
    pub fn host_baud(&self) -> Option<u32> {
        rustix::termios::tcgetattr(&self.near)
            .ok()
            .map(|settings| settings.output_speed())
    }

    fn sorted(&self, error: io::Error) -> TransportError {
        TransportError::from_io(&self.path().display().to_string(), HINT, error)
    }
}

impl Transport for Pty {
    fn boundary(&self) -> Boundary {
        Boundary::Stream
    }

    fn read(&mut self, buffer: &mut [u8]) -> Result<usize, TransportError> {
        let count = descriptor::read(self.far.as_fd(), buffer).map_err(|e| self.sorted(e))?;
        if count == 0 {
            // A program that took the terminal's exclusive lock and ended leaves it behind, since we hold the
            // terminal open; the next program must be able to open it all the same.
            let _ = rustix::termios::ioctl_tiocnxcl(&self.near);
        }
        Ok(count)
    }

    /// What nobody reads is lost once the terminal's buffer is full, as on a wire with nothing at its end.
    fn write(&mut self, bytes: &[u8]) -> Result<(), TransportError> {
        let mut left = bytes;
        while !left.is_empty() {
            match descriptor::write_some(self.far.as_fd(), left).map_err(|e| self.sorted(e))? {
                0 => break,
                count => left = left.get(count..).unwrap_or_default(),
            }
        }
        Ok(())
    }

    fn wait(&mut self, clock: &dyn Clock, until: Instant) {
        descriptor::wait(self.far.as_fd(), clock, until);
    }

    fn ready(&mut self) -> bool {
        descriptor::ready(self.far.as_fd())
    }

    fn descriptor(&self) -> Option<BorrowedFd<'_>> {
        Some(self.far.as_fd())
    }
}

impl Drop for Pty {
    fn drop(&mut self) {
        if let Some(link) = &self.link
            && std::fs::read_link(link).is_ok_and(|target| target == self.device)
        {
            // A link that cannot be removed leads nowhere and is replaced by the next to ask for it.
            let _ = std::fs::remove_file(link);
        }
    }
}
