//! One photograph: wall, track, horse and rider through one camera; and what time does to the whole plate.

use image::imageops::{FilterType, resize};
use image::{GrayImage, Luma};
use imageproc::filter::gaussian_blur_f32;
use muybridge_core::Random;

use super::layout::{Layout, PanelLayout};
use super::limb::Viewer;
use super::paint::{Canvas, Layer, Part};
use super::raster::{Field, Mask, Point, Shape};
use super::scene::Scene;
use super::style::SpecimenStyle;
use super::{PosedHorse, Silhouette, SpecimenMotion, horse, rider};

/// How dark the shadowed half of a panel becomes.
const SHADOW_LEFT: f32 = 0.16;

/// A photograph before it is mounted.
pub(super) struct Photograph {
    canvas: Canvas,
    /// What stands in front of what, the farthest first.
    covers: Vec<(Part, Mask)>,
    /// How it is cut.
    print: Mask,
}

impl Photograph {
    pub(super) fn take(
        layout: &Layout,
        panel: &PanelLayout,
        pose: &PosedHorse,
        motion: &SpecimenMotion,
        style: &SpecimenStyle,
        random: &mut Random,
    ) -> Self {
        let view = Viewer::new(&panel.camera, motion.withers_height_m);
        let mut canvas = Canvas::new(panel.window(layout.size_px), style.tones.wall);
        let scene = Scene { panel, style, view: &view };
        scene.paint(&mut canvas, random);
        scene.paint_shadow(&mut canvas, pose);
        let mut covers = Vec::new();
        for layer in horse::layers(&view, pose, motion, &style.tones) {
            covers.push((layer.part, layer.paint(&mut canvas, style.tones.horse, style.shading)));
        }
        if style.rider {
            for (layer, tone) in rider::layers(&view, pose, style) {
                covers.push((layer.part, layer.paint(&mut canvas, tone, style.shading)));
            }
            rider::paint_reins(&view, pose, &mut canvas);
        }
        if let Some(hurdle) = motion.hurdle {
            let shapes = scene.hurdle(hurdle.x_m - layout.origin_x_m, hurdle.height_m);
            let layer = Layer::new(Part::Hurdle, shapes, 1.0);
            covers.push((layer.part, layer.paint(&mut canvas, style.tones.uprights, style.shading)));
        }
        let print = Mask::of(&[Shape::polygon(panel.quad_px.to_vec())], canvas.window, 0.0);
        let mut photograph = Self { canvas, covers, print };
        photograph.light(panel, style);
        photograph
    }

    /// Whether something in front of a part hides a point of it.
    pub(super) fn hides(&self, part: Part, at_px: Point) -> bool {
        self.covers.iter().any(|(front, mask)| *front > part && mask.at(at_px) > 0.5)
    }

    /// Which pixels show horse and rider and not the hurdle before them.
    pub(super) fn silhouette(&self) -> Silhouette {
        let window = self.canvas.window;
        let mut cover = Field::new(window.width, window.height);
        for (part, mask) in &self.covers {
            for (x, y, value) in mask.cover.enumerate_pixels() {
                let (x, y) = (mask.window.left + x - window.left, mask.window.top + y - window.top);
                let here = &mut cover.get_pixel_mut(x, y).0[0];
                *here = if *part == Part::Hurdle { here.min(1.0 - value.0[0]) } else { here.max(value.0[0]) };
            }
        }
        let mask = GrayImage::from_fn(window.width, window.height, |x, y| {
            let place = [f64::from(window.left + x) + 0.5, f64::from(window.top + y) + 0.5];
            Luma([(255.0 * cover.get_pixel(x, y).0[0].min(self.print.at(place))).round() as u8])
        });
        Silhouette { left_px: window.left, top_px: window.top, mask }
    }

    /// Darker corners, and the shadow over half a panel.
    fn light(&mut self, panel: &PanelLayout, style: &SpecimenStyle) {
        let (width, height) = (self.canvas.window.width as f32, self.canvas.window.height as f32);
        let shadowed = style.shadowed_panel == Some(panel.camera.panel);
        for (x, y, tone) in self.canvas.tones.enumerate_pixels_mut() {
            let (u, v) = (2.0 * x as f32 / width - 1.0, 2.0 * y as f32 / height - 1.0);
            let mut light = 1.0 - style.light_falloff as f32 * 0.5 * (u * u + v * v);
            if shadowed {
                // From full light left of the middle to full shadow a quarter of the panel before its right edge.
                let share = ((u + 0.2) / 0.7).clamp(0.0, 1.0);
                light *= 1.0 - (1.0 - SHADOW_LEFT) * share * share * (3.0 - 2.0 * share);
            }
            tone.0[0] *= light;
        }
    }

    /// Puts the print on the plate.
    pub(super) fn paste(&self, plate: &mut Canvas) {
        let (print, window) = (self.print.window, self.canvas.window);
        let [dx, dy] = [print.left - window.left, print.top - window.top];
        plate.lay(&self.print, |x, y| self.canvas.tones.get_pixel(x + dx, y + dy).0[0], 1.0);
    }
}

/// Smooth noise of standard deviation about 1 whose features are as large as `cell_px`.
pub(super) fn mottle(width: u32, height: u32, cell_px: [f64; 2], random: &mut Random) -> Field {
    if width == 0 || height == 0 {
        return Field::new(width, height);
    }
    let cells = |size: u32, cell: f64| (f64::from(size) / cell).ceil() as u32 + 2;
    let (columns, rows) = (cells(width, cell_px[0]), cells(height, cell_px[1]));
    let coarse = Field::from_fn(columns, rows, |_, _| Luma([random.normal() as f32]));
    resize(&coarse, width, height, FilterType::Triangle)
}

/// The finished picture: fold, blur, grain, scratches.
pub(super) fn developed(
    plate: Canvas,
    layout: &Layout,
    style: &SpecimenStyle,
    random: &mut Random,
) -> GrayImage {
    let [width, height] = layout.size_px;
    let mut tones = plate.tones;
    if style.blur_px > 0.0 && width > 0 && height > 0 {
        tones = gaussian_blur_f32(&tones, style.blur_px as f32);
    }
    let mut canvas = Canvas { window: plate.window, tones };
    scratch(&mut canvas, layout, style, random);
    let grain = grain(width, height, style.grain_sd.max(0.0), random);
    GrayImage::from_fn(width, height, |x, y| {
        Luma([
            (canvas.tones.get_pixel(x, y).0[0] + grain.get_pixel(x, y).0[0]).round().clamp(0.0, 255.0) as u8
        ])
    })
}

/// Grain clumped over about two pixels, as scanned prints show it: the sum of four neighbours' even chances, which is
/// near enough to normal.
fn grain(width: u32, height: u32, sd: f64, random: &mut Random) -> Field {
    // A sum of four uniform numbers has a variance of four twelfths.
    let gain = sd * 3.0f64.sqrt();
    let rough =
        Field::from_fn(width + 1, height + 1, |_, _| Luma([(gain * (random.uniform() - 0.5)) as f32]));
    Field::from_fn(width, height, |x, y| {
        let at = |dx: u32, dy: u32| rough.get_pixel(x + dx, y + dy).0[0];
        Luma([at(0, 0) + at(1, 0) + at(0, 1) + at(1, 1)])
    })
}

/// Fine lines and specks, white or black, anywhere on the plate.
fn scratch(canvas: &mut Canvas, layout: &Layout, style: &SpecimenStyle, random: &mut Random) {
    let [width, height] = layout.size_px.map(f64::from);
    for _ in 0..style.scratches {
        let at = [random.between(0.0, width), random.between(0.0, height)];
        let tone = if random.uniform() < 0.6 { 225.0 } else { 25.0 };
        let shape = if random.uniform() < 0.5 {
            let way = [random.between(-12.0, 12.0), random.between(-40.0, 40.0)];
            Shape::stroke(at, [at[0] + way[0], at[1] + way[1]], random.between(0.5, 1.1))
        } else {
            let radius = random.between(0.6, 2.0);
            Shape::Capsule([
                (at, radius),
                ([at[0] + random.between(-2.0, 2.0), at[1] + random.between(-2.0, 2.0)], radius),
            ])
        };
        canvas.fill(&[shape], tone, random.between(0.3, 0.8));
    }
}
