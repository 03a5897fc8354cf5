//! From probabilities to an outline: which pieces belong to the horse, and where exactly it ends.

use image::{GrayImage, Luma, imageops};
use imageproc::distance_transform::Norm;
use imageproc::filter::box_filter;
use imageproc::morphology::{dilate, open};
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
/// Pieces of at least this share of the horse ...
const PIECE: f64 = 0.006;
/// ... and no further away than this share of the longer side belong to it: a head above a white shirt.
const PIECE_REACH: f64 = 0.065;

/// Pale clothes of a rider: log odds by the tone alone, above the horse's middle and no further from it than a piece.
const PALE_ODDS: f32 = -2.0;

/// Half the least thickness of such a piece, px: the horse's blurred edge is thinner.
const PALE_THICKNESS: u8 = 2;

/// The horse's pixels of a reduced panel.
pub(super) fn pieces(evidence: &Evidence, probability: &Plane) -> GrayImage {
    let mut all = binary(probability.width(), probability.height(), |x, y| probability.get_pixel(x, y).0[0] > 0.5);
    remove_mount(&mut all);
    fill_surrounded(&mut all);
    let horse = with_pieces(&all);
    add_pale(&mut all, &horse, evidence);
    let mut horse = with_pieces(&all);
    fill_holes(&mut horse);
    horse
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
    let rows: Vec<u32> = horse.enumerate_pixels().filter(|(_, _, p)| p.0[0] > 0).map(|(_, y, _)| y).collect();
    if rows.is_empty() || evidence.contrast > 0.0 {
        return;
    }
    let middle = rows[rows.len() / 2];
    let reach = dilate(horse, Norm::LInf, (PIECE_REACH * longest(mask)) as u8);
    let pale = binary(width, height, |x, y| {
        let near = y < middle && reach.get_pixel(x, y).0[0] > 0 && mask.get_pixel(x, y).0[0] == 0;
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

/// The largest piece, and those near it that are not small.
fn with_pieces(mask: &GrayImage) -> GrayImage {
    let reach = (PIECE_REACH * longest(mask)) as u8;
    let (width, height) = mask.dimensions();
    let labels = connected_components(mask, Connectivity::Eight, Luma([0]));
    let count = labels.pixels().map(|p| p.0[0] as usize).max().unwrap_or(0);
    let mut sizes = vec![0u32; count + 1];
    let mut at_border = vec![false; count + 1];
    for (x, y, label) in labels.enumerate_pixels() {
        let label = label.0[0] as usize;
        sizes[label] += 1;
        at_border[label] |= x == 0 || y == 0 || x + 1 == width || y + 1 == height;
    }
    sizes[0] = 0;
    let largest = (1..=count).max_by_key(|i| sizes[*i]).unwrap_or(0);
    let is = |x: u32, y: u32, label: usize| labels.get_pixel(x, y).0[0] as usize == label;
    let near = dilate(&binary(width, height, |x, y| largest > 0 && is(x, y, largest)), Norm::LInf, reach);
    let mut kept = vec![false; count + 1];
    for (x, y, label) in labels.enumerate_pixels() {
        let label = label.0[0] as usize;
        let counts = f64::from(sizes[label]) >= PIECE * f64::from(sizes[largest]) && !at_border[label];
        kept[label] |= label > 0 && (label == largest || counts && near.get_pixel(x, y).0[0] > 0);
    }
    binary(width, height, |x, y| kept[labels.get_pixel(x, y).0[0] as usize])
}

fn fill_holes(mask: &mut GrayImage) {
    let labels = connected_components(&negative(mask), Connectivity::Four, Luma([0]));
    let count = labels.pixels().map(|p| p.0[0] as usize).max().unwrap_or(0);
    let mut sizes = vec![0u32; count + 1];
    for label in labels.pixels() {
        sizes[label.0[0] as usize] += 1;
    }
    let most = HOLE * f64::from(sizes[0]);
    for (pixel, label) in mask.pixels_mut().zip(labels.pixels()) {
        if f64::from(sizes[label.0[0] as usize]) <= most {
            pixel.0[0] = 255;
        }
    }
}

fn negative(mask: &GrayImage) -> GrayImage {
    binary(mask.width(), mask.height(), |x, y| mask.get_pixel(x, y).0[0] == 0)
}

/// The outline at full size: between the reduced view's pixels the panel's own tones decide.
pub(super) fn refined(image: &GrayImage, evidence: &Evidence, horse: &GrayImage) -> GrayImage {
    if image.dimensions() == horse.dimensions() {
        return horse.clone();
    }
    let (width, height) = image.dimensions();
    let soft = imageops::resize(&box_filter(horse, 1, 1), width, height, imageops::FilterType::Triangle);
    let (sx, sy) = (f64::from(horse.width()) / f64::from(width), f64::from(horse.height()) / f64::from(height));
    let smooth = box_filter(image, 1, 1);
    GrayImage::from_fn(width, height, |x, y| {
        let near = soft.get_pixel(x, y).0[0];
        let inside = match near {
            0..=30 => false,
            225..=255 => true,
            _ => {
                let at = |k: u32, s: f64, size: u32| (((f64::from(k) + 0.5) * s) as u32).min(size - 1);
                let (column, row) = (at(x, sx, horse.width()), at(y, sy, horse.height()));
                let odds = evidence.odds(column, row, f32::from(smooth.get_pixel(x, y).0[0]));
                odds / 8.0 + (f32::from(near) / 255.0 - 0.5) > 0.0
            }
        };
        Luma([if inside { 255 } else { 0 }])
    })
}
