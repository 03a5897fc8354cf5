//! The figure in three dimensions, on its ground, with its prints and the curve of its centre of mass.

use glam::{DVec2, DVec3, Vec2, Vec3};
use image::{Rgb, RgbImage, RgbaImage};
use muybridge_core::{Limb, Side};
use muybridge_footprints::{Figure, Foot, Support, Terrain};
use muybridge_imaging::figure::{
    Camera, Decal, Figure as Horse, FigureColors, Scene, Terrain as Ground, Tube, render,
};

use super::plan::times;
use super::silhouette;
use super::supports::{color, foot_color};
use super::unrolled::Unrolled;
use super::walk::Walk;

/// The camera's angle from the right of the way, and over the ground, rad: of one figure, and of the whole way.
const NEAR_RAD: [f32; 2] = [0.55, 0.2];
const FAR_RAD: [f32; 2] = [0.3, 0.33];
/// Metres across for each metre of the figure's height or length, and metres up.
const SEEN_ACROSS: f64 = 1.5;
const SEEN_UP: f64 = 1.55;
/// A way that rises by more than this climbs, metres.
const CLIMB_M: f64 = 0.3;
/// The camera goes up and down with the body's mean height over so long before and after, s.
const CALM_S: f64 = 0.45;
/// Prints and curve nearer than this to what is looked at are drawn, in metres seen across.
const REACH: f64 = 3.0;
/// Half thickness of the curve: this share of what is seen across, divided by the root of the picture's px; large pictures have
/// lines of more px.
const LINE: f64 = 0.07;
/// The curve is drawn in pieces of so many points at most, to leave out those that are far away.
const PIECE: usize = 64;
/// A whole way keeps this share of the picture's sides free.
const MARGIN: f32 = 0.05;

/// Takes pictures of one motion.
pub(super) struct Photographer<'a> {
    walk: &'a Walk,
    /// Lines of the curve and their colours.
    curve: Vec<(Vec<Vec3>, [u8; 3])>,
    /// Prints, and where they are.
    prints: Vec<(DVec3, Decal)>,
    /// Height of the figure at the beginning, and its greatest length, metres.
    size_m: [f64; 2],
    /// Heading of the whole way, rad.
    heading_rad: f32,
    /// Where the way climbs, stairs are seen from behind: -1, else 1.
    from_before: f32,
}

/// What is seen: a camera, and how far around its target things matter, metres.
pub(super) struct Sight {
    camera: Camera,
    middle: DVec3,
    reach_m: f64,
    /// Half thickness of the curve, metres.
    line_m: f32,
}

impl<'a> Photographer<'a> {
    pub(super) fn new(walk: &'a Walk, way: &Unrolled) -> Self {
        let (_, top) = silhouette::extent(walk, way, 0.0);
        let first = walk.motion.centre_of_mass(0.0).at;
        let height_m = top - walk.ground_m(DVec2::new(first.x, first.z));
        let mut curve = Vec::new();
        for support in walk.motion.placed.supports() {
            let points: Vec<Vec3> =
                times(&support).map(|time_s| walk.motion.centre_of_mass(time_s).at.as_vec3()).collect();
            let mut from = 0;
            while from + 1 < points.len() {
                let to = (from + PIECE).min(points.len());
                curve.push((points[from..to].to_vec(), color(&support.down)));
                from = to - 1;
            }
        }
        let prints = walk.motion.placed.prints.iter().map(|print| {
            let points = walk.outline(print).into_iter().map(DVec3::as_vec3).collect();
            (print.middle, Decal { points, color: foot_color(print.foot) })
        });
        let prints: Vec<(DVec3, Decal)> = prints.collect();
        let climb_m =
            prints.last().map_or(0.0, |(last, _)| last.y) - prints.first().map_or(0.0, |(at, _)| at.y);
        let from_before = if climb_m > CLIMB_M { -1.0 } else { 1.0 };
        let size_m = [height_m, silhouette::length_m(walk, way)];
        Self { walk, curve, prints, size_m, heading_rad: heading(way), from_before }
    }

    /// Length of the figure, metres.
    pub(super) fn length_m(&self) -> f64 {
        self.size_m[1]
    }

    /// A camera that goes along, looking at the figure's right side; `turns` with it or keeps the direction of the way.
    pub(super) fn along(&self, time_s: f64, size_px: [u32; 2], turns: bool) -> Sight {
        let aspect = f64::from(size_px[0]) / f64::from(size_px[1]);
        let [height_m, length_m] = self.size_m;
        let seen_m = (SEEN_ACROSS * length_m.max(0.6 * height_m)).max(SEEN_UP * height_m * aspect);
        let moments = (-6..=6).map(|i| time_s + CALM_S * f64::from(i) / 6.0);
        let heights: Vec<f64> = moments.map(|at_s| self.walk.motion.centre_of_mass(at_s).at.y).collect();
        let mean_m = heights.iter().sum::<f64>() / heights.len() as f64;
        let first = self.walk.motion.centre_of_mass(0.0).at;
        let over_ground_m = first.y - self.walk.ground_m(DVec2::new(first.x, first.z));
        let at = self.walk.motion.centre_of_mass(time_s).at;
        let middle = DVec3::new(at.x, mean_m - over_ground_m + 0.5 * height_m, at.z);
        let facing = self.walk.facing(time_s);
        let heading = if turns { (-facing.y).atan2(facing.x) as f32 } else { self.heading_rad };
        self.sight(middle, heading + self.from_before * NEAR_RAD[0], NEAR_RAD[1], seen_m, size_px)
    }

    /// A camera that sees the whole way.
    pub(super) fn whole(&self, moments: &[f64], size_px: [u32; 2]) -> Sight {
        let mut corners: Vec<DVec3> = self.prints.iter().map(|(at, _)| *at).collect();
        for &time_s in moments {
            let at = self.walk.motion.centre_of_mass(time_s).at;
            let half = 0.5 * self.size_m[1];
            let low = self.walk.ground_m(DVec2::new(at.x, at.z));
            let top = at.y + 0.55 * self.size_m[0];
            let facing = self.walk.facing(time_s) * half;
            corners.extend(
                [-1.0, 1.0].map(|sign| DVec3::new(at.x + sign * facing.x, top, at.z + sign * facing.y)),
            );
            corners.push(DVec3::new(at.x, low, at.z));
        }
        let mut middle = corners.iter().sum::<DVec3>() / corners.len().max(1) as f64;
        let mut seen_m = 2.0 * corners.iter().map(|at| at.distance(middle)).fold(1.0, f64::max);
        let yaw = self.heading_rad + self.from_before * FAR_RAD[0];
        // The camera is brought nearer until what it is to see fills the picture.
        for _ in 0..12 {
            let sight = self.sight(middle, yaw, FAR_RAD[1], seen_m, size_px);
            let places: Vec<Vec3> =
                corners.iter().filter_map(|at| sight.camera.project(at.as_vec3())).collect();
            let low = places.iter().copied().fold(Vec3::INFINITY, Vec3::min);
            let high = places.iter().copied().fold(Vec3::NEG_INFINITY, Vec3::max);
            let size = size_px.map(|side| side as f32);
            let share = ((high.x - low.x) / size[0]).max((high.y - low.y) / size[1]) / (1.0 - 2.0 * MARGIN);
            if !share.is_finite() || places.len() < corners.len() {
                seen_m *= 1.3;
                continue;
            }
            let m_per_px = seen_m / f64::from(size[0]);
            let off = (low + high) / 2.0 - Vec3::new(size[0], size[1], 0.0) / 2.0;
            let (sin, cos) = f64::from(yaw).sin_cos();
            middle += DVec3::new(cos, 0.0, -sin) * (f64::from(off.x) * m_per_px);
            middle.y -= f64::from(off.y) * m_per_px;
            seen_m *= f64::from(share);
        }
        self.sight(middle, yaw, FAR_RAD[1], seen_m, size_px)
    }

    fn sight(&self, middle: DVec3, yaw: f32, pitch: f32, seen_m: f64, size_px: [u32; 2]) -> Sight {
        let size = size_px.map(|side| side as f32);
        let camera = Camera::orbit(middle.as_vec3(), yaw, pitch, seen_m as f32, size);
        let line_m = (LINE * seen_m / f64::from(size_px[0]).sqrt()) as f32;
        Sight { camera, middle, reach_m: REACH * seen_m, line_m }
    }

    /// The picture of some moments at once.
    pub(super) fn shoot(&self, sight: &Sight, moments: &[f64], size_px: [u32; 2]) -> RgbImage {
        let (mut horses, mut tubes) = (Vec::new(), Vec::new());
        for &time_s in moments {
            self.add_figure(time_s, &mut horses, &mut tubes);
        }
        let is_near = |at: DVec3| at.distance(sight.middle) < sight.reach_m;
        let near_prints = self.prints.iter().filter(|(at, _)| is_near(*at));
        let decals: Vec<Decal> = near_prints.map(|(_, decal)| decal.clone()).collect();
        let near_curve =
            self.curve.iter().filter(|(points, _)| points.iter().any(|at| is_near(at.as_dvec3())));
        tubes.extend(near_curve.map(|(points, color)| Tube {
            points: points.clone(),
            radii_m: vec![Vec2::splat(sight.line_m); points.len()],
            up: Vec3::Y,
            color: *color,
        }));
        let terrain = &self.walk.motion.track.terrain;
        let height = |x_m: f32, z_m: f32| terrain.at(f64::from(x_m), f64::from(z_m)).0 as f32;
        let scene = Scene {
            figures: &horses,
            tubes: &tubes,
            decals: &decals,
            filmed: Side::Right,
            terrain: match terrain {
                Terrain::Flat => Ground::Flat,
                Terrain::Slope { .. } | Terrain::HeightField { .. } => Ground::Height(&height),
                Terrain::Stairs { .. } | Terrain::SpiralStairs { .. } => Ground::Stepped(&height),
            },
            grid_m: 1.0,
            traces: &[],
            support_polygon: false,
            colors: &FigureColors::default(),
        };
        // Twice as fine as asked for, so that edges of the ground are smooth, too.
        let fine = render(&scene, &sight.camera.finer(2.0), size_px.map(|side| 2 * side as usize), false);
        halved(&fine)
    }

    fn add_figure(&self, time_s: f64, horses: &mut Vec<Horse>, tubes: &mut Vec<Tube>) {
        let figure = self.walk.motion.figure(time_s);
        if let (Figure::Horse(pose), Some(skeleton)) = (&figure, self.walk.skeleton()) {
            let supports = self.walk.motion.placed.supports();
            let down = Support::at(&supports, time_s).map_or(&[][..], |support| &support.down);
            let standing = Limb::ALL.map(|limb| down.contains(&Foot::QUADRUPED[limb.index()]));
            horses.push(Horse { joints: pose.joints(skeleton), standing, ghost: false });
        }
        tubes.extend(self.walk.motion.tubes(&figure).into_iter().map(|tube| Tube {
            points: tube.points,
            radii_m: tube.radii_m,
            up: tube.up,
            color: tube.color,
        }));
    }
}

/// Each pixel the mean of four.
fn halved(fine: &RgbaImage) -> RgbImage {
    RgbImage::from_fn(fine.width() / 2, fine.height() / 2, |x, y| {
        let four = [[0, 0], [1, 0], [0, 1], [1, 1]].map(|[i, k]| fine.get_pixel(2 * x + i, 2 * y + k));
        Rgb([0, 1, 2].map(|c| {
            let sum: u32 = four.iter().map(|pixel| u32::from(pixel[c])).sum();
            ((sum + 2) / 4) as u8
        }))
    })
}

/// Heading of a whole way, rad: from its first to its last place, or of the first figure where it comes back.
fn heading(way: &Unrolled) -> f32 {
    let places: Vec<DVec2> = way.way().map(|(_, at)| at).collect();
    let (Some(first), Some(last)) = (places.first(), places.last()) else { return 0.0 };
    let furthest = places.iter().map(|at| at.distance(*first)).fold(0.0, f64::max);
    let all = *last - *first;
    let along = if all.length() > 0.4 * furthest { all } else { places[places.len() / 2] - *first };
    (-along.y).atan2(along.x) as f32
}
