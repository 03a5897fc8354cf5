//! The stride fit as a least-squares problem: one row per residual, all with unit variance (spec 4.1).
//!
//! Panels stand in the order of their phase, so that neighbours in the ring are neighbours in the stride even where
//! the last panels overlap the first. Rows that are linear in the unknowns are worked out once; what is left is the
//! reprojection of placed points and the stance of the hooves.

use muybridge_capture::StanceLabel;
use muybridge_core::{BONE_COUNT, Limb, Pair, Skeleton, bone};

use crate::chain::{Attachment, Chain, Kinematics, Unknown, Vec2};
use crate::layout::{BENDS, LOG_SCALE, Layout, PANEL_DOF, PITCH, ROOT_X, ROOT_Y, SHARED, SLIDES, log_length};
use crate::levenberg::{Curvature, LeastSquares, Linearization};
use crate::normal_matrix::NormalMatrix;
use crate::observation::{PanelObservation, StrideObservation, attachment, depth_m};
use crate::weights::{TUNED_PANELS, Weights};

/// Panels closer in phase than this share of a stride are treated as this far apart: the times are not known better.
const LEAST_GAP: f64 = 0.02;
/// Bounds of a root's place, m: wide enough for any plate, narrow enough to keep the numbers finite.
const ROOT_BOUNDS: [f64; 2] = [-1e4, 1e4];

/// A linear residual: `constant + sum of coefficient * unknown`.
#[derive(Clone, Debug)]
pub(crate) struct LinearRow {
    pub(crate) terms: Vec<(usize, f64)>,
    pub(crate) constant: f64,
}

/// A placed point: residual `(offset + x * columns[0] + y * columns[1] - observed) / sd`, per coordinate, with Cauchy loss.
#[derive(Clone, Debug)]
pub(crate) struct PointRow {
    pub(crate) slot: usize,
    pub(crate) point: Attachment,
    pub(crate) constant: Vec2,
    pub(crate) columns: [Vec2; 2],
}

/// A toe in stance.
#[derive(Clone, Debug)]
pub(crate) struct StanceRow {
    pub(crate) slot: usize,
    pub(crate) toe: Attachment,
    /// The next slot of the same stance, and how much farther along the track its world lies (a stride, at the wrap).
    pub(crate) next: Option<(usize, f64)>,
}

/// The fit of one stride for one stride time.
#[derive(Clone, Debug)]
pub struct StrideProblem {
    /// Where unknowns stand.
    pub layout: Layout,
    /// Phase of each slot, rising, in `[0, 1)`.
    pub phases: Vec<f64>,
    /// For each slot, the index of its panel in the observation.
    pub order: Vec<usize>,
    /// Strides per second times speed: the stride length, m.
    pub stride_length_m: f64,
    pub(crate) chain: Chain,
    pub(crate) weights: Weights,
    pub(crate) linear: Vec<LinearRow>,
    pub(crate) points: Vec<PointRow>,
    pub(crate) stances: Vec<StanceRow>,
    linear_normal: NormalMatrix,
    bounds: Vec<[f64; 2]>,
}

impl StrideProblem {
    /// Sets up the fit of an observation with at least four panels, for a stride time in seconds.
    pub fn new(
        skeleton: &Skeleton,
        observation: &StrideObservation,
        stride_time_s: f64,
        weights: &Weights,
    ) -> Self {
        let start_s = observation.panels.first().map_or(0.0, |p| p.camera.time_s);
        let turns: Vec<f64> =
            observation.panels.iter().map(|p| (p.camera.time_s - start_s) / stride_time_s).collect();
        let mut order: Vec<usize> = (0..turns.len()).collect();
        order.sort_by(|a, b| turns[*a].fract().total_cmp(&turns[*b].fract()).then(a.cmp(b)));
        let layout = Layout { panels: order.len() };
        let mut problem = Self {
            layout,
            phases: order.iter().map(|i| turns[*i].fract()).collect(),
            stride_length_m: observation.speed_m_s * stride_time_s,
            chain: Chain::new(skeleton),
            weights: weights.clone(),
            linear: Vec::new(),
            points: Vec::new(),
            stances: Vec::new(),
            linear_normal: NormalMatrix::zeros(layout),
            bounds: Vec::new(),
            order,
        };
        problem.add_points(observation);
        problem.add_stances(observation, &turns);
        problem.add_smoothness(&turns);
        problem.add_priors();
        problem.add_size(skeleton, observation);
        problem.add_couplings(skeleton, observation);
        problem.linear_normal = problem.normal_of_linear_rows();
        problem.bounds = problem.box_limits();
        problem
    }

    /// Start of the fit: the rest pose, standing where the placed points are.
    pub fn rest_start(&self, observation: &StrideObservation) -> Vec<f64> {
        let mut x = vec![0.0; self.layout.dimension()];
        for (slot, panel) in self.order.iter().map(|i| &observation.panels[*i]).enumerate() {
            let pose = &mut x[self.layout.panel(slot, 0)..][..PANEL_DOF];
            pose[BENDS..SLIDES].copy_from_slice(&self.chain.rest_rad);
            let [dx, dy] = self.mean_offset(pose, panel, observation);
            pose[ROOT_X] = dx;
            pose[ROOT_Y] = dy;
        }
        x
    }

    /// How far a pose is to be moved so that its points and the placed ones have the same mean, m.
    fn mean_offset(&self, pose: &[f64], panel: &PanelObservation, observation: &StrideObservation) -> Vec2 {
        let k = self.chain.kinematics(pose, &[0.0; SHARED]);
        let mut sum = [0.0; 2];
        for point in &panel.points {
            let on = attachment(point.keypoint, observation.facing);
            let depth = depth_m(&self.chain, on, observation.facing);
            let [x, y, _] = panel.camera.world_from_plate(point.at_px, depth);
            let [kx, ky] = k.place(on);
            sum = [sum[0] + x - kx, sum[1] + y - ky];
        }
        sum.map(|s| s / panel.points.len().max(1) as f64)
    }

    fn add_points(&mut self, observation: &StrideObservation) {
        for (slot, panel) in self.order.iter().map(|i| &observation.panels[*i]).enumerate() {
            for point in &panel.points {
                let on = attachment(point.keypoint, observation.facing);
                let (offset, columns) = panel.camera.plane(depth_m(&self.chain, on, observation.facing));
                let weight = 1.0 / point.sd_px;
                self.points.push(PointRow {
                    slot,
                    point: on,
                    constant: [0, 1].map(|axis| (offset[axis] - point.at_px[axis]) * weight),
                    columns: columns.map(|column| column.map(|v| v * weight)),
                });
            }
        }
    }

    fn add_stances(&mut self, observation: &StrideObservation, turns: &[f64]) {
        let n = self.layout.panels;
        for limb in Limb::ALL {
            let down = |slot: usize| {
                observation.panels[self.order[slot]].contacts[limb.index()] == StanceLabel::Stance
            };
            for slot in (0..n).filter(|slot| down(*slot)) {
                let after = (slot + 1) % n;
                // World places differ by whole strides: those the panels were apart in time, plus one at the wrap.
                let strides = turns[self.order[slot]].floor() - turns[self.order[after]].floor()
                    + if after == 0 { 1.0 } else { 0.0 };
                let next = down(after).then_some((after, strides * self.stride_length_m));
                self.stances.push(StanceRow { slot, toe: Attachment::Tip(limb.hoof_bone()), next });
            }
        }
    }

    /// Second differences over the ring, with uneven gaps, as accelerations per stride squared.
    fn add_smoothness(&mut self, turns: &[f64]) {
        let n = self.layout.panels;
        for slot in 0..n {
            let (before, after) = ((slot + n - 1) % n, (slot + 1) % n);
            let gap = |a: usize, b: usize| (self.phases[b] - self.phases[a]).rem_euclid(1.0).max(LEAST_GAP);
            let (h1, h2) = (gap(before, slot), gap(slot, after));
            let weight = (TUNED_PANELS * 0.5 * (h1 + h2)).sqrt();
            let [c0, c1, c2] = [2.0 / (h1 * (h1 + h2)), -2.0 / (h1 * h2), 2.0 / (h2 * (h1 + h2))];
            let mut row = |dof: usize, sd: f64, constant: f64| {
                let scale = weight / sd;
                let terms = [(before, c0), (slot, c1), (after, c2)]
                    .map(|(s, c)| (self.layout.panel(s, dof), c * scale))
                    .to_vec();
                self.linear.push(LinearRow { terms, constant: constant * scale });
            };
            for bone in 0..BONE_COUNT {
                row(BENDS + bone, self.weights.bend_acceleration_sd[bone], 0.0);
            }
            row(PITCH, self.weights.pitch_acceleration_sd, 0.0);
            for dof in [ROOT_Y, SLIDES, SLIDES + 1] {
                row(dof, self.weights.root_acceleration_sd, 0.0);
            }
            // The root's surge, its place less the uniform advance, is what is periodic.
            let advance = |s: usize| -self.stride_length_m * turns[self.order[s]];
            let constant = c0 * advance(before) + c1 * advance(slot) + c2 * advance(after);
            row(ROOT_X, self.weights.root_acceleration_sd, constant);
        }
    }

    fn add_priors(&mut self) {
        let mut row = |index: usize, sd: f64, mean: f64| {
            self.linear.push(LinearRow { terms: vec![(index, 1.0 / sd)], constant: -mean / sd });
        };
        for slot in 0..self.layout.panels {
            for bone in 0..BONE_COUNT {
                let sd = self.weights.bend_prior_sd[bone];
                row(self.layout.panel(slot, BENDS + bone), sd, self.chain.rest_rad[bone]);
            }
            row(self.layout.panel(slot, PITCH), self.weights.pitch_prior_sd, 0.0);
            row(self.layout.panel(slot, SLIDES), self.weights.slide_prior_sd, 0.0);
            row(self.layout.panel(slot, SLIDES + 1), self.weights.slide_prior_sd, 0.0);
        }
        let sd = self.weights.head_direction_sd;
        for slot in 0..self.layout.panels {
            // The head's direction in the world is the sum of the bends from the root up to it.
            let bends = (bone::SPINE..=bone::HEAD).map(|i| BENDS + i).chain([PITCH]);
            let terms = bends.map(|dof| (self.layout.panel(slot, dof), 1.0 / sd)).collect();
            self.linear.push(LinearRow { terms, constant: -self.weights.head_direction / sd });
        }
        // The neck bends in an even curve: only its ends are seen, and three bones between two points could fold anyhow.
        let sd = self.weights.neck_evenness_sd;
        for slot in 0..self.layout.panels {
            for bone in bone::NECK..bone::NECK_LAST {
                let [here, next] = [bone, bone + 1].map(|i| self.layout.panel(slot, BENDS + i));
                let constant = (self.chain.rest_rad[bone + 1] - self.chain.rest_rad[bone]) / sd;
                self.linear.push(LinearRow { terms: vec![(here, 1.0 / sd), (next, -1.0 / sd)], constant });
            }
        }
        let sd = self.weights.log_length_sd;
        for length in 0..LOG_SCALE {
            let terms =
                vec![(self.layout.shared(length), 1.0 / sd), (self.layout.shared(LOG_SCALE), -1.0 / sd)];
            self.linear.push(LinearRow { terms, constant: 0.0 });
        }
    }

    /// The animal's size: as the withers height tells it, else near the reference's.
    fn add_size(&mut self, skeleton: &Skeleton, observation: &StrideObservation) {
        let reference = f64::from(skeleton.withers_height_m);
        let (mean, sd) = observation.withers_height_m.map_or((0.0, self.weights.log_scale_sd), |height_m| {
            ((height_m / reference).ln(), self.weights.log_size_sd)
        });
        let terms = vec![(self.layout.shared(LOG_SCALE), 1.0 / sd)];
        self.linear.push(LinearRow { terms, constant: -mean / sd });
    }

    /// Reciprocal apparatus and passive fetlock.
    fn add_couplings(&mut self, skeleton: &Skeleton, observation: &StrideObservation) {
        for slot in 0..self.layout.panels {
            let contacts = observation.panels[self.order[slot]].contacts;
            for limb in Limb::ALL {
                let rows =
                    [reciprocal_row(skeleton, limb), fetlock_row(skeleton, limb, contacts[limb.index()])];
                for mut row in rows.into_iter().flatten() {
                    for (index, _) in &mut row.terms {
                        *index = self.layout.panel(slot, *index);
                    }
                    self.linear.push(row);
                }
            }
        }
    }

    fn normal_of_linear_rows(&self) -> NormalMatrix {
        let mut normal = NormalMatrix::zeros(self.layout);
        for row in &self.linear {
            normal.add_row(&row.terms, 1.0);
        }
        normal
    }

    fn box_limits(&self) -> Vec<[f64; 2]> {
        let mut bounds = vec![ROOT_BOUNDS; self.layout.dimension()];
        for slot in 0..self.layout.panels {
            let panel = &mut bounds[self.layout.panel(slot, 0)..][..PANEL_DOF];
            panel[PITCH] = [-1.0, 1.0];
            panel[BENDS..SLIDES].copy_from_slice(&self.chain.limits_rad);
            panel[SLIDES..].fill(self.chain.slide_limits_m);
        }
        // No horse's bone is a third or three times the reference's.
        bounds[self.layout.shared(0)..].fill([-1.1, 1.1]);
        bounds
    }

    /// Poses worked out for every slot.
    pub fn kinematics(&self, x: &[f64]) -> Vec<Kinematics> {
        let shared = &x[self.layout.shared(0)..];
        (0..self.layout.panels)
            .map(|slot| self.chain.kinematics(&x[self.layout.panel(slot, 0)..][..PANEL_DOF], shared))
            .collect()
    }

    /// The residuals that depend on one point each: placed points, then stance heights.
    fn point_terms(&self, kinematics: &[Kinematics]) -> impl Iterator<Item = PointTerm> {
        let placed = self.points.iter().map(|row| {
            let [x, y] = kinematics[row.slot].place(row.point);
            let slopes = [0, 1].map(|axis| [row.columns[0][axis], row.columns[1][axis]]);
            let values = [0, 1].map(|axis| row.constant[axis] + x * slopes[axis][0] + y * slopes[axis][1]);
            PointTerm { slot: row.slot, point: row.point, values, slopes, loss: Loss::Cauchy }
        });
        let per_height = 1.0 / self.weights.stance_height_sd;
        let heights = self.stances.iter().map(move |row| {
            let values = [kinematics[row.slot].place(row.toe)[1] * per_height, 0.0];
            let slopes = [[0.0, per_height], [0.0; 2]];
            PointTerm { slot: row.slot, point: row.toe, values, slopes, loss: Loss::Square }
        });
        placed.chain(heights)
    }

    /// The residuals that hold a toe in stance in its place from one panel to the next.
    fn slip_terms(&self, kinematics: &[Kinematics]) -> impl Iterator<Item = SlipTerm> {
        let per_slip = 1.0 / self.weights.stance_slip_sd;
        self.stances.iter().filter_map(move |row| {
            let (after, ahead_m) = row.next?;
            let x_m = |slot: usize| kinematics[slot].place(row.toe)[0];
            let value = (x_m(row.slot) - x_m(after) - ahead_m) * per_slip;
            Some(SlipTerm { ends: [(row.slot, per_slip), (after, -per_slip)], toe: row.toe, value })
        })
    }

    /// Derivatives of a point's place with respect to the unknowns it depends on.
    fn place_derivatives(
        &self,
        k: &Kinematics,
        slot: usize,
        point: Attachment,
        out: &mut Vec<(usize, Vec2)>,
    ) {
        out.clear();
        self.chain.derivatives(k, point, |unknown, d| out.push((self.index(slot, unknown), d)));
    }

    /// Sparse derivative of a slip residual.
    fn slip_row(&self, kinematics: &[Kinematics], term: &SlipTerm) -> Vec<(usize, f64)> {
        let mut row = Vec::with_capacity(64);
        for (slot, slope) in term.ends {
            self.chain.derivatives(&kinematics[slot], term.toe, |unknown, [dx, _]| {
                row.push((self.index(slot, unknown), dx * slope));
            });
        }
        row
    }

    fn index(&self, slot: usize, unknown: Unknown) -> usize {
        match unknown {
            Unknown::Panel(dof) => self.layout.panel(slot, dof),
            Unknown::Shared(index) => self.layout.shared(index),
        }
    }

    /// Number of residuals.
    pub fn residual_count(&self) -> usize {
        let stance: usize = self.stances.iter().map(|row| 1 + usize::from(row.next.is_some())).sum();
        2 * self.points.len() + stance + self.linear.len()
    }

    /// All residuals with their loss folded in (half their sum of squares is the cost), nonlinear first, and their
    /// sparse derivatives: for checks and for other solvers.
    pub fn rows(&self, x: &[f64]) -> Vec<(f64, Vec<(usize, f64)>)> {
        let mut all = Vec::with_capacity(self.residual_count());
        let kinematics = self.kinematics(x);
        let mut places = Vec::new();
        for term in self.point_terms(&kinematics) {
            self.place_derivatives(&kinematics[term.slot], term.slot, term.point, &mut places);
            for (value, slopes) in term.values.into_iter().zip(term.slopes).filter(|(_, s)| *s != [0.0; 2]) {
                let (value, slope) = term.loss.as_residual(value, self.weights.cauchy);
                let row = places.iter().map(|(i, d)| (*i, slope * dot(slopes, *d)));
                all.push((value, row.collect()));
            }
        }
        all.extend(self.slip_terms(&kinematics).map(|term| (term.value, self.slip_row(&kinematics, &term))));
        all.extend(self.linear.iter().map(|row| (row.residual(x), row.terms.clone())));
        all
    }

    /// The same problem with another Cauchy scale.
    pub(crate) fn with_cauchy(&self, cauchy: f64) -> Self {
        let mut other = self.clone();
        other.weights.cauchy = cauchy;
        other
    }

    /// Length of a bone, m.
    pub fn bone_length_m(&self, bone: usize, shared: &[f64]) -> f64 {
        self.chain.length_m(bone, shared)
    }

    /// Index of the log-length of a bone in the unknowns.
    pub fn length_index(&self, bone: usize) -> usize {
        self.layout.shared(log_length(bone))
    }
}

/// Reciprocal apparatus of a hind limb, in the unknowns of its panel.
pub(crate) fn reciprocal_row(skeleton: &Skeleton, limb: Limb) -> Option<LinearRow> {
    let (sd, ratio) = (f64::from(skeleton.reciprocal.sd_rad), f64::from(skeleton.reciprocal.ratio));
    let rest = |i: usize| f64::from(skeleton.bones[limb.first_bone() + i].rest_bend_rad);
    let bend = |i: usize| BENDS + limb.first_bone() + i;
    (limb.pair() == Pair::Hind).then(|| LinearRow {
        terms: vec![(bend(3), 1.0 / sd), (bend(2), -ratio / sd)],
        constant: (ratio * rest(2) - rest(3)) / sd,
    })
}

/// Passive fetlock of a limb of known contact, in the unknowns of its panel.
pub(crate) fn fetlock_row(skeleton: &Skeleton, limb: Limb, contact: StanceLabel) -> Option<LinearRow> {
    let fetlock = skeleton.fetlock;
    let rest = |i: usize| f64::from(skeleton.bones[limb.first_bone() + i].rest_bend_rad);
    let bend = |i: usize| BENDS + limb.first_bone() + i;
    match contact {
        StanceLabel::Unknown => None,
        StanceLabel::Stance => {
            let sd = f64::from(fetlock.stance_sd_rad);
            let constant = -f64::from(fetlock.stance_bend_rad) / sd;
            Some(LinearRow { terms: vec![(bend(4), 1.0 / sd)], constant })
        }
        StanceLabel::Swing => {
            let sd = f64::from(fetlock.swing_sd_rad);
            let swing = if limb.pair() == Pair::Fore { fetlock.fore } else { fetlock.hind };
            let [upper, cannon] = [swing.per_upper_bend, swing.per_cannon_bend].map(f64::from);
            let terms = vec![(bend(4), 1.0 / sd), (bend(1), -upper / sd), (bend(3), -cannon / sd)];
            let mean = f64::from(swing.swing_bend_rad) - upper * rest(1) - cannon * rest(3);
            Some(LinearRow { terms, constant: -mean / sd })
        }
    }
}

impl LinearRow {
    pub(crate) fn residual(&self, x: &[f64]) -> f64 {
        self.terms.iter().fold(self.constant, |sum, (i, c)| sum + c * x[*i])
    }
}

/// How a residual counts.
#[derive(Clone, Copy)]
enum Loss {
    /// `r^2 / 2`.
    Square,
    /// `c^2 / 2 ln(1 + (r/c)^2)`.
    Cauchy,
}

impl Loss {
    /// Value, first and second derivative with respect to the residual.
    fn of(self, r: f64, c: f64) -> [f64; 3] {
        match self {
            Self::Square => [0.5 * r * r, r, 1.0],
            Self::Cauchy => {
                let q = (r / c).powi(2);
                [0.5 * c * c * q.ln_1p(), r / (1.0 + q), (1.0 - q) / (1.0 + q).powi(2)]
            }
        }
    }

    /// A residual whose half square is the loss, and its derivative with respect to the residual.
    fn as_residual(self, r: f64, c: f64) -> (f64, f64) {
        let [value, slope, _] = self.of(r, c);
        let folded = r.signum() * (2.0 * value).sqrt();
        // Near zero the loss is the square: the quotient below would be 0 / 0.
        if r.abs() < 1e-6 * c { (r, 1.0) } else { (folded, slope / folded) }
    }
}

/// Two residuals of one point: `values` and how each changes with the point's place (zero where there is only one).
struct PointTerm {
    slot: usize,
    point: Attachment,
    values: [f64; 2],
    slopes: [Vec2; 2],
    loss: Loss,
}

/// A residual between a toe in one slot and the same toe in the next: slots with its slope along the track.
struct SlipTerm {
    ends: [(usize, f64); 2],
    toe: Attachment,
    value: f64,
}

fn dot([ax, ay]: Vec2, [bx, by]: Vec2) -> f64 {
    ax * bx + ay * by
}

impl LeastSquares for &StrideProblem {
    fn cost(&self, x: &[f64]) -> f64 {
        let kinematics = self.kinematics(x);
        let mut sum = 0.0;
        for term in self.point_terms(&kinematics) {
            sum += term.values.map(|value| term.loss.of(value, self.weights.cauchy)[0]).iter().sum::<f64>();
        }
        sum += self.slip_terms(&kinematics).map(|term| 0.5 * term.value * term.value).sum::<f64>();
        self.linear.iter().fold(sum, |sum, row| sum + 0.5 * row.residual(x).powi(2))
    }

    fn linearize(&self, x: &[f64], curvature: Curvature) -> Linearization {
        let gradient = vec![0.0; self.layout.dimension()];
        let mut at = Linearization { cost: 0.0, gradient, normal: self.linear_normal.clone() };
        self.relinearize(x, curvature, &mut at);
        at
    }

    fn relinearize(&self, x: &[f64], curvature: Curvature, at: &mut Linearization) {
        at.cost = 0.0;
        at.gradient.fill(0.0);
        at.normal.clone_from(&self.linear_normal);
        let kinematics = self.kinematics(x);
        let mut places = Vec::with_capacity(64);
        for term in self.point_terms(&kinematics) {
            self.add_point(at, &kinematics[term.slot], &term, curvature, &mut places);
        }
        for term in self.slip_terms(&kinematics) {
            at.cost += 0.5 * term.value * term.value;
            let row = self.slip_row(&kinematics, &term);
            for (i, v) in &row {
                at.gradient[*i] += term.value * v;
            }
            at.normal.add_row(&row, 1.0);
            if curvature == Curvature::Full {
                for (slot, slope) in term.ends {
                    let pull = [slope * term.value, 0.0];
                    self.add_turning(&mut at.normal, &kinematics[slot], slot, term.toe, pull);
                }
            }
        }
        for row in &self.linear {
            let residual = row.residual(x);
            at.cost += 0.5 * residual * residual;
            for (i, slope) in &row.terms {
                at.gradient[*i] += residual * slope;
            }
        }
    }

    fn bounds(&self) -> &[[f64; 2]] {
        &self.bounds
    }
}

impl StrideProblem {
    /// Adds a point's two residuals to cost, gradient and second derivatives in one pass over its unknowns.
    fn add_point(
        &self,
        at: &mut Linearization,
        k: &Kinematics,
        term: &PointTerm,
        curvature: Curvature,
        places: &mut Vec<(usize, Vec2)>,
    ) {
        let (mut pull, mut stiffness) = ([0.0; 2], [[0.0; 2]; 2]);
        for (value, slopes) in term.values.into_iter().zip(term.slopes) {
            let [cost, slope, bend] = term.loss.of(value, self.weights.cauchy);
            at.cost += cost;
            let weight = match curvature {
                Curvature::GaussNewton if value == 0.0 => 1.0,
                Curvature::GaussNewton => slope / value,
                Curvature::Full => bend,
            };
            for axis in 0..2 {
                pull[axis] += slope * slopes[axis];
                stiffness[axis] =
                    [0, 1].map(|other| stiffness[axis][other] + weight * slopes[axis] * slopes[other]);
            }
        }
        self.place_derivatives(k, term.slot, term.point, places);
        for (n, (i, d)) in places.iter().enumerate() {
            at.gradient[*i] += dot(pull, *d);
            let stiff = [dot(stiffness[0], *d), dot(stiffness[1], *d)];
            // No unknown moves a point in two ways, so each pair of indices comes once.
            for (j, other) in &places[..=n] {
                at.normal.add(*i, *j, dot(stiff, *other));
            }
        }
        if curvature == Curvature::Full {
            self.add_turning(&mut at.normal, k, term.slot, term.point, pull);
        }
    }

    /// Adds the part of the second derivative that comes from the joints' turning.
    fn add_turning(
        &self,
        normal: &mut NormalMatrix,
        k: &Kinematics,
        slot: usize,
        point: Attachment,
        pull: Vec2,
    ) {
        self.chain.second_derivatives(k, point, pull, |a, b, value| {
            normal.add(self.index(slot, a), self.index(slot, b), value);
        });
    }
}
