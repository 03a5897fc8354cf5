//! Every annotated plate, fitted: residuals, footfalls in the order a person saw them, and where its speed is from.

#![allow(clippy::unwrap_used, reason = "a test stops at the first thing it cannot do")]

use std::sync::LazyLock;

use muybridge_capture::{ANNOTATION_SCHEMA, Annotation, read_json};
use muybridge_core::Limb::{self, LF, LH, RF, RH};
use muybridge_core::{Gait, Side, Skeleton, SpeedSource, Stride};
use muybridge_fitting::gait_analysis::ImpliedGait;
use muybridge_fitting::gait_laws::Evidence;
use muybridge_fitting::held_out::quantile;
use muybridge_fitting::motion_database::build_database;
use muybridge_fitting::pipeline::{PlateFit, fit_plate};
use muybridge_fitting::repeatability::Repeatability;
use muybridge_fitting::stride_fit::{PointResidual, rms};
use muybridge_fitting::weights::Weights;
use muybridge_tests::repository;

/// Root mean square of all residuals, and median of predicted unseen points, percent of the withers height.
const MOST_RMS: f64 = 2.5;
const MOST_HELD_OUT: f64 = 4.0;

/// What a person who looked at a plate knows of it.
struct Seen {
    id: &'static str,
    gait: Gait,
    /// Legs in the order they strike, from the left hind; two that strike as one beat may change places.
    order: [Limb; 4],
    beats: [[Limb; 2]; 2],
    lead: Option<Side>,
    suspensions: usize,
    speed: SpeedSource,
}

const NONE: [[Limb; 2]; 2] = [[LF, LF], [LF, LF]];

const SEEN: [Seen; 7] = [
    Seen {
        id: "chopper-walking",
        gait: Gait::Walk,
        order: [LH, LF, RH, RF],
        beats: NONE,
        lead: None,
        suspensions: 0,
        speed: SpeedSource::Measured,
    },
    Seen {
        id: "daisy-galloping",
        gait: Gait::Gallop,
        order: [LH, RH, LF, RF],
        beats: NONE,
        lead: Some(Side::Right),
        suspensions: 1,
        speed: SpeedSource::Inferred,
    },
    Seen {
        id: "flode-holden-614",
        gait: Gait::Canter,
        order: [LH, LF, RH, RF],
        beats: [[LF, RH], [LF, LF]],
        lead: Some(Side::Right),
        suspensions: 1,
        speed: SpeedSource::Inferred,
    },
    Seen {
        id: "in-hand-trot",
        gait: Gait::Trot,
        order: [LH, RF, RH, LF],
        beats: [[LH, RF], [RH, LF]],
        lead: None,
        // Two of 7 % of the stride by the best estimate, but shorter than twice what the contacts' edges are unsure by.
        suspensions: 0,
        speed: SpeedSource::Inferred,
    },
    Seen {
        id: "labelled-walk",
        gait: Gait::Walk,
        order: [LH, LF, RH, RF],
        beats: NONE,
        lead: None,
        suspensions: 0,
        speed: SpeedSource::Inferred,
    },
    Seen {
        id: "pronto-pacing",
        gait: Gait::Rack,
        order: [LH, RH, RF, LF],
        beats: [[LH, LF], [RH, RF]],
        lead: None,
        suspensions: 2,
        speed: SpeedSource::Inferred,
    },
    Seen {
        id: "sallie-gardner-1878",
        gait: Gait::Gallop,
        order: [LH, RH, LF, RF],
        beats: NONE,
        lead: Some(Side::Right),
        suspensions: 1,
        speed: SpeedSource::Stated,
    },
];

static FITS: LazyLock<Vec<PlateFit>> = LazyLock::new(|| {
    let fit = |seen: &Seen| {
        let path = repository().join(format!("annotations/{}.json", seen.id));
        fit_plate(&path, &Skeleton::reference(), &Weights::default()).unwrap()
    };
    SEEN.iter().map(fit).collect()
});

fn each() -> impl Iterator<Item = (&'static Seen, &'static PlateFit)> {
    SEEN.iter().zip(FITS.iter())
}

#[test]
fn every_annotation_is_one_somebody_has_looked_at() {
    let files = std::fs::read_dir(repository().join("annotations")).unwrap();
    let mut ids: Vec<String> = files
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "json"))
        .map(|path| path.file_stem().unwrap().to_string_lossy().into_owned())
        .collect();
    ids.sort();
    assert_eq!(ids, SEEN.map(|seen| seen.id));
}

#[test]
fn points_are_met_and_unseen_points_predicted() {
    for (seen, fit) in each() {
        let percent = |points: &[PointResidual]| -> Vec<f64> {
            points.iter().map(|residual| 100.0 * residual.metres() / fit.withers_height_m).collect()
        };
        let (all, unseen) = (rms(percent(&fit.residuals).into_iter()), percent(&fit.held_out));
        let median = quantile(&unseen, 0.5);
        println!("{}: RMS {all:.2} %, held out ({}) median {median:.2} %", seen.id, unseen.len());
        assert!(all <= MOST_RMS, "{}: RMS {all}", seen.id);
        assert!(unseen.len() > 50 && median <= MOST_HELD_OUT, "{}: held out {median}", seen.id);
    }
}

#[test]
fn footfalls_lead_and_suspension_are_what_a_person_saw() {
    for (seen, fit) in each() {
        let analysis = &fit.analysis;
        println!(
            "{}: {} ({}), lags {:.2?}, duty {:.2?}, lead {:?}, suspensions {:?}",
            seen.id,
            analysis.implied.name(),
            fit.gait(),
            analysis.lags,
            analysis.contacts.map(|contact| contact.duty_factor()),
            analysis.lead,
            analysis.suspensions.iter().map(|s| s.share).collect::<Vec<_>>(),
        );
        assert_eq!(fit.gait(), seen.gait, "{}", seen.id);
        assert!(analysis.implied.agrees_with(seen.gait), "{}: {}", seen.id, analysis.implied.name());
        assert!(same_order(analysis.footfall_order(), seen), "{}: {:?}", seen.id, analysis.footfall_order());
        assert_eq!(analysis.lead.map(|lead| lead.fore), seen.lead, "{}", seen.id);
        assert!(analysis.lead.is_none_or(muybridge_core::Lead::is_transverse), "{}", seen.id);
        assert_eq!(analysis.suspensions.len(), seen.suspensions, "{}", seen.id);
        if matches!(analysis.implied, ImpliedGait::TransverseGallop | ImpliedGait::Canter) {
            assert!(analysis.suspensions[0].is_gathered(), "{}", seen.id);
        }
    }
}

/// Legs of one beat may come in either order, and the left hind's partner may come last instead of second.
fn same_order(found: [Limb; 4], seen: &Seen) -> bool {
    let beat = |limb: Limb| {
        let pair = seen.beats.iter().find(|pair| pair[0] != pair[1] && pair.contains(&limb));
        pair.map_or([limb, limb], |pair| *pair)
    };
    let start = |order: [Limb; 4]| {
        let mut beats: Vec<[Limb; 2]> = order.map(beat).to_vec();
        beats.dedup();
        if beats.len() > 1 && beats.first() == beats.last() {
            beats.pop();
        }
        beats
    };
    start(found) == start(seen.order)
}

#[test]
fn what_is_not_stated_is_marked_inferred_and_carries_its_uncertainty() {
    for (seen, fit) in each() {
        let speed = fit.calibration.speed_m_s;
        let [time_s, time_sd_s] = fit.analysis.stance_s(muybridge_core::Pair::Fore);
        println!(
            "{}: {:.2} ± {:.2} m/s, fore stance {time_s:.3} ± {time_sd_s:.3} s",
            seen.id, speed.value, speed.sd
        );
        assert_eq!(fit.calibration.speed_source, seen.speed, "{}", seen.id);
        if seen.speed == SpeedSource::Inferred {
            assert!(speed.sd > 0.05 * speed.value, "{}: the law's own spread", seen.id);
            assert!(time_sd_s > 0.05 * time_s, "{}: an inferred speed makes the time unsure", seen.id);
        }
    }
}

#[test]
fn points_are_as_repeatable_as_the_annotation_says() {
    for (seen, fit) in each() {
        let path = repository().join(format!("annotations/second-pass/{}.json", seen.id));
        if !path.exists() {
            let averaged = fit
                .plate
                .annotation
                .panels
                .iter()
                .any(|panel| panel.keypoints.iter().any(|(_, placed)| placed.sd_px.is_some()));
            assert!(averaged, "{}: neither a second pass nor a spread of its own", seen.id);
            continue;
        }
        let second: Annotation = read_json(&path, ANNOTATION_SCHEMA).unwrap();
        let annotation = &fit.plate.annotation;
        let repeated = Repeatability::new(annotation, &second, &fit.calibration).unwrap();
        for (visible, said) in [(true, annotation.visible_sd_px), (false, annotation.occluded_sd_px)] {
            let measured = repeated.sd_px(visible).unwrap();
            println!("{}: visible {visible}: {measured:.2} px, said {said}", seen.id);
            assert!((measured / said - 1.0).abs() < 0.1, "{}: {measured} px, not {said}", seen.id);
        }
    }
}

#[test]
fn derived_gaits_are_there_until_somebody_annotates_such_a_plate() {
    let reference = Skeleton::reference();
    let derived = |fits: &[PlateFit], gait: Gait| -> Vec<String> {
        let database = build_database(&Evidence { fits, ..Evidence::default() }, &reference);
        let made_of_another = |stride: &&Stride| stride.id.contains("-of-");
        database.strides_of(gait).filter(made_of_another).map(|stride| stride.id.clone()).collect()
    };
    for gait in [Gait::Amble, Gait::Leap] {
        let mut fits: Vec<PlateFit> = FITS.iter().filter(|fit| fit.gait() != Gait::Canter).cloned().collect();
        assert!(!derived(&fits, gait).is_empty(), "{gait}");
        // Somebody judges the second walk to be one.
        let walk = fits.iter_mut().find(|fit| fit.id() == "labelled-walk").unwrap();
        walk.plate.annotation.gait = Some(gait);
        assert!(derived(&fits, gait).is_empty(), "{gait}");
    }
}
