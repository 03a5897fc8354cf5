//! The ring of a stride's panels: where it closes, and the time of any place on it.

use muybridge_capture::{Annotation, PlateCalibration};

use crate::stride_fit::StrideTime;

/// A person tells the panel on which a stride closes to about a quarter of a panel.
const STATED_SD_PANELS: f64 = 0.25;
/// Taken from the number of panels, the stride may close half a panel earlier or later.
const COUNTED_SD_PANELS: f64 = 0.5;
/// Panels a stride may close after: fewer than two cannot show a swing and a stance, more than a thousand no plate has.
const CLOSING_PANELS: [f64; 2] = [2.0, 1000.0];

/// What says where the stride closes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ClosedBy {
    /// `stride.closes_after_panels`, said by a person.
    Annotation,
    /// The stride time of a fit.
    Fit,
    /// Nothing better than the number of panels.
    PanelCount,
}

/// Where the stride's panels stand in time, and after how many of them it closes.
#[derive(Clone, Debug, PartialEq)]
pub struct StrideClock {
    first: u32,
    last: u32,
    /// Time of each panel from the first to the last, s after the first; panels where no time is known.
    times: Vec<f64>,
    in_seconds: bool,
    closes_after_panels: f64,
    closes_sd_panels: f64,
    closed_by: ClosedBy,
}

impl StrideClock {
    /// The clock of an annotation. Without a calibration there are no seconds, and a fit's stride time says nothing.
    ///
    /// A person's word on where the stride closes comes before the fit's, and that before the number of panels.
    pub fn new(
        annotation: &Annotation,
        calibration: Option<&PlateCalibration>,
        fitted: Option<StrideTime>,
    ) -> Self {
        let first = annotation.stride.first;
        let last = annotation.stride.last.clamp(first, first.saturating_add(CLOSING_PANELS[1] as u32));
        let times = calibration.and_then(|calibration| seconds(first, last, calibration));
        let in_seconds = times.is_some();
        let times = times.unwrap_or_else(|| (0..=last - first).map(f64::from).collect());
        let mut clock = Self {
            first,
            last,
            in_seconds,
            closes_after_panels: f64::from(last - first) + 1.0,
            closes_sd_panels: COUNTED_SD_PANELS,
            closed_by: ClosedBy::PanelCount,
            times,
        };
        let fitted = fitted.filter(|time| in_seconds && time.seconds > 0.0);
        if let Some(panels) = annotation.stride.closes_after_panels {
            (clock.closes_after_panels, clock.closes_sd_panels) = (panels, STATED_SD_PANELS);
            clock.closed_by = ClosedBy::Annotation;
        } else if let Some(time) = fitted {
            let panels = clock.panel_at(time.seconds) - f64::from(first);
            (clock.closes_after_panels, clock.closes_sd_panels) = (panels, panels * time.sd_s / time.seconds);
            clock.closed_by = ClosedBy::Fit;
        }
        let [least, most] = CLOSING_PANELS;
        // A number that is none becomes the least.
        clock.closes_after_panels = clock.closes_after_panels.max(least).min(most);
        clock
    }

    /// First panel of the stride.
    pub fn first(&self) -> u32 {
        self.first
    }

    /// Last panel of the stride.
    pub fn last(&self) -> u32 {
        self.last
    }

    /// Panels after which the movement repeats.
    pub fn closes_after_panels(&self) -> f64 {
        self.closes_after_panels
    }

    /// What says so.
    pub fn closed_by(&self) -> ClosedBy {
        self.closed_by
    }

    /// Stride time and its standard deviation, s, as far as the place where the stride closes is in doubt; none
    /// without a calibration.
    pub fn stride_time_s(&self) -> Option<[f64; 2]> {
        let seconds = self.period();
        self.in_seconds.then(|| [seconds, seconds * self.closes_sd_panels / self.closes_after_panels])
    }

    /// Phase of a place, strides after the first panel, in `[0, 1)`.
    pub fn phase(&self, at_panel: f64) -> f64 {
        (self.time_at(self.first_panel() + self.after(self.first_panel(), at_panel)) / self.period())
            .rem_euclid(1.0)
    }

    /// How far a place lies after another around the ring, panels, at least 0 and less than a stride.
    pub fn after(&self, from_panel: f64, to_panel: f64) -> f64 {
        let after = (to_panel - from_panel).rem_euclid(self.closes_after_panels);
        // A difference a hair below zero is rounded up to a whole stride.
        if after < self.closes_after_panels { after } else { 0.0 }
    }

    /// Distance of two places around the ring, panels, the shorter way.
    pub(super) fn apart(&self, a: f64, b: f64) -> f64 {
        let after = self.after(a, b);
        after.min(self.closes_after_panels - after)
    }

    /// The place in the stride's first turn: from the first panel to less than where it closes.
    pub(crate) fn wrapped(&self, at_panel: f64) -> f64 {
        self.first_panel() + self.after(self.first_panel(), at_panel)
    }

    /// The panel nearest to a place.
    pub(crate) fn panel_near(&self, at_panel: f64) -> u32 {
        (self.wrapped(at_panel).round() as u32).min(self.last)
    }

    pub(super) fn first_panel(&self) -> f64 {
        f64::from(self.first)
    }

    /// Share of a stride that a number of panels takes at a place.
    pub(super) fn share(&self, at_panel: f64, panels: f64) -> f64 {
        let at = self.wrapped(at_panel);
        (self.time_at(at + 0.5 * panels) - self.time_at(at - 0.5 * panels)) / self.period()
    }

    /// Stride time, s or panels.
    fn period(&self) -> f64 {
        self.time_at(self.first_panel() + self.closes_after_panels)
    }

    /// Mean time between panels, s or panels.
    fn mean_interval(&self) -> f64 {
        let gaps = self.times.len().saturating_sub(1);
        self.times.last().map_or(1.0, |end| if gaps > 0 { end / gaps as f64 } else { 1.0 })
    }

    /// Time of any place: linear between panels, at the mean interval beyond them.
    fn time_at(&self, at_panel: f64) -> f64 {
        let at = at_panel - self.first_panel();
        let last = self.times.len() - 1;
        if at <= 0.0 {
            return at * self.mean_interval();
        }
        let before = at.floor() as usize;
        if before >= last {
            return self.times[last] + (at - last as f64) * self.mean_interval();
        }
        self.times[before] + (self.times[before + 1] - self.times[before]) * at.fract()
    }

    /// The place of a time from the first panel on.
    fn panel_at(&self, time: f64) -> f64 {
        let last = self.times.len() - 1;
        let after = self.times.partition_point(|t| *t <= time);
        let at = if after > last {
            last as f64 + (time - self.times[last]) / self.mean_interval()
        } else {
            let before = after.saturating_sub(1);
            before as f64 + (time - self.times[before]) / (self.times[after] - self.times[before])
        };
        self.first_panel() + at
    }
}

/// Time of every panel from the first to the last, s; panels left out of the stride lie on the line between their
/// neighbours. None when the ends have no time or times do not rise.
fn seconds(first: u32, last: u32, calibration: &PlateCalibration) -> Option<Vec<f64>> {
    let known: Vec<(u32, f64)> = calibration
        .stride
        .iter()
        .map(|camera| (camera.panel, camera.time_s))
        .filter(|(panel, _)| (first..=last).contains(panel))
        .collect();
    let rising = known.windows(2).all(|two| two[1].0 > two[0].0 && two[1].1 > two[0].1);
    let (start, end) = (known.first()?, known.last()?);
    if known.len() < 2 || !rising {
        return None;
    }
    let interval_s = (end.1 - start.1) / f64::from(end.0 - start.0);
    let time = |panel: u32| {
        let after = known.partition_point(|(known, _)| *known <= panel);
        match (after.checked_sub(1).map(|before| known[before]), known.get(after)) {
            (Some((a, ta)), Some(&(b, tb))) => ta + (tb - ta) * f64::from(panel - a) / f64::from(b - a),
            (Some((a, ta)), None) => ta + interval_s * f64::from(panel - a),
            (None, _) => start.1 - interval_s * f64::from(start.0 - panel),
        }
    };
    let times: Vec<f64> = (first..=last).map(time).collect();
    Some(times.iter().map(|t| t - times[0]).collect())
}
