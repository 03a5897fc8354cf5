//! Planar kinematics of the skeleton in f64, with exact derivatives.
//!
//! Seen from the side a turn out of the sagittal plane has no first-order effect, so the fit is planar; bones keep
//! their distance from the median plane, which the camera turns into perspective.

use muybridge_core::{BONE_COUNT, Limb, Skeleton, bone};

use crate::layout::{
    BENDS, LOG_DOCK, LOG_SCALE, PANEL_DOF, PITCH, ROOT_X, ROOT_Y, SHARED, SLIDES, log_length,
};

/// A vector of the sagittal plane: forward, up.
pub(crate) type Vec2 = [f64; 2];

fn add([ax, ay]: Vec2, [bx, by]: Vec2) -> Vec2 {
    [ax + bx, ay + by]
}

fn sub([ax, ay]: Vec2, [bx, by]: Vec2) -> Vec2 {
    [ax - bx, ay - by]
}

/// Derivative of a vector with respect to its own rotation.
fn quarter_turn([x, y]: Vec2) -> Vec2 {
    [-y, x]
}

fn rotate([x, y]: Vec2, angle: f64) -> Vec2 {
    let (sin, cos) = angle.sin_cos();
    [cos * x - sin * y, sin * x + cos * y]
}

/// A point that moves with the skeleton.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Attachment {
    /// Distal end of a bone.
    Tip(usize),
    /// The root joint, top of the croup.
    Root,
    /// Root of the tail, fixed to the root.
    Dock,
}

/// One unknown that a point depends on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Unknown {
    Panel(usize),
    Shared(usize),
}

/// The reference skeleton, prepared for the fit.
#[derive(Clone, Debug)]
pub struct Chain {
    pub(crate) parents: [Option<usize>; BONE_COUNT],
    pub(crate) reference_lengths_m: [f64; BONE_COUNT],
    pub(crate) rest_rad: [f64; BONE_COUNT],
    pub(crate) limits_rad: [[f64; 2]; BONE_COUNT],
    /// Distance of each tip from the median plane, m, positive to the right.
    pub(crate) lateral_m: [f64; BONE_COUNT],
    pub(crate) scapula_attachment_m: Vec2,
    pub(crate) slide_limits_m: Vec2,
    pub(crate) dock_m: Vec2,
}

/// A pose worked out: places of all joints in metres.
pub struct Kinematics {
    root: Vec2,
    bases: [Vec2; BONE_COUNT],
    tips: [Vec2; BONE_COUNT],
    angles: [f64; BONE_COUNT],
    /// From the withers to the scapula's attachment without the slide; scales with the animal.
    attachment: Vec2,
    dock: Vec2,
}

impl Chain {
    /// Prepares a skeleton.
    pub fn new(skeleton: &Skeleton) -> Self {
        let per_bone = |f: &dyn Fn(&muybridge_core::Bone) -> f32| {
            std::array::from_fn(|i| f64::from(f(&skeleton.bones[i])))
        };
        Self {
            parents: std::array::from_fn(|i| skeleton.bones[i].parent),
            reference_lengths_m: per_bone(&|b| b.length_m),
            rest_rad: per_bone(&|b| b.rest_bend_rad),
            limits_rad: std::array::from_fn(|i| skeleton.bones[i].limits_rad.map(f64::from)),
            lateral_m: per_bone(&|b| b.lateral_m),
            scapula_attachment_m: skeleton.scapula_attachment_from_withers_m.map(f64::from),
            slide_limits_m: skeleton.scapula_slide_limits_m.map(f64::from),
            dock_m: skeleton.dock_from_croup_m.map(f64::from),
        }
    }

    /// Length of a bone under shared log-lengths, m.
    pub fn length_m(&self, bone: usize, shared: &[f64]) -> f64 {
        self.reference_lengths_m[bone] * shared[log_length(bone)].exp()
    }

    /// Works out a pose of [`PANEL_DOF`] unknowns with [`SHARED`] lengths.
    pub fn kinematics(&self, pose: &[f64], shared: &[f64]) -> Kinematics {
        debug_assert!(pose.len() == PANEL_DOF && shared.len() == SHARED);
        let scale = shared[LOG_SCALE].exp();
        let root = [pose[ROOT_X], pose[ROOT_Y]];
        let mut k = Kinematics {
            root,
            bases: [root; BONE_COUNT],
            tips: [root; BONE_COUNT],
            angles: [0.0; BONE_COUNT],
            attachment: [0.0; 2],
            dock: add(root, rotate(self.dock_m.map(|v| v * shared[LOG_DOCK].exp()), pose[PITCH])),
        };
        for i in 0..BONE_COUNT {
            let (parent_angle, parent_tip) =
                self.parents[i].map_or((pose[PITCH], root), |p| (k.angles[p], k.tips[p]));
            k.angles[i] = parent_angle + pose[BENDS + i];
            k.bases[i] = parent_tip;
            if let Some(side) = scapula_side(i) {
                k.attachment = rotate(self.scapula_attachment_m.map(|v| v * scale), parent_angle);
                let slide = rotate([pose[SLIDES + side], 0.0], parent_angle);
                k.bases[i] = add(parent_tip, add(k.attachment, slide));
            }
            k.tips[i] = add(k.bases[i], rotate([self.length_m(i, shared), 0.0], k.angles[i]));
        }
        k
    }

    /// Calls `emit` with each unknown that a point depends on and the point's derivative, m per unit.
    pub(crate) fn derivatives(&self, k: &Kinematics, point: Attachment, mut emit: impl FnMut(Unknown, Vec2)) {
        emit(Unknown::Panel(ROOT_X), [1.0, 0.0]);
        emit(Unknown::Panel(ROOT_Y), [0.0, 1.0]);
        let place = k.place(point);
        emit(Unknown::Panel(PITCH), quarter_turn(sub(place, k.root)));
        let mut at = match point {
            Attachment::Tip(bone) => Some(bone),
            Attachment::Root => None,
            Attachment::Dock => {
                emit(Unknown::Shared(LOG_DOCK), sub(place, k.root));
                None
            }
        };
        while let Some(bone) = at {
            emit(Unknown::Panel(BENDS + bone), quarter_turn(sub(place, k.bases[bone])));
            emit(Unknown::Shared(log_length(bone)), sub(k.tips[bone], k.bases[bone]));
            if let Some(side) = scapula_side(bone) {
                emit(Unknown::Panel(SLIDES + side), rotate([1.0, 0.0], k.angles[bone::SPINE_LAST]));
                emit(Unknown::Shared(LOG_SCALE), k.attachment);
            }
            at = self.parents[bone];
        }
    }
}

impl Chain {
    /// Calls `emit` with each pair of unknowns (each unordered pair once) and `pull` dotted with the point's second
    /// derivative. A planar chain has simple ones: two turns give minus the lever of the lower joint, a turn and a
    /// length the bone's quarter turn where the turn carries the bone.
    pub(crate) fn second_derivatives(
        &self,
        k: &Kinematics,
        point: Attachment,
        pull: Vec2,
        mut emit: impl FnMut(Unknown, Unknown, f64),
    ) {
        let dot = |v: Vec2| pull[0] * v[0] + pull[1] * v[1];
        let place = k.place(point);
        let mut carried: Vec<(Unknown, Vec2)> = Vec::with_capacity(24);
        let mut turn = |unknown: Unknown, pivot: Vec2, carried: &[(Unknown, Vec2)]| {
            for (length, vector) in carried {
                emit(unknown, *length, dot(quarter_turn(*vector)));
            }
            emit(unknown, unknown, -dot(sub(place, pivot)));
        };
        let mut turns: Vec<(Unknown, Vec2)> = Vec::with_capacity(12);
        let mut at = if let Attachment::Tip(bone) = point { Some(bone) } else { None };
        if point == Attachment::Dock {
            carried.push((Unknown::Shared(LOG_DOCK), sub(place, k.root)));
        }
        while let Some(bone) = at {
            carried.push((Unknown::Shared(log_length(bone)), sub(k.tips[bone], k.bases[bone])));
            turns.push((Unknown::Panel(BENDS + bone), k.bases[bone]));
            turn(Unknown::Panel(BENDS + bone), k.bases[bone], &carried);
            if let Some(side) = scapula_side(bone) {
                let along = rotate([1.0, 0.0], k.angles[bone::SPINE_LAST]);
                carried.push((Unknown::Panel(SLIDES + side), along));
                carried.push((Unknown::Shared(LOG_SCALE), k.attachment));
            }
            at = self.parents[bone];
        }
        turns.push((Unknown::Panel(PITCH), k.root));
        turn(Unknown::Panel(PITCH), k.root, &carried);
        for (i, (lower, pivot)) in turns.iter().enumerate() {
            for (upper, _) in &turns[i + 1..] {
                emit(*lower, *upper, -dot(sub(place, *pivot)));
            }
        }
        for (length, vector) in carried.iter().filter(|(unknown, _)| matches!(unknown, Unknown::Shared(_))) {
            emit(*length, *length, dot(*vector));
        }
    }
}

impl Kinematics {
    /// Place of a point, m.
    pub fn place(&self, point: Attachment) -> Vec2 {
        match point {
            Attachment::Tip(bone) => self.tips[bone],
            Attachment::Root => self.root,
            Attachment::Dock => self.dock,
        }
    }

    /// Proximal and distal end of a bone, m.
    pub fn bone(&self, bone: usize) -> [Vec2; 2] {
        [self.bases[bone], self.tips[bone]]
    }
}

/// 0 for the left scapula, 1 for the right one, none for other bones.
fn scapula_side(bone: usize) -> Option<usize> {
    [Limb::LF, Limb::RF].iter().position(|limb| limb.first_bone() == bone)
}

#[cfg(test)]
mod tests {
    use super::*;
    use muybridge_core::Pose;

    fn test_pose() -> (Chain, Skeleton, Vec<f64>, Vec<f64>) {
        let skeleton = Skeleton::reference();
        let chain = Chain::new(&skeleton);
        let mut pose = vec![0.0; PANEL_DOF];
        for (i, value) in pose.iter_mut().enumerate() {
            *value = 0.2 * (1.7 * i as f64).sin();
        }
        for i in 0..BONE_COUNT {
            pose[BENDS + i] += chain.rest_rad[i];
        }
        let shared: Vec<f64> = (0..SHARED).map(|i| 0.1 * (2.3 * i as f64).cos()).collect();
        (chain, skeleton, pose, shared)
    }

    #[test]
    fn derivatives_agree_with_central_differences() {
        let (chain, _, pose, shared) = test_pose();
        let points = (0..BONE_COUNT).map(Attachment::Tip).chain([Attachment::Root, Attachment::Dock]);
        for point in points {
            let k = chain.kinematics(&pose, &shared);
            let mut analytic = vec![[0.0; 2]; PANEL_DOF + SHARED];
            chain.derivatives(&k, point, |unknown, d| {
                let i = match unknown {
                    Unknown::Panel(i) => i,
                    Unknown::Shared(i) => PANEL_DOF + i,
                };
                analytic[i] = add(analytic[i], d);
            });
            for i in 0..PANEL_DOF + SHARED {
                let moved = |h: f64| {
                    let (mut pose, mut shared) = (pose.clone(), shared.clone());
                    if i < PANEL_DOF {
                        pose[i] += h;
                    } else {
                        shared[i - PANEL_DOF] += h;
                    }
                    chain.kinematics(&pose, &shared).place(point)
                };
                let (a, b) = (moved(1e-6), moved(-1e-6));
                for axis in 0..2 {
                    let numeric = (a[axis] - b[axis]) / 2e-6;
                    assert!((numeric - analytic[i][axis]).abs() < 1e-8, "{point:?} unknown {i}");
                }
            }
        }
    }

    #[test]
    fn second_derivatives_agree_with_differences_of_the_first() {
        let (chain, _, pose, shared) = test_pose();
        let (n, pull) = (PANEL_DOF + SHARED, [0.7, -1.3]);
        let flat = |unknown| match unknown {
            Unknown::Panel(i) => i,
            Unknown::Shared(i) => PANEL_DOF + i,
        };
        for point in
            [Attachment::Tip(Limb::RF.hoof_bone()), Attachment::Tip(Limb::LH.hoof_bone()), Attachment::Dock]
        {
            let gradient = |at: usize, h: f64| {
                let (mut pose, mut shared) = (pose.clone(), shared.clone());
                if at < PANEL_DOF {
                    pose[at] += h;
                } else {
                    shared[at - PANEL_DOF] += h;
                }
                let mut g = vec![0.0; n];
                let k = chain.kinematics(&pose, &shared);
                chain.derivatives(&k, point, |u, [dx, dy]| g[flat(u)] += pull[0] * dx + pull[1] * dy);
                g
            };
            let mut analytic = vec![vec![0.0; n]; n];
            chain.second_derivatives(&chain.kinematics(&pose, &shared), point, pull, |a, b, v| {
                let (a, b) = (flat(a), flat(b));
                analytic[a][b] += v;
                if a != b {
                    analytic[b][a] += v;
                }
            });
            for a in 0..n {
                let (plus, minus) = (gradient(a, 1e-6), gradient(a, -1e-6));
                for b in 0..n {
                    let numeric = (plus[b] - minus[b]) / 2e-6;
                    assert!(
                        (numeric - analytic[a][b]).abs() < 1e-8,
                        "{point:?} {a} {b}: {numeric} {}",
                        analytic[a][b]
                    );
                }
            }
        }
    }

    #[test]
    fn joints_stand_where_the_run_time_puts_them() {
        let (chain, skeleton, pose, _) = test_pose();
        let k = chain.kinematics(&pose, &[0.0; SHARED]);
        let run_time = Pose {
            root_in_world: [pose[ROOT_X] as f32, pose[ROOT_Y] as f32, 0.0].into(),
            world_from_root: glam::Quat::from_rotation_z(pose[PITCH] as f32),
            bends_rad: std::array::from_fn(|i| pose[BENDS + i] as f32),
            scapula_slides_m: [pose[SLIDES] as f32, pose[SLIDES + 1] as f32],
            ..Pose::default()
        };
        let joints = run_time.joints(&skeleton);
        for i in 0..BONE_COUNT {
            let [x, y] = k.place(Attachment::Tip(i));
            let tip = joints.tips[i];
            assert!((f64::from(tip.x) - x).abs() < 1e-5 && (f64::from(tip.y) - y).abs() < 1e-5, "bone {i}");
        }
        let [x, y] = k.place(Attachment::Dock);
        assert!((f64::from(joints.dock.x) - x).abs() < 1e-5 && (f64::from(joints.dock.y) - y).abs() < 1e-5);
    }
}
