//! Devices that the kernel gives no node to: the host must say why, and what to do.

use std::process::Command;
use std::time::Duration;

use anyhow::{Context, ensure};
use firmware_sim::usb_kind;
use serde_json::Value;

use super::open::{find_one, plugged};
use super::{Claim, PATIENCE, same};
use crate::kernel::cable::{Cable, Watch};
use crate::kernel::function::Hid;
use crate::kernel::host;

pub(super) const CLAIMS: &[Claim] = &[
    Claim {
        name: "devices: a SoundKnob that HID leaves to the driver powermate is named with it and with the option that frees it",
        show: left_to_powermate,
    },
    Claim {
        name: "devices: a SpaceNavigator whose module is missing is named with it, and found once it is loaded",
        show: module_missing,
    },
];

/// What `devices` tells of a device that is known and has no node, once it is sure of that.
fn without_node(watch: &Watch, profile: &str) -> anyhow::Result<Value> {
    let until_us = watch.now_us() + PATIENCE.as_micros() as u64;
    loop {
        let all = host::devices(false)?;
        if let Some(record) = all.iter().find(|record| host::is_of(record, profile)) {
            same(
                &record["allowed"].as_bool(),
                &Some(false),
                &format!("whether it may be opened: {record}"),
            )?;
            return Ok(record.clone());
        }
        ensure!(watch.now_us() < until_us, "no {profile} among {all:?}");
        watch.pause(Duration::from_millis(50));
    }
}

fn says(record: &Value, words: &[&str]) -> anyhow::Result<()> {
    let remedy = record["remedy"].as_str().unwrap_or_default();
    for word in words {
        ensure!(remedy.contains(word), "it should say \"{word}\": {record}");
    }
    Ok(())
}

fn left_to_powermate(watch: &Watch) -> anyhow::Result<()> {
    // The guest frees the PowerMate's own number only.
    let kind = usb_kind("powermate").context("no such kind")?;
    let _cable = Cable::plug_in(Hid::new((kind.make)()).called([0x077D, 0x04AA]), 1, watch);
    let record = without_node(watch, "powermate")?;
    same(&record["held_by"].as_str(), &Some("powermate"), "who has it")?;
    says(
        &record,
        &[
            "powermate",
            "0x077d:0x04aa:0x40000000",
            "--install-rules",
            "/etc/modprobe.d/",
        ],
    )?;
    let said = host::run(
        &["devices", "--install-rules", "--modprobe-file", "/tmp/options"],
        false,
    )?;
    ensure!(said.status.success(), "{said:?}");
    let options = std::fs::read_to_string("/tmp/options")?;
    ensure!(
        options.contains("quirks=0x077d:0x0410:0x40000000,0x077d:0x04aa:0x40000000"),
        "{options}"
    );
    Ok(())
}

/// Takes a module out of the kernel, and puts it back when it is dropped.
struct Without(&'static str);

impl Without {
    fn module(name: &'static str) -> anyhow::Result<Self> {
        let done = Command::new("rmmod").arg(name).status()?;
        ensure!(done.success(), "rmmod {name}: {done}");
        Ok(Self(name))
    }
}

impl Drop for Without {
    fn drop(&mut self) {
        let file = format!("/modules/{}.ko", self.0);
        match Command::new("insmod").arg(&file).status() {
            Ok(done) if done.success() => {}
            other => eprintln!("insmod {file}: {other:?}"),
        }
    }
}

fn module_missing(watch: &Watch) -> anyhow::Result<()> {
    let without = Without::module("hid-logitech")?;
    let _cable = plugged("spacenavigator", 1, watch)?;
    let record = without_node(watch, "spacenavigator")?;
    says(&record, &["modprobe hid-logitech"])?;
    drop(without);
    find_one(watch, "spacenavigator")?;
    Ok(())
}
