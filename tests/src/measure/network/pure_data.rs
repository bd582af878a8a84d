//! Pure Data as a peer: a process for every repetition, without window and sound.

use super::patch::Graph;
use super::shape::near;
use anyhow::{Context, bail, ensure};
use std::io::ErrorKind;
use std::path::PathBuf;
use std::process::Command;
use tempfile::TempDir;

/// As rows call it.
pub(super) const NAME: &str = "pd";
const PROGRAM: &str = "pd";

/// An installed Pure Data, and where its patches lie meanwhile.
pub(super) struct PureData {
    version: String,
    folder: TempDir,
}

/// A patch that has been written; it lasts as long as the folder of its [`PureData`].
pub(super) struct Written {
    graph: Graph,
    timings: usize,
    file: PathBuf,
}

impl PureData {
    /// What is installed, if anything is.
    pub(super) fn find() -> anyhow::Result<Option<Self>> {
        let output = match Command::new(PROGRAM).arg("-version").output() {
            Ok(output) => output,
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
            Err(error) => return Err(error).context("asking Pure Data for its version"),
        };
        // Said on standard error, as everything it says without a window.
        let said = String::from_utf8_lossy(&output.stderr);
        Ok(Some(Self {
            version: said.lines().next().unwrap_or("of no known version").to_owned(),
            folder: TempDir::new()?,
        }))
    }

    /// What it says of itself.
    pub(super) fn version(&self) -> &str {
        &self.version
    }

    /// Writes the patch that times so many turns, so many times.
    pub(super) fn written(&self, graph: Graph, turns: usize, timings: usize) -> anyhow::Result<Written> {
        let file = self.folder.path().join(format!("{graph:?}.pd"));
        std::fs::write(&file, graph.patch(turns, timings))?;
        Ok(Written { graph, timings, file })
    }
}

impl Written {
    /// Has the patch check itself and take its times, in seconds.
    pub(super) fn run(&self) -> anyhow::Result<Vec<f64>> {
        let output = Command::new(PROGRAM)
            .args(["-batch", "-nogui", "-noaudio", "-noprefs", "-open"])
            .arg(&self.file)
            .output()?;
        let said = String::from_utf8_lossy(&output.stderr);
        read(&said, self).with_context(|| format!("Pure Data said: {said}"))
    }
}

/// Reads the lines `NAME: NUMBER…` of a patch.
fn read(said: &str, patch: &Written) -> anyhow::Result<Vec<f64>> {
    let mut lines = Vec::new();
    for line in said.lines().filter(|line| !line.trim().is_empty()) {
        let Some((name, rest)) = line.split_once(": ") else {
            bail!("expected a name and numbers, found {line:?}");
        };
        let numbers: Result<Vec<f64>, _> = rest.split_whitespace().map(str::parse).collect();
        lines.push((name, numbers.with_context(|| format!("no numbers: {line:?}"))?));
    }
    for (name, wanted) in patch.graph.ends() {
        let found = lines.iter().find(|(at, _)| *at == name);
        let got = found.map(|(_, numbers)| numbers.as_slice()).unwrap_or_default();
        ensure!(near(got, &wanted), "{name} says {got:?}, expected {wanted:?}");
    }
    let of_clock = lines.iter().filter(|(name, _)| *name == "ms");
    let took_secs: Vec<f64> = of_clock.flat_map(|(_, ms)| ms).map(|ms| ms * 1e-3).collect();
    ensure!(
        took_secs.len() == patch.timings && took_secs.iter().all(|secs| *secs > 0.0),
        "expected {} times, found {took_secs:?}",
        patch.timings
    );
    Ok(took_secs)
}

#[cfg(test)]
mod tests {
    use super::*;

    const GRAPH: Graph = Graph::FanOut(3);

    fn written(timings: usize) -> Written {
        Written {
            graph: GRAPH,
            timings,
            file: PathBuf::new(),
        }
    }

    #[test]
    fn times_are_believed_only_from_a_patch_that_computes() {
        let good = "n2: 1.25\nms: 4\nms: 5\n";
        assert_eq!(read(good, &written(2)).ok(), Some(vec![0.004, 0.005]));
        for bad in [
            "n2: 1.5\nms: 4\nms: 5\n",
            "n2: 1.25\nms: 4\n",
            "n2: 1.25\nms: 4\nms: 0\n",
            "ms: 4\nms: 5\n",
            "error: stack overflow\nn2: 1.25\nms: 4\nms: 5\n",
            "n2: 1.25\nms: 4\nms: soon\n",
            "",
        ] {
            assert!(read(bad, &written(2)).is_err(), "{bad}");
        }
    }
}
