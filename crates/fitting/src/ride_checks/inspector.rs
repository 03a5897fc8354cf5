//! A look at every step of a horse.

use muybridge_core::{BONE_COUNT, Ground, Horse, Joints, Limb, Pose, Readout, Skeleton};

use super::findings::{Findings, Part, Quantity, ROOT_ACCELERATION_M_S2, TOE_SPEED_FACTOR};

/// Shorter steps are added to the next one before speeds are worked out, s: rounding over less time is no speed.
const SHORTEST_STEP_S: f64 = 1e-3;
/// The horse takes no longer step than this, s.
const LONGEST_STEP_S: f64 = 0.25;
/// After a longer step a standing leg may have left the ground and come back between two looks, s (the shortest swing lasts 0.3).
const SWING_MISSED_S: f64 = 0.1;
/// Joints higher than this over the ground under the feet are not tried against the ground, m.
const NEAR_GROUND_M: f64 = 0.35;
/// Edge of a step: where a toe disagrees with the ground, the ground this far beside it counts as well, m.
const EDGE_M: f64 = 5e-4;
/// Disagreement that is looked into, m.
const DISAGREEMENT_M: f64 = 1e-3;

/// A place in the world, m.
type Place = [f64; 3];

/// Looks at every step of one horse and keeps the worst of each quantity. Allocates nothing after it is made.
#[derive(Clone, Debug)]
pub struct Inspector {
    skeleton: Skeleton,
    lengths_m: [f64; BONE_COUNT],
    limits_rad: [[f64; 2]; BONE_COUNT],
    reach_m: [f64; 4],
    stances: [Option<Place>; 4],
    cycles: [f32; 4],
    before: Option<Frame>,
    rates: Option<Rates>,
    findings: Findings,
}

/// What one step is compared with.
#[derive(Clone, Copy, Debug)]
struct Frame {
    at_s: f64,
    root: Place,
    toes: [Place; 4],
    bends_rad: [f32; BONE_COUNT],
}

/// Speeds between the two steps before.
#[derive(Clone, Copy, Debug)]
struct Rates {
    over_s: f64,
    root_m_s: Place,
    bends_rad_s: [f32; BONE_COUNT],
}

impl Inspector {
    /// An inspector for horses of a build.
    pub fn new(skeleton: &Skeleton) -> Self {
        let mut lengths_m = [0.0; BONE_COUNT];
        for (index, (length, bone)) in lengths_m.iter_mut().zip(&skeleton.bones).enumerate() {
            let is_leg_root = Limb::ALL.iter().any(|limb| limb.first_bone() == index);
            let parent_m = match bone.parent {
                Some(parent) if !is_leg_root => skeleton.bones[parent].lateral_m,
                _ => 0.0,
            };
            *length = f64::from(bone.length_m).hypot(f64::from(bone.lateral_m - parent_m));
        }
        let mut limits_rad = [[0.0; 2]; BONE_COUNT];
        for (limits, bone) in limits_rad.iter_mut().zip(&skeleton.bones) {
            *limits = bone.limits_rad.map(f64::from);
        }
        let reach_m = Limb::ALL.map(|limb| lengths_m[limb.first_bone()..=limb.hoof_bone()].iter().sum());
        Self {
            skeleton: skeleton.clone(),
            lengths_m,
            limits_rad,
            reach_m,
            stances: [None; 4],
            cycles: [0.0; 4],
            before: None,
            rates: None,
            findings: Findings::default(),
        }
    }

    /// Looks at a horse after a step of `dt_s`.
    pub fn look(&mut self, horse: &Horse, dt_s: f32, ground: &impl Ground) {
        self.inspect(horse.pose(), &horse.readout(), dt_s, ground);
    }

    /// Looks at a pose and what the horse says of it, `dt_s` after the last one.
    pub fn inspect(&mut self, pose: &Pose, readout: &Readout, dt_s: f32, ground: &impl Ground) {
        let dt_s = if dt_s > 0.0 { f64::from(dt_s).min(LONGEST_STEP_S) } else { 0.0 };
        self.findings.steps += 1;
        self.findings.time_s += dt_s;
        let missing = numbers_missing(pose, readout);
        if missing > 0 {
            self.see(Quantity::NotFinite, missing as f64, Part::Body);
            self.forget();
            return;
        }
        // Joints around the root in f32, the root in f64: as exact a kilometre away as at the origin.
        let mut at_origin = *pose;
        at_origin.root_in_world = Default::default();
        let joints = at_origin.joints(&self.skeleton);
        let root = root_of(pose);
        self.bends(pose);
        self.bones(&joints);
        let toes = Limb::ALL.map(|limb| {
            let toe = joints.toe(limb);
            [root[0] + f64::from(toe.x), root[1] + f64::from(toe.y), root[2] + f64::from(toe.z)]
        });
        self.feet(readout, &toes, dt_s, root, ground);
        self.under_ground(readout, &joints, root, ground);
        self.motion(pose, readout, root, toes);
        self.see(Quantity::Lowered, f64::from(readout.lowered_m), Part::Body);
    }

    /// Forgets the steps before, not the findings: for a horse that was placed somewhere else.
    pub fn forget(&mut self) {
        (self.stances, self.before, self.rates) = ([None; 4], None, None);
    }

    /// What was found so far.
    pub fn findings(&self) -> &Findings {
        &self.findings
    }

    fn see(&mut self, quantity: Quantity, value: f64, part: Part) {
        let at_s = self.findings.time_s;
        self.findings.see(quantity, value, at_s, part);
    }

    fn bends(&mut self, pose: &Pose) {
        for (bone, &bend) in pose.bends_rad.iter().enumerate() {
            let [low, high] = self.limits_rad[bone];
            let bend = f64::from(bend);
            let beyond = (low - bend).max(bend - high);
            if beyond > 0.0 {
                self.see(Quantity::BendBeyondLimit, beyond, Part::Bone(bone));
            }
        }
    }

    fn bones(&mut self, joints: &Joints) {
        for bone in 0..BONE_COUNT {
            let length = f64::from(joints.bases[bone].distance(joints.tips[bone]));
            self.see(Quantity::BoneLength, (length - self.lengths_m[bone]).abs(), Part::Bone(bone));
        }
        for limb in Limb::ALL {
            let reach = f64::from(joints.bases[limb.first_bone()].distance(joints.toe(limb)));
            self.see(Quantity::LegReach, reach - self.reach_m[limb.index()], Part::Leg(limb));
        }
    }

    /// Standing toes: slide, sink, float, print.
    fn feet(&mut self, readout: &Readout, toes: &[Place; 4], dt_s: f64, root: Place, ground: &impl Ground) {
        let rounding_m = rounding_of(root);
        for limb in Limb::ALL {
            let leg = limb.index();
            let struck_unseen = dt_s > SWING_MISSED_S && readout.leg_cycles[leg] < self.cycles[leg];
            self.cycles[leg] = readout.leg_cycles[leg];
            if !readout.on_ground[leg] {
                if self.stances[leg].take().is_some() && !readout.is_standing {
                    let left = 1.0 - f64::from(readout.leg_cycles[leg] / readout.duty_factors[leg]);
                    self.see(Quantity::BrokenStance, left, Part::Leg(limb));
                }
                continue;
            }
            let toe = toes[leg];
            if self.stances[leg].is_none() || struck_unseen {
                self.stances[leg] = Some(toe);
                self.findings.stances += 1;
            }
            let place = self.stances[leg].unwrap_or(toe);
            let part = Part::Leg(limb);
            let slide = (toe[0] - place[0]).hypot(toe[2] - place[2]) - rounding_m;
            self.see(Quantity::StanceSlide, slide, part);
            let print = readout.prints[leg];
            let apart = (toe[0] - print.x).hypot(toe[1] - print.y).hypot(toe[2] - print.z) - rounding_m;
            self.see(Quantity::PrintApart, apart, part);
            let over = height_over(toe, ground);
            self.see(Quantity::Float, over - rounding_m, part);
            self.see(Quantity::Sink, -over - rounding_m, part);
        }
    }

    /// Swinging toes and every other joint against the ground.
    fn under_ground(&mut self, readout: &Readout, joints: &Joints, root: Place, ground: &impl Ground) {
        let highest = Limb::ALL
            .map(|limb| {
                let toe = joints.toe(limb);
                let (x, z) = (root[0] + f64::from(toe.x), root[2] + f64::from(toe.z));
                f64::from(ground.surface(x as f32, z as f32).height_m)
            })
            .into_iter()
            .fold(f64::NEG_INFINITY, f64::max);
        for (bone, tip) in joints.tips.iter().enumerate() {
            let y = root[1] + f64::from(tip.y);
            let standing = Skeleton::limb_of(bone)
                .is_some_and(|limb| limb.hoof_bone() == bone && readout.on_ground[limb.index()]);
            if standing || y > highest + NEAR_GROUND_M {
                continue;
            }
            let place = [root[0] + f64::from(tip.x), y, root[2] + f64::from(tip.z)];
            self.see(Quantity::UnderGround, -height_over(place, ground), Part::Bone(bone));
        }
    }

    /// Speeds and jumps against the steps before.
    fn motion(&mut self, pose: &Pose, readout: &Readout, root: Place, toes: [Place; 4]) {
        let frame = Frame { at_s: self.findings.time_s, root, toes, bends_rad: pose.bends_rad };
        let Some(before) = self.before else {
            self.before = Some(frame);
            return;
        };
        let over_s = frame.at_s - before.at_s;
        if over_s < SHORTEST_STEP_S {
            return;
        }
        let horse_m_s = f64::from(readout.speed_m_s).abs();
        for limb in Limb::ALL {
            let moved = distance(toes[limb.index()], before.toes[limb.index()]);
            let faster = moved / over_s - TOE_SPEED_FACTOR * horse_m_s;
            self.see(Quantity::ToeSpeed, faster, Part::Leg(limb));
        }
        let mut rates = Rates { over_s, root_m_s: [0.0; 3], bends_rad_s: [0.0; BONE_COUNT] };
        for axis in 0..3 {
            rates.root_m_s[axis] = (root[axis] - before.root[axis]) / over_s;
        }
        for bone in 0..BONE_COUNT {
            rates.bends_rad_s[bone] = (pose.bends_rad[bone] - before.bends_rad[bone]) / over_s as f32;
        }
        self.rates(&rates);
        (self.before, self.rates) = (Some(frame), Some(rates));
    }

    fn rates(&mut self, rates: &Rates) {
        let before = self.rates;
        for (bone, &rate) in rates.bends_rad_s.iter().enumerate() {
            self.see(Quantity::BendSpeed, f64::from(rate.abs()), Part::Bone(bone));
            if let Some(before) = before {
                let change = f64::from((rate - before.bends_rad_s[bone]).abs());
                let acceleration = 2.0 * change / (rates.over_s + before.over_s);
                self.see(Quantity::BendAcceleration, acceleration, Part::Bone(bone));
            }
        }
        if let Some(before) = before {
            let missed = rates.over_s * distance(rates.root_m_s, before.root_m_s);
            let explained = 0.5 * ROOT_ACCELERATION_M_S2 * rates.over_s * (rates.over_s + before.over_s);
            self.see(Quantity::RootJump, missed - explained, Part::Body);
        }
    }
}

fn distance(a: Place, b: Place) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1]).hypot(a[2] - b[2])
}

/// The root's place in f64.
fn root_of(pose: &Pose) -> Place {
    let root = pose.root_in_world;
    [root.x, root.y, root.z].map(f64::from)
}

/// What rounding the root to f32 can move a toe between two looks, m.
fn rounding_of(root: Place) -> f64 {
    root.iter().map(|at| at.abs() * f64::from(f32::EPSILON)).fold(0.0, f64::max)
}

/// Height of a place over the ground; at an edge over the ground that it agrees with best. Over a hole, zero.
fn height_over([x, y, z]: Place, ground: &impl Ground) -> f64 {
    let over = |dx: f64, dz: f64| {
        let height = f64::from(ground.surface((x + dx) as f32, (z + dz) as f32).height_m);
        if height.is_finite() { y - height } else { 0.0 }
    };
    let here = over(0.0, 0.0);
    if here.abs() < DISAGREEMENT_M {
        return here;
    }
    let beside = [(EDGE_M, 0.0), (-EDGE_M, 0.0), (0.0, EDGE_M), (0.0, -EDGE_M)].map(|(dx, dz)| over(dx, dz));
    beside.into_iter().fold(here, |least, over| if over.abs() < least.abs() { over } else { least })
}

/// How many numbers of a pose and a readout are none; a stride time is infinite while the horse stands.
pub(super) fn numbers_missing(pose: &Pose, readout: &Readout) -> usize {
    let (root, turn) = (pose.root_in_world, pose.world_from_root);
    let single = [
        root.x,
        root.y,
        root.z,
        turn.x,
        turn.y,
        turn.z,
        turn.w,
        readout.speed_m_s,
        readout.turn_rate_rad_s,
        readout.lowered_m,
        readout.heading_rad as f32,
        readout.strides as f32,
        readout.phase,
    ];
    let lists = [
        &pose.bends_rad[..],
        &pose.scapula_slides_m,
        &pose.lateral_bends_rad,
        &pose.limb_turns_rad,
        &pose.abductions_rad,
        &readout.leg_cycles,
        &readout.duty_factors,
        &single,
    ];
    let missing = |values: &[f32]| values.iter().filter(|value| !value.is_finite()).count();
    let prints = readout.prints.iter().filter(|print| !print.is_finite()).count();
    lists.into_iter().map(missing).sum::<usize>() + prints + usize::from(readout.stride_time_s.is_nan())
}

#[cfg(test)]
mod tests {
    use std::f32::consts::PI;

    use glam::{DVec3, Quat};
    use muybridge_core::{FlatGround, Gait};

    use super::super::findings::Limits;
    use super::*;

    const DT_S: f32 = 1.0 / 120.0;

    fn readout(on_ground: [bool; 4], pose: &Pose, skeleton: &Skeleton) -> Readout {
        let joints = pose.joints(skeleton);
        Readout {
            gait: Gait::Walk,
            lead: None,
            is_standing: true,
            change: None,
            speed_m_s: 0.0,
            heading_rad: 0.0,
            turn_rate_rad_s: 0.0,
            stride_time_s: f32::INFINITY,
            strides: 0.0,
            phase: 0.0,
            leg_cycles: [0.0; 4],
            duty_factors: [0.6; 4],
            on_ground,
            prints: Limb::ALL.map(|limb| joints.toe(limb).as_dvec3()),
            lowered_m: 0.0,
        }
    }

    /// The standing horse with its toes on the ground.
    fn standing(skeleton: &Skeleton) -> Pose {
        let mut pose = Pose::standing(skeleton);
        for _ in 0..5 {
            let lower = pose.joints(skeleton).toe(Limb::LH).y - pose.joints(skeleton).toe(Limb::LF).y;
            let lever = pose.joints(skeleton).toe(Limb::LF).x - pose.joints(skeleton).toe(Limb::LH).x;
            pose.world_from_root *= Quat::from_rotation_z(lower / lever);
        }
        pose.root_in_world.y -= pose.joints(skeleton).toe(Limb::LH).y;
        pose
    }

    /// What is broken after a good pose and then another.
    fn broken_by(change: impl Fn(&mut Pose, &mut Readout)) -> Vec<(Quantity, f64)> {
        let skeleton = Skeleton::reference();
        let mut inspector = Inspector::new(&skeleton);
        let mut pose = standing(&skeleton);
        let mut seen = readout([true; 4], &pose, &skeleton);
        inspector.inspect(&pose, &seen, DT_S, &FlatGround);
        inspector.inspect(&pose, &seen, DT_S, &FlatGround);
        let before = inspector.findings().broken(&Limits::smooth());
        assert_eq!(before, [], "the standing horse itself is good");
        change(&mut pose, &mut seen);
        inspector.inspect(&pose, &seen, DT_S, &FlatGround);
        let broken = inspector.findings().broken(&Limits::smooth());
        broken.into_iter().map(|b| (b.quantity, b.worst.value)).collect()
    }

    fn only(found: &[(Quantity, f64)], quantity: Quantity) -> f64 {
        assert_eq!(found.iter().map(|row| row.0).collect::<Vec<_>>(), [quantity], "{found:?}");
        found[0].1
    }

    #[test]
    fn a_slide_of_3_mm_is_found_and_is_none_in_swing() {
        let slid = broken_by(|pose, seen| {
            pose.root_in_world.x += 0.003;
            seen.prints.iter_mut().for_each(|print| print.x += 0.003);
        });
        assert!((only(&slid, Quantity::StanceSlide) - 0.003).abs() < 1e-6);
        let swung = broken_by(|pose, seen| {
            pose.root_in_world.x += 0.003;
            seen.on_ground = [false; 4];
        });
        assert_eq!(swung, []);
    }

    #[test]
    fn a_toe_over_and_under_the_ground_and_off_its_print_is_found() {
        let floats = broken_by(|pose, seen| {
            pose.root_in_world.y += 0.002;
            seen.prints.iter_mut().for_each(|print| print.y += 0.002);
        });
        assert!((only(&floats, Quantity::Float) - 0.002).abs() < 1e-4);
        let sinks = broken_by(|pose, seen| {
            pose.root_in_world.y -= 0.002;
            seen.prints.iter_mut().for_each(|print| print.y -= 0.002);
        });
        assert!((only(&sinks, Quantity::Sink) - 0.002).abs() < 1e-4);
        let apart = broken_by(|_, seen| seen.prints[2] += DVec3::X * 0.01);
        assert!((only(&apart, Quantity::PrintApart) - 0.01).abs() < 1e-6);
    }

    #[test]
    fn a_bend_beyond_its_limit_and_a_stretched_bone_are_found() {
        let skeleton = Skeleton::reference();
        let head = muybridge_core::bone::HEAD;
        let bent = broken_by(|pose, _| pose.bends_rad[head] = skeleton.bones[head].limits_rad[1] + 0.01);
        assert!(bent.iter().any(|row| row.0 == Quantity::BendBeyondLimit && (row.1 - 0.01).abs() < 1e-6));
        let stretched = broken_by(|pose, _| pose.world_from_root *= 1.01);
        assert!(stretched.iter().any(|row| row.0 == Quantity::BoneLength && row.1 > 1e-3), "{stretched:?}");
    }

    #[test]
    fn a_number_that_is_none_a_jump_and_a_foot_elsewhere_are_found() {
        assert_eq!(only(&broken_by(|pose, _| pose.bends_rad[5] = f32::NAN), Quantity::NotFinite), 1.0);
        let jumped = broken_by(|pose, seen| {
            pose.root_in_world.z += 0.2;
            seen.on_ground = [false; 4];
        });
        let found: Vec<Quantity> = jumped.iter().map(|row| row.0).collect();
        assert_eq!(found, [Quantity::ToeSpeed, Quantity::RootJump], "{jumped:?}");
        let flicked = broken_by(|pose, seen| {
            pose.bends_rad[Limb::RH.hoof_bone()] -= 2.0;
            seen.on_ground = [false; 4];
        });
        assert!(flicked.iter().any(|row| row.0 == Quantity::BendSpeed && row.1 > 200.0), "{flicked:?}");
    }

    #[test]
    fn a_hoof_that_swings_through_the_ground_is_found() {
        let through = broken_by(|pose, seen| {
            pose.root_in_world.y -= 0.05;
            seen.on_ground = [false; 4];
        });
        let [jump, under] = &through[..] else { panic!("{through:?}") };
        assert_eq!([jump.0, under.0], [Quantity::RootJump, Quantity::UnderGround]);
        assert!((under.1 - 0.05).abs() < 1e-4);
    }

    #[test]
    fn a_kilometre_away_a_standing_horse_stands_and_a_slide_is_seen() {
        let skeleton = Skeleton::reference();
        let mut inspector = Inspector::new(&skeleton);
        let mut pose = standing(&skeleton);
        pose.root_in_world.x += 1000.0;
        pose.world_from_root = Quat::from_rotation_y(0.3 * PI) * pose.world_from_root;
        let mut seen = readout([true; 4], &pose, &skeleton);
        inspector.inspect(&pose, &seen, DT_S, &FlatGround);
        inspector.inspect(&pose, &seen, DT_S, &FlatGround);
        assert_eq!(inspector.findings().broken(&Limits::smooth()), []);
        pose.root_in_world.z += 0.003;
        seen.prints.iter_mut().for_each(|print| print.z += 0.003);
        inspector.inspect(&pose, &seen, DT_S, &FlatGround);
        let slide = inspector.findings().worst(Quantity::StanceSlide).value;
        assert!((slide - 0.003).abs() < 3e-4, "{slide}");
    }
}
