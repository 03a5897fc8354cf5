//! Prints laid along a path.

use muybridge_core::{Gait, Lead, Side};

use super::scene::{GAITS, laid, model, random_track, straight_track, track_gait};
use crate::lay::{LayError, Laying};
use crate::path::PathPoint;
use crate::terrain::Terrain;
use crate::track::{Foot, TrackGait};

fn point(x_m: f64) -> PathPoint {
    PathPoint { at_m: [x_m, 0.0], tangent_m: None }
}

fn laying(points: Vec<PathPoint>) -> Laying {
    Laying { points, step_length_m: None, step_width_m: None, timing: None }
}

#[test]
fn prints_begin_and_end_on_the_path_beside_it() {
    let model = model();
    for gait in GAITS {
        let track = straight_track(&model, gait);
        let along = || track.prints.iter().map(|print| print.at_m[0]);
        let first = along().fold(f64::INFINITY, f64::min);
        let last = along().fold(f64::NEG_INFINITY, f64::max);
        assert!(first.abs() < 1e-9, "{gait} begins at {first}");
        assert!(last <= 30.0 && last > 20.0, "{gait} ends at {last}");
        for print in &track.prints {
            let is_right = matches!(print.foot, Foot::RightFore | Foot::RightHind);
            assert!((print.at_m[1] > 0.0) == is_right && print.at_m[1].abs() < 0.3, "{print:?}");
        }
    }
}

#[test]
fn a_short_path_gives_one_stride_and_a_slope_shorter_steps() {
    let model = model();
    let gait = track_gait(&model, Gait::Trot, 0.5, Side::Right);
    let short = laid(&model, gait, vec![point(0.0), point(0.5)], Terrain::Flat);
    assert!((4..=8).contains(&short.prints.len()), "{}", short.prints.len());
    let points = || vec![point(0.0), point(40.0)];
    let level = laid(&model, gait, points(), Terrain::Flat);
    let steep = laid(&model, gait, points(), Terrain::Slope { rise_deg: 10.0, towards_deg: 0.0 });
    assert!(steep.prints.len() > level.prints.len() + 4, "{} {}", steep.prints.len(), level.prints.len());
}

#[test]
fn the_other_lead_is_the_mirror_image() {
    let model = model();
    let [left, right] = [Side::Left, Side::Right].map(|side| {
        let gait = track_gait(&model, Gait::Canter, 0.5, side);
        laid(&model, gait, vec![point(0.0), point(20.0)], Terrain::Flat).prints
    });
    assert_eq!(left.len(), right.len());
    for (a, b) in left.iter().zip(&right) {
        assert_eq!(a.foot.index() ^ 1, b.foot.index());
        assert!((a.at_m[0] - b.at_m[0]).abs() < 1e-6 && (a.at_m[1] + b.at_m[1]).abs() < 1e-6);
    }
}

#[test]
fn what_cannot_be_laid_is_told() {
    let model = model();
    let walk = TrackGait { gait: Gait::Walk, speed_m_s: 1.5, lead: None };
    let lay = |gait: TrackGait, points: Vec<PathPoint>| {
        super::super::lay_horse(&laying(points), &gait, &Terrain::Flat, &model)
    };
    assert_eq!(lay(walk, vec![point(1.0)]), Err(LayError::NoPath));
    let path = || vec![point(0.0), point(9.0)];
    for speed_m_s in [0.0, 9.0, f64::NAN, f64::INFINITY] {
        let error = lay(TrackGait { speed_m_s, ..walk }, path()).unwrap_err().to_string();
        assert!(error.contains("walk is known from"), "{error}");
    }
    let lead = Some(Lead { fore: Side::Left, hind: Side::Right });
    for gait in [Gait::Walk, Gait::Leap, Gait::Canter] {
        let [low, high] = model.speed_range_m_s(gait);
        let speed_m_s = f64::from(0.5 * (low + high));
        assert!(matches!(lay(TrackGait { gait, speed_m_s, lead }, path()), Err(LayError::Gait(_))), "{gait}");
    }
    let far = |k: u8| PathPoint { at_m: [f64::from(k % 2) * 9000.0, f64::from(k)], tangent_m: None };
    assert!(matches!(lay(walk, (0..9).map(far).collect()), Err(LayError::TooMany { .. })));
}

#[test]
fn equal_inputs_give_equal_prints() {
    let model = model();
    assert_eq!(random_track(&model, Gait::Rack, 4), random_track(&model, Gait::Rack, 4));
}
