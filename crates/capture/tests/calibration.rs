//! Calibration against plates whose cameras are known: every source of scale, position and time.

#![allow(clippy::unwrap_used, reason = "a test's helpers stop at what must not happen, as its tests do")]

use muybridge_capture::{
    Annotation, BodyPoint, Calibration, Camera, Estimate, Facing, Keypoint, KeypointState, Keypoints, Known,
    KnownLength, LEG_SHARE, LegContacts, Manifest, Mark, NearOff, Panel, PanelAnnotation, PanelUse, Parallax,
    Placed, PlacedBy, Plane, PlateImage, Position, Scale, ScaleSource, SimilarityLaw, StanceLabel,
    StrideSpan, Time, TimeSource, calibrate,
};
use muybridge_core::{Gait, Pair, SpeedSource};

const PANELS: u32 = 6;
const SPACING_M: f64 = 0.7;
const TRACK_PX_PER_M: f64 = 120.0;
const RATIO: f64 = 1.2;
const GROUND_Y: f64 = 400.0;
const WIDTH: f64 = 800.0;
/// The trunk advances by this per panel, m.
const ADVANCE_M: [f64; 5] = [0.8, 0.6, 0.7, 0.75, 0.65];

fn known(value: f64, sd: f64) -> Known {
    Known { value, sd, assumed: false, from: "test".into() }
}

/// A plate of `PANELS` pictures 800 px wide, all standing side by side, axis in the middle of each.
struct Truth {
    facing: Facing,
}

impl Truth {
    fn sign(&self) -> f64 {
        self.facing.sign()
    }

    fn axis_px(panel: u32) -> f64 {
        WIDTH * (f64::from(panel) - 0.5)
    }

    fn camera_x_m(panel: u32) -> f64 {
        SPACING_M * f64::from(panel - 1)
    }

    /// A point in the near plane.
    fn near_px(&self, panel: u32, x_m: f64, y_m: f64) -> [f64; 2] {
        let ahead = (x_m - Self::camera_x_m(panel)) * TRACK_PX_PER_M;
        [Self::axis_px(panel) + self.sign() * ahead, GROUND_Y - y_m * TRACK_PX_PER_M]
    }

    /// A mark on the wall; numbers grow to the right whichever way the animal faces.
    fn mark_px(&self, panel: u32, mark: f64) -> [f64; 2] {
        let wall = TRACK_PX_PER_M / RATIO;
        // Mark 10 is opposite the first camera, and cameras follow the animal.
        let right_m = (mark - 10.0) * SPACING_M - self.sign() * Self::camera_x_m(panel);
        [Self::axis_px(panel) + right_m * wall, 330.0]
    }

    fn trunk_m(panel: u32) -> f64 {
        ADVANCE_M[..panel as usize - 1].iter().sum()
    }

    fn panel(&self, panel: u32) -> PanelAnnotation {
        let mut keypoints = Keypoints::default();
        let mut place = |keypoint, x_m: f64, y_m: f64| {
            let at_px = Some(self.near_px(panel, x_m, y_m));
            keypoints.insert(
                keypoint,
                Placed { at_px, state: KeypointState::Visible, by: PlacedBy::Hand, sd_px: None },
            );
        };
        let trunk_m = Self::trunk_m(panel);
        place(Keypoint::Body(BodyPoint::Withers), trunk_m + 0.4, 1.6);
        place(Keypoint::Body(BodyPoint::Croup), trunk_m - 0.4, 1.58);
        if panel != 3 {
            place(Keypoint::Body(BodyPoint::Dock), trunk_m - 0.8, 1.4);
        }
        place(Keypoint::hoof(NearOff::Near, Pair::Fore), 1.9, 0.0);
        let near_fore = if (2..=4).contains(&panel) { StanceLabel::Stance } else { StanceLabel::Swing };
        let (off_fore, near_hind, off_hind) = (StanceLabel::Swing, StanceLabel::Swing, StanceLabel::Swing);
        let left = Self::axis_px(panel) - 300.0;
        let nearest = (10.0 + self.sign() * f64::from(panel - 1)).round();
        PanelAnnotation {
            panel,
            usage: if panel == PANELS { PanelUse::Standing } else { PanelUse::Stride },
            ground_px: Some([[left, GROUND_Y], [left + 600.0, GROUND_Y]]),
            marks: [-2.0, 0.0, 1.0, 2.0]
                .map(|d| Mark { mark: nearest + d, at_px: self.mark_px(panel, nearest + d) })
                .to_vec(),
            contacts: LegContacts { near_fore, off_fore, near_hind, off_hind },
            keypoints,
        }
    }

    fn annotation(&self) -> Annotation {
        Annotation {
            schema: 1,
            plate: "plate.json".into(),
            images_sha256: vec!["0".repeat(64)],
            annotator: "test".into(),
            visible_sd_px: 1.0,
            occluded_sd_px: 3.0,
            gait: None,
            stride: StrideSpan { first: 1, last: PANELS - 1, closes_after_panels: Some(4.0) },
            notes: Vec::new(),
            panels: (1..=PANELS).map(|panel| self.panel(panel)).collect(),
            instants: Vec::new(),
        }
    }

    fn manifest(&self) -> Manifest {
        let quad = |panel: u32| {
            let (left, right) = (WIDTH * f64::from(panel - 1), WIDTH * f64::from(panel));
            [[left, 0.0], [right, 0.0], [right, 450.0], [left, 450.0]]
        };
        Manifest {
            schema: 1,
            id: "plate".into(),
            catalogue_number: None,
            title: String::new(),
            animal: String::new(),
            gait: Gait::Gallop,
            date: String::new(),
            source: String::new(),
            holder: String::new(),
            licence: String::new(),
            printed: Vec::new(),
            facing: Some(self.facing),
            images: vec![PlateImage {
                file: "x.png".into(),
                sha256: "0".repeat(64),
                width_px: 4800,
                height_px: 450,
            }],
            panels: (1..=PANELS).map(|panel| Panel { panel, image: 0, quad_px: quad(panel) }).collect(),
            calibration: Some(Calibration {
                scale: Scale {
                    driven_by: ScaleSource::KnownLength,
                    known_length: Some(KnownLength {
                        mark_spacing_m: known(SPACING_M, 0.007),
                        plane: Plane::Wall(Parallax::FromStance),
                    }),
                    withers_height_m: Some(known(1.6, 0.05)),
                },
                position: Position::CameraSpacing {
                    spacing_m: known(SPACING_M, 0.007),
                    first_axis_mark: 10.0,
                },
                time: Time {
                    driven_by: TimeSource::Speed,
                    interval_s: Some(known(0.05, 0.005)),
                    intervals_s: None,
                    speed_m_s: Some(known(14.0, 0.28)),
                    stride_time_s: Some(known(0.44, 0.01)),
                },
                camera: Camera { distance_m: known(12.0, 2.0), height_m: known(1.2, 0.2) },
            }),
        }
    }
}

/// Every camera maps the truth's points where they are, whichever way the animal faces.
fn assert_cameras(truth: &Truth, manifest: &Manifest, tolerance_m: f64) {
    let found = calibrate(manifest, &truth.annotation()).unwrap();
    let offset = found.stride[0].world_from_plate(truth.near_px(1, 0.0, 0.0), 0.0)[0];
    for camera in &found.stride {
        for (x_m, y_m) in [(Truth::camera_x_m(camera.panel) + 0.7, 0.3), (1.9, 1.2)] {
            let [x, y, _] = camera.world_from_plate(truth.near_px(camera.panel, x_m, y_m), 0.0);
            assert!((x - offset - x_m).abs() < tolerance_m, "panel {}: {x} for {x_m}", camera.panel);
            assert!((y - y_m).abs() < tolerance_m, "panel {}: {y} for {y_m}", camera.panel);
        }
    }
}

#[test]
fn parallax_is_measured_from_a_standing_hoof_in_either_direction() {
    for facing in [Facing::Right, Facing::Left] {
        let truth = Truth { facing };
        let manifest = truth.manifest();
        let found = calibrate(&manifest, &truth.annotation()).unwrap();
        assert!((found.parallax.unwrap().value - RATIO).abs() < 1e-9, "{facing:?}: {:?}", found.parallax);
        assert_cameras(&truth, &manifest, 1e-9);
        assert!((found.withers_height_m.unwrap().value - 1.6).abs() < 1e-9);
    }
}

#[test]
fn distances_a_ratio_marks_on_the_track_and_the_withers_give_the_same_scale() {
    let truth = Truth { facing: Facing::Right };
    let mut manifest = truth.manifest();
    let length = |plane| Some(KnownLength { mark_spacing_m: known(SPACING_M, 0.007), plane });
    manifest.calibration.as_mut().unwrap().scale.known_length =
        length(Plane::Wall(Parallax::Distances { camera_to_track_m: 10.0, camera_to_wall_m: 12.0 }));
    assert_cameras(&truth, &manifest, 1e-9);
    manifest.calibration.as_mut().unwrap().scale.known_length =
        length(Plane::Wall(Parallax::Ratio(known(RATIO, 0.02))));
    assert_cameras(&truth, &manifest, 1e-9);
    manifest.calibration.as_mut().unwrap().scale.driven_by = ScaleSource::WithersHeight;
    assert_cameras(&truth, &manifest, 1e-9);
    // Without the parallax correction the animal comes out a fifth too big, and the two scales disagree by that.
    manifest.calibration.as_mut().unwrap().scale.driven_by = ScaleSource::KnownLength;
    manifest.calibration.as_mut().unwrap().scale.known_length = length(Plane::Track);
    let found = calibrate(&manifest, &truth.annotation()).unwrap();
    assert!((found.withers_height_m.unwrap().value / 1.6 - RATIO).abs() < 1e-9);
    let scale = found.disagreements.iter().find(|d| d.quantity.starts_with("scale")).unwrap();
    assert!((scale.percent() - 100.0 * (RATIO - 1.0)).abs() < 1e-6, "{scale:?}");
}

#[test]
fn a_fixed_mark_in_the_track_places_every_panel() {
    let truth = Truth { facing: Facing::Left };
    let mut manifest = truth.manifest();
    manifest.calibration.as_mut().unwrap().scale.driven_by = ScaleSource::WithersHeight;
    manifest.calibration.as_mut().unwrap().scale.known_length = None;
    manifest.calibration.as_mut().unwrap().position = Position::FixedMark { mark: 1.0 };
    let mut annotation = truth.annotation();
    for panel in &mut annotation.panels {
        panel.marks = vec![Mark { mark: 1.0, at_px: truth.near_px(panel.panel, 1.5, 0.4) }];
    }
    let found = calibrate(&manifest, &annotation).unwrap();
    for camera in &found.stride {
        let [x, y, _] = camera.world_from_plate(truth.near_px(camera.panel, 2.0, 1.0), 0.0);
        assert!((x - 0.5).abs() < 1e-9 && (y - 1.0).abs() < 1e-9, "{x} {y}");
    }
    annotation.panels[2].marks.clear();
    let error = calibrate(&manifest, &annotation).unwrap_err().to_string();
    assert!(error.contains("panel 3") && error.contains("mark 1"), "{error}");
}

#[test]
fn one_fixed_camera_sees_the_animal_cross_the_picture() {
    let truth = Truth { facing: Facing::Right };
    let mut manifest = truth.manifest();
    manifest.calibration.as_mut().unwrap().position = Position::FixedCamera;
    manifest.calibration.as_mut().unwrap().time.driven_by = TimeSource::Interval;
    manifest.calibration.as_mut().unwrap().scale.driven_by = ScaleSource::WithersHeight;
    manifest.calibration.as_mut().unwrap().scale.known_length = None;
    let annotation = truth.annotation();
    let found = calibrate(&manifest, &annotation).unwrap();
    for camera in &found.stride {
        // The truth's cameras move with the battery; seen as one camera the place is relative to the picture.
        let [x, _, _] = camera.world_from_plate(truth.near_px(camera.panel, 2.0, 1.0), 0.0);
        assert!((x - (2.0 - Truth::camera_x_m(camera.panel))).abs() < 1e-9);
    }
}

#[test]
fn times_follow_the_distance_covered_an_interval_or_the_stride_time() {
    let truth = Truth { facing: Facing::Right };
    let mut manifest = truth.manifest();
    let annotation = truth.annotation();
    let times = |manifest: &Manifest| {
        let found = calibrate(manifest, &annotation).unwrap();
        let times: Vec<f64> = found.stride.iter().map(|camera| camera.time_s).collect();
        (times, found)
    };
    let (by_speed, found) = times(&manifest);
    for (i, time) in by_speed.iter().enumerate() {
        let expected = ADVANCE_M[..i].iter().sum::<f64>() / 14.0;
        assert!((time - expected).abs() < 1e-6, "panel {}: {time} for {expected}", i + 1);
    }
    assert_eq!(found.speed_source, SpeedSource::Stated);
    let interval = found.disagreements.iter().find(|d| d.quantity.starts_with("mean interval")).unwrap();
    assert!((interval.percent() - 100.0 * (0.05 / (2.85 / 4.0 / 14.0) - 1.0)).abs() < 1e-3, "{interval:?}");

    manifest.calibration.as_mut().unwrap().time.driven_by = TimeSource::Interval;
    let (by_interval, found) = times(&manifest);
    assert!(by_interval.iter().enumerate().all(|(i, t)| (t - 0.05 * i as f64).abs() < 1e-12));
    assert!((found.speed_m_s.value - 2.85 / 0.2).abs() < 1e-6);
    assert_eq!(found.speed_source, SpeedSource::Measured);
    assert!(found.disagreements.iter().any(|d| d.quantity.starts_with("speed")));

    manifest.calibration.as_mut().unwrap().time.intervals_s = Some(vec![0.04, 0.05, 0.06, 0.05]);
    let (uneven, _) = times(&manifest);
    assert!((uneven[4] - 0.20).abs() < 1e-12 && (uneven[2] - 0.09).abs() < 1e-12);

    manifest.calibration.as_mut().unwrap().time.driven_by = TimeSource::StrideTime;
    let (by_stride, _) = times(&manifest);
    assert!((by_stride[4] - 0.44).abs() < 1e-12 && (by_stride[1] - 0.11).abs() < 1e-12);
}

#[test]
fn pictures_cut_out_around_the_animal_advance_as_the_hooves_say_and_the_speed_is_inferred() {
    let truth = Truth { facing: Facing::Left };
    let mut manifest = truth.manifest();
    let calibration = manifest.calibration.as_mut().unwrap();
    calibration.position = Position::EvenAdvance { per_panel_m: None };
    calibration.time.driven_by = TimeSource::DynamicSimilarity;
    calibration.scale.driven_by = ScaleSource::WithersHeight;
    calibration.scale.known_length = None;
    let mut annotation = truth.annotation();
    // Each picture is cut out a little elsewhere.
    for (panel, shift_px) in annotation.panels.iter_mut().zip([3.0, -7.0, 11.0, 0.0, -5.0, 2.0]) {
        for (keypoint, placed) in panel.keypoints.clone().iter() {
            let at_px = placed.at_px.map(|[x, y]| [x + shift_px, y]);
            panel.keypoints.insert(keypoint, Placed { at_px, ..*placed });
        }
    }
    let found = calibrate(&manifest, &annotation).unwrap();
    // The hoof stands in panels 2 to 4, over which the trunk advances by 0.6 and 0.7 m.
    let per_panel_m = 0.65;
    let croup = Keypoint::Body(BodyPoint::Croup);
    let croup_m = |i: usize| {
        let place = annotation.panels[i].keypoints.place(croup).unwrap();
        found.stride[i].world_from_plate(place, 0.0)[0]
    };
    for i in 0..found.stride.len() {
        let gone = croup_m(i) - croup_m(0);
        assert!((gone - per_panel_m * i as f64).abs() < 1e-6, "panel {}: {gone}", i + 1);
    }
    let leg_m = LEG_SHARE * 1.6;
    let law = SimilarityLaw::of(Gait::Gallop).unwrap();
    let exact = |value| Estimate { value, sd: 0.0 };
    let expected = law.speed_m_s(exact(4.0 * per_panel_m / leg_m), exact(leg_m)).value;
    let speed = found.speed_m_s;
    assert_eq!(found.speed_source, SpeedSource::Inferred);
    assert!((speed.value / expected - 1.0).abs() < 1e-6, "{} for {expected}", speed.value);
    assert!(speed.sd > 0.08 * speed.value, "the law's own spread at least");
    let intervals: Vec<f64> = found.stride.windows(2).map(|two| two[1].time_s - two[0].time_s).collect();
    assert!(intervals.iter().all(|s| (s - per_panel_m / expected).abs() < 1e-6), "{intervals:?}");

    annotation.stride.closes_after_panels = None;
    let error = calibrate(&manifest, &annotation).unwrap_err().to_string();
    assert!(error.contains("closes_after_panels"), "{error}");
    annotation.panels.iter_mut().for_each(|panel| panel.contacts.near_fore = StanceLabel::Swing);
    let error = calibrate(&manifest, &annotation).unwrap_err().to_string();
    assert!(error.contains("advance"), "{error}");
}

#[test]
fn what_cannot_be_calibrated_says_why() {
    let truth = Truth { facing: Facing::Right };
    let mut annotation = truth.annotation();
    for panel in &mut annotation.panels {
        panel.contacts.near_fore = StanceLabel::Swing;
    }
    let error = calibrate(&truth.manifest(), &annotation).unwrap_err().to_string();
    assert!(error.contains("stance"), "{error}");
    let mut annotation = truth.annotation();
    annotation.panels[1].marks.truncate(1);
    let error = calibrate(&truth.manifest(), &annotation).unwrap_err().to_string();
    assert!(error.contains("panel 2") && error.contains("marks"), "{error}");
    // An animal that does not move has no times under a known speed.
    let mut manifest = truth.manifest();
    manifest.facing = Some(Facing::Left);
    assert!(calibrate(&manifest, &truth.annotation()).is_err());
}
