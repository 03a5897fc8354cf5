//! Imported points and those that are there already.

use super::Import;
use super::collect::{Origin, Said};
use crate::annotation::{Annotation, PanelAnnotation, Placed, PlacedBy};

/// Two places this close are one, px: formats of single precision are this exact, and no person is.
const SAME_PLACE_PX: f64 = 0.01;

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
    /// Points that were there like that.
    pub same: usize,
    /// Points that were left away, because a person's is there.
    pub kept: usize,
}

impl Import {
    /// Puts the points into an annotation; panels that it has not yet are added in order.
    ///
    /// A point that comes back to where it was keeps what the format could not say of it (state, provenance); one that
    /// was moved in the other tool was placed by hand.
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
                let mut placed = *placed;
                if let Some(old) = there.get(keypoint) {
                    if let Some(said) = self.said.get(&(*number, keypoint)) {
                        placed = with_what_was_known(placed, old, said);
                    }
                    if placed == *old {
                        merged.same += 1;
                        continue;
                    }
                    if existing == Existing::KeepHand && old.by == PlacedBy::Hand {
                        merged.kept += 1;
                        continue;
                    }
                    merged.replaced += 1;
                } else {
                    merged.added += 1;
                }
                there.insert(keypoint, placed);
            }
        }
        merged
    }
}

/// An imported point over the one that is there.
fn with_what_was_known(new: Placed, old: &Placed, said: &Said) -> Placed {
    let Some((from, to)) = old.place().zip(new.place()) else { return new };
    let moved = (from[0] - to[0]).hypot(from[1] - to[1]) > SAME_PLACE_PX;
    match (moved, said.by) {
        (true, Origin::Carried(_)) => Placed { by: PlacedBy::Hand, ..new },
        (true, Origin::Stated(_) | Origin::Unsaid) => new,
        (false, by) => Placed {
            at_px: old.at_px,
            state: said.state.unwrap_or(old.state),
            by: if by == Origin::Unsaid { old.by } else { new.by },
            sd_px: old.sd_px,
        },
    }
}
