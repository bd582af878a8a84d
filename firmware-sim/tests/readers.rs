//! The dial box against the programs that are known to read a real one: what each sends, in its own order and pace,
//! and what it must hear. The files are exchanges; who is `host` in them is not our driver.

use firmware_sim::Firmware;
use firmware_sim::dial_box::{Options, SgiDialBox};
use firmware_sim::hands::Hands;
use firmware_sim::script::{Device, Script};

/// A second of answers at 9600 baud would be 960 bytes; this is long enough for any of these and for a still line.
const LISTEN_US: u64 = 150_000;

struct Reader<'a> {
    name: &'a str,
    dial_box: SgiDialBox,
    now_us: u64,
    /// Between two bytes of the host.
    slowly_us: u64,
    heard: Vec<u8>,
}

impl Reader<'_> {
    fn run(&mut self, line: &str) {
        let name = self.name;
        let (word, rest) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
        match word {
            "source:" => {}
            "slowly" => self.slowly_us = micros(rest),
            "pause" => self.pass(micros(rest)),
            "host" => {
                for byte in hex(rest.trim_start().strip_prefix('>').expect("host > bytes")) {
                    self.dial_box.receive(self.now_us, &[byte]);
                    self.pass(self.slowly_us);
                }
            }
            "device" => {
                self.pass(LISTEN_US);
                let wanted = hex(rest.trim_start().strip_prefix('<').expect("device < bytes"));
                assert_eq!(self.heard, wanted, "{name}: {line}");
                self.heard.clear();
            }
            "hand" => {
                let script = Script::parse(Device::DIAL_BOX, &format!("at 0 {rest}")).expect(line);
                for action in script.actions {
                    assert!(self.dial_box.touch(self.now_us, &action.touch), "{name}: {line}");
                }
                if rest.trim() == "power-cycle" {
                    self.pass(1_000_000);
                }
            }
            "lamps" => {
                self.pass(LISTEN_US);
                let wanted = rest
                    .split_whitespace()
                    .map(|n| 1u32 << n.parse::<u32>().expect(line));
                assert_eq!(
                    self.dial_box.lamps(),
                    wanted.fold(0, |all, lamp| all | lamp),
                    "{name}: {line}"
                );
            }
            _ => panic!("{name}: expected host, device, hand, lamps, pause or slowly, found {line}"),
        }
    }

    fn pass(&mut self, us: u64) {
        self.now_us += us;
        self.dial_box.transmit(self.now_us, &mut self.heard);
    }
}

fn micros(secs: &str) -> u64 {
    (secs.trim().parse::<f64>().expect("seconds") * 1e6).round() as u64
}

fn hex(text: &str) -> Vec<u8> {
    let byte = |pair| u8::from_str_radix(pair, 16).expect("hexadecimal");
    text.split_whitespace().map(byte).collect()
}

#[test]
fn every_known_reader_is_understood_in_its_own_order() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/readers");
    let mut read = 0;
    for entry in std::fs::read_dir(folder).expect("the folder is there") {
        let path = entry.expect("readable").path();
        let text = std::fs::read_to_string(&path).expect("readable");
        let name = path.file_stem().and_then(|stem| stem.to_str()).expect("a name");
        // Whether or not the first set-up of the buttons is lost: VRPN says twice, the others do not care.
        for loses_first_button_setup in [false, true] {
            let options = Options {
                loses_first_button_setup,
                ..Options::default()
            };
            let mut reader = Reader {
                name,
                dial_box: SgiDialBox::new(options),
                now_us: 0,
                slowly_us: 0,
                heard: Vec::new(),
            };
            let lines = text
                .lines()
                .map(|line| line.split('#').next().unwrap_or("").trim());
            lines
                .filter(|line| !line.is_empty())
                .for_each(|line| reader.run(line));
            reader.pass(LISTEN_US);
            assert_eq!(
                reader.heard,
                [] as [u8; 0],
                "{name}: said more than its reader was told"
            );
            assert_eq!(reader.dial_box.unknown_bytes(), 0, "{name}");
        }
        read += 1;
    }
    assert_eq!(read, 5);
}
