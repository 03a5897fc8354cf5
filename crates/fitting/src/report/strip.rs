//! The stride as a strip of stick figures: the fitted skeleton in each panel, to scale, on the ground line.

use muybridge_capture::{KeypointState, NearOff, StanceLabel};
use muybridge_core::{Limb, Pair, bone};

use super::page::figure;
use super::plot::{Anchor, Drawn, FULL_WIDTH_PX, Ink, LABEL_PX, Pen, svg};
use crate::chain::{Attachment, Kinematics};
use crate::observation::{PanelObservation, attachment, depth_m};
use crate::pipeline::PlateFit;
use crate::stride_fit::StrideFit;

/// Height of the legend, px.
const LEGEND_PX: f64 = 34.0;
/// Room under the ground line for the panel's number, px.
const FOOT_PX: f64 = 46.0;
/// Room around a figure, px.
const MARGIN_PX: f64 = 12.0;

/// One panel: its observation, pose, and where its picture is cut out of the track.
struct Still<'a> {
    fit: &'a StrideFit,
    panel: &'a PanelObservation,
    kinematics: Kinematics,
    down: [bool; 4],
    /// Rearmost and foremost point, m along the track.
    span_m: [f64; 2],
    top_m: f64,
}

/// The strip with its caption.
pub(super) fn strip(fit: &PlateFit) -> String {
    let stills = stills(fit);
    let columns = columns(stills.len());
    let rows = stills.len().div_ceil(columns).max(1);
    let cell_px = FULL_WIDTH_PX / columns as f64;
    let widest_m = stills.iter().map(|s| s.span_m[1] - s.span_m[0]).fold(1.0, f64::max);
    let tallest_m = stills.iter().map(|s| s.top_m).fold(1.0, f64::max);
    let px_per_m = (cell_px - 2.0 * MARGIN_PX) / widest_m;
    let row_px = tallest_m * px_per_m + FOOT_PX + MARGIN_PX;
    let size = [FULL_WIDTH_PX, LEGEND_PX + rows as f64 * row_px];
    let title = format!("Stick figures of {} in {} panels", fit.plate.manifest.animal, stills.len());
    let picture = svg(&title, size, |pen| {
        legend(pen, px_per_m)?;
        stills.iter().enumerate().try_for_each(|(i, still)| {
            let left = (i % columns) as f64 * cell_px;
            let ground = LEGEND_PX + (i / columns + 1) as f64 * row_px - FOOT_PX;
            let middle_m = 0.5 * (still.span_m[0] + still.span_m[1]);
            let to_px =
                |[x, y]: [f64; 2]| [left + 0.5 * cell_px + (x - middle_m) * px_per_m, ground - y * px_per_m];
            still.draw(pen, [left, cell_px, ground], &to_px)
        })
    });
    let near = super::plate::near_side(fit);
    let caption = format!(
        "The fitted skeleton in every panel, in order of time and to one scale; forward is to the right \
         whichever way the animal faces on the plate. Near is the animal&#8217;s {near} side. Dots are \
         the points a person placed, carried to the track by the panel&#8217;s camera: filled where seen, \
         hollow where guessed. Bars under the ground line mark hooves in stance."
    );
    figure(&picture, &caption)
}

/// One row up to six panels; four or six in a row beyond that, as on Muybridge's cards.
fn columns(panels: usize) -> usize {
    match panels {
        0..=6 => panels.max(1),
        7..=12 => 4,
        _ => 6,
    }
}

fn stills(fit: &PlateFit) -> Vec<Still<'_>> {
    let stride = &fit.fit;
    let mut slots: Vec<(usize, Kinematics)> = stride.kinematics().into_iter().enumerate().collect();
    slots.sort_by_key(|(slot, _)| stride.problem.order[*slot]);
    let still = |(slot, kinematics): (usize, Kinematics)| {
        let panel = &stride.observation.panels[stride.problem.order[slot]];
        let down = feet_down(fit, slot);
        let mut still = Still { fit: stride, panel, kinematics, down, span_m: [0.0; 2], top_m: 0.0 };
        let places = still.all_places();
        let extreme = |axis: usize, start: f64, pick: fn(f64, f64) -> f64| {
            places.iter().map(|place| place[axis]).fold(start, pick)
        };
        still.span_m = [extreme(0, f64::INFINITY, f64::min), extreme(0, f64::NEG_INFINITY, f64::max)];
        still.top_m = extreme(1, 0.0, f64::max);
        still
    };
    slots.into_iter().map(still).collect()
}

/// Feet down in a slot's panel, in the order of [`Limb::ALL`]: as labelled, else as the analysis has it.
pub(super) fn feet_down(fit: &PlateFit, slot: usize) -> [bool; 4] {
    let problem = &fit.fit.problem;
    let labels = &fit.fit.observation.panels[problem.order[slot]].contacts;
    Limb::ALL.map(|limb| match labels[limb.index()] {
        StanceLabel::Stance => true,
        StanceLabel::Swing => false,
        StanceLabel::Unknown => fit.analysis.contacts[limb.index()].contains(problem.phases[slot]),
    })
}

impl Still<'_> {
    /// Joints and placed points, m.
    fn all_places(&self) -> Vec<[f64; 2]> {
        let joints = (0..muybridge_core::BONE_COUNT).flat_map(|bone| self.kinematics.bone(bone));
        let dots = self.placed().into_iter().map(|(place, ..)| place);
        joints.chain([self.kinematics.place(Attachment::Dock)]).chain(dots).collect()
    }

    /// Placed points on the track, m, with their colour and whether they were seen.
    fn placed(&self) -> Vec<([f64; 2], Ink, bool)> {
        let facing = self.fit.observation.facing;
        let dot = |point: &crate::observation::PointObservation| {
            let on = attachment(point.keypoint, facing);
            let depth = depth_m(&self.fit.problem.chain, on, facing);
            let [x, y, _] = self.panel.camera.world_from_plate(point.at_px, depth);
            ([x, y], super::ink_of(point.keypoint), point.state == KeypointState::Visible)
        };
        self.panel.points.iter().map(dot).collect()
    }

    /// `cell` is the cell's left edge, width and ground line, px.
    fn draw(
        &self,
        pen: &Pen<'_>,
        [left, width, ground]: [f64; 3],
        to_px: &dyn Fn([f64; 2]) -> [f64; 2],
    ) -> Drawn {
        pen.line(&[[left + 4.0, ground], [left + width - 4.0, ground]], Ink::Ground, 1.0)?;
        self.limbs(pen, NearOff::Off, to_px)?;
        self.body(pen, to_px)?;
        self.limbs(pen, NearOff::Near, to_px)?;
        for (place, ink, seen) in self.placed() {
            let at = to_px(place);
            if seen { pen.dot(at, 2.2, ink, 1.0)? } else { pen.ring(at, 2.0, ink)? }
        }
        let middle = left + 0.5 * width;
        let camera = &self.panel.camera;
        pen.text(
            [middle - 5.0, ground + 24.0],
            &camera.panel.to_string(),
            LABEL_PX + 1.0,
            Ink::Text,
            Anchor::End,
        )?;
        pen.label([middle + 3.0, ground + 24.0], &format!("{:.0} ms", 1000.0 * camera.time_s), Anchor::Start)
    }

    fn body(&self, pen: &Pen<'_>, to_px: &dyn Fn([f64; 2]) -> [f64; 2]) -> Drawn {
        let mut outline = vec![
            to_px(self.kinematics.place(Attachment::Dock)),
            to_px(self.kinematics.place(Attachment::Root)),
        ];
        outline.extend((bone::SPINE..=bone::HEAD).map(|bone| to_px(self.kinematics.bone(bone)[1])));
        pen.line(&outline, Ink::Body, 3.0)
    }

    fn limbs(&self, pen: &Pen<'_>, side: NearOff, to_px: &dyn Fn([f64; 2]) -> [f64; 2]) -> Drawn {
        let ink = if side == NearOff::Near { Ink::Near } else { Ink::Off };
        for pair in [Pair::Fore, Pair::Hind] {
            let limb = self.fit.observation.facing.limb(side, pair);
            let first = limb.first_bone();
            let mut joints = vec![to_px(self.kinematics.bone(first)[0])];
            joints.extend((first..first + 5).map(|bone| to_px(self.kinematics.bone(bone)[1])));
            pen.line(&joints, ink, 2.4)?;
            if self.down[limb.index()] {
                let [x, _] = to_px(self.kinematics.bone(limb.hoof_bone())[1]);
                let [_, ground] = to_px([0.0, 0.0]);
                let (top, depth) = if side == NearOff::Near { (2.0, 4.0) } else { (6.5, 4.0) };
                pen.rectangle([x - 9.0, ground + top], [x + 9.0, ground + top + depth], ink, 1.0)?;
            }
        }
        Ok(())
    }
}

fn legend(pen: &Pen<'_>, px_per_m: f64) -> Drawn {
    let y = 12.0;
    let lines = [(0.0, Ink::Near, "near limbs"), (110.0, Ink::Off, "off limbs"), (212.0, Ink::Body, "body")];
    for (x, ink, name) in lines {
        pen.line(&[[x, y], [x + 24.0, y]], ink, 3.0)?;
        pen.label([x + 30.0, y], name, Anchor::Start)?;
    }
    pen.dot([302.0, y], 2.2, Ink::Body, 1.0)?;
    pen.label([310.0, y], "placed, seen", Anchor::Start)?;
    pen.ring([402.0, y], 2.0, Ink::Body)?;
    pen.label([410.0, y], "placed, guessed", Anchor::Start)?;
    pen.rectangle([522.0, y - 2.0], [540.0, y + 2.0], Ink::Body, 1.0)?;
    pen.label([546.0, y], "hoof in stance", Anchor::Start)?;
    let right = FULL_WIDTH_PX - 4.0;
    let left = right - px_per_m;
    pen.line(&[[left, y - 4.0], [left, y + 4.0]], Ink::Muted, 1.0)?;
    pen.line(&[[right, y - 4.0], [right, y + 4.0]], Ink::Muted, 1.0)?;
    pen.line(&[[left, y], [right, y]], Ink::Muted, 1.0)?;
    pen.label([left - 6.0, y], "1 m", Anchor::End)
}
