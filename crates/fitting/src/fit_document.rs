//! The fit of a plate as a file of its own, next to the annotation it was made from and never in place of it.

use muybridge_core::{BONE_COUNT, Skeleton};
use serde::Serialize;

use muybridge_capture::Keypoint;

use crate::layout::{BENDS, PITCH, ROOT_X, ROOT_Y, SLIDES};
use crate::pipeline::PlateFit;

/// Schema version of a fit file.
pub const FIT_SCHEMA: u32 = 1;

/// A fitted plate for other programs.
#[derive(Debug, Serialize)]
pub struct FitDocument {
    schema: u32,
    plate: String,
    annotation_sha256: String,
    stride_time_s: f64,
    stride_time_sd_s: f64,
    speed_m_s: f64,
    px_rms: f64,
    bones: Vec<BoneDocument>,
    panels: Vec<PanelDocument>,
}

#[derive(Debug, Serialize)]
struct BoneDocument {
    bone: String,
    length_m: f64,
    /// Standard error of the length, relative.
    relative_error: Option<f64>,
}

#[derive(Debug, Serialize)]
struct PanelDocument {
    panel: u32,
    time_s: f64,
    phase: f64,
    root_m: [f64; 2],
    pitch_deg: f64,
    bends_deg: Vec<f64>,
    /// Standard error of each bend.
    bend_errors_deg: Option<Vec<f64>>,
    scapula_slides_m: [f64; 2],
    keypoints_px: serde_json::Map<String, serde_json::Value>,
}

impl FitDocument {
    /// Collects a fitted plate; panels in the order of time.
    pub fn new(fitted: &PlateFit, skeleton: &Skeleton) -> Self {
        let fit = &fitted.fit;
        let errors = fit.standard_errors();
        let shared = fit.shared();
        let bones = (0..BONE_COUNT).map(|index| BoneDocument {
            bone: bone_name(skeleton, index),
            length_m: rounded(fit.problem.bone_length_m(index, shared), 5),
            relative_error: errors.as_ref().map(|e| rounded(e[fit.problem.length_index(index)], 5)),
        });
        let mut panels: Vec<PanelDocument> = (0..fit.problem.layout.panels)
            .map(|slot| panel_document(fitted, slot, errors.as_deref()))
            .collect();
        panels.sort_by_key(|panel| panel.panel);
        Self {
            schema: FIT_SCHEMA,
            plate: fitted.id().to_string(),
            annotation_sha256: fitted.plate.annotation_sha256.clone(),
            stride_time_s: rounded(fit.stride_time.seconds, 5),
            stride_time_sd_s: rounded(fitted.analysis.stride_time_s[1], 5),
            speed_m_s: rounded(fitted.calibration.speed_m_s.value, 5),
            px_rms: rounded(
                crate::stride_fit::rms(fitted.residuals.iter().map(crate::stride_fit::PointResidual::px)),
                3,
            ),
            bones: bones.collect(),
            panels,
        }
    }
}

/// `left hoof`, `right femur`, `spine1`.
fn bone_name(skeleton: &Skeleton, index: usize) -> String {
    let name = &skeleton.bones[index].name;
    match Skeleton::limb_of(index) {
        None => name.clone(),
        Some(limb) => format!("{} {}", limb.abbreviation(), name),
    }
}

fn panel_document(fitted: &PlateFit, slot: usize, errors: Option<&[f64]>) -> PanelDocument {
    let fit = &fitted.fit;
    let (pose, panel) = (fit.pose(slot), &fit.observation.panels[fit.problem.order[slot]]);
    let kinematics = &fit.kinematics()[slot];
    let degrees = |value: f64| rounded(value.to_degrees(), 3);
    let bends = fit.problem.layout.panel(slot, BENDS)..fit.problem.layout.panel(slot, SLIDES);
    let keypoints_px = Keypoint::all().map(|keypoint| {
        let place = fit.place_px(slot, kinematics, keypoint).map(|v| rounded(v, 2));
        (keypoint.name().to_string(), serde_json::json!(place))
    });
    PanelDocument {
        panel: panel.camera.panel,
        time_s: rounded(panel.camera.time_s, 5),
        phase: rounded(fit.problem.phases[slot], 5),
        root_m: [rounded(pose[ROOT_X], 4), rounded(pose[ROOT_Y], 4)],
        pitch_deg: degrees(pose[PITCH]),
        bends_deg: pose[BENDS..BENDS + BONE_COUNT].iter().map(|b| degrees(*b)).collect(),
        bend_errors_deg: errors.map(|e| e[bends].iter().map(|b| degrees(*b)).collect()),
        scapula_slides_m: [rounded(pose[SLIDES], 4), rounded(pose[SLIDES + 1], 4)],
        keypoints_px: keypoints_px.collect(),
    }
}

/// A value with so many decimals, never a negative zero.
pub fn rounded(value: f64, decimals: i32) -> f64 {
    let factor = 10f64.powi(decimals);
    (value * factor).round() / factor + 0.0
}
