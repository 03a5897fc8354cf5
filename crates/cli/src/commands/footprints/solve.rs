//! `muybridge footprints solve`: the motion over a track, in numbers and as a file.

use std::io::Write as _;
use std::path::PathBuf;

use anyhow::bail;
use clap::{Args, ValueEnum};
use muybridge_capture::{to_stable_json, write_atomically};
use muybridge_footprints::Method;

use super::super::output::print;
use super::solution::{MOST_FRAMES, solution};
use super::summary::{Compared, Summary};
use super::walk::Walk;

/// Arguments of `solve`.
#[derive(Debug, Args)]
pub(in crate::commands) struct SolveArguments {
    /// Track to solve (see docs/footprints/tracks/).
    track: PathBuf,
    /// Write the solution: knots of the curve, and the motion with all joints (JSON).
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// How the curve of the centre of mass is found.
    #[arg(long, value_enum, default_value = "gradient")]
    method: MethodName,
    /// Moments of the motion in the solution, a second.
    #[arg(long, value_name = "HZ", default_value_t = 60.0, value_parser = rate)]
    rate: f64,
    /// Solve with both methods and print both energies.
    #[arg(long)]
    compare: bool,
    /// Print the numbers as one JSON document.
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum MethodName {
    /// By exact derivatives.
    Gradient,
    /// The paper's greedy search at two scales.
    Greedy,
}

impl MethodName {
    fn method(self) -> Method {
        match self {
            Self::Gradient => Method::Gradient,
            Self::Greedy => Method::Greedy,
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Gradient => "gradient",
            Self::Greedy => "greedy",
        }
    }
}

fn rate(text: &str) -> Result<f64, String> {
    let rate: f64 = text.parse().map_err(|_| "not a number".to_string())?;
    if (1.0..=1000.0).contains(&rate) { Ok(rate) } else { Err("between 1 and 1000 moments a second".into()) }
}

impl SolveArguments {
    pub(super) fn run(&self) -> anyhow::Result<()> {
        let walk = Walk::read(&self.track, self.method.method())?;
        let mut summary = Summary::of(&walk, self.method.name());
        if self.compare {
            for method in [MethodName::Gradient, MethodName::Greedy] {
                let solved = if method == self.method {
                    walk.motion.solved.clone()
                } else {
                    Walk::read(&self.track, method.method())?.motion.solved
                };
                summary.compared.push(Compared::of(method.name(), &solved));
            }
        }
        if let Some(path) = &self.out {
            let frames = walk.motion.duration_s() * self.rate;
            if frames > MOST_FRAMES {
                bail!(
                    "{}: {frames:.0} moments are too many for one file ({MOST_FRAMES}); take a lower --rate",
                    path.display()
                );
            }
            write_atomically(
                path,
                to_stable_json(&solution(&walk, self.method.name(), self.rate)).as_bytes(),
            )?;
        }
        print(|out| {
            if self.json {
                out.write_all(to_stable_json(&summary).as_bytes())?;
            } else {
                summary.write(out)?;
                if let Some(path) = &self.out {
                    writeln!(out, "{}", path.display())?;
                }
            }
            Ok(())
        })
    }
}
