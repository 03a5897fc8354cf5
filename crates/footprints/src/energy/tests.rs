//! Cases worked by hand.

use super::*;

const EXACT: f64 = 1e-9;
const PAPER: Terms = Terms { physics: 1.0, comfort_per_s2: 100.0, toe_band_m: 0.0, smoothing: 0.0 };

/// A foot whose point of support is its ankle's, under a hip at the centre of mass.
fn foot(at: DVec3, nominal_m: f64) -> Support {
    Support {
        ankle: at,
        middle: at,
        toe_from_middle: DVec3::ZERO,
        hip: DVec3::ZERO,
        through: DVec3::ZERO,
        nominal_m,
        longest_m: 10.0,
    }
}

fn missing_force(feet: &[Support], centre: DVec3, acceleration: DVec3) -> f64 {
    energy(feet, centre, acceleration, &PAPER)[0]
}

#[test]
fn standing_over_one_foot_costs_nothing() {
    let [physics, comfort] = energy(&[foot(DVec3::ZERO, 0.9)], DVec3::Y * 0.9, DVec3::ZERO, &PAPER);
    assert!(physics.abs() < EXACT && comfort.abs() < EXACT, "{physics} {comfort}");
}

#[test]
fn only_free_fall_is_free_without_a_foot() {
    assert!(missing_force(&[], DVec3::ZERO, GRAVITY).abs() < EXACT);
    assert!((missing_force(&[], DVec3::ZERO, DVec3::ZERO) - 9.81).abs() < EXACT);
    assert!((missing_force(&[], DVec3::ZERO, GRAVITY + DVec3::new(3.0, 0.0, -4.0)) - 5.0).abs() < EXACT);
}

#[test]
fn one_foot_pushes_along_its_leg_and_does_not_pull() {
    let (centre, along) = (DVec3::new(0.6, 0.8, 0.0), DVec3::new(0.6, 0.8, 0.0));
    let feet = [foot(DVec3::ZERO, 1.0)];
    let of = |force: DVec3| missing_force(&feet, centre, GRAVITY + force);
    assert!(of(7.0 * along).abs() < EXACT);
    assert!((of(-7.0 * along) - 7.0).abs() < EXACT, "pulling");
    let across = DVec3::new(-0.8, 0.6, 0.0);
    assert!((of(7.0 * along + 2.0 * across) - 2.0).abs() < EXACT);
    assert!((of(7.0 * along + 2.0 * DVec3::Z) - 2.0).abs() < EXACT);
    assert!((of(-3.0 * along + 4.0 * across) - 5.0).abs() < EXACT);
}

#[test]
fn two_feet_exert_what_lies_in_their_triangle() {
    let feet = [foot(DVec3::new(-0.3, 0.0, 0.0), 0.5), foot(DVec3::new(0.3, 0.0, 0.0), 0.5)];
    let centre = DVec3::new(0.0, 0.4, 0.0);
    let (behind, ahead) = (DVec3::new(0.6, 0.8, 0.0), DVec3::new(-0.6, 0.8, 0.0));
    let of = |force: DVec3| missing_force(&feet, centre, GRAVITY + force);
    assert!(of(5.0 * behind + 2.0 * ahead).abs() < EXACT, "inside");
    assert!((of(5.0 * behind + 2.0 * ahead + 1.5 * DVec3::Z) - 1.5).abs() < EXACT, "out of the plane");
    // Beyond the edge of the hind foot: 2 ahead of it, of which the sine of the angle between the legs, 0.96, is missing.
    assert!((of(5.0 * behind - 2.0 * ahead) - 1.92).abs() < EXACT, "outside");
    assert!((of(-5.0 * DVec3::Y) - 5.0).abs() < EXACT, "both would pull");
}

#[test]
fn two_feet_on_one_spot_are_one_foot() {
    let feet = [foot(DVec3::ZERO, 0.9), foot(DVec3::ZERO, 0.9)];
    assert!((missing_force(&feet, DVec3::Y * 0.9, DVec3::X) - 1.0).abs() < EXACT);
}

#[test]
fn three_feet_exert_what_lies_in_their_pyramid() {
    let feet = [DVec3::new(1.0, 0.0, 0.0), DVec3::new(-1.0, 0.0, 1.0), DVec3::new(-1.0, 0.0, -1.0)];
    let [a, b, c] = feet.map(|at| (DVec3::Y - at).normalize());
    let feet = feet.map(|at| foot(at, 1.0));
    let of = |force: DVec3| missing_force(&feet, DVec3::Y, GRAVITY + force);
    assert!(of(3.0 * a + 2.0 * b + c).abs() < EXACT);
    // Beyond the face of a and b what is missing is across that face.
    let across = a.cross(b).normalize();
    assert!((of(3.0 * a + 2.0 * b - 0.5 * c) - 0.5 * across.dot(c).abs()).abs() < EXACT);
}

#[test]
fn discomfort_is_the_squared_difference_of_the_leg_from_its_comfortable_length() {
    let feet = [foot(DVec3::ZERO, 0.9), foot(DVec3::new(0.3, 0.0, 0.0), 0.4)];
    let [_, comfort] = energy(&feet, DVec3::new(0.0, 0.4, 0.0), DVec3::ZERO, &PAPER);
    assert!((comfort - 100.0 * (0.5 * 0.5 + 0.1 * 0.1)).abs() < EXACT);
}

#[test]
fn on_its_toes_a_foot_supports_at_the_toe_and_its_leg_grows_no_longer() {
    let mut toes = foot(DVec3::ZERO, 0.9);
    (toes.toe_from_middle, toes.longest_m) = (DVec3::X * 0.12, 0.95);
    let centre = DVec3::new(0.12, 1.0, 0.0);
    let [physics, comfort] = energy(&[toes], centre, DVec3::ZERO, &PAPER);
    assert!(physics.abs() < EXACT, "the centre of mass is above the toe: {physics}");
    assert!((comfort - 100.0 * 0.05 * 0.05).abs() < EXACT, "{comfort}");
    // Farther from the toe than foot and leg together, what is lacking costs, too.
    let [_, comfort] = energy(&[toes], DVec3::new(0.12, 1.17, 0.0), DVec3::ZERO, &PAPER);
    assert!((comfort - 100.0 * (0.05 * 0.05 + 0.1 * 0.1)).abs() < EXACT, "{comfort}");
    toes.longest_m = 1.2;
    assert!(missing_force(&[toes], centre, DVec3::ZERO) > 1.0, "flat, it supports under its middle");
}

#[test]
fn the_band_joins_flat_foot_and_toes_smoothly() {
    let mut support = foot(DVec3::ZERO, 0.9);
    (support.toe_from_middle, support.longest_m) = (DVec3::X * 0.12, 0.95);
    let at = |length_m: f64| support.on_toes(length_m, 0.1);
    assert_eq!(at(0.95), [0.95, 0.0, 0.0]);
    let [length_m, share, _] = at(1.05);
    assert!((length_m - 1.0).abs() < EXACT && share == 1.0);
    for i in 0..=24 {
        let length_m = 0.94 + 0.005 * f64::from(i);
        let (before, after) = (at(length_m - 1e-6), at(length_m + 1e-6));
        assert!(((after[0] - before[0]) / 2e-6 - (1.0 - at(length_m)[1])).abs() < 1e-5, "{length_m}");
        assert!(((after[1] - before[1]) / 2e-6 - at(length_m)[2]).abs() < 1e-3, "{length_m}");
    }
}

#[test]
fn no_number_breaks_the_energy() {
    for centre in [DVec3::ZERO, DVec3::splat(f64::NAN), DVec3::splat(1e300)] {
        let feet = [foot(DVec3::ZERO, 0.9), foot(DVec3::ZERO, 0.9), foot(DVec3::X, 0.9), foot(DVec3::Z, 0.9)];
        let _ = energy(&feet, centre, DVec3::ZERO, &PAPER);
        let _ = derivatives(&feet, centre, DVec3::ZERO, &PAPER, &Foreseen::default());
    }
}
