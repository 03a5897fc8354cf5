//! One photograph of a plate, cut out along its quadrilateral and squared up.

use image::{GrayImage, Luma};

/// A point: x right, y down.
type Point = [f64; 2];

/// The projective map between a panel and its quadrilateral on the plate, both ways.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PanelTransform {
    plate_from_panel: [[f64; 3]; 3],
    panel_from_plate: [[f64; 3]; 3],
}

impl PanelTransform {
    /// The map that takes the corners of a `width` x `height` rectangle (top left, top right, bottom right, bottom left)
    /// to those of a quadrilateral on the plate; none when the quadrilateral is not convex or has no area.
    pub fn new(quad_px: [Point; 4], [width, height]: [f64; 2]) -> Option<Self> {
        if !(is_convex(&quad_px) && width > 0.0 && height > 0.0) {
            return None;
        }
        let unit = plate_from_unit_square(&quad_px)?;
        let scale = [1.0 / width, 1.0 / height, 1.0];
        let plate_from_panel = unit.map(|row| [row[0] * scale[0], row[1] * scale[1], row[2] * scale[2]]);
        Some(Self { plate_from_panel, panel_from_plate: inverse(&plate_from_panel)? })
    }

    /// A panel point in plate px.
    pub fn plate_from_panel(&self, point_in_panel_px: Point) -> Point {
        apply(&self.plate_from_panel, point_in_panel_px)
    }

    /// A plate point in panel px.
    pub fn panel_from_plate(&self, point_in_plate_px: Point) -> Point {
        apply(&self.panel_from_plate, point_in_plate_px)
    }
}

/// Corners turn one way all round (clockwise as seen, y pointing down).
fn is_convex(quad: &[Point; 4]) -> bool {
    (0..4).all(|i| {
        let ([ax, ay], [bx, by], [cx, cy]) = (quad[i], quad[(i + 1) % 4], quad[(i + 2) % 4]);
        (bx - ax) * (cy - by) - (by - ay) * (cx - bx) > 0.0
    })
}

/// Heckbert, *Fundamentals of texture mapping and image warping* (1989), section 2.2.3.
fn plate_from_unit_square(&[[x0, y0], [x1, y1], [x2, y2], [x3, y3]]: &[Point; 4]) -> Option<[[f64; 3]; 3]> {
    let (sx, sy) = (x0 - x1 + x2 - x3, y0 - y1 + y2 - y3);
    let (dx1, dx2, dy1, dy2) = (x1 - x2, x3 - x2, y1 - y2, y3 - y2);
    let determinant = dx1 * dy2 - dx2 * dy1;
    if determinant == 0.0 {
        return None;
    }
    let g = (sx * dy2 - dx2 * sy) / determinant;
    let h = (dx1 * sy - sx * dy1) / determinant;
    Some([[x1 - x0 + g * x1, x3 - x0 + h * x3, x0], [y1 - y0 + g * y1, y3 - y0 + h * y3, y0], [g, h, 1.0]])
}

fn inverse(m: &[[f64; 3]; 3]) -> Option<[[f64; 3]; 3]> {
    let cofactor = |row: usize, column: usize| {
        let ([r0, r1], [c0, c1]) = ([(row + 1) % 3, (row + 2) % 3], [(column + 1) % 3, (column + 2) % 3]);
        m[r0][c0] * m[r1][c1] - m[r0][c1] * m[r1][c0]
    };
    let determinant: f64 = (0..3).map(|column| m[0][column] * cofactor(0, column)).sum();
    (determinant != 0.0 && determinant.is_finite())
        .then(|| std::array::from_fn(|i| std::array::from_fn(|j| cofactor(j, i) / determinant)))
}

fn apply(m: &[[f64; 3]; 3], [x, y]: Point) -> Point {
    let [u, v, w] = m.map(|row| row[0] * x + row[1] * y + row[2]);
    [u / w, v / w]
}

/// Width and height of a quadrilateral: the means of opposite sides, px.
pub(crate) fn side_lengths_px(quad_px: &[Point; 4]) -> [f64; 2] {
    let side = |a: usize, b: usize| (quad_px[a][0] - quad_px[b][0]).hypot(quad_px[a][1] - quad_px[b][1]);
    [0.5 * (side(0, 1) + side(3, 2)), 0.5 * (side(0, 3) + side(1, 2))]
}

/// One photograph, squared up.
#[derive(Clone, Debug)]
pub struct PanelView {
    /// The photograph, grey.
    pub image: GrayImage,
    /// Where it lies on the plate.
    pub transform: PanelTransform,
    /// Panel px per plate px: at most 1.
    pub scale: f64,
}

impl PanelView {
    /// Cuts a panel out of a plate. Its size is the mean of opposite sides in plate px, or smaller, so that the longer
    /// side has at most `longest_px`; where it is smaller, the plate is averaged over each pixel of the view.
    /// None when the quadrilateral is not convex or smaller than a pixel.
    pub fn new(plate: &GrayImage, quad_px: [Point; 4], longest_px: u32) -> Option<Self> {
        let [width, height] = side_lengths_px(&quad_px);
        let scale = (f64::from(longest_px) / width.max(height)).min(1.0);
        let size = [width, height].map(|v| (v * scale).round().max(1.0));
        let transform = PanelTransform::new(quad_px, size)?;
        let [columns, rows] = size.map(|v| v as u32);
        // Samples per pixel and axis: one for each plate pixel under it.
        let samples = (1.0 / scale).ceil() as u32;
        let image = GrayImage::from_fn(columns, rows, |x, y| {
            let mut sum = 0.0;
            for (i, j) in (0..samples).flat_map(|j| (0..samples).map(move |i| (i, j))) {
                let at = |k: u32, n: u32| f64::from(k) + (f64::from(n) + 0.5) / f64::from(samples);
                sum += sample(plate, transform.plate_from_panel([at(x, i), at(y, j)]));
            }
            Luma([(sum / f64::from(samples * samples)).round() as u8])
        });
        Some(Self { image, transform, scale })
    }
}

/// Grey value at a point, between four pixels; beyond the border the nearest pixel's.
fn sample(picture: &GrayImage, [x, y]: Point) -> f64 {
    let (right, bottom) = (f64::from(picture.width() - 1), f64::from(picture.height() - 1));
    let (x, y) = ((x - 0.5).clamp(0.0, right), (y - 0.5).clamp(0.0, bottom));
    let (x0, y0) = (x.floor(), y.floor());
    let (fx, fy) = (x - x0, y - y0);
    let at = |dx: u32, dy: u32| {
        let column = (x0 as u32 + dx).min(picture.width() - 1);
        let row = (y0 as u32 + dy).min(picture.height() - 1);
        f64::from(picture.get_pixel(column, row).0[0])
    };
    (1.0 - fy) * ((1.0 - fx) * at(0, 0) + fx * at(1, 0)) + fy * ((1.0 - fx) * at(0, 1) + fx * at(1, 1))
}

#[cfg(test)]
mod tests {
    use super::*;

    const QUAD: [Point; 4] = [[10.0, 12.0], [108.0, 9.0], [113.0, 70.0], [8.0, 74.0]];

    #[test]
    fn corners_meet_and_the_way_back_is_the_way_there() {
        let transform = PanelTransform::new(QUAD, [100.0, 60.0]).unwrap();
        let corners = [[0.0, 0.0], [100.0, 0.0], [100.0, 60.0], [0.0, 60.0]];
        for (corner, expected) in corners.into_iter().zip(QUAD) {
            let [x, y] = transform.plate_from_panel(corner);
            assert!((x - expected[0]).abs() < 1e-9 && (y - expected[1]).abs() < 1e-9);
        }
        for point in [[50.0, 30.0], [-20.0, 5.0], [3.0, 90.0]] {
            let [x, y] = transform.panel_from_plate(transform.plate_from_panel(point));
            assert!((x - point[0]).abs() < 1e-9 && (y - point[1]).abs() < 1e-9);
        }
    }

    #[test]
    fn a_folded_or_empty_quadrilateral_is_none() {
        let crossed = [QUAD[0], QUAD[2], QUAD[1], QUAD[3]];
        assert_eq!(PanelTransform::new(crossed, [1.0, 1.0]), None);
        assert_eq!(PanelTransform::new([QUAD[0]; 4], [1.0, 1.0]), None);
        assert_eq!(PanelTransform::new([[f64::NAN; 2]; 4], [1.0, 1.0]), None);
    }

    #[test]
    fn a_view_keeps_straight_pixels_and_averages_small_ones() {
        let plate = GrayImage::from_fn(80, 60, |x, y| Luma([(x + 2 * y) as u8]));
        let quad = [[10.0, 20.0], [50.0, 20.0], [50.0, 40.0], [10.0, 40.0]];
        let view = PanelView::new(&plate, quad, 1000).unwrap();
        assert_eq!(view.image.dimensions(), (40, 20));
        assert_eq!(view.image.get_pixel(3, 5), plate.get_pixel(13, 25));
        let half = PanelView::new(&plate, quad, 20).unwrap();
        assert_eq!(half.image.dimensions(), (20, 10));
        // Mean of x in {16, 17}, y in {30, 31}: 77.5.
        assert_eq!(half.image.get_pixel(3, 5).0[0], 78);
    }
}
