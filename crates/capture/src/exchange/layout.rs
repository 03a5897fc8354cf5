//! Which pictures an export speaks of, and where the placed points lie in them.

use std::collections::{BTreeMap, BTreeSet};

use super::notes::short;
use super::{ExchangeError, ExportPicture, Format, Space};
use crate::annotation::{Annotation, KeypointState, PlacedBy};
use crate::keypoint::Keypoint;
use crate::manifest::{Manifest, Panel, PlateImage};

/// The pictures of single panels, cut out of the plate and squared up. The caller gives them, because their transform
/// (`muybridge_imaging::PanelTransform`) belongs to pixels, which this crate knows nothing of.
pub trait PanelPictures {
    /// Width and height of a panel's picture, px; none for a panel that has no picture.
    fn size_px(&self, panel: u32) -> Option<[u32; 2]>;
    /// A point of the panel's picture in plate px.
    fn plate_from_panel(&self, panel: u32, point_in_panel_px: [f64; 2]) -> Option<[f64; 2]>;
    /// A point of the plate in px of the panel's picture.
    fn panel_from_plate(&self, panel: u32, point_in_plate_px: [f64; 2]) -> Option<[f64; 2]>;
}

/// What a picture shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PictureSource {
    /// A panel, cut out.
    Panel(u32),
    /// An image file of the plate, by its index in the manifest, as it is.
    Image(usize),
}

/// Steps of a written coordinate, 1/px: finer than any rounding that matters, coarser than the last bits of arithmetic,
/// which differ between processors.
const STEPS_PER_PX: f64 = 1e8;
/// A panel whose corners are this close to those of its image is the image, px.
const WHOLE_IMAGE_MARGIN_PX: f64 = 0.5;

/// A picture of an export.
pub(super) struct Picture {
    pub(super) source: PictureSource,
    pub(super) name: String,
    pub(super) size_px: [u32; 2],
}

/// A point as it goes into the file.
pub(super) struct ShownPoint {
    pub(super) keypoint: Keypoint,
    /// In the format's own pixels.
    pub(super) at: [f64; 2],
    pub(super) state: KeypointState,
    pub(super) by: PlacedBy,
}

/// A panel in a picture; at least one point.
pub(super) struct Shown {
    pub(super) panel: u32,
    /// Index into [`Layout::pictures`].
    pub(super) picture: usize,
    pub(super) points: Vec<ShownPoint>,
}

/// All pictures of an export, and all panels with points.
pub(super) struct Layout {
    pub(super) pictures: Vec<Picture>,
    pub(super) shown: Vec<Shown>,
    format: Format,
}

impl Layout {
    pub(super) fn new(
        manifest: &Manifest,
        annotation: &Annotation,
        panels: &dyn PanelPictures,
        format: Format,
        space: Space,
    ) -> Result<Self, ExchangeError> {
        let (pictures, picture_of_panel) = pictures(manifest, panels, format, space)?;
        let mut shown = Vec::new();
        for annotated in &annotation.panels {
            let number = annotated.panel;
            let unknown = |message: &str| ExchangeError::Panel { panel: number, message: message.into() };
            let picture = *picture_of_panel.get(&number).ok_or_else(|| {
                unknown("is annotated, but the manifest has no such panel; correct one of the two")
            })?;
            let offset = format.first_pixel_centre_px() - 0.5;
            let mut points = Vec::new();
            for (keypoint, placed) in annotated.keypoints.iter() {
                let Some(place) = placed.place() else { continue };
                let at = match pictures[picture].source {
                    PictureSource::Image(_) => Some(place),
                    PictureSource::Panel(panel) => panels.panel_from_plate(panel, place),
                };
                let at = at
                    .filter(|at| at.iter().all(|v| v.is_finite()))
                    .ok_or_else(|| {
                        unknown(&format!("{keypoint} lies nowhere in its picture; place it anew"))
                    })?
                    .map(|v| ((v + offset) * STEPS_PER_PX).round() / STEPS_PER_PX);
                points.push(ShownPoint { keypoint, at, state: placed.state, by: placed.by });
            }
            if !points.is_empty() {
                shown.push(Shown { panel: number, picture, points });
            }
        }
        Ok(Self { pictures, shown, format })
    }

    /// The pictures, in a folder of the export (empty for its root).
    pub(super) fn pictures_in(&self, folder: &str) -> Vec<ExportPicture> {
        let path = |picture: &Picture| format!("{folder}{}", picture.name);
        self.pictures.iter().map(|p| ExportPicture { path: path(p), source: p.source }).collect()
    }

    /// What the format does not keep of this annotation.
    pub(super) fn losses(&self, annotation: &Annotation) -> Vec<String> {
        let points = || self.shown.iter().flat_map(|shown| &shown.points);
        let occluded = points().filter(|point| point.state == KeypointState::Occluded).count();
        let by_others = points().filter(|point| point.by != PlacedBy::Hand).count();
        let entries = annotation.panels.iter().flat_map(|panel| panel.keypoints.iter());
        let absent = entries.filter(|(_, placed)| placed.place().is_none()).count();
        let mut losses = Vec::new();
        let mut lose = |count: usize, what: &str| {
            if count > 0 {
                losses.push(format!("{count} {what}"));
            }
        };
        if self.format == Format::DeepLabCut {
            lose(
                occluded,
                "occluded points are ordinary labels in CollectedData; the file with likelihoods keeps their state",
            );
        }
        if matches!(self.format, Format::DeepLabCut | Format::Coco) {
            lose(by_others, "points not placed by hand (interpolated, tracked, fitted) do not say so there");
        }
        if self.format != Format::Csv {
            lose(absent, "points declared absent are the same there as points nobody has placed");
        }
        losses
    }
}

/// The pictures of a space, and which of them shows which panel.
fn pictures(
    manifest: &Manifest,
    panels: &dyn PanelPictures,
    format: Format,
    space: Space,
) -> Result<(Vec<Picture>, BTreeMap<u32, usize>), ExchangeError> {
    if let Some(panel) = manifest.panels.iter().find(|panel| panel.image >= manifest.images.len()) {
        let message = "the manifest has no image of this index; correct `image`".into();
        return Err(ExchangeError::Panel { panel: panel.panel, message });
    }
    let (found, of_panel) = match space {
        Space::Plate => (
            (0..manifest.images.len()).map(|index| image(manifest, index)).collect(),
            manifest.panels.iter().map(|panel| (panel.panel, panel.image)).collect(),
        ),
        Space::Panel => {
            let found = manifest.panels.iter().map(|panel| picture_of_panel(manifest, panels, format, panel));
            let numbers = manifest.panels.iter().map(|panel| panel.panel);
            (found.collect::<Result<Vec<Picture>, _>>()?, numbers.zip(0..).collect())
        }
    };
    check_names(manifest, &found)?;
    Ok((found, of_panel))
}

fn image(manifest: &Manifest, index: usize) -> Picture {
    let image = &manifest.images[index];
    let name = last_part(&image.file).to_string();
    Picture { source: PictureSource::Image(index), name, size_px: [image.width_px, image.height_px] }
}

/// A panel's cut-out, or its image file where that shows nothing else.
fn picture_of_panel(
    manifest: &Manifest,
    panels: &dyn PanelPictures,
    format: Format,
    panel: &Panel,
) -> Result<Picture, ExchangeError> {
    if is_whole_image(manifest, panel) {
        return Ok(image(manifest, panel.image));
    }
    let number = panel.panel;
    let size_px = panels.size_px(number).ok_or_else(|| ExchangeError::Panel {
        panel: number,
        message: "its quadrilateral cannot be squared up; correct `quad_px` of the manifest".into(),
    })?;
    let name = match format {
        Format::DeepLabCut => format!("img{number:03}.png"),
        Format::Coco | Format::Labelme | Format::Csv => format!("panel_{number:02}.png"),
    };
    Ok(Picture { source: PictureSource::Panel(number), name, size_px })
}

/// Every picture must be known by its name, also when it comes back: a cut-out must not be called what an image of the
/// plate is called.
fn check_names(manifest: &Manifest, pictures: &[Picture]) -> Result<(), ExchangeError> {
    let mut stems: BTreeSet<String> = BTreeSet::new();
    for picture in pictures {
        let is_image = |image: &PlateImage| stem(&image.file) == stem(&picture.name);
        let taken = matches!(picture.source, PictureSource::Panel(_)) && manifest.images.iter().any(is_image);
        if !stems.insert(stem(&picture.name)) || taken {
            return Err(ExchangeError::SameName(short(&picture.name)));
        }
    }
    Ok(())
}

/// Whether a panel is all of an image file, as in a plate of one file a panel.
pub(super) fn is_whole_image(manifest: &Manifest, panel: &Panel) -> bool {
    let Some(image) = manifest.images.get(panel.image) else { return false };
    let [width, height] = [f64::from(image.width_px), f64::from(image.height_px)];
    let corners = [[0.0, 0.0], [width, 0.0], [width, height], [0.0, height]];
    let close = |(a, b): (&[f64; 2], [f64; 2])| (0..2).all(|i| (a[i] - b[i]).abs() <= WHOLE_IMAGE_MARGIN_PX);
    panel.quad_px.iter().zip(corners).all(close)
        && manifest.panels.iter().filter(|other| other.image == panel.image).count() == 1
}

/// The file's name in a path with slashes of either kind.
pub(super) fn last_part(path: &str) -> &str {
    path.rsplit(['/', '\\']).next().unwrap_or(path)
}

/// What a picture is known by: its file's name without extension, in small letters. Other tools change the rest.
pub(super) fn stem(path: &str) -> String {
    let name = last_part(path).trim();
    name.rsplit_once('.').map_or(name, |(stem, _)| stem).to_lowercase()
}
