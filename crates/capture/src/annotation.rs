//! What a person marked on a plate: keypoints, contacts, ground line and marks, panel by panel.

use std::collections::BTreeMap;
use std::fmt;

use muybridge_core::{Gait, Pair};
use serde::de::{MapAccess, Visitor};
use serde::ser::SerializeMap;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::keypoint::{Keypoint, NearOff};
use crate::manifest::Manifest;

/// Schema version of an annotation file.
pub const ANNOTATION_SCHEMA: u32 = 1;

/// An annotated plate.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Annotation {
    /// [`ANNOTATION_SCHEMA`].
    pub schema: u32,
    /// Path of the plate's manifest, relative to this file.
    pub plate: String,
    /// SHA-256 of the images the points were placed on, as in the manifest.
    pub images_sha256: Vec<String>,
    /// Who placed the points.
    pub annotator: String,
    /// Repeatability of a visible point when placed a second time, standard deviation of one coordinate, px.
    pub visible_sd_px: f64,
    /// The same for an occluded point, px.
    pub occluded_sd_px: f64,
    /// The gait that the footfalls show, where it is not the title's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gait: Option<Gait>,
    /// The panels that make up the stride.
    pub stride: StrideSpan,
    /// Free text.
    pub notes: Vec<String>,
    /// One entry per panel, in panel order.
    pub panels: Vec<PanelAnnotation>,
    /// Contact instants a person placed between panels; they override what is found from the fit.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub instants: Vec<Instant>,
}

impl Annotation {
    /// The gait of the stride: as the person judged it from the footfalls, else as titled.
    pub fn gait(&self, manifest: &Manifest) -> Gait {
        self.gait.unwrap_or(manifest.gait)
    }
}

/// Which panels show the stride.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StrideSpan {
    /// First panel.
    pub first: u32,
    /// Last panel.
    pub last: u32,
    /// Panels after which the movement repeats, where the person can tell; otherwise it is searched for.
    pub closes_after_panels: Option<f64>,
}

/// What a panel is good for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum PanelUse {
    /// Part of the stride.
    Stride,
    /// The animal stands: used for its height.
    Standing,
    /// Shows no horse, or nothing usable.
    Unused,
}

/// One panel's marks and points.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PanelAnnotation {
    /// Panel number of the manifest.
    pub panel: u32,
    /// What it is used for.
    #[serde(rename = "use")]
    pub usage: PanelUse,
    /// Two points on the ground line under the near hooves, left to right, plate px; none until somebody has drawn it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ground_px: Option<[[f64; 2]; 2]>,
    /// Numbered marks of known spacing.
    #[serde(default)]
    pub marks: Vec<Mark>,
    /// State of each leg.
    pub contacts: LegContacts,
    /// The points.
    pub keypoints: Keypoints,
}

impl PanelAnnotation {
    /// Exchanges the near and the off limb of a pair, or of both pairs: points with their states, and contact labels.
    ///
    /// Contact instants belong to the plate and stay.
    pub fn swap_near_off(&mut self, pair: Option<Pair>) {
        let wanted = |p: Pair| pair.is_none_or(|only| only == p);
        for near in Keypoint::all() {
            let Keypoint::Limb(NearOff::Near, of_pair, joint) = near else { continue };
            if wanted(of_pair) {
                let off = Keypoint::Limb(NearOff::Off, of_pair, joint);
                let (on_near, on_off) = (self.keypoints.0.remove(&near), self.keypoints.0.remove(&off));
                self.keypoints.0.extend(on_near.map(|placed| (off, placed)));
                self.keypoints.0.extend(on_off.map(|placed| (near, placed)));
            }
        }
        for swapped in [Pair::Fore, Pair::Hind].into_iter().filter(|p| wanted(*p)) {
            let [near, off] = [NearOff::Near, NearOff::Off].map(|s| self.contacts.of(s, swapped));
            self.contacts.set(NearOff::Near, swapped, off);
            self.contacts.set(NearOff::Off, swapped, near);
        }
    }
}

/// A numbered mark of the background.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Mark {
    /// Number; neighbours differ by 1.
    pub mark: f64,
    /// Place, plate px.
    pub at_px: [f64; 2],
}

/// What a leg does in a panel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum StanceLabel {
    /// On the ground and loaded.
    Stance,
    /// In the air.
    Swing,
    /// Cannot be told.
    Unknown,
}

/// Contact labels of the four legs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LegContacts {
    /// Near fore.
    pub near_fore: StanceLabel,
    /// Off fore.
    pub off_fore: StanceLabel,
    /// Near hind.
    pub near_hind: StanceLabel,
    /// Off hind.
    pub off_hind: StanceLabel,
}

impl LegContacts {
    /// The label of one leg.
    pub fn of(&self, near_off: NearOff, pair: Pair) -> StanceLabel {
        match (near_off, pair) {
            (NearOff::Near, Pair::Fore) => self.near_fore,
            (NearOff::Off, Pair::Fore) => self.off_fore,
            (NearOff::Near, Pair::Hind) => self.near_hind,
            (NearOff::Off, Pair::Hind) => self.off_hind,
        }
    }

    /// Sets the label of one leg.
    pub fn set(&mut self, near_off: NearOff, pair: Pair, label: StanceLabel) {
        let of_leg = match (near_off, pair) {
            (NearOff::Near, Pair::Fore) => &mut self.near_fore,
            (NearOff::Off, Pair::Fore) => &mut self.off_fore,
            (NearOff::Near, Pair::Hind) => &mut self.near_hind,
            (NearOff::Off, Pair::Hind) => &mut self.off_hind,
        };
        *of_leg = label;
    }
}

/// Strike or lift-off.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Event {
    /// The hoof meets the ground.
    Strike,
    /// The hoof leaves it.
    LiftOff,
}

/// A contact instant between two panels.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Instant {
    /// Near or off.
    pub side: NearOff,
    /// Fore or hind.
    pub pair: Pair,
    /// What happens.
    pub event: Event,
    /// When: 4.25 is a quarter of the way from panel 4 to panel 5.
    pub at_panel: f64,
}

/// Whether a point is seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum KeypointState {
    /// Clearly seen.
    Visible,
    /// Placed, but guessed behind or inside something.
    Occluded,
    /// Cannot be placed.
    Absent,
}

/// Who or what placed a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum PlacedBy {
    /// A person.
    Hand,
    /// Interpolated between panels.
    Interpolated,
    /// Tracked from a neighbouring panel.
    Tracked,
    /// Taken over from a fit.
    Fitted,
}

/// One placed point.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Placed {
    /// Place in plate px; none when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at_px: Option<[f64; 2]>,
    /// Seen or guessed.
    pub state: KeypointState,
    /// By whom.
    pub by: PlacedBy,
    /// Standard deviation of a coordinate of this very point, px, where it is known, as of a mean over strides; otherwise the
    /// annotation's for its state holds.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sd_px: Option<f64>,
}

impl Placed {
    /// The place, when there is one.
    pub fn place(&self) -> Option<[f64; 2]> {
        match self.state {
            KeypointState::Absent => None,
            KeypointState::Visible | KeypointState::Occluded => self.at_px,
        }
    }
}

/// The keypoints of a panel in the fixed order; a name that comes twice in a file is an error.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Keypoints(BTreeMap<Keypoint, Placed>);

impl Keypoints {
    /// The point of a type, if the file has it.
    pub fn get(&self, keypoint: Keypoint) -> Option<&Placed> {
        self.0.get(&keypoint)
    }

    /// Sets or replaces a point.
    pub fn insert(&mut self, keypoint: Keypoint, placed: Placed) {
        self.0.insert(keypoint, placed);
    }

    /// Removes a point.
    pub fn remove(&mut self, keypoint: Keypoint) {
        self.0.remove(&keypoint);
    }

    /// Place of a point that is visible or occluded, plate px.
    pub fn place(&self, keypoint: Keypoint) -> Option<[f64; 2]> {
        self.get(keypoint).and_then(Placed::place)
    }

    /// All places, to be changed.
    pub(crate) fn places_mut(&mut self) -> impl Iterator<Item = &mut [f64; 2]> {
        self.0.values_mut().filter_map(|placed| placed.at_px.as_mut())
    }

    /// All entries in the fixed order.
    pub fn iter(&self) -> impl Iterator<Item = (Keypoint, &Placed)> {
        self.0.iter().map(|(keypoint, placed)| (*keypoint, placed))
    }
}

impl Serialize for Keypoints {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(self.0.len()))?;
        for (keypoint, placed) in &self.0 {
            map.serialize_entry(keypoint, placed)?;
        }
        map.end()
    }
}

impl<'de> Deserialize<'de> for Keypoints {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct KeypointsVisitor;
        impl<'de> Visitor<'de> for KeypointsVisitor {
            type Value = Keypoints;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("an object of keypoints by name")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Keypoints, A::Error> {
                let mut keypoints = Keypoints::default();
                while let Some(keypoint) = map.next_key::<Keypoint>()? {
                    if keypoints.0.insert(keypoint, map.next_value()?).is_some() {
                        let message = format!("duplicate keypoint `{keypoint}`: keep one of the two");
                        return Err(serde::de::Error::custom(message));
                    }
                }
                Ok(keypoints)
            }
        }
        deserializer.deserialize_map(KeypointsVisitor)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn panel() -> PanelAnnotation {
        let mut keypoints = Keypoints::default();
        for (i, keypoint) in Keypoint::all().enumerate() {
            let state = if i % 3 == 0 { KeypointState::Occluded } else { KeypointState::Visible };
            keypoints.insert(
                keypoint,
                Placed { at_px: Some([i as f64, 1.0]), state, by: PlacedBy::Hand, sd_px: None },
            );
        }
        // One point that only one side has.
        keypoints.remove(Keypoint::hoof(NearOff::Off, Pair::Fore));
        let contacts = LegContacts {
            near_fore: StanceLabel::Stance,
            off_fore: StanceLabel::Swing,
            near_hind: StanceLabel::Unknown,
            off_hind: StanceLabel::Stance,
        };
        let usage = PanelUse::Stride;
        PanelAnnotation { panel: 1, usage, ground_px: None, marks: Vec::new(), contacts, keypoints }
    }

    #[test]
    fn a_pair_is_exchanged_with_states_and_labels_and_nothing_else() {
        let before = panel();
        let mut after = before.clone();
        after.swap_near_off(Some(Pair::Fore));
        for keypoint in Keypoint::all() {
            let from = match keypoint {
                Keypoint::Limb(NearOff::Near, Pair::Fore, joint) => {
                    Keypoint::Limb(NearOff::Off, Pair::Fore, joint)
                }
                Keypoint::Limb(NearOff::Off, Pair::Fore, joint) => {
                    Keypoint::Limb(NearOff::Near, Pair::Fore, joint)
                }
                other => other,
            };
            assert_eq!(after.keypoints.get(keypoint), before.keypoints.get(from), "{keypoint}");
        }
        assert_eq!(after.contacts.near_fore, StanceLabel::Swing);
        assert_eq!(after.contacts.off_fore, StanceLabel::Stance);
        assert_eq!(after.contacts.near_hind, before.contacts.near_hind);
        after.swap_near_off(Some(Pair::Hind));
        after.swap_near_off(None);
        assert_eq!(after, before, "twice is as before");
    }
}
