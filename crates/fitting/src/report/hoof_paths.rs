//! Paths of the hooves: seen from the root joint, and height over the ground through the stride.

use muybridge_capture::NearOff;
use muybridge_core::{Limb, Pair};

use super::page::figure;
use super::plot::{Anchor, Axis, Drawn, FULL_WIDTH_PX, Frame, HALF_WIDTH_PX, Ink, Mark, Pen, svg};
use crate::chain::Attachment;
use crate::pipeline::PlateFit;
use crate::stride_curves::StrideCurves;

/// Samples per stride of a drawn curve.
const SAMPLES: usize = 240;
/// Width of a path in the air and on the ground, px.
const WIDTHS_PX: [f64; 2] = [1.5, 4.0];

/// A toe at one moment.
struct Sample {
    /// Phase since the left hind's strike.
    phase: f64,
    /// Ahead of and above the root, m.
    from_root_m: [f64; 2],
    /// Over the ground, m.
    height_m: f64,
}

/// One toe over the stride from the left hind's strike.
struct ToePath {
    limb: Limb,
    samples: Vec<Sample>,
    /// Phases since the left hind's strike.
    strike: f64,
    duty: f64,
}

/// The paths and the heights with their captions.
pub(super) fn hoof_paths(fit: &PlateFit) -> String {
    let paths = toe_paths(fit);
    let sides = [NearOff::Near, NearOff::Off].map(|side| side_picture(fit, &paths, side));
    let seen_from_root = figure(
        &format!("<div class=\"pair\">{}{}</div>", sides[0], sides[1]),
        "The toe seen from the root joint (top of the croup, at 0, 0) over one stride, to equal scales, \
         forward to the right; the stance is drawn thick. Triangles mark foot strike, squares lift-off.",
    );
    let heights = figure(
        &heights_picture(fit, &paths),
        "Height of the four toes over the ground. Fore limbs are drawn in full, hind limbs dashed, the \
         stance thick. A toe does not stand at exactly zero in stance: the ground binds it with a \
         standard deviation of its own.",
    );
    format!("{seen_from_root}{heights}")
}

fn toe_paths(fit: &PlateFit) -> Vec<ToePath> {
    let curves = StrideCurves::new(&fit.fit);
    let origin = fit.analysis.contacts[Limb::LH.index()].strike.phase;
    let poses: Vec<_> = (0..=SAMPLES)
        .map(|k| k as f64 / SAMPLES as f64)
        .map(|phase| (phase, curves.kinematics(origin + phase)))
        .collect();
    Limb::ALL
        .into_iter()
        .map(|limb| {
            let contact = &fit.analysis.contacts[limb.index()];
            let sample = |(phase, k): &(f64, crate::chain::Kinematics)| {
                let ([x, y], [root_x, root_y]) =
                    (k.place(Attachment::Tip(limb.hoof_bone())), k.place(Attachment::Root));
                Sample { phase: *phase, from_root_m: [x - root_x, y - root_y], height_m: y }
            };
            ToePath {
                limb,
                samples: poses.iter().map(sample).collect(),
                strike: fit.analysis.lags[limb.index()],
                duty: contact.duty_factor(),
            }
        })
        .collect()
}

impl ToePath {
    fn is_down(&self, phase: f64) -> bool {
        (phase - self.strike).rem_euclid(1.0) <= self.duty
    }

    /// Runs of the path in the air and on the ground in turn, of two widths; neighbours share an end.
    fn draw(&self, pen: &Pen<'_>, ink: Ink, dashed: bool, to_px: &dyn Fn(&Sample) -> [f64; 2]) -> Drawn {
        let mut run: Vec<[f64; 2]> = Vec::new();
        let mut was_down = self.is_down(0.5 / SAMPLES as f64);
        let stroke = |run: &[[f64; 2]], down: bool| match (down, dashed) {
            (true, _) => pen.line(run, ink, WIDTHS_PX[1]),
            (false, true) => pen.dashed(run, ink, WIDTHS_PX[0]),
            (false, false) => pen.line(run, ink, WIDTHS_PX[0]),
        };
        for pair in self.samples.windows(2) {
            let down = self.is_down(0.5 * (pair[0].phase + pair[1].phase));
            if down != was_down {
                stroke(&run, was_down)?;
                run.clear();
                was_down = down;
            }
            if run.is_empty() {
                run.push(to_px(&pair[0]));
            }
            run.push(to_px(&pair[1]));
        }
        stroke(&run, was_down)
    }

    /// The sample nearest to a phase.
    fn nearest(&self, phase: f64) -> &Sample {
        &self.samples[(phase.rem_euclid(1.0) * SAMPLES as f64).round() as usize]
    }
}

/// Both toes of one side, at the scale that both sides share.
fn side_picture(fit: &PlateFit, paths: &[ToePath], side: NearOff) -> String {
    let all = || paths.iter().flat_map(|path| &path.samples).map(|sample| sample.from_root_m);
    let reach = |axis: usize| {
        let low = all().map(|p| p[axis]).fold(0.0, f64::min);
        let high = all().map(|p| p[axis]).fold(0.0, f64::max);
        [low - 0.12, high + 0.12]
    };
    let (xs, ys) = (reach(0), reach(1));
    let (left, right, top) = (46.0, HALF_WIDTH_PX - 12.0, 36.0);
    let bottom = top + (right - left) * (ys[1] - ys[0]) / (xs[1] - xs[0]);
    let frame =
        Frame { x: Axis { values: xs, px: [left, right] }, y: Axis { values: ys, px: [bottom, top] } };
    let (ink, name) = (super::ink_of_side(side), format!("{side:?}"));
    svg(&format!("{name} hooves seen from the root joint"), [HALF_WIDTH_PX, bottom + 36.0], |pen| {
        frame.draw(pen, [8, 5], ["m ahead of the root", "m above the root"])?;
        pen.text([right, top - 16.0], &format!("{} side", name.to_lowercase()), 13.0, ink, Anchor::End)?;
        pen.dot(frame.at([0.0, 0.0]), 4.0, Ink::Body, 1.0)?;
        pen.label([frame.x.at(0.0) + 8.0, frame.y.at(0.0)], "root", Anchor::Start)?;
        for pair in [Pair::Fore, Pair::Hind] {
            let path = &paths[fit.plate.facing.limb(side, pair).index()];
            path.draw(pen, ink, false, &|sample| frame.at(sample.from_root_m))?;
            pen.mark(frame.at(path.nearest(path.strike).from_root_m), Mark::Triangle, 5.0, ink)?;
            pen.mark(frame.at(path.nearest(path.strike + path.duty).from_root_m), Mark::Square, 4.0, ink)?;
            let highest = path.samples.iter().map(|s| s.from_root_m).max_by(|a, b| a[1].total_cmp(&b[1]));
            let [x, y] = frame.at(highest.unwrap_or_default());
            pen.text([x, y - 11.0], path.limb.abbreviation(), 13.0, ink, Anchor::Middle)?;
        }
        Ok(())
    })
}

fn heights_picture(fit: &PlateFit, paths: &[ToePath]) -> String {
    let heights_cm = || paths.iter().flat_map(|path| &path.samples).map(|sample| 100.0 * sample.height_m);
    let (low, high) = (heights_cm().fold(0.0, f64::min), heights_cm().fold(10.0, f64::max));
    let (left, right, top, bottom) = (46.0, FULL_WIDTH_PX - 16.0, 36.0, 256.0);
    let frame = Frame {
        x: Axis { values: [0.0, 100.0], px: [left, right] },
        y: Axis { values: [low - 2.0, 1.15 * high], px: [bottom, top] },
    };
    svg("Height of the toes through the stride", [FULL_WIDTH_PX, bottom + 36.0], |pen| {
        frame.draw(pen, [11, 6], ["% of stride from the left hind's strike", "cm over the ground"])?;
        pen.line(&[frame.at([0.0, 0.0]), frame.at([100.0, 0.0])], Ink::Ground, 1.25)?;
        for path in paths {
            let ink = super::ink_of_side(fit.plate.facing.near_off(path.limb.side()));
            let at = |sample: &Sample| frame.at([100.0 * sample.phase, 100.0 * sample.height_m]);
            path.draw(pen, ink, path.limb.pair() == Pair::Hind, &at)?;
            if let Some(top) = path.samples.iter().max_by(|a, b| a.height_m.total_cmp(&b.height_m)) {
                let [x, y] = at(top);
                pen.text([x, y - 10.0], path.limb.abbreviation(), 13.0, ink, Anchor::Middle)?;
            }
        }
        Ok(())
    })
}
