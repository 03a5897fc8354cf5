//! A rider in the saddle: one near leg, trunk, arm, head and hat.

use muybridge_core::bone;

use super::PosedHorse;
use super::limb::{Segment, Viewer};
use super::paint::{Canvas, Layer, Part};
use super::raster::{Point, Shape, add, between, scaled, sub};
use super::style::SpecimenStyle;

/// Places seen from the withers, m along the trunk and up from it: seat, shoulders, head, elbow, hand, knee, ankle, toe.
const SEAT: Point = [-0.21, 0.06];
const SHOULDERS: Point = [-0.06, 0.52];
const HEAD: Point = [0.02, 0.74];
const ELBOW: Point = [0.02, 0.27];
const HAND: Point = [0.24, 0.13];
const KNEE: Point = [0.10, -0.22];
const ANKLE: Point = [-0.05, -0.60];
const TOE: Point = [0.09, -0.66];
/// Clothes over or under the coat's tone, grey values: coat, breeches, boot, face.
const COAT: f64 = 8.0;
const BREECHES: f64 = 62.0;
const BOOT: f64 = -18.0;
const FACE: f64 = 88.0;

/// The rider's layers with their tones.
pub(super) fn layers(view: &Viewer<'_>, pose: &PosedHorse, style: &SpecimenStyle) -> Vec<(Layer, f64)> {
    let (withers, croup) = (pose.withers(), pose.croup);
    let chord = sub([withers[0], withers[1]], [croup[0], croup[1]]);
    let along = scaled(chord, view.size / chord[0].hypot(chord[1]).max(f64::MIN_POSITIVE));
    let up = [-along[1], along[0]];
    let circle = |[x, y]: Point, radius_m: f64| {
        let at = add([withers[0], withers[1]], add(scaled(along, x), scaled(up, y)));
        (view.px(at, withers[2]), view.length_px(radius_m))
    };
    let tube = |from: (Point, f64), to: (Point, f64)| Shape::Capsule([from, to]);
    let waist = between(SEAT, SHOULDERS, 0.45);
    let coat = vec![
        tube(circle(SEAT, 0.12), circle(waist, 0.105)),
        tube(circle(waist, 0.105), circle(between(waist, SHOULDERS, 0.8), 0.12)),
        tube(circle(between(waist, SHOULDERS, 0.8), 0.12), circle(add(SHOULDERS, [0.01, 0.03]), 0.075)),
        tube(circle(SEAT, 0.10), circle(add(SEAT, [-0.15, -0.01]), 0.035)),
    ];
    let arm = vec![
        tube(circle(SHOULDERS, 0.068), circle(ELBOW, 0.05)),
        tube(circle(ELBOW, 0.05), circle(between(ELBOW, HAND, 0.85), 0.035)),
    ];
    let leg = vec![
        tube(circle(add(SEAT, [0.03, -0.03]), 0.115), circle(KNEE, 0.075)),
        tube(circle(KNEE, 0.072), circle(between(KNEE, ANKLE, 0.35), 0.066)),
    ];
    let boot = vec![
        tube(circle(between(KNEE, ANKLE, 0.3), 0.064), circle(ANKLE, 0.042)),
        tube(circle(ANKLE, 0.042), circle(TOE, 0.026)),
    ];
    let face = vec![
        tube(circle(HEAD, 0.088), circle(add(HEAD, [0.025, -0.06]), 0.06)),
        tube(circle(add(HEAD, [0.07, -0.02]), 0.02), circle(add(HEAD, [0.09, -0.035]), 0.012)),
        tube(circle(HAND, 0.04), circle(between(ELBOW, HAND, 0.85), 0.033)),
        tube(circle(add(SHOULDERS, [0.02, 0.04]), 0.05), circle(HEAD, 0.05)),
    ];
    let hat = vec![
        tube(circle(add(HEAD, [-0.015, 0.055]), 0.088), circle(add(HEAD, [0.0, 0.075]), 0.08)),
        tube(circle(add(HEAD, [-0.12, 0.03]), 0.014), circle(add(HEAD, [0.15, 0.025]), 0.014)),
    ];
    let tone = style.tones.horse;
    [(coat, COAT), (leg, BREECHES), (boot, BOOT), (face, FACE), (hat, BOOT), (arm, COAT)]
        .map(|(shapes, over)| (Layer::new(Part::Rider, shapes, view.length_px(0.03)), tone + over))
        .into()
}

/// The rein from the mouth to the hand; too thin to count as horse.
pub(super) fn paint_reins(view: &Viewer<'_>, pose: &PosedHorse, canvas: &mut Canvas) {
    let mouth = Segment::new(pose.bones[bone::HEAD]).at(0.86, -0.085 * view.size);
    let withers = pose.withers();
    let hand = add([withers[0], withers[1]], scaled(HAND, view.size));
    let rein = Shape::stroke(view.px(mouth, withers[2]), view.px(hand, withers[2]), view.length_px(0.012).max(0.8));
    canvas.fill(&[rein], 30.0, 0.7);
}
