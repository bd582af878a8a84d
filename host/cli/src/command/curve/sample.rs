//! `dialrig curve sample`: points along a curve.

use serde::Serialize;

use super::CurveArgs;
use super::kind::{AnyCurve, Point, Use, with_curve};
use super::points::Points;
use crate::console::Console;
use crate::failure::{Exit, Failure};
use crate::interrupt::Interrupt;
use crate::number;

const EXAMPLES: &str = "\
Examples:
  dialrig curve sample points.csv --count 50 > curve.csv
  dialrig curve sample points.csv --order 4 --at 0,0.5,1 --derivatives 1 --json";

/// Points along the curve
///
/// CSV or, with `--json`, lines `{"u":…,"point":[…],"derivatives":[[…]]}`.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct Args {
    #[command(flatten)]
    curve: CurveArgs,
    /// This many points, evenly spaced in the parameter, ends included
    #[arg(long, value_name = "N", default_value_t = 11, value_parser = clap::value_parser!(u32).range(2..=10_000_000))]
    count: u32,
    /// Points at these parameters instead; those outside the curve mean its ends
    #[arg(long, value_name = "U,U…", value_delimiter = ',', value_parser = number::finite, conflicts_with = "count", allow_hyphen_values = true)]
    at: Vec<f64>,
    /// Derivatives by the parameter, up to this order
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u8).range(0..=3))]
    derivatives: u8,
}

/// One sample. `derivatives`: first order first.
#[derive(Serialize)]
struct Record {
    u: f64,
    point: Vec<f64>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    derivatives: Vec<Vec<f64>>,
}

pub(super) fn run(args: &Args, console: &Console) -> Result<Exit, Failure> {
    with_curve(&args.curve, console, &Sample { args, console })
}

struct Sample<'c> {
    args: &'c Args,
    console: &'c Console,
}

impl Use for Sample<'_> {
    fn curve<P: Point>(&self, curve: &AnyCurve<P>, points: &Points) -> Result<Exit, Failure> {
        let interrupt = Interrupt::listen();
        if !self.console.json() {
            self.heading(points)?;
        }
        let domain = curve.domain();
        let steps = self.args.count - 1;
        let even = (0..=steps).map(|index| match index {
            // Met exactly, whatever the rounding.
            index if index == steps => domain.end,
            index => domain.start + domain.length() * f64::from(index) / f64::from(steps),
        });
        let at: Box<dyn Iterator<Item = f64>> = if self.args.at.is_empty() {
            Box::new(even)
        } else {
            Box::new(self.args.at.iter().copied())
        };
        for u in at {
            if interrupt.came() {
                return Err(Failure::interrupted());
            }
            self.one(curve, domain.clamp(u))?;
        }
        Ok(Exit::Done)
    }
}

impl Sample<'_> {
    fn one<P: Point>(&self, curve: &AnyCurve<P>, u: f64) -> Result<(), Failure> {
        let derivatives = (1..=self.args.derivatives).map(|order| curve.derivative(u, order));
        let record = Record {
            u,
            point: curve.derivative(u, 0),
            derivatives: derivatives.collect(),
        };
        if self.console.json() {
            return self.console.record(&record);
        }
        let cells = [&[u], record.point.as_slice()].concat().into_iter();
        let cells: Vec<String> = cells
            .chain(record.derivatives.into_iter().flatten())
            .map(|x| x.to_string())
            .collect();
        self.console.line(cells.join(","))
    }

    /// `u,x,y,d1x,d1y,…`.
    fn heading(&self, points: &Points) -> Result<(), Failure> {
        let dimension = points.rows.first().map_or(0, Vec::len);
        let axes = ["x", "y", "z"].into_iter().take(dimension);
        let mut names = vec!["u".to_owned()];
        names.extend(axes.clone().map(str::to_owned));
        for order in 1..=self.args.derivatives {
            names.extend(axes.clone().map(|axis| format!("d{order}{axis}")));
        }
        self.console.line(names.join(","))
    }
}
