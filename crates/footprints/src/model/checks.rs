//! Whether the numbers of a model can be.

use std::ops::RangeInclusive;

use super::{FootModel, LegModel, MODEL_SCHEMA, Model, Sway};
use crate::leg::Chain;
use crate::shape::{Shape, TubeModel};

/// Lengths of a body, metres: from a wren's foot to the largest theropods, and some way beyond.
const LENGTH_M: RangeInclusive<f64> = 1e-3..=20.0;
/// Coordinates in a body, metres.
const PLACE_M: RangeInclusive<f64> = -20.0..=20.0;
/// A share.
const SHARE: RangeInclusive<f64> = 0.0..=1.0;
/// Window of the body's orientation, s; 0 follows the feet at once.
const WINDOW_S: RangeInclusive<f64> = 0.0..=60.0;
/// Sways beyond this are falls, degrees.
const SWAY_DEG: RangeInclusive<f64> = 0.0..=45.0;
/// A foot on its toes is not turned further than upright, degrees.
const RISE_DEG: RangeInclusive<f64> = 0.0..=90.0;
/// No joint folds further, degrees.
const FOLD_DEG: RangeInclusive<f64> = 1.0..=175.0;
/// Step lengths, metres.
const STEP_M: RangeInclusive<f64> = 0.01..=20.0;
/// Step widths, metres.
const WIDTH_M: RangeInclusive<f64> = 0.0..=5.0;
/// Most corners, sections or tubes in one list.
const MOST_ENTRIES: usize = 1000;

/// What is wrong, if anything.
pub(super) fn check(model: &Model) -> Result<(), String> {
    if model.schema != MODEL_SCHEMA {
        return Err(format!("schema is {}; this program reads schema {MODEL_SCHEMA}", model.schema));
    }
    leg(&model.leg)?;
    foot(&model.leg.foot)?;
    within("body_window_s", model.body_window_s, WINDOW_S)?;
    sway("pitch", model.pitch)?;
    sway("roll", model.roll)?;
    within("step_m (length)", model.step_m[0], STEP_M)?;
    within("step_m (width)", model.step_m[1], WIDTH_M)?;
    model.timing.fault().map_or(Ok(()), |fault| Err(format!("timing: {fault}")))?;
    shape(&model.shape, model.leg.segments_m.len())
}

/// A number between two others; NaN is not.
fn within(what: &str, value: f64, range: RangeInclusive<f64>) -> Result<(), String> {
    if range.contains(&value) {
        return Ok(());
    }
    Err(format!("{what} is {value}; it must be between {} and {}", range.start(), range.end()))
}

/// A list that is neither too short nor too long.
fn count(what: &str, entries: usize, least: usize) -> Result<(), String> {
    if (least..=MOST_ENTRIES).contains(&entries) {
        return Ok(());
    }
    Err(format!("{what} has {entries} entries; it must have between {least} and {MOST_ENTRIES}"))
}

fn leg(leg: &LegModel) -> Result<(), String> {
    for (axis, value) in ["ahead", "up"].iter().zip(leg.hip_from_com_m) {
        within(&format!("leg.hip_from_com_m ({axis})"), value, PLACE_M)?;
    }
    within("leg.hip_from_com_m (to the right)", leg.hip_from_com_m[2], 0.0..=*PLACE_M.end())?;
    if ![2, 3].contains(&leg.segments_m.len()) {
        return Err(format!("leg.segments_m has {} lengths; a leg has 2 or 3", leg.segments_m.len()));
    }
    if leg.fold_deg.len() + 1 != leg.segments_m.len() {
        return Err("leg.fold_deg must have one angle for each joint between two segments".into());
    }
    leg.segments_m.iter().try_for_each(|&length| within("leg.segments_m", length, LENGTH_M))?;
    leg.fold_deg.iter().try_for_each(|&angle| within("leg.fold_deg", angle, FOLD_DEG))?;
    within("leg.nominal_m", leg.nominal_m, LENGTH_M)?;
    within("leg.longest_m", leg.longest_m, LENGTH_M)?;
    within("leg.retracted", leg.retracted, SHARE)?;
    within("leg.retracted_running", leg.retracted_running, SHARE)?;
    let chain = Chain::of(leg);
    if leg.longest_m > chain.longest_m() {
        let sum = chain.longest_m();
        return Err(format!("leg.longest_m is {} m; the segments together are {sum} m long", leg.longest_m));
    }
    if leg.nominal_m >= leg.longest_m {
        return Err(format!("leg.nominal_m is {} m; it must be below longest_m", leg.nominal_m));
    }
    let least = leg.nominal_m * leg.retracted.min(leg.retracted_running);
    if least < chain.shortest_m() {
        let shortest = chain.shortest_m();
        return Err(format!(
            "leg.fold_deg folds the leg to {shortest:.3} m only; retracted it is to be {least:.3} m long"
        ));
    }
    Ok(())
}

fn foot(foot: &FootModel) -> Result<(), String> {
    within("leg.foot.toe_ahead_m", foot.toe_ahead_m, LENGTH_M)?;
    within("leg.foot.ankle_m (ahead)", foot.ankle_m[0], -foot.toe_ahead_m..=foot.toe_ahead_m)?;
    within("leg.foot.ankle_m (up)", foot.ankle_m[1], 0.0..=*LENGTH_M.end())?;
    within("leg.foot.most_heel_rise_deg", foot.most_heel_rise_deg, RISE_DEG)?;
    within("leg.foot.heel_off_at", foot.heel_off_at, SHARE)?;
    within("leg.foot.toe_off_rise_deg", foot.toe_off_rise_deg, 0.0..=foot.most_heel_rise_deg)?;
    within("leg.foot.swing_droop_deg", foot.swing_droop_deg, RISE_DEG)?;
    within("leg.foot.swing_clearance_m", foot.swing_clearance_m, 0.0..=*LENGTH_M.end())?;
    count("leg.foot.outline_m", foot.outline_m.len(), 3)?;
    let mut all = foot.outline_m.iter().flatten();
    all.try_for_each(|&value| within("leg.foot.outline_m", value, PLACE_M))
}

fn sway(what: &str, sway: Sway) -> Result<(), String> {
    within(&format!("{what}.amplitude_deg"), sway.amplitude_deg, SWAY_DEG)?;
    within(&format!("{what}.greatest_at"), sway.greatest_at, SHARE)
}

fn shape(shape: &Shape, segments: usize) -> Result<(), String> {
    if shape.legs.len() != segments {
        return Err(format!("shape.legs has {} entries; the leg has {segments} segments", shape.legs.len()));
    }
    let mut radii = shape.legs.iter().flat_map(|segment| segment.radii_m);
    radii.try_for_each(|radius_m| within("shape.legs", radius_m, LENGTH_M))?;
    for (what, tubes) in [("shape.body", &shape.body), ("shape.foot", &shape.foot)] {
        count(what, tubes.len(), 1)?;
        tubes.iter().try_for_each(|one| tube(what, one))?;
    }
    Ok(())
}

fn tube(what: &str, tube: &TubeModel) -> Result<(), String> {
    count(what, tube.points_m.len(), 2)?;
    if tube.radii_m.len() != tube.points_m.len() {
        return Err(format!("{what}: a tube has as many radii_m as points_m"));
    }
    tube.points_m.iter().flatten().try_for_each(|&value| within(what, value, PLACE_M))?;
    tube.radii_m.iter().flatten().try_for_each(|&value| within(what, value, LENGTH_M))?;
    tube.up.iter().try_for_each(|&value| within(what, value, -1.0..=1.0))?;
    within(what, tube.swing, -2.0..=2.0)
}
