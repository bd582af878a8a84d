//! The host program as anybody runs it: a command line, JSON lines, an exit code.

use std::io::{BufRead, BufReader, Read};
use std::os::unix::process::CommandExt;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use anyhow::{Context, bail};
use serde_json::Value;

use super::cable::Watch;

/// The program under test, found in the path.
const HOST: &str = "dialrig";
/// A user without any rights.
const NOBODY: u32 = 65534;

/// What a command said and how it ended.
#[derive(Debug)]
pub struct Said {
    /// Standard output.
    pub out: String,
    /// Standard error.
    pub err: String,
    /// Exit.
    pub status: ExitStatus,
}

fn command(arguments: &[&str], as_nobody: bool) -> Command {
    let mut command = Command::new(HOST);
    command.args(arguments).stdin(Stdio::null());
    // A home of its own: profiles and remembered devices of nobody else.
    command.env("HOME", if as_nobody { "/tmp/nobody" } else { "/tmp/root" });
    if as_nobody {
        command.uid(NOBODY).gid(NOBODY);
    }
    command
}

/// Runs the host to its end.
pub fn run(arguments: &[&str], as_nobody: bool) -> anyhow::Result<Said> {
    let output = command(arguments, as_nobody)
        .output()
        .with_context(|| format!("{HOST} {}", arguments.join(" ")))?;
    Ok(Said {
        out: String::from_utf8_lossy(&output.stdout).into_owned(),
        err: String::from_utf8_lossy(&output.stderr).into_owned(),
        status: output.status,
    })
}

/// What a user without rights is told when the host's own code opens `address` for him.
pub fn try_open_as_nobody(address: &str) -> anyhow::Result<String> {
    let output = Command::new(std::env::current_exe()?)
        .args([TRY_OPEN, address])
        .uid(NOBODY)
        .gid(NOBODY)
        .output()?;
    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
}

/// Argument by which this program opens a device and says what came of it.
pub const TRY_OPEN: &str = "--try-open";

/// The records of `devices --json`.
pub fn devices(as_nobody: bool) -> anyhow::Result<Vec<Value>> {
    let said = run(&["devices", "--json"], as_nobody)?;
    if !said.status.success() {
        bail!("devices ended with {}: {}", said.status, said.err);
    }
    let records = said.out.lines().map(serde_json::from_str);
    records
        .collect::<Result<_, _>>()
        .with_context(|| format!("devices said {}", said.out))
}

/// Whether a record of `devices` names this profile.
pub fn is_of(record: &Value, profile: &str) -> bool {
    let names = record["profiles"]
        .as_array()
        .map(Vec::as_slice)
        .unwrap_or_default();
    names.iter().any(|name| name == profile)
}

/// Looks until at least `count` devices match `profile`, for at most `limit`; their records.
pub fn wait_for(watch: &Watch, profile: &str, count: usize, limit: Duration) -> anyhow::Result<Vec<Value>> {
    let until_us = watch.now_us() + limit.as_micros() as u64;
    loop {
        let all = devices(false)?;
        let found: Vec<Value> = all
            .iter()
            .filter(|record| is_of(record, profile) && !address(record).starts_with("sim:"))
            .cloned()
            .collect();
        if found.len() >= count {
            return Ok(found);
        }
        if watch.now_us() > until_us {
            bail!("{} of {count} {profile} found among {all:?}", found.len());
        }
        watch.pause(Duration::from_millis(50));
    }
}

/// The address in a record of `devices`.
pub fn address(record: &Value) -> &str {
    record["address"].as_str().unwrap_or_default()
}

/// Lines as they come.
#[derive(Default)]
struct Lines {
    lines: Mutex<(Vec<String>, bool)>,
    more: Condvar,
}

impl Lines {
    fn lock(&self) -> MutexGuard<'_, (Vec<String>, bool)> {
        self.lines.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn follow(self: &Arc<Self>, from: impl Read + Send + 'static) {
        let lines = Arc::clone(self);
        std::thread::spawn(move || {
            for line in BufReader::new(from).lines().map_while(Result::ok) {
                lines.lock().0.push(line);
                lines.more.notify_all();
            }
            lines.lock().1 = true;
            lines.more.notify_all();
        });
    }
}

/// The host while it runs. Dropping it ends it.
pub struct Running {
    child: Child,
    out: Arc<Lines>,
    err: Arc<Lines>,
}

impl Running {
    /// Starts the host.
    pub fn start(arguments: &[&str]) -> anyhow::Result<Self> {
        let mut child = command(arguments, false)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .with_context(|| format!("{HOST} {}", arguments.join(" ")))?;
        let (out, err) = (Arc::new(Lines::default()), Arc::new(Lines::default()));
        if let Some(pipe) = child.stdout.take() {
            out.follow(pipe);
        }
        if let Some(pipe) = child.stderr.take() {
            err.follow(pipe);
        }
        Ok(Self { child, out, err })
    }

    /// Waits until a predicate holds of all JSON lines so far, which it gets; their final state, or what there was.
    pub fn until(
        &self,
        limit: Duration,
        what: &str,
        mut holds: impl FnMut(&[Value]) -> bool,
    ) -> anyhow::Result<Vec<Value>> {
        let mut records = Vec::new();
        let mut lines = self.out.lock();
        loop {
            let new = lines.0.get(records.len()..).unwrap_or_default();
            for line in new {
                records.push(serde_json::from_str(line).with_context(|| format!("not JSON: {line}"))?);
            }
            if holds(&records) {
                return Ok(records);
            }
            let ended = lines.1;
            let (next, timed_out) = self
                .out
                .more
                .wait_timeout(lines, limit)
                .unwrap_or_else(PoisonError::into_inner);
            lines = next;
            if ended || timed_out.timed_out() {
                drop(lines);
                let tail = &records[records.len().saturating_sub(8)..];
                let said = self.errors();
                bail!(
                    "waited for {what}; {} lines came, last {tail:?}; said {said:?}",
                    records.len()
                );
            }
        }
    }

    /// Waits until a simulated device says that it was made to show this.
    pub fn shown(&self, output: &str, value: i64) -> anyhow::Result<()> {
        // The first line of a served device is no record.
        let wanted = format!("\"output\":\"{output}\",\"value\":{value}}}");
        let mut lines = self.out.lock();
        loop {
            if lines.0.iter().any(|line| line.ends_with(&wanted)) {
                return Ok(());
            }
            let waited = self.out.more.wait_timeout(lines, Duration::from_secs(5));
            let (next, timed_out) = waited.unwrap_or_else(PoisonError::into_inner);
            lines = next;
            if timed_out.timed_out() {
                bail!("it was to show {output} {value}, and said {:?}", lines.0);
            }
        }
    }

    /// What was said on standard error so far.
    pub fn errors(&self) -> Vec<String> {
        self.err.lock().0.clone()
    }

    /// Its peak of memory so far, KiB.
    pub fn peak_kib(&self) -> Option<u64> {
        let status = std::fs::read_to_string(format!("/proc/{}/status", self.child.id())).ok()?;
        let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
        line.split_whitespace().nth(1)?.parse().ok()
    }

    /// Whether it still runs.
    pub fn runs(&mut self) -> bool {
        matches!(self.child.try_wait(), Ok(None))
    }

    /// Waits for its end by itself.
    pub fn ended(&mut self, watch: &Watch, limit: Duration) -> anyhow::Result<ExitStatus> {
        let until_us = watch.now_us() + limit.as_micros() as u64;
        loop {
            if let Some(status) = self.child.try_wait()? {
                return Ok(status);
            }
            if watch.now_us() > until_us {
                bail!("it still runs; said {:?}", self.errors());
            }
            watch.pause(Duration::from_millis(20));
        }
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        // One that has ended already cannot be ended.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
