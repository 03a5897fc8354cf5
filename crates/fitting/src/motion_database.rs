//! From fitted plates to the motion database: captured strides, laws, and each gait at every speed (spec 4.3 to 5).

use muybridge_core::{
    BONE_COUNT, CURVE_SAMPLES, Contact, ContactLaw, Curves, DATABASE_SCHEMA, Database, Gait, LawKind, Limb,
    MPS_PER_MPH, Pair, PowerLaw, Provenance, Skeleton, SpeedSource, Stride,
};

use crate::chain::Attachment;
use crate::expansion::expand;
use crate::law::{ContactPoint, LawFit, fit_law, shift_law};
use crate::layout::{BENDS, PITCH, ROOT_X, ROOT_Y, SLIDES};
use crate::pipeline::{LEG_SHARE, PlateFit};
use crate::published;
use crate::stride_curves::StrideCurves;

/// Decimals kept in the file: a ten-thousandth of a radian is 0.02 mm at the end of a bone of 0.2 m.
const DECIMALS: i32 = 5;
/// With one capture the second point of the shifted curve lies at this multiple of its speed, as 9 mph to the amble's 7.
const SECOND_SPEED: f64 = 9.0 / 7.0;

/// A law with what was needed to fit it, for the report.
#[derive(Clone, Debug)]
pub struct GaitLaw {
    /// What goes into the database.
    pub law: ContactLaw,
    /// The data points.
    pub points: Vec<ContactPoint>,
    /// The fit with its statistics, where there are points enough.
    pub fit: Option<LawFit>,
}

/// Laws of every gait that has a capture or a published curve, ordered by gait, then kind.
pub fn gait_laws(fits: &[PlateFit]) -> Vec<GaitLaw> {
    let published = published::laws();
    let mut laws = Vec::new();
    for gait in Gait::ALL {
        for kind in LawKind::ALL {
            let of_gait: Vec<&PlateFit> = fits.iter().filter(|fit| fit.gait() == gait).collect();
            let printed = published.iter().find(|law| law.gait == gait && law.law == kind);
            laws.extend(captured_law(gait, kind, &of_gait, printed).or_else(|| {
                let law = printed?.clone();
                let clips = published::clips().into_iter().filter(|clip| clip.gait == gait);
                Some(GaitLaw { law, points: clips.map(|clip| clip.point()).collect(), fit: None })
            }));
        }
    }
    laws
}

fn captured_law(
    gait: Gait,
    kind: LawKind,
    fits: &[&PlateFit],
    printed: Option<&ContactLaw>,
) -> Option<GaitLaw> {
    let points: Vec<ContactPoint> = fits
        .iter()
        .map(|fit| match kind {
            LawKind::Support => fit.support_point(),
            LawKind::LimbFore => fit.limb_point(Pair::Fore),
            LawKind::LimbHind => fit.limb_point(Pair::Hind),
        })
        .collect();
    let (curve, fit, provenance) = match (fit_law(&points), points.as_slice()) {
        (Some(fit), _) => (fit.curve, Some(fit), captured(fits)),
        (None, []) => return None,
        (None, [first, ..]) => {
            let (parent, source) = parent_law(gait, kind, fits[0].withers_height_m, printed);
            let curve = shift_law(parent, *first, SECOND_SPEED * first.speed_m_s)?;
            let from = vec![format!("plate {}", fits[0].id()), source];
            let how = "one capture: the parent curve shifted in time to meet it (amble rule)".to_string();
            (curve, None, Provenance::Derived { from, how })
        }
    };
    let interval = fit.as_ref().and_then(|fit| fit.interval);
    let law = ContactLaw { gait, law: kind, curve, n: points.len(), interval, provenance };
    Some(GaitLaw { law, points, fit })
}

fn captured(fits: &[&PlateFit]) -> Provenance {
    let inferred = fits.iter().any(|fit| fit.calibration.speed_source == SpeedSource::Inferred);
    Provenance::Captured {
        plates: fits.iter().map(|fit| fit.id().to_string()).collect(),
        annotations_sha256: fits.iter().map(|fit| fit.plate.annotation_sha256.clone()).collect(),
        speed: if inferred { SpeedSource::Inferred } else { fits[0].calibration.speed_source },
    }
}

/// The curve a single capture borrows its shape from.
fn parent_law(
    gait: Gait,
    kind: LawKind,
    withers_height_m: f64,
    printed: Option<&ContactLaw>,
) -> (PowerLaw, String) {
    match (kind, gait, printed) {
        (LawKind::Support, _, Some(law)) => (law.curve, published::SOURCE.to_string()),
        (LawKind::LimbFore, Gait::Gallop, _) => {
            (PowerLaw { a: 0.82, b: -0.84 }, "galloping horses, forelimb (Witte et al. 2006)".to_string())
        }
        (LawKind::LimbHind, Gait::Gallop, _) => {
            (PowerLaw { a: 0.61, b: -0.66 }, "galloping horses, hind limb (Witte et al. 2006)".to_string())
        }
        _ => {
            let a = 0.80 * (LEG_SHARE * withers_height_m).powf(0.84);
            (
                PowerLaw { a, b: -0.87 },
                "one limb's stance across species (Hoyt, Wickler & Cogger 2000)".to_string(),
            )
        }
    }
}

/// The database of a set of fitted plates.
pub fn build_database(fits: &[PlateFit], skeleton: &Skeleton) -> Database {
    let laws: Vec<ContactLaw> = gait_laws(fits).into_iter().map(|law| rounded_law(law.law)).collect();
    let mut strides = Vec::new();
    for fit in fits {
        let captured = captured_stride(fit);
        strides.extend(expanded_strides(&captured, &laws, skeleton));
        strides.push(captured);
    }
    strides.sort_by(|a, b| {
        a.gait.cmp(&b.gait).then(a.speed_m_s.total_cmp(&b.speed_m_s)).then_with(|| a.id.cmp(&b.id))
    });
    Database { schema: DATABASE_SCHEMA, generator: "fit-gaits".into(), laws, strides }
}

/// The stride at every whole mile per hour of its gait's range, where the limb laws are known.
fn expanded_strides(captured: &Stride, laws: &[ContactLaw], skeleton: &Skeleton) -> Vec<Stride> {
    let curve = |kind| laws.iter().find(|l| l.gait == captured.gait && l.law == kind).map(|l| l.curve);
    let (Some(fore), Some(hind)) = (curve(LawKind::LimbFore), curve(LawKind::LimbHind)) else {
        return Vec::new();
    };
    let Some([low, high]) = captured.gait.speed_range_mph() else { return Vec::new() };
    (low as u32..=high as u32)
        .filter_map(|mph| {
            let mut stride = expand(captured, skeleton, [fore, hind], f64::from(mph) * MPS_PER_MPH)?;
            stride.id = format!("{}@{mph}mph", captured.id);
            round_stride(&mut stride);
            Some(stride)
        })
        .collect()
}

/// A fitted plate as a stride of the database; phase 0 is the strike of the left hind.
pub fn captured_stride(fit: &PlateFit) -> Stride {
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
        withers_height_m: fit.withers_height_m as f32,
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
