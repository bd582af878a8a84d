use super::late::LateFaults;
use super::*;
use device::clock::MonotonicClock;
use device::transport::{self, Address, Transport};
use device_profiles::Profiles;
use firmware_sim::SgiDialBox;
use firmware_sim::dial_box::Options;
use std::path::Path;
use std::sync::{Arc, Mutex};
use std::time::Duration;

/// Ping to servo 1 and its status at factory settings: model 1060 (XL430-W250).
const PING: &[u8] = &[0xFF, 0xFF, 0xFD, 0, 1, 3, 0, 1, 0x19, 0x4E];

/// Serves `device` beside the test; `with` gets its address.
fn serve(mut device: Served, place: &Place, with: impl FnOnce(&str)) -> Vec<(u64, Output)> {
    let mut line = ServeLine::open(place, device.baud()).expect("opens");
    let path = line.path().to_owned();
    let stop = Arc::new(AtomicBool::new(false));
    let shown = Arc::new(Mutex::new(Vec::new()));
    let (stop_there, shown_there) = (Arc::clone(&stop), Arc::clone(&shown));
    let thread = std::thread::spawn(move || {
        let clock = MonotonicClock::new();
        run(
            &mut device,
            &mut line,
            &clock,
            &stop_there,
            &mut || None,
            &mut |event| {
                if let Event::Output(at_us, output) = event {
                    shown_there.lock().expect("whole").push((at_us, output.clone()));
                }
            },
        )
    });
    with(&path);
    stop.store(true, Ordering::Relaxed);
    thread.join().expect("ends").expect("without an error");
    Arc::into_inner(shown)
        .expect("alone")
        .into_inner()
        .expect("whole")
}

fn open(path: &str, baud: u32) -> Box<dyn Transport> {
    transport::open(&path.parse::<Address>().expect("an address"), baud).expect("opens")
}

fn hear(port: &mut dyn Transport, count: usize) -> Vec<u8> {
    let clock = MonotonicClock::new();
    let end = clock.now().after(Duration::from_secs(5));
    let mut heard = Vec::new();
    let mut buffer = [0; 256];
    while heard.len() < count && clock.now() < end {
        port.wait(&clock, end);
        let count = port.read(&mut buffer).expect("there");
        heard.extend_from_slice(&buffer[..count]);
    }
    heard
}

fn bus(folder: Option<&Path>) -> Served {
    let mut plan = BusPlan::new(ServoSpec::parse("XL430-W250:1-3,XL330-M288:7").expect("reads"));
    plan.eeprom = folder.map(Path::to_owned);
    plan.build(&Profiles::builtin()).expect("built in")
}

#[test]
fn a_bus_answers_on_a_terminal_and_not_before_its_time() {
    serve(bus(None), &Place::Pty(None), |path| {
        let mut port = open(path, 1_000_000);
        let clock = MonotonicClock::new();
        let began = clock.now();
        port.write(PING).expect("writes");
        let heard = hear(&mut *port, 14);
        let took = clock.now().since(began);
        assert_eq!(
            heard.get(..12).expect("a status"),
            [255, 255, 253, 0, 1, 7, 0, 0x55, 0, 36, 4, heard[11]]
        );
        // 24 bytes of 10 us and a return delay of 500 us.
        assert!(took >= Duration::from_micros(740), "{took:?}");
    });
}

#[test]
fn a_bus_answers_over_tcp_one_program_after_the_other() {
    serve(bus(None), &Place::Tcp("127.0.0.1:0".into()), |path| {
        for _ in 0..2 {
            let mut port = open(path, 1_000_000);
            port.write(PING).expect("writes");
            assert_eq!(hear(&mut *port, 14).len(), 14);
        }
    });
}

#[test]
fn a_wrong_speed_is_not_understood() {
    serve(bus(None), &Place::Pty(None), |path| {
        let mut port = open(path, 57_600);
        port.write(PING).expect("writes");
        let clock = MonotonicClock::new();
        port.wait(&clock, clock.now().after(Duration::from_millis(20)));
        assert_eq!(port.read(&mut [0; 16]).expect("there"), 0);
    });
}

#[test]
fn memories_outlive_the_program() {
    let folder = tempfile::tempdir().expect("a folder");
    // Write Return Delay Time 5 to servo 1.
    let write = [0xFF, 0xFF, 0xFD, 0, 1, 6, 0, 3, 9, 0, 5, 0x01, 0x66];
    let crc = firmware_crc(&write[..11]);
    let write = [&write[..11], &crc.to_le_bytes()].concat();
    serve(bus(Some(folder.path())), &Place::Pty(None), |path| {
        let mut port = open(path, 1_000_000);
        port.write(&write).expect("writes");
        assert_eq!(hear(&mut *port, 11).len(), 11);
    });
    let Served::Bus(again, ..) = bus(Some(folder.path())) else {
        panic!("a bus")
    };
    assert_eq!(
        again.servo(1).expect("there").register("Return Delay Time"),
        Some(5)
    );
    // What it cost is kept as well; what it is of is checked.
    let file = folder.path().join("servo-1.toml");
    let text = std::fs::read_to_string(&file).expect("a file");
    assert!(text.contains("writes = 1\n"), "{text}");
    std::fs::rename(&file, folder.path().join("servo-7.toml")).expect("renames");
    assert!(refusal(folder.path()).contains("expected the memory of xl330-m288, found that of xl430-w250"));
    let short = "model = \"xl330-m288\"\nwrites = 0\neeprom = \"24 04\"\n";
    std::fs::write(folder.path().join("servo-7.toml"), short).expect("writes");
    assert!(refusal(folder.path()).contains("servo-7.toml: expected 64 bytes, found 2"));
    std::fs::write(folder.path().join("servo-7.toml"), "model = 3").expect("writes");
    assert!(refusal(folder.path()).contains("servo-7.toml"));
}

/// Why the bus with the memories of `folder` cannot be.
fn refusal(folder: &Path) -> String {
    let mut plan = BusPlan::new(ServoSpec::parse("XL430-W250:1-3,XL330-M288:7").expect("reads"));
    plan.eeprom = Some(folder.to_owned());
    let error = plan.build(&Profiles::builtin()).err();
    error.expect("it is no memory of that servo").to_string()
}

#[test]
fn two_servos_of_one_number_have_a_memory_each() {
    let folder = tempfile::tempdir().expect("a folder");
    let plan = || {
        let mut plan = BusPlan::new(ServoSpec::parse("AX-12A:1,AX-12A:1").expect("reads"));
        plan.eeprom = Some(folder.path().to_owned());
        plan.build(&Profiles::builtin()).expect("built in")
    };
    // Both obey: Return Delay Time 5.
    let mut first = plan();
    first.firmware().receive(0, &[0xFF, 0xFF, 1, 4, 3, 5, 5, 0xED]);
    first.firmware().transmit(1_000_000, &mut Vec::new());
    first.keep().expect("keeps");
    assert!(folder.path().join("servo-1-2.toml").exists());
    let Served::Bus(again, ..) = plan() else {
        panic!("a bus")
    };
    for servo in again.servos() {
        assert_eq!(servo.register("Return Delay Time"), Some(5));
    }
}

#[test]
fn without_a_speed_servos_have_the_one_they_come_with() {
    for (model, baud) in [
        ("XL430-W250", 57_600),
        ("STS3215", 1_000_000),
        ("AX-12A", 1_000_000),
    ] {
        let mut plan = BusPlan::new(ServoSpec::parse(&format!("{model}:1")).expect("reads"));
        plan.baud = None;
        let served = plan.build(&Profiles::builtin()).expect("built in");
        assert_eq!(served.baud(), baud, "{model}");
    }
}

#[test]
fn orders_are_faults_hands_and_two_words() {
    let mut served = bus(None);
    assert_eq!(served.order(0, "servo 2 silent"), Ok("servo 2 silent".to_owned()));
    let lines = served.order(10, "servos").expect("a table");
    assert_eq!(lines.lines().count(), 4, "{lines}");
    assert!(lines.contains("xl330-m288"), "{lines}");
    let why = served.order(20, "servo 2 quiet").expect_err("no such fault");
    assert!(why.contains("column 9") && why.contains("`mend`"), "{why}");
    let why = served.order(25, "servo 9 silent").expect_err("no such servo");
    assert_eq!(why, "there is no servo 9; there are: 1, 2, 3, 7");
    assert!(
        served.order(26, "servo 9 silent at 2s").is_ok(),
        "by then there may be one"
    );
    assert_eq!(served.order(30, "mend"), Ok("mended".to_owned()));
    assert!(served.order(40, "hand on 2 turns to 20 deg over 100ms").is_ok());
    let lines = served.order(500_000, "servos").expect("a table");
    assert!(
        lines
            .lines()
            .nth(1)
            .is_some_and(|line| line.contains(" 20.00 deg")),
        "{lines}"
    );
}

fn dial_box(options: Options) -> Served {
    Served::Input(Box::new(SgiDialBox::new(options)), LateFaults::default())
}

#[test]
fn hands_and_faults_may_be_asked_for_while_a_box_runs() {
    let mut dials = dial_box(Options::default());
    dials.firmware().receive(0, &[0x20, 0x50, 0, 0xFF]);
    let mut heard = Vec::new();
    dials.firmware().transmit(20_000, &mut heard);
    assert_eq!(dials.order(20_000, "drop 1"), Ok("drop 1".to_owned()));
    assert_eq!(dials.order(20_000, " dial 2 +5 "), Ok("dial 2 +5".to_owned()));
    dials.firmware().transmit(60_000, &mut heard);
    assert_eq!(heard, [0x20], "the report of the turn was dropped");
    assert!(dials.order(60_000, "dial 2 +1").is_ok());
    dials.firmware().transmit(100_000, &mut heard);
    assert_eq!(heard, [0x20, 0x32, 0, 6]);
    for (order, why) in [
        ("mend", "an order is"),
        ("dial 8 +1", "0 to 7"),
        ("unplug after 2", "type `unplug`"),
    ] {
        let refused = dials.order(100_000, order).expect_err(order);
        assert!(refused.contains(why), "{refused}");
    }
}

#[test]
fn a_cable_that_is_pulled_out_is_gone_and_back_under_its_name() {
    let folder = std::env::temp_dir().join(format!("dialrig-cable-{}", std::process::id()));
    let mut line = ServeLine::open(&Place::Pty(Some(folder.clone())), 9600).expect("opens");
    let mut box_there = dial_box(Options::default());
    let mut port = open(&folder.display().to_string(), 9600);
    let pull = |order: &str, line: &mut ServeLine, device: &mut Served| {
        orders::Cable::of(order).expect("one").move_it(line, device, 0)
    };
    assert_eq!(
        pull("unplug", &mut line, &mut box_there),
        Ok("unplugged".to_owned())
    );
    assert!(!folder.exists());
    assert!(port.read(&mut [0; 8]).is_err_and(|error| error.is_gone()));
    assert!(
        line.read(&mut [0; 8]).is_ok_and(|count| count == 0),
        "the device lives on"
    );
    assert_eq!(
        pull("plug", &mut line, &mut box_there),
        Ok("plugged in".to_owned())
    );
    let mut again = open(&folder.display().to_string(), 9600);
    line.write(&[0x20]).expect("somebody listens");
    assert_eq!(hear(&mut *again, 1), [0x20]);
}

/// CRC-16 of the protocol page, bit by bit: polynomial 8005, nothing reflected.
fn firmware_crc(bytes: &[u8]) -> u16 {
    bytes.iter().fold(0, |crc: u16, &byte| {
        (0..8).fold(crc ^ u16::from(byte) << 8, |crc, _| {
            if crc & 0x8000 == 0 {
                crc << 1
            } else {
                crc << 1 ^ 0x8005
            }
        })
    })
}

#[test]
fn a_dial_box_plays_its_script_and_tells_what_it_is_shown() {
    let options = Options {
        labels: true,
        ..Options::default()
    };
    let mut device = dial_box(options);
    let script = firmware_sim::Script::parse(firmware_sim::script::Device::DIAL_BOX, "at 0.05 dial 2 +5\n");
    device.play(&script.expect("reads"));
    let shown = serve(device, &Place::Pty(None), |path| {
        let mut port = open(path, 9600);
        port.write(&[0x20]).expect("writes");
        assert_eq!(hear(&mut *port, 1), [0x20]);
        // Thirteen bytes, over before the script's first turn.
        port.write(b"\x50\x00\xFF\x61\x02X-Trans ").expect("writes");
        assert_eq!(hear(&mut *port, 3), [0x32, 0, 5]);
    });
    assert!(
        shown.iter().any(|(_, output)| {
            *output
                == Output::Label {
                    control: 2,
                    text: "X-Trans ".into(),
                }
        }),
        "{shown:?}"
    );
}

#[test]
fn servo_lists_are_read() {
    let spec = |model: &str, first, last| ServoSpec {
        model: model.into(),
        first,
        last,
    };
    let good = ServoSpec::parse("XL430-W250:1-20, XL330-M288:7").expect("reads");
    assert_eq!(good, [spec("XL430-W250", 1, 20), spec("XL330-M288", 7, 7)]);
    for bad in [
        "",
        "XL430-W250",
        "XL430-W250:",
        ":1",
        "XL430-W250:5-1",
        "XL430-W250:1-254",
        "XL430-W250:x",
    ] {
        let error = ServoSpec::parse(bad).expect_err(bad).to_string();
        assert!(error.contains("expected MODEL:ID"), "{error}");
    }
}
