//! Changing contacts by their spans: an edge dragged, a span drawn or taken away, one panel's label set.
//!
//! Every change gives a new annotation in which labels and instants of the leg agree. What a file cannot say, an
//! instant after the last panel and before the stride closes, becomes the place midway between the labels.

use muybridge_capture::{Annotation, Event, Instant, NearOff, PanelAnnotation, StanceLabel};
use muybridge_core::Pair;

use super::clock::StrideClock;
use super::lane::{SAME_PLACE, lane, stride_panels};
use super::{Edge, EdgeSource, Lane, NoSpan, StanceSpan};

/// Edges of a leg keep this distance, panels: half of what a hand can place, and still to be seen and grasped.
const LEAST_DISTANCE: f64 = 0.05;

/// A leg of an annotation.
type Leg = (NearOff, Pair);

/// Moves the strike or lift-off of a leg that is nearest to `from_panel` towards `to_panel`.
///
/// It becomes an instant placed by hand, and the panels it passes change their labels. It stops short of the other edge
/// of its span and of the neighbouring span. Nothing changes for a leg without spans.
pub fn with_edge(
    annotation: &Annotation,
    clock: &StrideClock,
    (side, pair): (NearOff, Pair),
    event: Event,
    [from_panel, to_panel]: [f64; 2],
) -> Annotation {
    let before = lane(annotation, clock, side, pair);
    let edge_of = |span: &StanceSpan| match event {
        Event::Strike => span.strike.at_panel,
        Event::LiftOff => span.lift_off.at_panel,
    };
    let distance = |span: &StanceSpan| clock.apart(edge_of(span), from_panel);
    let nearest = before.spans.iter().enumerate().min_by(|a, b| distance(a.1).total_cmp(&distance(b.1)));
    let Some((index, span)) = nearest.filter(|_| to_panel.is_finite()) else { return annotation.clone() };
    let n = before.spans.len();
    let gap_before = swing_before(clock, &before.spans[(index + n - 1) % n], span);
    let gap_after = swing_before(clock, span, &before.spans[(index + 1) % n]);
    let [low, high] = match event {
        Event::Strike => [-gap_before, span.panels()],
        Event::LiftOff => [-span.panels(), gap_after],
    };
    // The shorter way around the ring.
    let half = 0.5 * clock.closes_after_panels();
    let wanted = clock.after(edge_of(span) - half, to_panel) - half;
    let (low, high) = (low + LEAST_DISTANCE, high - LEAST_DISTANCE);
    if low > high {
        return annotation.clone();
    }
    let by_hand = Edge { at_panel: edge_of(span) + wanted.clamp(low, high), source: EdgeSource::Hand };
    let mut spans = before.spans.clone();
    match event {
        Event::Strike => spans[index].strike = by_hand,
        Event::LiftOff => spans[index].lift_off = by_hand,
    }
    written(annotation, clock, &before, &spans)
}

/// Panels from the lift-off of a span to the strike of the next, which may be the same one a stride later.
fn swing_before(clock: &StrideClock, span: &StanceSpan, next: &StanceSpan) -> f64 {
    clock.after(span.lift_off.at_panel, next.strike.at_panel)
}

/// Adds a stance drawn on an empty stretch of a leg's lane, from where the hand began to where it is.
///
/// It stops short of neighbouring spans. The panels next to it become swing where nothing was known of them. Nothing
/// changes when it begins within a span, is too short, or the leg is labelled stance throughout.
pub fn with_span(
    annotation: &Annotation,
    clock: &StrideClock,
    (side, pair): (NearOff, Pair),
    [from_panel, to_panel]: [f64; 2],
) -> Annotation {
    let before = lane(annotation, clock, side, pair);
    let unusable = !(from_panel.is_finite() && to_panel.is_finite());
    let taken = before.span_at(clock, from_panel).is_some() || before.no_span == Some(NoSpan::NeverUp);
    if unusable || taken {
        return annotation.clone();
    }
    let whole = clock.closes_after_panels();
    let room = |distance: &dyn Fn(&StanceSpan) -> f64| {
        before.spans.iter().map(distance).fold(whole, f64::min) - LEAST_DISTANCE
    };
    let drawn = if to_panel >= from_panel {
        let room = room(&|span| clock.after(from_panel, span.strike.at_panel));
        [from_panel, from_panel + (to_panel - from_panel).min(room)]
    } else {
        let room = room(&|span| clock.after(span.lift_off.at_panel, from_panel));
        [from_panel - (from_panel - to_panel).min(room), from_panel]
    };
    let duration = drawn[1] - drawn[0];
    if duration < LEAST_DISTANCE {
        return annotation.clone();
    }
    let strike = Edge { at_panel: clock.wrapped(drawn[0]), source: EdgeSource::Hand };
    let lift_off = Edge { at_panel: strike.at_panel + duration, source: EdgeSource::Hand };
    let mut spans = before.spans.clone();
    spans.push(StanceSpan { strike, lift_off });
    let mut changed = annotation.clone();
    for outside in [
        nearest_before(annotation, clock, strike.at_panel),
        nearest_after(annotation, clock, lift_off.at_panel),
    ] {
        set_if_unknown(&mut changed, outside, (side, pair));
    }
    written(&changed, clock, &before, &spans)
}

/// Index of the last stride panel before a place.
fn nearest_before(annotation: &Annotation, clock: &StrideClock, at_panel: f64) -> Option<usize> {
    let panels =
        stride_panels(annotation, clock).into_iter().filter(|(at, _)| clock.apart(*at, at_panel) > 0.0);
    panels
        .min_by(|a, b| clock.after(a.0, at_panel).total_cmp(&clock.after(b.0, at_panel)))
        .map(|found| found.1)
}

/// Index of the first stride panel at or after a place.
fn nearest_after(annotation: &Annotation, clock: &StrideClock, at_panel: f64) -> Option<usize> {
    let panels = stride_panels(annotation, clock).into_iter();
    panels
        .min_by(|a, b| clock.after(at_panel, a.0).total_cmp(&clock.after(at_panel, b.0)))
        .map(|found| found.1)
}

fn set_if_unknown(annotation: &mut Annotation, panel: Option<usize>, (side, pair): Leg) {
    let Some(panel) = panel.map(|index| &mut annotation.panels[index]) else { return };
    if panel.contacts.of(side, pair) == StanceLabel::Unknown {
        panel.contacts.set(side, pair, StanceLabel::Swing);
    }
}

/// Takes away the stance of a leg in which a place lies; its panels become swing. Nothing changes where there is none.
pub fn without_span(
    annotation: &Annotation,
    clock: &StrideClock,
    (side, pair): (NearOff, Pair),
    at_panel: f64,
) -> Annotation {
    let before = lane(annotation, clock, side, pair);
    let Some(index) = before.span_at(clock, at_panel) else { return annotation.clone() };
    let mut spans = before.spans.clone();
    spans.remove(index);
    written(annotation, clock, &before, &spans)
}

/// Sets the label of a leg in one panel and drops the instants of the leg that contradict its labels then.
pub fn with_label(
    annotation: &Annotation,
    clock: &StrideClock,
    (side, pair): (NearOff, Pair),
    panel: u32,
    label: StanceLabel,
) -> Annotation {
    let mut changed = annotation.clone();
    for entry in changed.panels.iter_mut().filter(|entry| entry.panel == panel) {
        entry.contacts.set(side, pair, label);
    }
    drop_contradicting(&mut changed, clock, (side, pair));
    changed
}

fn drop_contradicting(annotation: &mut Annotation, clock: &StrideClock, (side, pair): Leg) {
    let contradicting = lane(annotation, clock, side, pair).contradicting;
    annotation.instants.retain(|instant| !contradicting.contains(instant));
}

/// The annotation with a leg's spans; where they cannot be said, the annotation as it was.
fn written(annotation: &Annotation, clock: &StrideClock, before: &Lane, spans: &[StanceSpan]) -> Annotation {
    for spans in [spans.to_vec(), kept_on_panels(clock, spans)] {
        let changed = attempt(annotation, clock, before, &spans);
        let after = lane(&changed, clock, before.side, before.pair);
        if after.spans.len() == spans.len() {
            return changed;
        }
    }
    annotation.clone()
}

/// Edges placed by hand where no instant can be moved onto the nearest panel.
fn kept_on_panels(clock: &StrideClock, spans: &[StanceSpan]) -> Vec<StanceSpan> {
    let kept = |edge: Edge| {
        if edge.source != EdgeSource::Hand || sayable(clock, edge.at_panel).is_some() {
            return edge;
        }
        let past_last = clock.after(f64::from(clock.last()), edge.at_panel);
        let to_first = clock.after(edge.at_panel, clock.first_panel());
        let shift = if past_last <= to_first { -past_last } else { to_first };
        Edge { at_panel: edge.at_panel + shift, ..edge }
    };
    let both = |span: &StanceSpan| StanceSpan { strike: kept(span.strike), lift_off: kept(span.lift_off) };
    spans.iter().map(both).filter(|span| span.panels() > SAME_PLACE).collect()
}

fn attempt(annotation: &Annotation, clock: &StrideClock, before: &Lane, spans: &[StanceSpan]) -> Annotation {
    let leg = (before.side, before.pair);
    let mut changed = annotation.clone();
    for (at_panel, index) in stride_panels(annotation, clock) {
        relabel(
            &mut changed.panels[index],
            leg,
            inside(clock, &before.spans, at_panel),
            inside(clock, spans, at_panel),
        );
    }
    let of_leg = |i: &Instant| (i.side, i.pair) == leg;
    changed.instants.retain(|instant| !of_leg(instant));
    let edges: Vec<(Event, Edge)> = spans
        .iter()
        .flat_map(|span| [(Event::Strike, span.strike), (Event::LiftOff, span.lift_off)])
        .collect();
    for (event, edge) in edges.iter().filter(|(_, edge)| edge.source == EdgeSource::Hand) {
        let as_before = annotation
            .instants
            .iter()
            .find(|i| of_leg(i) && i.event == *event && clock.apart(i.at_panel, edge.at_panel) < SAME_PLACE);
        let at_panel = as_before.map(|i| i.at_panel).or_else(|| sayable(clock, edge.at_panel));
        changed.instants.extend(at_panel.map(|at_panel| instant(leg, *event, at_panel)));
    }
    pin(&mut changed, clock, leg, &edges);
    drop_contradicting(&mut changed, clock, leg);
    changed
}

fn relabel(panel: &mut PanelAnnotation, (side, pair): Leg, was_down: bool, is_down: bool) {
    if was_down != is_down {
        let label = if is_down { StanceLabel::Stance } else { StanceLabel::Swing };
        panel.contacts.set(side, pair, label);
    }
}

/// Edges between labels that lost their labels are held by an instant where they were.
fn pin(annotation: &mut Annotation, clock: &StrideClock, leg: Leg, edges: &[(Event, Edge)]) {
    let found = lane(annotation, clock, leg.0, leg.1).spans;
    let stands = |event: Event, at_panel: f64| {
        found.iter().any(|span| {
            let edge = if event == Event::Strike { span.strike } else { span.lift_off };
            clock.apart(edge.at_panel, at_panel) < SAME_PLACE
        })
    };
    for (event, edge) in edges.iter().filter(|(event, edge)| !stands(*event, edge.at_panel)) {
        let known = annotation.instants.iter().any(|i| {
            (i.side, i.pair) == leg
                && i.event == *event
                && clock.apart(i.at_panel, edge.at_panel) < SAME_PLACE
        });
        let at_panel = sayable(clock, edge.at_panel).filter(|_| !known);
        annotation.instants.extend(at_panel.map(|at_panel| instant(leg, *event, at_panel)));
    }
}

fn instant((side, pair): Leg, event: Event, at_panel: f64) -> Instant {
    Instant { side, pair, event, at_panel }
}

fn inside(clock: &StrideClock, spans: &[StanceSpan], at_panel: f64) -> bool {
    spans.iter().any(|span| clock.after(span.strike.at_panel, at_panel) < span.panels())
}

/// The place as an instant may hold it: none between the last panel and where the stride closes.
fn sayable(clock: &StrideClock, at_panel: f64) -> Option<f64> {
    Some(clock.wrapped(at_panel)).filter(|at| *at <= f64::from(clock.last()))
}
