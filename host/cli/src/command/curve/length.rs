//! `dialrig curve length`: how long a curve is.

use motion::Interval;
use serde::Serialize;

use super::CurveArgs;
use super::kind::{AnyCurve, Point, Use, with_curve};
use super::points::Points;
use crate::console::Console;
use crate::failure::{Exit, Failure};
use crate::number;

const EXAMPLES: &str = "\
Examples:
  dialrig curve length points.csv
  dialrig curve length points.csv --order 4 --from 0.5 --to 1.5 --json";

/// How long the curve is
///
/// By Gauss-Legendre quadrature between its knots, good to eleven digits.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct Args {
    #[command(flatten)]
    curve: CurveArgs,
    /// From this parameter on; from the curve's beginning if not given
    #[arg(long, value_name = "U", value_parser = number::finite, allow_hyphen_values = true)]
    from: Option<f64>,
    /// Up to this parameter; to the curve's end if not given
    #[arg(long, value_name = "U", value_parser = number::finite, allow_hyphen_values = true)]
    to: Option<f64>,
}

/// A length, and over which parameters.
#[derive(Serialize)]
struct Record {
    from: f64,
    to: f64,
    length: f64,
}

pub(super) fn run(args: &Args, console: &Console) -> Result<Exit, Failure> {
    with_curve(&args.curve, console, &Length { args, console })
}

struct Length<'c> {
    args: &'c Args,
    console: &'c Console,
}

impl Use for Length<'_> {
    fn curve<P: Point>(&self, curve: &AnyCurve<P>, _points: &Points) -> Result<Exit, Failure> {
        let domain = curve.domain();
        let over = Interval {
            start: self.args.from.map_or(domain.start, |u| domain.clamp(u)),
            end: self.args.to.map_or(domain.end, |u| domain.clamp(u)),
        };
        let length = curve.length(over);
        if self.console.json() {
            self.console.record(&Record {
                from: over.start,
                to: over.end,
                length,
            })?;
        } else {
            // As many digits as the quadrature is good for.
            self.console.line(number::significant(length, 11))?;
        }
        Ok(Exit::Done)
    }
}
