//! From labels and instants to the stance spans of a leg.
//!
//! Between two neighbouring labels of the ring the leg changes its state once, where they differ, or not at all. An
//! instant counts where it agrees with the labels on either side; two instants between equal labels make a stance (or a
//! swing) too short for any panel to show.

use muybridge_capture::{Annotation, Event, Instant, NearOff, PanelUse, StanceLabel};
use muybridge_core::Pair;

use super::clock::StrideClock;
use super::{Edge, EdgeSource, Lane, NoSpan, StanceSpan};

/// A label that says something: place in the first turn, and whether the hoof is down.
#[derive(Clone, Copy)]
struct Label {
    at_panel: f64,
    down: bool,
}

/// A change of state: strike or lift-off.
struct Change {
    event: Event,
    edge: Edge,
}

pub(super) fn lane(annotation: &Annotation, clock: &StrideClock, side: NearOff, pair: Pair) -> Lane {
    let labels = labels(annotation, clock, side, pair);
    let instants: Vec<Instant> =
        annotation.instants.iter().copied().filter(|i| i.side == side && i.pair == pair).collect();
    let finite: Vec<Instant> = instants.iter().copied().filter(|i| i.at_panel.is_finite()).collect();
    let changes = if labels.is_empty() {
        unlabelled_changes(clock, &finite)
    } else {
        (0..labels.len()).flat_map(|k| changes_after(k, &labels, clock, &finite)).collect()
    };
    let spans = spans(clock, &changes);
    let used = |instant: &Instant| {
        changes.iter().any(|change| {
            change.event == instant.event
                && change.edge.source == EdgeSource::Hand
                && clock.apart(change.edge.at_panel, instant.at_panel) < SAME_PLACE
        })
    };
    let contradicting = if labels.is_empty() {
        Vec::new()
    } else {
        instants.into_iter().filter(|instant| !used(instant)).collect()
    };
    let no_span = spans
        .is_empty()
        .then(|| if labels.iter().any(|label| label.down) { NoSpan::NeverUp } else { NoSpan::NeverDown });
    Lane { side, pair, spans, no_span, contradicting }
}

/// Places closer than this are one, panels: far below what can be drawn, far above rounding.
pub(super) const SAME_PLACE: f64 = 1e-9;

/// Places of the panels that count for the stride, in their order on the ring, with their indices in the annotation.
pub(crate) fn stride_panels(annotation: &Annotation, clock: &StrideClock) -> Vec<(f64, usize)> {
    let counts = |usage: PanelUse, panel: u32| {
        usage == PanelUse::Stride && (clock.first()..=clock.last()).contains(&panel)
    };
    let mut panels: Vec<(f64, usize)> = annotation
        .panels
        .iter()
        .enumerate()
        .filter(|(_, panel)| counts(panel.usage, panel.panel))
        .map(|(index, panel)| (clock.wrapped(f64::from(panel.panel)), index))
        .collect();
    panels.sort_by(|a, b| a.0.total_cmp(&b.0));
    panels
}

fn labels(annotation: &Annotation, clock: &StrideClock, side: NearOff, pair: Pair) -> Vec<Label> {
    let label = |(at_panel, index): (f64, usize)| match annotation.panels[index].contacts.of(side, pair) {
        StanceLabel::Stance => Some(Label { at_panel, down: true }),
        StanceLabel::Swing => Some(Label { at_panel, down: false }),
        StanceLabel::Unknown => None,
    };
    stride_panels(annotation, clock).into_iter().filter_map(label).collect()
}

/// What happens between a label and the next one around the ring.
fn changes_after(k: usize, labels: &[Label], clock: &StrideClock, instants: &[Instant]) -> Vec<Change> {
    let (from, to) = (labels[k], labels[(k + 1) % labels.len()]);
    let is_last = k + 1 == labels.len();
    let width = to.at_panel - from.at_panel + if is_last { clock.closes_after_panels() } else { 0.0 };
    let bracket = [from.at_panel, from.at_panel + width];
    // Where an event was placed between the two labels, from a place on.
    let placed = |event: Event, since: f64| {
        let places = instants.iter().filter(|i| i.event == event);
        let mut inside = places
            .map(|i| from.at_panel + clock.after(from.at_panel, i.at_panel))
            .filter(|at| *at <= bracket[1] + SAME_PLACE && *at > since);
        inside.next()
    };
    let by_hand = |at_panel: f64| Edge { at_panel, source: EdgeSource::Hand };
    let (leaves, returns) =
        if from.down { (Event::LiftOff, Event::Strike) } else { (Event::Strike, Event::LiftOff) };
    let first = placed(leaves, f64::NEG_INFINITY);
    if from.down != to.down {
        let midway =
            Edge { at_panel: 0.5 * (bracket[0] + bracket[1]), source: EdgeSource::Midway { bracket } };
        return vec![Change { event: leaves, edge: first.map_or(midway, by_hand) }];
    }
    match first.and_then(|first| Some((first, placed(returns, first)?))) {
        Some((first, second)) => {
            vec![
                Change { event: leaves, edge: by_hand(first) },
                Change { event: returns, edge: by_hand(second) },
            ]
        }
        None => Vec::new(),
    }
}

/// Without any label: the first strike that was placed and the lift-off that follows it.
fn unlabelled_changes(clock: &StrideClock, instants: &[Instant]) -> Vec<Change> {
    let Some(strike) = instants.iter().find(|i| i.event == Event::Strike) else { return Vec::new() };
    let lift_offs = instants.iter().filter(|i| i.event == Event::LiftOff);
    let after = |i: &Instant| clock.after(strike.at_panel, i.at_panel);
    let Some(lift_off) = lift_offs.min_by(|a, b| after(a).total_cmp(&after(b))) else { return Vec::new() };
    [strike, lift_off]
        .map(|i| Change { event: i.event, edge: Edge { at_panel: i.at_panel, source: EdgeSource::Hand } })
        .into()
}

/// Strikes with the lift-offs that follow them; the changes alternate around the ring.
fn spans(clock: &StrideClock, changes: &[Change]) -> Vec<StanceSpan> {
    let mut spans: Vec<StanceSpan> = Vec::new();
    for (k, change) in changes.iter().enumerate().filter(|(_, change)| change.event == Event::Strike) {
        let next = &changes[(k + 1) % changes.len()];
        let strike = moved(change.edge, clock.wrapped(change.edge.at_panel));
        let duration = clock.after(change.edge.at_panel, next.edge.at_panel);
        if next.event == Event::LiftOff && duration > SAME_PLACE {
            let lift_off = moved(next.edge, strike.at_panel + duration);
            spans.push(StanceSpan { strike, lift_off });
        }
    }
    spans.sort_by(|a, b| a.strike.at_panel.total_cmp(&b.strike.at_panel));
    spans
}

/// The same edge whole strides away, with its bracket.
fn moved(edge: Edge, at_panel: f64) -> Edge {
    let shift = at_panel - edge.at_panel;
    let source = match edge.source {
        EdgeSource::Hand => EdgeSource::Hand,
        EdgeSource::Midway { bracket } => EdgeSource::Midway { bracket: bracket.map(|end| end + shift) },
    };
    Edge { at_panel, source }
}
