//! Drawing on a picture: smooth thick lines, marks and text.

use std::path::Path;

use ab_glyph::{FontRef, PxScale};
use anyhow::Context;
use image::{Rgb, RgbImage};
use imageproc::drawing::{
    draw_antialiased_polygon_mut, draw_filled_circle_mut, draw_hollow_circle_mut, draw_text_mut,
};
use imageproc::pixelops::interpolate;
use imageproc::point::Point;

use super::palette::{MOST_COLORS, Palette};

/// Writes a picture as PNG.
pub(super) fn write_picture(path: &Path, picture: &RgbImage) -> anyhow::Result<()> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    picture.write_to(&mut bytes, image::ImageFormat::Png).context("cannot encode the picture")?;
    Ok(muybridge_capture::write_atomically(path, bytes.get_ref())?)
}

/// Writes a picture as PNG with a palette: a third of the bytes of one without.
pub(super) fn write_few_colors(path: &Path, picture: &RgbImage) -> anyhow::Result<()> {
    let palette = Palette::choose(std::slice::from_ref(picture), MOST_COLORS);
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, picture.width(), picture.height());
    encoder.set_color(png::ColorType::Indexed);
    encoder.set_palette(palette.bytes());
    encoder.set_compression(png::Compression::High);
    encoder.set_filter(png::Filter::NoFilter);
    let encoded = encoder.write_header().and_then(|mut writer| {
        writer.write_image_data(&palette.indices(picture))?;
        writer.finish()
    });
    encoded.context("cannot encode the picture")?;
    Ok(muybridge_capture::write_atomically(path, &bytes)?)
}

/// Line thickness of bones, px of the drawn picture.
pub(super) const BONE_PX: f64 = 3.0;
const TEXT_PX: f32 = 16.0;

/// A picture with a font.
pub(super) struct Canvas {
    pub(super) picture: RgbImage,
    font: Option<FontRef<'static>>,
}

impl Canvas {
    pub(super) fn new(width: u32, height: u32, background: Rgb<u8>) -> Self {
        Self::of(RgbImage::from_pixel(width, height, background))
    }

    /// To draw on a picture that is there.
    pub(super) fn of(picture: RgbImage) -> Self {
        Self { picture, font: FontRef::try_from_slice(epaint_default_fonts::HACK_REGULAR).ok() }
    }

    /// A straight line of a thickness in px, with smooth edges; nothing when its ends coincide.
    pub(super) fn line(&mut self, [ax, ay]: [f64; 2], [bx, by]: [f64; 2], thickness: f64, colour: Rgb<u8>) {
        let (dx, dy) = (bx - ax, by - ay);
        let length = dx.hypot(dy);
        if length < 1.0 {
            return;
        }
        let (nx, ny) = (-dy / length * thickness / 2.0, dx / length * thickness / 2.0);
        let corner = |x: f64, y: f64| Point::new(x.round() as i32, y.round() as i32);
        let corners = [
            corner(ax + nx, ay + ny),
            corner(bx + nx, by + ny),
            corner(bx - nx, by - ny),
            corner(ax - nx, ay - ny),
        ];
        let distinct = (1..4).all(|i| !corners[..i].contains(&corners[i]));
        if distinct {
            draw_antialiased_polygon_mut(&mut self.picture, &corners, colour, interpolate);
        }
    }

    pub(super) fn dot(&mut self, [x, y]: [f64; 2], radius: i32, colour: Rgb<u8>) {
        draw_filled_circle_mut(&mut self.picture, (x.round() as i32, y.round() as i32), radius, colour);
    }

    pub(super) fn ring(&mut self, [x, y]: [f64; 2], radius: i32, colour: Rgb<u8>) {
        draw_hollow_circle_mut(&mut self.picture, (x.round() as i32, y.round() as i32), radius, colour);
        draw_hollow_circle_mut(&mut self.picture, (x.round() as i32, y.round() as i32), radius + 1, colour);
    }

    pub(super) fn text(&mut self, [x, y]: [f64; 2], text: &str, colour: Rgb<u8>) {
        if let Some(font) = &self.font {
            let scale = PxScale::from(TEXT_PX);
            draw_text_mut(&mut self.picture, colour, x.round() as i32, y.round() as i32, scale, font, text);
        }
    }
}
