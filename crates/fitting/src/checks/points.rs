//! Points outside their panel, and points nobody has placed.

use muybridge_capture::{Annotation, Keypoint, MIN_POINTS_PER_PANEL, Manifest, PANEL_MARGIN_PX, PanelUse};

use super::{Concern, ConcernKind, Severity, name};

/// Names of points in a sentence, at most.
const NAMED: usize = 4;

pub(super) fn concerns(annotation: &Annotation, manifest: &Manifest) -> Vec<Concern> {
    let mut concerns = Vec::new();
    for panel in annotation.panels.iter().filter(|panel| panel.usage != PanelUse::Unused) {
        let Some(place) = manifest.panels.iter().find(|p| p.panel == panel.panel) else { continue };
        let outside: Vec<Keypoint> = panel
            .keypoints
            .iter()
            .filter(|(_, placed)| placed.place().is_some_and(|at| !place.contains(at, PANEL_MARGIN_PX)))
            .map(|(keypoint, _)| keypoint)
            .collect();
        if !outside.is_empty() {
            let text = format!("{} outside the panel; move or remove", list(&outside));
            let kind = ConcernKind::OutsidePanel;
            concerns.push(on_panel(kind, Severity::Warning, panel.panel, outside, text));
        }
        let missing: Vec<Keypoint> =
            Keypoint::all().filter(|keypoint| panel.keypoints.get(*keypoint).is_none()).collect();
        let of_stride = panel.usage == PanelUse::Stride
            && (annotation.stride.first..=annotation.stride.last).contains(&panel.panel);
        if of_stride && !missing.is_empty() {
            let placed = panel.keypoints.iter().filter(|(_, placed)| placed.place().is_some()).count();
            let severity = if placed < MIN_POINTS_PER_PANEL { Severity::Warning } else { Severity::Note };
            let text = format!("{} not placed yet; place or call absent", list(&missing));
            concerns.push(on_panel(ConcernKind::MissingPoints, severity, panel.panel, missing, text));
        }
    }
    concerns
}

/// The first few by name, the rest by number.
fn list(keypoints: &[Keypoint]) -> String {
    let names: Vec<String> = keypoints.iter().take(NAMED).map(|keypoint| name(*keypoint)).collect();
    let more = keypoints.len().saturating_sub(NAMED);
    let verb = if keypoints.len() == 1 { "is" } else { "are" };
    if more > 0 {
        format!("{} and {more} more {verb}", names.join(", "))
    } else {
        format!("{} {verb}", names.join(", "))
    }
}

fn on_panel(
    kind: ConcernKind,
    severity: Severity,
    panel: u32,
    keypoints: Vec<Keypoint>,
    text: String,
) -> Concern {
    let size = keypoints.len() as f64;
    let limb = match keypoints.as_slice() {
        [Keypoint::Limb(side, pair, _)] => Some((*side, *pair)),
        _ => None,
    };
    Concern { kind, severity, panel: Some(panel), keypoints, limb, text, size }
}
