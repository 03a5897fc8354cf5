//! A stride problem in a form that other solvers can read.
//!
//! ```text
//! L = g exp(Ml x) + Sl x                 length of each term
//! T = Mt x + t0                          direction of each term
//! r = robust(Ac (L cos T) + As (L sin T) + A0 x + b)
//! ```
//!
//! All products but those with matrices are elementwise. A term is a vector of the sagittal plane: one per bone and
//! panel, and per panel the scapula's attachment, the two scapula slides (the only lengths that are unknowns
//! themselves, in `Sl`), and the dock. `robust` is `sign(r) c sqrt(ln(1 + (r/c)^2))` where the mask says so, else `r`.

use muybridge_core::{BONE_COUNT, Limb, bone};
use serde::Serialize;

use crate::chain::Attachment;
use crate::layout::{BENDS, LOG_DOCK, LOG_SCALE, PITCH, ROOT_X, ROOT_Y, SLIDES, log_length};
use crate::levenberg::LeastSquares;
use crate::problem::StrideProblem;

/// Terms of one panel: bones, attachment of the scapulae, their two slides, dock.
const PANEL_TERMS: usize = BONE_COUNT + 4;
const ATTACHMENT: usize = BONE_COUNT;
const SLIDE: usize = BONE_COUNT + 1;
const DOCK: usize = BONE_COUNT + 3;

/// Sparse matrix as triplets; entries of the same place add up.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Triplets {
    /// Row of each entry.
    pub rows: Vec<usize>,
    /// Column of each entry.
    pub columns: Vec<usize>,
    /// Value of each entry.
    pub values: Vec<f64>,
}

impl Triplets {
    fn push(&mut self, row: usize, column: usize, value: f64) {
        self.rows.push(row);
        self.columns.push(column);
        self.values.push(value);
    }

    /// Adds the product with a vector to `sum`.
    fn multiply_into(&self, x: &[f64], sum: &mut [f64]) {
        for ((row, column), value) in self.rows.iter().zip(&self.columns).zip(&self.values) {
            sum[*row] += value * x[*column];
        }
    }
}

/// A stride problem in the module's form, with a start and the optimum to compare with.
#[derive(Clone, Debug, Serialize)]
pub struct ExportedProblem {
    /// Number of unknowns.
    pub unknowns: usize,
    /// Number of terms.
    pub terms: usize,
    /// Number of residuals.
    pub residuals: usize,
    /// `Ml`, terms by unknowns.
    pub log_length: Triplets,
    /// `g`, metres.
    pub length_m: Vec<f64>,
    /// `Sl`, terms by unknowns.
    pub slide: Triplets,
    /// `Mt`, terms by unknowns.
    pub direction: Triplets,
    /// `t0`, radians.
    pub direction_offset_rad: Vec<f64>,
    /// `Ac`, residuals by terms.
    pub along: Triplets,
    /// `As`, residuals by terms.
    pub up: Triplets,
    /// `A0`, residuals by unknowns.
    pub linear: Triplets,
    /// `b`.
    pub constant: Vec<f64>,
    /// Which residuals have the Cauchy loss.
    pub is_robust: Vec<bool>,
    /// `c`.
    pub cauchy: f64,
    /// Least value of each unknown; none where the problem is free.
    pub lower: Option<Vec<f64>>,
    /// Greatest value of each unknown; none where the problem is free.
    pub upper: Option<Vec<f64>>,
    /// Where to start.
    pub start: Vec<f64>,
    /// Half the sum of squares at this solver's optimum.
    pub optimum_cost: f64,
}

impl ExportedProblem {
    /// Exports a problem, with its bounds or without.
    pub fn new(problem: &StrideProblem, bounded: bool, start: &[f64], optimum_cost: f64) -> Self {
        let bounds = problem.bounds();
        let side = |end: usize| bounded.then(|| bounds.iter().map(|limits| limits[end]).collect());
        let mut exported = Self {
            unknowns: problem.layout.dimension(),
            terms: problem.layout.panels * PANEL_TERMS,
            residuals: 0,
            log_length: Triplets::default(),
            length_m: Vec::new(),
            slide: Triplets::default(),
            direction: Triplets::default(),
            direction_offset_rad: Vec::new(),
            along: Triplets::default(),
            up: Triplets::default(),
            linear: Triplets::default(),
            constant: Vec::new(),
            is_robust: Vec::new(),
            cauchy: problem.weights.cauchy,
            lower: side(0),
            upper: side(1),
            start: start.to_vec(),
            optimum_cost,
        };
        (0..problem.layout.panels).for_each(|slot| exported.add_terms(problem, slot));
        exported.add_residuals(problem);
        exported.residuals = exported.constant.len();
        exported
    }

    fn add_terms(&mut self, problem: &StrideProblem, slot: usize) {
        let chain = &problem.chain;
        for i in 0..BONE_COUNT {
            self.add_term(problem, slot, Some(i), chain.reference_lengths_m[i], Some(log_length(i)), 0.0);
        }
        let polar = |[along, up]: [f64; 2]| (along.hypot(up), up.atan2(along));
        let (length_m, angle_rad) = polar(chain.scapula_attachment_m);
        self.add_term(problem, slot, Some(bone::SPINE_LAST), length_m, Some(LOG_SCALE), angle_rad);
        for side in 0..2 {
            let unknown = problem.layout.panel(slot, SLIDES + side);
            self.slide.push(self.length_m.len(), unknown, 1.0);
            self.add_term(problem, slot, Some(bone::SPINE_LAST), 0.0, None, 0.0);
        }
        let (length_m, angle_rad) = polar(chain.dock_m);
        self.add_term(problem, slot, None, length_m, Some(LOG_DOCK), angle_rad);
    }

    /// A term that turns with a bone, or with the root.
    fn add_term(
        &mut self,
        problem: &StrideProblem,
        slot: usize,
        carrier: Option<usize>,
        length_m: f64,
        log_length: Option<usize>,
        angle_rad: f64,
    ) {
        let term = self.length_m.len();
        self.length_m.push(length_m);
        self.direction_offset_rad.push(angle_rad);
        if let Some(index) = log_length {
            self.log_length.push(term, problem.layout.shared(index), 1.0);
        }
        self.direction.push(term, problem.layout.panel(slot, PITCH), 1.0);
        let mut at = carrier;
        while let Some(bone) = at {
            self.direction.push(term, problem.layout.panel(slot, BENDS + bone), 1.0);
            at = problem.chain.parents[bone];
        }
    }

    fn add_residuals(&mut self, problem: &StrideProblem) {
        for row in &problem.points {
            for axis in 0..2 {
                let slopes = row.columns.map(|column| column[axis]);
                self.add_place(problem, row.slot, row.point, slopes);
                self.finish_row(row.constant[axis], true);
            }
        }
        let (height_sd, slip_sd) = (problem.weights.stance_height_sd, problem.weights.stance_slip_sd);
        for row in &problem.stances {
            self.add_place(problem, row.slot, row.toe, [0.0, 1.0 / height_sd]);
            self.finish_row(0.0, false);
        }
        for row in &problem.stances {
            if let Some((after, ahead_m)) = row.next {
                self.add_place(problem, row.slot, row.toe, [1.0 / slip_sd, 0.0]);
                self.add_place(problem, after, row.toe, [-1.0 / slip_sd, 0.0]);
                self.finish_row(-ahead_m / slip_sd, false);
            }
        }
        for row in &problem.linear {
            let residual = self.constant.len();
            row.terms.iter().for_each(|(unknown, slope)| self.linear.push(residual, *unknown, *slope));
            self.finish_row(row.constant, false);
        }
    }

    fn finish_row(&mut self, constant: f64, is_robust: bool) {
        self.constant.push(constant);
        self.is_robust.push(is_robust);
    }

    /// Adds the place of a point, weighted along the track and upwards, to the row being built.
    fn add_place(
        &mut self,
        problem: &StrideProblem,
        slot: usize,
        point: Attachment,
        [per_x, per_y]: [f64; 2],
    ) {
        let row = self.constant.len();
        self.linear.push(row, problem.layout.panel(slot, ROOT_X), per_x);
        self.linear.push(row, problem.layout.panel(slot, ROOT_Y), per_y);
        let mut carried: Vec<usize> = Vec::new();
        let mut at = match point {
            Attachment::Tip(bone) => Some(bone),
            Attachment::Root => None,
            Attachment::Dock => {
                carried.push(DOCK);
                None
            }
        };
        while let Some(bone) = at {
            carried.push(bone);
            if let Some(side) = [Limb::LF, Limb::RF].iter().position(|limb| limb.first_bone() == bone) {
                carried.extend([ATTACHMENT, SLIDE + side]);
            }
            at = problem.chain.parents[bone];
        }
        for term in carried {
            self.along.push(row, slot * PANEL_TERMS + term, per_x);
            self.up.push(row, slot * PANEL_TERMS + term, per_y);
        }
    }

    /// Evaluates the form.
    pub fn evaluate(&self, x: &[f64]) -> Vec<f64> {
        let zeros = vec![0.0; self.terms];
        let (mut logs, mut slides, mut directions) =
            (zeros.clone(), zeros, self.direction_offset_rad.clone());
        self.log_length.multiply_into(x, &mut logs);
        self.slide.multiply_into(x, &mut slides);
        self.direction.multiply_into(x, &mut directions);
        let lengths: Vec<f64> =
            (0..self.terms).map(|i| self.length_m[i] * logs[i].exp() + slides[i]).collect();
        let (along, up): (Vec<f64>, Vec<f64>) =
            lengths.iter().zip(&directions).map(|(l, t)| (l * t.cos(), l * t.sin())).unzip();
        let mut residuals = self.constant.clone();
        self.along.multiply_into(&along, &mut residuals);
        self.up.multiply_into(&up, &mut residuals);
        self.linear.multiply_into(x, &mut residuals);
        for (r, _) in residuals.iter_mut().zip(&self.is_robust).filter(|(_, is_robust)| **is_robust) {
            *r = r.signum() * self.cauchy * (*r / self.cauchy).powi(2).ln_1p().sqrt();
        }
        residuals
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::{Placing, SyntheticStride};
    use crate::weights::Weights;
    use muybridge_core::Skeleton;

    #[test]
    fn the_form_has_the_residuals_of_the_problem() {
        let (stride, weights) = (SyntheticStride::new(2, 12), Weights::default());
        let observation = stride.observe(&Placing { outlier_share: 0.1, ..Placing::default() }, &weights);
        let skeleton = Skeleton::reference();
        let problem = StrideProblem::new(&skeleton, &observation, stride.stride_time_s, &weights);
        let start = problem.rest_start(&observation);
        let exported = ExportedProblem::new(&problem, true, &start, 0.0);
        assert_eq!(exported.residuals, problem.residual_count());
        for trial in 0..10 {
            let moved = |(i, value): (usize, &f64)| value + 0.3 * ((trial * 37 + i * 11) as f64).sin();
            let x: Vec<f64> = start.iter().enumerate().map(moved).collect();
            let (found, rows) = (exported.evaluate(&x), problem.rows(&x));
            for (i, (r, (expected, _))) in found.iter().zip(&rows).enumerate() {
                assert!((r - expected).abs() < 1e-9, "trial {trial} residual {i}: {r} {expected}");
            }
        }
    }
}
