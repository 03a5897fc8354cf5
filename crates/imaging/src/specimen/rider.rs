//! A rider in the saddle: one near leg, trunk, arm, head and hat.

use muybridge_core::bone;

use super::PosedHorse;
use super::limb::{Segment, Viewer, chain};
use super::paint::{Canvas, Layer, Part};
use super::raster::{Point, Shape, add, between, scaled, turned};
use super::style::SpecimenStyle;

/// Places on the horse seen from the withers, m along the trunk and up from it.
const SEAT: Point = [-0.21, 0.06];
const HAND: Point = [0.24, 0.13];
const KNEE: Point = [0.10, -0.22];
const ANKLE: Point = [-0.05, -0.60];
const TOE: Point = [0.09, -0.66];
/// Places of the upper body seen from the seat, m forward and up.
const SHOULDERS: Point = [0.15, 0.46];
const HEAD: Point = [0.23, 0.68];
const ELBOW: Point = [0.23, 0.21];
/// How much of the trunk's pitch the upper body goes along with: a rider stays nearly upright.
const PITCH_SHARE: f64 = 0.2;
/// Clothes over or under the coat's tone, grey values: coat, breeches, boot, face.
const COAT: f64 = 8.0;
const BREECHES: f64 = 62.0;
const BOOT: f64 = -18.0;
const SKIN: f64 = 88.0;
/// How far light reaches round the rider's limbs, m.
const ROUND_M: f64 = 0.03;
/// The bit, in shares of the head's length along the face and towards the jaw; width of the rein, m, and its tone.
const MOUTH: Point = [0.86, 0.15];
const REIN_M: f64 = 0.012;
const REIN_TONE: f64 = 30.0;

/// Carries a rider's places to the plate.
struct Seated<'a> {
    view: &'a Viewer<'a>,
    withers: [f64; 3],
    /// Turn of the trunk and of the rider's upper body, rad.
    pitch_rad: f64,
    lean_rad: f64,
}

/// A circle on the plate: centre and radius, px.
type Circle = (Point, f64);

impl<'a> Seated<'a> {
    fn new(view: &'a Viewer<'a>, pose: &PosedHorse) -> Self {
        let (withers, croup) = (pose.withers(), pose.croup);
        let pitch_rad = (withers[1] - croup[1]).atan2(withers[0] - croup[0]);
        Self { view, withers, pitch_rad, lean_rad: PITCH_SHARE * pitch_rad }
    }

    fn world(&self, on_horse: Point, on_body: Point) -> Point {
        let size = self.view.size;
        let offset =
            add(turned(scaled(on_horse, size), self.pitch_rad), turned(scaled(on_body, size), self.lean_rad));
        add([self.withers[0], self.withers[1]], offset)
    }

    /// A circle at a place fixed to the horse.
    fn on_horse(&self, at: Point, radius_m: f64) -> Circle {
        (self.view.px(self.world(at, [0.0; 2]), self.withers[2]), self.view.length_px(radius_m))
    }

    /// A circle at a place of the upper body.
    fn on_body(&self, at: Point, radius_m: f64) -> Circle {
        (self.view.px(self.world(SEAT, at), self.withers[2]), self.view.length_px(radius_m))
    }

    fn coat(&self) -> Vec<Shape> {
        let (waist, chest) = (scaled(SHOULDERS, 0.45), scaled(SHOULDERS, 0.88));
        let trunk = [
            self.on_body([0.0, 0.0], 0.12),
            self.on_body(waist, 0.105),
            self.on_body(chest, 0.118),
            self.on_body(add(SHOULDERS, [0.01, 0.03]), 0.075),
        ];
        let tail = [trunk[0], self.on_body([-0.15, -0.01], 0.035)];
        chain(&trunk).chain(chain(&tail)).collect()
    }

    fn arm(&self) -> Vec<Shape> {
        let (elbow, hand) = (self.on_body(ELBOW, 0.05), self.on_horse(HAND, 0.035));
        chain(&[self.on_body(SHOULDERS, 0.068), elbow, (between(elbow.0, hand.0, 0.85), hand.1)]).collect()
    }

    fn leg(&self) -> Vec<Shape> {
        let shin = self.on_horse(between(KNEE, ANKLE, 0.35), 0.066);
        chain(&[self.on_horse(add(SEAT, [0.03, -0.03]), 0.115), self.on_horse(KNEE, 0.074), shin]).collect()
    }

    fn boot(&self) -> Vec<Shape> {
        let shin = self.on_horse(between(KNEE, ANKLE, 0.3), 0.064);
        chain(&[shin, self.on_horse(ANKLE, 0.042), self.on_horse(TOE, 0.026)]).collect()
    }

    /// Face, neck and hand.
    fn skin(&self) -> Vec<Shape> {
        let head = self.on_body(HEAD, 0.088);
        let chin = [head, self.on_body(add(HEAD, [0.025, -0.06]), 0.06)];
        let nose =
            [self.on_body(add(HEAD, [0.07, -0.02]), 0.02), self.on_body(add(HEAD, [0.09, -0.035]), 0.012)];
        let neck = [self.on_body(add(SHOULDERS, [0.02, 0.04]), 0.05), self.on_body(HEAD, 0.05)];
        let hand = self.on_horse(HAND, 0.04);
        chain(&chin).chain(chain(&nose)).chain(chain(&neck)).chain(chain(&[hand, hand])).collect()
    }

    fn cap(&self) -> Vec<Shape> {
        let crown =
            [self.on_body(add(HEAD, [-0.015, 0.055]), 0.088), self.on_body(add(HEAD, [0.0, 0.07]), 0.08)];
        let brim =
            [self.on_body(add(HEAD, [-0.1, 0.03]), 0.014), self.on_body(add(HEAD, [0.15, 0.025]), 0.014)];
        chain(&crown).chain(chain(&brim)).collect()
    }
}

/// The rider's layers with their tones.
pub(super) fn layers(view: &Viewer<'_>, pose: &PosedHorse, style: &SpecimenStyle) -> Vec<(Layer, f64)> {
    let rider = Seated::new(view, pose);
    let parts = [
        (rider.coat(), COAT),
        (rider.leg(), BREECHES),
        (rider.boot(), BOOT),
        (rider.skin(), SKIN),
        (rider.cap(), BOOT),
        (rider.arm(), COAT),
    ];
    let round_px = view.length_px(ROUND_M);
    parts.map(|(shapes, over)| (Layer::new(Part::Rider, shapes, round_px), style.tones.horse + over)).into()
}

/// The rein from the mouth to the hand; too thin to count as horse.
pub(super) fn paint_reins(view: &Viewer<'_>, pose: &PosedHorse, canvas: &mut Canvas) {
    let rider = Seated::new(view, pose);
    let head = Segment::new(pose.bones[bone::HEAD]);
    let mouth = view.px(head.at(MOUTH[0], -MOUTH[1] * head.length()), rider.withers[2]);
    let rein = Shape::stroke(mouth, rider.on_horse(HAND, 0.0).0, view.length_px(REIN_M).max(0.8));
    canvas.fill(&[rein], REIN_TONE, 0.7);
}
