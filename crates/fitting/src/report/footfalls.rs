//! The footfall diagram: stance of the four feet over one stride, and which of them carry the horse when.

use muybridge_core::{Limb, Pair};

use super::page::{escape, figure, plus_minus, table};
use super::plot::{Anchor, Axis, Drawn, FULL_WIDTH_PX, Ink, LABEL_PX, Pen, svg, tick_label};
use crate::contacts::ContactInstant;
use crate::gait_analysis::Suspension;
use crate::pipeline::PlateFit;

/// Lanes from the top: Hildebrand's order, left side above right, hind feet outermost.
const LANES: [Limb; 4] = [Limb::LH, Limb::LF, Limb::RF, Limb::RH];
const TOP_PX: f64 = 30.0;
const LANE_PX: f64 = 30.0;
const BAR_PX: f64 = 15.0;
const LEFT_PX: f64 = 108.0;
const RIGHT_PX: f64 = 24.0;
/// Panels' ticks, labels of the axis, and support patterns under the lanes.
const BELOW_PX: f64 = 142.0;
/// Least distance of neighbouring support patterns, px.
const GLYPH_STEP_PX: f64 = 44.0;
/// Least distance of neighbouring panel numbers in one row, px.
const NUMBER_STEP_PX: f64 = 20.0;

/// The diagram, its numbers by leg, and what they mean.
pub(super) fn footfalls(fit: &PlateFit) -> String {
    let diagram = Diagram {
        fit,
        origin: fit.analysis.contacts[Limb::LH.index()].strike.phase,
        x: Axis { values: [0.0, 1.0], px: [LEFT_PX, FULL_WIDTH_PX - RIGHT_PX] },
        bottom: TOP_PX + 4.0 * LANE_PX,
    };
    let title = format!("Footfall diagram of {}", fit.plate.manifest.animal);
    let picture = svg(&title, [FULL_WIDTH_PX, diagram.bottom + BELOW_PX], |pen| diagram.draw(pen));
    let caption = "Stance of each foot in percent of the stride from the left hind&#8217;s strike; \
     whiskers are &#177;1 standard deviation of foot strike and lift-off. Numbered ticks are the panels. \
     Under them the support patterns, seen from above with the head to the right: filled feet are down; \
     the number is the pattern&#8217;s share of the stride in percent. A time without a foot down is \
     shaded only where it is longer than twice its own uncertainty.";
    format!("{}{}{}", figure(&picture, caption), by_leg(fit), in_words(fit))
}

struct Diagram<'a> {
    fit: &'a PlateFit,
    origin: f64,
    x: Axis,
    bottom: f64,
}

impl Diagram<'_> {
    /// Phase from the left hind's strike.
    fn since(&self, phase: f64) -> f64 {
        (phase - self.origin).rem_euclid(1.0)
    }

    fn draw(&self, pen: &Pen<'_>) -> Drawn {
        for suspension in &self.fit.analysis.suspensions {
            self.flight(pen, suspension)?;
        }
        self.axis(pen)?;
        LANES.iter().enumerate().try_for_each(|(lane, limb)| self.lane(pen, lane, *limb))?;
        self.panels(pen)?;
        self.supports(pen)
    }

    fn flight(&self, pen: &Pen<'_>, suspension: &Suspension) -> Drawn {
        let start = self.since(suspension.start);
        let name = if suspension.is_gathered() { "gathered suspension" } else { "suspension" };
        for (low, high) in within_stride(start, suspension.share) {
            pen.rectangle([self.x.at(low), TOP_PX], [self.x.at(high), self.bottom], Ink::Flight, 1.0)?;
        }
        let middle = self.x.at((start + 0.5 * suspension.share).min(1.0));
        let text = format!("{name} {:.0} ± {:.0} %", 100.0 * suspension.share, 100.0 * suspension.sd);
        // Half the label's width, so that it stays on the picture.
        let room = 85.0;
        let at = middle.clamp(LEFT_PX + room, FULL_WIDTH_PX - room);
        pen.text([at, TOP_PX - 12.0], &text, LABEL_PX, Ink::Text, Anchor::Middle)
    }

    fn axis(&self, pen: &Pen<'_>) -> Drawn {
        let ticks: Vec<f64> = (0..=10).map(|i| 10.0 * f64::from(i)).collect();
        for tick in &ticks {
            let x = self.x.at(tick / 100.0);
            pen.line(&[[x, TOP_PX], [x, self.bottom]], Ink::Rule, 0.75)?;
            pen.label([x, self.bottom + 46.0], &tick_label(*tick, &ticks), Anchor::Middle)?;
        }
        pen.label([LEFT_PX - 24.0, self.bottom + 46.0], "% of stride", Anchor::End)
    }

    fn lane(&self, pen: &Pen<'_>, lane: usize, limb: Limb) -> Drawn {
        let y = TOP_PX + (lane as f64 + 0.5) * LANE_PX;
        let contact = &self.fit.analysis.contacts[limb.index()];
        let near_off = self.fit.plate.facing.near_off(limb.side());
        let ink = super::ink_of_side(near_off);
        pen.text([LEFT_PX - 24.0, y], limb.abbreviation(), LABEL_PX + 1.0, Ink::Text, Anchor::End)?;
        pen.label([LEFT_PX - 50.0, y], &format!("{near_off:?}").to_lowercase(), Anchor::End)?;
        let (strike, duty) = (self.since(contact.strike.phase), contact.duty_factor());
        for (low, high) in within_stride(strike, duty) {
            let [top, bottom] = [y - 0.5 * BAR_PX, y + 0.5 * BAR_PX];
            pen.rectangle([self.x.at(low), top], [self.x.at(high), bottom], ink, 1.0)?;
        }
        self.whisker(pen, y, contact.strike)?;
        self.whisker(pen, y, contact.lift_off)
    }

    fn whisker(&self, pen: &Pen<'_>, y: f64, instant: ContactInstant) -> Drawn {
        let at = self.since(instant.phase);
        let [left, right] = [self.x.at(at - instant.sd), self.x.at(at + instant.sd)];
        // Paper around it keeps it visible on the bar.
        for (ink, width) in [(Ink::Paper, 3.5), (Ink::Text, 1.25)] {
            pen.line(&[[left, y], [right, y]], ink, width)?;
            for x in [left, right] {
                pen.line(&[[x, y - 4.0], [x, y + 4.0]], ink, width)?;
            }
        }
        Ok(())
    }

    /// Ticks at the panels' phases; numbers that would touch go to a second row.
    fn panels(&self, pen: &Pen<'_>) -> Drawn {
        let stride = &self.fit.fit;
        let number = |slot: usize| stride.observation.panels[stride.problem.order[slot]].camera.panel;
        let mut ticks: Vec<(f64, u32)> = stride
            .problem
            .phases
            .iter()
            .enumerate()
            .map(|(slot, phase)| (self.x.at(self.since(*phase)), number(slot)))
            .collect();
        ticks.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut last = [f64::NEG_INFINITY; 2];
        for (x, panel) in ticks {
            let row = usize::from(x - last[0] < NUMBER_STEP_PX && x - last[1] >= x - last[0]);
            last[row] = x;
            let y = self.bottom + 13.0 + 13.0 * row as f64;
            pen.line(&[[x, self.bottom - 4.0], [x, y - 7.0]], Ink::Text, 1.0)?;
            pen.text([x, y], &panel.to_string(), LABEL_PX - 1.0, Ink::Text, Anchor::Middle)?;
        }
        pen.label([LEFT_PX - 24.0, self.bottom + 13.0], "panel", Anchor::End)
    }

    /// The row of support patterns, each under its own time as far as there is room.
    fn supports(&self, pen: &Pen<'_>) -> Drawn {
        let supports = &self.fit.analysis.supports;
        let wanted: Vec<f64> =
            supports.iter().map(|s| self.x.at((self.since(s.start) + 0.5 * s.share).min(1.0))).collect();
        let row = self.bottom + 96.0;
        let [low, high] = [LEFT_PX + 10.0, FULL_WIDTH_PX - RIGHT_PX];
        for ((support, wanted), x) in
            supports.iter().zip(&wanted).zip(spread(&wanted, GLYPH_STEP_PX, [low, high]))
        {
            pen.line(&[[*wanted, self.bottom + 58.0], [x, row - 18.0]], Ink::Muted, 0.75)?;
            for limb in Limb::ALL {
                let across = if limb.pair() == Pair::Fore { 7.0 } else { -7.0 };
                let down = if limb.index().is_multiple_of(2) { -7.0 } else { 7.0 };
                let ink = super::ink_of_side(self.fit.plate.facing.near_off(limb.side()));
                let at = [x + across, row + down];
                if support.down[limb.index()] {
                    pen.dot(at, 4.5, ink, 1.0)?;
                } else {
                    pen.ring(at, 4.0, Ink::Muted)?;
                }
            }
            pen.label([x, row + 24.0], &format!("{:.0}", 100.0 * support.share), Anchor::Middle)?;
        }
        pen.label([LEFT_PX - 24.0, row], "feet down", Anchor::End)
    }
}

/// A stretch from `start` in `[0, 1)`, cut in two where it runs through the end of the stride.
fn within_stride(start: f64, share: f64) -> Vec<(f64, f64)> {
    if start + share <= 1.0 {
        vec![(start, start + share)]
    } else {
        vec![(start, 1.0), (0.0, start + share - 1.0)]
    }
}

/// Rising places moved as little as a pass each way does, so that neighbours are a step apart within limits.
fn spread(wanted: &[f64], step: f64, [low, high]: [f64; 2]) -> Vec<f64> {
    let mut places = wanted.to_vec();
    let mut least = low;
    for place in &mut places {
        *place = place.max(least);
        least = *place + step;
    }
    let mut most = high;
    for place in places.iter_mut().rev() {
        *place = place.min(most);
        most = *place - step;
    }
    places
}

fn by_leg(fit: &PlateFit) -> String {
    let analysis = &fit.analysis;
    let [stride_s, _] = analysis.stride_time_s;
    let percent = |share: f64, sd: f64| plus_minus(100.0 * share, 100.0 * sd, 1);
    let rows: Vec<Vec<String>> = LANES
        .iter()
        .map(|limb| {
            let contact = &analysis.contacts[limb.index()];
            let lag = analysis.lags[limb.index()];
            let (duty, sd) = (contact.duty_factor(), contact.duty_factor_sd());
            vec![
                limb.abbreviation().to_string(),
                percent(lag, contact.strike.sd),
                percent((lag + duty).rem_euclid(1.0), contact.lift_off.sd),
                percent(duty, sd),
                plus_minus(1000.0 * duty * stride_s, 1000.0 * sd * stride_s, 0),
            ]
        })
        .collect();
    let head = ["Foot", "Strike, %", "Lift-off, %", "Duty factor, %", "Stance, ms"];
    table("numbers", &head, &rows)
}

fn in_words(fit: &PlateFit) -> String {
    let analysis = &fit.analysis;
    let order: Vec<&str> = analysis.footfall_order().iter().map(|limb| limb.abbreviation()).collect();
    let stride_ms = 1000.0 * analysis.stride_time_s[0];
    let flights: Vec<String> = analysis
        .suspensions
        .iter()
        .map(|s| {
            let kind = if s.is_gathered() { "gathered suspension" } else { "suspension" };
            let time = plus_minus(s.share * stride_ms, s.sd * stride_ms, 0);
            format!(
                "a {kind} of {time} ms from {}&#8217;s lift-off to {}&#8217;s strike",
                s.left_by.abbreviation(),
                s.ended_by.abbreviation()
            )
        })
        .collect();
    let flights = if flights.is_empty() {
        "no suspension that its uncertainty allows to claim".to_string()
    } else {
        flights.join(", ")
    };
    format!(
        "<p>Order of footfalls {}; {flights}. Footfalls imply a {}. Froude number {:.1}; a stance limb \
         sweeps {:.0}&#176; (fore) and {:.0}&#176; (hind).</p>\n",
        order.join(" &#8594; "),
        escape(analysis.implied.name()),
        fit.froude(),
        fit.stance_sweep_deg(Pair::Fore),
        fit.stance_sweep_deg(Pair::Hind)
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stance_through_the_end_of_the_stride_is_drawn_at_both_ends() {
        let parts = within_stride(0.9, 0.3);
        assert_eq!(parts.len(), 2);
        assert!((parts[0].0 - 0.9).abs() < 1e-12 && (parts[1].1 - 0.2).abs() < 1e-12);
        assert_eq!(within_stride(0.2, 0.3), vec![(0.2, 0.5)]);
    }

    #[test]
    fn crowded_patterns_are_spread_within_the_row() {
        let places = spread(&[10.0, 11.0, 12.0, 98.0, 99.0], 8.0, [5.0, 100.0]);
        assert!(places.windows(2).all(|w| w[1] - w[0] >= 8.0 - 1e-9));
        assert!(places[0] >= 5.0 && places[4] <= 100.0);
    }
}
