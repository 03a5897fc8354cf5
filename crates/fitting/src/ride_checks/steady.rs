//! A horse in a steady gait, and one stride of it as a [`Stride`], to be judged as the database's own strides are.

use std::sync::Arc;

use muybridge_core::{
    BONE_COUNT, CURVE_SAMPLES, Command, Contact, Curves, FlatGround, Gait, Horse, Lead, Limb, Pose,
    Provenance, Readout, Repertoire, Side, Skeleton, Stride,
};

use super::findings::Findings;
use super::inspector::Inspector;

/// Steps while the horse settles, s.
const SETTLE_STEP_S: f32 = 1.0 / 120.0;
/// Time that the wanted gait must have gone on unchanged before it is called steady, s.
const UNCHANGED_S: f64 = 4.0;
/// Time after which it is given up, s.
const PATIENCE_S: f64 = 60.0;
/// The speed may still differ by this share: it is judged elsewhere.
const SPEED_SHARE: f64 = 0.05;
/// Steps between two samples of a recorded stride.
const STEPS_PER_SAMPLE: usize = 4;
/// Halvings of a step to find an instant: 2 ms over a million.
const HALVINGS: usize = 20;
/// A strike this near the end of the recorded stride is the next stride's.
const NEXT_STRIDE: f64 = 0.99;
/// Longest wait for a strike, s: the slowest walk's stride lasts 2.3.
const LONGEST_STRIDE_S: f64 = 6.0;

/// What a steady gait is asked for with.
pub fn command(gait: Option<Gait>, speed_m_s: f64, lead: Option<Side>) -> Command {
    Command { speed_m_s: speed_m_s as f32, gait, lead, ..Command::default() }
}

/// Rides a new horse along X on the flat until it goes steadily as commanded.
///
/// # Errors
/// When it does not, in plain words.
pub fn settled(repertoire: &Arc<Repertoire>, command: &Command, seed: u64) -> Result<Horse, String> {
    let mut horse = Horse::of(Arc::clone(repertoire), seed);
    let (mut time_s, mut unchanged_s) = (0.0, 0.0);
    while time_s < PATIENCE_S {
        horse.step(command, SETTLE_STEP_S, &FlatGround);
        time_s += f64::from(SETTLE_STEP_S);
        let seen = horse.readout();
        let speed_off = (seen.speed_m_s / command.speed_m_s - 1.0).abs();
        let as_wanted = command.gait.is_none_or(|gait| gait == seen.gait)
            && seen.change.is_none()
            && !seen.is_standing
            && f64::from(speed_off) < SPEED_SHARE;
        unchanged_s = if as_wanted { unchanged_s + f64::from(SETTLE_STEP_S) } else { 0.0 };
        if unchanged_s > UNCHANGED_S {
            return Ok(horse);
        }
    }
    let seen = horse.readout();
    let change =
        seen.change.map_or("no change".into(), |c| format!("changing from {} ({:.2})", c.from, c.share));
    Err(format!(
        "asked for {:?} at {:.2} m/s it goes no steady gait in {PATIENCE_S:.0} s: {} at {:.2} m/s, {change}",
        command.gait, command.speed_m_s, seen.gait, seen.speed_m_s
    ))
}

/// Steps on to just after an event, found by halving the step; returns the time that passed, none if it does not come in time.
pub fn step_to(
    horse: &mut Horse,
    command: &Command,
    step_s: f32,
    is_past: impl Fn(&Readout, &Readout) -> bool,
) -> Option<f64> {
    let mut time_s = 0.0;
    while time_s < LONGEST_STRIDE_S {
        let before = horse.readout();
        let mut next = horse.clone();
        next.step(command, step_s, &FlatGround);
        if is_past(&before, &next.readout()) {
            let (mut low, mut high) = (0.0, step_s);
            for _ in 0..HALVINGS {
                let middle = 0.5 * (low + high);
                let mut tried = horse.clone();
                tried.step(command, middle, &FlatGround);
                if is_past(&before, &tried.readout()) { high = middle } else { low = middle }
            }
            horse.step(command, high, &FlatGround);
            return Some(time_s + f64::from(high));
        }
        *horse = next;
        time_s += f64::from(step_s);
    }
    None
}

/// Whether a leg struck between two readouts: its cycle began anew.
pub fn struck(limb: Limb) -> impl Fn(&Readout, &Readout) -> bool {
    let leg = limb.index();
    move |before, after| after.leg_cycles[leg] < before.leg_cycles[leg]
}

/// Steps on to the next strike of the left hind; returns the time that passed.
///
/// # Errors
/// When it does not strike.
pub fn step_to_strike(horse: &mut Horse, command: &Command) -> Result<f64, String> {
    step_to(horse, command, SETTLE_STEP_S, struck(Limb::LH))
        .ok_or_else(|| "the left hind does not strike".to_string())
}

/// A recorded stride, and how far the horse was from moving in planes along its track.
#[derive(Clone, Debug)]
pub struct Recorded {
    /// The stride.
    pub stride: Stride,
    /// Greatest turn, roll or sideways swing of anything, rad: zero in a horse that goes straight on.
    pub sideways_rad: f64,
    /// What the inspector saw, four times as often as it was sampled.
    pub findings: Findings,
    /// The bone whose bend differs most one stride later, and by how much, rad: zero in a steady gait.
    pub unsteady: (usize, f64),
}

/// Records one stride of a horse that goes steadily along its heading on the flat.
///
/// # Errors
/// When it takes no whole stride, or a leg strikes or leaves more or less than once.
pub fn record(
    horse: &Horse,
    command: &Command,
    id: &str,
    provenance: Provenance,
) -> Result<Recorded, String> {
    let mut horse = horse.clone();
    step_to_strike(&mut horse, command)?;
    let mut ahead = horse.clone();
    let step_s = step_to_strike(&mut ahead, command)? / (CURVE_SAMPLES * STEPS_PER_SAMPLE) as f64;
    // One stride in the steps of the recording first: what follows the feet with a lag depends a little on the step.
    let on = |horse: &mut Horse| {
        step_to(horse, command, step_s as f32, struck(Limb::LH)).ok_or("the left hind does not strike")
    };
    on(&mut horse)?;
    let mut ahead = horse.clone();
    let stride_time_s = on(&mut ahead)?;
    let mut recorder = Recorder::new(&horse, &ahead, stride_time_s);
    let start_rad = horse.pose().bends_rad;
    let mut inspector = Inspector::new(horse.skeleton());
    let step_s = stride_time_s / (CURVE_SAMPLES * STEPS_PER_SAMPLE) as f64;
    for step in 0..CURVE_SAMPLES * STEPS_PER_SAMPLE {
        if step % STEPS_PER_SAMPLE == 0 {
            recorder.sample(horse.pose(), step as f64 / (CURVE_SAMPLES * STEPS_PER_SAMPLE) as f64);
        }
        let before = horse.clone();
        horse.step(command, step_s as f32, &FlatGround);
        inspector.look(&horse, step_s as f32, &FlatGround);
        recorder.instants(&before, &horse, command, step as f64 * step_s, step_s);
    }
    let (stride, sideways_rad) = recorder.finish(horse.skeleton(), id, provenance)?;
    let changes = horse.pose().bends_rad.into_iter().zip(start_rad).map(|(b, a)| f64::from((b - a).abs()));
    let unsteady = changes.enumerate().max_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or_default();
    Ok(Recorded { stride, sideways_rad, findings: *inspector.findings(), unsteady })
}

/// Collects samples and instants of a stride.
struct Recorder {
    gait: Gait,
    lead: Option<Lead>,
    stride_time_s: f64,
    length_m: f64,
    /// Where the root was at phase 0, and the direction of travel in X and Z.
    start: [f64; 2],
    along: [f64; 2],
    curves: Curves,
    sideways_rad: f64,
    on_at_start: [bool; 4],
    toes_at_start: [f64; 4],
    strikes: [Vec<(f64, f64)>; 4],
    lift_offs: [Vec<f64>; 4],
}

impl Recorder {
    fn new(horse: &Horse, ahead: &Horse, stride_time_s: f64) -> Self {
        let [here, there] = [horse, ahead].map(|h| h.pose().root_in_world);
        let way = [f64::from(there.x) - f64::from(here.x), f64::from(there.z) - f64::from(here.z)];
        let length_m = way[0].hypot(way[1]);
        let along = if length_m > 0.0 { way.map(|w| w / length_m) } else { [1.0, 0.0] };
        let seen = horse.readout();
        let flat = || Vec::with_capacity(CURVE_SAMPLES);
        let curves = Curves {
            surge_m: flat(),
            height_m: flat(),
            pitch_rad: flat(),
            bends_rad: (0..BONE_COUNT).map(|_| flat()).collect(),
            scapula_slides_m: vec![flat(), flat()],
        };
        let mut recorder = Self {
            gait: seen.gait,
            lead: seen.lead.map(|side| Lead { fore: side, hind: side }),
            stride_time_s,
            length_m,
            start: [f64::from(here.x), f64::from(here.z)],
            along,
            curves,
            sideways_rad: 0.0,
            on_at_start: seen.on_ground,
            toes_at_start: [0.0; 4],
            strikes: Default::default(),
            lift_offs: Default::default(),
        };
        recorder.toes_at_start = Limb::ALL.map(|limb| recorder.toe_ahead_m(horse, limb));
        recorder
    }

    /// How far a place is ahead of where the root was at phase 0, m.
    fn ahead_m(&self, x: f64, z: f64) -> f64 {
        (x - self.start[0]) * self.along[0] + (z - self.start[1]) * self.along[1]
    }

    fn toe_ahead_m(&self, horse: &Horse, limb: Limb) -> f64 {
        let mut pose = *horse.pose();
        let root = pose.root_in_world;
        pose.root_in_world = Default::default();
        let toe = pose.joints(horse.skeleton()).toe(limb);
        self.ahead_m(f64::from(root.x) + f64::from(toe.x), f64::from(root.z) + f64::from(toe.z))
    }

    fn sample(&mut self, pose: &Pose, phase: f64) {
        let root = pose.root_in_world;
        let ahead_m = self.ahead_m(f64::from(root.x), f64::from(root.z));
        self.curves.surge_m.push((ahead_m - self.length_m * phase) as f32);
        self.curves.height_m.push(root.y);
        let [pitch, yaw, roll] = angles(pose, self.along);
        self.curves.pitch_rad.push(pitch as f32);
        for (curve, &bend) in self.curves.bends_rad.iter_mut().zip(&pose.bends_rad) {
            curve.push(bend);
        }
        for (curve, &slide) in self.curves.scapula_slides_m.iter_mut().zip(&pose.scapula_slides_m) {
            curve.push(slide);
        }
        let sideways = pose.lateral_bends_rad.iter().chain(&pose.limb_turns_rad).chain(&pose.abductions_rad);
        let greatest = sideways.map(|angle| f64::from(angle.abs())).fold(yaw.abs().max(roll.abs()), f64::max);
        self.sideways_rad = self.sideways_rad.max(greatest);
    }

    /// Strikes and lift-offs between two steps.
    fn instants(&mut self, before: &Horse, after: &Horse, command: &Command, at_s: f64, step_s: f64) {
        let (was, is) = (before.readout().on_ground, after.readout().on_ground);
        for limb in Limb::ALL {
            let leg = limb.index();
            if was[leg] == is[leg] {
                continue;
            }
            let mut there = before.clone();
            let changed = |_: &Readout, now: &Readout| now.on_ground[leg] != was[leg];
            let Some(time_s) = step_to(&mut there, command, step_s as f32, changed) else { continue };
            let phase = (at_s + time_s) / self.stride_time_s;
            if is[leg] {
                self.strikes[leg].push((phase, self.toe_ahead_m(&there, limb)));
            } else {
                self.lift_offs[leg].push(phase);
            }
        }
    }

    /// The stride, and the greatest angle out of its plane.
    fn finish(
        mut self,
        skeleton: &Skeleton,
        id: &str,
        provenance: Provenance,
    ) -> Result<(Stride, f64), String> {
        let mut contacts = [Contact { strike_phase: 0.0, lift_off_phase: 0.0 }; 4];
        let mut prints_m = [0.0; 4];
        for limb in Limb::ALL {
            let leg = limb.index();
            // What strikes with the left hind strikes at phase 0.
            let strikes = &mut self.strikes[leg];
            strikes.retain(|strike| strike.0 < NEXT_STRIDE || !self.on_at_start[leg]);
            if strikes.is_empty() && self.on_at_start[leg] {
                strikes.push((0.0, self.toes_at_start[leg]));
            }
            let ([(strike, print_m)], [lift_off]) = (&strikes[..], &self.lift_offs[leg][..]) else {
                let (down, up) = (strikes.len(), self.lift_offs[leg].len());
                return Err(format!("{id}: {} strikes {down} and leaves {up} times", limb.abbreviation()));
            };
            contacts[leg] = Contact {
                strike_phase: strike.rem_euclid(1.0) as f32,
                lift_off_phase: lift_off.rem_euclid(1.0) as f32,
            };
            prints_m[leg] = *print_m as f32;
        }
        let stride = Stride {
            id: id.into(),
            gait: self.gait,
            lead: self.lead,
            speed_m_s: (self.length_m / self.stride_time_s) as f32,
            stride_time_s: self.stride_time_s as f32,
            withers_height_m: skeleton.withers_height_m,
            bone_lengths_m: skeleton.bones.iter().map(|bone| bone.length_m).collect(),
            contacts,
            prints_m,
            curves: self.curves,
            provenance,
        };
        Ok((stride, self.sideways_rad))
    }
}

/// Pitch (nose up), yaw against a direction of travel (X and Z), and roll of a pose's root, rad.
fn angles(pose: &Pose, along: [f64; 2]) -> [f64; 3] {
    let q = pose.world_from_root;
    let [x, y, z, w] = [q.x, q.y, q.z, q.w].map(f64::from);
    // The root's X axis, and the height of its Z axis, in the world.
    let nose = [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y)];
    let right_y = 2.0 * (y * z - w * x);
    let ahead = nose[0] * along[0] + nose[2] * along[1];
    let aside = nose[0] * along[1] - nose[2] * along[0];
    [nose[1].atan2(ahead.hypot(aside)), aside.atan2(ahead), right_y.clamp(-1.0, 1.0).asin()]
}

#[cfg(test)]
mod tests {
    use glam::Quat;

    use super::*;

    #[test]
    fn pitch_yaw_and_roll_are_told_apart() {
        let pose = |q: Quat| Pose { world_from_root: q, ..Pose::default() };
        let [pitch, yaw, roll] = angles(&pose(Quat::from_rotation_z(0.2)), [1.0, 0.0]);
        assert!((pitch - 0.2).abs() < 1e-6 && yaw.abs() < 1e-6 && roll.abs() < 1e-6);
        let [pitch, yaw, roll] = angles(&pose(Quat::from_rotation_y(0.2)), [1.0, 0.0]);
        assert!(pitch.abs() < 1e-6 && (yaw.abs() - 0.2).abs() < 1e-6 && roll.abs() < 1e-6);
        // Along a heading of 0.2 the same horse goes straight on.
        let along = [0.2f64.cos(), -(0.2f64.sin())];
        assert!(angles(&pose(Quat::from_rotation_y(0.2)), along)[1].abs() < 1e-6);
        let [pitch, yaw, roll] = angles(&pose(Quat::from_rotation_x(0.2)), [1.0, 0.0]);
        assert!(pitch.abs() < 1e-6 && yaw.abs() < 1e-6 && (roll.abs() - 0.2).abs() < 1e-6);
    }
}
