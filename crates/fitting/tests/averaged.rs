//! The mean strides that are kept here are what their clips give, byte for byte, and fit well.

use std::path::{Path, PathBuf};

use muybridge_capture::to_stable_json;
use muybridge_core::{Gait, Skeleton};
use muybridge_fitting::averaged::{Clip, MeanStride, Plan, documents};
use muybridge_fitting::pipeline::fit_plate;
use muybridge_fitting::weights::Weights;

/// Clip, plate, gait, assumed withers height (m).
const KEPT: [(&str, &str, Gait, f64); 2] = [
    ("tracked-trot/in-hand-trot.csv", "in-hand-trot", Gait::Trot, 1.60),
    ("labelled-walk/brown-horse.csv", "labelled-walk", Gait::Walk, 1.55),
];

fn project() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

#[test]
fn the_kept_documents_are_what_the_clips_give() {
    let shared = project().join("../shared/reference");
    for (table, id, gait, withers_height_m) in KEPT {
        let path = shared.join(table);
        if !path.exists() {
            println!("skipped: no shared tracks");
            continue;
        }
        let clip = Clip::read(&path).unwrap();
        let mean = MeanStride::new(&clip, gait).unwrap();
        let plan = Plan { id: id.into(), gait, withers_height_m, plate: format!("../plates/{id}.json") };
        let (manifest, annotation) = documents(&clip, &mean, &plan);
        let kept = |folder: &str| {
            std::fs::read_to_string(project().join(folder).join(format!("{id}.json"))).unwrap()
        };
        assert!(to_stable_json(&manifest) == kept("plates"), "{id}: the manifest; write it again");
        assert!(to_stable_json(&annotation) == kept("annotations"), "{id}: the annotation; write it again");
    }
}

#[test]
fn the_kept_strides_fit_as_trot_and_walk() {
    for (_, id, gait, withers_height_m) in KEPT {
        let annotation = project().join("annotations").join(format!("{id}.json"));
        let fitted = fit_plate(&annotation, &Skeleton::reference(), &Weights::default()).unwrap();
        assert!(fitted.analysis.implied.agrees_with(gait), "{id}: {}", fitted.analysis.implied.name());
        let squares = fitted.residuals.iter().map(|residual| residual.metres().powi(2));
        let rms = (squares.sum::<f64>() / fitted.residuals.len() as f64).sqrt() / withers_height_m;
        assert!(rms < 0.025, "{id}: {rms} of withers height");
        let duty = fitted.analysis.hind_duty_factor();
        let usual = if gait == Gait::Trot { 0.3..0.5 } else { 0.55..0.75 };
        assert!(usual.contains(&duty), "{id}: hind duty factor {duty}");
    }
}
