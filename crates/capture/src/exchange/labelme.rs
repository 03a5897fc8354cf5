//! labelme: one JSON file a picture; a point is a shape of type `point`. Keys it does not know survive in it, so the
//! provenance rides along as `by`, and `flags.occluded` is the state.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::collect::{Collector, FoundPoint, Origin, Said, Target};
use super::format::parse_json;
use super::layout::{Layout, PictureSource, stem};
use super::notes::{Skipped, short};
use super::plain_csv::{provenance, provenance_name};
use super::{ExchangeError, Format};
use crate::annotation::KeypointState;
use crate::files::to_stable_json;

/// Version of labelme whose files these are.
const VERSION: &str = "6.1.0";
/// The flag of an occluded point.
const OCCLUDED: &str = "occluded";

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct WrittenFile<'a> {
    version: &'static str,
    flags: BTreeMap<(), ()>,
    shapes: Vec<WrittenShape>,
    image_path: &'a str,
    image_data: (),
    image_height: u32,
    image_width: u32,
}

#[derive(Serialize)]
struct WrittenShape {
    label: &'static str,
    points: [[f64; 2]; 1],
    /// The panel, where one picture shows several.
    group_id: Option<u32>,
    description: &'static str,
    shape_type: &'static str,
    flags: BTreeMap<&'static str, bool>,
    mask: (),
    by: &'static str,
}

/// One file for each picture that shows a point.
pub(super) fn write(layout: &Layout) -> Vec<(String, Vec<u8>)> {
    let mut files = Vec::new();
    for (index, picture) in layout.pictures.iter().enumerate() {
        let many = matches!(picture.source, PictureSource::Image(_));
        let mut shapes = Vec::new();
        for shown in layout.shown.iter().filter(|shown| shown.picture == index) {
            shapes.extend(shown.points.iter().map(|point| WrittenShape {
                label: point.keypoint.name(),
                points: [point.at],
                group_id: many.then_some(shown.panel),
                description: "",
                shape_type: "point",
                flags: BTreeMap::from([(OCCLUDED, point.state == KeypointState::Occluded)]),
                mask: (),
                by: provenance_name(point.by),
            }));
        }
        if shapes.is_empty() {
            continue;
        }
        let [image_width, image_height] = picture.size_px;
        let file = WrittenFile {
            version: VERSION,
            flags: BTreeMap::new(),
            shapes,
            image_path: &picture.name,
            image_data: (),
            image_height,
            image_width,
        };
        files.push((format!("{}.json", stem(&picture.name)), to_stable_json(&file).into_bytes()));
    }
    files
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct ReadFile {
    shapes: Vec<ReadShape>,
    image_path: String,
    image_height: Option<f64>,
    image_width: Option<f64>,
}

#[derive(Deserialize)]
struct ReadShape {
    label: String,
    points: Vec<[f64; 2]>,
    shape_type: String,
    group_id: Option<i64>,
    flags: Option<BTreeMap<String, bool>>,
    by: Option<String>,
}

/// Reads a file; shapes that are no points are counted and skipped.
pub(super) fn read(file: &str, text: &str, collector: &mut Collector<'_>) -> Result<(), ExchangeError> {
    let document: ReadFile = parse_json(file, text)?;
    for (index, shape) in document.shapes.into_iter().enumerate() {
        let place = format!("shapes[{index}]");
        let ("point", [at]) = (shape.shape_type.as_str(), shape.points.as_slice()) else {
            collector
                .notes
                .skip(Skipped::NoPoints, format!("{} {}", short(&shape.shape_type), short(&shape.label)));
            continue;
        };
        let occluded = shape.flags.is_some_and(|flags| flags.get(OCCLUDED) == Some(&true));
        let state = if occluded { KeypointState::Occluded } else { KeypointState::Visible };
        let by = shape.by.as_deref().and_then(provenance).map_or(Origin::Unsaid, Origin::Carried);
        let point = FoundPoint { at: Some(*at), said: Said { state: Some(state), by }, name: shape.label };
        let target = Target::Picture {
            name: document.image_path.clone(),
            size_px: document.image_width.zip(document.image_height).map(|(width, height)| [width, height]),
            panel: shape.group_id.and_then(|id| u32::try_from(id).ok()),
        };
        collector.take(file, &place, Format::Labelme, &target, vec![point])?;
    }
    Ok(())
}
