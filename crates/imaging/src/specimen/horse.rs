//! The horse in layers, from the off side to the near side.

use muybridge_capture::NearOff;
use muybridge_core::{Limb, Pair, bone};

use super::limb::{Segment, Viewer, lower, muscles, root_px};
use super::paint::{Blob, Layer, Part};
use super::raster::{Point, Shape, add, between, scaled, sub, turned};
use super::style::Tones;
use super::{PosedHorse, SpecimenMotion};

/// Dock of the reference horse seen from its croup, m; its direction tells how the pelvis is turned.
const REST_DOCK: Point = [-0.37, -0.13];
/// Under the trunk, from the breast backwards: share of the distance croup to withers, m over the line between them.
const UNDERLINE: [Point; 9] = [
    [1.20, -0.10],
    [1.39, -0.27],
    [1.455, -0.42],
    [1.39, -0.55],
    [1.20, -0.655],
    [0.93, -0.715],
    [0.65, -0.715],
    [0.38, -0.67],
    [0.15, -0.585],
];
/// Groin and buttock, m from the croup in the frame of the pelvis.
const HINDQUARTER: [Point; 5] =
    [[-0.02, -0.52], [-0.20, -0.50], [-0.34, -0.44], [-0.425, -0.33], [-0.43, -0.22]];
/// Profile of the head from the poll round the nose, in shares of its length: along it, towards the jaw.
const PROFILE: [Point; 18] = [
    [0.0, 0.0],
    [0.12, -0.02],
    [0.27, -0.025],
    [0.46, -0.005],
    [0.66, 0.012],
    [0.86, 0.006],
    [1.0, 0.0],
    [1.045, 0.075],
    [1.03, 0.15],
    [0.97, 0.205],
    [0.90, 0.255],
    [0.80, 0.245],
    [0.66, 0.285],
    [0.50, 0.375],
    [0.35, 0.455],
    [0.20, 0.465],
    [0.07, 0.40],
    [0.0, 0.22],
];
/// Where head and neck meet at the throat, in shares of the head's length as in the profile.
const THROAT: Point = [0.20, 0.48];
/// How far the throat's line is hollowed towards the crest (negative: rounded out) at a third and two thirds of the way to
/// the breast, m.
const HOLLOW_M: [f64; 2] = [-0.02, -0.015];
/// How far the crest arches over the neck's joints, m.
const CREST_M: f64 = 0.065;
/// Length of the tail from the dock, m, and how far its hair spreads to either side.
const TAIL_M: f64 = 0.78;
const TAIL_SPREAD_M: f64 = 0.055;
const TAIL_JOINTS: usize = 14;
/// Strands of the tail: place across it, -1 to 1, and the joint at which it ends.
const STRANDS: [(f64, usize); 7] =
    [(-1.0, 11), (-0.65, 13), (-0.3, 12), (0.0, 14), (0.35, 12), (0.7, 13), (1.0, 10)];
/// Tufts of the mane.
const TUFTS: usize = 44;
/// How far light reaches round trunk and limbs, m: about a third of their half width.
const TRUNK_ROUND_M: f64 = 0.085;
const LIMB_ROUND_M: f64 = 0.028;

/// All layers of the horse, the farthest first.
pub(super) fn layers(
    view: &Viewer<'_>,
    pose: &PosedHorse,
    motion: &SpecimenMotion,
    tones: &Tones,
) -> Vec<Layer> {
    let coat = if tones.horse < tones.wall { &DARK_COAT } else { &PALE_COAT };
    let body = Body::new(view, pose);
    let limb = |side, pair| motion.facing.limb(side, pair);
    let off = |pair, part| {
        let limb = limb(NearOff::Off, pair);
        let mut shapes = body.upper(limb);
        shapes.extend(lower(view, pose, limb));
        Layer { light: coat.off, ..Layer::new(part, shapes, view.length_px(LIMB_ROUND_M)) }
    };
    let near = |pair, part| {
        let limb = limb(NearOff::Near, pair);
        let layer = Layer::new(part, lower(view, pose, limb), view.length_px(LIMB_ROUND_M));
        Layer { root: Some(root_px(view, pose, limb)), ..layer }
    };
    let mut trunk = body.outlines();
    for pair in [Pair::Hind, Pair::Fore] {
        trunk.extend(body.upper(limb(NearOff::Near, pair)));
    }
    let trunk =
        Layer { blobs: body.relief(), ..Layer::new(Part::Body, trunk, view.length_px(TRUNK_ROUND_M)) };
    let hair =
        |part, shapes| Layer { light: coat.hair, ..Layer::new(part, shapes, view.length_px(LIMB_ROUND_M)) };
    vec![
        off(Pair::Hind, Part::OffHind),
        off(Pair::Fore, Part::OffFore),
        hair(Part::Tail, body.tail(motion)),
        trunk,
        hair(Part::Body, body.mane(motion)),
        near(Pair::Hind, Part::NearHind),
        near(Pair::Fore, Part::NearFore),
    ]
}

/// Tones of a coat's parts over the coat's own.
struct Coat {
    /// The off legs, which lie in the trunk's shadow.
    off: f64,
    /// Mane and tail.
    hair: f64,
}

/// A dark horse has a darker mane, a grey one a paler mane; both stand out from the wall.
const DARK_COAT: Coat = Coat { off: 0.72, hair: 0.7 };
const PALE_COAT: Coat = Coat { off: 0.86, hair: 1.12 };

/// Head, neck and trunk.
struct Body<'a> {
    view: &'a Viewer<'a>,
    pose: &'a PosedHorse,
    /// Croup, withers.
    croup: Point,
    withers: Point,
    /// Unit vector up from the trunk.
    up: Point,
    pelvis_rad: f64,
    z_m: f64,
}

fn flat([x, y, _]: [f64; 3]) -> Point {
    [x, y]
}

impl<'a> Body<'a> {
    fn new(view: &'a Viewer<'a>, pose: &'a PosedHorse) -> Self {
        let (croup, withers) = (flat(pose.croup), flat(pose.withers()));
        let [dx, dy] = sub(withers, croup);
        let along = scaled([dx, dy], 1.0 / dx.hypot(dy).max(f64::MIN_POSITIVE));
        let dock = sub(flat(pose.dock), croup);
        let pelvis_rad = dock[1].atan2(dock[0]) - REST_DOCK[1].atan2(REST_DOCK[0]);
        Self { view, pose, croup, withers, up: [-along[1], along[0]], pelvis_rad, z_m: pose.croup[2] }
    }

    /// A point of the trunk: share of the distance croup to withers, m over the line between them.
    fn on_trunk(&self, [share, over_m]: Point) -> Point {
        add(between(self.croup, self.withers, share), scaled(self.up, over_m * self.view.size))
    }

    /// A point fixed to the pelvis, m from the croup.
    fn on_pelvis(&self, at_m: Point) -> Point {
        add(self.croup, turned(scaled(at_m, self.view.size), self.pelvis_rad))
    }

    fn tip(&self, bone: usize) -> Point {
        flat(self.pose.tip(bone))
    }

    /// A smooth outline in the middle of the horse.
    fn outline(&self, corners: &[Point]) -> Shape {
        self.outline_at(corners, self.z_m)
    }

    fn outline_at(&self, corners: &[Point], z_m: f64) -> Shape {
        Shape::polygon(smooth(corners).into_iter().map(|at| self.view.px(at, z_m)).collect())
    }

    fn outlines(&self) -> Vec<Shape> {
        let mut shapes = vec![self.trunk(), self.neck(), self.head()];
        shapes.extend(self.ears());
        shapes
    }

    fn trunk(&self) -> Shape {
        let mut corners = vec![flat(self.pose.dock), self.croup];
        corners.extend((bone::SPINE..=bone::SPINE_LAST).map(|i| self.tip(i)));
        corners.extend(UNDERLINE.map(|at| self.on_trunk(at)));
        corners.extend(HINDQUARTER.map(|at| self.on_pelvis(at)));
        self.outline(&corners)
    }

    /// The neck's joints on the crest, withers and poll included.
    fn crest(&self) -> [Point; 4] {
        [self.withers, self.tip(bone::NECK), self.tip(bone::NECK + 1), self.tip(bone::NECK_LAST)]
    }

    /// From the crest towards the throat, unit vector at the first joint, the second and the poll.
    fn throatwards(&self) -> [Point; 3] {
        let crest = self.crest();
        std::array::from_fn(|i| {
            let [dx, dy] = sub(crest[(i + 2).min(3)], crest[i]);
            scaled([dy, -dx], 1.0 / dx.hypot(dy).max(f64::MIN_POSITIVE))
        })
    }

    fn neck(&self) -> Shape {
        let (crest, down) = (self.crest(), self.throatwards());
        let under = |i: usize, depth_m: f64| add(crest[i + 1], scaled(down[i], depth_m * self.view.size));
        let (throat, breast) = (self.on_head(THROAT), self.on_trunk(UNDERLINE[2]));
        let [high, low] = [0, 1].map(|i| {
            let on_line = between(throat, breast, (i as f64 + 1.0) / 3.0);
            add(on_line, scaled(down[1], -HOLLOW_M[i] * self.view.size))
        });
        self.outline(&[
            self.withers,
            under(0, -CREST_M),
            under(1, -CREST_M),
            crest[3],
            self.on_head([0.16, 0.25]),
            throat,
            high,
            low,
            breast,
            self.on_trunk([1.15, -0.45]),
            self.on_trunk([0.85, -0.25]),
        ])
    }

    /// A point of the head in shares of its length: along it, towards the jaw.
    fn on_head(&self, [along, jaw]: Point) -> Point {
        let head = Segment::new(self.pose.bones[bone::HEAD]);
        head.at(along, -jaw * head.length())
    }

    fn head(&self) -> Shape {
        self.outline(&PROFILE.map(|at| self.on_head(at)))
    }

    fn ears(&self) -> [Shape; 2] {
        // Root from and to, in shares of the head's length; the near ear and, a little forward, the off ear.
        [[-0.01, 0.12], [0.08, 0.20]].map(|[from, to]| {
            let (a, b) = (self.on_head([from, 0.03]), self.on_head([to, 0.0]));
            let tip = self.on_head([from - 0.15, -0.15]);
            let bulge = |root: Point, side: f64| add(between(root, tip, 0.45), scaled(sub(b, a), side));
            self.outline(&[a, bulge(a, -0.16), tip, bulge(b, 0.16), b])
        })
    }

    /// The mane: a fringe that falls on the neck, and at speed blows back from the crest.
    fn mane(&self, motion: &SpecimenMotion) -> Vec<Shape> {
        let (crest, down) = (self.crest(), self.throatwards());
        let wind = (motion.speed_m_s / FAST_M_S).min(1.0);
        (0..=TUFTS)
            .map(|i| {
                let along = 0.2 + 2.8 * i as f64 / TUFTS as f64;
                let joint = (along as usize).min(2);
                let root = between(crest[joint], crest[joint + 1], along - joint as f64);
                // Hair is shorter towards the poll and the withers; no two tufts are alike.
                let (from_end, waver) =
                    ((2.0 * along).min(3.4 - along).min(1.0), (7.3 * (i * i) as f64).sin());
                let length = (0.02 + 0.10 * from_end + 0.035 * waver) * self.view.size;
                let hang = scaled(down[joint], length * (1.0 - 0.55 * wind));
                let blown = scaled([-1.0, 0.30 + 0.2 * waver], length * (0.25 + 0.55 * wind));
                let lifted = add(root, scaled(down[joint], -0.4 * CREST_M * self.view.size));
                let circle =
                    |at: Point, radius_m: f64| (self.view.px(at, self.z_m), self.view.length_px(radius_m));
                Shape::Capsule([
                    circle(lifted, 0.012 + 0.010 * from_end),
                    circle(add(lifted, add(hang, blown)), 0.007),
                ])
            })
            .collect()
    }

    /// Dock and hair, hanging at rest, streaming at speed: strands side by side along one curve.
    fn tail(&self, motion: &SpecimenMotion) -> Vec<Shape> {
        let size = self.view.size;
        let speed = (motion.speed_m_s / FAST_M_S).min(1.0);
        let sway = (9.0 * self.pose.time_s).sin();
        // Angle from straight down, rad: it leaves the dock lifted and falls towards its end.
        let angle = |share: f64| {
            let (lifted, fallen) = (0.85 + 0.95 * speed, 0.04 + 1.05 * speed);
            lifted + (fallen - lifted) * (1.6 * share).min(1.0) + 0.16 * sway * share
        };
        let step = TAIL_M * size / TAIL_JOINTS as f64;
        let mut curve = vec![self.on_pelvis(add(REST_DOCK, [0.04, -0.02]))];
        for i in 0..TAIL_JOINTS {
            let turn = angle((i as f64 + 0.5) / TAIL_JOINTS as f64);
            curve.push(add(curve[i], [-turn.sin() * step, -turn.cos() * step]));
        }
        let strand = |aside: f64, end: usize| {
            let circle = move |i: usize, curve: &[Point]| {
                let share = i as f64 / TAIL_JOINTS as f64;
                let [dx, dy] = sub(curve[(i + 1).min(TAIL_JOINTS)], curve[i.saturating_sub(1)]);
                let across = scaled(
                    [-dy, dx],
                    aside * TAIL_SPREAD_M * size * (share * 2.2).min(1.0)
                        / dx.hypot(dy).max(f64::MIN_POSITIVE),
                );
                let radius = (0.032 - 0.008 * share) * (1.0 - (i as f64 / end as f64).powi(4)) + 0.003;
                (self.view.px(add(curve[i], across), self.z_m), self.view.length_px(radius))
            };
            (0..end).map(|i| Shape::Capsule([circle(i, &curve), circle(i + 1, &curve)])).collect::<Vec<_>>()
        };
        STRANDS.into_iter().flat_map(|(aside, end)| strand(aside, end)).collect()
    }

    /// Shoulder and upper arm, or thigh, with the skin between them and the trunk.
    fn upper(&self, limb: Limb) -> Vec<Shape> {
        let size = self.view.size;
        let segment = |i: usize| Segment::new(self.pose.bones[limb.first_bone() + i]);
        let third = |along: f64, ahead_m: f64| segment(2).at(along, ahead_m * size);
        let corners = match limb.pair() {
            Pair::Fore => vec![
                self.on_trunk([1.10, -0.22]),
                self.on_trunk([1.40, -0.40]),
                between(self.on_trunk([1.36, -0.55]), third(0.0, 0.10), 0.5),
                third(0.16, 0.088),
                third(0.4, 0.068),
                third(0.4, -0.062),
                third(0.16, -0.078),
                between(third(0.0, -0.11), self.on_trunk([0.93, -0.70]), 0.3),
                self.on_trunk([0.88, -0.55]),
            ],
            Pair::Hind => vec![
                self.on_trunk([0.22, -0.22]),
                between(self.on_trunk([0.22, -0.58]), segment(1).at(0.75, 0.10 * size), 0.45),
                segment(1).at(0.97, 0.075 * size),
                third(0.18, 0.082),
                third(0.42, 0.06),
                third(0.42, -0.082),
                third(0.16, -0.15),
                between(self.on_pelvis(HINDQUARTER[3]), third(0.0, -0.24), 0.55),
                self.on_pelvis(HINDQUARTER[3]),
                self.on_pelvis([-0.38, -0.20]),
            ],
        };
        let mut shapes = muscles(self.view, self.pose, limb);
        shapes.push(self.outline_at(&corners, self.pose.tip(limb.first_bone() + 1)[2]));
        shapes
    }

    /// Light and shade of the muscles.
    fn relief(&self) -> Vec<Blob> {
        let px = |at: Point| self.view.px(at, self.z_m);
        let blob = |at: Point, towards: Point, across_m: f64, gain: f64| Blob {
            centre: px(at),
            arm: sub(px(towards), px(at)),
            across: self.view.length_px(across_m),
            gain,
        };
        let t = |x, y| self.on_trunk([x, y]);
        let p = |x, y| self.on_pelvis([x, y]);
        vec![
            // Croup and thigh.
            blob(p(-0.14, -0.11), p(0.04, -0.09), 0.08, 0.30),
            blob(p(-0.24, -0.27), p(-0.22, -0.42), 0.09, 0.25),
            // Loin and ribs.
            blob(t(0.58, -0.18), t(0.86, -0.20), 0.08, 0.25),
            blob(t(0.42, -0.33), t(0.55, -0.45), 0.07, 0.12),
            // Flank and behind the elbow lie deeper.
            blob(t(0.16, -0.40), t(0.20, -0.56), 0.06, -0.22),
            blob(t(0.85, -0.50), t(0.88, -0.68), 0.07, -0.2),
            // Shoulder, and the hollow before it.
            blob(t(1.10, -0.30), t(1.02, -0.12), 0.07, 0.28),
            blob(t(1.27, -0.42), t(1.25, -0.32), 0.07, 0.25),
            blob(t(1.25, -0.16), t(1.34, -0.30), 0.04, -0.15),
            // Neck and cheek.
            blob(between(self.tip(bone::NECK), t(1.3, -0.25), 0.42), self.tip(bone::NECK + 1), 0.06, 0.16),
            blob(self.on_head([0.28, 0.24]), self.on_head([0.46, 0.18]), 0.055, 0.25),
            blob(self.on_head([0.72, 0.10]), self.on_head([0.92, 0.10]), 0.03, 0.18),
        ]
    }
}

/// Speed at which tail and mane stream, m/s: a racing gallop.
const FAST_M_S: f64 = 14.0;

/// A closed curve through its corners (centripetal Catmull and Rom, by Barry and Goldman's pyramid).
fn smooth(corners: &[Point]) -> Vec<Point> {
    const STEPS: usize = 8;
    let n = corners.len();
    let mut curve = Vec::with_capacity(n * STEPS);
    for i in 0..n {
        let p = [0, 1, 2, 3].map(|k| corners[(i + n + k - 1) % n]);
        let knot = |t: f64, a: Point, b: Point| t + sub(b, a)[0].hypot(sub(b, a)[1]).sqrt().max(1e-6);
        let t1 = knot(0.0, p[0], p[1]);
        let t2 = knot(t1, p[1], p[2]);
        let t = [0.0, t1, t2, knot(t2, p[2], p[3])];
        for step in 0..STEPS {
            let at = t1 + (t2 - t1) * step as f64 / STEPS as f64;
            let mix = |a: Point, b: Point, from: f64, to: f64| between(a, b, (at - from) / (to - from));
            let a = [0, 1, 2].map(|k| mix(p[k], p[k + 1], t[k], t[k + 1]));
            let b = [0, 1].map(|k| mix(a[k], a[k + 1], t[k], t[k + 2]));
            curve.push(mix(b[0], b[1], t1, t2));
        }
    }
    curve
}
