//! One plate from files to a fitted, analysed stride.

use std::path::{Path, PathBuf};

use muybridge_capture::{
    CLOSING_SD_PANELS, CalibrationError, LEG_SHARE, Plate, PlateCalibration, PlateError, calibrate,
};
use muybridge_core::{Gait, Pair, Skeleton};

use crate::contacts::{ContactError, find_contacts};
use crate::gait_analysis::GaitAnalysis;
use crate::held_out::held_out_errors;
use crate::law::ContactPoint;
use crate::observation::StrideObservation;
use crate::stride_fit::{PointResidual, StrideFit, StrideTime, fit_stride, fit_stride_of_unknown_time};
use crate::weights::Weights;

/// Standard gravity, m/s^2.
const GRAVITY: f64 = 9.80665;

/// A fitted plate.
#[derive(Clone, Debug)]
pub struct PlateFit {
    /// Its documents.
    pub plate: Plate,
    /// Its cameras and times.
    pub calibration: PlateCalibration,
    /// The fitted stride.
    pub fit: StrideFit,
    /// What its footfalls say.
    pub analysis: GaitAnalysis,
    /// Withers height percentages refer to: measured on a standing panel, else the fitted skeleton's, m.
    pub withers_height_m: f64,
    /// Residuals of all placed points, panel by panel.
    pub residuals: Vec<PointResidual>,
    /// Errors of points predicted without any point of their type; empty where that was not asked for.
    pub held_out: Vec<PointResidual>,
    /// Numbers outside what horses do, in words.
    pub warnings: Vec<String>,
}

/// Why a plate was not fitted.
#[derive(Debug, thiserror::Error)]
pub enum PlateFailure {
    /// Its documents are unreadable or wrong.
    #[error(transparent)]
    Documents(#[from] PlateError),
    /// It cannot be calibrated.
    #[error("{}: {cause}", path.display())]
    Calibration {
        /// The annotation.
        path: PathBuf,
        /// Cause.
        cause: CalibrationError,
    },
    /// Its contacts cannot be told.
    #[error("{}: {cause}", path.display())]
    Contacts {
        /// The annotation.
        path: PathBuf,
        /// Cause.
        cause: ContactError,
    },
}

/// Reads, calibrates, fits and analyses one annotated plate.
///
/// # Errors
/// When its documents are wrong, or calibration or contacts cannot be worked out from them.
pub fn fit_plate(
    annotation_path: &Path,
    skeleton: &Skeleton,
    weights: &Weights,
) -> Result<PlateFit, PlateFailure> {
    let mut fitted = fit_loaded(Plate::load(annotation_path)?, skeleton, weights)?;
    fitted.held_out = held_out_errors(skeleton, &fitted.fit, weights);
    Ok(fitted)
}

/// Calibrates, fits and analyses a plate that was loaded before, or is being worked on; nothing is held out.
///
/// # Errors
/// When calibration or contacts cannot be worked out.
pub fn fit_loaded(plate: Plate, skeleton: &Skeleton, weights: &Weights) -> Result<PlateFit, PlateFailure> {
    let path = || plate.annotation_path.clone();
    let calibration = calibrate(&plate.manifest, &plate.annotation)
        .map_err(|cause| PlateFailure::Calibration { path: path(), cause })?;
    let observation = StrideObservation::new(&plate, &calibration, weights);
    let fit = match known_stride_time(&plate, &observation) {
        Some(stride_time) => fit_stride(skeleton, &observation, stride_time, weights),
        None => fit_stride_of_unknown_time(skeleton, &observation, weights),
    };
    let withers_height_m =
        calibration.withers_height_m.map_or_else(|| fit.withers_height_m(skeleton), |height| height.value);
    let contacts = find_contacts(&fit, &plate.annotation.instants, withers_height_m)
        .map_err(|cause| PlateFailure::Contacts { path: path(), cause })?;
    let relative_time_sd = calibration.interval_s.sd / calibration.interval_s.value;
    let stride_s = fit.stride_time.seconds;
    let stride_sd = fit.stride_time.sd_s.hypot(stride_s * relative_time_sd);
    let analysis = GaitAnalysis::new(contacts, [stride_s, stride_sd]);
    let residuals = fit.residuals_of(&observation);
    let mut fitted = PlateFit {
        plate,
        calibration,
        fit,
        analysis,
        withers_height_m,
        residuals,
        held_out: Vec::new(),
        warnings: Vec::new(),
    };
    fitted.warnings = fitted.implausible();
    Ok(fitted)
}

/// The stride time that the annotation states: panels after which the movement closes, or the manifest's own.
fn known_stride_time(plate: &Plate, observation: &StrideObservation) -> Option<StrideTime> {
    let given = plate.calibration.time.stride_time_s.as_ref();
    let from_time = given.map(|known| StrideTime { seconds: known.value, sd_s: known.sd });
    let first = f64::from(plate.annotation.stride.first);
    let closes = plate.annotation.stride.closes_after_panels.and_then(|panels| {
        let time = |panel: f64| {
            observation.panels.iter().find(|p| f64::from(p.camera.panel) == panel).map(|p| p.camera.time_s)
        };
        let (start, last) = (observation.panels.first()?, observation.panels.last()?);
        let mean_interval = observation.duration_s() / f64::from(last.camera.panel - start.camera.panel);
        // After the last panel, time goes on as it did on the whole.
        let beyond = |panel: f64| last.camera.time_s + mean_interval * (panel - f64::from(last.camera.panel));
        let at = first + panels;
        // Far beyond what is placed so far the closing says little of the panels that are.
        if at > f64::from(last.camera.panel) + 1.0 {
            return None;
        }
        let low = time(at.floor()).unwrap_or_else(|| beyond(at.floor()));
        let high = time(at.ceil()).unwrap_or_else(|| beyond(at.ceil()));
        let seconds = low + (high - low) * at.fract() - start.camera.time_s;
        (seconds > 0.0).then_some(StrideTime { seconds, sd_s: CLOSING_SD_PANELS * seconds / panels })
    });
    closes.or(from_time)
}

impl PlateFit {
    /// The plate's identifier.
    pub fn id(&self) -> &str {
        &self.plate.manifest.id
    }

    /// Gait: as the annotator judged it from the footfalls, else as titled.
    pub fn gait(&self) -> Gait {
        self.plate.annotation.gait(&self.plate.manifest)
    }

    /// Gait as titled.
    pub fn titled(&self) -> Gait {
        self.plate.manifest.gait
    }

    /// Mean stance time of a pair against speed, as a data point.
    pub fn limb_point(&self, pair: Pair) -> ContactPoint {
        self.point(self.analysis.stance_s(pair)[0])
    }

    /// Support time against speed, as a data point.
    pub fn support_point(&self) -> ContactPoint {
        self.point(self.analysis.support_s()[0])
    }

    fn point(&self, contact_time_s: f64) -> ContactPoint {
        ContactPoint { speed_m_s: self.calibration.speed_m_s.value, contact_time_s }
    }

    /// Stride length with its standard deviation, m: it comes from footprints and scale, not from the time.
    pub fn stride_length_m(&self) -> [f64; 2] {
        let length = self.calibration.speed_m_s.value * self.fit.stride_time.seconds;
        let closing = self.fit.stride_time.sd_s / self.fit.stride_time.seconds;
        [length, length * closing.hypot(self.calibration.scale_relative_sd)]
    }

    /// Froude number `v^2 / (g L)` with the leg length `L`.
    pub fn froude(&self) -> f64 {
        self.calibration.speed_m_s.value.powi(2) / (GRAVITY * LEG_SHARE * self.withers_height_m)
    }

    /// Angle a stance limb of a pair sweeps, degrees.
    pub fn stance_sweep_deg(&self, pair: Pair) -> f64 {
        let step_m = self.calibration.speed_m_s.value * self.analysis.stance_s(pair)[0];
        2.0 * (0.5 * step_m / (LEG_SHARE * self.withers_height_m)).atan().to_degrees()
    }

    fn implausible(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        let implied = self.analysis.implied;
        for (gait, who) in [(self.titled(), "the title"), (self.gait(), "the annotation")] {
            if !implied.agrees_with(gait) && (who == "the title" || gait != self.titled()) {
                warnings.push(format!("footfalls imply a {}, {who} says {gait}", implied.name()));
            }
        }
        for (pair, name) in [(Pair::Fore, "fore"), (Pair::Hind, "hind")] {
            let sweep = self.stance_sweep_deg(pair);
            if sweep > 90.0 {
                warnings.push(format!(
                    "a {name} limb sweeps {sweep:.0} degrees in stance; more than 90 is not a limb's"
                ));
            }
        }
        let [low, high] = duty_factor_range(self.gait());
        for contact in &self.analysis.contacts {
            let duty = contact.duty_factor();
            if !(low..=high).contains(&duty) {
                let limb = contact.limb.abbreviation();
                warnings.push(format!(
                    "duty factor of {limb} is {duty:.2}; a {} has {low} to {high}",
                    self.gait()
                ));
            }
        }
        let ([froude_low, froude_high], froude) = (froude_range(self.gait()), self.froude());
        if !(froude_low..=froude_high).contains(&froude) {
            warnings.push(format!(
                "Froude number {froude:.2}; a {} has {froude_low} to {froude_high}",
                self.gait()
            ));
        }
        if !self.fit.optimum.converged {
            warnings.push("the fit stopped before it converged".into());
        }
        warnings
    }
}

/// Duty factors a gait is seen at, generous (Hildebrand's plots; Witte et al. 2006 for the gallop).
fn duty_factor_range(gait: Gait) -> [f64; 2] {
    match gait {
        Gait::Walk => [0.5, 0.8],
        Gait::Amble => [0.35, 0.65],
        Gait::Trot | Gait::Rack => [0.2, 0.55],
        Gait::Canter => [0.2, 0.5],
        Gait::Gallop => [0.14, 0.4],
        Gait::Leap => [0.05, 0.5],
    }
}

/// Froude numbers a gait is seen at, generous: walk to trot at 0.35 (Griffin et al. 2004), racing speed above 20.
fn froude_range(gait: Gait) -> [f64; 2] {
    match gait {
        Gait::Walk => [0.02, 0.6],
        Gait::Amble => [0.2, 2.5],
        Gait::Trot | Gait::Rack => [0.3, 14.0],
        Gait::Canter => [0.5, 12.0],
        Gait::Gallop | Gait::Leap => [2.0, 35.0],
    }
}
