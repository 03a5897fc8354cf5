//! Contact-time laws of every gait: from captures where they can tell, else with a borrowed exponent (spec 4.3).

use muybridge_capture::LEG_SHARE;
use muybridge_core::{ContactLaw, Gait, LawKind, MPS_PER_MPH, Pair, PowerLaw, Provenance, SpeedSource};

use crate::law::{ContactPoint, LawFit, fit_law, shift_law};
use crate::pipeline::PlateFit;
use crate::published;
use crate::tracked::strides::MeasuredStride;
use crate::tracked::walk_law::contact_points;

/// Exponent of a single limb's contact time over species, `t_c = 0.80 L^0.84 / v^0.87`.
const INTERSPECIFIC_EXPONENT: f64 = -0.87;
/// Where it is from.
const INTERSPECIFIC: &str = "one limb's stance across species (Hoyt, Wickler & Cogger 2000)";
/// With one capture the second point of the shifted curve lies at this multiple of its speed, as 9 mph to the amble's 7.
const SECOND_SPEED: f64 = 9.0 / 7.0;
/// Speed of the amble rule's first point, mph (Huang 2012, Fig. 3.10).
const AMBLE_MPH: f64 = 7.0;
/// Share of the stride an ambling foot is down at that speed. The amble's feet follow each other by a quarter of the stride
/// and one and two of them are down in turn, so the share lies between a quarter and a half. With this one it does so for
/// every leg of the walk that the amble is made from, at 6 mph (0.44 to 0.50) as at 9 (0.32 to 0.38).
const AMBLE_DUTY: f64 = 0.42;
/// Horses at one speed differ in stance time by about a tenth (scatter about the laws of Witte et al. 2006).
const BETWEEN_HORSES: f64 = 0.1;
/// An exponent that two captures leave more uncertain than this says less than the borrowed one.
const EXPONENT_SD: f64 = 0.2;

/// All that laws and strides are made from.
#[derive(Clone, Copy, Debug, Default)]
pub struct Evidence<'a> {
    /// Fitted plates.
    pub fits: &'a [PlateFit],
    /// Strides measured on tracked walks.
    pub walks: &'a [MeasuredStride],
    /// SHA-256 of the table they were read from, hexadecimal; empty without one.
    pub walks_sha256: &'a str,
}

impl<'a> Evidence<'a> {
    /// Plates of a gait, the one that stands for it first: whose speed is stated or measured before one whose speed is inferred,
    /// then the one with the surest speed.
    pub fn of_gait(&self, gait: Gait) -> Vec<&'a PlateFit> {
        let mut fits: Vec<&PlateFit> = self.fits.iter().filter(|fit| fit.gait() == gait).collect();
        let inferred = |fit: &PlateFit| fit.calibration.speed_source == SpeedSource::Inferred;
        let spread = |fit: &PlateFit| fit.calibration.speed_m_s.sd / fit.calibration.speed_m_s.value;
        fits.sort_by(|a, b| {
            inferred(a)
                .cmp(&inferred(b))
                .then(spread(a).total_cmp(&spread(b)))
                .then_with(|| a.id().cmp(b.id()))
        });
        fits
    }
}

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

/// Laws of every gait that has a capture, a rule or a published curve, ordered by gait, then kind.
pub fn gait_laws(evidence: &Evidence<'_>) -> Vec<GaitLaw> {
    let published = published::laws();
    let mut laws: Vec<GaitLaw> = Vec::new();
    for gait in Gait::ALL {
        for kind in LawKind::ALL {
            let printed = published.iter().find(|law| law.gait == gait && law.law == kind);
            let law = captured_law(gait, kind, evidence, printed)
                .or_else(|| amble_law(gait, kind, evidence, &laws))
                .or_else(|| Some(published_law(printed?)));
            laws.extend(law);
        }
    }
    laws
}

fn published_law(law: &ContactLaw) -> GaitLaw {
    let clips = published::clips().into_iter().filter(|clip| clip.gait == law.gait);
    GaitLaw { law: law.clone(), points: clips.map(|clip| clip.point()).collect(), fit: None }
}

/// A contact time with the relative standard deviation of a law's `a` through it.
struct Measured {
    point: ContactPoint,
    relative_sd: f64,
}

fn measured(fit: &PlateFit, kind: LawKind) -> Measured {
    let (point, [time_s, sd_s]) = match kind {
        LawKind::Support => (fit.support_point(), fit.analysis.support_s()),
        LawKind::LimbFore => (fit.limb_point(Pair::Fore), fit.analysis.stance_s(Pair::Fore)),
        LawKind::LimbHind => (fit.limb_point(Pair::Hind), fit.analysis.stance_s(Pair::Hind)),
    };
    // An error of the time scale moves time and speed against each other, along a curve of exponent -1: what is left is the
    // contacts' own error.
    let time_scale = fit.calibration.interval_s.sd / fit.calibration.interval_s.value;
    let contacts = ((sd_s / time_s).powi(2) - time_scale.powi(2)).max(0.0).sqrt();
    let along =
        (1.0 + INTERSPECIFIC_EXPONENT) * fit.calibration.speed_m_s.sd / fit.calibration.speed_m_s.value;
    Measured { point, relative_sd: contacts.hypot(along).hypot(BETWEEN_HORSES) }
}

fn captured_law(
    gait: Gait,
    kind: LawKind,
    evidence: &Evidence<'_>,
    printed: Option<&ContactLaw>,
) -> Option<GaitLaw> {
    let fits = evidence.of_gait(gait);
    let measured: Vec<Measured> = fits.iter().map(|fit| measured(fit, kind)).collect();
    let mut points: Vec<ContactPoint> = measured.iter().map(|m| m.point).collect();
    let mut provenance = captured(&fits);
    if let (Gait::Walk, Some(pair)) = (gait, pair_of(kind)) {
        let clips = contact_points(evidence.walks, pair);
        if !clips.is_empty() {
            provenance = with_walks(provenance, clips.len(), evidence.walks_sha256);
        }
        points.extend(clips);
    }
    let first = *points.first()?;
    let own = fit_law(&points).filter(|_| points.len() > 2 || tells_exponent(&measured));
    let n = points.len();
    if let Some(fit) = own {
        let law = ContactLaw {
            gait,
            law: kind,
            curve: fit.curve,
            n,
            interval: fit.interval,
            borrowed: None,
            provenance,
        };
        return Some(GaitLaw { law, points, fit: Some(fit) });
    }
    let (curve, source) = match (kind, printed) {
        (LawKind::Support, Some(law)) if n == 1 => {
            let shifted = shift_law(law.curve, first, SECOND_SPEED * first.speed_m_s)?;
            (shifted, format!("{}, shifted in time (amble rule)", published::SOURCE))
        }
        (LawKind::Support, Some(law)) => (through(&measured, law.curve.b), published::SOURCE.to_string()),
        _ => (through(&measured, INTERSPECIFIC_EXPONENT), INTERSPECIFIC.to_string()),
    };
    let law = ContactLaw { gait, law: kind, curve, n, interval: None, borrowed: Some(source), provenance };
    Some(GaitLaw { law, points, fit: None })
}

fn pair_of(kind: LawKind) -> Option<Pair> {
    match kind {
        LawKind::Support => None,
        LawKind::LimbFore => Some(Pair::Fore),
        LawKind::LimbHind => Some(Pair::Hind),
    }
}

/// Whether two captures tell an exponent better than the borrowed one does.
fn tells_exponent(measured: &[Measured]) -> bool {
    let [a, b] = measured else { return false };
    let apart = (a.point.speed_m_s / b.point.speed_m_s).ln().abs();
    a.relative_sd.hypot(b.relative_sd) < EXPONENT_SD * apart
}

/// The law of a given exponent through the captures' weighted mean in logarithms.
fn through(measured: &[Measured], b: f64) -> PowerLaw {
    let (sum, mass) = measured.iter().fold((0.0, 0.0), |(sum, mass), m| {
        let weight = m.relative_sd.powi(-2);
        (sum + weight * (m.point.contact_time_s.ln() - b * m.point.speed_m_s.ln()), mass + weight)
    });
    PowerLaw { a: (sum / mass).exp(), b }
}

/// The amble from the walk by the paper's rule: the walk's curve at 7 and 9 mph, both shifted so that at 7 mph the feet are
/// down for [`AMBLE_DUTY`] of a stride whose swing is the walk's.
fn amble_law(gait: Gait, kind: LawKind, evidence: &Evidence<'_>, laws: &[GaitLaw]) -> Option<GaitLaw> {
    let pair = pair_of(kind).filter(|_| gait == Gait::Amble)?;
    let walk = laws.iter().find(|law| law.law.gait == Gait::Walk && law.law.law == kind)?;
    let capture = *evidence.of_gait(Gait::Walk).first()?;
    let swing_s = capture.analysis.stride_time_s[0] - capture.analysis.stance_s(pair)[0];
    let speed_m_s = AMBLE_MPH * MPS_PER_MPH;
    let point = ContactPoint { speed_m_s, contact_time_s: swing_s * AMBLE_DUTY / (1.0 - AMBLE_DUTY) };
    let curve = shift_law(walk.law.curve, point, SECOND_SPEED * speed_m_s)?;
    let provenance = Provenance::Derived {
        from: vec![capture.id().to_string(), "the walk's limb law".into()],
        how: format!(
            "the walk's law shifted in time (amble rule, Huang 2012, Fig. 3.10) to a duty factor of {AMBLE_DUTY} at 7 mph, \
             at which one and two feet are down in turn"
        ),
    };
    let borrowed = Some("the walk's law, shifted in time (amble rule)".to_string());
    let law = ContactLaw { gait, law: kind, curve, n: 0, interval: None, borrowed, provenance };
    Some(GaitLaw { law, points: Vec::new(), fit: None })
}

/// Provenance of what was captured on these plates.
pub(crate) fn captured(fits: &[&PlateFit]) -> Provenance {
    let sources = || fits.iter().map(|fit| fit.calibration.speed_source);
    let least_sure = [SpeedSource::Inferred, SpeedSource::Measured, SpeedSource::Stated]
        .into_iter()
        .find(|source| sources().any(|of_plate| of_plate == *source));
    Provenance::Captured {
        plates: fits.iter().map(|fit| fit.id().to_string()).collect(),
        annotations_sha256: fits.iter().map(|fit| fit.plate.annotation_sha256.clone()).collect(),
        speed: least_sure.unwrap_or(SpeedSource::Measured),
    }
}

fn with_walks(provenance: Provenance, clips: usize, sha256: &str) -> Provenance {
    match provenance {
        Provenance::Captured { mut plates, mut annotations_sha256, speed } => {
            plates.push(format!("{clips} tracked walks"));
            annotations_sha256.push(sha256.to_string());
            Provenance::Captured { plates, annotations_sha256, speed }
        }
        other => other,
    }
}

/// Stance time that the interspecific law expects of a horse, s, to compare a capture with.
pub fn interspecific_stance_s(withers_height_m: f64, speed_m_s: f64) -> f64 {
    0.80 * (LEG_SHARE * withers_height_m).powf(0.84) * speed_m_s.powf(INTERSPECIFIC_EXPONENT)
}
