use super::*;
use crate::ports::{Found, Plug};
use device::transport::memory::{self, MemoryTransport, reports};

/// Ports whose plugs a test pulls.
#[derive(Default)]
struct Sockets {
    found: Vec<Found>,
    lines: Vec<(String, Box<dyn Transport>)>,
    opened: Vec<String>,
    /// So many attempts to open find that somebody has the line.
    busy: usize,
}

impl Sockets {
    /// Plugs a dial box in; its far end.
    fn plug(&mut self, address: &str, slot: u16) -> MemoryTransport {
        let (host, far) = memory::pair_named(address);
        self.lines.push((address.to_owned(), Box::new(host)));
        self.found.push(Found {
            address: address.to_owned(),
            matches: vec!["sgi-dialbox".to_owned()],
            plug: Some(Plug {
                name: "sgi-dialbox".to_owned(),
                profile: Some("sgi-dialbox".to_owned()),
                slot,
                baud: 9600,
                identity: String::new(),
            }),
            ..Found::default()
        });
        far
    }

    fn unplug(&mut self, address: &str) {
        self.found.retain(|found| found.address != address);
        self.lines.retain(|(at, _)| at != address);
    }
}

impl Ports for Sockets {
    fn list(&mut self) -> Vec<Found> {
        self.found.clone()
    }
    fn open(&mut self, address: &str, _baud: u32) -> Result<Box<dyn Transport>, TransportError> {
        self.opened.push(address.to_owned());
        if self.busy > 0 {
            self.busy -= 1;
            return Err(TransportError::Busy {
                address: address.to_owned(),
            });
        }
        let place = self.lines.iter().position(|(at, _)| at == address);
        match place {
            Some(place) => Ok(self.lines.remove(place).1),
            None => Err(TransportError::NotFound {
                address: address.to_owned(),
            }),
        }
    }
    fn pin(&mut self, _address: &str, _slot: Option<u16>) -> Result<(), String> {
        Ok(())
    }
}

struct Desk {
    inputs: Inputs,
    sockets: Sockets,
    heard: Vec<Heard>,
    said: Vec<Change>,
    now: Instant,
}

impl Desk {
    fn new(specs: Vec<InputSpec>) -> Self {
        Self {
            inputs: Inputs::new(specs, &Arc::new(Profiles::builtin())).expect("its profile is there"),
            sockets: Sockets::default(),
            heard: Vec::new(),
            said: Vec::new(),
            now: Instant::ZERO,
        }
    }

    /// Polls every 10 ms for so long.
    fn run(&mut self, ms: u64) {
        for _ in 0..ms / 10 {
            self.now = self.now.after(Duration::from_millis(10));
            let said = &mut self.said;
            self.inputs
                .poll(self.now, &mut self.sockets, &mut self.heard, &mut |change| {
                    said.push(change);
                });
        }
    }

    /// Names and how they are.
    fn told(&self) -> Vec<(String, DeviceHealth)> {
        let views = self.inputs.view().into_iter();
        views.map(|view| (view.name, view.health)).collect()
    }
}

fn answers(far: &mut MemoryTransport) {
    far.write(&[0x20]).expect("the host is there");
}

#[test]
fn a_known_device_is_taken_within_a_second_and_keeps_its_seat_while_it_is_away() {
    let mut desk = Desk::new(Vec::new());
    desk.run(500);
    assert!(desk.told().is_empty());
    let mut far = desk.sockets.plug("/dev/ttyUSB0", 1);
    desk.run(500);
    answers(&mut far);
    desk.run(500);
    assert_eq!(desk.told(), [("sgi-dialbox".to_owned(), DeviceHealth::Present)]);
    desk.sockets.unplug("/dev/ttyUSB0");
    drop(far);
    desk.run(20);
    assert_eq!(desk.told(), [("sgi-dialbox".to_owned(), DeviceHealth::Lost)]);
    // It comes back in another port.
    let mut far = desk.sockets.plug("/dev/ttyUSB7", 1);
    desk.run(500);
    answers(&mut far);
    desk.run(500);
    assert_eq!(desk.told(), [("sgi-dialbox".to_owned(), DeviceHealth::Present)]);
    assert_eq!(desk.inputs.address("sgi-dialbox"), Some("/dev/ttyUSB7"));
}

#[test]
fn equal_ones_have_numbers_and_the_second_plugged_first_is_still_the_second() {
    let mut desk = Desk::new(Vec::new());
    let mut second = desk.sockets.plug("/dev/ttyUSB0", 2);
    desk.run(1000);
    let mut first = desk.sockets.plug("/dev/ttyUSB1", 1);
    desk.run(1000);
    answers(&mut first);
    answers(&mut second);
    desk.run(100);
    let names: Vec<_> = desk.told().into_iter().map(|(name, _)| name).collect();
    assert_eq!(names, ["sgi-dialbox", "sgi-dialbox2"]);
    assert_eq!(desk.inputs.address("sgi-dialbox2"), Some("/dev/ttyUSB0"));
}

#[test]
fn what_may_not_be_opened_is_said_after_a_while_and_taken_when_it_may() {
    let mut desk = Desk::new(Vec::new());
    let mut far = desk.sockets.plug("/dev/hidraw0", 1);
    desk.sockets.found[0].allowed = Err("a rule".to_owned());
    desk.run(1500);
    assert!(
        desk.said.is_empty(),
        "its rights may still be on their way: {:?}",
        desk.said
    );
    desk.run(1500);
    let rule = "a rule".to_owned();
    assert_eq!(
        desk.told(),
        [("sgi-dialbox".to_owned(), DeviceHealth::Forbidden { rule })]
    );
    assert!(desk.sockets.opened.is_empty());
    assert_eq!(desk.said.len(), 1, "once");
    desk.sockets.found[0].allowed = Ok(());
    desk.run(500);
    answers(&mut far);
    desk.run(100);
    assert_eq!(desk.told(), [("sgi-dialbox".to_owned(), DeviceHealth::Present)]);
}

#[test]
fn what_was_named_is_not_taken_twice_and_what_nobody_knows_is_left_alone() {
    let spec = InputSpec {
        name: "box".to_owned(),
        profile: "sgi-dialbox".to_owned(),
        address: "/dev/ttyUSB0".to_owned(),
    };
    let mut desk = Desk::new(vec![spec]);
    let mut far = desk.sockets.plug("/dev/ttyUSB0", 1);
    desk.sockets.found.push(Found {
        address: "/dev/ttyUSB1".to_owned(),
        ..Found::default()
    });
    desk.run(100);
    answers(&mut far);
    desk.run(2000);
    assert_eq!(desk.told(), [("box".to_owned(), DeviceHealth::Present)]);
    assert_eq!(desk.sockets.opened, ["/dev/ttyUSB0"]);
}

#[test]
fn pulled_and_put_back_a_hundred_times_nothing_is_lost_or_doubled() {
    let mut desk = Desk::new(Vec::new());
    for round in 0..100_u64 {
        let address = format!("/dev/ttyUSB{round}");
        let mut far = desk.sockets.plug(&address, 1);
        // Pulled at another moment of its beginning every time.
        desk.run(400 + round * 10);
        let _ = far.write(&[0x20]);
        desk.run(30);
        assert_eq!(desk.told().len(), 1, "round {round}");
        desk.sockets.unplug(&address);
        drop(far);
        desk.run(30);
    }
    let came = desk
        .said
        .iter()
        .filter(|said| matches!(said, Change::Came(_)))
        .count();
    let gone = desk
        .said
        .iter()
        .filter(|said| matches!(said, Change::Gone(..)))
        .count();
    assert_eq!(came, gone, "every coming has its going");
    assert!(came > 90, "{came}");
}

#[test]
fn what_describes_itself_is_taken_without_a_profile_and_what_says_nothing_is_not() {
    let mut desk = Desk::new(Vec::new());
    let mut plug = |address: &str, descriptor: &[u8]| {
        let (host, far) = reports::pair(address);
        far.set_descriptor(descriptor);
        desk.sockets.lines.push((address.to_owned(), Box::new(host)));
        desk.sockets.found.push(Found {
            address: address.to_owned(),
            plug: Some(Plug {
                name: "hid-1209-0001".to_owned(),
                profile: None,
                slot: desk.sockets.found.len() as u16 + 1,
                baud: 0,
                identity: String::new(),
            }),
            ..Found::default()
        });
        far
    };
    // A multi-axis controller with one axis of eight bits; and a vendor's page of which nobody knows anything.
    let axis = [
        0x05, 1, 0x09, 8, 0xA1, 1, 0x09, 0x30, 0x15, 0, 0x26, 0xFF, 0, 0x75, 8, 0x95, 1, 0x81, 2, 0xC0,
    ];
    let vendor = [
        0x06, 0, 0xFF, 0x09, 1, 0xA1, 1, 0x09, 1, 0x15, 0, 0x26, 0xFF, 0, 0x75, 8, 0x95, 1, 0x81, 2, 0xC0,
    ];
    let far = plug("/dev/hidraw0", &axis);
    let _other = plug("/dev/hidraw1", &vendor);
    desk.run(1000);
    assert_eq!(desk.told(), [("hid-1209-0001".to_owned(), DeviceHealth::Present)]);
    assert_eq!(desk.sockets.opened, ["/dev/hidraw0", "/dev/hidraw1"], "each once");
    far.report(&[200]);
    desk.run(20);
    let said = desk.heard.iter().map(|heard| &heard.event.what);
    let moved = said.filter(|what| matches!(what, InputEvent::Axis { value: 200, .. }));
    assert_eq!(moved.count(), 1);
}

fn named(address: &str) -> InputSpec {
    InputSpec {
        name: "box".to_owned(),
        profile: "sgi-dialbox".to_owned(),
        address: address.to_owned(),
    }
}

/// The thread that read it has not noticed yet that nobody wants it any more.
#[test]
fn a_line_just_let_go_of_is_waited_for_in_silence_and_one_that_is_held_is_said() {
    let mut desk = Desk::new(vec![named("osc:8000")]);
    let mut far = desk.sockets.plug("osc:8000", 1);
    desk.sockets.busy = 4;
    desk.run(300);
    answers(&mut far);
    desk.run(50);
    assert_eq!(desk.said, [Change::Came("box".to_owned())]);
    let mut desk = Desk::new(vec![named("osc:8000")]);
    desk.sockets.busy = usize::MAX;
    desk.run(400);
    assert_eq!(desk.said, []);
    desk.run(400);
    let held = DeviceHealth::Held {
        driver: "another program".to_owned(),
    };
    assert_eq!(desk.told(), [("box".to_owned(), held)]);
    assert!(matches!(desk.said[..], [Change::Absent(..)]), "{:?}", desk.said);
}

/// Who is given another place lets go of everything first, and goes on with the line it is given then.
#[test]
fn what_is_held_when_a_device_is_given_another_place_is_let_go() {
    let mut desk = Desk::new(Vec::new());
    let mut far = desk.sockets.plug("/dev/ttyUSB0", 1);
    desk.run(500);
    answers(&mut far);
    desk.run(100);
    far.write(&[0xC3]).expect("the host is there");
    desk.run(100);
    let buttons = |heard: &[Heard]| -> Vec<InputEvent> {
        let button = |it: &&Heard| matches!(it.event.what, InputEvent::Button { .. });
        heard.iter().filter(button).map(|it| it.event.what).collect()
    };
    let [InputEvent::Button { control, down: true }] = buttons(&desk.heard)[..] else {
        panic!("{:?}", buttons(&desk.heard));
    };
    let edge = |down| InputEvent::Button { control, down };
    let Desk { inputs, sockets, .. } = &mut desk;
    inputs.pin("sgi-dialbox", Some(2), sockets).expect("it is known");
    desk.run(20);
    assert_eq!(buttons(&desk.heard), [edge(true), edge(false)]);
    drop(far);
    desk.sockets.unplug("/dev/ttyUSB0");
    let mut far = desk.sockets.plug("/dev/ttyUSB1", 2);
    desk.run(1000);
    answers(&mut far);
    desk.run(100);
    assert_eq!(buttons(&desk.heard).len(), 2);
}

#[test]
fn a_number_behind_a_name_is_not_read_as_part_of_it() {
    let desk = Desk::new(Vec::new());
    for (kind, slot, name) in [
        ("knob", 1, "knob"),
        ("knob", 2, "knob2"),
        ("nanokontrol2", 1, "nanokontrol2"),
        ("nanokontrol2", 2, "nanokontrol2-2"),
        ("nanokontrol2", 12, "nanokontrol2-12"),
    ] {
        assert_eq!(desk.inputs.free_name(kind, slot), name);
    }
}
