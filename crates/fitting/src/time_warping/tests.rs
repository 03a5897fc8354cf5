//! What the paper claims of its two warpings, on the embedded database.

use muybridge_core::MPS_PER_MPH;

use super::*;

const FRAME_RATE_HZ: f64 = 60.0;
const STARTS: usize = 40;
const GAITS: [Gait; 6] = [Gait::Walk, Gait::Amble, Gait::Trot, Gait::Rack, Gait::Canter, Gait::Gallop];

/// Every gait at the middle of its range.
fn motions() -> Vec<(Gait, WarpedMotion)> {
    let database = Database::embedded();
    let motion = |gait: Gait| {
        let [low, high] = gait.speed_range_mph().unwrap();
        let speed_m_s = (0.5 * (low + high) * MPS_PER_MPH) as f32;
        (gait, WarpedMotion::of(&database, gait, speed_m_s, FRAME_RATE_HZ).unwrap())
    };
    GAITS.map(motion).to_vec()
}

/// Runs on every pair of different gaits.
fn for_every_pair(mut run: impl FnMut(&str, &WarpedMotion, &WarpedMotion)) {
    let motions = motions();
    for (from_gait, from) in &motions {
        for (to_gait, to) in motions.iter().filter(|(gait, _)| gait != from_gait) {
            run(&format!("{from_gait} to {to_gait}"), from, to);
        }
    }
}

/// Changes of a pair from every phase of the stride.
fn changes<'a>(from: &'a WarpedMotion, to: &'a WarpedMotion) -> impl Iterator<Item = GaitChange<'a>> {
    let phase = |k: usize| k as f64 / STARTS as f64;
    (0..STARTS).map(move |k| GaitChange {
        from,
        to,
        start_frame: phase(k) * from.frames_per_stride(),
        reference: Limb::LH,
    })
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// How much the footfalls of two motions differ: the widest disagreement in when a leg strikes, once the best common shift is
/// taken off.
fn lag_difference(from: &WarpedMotion, to: &WarpedMotion) -> f64 {
    cyclic_spread(std::array::from_fn(|j| to.strikes[j] - from.strikes[j]))
}

fn last(warping: &Warping) -> &WarpedFrame {
    warping.frames.last().unwrap()
}

#[test]
fn generic_time_is_whole_at_strikes_half_at_lift_offs_and_turns_back() {
    for (gait, motion) in motions() {
        for limb in Limb::ALL {
            let [strike, lift_off, next] = motion.keytimes(limb);
            for (frame, expected) in [(strike, 0.0), (lift_off, 0.5), (next, 1.0)] {
                assert!((motion.generic_time(limb, frame) - expected).abs() < 1e-12, "{gait} {limb:?}");
            }
            let mut before = f64::NEG_INFINITY;
            for k in -150..300 {
                let frame = 0.37 * f64::from(k);
                let time = motion.generic_time(limb, frame);
                assert!(time > before, "{gait} {limb:?} runs back");
                assert!((motion.actual_frame(limb, time) - frame).abs() < 1e-9, "{gait} {limb:?}");
                before = time;
            }
        }
    }
}

#[test]
fn the_asynchronous_warping_brings_four_legs_to_one_moment() {
    for_every_pair(|name, from, to| {
        for change in changes(from, to) {
            let spread = last(&change.asynchronous()).spread();
            assert!(spread < 1e-9, "{name}: {spread}");
        }
    });
}

#[test]
fn it_does_so_with_any_leg_as_reference() {
    for_every_pair(|name, from, to| {
        for reference in Limb::ALL {
            for change in changes(from, to).step_by(7) {
                let spread = last(&GaitChange { reference, ..change }.asynchronous()).spread();
                assert!(spread < 1e-9, "{name}, {reference:?}: {spread}");
            }
        }
    });
}

#[test]
fn the_synchronous_warping_leaves_them_apart_where_footfalls_differ() {
    println!("                    lags differ  left apart, median (percent of the stride)");
    for_every_pair(|name, from, to| {
        let spreads: Vec<f64> =
            changes(from, to).map(|change| last(&change.synchronous()).spread()).collect();
        let (difference, apart) = (lag_difference(from, to), median(spreads));
        println!("{name:18} {:11.1} {:8.1}", 100.0 * difference, 100.0 * apart);
        // Walk and amble strike alike and differ in their stances alone: they come out near one another.
        let least = if difference > 0.05 { 0.08 } else { 0.003 };
        assert!(apart > least, "{name}: {apart}");
    });
}

#[test]
fn no_leg_strays_more_than_half_a_stride_and_none_goes_back() {
    let (mut unusual, mut paces) = (0, Vec::new());
    for_every_pair(|name, from, to| {
        for change in changes(from, to) {
            let warping = change.asynchronous();
            let sigma = warping.reference_sigma;
            assert!((2.0..=3.0).contains(&sigma), "{name}: {sigma} strides");
            for (leg, x) in warping.sigmas.iter().zip(warping.whole_strides) {
                assert!((leg - sigma).abs() <= 0.5 + 1e-9, "{name}: {leg} of {sigma}");
                unusual += usize::from(x != 2.0 && x != 3.0);
                paces.push((leg / sigma - 1.0).abs());
            }
            for pair in warping.frames.windows(2) {
                let grows = |j: usize| pair[1].generic_times[j] > pair[0].generic_times[j];
                assert!((0..4).all(grows), "{name}");
            }
        }
    });
    let fastest = paces.iter().copied().fold(0.0, f64::max);
    println!(
        "a leg's pace differs from the reference's by {:.3} (median), {fastest:.3} (most)",
        median(paces)
    );
    println!("x is neither 2 nor 3 for {unusual} of {} legs", 30 * STARTS * 4);
    assert!(unusual < 30 * STARTS * 4 / 100);
}

#[test]
fn a_change_begins_in_the_original_and_ends_in_the_target() {
    for_every_pair(|name, from, to| {
        for change in changes(from, to).step_by(5) {
            let warping = change.asynchronous();
            let start = change.start_frame / from.frames_per_stride();
            let first = &warping.frames[0];
            assert_eq!((first.target_weight, last(&warping).target_weight), (0.0, 1.0), "{name}");
            for j in 0..4 {
                let begins = (first.actual_frames[j] / from.frames_per_stride() - start).rem_euclid(1.0);
                assert!(begins.min(1.0 - begins) < 1e-9, "{name}: {begins}");
                let ends = last(&warping).actual_frames[j] / to.frames_per_stride();
                let off = (ends - last(&warping).target_phases[j]).rem_euclid(1.0);
                assert!(off.min(1.0 - off) < 1e-9, "{name}: {off}");
            }
        }
    });
}

/// Both warpings advance by the stride's average: within a stance or swing that is not the pace the leg had.
#[test]
fn the_papers_increments_begin_with_a_step_in_pace() {
    for (gait, motion) in motions() {
        let change = GaitChange { from: &motion, to: &motion, start_frame: 0.0, reference: Limb::LH };
        let warping = change.asynchronous();
        let gained = warping.frames[1].generic_times[2] - warping.frames[0].generic_times[2];
        let before = motion.generic_time(Limb::LH, 1.0) - motion.generic_time(Limb::LH, 0.0);
        let expected = 2.0 * motion.duty_factors()[Limb::LH.index()];
        println!("{gait}: a standing hind leg goes on at {:.2} of its pace", gained / before);
        assert!((gained / before - expected).abs() < 1e-9, "{gait}");
    }
}

#[test]
fn legs_without_keytimes_are_refused() {
    let contact = Contact { strike_phase: 0.2, lift_off_phase: 0.6 };
    let always = Contact { strike_phase: 0.2, lift_off_phase: 0.2 };
    assert!(WarpedMotion::new([contact; 4], 40).is_some());
    assert!(WarpedMotion::new([contact; 4], 0).is_none());
    assert!(WarpedMotion::new([contact, contact, always, contact], 40).is_none());
}

#[test]
fn spread_is_cyclic() {
    assert!((cyclic_spread([0.98, 0.03, 0.0, 0.01]) - 0.05).abs() < 1e-12);
    assert!((cyclic_spread([0.0, 0.25, 0.5, 0.75]) - 0.75).abs() < 1e-12);
    assert!(cyclic_spread([3.4, 0.4, -0.6, 0.4]) < 1e-12);
}
