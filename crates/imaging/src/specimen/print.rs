//! The mount: page, gutters, print, hand-written numbers, the fold.

use ab_glyph::{Font, FontRef, OutlineCurve};
use muybridge_core::Random;

use super::layout::{Layout, PRINT_PX};
use super::paint::Canvas;
use super::raster::{Point, Shape, Window, add, between, scaled, sub};
use super::style::{Mount, SpecimenStyle};
use super::{NOTICE, SpecimenMotion};

/// What a scan shows beyond the page.
const SCANNER_TONE: f64 = 244.0;
/// Print on paper, and on a black mount.
const INK: f64 = 48.0;
const PALE_INK: f64 = 190.0;
/// Straight pieces a curve of a letter is drawn with.
const CURVE_STEPS: usize = 5;

/// The empty mount on its page.
pub(super) fn mounted(layout: &Layout, style: &SpecimenStyle) -> Canvas {
    let [width, height] = layout.size_px;
    let mut plate = Canvas::new(Window { left: 0, top: 0, width, height }, SCANNER_TONE);
    let page = &layout.page;
    let rectangle = |[left, top, right, bottom]: [f64; 4]| {
        let corners = [[left, top], [right, top], [right, bottom], [left, bottom]];
        Shape::polygon(corners.map(|corner| page.plate_from_page(corner)).to_vec())
    };
    plate.fill(&[rectangle([0.0, 0.0, page.size[0], page.size[1]])], style.tones.page, 1.0);
    plate.fill(&[rectangle(page.mount)], style.tones.mount, 1.0);
    plate
}

/// Print, numbers and fold, over the mounted photographs.
pub(super) fn ink(
    plate: &mut Canvas,
    layout: &Layout,
    motion: &SpecimenMotion,
    style: &SpecimenStyle,
    random: &mut Random,
) {
    let page = &layout.page;
    let on_dark = style.mount == Mount::Dark && style.tones.page == style.tones.mount;
    let tone = if on_dark { PALE_INK } else { INK };
    let lines = printed(motion, style);
    let step = PRINT_PX / (lines.len() as f64 + 1.0);
    let script = Script {
        height_px: (0.75 * step).min(18.0).min(1.3 * page.size[0] / NOTICE.len() as f64),
        right: page.direction([1.0, 0.0]),
        down: page.direction([0.0, 1.0]),
    };
    for (i, line) in lines.iter().enumerate() {
        let middle = [0.5 * page.size[0], page.size[1] - PRINT_PX + step * (i as f64 + 0.8)];
        plate.fill(&text(line, page.plate_from_page(middle), &script), tone, 0.9);
    }
    if style.numbers {
        let number_tone = if style.tones.ground > 110.0 { 30.0 } else { 225.0 };
        for panel in &layout.panels {
            let strokes = hand_written(panel.camera.panel, &panel.quad_px, style, random);
            plate.fill(&strokes, number_tone, 0.9);
        }
    }
    if style.fold {
        fold(plate, layout, random);
    }
}

/// The lines of print under the panels, top to bottom.
pub(super) fn printed(motion: &SpecimenMotion, style: &SpecimenStyle) -> Vec<String> {
    let mut lines = Vec::new();
    if style.caption {
        lines.push(format!("THE HORSE IN MOTION: {}", motion.gait.name().to_uppercase()));
    }
    lines.push(NOTICE.to_string());
    lines
}

/// Size and direction of lettering.
pub(super) struct Script {
    /// Height of a line, px.
    pub(super) height_px: f64,
    /// Unit vectors of the plate.
    pub(super) right: Point,
    pub(super) down: Point,
}

/// Letters centred on a point.
pub(super) fn text(line: &str, middle_px: Point, script: &Script) -> Vec<Shape> {
    let Ok(font) = FontRef::try_from_slice(epaint_default_fonts::HACK_REGULAR) else { return Vec::new() };
    let scale = script.height_px / f64::from(font.height_unscaled());
    let ids: Vec<_> = line.chars().map(|letter| font.glyph_id(letter)).collect();
    let width: f64 = ids.iter().map(|id| f64::from(font.h_advance_unscaled(*id))).sum();
    // Capitals and figures stand between the base line and seven tenths of the ascent.
    let drop = 0.5 * 0.78 * f64::from(font.ascent_unscaled());
    let mut shapes = Vec::new();
    let mut pen = -0.5 * width;
    for id in ids {
        if let Some(outline) = font.outline(id) {
            let place = |at: ab_glyph::Point| {
                let (x, y) = ((pen + f64::from(at.x)) * scale, (drop - f64::from(at.y)) * scale);
                add(middle_px, add(scaled(script.right, x), scaled(script.down, y)))
            };
            shapes.push(Shape::Outlines(contours(&outline.curves, place)));
        }
        pen += f64::from(font.h_advance_unscaled(id));
    }
    shapes
}

/// A letter's curves as closed lines.
fn contours(curves: &[OutlineCurve], place: impl Fn(ab_glyph::Point) -> Point) -> Vec<Vec<Point>> {
    let mut lines: Vec<Vec<Point>> = Vec::new();
    let mut end = None;
    for curve in curves {
        let points = match curve {
            OutlineCurve::Line(a, b) => vec![*a, *b],
            OutlineCurve::Quad(a, b, c) => vec![*a, *b, *c],
            OutlineCurve::Cubic(a, b, c, d) => vec![*a, *b, *c, *d],
        };
        if end != points.first().copied() {
            lines.push(Vec::new());
        }
        end = points.last().copied();
        let corners: Vec<Point> = points.into_iter().map(&place).collect();
        if let Some(line) = lines.last_mut() {
            line.extend((0..CURVE_STEPS).map(|i| bezier(&corners, i as f64 / CURVE_STEPS as f64)));
        }
    }
    lines
}

/// Point of a Bézier curve of any degree (de Casteljau).
fn bezier(corners: &[Point], share: f64) -> Point {
    let mut left = corners.to_vec();
    while left.len() > 1 {
        left = left.windows(2).map(|two| between(two[0], two[1], share)).collect();
    }
    left.first().copied().unwrap_or_default()
}

/// Pen strokes of the figures 0 to 9 in a box of width 1 and height 2, y down.
const FIGURES: [&[Point]; 10] = [
    &[[0.6, 0.0], [0.1, 0.5], [0.05, 1.5], [0.5, 2.0], [0.9, 1.4], [0.9, 0.6], [0.6, 0.0]],
    &[[0.3, 0.4], [0.65, 0.0], [0.5, 1.0], [0.4, 2.0]],
    &[[0.1, 0.5], [0.4, 0.0], [0.9, 0.3], [0.7, 1.0], [0.0, 1.9], [0.5, 1.8], [1.0, 2.0]],
    &[[0.1, 0.2], [0.6, 0.0], [0.9, 0.4], [0.4, 0.9], [0.9, 1.3], [0.7, 1.9], [0.0, 1.9]],
    &[[0.6, 0.0], [0.0, 1.2], [1.0, 1.2], [0.7, 0.7], [0.6, 2.0]],
    &[[0.95, 0.05], [0.3, 0.0], [0.15, 0.8], [0.8, 0.9], [0.8, 1.7], [0.1, 2.0]],
    &[[0.8, 0.0], [0.2, 0.8], [0.1, 1.6], [0.5, 2.0], [0.9, 1.5], [0.6, 1.0], [0.15, 1.3]],
    &[[0.0, 0.1], [0.95, 0.0], [0.5, 1.0], [0.3, 2.0]],
    &[[0.8, 0.2], [0.4, 0.0], [0.2, 0.5], [0.9, 1.4], [0.5, 2.0], [0.1, 1.5], [0.85, 0.5], [0.7, 0.1]],
    &[[0.85, 0.3], [0.4, 0.0], [0.15, 0.6], [0.5, 0.95], [0.85, 0.4], [0.6, 2.0]],
];

/// A panel's number in ink, in its lower left corner.
fn hand_written(number: u32, quad_px: &[Point; 4], style: &SpecimenStyle, random: &mut Random) -> Vec<Shape> {
    let height = (0.055 * style.panel_px[1]).max(9.0);
    let unit = |a: Point, b: Point| {
        let d = sub(b, a);
        scaled(d, 1.0 / d[0].hypot(d[1]).max(f64::MIN_POSITIVE))
    };
    let (right, down) = (unit(quad_px[3], quad_px[2]), unit(quad_px[0], quad_px[3]));
    let corner = add(
        quad_px[3],
        add(scaled(right, (0.4 + 0.6 * random.uniform()) * height), scaled(down, -1.35 * height)),
    );
    let slant = random.between(0.0, 0.35);
    let mut shapes = Vec::new();
    for (place, figure) in number.to_string().bytes().map(|byte| usize::from(byte - b'0')).enumerate() {
        let points: Vec<Point> = FIGURES[figure]
            .iter()
            .map(|[x, y]| {
                let x = 0.5 * x + 0.62 * place as f64 + slant * (1.0 - 0.5 * y) + random.between(-0.03, 0.03);
                let y = 0.5 * y + random.between(-0.03, 0.03);
                add(corner, add(scaled(right, x * height), scaled(down, y * height)))
            })
            .collect();
        let pen = 0.045 * height;
        shapes.extend(points.windows(2).map(|two| {
            Shape::Capsule([
                (two[0], pen * random.between(0.8, 1.6)),
                (two[1], pen * random.between(0.8, 1.6)),
            ])
        }));
    }
    shapes
}

/// A page fold: a soft shadow to both sides of a pale line, down a gutter near the page's middle.
fn fold(plate: &mut Canvas, layout: &Layout, random: &mut Random) {
    let page = &layout.page;
    let from_middle = |x: &f64| (x - 0.5 * page.size[0]).abs();
    let Some(x) = layout.gutters_x.iter().copied().min_by(|a, b| from_middle(a).total_cmp(&from_middle(b)))
    else {
        return;
    };
    let lean = random.between(-2.0, 2.0);
    let [a, b] = [[x - lean, 0.0], [x + lean, page.size[1]]].map(|at| page.plate_from_page(at));
    for width in [26.0, 16.0, 8.0] {
        plate.fill(&[Shape::stroke(a, b, width)], 20.0, 0.13);
    }
    plate.fill(&[Shape::stroke(add(a, [1.0, 0.0]), add(b, [1.0, 0.0]), 1.6)], 215.0, 0.8);
}
