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

    /// Waits until `holds` of all lines so far: nothing then, or why it never will or did not in time.
    fn wait(
        &self,
        watch: &Watch,
        limit: Duration,
        mut holds: impl FnMut(&[String]) -> bool,
    ) -> Option<&'static str> {
        let until_us = watch.now_us() + limit.as_micros() as u64;
        let mut lines = self.lock();
        loop {
            if holds(&lines.0) {
                return None;
            }
            if lines.1 {
                return Some("it has ended");
            }
            let left_us = until_us.saturating_sub(watch.now_us());
            if left_us == 0 {
                return Some("the time is over");
            }
            let waited = self.more.wait_timeout(lines, Duration::from_micros(left_us));
            lines = waited.unwrap_or_else(PoisonError::into_inner).0;
        }
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
    watch: Watch,
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
        let watch = Watch::start();
        Ok(Self {
            child,
            out,
            err,
            watch,
        })
    }

    /// Waits until a predicate holds of all JSON lines so far, which it gets; their final state, or what there was. The
    /// limit is that of the whole wait, however many lines come meanwhile.
    pub fn until(
        &self,
        limit: Duration,
        what: &str,
        mut holds: impl FnMut(&[Value]) -> bool,
    ) -> anyhow::Result<Vec<Value>> {
        let mut records: Vec<Value> = Vec::new();
        let mut fresh = true;
        let ended = self.out.wait(&self.watch, limit, |lines| {
            for line in lines.get(records.len()..).unwrap_or_default() {
                // What is no record is told as it stands.
                records.push(serde_json::from_str(line).unwrap_or_else(|_| Value::String(line.clone())));
                fresh = true;
            }
            std::mem::take(&mut fresh) && holds(&records)
        });
        if let Some(why) = ended {
            let tail = &records[records.len().saturating_sub(8)..];
            let said = self.errors();
            bail!(
                "waited for {what}: {why}; {} lines came, last {tail:?}; said {said:?}",
                records.len()
            );
        }
        if let Some(stray) = records.iter().find(|record| !record.is_object()) {
            bail!("not a record: {stray}");
        }
        Ok(records)
    }

    /// Waits until something is said on standard error.
    pub fn says(&self, what: &str, limit: Duration) -> anyhow::Result<()> {
        let there = |lines: &[String]| lines.iter().any(|line| line.contains(what));
        match self.err.wait(&self.watch, limit, there) {
            None => Ok(()),
            Some(why) => bail!("waited for \"{what}\": {why}; said {:?}", self.errors()),
        }
    }

    /// All records, once it has ended by itself and every line of it is here.
    pub fn all(&self, limit: Duration) -> anyhow::Result<Vec<Value>> {
        let limit_us = self.watch.now_us() + limit.as_micros() as u64;
        while !(self.out.lock().1 && self.err.lock().1) {
            if self.watch.now_us() > limit_us {
                bail!("it still runs; said {:?}", self.errors());
            }
            self.watch.pause(Duration::from_millis(5));
        }
        self.until(Duration::ZERO, "nothing", |_| true)
    }

    /// Waits until a simulated device says that it was made to show this.
    pub fn shown(&self, output: &str, value: i64, limit: Duration) -> anyhow::Result<()> {
        // The first line of a served device is no record.
        let wanted = format!("\"output\":\"{output}\",\"value\":{value}}}");
        let there = |lines: &[String]| lines.iter().any(|line| line.ends_with(&wanted));
        match self.out.wait(&self.watch, limit, there) {
            None => Ok(()),
            Some(why) => bail!(
                "it was to show {output} {value}: {why}; it said {:?}",
                self.out.lock().0
            ),
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

    /// Asks it to end, as Ctrl-C does.
    pub fn interrupt(&self) -> anyhow::Result<()> {
        let process = self.child.id().to_string();
        let asked = Command::new("kill").args(["-INT", &process]).status()?;
        anyhow::ensure!(asked.success(), "kill -INT {process}: {asked}");
        Ok(())
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
