//! When each panel was taken: from an interval, a speed, or a stride time; and what the others would have said.

use muybridge_core::SpeedSource;

use crate::annotation::PanelAnnotation;
use crate::calibration::{CalibrationError, Context, Disagreement, Estimate, PanelCamera};
use crate::even_advance::{TRUNK, trunk_places};
use crate::keypoint::Keypoint;
use crate::manifest::{Known, Position, TimeSource};
use crate::scales::{Scales, withers_px};
use crate::similarity::{LEG_SHARE, SimilarityLaw};
use crate::validation::SPEEDS_M_S;

/// A person tells the panel at which a stride closes to about a quarter of a panel.
pub const CLOSING_SD_PANELS: f64 = 0.25;

/// Times and speed of a stride's panels.
pub(crate) struct Timing {
    pub(crate) times_s: Vec<f64>,
    pub(crate) speed_m_s: Estimate,
    pub(crate) speed_source: SpeedSource,
    pub(crate) interval_s: Estimate,
    pub(crate) disagreements: Vec<Disagreement>,
}

pub(crate) fn panel_times(
    context: &Context<'_>,
    cameras: &[PanelCamera],
    scale: &Scales,
) -> Result<Timing, CalibrationError> {
    let scale_relative_sd = scale.relative_sd;
    let time = &context.calibration.time;
    let panels = context.stride_panels();
    let advance_m = trunk_advance(&panels, cameras);
    // Panels left out of the stride leave their intervals in it.
    let gaps =
        panels.first().zip(panels.last()).map_or(0.0, |(a, b)| f64::from(b.panel) - f64::from(a.panel));
    let distance_m = advance_m.last().copied().unwrap_or(0.0);
    let stated_interval = time.interval_s.as_ref().map(estimate);
    let stated_speed = time.speed_m_s.as_ref().map(estimate);
    let mut inferred_relative_sd = 0.0;
    let (times_s, speed_source) = match time.driven_by {
        TimeSource::Speed => {
            let speed = stated_speed.map_or(f64::NAN, |s| s.value);
            (advance_m.iter().map(|x| x / speed).collect::<Vec<_>>(), SpeedSource::Stated)
        }
        TimeSource::Interval => (interval_times(context, &panels), SpeedSource::Measured),
        TimeSource::StrideTime => (stride_times(context, &panels)?, SpeedSource::Measured),
        TimeSource::DynamicSimilarity => {
            let inferred = inferred_speed(context, cameras, scale, distance_m / gaps)?;
            let interval_s = distance_m / gaps / inferred.value;
            inferred_relative_sd = inferred.sd / inferred.value;
            let first = context.annotation.stride.first;
            let times = panels.iter().map(|panel| f64::from(panel.panel - first) * interval_s).collect();
            (times, SpeedSource::Inferred)
        }
    };
    require_rising(&panels, &times_s)?;
    let duration_s = times_s.last().copied().unwrap_or(0.0);
    let relative_time_sd = match time.driven_by {
        TimeSource::Speed => relative_sd(time.speed_m_s.as_ref()),
        TimeSource::Interval => relative_sd(time.interval_s.as_ref()),
        TimeSource::StrideTime => relative_sd(time.stride_time_s.as_ref()),
        TimeSource::DynamicSimilarity => inferred_relative_sd,
    };
    let interval_sd = match time.driven_by {
        TimeSource::Speed => relative_time_sd.hypot(scale_relative_sd),
        TimeSource::Interval | TimeSource::StrideTime | TimeSource::DynamicSimilarity => relative_time_sd,
    };
    let (interval, speed) = (duration_s / gaps, distance_m / duration_s);
    if !(speed > SPEEDS_M_S[0] && speed <= SPEEDS_M_S[1]) {
        return Err(CalibrationError::Contradiction(format!(
            "time: the trunk moves forward by {distance_m:.2} m in {duration_s:.3} s, which no horse does; \
             check the facing direction, the scale and the intervals"
        )));
    }
    let interval_s = Estimate { value: interval, sd: interval * interval_sd };
    let speed_sd = match time.driven_by {
        TimeSource::Speed | TimeSource::DynamicSimilarity => relative_time_sd,
        TimeSource::Interval | TimeSource::StrideTime => relative_time_sd.hypot(scale_relative_sd),
    };
    let speed_m_s = Estimate { value: speed, sd: speed.abs() * speed_sd };
    let mut disagreements = Vec::new();
    if let (TimeSource::Speed, Some(other)) = (time.driven_by, stated_interval) {
        let used = ("distance per panel over the stated speed".to_string(), interval_s);
        disagreements.push(Disagreement {
            quantity: "mean interval, s",
            used,
            other: ("stated interval".into(), other),
        });
    }
    if let (TimeSource::Speed, Some(interval), Position::CameraSpacing { spacing_m, .. }) =
        (time.driven_by, stated_interval, &context.calibration.position)
    {
        let value = spacing_m.value / interval.value;
        let sd = value * relative_sd(Some(spacing_m)).hypot(interval.sd / interval.value);
        let other = ("camera spacing over the stated interval".to_string(), Estimate { value, sd });
        disagreements.push(Disagreement {
            quantity: "speed, m/s",
            used: ("stated speed".into(), speed_m_s),
            other,
        });
    }
    if let (TimeSource::Interval | TimeSource::DynamicSimilarity, Some(other)) =
        (time.driven_by, stated_speed)
    {
        let used = match time.driven_by {
            TimeSource::Interval => "distance per panel over the stated interval",
            _ => "inferred by dynamic similarity",
        };
        let used = (used.to_string(), speed_m_s);
        disagreements.push(Disagreement {
            quantity: "speed, m/s",
            used,
            other: ("stated speed".into(), other),
        });
    }
    if let Position::CameraSpacing { spacing_m, .. } = &context.calibration.position {
        let per_panel = distance_m / gaps;
        disagreements.push(Disagreement {
            quantity: "distance per panel, m",
            used: (
                "measured on the trunk".into(),
                Estimate { value: per_panel, sd: per_panel * scale_relative_sd },
            ),
            other: ("camera spacing".into(), estimate(spacing_m)),
        });
    }
    Ok(Timing { times_s, speed_m_s, speed_source, interval_s, disagreements })
}

fn estimate(known: &Known) -> Estimate {
    Estimate { value: known.value, sd: known.sd }
}

fn relative_sd(known: Option<&Known>) -> f64 {
    known.map_or(0.0, |k| k.sd / k.value)
}

fn interval_times(context: &Context<'_>, panels: &[&PanelAnnotation]) -> Vec<f64> {
    let time = &context.calibration.time;
    let first = context.annotation.stride.first;
    panels
        .iter()
        .map(|panel| {
            let gaps = (panel.panel - first) as usize;
            match &time.intervals_s {
                Some(intervals) => intervals.iter().take(gaps).sum(),
                None => time.interval_s.as_ref().map_or(f64::NAN, |known| known.value * gaps as f64),
            }
        })
        .collect()
}

fn stride_times(context: &Context<'_>, panels: &[&PanelAnnotation]) -> Result<Vec<f64>, CalibrationError> {
    let stride_s = context.calibration.time.stride_time_s.as_ref().map_or(f64::NAN, |known| known.value);
    let closes = context.annotation.stride.closes_after_panels.ok_or_else(|| {
        CalibrationError::Contradiction(
            "time is driven by the stride time, so stride.closes_after_panels must say how many panels it spans".into(),
        )
    })?;
    let first = context.annotation.stride.first;
    Ok(panels.iter().map(|panel| f64::from(panel.panel - first) * stride_s / closes).collect())
}

/// The speed at which horses take strides of this length, from the even advance per panel, m.
fn inferred_speed(
    context: &Context<'_>,
    cameras: &[PanelCamera],
    scale: &Scales,
    per_panel_m: f64,
) -> Result<Estimate, CalibrationError> {
    let missing = CalibrationError::NoSimilarity;
    let gait = context.annotation.gait(context.manifest);
    let law = SimilarityLaw::of(gait).ok_or(missing("the length of a leap is not a gait's"))?;
    let panels = context.annotation.stride.closes_after_panels;
    let panels =
        panels.ok_or(missing("stride.closes_after_panels must say how many panels the stride spans"))?;
    let px_per_m = cameras.first().map_or(f64::NAN, |camera| camera.px_per_m);
    let withers_m = withers_px(context).map(|px| px / px_per_m);
    let stated = context.calibration.scale.withers_height_m.as_ref().map(|known| known.value);
    let leg_m = LEG_SHARE * stated.or(withers_m).ok_or(missing("the withers are placed in no panel"))?;
    let advance_sd = scale.advance_m(px_per_m).map_or(0.0, |advance| advance.sd / advance.value);
    let relative_sd = advance_sd.hypot(CLOSING_SD_PANELS / panels);
    let relative = per_panel_m * panels / leg_m;
    if !(relative.is_finite() && relative > 0.0) {
        return Err(CalibrationError::Contradiction(format!(
            "time: the trunk moves forward by {per_panel_m:.3} m per panel; check the facing direction and the scale"
        )));
    }
    let leg_m = Estimate { value: leg_m, sd: leg_m * scale.relative_sd };
    Ok(law.speed_m_s(Estimate { value: relative, sd: relative * relative_sd }, leg_m))
}

fn require_rising(panels: &[&PanelAnnotation], times_s: &[f64]) -> Result<(), CalibrationError> {
    for (two, panel) in times_s.windows(2).zip(panels.windows(2)) {
        let (a, b) = (panel[0].panel, panel[1].panel);
        let fault = if two[1] == two[0] {
            "have the same time"
        } else if two[1] > two[0] {
            continue;
        } else {
            "are out of order in time"
        };
        return Err(CalibrationError::Contradiction(format!(
            "time: panels {a} and {b} {fault}; check the intervals, the facing direction and the trunk points"
        )));
    }
    Ok(())
}

/// How far the trunk has come since the first panel, m.
fn trunk_advance(panels: &[&PanelAnnotation], cameras: &[PanelCamera]) -> Vec<f64> {
    let x_m: Vec<[Option<f64>; TRUNK.len()]> = panels
        .iter()
        .zip(cameras)
        .map(|(panel, camera)| {
            TRUNK.map(|point| {
                Some(camera.world_from_plate(panel.keypoints.place(Keypoint::Body(point))?, 0.0)[0])
            })
        })
        .collect();
    let mut places = trunk_places(&x_m);
    fill_gaps(&mut places);
    let start = places.first().copied().unwrap_or(0.0);
    places.iter().map(|place| place - start).collect()
}

/// Panels without any trunk point take the straight line between their neighbours; before the first and after the last
/// that have some, the mean advance goes on. So speed and distance are right before every panel is posed.
fn fill_gaps(places: &mut [f64]) {
    let known: Vec<(usize, f64)> =
        places.iter().copied().enumerate().filter(|(_, place)| place.is_finite()).collect();
    let mean_advance = match (known.first(), known.last()) {
        (Some(&(a, xa)), Some(&(b, xb))) if b > a => (xb - xa) / (b - a) as f64,
        _ => 0.0,
    };
    for i in 0..places.len() {
        if places[i].is_finite() {
            continue;
        }
        let before = known.iter().rev().find(|(k, _)| *k < i);
        let after = known.iter().find(|(k, _)| *k > i);
        places[i] = match (before, after) {
            (Some(&(a, xa)), Some(&(b, xb))) => xa + (xb - xa) * (i - a) as f64 / (b - a) as f64,
            (Some(&(a, x)), None) | (None, Some(&(a, x))) => x + mean_advance * (i as f64 - a as f64),
            (None, None) => 0.0,
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn panels_without_trunk_points_follow_the_others() {
        let mut places = [f64::NAN, 1.0, f64::NAN, f64::NAN, 4.0, f64::NAN];
        fill_gaps(&mut places);
        assert_eq!(places, [0.0, 1.0, 2.0, 3.0, 4.0, 5.0]);
        let mut alone = [f64::NAN, 3.0];
        fill_gaps(&mut alone);
        assert_eq!(alone, [3.0, 3.0]);
    }
}
