//! The flesh of a limb: tapered capsules along its bones, and a hoof.

use muybridge_capture::PanelCamera;
use muybridge_core::{Limb, Pair};

use super::PosedHorse;
use super::raster::{Point, Shape, add, between, scaled, sub, turned};

/// Withers height of the horse whose widths are given here, m: the core skeleton's reference.
const REFERENCE_WITHERS_M: f64 = 1.6;

/// Where flesh lies on a bone: share of the bone's length from its upper end, m ahead of the bone (forward on a standing
/// horse), half its width in m.
struct Station(f64, f64, f64);

/// Half widths of a light riding horse, measured on the galloping and pacing horses of 1878 and 1887 and rounded.
const FOREARM: [Station; 6] = [
    Station(0.0, 0.01, 0.092),
    Station(0.2, 0.008, 0.084),
    Station(0.5, 0.004, 0.062),
    Station(0.78, 0.002, 0.046),
    Station(0.93, 0.006, 0.049),
    Station(1.0, 0.006, 0.050),
];
const FORE_CANNON: [Station; 4] = [
    Station(0.1, 0.003, 0.045),
    Station(0.28, -0.002, 0.034),
    Station(0.75, -0.003, 0.033),
    Station(1.0, -0.006, 0.043),
];
const GASKIN: [Station; 6] = [
    Station(0.0, -0.025, 0.105),
    Station(0.22, -0.018, 0.095),
    Station(0.45, -0.012, 0.073),
    Station(0.7, -0.002, 0.050),
    Station(0.9, 0.0, 0.046),
    Station(1.0, 0.002, 0.052),
];
const HIND_CANNON: [Station; 4] = [
    Station(0.12, 0.0, 0.047),
    Station(0.3, 0.0, 0.037),
    Station(0.75, 0.0, 0.034),
    Station(1.0, -0.004, 0.045),
];
const PASTERN: [Station; 3] =
    [Station(0.08, -0.004, 0.042), Station(0.3, 0.0, 0.033), Station(0.5, 0.0, 0.038)];
/// The point of the hock, from the tendon above it to the cannon below: the first two on the tibia, the last on the cannon.
const HOCK_POINT: [Station; 3] =
    [Station(0.58, -0.045, 0.022), Station(0.95, -0.066, 0.022), Station(0.2, -0.034, 0.018)];
/// Corners of a hoof standing flat, m behind and above the tip of the toe: heel, back and front of the coronet.
const HOOF: [Point; 3] = [[-0.118, 0.0], [-0.128, 0.045], [-0.05, 0.075]];
/// Direction of the hoof bone on a standing horse, radians over the horizontal; the sole is then flat.
const STANDING_HOOF_RAD: f64 = -1.117;

/// Maps metres to plate px.
pub(super) struct Viewer<'a> {
    camera: &'a PanelCamera,
    /// Size of the horse over the reference horse.
    pub(super) size: f64,
}

impl<'a> Viewer<'a> {
    pub(super) fn new(camera: &'a PanelCamera, withers_height_m: f64) -> Self {
        Self { camera, size: withers_height_m / REFERENCE_WITHERS_M }
    }

    /// A point of a plane at `z_m`, plate px.
    pub(super) fn px(&self, [x, y]: Point, z_m: f64) -> Point {
        self.camera.plate_from_world([x, y, z_m])
    }

    /// A length on a horse of the reference's size, m, in px.
    pub(super) fn length_px(&self, reference_m: f64) -> f64 {
        reference_m * self.size * self.camera.px_per_m
    }

    /// A circle of a radius in m of the reference horse.
    fn circle(&self, at: Point, z_m: f64, radius_m: f64) -> (Point, f64) {
        (self.px(at, z_m), self.length_px(radius_m))
    }
}

/// A bone in its plane.
pub(super) struct Segment {
    base: Point,
    tip: Point,
    z_m: [f64; 2],
}

impl Segment {
    pub(super) fn new([[bx, by, bz], [tx, ty, tz]]: [[f64; 3]; 2]) -> Self {
        Self { base: [bx, by], tip: [tx, ty], z_m: [bz, tz] }
    }

    /// A point at a share of the bone's length, m ahead of it.
    pub(super) fn at(&self, along: f64, ahead_m: f64) -> Point {
        add(between(self.base, self.tip, along), scaled(self.ahead(), ahead_m))
    }

    /// Unit vector ahead of the bone.
    fn ahead(&self) -> Point {
        let [dx, dy] = sub(self.tip, self.base);
        scaled([-dy, dx], 1.0 / dx.hypot(dy).max(f64::MIN_POSITIVE))
    }

    /// Length, m.
    pub(super) fn length(&self) -> f64 {
        let [dx, dy] = sub(self.tip, self.base);
        dx.hypot(dy)
    }

    fn angle_rad(&self) -> f64 {
        let [dx, dy] = sub(self.tip, self.base);
        dy.atan2(dx)
    }

    fn station(&self, view: &Viewer<'_>, &Station(along, ahead_m, radius_m): &Station) -> (Point, f64) {
        let z_m = (1.0 - along) * self.z_m[0] + along * self.z_m[1];
        view.circle(self.at(along, ahead_m * view.size), z_m, radius_m)
    }
}

/// The `index`-th bone of a limb, root first.
fn segment(pose: &PosedHorse, limb: Limb, index: usize) -> Segment {
    Segment::new(pose.bones[limb.first_bone() + index])
}

/// Capsules through a row of circles.
pub(super) fn chain(circles: &[(Point, f64)]) -> impl Iterator<Item = Shape> + '_ {
    circles.windows(2).map(|two| Shape::Capsule([two[0], two[1]]))
}

/// From elbow or stifle to the ground.
pub(super) fn lower(view: &Viewer<'_>, pose: &PosedHorse, limb: Limb) -> Vec<Shape> {
    let [upper, cannon, hoof] = [2, 3, 4].map(|i| segment(pose, limb, i));
    let (muscle, shin): (&[Station], &[Station]) = match limb.pair() {
        Pair::Fore => (&FOREARM, &FORE_CANNON),
        Pair::Hind => (&GASKIN, &HIND_CANNON),
    };
    let mut circles: Vec<(Point, f64)> = muscle.iter().map(|s| upper.station(view, s)).collect();
    circles.extend(shin.iter().map(|s| cannon.station(view, s)));
    let flat = pose.down[limb.index()];
    let (coronet, outline) = hoof_outline(view, &hoof, flat);
    let pastern = &PASTERN[..2];
    circles.extend(pastern.iter().map(|s| hoof.station(view, s)));
    circles.push((coronet, view.length_px(PASTERN[2].2)));
    let mut shapes: Vec<Shape> = chain(&circles).collect();
    shapes.push(Shape::polygon(outline));
    if limb.pair() == Pair::Hind {
        let [a, b, c] = &HOCK_POINT;
        shapes.extend(chain(&[upper.station(view, a), upper.station(view, b), cannon.station(view, c)]));
    }
    shapes
}

/// Middle of the coronet and the hoof's corners, plate px. A hoof on the ground lies flat; one in the air goes with its
/// bone.
fn hoof_outline(view: &Viewer<'_>, hoof: &Segment, flat: bool) -> (Point, Vec<Point>) {
    let turn_rad = if flat { 0.0 } else { hoof.angle_rad() - STANDING_HOOF_RAD };
    let corner = |at: Point| add(hoof.tip, turned(scaled(at, view.size), turn_rad));
    let [heel, back, front] = HOOF.map(corner);
    let coronet = between(back, front, 0.5);
    let outline = [hoof.tip, heel, back, front].map(|at| view.px(at, hoof.z_m[1]));
    (view.px(coronet, hoof.z_m[1]), outline.to_vec())
}

/// The round muscles over the upper bones, down to a little below elbow or stifle: what goes over into the trunk.
pub(super) fn muscles(view: &Viewer<'_>, pose: &PosedHorse, limb: Limb) -> Vec<Shape> {
    let [root, second, third] = [0, 1, 2].map(|i| segment(pose, limb, i));
    let circles = match limb.pair() {
        Pair::Fore => vec![
            root.station(view, &Station(0.55, -0.02, 0.10)),
            root.station(view, &Station(0.93, -0.05, 0.08)),
            second.station(view, &Station(0.6, -0.02, 0.09)),
            third.station(view, &FOREARM[0]),
            third.station(view, &FOREARM[1]),
            third.station(view, &FOREARM[2]),
        ],
        Pair::Hind => vec![
            second.station(view, &Station(0.1, -0.03, 0.14)),
            second.station(view, &Station(0.6, -0.03, 0.13)),
            second.station(view, &Station(0.95, -0.025, 0.10)),
            third.station(view, &GASKIN[0]),
            third.station(view, &GASKIN[1]),
            third.station(view, &GASKIN[2]),
        ],
    };
    chain(&circles).collect()
}

/// Where the visible lower limb grows out of the trunk: centre and radius, plate px.
pub(super) fn root_px(view: &Viewer<'_>, pose: &PosedHorse, limb: Limb) -> (Point, f64) {
    let third = segment(pose, limb, 2);
    match limb.pair() {
        Pair::Fore => third.station(view, &Station(0.0, 0.0, 0.19)),
        Pair::Hind => third.station(view, &Station(0.0, -0.02, 0.23)),
    }
}
