//! A walk of known truth filmed by a camera that stands still: what comes back, and what is refused.

use std::f64::consts::TAU;
use std::path::Path;

use muybridge_capture::{BodyPoint, Facing, Keypoint, LimbJoint, NearOff, Plate, calibrate};
use muybridge_core::{Gait, Pair, Side};

use super::naming::{Landmark, NAMINGS};
use super::*;

/// Advance in a stride and duty factor of the walk, withers heights.
const ADVANCE: f64 = 1.2;
const DUTY: f64 = 0.62;
const PERIOD: f64 = 52.3;
const FRAMES: usize = 215;
/// Distance of the legs from the median plane, withers heights; the camera is 10 withers heights away.
const HALF_WIDTH: f64 = 0.06;

/// How the film was made.
struct Film {
    /// 1 to the right, -1 to the left.
    direction: f64,
    /// How fast the trunk goes through the picture, of [`ADVANCE`].
    advances: f64,
    /// Whether the legs move.
    moves: bool,
    /// Scatter of a point, withers heights.
    scatter: f64,
}

const FILM: Film = Film { direction: 1.0, advances: 1.0, moves: true, scatter: 0.005 };

/// Where a landmark is, forward of the trunk's middle and above the ground, withers heights.
fn truth(landmark: Landmark, turns: f64) -> [f64; 2] {
    let bob = |share: f64| share * (2.0 * TAU * turns).sin();
    let joint = |side: Side, pair: Pair, joint: LimbJoint| {
        let lag = if side == Side::Left { 0.5 } else { 0.0 } + if pair == Pair::Fore { 0.25 } else { 0.0 };
        let root = if pair == Pair::Fore { [0.3, 0.68] } else { [-0.2, 0.65] };
        let hoof = hoof(turns + lag);
        let share = [0.0, 0.3, 0.6, 0.9, 1.0][joint as usize];
        [root[0] + share * hoof[0], root[1] + share * (hoof[1] - root[1])]
    };
    match landmark {
        Landmark::Body(BodyPoint::Withers) => [0.27, 1.0 + bob(0.01)],
        Landmark::Body(BodyPoint::Croup) => [-0.27, 0.98 - bob(0.01)],
        Landmark::Body(BodyPoint::Muzzle) => [0.9, 0.8 + bob(0.03)],
        Landmark::Body(_) => [0.8, 1.05 + bob(0.03)],
        Landmark::Near(pair, at) => joint(Side::Right, pair, at),
        Landmark::Own(side, pair, at) => joint(side, pair, at),
    }
}

/// A hoof against its hip: back with the ground, then forward through the air without a jerk.
fn hoof(turns: f64) -> [f64; 2] {
    let phase = turns.rem_euclid(1.0);
    let swept = ADVANCE * DUTY;
    if phase < DUTY {
        return [0.5 * swept - ADVANCE * phase, 0.0];
    }
    let swing = (phase - DUTY) / (1.0 - DUTY);
    // A straight line back, and forward by what that and the stance take.
    let forward = (swept + ADVANCE * (1.0 - DUTY)) * (swing - (TAU * swing).sin() / TAU);
    [-0.5 * swept - ADVANCE * (1.0 - DUTY) * swing + forward, 0.07 * (0.5 * TAU * swing).sin()]
}

/// Numbers between -1 and 1 that only look random.
struct Noise(u64);

impl Noise {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as f64 / f64::from(1u32 << 30) - 1.0
    }
}

/// The table of a film in the names of the labelled walk; the animal comes nearer, a tenth of the points is missing, some
/// are anywhere, and some hind hooves have each other's names.
fn table(film: &Film) -> String {
    let points = NAMINGS[1].points;
    let facing = if film.direction < 0.0 { Facing::Left } else { Facing::Right };
    let mut noise = Noise(5);
    let mut text = String::from("picture");
    for (name, _) in points {
        text += &format!(",{name}_x,{name}_y");
    }
    for frame in 0..FRAMES {
        text += &format!("\n{frame:04}.png");
        let turns = frame as f64 / PERIOD;
        let trunk = film.advances * ADVANCE * (turns - 0.5 * FRAMES as f64 / PERIOD);
        let swapped = film.moves && frame % 23 == 11;
        for (_, landmark) in points {
            let named = match landmark {
                Landmark::Own(side, Pair::Hind, LimbJoint::Hoof) if swapped => {
                    Landmark::Own(side.opposite(), Pair::Hind, LimbJoint::Hoof)
                }
                other => *other,
            };
            let at = truth(named, if film.moves { turns } else { 0.0 });
            let forward = trunk + at[0];
            let nearer = match landmark.keypoint(facing) {
                Keypoint::Limb(NearOff::Near, ..) => HALF_WIDTH,
                Keypoint::Limb(NearOff::Off, ..) => -HALF_WIDTH,
                Keypoint::Body(_) => 0.0,
            };
            let px_per_height = 1500.0 / (10.0 - 0.2 * forward - nearer);
            let mut scattered = |value: f64| value + film.scatter * noise.next();
            let x = 960.0 + film.direction * px_per_height * scattered(forward);
            let y = 500.0 + px_per_height * (0.6 - scattered(at[1]));
            let chance = noise.next();
            let is_leg = matches!(landmark, Landmark::Own(..));
            text += &match () {
                () if chance > 0.8 => ",,".to_string(),
                () if is_leg && chance < -0.96 => format!(",{:.2},{:.2}", x + 60.0, y - 50.0),
                () => format!(",{x:.2},{y:.2}"),
            };
        }
    }
    text
}

fn clip(film: &Film) -> Clip {
    Clip::parse("film.csv".into(), "0".repeat(64), table(film).as_bytes()).unwrap()
}

/// Distances of the mean from the truth, worst last, withers heights.
fn errors(film: &Film) -> (MeanStride, Vec<f64>) {
    let clip = clip(film);
    let mean = MeanStride::new(&clip, Gait::Walk).unwrap();
    let mut errors = Vec::new();
    for (landmark, _) in &clip.tracks {
        // The poll is not where the table's point is.
        if *landmark == Landmark::Body(BodyPoint::Poll) {
            continue;
        }
        let keypoint = landmark.keypoint(mean.facing);
        let point = mean.points.iter().find(|point| point.keypoint == keypoint).unwrap();
        for (k, place) in point.places.iter().enumerate() {
            let [x, y] = truth(*landmark, k as f64 / PHASES as f64 * mean.strides.period_frames / PERIOD);
            errors.push(place.map_or(1.0, |place| (place.at[0] - x).hypot(place.at[1] - y)));
        }
    }
    errors.sort_by(f64::total_cmp);
    (mean, errors)
}

#[test]
fn four_strides_with_noise_gaps_swaps_and_a_change_of_size_give_the_true_one() {
    for direction in [1.0, -1.0] {
        let (mean, errors) = errors(&Film { direction, ..FILM });
        assert!((mean.strides.period_frames - PERIOD).abs() < 0.1, "{:?}", mean.strides);
        assert!((mean.advance - ADVANCE).abs() < 0.02, "{}", mean.advance);
        assert!(mean.sizes[1][1] - mean.sizes[0][1] > 0.08, "the animal grows: {:?}", mean.sizes);
        let parallax = mean.parallax().unwrap() / (ADVANCE * 2.0 * HALF_WIDTH / 10.0);
        assert!(
            (0.7..1.3).contains(&parallax),
            "near legs overtake off legs: {parallax} of what they should"
        );
        assert!(mean.swaps >= 8, "{} swaps", mean.swaps);
        let (median, worst) = (errors[errors.len() / 2], errors[errors.len() - 1]);
        assert!(median < 0.006 && worst < 0.02, "median {median}, worst {worst} of withers height");
        for hoof in &mean.hooves {
            let duty = hoof.duty_factor().unwrap();
            // Two edges, each good to little more than a panel.
            assert!((duty - DUTY).abs() < 0.1, "{hoof:?}");
        }
    }
}

#[test]
fn the_spread_is_what_strides_differ_by() {
    let quiet = errors(&Film { scatter: 0.0, ..FILM }).0.spread();
    let noisy = errors(&Film { scatter: 0.02, ..FILM }).0.spread();
    assert!(noisy[0] > 2.0 * quiet[0], "{quiet:?} {noisy:?}");
}

#[test]
fn the_documents_are_a_plate_that_calibrates() {
    let clip = clip(&FILM);
    let mean = MeanStride::new(&clip, Gait::Walk).unwrap();
    let plan = Plan {
        id: "film".into(),
        gait: Gait::Walk,
        withers_height_m: 1.55,
        plate: "../plates/film.json".into(),
    };
    let (manifest, annotation) = documents(&clip, &mean, &plan);
    assert_eq!(documents(&clip, &mean, &plan), (manifest.clone(), annotation.clone()), "always the same");
    let paths = [Path::new("plates/film.json"), Path::new("annotations/film.json")];
    let plate = Plate::from_documents((paths[0], manifest), (paths[1], annotation)).unwrap();
    let calibration = calibrate(&plate.manifest, &plate.annotation).unwrap();
    let stride_m = calibration.speed_m_s.value * calibration.interval_s.value * PHASES as f64;
    assert!((stride_m / (ADVANCE * 1.55) - 1.0).abs() < 0.03, "{stride_m} m a stride");
    let poll = plate.annotation.panels[0].keypoints.get(Keypoint::Body(BodyPoint::Poll)).unwrap();
    assert_eq!(poll.state, muybridge_capture::KeypointState::Occluded, "it is a guess");
}

#[test]
fn a_clip_without_strides_says_so() {
    let refused = |film: &Film| MeanStride::new(&clip(film), Gait::Walk).unwrap_err();
    let standing = refused(&Film { moves: false, advances: 0.0, ..FILM });
    assert_eq!(standing, AverageFault::NoStride);
    assert!(standing.to_string().contains("no stride"), "{standing}");
    let followed = refused(&Film { advances: 0.0, ..FILM });
    assert_eq!(followed, AverageFault::NoAdvance);
}

#[test]
fn wrong_tables_are_errors_that_say_what_to_do() {
    let good = table(&FILM);
    let parse = |text: &str| Clip::parse("film.csv".into(), String::new(), text.as_bytes()).map(|_| ());
    let said = |text: &str| parse(text).unwrap_err().to_string();
    assert!(parse(&good).is_ok());
    assert!(said("").contains("empty"));
    assert!(said("a,b\n1,2").contains("in-hand trot needs, for one, nostril_x"));
    assert!(said(good.lines().next().unwrap()).contains("no frames"));
    assert!(said(&good.replacen("Elbow_x", "Hip_x", 1)).contains("Elbow_x"));
    assert!(said(&good.replacen("picture", "Nose_x", 1)).contains("column Nose_x must be there once"));
    assert!(said(&good.replace("0100.png", "0200.png")).contains("does not follow"));
    assert!(said(&good.replace("0100.png", "0100.png,1")).contains("cut off"));
    assert!(said(&good.replace("0100.png,", "0100.png,x")).contains("no number"));
    assert!(said(&good.replace("0100.png,", "0100.png,inf")).contains("no number"));
    let missing = Clip::read(Path::new("no/such/clip.csv")).unwrap_err().to_string();
    assert!(missing.contains("no/such/clip.csv") && missing.contains("cannot be read"), "{missing}");
}

#[test]
fn truncated_and_damaged_tables_never_panic() {
    let good = table(&FILM).into_bytes();
    let average = |bytes: &[u8]| {
        if let Ok(clip) = Clip::parse("film.csv".into(), String::new(), bytes) {
            let _ = MeanStride::new(&clip, Gait::Walk);
        }
    };
    let header = good.iter().position(|byte| *byte == b'\n').unwrap();
    for length in (0..header).step_by(53).chain((header..good.len()).step_by(4999)) {
        average(&good[..length]);
    }
    // Only rows of the first stride, at their ends.
    let lines: Vec<&[u8]> = good.split(|byte| *byte == b'\n').collect();
    for count in [2, 3, 5, 9, 20, 60, 110] {
        average(&lines[..count].join(&b'\n'));
    }
    let mut noise = Noise(9);
    for _ in 0..60 {
        let mut bytes = good.clone();
        for _ in 0..4 {
            let at = (0.5 * (noise.next() + 1.0) * bytes.len() as f64) as usize;
            bytes[at] = (128.0 * (noise.next() + 1.0)) as u8;
        }
        average(&bytes);
    }
}
