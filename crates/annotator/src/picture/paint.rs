//! Drawing a picture, or one panel of it, with the tiles that are there.

use egui::epaint::{Mesh, Vertex};
use egui::{Color32, Painter, Pos2, Rect, Shape};
use muybridge_imaging::PanelTransform;

use super::patch::{self, Corner, Polygon};
use super::pyramid::Pyramid;
use super::textures::PlateTextures;
use super::tiles::TileKey;
use super::view_transform::ViewTransform;

/// From this many screen pixels per plate px on, the plate's pixels are shown as squares.
const SQUARES_FROM: f64 = 3.0;

/// Which picture is drawn.
#[derive(Clone, Copy, Debug)]
pub struct Source<'a> {
    /// Number of the picture in the plate; the textures know it by this.
    pub image: usize,
    /// Its pixels.
    pub pyramid: &'a Pyramid,
}

/// How a picture is laid over what is below.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// 0 unseen, 1 opaque.
    pub opacity: f32,
    /// Multiplies the colours; white leaves them.
    pub tint: Color32,
}

impl Default for Look {
    fn default() -> Self {
        Self { opacity: 1.0, tint: Color32::WHITE }
    }
}

impl PlateTextures {
    /// Draws what the painter's clip rectangle shows of a picture.
    pub fn draw(&mut self, painter: &Painter, source: Source<'_>, view: &ViewTransform, look: Look) {
        let size = source.pyramid.size_px().map(f64::from);
        let corner_at = |u: f64, v: f64| {
            let at_px = [u * size[0], v * size[1]];
            let [x, y] = view.place(at_px);
            [at_px[0], at_px[1], x, y]
        };
        self.draw_patch(painter, source, corner_at, look);
    }

    /// Draws one panel squared up into a rectangle of the screen. `quad_px` is its top left, top right, bottom right and
    /// bottom left corner on the plate; one that is not convex is drawn without perspective.
    pub fn draw_quad(
        &mut self,
        painter: &Painter,
        source: Source<'_>,
        quad_px: [[f64; 2]; 4],
        into: Rect,
        look: Look,
    ) {
        let perspective = PanelTransform::new(quad_px, [1.0, 1.0]);
        let corner_at = |u: f64, v: f64| {
            let plate_px = match &perspective {
                Some(transform) => transform.plate_from_panel([u, v]),
                None => bilinear(quad_px, u, v),
            };
            let [x, y] = [f64::from(into.left()), f64::from(into.top())];
            [plate_px[0], plate_px[1], x + u * f64::from(into.width()), y + v * f64::from(into.height())]
        };
        self.draw_patch(painter, source, corner_at, look);
    }

    /// Draws one panel where a map from plate px to screen points takes it: another photograph laid over this one.
    pub fn draw_mapped(
        &mut self,
        painter: &Painter,
        source: Source<'_>,
        quad_px: [[f64; 2]; 4],
        screen_from_plate: impl Fn([f64; 2]) -> Pos2,
        look: Look,
    ) {
        let corner_at = |u: f64, v: f64| {
            let at_px = bilinear(quad_px, u, v);
            let screen = screen_from_plate(at_px);
            [at_px[0], at_px[1], f64::from(screen.x), f64::from(screen.y)]
        };
        self.draw_patch(painter, source, corner_at, look);
    }

    fn draw_patch(
        &mut self,
        painter: &Painter,
        source: Source<'_>,
        corner_at: impl Fn(f64, f64) -> Corner,
        look: Look,
    ) {
        let Source { image, pyramid } = source;
        let clip = painter.clip_rect();
        let pixels_per_point = f64::from(painter.pixels_per_point());
        let triangles = patch::triangles(corner_at, pixels_per_point);
        let pixels_per_px = patch::scale(&triangles) * pixels_per_point;
        if !(pixels_per_px > 0.0 && pixels_per_px.is_finite() && clip.is_positive() && look.opacity > 0.0) {
            return;
        }
        let level = (-pixels_per_px.log2()).round().clamp(0.0, (pyramid.levels().len() - 1) as f64) as usize;
        let squares = pixels_per_px >= SQUARES_FROM;
        let [width, height] = pyramid.size_px().map(f64::from);
        let bounds = [
            [0.0, 0.0, f64::from(clip.left()), f64::from(clip.top())],
            [width, height, f64::from(clip.right()), f64::from(clip.bottom())],
        ];
        let tiles = patch::by_tile(&triangles, bounds, level);
        let key = |&(row, column): &(u32, u32)| TileKey { image, level, row, column, squares };
        let wanted: Vec<TileKey> = tiles.keys().map(key).collect();
        if wanted.is_empty() {
            return;
        }
        self.provide(painter.ctx(), pyramid, image, &wanted);
        let color = look.tint.gamma_multiply(look.opacity.min(1.0));
        for (wanted, polygons) in wanted.into_iter().zip(tiles.values()) {
            if let Some((tile, texture, size)) = self.best(pyramid, wanted) {
                let mut mesh = Mesh::with_texture(texture);
                polygons.iter().for_each(|polygon| add(&mut mesh, polygon, tile, size, color));
                painter.add(Shape::mesh(mesh));
            }
        }
    }
}

/// A convex polygon as a fan of triangles.
fn add(mesh: &mut Mesh, polygon: &Polygon, tile: TileKey, texture_size: [usize; 2], color: Color32) {
    let first = mesh.vertices.len() as u32;
    mesh.vertices.extend(polygon.iter().map(|&[plate_x, plate_y, x, y]| Vertex {
        pos: egui::pos2(x as f32, y as f32),
        uv: tile.uv([plate_x, plate_y], texture_size),
        color,
    }));
    for i in 2..polygon.len() as u32 {
        mesh.add_triangle(first, first + i - 1, first + i);
    }
}

fn bilinear([a, b, c, d]: [[f64; 2]; 4], u: f64, v: f64) -> [f64; 2] {
    let mix = |i: usize| (1.0 - v) * ((1.0 - u) * a[i] + u * b[i]) + v * ((1.0 - u) * d[i] + u * c[i]);
    [mix(0), mix(1)]
}
