//! Picture files of every kind a person may open, good and bad: a clear error or the right picture.

#![allow(clippy::unwrap_used, reason = "a test stops at the first thing it cannot do")]

use std::io::Cursor;
use std::path::{Path, PathBuf};

use image::codecs::gif::GifEncoder;
use image::{DynamicImage, Frame, GrayImage, ImageBuffer, ImageFormat, Luma, Rgba, RgbaImage};
use muybridge_capture::write_atomically;
use muybridge_imaging::{LoadLimits, PictureError, load_gray, load_rgb};

/// A folder that holds one file.
struct File {
    _folder: tempfile::TempDir,
    path: PathBuf,
}

fn file(name: &str, bytes: &[u8]) -> File {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    write_atomically(&path, bytes).unwrap();
    File { _folder: folder, path }
}

fn encoded(picture: &DynamicImage, format: ImageFormat) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    picture.write_to(&mut bytes, format).unwrap();
    bytes.into_inner()
}

/// Something with detail, so that half of its file is not nearly all of it.
fn detailed() -> DynamicImage {
    let grey = GrayImage::from_fn(200, 120, |x, y| Luma([(x * x + 7 * y * (x % 13)) as u8]));
    DynamicImage::from(grey).into_rgb8().into()
}

fn open(path: &Path) -> Result<GrayImage, PictureError> {
    load_gray(path, LoadLimits::default())
}

#[track_caller]
fn assert_refused(name: &str, bytes: &[u8], says: &str) {
    let file = file(name, bytes);
    let message = match open(&file.path) {
        Ok(picture) => panic!("{name}: read as {:?}", picture.dimensions()),
        Err(error) => error.to_string(),
    };
    assert!(message.contains(name) && message.contains(says), "{message}");
}

#[test]
fn files_that_are_no_picture_are_called_so() {
    assert_refused("empty.jpg", b"", "not a JPEG");
    assert_refused("text.jpg", b"This is a text file that somebody has named .jpg.\n", "not a JPEG");
    let missing = open(Path::new("no-such-file.jpg")).unwrap_err().to_string();
    assert!(missing.contains("no-such-file.jpg: cannot be read"), "{missing}");
    let folder = tempfile::tempdir().unwrap();
    assert!(open(folder.path()).unwrap_err().to_string().contains("cannot be read"));
}

#[test]
fn files_cut_short_are_damaged_wherever_they_are_cut() {
    for (format, name) in [
        (ImageFormat::Jpeg, "cut.jpg"),
        (ImageFormat::Png, "cut.png"),
        (ImageFormat::Tiff, "cut.tif"),
        (ImageFormat::Gif, "cut.gif"),
    ] {
        let whole = encoded(&detailed(), format);
        for share in [0.1, 0.5, 0.9, 0.99] {
            let cut = &whole[..(whole.len() as f64 * share) as usize];
            assert_refused(name, cut, "damaged");
        }
        assert_eq!(open(&file(name, &whole).path).unwrap().dimensions(), (200, 120));
    }
}

#[test]
fn headers_that_promise_too_much_are_refused_before_memory_is_taken() {
    let mut png = encoded(&GrayImage::new(1, 1).into(), ImageFormat::Png);
    png[16..24].copy_from_slice(&[0, 0, 0xea, 0x60, 0, 0, 0xea, 0x60]);
    let checksum = crc32(&png[12..29]);
    png[29..33].copy_from_slice(&checksum.to_be_bytes());
    assert_refused("huge.png", &png, "60000 x 60000 pixels are more than the 200 megapixels");

    let mut jpeg = encoded(&detailed(), ImageFormat::Jpeg);
    let frame = jpeg.windows(2).position(|two| two == [0xff, 0xc0]).unwrap();
    jpeg[frame + 5..frame + 9].copy_from_slice(&[0xea, 0x60, 0xea, 0x60]);
    assert_refused("huge.jpg", &jpeg, "60000 x 60000");

    let mut gif = encoded(&detailed(), ImageFormat::Gif);
    gif[6..10].copy_from_slice(&[0x60, 0xea, 0x60, 0xea]);
    assert_refused("huge.gif", &gif, "60000 x 60000");

    let small = file("small.png", &encoded(&detailed(), ImageFormat::Png));
    let refused = load_rgb(&small.path, LoadLimits { pixels: 23_999 }).unwrap_err();
    assert!(matches!(refused, PictureError::TooLarge { width: 200, height: 120, .. }), "{refused}");
    load_rgb(&small.path, LoadLimits { pixels: 24_000 }).unwrap();
}

/// CRC-32 of a PNG chunk.
fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(u32::MAX, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |c, _| if c & 1 == 1 { 0xedb8_8320 ^ (c >> 1) } else { c >> 1 })
    })
}

#[test]
fn a_single_pixel_is_a_picture() {
    let file = file("one.png", &encoded(&GrayImage::from_pixel(1, 1, Luma([77])).into(), ImageFormat::Png));
    assert_eq!(open(&file.path).unwrap().get_pixel(0, 0).0, [77]);
}

#[test]
fn inks_become_light() {
    // White on the left, 200 of 255 of black ink on the right.
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/cmyk.jpg");
    let picture = open(&path).unwrap();
    assert!(picture.get_pixel(2, 2).0[0] >= 250, "{:?}", picture.get_pixel(2, 2));
    assert!((50..=60).contains(&picture.get_pixel(12, 2).0[0]), "{:?}", picture.get_pixel(12, 2));
}

#[test]
fn sixteen_bits_become_eight() {
    let deep: ImageBuffer<Luma<u16>, Vec<u16>> =
        ImageBuffer::from_fn(4, 1, |x, _| Luma([[0, 257 * 100, 257 * 200, 65535][x as usize]]));
    for format in [ImageFormat::Png, ImageFormat::Tiff] {
        let file = file("deep", &encoded(&DynamicImage::ImageLuma16(deep.clone()), format));
        assert_eq!(open(&file.path).unwrap().into_raw(), [0, 100, 200, 255]);
    }
}

#[test]
fn transparent_parts_show_white_paper() {
    let picture = RgbaImage::from_fn(3, 1, |x, _| Rgba([0, 0, 0, [0, 128, 255][x as usize]]));
    let file = file("clear.png", &encoded(&picture.into(), ImageFormat::Png));
    assert_eq!(open(&file.path).unwrap().into_raw(), [255, 127, 0]);
}

#[test]
fn a_moving_picture_is_refused_and_a_still_gif_is_not() {
    let mut bytes = Vec::new();
    let frame = |grey: u8| Frame::new(RgbaImage::from_pixel(8, 8, Rgba([grey, grey, grey, 255])));
    GifEncoder::new(&mut bytes).encode_frames([frame(0), frame(200)]).unwrap();
    assert_refused("moving.gif", &bytes, "unpack its frames into a folder");
    let mut still = Vec::new();
    GifEncoder::new(&mut still).encode_frames([frame(90)]).unwrap();
    assert_eq!(open(&file("still.gif", &still).path).unwrap().get_pixel(3, 3).0, [90]);
}

#[test]
fn a_wrong_extension_does_not_matter() {
    let file = file("picture.jpg", &encoded(&detailed(), ImageFormat::Png));
    assert_eq!(open(&file.path).unwrap().dimensions(), (200, 120));
}
