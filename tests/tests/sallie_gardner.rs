//! The plate of 1878, fitted: what is known of that stride, and of galloping horses, must come out.

#![allow(clippy::unwrap_used, reason = "a test stops at the first thing it cannot do")]

use std::sync::LazyLock;

use muybridge_capture::{KEYPOINT_COUNT, StanceLabel};
use muybridge_core::{Limb, Pair, PowerLaw, Side, Skeleton, SpeedSource};
use muybridge_fitting::chain::Attachment;
use muybridge_fitting::gait_analysis::ImpliedGait;
use muybridge_fitting::held_out::quantile;
use muybridge_fitting::pipeline::{PlateFit, fit_plate};
use muybridge_fitting::stride_fit::{PointResidual, rms};
use muybridge_fitting::weights::Weights;
use muybridge_tests::{SALLIE, repository};

/// Stance times of galloping thoroughbreds, m/s to s (Witte et al. 2006, as power laws).
const WITTE_FORE: PowerLaw = PowerLaw { a: 0.82, b: -0.84 };
/// The same for a hind limb.
const WITTE_HIND: PowerLaw = PowerLaw { a: 0.61, b: -0.66 };
/// Stance times may differ from Witte's by this share: another horse on another track, and panels 0.04 s apart that
/// leave a stance of 0.08 s no better known than to a third.
const WITTE_TOLERANCE: f64 = 0.35;
/// A stance toe may lie this far from the ground, m: a placed point is good to about 3 px, which is 2.5 cm here.
const TOE_TOLERANCE_M: f64 = 0.03;

static FIT: LazyLock<PlateFit> = LazyLock::new(|| {
    let path = repository().join(format!("annotations/{SALLIE}.json"));
    fit_plate(&path, &Skeleton::reference(), &Weights::default()).unwrap()
});

fn percent_of_withers(residuals: &[PointResidual]) -> Vec<f64> {
    residuals.iter().map(|residual| 100.0 * residual.metres() / FIT.withers_height_m).collect()
}

#[test]
fn footfalls_are_a_transverse_gallop_on_the_right_lead() {
    let analysis = &FIT.analysis;
    assert_eq!(analysis.implied, ImpliedGait::TransverseGallop);
    let lead = analysis.lead.unwrap();
    assert_eq!((lead.fore, lead.hind), (Side::Right, Side::Right));
    assert_eq!(analysis.footfall_order(), [Limb::LH, Limb::RH, Limb::LF, Limb::RF]);
    println!("lags behind the left hind (LF, RF, LH, RH): {:.3?}", analysis.lags);
}

#[test]
fn there_is_one_suspension_and_it_is_gathered() {
    let suspensions = &FIT.analysis.suspensions;
    println!("suspensions: {suspensions:.3?}");
    assert_eq!(suspensions.len(), 1);
    assert!(suspensions[0].is_gathered());
}

#[test]
fn stride_time_and_speed_are_those_of_a_racing_gallop() {
    let [stride_s, sd_s] = FIT.analysis.stride_time_s;
    println!("stride time {stride_s:.4} ± {sd_s:.4} s");
    assert!((0.41..=0.50).contains(&stride_s) && sd_s > 0.0 && sd_s.is_finite());
    let speed = FIT.calibration.speed_m_s;
    println!("speed {:.3} ± {:.3} m/s", speed.value, speed.sd);
    assert!((speed.value - 16.09).abs() < 0.005, "one mile in 1 min 40 s");
    assert_eq!(FIT.calibration.speed_source, SpeedSource::Stated);
}

#[test]
fn the_printed_interval_is_compared_with_the_one_used() {
    let found = FIT.calibration.disagreements.iter().find(|d| d.quantity.contains("interval")).unwrap();
    println!("{}: {:?} against {:?}, {:+.1} %", found.quantity, found.used, found.other, found.percent());
    assert!((found.other.1.value - 0.04).abs() < 1e-9, "the card says the twenty-fifth part of a second");
}

#[test]
fn stance_times_are_near_those_of_galloping_horses() {
    let speed_m_s = FIT.calibration.speed_m_s.value;
    for (pair, law) in [(Pair::Fore, WITTE_FORE), (Pair::Hind, WITTE_HIND)] {
        let ([stance_s, sd_s], expected_s) = (FIT.analysis.stance_s(pair), law.contact_time_s(speed_m_s));
        println!("{pair:?} stance {stance_s:.4} ± {sd_s:.4} s; Witte et al. {expected_s:.4} s");
        assert!((stance_s / expected_s - 1.0).abs() <= WITTE_TOLERANCE);
    }
}

#[test]
fn points_are_met_and_unseen_points_predicted() {
    let rms = rms(percent_of_withers(&FIT.residuals).into_iter());
    let unseen = percent_of_withers(&FIT.held_out);
    let (median, p90) = (quantile(&unseen, 0.5), quantile(&unseen, 0.9));
    println!(
        "% of withers height: RMS {rms:.2}; held out ({}) median {median:.2}, 90th {p90:.2}",
        unseen.len()
    );
    assert!(rms <= 2.0);
    assert!(unseen.len() >= 100, "only {} held-out points", unseen.len());
    assert!(median <= 3.0 && p90 <= 6.0);
}

#[test]
fn toes_labelled_stance_are_on_the_ground() {
    let fit = &FIT.fit;
    let mut seen = [0; 4];
    for (slot, kinematics) in fit.kinematics().iter().enumerate() {
        let panel = &fit.observation.panels[fit.problem.order[slot]];
        let number = panel.camera.panel;
        for limb in Limb::ALL.into_iter().filter(|limb| panel.contacts[limb.index()] == StanceLabel::Stance) {
            let [_, height_m] = kinematics.place(Attachment::Tip(limb.hoof_bone()));
            println!("panel {number}: {} toe at {:+.1} cm", limb.abbreviation(), 100.0 * height_m);
            assert!(height_m.abs() <= TOE_TOLERANCE_M, "panel {number}: {limb:?} at {height_m:.3} m");
            seen[limb.index()] += 1;
        }
    }
    assert!(seen.iter().all(|panels| *panels > 0), "every leg has a stance panel: {seen:?}");
}

#[test]
fn every_panel_has_every_keypoint_and_every_hash_is_one() {
    let plate = &FIT.plate;
    let panels: Vec<u32> = plate.annotation.panels.iter().map(|panel| panel.panel).collect();
    assert_eq!(panels, (1..=12).collect::<Vec<_>>());
    for panel in &plate.annotation.panels {
        assert_eq!(panel.keypoints.iter().count(), KEYPOINT_COUNT, "panel {}", panel.panel);
    }
    let hashes = plate.manifest.images.iter().map(|image| &image.sha256);
    for hash in hashes.chain(&plate.annotation.images_sha256).chain([&plate.annotation_sha256]) {
        assert!(hash.len() == 64 && hash.bytes().all(|byte| byte.is_ascii_hexdigit()), "{hash}");
    }
}
