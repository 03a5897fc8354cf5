//! The documents of the capture side: plate manifests, annotations, calibration, and their files.
//!
//! No pixels here: everything works on numbers a person or a program read off a photograph.
//! Coordinates are *plate pixels* (`point_in_plate_px`: origin at the top left of the image file, x right, y down),
//! so that labels survive a new split of the plate into panels.
//! A person sees near and off limbs; files say so, and [`Facing`] turns them into the horse's left and right.

mod annotation;
mod calibration;
mod catalogue;
mod document;
mod even_advance;
pub mod exchange;
mod files;
mod images;
mod keypoint;
mod line;
mod manifest;
mod parallax;
mod scales;
mod similarity;
mod timing;
mod validation;

pub use annotation::{
    ANNOTATION_SCHEMA, Annotation, Event, Instant, KeypointState, Keypoints, LegContacts, Mark,
    PanelAnnotation, PanelUse, Placed, PlacedBy, StanceLabel, StrideSpan,
};
pub use calibration::{CalibrationError, Disagreement, Estimate, PanelCamera, PlateCalibration, calibrate};
pub use catalogue::{CATALOGUE_SCHEMA, Catalogue, CataloguePlate};
pub use document::{
    Document, DocumentError, Draft, JournalError, STATE_VARIABLE, SaveError, Waiting, annotation_beside,
    discard, relative_path, state_folder, waiting,
};
pub use files::{
    FileError, Hash, hash_file, read_json, read_text, to_stable_json, write_atomically, write_json,
};
pub use images::{CACHE_VARIABLE, cache_folder, locate_image};
pub use keypoint::{BodyPoint, KEYPOINT_COUNT, Keypoint, LimbJoint, NearOff};
pub use manifest::{
    Calibration, Camera, Facing, Known, KnownLength, MANIFEST_SCHEMA, Manifest, Panel, Parallax, Plane,
    PlateImage, Position, Scale, ScaleSource, Time, TimeSource,
};
pub use similarity::{LEG_SHARE, SimilarityLaw};
pub use timing::CLOSING_SD_PANELS;
pub use validation::{Fault, ImageCheck, MIN_POINTS_PER_PANEL, PANEL_MARGIN_PX, Plate, PlateError};
