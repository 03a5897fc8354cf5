//! The two documents together, and the parts in which one state differs from another.

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::{Number, Value};

use crate::annotation::{
    ANNOTATION_SCHEMA, Annotation, Keypoints, LegContacts, PanelAnnotation, PanelUse, StanceLabel, StrideSpan,
};
use crate::manifest::Manifest;

/// Repeatability that is assumed of a person until a second pass has measured it, px: visible and occluded. From the two
/// passes over Sallie Gardner's plate.
const ASSUMED_SD_PX: [f64; 2] = [2.0, 4.0];

/// A plate's documents in whatever state of completion.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Draft {
    /// What is known of the plate.
    pub manifest: Manifest,
    /// What was marked on it.
    pub annotation: Annotation,
}

/// A part of a draft, whole: changes are kept by parts, so that a step costs as much memory as what it touched.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Part {
    /// The manifest.
    Manifest(Box<Manifest>),
    /// The annotation without its panels.
    Head(Box<Annotation>),
    /// One panel's annotation.
    Panel(Box<PanelAnnotation>),
    /// A panel's annotation that is not there.
    NoPanel(u32),
}

/// An annotation in which nothing is placed, of the first to the last panel.
pub(crate) fn empty_annotation(manifest: &Manifest, plate: String) -> Annotation {
    let numbers = || manifest.panels.iter().map(|panel| panel.panel);
    Annotation {
        schema: ANNOTATION_SCHEMA,
        plate,
        images_sha256: manifest.images.iter().map(|image| image.sha256.clone()).collect(),
        annotator: String::new(),
        visible_sd_px: ASSUMED_SD_PX[0],
        occluded_sd_px: ASSUMED_SD_PX[1],
        gait: None,
        stride: StrideSpan {
            first: numbers().min().unwrap_or(1),
            last: numbers().max().unwrap_or(1),
            closes_after_panels: None,
        },
        notes: Vec::new(),
        panels: Vec::new(),
        instants: Vec::new(),
    }
}

impl PanelAnnotation {
    /// A panel on which nothing is marked yet.
    pub fn empty(panel: u32) -> Self {
        Self {
            panel,
            usage: PanelUse::Stride,
            ground_px: None,
            marks: Vec::new(),
            contacts: LegContacts {
                near_fore: StanceLabel::Unknown,
                off_fore: StanceLabel::Unknown,
                near_hind: StanceLabel::Unknown,
                off_hind: StanceLabel::Unknown,
            },
            keypoints: Keypoints::default(),
        }
    }
}

impl Draft {
    /// A panel's annotation, if it has one.
    pub fn panel(&self, panel: u32) -> Option<&PanelAnnotation> {
        self.annotation.panels.iter().find(|p| p.panel == panel)
    }

    /// A panel's annotation, made empty if it has none.
    pub fn panel_mut(&mut self, panel: u32) -> &mut PanelAnnotation {
        let panels = &mut self.annotation.panels;
        let at = panels.partition_point(|p| p.panel < panel);
        if panels.get(at).is_none_or(|p| p.panel != panel) {
            panels.insert(at, PanelAnnotation::empty(panel));
        }
        &mut panels[at]
    }

    /// With places rounded to the precision of the files, a hundredth of a pixel and a thousandth of a panel, and all other
    /// numbers to what text gives back exactly. None when a number is not finite.
    pub(crate) fn rounded(mut self) -> Option<Self> {
        for panel in &mut self.manifest.panels {
            panel.quad_px.iter_mut().flatten().for_each(hundredth);
        }
        for instant in &mut self.annotation.instants {
            instant.at_panel = (instant.at_panel * 1000.0).round() / 1000.0;
        }
        for panel in &mut self.annotation.panels {
            if !round_panel(panel) {
                return None;
            }
        }
        let panels = std::mem::take(&mut self.annotation.panels);
        let annotation = Annotation { panels, ..with_short_numbers(&self.annotation)? };
        Some(Self { manifest: with_short_numbers(&self.manifest)?, annotation })
    }

    /// The parts of `after` in which it differs from this.
    pub(crate) fn difference(&self, after: &Self) -> Vec<Part> {
        let mut parts = Vec::new();
        if self.manifest != after.manifest {
            parts.push(Part::Manifest(Box::new(after.manifest.clone())));
        }
        // How the plate is named follows from where the annotation is, and is no step.
        let head = |draft: &Self| Annotation {
            panels: Vec::new(),
            plate: String::new(),
            ..draft.annotation.clone()
        };
        let (before_head, after_head) = (head(self), head(after));
        if before_head != after_head {
            parts.push(Part::Head(Box::new(after_head)));
        }
        for panel in &after.annotation.panels {
            if self.panel(panel.panel) != Some(panel) {
                parts.push(Part::Panel(Box::new(panel.clone())));
            }
        }
        let gone = self.annotation.panels.iter().filter(|panel| after.panel(panel.panel).is_none());
        parts.extend(gone.map(|panel| Part::NoPanel(panel.panel)));
        parts
    }

    /// Puts parts in the place of what is there.
    pub(crate) fn apply(&mut self, parts: &[Part]) {
        for part in parts {
            match part {
                Part::Manifest(manifest) => self.manifest = (**manifest).clone(),
                Part::Head(head) => {
                    let Annotation { panels, plate, .. } = &mut self.annotation;
                    let (panels, plate) = (std::mem::take(panels), std::mem::take(plate));
                    self.annotation = Annotation { panels, plate, ..(**head).clone() };
                }
                Part::Panel(panel) => *self.panel_mut(panel.panel) = (**panel).clone(),
                Part::NoPanel(number) => self.annotation.panels.retain(|panel| panel.panel != *number),
            }
        }
    }
}

fn hundredth(value: &mut f64) {
    *value = (*value * 100.0).round() / 100.0;
}

/// Rounds what is marked on a panel; whether all of it is finite.
fn round_panel(panel: &mut PanelAnnotation) -> bool {
    let mut finite = true;
    let mut round = |value: &mut f64| {
        hundredth(value);
        finite &= value.is_finite();
    };
    panel.ground_px.iter_mut().flatten().flatten().for_each(&mut round);
    for mark in &mut panel.marks {
        round(&mut mark.mark);
        mark.at_px.iter_mut().for_each(&mut round);
    }
    panel.keypoints.places_mut().flatten().for_each(&mut round);
    finite
}

/// A document with its numbers to nine digits, which text gives back exactly, and more than anybody knows of a plate.
/// None when one is not finite.
fn with_short_numbers<T: Serialize + DeserializeOwned>(document: &T) -> Option<T> {
    let mut value = serde_json::to_value(document).ok()?;
    shorten(&mut value);
    serde_json::from_value(value).ok()
}

fn shorten(value: &mut Value) {
    match value {
        Value::Array(items) => items.iter_mut().for_each(shorten),
        Value::Object(fields) => fields.values_mut().for_each(shorten),
        Value::Number(number) if number.is_f64() => {
            let short = number.as_f64().and_then(|v| format!("{v:.8e}").parse().ok());
            *number = short.and_then(Number::from_f64).unwrap_or_else(|| number.clone());
        }
        _ => {}
    }
}
