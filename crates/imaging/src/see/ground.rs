//! The line the near hooves stand on: its direction from the edges of wall and track, its height from the lowest hooves of all
//! panels, which share their surroundings up to a shift and a turn.

use image::GrayImage;

use super::{Line, Silhouette, quantile};
use crate::PanelView;

/// Upright bands a panel is averaged in.
const BANDS: u32 = 24;
/// Edges of wall and track are looked for below this share of the height.
const FROM: f64 = 0.45;
/// Steepest line, px down per px across: panels are squared up.
const STEEPEST: f64 = 0.04;
/// Slopes that are tried to either side of level.
const SLOPES: i32 = 60;
/// A step of tone, in usual steps, that counts fully: what lies on the track is not to outweigh a faint edge along it.
const MOST_STEP: f32 = 4.0;
/// Panels are shifted against each other by less than this share of the height.
const MOST_SHIFT: f64 = 0.06;
/// So many columns of the horse must reach as low as its lowest point, share of the width: fewer are dirt.
const COLUMNS: f64 = 0.006;
/// Spread of the lowest stance hooves about the ground, share of the height.
const SPREAD: f64 = 0.006;
/// Which of the lowest hooves of the panels is on the ground line: off hooves stand a little higher in the picture.
const SHARE: f64 = 0.6;
/// With so many panels whose lowest hooves agree, the ground is certain.
const ENOUGH: f64 = 4.0;

/// How a panel's levels run.
struct Levels {
    /// px down per px across.
    slope: f64,
    /// Shift down against the others, px.
    shift: f64,
    /// Steps of tone along the slope, by row at the middle of the panel.
    profile: Vec<f32>,
    middle: f64,
}

impl Levels {
    /// Height of a point along the slope and against the shift, px: equal for equal places of all panels.
    fn height(&self, [x, y]: [f64; 2]) -> f64 {
        y - self.slope * (x - self.middle) - self.shift
    }

    fn line(&self, height: f64, width: f64, confidence: f64) -> Line {
        let at = |x: f64| [x, height + self.shift + self.slope * (x - self.middle)];
        Line { ends_px: [at(0.0), at(width)], confidence }
    }
}

/// The ground of every panel.
pub(super) fn find(views: &[PanelView], silhouettes: &[Silhouette]) -> Vec<Option<Line>> {
    let mut levels: Vec<Levels> =
        views.iter().zip(silhouettes).map(|(view, horse)| Levels::new(&view.image, &horse.mask)).collect();
    align(&mut levels);
    let lowest: Vec<Option<f64>> =
        levels.iter().zip(silhouettes).map(|(l, horse)| lowest(l, &horse.mask)).collect();
    let tallest = views.iter().map(|view| view.image.height()).max().unwrap_or(0);
    let spread = (SPREAD * f64::from(tallest)).max(1.0);
    let Some((height, confidence)) = commonest(&lowest, silhouettes, spread) else {
        return views.iter().map(|_| None).collect();
    };
    let line = |(levels, view): (&Levels, &PanelView)| {
        Some(levels.line(height, f64::from(view.image.width()), confidence))
    };
    levels.iter().zip(views).map(line).collect()
}

/// The height at which most panels' horses end below, and how far to trust it.
fn commonest(lowest: &[Option<f64>], silhouettes: &[Silhouette], spread: f64) -> Option<(f64, f64)> {
    let known: Vec<(f64, f64)> =
        lowest.iter().zip(silhouettes).filter_map(|(low, horse)| Some(((*low)?, horse.confidence))).collect();
    let votes = |height: f64| -> f64 {
        known.iter().map(|(low, weight)| weight * (-0.5 * ((low - height) / spread).powi(2)).exp()).sum()
    };
    let best = known.iter().map(|(low, _)| *low).max_by(|a, b| votes(*a).total_cmp(&votes(*b)))?;
    let mut near: Vec<f32> = known
        .iter()
        .map(|(low, _)| *low as f32)
        .filter(|low| (f64::from(*low) - best).abs() < 2.0 * spread)
        .collect();
    let (votes, count) = (votes(best), near.len() as f64);
    Some((f64::from(quantile(&mut near, SHARE)), (votes / ENOUGH).min(votes / count).min(1.0)))
}

/// Height of the horse's lowest points.
fn lowest(levels: &Levels, mask: &GrayImage) -> Option<f64> {
    let bottom = |x: u32| (0..mask.height()).rev().find(|y| mask.get_pixel(x, *y).0[0] > 0);
    let mut bottoms: Vec<f64> = (0..mask.width())
        .filter_map(|x| Some(levels.height([f64::from(x) + 0.5, f64::from(bottom(x)?) + 1.0])))
        .collect();
    bottoms.sort_by(|a, b| b.total_cmp(a));
    bottoms.get((COLUMNS * f64::from(mask.width())).ceil() as usize).copied()
}

impl Levels {
    fn new(image: &GrayImage, mask: &GrayImage) -> Self {
        let (width, height) = image.dimensions();
        let steps = steps(image, mask);
        let middle = 0.5 * f64::from(width);
        let first = (FROM * f64::from(height)) as usize;
        let profile_along = |slope: f64| -> Vec<f32> {
            (0..height as usize)
                .map(|y| {
                    let (mut sum, mut count) = (0.0, 0.0);
                    for (band, steps) in steps.iter().enumerate() {
                        let x = (band as f64 + 0.5) / f64::from(BANDS) * f64::from(width);
                        let at = y as f64 + slope * (x - middle);
                        let (row, share) = (at.floor(), (at - at.floor()) as f32);
                        if y < first || row < 0.0 || row as usize + 1 >= steps.len() {
                            continue;
                        }
                        if let (Some(a), Some(b)) = (steps[row as usize], steps[row as usize + 1]) {
                            sum += (1.0 - share) * a + share * b;
                            count += 1.0;
                        }
                    }
                    // Bands hidden by the horse count as ones without a step.
                    sum / (0.5 * (count + BANDS as f32))
                })
                .collect()
        };
        let sharpness = |slope: f64| -> f64 { profile_along(slope).iter().map(|v| f64::from(v * v)).sum() };
        let slope_of = |i: f64| STEEPEST * i / f64::from(SLOPES);
        let scores: Vec<f64> = (-SLOPES..=SLOPES).map(|i| sharpness(slope_of(f64::from(i)))).collect();
        let best = peak(&scores).map_or(0.0, |at| at - f64::from(SLOPES));
        let slope = slope_of(best);
        Self { slope, shift: 0.0, profile: profile_along(slope), middle }
    }
}

/// Steps of tone from row to row in each band, in usual steps; none where the horse is.
fn steps(image: &GrayImage, mask: &GrayImage) -> Vec<Vec<Option<f32>>> {
    let (width, height) = image.dimensions();
    let bands: Vec<Vec<Option<f32>>> = (0..BANDS)
        .map(|band| {
            let xs =
                band * width / BANDS..((band + 1) * width / BANDS).max(band * width / BANDS + 1).min(width);
            let means: Vec<Option<f32>> = (0..height)
                .map(|y| {
                    let seen = xs.clone().filter(|x| mask.get_pixel(*x, y).0[0] == 0);
                    let (sum, count) = seen.fold((0.0, 0u32), |(sum, count), x| {
                        (sum + f32::from(image.get_pixel(x, y).0[0]), count + 1)
                    });
                    (2 * count > xs.len() as u32).then(|| sum / count as f32)
                })
                .collect();
            (0..means.len())
                .map(|y| {
                    Some(
                        means.get(y + 1).copied().flatten()?
                            - means.get(y.checked_sub(1)?).copied().flatten()?,
                    )
                })
                .collect()
        })
        .collect();
    let mut sizes: Vec<f32> = bands.iter().flatten().filter_map(|step| step.map(f32::abs)).collect();
    let usual = quantile(&mut sizes, 0.5).max(0.5);
    let clipped = |step: Option<f32>| step.map(|step| (step / usual).clamp(-MOST_STEP, MOST_STEP));
    bands.into_iter().map(|band| band.into_iter().map(clipped).collect()).collect()
}

/// Shifts each panel so that its profile fits the mean of all.
fn align(levels: &mut [Levels]) {
    let rows = levels.iter().map(|l| l.profile.len()).max().unwrap_or(0);
    let most = (MOST_SHIFT * rows as f64) as i64;
    for _ in 0..3 {
        let at = |l: &Levels, y: i64| -> f32 {
            usize::try_from(y).ok().and_then(|y| l.profile.get(y)).copied().unwrap_or(0.0)
        };
        let mean: Vec<f32> = (0..rows as i64)
            .map(|y| {
                levels.iter().map(|l| at(l, y + l.shift.round() as i64)).sum::<f32>() / levels.len() as f32
            })
            .collect();
        for l in levels.iter_mut() {
            let fit = |shift: i64| -> f64 {
                mean.iter().enumerate().map(|(y, m)| f64::from(m * at(l, y as i64 + shift))).sum()
            };
            let fits: Vec<f64> = (-most..=most).map(fit).collect();
            l.shift = peak(&fits).map_or(0.0, |place| place - most as f64);
        }
    }
}

/// Place of the greatest value, between values by a parabola; none when all are equal.
fn peak(values: &[f64]) -> Option<f64> {
    let best = (0..values.len()).max_by(|a, b| values[*a].total_cmp(&values[*b]))?;
    let least = values.iter().copied().fold(f64::INFINITY, f64::min);
    if values[best] <= least {
        return None;
    }
    if best == 0 || best + 1 == values.len() {
        return Some(best as f64);
    }
    let (a, b, c) = (values[best - 1], values[best], values[best + 1]);
    let bend = a - 2.0 * b + c;
    Some(best as f64 + if bend < 0.0 { 0.5 * (a - c) / bend } else { 0.0 })
}
