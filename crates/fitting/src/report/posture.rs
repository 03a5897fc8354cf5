//! One posture of a contact sheet: a stick figure on its ground line, with the feet that are down.

use muybridge_capture::{Facing, NearOff};
use muybridge_core::{Limb, Pair, Skeleton, Stride, bone};

use super::page::number;
use super::plot::{Anchor, Drawn, Ink, LABEL_PX, Pen};
use super::strip;
use crate::chain::{Attachment, Kinematics};
use crate::pipeline::PlateFit;

/// Postures of a stride: as many as Muybridge's first plates have.
pub(super) const POSTURES: usize = 12;
/// Room on both sides of a figure, px.
pub(super) const MARGIN_PX: f64 = 8.0;
/// Places of the four feet's names about the middle of a cell, px.
const FEET_PX: [f64; 4] = [-42.0, -14.0, 14.0, 42.0];

/// One posture: joints about the middle of the trunk, m ahead of it and over the ground.
pub(super) struct Posture {
    pub(super) label: String,
    body: Vec<[f64; 2]>,
    limbs: [Vec<[f64; 2]>; 4],
    pub(super) down: [bool; 4],
}

/// Where on the sheet a posture is drawn.
pub(super) struct Cell {
    pub(super) left_px: f64,
    pub(super) ground_px: f64,
    pub(super) width_px: f64,
    pub(super) px_per_m: f64,
    /// Rearmost point of all postures, m ahead of the middle of the trunk.
    pub(super) rear_m: f64,
}

impl Cell {
    fn at(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [self.left_px + MARGIN_PX + (x - self.rear_m) * self.px_per_m, self.ground_px - y * self.px_per_m]
    }
}

impl Posture {
    /// A posture from the places of the dock, the root and each bone's base and tip, m.
    fn new(
        label: String,
        down: [bool; 4],
        [dock, root]: [[f64; 2]; 2],
        bone: &dyn Fn(usize) -> [[f64; 2]; 2],
    ) -> Self {
        let middle_m = 0.5 * (root[0] + bone(bone::SPINE_LAST)[1][0]);
        let about = |[x, y]: [f64; 2]| [x - middle_m, y];
        let spine = (bone::SPINE..=bone::HEAD).map(|i| bone(i)[1]);
        let body = [dock, root].into_iter().chain(spine).map(about).collect();
        let limbs = Limb::ALL.map(|limb| {
            let first = limb.first_bone();
            let joints = [bone(first)[0]].into_iter().chain((first..=limb.hoof_bone()).map(|i| bone(i)[1]));
            joints.map(about).collect()
        });
        Self { label, body, limbs, down }
    }

    /// All joints.
    pub(super) fn points(&self) -> impl Iterator<Item = &[f64; 2]> {
        self.body.iter().chain(self.limbs.iter().flatten())
    }

    /// Off limbs, body, near limbs, the feet that are down and the label.
    pub(super) fn draw(&self, pen: &Pen<'_>, cell: &Cell, facing: Facing) -> Drawn {
        let ground = cell.ground_px;
        pen.line(
            &[[cell.left_px + 3.0, ground], [cell.left_px + cell.width_px - 3.0, ground]],
            Ink::Ground,
            1.0,
        )?;
        self.draw_limbs(pen, cell, facing, NearOff::Off)?;
        pen.line(&self.body.iter().map(|place| cell.at(*place)).collect::<Vec<_>>(), Ink::Body, 2.6)?;
        self.draw_limbs(pen, cell, facing, NearOff::Near)?;
        let middle = cell.left_px + 0.5 * cell.width_px;
        for (limb, across) in Limb::ALL.into_iter().zip(FEET_PX) {
            let at = [middle + across, ground + 15.0];
            if self.down[limb.index()] {
                let ink = ink_of(facing.near_off(limb.side()));
                pen.text(at, limb.abbreviation(), LABEL_PX, ink, Anchor::Middle)?;
            } else {
                pen.label(at, "\u{b7}", Anchor::Middle)?;
            }
        }
        pen.label([middle, ground + 31.0], &self.label, Anchor::Middle)
    }

    fn draw_limbs(&self, pen: &Pen<'_>, cell: &Cell, facing: Facing, near_off: NearOff) -> Drawn {
        for pair in [Pair::Fore, Pair::Hind] {
            let limb = facing.limb(near_off, pair);
            let joints: Vec<[f64; 2]> =
                self.limbs[limb.index()].iter().map(|place| cell.at(*place)).collect();
            pen.line(&joints, ink_of(near_off), 2.2)?;
            if let (true, Some(toe)) = (self.down[limb.index()], joints.last()) {
                pen.dot(*toe, 4.0, ink_of(near_off), 1.0)?;
            }
        }
        Ok(())
    }
}

/// Near limbs dark, off limbs lighter.
pub(super) fn ink_of(near_off: NearOff) -> Ink {
    match near_off {
        NearOff::Near => Ink::NearDark,
        NearOff::Off => Ink::OffLight,
    }
}

/// Twelve postures of a stride, from the left hind's strike.
pub(super) fn postures_of_stride(stride: &Stride, reference: &Skeleton) -> Vec<Posture> {
    let skeleton = stride.skeleton(reference);
    let posture = |k: usize| {
        let phase = k as f32 / POSTURES as f32;
        let joints = stride.pose(phase).joints(&skeleton);
        let flat = |[x, y, _]: [f32; 3]| [f64::from(x), f64::from(y)];
        let bone = |i: usize| [joints.bases[i], joints.tips[i]].map(|point| flat(point.to_array()));
        let places = [joints.dock, joints.root].map(|point| flat(point.to_array()));
        Posture::new(format!("phase {k}/{POSTURES}"), stride.support(phase), places, &bone)
    };
    (0..POSTURES).map(posture).collect()
}

/// The plate's panel nearest in phase to each of the twelve moments.
pub(super) fn postures_of_plate(fit: &PlateFit) -> Vec<Posture> {
    let stride = &fit.fit;
    let origin = fit.analysis.contacts[Limb::LH.index()].strike.phase;
    let slots: Vec<(f64, Kinematics)> = stride
        .kinematics()
        .into_iter()
        .zip(&stride.problem.phases)
        .map(|(kinematics, phase)| ((phase - origin).rem_euclid(1.0), kinematics))
        .collect();
    let posture = |k: usize| {
        let wanted = k as f64 / POSTURES as f64;
        let off = |phase: f64| (phase - wanted + 0.5).rem_euclid(1.0) - 0.5;
        let nearest = |slot: &usize| off(slots[*slot].0).abs();
        let slot = (0..slots.len()).min_by(|a, b| nearest(a).total_cmp(&nearest(b)))?;
        let (phase, kinematics) = &slots[slot];
        let panel = stride.observation.panels[stride.problem.order[slot]].camera.panel;
        let label = format!("panel {panel}, {}/{POSTURES}", number(POSTURES as f64 * phase, 1));
        let places = [Attachment::Dock, Attachment::Root].map(|point| kinematics.place(point));
        Some(Posture::new(label, strip::feet_down(fit, slot), places, &|i| kinematics.bone(i)))
    };
    (0..POSTURES).filter_map(posture).collect()
}
