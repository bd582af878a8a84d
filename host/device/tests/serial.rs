//! Serial ports against pseudo-terminals, and sockets against each other, on this machine's own kernel.

use device::clock::{Clock, Instant, MonotonicClock};
use device::transport::pty::Pty;
use device::transport::{Transport, TransportError, serial, tcp};
use std::path::PathBuf;
use std::time::Duration;

/// Reads until `count` bytes are there or a second has passed.
fn read_exactly(from: &mut dyn Transport, count: usize) -> Vec<u8> {
    let clock = MonotonicClock::new();
    let limit = Instant::ZERO.after(Duration::from_secs(1));
    let mut all = Vec::new();
    let mut buffer = [0; 64];
    while all.len() < count && clock.now() < limit {
        from.wait(&clock, limit);
        let got = from.read(&mut buffer).unwrap();
        all.extend_from_slice(&buffer[..got]);
    }
    all
}

fn port_of(pty: &Pty) -> String {
    pty.path().display().to_string()
}

#[test]
fn every_byte_passes_both_ways_unchanged() {
    let mut far = Pty::open().unwrap();
    let mut host = serial::open(&port_of(&far), 1_000_000).unwrap();
    let all: Vec<u8> = (0..=255).collect();
    host.write(&all).unwrap();
    assert_eq!(read_exactly(&mut far, 256), all);
    far.write(&all).unwrap();
    assert_eq!(read_exactly(&mut host, 256), all);
    assert_eq!(host.read(&mut [0; 8]).unwrap(), 0);
}

#[test]
fn the_far_side_sees_the_line_speed() {
    let far = Pty::open().unwrap();
    let mut host = serial::open(&port_of(&far), 9_600).unwrap();
    assert_eq!(far.host_baud(), Some(9_600));
    for baud in [57_600, 1_000_000, 4_500_000] {
        host.set_baud(baud).unwrap();
        assert_eq!(far.host_baud(), Some(baud));
    }
}

#[test]
fn one_port_has_one_owner_at_a_time() {
    let mut far = Pty::open().unwrap();
    let path = port_of(&far);
    let first = serial::open(&path, 9_600).unwrap();
    let error = serial::open(&path, 9_600).unwrap_err();
    assert!(matches!(&error, TransportError::Busy { .. }), "{error}");
    assert!(
        error
            .to_string()
            .starts_with(&format!("{path}: in use by another program")),
        "{error}"
    );
    drop(first);
    assert_eq!(far.read(&mut [0; 8]).unwrap(), 0);
    serial::open(&path, 9_600).unwrap();
}

#[test]
fn a_pulled_plug_is_gone_and_its_path_not_found() {
    let far = Pty::open().unwrap();
    let path = port_of(&far);
    let mut host = serial::open(&path, 9_600).unwrap();
    drop(far);
    assert!(host.read(&mut [0; 8]).unwrap_err().is_gone());
    assert!(host.write(&[1]).unwrap_err().is_gone());
    drop(host);
    let error = serial::open(&path, 9_600).unwrap_err();
    assert!(matches!(error, TransportError::NotFound { .. }), "{error}");
}

#[test]
fn a_file_is_not_a_port() {
    let error = serial::open("/dev/null", 9_600).unwrap_err().to_string();
    assert!(error.contains("expected a serial port"), "{error}");
}

/// A path of this test's own, in the build's folder.
fn scratch(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}-{}", std::process::id()))
}

#[test]
fn a_link_comes_and_goes_with_the_terminal_and_replaces_a_dead_one() {
    let link = scratch("bus");
    std::os::unix::fs::symlink("/dev/pts/no-such", &link).unwrap();
    let far = Pty::open_at(&link).unwrap();
    assert_eq!(far.path(), link);
    serial::open(&port_of(&far), 9_600).unwrap();
    drop(far);
    assert!(std::fs::symlink_metadata(&link).is_err());
}

#[test]
fn a_link_never_takes_a_files_place() {
    let file = scratch("precious");
    std::fs::write(&file, "kept").unwrap();
    assert!(Pty::open_at(&file).is_err());
    assert_eq!(std::fs::read_to_string(&file).unwrap(), "kept");
    std::fs::remove_file(&file).unwrap();
}

#[test]
fn waiting_on_a_silent_port_ends_at_the_deadline() {
    let far = Pty::open().unwrap();
    let mut host = serial::open(&port_of(&far), 9_600).unwrap();
    let clock = MonotonicClock::new();
    let until = clock.now().after(Duration::from_millis(5));
    host.wait(&clock, until);
    assert!(clock.now() >= until);
}

#[test]
fn nobody_listening_loses_bytes_and_blocks_nobody() {
    let mut far = Pty::open().unwrap();
    for _ in 0..1_000 {
        far.write(&[0x55; 1_000]).unwrap();
    }
}

#[test]
fn a_socket_carries_bytes_and_its_end() {
    let listener = tcp::listen("127.0.0.1:0").unwrap();
    let port = listener.local_addr().unwrap().port();
    let mut host = tcp::connect("127.0.0.1", port).unwrap();
    let mut far = tcp::accept(&listener)
        .unwrap()
        .expect("the connection is complete");
    host.write(b"ping").unwrap();
    assert_eq!(read_exactly(&mut far, 4), b"ping");
    drop(far);
    let clock = MonotonicClock::new();
    host.wait(&clock, clock.now().after(Duration::from_secs(1)));
    assert!(host.read(&mut [0; 8]).unwrap_err().is_gone());
}
