//! The straight edge of one photograph, found on the plate itself to a fraction of a pixel.

use image::GrayImage;

use super::agree::KNOWN;
use super::fold::Fold;
use super::mount::Tones;
use super::strip::{SCAN_LINES, Strip, along};
use super::{Point, median};

/// Depth of the photograph just inside its edge that must differ from the mount, in panel sizes.
const RIM: f64 = 0.02;
/// Least depth, in samples.
const LEAST_RIM: usize = 3;
/// How far from its edge a ragged photograph may begin and still be seen there, in panel sizes, and in steps.
const SLACK: f64 = 0.012;
const SLACK_STEPS: f64 = 1.0;
/// Rounds of fitting a line to what is near the last one.
const ROUNDS: usize = 3;
/// How near, in steps, and in addition in rims.
const NEAR_STEPS: f64 = 2.0;
const NEAR_RIMS: f64 = 0.25;
/// Most an edge leans against its rough place, in edge lengths.
const LEAN: f64 = 0.025;
/// Worth lost by an edge at the window's border against one at its rough place.
const FAR: f64 = 0.1;
/// Share of an edge by which more of it must be seen elsewhere for it to lie there.
const CLEARER: f64 = 0.2;
/// Fewest points of an edge a line is put through.
const LEAST_POINTS: usize = 6;

/// A rough edge.
#[derive(Clone, Copy, Debug)]
pub(super) struct RoughEdge {
    /// Its ends in plate px, clockwise round the panel.
    pub(super) ends: [Point; 2],
    /// The panel's size across it, px.
    pub(super) size_px: f64,
    /// Where outside there is only mount: nearest and farthest, px from the rough edge.
    pub(super) mount_px: [f64; 2],
    /// Grey values of the mount.
    pub(super) mount: Tones,
}

impl RoughEdge {
    pub(super) fn length_px(&self) -> f64 {
        let [[ax, ay], [bx, by]] = self.ends;
        (bx - ax).hypot(by - ay)
    }

    /// Point at a share of the edge's length and px inwards of it.
    pub(super) fn point(&self, share: f64, inwards_px: f64) -> Point {
        let [[ax, ay], [bx, by]] = self.ends;
        let length = self.length_px().max(f64::MIN_POSITIVE);
        let inwards = [-(by - ay) / length, (bx - ax) / length];
        [ax + share * (bx - ax) + inwards_px * inwards[0], ay + share * (by - ay) + inwards_px * inwards[1]]
    }
}

/// An edge as seen on the plate.
#[derive(Clone, Copy, Debug)]
pub(super) struct SeenEdge {
    /// Its ends, plate px, where the rough edge's were.
    pub(super) ends: [Point; 2],
    /// Share of its length along which the photograph begins there, coming from the mount, 0..1.
    pub(super) seen: f64,
}

/// A line across a strip: px inwards of the rough edge's middle, and px by which its end lies farther inwards than its start.
type Line = [f64; 2];

/// Finds the edge near its rough place; where hardly anything is seen, it stays there.
pub(super) fn find(plate: &GrayImage, folds: &[Fold], rough: RoughEdge) -> SeenEdge {
    let Some(strip) = Strip::read(plate, folds, &rough) else {
        return SeenEdge { ends: rough.ends, seen: 0.0 };
    };
    let size = rough.size_px / strip.step_px;
    let rim = ((RIM * size).round() as usize).max(LEAST_RIM);
    let tried = [Some(likeliest(&strip, rim, LEAN * rough.length_px())), outermost(&strip, rim)];
    let (seen, [offset, lean]) = tried
        .into_iter()
        .flatten()
        .map(|line| fitted(&strip, line, rim))
        .map(|line| (seen(&strip, line, rim, SLACK_STEPS + SLACK * size), line))
        .fold((0.0, [0.0; 2]), |best, line| if line.0 > best.0 + CLEARER { line } else { best });
    let ends = [rough.point(0.0, offset - 0.5 * lean), rough.point(1.0, offset + 0.5 * lean)];
    SeenEdge { ends: if seen < KNOWN { rough.ends } else { ends }, seen }
}

/// The line through the places where scan lines first differ from the mount.
fn outermost(strip: &Strip, rim: usize) -> Option<Line> {
    let begins =
        |line: usize| Some([along(line), strip.first_px + strip.step_px * begins(strip, line, rim)? as f64]);
    straight(&(0..SCAN_LINES).filter_map(begins).collect::<Vec<Point>>())
}

/// Where a scan line first differs from the mount for more than a speck or a fold, in samples.
fn begins(strip: &Strip, line: usize, rim: usize) -> Option<usize> {
    let is_photograph = |run: &[f64]| run.iter().all(|departure| *departure >= 0.5);
    strip.departures[line].windows(rim).position(is_photograph)
}

/// The line with most photograph just inside and least outside.
fn likeliest(strip: &Strip, rim: usize, most_lean_px: f64) -> Line {
    let sums: Vec<Vec<f64>> = strip.departures.iter().map(|line| running_sums(line)).collect();
    let depth = strip.step_px * strip.count() as f64;
    let leans = (0.5 * most_lean_px / strip.step_px).ceil() as isize;
    let mut best = (f64::MIN, [0.0; 2]);
    for position in 1..strip.count().saturating_sub(rim) {
        let offset = strip.first_px + strip.step_px * position as f64;
        for step in -leans..=leans {
            let line = [offset, 2.0 * strip.step_px * step as f64];
            let steps =
                sums.iter().enumerate().map(|(i, sums)| step_worth(sums, strip.crossing(line, i), rim));
            let worth = steps.sum::<f64>() / SCAN_LINES as f64 - FAR * (offset / depth).abs();
            if worth > best.0 {
                best = (worth, line);
            }
        }
    }
    best.1
}

fn running_sums(values: &[f64]) -> Vec<f64> {
    let add = |sum: &mut f64, value: &f64| {
        *sum += value;
        Some(*sum)
    };
    std::iter::once(0.0).chain(values.iter().scan(0.0, add)).collect()
}

/// Departure from the mount just inside a place less that outside it.
fn step_worth(sums: &[f64], at: f64, rim: usize) -> f64 {
    let last = sums.len() - 1;
    let at = at.round().clamp(0.0, last as f64) as usize;
    let mean =
        |from: usize, to: usize| if to > from { (sums[to] - sums[from]) / (to - from) as f64 } else { 0.0 };
    mean(at, (at + rim).min(last)) - mean(0, at)
}

/// The line through the places near a line where scan lines are half way between mount and photograph.
fn fitted(strip: &Strip, mut line: Line, rim: usize) -> Line {
    let reach = NEAR_STEPS + NEAR_RIMS * rim as f64;
    for _ in 0..ROUNDS {
        let points: Vec<Point> = (0..SCAN_LINES)
            .filter_map(|i| {
                let foot = rise(&strip.departures[i], strip.crossing(line, i), reach, rim)?;
                let at = half_way(&strip.tones[i], foot, rim);
                Some([along(i), strip.first_px + strip.step_px * at])
            })
            .collect();
        line = straight(&points).unwrap_or(line);
    }
    line
}

/// Where a scan line rises from mount to photograph, nearest to a place, in samples; none when it does not.
fn rise(line: &[f64], near: f64, reach: f64, rim: usize) -> Option<f64> {
    let from = (near - reach).floor().max(0.0) as usize;
    let to = ((near + reach).ceil().max(0.0) as usize).min(line.len() - 1);
    let is_photograph = |inside: &[f64]| inside.iter().sum::<f64>() >= 0.5 * inside.len() as f64;
    (from..to)
        .filter(|i| line[*i] < 0.5 && line[i + 1] >= 0.5)
        .filter(|i| is_photograph(&line[i + 1..(i + 1 + rim).min(line.len())]))
        .map(|i| i as f64 + (0.5 - line[i]) / (line[i + 1] - line[i]))
        .min_by(|a, b| (a - near).abs().total_cmp(&(b - near).abs()))
}

/// Where the tone is half way between the mount before a place and the photograph behind it, in samples.
fn half_way(tones: &[f64], foot: f64, rim: usize) -> f64 {
    let (foot_index, last) = (foot as usize, tones.len() - 1);
    let before = median(tones[foot_index.saturating_sub(rim)..=foot_index].to_vec());
    let behind = median(tones[(foot_index + 2).min(last)..(foot_index + 2 + rim).min(last + 1)].to_vec());
    let side = |i: usize| (tones[i] - 0.5 * (before + behind)) * (behind - before);
    (foot_index..(foot_index + rim).min(last))
        .find(|i| side(*i) < 0.0 && side(i + 1) >= 0.0)
        .map_or(foot, |i| i as f64 + side(i) / (side(i) - side(i + 1)))
}

/// The line through points, by the median of slopes and of offsets; none of few points.
fn straight(points: &[Point]) -> Option<Line> {
    if points.len() < LEAST_POINTS {
        return None;
    }
    let half = points.len() / 2;
    let slope = |i: usize| (points[i + half][1] - points[i][1]) / (points[i + half][0] - points[i][0]);
    let lean = median((0..points.len() - half).map(slope).collect());
    Some([median(points.iter().map(|[x, y]| y - lean * x).collect()), lean])
}

/// Share of scan lines on which the photograph begins near a line, coming from the mount.
fn seen(strip: &Strip, line: Line, rim: usize, slack: f64) -> f64 {
    let is_seen = |i: &usize| {
        let at = strip.crossing(line, *i);
        // Beyond the plate's border the tone is not a number.
        let first = strip.tones[*i].iter().position(|tone| !tone.is_nan());
        first.is_some_and(|first| (first as f64) < at)
            && begins(strip, *i, rim).is_some_and(|begins| begins > 0 && (begins as f64 - at).abs() <= slack)
    };
    (0..SCAN_LINES).filter(is_seen).count() as f64 / SCAN_LINES as f64
}
