//! A blind second pass: some panels again, without sight of the first points, to measure how well they are placed.
//!
//! It is a document of its own, in the folder `second-pass` beside the annotation, so that the first points are in no
//! danger.

use std::path::{Path, PathBuf};

use muybridge_capture::{Annotation, Document, Keypoints, PanelAnnotation, calibrate};
use muybridge_core::Random;
use muybridge_fitting::repeatability::Repeatability;

use crate::session::Session;

/// One panel in so many is done again: that says enough of the scatter (as with Sallie Gardner).
const ONE_IN: usize = 3;

/// A second pass under way.
#[derive(Clone, Debug)]
pub struct SecondPass {
    first: Annotation,
    /// File of the first pass.
    pub first_path: PathBuf,
    panels: Vec<u32>,
}

impl SecondPass {
    /// Starts the document of a second pass over a third of the panels that have points, drawn by chance.
    ///
    /// # Errors
    /// In words, when there are no points, or the document cannot be started.
    pub fn begin(session: &Session, journals: Option<&Path>) -> Result<(Document, Self), String> {
        let draft = session.document.draft();
        let first = draft.annotation.clone();
        let placed: Vec<&PanelAnnotation> =
            first.panels.iter().filter(|panel| panel.keypoints.iter().next().is_some()).collect();
        if placed.is_empty() {
            return Err("Place points first; a second pass does some of them again".into());
        }
        let drawn =
            Random::new(session.document.revision()).choose(placed.len().div_ceil(ONE_IN), placed.len());
        let again =
            |panel: &PanelAnnotation| PanelAnnotation { keypoints: Keypoints::default(), ..panel.clone() };
        let again: Vec<PanelAnnotation> =
            placed.iter().zip(drawn).filter(|(_, drawn)| *drawn).map(|(panel, _)| again(panel)).collect();
        let path = unused_path(session.document.annotation_path());
        let manifest_path = session.document.manifest_path();
        let document = Document::start(manifest_path, &path, draft.manifest.clone(), journals);
        let mut document = document.map_err(|error| error.to_string())?;
        let panels = again.iter().map(|panel| panel.panel).collect();
        document.edit("Begin the second pass", |second| {
            second.annotation =
                Annotation { panels: again, plate: second.annotation.plate.clone(), ..first.clone() };
        });
        let first_path = session.document.annotation_path().to_path_buf();
        Ok((document, Self { first, first_path, panels }))
    }

    /// What is left to do.
    pub fn headline(&self, session: &Session) -> String {
        let empty =
            |panel: &&u32| session.draft().panel(**panel).is_none_or(|p| p.keypoints.iter().next().is_none());
        let left: Vec<String> = self.panels.iter().filter(empty).map(u32::to_string).collect();
        if left.is_empty() {
            "Blind second pass: all panels have points; end it in the menu Pose".into()
        } else {
            format!("Blind second pass: place panels {} again", left.join(", "))
        }
    }

    /// The first panel that has no points yet.
    pub fn next_panel(&self) -> Option<u32> {
        self.panels.first().copied()
    }

    /// The second points compared with the first.
    ///
    /// # Errors
    /// In words, when the plate cannot be calibrated or no point was placed twice.
    pub fn compare(&self, session: &Session) -> Result<Repeatability, String> {
        let draft = session.document.draft();
        let calibration = calibrate(&draft.manifest, &self.first).map_err(|error| error.to_string())?;
        Repeatability::new(&self.first, &draft.annotation, &calibration)
            .ok_or_else(|| "No point was placed in both passes, or the withers height is not known".into())
    }
}

/// `second-pass/NAME.json` beside an annotation, or `NAME-2.json` and so on.
fn unused_path(annotation_path: &Path) -> PathBuf {
    let folder = annotation_path.parent().unwrap_or(Path::new(".")).join("second-pass");
    let stem = annotation_path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let numbered = (2..).map(|number| format!("{stem}-{number}.json"));
    let names = std::iter::once(format!("{stem}.json")).chain(numbered);
    let mut paths = names.map(|name| folder.join(name));
    paths.find(|path| !path.exists()).unwrap_or_else(|| folder.join(format!("{stem}.json")))
}
