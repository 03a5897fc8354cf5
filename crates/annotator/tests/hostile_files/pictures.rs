//! Pictures that are none, or not any more.

use std::io::Cursor;
use std::path::Path;

use image::{ImageFormat, RgbImage};
use muybridge_core::Random;

use super::{Dropped, write};

const FORMATS: [(ImageFormat, &str); 4] = [
    (ImageFormat::Jpeg, "jpg"),
    (ImageFormat::Png, "png"),
    (ImageFormat::Tiff, "tif"),
    (ImageFormat::Gif, "gif"),
];

/// A noisy picture in some format.
fn picture(format: ImageFormat) -> Vec<u8> {
    let mut random = Random::new(5);
    let noisy =
        RgbImage::from_fn(80, 60, |_, _| image::Rgb([0; 3].map(|_: u8| random.between(0.0, 255.0) as u8)));
    let mut bytes = Cursor::new(Vec::new());
    noisy.write_to(&mut bytes, format).unwrap();
    bytes.into_inner()
}

/// The check of a chunk, so that a claimed size is believed (CRC-32).
fn png_check(chunk: &[u8]) -> u32 {
    let bit = |crc: u32, _: u32| (crc >> 1) ^ (0xedb8_8320 & (crc & 1).wrapping_neg());
    !chunk.iter().fold(!0, |crc, byte| (0..8).fold(crc ^ u32::from(*byte), bit))
}

pub(super) fn pictures(folder: &Path) -> Vec<Dropped> {
    std::fs::create_dir_all(folder).unwrap();
    let mut files = Vec::new();
    let mut add = |name: String, content: &[u8], may_open: bool| {
        let path = folder.join(name);
        write(&path, content);
        files.push(Dropped { path, may_open });
    };
    let mut random = Random::new(11);
    for (format, ending) in FORMATS {
        let whole = picture(format);
        for share in [0.02, 0.3, 0.7, 0.98] {
            let cut = (share * whole.len() as f64) as usize;
            // The end of a GIF can be missed without missing a pixel.
            add(format!("cut-{share}.{ending}"), &whole[..cut], format == ImageFormat::Gif && share > 0.9);
        }
        for changes in [1, 10, 200] {
            let mut damaged = whole.clone();
            for _ in 0..changes {
                let at = random.between(0.0, damaged.len() as f64) as usize;
                damaged[at] = random.between(0.0, 256.0) as u8;
            }
            add(format!("damaged-{changes}.{ending}"), &damaged, true);
        }
        add(format!("nothing.{ending}"), b"", false);
        add(format!("text.{ending}"), b"This is a letter and no picture.\n", false);
    }
    for (name, size) in
        [("vast", [60_000, 60_000]), ("vaster", [u32::MAX, u32::MAX]), ("without-size", [0, 0])]
    {
        let mut claiming = picture(ImageFormat::Png);
        claiming[16..20].copy_from_slice(&u32::to_be_bytes(size[0]));
        claiming[20..24].copy_from_slice(&u32::to_be_bytes(size[1]));
        let check = png_check(&claiming[12..29]);
        claiming[29..33].copy_from_slice(&check.to_be_bytes());
        add(format!("{name}.png"), &claiming, false);
    }
    let mut ring = picture(ImageFormat::Tiff);
    // The directory of a TIFF begins where its header says: at the header.
    ring[4..8].copy_from_slice(&[0; 4]);
    add("ring.tif".into(), &ring, false);
    add("program.jpg".into(), b"\x7fELF\x02\x01\x01\0\0\0\0\0", false);
    let mut noise: Vec<u8> = (0..5000).map(|_| random.between(0.0, 256.0) as u8).collect();
    add("noise".into(), &noise, false);
    noise[..3].copy_from_slice(&[0xff, 0xd8, 0xff]);
    add("noise.jpg".into(), &noise, false);
    add("documents-as.png".into(), b"{\"schema\": 1, \"plate\": \"x\", \"annotator\": \"\"}", false);
    files
}
