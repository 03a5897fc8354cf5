//! Why a plate is not calibrated yet, and what to do about it, in words.

use muybridge_capture::{BodyPoint, CalibrationError, Draft, Keypoint, calibrate};

/// What is wrong, and what to do next; none when it can be calibrated.
pub(super) fn words(draft: &Draft) -> Option<[String; 2]> {
    let error = calibrate(&draft.manifest, &draft.annotation).err()?;
    Some(match error {
        CalibrationError::Missing { field: "facing" } => [
            "Nobody has said which way the animal faces.".into(),
            "Choose left or right in the row of pages at the top.".into(),
        ],
        CalibrationError::Missing { .. } => [
            "Nobody has said yet how scale, position and time are known.".into(),
            "Choose it at the right and press Begin calibration.".into(),
        ],
        CalibrationError::TooFewMarks { panel } => [
            format!("Panel {panel} has fewer than two marks, so the known length gives it no scale."),
            "Mark two, copy the marks of another panel, or drive the scale by the withers height.".into(),
        ],
        CalibrationError::NoMark { panel, mark } => [
            format!("Mark {mark} is not placed in panel {panel}, but positions are measured from it."),
            "Place it there, or choose another kind of position.".into(),
        ],
        CalibrationError::NoGround { panel } => [
            format!("Panel {panel} has no ground line."),
            "Draw it under the near hooves, find it, or copy it from another panel.".into(),
        ],
        CalibrationError::NoWithers => [
            "The withers are placed in no panel with a ground line, but their height drives the scale."
                .into(),
            "Place the withers on the Pose page, or drive the scale by a known length.".into(),
        ],
        CalibrationError::NoStance => [
            "No hoof is labelled stance in two neighbouring panels, so the parallax cannot be measured."
                .into(),
            "Place hooves and label them, or give the distances or the ratio of the wall.".into(),
        ],
        CalibrationError::NoAdvance => [
            "No hoof is labelled stance in two neighbouring panels, so the advance cannot be measured."
                .into(),
            "Place hooves and label them, or type the advance.".into(),
        ],
        CalibrationError::NoSimilarity(reason) => [
            format!("The speed cannot be inferred: {reason}."),
            "Say it, or choose another source of time.".into(),
        ],
        CalibrationError::Contradiction(_) if panels_with_trunk(draft) < 2 => [
            "How far the animal goes is not known: its trunk is placed in fewer than two panels.".into(),
            "Place withers, back, croup or dock on the Pose page; scale and ground can be drawn before."
                .into(),
        ],
        CalibrationError::Contradiction(reason) => {
            [format!("The numbers contradict each other: {reason}."), "Correct the one that is wrong.".into()]
        }
    })
}

/// Panels in which a point is placed that rides with the body.
fn panels_with_trunk(draft: &Draft) -> usize {
    let trunk = [BodyPoint::Withers, BodyPoint::Back, BodyPoint::Croup, BodyPoint::Dock];
    let placed = |point: BodyPoint| Keypoint::Body(point);
    let has = |panel: &&muybridge_capture::PanelAnnotation| {
        trunk.iter().any(|point| panel.keypoints.place(placed(*point)).is_some())
    };
    draft.annotation.panels.iter().filter(has).count()
}
