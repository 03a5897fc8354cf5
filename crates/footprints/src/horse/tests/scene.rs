//! Tracks to measure horses on, and the centre of mass as the database has it.

use std::sync::OnceLock;

use glam::{DVec2, DVec3};
use muybridge_core::{Gait, Lead, Limb, Random, Side};

use super::super::{HorseModel, HorseMotion, HorsePlan, lay_horse};
use crate::knots::{Knot, Trajectory};
use crate::lay::Laying;
use crate::path::PathPoint;
use crate::placed::Placed;
use crate::solve::descend;
use crate::terrain::Terrain;
use crate::timing::TimingRule;
use crate::track::{Foot, Track, TrackGait};

/// The six gaits.
pub(crate) const GAITS: [Gait; 6] =
    [Gait::Walk, Gait::Amble, Gait::Trot, Gait::Rack, Gait::Canter, Gait::Gallop];
/// Strides of a track.
const STRIDES: f64 = 6.0;
/// Greatest lateral acceleration, m/s², and smallest radius, m, of a random path.
const LATERAL_M_S2: f64 = 2.0;
const LEAST_RADIUS_M: f64 = 3.5;
/// Steepest random slope, degrees.
const STEEPEST_DEG: f64 = 8.0;
/// Knots of the database's curve, s apart.
const KNOTS_S: f64 = 1.0 / 120.0;

/// The reference horse, made once.
pub(crate) fn model() -> HorseModel {
    static MODEL: OnceLock<HorseModel> = OnceLock::new();
    MODEL.get_or_init(HorseModel::reference).clone()
}

/// A track with everything its prints decide.
pub(crate) struct Scene {
    pub(crate) track: Track,
    pub(crate) placed: Placed,
    pub(crate) plan: HorsePlan,
}

impl Scene {
    pub(crate) fn new(model: &HorseModel, track: Track) -> Self {
        let rule = TimingRule { step_times: vec![[0.0, 0.5]], stance_times: vec![[0.0, 0.5]] };
        let placed = track.place(&rule).unwrap();
        let plan = HorsePlan::new(model, &track.gait.unwrap(), &placed, &track.terrain).unwrap();
        Self { track, placed, plan }
    }

    pub(crate) fn motion(&self, curve: Trajectory) -> HorseMotion {
        HorseMotion::new(self.plan.clone(), curve)
    }

    /// The feet in the order of their footfalls after the first moment.
    pub(crate) fn order(&self) -> Vec<Foot> {
        self.placed.prints.iter().filter(|print| print.strike_s > 0.0).map(|print| print.foot).collect()
    }

    /// The same by the contacts of the database.
    pub(crate) fn gait_order(&self) -> Vec<Foot> {
        let own = self.plan.gait().own();
        let mut strikes = Limb::ALL.map(|limb| (own.contact(limb).strike_phase, limb.index()));
        strikes.sort_by(|a, b| a.0.total_cmp(&b.0));
        let feet = strikes.into_iter().map(|(_, limb)| Foot::QUADRUPED[limb]);
        // The first of a stride falls at the first moment.
        feet.cycle().skip(1).take(self.order().len()).collect()
    }
}

/// A gait at a share of its range of speeds and, where it has one, with a lead.
pub(crate) fn track_gait(model: &HorseModel, gait: Gait, share: f64, side: Side) -> TrackGait {
    let [low, high] = model.speed_range_m_s(gait).map(f64::from);
    let has_lead = matches!(gait, Gait::Canter | Gait::Gallop);
    let lead = has_lead.then_some(Lead { fore: side, hind: side });
    TrackGait { gait, speed_m_s: low + share * (high - low), lead }
}

pub(crate) fn laid(model: &HorseModel, gait: TrackGait, points: Vec<PathPoint>, terrain: Terrain) -> Track {
    let laying = Laying { points, step_length_m: None, step_width_m: None, timing: None };
    let prints = lay_horse(&laying, &gait, &terrain, model).unwrap();
    Track { terrain, gait: Some(gait), prints, ..Track::new("horse") }
}

/// A few strides along X on level ground.
pub(crate) fn straight_track(model: &HorseModel, gait: Gait) -> Track {
    let gait = track_gait(model, gait, 0.5, Side::Right);
    let point = |x_m: f64| PathPoint { at_m: [x_m, 0.0], tangent_m: None };
    laid(model, gait, vec![point(0.0), point(30.0)], Terrain::Flat)
}

/// A random path with turns on a slope, at a random speed of a gait.
pub(crate) fn random_track(model: &HorseModel, gait: Gait, seed: u64) -> Track {
    let mut random = Random::new(1000 * gait as u64 + seed);
    let side = if random.uniform() < 0.5 { Side::Left } else { Side::Right };
    let gait = track_gait(model, gait, random.uniform(), side);
    let terrain = Terrain::Slope {
        rise_deg: random.between(-STEEPEST_DEG, STEEPEST_DEG),
        towards_deg: random.between(-180.0, 180.0),
    };
    let most_per_m = (LATERAL_M_S2 / gait.speed_m_s.powi(2)).min(1.0 / LEAST_RADIUS_M);
    let own = model.repertoire().own_gait(gait.gait, side, gait.speed_m_s as f32);
    let length_m = STRIDES * f64::from(own.stride_length_m()) + 1.5;
    let piece_m = (length_m / 8.0).min(4.0);
    let (mut at, mut heading) = (DVec2::new(random.between(-50.0, 50.0), 3.0), random.between(-3.0, 3.0));
    let mut points = Vec::new();
    for _ in 0..=(length_m / piece_m) as usize {
        let ahead = DVec2::from_angle(-heading);
        points.push(PathPoint { at_m: at.into(), tangent_m: Some((ahead * piece_m).into()) });
        let turn = piece_m * random.between(-most_per_m, most_per_m);
        at += DVec2::from_angle(-heading - 0.5 * turn) * piece_m;
        heading += turn;
    }
    laid(model, gait, points, terrain)
}

/// The centre of mass as the database has it over prints on level ground: the root is where the standing feet say.
pub(crate) fn database_curve(plan: &HorsePlan) -> Trajectory {
    let times_s: Vec<f64> =
        (0..=(plan.end_s() / KNOTS_S).ceil() as usize).map(|i| i as f64 * KNOTS_S).collect();
    let places: Vec<DVec3> = times_s.iter().map(|time_s| database_place(plan, *time_s)).collect();
    let knot = |i: usize| {
        let (before, after) = (i.saturating_sub(1), (i + 1).min(places.len() - 1));
        let over_s = KNOTS_S * (after - before).max(1) as f64;
        Knot { at: places[i], velocity: (places[after] - places[before]) / over_s }
    };
    Trajectory { knots: (0..places.len()).map(knot).collect(), times_s }
}

fn database_place(plan: &HorsePlan, time_s: f64) -> DVec3 {
    let own = plan.gait().own();
    let (pose, wanted) = plan.carried(time_s, DVec3::ZERO);
    let legs = plan.legs(time_s);
    let mut at = DVec3::ZERO;
    for limb in Limb::ALL {
        let phase = legs[limb.index()].unwrap().phase as f32;
        let ahead_m = f64::from(own.toe_m(limb, phase)[0]);
        at += 0.25 * (wanted[limb.index()].unwrap().aim.toe_in_world - DVec3::X * ahead_m);
    }
    let phase = super::super::trunk::body_phase(&legs) as f32;
    let root = own.pose(phase, [phase; 4]).root_in_world.as_dvec3();
    // What `carried` puts under the centre of mass, put on it.
    DVec3::new(at.x, 0.0, 0.0) + root - pose.root_in_world.as_dvec3()
}

/// The centre of mass as the energy has it.
pub(crate) fn solved_curve(scene: &Scene) -> Trajectory {
    let problem = scene.plan.problem(scene.track.weights);
    descend(&problem, scene.plan.start(&problem)).trajectory
}
