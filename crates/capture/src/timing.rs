//! When each panel was taken: from an interval, a speed, or a stride time; and what the others would have said.

use muybridge_core::SpeedSource;

use crate::annotation::PanelAnnotation;
use crate::calibration::{CalibrationError, Context, Disagreement, Estimate, PanelCamera};
use crate::keypoint::{BodyPoint, Keypoint};
use crate::manifest::{Known, Position, TimeSource};
use crate::validation::SPEEDS_M_S;

/// Trunk points that ride with the body; head and neck nod.
const TRUNK: [BodyPoint; 4] = [BodyPoint::Withers, BodyPoint::Back, BodyPoint::Croup, BodyPoint::Dock];

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
    scale_relative_sd: f64,
) -> Result<Timing, CalibrationError> {
    let time = &context.calibration.time;
    let panels = context.stride_panels();
    let advance_m = trunk_advance(&panels, cameras);
    // Panels left out of the stride leave their intervals in it.
    let gaps =
        panels.first().zip(panels.last()).map_or(0.0, |(a, b)| f64::from(b.panel) - f64::from(a.panel));
    let distance_m = advance_m.last().copied().unwrap_or(0.0);
    let stated_interval = time.interval_s.as_ref().map(estimate);
    let stated_speed = time.speed_m_s.as_ref().map(estimate);
    let (times_s, speed_source) = match time.driven_by {
        TimeSource::Speed => {
            let speed = stated_speed.map_or(f64::NAN, |s| s.value);
            (advance_m.iter().map(|x| x / speed).collect::<Vec<_>>(), SpeedSource::Stated)
        }
        TimeSource::Interval => (interval_times(context, &panels), SpeedSource::Measured),
        TimeSource::StrideTime => (stride_times(context, &panels)?, SpeedSource::Measured),
    };
    require_rising(&panels, &times_s)?;
    let duration_s = times_s.last().copied().unwrap_or(0.0);
    let relative_time_sd = relative_sd(match time.driven_by {
        TimeSource::Speed => time.speed_m_s.as_ref(),
        TimeSource::Interval => time.interval_s.as_ref(),
        TimeSource::StrideTime => time.stride_time_s.as_ref(),
    });
    let interval_sd = match time.driven_by {
        TimeSource::Speed => relative_time_sd.hypot(scale_relative_sd),
        TimeSource::Interval | TimeSource::StrideTime => relative_time_sd,
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
        TimeSource::Speed => relative_time_sd,
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
    if let (TimeSource::Interval, Some(other)) = (time.driven_by, stated_speed) {
        let used = ("distance per panel over the stated interval".to_string(), speed_m_s);
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

/// How far the trunk has come since the first panel, m: an additive fit (panel + point) over all trunk points placed,
/// so that a point missing in one panel does not shift it.
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
    let mean = |values: &mut dyn Iterator<Item = f64>| {
        let (n, sum) = values.fold((0.0, 0.0), |(n, sum), v| (n + 1.0, sum + v));
        (n > 0.0).then(|| sum / n)
    };
    let mut offsets = [0.0; TRUNK.len()];
    let mut places = vec![0.0; panels.len()];
    // Alternating means converge geometrically; with points missing at random twenty rounds leave less than 1e-6 m.
    for _ in 0..20 {
        for (place, row) in places.iter_mut().zip(&x_m) {
            let mut known = row.iter().zip(&offsets).filter_map(|(x, offset)| x.map(|x| x - offset));
            *place = mean(&mut known).unwrap_or(f64::NAN);
        }
        for (k, offset) in offsets.iter_mut().enumerate() {
            let mut known = x_m
                .iter()
                .zip(&places)
                .filter_map(|(row, place)| row[k].map(|x| x - place))
                .filter(|v| v.is_finite());
            *offset = mean(&mut known).unwrap_or(0.0);
        }
    }
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
