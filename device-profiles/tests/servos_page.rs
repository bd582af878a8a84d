//! `docs/servos.md` says what the profiles say; `UPDATE_PAGES=1` writes it anew.

use device_profiles::{Profiles, PuppetProfile, Role, ServoProfile, Variant, WordOrder};
use std::collections::BTreeSet;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

const HEAD: &str = "\
# Servos and puppets

<!-- Written by `UPDATE_PAGES=1 cargo test -p device-profiles --test servos_page`; change the files in
     `device-profiles/servos/` and `device-profiles/puppets/`. -->

What comes with the program, from the profiles themselves. Each file has its sources in full, and where they disagree,
in comments at its top. *untested* means written from documents: nobody has tried it on the real thing. What you try,
tell us: a profile becomes *supported*, or *quirks* with the oddities in its comments.

[Profiles of your own](profiles.md) tells how to add a servo or a puppet.
";

const MODELS: &str = "
## Servos

*Model number* is what the servo says of itself. *Group reads* are the instructions with which one packet asks many
servos; *fast* is DYNAMIXEL's one answer for all, from the firmware named.

| servo | profile | protocol | model number | counts in a turn | goals | group reads | status |
|---|---|---|---|---|---|---|---|
";

const SPEEDS: &str = "
### Line speeds

| servo | baud |
|---|---|
";

const MOTORS: &str = "
### Motors

At the supply named. *Inertia* is the rotor's as the horn feels it; ≈ marks one that was reckoned from another model's.
The simulator moves its shafts with these, and feasibility is judged by them.

| servo | supply | stall torque | free speed | stall current | inertia |
|---|---|---|---|---|---|
";

const ROLES: &str = "
### Where registers are

By what they are for (`role` in the files); a servo has those it has.

";

const PUPPETS: &str = "
## Puppets

| puppet | profile | joints | servos | line | follows a figure | status |
|---|---|---|---|---|---|---|
";

const SOURCES: &str = "
## Sources

| profile | from |
|---|---|
";

fn page() -> String {
    let all = Profiles::builtin();
    let mut page = String::from(HEAD);
    page.push_str(MODELS);
    all.servos().for_each(|servo| model_row(&mut page, servo));
    page.push_str(SPEEDS);
    for servo in all.servos() {
        line(&mut page, &[servo.name.clone(), list(&servo.bauds)]);
    }
    page.push_str(MOTORS);
    all.servos().for_each(|servo| motor_row(&mut page, servo));
    page.push_str(ROLES);
    roles(&mut page, &all);
    page.push_str(PUPPETS);
    all.puppets().for_each(|puppet| puppet_row(&mut page, puppet));
    page.push_str(SOURCES);
    let sources = all
        .servos()
        .map(|s| (&s.key, &s.source))
        .chain(all.puppets().map(|p| (&p.key, &p.source)));
    for (key, source) in sources {
        line(&mut page, &[format!("`{key}`"), source.clone()]);
    }
    page
}

fn line(page: &mut String, cells: &[String]) {
    let cells: Vec<String> = cells.iter().map(|cell| cell.replace('|', "\\|")).collect();
    // Writing to a string cannot fail.
    let _ = writeln!(page, "| {} |", cells.join(" | "));
}

fn list<T: ToString>(values: &[T]) -> String {
    values.iter().map(T::to_string).collect::<Vec<_>>().join(", ")
}

fn model_row(page: &mut String, servo: &ServoProfile) {
    let mut reads = Vec::new();
    for (has, word) in [(servo.sync_read, "sync"), (servo.bulk_read, "bulk")] {
        if has {
            reads.push(word.to_owned());
        }
    }
    if let Some(firmware) = servo.fast_sync_read_from_firmware {
        reads.push(format!("fast from {firmware}"));
    }
    if reads.is_empty() {
        reads.push("none".to_owned());
    }
    let order = match servo.word_order() {
        WordOrder::Little => "",
        WordOrder::Big => ", high byte first",
    };
    let [first, last] = servo.position_counts;
    line(
        page,
        &[
            servo.name.clone(),
            format!("`{}`", servo.key),
            format!("{}{order}", servo.protocol),
            servo.model_number.to_string(),
            servo.counts_per_turn.to_string(),
            format!("{first} to {last}"),
            reads.join(", "),
            servo.status.word().to_owned(),
        ],
    );
}

fn motor_row(page: &mut String, servo: &ServoProfile) {
    let Some(motor) = &servo.motor else { return };
    let about = if motor.inertia_estimated { "≈ " } else { "" };
    line(
        page,
        &[
            servo.name.clone(),
            format!("{} V", motor.rated_voltage_v),
            format!("{} N m", motor.stall_torque_nm),
            format!("{:.1} rad/s", motor.no_load_speed_rad_per_s),
            format!("{} A", motor.stall_current_a),
            format!("{about}{} kg m²", motor.rotor_inertia_kg_m2),
        ],
    );
}

/// A register's purpose, its first byte and how many it has.
type Place = (Role, u16, u8);

/// One column for each group of servos with the same places; most share theirs.
fn roles(page: &mut String, all: &Profiles) {
    let places = |servo: &ServoProfile| -> Vec<Place> {
        let mut rows: Vec<_> = servo
            .registers
            .iter()
            .filter_map(|row| Some((row.role?, row.address, row.size)))
            .collect();
        rows.sort_unstable();
        rows
    };
    let mut columns: Vec<(Vec<String>, Vec<Place>)> = Vec::new();
    for servo in all.servos() {
        let own = places(servo);
        match columns.iter_mut().find(|(_, rows)| *rows == own) {
            Some((names, _)) => names.push(servo.name.clone()),
            None => columns.push((vec![servo.name.clone()], own)),
        }
    }
    let mut heads = vec!["role".to_owned()];
    heads.extend(columns.iter().map(|(names, _)| names.join(", ")));
    line(page, &heads);
    page.push_str(&"|---".repeat(heads.len()));
    page.push_str("|\n");
    let used: BTreeSet<Role> = columns
        .iter()
        .flat_map(|(_, rows)| rows.iter().map(|r| r.0))
        .collect();
    for role in used {
        let mut cells = vec![format!("`{role}`")];
        cells.extend(columns.iter().map(|(_, rows)| {
            rows.iter()
                .find(|row| row.0 == role)
                .map_or(String::new(), |(_, address, size)| match size {
                    1 => address.to_string(),
                    size => format!("{address} ({size})"),
                })
        }));
        line(page, &cells);
    }
    page.push_str("\nIn brackets: bytes, where there is more than one. Firmware with another table:\n\n");
    for servo in all.servos() {
        for variant in &servo.variants {
            variant_line(page, servo, variant);
        }
    }
}

fn variant_line(page: &mut String, servo: &ServoProfile, variant: &Variant) {
    let [from, to] = variant.firmware;
    let mut said = Vec::new();
    if !variant.removed.is_empty() {
        said.push(format!("lacks {}", variant.removed.join(", ")));
    }
    if !variant.registers.is_empty() {
        let rows = variant.registers.iter();
        let rows: Vec<String> = rows
            .map(|row| format!("{} at {}", row.name, row.address))
            .collect();
        said.push(format!("has {}", rows.join(", ")));
    }
    // Writing to a string cannot fail.
    let _ = writeln!(
        page,
        "- {}, firmware {from} to {to}: {}",
        servo.name,
        said.join("; ")
    );
}

fn puppet_row(page: &mut String, puppet: &PuppetProfile) {
    let mut models: Vec<(String, usize)> = Vec::new();
    for joint in puppet.joints() {
        match models.iter_mut().find(|(model, _)| *model == joint.model) {
            Some((_, count)) => *count += 1,
            None => models.push((joint.model.clone(), 1)),
        }
    }
    let servos: Vec<String> = models
        .iter()
        .map(|(model, count)| format!("{count} × {model}"))
        .collect();
    let lines: Vec<String> = puppet
        .buses
        .iter()
        .map(|bus| format!("{}: {} baud", bus.name, bus.baud))
        .collect();
    line(
        page,
        &[
            puppet.name.clone(),
            format!("`{}`", puppet.key),
            puppet.joints().count().to_string(),
            servos.join(", "),
            lines.join(", "),
            puppet
                .figure
                .clone()
                .unwrap_or_else(|| "no, joint by joint".to_owned()),
            puppet.status.word().to_owned(),
        ],
    );
}

fn place() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/servos.md")
}

#[test]
fn the_page_is_the_profiles() {
    let wanted = page();
    if std::env::var_os("UPDATE_PAGES").is_some_and(|set| set == "1") {
        fs::write(place(), &wanted).expect("docs/ can be written");
    }
    let found = fs::read_to_string(place())
        .unwrap_or_default()
        .replace("\r\n", "\n");
    assert!(
        found == wanted,
        "docs/servos.md is not what the profiles say; \
         write it with: UPDATE_PAGES=1 cargo test -p device-profiles --test servos_page"
    );
}
