//! A plate of 50 megapixels with 24 panels: the specimen's twelve, twice, enlarged.

use std::path::{Path, PathBuf};

use image::imageops::{FilterType, crop_imm, resize};
use image::{ImageEncoder, RgbImage, codecs::jpeg::JpegEncoder};
use muybridge_capture::{
    Annotation, Manifest, PanelAnnotation, hash_file, read_json, write_atomically, write_json,
};

/// Sides, px.
const PLATE_PX: [u32; 2] = [8660, 5773];
/// Columns and rows.
const GRID: [u32; 2] = [6, 4];
/// Share of its cell that a panel takes.
const FILLED: f64 = 0.94;

/// Where a panel of the specimen goes: `large = corner + factor * (small - least)`.
struct Enlarged {
    least: [f64; 2],
    size: [f64; 2],
    corner: [f64; 2],
    factor: f64,
}

impl Enlarged {
    fn place(&self, at: &mut [f64; 2]) {
        *at = [0, 1].map(|i| self.corner[i] + self.factor * (at[i] - self.least[i]));
    }
}

/// Draws the plate into a folder; the path of its annotation.
pub(crate) fn large_plate(folder: &Path) -> PathBuf {
    let specimens = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../plates/specimens");
    let mut manifest = Manifest::read(&specimens.join("specimen-trot.json")).unwrap();
    let mut annotation: Annotation = read_json(&specimens.join("annotations/specimen-trot.json"), 1).unwrap();
    let small = image::open(specimens.join("specimen-trot.jpg")).unwrap().into_rgb8();
    let mut large = RgbImage::from_pixel(PLATE_PX[0], PLATE_PX[1], image::Rgb([205, 195, 175]));
    let (panels, marked) = (std::mem::take(&mut manifest.panels), std::mem::take(&mut annotation.panels));
    for number in 1..=GRID[0] * GRID[1] {
        let source = (number as usize - 1) % panels.len();
        let enlarged = enlarged(&panels[source].quad_px, number - 1);
        paste(&small, &mut large, &enlarged);
        let mut panel = panels[source].clone();
        panel.panel = number;
        panel.quad_px.iter_mut().for_each(|corner| enlarged.place(corner));
        manifest.panels.push(panel);
        annotation.panels.push(moved(&marked[source], number, &enlarged));
    }
    manifest.id = "large".into();
    annotation.plate = "large.json".into();
    let mut picture = Vec::new();
    let encoder = JpegEncoder::new_with_quality(&mut picture, 85);
    let color = image::ExtendedColorType::Rgb8;
    encoder.write_image(large.as_raw(), PLATE_PX[0], PLATE_PX[1], color).unwrap();
    write_atomically(&folder.join("large.jpg"), &picture).unwrap();
    let hash = hash_file(&folder.join("large.jpg")).unwrap();
    let image = &mut manifest.images[0];
    (image.file, image.sha256) = ("large.jpg".into(), hash.clone());
    [image.width_px, image.height_px] = PLATE_PX;
    annotation.images_sha256 = vec![hash];
    write_json(&folder.join("large.json"), &manifest).unwrap();
    let path = folder.join("annotation.json");
    write_json(&path, &annotation).unwrap();
    path
}

fn enlarged(quad_px: &[[f64; 2]; 4], cell: u32) -> Enlarged {
    let [least, greatest] = [0, 2].map(|corner| quad_px[corner]);
    let size = [0, 1].map(|i| greatest[i] - least[i]);
    let cell_px = [0, 1].map(|i| f64::from(PLATE_PX[i]) / f64::from(GRID[i]));
    let factor = FILLED * (cell_px[0] / size[0]).min(cell_px[1] / size[1]);
    let at = [cell % GRID[0], cell / GRID[0]];
    let corner = [0, 1].map(|i| (f64::from(at[i]) + 0.5) * cell_px[i] - 0.5 * factor * size[i]);
    Enlarged { least, size, corner, factor }
}

fn paste(small: &RgbImage, large: &mut RgbImage, to: &Enlarged) {
    let [x, y, width, height] =
        [to.least[0], to.least[1], to.size[0], to.size[1]].map(|v| v.round().max(0.0) as u32);
    let photograph = crop_imm(small, x, y, width, height).to_image();
    let size = [0, 1].map(|i| (to.factor * to.size[i]).round() as u32);
    let photograph = resize(&photograph, size[0], size[1], FilterType::Triangle);
    let corner = to.corner.map(|v| v.round() as i64);
    image::imageops::replace(large, &photograph, corner[0], corner[1]);
}

fn moved(marked: &PanelAnnotation, number: u32, to: &Enlarged) -> PanelAnnotation {
    let mut panel = PanelAnnotation { panel: number, ..marked.clone() };
    panel.ground_px.iter_mut().flatten().for_each(|at| to.place(at));
    panel.marks.iter_mut().for_each(|mark| to.place(&mut mark.at_px));
    for (keypoint, placed) in marked.keypoints.iter() {
        let mut placed = *placed;
        placed.at_px.iter_mut().for_each(|at| to.place(at));
        panel.keypoints.insert(keypoint, placed);
    }
    panel
}
