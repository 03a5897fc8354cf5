//! How much each pixel of a reduced panel looks like horse: its distance from the background in units of the horse's.

use image::{GrayImage, Luma, imageops};

use super::background::{self, Background};
use super::lines::Tone;
use super::{Plane, erase, quantile, still};
use crate::PanelView;

/// Longest side of the reduced view, px: a cannon bone is still two to four pixels broad.
const LONGEST: u32 = 380;
/// Where the horse is looked for first, shares of width and height: not in bands of numbers, nor on the track.
const MIDDLE: [[f64; 2]; 2] = [[0.1, 0.9], [0.12, 0.85]];
/// The tones furthest from the background, a share of the pixels of the middle: any horse covers more.
const EXTREME: f64 = 0.02;

/// Log odds at most, from one pixel alone.
const MOST_ODDS: f32 = 4.0;
/// Log odds between a pixel of the horse's tone and one of the background's.
const ODDS: f32 = 8.0;
/// A dark horse's pixels are darker by more than this part of its contrast; the shadows it throws on the wall are lighter.
const MIDDLE_SHARE: f32 = 0.45;
/// No shadow is lighter than the wall: on a dark wall anything lighter by so many standard deviations is the horse's, ...
const LIGHTER: f32 = 2.8;
/// ... or by this part of its contrast, whichever is more.
const LEAST_SHARE: f32 = 0.2;
/// A light horse's mane, tail and hooves are darker than wall or track by so many standard deviations.
const DARKER: f32 = 4.5;
/// Before a background that stands still, what differs by so many standard deviations is the horse's.
const MOVED: f32 = 5.0;
/// The background's tone is taken as at least this: ratios of less mean nothing.
const LEAST_TONE: f32 = 8.0;

/// A reduced panel.
pub(super) struct Evidence {
    /// Tone, the wall's lines erased.
    pub(super) tone: Plane,
    /// The panel without the horse.
    pub(super) background: Background,
    /// Difference of the horse's tone from the background's as a part of the background's, negative for a dark horse;
    /// 0 when there is none.
    pub(super) contrast: f32,
    /// Whether the background is known from other frames of a camera that stands still.
    is_still: bool,
}

impl Evidence {
    /// Difference of tone between horse and wall in the middle of the panel.
    pub(super) fn full_contrast(&self) -> f32 {
        let (x, y) = (self.tone.width() / 2, self.tone.height() / 2);
        (self.contrast * self.background.tone.get_pixel(x, y).0[0].max(LEAST_TONE)).abs()
    }

    /// Whether a tone at a pixel may be a shadow on the track as well as a hoof: of a light horse only.
    pub(super) fn may_be_shadow(&self, x: u32, y: u32, tone: f32) -> bool {
        self.contrast > 0.0 && y >= self.background.track && tone < self.background.tone.get_pixel(x, y).0[0]
    }

    /// Log odds of horse to background for a tone at a pixel.
    pub(super) fn odds(&self, x: u32, y: u32, tone: f32) -> f32 {
        let background = self.background.tone.get_pixel(x, y).0[0];
        let noise = self.background.noise;
        let off = tone - background;
        let full = self.contrast * background.max(LEAST_TONE);
        let odds = if self.is_still {
            ODDS * 0.5 * (off.abs() / (MOVED * noise) - 1.0)
        } else if full < 0.0 {
            ODDS * (off / full - MIDDLE_SHARE)
        } else if off > 0.0 {
            ODDS * 0.5 * (off / (LIGHTER * noise).max(LEAST_SHARE * full) - 1.0)
        } else {
            ODDS * 0.5 * (-off / (DARKER * noise) - 1.0)
        };
        odds.clamp(-MOST_ODDS, MOST_ODDS)
    }
}

/// All panels of a plate, reduced by the same factor.
pub(super) fn of_panels(views: &[PanelView]) -> Vec<Evidence> {
    let longest = views.iter().map(|view| view.image.width().max(view.image.height())).max().unwrap_or(1);
    let scale = (f64::from(LONGEST) / f64::from(longest.max(1))).min(1.0);
    let tone = horse_tone(views, scale);
    let tones: Vec<Plane> =
        views.iter().map(|view| plane(&erase::erased(&reduced(&view.image, scale), tone))).collect();
    let walls: Vec<Background> = tones.iter().map(background::estimate).collect();
    let still = still::background(&tones, &walls, tone);
    tones
        .into_iter()
        .zip(walls)
        .map(|(tone, wall)| {
            let background = still.clone().unwrap_or(wall);
            let contrast = contrast(&tone, &background.tone);
            Evidence { tone, background, contrast, is_still: still.is_some() }
        })
        .collect()
}

fn reduced(image: &GrayImage, scale: f64) -> GrayImage {
    if scale == 1.0 {
        return image.clone();
    }
    let size = |n: u32| ((f64::from(n) * scale).round() as u32).max(1);
    imageops::thumbnail(image, size(image.width()), size(image.height()))
}

fn plane(image: &GrayImage) -> Plane {
    Plane::from_fn(image.width(), image.height(), |x, y| Luma([f32::from(image.get_pixel(x, y).0[0])]))
}

/// Whether the horses are darker or lighter than their walls, by the first panels.
fn horse_tone(views: &[PanelView], scale: f64) -> Tone {
    let sum: f32 = views
        .iter()
        .take(4)
        .map(|view| {
            let tone = plane(&reduced(&view.image, 0.5 * scale));
            contrast(&tone, &background::estimate(&tone).tone)
        })
        .sum();
    if sum > 0.0 { Tone::Light } else { Tone::Dark }
}

/// The middle difference of what is far from the background, in the middle of the panel.
fn contrast(tone: &Plane, background: &Plane) -> f32 {
    let (width, height) = (f64::from(tone.width()), f64::from(tone.height()));
    let inside =
        |k: u32, size: f64, [from, to]: [f64; 2]| (from..to).contains(&((f64::from(k) + 0.5) / size));
    let mut off: Vec<f32> = tone
        .enumerate_pixels()
        .filter(|(x, y, _)| inside(*x, width, MIDDLE[0]) && inside(*y, height, MIDDLE[1]))
        .map(|(x, y, tone)| {
            let background = background.get_pixel(x, y).0[0];
            (tone.0[0] - background) / background.max(LEAST_TONE)
        })
        .collect();
    let (low, high) = (quantile(&mut off, EXTREME), quantile(&mut off, 1.0 - EXTREME));
    let mut contrast = if -low > high { low } else { high };
    for _ in 0..3 {
        let mut beyond: Vec<f32> = off.iter().copied().filter(|off| off / contrast > 0.5).collect();
        contrast = quantile(&mut beyond, 0.5);
    }
    contrast
}
