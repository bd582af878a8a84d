//! The shipped files, held to what their schema cannot say.

use device_profiles::{Access, Area, Kind, Profiles, Register, Tool, Unit, read_file};
use std::path::{Path, PathBuf};

fn all_files() -> Vec<PathBuf> {
    let mut folders: Vec<_> = ["servos", "puppets", "knobs", "tablets"]
        .map(|f| Path::new(env!("CARGO_MANIFEST_DIR")).join(f))
        .into();
    let mut files = Vec::new();
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else {
                files.push(path);
            }
        }
    }
    files.sort();
    files
}

fn key_name_source(profile: &Kind) -> (&str, &str, &str) {
    match profile {
        Kind::Servo(p) => (&p.key, &p.name, &p.source),
        Kind::Puppet(p) => (&p.key, &p.name, &p.source),
        Kind::Knobs(p) => (&p.key, &p.name, &p.source),
        Kind::Tablet(p) => (&p.key, &p.name, &p.source),
    }
}

fn printed(profile: &Kind) -> String {
    match profile {
        Kind::Servo(p) => toml::to_string(p),
        Kind::Puppet(p) => toml::to_string(p),
        Kind::Knobs(p) => toml::to_string(p),
        Kind::Tablet(p) => toml::to_string(p),
    }
    .unwrap()
}

#[test]
fn every_file_reads_bears_its_source_and_a_name_of_its_own() {
    let mut keys = Vec::new();
    let mut names = Vec::new();
    for file in all_files() {
        let profile = read_file(&file).unwrap_or_else(|errors| panic!("{}", errors[0]));
        let (key, name, source) = key_name_source(&profile);
        assert!(
            source.len() > 10,
            "{}: a source is wanted, found \"{source}\"",
            file.display()
        );
        keys.push(key.to_owned());
        names.push(name.to_lowercase());
    }
    for list in [&mut keys, &mut names] {
        let count = list.len();
        list.sort();
        list.dedup();
        assert_eq!(list.len(), count, "two profiles share a key or a name: {list:?}");
    }
}

/// Canonical: printed and read again nothing is added, dropped or written in another type; and the text keeps
/// to one way of laying out.
#[test]
fn every_file_is_in_canonical_form() {
    for file in all_files() {
        let shown = file.display();
        let text = std::fs::read_to_string(&file).unwrap();
        let table: toml::Table = text.parse().unwrap();
        let again: toml::Table = printed(&read_file(&file).unwrap()).parse().unwrap();
        assert_eq!(table, again, "{shown}");
        assert!(
            text.ends_with('\n') && !text.ends_with("\n\n"),
            "{shown}: one line end at the end"
        );
        let untidy = |line: &str| line.contains(['\t', '\r']) || line.ends_with(' ');
        assert_eq!(text.lines().find(|line| untidy(line)), None, "{shown}");
        let first: Vec<&str> = text
            .lines()
            .filter(|l| !l.starts_with('#'))
            .filter_map(|l| l.split(" = ").next())
            .take(2)
            .collect();
        assert_eq!(first, ["name", "status"], "{shown}: name and status come first");
    }
}

#[test]
fn builtin_profiles_are_found_by_key_and_by_name() {
    let all = Profiles::builtin();
    assert_eq!(all.servo("XL330-M288").unwrap().model_number, 1200);
    assert_eq!(all.servo("xl430-w250").unwrap().model_number, 1060);
    assert_eq!(all.servo_by_model(1060).unwrap().name, "XL430-W250");
    assert_eq!(all.puppet("marionette").unwrap().joints().count(), 22);
    assert_eq!(all.knobs("SGI dial and button box").unwrap().key, "sgi-dialbox");
    assert_eq!(
        all.tablet("graphire-serial").unwrap().surface.counts,
        [5103, 3711]
    );
    let missing = all.servo("mx-28").unwrap_err().to_string();
    assert_eq!(
        missing,
        "there is no servo profile named \"mx-28\"; there are: xl330-m288, xl430-w250"
    );
}

#[test]
fn no_two_profiles_claim_the_same_device() {
    let all = Profiles::builtin();
    let mut models: Vec<_> = all.servos().map(|s| s.model_number).collect();
    let mut prefixes: Vec<_> = all.tablets().map(|t| t.identify.prefix.clone()).collect();
    let counts = (models.len(), prefixes.len());
    models.sort_unstable();
    models.dedup();
    prefixes.sort();
    prefixes.dedup();
    assert_eq!((models.len(), prefixes.len()), counts);
    for tablet in all.tablets() {
        assert!(
            tablet.identify.model.starts_with(&tablet.identify.prefix),
            "{}",
            tablet.name
        );
        assert_eq!(
            tablet.tools.iter().filter(|t| t.tool == Tool::Pen).count(),
            1,
            "{}",
            tablet.name
        );
    }
}

#[test]
fn registers_stand_where_the_manual_puts_them() {
    let all = Profiles::builtin();
    let rows = [
        ("Model Number", 0, 2, Area::Eeprom, Access::R),
        ("Return Delay Time", 9, 1, Area::Eeprom, Access::Rw),
        ("Torque Enable", 64, 1, Area::Ram, Access::Rw),
        ("Bus Watchdog", 98, 1, Area::Ram, Access::Rw),
        ("Profile Velocity", 112, 4, Area::Ram, Access::Rw),
        ("Goal Position", 116, 4, Area::Ram, Access::Rw),
        ("Realtime Tick", 120, 2, Area::Ram, Access::R),
        ("Present Position", 132, 4, Area::Ram, Access::R),
        ("Present Temperature", 146, 1, Area::Ram, Access::R),
    ];
    for servo in all.servos() {
        for (name, address, size, area, access) in rows {
            let row = servo
                .register(name)
                .unwrap_or_else(|| panic!("{} has no {name}", servo.name));
            assert_eq!(
                (row.address, row.size, row.area, row.access),
                (address, size, area, access),
                "{name}"
            );
            assert_eq!(servo.register_at(address).map(|r| r.name.as_str()), Some(name));
        }
        assert_eq!(servo.baud_code(1_000_000), Some(3));
        assert_eq!(
            servo.register("Model Number").unwrap().init,
            Some(servo.model_number.into())
        );
    }
    let bytes = |name| all.servo(name).unwrap().table_bytes();
    assert_eq!((bytes("xl330-m288"), bytes("xl430-w250")), (252, 662));
}

#[test]
fn start_values_fit_their_rows() {
    for servo in Profiles::builtin().servos() {
        for row in &servo.registers {
            let Some(init) = row.init else { continue };
            let last = init + row.init_step * i64::from(row.count - 1);
            let in_range = |v: i64| {
                row.min.is_none_or(|min| v >= min)
                    && row.max.is_none_or(|max| v <= max)
                    && (row.values.is_empty() || row.values.contains(&v))
            };
            // The manual's start value 255 of this one lies outside its own range and means "none".
            let switched_off = row.name == "Secondary(Shadow) ID" && init == 255;
            assert!(
                switched_off || in_range(init) && in_range(last),
                "{}: {}",
                servo.name,
                row.name
            );
            assert!(fits(row, init) && fits(row, last), "{}: {}", servo.name, row.name);
        }
    }
}

fn fits(row: &Register, value: i64) -> bool {
    let bits = u32::from(row.size) * 8;
    let (low, high) = if row.signed {
        (-(1_i64 << (bits - 1)), (1 << (bits - 1)) - 1)
    } else {
        (0, (1 << bits) - 1)
    };
    (low..=high).contains(&value)
}

#[test]
fn units_are_the_ones_their_counts_imply() {
    use std::f64::consts::TAU;
    for servo in Profiles::builtin().servos() {
        let of = |name: &str| {
            let row = servo
                .register(name)
                .unwrap_or_else(|| panic!("{} has no {name}", servo.name));
            (row.unit.unwrap(), row.unit_per_count.unwrap())
        };
        let rows = [
            ("Present Position", Unit::Radian, servo.rad_per_count()),
            ("Goal Position", Unit::Radian, TAU / 4096.0),
            ("Present Velocity", Unit::RadianPerSecond, 0.229 * TAU / 60.0),
            (
                "Profile Velocity",
                Unit::RadianPerSecond,
                servo.rad_per_s_per_count(),
            ),
            (
                "Profile Acceleration",
                Unit::RadianPerSecondSquared,
                214.577 * TAU / 3600.0,
            ),
            ("Realtime Tick", Unit::Second, 0.001),
            ("Present Input Voltage", Unit::Volt, 0.1),
        ];
        for (name, unit, factor) in rows {
            let (found, per_count) = of(name);
            assert_eq!(found, unit, "{name}");
            assert!(
                (per_count / factor - 1.0).abs() < 1e-9,
                "{name}: {per_count}, wanted {factor}"
            );
        }
    }
}
