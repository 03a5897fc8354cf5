//! Tests of laying prints for two legs.

use super::*;
use crate::track::Track;

fn human() -> Model {
    Model::named("human").unwrap()
}

fn along(points: &[[f64; 2]]) -> Laying {
    let points = points.iter().map(|at_m| PathPoint { at_m: *at_m, tangent_m: None }).collect();
    Laying { points, step_length_m: Some(0.7), step_width_m: Some(0.2), timing: None }
}

fn placed(prints: Vec<Print>) -> crate::placed::Placed {
    Track { prints, ..Track::new("human") }.place(&human().timing).unwrap()
}

#[test]
fn it_stands_walks_in_even_steps_and_stands() {
    let prints = lay_biped(&along(&[[0.0, 0.0], [7.0, 0.0]]), &human()).unwrap();
    assert_eq!(prints.len(), 13);
    let [first, second, .., last, closing] = &prints[..] else { panic!() };
    assert!(first.at_m[0].abs() < 1e-9 && second.at_m[0].abs() < 1e-9);
    assert!((last.at_m[0] - 7.0).abs() < 1e-9 && (closing.at_m[0] - 7.0).abs() < 1e-9);
    for (i, print) in prints.iter().enumerate() {
        assert_eq!(print.foot, Foot::BIPED[i % 2]);
        assert!((print.at_m[1] - [-0.1, 0.1][i % 2]).abs() < 1e-9, "the left foot goes at -Z");
        assert!(print.heading_deg.abs() < 1e-9);
    }
    assert!(prints[1..12].windows(2).all(|pair| (pair[1].at_m[0] - pair[0].at_m[0] - 0.7).abs() < 1e-9));
    let placed = placed(prints);
    let [first, second, third, .., last, closing] = &placed.prints[..] else { panic!() };
    assert_eq!([first.strike_s, second.strike_s], [0.0, 0.0]);
    assert!(
        first.lift_off_s > 0.1 && first.lift_off_s < third.strike_s && third.strike_s <= second.lift_off_s
    );
    assert_eq!([last.lift_off_s, closing.lift_off_s], [placed.end_s; 2]);
}

#[test]
fn steps_are_never_much_longer_than_asked() {
    for length_m in [0.3, 0.72, 0.8, 5.0, 6.999, 7.1] {
        let prints = lay_biped(&along(&[[0.0, 0.0], [length_m, 0.0]]), &human()).unwrap();
        let steps = prints.len() - STANDING_PRINTS;
        assert!(length_m / steps as f64 <= 0.7 * 1.05, "{length_m}");
        assert!(steps == 1 || length_m / (steps as f64) > 0.35, "{length_m}");
        placed(prints);
    }
}

#[test]
fn toes_follow_a_bend() {
    let prints = lay_biped(&along(&[[0.0, 0.0], [3.0, -1.0], [3.0, -5.0], [8.0, -9.0]]), &human()).unwrap();
    assert!(prints.iter().any(|print| print.heading_deg > 60.0), "-Z is to the left");
    for pair in prints[1..].windows(2) {
        let way = DVec2::from(pair[1].at_m) - DVec2::from(pair[0].at_m);
        assert!(way.length() < 0.7 + 0.2 && (pair[1].heading_deg - pair[0].heading_deg).abs() < 60.0);
    }
    placed(prints);
}

#[test]
fn times_that_are_given_hold_for_walks_and_for_runs() {
    for (stance_time_s, step_time_s) in [(0.6, 0.5), (0.5, 0.5), (0.2, 0.4), (0.95, 0.5)] {
        let timing = Some(StepTiming { stance_time_s, step_time_s });
        for length_m in [0.5, 7.0] {
            let laying = Laying { timing, ..along(&[[0.0, 0.0], [length_m, 0.0]]) };
            let prints = lay_biped(&laying, &human()).unwrap();
            assert!(prints[2..prints.len() - 2].iter().all(|print| print.timing == timing));
            let placed = placed(prints);
            let count = placed.prints.len();
            assert_eq!(placed.prints[0].strike_s, placed.prints[1].strike_s);
            assert!(placed.prints[count - 2..].iter().all(|print| print.lift_off_s == placed.end_s));
            let flies = placed.prints[1].lift_off_s < placed.prints[2].strike_s;
            assert_eq!(flies, stance_time_s < step_time_s, "the first step is one of those that follow");
        }
    }
}

#[test]
fn the_model_says_what_is_not_given() {
    let model = human();
    let laying = Laying { step_length_m: None, step_width_m: None, ..along(&[[0.0, 0.0], [9.0, 0.0]]) };
    let prints = lay_biped(&laying, &model).unwrap();
    assert!((prints[3].at_m[0] - prints[2].at_m[0] - model.step_m[0]).abs() < 0.1 * model.step_m[0]);
    assert!((prints[3].at_m[1] - prints[2].at_m[1] - model.step_m[1]).abs() < 1e-9);
}

#[test]
fn what_cannot_be_laid_is_said() {
    let line = along(&[[0.0, 0.0], [7.0, 0.0]]);
    let error = |laying: Laying| lay_biped(&laying, &human()).unwrap_err().to_string();
    for step_length_m in [0.0, -1.0, f64::NAN, 21.0] {
        let said = error(Laying { step_length_m: Some(step_length_m), ..line.clone() });
        assert!(said.starts_with("step_length_m is"), "{said}");
    }
    assert!(
        error(Laying { step_width_m: Some(f64::INFINITY), ..line.clone() }).contains("step_width_m is inf")
    );
    assert_eq!(error(along(&[[1.0, 1.0], [1.0, 1.0]])), LayError::NoPath.to_string());
    assert_eq!(error(along(&[[1.0, f64::NAN], [1.0, 1.0]])), LayError::NoPath.to_string());
    let long = Laying { step_length_m: Some(0.01), ..along(&[[0.0, 0.0], [9000.0, 0.0]]) };
    assert_eq!(error(long), "the path is 900000 steps long; 9997 are the most");
    let standing_nowhere = StepTiming { stance_time_s: f64::NAN, step_time_s: f64::NAN };
    assert!(
        lay_biped(&Laying { timing: Some(standing_nowhere), ..line }, &human()).is_ok(),
        "placing it says so"
    );
}
