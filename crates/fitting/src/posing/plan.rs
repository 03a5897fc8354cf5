//! What a drag lets move, how readily, and what it holds in place.
//!
//! Standard deviations say which joints give way first: a motion is shared out by their squares, so that a joint of half
//! the value does a quarter of the work. They are chosen for the hand, not measured.

use muybridge_capture::{BodyPoint, Keypoint, LimbJoint, StanceLabel};
use muybridge_core::{Limb, Pair, bone};

use crate::chain::Attachment;
use crate::layout::{BENDS, PANEL_DOF, PITCH, ROOT_X, ROOT_Y, SLIDES};
use crate::observation::attachment;
use crate::problem::LinearRow;

use super::damped::{Loss, PointTerm};
use super::drag::{DragOptions, Reach};
use super::{PanelPose, PanelPoser};

/// Bends of a limb, root to hoof, rad, about in the proportions in which a walking horse uses them: the pelvis is one
/// with the sacrum, scapula and humerus swing a little, elbow and knee fold, and the hoof follows its cannon.
const FORE_SD: [f64; 5] = [0.06, 0.18, 0.45, 0.8, 0.12];
const HIND_SD: [f64; 5] = [0.04, 0.35, 0.5, 0.5, 0.12];
/// The bone whose end is dragged when a limb is dragged by its root, rad.
const DRAGGED_ROOT_SD: [f64; 2] = [0.3, 0.15];
/// Knee (carpus) bend per elbow bend as a forelimb folds, and its standard deviation, rad: through the swing of a walk
/// the elbow flexes by some 50 degrees and the knee by some 75, in opposite senses. Without it a straight knee would not
/// know that it may fold. The deviation is that of the hind limb's reciprocal apparatus.
const FOLD_RATIO: f64 = -1.5;
const FOLD_SD: f64 = 0.25;
/// Slide of a scapula, m.
const SLIDE_SD_M: f64 = 0.03;
/// How far the bone above a limb's root may turn while the limb is dragged by a lower joint, rad: the root moves by a
/// few centimetres at most. The elbow hangs on it by one bone only, and needs more to go anywhere.
const ROOT_BONE_GIVE_RAD: f64 = 0.12;
const ROOT_BONE_GIVE_TO_ELBOW_RAD: f64 = 0.25;
/// Three neck bones and the head, rad.
const NECK_SD: [f64; 4] = [0.3, 0.2, 0.2, 0.5];
/// Root place (m), pitch (rad), the lumbosacral bend and the other bends of the back (rad), when the trunk is dragged.
const TRUNK_SD: [f64; 4] = [0.15, 0.2, 0.1, 0.04];
/// The same when the trunk only gives way to a limb or the neck.
const YIELDING_TRUNK_SD: [f64; 4] = [0.02, 0.02, 0.02, 0.01];
/// Croup and withers stay near their places while another point of the trunk is dragged, m.
const TRUNK_HOLD_SD_M: f64 = 0.06;
/// Standard deviation of what is pinned, m: against the full pull of a handle out of reach it stays within half a
/// millimetre.
const PIN_SD_M: f64 = 3e-4;
/// Frozen unknowns need a number that is not zero.
const FROZEN_SD: f64 = 1.0;

/// The part of the animal that a handle is on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Part {
    Neck,
    Trunk,
    Limb(Limb, LimbJoint),
}

/// What may move and what stays, for one drag.
#[derive(Clone, Debug)]
pub(super) struct Plan {
    pub(super) bounds: [[f64; 2]; PANEL_DOF],
    pub(super) sd: [f64; PANEL_DOF],
    pub(super) rows: Vec<LinearRow>,
    /// Places that are held, softly or hard.
    pub(super) held: Vec<PointTerm>,
}

impl Plan {
    pub(super) fn new(
        poser: &PanelPoser,
        start: &PanelPose,
        handle: Keypoint,
        options: &DragOptions,
    ) -> Self {
        let mut plan = Self {
            bounds: start.map(|value| [value, value]),
            sd: [FROZEN_SD; PANEL_DOF],
            rows: Vec::new(),
            held: Vec::new(),
        };
        let part = part(poser, handle);
        plan.free_part(poser, start, part, handle);
        let trunk_moves = match part {
            Part::Trunk | Part::Limb(_, LimbJoint::Root) => {
                plan.free_trunk(poser, TRUNK_SD);
                plan.hold_trunk(poser, start, handle);
                true
            }
            Part::Limb(..) | Part::Neck if options.reach == Reach::Whole => {
                plan.free_trunk(poser, YIELDING_TRUNK_SD);
                true
            }
            Part::Limb(..) | Part::Neck => false,
        };
        plan.pin(poser, start, part, trunk_moves, &pins(poser, part, handle, options));
        plan.couple(poser, start);
        plan
    }

    /// Frees the joints between the dragged point and the trunk.
    fn free_part(&mut self, poser: &PanelPoser, start: &PanelPose, part: Part, handle: Keypoint) {
        match part {
            Part::Trunk => {}
            Part::Neck => self.free_neck(poser, handle),
            Part::Limb(limb, LimbJoint::Root) => {
                self.free(poser, BENDS + limb.first_bone(), DRAGGED_ROOT_SD[limb.pair() as usize]);
                self.free_slide(poser, limb);
            }
            Part::Limb(limb, joint) => {
                self.free_limb(poser, limb, joint);
                let at = BENDS + limb.first_bone();
                let [low, high] = self.bounds[at];
                let elbow = joint == LimbJoint::Upper && limb.pair() == Pair::Fore;
                let give = if elbow { ROOT_BONE_GIVE_TO_ELBOW_RAD } else { ROOT_BONE_GIVE_RAD };
                self.bounds[at] = [(start[at] - give).max(low), (start[at] + give).min(high)];
                if elbow {
                    self.free_slide(poser, limb);
                }
            }
        }
    }

    /// Lets an unknown move within its limits.
    fn free(&mut self, poser: &PanelPoser, index: usize, sd: f64) {
        self.bounds[index] = poser.bounds()[index];
        self.sd[index] = sd;
    }

    fn is_free(&self, index: usize) -> bool {
        self.bounds[index][0] < self.bounds[index][1]
    }

    /// Frees the bends of a limb from its root down to a joint.
    fn free_limb(&mut self, poser: &PanelPoser, limb: Limb, joint: LimbJoint) {
        let sds = if limb.pair() == Pair::Fore { FORE_SD } else { HIND_SD };
        for (i, sd) in sds.into_iter().enumerate().take(joint as usize + 1) {
            let index = BENDS + limb.first_bone() + i;
            if !self.is_free(index) {
                self.free(poser, index, sd);
            }
        }
    }

    fn free_slide(&mut self, poser: &PanelPoser, limb: Limb) {
        if limb.pair() == Pair::Fore {
            self.free(poser, SLIDES + limb.side() as usize, SLIDE_SD_M);
        }
    }

    /// Frees the neck as far as the poll or the muzzle.
    fn free_neck(&mut self, poser: &PanelPoser, keypoint: Keypoint) {
        let last = keypoint.bone(poser.facing).unwrap_or(bone::NECK_LAST);
        for index in bone::NECK..=last {
            self.free(poser, BENDS + index, NECK_SD[index - bone::NECK]);
        }
    }

    fn free_trunk(&mut self, poser: &PanelPoser, [place, pitch, lumbosacral, back]: [f64; 4]) {
        for index in [ROOT_X, ROOT_Y] {
            self.free(poser, index, place);
        }
        self.free(poser, PITCH, pitch);
        for index in bone::SPINE..=bone::SPINE_LAST {
            let sd = if index == bone::SPINE { lumbosacral } else { back };
            self.free(poser, BENDS + index, sd);
        }
    }

    /// Holds both ends of the trunk softly, but for the one that is dragged.
    fn hold_trunk(&mut self, poser: &PanelPoser, start: &PanelPose, handle: Keypoint) {
        for end in [Attachment::Root, Attachment::Tip(bone::SPINE_LAST)] {
            if end != attachment(handle, poser.facing) {
                self.hold(poser, start, end, TRUNK_HOLD_SD_M);
            }
        }
    }

    fn hold(&mut self, poser: &PanelPoser, start: &PanelPose, on: Attachment, sd_m: f64) {
        let target_m = poser.chain.kinematics(start, &poser.lengths).place(on);
        self.held.push(PointTerm { on, target_m, sd_m, loss: Loss::Square });
    }

    /// Holds pins in place, and frees the joints that must give way for it.
    fn pin(
        &mut self,
        poser: &PanelPoser,
        start: &PanelPose,
        dragged: Part,
        trunk_moves: bool,
        pins: &[Keypoint],
    ) {
        for pin in pins {
            match (part(poser, *pin), dragged) {
                (Part::Limb(limb, joint), Part::Limb(own, _)) if trunk_moves || limb == own => {
                    self.free_limb(poser, limb, joint);
                }
                (Part::Limb(limb, joint), _) if trunk_moves => {
                    self.free_limb(poser, limb, joint);
                    self.free_slide(poser, limb);
                }
                (Part::Neck, _) if trunk_moves => self.free_neck(poser, *pin),
                _ => {}
            }
            self.hold(poser, start, attachment(*pin, poser.facing), PIN_SD_M);
        }
    }

    /// Lets stifle and hock of a hind limb, and elbow and knee of a forelimb, flex together from the bends they have,
    /// where both are free.
    fn couple(&mut self, poser: &PanelPoser, start: &PanelPose) {
        let fold = |limb: Limb| {
            let bend = |i: usize| BENDS + limb.first_bone() + i;
            vec![(bend(3), 1.0 / FOLD_SD), (bend(2), -FOLD_RATIO / FOLD_SD)]
        };
        let folds = [Limb::LF, Limb::RF].map(fold);
        for terms in poser.reciprocal.iter().map(|row| &row.terms).chain(&folds) {
            if terms.iter().all(|(index, _)| self.is_free(*index)) {
                let at_start: f64 = terms.iter().map(|(index, slope)| slope * start[*index]).sum();
                self.rows.push(LinearRow { terms: terms.clone(), constant: -at_start });
            }
        }
    }
}

fn part(poser: &PanelPoser, keypoint: Keypoint) -> Part {
    match keypoint {
        Keypoint::Body(BodyPoint::Muzzle | BodyPoint::Poll) => Part::Neck,
        Keypoint::Body(_) => Part::Trunk,
        Keypoint::Limb(side, pair, joint) => Part::Limb(poser.facing.limb(side, pair), joint),
    }
}

/// What stays: the pins asked for, and hooves in stance. A stance limb that is itself dragged by knee, hock, fetlock or
/// hoof lets go of the ground, because those are dragged in order to move the hoof.
fn pins(poser: &PanelPoser, dragged: Part, handle: Keypoint, options: &DragOptions) -> Vec<Keypoint> {
    let lets_go = |limb: Limb| match dragged {
        Part::Limb(own, joint) => own == limb && !matches!(joint, LimbJoint::Root | LimbJoint::Upper),
        Part::Neck | Part::Trunk => false,
    };
    let on_ground = Limb::ALL
        .into_iter()
        .filter(|limb| poser.contacts[limb.index()] == StanceLabel::Stance && !lets_go(*limb))
        .map(|limb| Keypoint::hoof(poser.facing.near_off(limb.side()), limb.pair()));
    let asked = options.pins.iter().copied();
    let mut pins: Vec<Keypoint> = on_ground.chain(asked).filter(|pin| *pin != handle).collect();
    pins.sort_unstable();
    pins.dedup();
    pins
}
