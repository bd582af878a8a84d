//! The commands: one a file, each with its `Args` (options, help, example) and a `run`.

mod bench;
mod capture;
mod check;
mod convert;
mod curve;
mod decode;
mod demo;
mod devices;
mod figure;
mod monitor;
mod net;
mod play;
mod profile;
mod record;
mod replay;
mod sample;
mod servo;
mod sim;
pub(crate) mod studio;

use clap::Subcommand;

use crate::console::Console;
use crate::failure::{Exit, Failure};
use crate::guard;

/// Everything that can be asked for.
#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    Demo(demo::Args),
    Play(play::Args),
    Sample(sample::Args),
    Check(check::Args),
    Convert(convert::Args),
    Figure(figure::Args),
    Curve(curve::Args),
    Net(net::Args),
    Decode(decode::Args),
    Devices(devices::Args),
    Monitor(monitor::Args),
    Profile(profile::Args),
    Capture(capture::Args),
    Replay(replay::Args),
    Record(record::Args),
    Servo(servo::Args),
    Sim(sim::Args),
    Bench(bench::Args),
    /// Waits for the program that started it to die, then lets go of its puppet
    #[command(
        hide = true,
        after_help = "Example: `dialrig play` starts it; nobody else has to"
    )]
    Guard,
}

impl Command {
    /// Does what was asked for.
    pub(crate) fn run(&self, console: &Console) -> Result<Exit, Failure> {
        match self {
            Self::Demo(args) => demo::run(args, console),
            Self::Play(args) => play::run(args, console),
            Self::Sample(args) => sample::run(args, console),
            Self::Check(args) => check::run(args, console),
            Self::Convert(args) => convert::run(args, console),
            Self::Figure(args) => figure::run(args, console),
            Self::Curve(args) => curve::run(args, console),
            Self::Net(args) => net::run(args, console),
            Self::Decode(args) => decode::run(args, console),
            Self::Devices(args) => devices::run(args, console),
            Self::Monitor(args) => monitor::run(args, console),
            Self::Profile(args) => profile::run(args, console),
            Self::Capture(args) => capture::run(args, console),
            Self::Replay(args) => replay::run(args, console),
            Self::Record(args) => record::run(args, console),
            Self::Servo(args) => servo::run(args, console),
            Self::Sim(args) => sim::run(args, console),
            Self::Bench(args) => bench::run(args, console),
            Self::Guard => Ok(guard::run()),
        }
    }
}
