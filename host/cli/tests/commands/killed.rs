//! `dialrig play` is killed, or its cable pulled: the servos end as the puppet's policy says, whenever it was.
//!
//! Two simulated servos behind a pseudo-terminal, served by a process of its own, and a player killed with SIGKILL at
//! a moment from a seed. `DIALRIG_SEED=n DIALRIG_KILLS=m` takes others.

use std::fs;
use std::io::{BufRead, BufReader};
use std::path::PathBuf;
use std::process::{Child, Stdio};
use std::time::Duration;

use crate::dialrig;

/// Kills for each policy in the suite; a night takes more.
const KILLS: u64 = 2;
/// A killed player may have been just about to arm, arming, approaching, or playing for a while.
const MOMENT_MAX_MS: u64 = 5000;
/// The servos' watchdogs wait 200 ms; shafts stand soon after.
const STANDING: Duration = Duration::from_millis(900);
/// So often it is asked whether a guard has done its work: finding that all is over, opening the line, asking everybody.
const ASKED_MAX: u32 = 40;

const SHOW: &str = "version = 1\nname = \"Nod\"\nclips = [\"nod\"]\nclip = \"nod\"\npuppet = \"PUPPET\"\n";
const CLIP: &str = "version = 1\nof = \"joints\"\n\
    [[key]]\nsecs = 0.0\n[key.joints]\npan = -50.0\ntilt = -20.0\n\
    [[key]]\nsecs = 0.7\n[key.joints]\npan = 50.0\ntilt = 25.0\n\
    [[key]]\nsecs = 1.4\n[key.joints]\npan = -50.0\ntilt = -20.0\n";

/// A bus of simulated servos, a puppet on it, and a show for it, in a folder.
struct Stage {
    folder: tempfile::TempDir,
    bus: Child,
}

fn setting(name: &str, usual: u64) -> u64 {
    let text = std::env::var(name).ok();
    text.and_then(|text| text.parse().ok()).unwrap_or(usual)
}

/// A number from a seed (splitmix64).
fn number(seed: u64) -> u64 {
    let mut z = seed.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

impl Stage {
    fn new(on_lost_host: &str) -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let put = |path: &str, text: &str| {
            let path = folder.path().join(path);
            fs::create_dir_all(path.parent().expect("inside")).expect("a folder");
            fs::write(path, text).expect("written");
        };
        let starter = include_str!("../../../../device-profiles/puppets/starter.toml");
        let wanted = format!("on_lost_host = \"{on_lost_host}\"");
        let puppet = starter.replace("on_lost_host = \"hold\"", &wanted);
        assert!(puppet.contains(&wanted));
        put("config/dialrig/profiles/nodder.toml", &puppet);
        put("show/show.toml", &SHOW.replace("PUPPET", "nodder"));
        put("show/clips/nod.toml", CLIP);
        let port = folder.path().join("bus");
        let mut bus = dialrig(&format!(
            "sim servo-bus --servo XL330-M288:1-2 --pty {}",
            port.display()
        ))
        .spawn()
        .expect("starts");
        let mut ready = String::new();
        BufReader::new(bus.stdout.take().expect("piped"))
            .read_line(&mut ready)
            .expect("a line");
        assert!(ready.starts_with("ready "), "{ready}");
        Self { folder, bus }
    }

    fn port(&self) -> PathBuf {
        self.folder.path().join("bus")
    }

    fn play(&self) -> Child {
        let show = self.folder.path().join("show");
        let mut play = dialrig(&format!(
            "play {} --port {} --loop --rate 50",
            show.display(),
            self.port().display()
        ));
        play.env("XDG_CONFIG_HOME", self.folder.path().join("config"));
        play.stderr(Stdio::piped()).stdin(Stdio::null());
        play.spawn().expect("starts")
    }

    /// A register of a servo; the line may still be somebody's for a moment.
    fn read(&self, id: u8, register: &str) -> i64 {
        let mut said = String::new();
        for _ in 0..50 {
            let mut read = dialrig(&format!(
                "servo read --port {} --json {id}",
                self.port().display()
            ));
            let output = read.arg(register).output().expect("runs");
            said = format!("{output:?}");
            let text = String::from_utf8_lossy(&output.stdout).into_owned();
            let raw = text.split("\"raw\":").nth(1);
            let raw = raw.and_then(|rest| rest.split([',', '}']).next()?.trim().parse().ok());
            if let Some(raw) = raw {
                return raw;
            }
            std::thread::park_timeout(Duration::from_millis(100));
        }
        panic!("{register} of servo {id}: {said}");
    }

    fn torque(&self) -> [bool; 2] {
        [1, 2].map(|id| self.read(id, "Torque Enable") != 0)
    }

    /// All shafts stand, each where its goal is if it has torque.
    fn check_standing(&self, what: &str) {
        for id in [1, 2] {
            let before = self.read(id, "Present Position");
            std::thread::park_timeout(Duration::from_millis(150));
            let after = self.read(id, "Present Position");
            assert!(
                (before - after).abs() <= 1,
                "{what}: servo {id} turns: {before}, {after}"
            );
            if self.read(id, "Torque Enable") != 0 {
                let goal = self.read(id, "Goal Position");
                assert!(
                    (goal - after).abs() <= 12,
                    "{what}: servo {id} at {after}, its goal {goal}"
                );
            }
        }
    }
}

impl Drop for Stage {
    fn drop(&mut self) {
        let _ = self.bus.kill();
        let _ = self.bus.wait();
    }
}

fn kill(mut child: Child) {
    child.kill().expect("it runs");
    child.wait().expect("it has run");
}

/// Kills as many players as wanted; says how many were, and how often torque was on soon after.
fn killed(on_lost_host: &str, end: fn(&Stage, &str)) {
    let stage = Stage::new(on_lost_host);
    let first = setting("DIALRIG_SEED", 1);
    let (kills, mut with_torque) = (setting("DIALRIG_KILLS", KILLS), 0);
    for seed in first..first + kills {
        // Torque that the last one left tells nothing of this one.
        let _ = dialrig(&format!("servo release --port {}", stage.port().display())).output();
        let play = stage.play();
        let moment_ms = number(seed) % MOMENT_MAX_MS;
        std::thread::park_timeout(Duration::from_millis(moment_ms));
        kill(play);
        let what = format!("{on_lost_host}, DIALRIG_SEED={seed}, killed after {moment_ms} ms");
        std::thread::park_timeout(STANDING);
        with_torque += u64::from(stage.torque().contains(&true));
        end(&stage, &what);
        stage.check_standing(&what);
    }
    eprintln!("{on_lost_host}: {kills} kills, torque on 0.9 s after {with_torque}");
}

#[test]
fn servos_of_a_killed_player_hold_where_the_policy_is_to_hold() {
    killed("hold", |_, _| {});
}

#[test]
fn servos_of_a_killed_player_are_let_go_where_the_policy_is_to_release() {
    killed("release", |stage, what| {
        let off = (0..ASKED_MAX).any(|_| stage.torque() == [false; 2]);
        assert!(off, "{what}: still held");
    });
}

#[test]
fn a_line_that_is_lost_while_playing_is_exit_4() {
    let mut stage = Stage::new("hold");
    let play = stage.play();
    std::thread::park_timeout(Duration::from_secs(5));
    stage.bus.kill().expect("it runs");
    let output = play.wait_with_output().expect("it ends");
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(4), "{said}");
}
