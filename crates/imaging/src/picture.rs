//! Reading picture files of any usual kind, within bounds of memory.

pub(crate) mod jpeg;

use std::io::{BufReader, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use image::codecs::gif::GifDecoder;
use image::error::ImageError;
use image::metadata::Orientation;
use image::{
    AnimationDecoder, DynamicImage, GrayImage, ImageDecoder, ImageFormat, ImageReader, Limits, RgbImage,
};

/// What is read at most.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LoadLimits {
    /// Most pixels of a picture.
    pub pixels: u64,
}

impl Default for LoadLimits {
    /// 200 megapixels: four times a 50-megapixel scan, 0.6 GB in colour.
    fn default() -> Self {
        Self { pixels: 200_000_000 }
    }
}

/// Why a picture cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum PictureError {
    /// The file cannot be opened.
    #[error("{}: cannot be read; check the path and its permissions", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Cause.
        source: std::io::Error,
    },
    /// The file is not a picture of a kind we read.
    #[error("{}: not a JPEG, PNG, TIFF or GIF picture; convert it, or check that the file is what its name says", path.display())]
    UnknownKind {
        /// The file.
        path: PathBuf,
    },
    /// The file begins as a picture, but cannot be read to its end.
    #[error("{}: damaged or cut short; get the file again", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// Cause.
        source: ImageError,
    },
    /// Too many pixels.
    #[error("{}: {width} x {height} pixels are more than the {} megapixels that are read; make a smaller copy", path.display(), most / 1_000_000)]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// Width, px.
        width: u32,
        /// Height, px.
        height: u32,
        /// Limit, px.
        most: u64,
    },
    /// A folder without frames.
    #[error("{}: no picture file in this folder; name a folder of JPEG, PNG, TIFF or GIF frames", path.display())]
    NoFrames {
        /// The folder.
        path: PathBuf,
    },
    /// A moving picture.
    #[error("{}: an animation; unpack its frames into a folder and give the folder", path.display())]
    Animated {
        /// The file.
        path: PathBuf,
    },
}

/// Reads a picture as grey values, turned upright where the file says how.
///
/// # Errors
/// When the file cannot be opened, is no picture, is damaged, animated, or larger than the limits.
pub fn load_gray(path: &Path, limits: LoadLimits) -> Result<GrayImage, PictureError> {
    load(path, limits).map(DynamicImage::into_luma8)
}

/// Reads a picture in colour, turned upright where the file says how.
///
/// # Errors
/// As [`load_gray`].
pub fn load_rgb(path: &Path, limits: LoadLimits) -> Result<RgbImage, PictureError> {
    load(path, limits).map(DynamicImage::into_rgb8)
}

fn load(path: &Path, limits: LoadLimits) -> Result<DynamicImage, PictureError> {
    let read_error = |source| PictureError::Read { path: path.to_path_buf(), source };
    let damaged = |source| PictureError::Damaged { path: path.to_path_buf(), source };
    // Anything but a file could keep its reader waiting for ever.
    if !std::fs::metadata(path).map_err(read_error)?.is_file() {
        return Err(read_error(std::io::Error::other("not a file")));
    }
    let mut file = std::fs::File::open(path).map_err(read_error)?;
    // By content: a scan's extension is often wrong.
    let reader = ImageReader::new(BufReader::new(&file)).with_guessed_format().map_err(read_error)?;
    let format = reader.format().ok_or_else(|| PictureError::UnknownKind { path: path.to_path_buf() })?;
    let mut decoder = reader.into_decoder().map_err(damaged)?;
    let (width, height) = decoder.dimensions();
    if u64::from(width) * u64::from(height) > limits.pixels {
        let path = path.to_path_buf();
        return Err(PictureError::TooLarge { path, width, height, most: limits.pixels });
    }
    let mut memory = Limits::default();
    // Sixteen-bit colour with alpha is eight bytes a pixel; as much again for the decoder's own tables.
    memory.max_alloc = Some(16 * limits.pixels);
    decoder.set_limits(memory).map_err(damaged)?;
    let orientation = decoder.orientation().unwrap_or(Orientation::NoTransforms);
    let mut picture = DynamicImage::from_decoder(decoder).map_err(damaged)?;
    if format == ImageFormat::Jpeg {
        file.seek(SeekFrom::Start(0)).map_err(read_error)?;
        if !jpeg::has_end(BufReader::new(&file)).map_err(read_error)? {
            return Err(damaged(std::io::Error::from(std::io::ErrorKind::UnexpectedEof).into()));
        }
    }
    if format == ImageFormat::Gif && is_animated(&mut file).map_err(damaged)? {
        return Err(PictureError::Animated { path: path.to_path_buf() });
    }
    picture.apply_orientation(orientation);
    Ok(over_white(picture))
}

fn is_animated(file: &mut std::fs::File) -> Result<bool, ImageError> {
    file.seek(SeekFrom::Start(0))?;
    let mut frames = GifDecoder::new(BufReader::new(file))?.into_frames();
    Ok(frames.nth(1).is_some())
}

/// What is transparent shows white paper.
fn over_white(picture: DynamicImage) -> DynamicImage {
    if !picture.color().has_alpha() {
        return picture;
    }
    let mut opaque = RgbImage::new(picture.width(), picture.height());
    for (to, from) in opaque.pixels_mut().zip(picture.into_rgba8().pixels()) {
        let [r, g, b, alpha] = from.0.map(u32::from);
        to.0 = [r, g, b].map(|v| ((v * alpha + 255 * (255 - alpha) + 127) / 255) as u8);
    }
    DynamicImage::ImageRgb8(opaque)
}
