//! `dialrig curve fit`: knots, parameters and coefficients.

use serde::Serialize;

use super::CurveArgs;
use super::kind::{AnyCurve, Point, Use, with_curve};
use super::points::Points;
use crate::console::Console;
use crate::failure::{Exit, Failure};
use crate::number::short;

const EXAMPLES: &str = "\
Examples:
  dialrig curve fit points.csv
  printf '[[0,0],[1,2],[3,1]]' | dialrig curve fit - --order 3 --json";

/// Knots, parameters and coefficients
///
/// For the curve through the points: the parameter of every point, and which points were kept (near-equal neighbours
/// are merged). For a B-spline: the order in use and the Greville abscissae.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct Args {
    #[command(flatten)]
    curve: CurveArgs,
}

/// A curve; `curve sample` reads `points` and `order` back.
#[derive(Serialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
enum Record<'a> {
    Natural {
        points: &'a [Vec<f64>],
        kept: &'a [usize],
        params: &'a [f64],
        knots: Vec<f64>,
        coefficients: Vec<Vec<f64>>,
    },
    BSpline {
        points: &'a [Vec<f64>],
        order: usize,
        order_in_use: usize,
        knots: &'a [f64],
        greville: Vec<f64>,
    },
}

pub(super) fn run(args: &Args, console: &Console) -> Result<Exit, Failure> {
    with_curve(&args.curve, console, &Fit { console })
}

struct Fit<'c> {
    console: &'c Console,
}

impl Use for Fit<'_> {
    fn curve<P: Point>(&self, curve: &AnyCurve<P>, points: &Points) -> Result<Exit, Failure> {
        let record = match curve {
            AnyCurve::Natural(curve) => Record::Natural {
                points: &points.rows,
                kept: curve.kept(),
                params: curve.params(),
                knots: curve.knots(),
                coefficients: curve.coefficients().into_iter().map(Point::coordinates).collect(),
            },
            AnyCurve::BSpline(curve) => Record::BSpline {
                points: &points.rows,
                order: curve.requested_order(),
                order_in_use: curve.order(),
                knots: curve.knots(),
                greville: curve.greville(),
            },
        };
        if self.console.json() {
            self.console.record(&record)?;
        } else {
            self.show(&record)?;
        }
        Ok(Exit::Done)
    }
}

impl Fit<'_> {
    fn show(&self, record: &Record<'_>) -> Result<(), Failure> {
        match record {
            Record::Natural {
                points,
                kept,
                params,
                knots,
                coefficients,
            } => {
                let merged = points.len() - kept.len();
                self.console.line(format_args!(
                    "natural cubic through {} points, {merged} merged",
                    kept.len()
                ))?;
                self.numbers("params", params)?;
                self.numbers("knots", knots)?;
                self.console.line("coefficients")?;
                coefficients.iter().try_for_each(|point| self.numbers("", point))
            }
            Record::BSpline {
                points,
                order,
                order_in_use,
                knots,
                greville,
            } => {
                self.console.line(format_args!(
                    "B-spline of order {order_in_use} ({order} asked for) with {} control points",
                    points.len()
                ))?;
                self.numbers("knots", knots)?;
                self.numbers("greville", greville)
            }
        }
    }

    fn numbers(&self, name: &str, numbers: &[f64]) -> Result<(), Failure> {
        let numbers: Vec<String> = numbers.iter().map(|&x| short(x)).collect();
        self.console.line(format_args!("{name:<8} {}", numbers.join(" ")))
    }
}
