//! The numbers beside the footfall bar: gait, duty factors, contact times and what is missing for them.

use std::fmt;

use muybridge_capture::{Estimate, Facing, LEG_SHARE, Manifest, NearOff, PlateCalibration};
use muybridge_core::{ContactLaw, Gait, LawKind, Limb, Pair};

use super::{Edge, Footfalls, Lane, NoSpan};
use crate::contacts::{ContactInstant, LegContact};
use crate::gait_analysis::GaitAnalysis;

/// Standard gravity, m/s^2.
const GRAVITY: f64 = 9.80665;

/// Why a number is not there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Missing {
    /// A leg has no stance span.
    NeverDown(NearOff, Pair),
    /// A leg has no swing.
    NeverUp(NearOff, Pair),
    /// Near and off cannot be turned into left and right.
    Facing,
    /// The plate is not calibrated, so there are no seconds and metres.
    Calibration,
    /// No withers height, so no Froude number.
    WithersHeight,
    /// No law of this gait is known.
    Law(Gait),
}

/// Name of a leg for people: `near fore`, `off hind`, ...
pub fn leg_name(side: NearOff, pair: Pair) -> &'static str {
    match (side, pair) {
        (NearOff::Near, Pair::Fore) => "near fore",
        (NearOff::Off, Pair::Fore) => "off fore",
        (NearOff::Near, Pair::Hind) => "near hind",
        (NearOff::Off, Pair::Hind) => "off hind",
    }
}

impl fmt::Display for Missing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NeverDown(side, pair) => write!(f, "{} has no stance span yet", leg_name(*side, *pair)),
            Self::NeverUp(side, pair) => write!(f, "{} has no swing yet", leg_name(*side, *pair)),
            Self::Facing => write!(f, "the manifest does not say yet which way the animal faces"),
            Self::Calibration => {
                write!(f, "the plate is not calibrated yet, so there are no seconds and metres")
            }
            Self::WithersHeight => write!(f, "the withers height is not known yet"),
            Self::Law(gait) => write!(f, "there is no contact-time law of the {gait}"),
        }
    }
}

/// How far a measured contact time lies from a law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LawDistance {
    /// Which contact time.
    pub kind: LawKind,
    /// Measured, s.
    pub measured_s: f64,
    /// The law's at the plate's speed, s.
    pub law_s: f64,
}

impl LawDistance {
    /// Measured over the law's, minus one, in percent.
    pub fn percent(&self) -> f64 {
        100.0 * (self.measured_s / self.law_s - 1.0)
    }
}

/// What the footfalls say while they are being placed.
#[derive(Clone, Debug, PartialEq)]
pub struct LiveGait {
    /// Contacts, duty factors, Hildebrand's numbers, support sequence, implied gait and lead; its times are in strides
    /// where the stride time is unknown, so take those from here.
    pub analysis: GaitAnalysis,
    /// Panels after which the stride closes.
    pub stride_panels: f64,
    /// Stride time and its standard deviation, s.
    pub stride_time_s: Option<[f64; 2]>,
    /// Stride length and its standard deviation, m.
    pub stride_length_m: Option<[f64; 2]>,
    /// Mean forward speed, m/s.
    pub speed_m_s: Option<Estimate>,
    /// Mean stance time of a forelimb and its standard deviation, s.
    pub fore_contact_s: Option<[f64; 2]>,
    /// Mean stance time of a hind limb and its standard deviation, s.
    pub hind_contact_s: Option<[f64; 2]>,
    /// Time per stride with at least one hoof down and its standard deviation, s.
    pub support_s: Option<[f64; 2]>,
    /// Froude number.
    pub froude: Option<f64>,
    /// Distance from each known law of the gait.
    pub law_distances: Vec<LawDistance>,
    /// Why numbers are not there.
    pub missing: Vec<Missing>,
}

impl LiveGait {
    /// Works out the numbers; `withers_height_m` is a fit's, where there is one (else the calibration's or the
    /// manifest's is taken), `laws` a database's or the published ones.
    ///
    /// # Errors
    /// With everything that keeps the four contacts from being known.
    pub fn new(
        footfalls: &Footfalls,
        (manifest, gait): (&Manifest, Gait),
        calibration: Option<&PlateCalibration>,
        withers_height_m: Option<f64>,
        laws: &[ContactLaw],
    ) -> Result<Self, Vec<Missing>> {
        let contacts = contacts(footfalls, manifest.facing)?;
        let calibrated = calibration.zip(footfalls.clock.stride_time_s());
        let in_strides = [1.0, 0.0];
        let stride_time = calibrated.map_or(in_strides, |(calibration, [seconds, closing_sd_s])| {
            let interval = calibration.interval_s;
            [seconds, closing_sd_s.hypot(seconds * interval.sd / interval.value)]
        });
        let analysis = GaitAnalysis::new(contacts, stride_time);
        let mut live = Self {
            stride_panels: footfalls.clock.closes_after_panels(),
            analysis,
            stride_time_s: None,
            stride_length_m: None,
            speed_m_s: None,
            fore_contact_s: None,
            hind_contact_s: None,
            support_s: None,
            froude: None,
            law_distances: Vec::new(),
            missing: Vec::new(),
        };
        match calibrated {
            Some((calibration, [_, closing_sd_s])) => {
                live.in_seconds(calibration, closing_sd_s, (manifest, gait), withers_height_m, laws);
            }
            None => live.missing.push(Missing::Calibration),
        }
        Ok(live)
    }

    fn in_seconds(
        &mut self,
        calibration: &PlateCalibration,
        closing_sd_s: f64,
        (manifest, gait): (&Manifest, Gait),
        withers_height_m: Option<f64>,
        laws: &[ContactLaw],
    ) {
        let speed = calibration.speed_m_s;
        let time_s = self.analysis.stride_time_s;
        let length_m = speed.value * time_s[0];
        self.stride_time_s = Some(time_s);
        self.speed_m_s = Some(speed);
        // It comes from footprints and scale, not from the time.
        let closing = closing_sd_s / time_s[0];
        self.stride_length_m = Some([length_m, length_m * closing.hypot(calibration.scale_relative_sd)]);
        let [fore, hind] = [Pair::Fore, Pair::Hind].map(|pair| self.analysis.stance_s(pair));
        let support = self.analysis.support_s();
        (self.fore_contact_s, self.hind_contact_s, self.support_s) = (Some(fore), Some(hind), Some(support));
        let stated = manifest.calibration.as_ref().and_then(|c| c.scale.withers_height_m.as_ref());
        let height_m = withers_height_m
            .or(calibration.withers_height_m.map(|height| height.value))
            .or(stated.map(|known| known.value));
        self.froude = height_m.map(|height_m| speed.value.powi(2) / (GRAVITY * LEG_SHARE * height_m));
        self.missing.extend(height_m.is_none().then_some(Missing::WithersHeight));
        let of_gait = laws.iter().filter(|law| law.gait == gait);
        self.law_distances = of_gait
            .map(|law| LawDistance {
                kind: law.law,
                measured_s: match law.law {
                    LawKind::Support => support[0],
                    LawKind::LimbFore => fore[0],
                    LawKind::LimbHind => hind[0],
                },
                law_s: law.curve.contact_time_s(speed.value),
            })
            .collect();
        self.missing.extend(self.law_distances.is_empty().then_some(Missing::Law(gait)));
    }
}

/// Contacts in the order of [`Limb::ALL`]; of a leg with several stances in the stride the longest counts.
pub(crate) fn contacts(
    footfalls: &Footfalls,
    facing: Option<Facing>,
) -> Result<[LegContact; 4], Vec<Missing>> {
    let mut missing: Vec<Missing> = footfalls.lanes.iter().filter_map(missing_span).collect();
    let Some(facing) = facing else {
        missing.push(Missing::Facing);
        return Err(missing);
    };
    let contact = |limb: Limb| {
        let lane = footfalls.lane(facing.near_off(limb.side()), limb.pair());
        let span = lane.longest()?;
        let instant = |edge: &Edge| ContactInstant {
            phase: footfalls.clock.phase(edge.at_panel),
            sd: footfalls.clock.share(edge.at_panel, edge.sd_panels()),
        };
        Some(LegContact { limb, strike: instant(&span.strike), lift_off: instant(&span.lift_off) })
    };
    match Limb::ALL.map(contact) {
        [Some(lf), Some(rf), Some(lh), Some(rh)] => Ok([lf, rf, lh, rh]),
        _ => Err(missing),
    }
}

fn missing_span(lane: &Lane) -> Option<Missing> {
    Some(match lane.no_span? {
        NoSpan::NeverDown => Missing::NeverDown(lane.side, lane.pair),
        NoSpan::NeverUp => Missing::NeverUp(lane.side, lane.pair),
    })
}
