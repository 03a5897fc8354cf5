//! A leap, which no plate shows: the gallop's limb folding under a ballistic body.
//!
//! One period runs from the take-off strike of the left hind to its strike after the landing: both hinds push, the horse
//! flies, the trailing and then the leading fore land, the hinds are gathered under the body, and the next leap could begin.

mod body;
mod clearance;
mod limbs;
mod plan;

use muybridge_core::{Gait, Lead, Limb, Pair, Provenance, Skeleton, Stride};

use body::Body;
use clearance::Fence;
use limbs::{Folding, Legs};
use plan::Plan;

/// Height of the fence that every toe clears, share of the withers height: 0.8 m for a horse of 1.6 m.
const FENCE: f64 = 0.5;
/// Rounds in which body and legs settle on one centre of mass, and the body is lowered until every leg reaches its
/// print: the legs hold a fifth of the mass, so each round leaves a fifth of the error.
const SETTLING_ROUNDS: usize = 12;
/// A standing toe farther than this from its print makes the body give way, m.
const REACH_TOLERANCE_M: f64 = 2e-4;
/// How much more than what is lacking the body is lowered: a leg that slants gains less than the body falls.
const LOWERING: f64 = 1.3;

/// A leap derived from the captured gallop that stands for its gait; none where a leg cannot reach the ground or a toe
/// cannot clear a fence of half the withers height.
pub(crate) fn leap(gallop: &Stride, reference: &Skeleton) -> Option<Stride> {
    let skeleton = gallop.skeleton(reference);
    let body = Body::new(gallop, &skeleton);
    let legs = Legs::new(gallop, &skeleton, &body);
    let mut folding = Folding::default();
    loop {
        let mut stride = settled(gallop, &body, &legs, folding)?;
        let fence = Fence::under(&stride, &skeleton, FENCE);
        let knocks = |pair: Pair| {
            let legs = Limb::ALL.into_iter().filter(|limb| limb.pair() == pair);
            legs.map(|limb| fence.cleared_by_m(&stride, &skeleton, limb)).any(|room_m| room_m < 0.0)
        };
        let low = [Pair::Fore, Pair::Hind].into_iter().filter(|pair| knocks(*pair)).collect::<Vec<Pair>>();
        if low.is_empty() {
            stride.provenance = provenance(gallop, folding);
            return Some(stride);
        }
        if !low.into_iter().all(|pair| folding.add(pair)) {
            return None;
        }
    }
}

/// The stride with the centre of mass on its path and every standing toe on its print.
fn settled(gallop: &Stride, body: &Body, legs: &Legs<'_>, folding: Folding) -> Option<Stride> {
    let mut stride = begun(gallop, &body.plan);
    body.shape_trunk(&mut stride);
    let folded = legs.folded(folding);
    legs.shape(&mut stride, &folded);
    let (mut lowered_m, mut lacking_m) = (0.0, f64::INFINITY);
    for _ in 0..SETTLING_ROUNDS {
        body.place_root(&mut stride, &legs.skeleton, lowered_m);
        legs.set_prints(&mut stride);
        lacking_m = legs.solve(&mut stride, &folded);
        if lacking_m > REACH_TOLERANCE_M {
            lowered_m += LOWERING * lacking_m;
        }
    }
    (lacking_m <= REACH_TOLERANCE_M).then_some(stride)
}

/// The gallop's horse at the leap's times.
fn begun(gallop: &Stride, plan: &Plan) -> Stride {
    Stride {
        id: format!("leap-of-{}", gallop.id),
        gait: Gait::Leap,
        lead: Some(Lead { fore: plan.lead, hind: plan.lead }),
        speed_m_s: plan.speed_m_s as f32,
        stride_time_s: plan.stride_time_s as f32,
        contacts: plan.contacts,
        ..gallop.clone()
    }
}

fn provenance(gallop: &Stride, folding: Folding) -> Provenance {
    let more = match folding.description() {
        Some(legs) => format!(", folded further over the fence as in the model of a drawn leap ({legs})"),
        None => String::new(),
    };
    Provenance::Derived {
        from: vec![gallop.id.clone()],
        how: format!(
            "no plate shows a leap: the gallop's horse and limb folding, timed for a fence{more}; trunk, footfalls and a \
             ballistic centre of mass from the model of a drawn leap; neck and head carried half as in the \
             gallop, moved as in the model"
        ),
    }
}

#[cfg(test)]
mod tests;
