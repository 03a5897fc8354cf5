//! From fitted plates to the motion database: captured strides, laws, and each gait at every speed (spec 4.3 to 5).

use muybridge_core::{
    BONE_COUNT, CURVE_SAMPLES, Contact, ContactLaw, Curves, DATABASE_SCHEMA, Database, Gait, LawKind, Limb,
    MPS_PER_MPH, Pair, PowerLaw, Provenance, Skeleton, Stride,
};

use crate::chain::Attachment;
use crate::derived_leap::leap;
use crate::expansion::{Pace, expand};
use crate::gait_laws::{Evidence, captured, gait_laws};
use crate::layout::{BENDS, PITCH, ROOT_X, ROOT_Y, SLIDES};
use crate::pipeline::PlateFit;
use crate::stride_curves::StrideCurves;

/// Decimals kept in the file: what [`muybridge_core::CURVE_STEP`] keeps of the curves.
const DECIMALS: i32 = 4;

/// The database of all that is known.
pub fn build_database(evidence: &Evidence<'_>, skeleton: &Skeleton) -> Database {
    let laws: Vec<ContactLaw> = gait_laws(evidence).into_iter().map(|law| rounded_law(law.law)).collect();
    let mut strides: Vec<Stride> = Vec::new();
    for gait in Gait::ALL {
        let captures: Vec<Stride> =
            evidence.of_gait(gait).into_iter().map(|fit| captured_stride(fit, skeleton)).collect();
        if let Some(standing_for_it) = captures.first() {
            strides.extend(expanded_strides(standing_for_it, &laws, skeleton));
        }
        strides.extend(captures);
    }
    strides.extend(ambles(&strides, &laws, skeleton));
    strides.extend(derived_leap(&strides, skeleton));
    strides.sort_by(|a, b| {
        a.gait.cmp(&b.gait).then(a.speed_m_s.total_cmp(&b.speed_m_s)).then_with(|| a.id.cmp(&b.id))
    });
    Database { schema: DATABASE_SCHEMA, generator: "fit-gaits".into(), laws, strides }
}

/// Limb laws of a gait, fore and hind.
fn limb_laws(laws: &[ContactLaw], gait: Gait) -> Option<[PowerLaw; 2]> {
    let curve = |kind| laws.iter().find(|l| l.gait == gait && l.law == kind).map(|l| l.curve);
    Some([curve(LawKind::LimbFore)?, curve(LawKind::LimbHind)?])
}

/// Speeds of a gait's range at whole miles per hour, with their number.
fn speeds_m_s(gait: Gait) -> impl Iterator<Item = (u32, f64)> {
    let [low, high] = gait.speed_range_mph().unwrap_or([1.0, 0.0]);
    (low as u32..=high as u32).map(|mph| (mph, f64::from(mph) * MPS_PER_MPH))
}

/// The stride at every whole mile per hour of its gait's range, where the limb laws are known.
fn expanded_strides(captured: &Stride, laws: &[ContactLaw], skeleton: &Skeleton) -> Vec<Stride> {
    let Some(laws) = limb_laws(laws, captured.gait) else { return Vec::new() };
    let own = laws.map(|law| law.contact_time_s(f64::from(captured.speed_m_s)));
    speeds_m_s(captured.gait)
        .filter_map(|(mph, speed_m_s)| {
            let stance_ratios = [0, 1].map(|pair| laws[pair].contact_time_s(speed_m_s) / own[pair]);
            let mut stride = expand(captured, skeleton, Pace { speed_m_s, stance_ratios })?;
            stride.id = format!("{}@{mph}mph", captured.id);
            round_stride(&mut stride);
            Some(stride)
        })
        .collect()
}

/// The amble at every whole mile per hour, from the walk that stands for its gait; nothing where an amble was captured.
fn ambles(strides: &[Stride], laws: &[ContactLaw], skeleton: &Skeleton) -> Vec<Stride> {
    let walk = first_capture(strides, Gait::Walk);
    let known = strides.iter().any(|stride| stride.gait == Gait::Amble);
    let (Some(walk), Some(laws), false) = (walk, limb_laws(laws, Gait::Amble), known) else {
        return Vec::new();
    };
    let stance_s = [Pair::Fore, Pair::Hind].map(|pair| {
        let of_pair = Limb::ALL.into_iter().filter(|limb| limb.pair() == pair);
        let duty: f64 = of_pair.map(|limb| f64::from(walk.contacts[limb.index()].duty_factor())).sum();
        0.5 * duty * f64::from(walk.stride_time_s)
    });
    speeds_m_s(Gait::Amble)
        .filter_map(|(mph, speed_m_s)| {
            let stance_ratios = [0, 1].map(|pair| laws[pair].contact_time_s(speed_m_s) / stance_s[pair]);
            let mut stride = expand(walk, skeleton, Pace { speed_m_s, stance_ratios })?;
            stride.gait = Gait::Amble;
            stride.id = format!("amble-of-{}@{mph}mph", walk.id);
            stride.provenance = Provenance::Derived {
                from: vec![walk.id.clone()],
                how: format!(
                    "no plate shows an amble: the walk's limb paths and footfall order at {speed_m_s:.1} m/s, with the amble's \
                     stance times (amble rule)"
                ),
            };
            round_stride(&mut stride);
            Some(stride)
        })
        .collect()
}

/// The leap from the gallop that stands for its gait; nothing where a leap was captured.
fn derived_leap(strides: &[Stride], skeleton: &Skeleton) -> Option<Stride> {
    if strides.iter().any(|stride| stride.gait == Gait::Leap) {
        return None;
    }
    let mut stride = leap(first_capture(strides, Gait::Gallop)?, skeleton)?;
    round_stride(&mut stride);
    Some(stride)
}

/// The capture that stands for a gait: they come in that order.
fn first_capture(strides: &[Stride], gait: Gait) -> Option<&Stride> {
    strides.iter().find(|s| s.gait == gait && matches!(s.provenance, Provenance::Captured { .. }))
}

/// A fitted plate as a stride of the database; phase 0 is the strike of the left hind.
pub fn captured_stride(fit: &PlateFit, skeleton: &Skeleton) -> Stride {
    let curves = StrideCurves::new(&fit.fit);
    let origin = fit.analysis.contacts[Limb::LH.index()].strike.phase;
    let sample = |dof: usize, mean: f64| -> Vec<f32> {
        (0..CURVE_SAMPLES)
            .map(|k| (curves.channel(dof, origin + k as f64 / CURVE_SAMPLES as f64) - mean) as f32)
            .collect()
    };
    // The surge is counted from the root's place at phase 0, so that prints are, too.
    let start_m = curves.channel(ROOT_X, origin);
    let contacts = Limb::ALL.map(|limb| {
        let contact = &fit.analysis.contacts[limb.index()];
        let phase = |p: f64| round((p - origin).rem_euclid(1.0) as f32);
        Contact { strike_phase: phase(contact.strike.phase), lift_off_phase: phase(contact.lift_off.phase) }
    });
    let prints_m = Limb::ALL.map(|limb| {
        let contact = &fit.analysis.contacts[limb.index()];
        let strike = (contact.strike.phase - origin).rem_euclid(1.0);
        let middle = origin + strike + 0.5 * contact.duty_factor();
        let [x, _] = curves.kinematics(middle).place(Attachment::Tip(limb.hoof_bone()));
        (x - start_m - origin * fit.fit.problem.stride_length_m) as f32
    });
    let shared = fit.fit.shared();
    let mut stride = Stride {
        id: fit.id().to_string(),
        gait: fit.gait(),
        lead: fit.analysis.lead,
        speed_m_s: fit.calibration.speed_m_s.value as f32,
        stride_time_s: fit.fit.stride_time.seconds as f32,
        withers_height_m: fit.fit.withers_height_m(skeleton) as f32,
        bone_lengths_m: (0..BONE_COUNT)
            .map(|bone| fit.fit.problem.bone_length_m(bone, shared) as f32)
            .collect(),
        contacts,
        prints_m,
        curves: Curves {
            surge_m: sample(ROOT_X, start_m),
            height_m: sample(ROOT_Y, 0.0),
            pitch_rad: sample(PITCH, 0.0),
            bends_rad: (0..BONE_COUNT).map(|bone| sample(BENDS + bone, 0.0)).collect(),
            scapula_slides_m: vec![sample(SLIDES, 0.0), sample(SLIDES + 1, 0.0)],
        },
        provenance: captured(&[fit]),
    };
    round_stride(&mut stride);
    stride
}

fn round(value: f32) -> f32 {
    let factor = 10f64.powi(DECIMALS);
    // Adding zero turns a negative zero into a plain one.
    ((f64::from(value) * factor).round() / factor) as f32 + 0.0
}

fn round_stride(stride: &mut Stride) {
    let curves = &mut stride.curves;
    let scalars = [&mut stride.speed_m_s, &mut stride.stride_time_s, &mut stride.withers_height_m];
    let lists =
        [&mut curves.surge_m, &mut curves.height_m, &mut curves.pitch_rad, &mut stride.bone_lengths_m];
    let rest = curves.bends_rad.iter_mut().chain(&mut curves.scapula_slides_m);
    let numbers = lists.into_iter().chain(rest).flatten();
    for value in scalars.into_iter().chain(numbers).chain(&mut stride.prints_m) {
        *value = round(*value);
    }
    for contact in &mut stride.contacts {
        contact.strike_phase = round(contact.strike_phase);
        contact.lift_off_phase = round(contact.lift_off_phase);
    }
}

/// Six significant digits, more than any interval supports.
fn rounded_law(mut law: ContactLaw) -> ContactLaw {
    let six = |v: f64| format!("{v:.5e}").parse().unwrap_or(v);
    law.curve = PowerLaw { a: six(law.curve.a), b: six(law.curve.b) };
    if let Some(interval) = &mut law.interval {
        interval.a = interval.a.map(six);
        interval.b = interval.b.map(six);
    }
    law
}
