//! Reading a JPEG picture strictly: whole or not at all.

use std::io::Cursor;

use image::codecs::jpeg::JpegDecoder;
use image::{DynamicImage, ImageDecoder};

use super::FetchError;
use super::error::beginning;
use crate::picture::jpeg::has_end;

/// Start of every JPEG file: its first marker and the lead byte of the next.
const SIGNATURE: [u8; 3] = [0xff, 0xd8, 0xff];

/// Decodes a JPEG picture from `url`.
///
/// # Errors
/// When it is no JPEG picture, has more than `most_pixels`, is damaged, or ends before its end.
pub(super) fn decode(url: &str, bytes: &[u8], most_pixels: u64) -> Result<DynamicImage, FetchError> {
    let wrong = |found: String| FetchError::WrongContent { url: url.into(), found };
    if !bytes.starts_with(&SIGNATURE) {
        return Err(wrong(format!("no JPEG picture but {}", beginning(bytes))));
    }
    // Before decoding: the decoder fills up what is missing with grey and says nothing.
    if !has_end(bytes).unwrap_or(false) {
        return Err(FetchError::CutShort { url: url.into(), bytes: bytes.len() as u64 });
    }
    let damaged = |error: image::ImageError| wrong(format!("a damaged picture ({error})"));
    let decoder = JpegDecoder::new(Cursor::new(bytes)).map_err(damaged)?;
    let (width, height) = (u64::from(decoder.dimensions().0), u64::from(decoder.dimensions().1));
    if width * height > most_pixels {
        return Err(FetchError::TooManyPixels { url: url.into(), width, height, most: most_pixels });
    }
    DynamicImage::from_decoder(decoder).map_err(damaged)
}

#[cfg(test)]
mod tests {
    use image::GrayImage;

    use super::*;

    fn jpeg() -> Vec<u8> {
        let picture = GrayImage::from_fn(64, 48, |x, y| image::Luma([(x * y) as u8]));
        let mut bytes = Vec::new();
        picture.write_to(&mut Cursor::new(&mut bytes), image::ImageFormat::Jpeg).unwrap();
        bytes
    }

    #[test]
    fn every_cut_is_noticed() {
        let whole = jpeg();
        assert_eq!(decode("u", &whole, 10_000).unwrap().width(), 64);
        for length in 3..whole.len() {
            let error = decode("u", &whole[..length], 10_000).unwrap_err();
            assert!(matches!(error, FetchError::CutShort { .. }), "{length}: {error}");
        }
    }

    #[test]
    fn the_end_of_a_thumbnail_is_not_the_end() {
        let whole = jpeg();
        let mut cut = whole[..2].to_vec();
        // An application segment that holds a picture of its own.
        cut.extend([0xff, 0xe1]);
        cut.extend((whole.len() as u16 + 2).to_be_bytes());
        cut.extend(&whole);
        cut.extend(&whole[2..]);
        assert!(decode("u", &cut, 10_000).is_ok());
        cut.truncate(cut.len() - 2);
        assert!(matches!(decode("u", &cut, 10_000), Err(FetchError::CutShort { .. })));
    }

    #[test]
    fn other_content_is_shown() {
        let error = decode("u", b"<!DOCTYPE html>", 10_000).unwrap_err().to_string();
        assert!(error.contains("<!DOCTYPE html>"), "{error}");
        assert!(matches!(decode("u", &[], 1), Err(FetchError::WrongContent { .. })));
        assert!(matches!(decode("u", &jpeg(), 3000), Err(FetchError::TooManyPixels { .. })));
    }
}
