//! Every known motion against what is known of horses.

use super::*;
use crate::chain::Attachment;
use crate::contacts::{ContactInstant, LegContact};
use crate::gait_analysis::GaitAnalysis;
use crate::layout::{BENDS, PITCH, SLIDES};
use muybridge_capture::NearOff;
use muybridge_core::{BONE_COUNT, Pair};

const SEEDS: std::ops::Range<u64> = 0..8;

/// The six gaits, in order of [`Gait::ALL`].
fn gaits() -> impl Iterator<Item = Gait> {
    Gait::ALL.into_iter().filter(|gait| *gait != Gait::Leap)
}

/// Every motion of [`SyntheticStride::of_gait`], leaps included.
fn every_motion(panels: usize) -> impl Iterator<Item = SyntheticStride> {
    Gait::ALL
        .into_iter()
        .flat_map(move |gait| SEEDS.map(move |seed| SyntheticStride::of_gait(gait, seed, panels)))
}

fn named(stride: &SyntheticStride) -> String {
    format!("{} of seed {}", stride.gait, stride.seed)
}

fn toe(posed: &Posed, limb: Limb) -> [f64; 3] {
    posed.bones[limb.hoof_bone()][1]
}

fn centre_of_mass(stride: &SyntheticStride, posed: &Posed) -> [f64; 2] {
    let middle = |i: usize, axis: usize| 0.5 * (posed.bones[i][0][axis] + posed.bones[i][1][axis]);
    let share = |i: usize| f64::from(stride.horse.bones[i].mass_fraction);
    [0, 1].map(|axis| (0..BONE_COUNT).map(|i| share(i) * middle(i, axis)).sum())
}

fn check_limits(stride: &SyntheticStride) {
    for (panel, pose) in stride.poses.iter().enumerate() {
        for i in 0..BONE_COUNT {
            let [low, high] = stride.chain.limits_rad[i];
            let (bend, name) = (pose[BENDS + i], &stride.horse.bones[i].name);
            let bend_deg = bend.to_degrees();
            assert!((low..=high).contains(&bend), "{} panel {panel} {name}: {bend_deg:.0}", named(stride));
        }
        assert!(pose[SLIDES..].iter().all(|slide| slide.abs() < 0.06));
    }
}

#[test]
fn stance_toes_rest_on_the_ground_and_swing_toes_are_over_it() {
    for seed in 0..20 {
        let stride = SyntheticStride::new(seed, 24);
        let mut prints: [Option<f64>; 4] = [None; 4];
        for panel in 0..48 {
            let (turn, panel) = (panel / 24, panel % 24);
            let k = stride.kinematics(panel);
            for limb in Limb::ALL {
                let [x, y] = k.place(Attachment::Tip(limb.hoof_bone()));
                let x = x + turn as f64 * stride.speed_m_s * stride.stride_time_s;
                let print = &mut prints[limb.index()];
                if !stride.down[panel][limb.index()] {
                    assert!(y > -0.01, "seed {seed} {limb:?} panel {panel}: {y:.3} m");
                    *print = None;
                    continue;
                }
                let slid = x - *print.get_or_insert(x);
                assert!(
                    y.abs() < 1e-6 && slid.abs() < 1e-6,
                    "seed {seed} {limb:?} panel {panel}: {y} {slid}"
                );
            }
        }
    }
}

#[test]
fn bends_and_slides_stay_within_the_limits() {
    (0..20).for_each(|seed| check_limits(&SyntheticStride::new(seed, 24)));
    every_motion(64).for_each(|stride| check_limits(&stride));
}

#[test]
fn every_hoof_stands_on_its_print_and_clears_the_ground_between() {
    for stride in every_motion(1) {
        let prints = stride.hoof_prints();
        for k in 0..200 {
            let time_s = stride.stride_time_s * f64::from(k) / 200.0;
            let posed = stride.posed_at(time_s);
            for limb in Limb::ALL {
                let [x, y, z] = toe(&posed, limb);
                let print =
                    prints.iter().find(|p| p.limb == limb && (p.strike_s..p.lift_off_s).contains(&time_s));
                assert_eq!(print.is_some(), posed.down[limb.index()], "{} {limb:?}", named(&stride));
                match print {
                    Some(HoofPrint { toe: [px, py, pz], .. }) => assert!(
                        (x - px).abs() < 1e-6 && (y - py).abs() < 1e-6 && z == *pz,
                        "{} {limb:?} at {time_s:.3} s slid by {} and sank to {y}",
                        named(&stride),
                        x - px
                    ),
                    // A toe comes down and leaves without speed, to a tenth of a millimetre.
                    None => assert!(y > -1e-4, "{} {limb:?} at {time_s:.3} s: {y} m", named(&stride)),
                }
            }
        }
    }
}

#[test]
fn forelegs_are_straight_while_they_carry_and_hooves_leave_the_ground_by_a_hand() {
    for stride in every_motion(64) {
        for limb in Limb::ALL {
            let knee = BENDS + limb.first_bone() + 3;
            let (mut highest_m, mut most_bent) = (0.0f64, 0.0f64);
            for (panel, pose) in stride.poses.iter().enumerate() {
                highest_m = highest_m.max(toe(&stride.posed(panel), limb)[1]);
                if stride.down[panel][limb.index()] && limb.pair() == Pair::Fore {
                    most_bent = most_bent.max(pose[knee].abs().to_degrees());
                }
            }
            assert!(most_bent < 10.0, "{} {limb:?}: knee {most_bent:.0} degrees", named(&stride));
            assert!(highest_m > 0.07, "{} {limb:?}: hoof up to {highest_m:.3} m", named(&stride));
        }
    }
}

/// Contacts of a stride as the detector takes them, exact.
fn contacts(stride: &SyntheticStride) -> [LegContact; 4] {
    let prints = stride.hoof_prints();
    Limb::ALL.map(|limb| {
        let print = prints.iter().find(|print| print.limb == limb).unwrap();
        let instant =
            |time_s: f64| ContactInstant { phase: (time_s / stride.stride_time_s).rem_euclid(1.0), sd: 1e-6 };
        LegContact { limb, strike: instant(print.strike_s), lift_off: instant(print.lift_off_s) }
    })
}

#[test]
fn the_detector_names_every_gait_and_its_lead() {
    for gait in gaits() {
        for seed in SEEDS {
            let stride = SyntheticStride::of_gait(gait, seed, 12);
            let analysis = GaitAnalysis::new(contacts(&stride), [stride.stride_time_s, 1e-6]);
            let name = named(&stride);
            assert!(analysis.implied.agrees_with(gait), "{name}: {}", analysis.implied.name());
            assert_eq!(analysis.lead, stride.lead, "{name}");
            let suspensions = match gait {
                Gait::Walk | Gait::Amble | Gait::Leap => 0,
                Gait::Canter | Gait::Gallop => 1,
                Gait::Trot | Gait::Rack => 2,
            };
            assert_eq!(analysis.suspensions.len(), suspensions, "{name}");
            if suspensions == 1 {
                assert!(analysis.suspensions[0].is_gathered(), "{name}");
            }
            if gait == Gait::Amble {
                let feet = |down: [bool; 4]| down.into_iter().filter(|d| *d).count();
                assert!(analysis.supports.iter().all(|s| (1..=2).contains(&feet(s.down))), "{name}");
            }
        }
    }
}

#[test]
fn speeds_strides_and_stances_are_those_of_real_horses() {
    // Speed m/s, stride m, hind duty factor: bands of the literature, widened for horses of 1.44 to 1.76 m.
    let bands = |gait| match gait {
        Gait::Walk => [[1.1, 2.1], [1.4, 2.0], [0.55, 0.75]],
        Gait::Amble => [[2.5, 4.0], [1.5, 2.3], [0.38, 0.5]],
        Gait::Trot => [[3.0, 4.5], [2.0, 2.9], [0.36, 0.45]],
        Gait::Rack => [[4.3, 6.0], [2.4, 3.4], [0.30, 0.42]],
        Gait::Canter => [[4.5, 7.0], [2.6, 3.7], [0.28, 0.40]],
        Gait::Gallop | Gait::Leap => [[10.0, 13.0], [4.5, 6.0], [0.20, 0.27]],
    };
    for gait in gaits() {
        for seed in SEEDS {
            let stride = SyntheticStride::of_gait(gait, seed, 12);
            let analysis = GaitAnalysis::new(contacts(&stride), [stride.stride_time_s, 1e-6]);
            let length_m = stride.speed_m_s * stride.stride_time_s;
            let found = [stride.speed_m_s, length_m, analysis.hind_duty_factor()];
            for (value, [low, high]) in found.into_iter().zip(bands(gait)) {
                assert!((low..=high).contains(&value), "{}: {found:?}", named(&stride));
            }
        }
    }
}

#[test]
fn a_walking_horse_sets_its_hind_hooves_on_or_ahead_of_the_fore_prints() {
    for seed in SEEDS {
        let stride = SyntheticStride::of_gait(Gait::Walk, seed, 12);
        let prints = stride.hoof_prints();
        let length_m = stride.speed_m_s * stride.stride_time_s;
        for (fore, hind) in [(Limb::LF, Limb::LH), (Limb::RF, Limb::RH)] {
            let x_m = |limb: Limb| prints.iter().find(|p| p.limb == limb).map(|p| p.toe[0]).unwrap();
            let ahead_m = (x_m(hind) - x_m(fore) + 0.5 * length_m).rem_euclid(length_m) - 0.5 * length_m;
            assert!((-0.05..0.35).contains(&ahead_m), "seed {seed} {hind:?}: {ahead_m:.2} m");
        }
    }
}

#[test]
fn motions_are_smooth_and_gaits_come_round() {
    for stride in every_motion(1).filter(|stride| stride.seed < 3) {
        // At a thousand frames a second no joint turns by more than the fastest do: 40 rad/s, a galloping fetlock.
        let frames = (stride.stride_time_s * 1000.0) as usize;
        let pose = |k: usize| stride.source.pose(k as f64 / 1000.0);
        for k in 0..frames {
            let (before, after) = (pose(k), pose(k + 1));
            for i in 0..BONE_COUNT {
                let turn = (after[BENDS + i] - before[BENDS + i]).abs();
                let name = &stride.horse.bones[i].name;
                assert!(turn < 0.06, "{} {name} at {k} ms turns by {turn:.3} rad", named(&stride));
            }
        }
        if stride.gait != Gait::Leap {
            let (first, next) = (stride.posed_at(0.0), stride.posed_at(stride.stride_time_s));
            let length_m = stride.speed_m_s * stride.stride_time_s;
            for (a, b) in first.bones.iter().flatten().zip(next.bones.iter().flatten()) {
                assert!((b[0] - a[0] - length_m).abs() < 1e-6 && (b[1] - a[1]).abs() < 1e-6);
            }
        }
    }
}

#[test]
fn panels_show_the_motion_with_near_hooves_in_the_plane_of_depth_zero() {
    for stride in every_motion(12) {
        for panel in [0, 5, 11] {
            let posed = stride.posed(panel);
            assert_eq!(posed, stride.posed_at(posed.time_s));
            assert_eq!(posed.down, stride.down[panel]);
            assert!(posed.croup[2] < 0.0 && posed.croup[2] == posed.dock[2]);
            for limb in Limb::ALL {
                let near = stride.facing.side(NearOff::Near) == limb.side();
                assert_eq!(toe(&posed, limb)[2].abs() < 1e-12, near, "{limb:?}");
            }
        }
    }
}

#[test]
fn a_leap_flies_over_its_hurdle() {
    for seed in SEEDS {
        let stride = SyntheticStride::of_gait(Gait::Leap, seed, 24);
        let hurdle = stride.hurdle.unwrap();
        let height = hurdle.height_m / f64::from(stride.horse.withers_height_m);
        assert!((0.48..0.60).contains(&height), "seed {seed}: {:.2} m", hurdle.height_m);
        let all_beyond =
            |posed: &Posed, sign: f64| posed.bones.iter().flatten().all(|p| sign * p[0] > sign * hurdle.x_m);
        assert!(all_beyond(&stride.posed_at(0.0), -1.0));
        assert!(all_beyond(&stride.posed_at(stride.stride_time_s), 1.0));
        for k in 0..2000 {
            let posed = stride.posed_at(stride.stride_time_s * f64::from(k) / 2000.0);
            for (i, [[x0, y0, _], [x1, y1, _]]) in posed.bones.into_iter().enumerate() {
                let share = (hurdle.x_m - x0) / (x1 - x0);
                if (0.0..=1.0).contains(&share) {
                    let y = y0 + share * (y1 - y0);
                    assert!(y > hurdle.height_m + 0.03, "seed {seed} bone {i} passes at {y:.2} m");
                }
            }
        }
    }
}

#[test]
fn a_leap_is_ballistic_between_push_off_and_landing() {
    for seed in SEEDS {
        let stride = SyntheticStride::of_gait(Gait::Leap, seed, 24);
        let prints = stride.hoof_prints();
        let hurdle_x_m = stride.hurdle.unwrap().x_m;
        let (before, after): (Vec<&HoofPrint>, Vec<&HoofPrint>) =
            prints.iter().partition(|print| print.toe[0] < hurdle_x_m);
        let pick = |prints: &[&HoofPrint], pair: Pair| -> Vec<HoofPrint> {
            prints.iter().filter(|p| p.limb.pair() == pair).map(|p| **p).collect()
        };
        let last_s = |prints: Vec<HoofPrint>| prints.iter().map(|p| p.lift_off_s).fold(f64::MIN, f64::max);
        let pushes: Vec<HoofPrint> =
            pick(&before, Pair::Hind).into_iter().filter(|p| p.strike_s > 0.1).collect();
        assert_eq!(pushes.len(), 2);
        assert!((pushes[0].lift_off_s - pushes[1].lift_off_s).abs() < 0.03, "hinds push together");
        assert!(pushes.iter().all(|p| p.lift_off_s > last_s(pick(&before, Pair::Fore)) + 0.15));
        let take_off_s = last_s(pushes);
        let landing = after.iter().min_by(|a, b| a.strike_s.total_cmp(&b.strike_s)).unwrap();
        let flight_s = landing.strike_s - take_off_s;
        assert!((0.4..0.52).contains(&flight_s), "seed {seed}: {flight_s:.2} s");
        assert_eq!(landing.limb, Limb::new(Pair::Fore, stride.lead.unwrap().fore.opposite()));
        assert!(pick(&after, Pair::Hind).iter().all(|p| p.strike_s > last_s(pick(&after, Pair::Fore))));
        let pitch_deg = |time_s: f64| stride.source.pose(time_s)[PITCH].to_degrees();
        assert!(pitch_deg(take_off_s) > 12.0 && pitch_deg(landing.strike_s) < -8.0);
        let mass = |share: f64| centre_of_mass(&stride, &stride.posed_at(take_off_s + share * flight_s));
        let [start, end] = [mass(0.0), mass(1.0)];
        for k in 1..20 {
            let share = f64::from(k) / 20.0;
            let [x, y] = mass(share);
            let straight = [0, 1].map(|axis| start[axis] + share * (end[axis] - start[axis]));
            let arch_m = 0.5 * 9.81 * flight_s * flight_s * share * (1.0 - share);
            assert!((x - straight[0]).abs() < 0.01, "seed {seed} {share}: {}", x - straight[0]);
            assert!(
                (y - straight[1] - arch_m).abs() < 0.01,
                "seed {seed} {share}: {}",
                y - straight[1] - arch_m
            );
        }
    }
}
