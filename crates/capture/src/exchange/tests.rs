//! Round trips, other people's names and files, and damage.

mod damage;
mod foreign;

use std::collections::BTreeMap;

use muybridge_core::{Gait, Random};
use proptest::prelude::*;

use super::*;
use crate::annotation::{KeypointState, Keypoints, PanelAnnotation, Placed, PlacedBy};
use crate::keypoint::Keypoint;
use crate::manifest::{Facing, MANIFEST_SCHEMA, Panel, PlateImage};

/// Panels of a test plate: two rows of three, tilted a little.
const PANELS: u32 = 6;
const SIZE_PX: [u32; 2] = [200, 120];

/// Cut-outs by a sheared and stretched map, as little like the identity as a panel is.
struct Cutouts;

impl Cutouts {
    fn corner(panel: u32) -> [f64; 2] {
        let index = panel - 1;
        [20.0 + 250.0 * f64::from(index % 3), 30.0 + 170.0 * f64::from(index / 3)]
    }
}

impl PanelPictures for Cutouts {
    fn size_px(&self, panel: u32) -> Option<[u32; 2]> {
        (1..=PANELS).contains(&panel).then_some(SIZE_PX)
    }

    fn plate_from_panel(&self, panel: u32, [x, y]: [f64; 2]) -> Option<[f64; 2]> {
        let [left, top] = Self::corner(panel);
        Some([left + 1.1 * x, top + 1.2 * y + 0.03 * x])
    }

    fn panel_from_plate(&self, panel: u32, [x, y]: [f64; 2]) -> Option<[f64; 2]> {
        let [left, top] = Self::corner(panel);
        let across = (x - left) / 1.1;
        Some([across, (y - top - 0.03 * across) / 1.2])
    }
}

fn manifest() -> Manifest {
    let [width, height] = SIZE_PX.map(f64::from);
    let corners = [[0.0, 0.0], [width, 0.0], [width, height], [0.0, height]];
    let quad = |panel| corners.map(|corner| Cutouts.plate_from_panel(panel, corner).unwrap());
    Manifest {
        schema: MANIFEST_SCHEMA,
        id: "test-plate".into(),
        catalogue_number: None,
        title: "A \"plate\": of one horse".into(),
        animal: String::new(),
        gait: Gait::Walk,
        date: "1 June 1878".into(),
        source: String::new(),
        holder: String::new(),
        licence: String::new(),
        printed: Vec::new(),
        facing: Some(Facing::Right),
        images: vec![PlateImage {
            file: "scans/test-plate.jpg".into(),
            sha256: "0".repeat(64),
            width_px: 800,
            height_px: 400,
        }],
        panels: (1..=PANELS).map(|panel| Panel { panel, image: 0, quad_px: quad(panel) }).collect(),
        calibration: None,
    }
}

fn annotation() -> Annotation {
    let read = serde_json::json!({
        "schema": 1, "plate": "../plates/test-plate.json", "images_sha256": [], "annotator": "A. Person",
        "visible_sd_px": 1.5, "occluded_sd_px": 2.5, "notes": [], "panels": [],
        "stride": { "first": 1, "last": PANELS, "closes_after_panels": null },
    });
    serde_json::from_value(read).unwrap()
}

/// Points all over the panels, in every state and of every provenance.
fn filled(seed: u64) -> Annotation {
    let mut random = Random::new(seed);
    let mut annotation = annotation();
    for panel in 1..=PANELS {
        let mut keypoints = Keypoints::default();
        for keypoint in Keypoint::all() {
            let mut unit = || random.uniform();
            let at = [unit(), unit()];
            let state = match unit() {
                u if u < 0.2 => continue,
                u if u < 0.3 => KeypointState::Absent,
                u if u < 0.6 => KeypointState::Occluded,
                _ => KeypointState::Visible,
            };
            let by = [PlacedBy::Hand, PlacedBy::Interpolated, PlacedBy::Tracked, PlacedBy::Fitted];
            let by = by[(unit() * 3.999) as usize];
            let at = [0, 1].map(|axis| at[axis] * f64::from(SIZE_PX[axis]));
            let at_px = (state != KeypointState::Absent)
                .then(|| Cutouts.plate_from_panel(panel, at).unwrap().map(|v| (v * 10.0).round() / 10.0));
            keypoints.insert(keypoint, Placed { at_px, state, by, sd_px: None });
        }
        annotation.panels.push(PanelAnnotation { keypoints, ..PanelAnnotation::empty(panel) });
    }
    annotation
}

fn exported(annotation: &Annotation, format: Format, space: Option<Space>) -> Export {
    let options = ExportOptions { space, scorer: None };
    export(&manifest(), annotation, &Cutouts, format, &options).unwrap()
}

fn files(export: &Export) -> Vec<ImportFile> {
    let file =
        |(name, content): &(String, Vec<u8>)| ImportFile { name: name.clone(), content: content.clone() };
    export.files.iter().filter(|(name, _)| !name.ends_with(".yaml")).map(file).collect()
}

fn imported(name: &str, text: &str) -> Result<Import, ExchangeError> {
    imported_as(name, text, &manifest(), &BTreeMap::new())
}

fn imported_as(
    name: &str,
    text: &str,
    manifest: &Manifest,
    names: &BTreeMap<String, Option<String>>,
) -> Result<Import, ExchangeError> {
    let file = ImportFile { name: name.into(), content: text.as_bytes().to_vec() };
    import(&[file], None, manifest, &Cutouts, names)
}

/// What a format makes of a point; none where it forgets it.
fn kept(placed: &Placed, format: Format, likelihoods: bool) -> Option<Placed> {
    let Placed { at_px, state, by, .. } = *placed;
    let (state, by) = match format {
        Format::Csv => (state, by),
        _ if at_px.is_none() => return None,
        Format::Labelme => (state, by),
        Format::Coco => (state, PlacedBy::Hand),
        Format::DeepLabCut if likelihoods => (state, PlacedBy::Tracked),
        Format::DeepLabCut => (KeypointState::Visible, PlacedBy::Hand),
    };
    Some(Placed { at_px, state, by, sd_px: None })
}

fn assert_comes_back(annotation: &Annotation, import: &Import, format: Format, likelihoods: bool) {
    for panel in &annotation.panels {
        let found = import.panels.iter().find(|(number, _)| *number == panel.panel).map(|(_, points)| points);
        for keypoint in Keypoint::all() {
            let expected = panel.keypoints.get(keypoint).and_then(|placed| kept(placed, format, likelihoods));
            let found = found.and_then(|points| points.get(keypoint));
            let what = format!("{format:?}, panel {}, {keypoint}", panel.panel);
            assert_eq!(expected.map(|p| (p.state, p.by)), found.map(|p| (p.state, p.by)), "{what}");
            let places = expected.and_then(|p| p.at_px).zip(found.and_then(|p| p.at_px));
            let Some((expected, found)) = places else { continue };
            let apart = (expected[0] - found[0]).hypot(expected[1] - found[1]);
            assert!(apart < 1e-6, "{what}: {apart} px");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn nothing_is_lost_but_what_the_notes_say(seed in any::<u64>()) {
        let annotation = filled(seed);
        for format in Format::ALL {
            for space in format.spaces() {
                let export = exported(&annotation, format, Some(*space));
                let all = files(&export);
                // DeepLabCut has labels and likelihoods, which are two tellings of the same points.
                let tellings: Vec<&[ImportFile]> = match format {
                    Format::DeepLabCut => all.chunks(1).collect(),
                    _ => vec![&all],
                };
                for telling in tellings {
                    let import = import(telling, None, &manifest(), &Cutouts, &BTreeMap::new()).unwrap();
                    let likelihoods = telling[0].name.contains("DLC_");
                    assert_comes_back(&annotation, &import, format, likelihoods);
                }
            }
        }
    }
}

#[test]
fn losses_are_counted() {
    let annotation = filled(1);
    let placed = |wanted: fn(&Placed) -> bool| {
        let points = annotation.panels.iter().flat_map(|panel| panel.keypoints.iter());
        points.filter(|(_, placed)| wanted(placed)).count().to_string()
    };
    let occluded = placed(|p| p.state == KeypointState::Occluded);
    let by_others = placed(|p| p.state != KeypointState::Absent && p.by != PlacedBy::Hand);
    let absent = placed(|p| p.state == KeypointState::Absent);
    let expected = [vec![&occluded, &by_others, &absent], vec![&by_others, &absent], vec![&absent], vec![]];
    for (format, counts) in Format::ALL.into_iter().zip(expected) {
        let notes = exported(&annotation, format, None).notes;
        let found: Vec<&str> = notes.iter().map(|note| note.split(' ').next().unwrap()).collect();
        assert_eq!(found, counts, "{notes:?}");
    }
}

#[test]
fn the_centre_of_the_first_pixel_is_where_each_format_has_it() {
    let mut annotation = annotation();
    let mut keypoints = Keypoints::default();
    let at_px = Cutouts.plate_from_panel(2, [0.5, 0.5]);
    let muzzle = Keypoint::all().next().unwrap();
    keypoints
        .insert(muzzle, Placed { at_px, state: KeypointState::Visible, by: PlacedBy::Hand, sd_px: None });
    annotation.panels.push(PanelAnnotation { keypoints, ..PanelAnnotation::empty(2) });
    let text =
        |format| String::from_utf8(exported(&annotation, format, None).files.swap_remove(0).1).unwrap();
    let labels =
        String::from_utf8(exported(&annotation, Format::DeepLabCut, None).files.swap_remove(1).1).unwrap();
    assert!(labels.contains("labeled-data,test-plate,img002.png,0,0,,"), "{labels}");
    let coco: serde_json::Value = serde_json::from_str(&text(Format::Coco)).unwrap();
    let muzzle: Vec<f64> = serde_json::from_value(coco["annotations"][0]["keypoints"].clone()).unwrap();
    assert_eq!(muzzle[..3], [0.0, 0.0, 2.0]);
    let labelme: serde_json::Value = serde_json::from_str(&text(Format::Labelme)).unwrap();
    assert_eq!(labelme["shapes"][0]["points"], serde_json::json!([[0.5, 0.5]]));
}

/// Points of one panel, as name, place and state.
fn panel_of(import: &Import, number: u32) -> Vec<(&'static str, Option<[f64; 2]>, KeypointState)> {
    let panel = import.panels.iter().find(|(panel, _)| *panel == number);
    panel
        .into_iter()
        .flat_map(|(_, points)| points.iter())
        .map(|(k, p)| (k.name(), p.at_px, p.state))
        .collect()
}

/// A table of labels: rows of a key and of cells for the two bodyparts.
fn labels(names: [&str; 2], rows: &[&str]) -> String {
    let [a, b] = names;
    format!("scorer,,,S,S,S,S\nbodyparts,,,{a},{a},{b},{b}\ncoords,,,x,y,x,y\n{}\n", rows.join("\n"))
}
