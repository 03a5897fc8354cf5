//! Loading a plate's documents together, and saying what is wrong with them: file, panel, field, and what to do.

use std::path::{Path, PathBuf};

use crate::annotation::{ANNOTATION_SCHEMA, Annotation, KeypointState, PanelAnnotation, PanelUse};
use crate::files::{FileError, Hash, hash_bytes, hash_file, read_json, to_stable_json};
use crate::images::locate_image;
use crate::manifest::{
    Calibration, Facing, Known, MANIFEST_SCHEMA, Manifest, Parallax, Plane, Position, ScaleSource, TimeSource,
};

/// Fewest points for a panel to count: fewer leave the root and the trunk undetermined.
pub const MIN_POINTS_PER_PANEL: usize = 6;
/// Fewest panels for a stride: a cyclic curve through fewer says nothing about contacts.
const MIN_STRIDE_PANELS: usize = 4;
/// Speeds that are believed of a horse, m/s: from a step in ten seconds to half as fast again as any was ever timed at.
pub(crate) const SPEEDS_M_S: [f64; 2] = [0.1, 30.0];
/// Durations that are believed of an interval or a stride, s; panels closer than the least have one and the same time.
const DURATIONS_S: [f64; 2] = [1e-4, 10.0];
/// Lengths that are believed of a spacing of marks or cameras, m.
const SPACINGS_M: [f64; 2] = [1e-3, 100.0];
/// Widest and highest image: four times the largest scan of a plate known to us.
const LARGEST_IMAGE_PX: u32 = 60_000;
/// Highest number of a panel, and most images: twenty times the most of any plate known to us.
const MOST_PANELS: u32 = 1000;
/// Most instants, and most marks of a panel: as many as no person places.
const MOST_ENTRIES: usize = 10_000;
/// Longest of the texts a person writes, bytes.
const LONGEST_TEXT: usize = 10_000;
/// Faults that are told; where there are more, the file is not what it should be as a whole.
const MOST_FAULTS: usize = 100;
/// Largest standard deviation of a place, px.
const LARGEST_SD_PX: f64 = 1000.0;
/// No point of a plate lies farther from its corner than this, px.
const FARTHEST_PX: f64 = 1e6;
/// A point may lie this far outside its panel, px: hooves and noses touch the mount.
pub const PANEL_MARGIN_PX: f64 = 12.0;

/// One thing that is wrong in a document.
#[derive(Clone, Debug, PartialEq)]
pub struct Fault {
    /// The file.
    pub path: PathBuf,
    /// The panel, where it concerns one.
    pub panel: Option<u32>,
    /// The field.
    pub field: String,
    /// What is wrong and what to do.
    pub message: String,
}

impl std::fmt::Display for Fault {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}: ", self.path.display())?;
        if let Some(panel) = self.panel {
            write!(f, "panel {panel}: ")?;
        }
        write!(f, "{}: {}", self.field, self.message)
    }
}

/// Why a plate cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum PlateError {
    /// A file cannot be read.
    #[error(transparent)]
    File(#[from] FileError),
    /// The documents are readable, but wrong.
    #[error("{}", listed(.0))]
    Faults(Vec<Fault>),
}

/// The first faults in words, a line each.
fn listed(faults: &[Fault]) -> String {
    let mut lines: Vec<String> = faults.iter().take(MOST_FAULTS).map(ToString::to_string).collect();
    if faults.len() > MOST_FAULTS {
        lines.push(format!("and {} more", faults.len() - MOST_FAULTS));
    }
    lines.join("\n")
}

/// Whether an image file was there to be compared with its hash.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ImageCheck {
    /// Every image is there and its hash agrees.
    Verified,
    /// At least one image is not on this machine; points can be fitted without it.
    Absent,
}

/// A plate's manifest and annotation, validated.
#[derive(Clone, Debug, PartialEq)]
pub struct Plate {
    /// The annotation file.
    pub annotation_path: PathBuf,
    /// SHA-256 of the annotation file.
    pub annotation_sha256: Hash,
    /// The manifest file.
    pub manifest_path: PathBuf,
    /// What is known of the plate.
    pub manifest: Manifest,
    /// Which way the animal faces, as the manifest says.
    pub facing: Facing,
    /// How scale, position and time are known, as the manifest says.
    pub calibration: Calibration,
    /// What was marked on it.
    pub annotation: Annotation,
    /// Whether the images were there.
    pub images: ImageCheck,
}

impl Plate {
    /// Reads an annotation and the manifest it names, and validates both.
    ///
    /// # Errors
    /// When a file cannot be read or parsed, or with every fault found, in document order.
    pub fn load(annotation_path: &Path) -> Result<Self, PlateError> {
        let annotation: Annotation = read_json(annotation_path, ANNOTATION_SCHEMA)?;
        let relative = Path::new(&annotation.plate);
        if relative.is_absolute() || annotation.plate.contains('\\') {
            return Err(PlateError::Faults(vec![Fault {
                path: annotation_path.to_path_buf(),
                panel: None,
                field: "plate".into(),
                message: "must be a path relative to this file, with forward slashes".into(),
            }]));
        }
        let manifest_path = annotation_path.parent().unwrap_or(Path::new(".")).join(relative);
        let manifest: Manifest = read_json(&manifest_path, MANIFEST_SCHEMA)
            .map_err(|error| unreadable_manifest(annotation_path, error))?;
        let mut faults = Faults { path: manifest_path.clone(), found: Vec::new() };
        let images = faults.images(&manifest, &manifest_path);
        let plate = Self::checked((&manifest_path, manifest), (annotation_path, annotation), faults.found)?;
        Ok(Self { annotation_sha256: hash_file(annotation_path)?, images, ..plate })
    }

    /// Validates documents that are being worked on, whatever the files hold; images are not looked at.
    ///
    /// # Errors
    /// With every fault found, in document order.
    pub fn from_documents(
        manifest: (&Path, Manifest),
        annotation: (&Path, Annotation),
    ) -> Result<Self, PlateError> {
        Self::checked(manifest, annotation, Vec::new())
    }

    fn checked(
        (manifest_path, manifest): (&Path, Manifest),
        (annotation_path, annotation): (&Path, Annotation),
        found: Vec<Fault>,
    ) -> Result<Self, PlateError> {
        let mut faults = Faults { path: manifest_path.to_path_buf(), found };
        faults.identifier(&manifest);
        faults.manifest(&manifest);
        faults.complete(&manifest);
        faults.path = annotation_path.to_path_buf();
        faults.annotation(&annotation, &manifest);
        faults.annotation_is_complete(&annotation, &manifest);
        let known = manifest.facing.zip(manifest.calibration.clone());
        let Some((facing, calibration)) = known.filter(|_| faults.found.is_empty()) else {
            return Err(PlateError::Faults(faults.found));
        };
        Ok(Self {
            facing,
            calibration,
            annotation_sha256: hash_bytes(to_stable_json(&annotation).as_bytes()),
            annotation_path: annotation_path.to_path_buf(),
            manifest_path: manifest_path.to_path_buf(),
            manifest,
            annotation,
            images: ImageCheck::Absent,
        })
    }

    /// Path of an image file on this machine (it may be absent).
    pub fn image_path(&self, index: usize) -> PathBuf {
        locate_image(&self.manifest_path, &self.manifest.images[index].file)
    }
}

impl Manifest {
    /// Reads a manifest and validates what it says; facing and calibration may be missing.
    ///
    /// # Errors
    /// When the file cannot be read or parsed, or with every fault found, in document order.
    pub fn read(path: &Path) -> Result<Self, PlateError> {
        let manifest: Self = read_json(path, MANIFEST_SCHEMA)?;
        check_manifest(path, &manifest)?;
        Ok(manifest)
    }
}

/// What must hold of a manifest, finished or not.
///
/// # Errors
/// With every fault found.
pub(crate) fn check_manifest(path: &Path, manifest: &Manifest) -> Result<(), PlateError> {
    let mut faults = Faults { path: path.to_path_buf(), found: Vec::new() };
    faults.identifier(manifest);
    faults.manifest(manifest);
    if faults.found.is_empty() { Ok(()) } else { Err(PlateError::Faults(faults.found)) }
}

/// What must hold of an annotation, finished or not, for a program to show and change it.
///
/// # Errors
/// With every fault found.
pub(crate) fn check_draft(
    annotation_path: &Path,
    annotation: &Annotation,
    manifest: &Manifest,
) -> Result<(), PlateError> {
    let mut faults = Faults { path: annotation_path.to_path_buf(), found: Vec::new() };
    faults.annotation(annotation, manifest);
    if faults.found.is_empty() { Ok(()) } else { Err(PlateError::Faults(faults.found)) }
}

/// A manifest that is not there is more likely a wrong name in the annotation.
fn unreadable_manifest(annotation_path: &Path, error: FileError) -> PlateError {
    let FileError::Read { path, source } = error else { return error.into() };
    let message = format!(
        "the manifest {} cannot be read ({source}); correct the path or restore the file",
        path.display()
    );
    let path = annotation_path.to_path_buf();
    PlateError::Faults(vec![Fault { path, panel: None, field: "plate".into(), message }])
}

struct Faults {
    path: PathBuf,
    found: Vec<Fault>,
}

impl Faults {
    fn add(&mut self, panel: Option<u32>, field: impl Into<String>, message: impl Into<String>) {
        let (path, field, message) = (self.path.clone(), field.into(), message.into());
        self.found.push(Fault { path, panel, field, message });
    }

    fn check(&mut self, good: bool, panel: Option<u32>, field: &str, message: &str) {
        if !good {
            self.add(panel, field, message);
        }
    }

    /// A known value within a range, with a standard deviation that is not negative.
    fn known(&mut self, field: &str, known: Option<&Known>, [low, high]: [f64; 2]) {
        let Some(known) = known else { return };
        if !(known.value > low && known.value <= high) {
            self.add(
                None,
                format!("{field}.value"),
                format!("{} is out of range; expected more than {low} and at most {high}", known.value),
            );
        }
        if !(known.sd >= 0.0 && known.sd <= high) {
            self.add(
                None,
                format!("{field}.sd"),
                format!("{} must not be negative and at most {high}", known.sd),
            );
        }
    }

    fn texts<'a>(&mut self, field: &str, mut texts: impl Iterator<Item = &'a String>) {
        let good = texts.all(|text| text.len() <= LONGEST_TEXT);
        self.check(good, None, field, "must be at most 10000 bytes long");
    }

    /// The identifier names output files and strides, so it must be a plain name, and one manifest's alone.
    fn identifier(&mut self, manifest: &Manifest) {
        let stem = self.path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
        if manifest.id != stem {
            let message =
                format!("is {:?}, but must be the file's name without its extension, {stem:?}", manifest.id);
            self.add(None, "id", message);
        }
    }

    fn manifest(&mut self, manifest: &Manifest) {
        self.check(!manifest.images.is_empty(), None, "images", "a plate needs at least one image");
        let Manifest { title, animal, date, source, holder, licence, printed, .. } = manifest;
        let texts = [title, animal, date, source, holder, licence];
        self.texts("printed and all other texts", texts.into_iter().chain(printed));
        let message = format!("must be at most {MOST_PANELS}");
        if manifest.panels.iter().any(|panel| panel.panel > MOST_PANELS) {
            return self.add(None, "panels", format!("panel numbers {message}"));
        }
        if manifest.images.len() > MOST_PANELS as usize {
            return self.add(None, "images", message);
        }
        for (i, image) in manifest.images.iter().enumerate() {
            let field = format!("images[{i}]");
            self.check(
                is_sha256(&image.sha256),
                None,
                &format!("{field}.sha256"),
                "must be 64 lower-case hexadecimal digits",
            );
            self.check(
                [image.width_px, image.height_px].iter().all(|px| (1..=LARGEST_IMAGE_PX).contains(px)),
                None,
                &field,
                "width and height must be between 1 and 60000 px",
            );
            self.check(
                !Path::new(&image.file).is_absolute(),
                None,
                &format!("{field}.file"),
                "must be a relative path",
            );
        }
        let mut last = 0;
        for panel in &manifest.panels {
            self.check(
                panel.panel > last,
                Some(panel.panel),
                "panel",
                "panel numbers must rise from 1 without repeats",
            );
            last = panel.panel;
            let Some(image) = manifest.images.get(panel.image) else {
                self.add(Some(panel.panel), "image", "there is no image of this index");
                continue;
            };
            let [width, height] = [f64::from(image.width_px), f64::from(image.height_px)];
            let inside = panel
                .quad_px
                .iter()
                .all(|[x, y]| (-1.0..=width + 1.0).contains(x) && (-1.0..=height + 1.0).contains(y));
            self.check(inside, Some(panel.panel), "quad_px", "a corner lies outside the image");
            let [[left, top], _, [right, bottom], _] = panel.quad_px;
            self.check(
                quad_area(&panel.quad_px) > 100.0 && left < right && top < bottom,
                Some(panel.panel),
                "quad_px",
                "corners must run clockwise from the top left",
            );
        }
        if let Some(calibration) = &manifest.calibration {
            self.calibration(calibration);
        }
    }

    /// What a plate may lack until somebody works with it.
    fn complete(&mut self, manifest: &Manifest) {
        let known = manifest.calibration.is_some();
        self.check(known, None, "calibration", "not known yet; say how scale, position and time are known");
        self.check(manifest.facing.is_some(), None, "facing", "not known yet; say \"left\" or \"right\"");
    }

    fn calibration(&mut self, calibration: &Calibration) {
        let scale = &calibration.scale;
        let length = scale.known_length.as_ref();
        self.known("calibration.scale.withers_height_m", scale.withers_height_m.as_ref(), [0.3, 3.0]);
        self.known(
            "calibration.scale.known_length.mark_spacing_m",
            length.map(|l| &l.mark_spacing_m),
            SPACINGS_M,
        );
        match length.map(|l| &l.plane) {
            Some(Plane::Wall(Parallax::Ratio(known))) => {
                self.known("calibration.scale.known_length.plane.wall.ratio", Some(known), [1.0, 10.0]);
            }
            Some(Plane::Wall(Parallax::Distances { camera_to_track_m, camera_to_wall_m })) => {
                let good = *camera_to_track_m > 0.0
                    && camera_to_wall_m >= camera_to_track_m
                    && *camera_to_wall_m <= 1000.0;
                self.check(
                    good,
                    None,
                    "calibration.scale.known_length.plane.wall.distances",
                    "the wall must be farther than the track, both positive, in metres",
                );
            }
            _ => {}
        }
        let from_stance = matches!(length.map(|l| &l.plane), Some(Plane::Wall(Parallax::FromStance)));
        let battery = matches!(calibration.position, Position::CameraSpacing { .. });
        self.check(
            battery || !from_stance,
            None,
            "calibration.scale.known_length.plane.wall",
            "from_stance needs position.kind camera_spacing; give distances or a ratio",
        );
        let given = match scale.driven_by {
            ScaleSource::KnownLength => scale.known_length.is_some(),
            ScaleSource::WithersHeight => scale.withers_height_m.is_some(),
        };
        self.check(given, None, "calibration.scale.driven_by", "names a source that is not given");
        if let Position::CameraSpacing { spacing_m, first_axis_mark } = &calibration.position {
            self.known("calibration.position.spacing_m", Some(spacing_m), SPACINGS_M);
            self.check(
                first_axis_mark.abs() < 1e4,
                None,
                "calibration.position.first_axis_mark",
                "must be a mark number",
            );
        }
        if let Position::EvenAdvance { per_panel_m } = &calibration.position {
            self.known("calibration.position.per_panel_m", per_panel_m.as_ref(), SPACINGS_M);
        }
        self.time(calibration);
        self.known("calibration.camera.distance_m", Some(&calibration.camera.distance_m), [1.0, 1000.0]);
        self.known("calibration.camera.height_m", Some(&calibration.camera.height_m), [-1.0, 50.0]);
    }

    fn time(&mut self, calibration: &Calibration) {
        let time = &calibration.time;
        self.known("calibration.time.interval_s", time.interval_s.as_ref(), DURATIONS_S);
        self.known("calibration.time.speed_m_s", time.speed_m_s.as_ref(), SPEEDS_M_S);
        self.known("calibration.time.stride_time_s", time.stride_time_s.as_ref(), DURATIONS_S);
        for (i, interval) in time.intervals_s.iter().flatten().enumerate() {
            let good = *interval > DURATIONS_S[0] && *interval <= DURATIONS_S[1];
            self.check(
                good,
                None,
                &format!("calibration.time.intervals_s[{i}]"),
                "must be more than 0.0001 and at most 10 s: two panels cannot have the same time",
            );
        }
        let given = match time.driven_by {
            TimeSource::Interval => time.interval_s.is_some(),
            TimeSource::Speed => time.speed_m_s.is_some(),
            TimeSource::StrideTime => time.stride_time_s.is_some(),
            TimeSource::DynamicSimilarity => true,
        };
        self.check(given, None, "calibration.time.driven_by", "names a source that is not given");
    }

    fn images(&mut self, manifest: &Manifest, manifest_path: &Path) -> ImageCheck {
        let mut check = ImageCheck::Verified;
        for (i, image) in manifest.images.iter().enumerate() {
            match hash_file(&locate_image(manifest_path, &image.file)) {
                Err(_) => check = ImageCheck::Absent,
                Ok(hash) if hash == image.sha256 => {}
                Ok(hash) => self.add(
                    None,
                    format!("images[{i}].sha256"),
                    format!("{} has hash {hash}: it is another image than the one annotated; get the right file or move this one away", image.file),
                ),
            }
        }
        check
    }

    /// What makes an annotation unusable.
    fn annotation(&mut self, annotation: &Annotation, manifest: &Manifest) {
        let hashes: Vec<&String> = manifest.images.iter().map(|image| &image.sha256).collect();
        let same = annotation.images_sha256.iter().eq(hashes);
        self.check(
            same,
            None,
            "images_sha256",
            "differs from the manifest's: the points were placed on other images",
        );
        for (field, sd) in
            [("visible_sd_px", annotation.visible_sd_px), ("occluded_sd_px", annotation.occluded_sd_px)]
        {
            self.check(
                sd > 0.0 && sd <= LARGEST_SD_PX,
                None,
                field,
                "must be more than 0 and at most 1000 px",
            );
        }
        self.texts("annotator and notes", annotation.notes.iter().chain([&annotation.annotator]));
        let most = annotation.panels.iter().map(|panel| panel.marks.len()).max().unwrap_or(0);
        if most.max(annotation.instants.len()) > MOST_ENTRIES {
            return self.add(None, "marks and instants", format!("must be at most {MOST_ENTRIES}"));
        }
        let span = annotation.stride;
        let numbers = annotation.panels.iter().map(|panel| panel.panel).chain([span.first, span.last]);
        if numbers.max() > Some(MOST_PANELS) {
            return self.add(None, "panels", format!("panel numbers must be at most {MOST_PANELS}"));
        }
        for (i, instant) in annotation.instants.iter().enumerate() {
            let good = (0.0..=f64::from(MOST_PANELS) + 1.0).contains(&instant.at_panel);
            self.check(good, None, &format!("instants[{i}].at_panel"), "must be a place among the panels");
        }
        let mut last = 0;
        for panel in &annotation.panels {
            self.check(
                panel.panel > last,
                Some(panel.panel),
                "panel",
                "panel numbers must rise without repeats",
            );
            last = panel.panel;
            self.places(panel);
        }
        if let Some(closes) = annotation.stride.closes_after_panels {
            self.check(
                (2.0..=1000.0).contains(&closes),
                None,
                "stride.closes_after_panels",
                "must be between 2 and 1000 panels",
            );
        }
    }

    /// Numbers no plate can have.
    fn places(&mut self, panel: &PanelAnnotation) {
        let number = Some(panel.panel);
        let good = |place: &[f64; 2]| place.iter().all(|v| v.abs() < FARTHEST_PX);
        let ground = panel.ground_px.iter().flatten().all(good);
        self.check(ground, number, "ground_px", "must be two points of the plate");
        for (i, mark) in panel.marks.iter().enumerate() {
            let good = good(&mark.at_px) && mark.mark.abs() < 1e4;
            let message = "must be a mark number and a point of the plate";
            self.check(good, number, &format!("marks[{i}]"), message);
        }
        for (keypoint, placed) in panel.keypoints.iter() {
            let field = format!("keypoints.{keypoint}");
            self.check(placed.at_px.iter().all(good), number, &field, "must be a point of the plate");
            let sd = placed.sd_px.is_none_or(|sd| sd > 0.0 && sd <= LARGEST_SD_PX);
            self.check(sd, number, &format!("{field}.sd_px"), "must be more than 0 and at most 1000 px");
        }
    }

    /// What an annotation may lack until it is to be fitted.
    fn annotation_is_complete(&mut self, annotation: &Annotation, manifest: &Manifest) {
        let span = annotation.stride;
        self.check(span.first < span.last, None, "stride", "first must come before last");
        for (end, panel) in [("first", span.first), ("last", span.last)] {
            let known = manifest.panels.iter().any(|p| p.panel == panel);
            self.check(
                known,
                Some(panel),
                &format!("stride.{end}"),
                "the manifest has no panel of this number",
            );
        }
        for panel in &annotation.panels {
            self.panel(panel, manifest);
        }
        let used = annotation
            .panels
            .iter()
            .filter(|p| p.usage == PanelUse::Stride && (span.first..=span.last).contains(&p.panel));
        let n = used.count();
        if n < MIN_STRIDE_PANELS {
            self.add(
                None,
                "stride",
                format!("{n} panels are marked for the stride; a fit needs at least {MIN_STRIDE_PANELS}"),
            );
        }
        for (i, instant) in annotation.instants.iter().enumerate() {
            let inside = (f64::from(span.first)..=f64::from(span.last)).contains(&instant.at_panel);
            self.check(inside, None, &format!("instants[{i}].at_panel"), "lies outside the stride");
        }
        let time = manifest.calibration.as_ref().map(|calibration| &calibration.time);
        if let Some(intervals) = time.and_then(|time| time.intervals_s.as_ref()) {
            let expected = span.last.saturating_sub(span.first) as usize;
            self.check(
                intervals.len() == expected,
                None,
                "stride",
                "the manifest's intervals_s must have one entry per gap between the stride's panels",
            );
        }
    }

    fn panel(&mut self, panel: &PanelAnnotation, manifest: &Manifest) {
        let number = Some(panel.panel);
        let Some(place) = manifest.panels.iter().find(|p| p.panel == panel.panel) else {
            return self.add(number, "panel", "the manifest has no panel of this number");
        };
        match panel.ground_px {
            Some([a, b]) => {
                let message = "needs two points at least 10 px apart, the left one first";
                self.check(b[0] - a[0] > 10.0, number, "ground_px", message);
            }
            None => self.check(
                panel.usage == PanelUse::Unused,
                number,
                "ground_px",
                "not drawn yet; draw the ground line under the near hooves",
            ),
        }
        for (i, mark) in panel.marks.iter().enumerate() {
            let repeated = panel.marks[..i].iter().any(|other| other.mark == mark.mark);
            self.check(!repeated, number, &format!("marks[{i}].mark"), "this mark is placed twice");
        }
        self.keypoints(panel, place);
    }

    fn keypoints(&mut self, panel: &PanelAnnotation, place: &crate::manifest::Panel) {
        let number = Some(panel.panel);
        let mut n = 0;
        for (keypoint, placed) in panel.keypoints.iter() {
            let field = format!("keypoints.{keypoint}");
            match (placed.state, placed.at_px) {
                (KeypointState::Absent, None) => {}
                (KeypointState::Absent, Some(_)) => {
                    self.add(number, field, "is absent but has a place; remove one of the two");
                }
                (_, None) => self.add(number, field, "has no place (`at_px`); place it or call it absent"),
                (_, Some(at)) if !place.contains(at, PANEL_MARGIN_PX) => {
                    self.add(
                        number,
                        field,
                        format!("{at:?} lies outside the panel; move it or correct the panel's corners"),
                    );
                }
                (_, Some(_)) => n += 1,
            }
        }
        if panel.usage == PanelUse::Stride && n < MIN_POINTS_PER_PANEL {
            self.add(number, "keypoints", format!("only {n} points are placed; place at least {MIN_POINTS_PER_PANEL} or mark the panel as unused"));
        }
    }
}

fn is_sha256(text: &str) -> bool {
    text.len() == 64 && text.bytes().all(|b| b.is_ascii_digit() || (b'a'..=b'f').contains(&b))
}

/// Signed area of a quadrilateral, positive when its corners run clockwise on the screen.
fn quad_area(quad: &[[f64; 2]; 4]) -> f64 {
    (0..4).map(|i| (quad[i], quad[(i + 1) % 4])).map(|(a, b)| a[0] * b[1] - b[0] * a[1]).sum::<f64>() / 2.0
}
