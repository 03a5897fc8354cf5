//! All changes in a table, beside the plain cross-fade.

use std::collections::BTreeMap;
use std::fmt::{Display, Formatter, Result as FormatResult};
use std::sync::Arc;

use muybridge_core::{Gait, Repertoire, Stride};

use super::super::cross_fade::{CrossFade, FadeCase};
use super::super::findings::Quantity;
use super::measure::{ChangeCase, measure};
use super::steady_gait::SteadyGait;
use super::{Accelerations, GAITS, STEP_S, pairs};

/// Time that a stride is played for its acceleration, s.
const PLAYED_S: f64 = 4.0;

/// All start phases of one pair.
#[derive(Clone, Debug)]
pub struct PairRow {
    /// From which gait to which.
    pub pair: [Gait; 2],
    /// Our changes.
    pub ours: Vec<ChangeCase>,
    /// Cross-fades from the same phases over the same times, with their acceleration against the larger of the two steady gaits.
    pub fades: Vec<(FadeCase, f64)>,
    /// Changes that did not come to an end.
    pub faults: Vec<String>,
}

/// Mean and greatest of a number over the start phases.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Spread {
    mean: f64,
    worst: f64,
}

impl Spread {
    fn of(values: impl Iterator<Item = f64>) -> Self {
        let (mut sum, mut n, mut worst) = (0.0, 0usize, 0.0f64);
        for value in values {
            sum += value;
            n += 1;
            worst = worst.max(value);
        }
        Self { mean: if n > 0 { sum / n as f64 } else { f64::NAN }, worst }
    }
}

/// Acceleration of joints of a stride that is played as the cross-fade plays it, rad/s^2.
fn played_p99(stride: &Stride) -> f64 {
    let mut accelerations = Accelerations::default();
    for step in 0..(PLAYED_S / f64::from(STEP_S)) as usize {
        let phase = step as f64 * f64::from(STEP_S) / f64::from(stride.stride_time_s);
        accelerations.take(&stride.pose(phase.rem_euclid(1.0) as f32).bends_rad);
    }
    accelerations.p99()
}

/// Every pair of gaits.
#[derive(Clone, Debug, Default)]
pub struct ChangeTable {
    /// One row each.
    pub rows: Vec<PairRow>,
    /// Gaits that never became steady.
    pub faults: Vec<String>,
}

impl PairRow {
    /// Measures one pair from so many start phases.
    pub fn measure(from: &SteadyGait, to: &SteadyGait, phases: usize) -> Self {
        let mut row =
            Self { pair: [from.gait, to.gait], ours: Vec::new(), fades: Vec::new(), faults: Vec::new() };
        let steady_p99 = played_p99(&from.stride).max(played_p99(&to.stride));
        for k in 0..phases {
            let start_phase = k as f64 / phases as f64;
            match measure(from, to, start_phase) {
                Ok(case) => {
                    let duration_s = case.duration_s;
                    let fade = CrossFade { from: &from.stride, to: &to.stride, start_phase, duration_s };
                    let faded = fade.measure(from.horse.skeleton());
                    row.fades.push((faded, faded.acceleration_p99 / steady_p99));
                    row.ours.push(case);
                }
                Err(fault) => row.faults.push(fault),
            }
        }
        row
    }

    /// What is wrong with it: each kind once, with how often and the worst.
    pub fn all_faults(&self) -> Vec<String> {
        let [from, to] = self.pair;
        let mut kinds: BTreeMap<&str, (usize, f64, String)> = BTreeMap::new();
        for case in &self.ours {
            for fault in case.faults() {
                let (count, worst, text) = kinds.entry(fault.kind).or_default();
                *count += 1;
                if fault.size > *worst {
                    (*worst, *text) =
                        (fault.size, format!("from phase {:.3}: {}", case.start_phase, fault.text));
                }
            }
        }
        let n = self.ours.len();
        let told =
            kinds.into_values().map(|(count, _, text)| format!("{from} to {to}, {count} of {n}, {text}"));
        told.chain(self.faults.iter().cloned()).collect()
    }
}

impl ChangeTable {
    /// Measures all 30 pairs from so many start phases.
    pub fn measure(repertoire: &Arc<Repertoire>, phases: usize) -> Self {
        let (mut gaits, mut faults) = (Vec::new(), Vec::new());
        for gait in GAITS {
            match SteadyGait::ride(repertoire, gait) {
                Ok(steady) => gaits.push(steady),
                Err(fault) => faults.push(format!("{gait}: {fault}")),
            }
        }
        let of = |gait: Gait| gaits.iter().find(|steady| steady.gait == gait);
        let rows =
            pairs().filter_map(|[from, to]| Some(PairRow::measure(of(from)?, of(to)?, phases))).collect();
        Self { rows, faults }
    }

    /// Everything that is wrong.
    pub fn all_faults(&self) -> Vec<String> {
        let rows = self.rows.iter().flat_map(PairRow::all_faults);
        self.faults.iter().cloned().chain(rows).collect()
    }
}

/// The numbers of a line.
fn line(f: &mut Formatter<'_>, name: &str, ours: &[&ChangeCase], fades: &[&(FadeCase, f64)]) -> FormatResult {
    let strides = Spread::of(ours.iter().map(|case| case.strides));
    let least = ours.iter().map(|case| case.strides).fold(f64::INFINITY, f64::min);
    let convergence = Spread::of(ours.iter().map(|case| case.convergence));
    let slide = Spread::of(ours.iter().map(|case| 1e3 * case.worst(Quantity::StanceSlide)));
    let acceleration = Spread::of(ours.iter().map(|case| case.acceleration_ratio));
    let faded_slide = Spread::of(fades.iter().map(|fade| 1e3 * fade.0.slide_m));
    let faded_acceleration = Spread::of(fades.iter().map(|fade| fade.1));
    let torn = Spread::of(fades.iter().map(|fade| 100.0 * fade.0.torn));
    writeln!(
        f,
        "{name:<18}{least:5.2}-{:4.2}{:9.1e}{:8.3}{:7.3}{:7.2}{:6.2} |{:8.0}{:6.0}{:7.2}{:6.2}{:6.0}{:5.0}",
        strides.worst,
        convergence.worst,
        slide.mean,
        slide.worst,
        acceleration.mean,
        acceleration.worst,
        faded_slide.mean,
        faded_slide.worst,
        faded_acceleration.mean,
        faded_acceleration.worst,
        torn.mean,
        torn.worst
    )
}

impl Display for ChangeTable {
    fn fmt(&self, f: &mut Formatter<'_>) -> FormatResult {
        writeln!(f, "                  ours                                        | cross-fade")?;
        writeln!(
            f,
            "                              leg     slide mm        accel.  | slide mm       accel.    leg torn %"
        )?;
        writeln!(
            f,
            "from to            strides    apart    mean  worst   mean worst|    mean worst   mean worst mean worst"
        )?;
        for row in &self.rows {
            let name = format!("{:<7} {:<7}", row.pair[0], row.pair[1]);
            line(f, &name, &row.ours.iter().collect::<Vec<_>>(), &row.fades.iter().collect::<Vec<_>>())?;
        }
        let ours: Vec<&ChangeCase> = self.rows.iter().flat_map(|row| &row.ours).collect();
        let fades: Vec<&(FadeCase, f64)> = self.rows.iter().flat_map(|row| &row.fades).collect();
        line(f, "all", &ours, &fades)?;
        let unfinished = self.rows.iter().map(|row| row.faults.len()).sum::<usize>();
        writeln!(
            f,
            "ours: {} changes, {unfinished} without end, mean slide {:.4} mm, worst joint acceleration {:.2} x steady, legs within {:.1e} of a stride",
            ours.len(),
            1e3 * Spread::of(ours.iter().map(|case| case.worst(Quantity::StanceSlide))).mean,
            Spread::of(ours.iter().map(|case| case.acceleration_ratio)).worst,
            Spread::of(ours.iter().map(|case| case.convergence)).worst
        )?;
        writeln!(
            f,
            "cross-fade: mean slide {:.0} mm, worst joint acceleration {:.2} x steady, a leg in neither gait for {:.0} % of its time",
            1e3 * Spread::of(fades.iter().map(|fade| fade.0.slide_m)).mean,
            Spread::of(fades.iter().map(|fade| fade.1)).worst,
            100.0 * Spread::of(fades.iter().map(|fade| fade.0.torn)).mean
        )
    }
}
