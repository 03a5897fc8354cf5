//! From probabilities to an outline: which pieces belong to the horse, and where exactly it ends.

use image::{GrayImage, ImageBuffer, Luma};
use imageproc::distance_transform::{Norm, distance_transform};
use imageproc::filter::box_filter;
use imageproc::morphology::open;
use imageproc::region_labelling::{Connectivity, connected_components};

use super::Plane;
use super::evidence::Evidence;

/// A row or column along the border of which more than this share looks like horse is the mount's.
const MOUNT: f64 = 0.5;
/// The mount is looked for this far in, share of the side.
const MOUNT_DEPTH: f64 = 0.025;
/// Half the side of the square in which a place nearly surrounded by horse is horse: a strap, a light on the coat; share of
/// the longer side.
const SURROUNDED_RADIUS: f64 = 0.015;
/// How much of that square must be horse.
const SURROUNDED: u8 = 184;
/// Holes up to this share of the horse are lights on its coat; larger ones are the wall between its legs.
const HOLE: f64 = 0.004;
/// Holes up to this share are filled if their tone is the horse's, ...
const OWN_HOLE: f64 = 0.25;
/// ... to this part of its contrast.
const OWN_TONE: f32 = 0.3;
/// Pieces of at least this share of the horse ...
const PIECE: f64 = 0.006;
/// ... and no further away than this share of the longer side belong to it: a head above a white shirt.
const PIECE_REACH: f64 = 0.065;
/// A piece below the horse's middle must be this near, share of the longer side: a hoof past a white sock.
const LOW_REACH: f64 = 0.03;
/// A hoof is broader than the leg it hangs from by at most this much a row to each side, px.
const HANG: u32 = 1;
/// Weight of a pixel's tone against the reduced outline.
const TONE_WEIGHT: f32 = 1.2;
/// Half the side of the square whose horse pixels tell its tone there, px.
const LOCAL: u32 = 3;
/// A sole is seen this far into its shadow, share of the height.
const SHADOW: f64 = 0.004;
/// A hoof and pastern are no higher than this, share of the height.
const HOOF: f64 = 0.06;
/// Pale clothes of a rider: log odds by the tone alone, above the horse's middle and no further from it than a piece.
const PALE_ODDS: f32 = -2.0;
/// Half the least thickness of such a piece, px: the horse's blurred edge is thinner.
const PALE_THICKNESS: u8 = 2;

/// The horse's pixels of a reduced panel.
pub(super) fn pieces(evidence: &Evidence, probability: &Plane) -> GrayImage {
    let mut all =
        binary(probability.width(), probability.height(), |x, y| probability.get_pixel(x, y).0[0] > 0.5);
    remove_mount(&mut all);
    if evidence.contrast > 0.0 {
        cut_shadow(&mut all, evidence);
    }
    fill_surrounded(&mut all);
    let horse = with_pieces(&all, evidence.background.track);
    add_pale(&mut all, &horse, evidence);
    let mut horse = with_pieces(&all, evidence.background.track);
    fill_holes(&mut horse, evidence);
    horse
}

/// Keeps of the track's dark places only what is under a leg: hooves, not the shadow between them. A light hoof before a
/// light track is seen by the shadow under it; what is between leg and shadow is the hoof.
fn cut_shadow(mask: &mut GrayImage, evidence: &Evidence) {
    let (width, height) = mask.dimensions();
    let deepest = (HOOF * f64::from(height)).ceil() as u32;
    let thickest = (SHADOW * f64::from(height)).ceil() as u32;
    let mut shadows = vec![0; width as usize];
    let mut legs: Vec<Option<u32>> =
        (0..width).map(|x| lowest_above(mask, x, evidence.background.track)).collect();
    for y in evidence.background.track..height {
        let above = legs.clone();
        for x in 0..width {
            if mask.get_pixel(x, y).0[0] == 0 {
                continue;
            }
            let shadow = evidence.may_be_shadow(x, y, evidence.tone.get_pixel(x, y).0[0]);
            shadows[x as usize] += u32::from(shadow);
            let columns = x.saturating_sub(HANG)..=(x + HANG).min(width - 1);
            let leg = columns
                .filter_map(|x| above[x as usize])
                .max()
                .filter(|leg| y - leg <= deepest && shadows[x as usize] <= thickest);
            if let Some(leg) = leg {
                (leg..y).for_each(|row| mask.put_pixel(x, row, Luma([255])));
                legs[x as usize] = Some(y);
            } else if shadow {
                mask.put_pixel(x, y, Luma([0]));
            }
        }
    }
}

/// The lowest row of a leg that reaches the track in a column.
fn lowest_above(mask: &GrayImage, x: u32, track: u32) -> Option<u32> {
    let from = track.saturating_sub(3);
    (from..track.min(mask.height())).rev().find(|y| mask.get_pixel(x, *y).0[0] > 0)
}

fn longest(mask: &GrayImage) -> f64 {
    f64::from(mask.width().max(mask.height()))
}

fn fill_surrounded(mask: &mut GrayImage) {
    let radius = (SURROUNDED_RADIUS * longest(mask)).ceil() as u32;
    let surroundings = box_filter(mask, radius, radius);
    for (pixel, share) in mask.pixels_mut().zip(surroundings.pixels()) {
        if share.0[0] >= SURROUNDED {
            pixel.0[0] = 255;
        }
    }
}

/// Adds what is near the horse's upper half and stands out from the wall, though less than the horse does. Lower down, the
/// shadows on the wall and the track do so, too.
fn add_pale(mask: &mut GrayImage, horse: &GrayImage, evidence: &Evidence) {
    let (width, height) = mask.dimensions();
    if evidence.contrast > 0.0 {
        return;
    }
    let middle = middle_row(horse);
    let reach = (PIECE_REACH * longest(mask)).ceil() as u8;
    let distance = distance_transform(horse, Norm::LInf);
    let pale = binary(width, height, |x, y| {
        let near = y < middle && distance.get_pixel(x, y).0[0] <= reach && mask.get_pixel(x, y).0[0] == 0;
        near && evidence.odds(x, y, evidence.tone.get_pixel(x, y).0[0]) > PALE_ODDS
    });
    // Opened, so that it is not just the horse's blurred edge.
    for (pixel, pale) in mask.pixels_mut().zip(open(&pale, Norm::LInf, PALE_THICKNESS).pixels()) {
        pixel.0[0] = pixel.0[0].max(pale.0[0]);
    }
}

fn binary(width: u32, height: u32, inside: impl Fn(u32, u32) -> bool) -> GrayImage {
    GrayImage::from_fn(width, height, |x, y| Luma([if inside(x, y) { 255 } else { 0 }]))
}

/// Dark edges of the photograph, or of what it is mounted on.
fn remove_mount(mask: &mut GrayImage) {
    let (width, height) = mask.dimensions();
    let depth = |side: u32| (MOUNT_DEPTH * f64::from(side)).ceil() as u32;
    for y in (0..depth(height)).chain(height - depth(height)..height) {
        let count = (0..width).filter(|x| mask.get_pixel(*x, y).0[0] > 0).count();
        if count as f64 > MOUNT * f64::from(width) {
            (0..width).for_each(|x| mask.put_pixel(x, y, Luma([0])));
        }
    }
    for x in (0..depth(width)).chain(width - depth(width)..width) {
        let count = (0..height).filter(|y| mask.get_pixel(x, *y).0[0] > 0).count();
        if count as f64 > MOUNT * f64::from(height) {
            (0..height).for_each(|y| mask.put_pixel(x, y, Luma([0])));
        }
    }
}

/// The largest piece, and those near it that are not small: nearer below its middle, where the track's are, than above it.
fn with_pieces(mask: &GrayImage, track: u32) -> GrayImage {
    let (width, height) = mask.dimensions();
    let pieces = Pieces::new(mask, Connectivity::Eight);
    let Some(largest) = (1..pieces.sizes.len()).max_by_key(|i| pieces.sizes[*i]) else {
        return GrayImage::new(width, height);
    };
    let main = binary(width, height, |x, y| pieces.at(x, y) == largest);
    let middle = middle_row(&main);
    let distance = distance_transform(&main, Norm::LInf);
    let [above, below] = [PIECE_REACH, LOW_REACH].map(|share| (share * longest(mask)).ceil() as u8);
    let mut kept = vec![false; pieces.sizes.len()];
    kept[largest] = true;
    let mut reaches_wall = vec![false; pieces.sizes.len()];
    for (x, y, _) in mask.enumerate_pixels() {
        let reach = if y < middle { above } else { below };
        kept[pieces.at(x, y)] |= distance.get_pixel(x, y).0[0] <= reach;
        reaches_wall[pieces.at(x, y)] |= y < track;
    }
    let least = PIECE * f64::from(pieces.sizes[largest]);
    binary(width, height, |x, y| {
        let i = pieces.at(x, y);
        i == largest
            || i > 0
                && kept[i]
                && reaches_wall[i]
                && f64::from(pieces.sizes[i]) >= least
                && !pieces.at_border[i]
    })
}

/// The row that has as many of the mask's pixels above as below it.
fn middle_row(mask: &GrayImage) -> u32 {
    let rows: Vec<u32> = mask.enumerate_pixels().filter(|(_, _, p)| p.0[0] > 0).map(|(_, y, _)| y).collect();
    rows.get(rows.len() / 2).copied().unwrap_or(0)
}

/// Connected pieces of a mask, numbered from 1.
struct Pieces {
    labels: ImageBuffer<Luma<u32>, Vec<u32>>,
    /// Pixels of each; the first entry, for what is no piece, is 0.
    sizes: Vec<u32>,
    at_border: Vec<bool>,
}

impl Pieces {
    fn new(mask: &GrayImage, connectivity: Connectivity) -> Self {
        let labels = connected_components(mask, connectivity, Luma([0]));
        let count = labels.pixels().map(|p| p.0[0] as usize).max().unwrap_or(0);
        let (mut sizes, mut at_border) = (vec![0; count + 1], vec![false; count + 1]);
        for (x, y, label) in labels.enumerate_pixels() {
            let label = label.0[0] as usize;
            sizes[label] += 1;
            at_border[label] |= x == 0 || y == 0 || x + 1 == mask.width() || y + 1 == mask.height();
        }
        sizes[0] = 0;
        Self { labels, sizes, at_border }
    }

    fn at(&self, x: u32, y: u32) -> usize {
        self.labels.get_pixel(x, y).0[0] as usize
    }
}

/// Fills small holes, and larger ones of the horse's own tone: before a background that is never seen without it.
fn fill_holes(mask: &mut GrayImage, evidence: &Evidence) {
    let outside = binary(mask.width(), mask.height(), |x, y| mask.get_pixel(x, y).0[0] == 0);
    let holes = Pieces::new(&outside, Connectivity::Four);
    // Entry 0 is the horse itself.
    let (mut sums, mut counts) = (vec![0.0; holes.sizes.len()], vec![0u32; holes.sizes.len()]);
    for (x, y, tone) in evidence.tone.enumerate_pixels() {
        let i = holes.at(x, y);
        sums[i] += tone.0[0];
        counts[i] += 1;
    }
    let mean = |i: usize| sums[i] / counts[i].max(1) as f32;
    let like_horse = |i: usize| (mean(i) - mean(0)).abs() < OWN_TONE * evidence.full_contrast();
    let most = |i: usize| if like_horse(i) { OWN_HOLE } else { HOLE } * f64::from(counts[0]);
    let is_filled: Vec<bool> = (0..counts.len()).map(|i| f64::from(counts[i]) <= most(i)).collect();
    for (x, y, pixel) in mask.enumerate_pixels_mut() {
        if is_filled[holes.at(x, y)] {
            pixel.0[0] = 255;
        }
    }
}

/// The outline at full size: near the reduced one a pixel is the horse's if its tone is nearer to the horse's just here than to
/// the wall's.
pub(super) fn refined(image: &GrayImage, evidence: &Evidence, horse: &GrayImage) -> GrayImage {
    let (width, height) = image.dimensions();
    let soft = box_filter(horse, 1, 1);
    let band = box_filter(&soft, 1, 1);
    let local = local_tone(evidence, horse);
    let smooth = if horse.dimensions() == (width, height) { image } else { &box_filter(image, 1, 1) };
    let place = |k: u32, n: u32, small: u32| ((f64::from(k) + 0.5) * f64::from(small) / f64::from(n)) as f32;
    let columns: Vec<f32> = (0..width).map(|x| place(x, width, horse.width())).collect();
    GrayImage::from_fn(width, height, |x, y| {
        let at = [columns[x as usize], place(y, height, horse.height())];
        let [column, row] = [(at[0] as u32).min(horse.width() - 1), (at[1] as u32).min(horse.height() - 1)];
        let inside = match band.get_pixel(column, row).0[0] {
            0 => false,
            255 => true,
            _ => {
                let wall = evidence.background.tone.get_pixel(column, row).0[0];
                let full = local.get_pixel(column, row).0[0] - wall;
                let tone = f32::from(smooth.get_pixel(x, y).0[0]);
                let share =
                    if full.abs() < 2.0 * evidence.background.noise { 0.5 } else { (tone - wall) / full };
                TONE_WEIGHT * (share - 0.5).clamp(-0.5, 0.5) + between(&soft, at) - 0.5 > 0.0
            }
        };
        Luma([if inside { 255 } else { 0 }])
    })
}

/// The horse's mean tone around each pixel of the reduced panel; the wall's where there is no horse around.
fn local_tone(evidence: &Evidence, horse: &GrayImage) -> Plane {
    let (width, height) = horse.dimensions();
    let tone = GrayImage::from_fn(width, height, |x, y| {
        let inside = horse.get_pixel(x, y).0[0] > 0;
        Luma([if inside { evidence.tone.get_pixel(x, y).0[0].round() as u8 } else { 0 }])
    });
    let (sum, count) = (box_filter(&tone, LOCAL, LOCAL), box_filter(horse, LOCAL, LOCAL));
    Plane::from_fn(width, height, |x, y| match count.get_pixel(x, y).0[0] {
        0..20 => *evidence.background.tone.get_pixel(x, y),
        count => Luma([f32::from(sum.get_pixel(x, y).0[0]) * 255.0 / f32::from(count)]),
    })
}

/// A mask's value between four pixels, 0 to 1.
fn between(mask: &GrayImage, at: [f32; 2]) -> f32 {
    let [x, y] = at.map(|v| (v - 0.5).max(0.0));
    let (left, top) = ((x as u32).min(mask.width() - 1), (y as u32).min(mask.height() - 1));
    let (right, bottom) = ((left + 1).min(mask.width() - 1), (top + 1).min(mask.height() - 1));
    let (fx, fy) = (x - left as f32, y - top as f32);
    let value = |x: u32, y: u32| f32::from(mask.get_pixel(x, y).0[0]) / 255.0;
    (1.0 - fy) * ((1.0 - fx) * value(left, top) + fx * value(right, top))
        + fy * ((1.0 - fx) * value(left, bottom) + fx * value(right, bottom))
}
