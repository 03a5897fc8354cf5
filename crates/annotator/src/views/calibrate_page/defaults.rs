//! What is assumed of a plate until somebody says better; always marked as assumed.

use muybridge_capture::{
    Calibration, Camera, Known, KnownLength, Parallax, Plane, Position, Scale, ScaleSource, Time, TimeSource,
};

use super::numbers::Quantity;

fn assumed(value: f64, sd: f64, why: &str) -> Known {
    Known { value, sd, assumed: true, from: format!("assumed: {why}") }
}

/// A value to begin with. Lengths of the battery and its intervals are those printed on the card of Sallie Gardner; heights
/// and speeds are a horse's.
pub(super) fn known(quantity: Quantity) -> Known {
    match quantity {
        Quantity::MarkSpacing => assumed(1.0, 0.1, "nobody has typed the length yet"),
        Quantity::WithersHeight => assumed(1.6, 0.1, "a usual height of a horse"),
        Quantity::ScaleRatio => assumed(1.1, 0.05, "a wall as far behind the track as Stanford's"),
        Quantity::CameraSpacing => assumed(0.6858, 0.02, "27 inches, as on Stanford's track in 1878"),
        Quantity::Advance => assumed(0.2, 0.1, "nobody has typed the advance yet"),
        Quantity::Interval => assumed(0.04, 0.01, "1/25 s, as on Stanford's track in 1878"),
        Quantity::Speed => assumed(4.0, 1.0, "nobody has typed the speed yet"),
        Quantity::StrideTime => assumed(0.6, 0.15, "a usual stride of a horse"),
        Quantity::CameraDistance => assumed(12.0, 3.0, "a battery about forty feet from the track"),
        Quantity::CameraHeight => assumed(1.2, 0.3, "about the height of the horse's trunk"),
    }
}

/// Corrects the words that go with a default when another value is typed in its place.
pub(super) fn note_typed(quantity: Quantity, typed: &mut Known) {
    if typed.from == known(quantity).from {
        typed.from = "assumed: typed without saying where it is from".into();
    }
}

/// A length between marks in the plane of the animal.
pub(super) fn known_length() -> KnownLength {
    KnownLength { mark_spacing_m: known(Quantity::MarkSpacing), plane: Plane::Track }
}

/// Distances that go with [`Quantity::ScaleRatio`].
pub(super) fn distances() -> Parallax {
    Parallax::Distances { camera_to_track_m: 12.0, camera_to_wall_m: 13.2 }
}

/// A row of cameras, the first opposite a mark.
pub(super) fn battery(first_axis_mark: f64) -> Position {
    Position::CameraSpacing { spacing_m: known(Quantity::CameraSpacing), first_axis_mark }
}

/// A whole calibration, of which only the kinds are known.
pub(super) fn calibration(scale: ScaleSource, position: Position, time: TimeSource) -> Calibration {
    let mut begun = Calibration {
        scale: Scale { driven_by: scale, known_length: None, withers_height_m: None },
        position,
        time: Time {
            driven_by: time,
            interval_s: None,
            intervals_s: None,
            speed_m_s: None,
            stride_time_s: None,
        },
        camera: Camera {
            distance_m: known(Quantity::CameraDistance),
            height_m: known(Quantity::CameraHeight),
        },
    };
    give_scale(&mut begun, scale);
    give_time(&mut begun, time);
    begun
}

/// Drives the scale by a source, which is assumed where it was not given.
pub(super) fn give_scale(calibration: &mut Calibration, source: ScaleSource) {
    let scale = &mut calibration.scale;
    scale.driven_by = source;
    match source {
        ScaleSource::KnownLength => drop(scale.known_length.get_or_insert_with(known_length)),
        ScaleSource::WithersHeight => {
            scale.withers_height_m.get_or_insert_with(|| known(Quantity::WithersHeight));
        }
    }
}

/// Drives the time by a source, which is assumed where it was not given.
pub(super) fn give_time(calibration: &mut Calibration, source: TimeSource) {
    let time = &mut calibration.time;
    time.driven_by = source;
    let (place, quantity) = match source {
        TimeSource::Interval => (&mut time.interval_s, Quantity::Interval),
        TimeSource::Speed => (&mut time.speed_m_s, Quantity::Speed),
        TimeSource::StrideTime => (&mut time.stride_time_s, Quantity::StrideTime),
        TimeSource::DynamicSimilarity => return,
    };
    place.get_or_insert_with(|| known(quantity));
}
