//! Tests of placing tracks, whole and broken.

use super::*;

fn rule() -> TimingRule {
    TimingRule {
        step_times: vec![[0.2, 0.4], [1.0, 0.5], [3.0, 0.9]],
        stance_times: vec![[0.2, 0.6], [1.0, 0.5], [3.0, 0.3]],
    }
}

fn print(foot: Foot, x_m: f64, times_s: Option<[f64; 2]>) -> Print {
    let timing = times_s.map(|[stance_time_s, step_time_s]| StepTiming { stance_time_s, step_time_s });
    Print { foot, at_m: [x_m, 0.0], heading_deg: 0.0, timing }
}

fn track(prints: Vec<Print>) -> Track {
    Track { prints, ..Track::new("human") }
}

fn walk(count: usize, step_m: f64) -> Track {
    let step = |i: usize| print(Foot::BIPED[i % 2], i as f64 * step_m, None);
    track((0..count).map(step).collect())
}

fn faults(track: &Track) -> Vec<String> {
    match track.place(&rule()) {
        Err(TrackError::Faults(faults)) => faults,
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_walk_is_placed_in_the_order_of_its_footfalls() {
    let placed = walk(6, 0.6).place(&rule()).unwrap();
    assert_eq!(placed.prints.len(), 6);
    assert_eq!(placed.prints[0].strike_s, 0.0);
    assert!(placed.prints.windows(2).all(|pair| pair[0].strike_s < pair[1].strike_s));
    assert!(
        placed
            .prints
            .iter()
            .all(|print| print.strike_s < print.lift_off_s && print.lift_off_s <= placed.end_s)
    );
}

#[test]
fn a_print_takes_height_and_slope_of_the_ground() {
    let mut track = walk(1, 0.0);
    track.prints[0] = Print { at_m: [1.0, -2.0], heading_deg: 90.0, ..track.prints[0] };
    let flat = track.place(&rule()).unwrap().prints[0];
    assert!((flat.world_from_foot * DVec3::X - DVec3::NEG_Z).length() < 1e-12, "left of X is -Z");
    track.terrain = Terrain::Slope { rise_deg: 30.0, towards_deg: 90.0 };
    let uphill = track.place(&rule()).unwrap().prints[0];
    let (sin, cos) = 30f64.to_radians().sin_cos();
    assert!((uphill.middle - DVec3::new(1.0, 2.0 * sin / cos, -2.0)).length() < 1e-12);
    assert!((uphill.world_from_foot * DVec3::X - DVec3::new(0.0, sin, -cos)).length() < 1e-12);
    assert!((uphill.world_from_foot * DVec3::Z - DVec3::X).length() < 1e-12, "its right is still right");
    for heading_deg in [0.0, 33.0, 145.0, -100.0] {
        track.prints[0].heading_deg = heading_deg;
        let foot = track.place(&rule()).unwrap().prints[0].world_from_foot;
        let toes = foot * DVec3::X;
        let plan = glam::DVec2::new(toes.x, toes.z).normalize_or_zero();
        assert!((plan - direction(heading_deg)).length() < 1e-12, "the toes point where the print does");
        assert!((foot * DVec3::Y - DVec3::new(0.0, cos, sin)).length() < 1e-12);
    }
}

#[test]
fn standing_on_one_leg_is_legal_and_so_are_great_leaps_and_two_feet_at_once() {
    let one = walk(1, 0.0).place(&rule()).unwrap();
    assert!(one.end_s > 0.0 && one.prints[0].lift_off_s == one.end_s);
    let far = walk(4, 50.0).place(&rule()).unwrap();
    assert!(far.prints[0].lift_off_s < far.prints[1].strike_s);
    let (left, right) = (Foot::Left, Foot::Right);
    let hops = (0..6).map(|i| print([left, right][i % 2], (i / 2) as f64, Some([0.3, [0.0, 0.8][i % 2]])));
    let placed = track(hops.collect()).place(&rule()).unwrap();
    assert_eq!(placed.prints[2].strike_s, placed.prints[3].strike_s);
}

#[test]
fn ten_thousand_prints_are_placed_and_one_more_is_not() {
    assert_eq!(walk(10_000, 0.6).place(&rule()).unwrap().prints.len(), 10_000);
    assert_eq!(
        faults(&walk(10_001, 0.6)),
        ["the track has 10001 prints; 10000 are the most: take some away"]
    );
}

#[test]
fn times_a_millisecond_apart_are_one() {
    let times_s = [Some([0.5004, 0.5]), Some([1.2, 0.9]), Some([0.3, 0.8])];
    let feet = [Foot::Left, Foot::Right, Foot::Left];
    let prints = feet.iter().zip(times_s).map(|(foot, times_s)| print(*foot, 0.0, times_s)).collect();
    let placed = track(prints).place(&rule()).unwrap();
    assert_eq!(placed.prints[0].lift_off_s, placed.prints[1].strike_s);
    assert_eq!(placed.prints[1].lift_off_s, 0.5 + 1.2);
    let outlasting = track(vec![print(Foot::Left, 0.0, Some([5.0, 1.0]))]).place(&rule()).unwrap();
    assert_eq!(outlasting.prints[0].lift_off_s, 1.0);
}

#[test]
fn every_fault_names_its_print_and_says_what_to_do() {
    let mut track = walk(6, 0.6);
    track.prints[0].at_m[0] = f64::NAN;
    track.prints[1].at_m[1] = 20_000.0;
    track.prints[2].heading_deg = f64::INFINITY;
    track.prints[3].foot = Foot::LeftFore;
    track.prints[4].timing = Some(StepTiming { stance_time_s: -1.0, step_time_s: 0.5 });
    track.prints[5].timing = Some(StepTiming { stance_time_s: 1.0, step_time_s: f64::NAN });
    track.weights.physics = -1.0;
    track.terrain = Terrain::Slope { rise_deg: 89.0, towards_deg: 0.0 };
    let faults = faults(&track).join("\n");
    for said in [
        "print 1 (L): at_m: x is NaN m; it must be between -10000 and 10000 m",
        "print 2 (R): at_m: z",
        "print 3 (L): heading_deg",
        "print 4 (LF): is of another kind",
        "print 5 (L): stance_time_s is -1 s",
        "print 6 (R): step_time_s",
        "weights: physics is -1",
        "terrain: rise_deg",
    ] {
        assert!(faults.contains(said), "{said} in\n{faults}");
    }
}

#[test]
fn times_that_exclude_each_other_are_faults() {
    let (left, right) = (Foot::Left, Foot::Right);
    let twice = [print(left, 0.0, Some([0.3, 0.0])), print(left, 1.0, None)];
    assert!(
        faults(&track(twice.into()))
            .join("")
            .contains("print 1 (L): the same foot falls at the same time as print 2")
    );
    let three = [
        print(left, 0.0, Some([0.3, 0.0])),
        print(right, 0.0, Some([0.3, 0.0])),
        print(left, 1.0, Some([0.3, 0.5])),
    ];
    assert!(faults(&track(three.into())).join("").contains("falls at the same time as print 3"));
    let long =
        [print(left, 0.0, Some([1.0, 0.5])), print(right, 0.5, Some([0.6, 0.5])), print(left, 1.0, None)];
    let said = faults(&track(long.into())).join("");
    assert!(
        said.contains("print 1 (L): it stands for 1 s, but its foot falls again 1.000 s later, at print 3"),
        "{said}"
    );
    let cut_off = [print(left, 0.0, Some([1.0, 0.5])), print(right, 0.5, Some([0.6, 0.0]))];
    assert!(faults(&track(cut_off.into())).join("").contains("print 2 (R): the motion ends"));
}

#[test]
fn hooves_need_times() {
    let hooves = [print(Foot::LeftFore, 0.0, None), print(Foot::RightHind, 0.0, Some([0.5, 0.5]))];
    let said = faults(&track(hooves.into()));
    assert_eq!(said.len(), 1);
    assert!(said[0].contains("print 1 (LF): has no times"));
}

#[test]
fn a_long_list_of_faults_is_cut() {
    let mut track = walk(100, 0.6);
    track.prints.iter_mut().for_each(|print| print.at_m = [f64::NAN; 2]);
    let faults = faults(&track);
    assert_eq!(faults.len(), 21);
    assert_eq!(faults[20], "... and 180 more");
    assert_eq!(
        self::faults(&walk(0, 0.0)),
        ["the track has no prints; add one, or a path along which they are laid"]
    );
}

#[test]
fn a_motion_of_days_is_refused() {
    let prints = (0..100).map(|i| print(Foot::BIPED[i % 2], 0.0, Some([300.0, 600.0]))).collect();
    assert!(faults(&track(prints)).join("").contains("60000 s; 14400 s are the most"));
}
