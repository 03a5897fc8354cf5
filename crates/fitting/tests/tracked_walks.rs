//! Strides out of machine-tracked walks: a drawn walk whose contacts are known, and the sixty real clips.

use std::path::{Path, PathBuf};

use muybridge_core::{Limb, Pair, Side};
use muybridge_fitting::tracked::clip::{Clip, POINTS};
use muybridge_fitting::tracked::strides::{Flag, MeasuredStride};
use muybridge_fitting::tracked::table::{parse_table, read_table, write_table};
use muybridge_fitting::tracked::walk_law::WalkLaws;
use muybridge_fitting::tracked::{FRAMES_PER_S, Film, Measurement, measure, median};

/// Width of the drawn picture, px.
const WIDTH_PX: f64 = 2208.0;
/// Stride time, s; stride length, withers heights; duty factor of the drawn walk.
const STRIDE_S: f64 = 1.24;
const STRIDE_LENGTH: f64 = 1.15;
const DUTY_FACTOR: f64 = 0.67;
/// Angle at which the drawn track leads away, rad.
const OBLIQUE_RAD: f64 = 0.28;
/// Frames of the drawn clip.
const FRAMES: usize = 56;
/// Time in which the hoof rolls over its toe before the lift-off, and slides after the strike, s, with the distances
/// that the tracked point then is from its print, withers heights.
const BREAK_OVER: (f64, f64) = (0.13, 0.09);
const SLIDE: (f64, f64) = (0.06, 0.025);

/// Phase of a leg's strike in the lateral sequence.
fn strike_phase(limb: Limb) -> f64 {
    [0.25, 0.75, 0.0, 0.5][limb.index()]
}

/// Where a hoof is, along the track and above the ground, withers heights.
fn hoof(limb: Limb, time_s: f64) -> [f64; 2] {
    let phase = time_s / STRIDE_S - strike_phase(limb);
    let strides = phase.floor();
    let since_s = (phase - strides) * STRIDE_S;
    let shoulder = if limb.pair() == Pair::Fore { 0.0 } else { -0.65 };
    let print = (strides + strike_phase(limb) + 0.5 * DUTY_FACTOR) * STRIDE_LENGTH + shoulder;
    let (lift_off_s, swing_s) = (DUTY_FACTOR * STRIDE_S, (1.0 - DUTY_FACTOR) * STRIDE_S);
    let [slide, roll] = [(SLIDE, SLIDE.0 - since_s), (BREAK_OVER, since_s - lift_off_s + BREAK_OVER.0)]
        .map(|((time, distance), t)| distance * (t.max(0.0) / time).powi(2));
    if since_s <= lift_off_s {
        // Four fifths of the way to the side and three fifths up make the whole distance.
        return [print - 0.8 * slide + 0.8 * roll, 0.6 * (slide + roll)];
    }
    // A cubic from where the toe leaves the ground to where it comes down, with the speeds there.
    let s = (since_s - lift_off_s) / swing_s;
    let [a, b] = [s * (1.0 - s) * (1.0 - s), s * s * (s - 1.0)].map(|basis| basis * swing_s);
    let smooth = s * s * (3.0 - 2.0 * s);
    let [leave, arrive] = [BREAK_OVER, SLIDE].map(|(time, distance)| 2.0 * distance / time);
    let cubic = |from: f64, to: f64, from_speed: f64, to_speed: f64| {
        from + smooth * (to - from) + a * from_speed + b * to_speed
    };
    let along = cubic(0.8 * BREAK_OVER.1, STRIDE_LENGTH - 0.8 * SLIDE.1, 0.8 * leave, 0.8 * arrive);
    let up = cubic(0.6 * BREAK_OVER.1, 0.6 * SLIDE.1, 0.6 * leave, -0.6 * arrive);
    [print + along, up]
}

/// A clip that is drawn: camera 0.85 withers heights up, a track that leads away at an angle, to the left.
struct Drawing {
    /// Speed of the animal as a share of the walk's.
    pace: f64,
    /// Angle between the track and the plane of the picture, rad.
    angle_rad: f64,
    points: Vec<Vec<[f64; 3]>>,
    seed: u64,
}

impl Drawing {
    fn new(pace: f64, angle_rad: f64) -> Self {
        let mut drawing = Self { pace, angle_rad, points: Vec::new(), seed: 11 };
        for frame in 0..FRAMES {
            let row = POINTS.iter().map(|point| drawing.point(point, frame)).collect();
            drawing.points.push(row);
        }
        drawing
    }

    fn noise_px(&mut self) -> f64 {
        let mut sum = -6.0;
        for _ in 0..12 {
            self.seed = self.seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            sum += (self.seed >> 11) as f64 / (1u64 << 53) as f64;
        }
        1.5 * sum
    }

    fn point(&mut self, point: &str, frame: usize) -> [f64; 3] {
        let time_s = self.pace * frame as f64 / FRAMES_PER_S;
        let trunk = time_s * STRIDE_LENGTH / STRIDE_S;
        let limb = Limb::ALL.into_iter().find(|limb| {
            let side = if limb.side() == Side::Left { "Left" } else { "Right" };
            let pair = if limb.pair() == Pair::Fore { "FrontHoof" } else { "HindHoof" };
            point == format!("{side}{pair}")
        });
        let [along, up] = match (limb, point) {
            (Some(limb), _) => hoof(limb, time_s),
            (None, "Nostril") => [trunk + 1.1, 0.9],
            (None, "Withers") => [trunk, 1.0],
            (None, "Hip") => [trunk - 0.7, 1.0],
            _ => [trunk - 0.3, 0.5],
        };
        // The left side is the near one when the horse walks to the left.
        let near = limb.map_or(0.0, |limb| if limb.side() == Side::Left { 0.04 } else { -0.04 });
        let along = along - 1.4;
        let (sin, cos) = self.angle_rad.sin_cos();
        let [aside, deep] = [-(along * cos), 2.6 + along * sin - near];
        let x = 0.5 * WIDTH_PX + 1060.0 * aside / deep + self.noise_px();
        [x, 590.0 + 1060.0 * (0.85 - up) / deep + self.noise_px(), 0.97]
    }

    fn column(point: &str) -> usize {
        POINTS.iter().position(|name| *name == point).unwrap_or(POINTS.len())
    }

    /// Exchanges the labels of a pair in some frames.
    fn swap(&mut self, pair: &str, frames: std::ops::Range<usize>) {
        let [left, right] = ["Left", "Right"].map(|side| Self::column(&format!("{side}{pair}")));
        for row in &mut self.points[frames] {
            row.swap(left, right);
        }
    }

    fn set(&mut self, point: &str, frame: usize, value: [f64; 3]) {
        self.points[frame][Self::column(point)] = value;
    }

    /// The mirror image: left is right, and the horse walks to the right.
    fn mirrored(mut self) -> Self {
        for pair in ["Knee", "FrontFetlock", "FrontHoof", "Hock", "HindFetlock", "HindHoof"] {
            self.swap(pair, 0..FRAMES);
        }
        for point in self.points.iter_mut().flatten() {
            point[0] = WIDTH_PX - point[0];
        }
        self
    }

    fn measure(&self) -> Measurement {
        let mut text = String::new();
        for (name, cells) in
            [("scorer", [""; 3]), ("bodyparts", [""; 3]), ("coords", ["x", "y", "likelihood"])]
        {
            text.push_str(name);
            for point in POINTS {
                for cell in cells {
                    text.push(',');
                    text.push_str(if cell.is_empty() { point } else { cell });
                }
            }
            text.push('\n');
        }
        for (frame, row) in self.points.iter().enumerate() {
            let cells: Vec<String> = row.iter().flatten().map(|cell| format!("{cell:.3}")).collect();
            text.push_str(&format!("{frame},{}\n", cells.join(",")));
        }
        let clip = Clip::parse("drawn".into(), text.as_bytes()).unwrap_or_else(|fault| panic!("{fault}"));
        measure(&clip, &Film::at_rate(FRAMES_PER_S))
    }
}

/// The drawn walk with all that goes wrong in real clips.
fn troubled() -> Drawing {
    let mut drawing = Drawing::new(1.0, OBLIQUE_RAD);
    drawing.swap("HindHoof", 22..27);
    drawing.set("LeftFrontHoof", 12, [400.0, 300.0, 0.02]);
    drawing.set("LeftFrontHoof", 13, [450.0, 900.0, 0.03]);
    drawing.set("RightFrontHoof", 30, [1900.0, 400.0, 0.95]);
    drawing.set("Withers", 20, [300.0, 500.0, 0.9]);
    drawing.set("Hip", 33, [0.0, 0.0, 0.05]);
    drawing
}

/// Checks the contacts of a leg against the truth of the leg it shows, within half a frame.
fn check_contacts(measurement: &Measurement, seen: Limb, drawn: Limb) {
    let stances = &measurement.stances[seen.index()];
    let mut checked = 0;
    for stance in stances {
        let near = |frame: f64, phase: f64| {
            let stride = STRIDE_S * FRAMES_PER_S;
            let late = frame / stride - strike_phase(drawn) - phase;
            let frames = (late - late.round()) * stride;
            assert!(frames.abs() < 0.5, "{seen:?}: {stance:?} is {frames} frames late");
        };
        checked += stance.strike.frame().map_or(0, |frame| {
            near(frame, 0.0);
            1
        });
        checked += stance.lift_off.frame().map_or(0, |frame| {
            near(frame, DUTY_FACTOR);
            1
        });
    }
    assert!(checked >= 4, "{seen:?}: {stances:?}");
}

#[test]
fn a_drawn_walk_gives_back_its_contacts_through_noise_drop_outs_and_swaps() {
    let measurement = troubled().measure();
    assert_eq!((measurement.faults.swaps, measurement.faults.swapped_frames), (1, 5));
    assert_eq!((measurement.faults.drop_outs, measurement.faults.jumps), (3, 2));
    for limb in Limb::ALL {
        check_contacts(&measurement, limb, limb);
    }
    let usable: Vec<&MeasuredStride> =
        measurement.strides.iter().filter(|stride| stride.is_usable()).collect();
    assert!(usable.len() >= 4, "{:?}", measurement.strides);
    for stride in &usable {
        assert!((stride.duty_factor.unwrap() - DUTY_FACTOR).abs() < 0.04, "{stride:?}");
        assert!(
            (stride.stride_length_withers_heights.unwrap() / STRIDE_LENGTH - 1.0).abs() < 0.04,
            "{stride:?}"
        );
    }
    assert!(usable.iter().any(|stride| stride.limb.pair() == Pair::Hind && stride.swaps_mended == 1));
}

#[test]
fn a_walk_to_the_right_gives_the_same() {
    let left = troubled().measure();
    let right = troubled().mirrored().measure();
    assert_eq!(left.faults, right.faults);
    for limb in Limb::ALL {
        let other = Limb::new(limb.pair(), limb.side().opposite());
        check_contacts(&right, other, limb);
        let [a, b] = [&left.stances[limb.index()], &right.stances[other.index()]];
        assert_eq!(a.len(), b.len());
    }
}

#[test]
fn a_standing_horse_has_no_strides_and_it_says_why() {
    let measurement = Drawing::new(0.0, OBLIQUE_RAD).measure();
    assert!(measurement.stances.iter().all(Vec::is_empty));
    assert_eq!(measurement.strides.len(), 4);
    assert!(measurement.strides.iter().all(|stride| stride.flags == [Flag::Standing]));
}

#[test]
fn a_horse_that_backs_is_no_walk() {
    let mut drawing = Drawing::new(1.0, OBLIQUE_RAD);
    drawing.points.reverse();
    assert!(drawing.measure().strides.iter().all(|stride| stride.flags == [Flag::Backwards]));
}

#[test]
fn a_horse_that_walks_away_is_not_measured() {
    let measurement = Drawing::new(1.0, 1.2).measure();
    assert!(measurement.strides.iter().all(|stride| stride.flags == [Flag::TowardsOrAway]));
}

#[test]
fn nonsense_gives_a_table_that_can_be_read() {
    for seed in 1..40 {
        let mut drawing = Drawing { seed, ..Drawing::new(1.0, OBLIQUE_RAD) };
        // From slightly wrong to all over the place, and beyond any picture.
        let size_px = [20.0, 300.0, 5000.0, 1e300][seed as usize % 4];
        for frame in 0..FRAMES {
            for index in 0..POINTS.len() {
                if drawing.noise_px() > 0.0 {
                    for axis in 0..2 {
                        drawing.points[frame][index][axis] += size_px * drawing.noise_px();
                    }
                }
            }
        }
        let table = write_table(&drawing.measure().strides).unwrap();
        assert!(parse_table(std::str::from_utf8(&table).unwrap()).is_ok());
    }
}

fn shared_tracks() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/reference/tracked-walks");
    folder.is_dir().then_some(folder)
}

#[test]
fn the_real_clips_give_the_committed_table() {
    let Some(folder) = shared_tracks() else {
        println!("skipped: no shared tracks");
        return;
    };
    let mut paths: Vec<PathBuf> =
        std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|ending| ending == "csv"));
    paths.sort();
    assert_eq!(paths.len(), 60);
    let film = Film::at_rate(FRAMES_PER_S);
    let strides: Vec<MeasuredStride> =
        paths.iter().flat_map(|path| measure(&Clip::read(path).unwrap(), &film).strides).collect();
    let committed = std::fs::read(committed_table()).unwrap();
    assert!(write_table(&strides).unwrap() == committed, "write it again with `muybridge tracks measure`");
}

fn committed_table() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../annotations/tracked-walks.csv")
}

#[test]
fn the_committed_table_is_one_of_walks() {
    let strides = read_table(&committed_table()).unwrap();
    for pair in [Pair::Fore, Pair::Hind] {
        let usable = strides.iter().filter(|stride| stride.is_usable() && stride.limb.pair() == pair);
        let duty = median(usable.filter_map(|stride| stride.duty_factor).collect()).unwrap();
        assert!((0.55..=0.78).contains(&duty), "{pair:?}: {duty}");
    }
    let laws = WalkLaws::new(&strides).unwrap();
    for law in [laws.fore, laws.hind, laws.stride_time] {
        // Every time falls with speed, and the whole interval says so.
        assert!(law.interval.unwrap().b[1] < 0.0, "{law:?}");
    }
}
