//! Where panels lie on the plate, and the camera of each.

use muybridge_capture::PanelCamera;
use muybridge_core::Random;

use super::raster::{Point, Window, add, between, scaled, sub};
use super::style::{Mount, SpecimenStyle};
use super::{PosedHorse, SpecimenMotion};

/// Height of the ground line in a panel, as a share of the panel's height.
pub(super) const GROUND_SHARE: f64 = 0.13;
/// Horse before and behind its outermost joints (nose, streaming tail) and rider over its withers, in heights of the withers.
const REACH: Reach = Reach { ahead: 0.06, behind: 0.38, above: 0.05, rider: 0.66 };
/// Room between panels and caption and around the outermost gutter, px, when the mount is a card of its own.
const CARD_PX: f64 = 34.0;
/// Height of the strip under the panels that holds the lines of print, px.
pub(super) const PRINT_PX: f64 = 62.0;

struct Reach {
    ahead: f64,
    behind: f64,
    above: f64,
    rider: f64,
}

/// A page turned on the plate.
#[derive(Clone, Copy, Debug)]
pub(super) struct Page {
    /// Width and height, px.
    pub(super) size: Point,
    /// The part that holds panels and gutters: left, top, right, bottom, page px.
    pub(super) mount: [f64; 4],
    tilt_rad: f64,
    plate_centre: Point,
}

impl Page {
    /// A point of the page in plate px.
    pub(super) fn plate_from_page(&self, at: Point) -> Point {
        let centred = sub(at, scaled(self.size, 0.5));
        add(self.plate_centre, clockwise(centred, self.tilt_rad))
    }

    /// Direction on the plate of the page's `[right, down]`.
    pub(super) fn direction(&self, [right, down]: Point) -> Point {
        clockwise([right, down], self.tilt_rad)
    }
}

/// Turned clockwise as seen, y pointing down.
fn clockwise([x, y]: Point, angle_rad: f64) -> Point {
    let (sin, cos) = angle_rad.sin_cos();
    [cos * x - sin * y, sin * x + cos * y]
}

/// A photograph's place and camera.
#[derive(Clone, Copy, Debug)]
pub(super) struct PanelLayout {
    pub(super) quad_px: [Point; 4],
    pub(super) camera: PanelCamera,
}

impl PanelLayout {
    /// The part of a straight line that lies in the panel.
    pub(super) fn clip(&self, [a, b]: [Point; 2]) -> Option<[Point; 2]> {
        let (mut from, mut to) = (0.0f64, 1.0f64);
        for i in 0..4 {
            let (corner, edge) = (self.quad_px[i], sub(self.quad_px[(i + 1) % 4], self.quad_px[i]));
            let inside = |p: Point| edge[0] * (p[1] - corner[1]) - edge[1] * (p[0] - corner[0]);
            let (at_a, at_b) = (inside(a), inside(b));
            if at_a < 0.0 && at_b < 0.0 {
                return None;
            } else if at_a < 0.0 {
                from = from.max(at_a / (at_a - at_b));
            } else if at_b < 0.0 {
                to = to.min(at_a / (at_a - at_b));
            }
        }
        (from < to).then(|| [between(a, b, from), between(a, b, to)])
    }

    /// Distance of a point from the nearer side edge, px; negative outside.
    pub(super) fn side_distance_px(&self, point: Point) -> f64 {
        let [top_left, top_right, bottom_right, bottom_left] = self.quad_px;
        let inside = |a: Point, b: Point| {
            let ([dx, dy], [px, py]) = (sub(b, a), sub(point, a));
            (dx * py - dy * px) / dx.hypot(dy).max(f64::MIN_POSITIVE)
        };
        inside(top_right, bottom_right).min(inside(bottom_left, top_left))
    }

    /// The panel's window of the plate.
    pub(super) fn window(&self, plate_px: [u32; 2]) -> Window {
        Window::around(&self.quad_px, plate_px)
    }
}

/// All of a plate's geometry.
#[derive(Clone, Debug)]
pub(super) struct Layout {
    pub(super) size_px: [u32; 2],
    pub(super) page: Page,
    pub(super) panels: Vec<PanelLayout>,
    /// Middle of each gutter between columns, page px.
    pub(super) gutters_x: Vec<f64>,
    /// Distance between neighbouring cameras, m.
    pub(super) camera_spacing_m: f64,
    /// Where the first camera stands on the motion's track, m; the plate's own track begins there.
    pub(super) origin_x_m: f64,
}

impl Layout {
    pub(super) fn new(motion: &SpecimenMotion, style: &SpecimenStyle, random: &mut Random) -> Self {
        let columns = Line::new(style.columns, style.panel_px[0], style.gutter_px[0], style, random);
        let rows = Line::new(style.rows, style.panel_px[1], style.gutter_px[1], style, random);
        let page = page(columns.length, rows.length, style);
        let plate = [0, 1].map(|i| (2.0 * page.plate_centre[i]) as u32);
        let battery = Battery::new(motion, style);
        let cells =
            (0..style.rows as usize).flat_map(|row| (0..style.columns as usize).map(move |c| (row, c)));
        let panels = cells
            .zip(&motion.poses)
            .enumerate()
            .map(|(index, ((row, column), pose))| {
                let low = [page.mount[0] + columns.starts[column], page.mount[1] + rows.starts[row]];
                let quad = scattered_quad(low, style, random);
                let tilt = page.tilt_rad + style.panel_tilt_sd_deg.to_radians() * random.normal();
                let centre = centre(&quad);
                let quad_px = quad.map(|p| {
                    page.plate_from_page(add(centre, clockwise(sub(p, centre), tilt - page.tilt_rad)))
                });
                PanelLayout { quad_px, camera: battery.camera(index, pose, motion, quad_px, tilt) }
            })
            .collect();
        let gutters_x = columns.gutters.iter().map(|x| page.mount[0] + x).collect();
        Self {
            size_px: plate,
            page,
            panels,
            gutters_x,
            camera_spacing_m: battery.spacing_m,
            origin_x_m: battery.origin_x_m,
        }
    }
}

/// Cells along one axis.
struct Line {
    starts: Vec<f64>,
    /// Middle of each gap between cells.
    gutters: Vec<f64>,
    length: f64,
}

impl Line {
    fn new(cells: u32, cell: f64, gutter: f64, style: &SpecimenStyle, random: &mut Random) -> Self {
        let mut line = Self { starts: Vec::new(), gutters: Vec::new(), length: style.margin_px };
        for i in 0..cells {
            if i > 0 {
                let gap = gutter * (1.0 + style.unevenness * random.between(-1.0, 1.0));
                line.gutters.push(line.length + 0.5 * gap);
                line.length += gap;
            }
            line.starts.push(line.length);
            line.length += cell;
        }
        line.length += style.margin_px;
        line
    }
}

/// A page around a mount of a size in px.
fn page(width: f64, height: f64, style: &SpecimenStyle) -> Page {
    let card = match style.mount {
        Mount::Dark if style.tones.page != style.tones.mount => CARD_PX,
        Mount::Dark | Mount::Light => 0.0,
    };
    let size = [width + 2.0 * card, height + 2.0 * card + PRINT_PX];
    let tilt_rad = style.tilt_deg.to_radians();
    let (sin, cos) = (tilt_rad.sin().abs(), tilt_rad.cos());
    let plate = [size[0] * cos + size[1] * sin, size[0] * sin + size[1] * cos].map(f64::ceil);
    Page {
        size,
        mount: [card, card, card + width, card + height],
        tilt_rad,
        plate_centre: scaled(plate, 0.5),
    }
}

/// Corners of a cell's photograph, page px, from its top left corner.
fn scattered_quad(low: Point, style: &SpecimenStyle, random: &mut Random) -> [Point; 4] {
    let reach = 0.18 * style.unevenness * style.gutter_px[0].min(style.gutter_px[1]);
    let [width, height] = style.panel_px;
    let corners = [[0.0, 0.0], [width, 0.0], [width, height], [0.0, height]];
    corners
        .map(|corner| add(add(low, corner), [random.between(-reach, reach), random.between(-reach, reach)]))
}

fn centre(quad: &[Point; 4]) -> Point {
    scaled(quad.iter().fold([0.0; 2], |sum, corner| add(sum, *corner)), 0.25)
}

/// The cameras: evenly spaced, so that the horse stays about mid panel.
struct Battery {
    spacing_m: f64,
    origin_x_m: f64,
    px_per_m: f64,
    distance_m: f64,
    height_m: f64,
}

impl Battery {
    fn new(motion: &SpecimenMotion, style: &SpecimenStyle) -> Self {
        let shown = &motion.poses[..motion.poses.len().min((style.columns * style.rows) as usize)];
        let places: Vec<f64> = shown.iter().map(PosedHorse::trunk_x_m).collect();
        let n = places.len() as f64;
        let mean = places.iter().sum::<f64>() / n.max(1.0);
        let middle = 0.5 * (n - 1.0);
        let (xy, xx) = places.iter().enumerate().fold((0.0, 0.0), |(xy, xx), (i, x)| {
            let d = i as f64 - middle;
            (xy + d * (x - mean), xx + d * d)
        });
        let spacing_m = if xx > 0.0 { xy / xx } else { 0.0 };
        let first = if n > 0.0 { mean - spacing_m * middle } else { 0.0 };
        let extent = Extent::of(shown, first, spacing_m, motion, style);
        let [width, height] = style.panel_px;
        let across = style.fill * width / (extent.ahead - extent.behind);
        let upright = style.fill * (1.0 - GROUND_SHARE) * height / extent.top;
        Self {
            spacing_m,
            origin_x_m: first + 0.5 * (extent.ahead + extent.behind),
            px_per_m: across.min(upright),
            distance_m: style.camera_distance_m,
            height_m: style.camera_height_m,
        }
    }

    /// The camera of a panel on the plate; its axis passes through the panel's middle.
    fn camera(
        &self,
        index: usize,
        pose: &PosedHorse,
        motion: &SpecimenMotion,
        quad_px: [Point; 4],
        tilt_rad: f64,
    ) -> PanelCamera {
        let height_px = 0.5 * (sub(quad_px[3], quad_px[0])[1] + sub(quad_px[2], quad_px[1])[1]);
        let down = clockwise([0.0, 1.0], tilt_rad);
        PanelCamera {
            panel: index as u32 + 1,
            time_s: pose.time_s - motion.poses[0].time_s,
            px_per_m: self.px_per_m,
            axis_foot_px: add(centre(&quad_px), scaled(down, (0.5 - GROUND_SHARE) * height_px)),
            forward: clockwise([motion.facing.sign(), 0.0], tilt_rad),
            up: scaled(down, -1.0),
            camera_x_m: self.spacing_m * index as f64,
            distance_m: self.distance_m,
            height_m: self.height_m,
        }
    }
}

/// What the horse takes up around its trunk in all panels, m.
struct Extent {
    ahead: f64,
    behind: f64,
    top: f64,
}

impl Extent {
    fn of(
        poses: &[PosedHorse],
        first: f64,
        spacing_m: f64,
        motion: &SpecimenMotion,
        style: &SpecimenStyle,
    ) -> Self {
        let size = motion.withers_height_m;
        let mut extent = Self { ahead: 0.1, behind: -0.1, top: 0.1 };
        for (index, pose) in poses.iter().enumerate() {
            let opposite = first + spacing_m * index as f64;
            for tip in pose.bones.iter().map(|[_, tip]| tip).chain([&pose.dock]) {
                let x = tip[0] - opposite;
                extent.ahead = extent.ahead.max(x + REACH.ahead * size);
                extent.behind = extent.behind.min(x - 0.1 * size);
                extent.top = extent.top.max(tip[1] + REACH.above * size);
            }
            extent.behind = extent.behind.min(pose.dock[0] - opposite - REACH.behind * size);
            if style.rider {
                extent.top = extent.top.max(pose.withers()[1] + REACH.rider * size);
            }
        }
        extent
    }
}
