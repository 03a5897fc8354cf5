//! Imported points and those that are there already.

use super::Import;
use crate::annotation::{Annotation, PanelAnnotation, PlacedBy};

/// What happens to a point that is there already.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Existing {
    /// What a person placed stays; interpolated, tracked and fitted points make room.
    KeepHand,
    /// Imported points replace all.
    Replace,
}

/// What became of the imported points.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Merged {
    /// Points where there was none.
    pub added: usize,
    /// Points that took another's place.
    pub replaced: usize,
    /// Points that were left away, because a person's is there.
    pub kept: usize,
}

impl Import {
    /// Puts the points into an annotation; panels that it has not yet are added in order.
    pub fn merge_into(&self, annotation: &mut Annotation, existing: Existing) -> Merged {
        let mut merged = Merged::default();
        for (number, keypoints) in &self.panels {
            let index = match annotation.panels.iter().position(|panel| panel.panel >= *number) {
                Some(index) if annotation.panels[index].panel == *number => index,
                after => {
                    let index = after.unwrap_or(annotation.panels.len());
                    annotation.panels.insert(index, PanelAnnotation::empty(*number));
                    index
                }
            };
            let there = &mut annotation.panels[index].keypoints;
            for (keypoint, placed) in keypoints.iter() {
                match there.get(keypoint) {
                    Some(old) if existing == Existing::KeepHand && old.by == PlacedBy::Hand => {
                        merged.kept += 1;
                        continue;
                    }
                    Some(_) => merged.replaced += 1,
                    None => merged.added += 1,
                }
                there.insert(keypoint, *placed);
            }
        }
        merged
    }
}
