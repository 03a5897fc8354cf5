//! The search for a way across a river: A* over holds and feet.

use std::cmp::Ordering;
use std::collections::BinaryHeap;
use std::f64::consts::FRAC_PI_4;

use glam::DVec2;

use super::plan::{ahead, heading_of, right_of, wrapped};
use super::river::RiverError;
use crate::lay::setting_out;
use crate::model::Model;
use crate::timing::TimingRule;
use crate::track::{Foot, Print};

/// Turn from one step to the next that costs as much as a step, radians.
const TURN_RAD: f64 = FRAC_PI_4;
/// How much more the square of a step's difference from the model's (in its length) costs than a step.
const LENGTH_COST: f64 = 1.0;
/// Feet nearer to each other than this share of the step's width stand on each other.
const LEAST_WIDTHS: f64 = 0.7;

/// Lengths of a walk, metres.
#[derive(Clone, Copy, Debug)]
pub(super) struct Gauge {
    pub(super) step_m: f64,
    pub(super) width_m: f64,
    /// Half the length of a foot.
    pub(super) foot_m: f64,
    /// The longest leap: the longest step for which the model has times.
    pub(super) leap_m: f64,
}

impl Gauge {
    /// A model's, when they are lengths.
    pub(super) fn of(model: &Model) -> Option<Self> {
        let [step_m, width_m] = model.step_m;
        let leap_m = model.timing.step_times.last()?[0].max(model.timing.stance_times.last()?[0]);
        let gauge = Self { step_m, width_m, foot_m: model.leg.foot.toe_ahead_m, leap_m };
        let is_length = |length_m: &f64| *length_m > 0.0 && *length_m < f64::INFINITY;
        [step_m, width_m, gauge.foot_m, leap_m].iter().all(is_length).then_some(gauge)
    }

    /// Heading of one who steps from a print to another one made by a foot.
    fn heading(&self, from: DVec2, to: DVec2, foot: Foot) -> f64 {
        let way = to - from;
        let to_own_side_rad = (self.width_m / way.length()).min(1.0).asin();
        wrapped(heading_of(way) + sign(foot) * to_own_side_rad)
    }

    /// What a step costs, steps, and the heading after it.
    fn step(&self, from: DVec2, heading_rad: f64, to: DVec2, foot: Foot) -> (f64, f64) {
        let after_rad = self.heading(from, to, foot);
        let longer = (from.distance(to) - self.step_m) / self.step_m;
        let turn = wrapped(after_rad - heading_rad) / TURN_RAD;
        // How far the foot comes down on the other one's side.
        let crossed = (-sign(foot) * (to - from).dot(right_of(heading_rad)) / self.width_m).max(0.0);
        (1.0 + LENGTH_COST * longer * longer + turn * turn + crossed * crossed, after_rad)
    }

    fn is_within_reach(&self, distance_m: f64) -> bool {
        (LEAST_WIDTHS * self.width_m..=self.leap_m).contains(&distance_m)
    }
}

/// 1 for the right foot, -1 for the left one.
fn sign(foot: Foot) -> f64 {
    if foot == Foot::Left { -1.0 } else { 1.0 }
}

fn other(foot: Foot) -> Foot {
    if foot == Foot::Left { Foot::Right } else { Foot::Left }
}

/// A foot on a hold (node `2 hold + foot`), as well as is known.
#[derive(Clone, Copy, Debug)]
struct Reached {
    cost: f64,
    heading_rad: f64,
    from: Option<usize>,
    is_settled: bool,
}

const UNREACHED: Reached = Reached { cost: f64::INFINITY, heading_rad: 0.0, from: None, is_settled: false };

/// The next node to look at; least is greatest, as the heap gives the greatest first.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Next {
    estimate: f64,
    node: usize,
}

impl Eq for Next {}

impl PartialOrd for Next {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Next {
    fn cmp(&self, other: &Self) -> Ordering {
        other.estimate.total_cmp(&self.estimate).then(other.node.cmp(&self.node))
    }
}

struct Search<'a> {
    near_m: f64,
    /// Where the feet land on the far bank: x, metres.
    landing_m: f64,
    holds: &'a [DVec2],
    gauge: &'a Gauge,
    rule: &'a TimingRule,
    reached: Vec<Reached>,
    queue: BinaryHeap<Next>,
    /// The best step on to the far bank: its cost and the node that it leaves, none from the near bank.
    over: (f64, Option<usize>),
}

/// Prints from bank to bank over holds that are sorted by x.
pub(super) fn cross(
    banks_m: [f64; 2],
    holds: &[DVec2],
    gauge: &Gauge,
    rule: &TimingRule,
) -> Result<Vec<Print>, RiverError> {
    let mut search = Search {
        near_m: banks_m[0] - gauge.foot_m,
        landing_m: banks_m[1] + gauge.foot_m,
        holds,
        gauge,
        rule,
        reached: vec![UNREACHED; 2 * holds.len()],
        queue: BinaryHeap::new(),
        over: (f64::INFINITY, None),
    };
    search.step_off();
    while let Some(next) = search.queue.pop() {
        if next.estimate >= search.over.0 {
            break;
        }
        if !std::mem::replace(&mut search.reached[next.node].is_settled, true) {
            search.step_on(next.node);
        }
    }
    if search.over.0.is_finite() { Ok(search.prints()) } else { Err(search.no_way()) }
}

impl Search<'_> {
    fn foot(node: usize) -> Foot {
        Foot::BIPED[node % 2]
    }

    fn hold(&self, node: usize) -> DVec2 {
        self.holds[node / 2]
    }

    /// The foot left on the near bank when the first step straight ahead leads to a hold.
    fn behind(&self, hold: DVec2, foot: Foot) -> DVec2 {
        DVec2::new(self.near_m, hold.y - sign(foot) * self.gauge.width_m)
    }

    /// Where a foot lands on the far bank, straight ahead.
    fn landing(&self, hold: DVec2, foot: Foot) -> DVec2 {
        DVec2::new(self.landing_m, hold.y + sign(foot) * self.gauge.width_m)
    }

    fn offer(&mut self, node: usize, (cost, heading_rad): (f64, f64), from: Option<usize>) {
        if cost < self.reached[node].cost {
            self.reached[node] = Reached { cost, heading_rad, from, is_settled: false };
            // No step costs less than one, or leads farther than the longest leap.
            let left = ((self.landing_m - self.hold(node).x) / self.gauge.leap_m).max(0.0);
            self.queue.push(Next { estimate: cost + left, node });
        }
    }

    /// All first steps from the near bank, and the one that leads over at once.
    fn step_off(&mut self) {
        for node in 0..self.reached.len() {
            let (to, foot) = (self.hold(node), Self::foot(node));
            let from = self.behind(to, foot);
            if self.gauge.is_within_reach(from.distance(to)) {
                self.offer(node, self.gauge.step(from, 0.0, to, foot), None);
            }
        }
        let from = DVec2::new(self.near_m, 0.0);
        let to = self.landing(from, Foot::Right);
        if self.gauge.is_within_reach(from.distance(to)) {
            self.over = (self.gauge.step(from, 0.0, to, Foot::Right).0, None);
        }
    }

    /// All steps from a node.
    fn step_on(&mut self, node: usize) {
        let (from, at) = (self.hold(node), self.reached[node]);
        let foot = other(Self::foot(node));
        let to = self.landing(from, foot);
        if self.gauge.is_within_reach(from.distance(to)) {
            let cost = at.cost + self.gauge.step(from, at.heading_rad, to, foot).0;
            if cost < self.over.0 {
                self.over = (cost, Some(node));
            }
        }
        let first = self.holds.partition_point(|hold| hold.x < from.x - self.gauge.leap_m);
        for hold in first..self.holds.len() {
            let to = self.holds[hold];
            if to.x > from.x + self.gauge.leap_m {
                break;
            }
            let next = 2 * hold + foot.index();
            // A step costs at least one, so that most need not be looked at closely.
            let is_better = at.cost + 1.0 < self.reached[next].cost && !self.reached[next].is_settled;
            if is_better && self.gauge.is_within_reach(from.distance(to)) {
                let (cost, heading_rad) = self.gauge.step(from, at.heading_rad, to, foot);
                self.offer(next, (at.cost + cost, heading_rad), Some(node));
            }
        }
    }

    /// Feet and places of the way over, from standing to standing.
    fn prints(&self) -> Vec<Print> {
        let way = std::iter::successors(self.over.1, |node| self.reached[*node].from);
        let mut nodes: Vec<usize> = way.collect();
        nodes.reverse();
        let mut steps: Vec<(DVec2, Foot)> =
            nodes.iter().map(|&node| (self.hold(node), Self::foot(node))).collect();
        let (behind, foot) = match steps.first() {
            Some(&(hold, foot)) => (self.behind(hold, foot), foot),
            None => (DVec2::new(self.near_m, 0.0), Foot::Right),
        };
        let to_side = sign(foot) * self.gauge.width_m * DVec2::Y;
        steps.splice(0..0, [(behind + to_side, foot), (behind, other(foot))]);
        let (last, foot) = steps[steps.len() - 1];
        let landed = self.landing(last, other(foot));
        let to_side = sign(foot) * self.gauge.width_m * DVec2::Y;
        steps.extend([(landed, other(foot)), (landed + to_side, foot)]);
        let mut prints = self.headed(&steps);
        let [_, (from, _), (to, _), ..] = steps[..] else { return prints };
        for (print, times) in prints.iter_mut().zip(setting_out(self.rule.timing(from.distance(to)))) {
            print.timing = Some(times);
        }
        prints
    }

    /// Prints whose toes point where the figure goes: the middle of the headings of the steps to and from them.
    fn headed(&self, steps: &[(DVec2, Foot)]) -> Vec<Print> {
        let heading = |step: usize| self.gauge.heading(steps[step].0, steps[step + 1].0, steps[step + 1].1);
        let print = |(i, (at, foot)): (usize, &(DVec2, Foot))| {
            let is_on_bank = i < 2 || i + 2 >= steps.len();
            let toes = if is_on_bank { DVec2::X } else { ahead(heading(i - 1)) + ahead(heading(i)) };
            let heading_deg = heading_of(toes).to_degrees();
            Print { foot: *foot, at_m: at.to_array(), heading_deg, timing: None }
        };
        steps.iter().enumerate().map(print).collect()
    }

    /// How far one comes, and the least gap that would have to be crossed.
    fn no_way(&self) -> RiverError {
        let is_reached = |hold: usize| (0..2).any(|foot| self.reached[2 * hold + foot].is_settled);
        let (reached, others): (Vec<usize>, Vec<usize>) =
            (0..self.holds.len()).partition(|&hold| is_reached(hold));
        let reached_m = reached.iter().map(|&hold| self.holds[hold].x).fold(self.near_m, f64::max);
        let mut gap_m = self.landing_m - reached_m;
        for &from in &reached {
            let first = self.holds.partition_point(|hold| hold.x < self.holds[from].x - gap_m);
            for &to in &others[others.partition_point(|&hold| hold < first)..] {
                if self.holds[to].x > self.holds[from].x + gap_m {
                    break;
                }
                gap_m = gap_m.min(self.holds[from].distance(self.holds[to]));
            }
        }
        // From the near bank one may step off anywhere.
        let from_bank = |&hold: &usize| self.behind(self.holds[hold], Foot::Left).distance(self.holds[hold]);
        let from_bank_m = others.first().map_or(f64::INFINITY, from_bank);
        RiverError::NoWay { reached_m, gap_m: gap_m.min(from_bank_m), leap_m: self.gauge.leap_m }
    }
}
