//! The fitted stride at any phase, and over any photograph.

use muybridge_capture::{Facing, PanelAnnotation};
use muybridge_core::{Limb, Skeleton};
use muybridge_fitting::layout::SHARED;
use muybridge_fitting::pipeline::PlateFit;
use muybridge_fitting::posing::{BonePlace, PanelPose, PanelPoser};
use muybridge_fitting::stride_curves::StrideCurves;

/// A photograph this little before the end of a turn belongs to the next one: rounding of the stride time.
const SAME_PHASE: f64 = 1e-6;

/// A bone over a photograph.
pub(super) struct DrawnBone {
    /// Where it is.
    pub(super) place: BonePlace,
    /// Whether it is that of a hoof that stands.
    pub(super) stands: bool,
}

/// The stride of a fitted plate.
pub(super) struct Motion<'a> {
    plate: &'a PlateFit,
    reference: &'a Skeleton,
    curves: StrideCurves<'a>,
    lengths: [f64; SHARED],
    /// Panels with the strides since the first of them, in order of time.
    panels: Vec<(u32, f64)>,
}

impl<'a> Motion<'a> {
    pub(super) fn new(plate: &'a PlateFit, reference: &'a Skeleton) -> Self {
        let fit = &plate.fit;
        let number = |slot: usize| fit.observation.panels[fit.problem.order[slot]].camera.panel;
        let mut panels: Vec<(u32, f64)> =
            (0..fit.problem.layout.panels).map(|slot| (number(slot), fit.turns(slot))).collect();
        panels.sort_by(|a, b| a.1.total_cmp(&b.1));
        let lengths = std::array::from_fn(|i| fit.shared()[i]);
        Self { plate, reference, curves: StrideCurves::new(fit), lengths, panels }
    }

    /// Duration of the stride, s.
    pub(super) fn stride_s(&self) -> f64 {
        self.plate.fit.stride_time.seconds
    }

    /// Length of the stride as it was fitted, m.
    pub(super) fn stride_length_m(&self) -> f64 {
        self.plate.fit.problem.stride_length_m
    }

    /// Which way the animal faces.
    pub(super) fn facing(&self) -> Facing {
        self.plate.plate.facing
    }

    /// The fitted log-lengths.
    pub(super) fn lengths(&self) -> &[f64; SHARED] {
        &self.lengths
    }

    /// Phase of a panel's photograph; none for a panel that is not of the stride.
    pub(super) fn phase_of(&self, panel: u32) -> Option<f64> {
        self.turns(panel).map(|turns| turns.rem_euclid(1.0))
    }

    fn turns(&self, panel: u32) -> Option<f64> {
        self.panels.iter().find(|(number, _)| *number == panel).map(|(_, turns)| *turns)
    }

    /// The panel nearest in phase, of those of the first turn: where a plate shows more than one stride, its end would
    /// otherwise alternate with its beginning.
    pub(super) fn panel_near(&self, phase: f64) -> Option<u32> {
        let apart = |turns: f64| {
            let after = (phase - turns).rem_euclid(1.0);
            after.min(1.0 - after)
        };
        let first_turn = self.panels.iter().filter(|(_, turns)| *turns < 1.0 - SAME_PHASE);
        first_turn.min_by(|a, b| apart(a.1).total_cmp(&apart(b.1))).map(|(panel, _)| *panel)
    }

    /// The panel so many photographs later, around the stride; the first for a panel that is not of it.
    pub(super) fn panel_after(&self, panel: u32, steps: i64) -> Option<u32> {
        let count = self.panels.len() as i64;
        let at = self.panels.iter().position(|(number, _)| *number == panel);
        let to = at.map_or(0, |at| (at as i64 + steps).rem_euclid(count.max(1)) as usize);
        self.panels.get(to).map(|(number, _)| *number)
    }

    /// The pose at a phase; whole strides add their length.
    pub(super) fn pose(&self, phase: f64) -> Option<PanelPose> {
        self.curves.pose(phase).try_into().ok()
    }

    /// Whether a leg's hoof is down at a phase.
    pub(super) fn stands(&self, limb: Limb, phase: f64) -> bool {
        self.plate.analysis.contacts[limb.index()].contains(phase)
    }

    /// The skeleton at a phase over a panel's photograph: where the animal is in the turn of the stride that this
    /// photograph belongs to, half a stride before or after it at most.
    pub(super) fn bones_px(&self, panel: u32, phase: f64) -> Option<Vec<DrawnBone>> {
        let turns = self.turns(panel)?;
        let observed = self.plate.fit.observation.panels.iter().find(|p| p.camera.panel == panel)?;
        let contacts = PanelAnnotation::empty(panel).contacts;
        let poser = PanelPoser::new(self.reference, self.facing(), &self.lengths, observed.camera, &contacts);
        let by = (phase - turns + 0.5).rem_euclid(1.0) - 0.5;
        let bones = poser.bones_px(&self.pose(turns + by)?);
        let stands = |index: usize| {
            let limb = Skeleton::limb_of(index);
            limb.is_some_and(|limb| limb.hoof_bone() == index && self.stands(limb, phase))
        };
        Some(bones.into_iter().enumerate().map(|(i, place)| DrawnBone { place, stands: stands(i) }).collect())
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use muybridge_capture::{Keypoint, NearOff, Plate};
    use muybridge_core::Pair;
    use muybridge_fitting::pipeline::fit_loaded;
    use muybridge_fitting::weights::Weights;

    use super::*;

    #[test]
    fn the_stride_lies_on_every_photograph_and_moves_evenly_between_them() {
        let specimens = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../plates/specimens/annotations");
        let skeleton = Skeleton::reference();
        let plate = Plate::load(&specimens.join("specimen-gallop.json")).unwrap();
        let plate = fit_loaded(plate, &skeleton, &Weights::default()).unwrap();
        let motion = Motion::new(&plate, &skeleton);
        let hoof = motion.facing().limb(NearOff::Near, Pair::Hind).hoof_bone();
        let tip = |panel: u32, phase: f64| motion.bones_px(panel, phase).unwrap()[hoof].place.ends_px[1];
        let apart = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]);
        for panel in 1..=12 {
            let phase = motion.phase_of(panel).unwrap();
            assert_eq!(motion.panel_near(phase), Some(panel));
            let placed = plate.plate.annotation.panels.iter().find(|p| p.panel == panel).unwrap();
            let placed = placed.keypoints.place(Keypoint::hoof(NearOff::Near, Pair::Hind)).unwrap();
            assert!(apart(tip(panel, phase), placed) < 3.0, "panel {panel}");
            assert!(apart(tip(panel, phase), tip(panel, phase + 1e-3)) < 3.0, "panel {panel} jumps");
        }
        assert!(motion.bones_px(99, 0.0).is_none());
    }
}
