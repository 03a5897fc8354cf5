//! What there is to say about a solved track, as a table and as JSON.

use std::io::Write;

use glam::DVec2;
use muybridge_footprints::{CURVE_SAMPLES, Solved, Support};
use serde::Serialize;

use super::walk::Walk;

/// Schema version of the JSON document.
const SUMMARY_SCHEMA: u32 = 1;
/// A flight's curve is looked at in so many places.
const PLACES: u32 = 4 * CURVE_SAMPLES as u32;
/// So many remarks are printed; the others are counted.
const MOST_REMARKS: usize = 20;

/// The numbers of a motion.
#[derive(Debug, Serialize)]
pub(super) struct Summary {
    schema: u32,
    name: String,
    model: String,
    prints: usize,
    steps: usize,
    duration_s: f64,
    #[serde(flatten)]
    solved: Compared,
    weights: Weights,
    flights: Vec<Flight>,
    remarks: Vec<String>,
    /// The same track by both methods, where that is asked for.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) compared: Vec<Compared>,
}

/// What one method found.
#[derive(Debug, Serialize)]
pub(super) struct Compared {
    method: &'static str,
    energy: Parts,
    /// Accepted steps of the gradient, or sweeps of the greedy search.
    iterations: usize,
    converged: bool,
}

/// An energy, m/s.
#[derive(Clone, Copy, Debug, Serialize)]
struct Parts {
    total: f64,
    physics: f64,
    comfort: f64,
}

#[derive(Debug, Serialize)]
struct Weights {
    physics: f64,
    comfort_per_s2: f64,
}

/// A time without any foot on the ground.
#[derive(Debug, Serialize)]
struct Flight {
    from_s: f64,
    to_s: f64,
    /// Highest place of the centre of mass over the ground, and over where it took off, metres.
    apex_m: f64,
    rise_m: f64,
    /// How far it went in the plan, metres.
    length_m: f64,
}

/// To five decimals.
pub(super) fn rounded(number: f64) -> f64 {
    // Adding zero makes a negative zero a positive one.
    (number * 1e5).round() / 1e5 + 0.0
}

impl Compared {
    pub(super) fn of(method: &'static str, solved: &Solved) -> Self {
        let energy = Parts {
            total: rounded(solved.energy.total()),
            physics: rounded(solved.energy.physics),
            comfort: rounded(solved.energy.comfort),
        };
        Self { method, energy, iterations: solved.steps, converged: solved.converged }
    }

    fn words(&self) -> String {
        let Parts { total, physics, comfort } = self.energy;
        let what = if self.method == "greedy" { "sweeps" } else { "steps" };
        let end = if self.converged { "" } else { ", not converged" };
        format!(
            "{:8}  {total:10.4}  {physics:10.4}  {comfort:10.4}  {:6} {what}{end}",
            self.method, self.iterations
        )
    }
}

impl Summary {
    pub(super) fn of(walk: &Walk, method: &'static str) -> Self {
        let (motion, track) = (&walk.motion, &walk.motion.track);
        let prints = motion.placed.prints.len();
        let remarks = motion.remarks().into_iter().map(|remark| remark.text);
        Self {
            schema: SUMMARY_SCHEMA,
            name: walk.title(),
            model: track.model.clone(),
            prints,
            steps: prints.saturating_sub(1),
            duration_s: rounded(motion.duration_s()),
            solved: Compared::of(method, &motion.solved),
            weights: Weights { physics: track.weights.physics, comfort_per_s2: track.weights.comfort_per_s2 },
            flights: flights(walk),
            remarks: remarks.collect(),
            compared: Vec::new(),
        }
    }

    pub(super) fn write(&self, out: &mut impl Write) -> anyhow::Result<()> {
        writeln!(out, "{} ({})", self.name, self.model)?;
        writeln!(out, "{} prints, {} steps, {:.3} s", self.prints, self.steps, self.duration_s)?;
        let Weights { physics, comfort_per_s2 } = self.weights;
        writeln!(out, "weights: physics {physics}, comfort {comfort_per_s2} /s^2; energies in m/s")?;
        writeln!(out, "method         energy     physics     comfort")?;
        let rows = if self.compared.is_empty() { std::slice::from_ref(&self.solved) } else { &self.compared };
        for row in rows {
            writeln!(out, "{}", row.words())?;
        }
        if let [gradient, greedy] = &self.compared[..] {
            let lower = 100.0 * (1.0 - gradient.energy.total / greedy.energy.total.max(1e-9));
            writeln!(out, "the gradient's is {lower:.1} % lower")?;
        }
        if !self.flights.is_empty() {
            writeln!(out, "flight     from_s      to_s  length_m  apex_m  rise_m")?;
            for (number, flight) in self.flights.iter().enumerate() {
                let Flight { from_s, to_s, apex_m, rise_m, length_m } = flight;
                writeln!(
                    out,
                    "{:6}  {from_s:9.3} {to_s:9.3}  {length_m:8.3}  {apex_m:6.3}  {rise_m:6.3}",
                    number + 1
                )?;
            }
        }
        for remark in self.remarks.iter().take(MOST_REMARKS) {
            writeln!(out, "remark: {remark}")?;
        }
        if self.remarks.len() > MOST_REMARKS {
            writeln!(out, "and {} more remarks", self.remarks.len() - MOST_REMARKS)?;
        }
        Ok(())
    }
}

fn flights(walk: &Walk) -> Vec<Flight> {
    let centre = |time_s: f64| walk.motion.centre_of_mass(time_s).at;
    let flying = walk.motion.placed.supports().into_iter().filter(Support::is_flight);
    flying
        .map(|support| {
            let length_s = support.to_s - support.from_s;
            let places =
                (0..=PLACES).map(|i| centre(support.from_s + length_s * f64::from(i) / f64::from(PLACES)));
            let (start, end) = (centre(support.from_s), centre(support.to_s));
            let highest = places.fold(start, |highest, at| if at.y > highest.y { at } else { highest });
            let ground_m = walk.ground_m(DVec2::new(highest.x, highest.z));
            Flight {
                from_s: rounded(support.from_s),
                to_s: rounded(support.to_s),
                apex_m: rounded(highest.y - ground_m),
                rise_m: rounded(highest.y - start.y),
                length_m: rounded(DVec2::new(end.x - start.x, end.z - start.z).length()),
            }
        })
        .collect()
}
