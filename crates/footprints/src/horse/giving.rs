//! How the body departs from its centre of mass: kept at the heights that the gait has in the database, and drawn smoothly to feet that
//! are out of reach, because a hoof stays on its print.

use glam::DVec3;
use muybridge_core::Limb;

use super::leg::LegNow;
use super::plan::HorsePlan;
use super::series::{between, moving_mean};
use crate::knots::Trajectory;

/// Step of the table, s, unless that makes more than so many.
const STEP_S: f64 = 1.0 / 60.0;
const MOST_STEPS: f64 = 40_000.0;
/// Time before and after a leg's need over which the body goes and comes back, s.
const EASING_S: f64 = 0.12;
/// The body is drawn no farther than this, metres.
const MOST_M: f64 = 0.6;
/// What a leg is spared of its greatest length, metres: the body moves a little between two steps of the table.
const SPARED_M: f64 = 0.0005;
/// A pull goes down rather than along the track: a body held back in its way lurches, a lowered one flexes its legs.
const PULL_ALONG: f64 = 0.5;
/// Softness of the ends of the gait's range of heights, metres.
const SOFT_M: f64 = 0.01;
/// Rounds of drawing the body to legs that are too short, and of drawing it to legs that their joints stop.
const ROUNDS: [usize; 2] = [4, 6];
/// How much more than what a stopped leg misses the body is drawn.
const PULL: f64 = 1.3;
/// A standing toe this near its print is there, metres.
const THERE_M: f64 = 2e-5;

/// How far the body is drawn from where its centre of mass has it, over time.
#[derive(Clone, Debug, Default)]
pub(super) struct Giving {
    step_s: f64,
    /// That, with what keeps it at the heights of the gait.
    drawn_m: Vec<DVec3>,
    /// What each print was missed by at worst, metres.
    pub(super) misses_m: Vec<f64>,
}

/// The pull of a leg whose toe has to be at a place seen from its joint, and that lacks so much.
fn pull_to(place: DVec3, lacking_m: f64) -> DVec3 {
    let along = place.normalize_or_zero();
    let way = (along * DVec3::new(PULL_ALONG, 1.0, PULL_ALONG)).normalize_or_zero();
    way * (lacking_m / way.dot(along).max(0.2))
}

/// A curve that is as far from zero as every need within reach of it, either way, and smooth.
fn eased(needs: &[DVec3], half: usize) -> Vec<DVec3> {
    let most = |sign: f64| -> Vec<DVec3> {
        let near = |i: usize| &needs[i.saturating_sub(half)..(i + half + 1).min(needs.len())];
        let farthest = |i: usize| near(i).iter().fold(DVec3::ZERO, |most, need| most.max(*need * sign));
        (0..needs.len()).map(|i| farthest(i) * sign).collect()
    };
    if needs.iter().all(|need| *need == DVec3::ZERO) {
        return needs.to_vec();
    }
    let both: Vec<DVec3> = most(1.0).into_iter().zip(most(-1.0)).map(|(up, down)| up + down).collect();
    moving_mean(&moving_mean(&both, half / 2), half - half / 2)
}

/// What brings a height over the ground into a range, softly at its ends, metres.
fn held_m(height_m: f64, [low_m, high_m]: [f64; 2]) -> f64 {
    let over = |over_m: f64| 0.5 * (over_m + over_m.hypot(SOFT_M));
    over(low_m - height_m) - over(height_m - high_m)
}

/// A moment at which standing legs are looked at, and the steps of the table that are to serve it.
#[derive(Clone, Copy, Debug)]
struct Moment {
    time_s: f64,
    steps: [usize; 2],
}

/// How much farther the body has to be drawn at a time, s, for a centre of mass.
type Pull = fn(&Giving, &HorsePlan, f64, DVec3) -> DVec3;

impl Giving {
    /// Finds how far the body has to be drawn.
    pub(super) fn new(plan: &HorsePlan, trajectory: &Trajectory) -> Self {
        let step_s = STEP_S.max(plan.end_s() / MOST_STEPS);
        let count = (plan.end_s() / step_s).ceil() as usize + 1;
        let half = (EASING_S / step_s).ceil() as usize;
        let held = |i: usize| {
            let time_s = (i as f64 * step_s).min(plan.end_s());
            let (pose, _) = plan.carried(time_s, trajectory.at(time_s).at);
            let height_m = f64::from(pose.root_in_world.y) - plan.trunk().under_root(time_s).y;
            DVec3::Y * held_m(height_m, plan.gait().heights_m)
        };
        let held_m: Vec<DVec3> = (0..count).map(held).collect();
        let mut needs = vec![DVec3::ZERO; count];
        let mut giving = Self { step_s, drawn_m: held_m.clone(), misses_m: Vec::new() };
        let moments = giving.moments(plan);
        for (rounds, pull) in [(ROUNDS[0], Self::lacking as Pull), (ROUNDS[1], Self::stopped)] {
            for _ in 0..rounds {
                let more = giving.more(plan, trajectory, &moments, pull);
                if more.iter().all(|more| *more == DVec3::ZERO) {
                    break;
                }
                for (need, more) in needs.iter_mut().zip(more) {
                    *need = (*need + more).clamp_length_max(MOST_M);
                }
                let drawn_m = held_m.iter().zip(eased(&needs, half));
                giving.drawn_m = drawn_m.map(|(held, eased)| *held + eased).collect();
            }
        }
        giving.misses_m = giving.misses_m(plan, trajectory);
        giving
    }

    /// How much farther the body has to be drawn at each step of the table.
    fn more(&self, plan: &HorsePlan, trajectory: &Trajectory, moments: &[Moment], pull: Pull) -> Vec<DVec3> {
        let mut more = vec![DVec3::ZERO; self.drawn_m.len()];
        for moment in moments {
            let pull = pull(self, plan, moment.time_s, trajectory.at(moment.time_s).at);
            for step in moment.steps {
                if pull.length_squared() > more[step].length_squared() {
                    more[step] = pull;
                }
            }
        }
        more
    }

    /// Every step of the table, and every footfall and lift-off: between two of them a leg is no longer than the longer of both.
    fn moments(&self, plan: &HorsePlan) -> Vec<Moment> {
        let last = self.drawn_m.len() - 1;
        let steps =
            (0..=last).map(|i| Moment { time_s: (i as f64 * self.step_s).min(plan.end_s()), steps: [i; 2] });
        let stands = plan.courses().iter().flat_map(|course| &course.stands);
        let edges = stands.filter(|stand| stand.print.is_some()).flat_map(|stand| [stand.from_s, stand.to_s]);
        let edges = edges.filter(|time_s| (0.0..=plan.end_s()).contains(time_s)).map(|time_s| {
            let before = ((time_s / self.step_s) as usize).min(last);
            Moment { time_s, steps: [before, (before + 1).min(last)] }
        });
        steps.chain(edges).collect()
    }

    /// How far the body is drawn at a time, metres.
    pub(super) fn at(&self, time_s: f64) -> DVec3 {
        between(&self.drawn_m, self.step_s, time_s)
    }

    /// How much farther the body has to be drawn so that no standing leg is longer than it can be.
    fn lacking(&self, plan: &HorsePlan, time_s: f64, centre_of_mass: DVec3) -> DVec3 {
        let (pose, _) = plan.carried(time_s, centre_of_mass);
        let reach = plan.gait().model.reach();
        let joints = reach.joints_in_root(&pose);
        let root = pose.root_in_world.as_dvec3() + self.at(time_s);
        let mut pull = DVec3::ZERO;
        for (limb, leg) in Limb::ALL.into_iter().zip(plan.legs(time_s)) {
            let Some(stand) = leg.and_then(|leg| leg.stand()) else { continue };
            let joint = root + pull + (pose.world_from_root * joints[limb.index()]).as_dvec3();
            let place = stand.toe - joint;
            let lacking_m = place.length() - f64::from(reach.span_m(limb)) + SPARED_M;
            if lacking_m > 0.0 {
                pull += pull_to(place, lacking_m);
            }
        }
        pull
    }

    /// How much farther it has to be drawn so that no standing leg is stopped by its joints.
    fn stopped(&self, plan: &HorsePlan, time_s: f64, centre_of_mass: DVec3) -> DVec3 {
        let (mut pose, wanted) = plan.carried(time_s, centre_of_mass);
        pose.root_in_world += self.at(time_s).as_vec3();
        let missed = plan.reach(&mut pose, &wanted);
        let mut pull = DVec3::ZERO;
        for (leg, missed) in plan.legs(time_s).into_iter().zip(missed) {
            let stands = leg.and_then(|leg| leg.stand()).is_some();
            let missing = missed.missing_in_world.as_dvec3();
            if stands && f64::from(missed.miss_m) > THERE_M && missing.is_finite() {
                pull += missing * PULL;
            }
        }
        pull
    }

    fn misses_m(&self, plan: &HorsePlan, trajectory: &Trajectory) -> Vec<f64> {
        let mut misses_m = vec![0.0f64; plan.print_count()];
        for Moment { time_s, .. } in self.moments(plan) {
            let (mut pose, wanted) = plan.carried(time_s, trajectory.at(time_s).at);
            pose.root_in_world += self.at(time_s).as_vec3();
            let missed = plan.reach(&mut pose, &wanted);
            for (leg, missed) in plan.legs(time_s).iter().zip(missed) {
                if let Some(print) = leg.as_ref().and_then(LegNow::stand).and_then(|stand| stand.print) {
                    misses_m[print] = misses_m[print].max(f64::from(missed.miss_m));
                }
            }
        }
        misses_m
    }
}
