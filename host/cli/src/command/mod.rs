//! The commands: one a file, each with its `Args` (options, help, example) and a `run`.

mod bench;
mod check;
mod convert;
mod curve;
mod demo;
mod devices;
mod figure;
mod monitor;
mod net;
mod play;
mod sample;
mod servo;
mod sim;
pub(crate) mod studio;

use clap::Subcommand;

use crate::console::Console;
use crate::failure::{Exit, Failure};

/// Everything that can be asked for.
#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// The whole chain without hardware or display, as a film
    Demo(demo::Args),
    /// A show on a servo puppet, without a window
    Play(play::Args),
    /// Where everything is over time, without drawing
    Sample(sample::Args),
    /// Everything that is wrong with files
    Check(check::Args),
    /// One kind of file into another, by their names
    Convert(convert::Args),
    /// A figure's tree, warnings and totals
    Figure(figure::Args),
    /// Curves through and along points
    Curve(curve::Args),
    /// Function networks without devices: run, check, print, draw, look up
    Net(net::Args),
    /// What can be opened, what is known about it, what is missing
    Devices(devices::Args),
    /// What an input device says
    Monitor(monitor::Args),
    /// Servos: who is there, their registers, letting go
    Servo(servo::Args),
    /// Simulated devices for any program
    Sim(sim::Args),
    /// Scenarios on a whole rig
    Bench(bench::Args),
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
            Self::Devices(args) => devices::run(args, console),
            Self::Monitor(args) => monitor::run(args, console),
            Self::Servo(args) => servo::run(args, console),
            Self::Sim(args) => sim::run(args, console),
            Self::Bench(args) => bench::run(args, console),
        }
    }
}
