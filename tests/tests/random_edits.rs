//! Random damage to good documents: reading, calibrating and fitting never panic; what they refuse they refuse with a
//! file named, and what they accept gives finite numbers.

#![allow(clippy::unwrap_used, reason = "a test stops at the first thing it cannot do")]

mod random_edit;

use std::path::{Path, PathBuf};

use muybridge_capture::{Plate, calibrate};
use muybridge_core::{Database, Skeleton};
use muybridge_fitting::contacts::find_contacts;
use muybridge_fitting::fit_document::FitDocument;
use muybridge_fitting::gait_analysis::GaitAnalysis;
use muybridge_fitting::gait_laws::Evidence;
use muybridge_fitting::motion_database::build_database;
use muybridge_fitting::observation::StrideObservation;
use muybridge_fitting::pipeline::{PlateFit, fit_plate};
use muybridge_fitting::stride_fit::{PointResidual, StrideTime, fit_stride};
use muybridge_fitting::weights::Weights;
use muybridge_tests::{SALLIE, repository, write};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use random_edit::{Edit, edit};
use serde_json::Value;
use tempfile::TempDir;

/// Documents damaged, calibrated and fitted without the points left out in turn.
const CASES: u32 = 200;
/// Documents put through the whole pipeline, which fits each some fifty times.
const WHOLE_CASES: u32 = 16;

/// A runner that always draws the same edits; `PROPTEST_CASES` draws more of them.
fn runner(cases: u32) -> TestRunner {
    let cases = std::env::var("PROPTEST_CASES").ok().and_then(|text| text.parse().ok()).unwrap_or(cases);
    let config = Config { cases, failure_persistence: None, max_shrink_iters: 64, ..Config::default() };
    TestRunner::new_with_rng(config, TestRng::deterministic_rng(RngAlgorithm::ChaCha))
}

/// The repository's two documents after some edits, in a folder of their own.
struct Damaged {
    folder: TempDir,
    annotation: PathBuf,
}

impl Damaged {
    fn new(edits: &[Edit]) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let mut documents = ["annotations", "plates"].map(|kind| {
            let path = repository().join(kind).join(format!("{SALLIE}.json"));
            std::fs::read_to_string(path).unwrap()
        });
        edits.iter().for_each(|edit| edit.apply(&mut documents));
        for (kind, text) in ["annotations", "plates"].iter().zip(&documents) {
            std::fs::create_dir(folder.path().join(kind)).unwrap();
            write(&folder.path().join(kind).join(format!("{SALLIE}.json")), text);
        }
        let annotation = folder.path().join("annotations").join(format!("{SALLIE}.json"));
        Self { folder, annotation }
    }

    /// The annotation's or the manifest's path, by its folder.
    fn path(&self, kind: &str) -> PathBuf {
        self.folder.path().join(kind).join(format!("{SALLIE}.json"))
    }
}

/// The pipeline without its search for the stride time and without held-out points: one fit. None when it was refused,
/// with a file named.
fn fit_once(path: &Path) -> Result<Option<PlateFit>, TestCaseError> {
    let skeleton = Skeleton::reference();
    let plate = match Plate::load(path) {
        Ok(plate) => plate,
        Err(error) => return refused(&error.to_string()),
    };
    let Ok(calibration) = calibrate(&plate.manifest, &plate.annotation) else { return Ok(None) };
    let weights = Weights::default();
    let observation = StrideObservation::new(&plate, &calibration, &weights);
    let stride_time = StrideTime { seconds: 0.94 * observation.duration_s(), sd_s: 0.01 };
    let fit = fit_stride(&skeleton, &observation, stride_time, &weights);
    let withers_height_m = fit.withers_height_m(&skeleton);
    let Ok(contacts) = find_contacts(&fit, &plate.annotation.instants, withers_height_m) else {
        return Ok(None);
    };
    let analysis = GaitAnalysis::new(contacts, [stride_time.seconds, stride_time.sd_s]);
    let residuals = fit.residuals_of(&observation);
    let (held_out, warnings) = (Vec::new(), Vec::new());
    Ok(Some(PlateFit { plate, calibration, fit, analysis, withers_height_m, residuals, held_out, warnings }))
}

fn refused(message: &str) -> Result<Option<PlateFit>, TestCaseError> {
    prop_assert!(message.contains(&format!("{SALLIE}.json: ")), "no file in {message}");
    Ok(None)
}

/// Every number a user could meet.
fn require_finite(fitted: &PlateFit) -> Result<(), TestCaseError> {
    let calibration = &fitted.calibration;
    let estimates = [calibration.speed_m_s, calibration.interval_s];
    let mut numbers: Vec<f64> = estimates.iter().flat_map(|e| [e.value, e.sd]).collect();
    numbers.extend(calibration.disagreements.iter().flat_map(|d| [d.used.1.value, d.other.1.value]));
    numbers.extend(fitted.residuals.iter().chain(&fitted.held_out).map(PointResidual::metres));
    numbers.extend(fitted.analysis.contacts.iter().flat_map(|c| [c.duty_factor(), c.duty_factor_sd()]));
    numbers.extend(fitted.analysis.stride_time_s);
    numbers.extend(fitted.analysis.support_s());
    numbers.extend([fitted.withers_height_m, fitted.froude(), fitted.fit.optimum.cost]);
    numbers.extend(fitted.stride_length_m());
    prop_assert!(numbers.iter().all(|number| number.is_finite()), "{numbers:?}");

    let skeleton = Skeleton::reference();
    let database =
        build_database(&Evidence { fits: std::slice::from_ref(fitted), ..Evidence::default() }, &skeleton);
    for stride in &database.strides {
        let curves = stride.curves.channels().flatten().all(|value| value.is_finite());
        prop_assert!(curves && stride.prints_m.iter().all(|x| x.is_finite()), "stride {}", stride.id);
    }
    prop_assert!(database.laws.iter().all(|law| law.curve.a.is_finite() && law.curve.b.is_finite()));
    let text = muybridge_capture::to_stable_json(&database);
    prop_assert!(Database::from_json(&text).is_ok(), "the database cannot be read back");
    let fit = muybridge_capture::to_stable_json(&FitDocument::new(fitted, &skeleton));
    // Numbers that are not finite become null in JSON; errors are null as a whole where they cannot be told.
    let null = fit.lines().find(|line| line.contains("null") && !line.contains("error"));
    prop_assert!(null.is_none(), "{null:?} in the fit's file");
    Ok(())
}

#[test]
fn damaged_documents_are_refused_with_a_name_or_give_finite_numbers() {
    let fitted = std::cell::Cell::new(0);
    let edits = prop::collection::vec(edit(), 1..4);
    let result = runner(CASES).run(&edits, |edits| {
        let damaged = Damaged::new(&edits);
        if let Some(fit) = fit_once(&damaged.annotation)? {
            fitted.set(fitted.get() + 1);
            require_finite(&fit)?;
        }
        Ok(())
    });
    println!("{} damaged plates could still be fitted", fitted.get());
    result.unwrap_or_else(|failure| panic!("{failure}"));
    assert!(fitted.get() >= CASES / 10, "edits so rough that nothing is left to fit test little");
}

/// Numbers of a document that are not lists', as JSON pointers.
fn numbers(document: &Value, at: &str, found: &mut Vec<String>) {
    match document {
        Value::Number(_) => found.push(at.to_string()),
        Value::Object(fields) => {
            fields.iter().for_each(|(key, value)| numbers(value, &format!("{at}/{key}"), found));
        }
        _ => {}
    }
}

#[test]
fn absurd_numbers_of_calibration_and_head_are_refused_or_borne() {
    let good = Damaged::new(&[]);
    for (kind, driven_by) in [("plates", "interval"), ("plates", "speed"), ("annotations", "speed")] {
        let manifest = good.path("plates");
        let mut document: Value = serde_json::from_str(&std::fs::read_to_string(&manifest).unwrap()).unwrap();
        document["calibration"]["time"]["driven_by"] = driven_by.into();
        write(&manifest, &document.to_string());
        let path = good.path(kind);
        let text = std::fs::read_to_string(&path).unwrap();
        let document: Value = serde_json::from_str(&text).unwrap();
        let mut places = Vec::new();
        numbers(&document, "", &mut places);
        for place in &places {
            for value in [-1.0, 0.0, 1e-300, 1e-3, 1e3, 1e300] {
                let mut damaged = document.clone();
                *damaged.pointer_mut(place).unwrap() = value.into();
                write(&path, &damaged.to_string());
                let result =
                    fit_once(&good.annotation).and_then(|fit| fit.as_ref().map_or(Ok(()), require_finite));
                result.unwrap_or_else(|failure| panic!("{kind}{place} = {value:e}: {failure}"));
            }
        }
        write(&path, &text);
    }
}

#[test]
fn the_whole_pipeline_bears_changed_labels_points_and_sources() {
    let mild = prop_oneof![
        random_edit::labels(),
        random_edit::same_labels(),
        random_edit::points_removed(),
        random_edit::panel_unused(),
        random_edit::sources(),
    ];
    let edits = prop::collection::vec(mild, 1..3);
    let result = runner(WHOLE_CASES).run(&edits, |edits| {
        let damaged = Damaged::new(&edits);
        match fit_plate(&damaged.annotation, &Skeleton::reference(), &Weights::default()) {
            Ok(fit) => require_finite(&fit),
            Err(failure) => refused(&failure.to_string()).map(|_| ()),
        }
    });
    result.unwrap_or_else(|failure| panic!("{failure}"));
}
