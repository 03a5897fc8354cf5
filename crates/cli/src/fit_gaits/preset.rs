//! `--preset huang-2012`: the published table, fitted anew and compared with what is printed.

use anyhow::bail;
use muybridge_core::{DATABASE_SCHEMA, Database, Gait};
use muybridge_fitting::gait_laws::{Evidence, GaitLaw, gait_laws};
use muybridge_fitting::published::clips;

use super::Outcome;

/// Largest difference of `b`; five printed decimals are half a unit of the last apart.
const B_TOLERANCE: f64 = 5e-6;
/// Largest relative difference of `a`: the printed ones are 3e-5 to 5.1e-5 high at exactly 0.44704 m/s per mph.
const A_TOLERANCE: f64 = 1e-4;
/// Largest difference of the amble's parameters, which rest on the walk's.
const AMBLE_TOLERANCE: f64 = 1e-3;

/// The laws of the published gaits, or of those asked for.
pub(super) fn outcome(only: &[String]) -> anyhow::Result<Outcome> {
    let mut laws = gait_laws(&Evidence::default());
    let mut wanted = Vec::new();
    for name in only {
        match Gait::from_name(name).filter(|gait| laws.iter().any(|law| law.law.gait == *gait)) {
            Some(gait) => wanted.push(gait),
            None => bail!("--only {name}: the published table has no such gait"),
        }
    }
    laws.retain(|law| wanted.is_empty() || wanted.contains(&law.law.gait));
    let database = Database {
        schema: DATABASE_SCHEMA,
        generator: "fit-gaits --preset huang-2012".into(),
        laws: laws.iter().map(|law| law.law.clone()).collect(),
        strides: Vec::new(),
    };
    Ok(Outcome { fits: Vec::new(), laws, database, failures: Vec::new() })
}

/// Where the fitted parameters differ from the printed ones.
pub(super) fn differences(laws: &[GaitLaw]) -> Vec<String> {
    let clips = clips();
    laws.iter()
        .filter_map(|law| {
            let printed = clips.iter().find(|clip| clip.gait == law.law.gait)?.printed;
            let (a, b) = (law.law.curve.a / printed.a - 1.0, law.law.curve.b - printed.b);
            let (limit_a, limit_b) = match law.law.gait {
                Gait::Amble => (AMBLE_TOLERANCE, AMBLE_TOLERANCE),
                _ => (A_TOLERANCE, B_TOLERANCE),
            };
            let differs = a.abs() > limit_a || b.abs() > limit_b;
            differs.then(|| format!("{}: a off by {a:.1e} of itself, b by {b:.1e}", law.law.gait))
        })
        .collect()
}
