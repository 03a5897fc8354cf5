//! What a rider would look at in the derived leap.

use muybridge_core::{CURVE_SAMPLES, Contact, Curves, DATABASE_SCHEMA, Database, Pose, Side};

use super::*;
use crate::database_checks::{check_database, worst_foot_errors};

/// Instants looked at.
const LOOKS: usize = 480;

/// The captured gallops of the embedded database, and the first one in a mirror.
fn gallops() -> Vec<Stride> {
    let database = Database::embedded();
    let captured = |stride: &&Stride| stride.provenance.kind() == "captured";
    let mut gallops: Vec<Stride> = database.strides_of(Gait::Gallop).filter(captured).cloned().collect();
    gallops.push(mirrored(&gallops[0]));
    gallops
}

/// The gallop on the other lead, from the strike of what is then the left hind.
fn mirrored(gallop: &Stride) -> Stride {
    let start = gallop.contacts[Limb::RH.index()].strike_phase;
    let phase = |k: usize| k as f32 / CURVE_SAMPLES as f32;
    let poses: Vec<Pose> = (0..CURVE_SAMPLES).map(|k| gallop.pose(start + phase(k)).mirrored()).collect();
    let curve = |value: &dyn Fn(&Pose) -> f32| -> Vec<f32> { poses.iter().map(value).collect() };
    let from_start = |phase: f32| (phase - start).rem_euclid(1.0);
    let mirrored = Limb::ALL.map(|limb| {
        let twin = gallop.contacts[Limb::new(limb.pair(), limb.side().opposite()).index()];
        Contact {
            strike_phase: from_start(twin.strike_phase),
            lift_off_phase: from_start(twin.lift_off_phase),
        }
    });
    Stride {
        id: format!("{}-mirrored", gallop.id),
        lead: gallop.lead.map(|lead| Lead { fore: lead.fore.opposite(), hind: lead.hind.opposite() }),
        contacts: mirrored,
        curves: Curves {
            height_m: curve(&|pose| pose.root_in_world.y),
            pitch_rad: curve(&|pose| 2.0 * pose.world_from_root.z.atan2(pose.world_from_root.w)),
            bends_rad: (0..gallop.curves.bends_rad.len()).map(|i| curve(&|pose| pose.bends_rad[i])).collect(),
            scapula_slides_m: (0..2).map(|i| curve(&|pose| pose.scapula_slides_m[i])).collect(),
            ..gallop.curves.clone()
        },
        ..gallop.clone()
    }
}

/// Each gallop's leap as a database file keeps it.
fn leaps() -> Vec<(Stride, Skeleton)> {
    let reference = Skeleton::reference();
    let stored = |gallop: &Stride| {
        let text = serde_json::to_string(&leap(gallop, &reference).unwrap()).unwrap();
        let stride: Stride = serde_json::from_str(&text).unwrap();
        let skeleton = stride.skeleton(&reference);
        (stride, skeleton)
    };
    gallops().iter().map(stored).collect()
}

/// Take-off of the last hind and strike of the trailing fore, phases counted from the strike of the left hind.
fn flight(stride: &Stride) -> [f32; 2] {
    let lead = stride.lead.unwrap().fore;
    let of = |pair, side| stride.contacts[Limb::new(pair, side).index()];
    let last = [Side::Left, Side::Right].map(|side| of(Pair::Hind, side).lift_off_phase);
    [last[0].max(last[1]), of(Pair::Fore, lead.opposite()).strike_phase]
}

#[test]
fn it_pushes_off_both_hinds_flies_and_lands_on_the_trailing_fore() {
    for (stride, _) in leaps() {
        let lead = stride.lead.unwrap().fore;
        let fore = |side| stride.contacts[Limb::new(Pair::Fore, side).index()];
        let [take_off, touch_down] = flight(&stride);
        assert_eq!(stride.contacts[Limb::LH.index()].strike_phase, 0.0);
        let flight_s = (touch_down - take_off) * stride.stride_time_s;
        assert!((0.40..0.52).contains(&flight_s), "{}: {flight_s} s in the air", stride.id);
        assert!(
            fore(lead).strike_phase > touch_down
                && fore(lead).lift_off_phase > fore(lead.opposite()).lift_off_phase
        );
        let airborne = |k: &usize| stride.support(*k as f32 / LOOKS as f32) == [false; 4];
        let gathered = (0..LOOKS).filter(airborne).count() as f32 / LOOKS as f32 - (touch_down - take_off);
        assert!((-0.005..0.05).contains(&gathered), "{}: gathered for {gathered} of the leap", stride.id);
    }
}

#[test]
fn its_body_is_thrown() {
    for (stride, skeleton) in leaps() {
        let [take_off, touch_down] = flight(&stride);
        let height = |phase: f32| f64::from(stride.pose(phase).centre_of_mass(&skeleton).y);
        let step = 0.2 * (touch_down - take_off);
        let step_s = f64::from(step * stride.stride_time_s);
        for share in [0.35, 0.5, 0.65] {
            let phase = take_off + share * (touch_down - take_off);
            let fall =
                (height(phase - step) - 2.0 * height(phase) + height(phase + step)) / (step_s * step_s);
            assert!(
                (fall / -9.81 - 1.0).abs() < 0.02,
                "{}: {fall} m/s^2 at {share} of the flight",
                stride.id
            );
        }
        let rise_m = height(0.5 * (take_off + touch_down)) - height(take_off);
        assert!((0.2..0.35).contains(&rise_m), "{}: rises by {rise_m} m", stride.id);
    }
}

#[test]
fn nobody_finds_a_fault_in_it() {
    let reference = Skeleton::reference();
    let strides: Vec<Stride> = leaps().into_iter().map(|(stride, _)| stride).collect();
    for stride in &strides {
        let feet = worst_foot_errors(stride, &reference);
        assert!(
            feet.slide_m < 0.002 && feet.sink_m < 0.005 && feet.float_m < 0.005,
            "{}: {feet:?}",
            stride.id
        );
    }
    let database = Database { schema: DATABASE_SCHEMA, generator: String::new(), laws: Vec::new(), strides };
    let found: Vec<String> = check_database(&database, &reference).iter().map(ToString::to_string).collect();
    assert_eq!(found, [""; 0]);
}

#[test]
fn it_clears_a_fence_and_begins_again_where_it_ended() {
    for (stride, skeleton) in leaps() {
        let fence = Fence::under(&stride, &skeleton, FENCE);
        assert!(fence.height_m >= 0.5 * f64::from(stride.withers_height_m) - 1e-6);
        for k in 0..LOOKS {
            let joints = stride.pose(k as f32 / LOOKS as f32).joints(&skeleton);
            for (i, (base, tip)) in joints.bases.iter().zip(&joints.tips).enumerate() {
                let share = (fence.x_m as f32 - base.x) / (tip.x - base.x);
                let height_m = f64::from(base.y + share * (tip.y - base.y));
                let over = !(0.0..=1.0).contains(&share) || height_m > fence.height_m;
                assert!(over, "{}: {} passes the fence at {height_m} m", stride.id, skeleton.bones[i].name);
            }
        }
        let (start, end) = (stride.pose(0.0), stride.pose(1.0));
        let gap = end.root_in_world - start.root_in_world;
        assert!((gap.x - stride.stride_length_m()).abs() < 1e-6 && gap.y.abs() < 1e-6);
        assert!(start.bends_rad.iter().zip(&end.bends_rad).all(|(a, b)| (a - b).abs() < 1e-6));
    }
}

#[test]
fn a_horse_on_the_other_lead_leaps_as_its_mirror_image() {
    let leaps = leaps();
    let ((right, skeleton), (left, _)) = (&leaps[0], &leaps[leaps.len() - 1]);
    assert_eq!(left.lead.unwrap().fore, right.lead.unwrap().fore.opposite());
    let start = right.contacts[Limb::RH.index()].strike_phase;
    for k in 0..48 {
        let phase = k as f32 / 48.0;
        let there = right.pose(start + phase).mirrored().joints(skeleton);
        let here = left.pose(phase).joints(skeleton);
        let from_root = |joints: &muybridge_core::Joints, limb: Limb| joints.toe(limb) - joints.root;
        for limb in Limb::ALL {
            let apart_m = (from_root(&here, limb) - from_root(&there, limb)).length();
            assert!(apart_m < 0.05, "{limb:?} at {phase}: {apart_m} m");
        }
    }
}

#[test]
fn it_says_what_it_is_made_from() {
    for (stride, gallop) in leaps().iter().map(|(stride, _)| stride).zip(gallops()) {
        assert_eq!(stride.id, format!("leap-of-{}", gallop.id));
        let Provenance::Derived { from, how } = &stride.provenance else { panic!("{:?}", stride.provenance) };
        assert_eq!(from, &[gallop.id]);
        assert!(how.contains("no plate shows a leap") && how.contains("ballistic"), "{how}");
    }
}
