//! Pictures one after the other as a GIF.

use anyhow::{Context, bail};
use gif::{DisposalMethod, Encoder, Repeat};
use image::RgbImage;

use super::palette::Palette;

/// Colours: fewer are smaller files, and with half as many the shades of the horse show as bands.
const COLORS: usize = 127;
/// Largest animation, px of all its pictures: what is held in memory at once, 3 bytes each.
const LARGEST_PX: f64 = 200e6;

/// Pictures a second, as an argument.
pub(super) fn fps(text: &str) -> Result<f64, String> {
    let fps: f64 = text.parse().map_err(|_| "not a number".to_string())?;
    if (1.0..=50.0).contains(&fps) { Ok(fps) } else { Err("between 1 and 50 pictures a second".into()) }
}

/// How many times slower, as an argument.
pub(super) fn slow(text: &str) -> Result<f64, String> {
    let slow: f64 = text.parse().map_err(|_| "not a number".to_string())?;
    if (0.1..=100.0).contains(&slow) { Ok(slow) } else { Err("between 0.1 and 100 times".into()) }
}

/// The duration of a picture of which so many are shown in a second, whole hundredths of a second.
pub(super) fn delay(fps: f64) -> u16 {
    (100.0 / fps).round() as u16
}

/// Refuses an animation that is too large to be held in memory.
///
/// # Errors
/// When it is.
pub(super) fn check_size(pictures: u32, [width, height]: [u32; 2]) -> anyhow::Result<()> {
    if f64::from(width) * f64::from(height) * f64::from(pictures) > LARGEST_PX {
        bail!("{pictures} pictures of {width} px are too many; take fewer seconds or a smaller width");
    }
    Ok(())
}

/// All pictures with one palette, for ever; each is shown for `delay` hundredths of a second. Pixels that stay are left as they are.
pub(super) fn animation(pictures: &[RgbImage], delay: u16) -> anyhow::Result<Vec<u8>> {
    encode(pictures, delay).context("cannot encode the animation")
}

fn encode(pictures: &[RgbImage], delay: u16) -> Result<Vec<u8>, gif::EncodingError> {
    let palette = Palette::choose(pictures, COLORS);
    // The place after the last colour stands for a pixel that stays.
    let stays = palette.len() as u8;
    let [width, height] =
        pictures.first().map_or([1, 1], |first| [first.width() as u16, first.height() as u16]);
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, width, height, &[palette.bytes(), vec![0; 3]].concat())?;
    encoder.set_repeat(Repeat::Infinite)?;
    let mut shown: Option<Vec<u8>> = None;
    for picture in pictures {
        let indices = palette.indices(picture);
        let changed = match &shown {
            Some(shown) => {
                indices.iter().zip(shown).map(|(new, old)| if new == old { stays } else { *new }).collect()
            }
            None => indices.clone(),
        };
        let transparent = shown.is_some().then_some(stays);
        let mut frame = gif::Frame::from_indexed_pixels(width, height, changed, transparent);
        // The encoder's own palette of the whole file is used.
        frame.palette = None;
        frame.delay = delay;
        frame.dispose = DisposalMethod::Keep;
        encoder.write_frame(&frame)?;
        shown = Some(indices);
    }
    drop(encoder);
    Ok(bytes)
}
