//! COCO keypoints: one JSON file for all pictures. Visibility is strict: 0 not placed, 1 occluded, 2 visible.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::collect::{Collector, FoundPoint, Origin, Said, Target};
use super::format::parse_json;
use super::layout::{Layout, PictureSource};
use super::names::skeleton_edges;
use super::notes::Skipped;
use super::{ExchangeError, Format};
use crate::annotation::KeypointState;
use crate::files::to_stable_json;
use crate::keypoint::{KEYPOINT_COUNT, Keypoint};
use crate::manifest::Manifest;

/// The one category.
const CATEGORY: i64 = 1;

#[derive(Serialize)]
struct Info<'a> {
    description: &'a str,
    contributor: &'a str,
    date_created: &'a str,
}

#[derive(Serialize)]
struct WrittenImage<'a> {
    id: i64,
    width: u32,
    height: u32,
    file_name: &'a str,
}

#[derive(Serialize)]
struct WrittenAnnotation {
    id: i64,
    image_id: i64,
    category_id: i64,
    /// The panel, where one picture shows several; a key that other tools pass over.
    #[serde(skip_serializing_if = "Option::is_none")]
    muybridge_panel: Option<u32>,
    bbox: [f64; 4],
    area: f64,
    iscrowd: u8,
    num_keypoints: usize,
    keypoints: Vec<f64>,
}

#[derive(Serialize)]
struct WrittenCategory {
    id: i64,
    name: &'static str,
    supercategory: &'static str,
    keypoints: Vec<&'static str>,
    /// Pairs of keypoints counted from 1, as in COCO's own files.
    skeleton: Vec<[usize; 2]>,
}

#[derive(Serialize)]
struct WrittenDataset<'a> {
    info: Info<'a>,
    licenses: [(); 0],
    images: Vec<WrittenImage<'a>>,
    annotations: Vec<WrittenAnnotation>,
    categories: [WrittenCategory; 1],
}

/// The one file.
pub(super) fn write(manifest: &Manifest, layout: &Layout) -> Vec<(String, Vec<u8>)> {
    let images = layout.pictures.iter().zip(1..).map(|(picture, id)| {
        let [width, height] = picture.size_px;
        WrittenImage { id, width, height, file_name: &picture.name }
    });
    let category = WrittenCategory {
        id: CATEGORY,
        name: "horse",
        supercategory: "animal",
        keypoints: Keypoint::all().map(Keypoint::name).collect(),
        skeleton: skeleton_edges().map(|edge| edge.map(|keypoint| keypoint.index() + 1)).collect(),
    };
    let dataset = WrittenDataset {
        info: Info {
            description: &manifest.title,
            contributor: &manifest.holder,
            date_created: &manifest.date,
        },
        licenses: [],
        images: images.collect(),
        annotations: annotations(layout),
        categories: [category],
    };
    vec![(format!("{}.coco.json", manifest.id), to_stable_json(&dataset).into_bytes())]
}

fn annotations(layout: &Layout) -> Vec<WrittenAnnotation> {
    let mut annotations = Vec::new();
    for (shown, id) in layout.shown.iter().zip(1..) {
        let mut keypoints = vec![0.0; 3 * KEYPOINT_COUNT];
        let (mut low, mut high) = ([f64::MAX; 2], [f64::MIN; 2]);
        for point in &shown.points {
            let visibility = if point.state == KeypointState::Visible { 2.0 } else { 1.0 };
            let slot = 3 * point.keypoint.index();
            keypoints[slot..slot + 3].copy_from_slice(&[point.at[0], point.at[1], visibility]);
            low = [0, 1].map(|axis| low[axis].min(point.at[axis]));
            high = [0, 1].map(|axis| high[axis].max(point.at[axis]));
        }
        let size = [0, 1].map(|axis| high[axis] - low[axis]);
        let is_image = matches!(layout.pictures[shown.picture].source, PictureSource::Image(_));
        annotations.push(WrittenAnnotation {
            id,
            image_id: shown.picture as i64 + 1,
            category_id: CATEGORY,
            muybridge_panel: is_image.then_some(shown.panel),
            bbox: [low[0], low[1], size[0], size[1]],
            area: size[0] * size[1],
            iscrowd: 0,
            num_keypoints: shown.points.len(),
            keypoints,
        });
    }
    annotations
}

#[derive(Deserialize)]
struct ReadDataset {
    images: Vec<ReadImage>,
    annotations: Vec<ReadAnnotation>,
    categories: Vec<ReadCategory>,
}

#[derive(Deserialize)]
struct ReadImage {
    id: i64,
    file_name: String,
    width: Option<f64>,
    height: Option<f64>,
}

#[derive(Deserialize)]
struct ReadAnnotation {
    image_id: i64,
    category_id: i64,
    muybridge_panel: Option<u32>,
    keypoints: Option<Vec<f64>>,
}

#[derive(Deserialize)]
struct ReadCategory {
    id: i64,
    keypoints: Option<Vec<String>>,
}

/// Reads a file.
pub(super) fn read(file: &str, text: &str, collector: &mut Collector<'_>) -> Result<(), ExchangeError> {
    let dataset: ReadDataset = parse_json(file, text)?;
    let images: BTreeMap<i64, &ReadImage> = dataset.images.iter().map(|image| (image.id, image)).collect();
    let categories: BTreeMap<i64, &[String]> =
        dataset.categories.iter().map(|c| (c.id, c.keypoints.as_deref().unwrap_or_default())).collect();
    if images.len() < dataset.images.len() || categories.len() < dataset.categories.len() {
        let message = "an identifier comes twice, so nobody can tell what is meant; give each its own";
        return Err(ExchangeError::content(file, "images or categories", message));
    }
    for (index, annotation) in dataset.annotations.iter().enumerate() {
        let place = format!("annotations[{index}]");
        let wrong = |message: String| ExchangeError::content(file, place.as_str(), message);
        let keypoints = annotation.keypoints.as_deref().unwrap_or_default();
        if keypoints.is_empty() {
            collector.notes.skip(Skipped::NoPoints, place);
            continue;
        }
        let names = categories.get(&annotation.category_id).copied();
        let names = names.ok_or_else(|| wrong(format!("there is no category {}", annotation.category_id)))?;
        let image = images.get(&annotation.image_id).copied();
        let image = image.ok_or_else(|| wrong(format!("there is no image {}", annotation.image_id)))?;
        if keypoints.len() != 3 * names.len() {
            let (found, wanted) = (keypoints.len(), 3 * names.len());
            return Err(wrong(format!(
                "{found} numbers, but the category's keypoints need {wanted}; correct it"
            )));
        }
        let target = Target::Picture {
            name: image.file_name.clone(),
            size_px: image.width.zip(image.height).map(|(width, height)| [width, height]),
            panel: annotation.muybridge_panel,
        };
        let points = points(names, keypoints, collector);
        collector.take(file, &place, Format::Coco, &target, points)?;
    }
    Ok(())
}

fn points(names: &[String], keypoints: &[f64], collector: &mut Collector<'_>) -> Vec<FoundPoint> {
    let mut points = Vec::new();
    for (name, triple) in names.iter().zip(keypoints.chunks_exact(3)) {
        let state = match triple[2] {
            0.0 => continue,
            1.0 => KeypointState::Occluded,
            2.0 => KeypointState::Visible,
            other => {
                collector.notes.skip(Skipped::UnknownState, format!("visibility {other}"));
                continue;
            }
        };
        points.push(FoundPoint {
            name: name.clone(),
            at: Some([triple[0], triple[1]]),
            said: Said { state: Some(state), by: Origin::Unsaid },
        });
    }
    points
}
