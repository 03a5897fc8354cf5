//! Every number of the calibration: its name, its unit, where it is kept.

use muybridge_capture::{Calibration, Draft, Known, Parallax, Plane, Position};

use super::defaults;
use super::units::{DURATIONS, LENGTHS, PLAIN, SPEEDS, Unit};

/// A quantity that is known with a standard deviation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(super) enum Quantity {
    MarkSpacing,
    WithersHeight,
    ScaleRatio,
    CameraSpacing,
    Advance,
    Interval,
    Speed,
    StrideTime,
    CameraDistance,
    CameraHeight,
}

impl Quantity {
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::MarkSpacing => "Known length",
            Self::WithersHeight => "Withers height",
            Self::ScaleRatio => "Track over wall",
            Self::CameraSpacing => "Camera spacing",
            Self::Advance => "Advance per panel",
            Self::Interval => "Interval",
            Self::Speed => "Speed",
            Self::StrideTime => "Stride time",
            Self::CameraDistance => "Distance",
            Self::CameraHeight => "Height",
        }
    }

    /// What it is, for somebody who meets it for the first time.
    pub(super) fn explanation(self) -> &'static str {
        match self {
            Self::MarkSpacing => "Distance between two neighbouring marks: those numbered n and n + 1",
            Self::WithersHeight => "Height of the withers over the ground when the animal stands",
            Self::ScaleRatio => "How many times as large a thing appears on the track as on the wall",
            Self::CameraSpacing => "Distance between neighbouring cameras of the row",
            Self::Advance => "How far the trunk moves on from one panel to the next",
            Self::Interval => "Time between two neighbouring panels; 1/25 may be typed",
            Self::Speed => "How fast the animal goes forward",
            Self::StrideTime => "Time until the movement repeats",
            Self::CameraDistance => "From the lens to the near legs",
            Self::CameraHeight => "Of the lens over the track",
        }
    }

    pub(super) fn units(self) -> &'static [Unit] {
        match self {
            Self::ScaleRatio => PLAIN,
            Self::Interval | Self::StrideTime => DURATIONS,
            Self::Speed => SPEEDS,
            _ => LENGTHS,
        }
    }

    pub(super) fn of(self, calibration: &Calibration) -> Option<&Known> {
        let (scale, time) = (&calibration.scale, &calibration.time);
        match self {
            Self::MarkSpacing => scale.known_length.as_ref().map(|length| &length.mark_spacing_m),
            Self::WithersHeight => scale.withers_height_m.as_ref(),
            Self::ScaleRatio => match scale.known_length.as_ref().map(|length| &length.plane) {
                Some(Plane::Wall(Parallax::Ratio(ratio))) => Some(ratio),
                _ => None,
            },
            Self::CameraSpacing => match &calibration.position {
                Position::CameraSpacing { spacing_m, .. } => Some(spacing_m),
                _ => None,
            },
            Self::Advance => match &calibration.position {
                Position::EvenAdvance { per_panel_m } => per_panel_m.as_ref(),
                _ => None,
            },
            Self::Interval => time.interval_s.as_ref(),
            Self::Speed => time.speed_m_s.as_ref(),
            Self::StrideTime => time.stride_time_s.as_ref(),
            Self::CameraDistance => Some(&calibration.camera.distance_m),
            Self::CameraHeight => Some(&calibration.camera.height_m),
        }
    }

    pub(super) fn of_mut(self, calibration: &mut Calibration) -> Option<&mut Known> {
        let (scale, time) = (&mut calibration.scale, &mut calibration.time);
        match self {
            Self::MarkSpacing => scale.known_length.as_mut().map(|length| &mut length.mark_spacing_m),
            Self::WithersHeight => scale.withers_height_m.as_mut(),
            Self::ScaleRatio => match scale.known_length.as_mut().map(|length| &mut length.plane) {
                Some(Plane::Wall(Parallax::Ratio(ratio))) => Some(ratio),
                _ => None,
            },
            Self::CameraSpacing => match &mut calibration.position {
                Position::CameraSpacing { spacing_m, .. } => Some(spacing_m),
                _ => None,
            },
            Self::Advance => match &mut calibration.position {
                Position::EvenAdvance { per_panel_m } => per_panel_m.as_mut(),
                _ => None,
            },
            Self::Interval => time.interval_s.as_mut(),
            Self::Speed => time.speed_m_s.as_mut(),
            Self::StrideTime => time.stride_time_s.as_mut(),
            Self::CameraDistance => Some(&mut calibration.camera.distance_m),
            Self::CameraHeight => Some(&mut calibration.camera.height_m),
        }
    }
}

/// A number that is typed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Number {
    Value(Quantity),
    Spread(Quantity),
    CameraToTrack,
    CameraToWall,
    FirstAxisMark,
    FixedMark,
    ClosesAfter,
    /// Number of a panel's mark, by its index.
    Mark(u32, usize),
}

impl Number {
    /// Name for people and for the undo list.
    pub(super) fn name(self) -> String {
        match self {
            Self::Value(quantity) => quantity.name().into(),
            Self::Spread(quantity) => format!("{}, standard deviation", quantity.name()),
            Self::CameraToTrack => "Camera to track".into(),
            Self::CameraToWall => "Camera to wall".into(),
            Self::FirstAxisMark => "First axis mark".into(),
            Self::FixedMark => "Fixed mark".into(),
            Self::ClosesAfter => "Closes after".into(),
            Self::Mark(_, index) => format!("Number of mark {}", index + 1),
        }
    }

    pub(super) fn units(self) -> &'static [Unit] {
        match self {
            Self::Value(quantity) | Self::Spread(quantity) => quantity.units(),
            Self::CameraToTrack | Self::CameraToWall => LENGTHS,
            Self::FirstAxisMark | Self::FixedMark | Self::ClosesAfter | Self::Mark(..) => PLAIN,
        }
    }

    /// The number, in the file's unit, where there is one.
    pub(super) fn get(self, draft: &Draft) -> Option<f64> {
        let calibration = draft.manifest.calibration.as_ref();
        match self {
            Self::Value(quantity) => Some(quantity.of(calibration?)?.value),
            Self::Spread(quantity) => Some(quantity.of(calibration?)?.sd),
            Self::CameraToTrack | Self::CameraToWall => {
                match &calibration?.scale.known_length.as_ref()?.plane {
                    Plane::Wall(Parallax::Distances { camera_to_track_m, camera_to_wall_m }) => {
                        Some(if self == Self::CameraToTrack { *camera_to_track_m } else { *camera_to_wall_m })
                    }
                    _ => None,
                }
            }
            Self::FirstAxisMark => match &calibration?.position {
                Position::CameraSpacing { first_axis_mark, .. } => Some(*first_axis_mark),
                _ => None,
            },
            Self::FixedMark => match &calibration?.position {
                Position::FixedMark { mark } => Some(*mark),
                _ => None,
            },
            Self::ClosesAfter => draft.annotation.stride.closes_after_panels,
            Self::Mark(panel, index) => Some(draft.panel(panel)?.marks.get(index)?.mark),
        }
    }

    /// Sets the number; nothing where there is no place for it.
    pub(super) fn set(self, draft: &mut Draft, value: f64) {
        if let Self::Mark(panel, index) = self {
            if let Some(mark) = draft.panel_mut(panel).marks.get_mut(index) {
                mark.mark = value;
            }
            return;
        }
        if self == Self::ClosesAfter {
            draft.annotation.stride.closes_after_panels = Some(value);
            return;
        }
        let Some(calibration) = &mut draft.manifest.calibration else { return };
        let place = match self {
            Self::Value(quantity) => quantity.of_mut(calibration).map(|known| {
                defaults::note_typed(quantity, known);
                &mut known.value
            }),
            Self::Spread(quantity) => quantity.of_mut(calibration).map(|known| &mut known.sd),
            _ => self.place_mut(calibration),
        };
        if let Some(place) = place {
            *place = value;
        }
    }

    fn place_mut(self, calibration: &mut Calibration) -> Option<&mut f64> {
        let wall = calibration.scale.known_length.as_mut().map(|length| &mut length.plane);
        match (self, wall, &mut calibration.position) {
            (Self::CameraToTrack, Some(Plane::Wall(Parallax::Distances { camera_to_track_m, .. })), _) => {
                Some(camera_to_track_m)
            }
            (Self::CameraToWall, Some(Plane::Wall(Parallax::Distances { camera_to_wall_m, .. })), _) => {
                Some(camera_to_wall_m)
            }
            (Self::FirstAxisMark, _, Position::CameraSpacing { first_axis_mark, .. }) => {
                Some(first_axis_mark)
            }
            (Self::FixedMark, _, Position::FixedMark { mark }) => Some(mark),
            _ => None,
        }
    }
}
