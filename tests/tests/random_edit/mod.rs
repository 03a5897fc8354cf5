//! One random change to a plate's two documents.

use proptest::prelude::*;
use proptest::sample::Index;
use serde_json::{Value, json};

/// Which document: 0 the annotation, 1 the manifest.
type Document = usize;

/// Where in a document: at each level the child to go down to, or none to stop.
type Way = Vec<Option<Index>>;

/// A change.
#[derive(Clone, Debug)]
pub(crate) enum Edit {
    /// Removes an entry of a list or object.
    Delete(Document, Way),
    /// Repeats an entry of a list, or a field of an object with the same name.
    Repeat(Document, Way),
    /// Puts another value in a place; the text need not be JSON.
    Replace(Document, Way, &'static str),
    /// Reverses or rotates a list.
    Reorder(Document, Way),
    /// Cuts the text at a byte.
    Truncate(Document, Index),
    /// Flips one bit of a byte (the result is kept readable as UTF-8).
    Flip(Document, Index, u8),
    /// Takes these keypoints out of a panel.
    RemovePoints(Index, Vec<Index>),
    /// Calls a panel unused.
    Unused(Index),
    /// Labels legs anew, panel by panel.
    Labels(Vec<u8>),
    /// Gives all legs in all panels the same label.
    SameLabels(u8),
    /// Drives scale, place and time by other sources.
    Sources([u8; 4]),
}

/// Values that a field hardly ever holds.
const VALUES: [&str; 20] = [
    "null",
    "0",
    "-1",
    "1e-300",
    "1e300",
    "-1e300",
    "1e999",
    "NaN",
    "Infinity",
    "18446744073709551616",
    "true",
    "\"NaN\"",
    "\"\"",
    "\"stance\"",
    "[]",
    "{}",
    "[0, 0]",
    "[[1e300, 0], [0, 1e300]]",
    "0.001",
    "1000",
];
const LABELS: [&str; 3] = ["stance", "swing", "unknown"];
const LEGS: [&str; 4] = ["near_fore", "off_fore", "near_hind", "off_hind"];

/// Any change.
pub(crate) fn edit() -> BoxedStrategy<Edit> {
    let document = || 0usize..2;
    prop_oneof![
        1 => (document(), way()).prop_map(|(document, way)| Edit::Delete(document, way)),
        1 => (document(), way()).prop_map(|(document, way)| Edit::Repeat(document, way)),
        4 => (document(), way(), prop::sample::select(&VALUES[..]))
            .prop_map(|(document, way, value)| Edit::Replace(document, way, value)),
        1 => (document(), way()).prop_map(|(document, way)| Edit::Reorder(document, way)),
        1 => (document(), any::<Index>()).prop_map(|(document, at)| Edit::Truncate(document, at)),
        1 => (document(), any::<Index>(), 0u8..7).prop_map(|(document, at, bit)| Edit::Flip(document, at, bit)),
        2 => points_removed(),
        1 => panel_unused(),
        2 => labels(),
        1 => same_labels(),
        3 => sources(),
    ]
    .boxed()
}

fn way() -> impl Strategy<Value = Way> {
    prop::collection::vec(prop::option::weighted(0.9, any::<Index>()), 1..7)
}

/// Keypoints taken out of a panel.
pub(crate) fn points_removed() -> BoxedStrategy<Edit> {
    (any::<Index>(), prop::collection::vec(any::<Index>(), 1..26))
        .prop_map(|(panel, points)| Edit::RemovePoints(panel, points))
        .boxed()
}

/// A panel called unused.
pub(crate) fn panel_unused() -> BoxedStrategy<Edit> {
    any::<Index>().prop_map(Edit::Unused).boxed()
}

/// Random contact labels.
pub(crate) fn labels() -> BoxedStrategy<Edit> {
    prop::collection::vec(any::<u8>(), 48).prop_map(Edit::Labels).boxed()
}

/// The same contact label everywhere.
pub(crate) fn same_labels() -> BoxedStrategy<Edit> {
    (0u8..3).prop_map(Edit::SameLabels).boxed()
}

/// Other sources of scale, place and time.
pub(crate) fn sources() -> BoxedStrategy<Edit> {
    any::<[u8; 4]>().prop_map(Edit::Sources).boxed()
}

impl Edit {
    /// Makes the change; documents that an earlier change left unreadable are changed only as text.
    pub(crate) fn apply(&self, documents: &mut [String; 2]) {
        match self {
            Self::Truncate(document, at) => {
                let text = &mut documents[*document];
                let mut end = at.index(text.len().max(1)).min(text.len());
                while !text.is_char_boundary(end) {
                    end -= 1;
                }
                text.truncate(end);
            }
            Self::Flip(document, at, bit) => {
                let mut bytes = std::mem::take(&mut documents[*document]).into_bytes();
                if !bytes.is_empty() {
                    let at = at.index(bytes.len());
                    bytes[at] ^= 1 << bit;
                }
                documents[*document] = String::from_utf8_lossy(&bytes).into_owned();
            }
            Self::Replace(document, way, value) => Self::replace(&mut documents[*document], way, value),
            Self::Delete(document, way) | Self::Repeat(document, way) | Self::Reorder(document, way) => {
                self.restructure(&mut documents[*document], way);
            }
            Self::Sources(choice) => change(&mut documents[1], |manifest| sources_of(manifest, *choice)),
            Self::RemovePoints(..) | Self::Unused(_) | Self::Labels(_) | Self::SameLabels(_) => {
                change(&mut documents[0], |annotation| self.annotate(annotation));
            }
        }
    }

    fn replace(text: &mut String, way: &[Option<Index>], value: &str) {
        const HERE: &str = "the place of the new value";
        change(text, |document| {
            if let Some(place) = follow(document, way) {
                *place = HERE.into();
            }
        });
        *text = text.replace(&format!("\"{HERE}\""), value);
    }

    fn restructure(&self, text: &mut String, way: &[Option<Index>]) {
        const AGAIN: &str = "the field's name once more";
        let Some((last, parents)) = way.split_last() else { return };
        let mut name = String::new();
        change(text, |document| match (follow(document, parents), last) {
            (Some(Value::Array(items)), Some(index)) if !items.is_empty() => {
                let at = index.index(items.len());
                match self {
                    Self::Delete(..) => drop(items.remove(at)),
                    Self::Repeat(..) => items.insert(at, items[at].clone()),
                    _ => items.rotate_left(at),
                }
            }
            (Some(Value::Object(fields)), Some(index)) if !fields.is_empty() => {
                name = fields.keys().nth(index.index(fields.len())).cloned().unwrap_or_default();
                let value = fields.get(&name).cloned().unwrap_or_default();
                match self {
                    Self::Delete(..) => drop(fields.remove(&name)),
                    Self::Repeat(..) => drop(fields.insert(AGAIN.into(), value)),
                    _ => {}
                }
            }
            (Some(Value::Array(items)), None) => items.reverse(),
            _ => {}
        });
        *text = text.replace(AGAIN, &name);
    }

    fn annotate(&self, annotation: &mut Value) {
        let n = annotation.get("panels").and_then(Value::as_array).map_or(0, Vec::len);
        if n == 0 {
            return;
        }
        let leg = |i: usize| format!("/panels/{}/contacts/{}", i / 4 % n, LEGS[i % 4]);
        let label = |value: u8| LABELS[usize::from(value) % LABELS.len()].into();
        match self {
            Self::Labels(values) => {
                values.iter().enumerate().for_each(|(i, value)| set(annotation, &leg(i), label(*value)));
            }
            Self::SameLabels(value) => (0..4 * n).for_each(|i| set(annotation, &leg(i), label(*value))),
            Self::Unused(panel) => {
                set(annotation, &format!("/panels/{}/use", panel.index(n)), "unused".into());
            }
            Self::RemovePoints(panel, points) => {
                let place = annotation.pointer_mut(&format!("/panels/{}/keypoints", panel.index(n)));
                let Some(fields) = place.and_then(Value::as_object_mut) else { return };
                for point in points {
                    let name = fields.keys().nth(point.index(fields.len().max(1))).cloned();
                    name.map(|name| fields.remove(&name));
                }
            }
            _ => {}
        }
    }
}

/// Replaces the value in a place, if there is one.
fn set(document: &mut Value, pointer: &str, value: Value) {
    if let Some(place) = document.pointer_mut(pointer) {
        *place = value;
    }
}

/// Changes a text that is JSON, and leaves any other.
fn change(text: &mut String, edit: impl FnOnce(&mut Value)) {
    if let Ok(mut document) = serde_json::from_str::<Value>(text) {
        edit(&mut document);
        *text = document.to_string();
    }
}

/// The place a way leads to: it ends early where there is nothing below.
fn follow<'a>(value: &'a mut Value, way: &[Option<Index>]) -> Option<&'a mut Value> {
    let Some((Some(index), rest)) = way.split_first() else { return Some(value) };
    let leaf = match value {
        Value::Array(items) => items.is_empty(),
        Value::Object(fields) => fields.is_empty(),
        _ => true,
    };
    match value {
        _ if leaf => Some(value),
        Value::Array(items) => {
            let at = index.index(items.len());
            follow(&mut items[at], rest)
        }
        Value::Object(fields) => {
            let at = index.index(fields.len());
            follow(fields.values_mut().nth(at)?, rest)
        }
        _ => None,
    }
}

/// Sources of a manifest's calibration by four throws of a die.
fn sources_of(manifest: &mut Value, [scale, plane, position, time]: [u8; 4]) {
    let known = |value: f64| json!({ "value": value, "sd": 0.01, "assumed": true, "from": "thrown" });
    let choice = |names: &[&str], throw: u8| Value::from(names[usize::from(throw) % names.len()]);
    let plane = match plane % 4 {
        0 => "track".into(),
        1 => json!({ "wall": "from_stance" }),
        2 => json!({ "wall": { "ratio": known(1.15) } }),
        _ => json!({ "wall": { "distances": { "camera_to_track_m": 12.0, "camera_to_wall_m": 14.0 } } }),
    };
    let position = match position % 4 {
        0 => json!({ "kind": "fixed_camera" }),
        1 => json!({ "kind": "fixed_mark", "mark": 7.5 }),
        2 => json!({ "kind": "camera_spacing", "spacing_m": known(0.3), "first_axis_mark": 4.0 }),
        _ => json!({ "kind": "camera_spacing", "spacing_m": known(0.6858), "first_axis_mark": 3.7 }),
    };
    let mut set = |place: &str, value: Value| set(manifest, &format!("/calibration/{place}"), value);
    set("scale/driven_by", choice(&["known_length", "withers_height"], scale));
    set("scale/known_length/plane", plane);
    set("position", position);
    set("time/driven_by", choice(&["interval", "speed", "stride_time"], time));
    set("time/stride_time_s", known(0.45));
}
