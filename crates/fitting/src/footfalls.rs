//! Contacts and gait from labels and hand-placed instants alone, before anything is fitted.
//!
//! The stride is a ring of panels that closes after a number of panels. Around it every leg has its stance spans, in
//! panel coordinates: 4.25 is a quarter of the way from panel 4 to panel 5. An edge of a span is where a person placed
//! an instant, or midway between a stance and a swing label.

mod clock;
mod edit;
mod lane;
mod live;

use muybridge_capture::{Annotation, Instant, NearOff};
use muybridge_core::Pair;

pub use clock::{ClosedBy, StrideClock};
pub use edit::{with_edge, with_label, with_span, without_span};
pub(crate) use lane::stride_panels;
pub(crate) use live::contacts;
pub use live::{LawDistance, LiveGait, Missing, leg_name};

/// The four lanes of the footfall bar, top to bottom.
pub const LANES: [(NearOff, Pair); 4] = [
    (NearOff::Near, Pair::Fore),
    (NearOff::Off, Pair::Fore),
    (NearOff::Near, Pair::Hind),
    (NearOff::Off, Pair::Hind),
];

/// How the place of an edge is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EdgeSource {
    /// A person placed it.
    Hand,
    /// Midway in the bracket that the labels leave: last panel before the edge and first after it.
    Midway {
        /// Both ends, panels; they may lie before the first or beyond the last panel of the stride.
        bracket: [f64; 2],
    },
}

/// A strike or lift-off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Edge {
    /// Where, panels.
    pub at_panel: f64,
    /// How it is known.
    pub source: EdgeSource,
}

impl Edge {
    /// Standard deviation, panels: a tenth for an instant placed by hand, the bracket's width over the square root of
    /// 12 (a uniform distribution) for one between labels.
    pub fn sd_panels(&self) -> f64 {
        match self.source {
            EdgeSource::Hand => HAND_SD_PANELS,
            EdgeSource::Midway { bracket: [low, high] } => (high - low) / 12f64.sqrt(),
        }
    }
}

/// A person places an instant to a tenth of a panel, as `contacts.rs` takes it.
const HAND_SD_PANELS: f64 = 0.1;

/// A stance of one leg.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StanceSpan {
    /// Foot strike, from the stride's first panel to less than where the stride closes.
    pub strike: Edge,
    /// Lift-off, after the strike and less than a stride later: it may lie beyond where the stride closes.
    pub lift_off: Edge,
}

impl StanceSpan {
    /// Duration, panels.
    pub fn panels(&self) -> f64 {
        self.lift_off.at_panel - self.strike.at_panel
    }
}

/// Why a leg has no stance span.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoSpan {
    /// No panel is labelled stance and no two instants make one.
    NeverDown,
    /// No panel is labelled swing and no two instants make one.
    NeverUp,
}

/// What one leg does around the stride.
#[derive(Clone, Debug, PartialEq)]
pub struct Lane {
    /// Near or off.
    pub side: NearOff,
    /// Fore or hind.
    pub pair: Pair,
    /// Stance spans in order of their strikes; they never overlap.
    pub spans: Vec<StanceSpan>,
    /// Why there is none.
    pub no_span: Option<NoSpan>,
    /// Instants that the labels contradict; they are not used.
    pub contradicting: Vec<Instant>,
}

impl Lane {
    /// Index into `spans` of the one in which a place lies, panels; places a whole stride apart are the same.
    pub fn span_at(&self, clock: &StrideClock, at_panel: f64) -> Option<usize> {
        let inside = |span: &StanceSpan| clock.after(span.strike.at_panel, at_panel) < span.panels();
        self.spans.iter().position(inside)
    }

    /// The longest span: of a leg that comes down twice in a stride, as in a leap, the one that counts.
    pub fn longest(&self) -> Option<&StanceSpan> {
        self.spans.iter().max_by(|a, b| a.panels().total_cmp(&b.panels()))
    }
}

/// The footfall bar: four lanes over one stride.
#[derive(Clone, Debug, PartialEq)]
pub struct Footfalls {
    /// When panels were taken and where the stride closes.
    pub clock: StrideClock,
    /// The legs in the order of [`LANES`].
    pub lanes: [Lane; 4],
}

impl Footfalls {
    /// Reads the lanes off an annotation's labels and instants.
    pub fn new(annotation: &Annotation, clock: StrideClock) -> Self {
        let lanes = LANES.map(|(side, pair)| lane::lane(annotation, &clock, side, pair));
        Self { clock, lanes }
    }

    /// The lane of a leg.
    pub fn lane(&self, side: NearOff, pair: Pair) -> &Lane {
        &self.lanes[2 * usize::from(pair == Pair::Hind) + usize::from(side == NearOff::Off)]
    }

    /// The pieces of a leg's spans that show between two places, panels: a span that reaches over the end of the
    /// stride, and panels photographed after it closes, appear again a stride away. In rising order.
    pub fn shown(&self, side: NearOff, pair: Pair, [low, high]: [f64; 2]) -> Vec<ShownSpan> {
        let period = self.clock.closes_after_panels();
        // A stride's width beyond the panels is as far as anybody looks.
        let low = low.max(f64::from(self.clock.first()) - period);
        let high = high.min(f64::from(self.clock.last()) + period);
        let mut shown = Vec::new();
        for (index, span) in self.lane(side, pair).spans.iter().enumerate() {
            let first = ((low - span.lift_off.at_panel) / period).floor() as i64;
            let last = ((high - span.strike.at_panel) / period).ceil() as i64;
            for turn in first..=last {
                let shift = turn as f64 * period;
                let [from, to] = [span.strike, span.lift_off].map(|edge| edge.at_panel + shift);
                if to > low && from < high {
                    shown.push(ShownSpan { span: index, from_panel: from, to_panel: to });
                }
            }
        }
        shown.sort_by(|a, b| a.from_panel.total_cmp(&b.from_panel));
        shown
    }
}

/// A span as it appears in a stretch of panels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShownSpan {
    /// Index into the lane's spans.
    pub span: usize,
    /// Strike as it appears, panels; it may lie before the stretch.
    pub from_panel: f64,
    /// Lift-off as it appears, panels; it may lie beyond the stretch.
    pub to_panel: f64,
}

#[cfg(test)]
mod tests;
