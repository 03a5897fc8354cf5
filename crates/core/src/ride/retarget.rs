//! A stride of the database made ready for a skeleton of any proportions (spec 6.5; Huang 2012, Eq. 3.3 and 3.4).
//!
//! Each toe's path relative to its shoulder or hip is scaled by the ratio of leg lengths, times by the square root of that ratio: equal
//! Froude numbers. The trunk is as high over the ground as its legs ask for; in a suspension it flies as a thrown body.
//! Every leg is then solved anew. Where one cannot reach, the body is lowered.

use std::ops::Range;

use super::clip::{Clip, Row, body, leg};
use super::rig::{Aim, LegBends, LegRig, Rig};
use crate::limb::{Limb, Pair};
use crate::pose::Pose;
use crate::skeleton::Skeleton;
use crate::stride::{CURVE_SAMPLES, Stride};

/// Acceleration of free fall, m/s^2.
pub(super) const GRAVITY_M_S2: f32 = 9.81;
/// A standing toe farther than this from its place makes the body give way, metres.
const REACH_TOLERANCE_M: f32 = 2e-4;
/// Rounds of lowering the body; each takes away what the worst leg lacks and a little more.
const LOWERING_ROUNDS: usize = 12;
/// How much more than what is lacking the body is lowered: a leg that slants gains less than the body falls.
const LOWERING: f32 = 1.3;
/// Share of the swing, at either end, over which a leg's load fades.
pub(super) const EASING: f32 = 0.12;
/// Share of the way towards the pitch that the new legs' lengths ask for; the rest the legs take up.
const PITCH_SHARE: f32 = 0.5;

/// From 0 to 1 without a slope at either end.
pub(super) fn smooth(t: f32) -> f32 {
    let t = t.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// A stride on another skeleton; none where a leg cannot reach the ground.
pub(super) fn retarget(stride: &Stride, reference: &Skeleton, rig: &Rig) -> Option<Clip> {
    let old = Rig::new(&stride.skeleton(reference));
    let scale = Scale::new(&old, rig);
    let mut captured: Vec<Moment> =
        (0..CURVE_SAMPLES).map(|k| Moment::new(stride, &old, sample_phase(k))).collect();
    let stride_time_s = stride.stride_time_s * scale.mean.sqrt();
    place_trunk(&mut captured, rig, &scale);
    fly(&mut captured, stride, stride_time_s);
    let paths = Limb::ALL.map(|limb| ToePath::new(&captured, stride, rig, limb, &scale));
    for _ in 0..LOWERING_ROUNDS {
        let (rows, lacking_m) = solve(&captured, rig, &paths);
        if lacking_m < REACH_TOLERANCE_M {
            let speed_m_s = stride.speed_m_s * scale.mean.sqrt();
            let prints_m = paths.each_ref().map(|path| path.print_m);
            return Some(Clip::new([speed_m_s, stride_time_s], &stride.contacts, prints_m, &rows));
        }
        captured.iter_mut().for_each(|moment| moment.pose.root_in_world.y -= LOWERING * lacking_m);
    }
    None
}

fn sample_phase(k: usize) -> f32 {
    k as f32 / CURVE_SAMPLES as f32
}

/// New leg lengths over old ones.
struct Scale {
    pairs: [f32; 2],
    mean: f32,
}

impl Scale {
    fn new(old: &Rig, new: &Rig) -> Self {
        let ratio = |limb: Limb| new.legs[limb.index()].length_m() / old.legs[limb.index()].length_m();
        let pairs = [ratio(Limb::LF), ratio(Limb::LH)];
        Self { pairs, mean: 0.5 * (pairs[0] + pairs[1]) }
    }

    fn of(&self, limb: Limb) -> f32 {
        self.pairs[limb.pair() as usize]
    }
}

/// A moment of the captured stride.
struct Moment {
    /// The pose, with the root against the uniform advance.
    pose: Pose,
    /// Toe seen from its shoulder or hip, along the track and upwards, metres.
    toes_m: [[f32; 2]; 4],
    /// Height of shoulders and hips over the ground, metres.
    joints_m: [f32; 4],
    /// Height of the toes over the ground, metres.
    heights_m: [f32; 4],
}

impl Moment {
    fn new(stride: &Stride, rig: &Rig, phase: f32) -> Self {
        let mut pose = stride.pose(phase);
        pose.root_in_world.x -= stride.stride_length_m() * phase;
        let girdles = rig.girdles(&pose);
        let world = |point: glam::Vec3| pose.root_in_world + pose.world_from_root * point;
        let joints = girdles.map(|girdle| world(girdle.joint));
        let toes = Limb::ALL
            .map(|limb| world(rig.legs[limb.index()].toe(&girdles[limb.index()], &leg_bends(&pose, limb))));
        Self {
            pose,
            toes_m: std::array::from_fn(|i| [toes[i].x - joints[i].x, toes[i].y - joints[i].y]),
            joints_m: joints.map(|joint| joint.y),
            heights_m: toes.map(|toe| toe.y),
        }
    }
}

/// A pose's bends of a leg below its first bone.
pub(super) fn leg_bends(pose: &Pose, limb: Limb) -> LegBends {
    let first = limb.first_bone() + 1;
    std::array::from_fn(|i| pose.bends_rad[first + i])
}

/// Mean over the stride of how much higher a pair's joints should be than they are.
fn wanted_m(moments: &[Moment], rig: &Rig, scale: &Scale, pair: Pair) -> f32 {
    let mut sum = 0.0;
    for moment in moments {
        let girdles = rig.girdles(&moment.pose);
        for limb in Limb::ALL.into_iter().filter(|limb| limb.pair() == pair) {
            let joint = moment.pose.root_in_world + moment.pose.world_from_root * girdles[limb.index()].joint;
            sum += scale.of(limb) * moment.joints_m[limb.index()] - joint.y;
        }
    }
    sum / (2 * moments.len()) as f32
}

/// Sets the root's height and pitch so that shoulders and hips are as high as their legs ask for.
fn place_trunk(moments: &mut [Moment], rig: &Rig, scale: &Scale) {
    for moment in moments.iter_mut() {
        moment.pose.root_in_world.y *= scale.mean;
        moment.pose.root_in_world.x *= scale.mean;
    }
    let (fore, hind) = (wanted_m(moments, rig, scale, Pair::Fore), wanted_m(moments, rig, scale, Pair::Hind));
    let pitch = glam::Quat::from_rotation_z(PITCH_SHARE * (fore - hind) / rig.trunk_m);
    moments.iter_mut().for_each(|moment| moment.pose.world_from_root *= pitch);
    let both = 0.5 * (wanted_m(moments, rig, scale, Pair::Fore) + wanted_m(moments, rig, scale, Pair::Hind));
    moments.iter_mut().for_each(|moment| moment.pose.root_in_world.y += both);
}

/// Lets the root fly as a thrown body in every suspension, and bends its height in the supports between them so that its speed has no
/// step at take-off and landing.
fn fly(moments: &mut [Moment], stride: &Stride, stride_time_s: f32) {
    let suspended: Vec<bool> =
        (0..CURVE_SAMPLES).map(|k| !stride.support(sample_phase(k)).contains(&true)).collect();
    let flights = runs(&suspended);
    let heights: Vec<f32> = moments.iter().map(|moment| moment.pose.root_in_world.y).collect();
    let at = |k: usize| heights[k % CURVE_SAMPLES];
    let slope = |k: usize| 0.5 * (at(k + 1) - at(k + CURVE_SAMPLES - 1));
    let fall = 0.5 * GRAVITY_M_S2 * (stride_time_s / CURVE_SAMPLES as f32).powi(2);
    for (i, flight) in flights.iter().enumerate() {
        // From the last sample of the support before to the first of the one after.
        let (start, end) = (flight.start + CURVE_SAMPLES - 1, flight.end + CURVE_SAMPLES);
        let length = (end - start) as f32;
        let thrown = |k: usize| {
            let (since, left) = ((k - start) as f32, (end - k) as f32);
            (at(start) * left + at(end) * since) / length + fall * since * left
        };
        for k in start..end {
            moments[k % CURVE_SAMPLES].pose.root_in_world.y = thrown(k);
        }
        let rise = (at(end) - at(start)) / length;
        let [leaving, arriving] = [rise + fall * length, rise - fall * length];
        let next =
            flights[(i + 1) % flights.len()].start + if i + 1 == flights.len() { CURVE_SAMPLES } else { 0 };
        let before = flights[(i + flights.len() - 1) % flights.len()].end;
        let after = (flight.end..next).len() as f32;
        let ahead = (flight.start + CURVE_SAMPLES - before) % CURVE_SAMPLES;
        for n in 0..=(next - flight.end) {
            let t = n as f32 / after;
            let bump = (arriving - slope(flight.end)) * after * t * (1.0 - t).powi(2);
            moments[(flight.end + n) % CURVE_SAMPLES].pose.root_in_world.y += bump;
        }
        for n in 0..=ahead {
            let t = n as f32 / ahead as f32;
            let k = flight.start + CURVE_SAMPLES - 1 - n;
            let bump = -(leaving - slope(start)) * ahead as f32 * t * (1.0 - t).powi(2);
            moments[k % CURVE_SAMPLES].pose.root_in_world.y += bump;
        }
    }
}

/// The runs of true in a ring, each from its first to after its last; a run through the ring's end ends beyond it.
fn runs(ring: &[bool]) -> Vec<Range<usize>> {
    let n = ring.len();
    let starts = (0..n).filter(|&k| ring[k] && !ring[(k + n - 1) % n]);
    starts.map(|start| start..(start..start + n).find(|&k| !ring[k % n]).unwrap_or(start + n)).collect()
}

/// Where a toe is to be at each sample, against the uniform advance.
struct ToePath {
    limb: Limb,
    /// Along the track and over the ground, metres.
    places_m: Vec<[f32; 2]>,
    loads: Vec<f32>,
    /// Place of the standing toe at the middle of the stance, metres.
    print_m: f32,
}

impl ToePath {
    fn new(captured: &[Moment], stride: &Stride, rig: &Rig, limb: Limb, scale: &Scale) -> Self {
        let contact = stride.contacts[limb.index()];
        let (strike, duty) = (contact.strike_phase, contact.duty_factor());
        let length_m = stride.stride_length_m() * scale.mean;
        // By similar triangles alone.
        let similar: Vec<[f32; 2]> = captured
            .iter()
            .map(|moment| {
                let joint = moment.pose.world_from_root * rig.girdles(&moment.pose)[limb.index()].joint;
                let ahead =
                    moment.pose.root_in_world.x + joint.x + scale.mean * moment.toes_m[limb.index()][0];
                [ahead, scale.mean * moment.heights_m[limb.index()]]
            })
            .collect();
        let at = |phase: f32| sample_ring(&similar, phase);
        let print_m = at(strike + 0.5 * duty)[0];
        let standing = |since: f32| [print_m - length_m * (since - 0.5 * duty), 0.0];
        let misses = [duty, 1.0].map(|since| {
            let (path, wanted) = (at(strike + since), standing(if since < 1.0 { duty } else { 0.0 }));
            [wanted[0] - path[0], wanted[1] - path[1]]
        });
        let mut loads = Vec::with_capacity(CURVE_SAMPLES);
        let places_m = (0..CURVE_SAMPLES)
            .map(|k| {
                let since = (sample_phase(k) - strike).rem_euclid(1.0);
                if since <= duty {
                    loads.push(1.0);
                    return standing(since);
                }
                let share = (since - duty) / (1.0 - duty);
                loads.push(1.0 - smooth(share.min(1.0 - share) / EASING));
                let [early, late] = [smooth(1.0 - share), smooth(share)];
                let [x, y] =
                    [0, 1].map(|axis| similar[k][axis] + early * misses[0][axis] + late * misses[1][axis]);
                [x, y.max(0.0)]
            })
            .collect();
        Self { limb, places_m, loads, print_m }
    }
}

/// A ring of samples between two of them, linearly.
fn sample_ring(ring: &[[f32; 2]], phase: f32) -> [f32; 2] {
    let at = phase.rem_euclid(1.0) * ring.len() as f32;
    let i = at as usize;
    let t = at - i as f32;
    let (a, b) = (ring[i % ring.len()], ring[(i + 1) % ring.len()]);
    [0, 1].map(|axis| a[axis] + t * (b[axis] - a[axis]))
}

/// Solves all legs at all samples; returns the rows and what the worst standing leg lacks, metres.
fn solve(captured: &[Moment], rig: &Rig, paths: &[ToePath; 4]) -> (Vec<Row>, f32) {
    let mut rows: Vec<Row> = captured.iter().map(|moment| body_row(&moment.pose)).collect();
    let mut lacking_m = 0.0f32;
    for path in paths {
        let leg_rig = &rig.legs[path.limb.index()];
        for (k, moment) in captured.iter().enumerate() {
            let (row, miss_m) = solve_leg(moment, rig, leg_rig, path, k);
            rows[k].legs[path.limb.index()] = row;
            if path.loads[k] >= 1.0 {
                lacking_m = lacking_m.max(miss_m);
            }
        }
    }
    (rows, lacking_m)
}

fn body_row(pose: &Pose) -> Row {
    let mut row = Row::default();
    row.body[..8].copy_from_slice(&pose.bends_rad[..8]);
    row.body[body::HEIGHT] = pose.root_in_world.y;
    row.body[body::PITCH] = 2.0 * pose.world_from_root.z.atan2(pose.world_from_root.w);
    row.body[body::SURGE] = pose.root_in_world.x;
    row
}

fn solve_leg(moment: &Moment, rig: &Rig, leg_rig: &LegRig, path: &ToePath, k: usize) -> ([f32; 8], f32) {
    let (limb, pose) = (path.limb, &moment.pose);
    let girdle = rig.girdles(pose)[limb.index()];
    let [x, y] = path.places_m[k];
    let world = glam::Vec3::new(x, y, 0.0) - pose.root_in_world;
    let toe = (pose.world_from_root.inverse() * world).with_z(leg_rig.toe_lateral_m);
    let aim = Aim { toe, hoof_turn_rad: 0.0, load: path.loads[k], keeps_hoof: 0.0 };
    let reached = leg_rig.solve(&girdle, &leg_bends(pose, limb), &aim);
    let there = pose.root_in_world + pose.world_from_root * leg_rig.toe(&girdle, &reached.bends_rad);
    let mut row = [0.0; 8];
    row[0] = pose.bends_rad[limb.first_bone()];
    row[1..5].copy_from_slice(&reached.bends_rad);
    row[leg::SLIDE] = pose.scapula_slides_m.get(limb.index()).copied().unwrap_or(0.0);
    (row[leg::TOE_AHEAD], row[leg::TOE_HEIGHT]) = (there.x, there.y);
    (row, reached.miss_m)
}
