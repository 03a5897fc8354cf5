//! A ride: one horse or two, driven step by step over a ground, with the last seconds kept. Needs no window.

pub mod build;
pub mod phase_match;
pub mod record;
pub mod terrain;
pub mod wants;

use std::sync::Arc;

use glam::{DVec3, Vec3};
use muybridge_core::{Gait, Horse, Joints, Limb, Repertoire, Side, bone};

use record::{Frame, Record, RiderFrame, STEP_S};
use terrain::{Shape, Terrain};
use wants::{HeldRein, Order, Wants};

/// Longest time that is caught up with, s: after a pause of the window the ride goes on where it was.
const LONGEST_S: f64 = 0.1;
/// Rounding of times that should add up to whole steps, s.
const ROUNDING_S: f64 = 1e-9;
/// The second horse goes so far to the left of the first, metres: room for two trunks and a rein. The usual cameras stand at the
/// right.
const BESIDE_M: f32 = 1.9;
/// A root that moved farther in one step was put there, metres.
const PUT_M: f32 = 1.0;

/// So short a step only poses the horse anew, s.
const POSED_S: f32 = 1e-5;

/// One of the two horses.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Which {
    /// The first.
    #[default]
    A,
    /// The second, for comparison.
    B,
}

impl Which {
    /// Both.
    pub const ALL: [Self; 2] = [Self::A, Self::B];

    /// 0 or 1.
    pub fn index(self) -> usize {
        self as usize
    }

    /// `A` or `B`.
    pub fn name(self) -> &'static str {
        ["A", "B"][self.index()]
    }
}

/// A horse that is ridden.
struct Rider {
    horse: Horse,
    seed: u64,
    /// Kept whatever is asked for.
    own_gait: Option<Gait>,
    /// Where it is seen from where it moves, metres: the second horse moves in the first one's place on a ground that is shifted
    /// likewise, so that it can take over its stride.
    offset_m: Vec3,
}

impl Rider {
    fn step(&mut self, wants: &Wants, seconds: f32, terrain: &Terrain) {
        let offset_m = self.offset_m;
        let ground = |x: f32, z: f32| terrain.height_m(x + offset_m.x, z + offset_m.z);
        self.horse.step(&wants.command(self.own_gait), seconds, &ground);
    }

    /// Stands at the origin, facing along X.
    fn begin(&mut self, terrain: &Terrain) {
        let offset_m = self.offset_m;
        let ground = |x: f32, z: f32| terrain.height_m(x + offset_m.x, z + offset_m.z);
        self.horse = Horse::of(Arc::clone(self.horse.repertoire()), self.seed);
        self.horse.place(DVec3::new(0.0, f64::from(ground(0.0, 0.0)), 0.0), 0.0, &ground);
    }
}

/// A ride.
pub struct RideSession {
    riders: [Option<Rider>; 2],
    wants: Wants,
    rein: HeldRein,
    terrain: Terrain,
    record: Record,
    /// Steps from the newest frame back to the one that is shown.
    back: usize,
    step: u64,
    carried_s: f64,
    is_paused: bool,
    /// Speed of time against the real one, `0..=1`.
    pub rate: f64,
}

impl RideSession {
    /// A horse of a build on flat ground, asked to walk.
    pub fn new(repertoire: Arc<Repertoire>) -> Self {
        let horse = Horse::of(repertoire, 0);
        let wants = Wants::default();
        let terrain = Terrain::default();
        let riders = [Some(RiderFrame::of(&horse, Vec3::ZERO)), None];
        Self {
            riders: [Some(Rider { horse, seed: 0, own_gait: None, offset_m: Vec3::ZERO }), None],
            wants,
            rein: HeldRein::default(),
            terrain,
            record: Record::new(Frame { step: 0, wants, terrain, riders }),
            back: 0,
            step: 0,
            carried_s: 0.0,
            is_paused: false,
            rate: 1.0,
        }
    }

    /// What is asked for now.
    pub fn wants(&self) -> &Wants {
        &self.wants
    }

    /// The moment that is shown.
    pub fn shown(&self) -> &Frame {
        self.record.back(self.back)
    }

    /// The record.
    pub fn record(&self) -> &Record {
        &self.record
    }

    /// Steps from the newest moment back to the one that is shown.
    pub fn back(&self) -> usize {
        self.back
    }

    /// Whether time stands.
    pub fn is_paused(&self) -> bool {
        self.is_paused
    }

    /// Whether there is a horse B.
    pub fn has_second(&self) -> bool {
        self.riders[1].is_some()
    }

    /// The gait that a horse keeps whatever is asked for, and its seed.
    pub fn own(&self, which: Which) -> (Option<Gait>, u64) {
        self.riders[which.index()].as_ref().map_or((None, 0), |rider| (rider.own_gait, rider.seed))
    }

    /// Stops time, or lets it go on: through what is recorded first, when an earlier moment is shown.
    pub fn pause(&mut self, is_paused: bool) {
        (self.is_paused, self.carried_s) = (is_paused, 0.0);
    }

    /// Takes an order. From an earlier moment the ride goes on from there, and what came after it is forgotten.
    pub fn give(&mut self, order: Order) {
        self.ride_on_from_here();
        self.wants.take(order, self.newest_heading_rad());
    }

    /// Says which rein is held down, after some seconds more.
    pub fn hold_rein(&mut self, side: Option<Side>, passed_s: f64) {
        let turn = self.rein.hold(side, passed_s, self.newest_heading_rad());
        if let Some(turn) = turn {
            self.give(Order::Turn(turn));
        }
    }

    /// Whether a rein is held down.
    pub fn holds_rein(&self) -> bool {
        self.rein.is_down()
    }

    fn newest_heading_rad(&self) -> f64 {
        self.riders[0].as_ref().map_or(0.0, |rider| rider.horse.readout().heading_rad)
    }

    /// Lets real time pass, seconds.
    pub fn advance(&mut self, passed_s: f64) {
        if self.is_paused || passed_s.is_nan() {
            return;
        }
        self.carried_s += passed_s.clamp(0.0, LONGEST_S) * self.rate.clamp(0.0, 1.0);
        while self.carried_s > STEP_S - ROUNDING_S {
            self.carried_s -= STEP_S;
            self.move_on();
        }
    }

    /// One step on, through the record or beyond it.
    fn move_on(&mut self) {
        match self.back {
            0 => self.take_step(),
            _ => self.back -= 1,
        }
    }

    fn take_step(&mut self) {
        for rider in self.riders.iter_mut().flatten() {
            rider.step(&self.wants, STEP_S as f32, &self.terrain);
        }
        self.step += 1;
        self.record.push(self.frame());
        self.wants.leaps = false;
    }

    fn frame(&self) -> Frame {
        let frame = |rider: &Rider| RiderFrame::of(&rider.horse, rider.offset_m);
        let riders = [0, 1].map(|i: usize| self.riders[i].as_ref().map(frame));
        Frame { step: self.step, wants: self.wants, terrain: self.terrain, riders }
    }

    /// Stops time one step later.
    pub fn step_forward(&mut self) {
        self.pause(true);
        self.move_on();
    }

    /// Stops time one step earlier.
    pub fn step_back(&mut self) {
        self.go_back(self.back + 1);
    }

    /// Stops time so many steps before the newest moment.
    pub fn go_back(&mut self, steps: usize) {
        self.pause(true);
        self.back = steps.min(self.record.depth());
    }

    /// Makes the moment that is shown the newest.
    pub fn ride_on_from_here(&mut self) {
        if self.back == 0 {
            return;
        }
        self.record.forget_newest(self.back);
        self.back = 0;
        let frame = self.record.back(0).clone();
        for (rider, kept) in self.riders.iter_mut().zip(frame.riders) {
            *rider = match (rider.take(), kept) {
                (Some(mut rider), Some(kept)) => {
                    if !Arc::ptr_eq(rider.horse.repertoire(), &kept.repertoire) {
                        rider.horse = Horse::of(kept.repertoire, rider.seed);
                    }
                    rider.horse.restore(&kept.state);
                    rider.offset_m = kept.offset_m;
                    Some(rider)
                }
                // Horse B came later, or has gone: it is as it is.
                (rider, _) => rider,
            };
        }
        (self.step, self.terrain, self.wants) = (frame.step, frame.terrain, frame.wants);
        self.wants.leaps = false;
    }

    /// Lets another ground begin around horse A.
    pub fn set_shape(&mut self, shape: Shape) {
        self.ride_on_from_here();
        let Some(rider) = &self.riders[0] else { return };
        let (at, heading) = (rider.horse.pose().root_in_world, rider.horse.readout().heading_rad);
        self.terrain = self.terrain.changed(shape, [at.x, at.z], heading as f32);
        self.record.replace_newest(self.frame());
    }

    /// Gives a horse another build; it goes on where it is.
    pub fn set_build(&mut self, which: Which, repertoire: Arc<Repertoire>) {
        self.ride_on_from_here();
        let terrain = self.terrain;
        if let Some(rider) = &mut self.riders[which.index()] {
            let state = *rider.horse.state();
            rider.horse = Horse::of(repertoire, rider.seed);
            rider.horse.restore(&state);
            rider.step(&self.wants, POSED_S, &terrain);
        }
        self.record.replace_newest(self.frame());
    }

    /// The motion a horse draws from.
    pub fn repertoire(&self, which: Which) -> Option<&Arc<Repertoire>> {
        self.riders[which.index()].as_ref().map(|rider| rider.horse.repertoire())
    }

    /// Lets a horse keep a gait; none lets it do what is asked for.
    pub fn set_own_gait(&mut self, which: Which, gait: Option<Gait>) {
        self.ride_on_from_here();
        if let Some(rider) = &mut self.riders[which.index()] {
            rider.own_gait = gait;
        }
    }

    /// Gives a horse another seed: what it chooses where it has a choice, from the next beginning on.
    pub fn set_seed(&mut self, which: Which, seed: u64) {
        if let Some(rider) = &mut self.riders[which.index()] {
            rider.seed = seed;
        }
    }

    /// Puts horse B beside A in A's stride, a new one of A's build where there is none.
    pub fn bring_second(&mut self) {
        self.ride_on_from_here();
        let Some(first) = &self.riders[0] else { return };
        let heading = first.horse.readout().heading_rad as f32;
        let offset_m = -BESIDE_M * Vec3::new(heading.sin(), 0.0, heading.cos());
        let (repertoire, state) = (Arc::clone(first.horse.repertoire()), *first.horse.state());
        let (wants, terrain) = (self.wants, self.terrain);
        let second = self.riders[1].get_or_insert_with(|| Rider {
            horse: Horse::of(repertoire, 1),
            seed: 1,
            own_gait: None,
            offset_m,
        });
        second.offset_m = offset_m;
        second.horse.restore(&state);
        second.step(&wants, POSED_S, &terrain);
        self.record.replace_newest(self.frame());
    }

    /// Takes horse B away.
    pub fn take_second_away(&mut self) {
        self.ride_on_from_here();
        self.riders[1] = None;
        self.record.replace_newest(self.frame());
    }

    /// Begins again: the same horses and ground at the origin, standing, asked to walk.
    pub fn reset(&mut self) {
        let size = Wants { leap: self.wants.leap, ..Wants::default() };
        (self.wants, self.rein, self.back, self.step, self.carried_s) =
            (size, HeldRein::default(), 0, 0, 0.0);
        self.terrain = Terrain::default().changed(self.terrain.shape, [0.0; 2], 0.0);
        let beside = Vec3::new(0.0, 0.0, -BESIDE_M);
        for (rider, offset_m) in self.riders.iter_mut().zip([Vec3::ZERO, beside]) {
            if let Some(rider) = rider {
                rider.offset_m = offset_m;
                rider.begin(&self.terrain);
            }
        }
        self.record = Record::new(self.frame());
    }

    /// A horse's joints as they are shown: between two steps while time passes, so that slow motion is smooth.
    pub fn joints(&self, which: Which) -> Option<Joints> {
        let now = self.record.back(self.back).riders[which.index()].as_ref()?.joints;
        let before = self.record.back(self.back + 1).riders[which.index()].as_ref().map(|r| r.joints);
        let share = (self.carried_s / STEP_S).clamp(0.0, 1.0) as f32;
        match before {
            Some(before) if !self.is_paused && before.root.distance(now.root) < PUT_M => {
                Some(mixed(&before, &now, share))
            }
            _ => Some(now),
        }
    }

    /// A horse's heading as it is shown, radians, between two steps like its joints.
    pub fn heading_rad(&self, which: Which) -> Option<f64> {
        let now = self.record.back(self.back).riders[which.index()].as_ref()?.readout.heading_rad;
        let before = self.record.back(self.back + 1).riders[which.index()].as_ref();
        let share = if self.is_paused { 1.0 } else { (self.carried_s / STEP_S).clamp(0.0, 1.0) };
        Some(before.map_or(now, |before| before.readout.heading_rad * (1.0 - share) + now * share))
    }

    /// Where a horse's toe was in the last seconds before the moment that is shown, oldest first.
    pub fn trace(&self, which: Which, limb: Limb, seconds: f64) -> Vec<Vec3> {
        let steps = (seconds / STEP_S) as usize;
        let frames = self.record.between(self.back + steps, self.back);
        let toes = frames.filter_map(|frame| Some(frame.riders[which.index()].as_ref()?.joints.toe(limb)));
        let mut trace: Vec<Vec3> = Vec::with_capacity(steps + 1);
        for toe in toes {
            if trace.last().is_some_and(|last| last.distance(toe) > PUT_M) {
                trace.clear();
            }
            trace.push(toe);
        }
        trace
    }
}

fn mixed(a: &Joints, b: &Joints, share: f32) -> Joints {
    let mix = |a: Vec3, b: Vec3| a.lerp(b, share);
    Joints {
        root: mix(a.root, b.root),
        dock: mix(a.dock, b.dock),
        bases: std::array::from_fn(|i| mix(a.bases[i], b.bases[i])),
        tips: std::array::from_fn(|i| mix(a.tips[i], b.tips[i])),
    }
}

/// A figure's joints moved so that its trunk is over another's; its height above its own ground stays.
pub fn moved_over(joints: &Joints, to: &Joints) -> Joints {
    let middle = |joints: &Joints| (joints.root + joints.tips[bone::SPINE_LAST]) / 2.0;
    shifted(joints, (middle(to) - middle(joints)).with_y(0.0))
}

/// Joints moved by a way, metres.
fn shifted(joints: &Joints, by: Vec3) -> Joints {
    Joints {
        root: joints.root + by,
        dock: joints.dock + by,
        bases: joints.bases.map(|at| at + by),
        tips: joints.tips.map(|at| at + by),
    }
}

#[cfg(test)]
mod tests;
