//! Contact time and step length against speed, gait by gait, with what each curve rests on.

use std::fmt::Write as _;

use muybridge_core::{ContactLaw, Gait, LawKind, MPS_PER_MPH, PowerLaw, Provenance, SpeedSource};

use super::page::{escape, number, table};
use super::plot::{Anchor, Axis, Drawn, Frame, HALF_WIDTH_PX, Ink, Mark, Pen, svg, tick_label};
use crate::gait_laws::GaitLaw;
use crate::law::ContactPoint;
use crate::published;

/// Samples of a drawn curve.
const SAMPLES: usize = 80;
/// Picture and frame, px.
const HEIGHT_PX: f64 = 360.0;
const FRAME_X_PX: [f64; 2] = [46.0, HALF_WIDTH_PX - 14.0];
const FRAME_Y_PX: [f64; 2] = [HEIGHT_PX - 40.0, 64.0];
/// Speeds shown beyond a gait's usual range and its data, as a share of the lowest and highest.
const BEYOND: [f64; 2] = [0.9, 1.06];

/// The section on laws: what the curves are, then every gait that has one.
pub(super) fn laws(laws: &[GaitLaw]) -> String {
    let mut html = String::from(
        "<section id=\"laws\"><h2>Contact time and step length against speed</h2>\n\
         <p>The law is <i>T</i><sub>c</sub> = <i>a v</i><sup><i>b</i></sup> with <i>v</i> in m/s, and the \
         step is <i>D</i> = <i>v T</i><sub>c</sub>. Support time and the stance of one limb are different \
         quantities: at the gallop the feet follow one another, and the time in which any foot is down is \
         up to four times that of a single one. Never compare one with the other&#8217;s curve.</p>\n\
         <p>An exponent from two speeds is fragile: an error of 1 % in each contact time moves <i>b</i> \
         by several hundredths. The last column of each table says by how much here.</p>\n",
    );
    let published = published::laws();
    for gait in Gait::ALL {
        let of_gait: Vec<&GaitLaw> = laws.iter().filter(|law| law.law.gait == gait).collect();
        let printed = published.iter().find(|law| law.gait == gait);
        if !of_gait.is_empty() || printed.is_some() {
            html.push_str(&gait_section(gait, &of_gait, printed));
        }
    }
    html.push_str("</section>\n");
    html
}

fn gait_section(gait: Gait, laws: &[&GaitLaw], printed: Option<&ContactLaw>) -> String {
    let plot = LawPlot { laws, printed, speeds_m_s: speed_range(gait, laws) };
    let mut keys = String::new();
    for law in laws.iter().filter(|law| !is_published(law)) {
        let kind = law.law.law;
        let _ = write!(keys, "<span><span class=\"key {}\"></span>{}</span>", kind.name(), kind_name(kind));
    }
    if printed.is_some() {
        keys.push_str("<span><span class=\"key published\"></span>published, support (Huang 2012)</span>");
    }
    let name = gait.name();
    format!(
        "<section id=\"gait-{name}\"><h3>{}</h3>\n<p class=\"keys\">{keys}</p>\n\
         <div class=\"pair\">{}{}</div>\n{}</section>\n",
        capitalized(name),
        plot.picture(&format!("Contact time of the {name} against speed"), "contact time, s", false),
        plot.picture(&format!("Step length of the {name} against speed"), "step length, m", true),
        parameters(laws, printed)
    )
}

/// The published clips of a gait.
fn published_points(gait: Gait) -> Vec<ContactPoint> {
    published::clips().iter().filter(|clip| clip.gait == gait).map(published::PublishedClip::point).collect()
}

fn capitalized(name: &str) -> String {
    let mut letters = name.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}

fn is_published(law: &GaitLaw) -> bool {
    matches!(law.law.provenance, Provenance::Published { .. })
}

fn kind_name(kind: LawKind) -> &'static str {
    match kind {
        LawKind::Support => "support time (any foot down)",
        LawKind::LimbFore => "stance of a forelimb",
        LawKind::LimbHind => "stance of a hind limb",
    }
}

fn style_of(law: &GaitLaw) -> (Ink, Mark) {
    match law.law.law {
        LawKind::Support => (Ink::Support, Mark::Dot),
        LawKind::LimbFore => (Ink::LimbFore, Mark::Triangle),
        LawKind::LimbHind => (Ink::LimbHind, Mark::Square),
    }
}

/// The gait's usual speeds and its data, with a margin.
fn speed_range(gait: Gait, laws: &[&GaitLaw]) -> [f64; 2] {
    let points =
        laws.iter().flat_map(|law| law.points.clone()).chain(published_points(gait)).map(|p| p.speed_m_s);
    let usual = gait.speed_range_mph().into_iter().flatten().map(|mph| mph * MPS_PER_MPH);
    let speeds: Vec<f64> = points.chain(usual).filter(|v| v.is_finite() && *v > 0.0).collect();
    let low = speeds.iter().copied().fold(f64::INFINITY, f64::min);
    let high = speeds.iter().copied().fold(0.0, f64::max);
    if low < high { [BEYOND[0] * low, BEYOND[1] * high] } else { [0.5, 20.0] }
}

struct LawPlot<'a> {
    laws: &'a [&'a GaitLaw],
    printed: Option<&'a ContactLaw>,
    speeds_m_s: [f64; 2],
}

impl LawPlot<'_> {
    fn speeds(&self) -> impl Iterator<Item = f64> {
        let [low, high] = self.speeds_m_s;
        (0..=SAMPLES).map(move |i| low + (high - low) * i as f64 / SAMPLES as f64)
    }

    fn picture(&self, title: &str, y_name: &str, as_length: bool) -> String {
        let value = |speed: f64, time_s: f64| if as_length { speed * time_s } else { time_s };
        let curve = |law: PowerLaw, speed: f64| value(speed, law.contact_time_s(speed));
        let curves = self.laws.iter().map(|law| law.law.curve).chain(self.printed.map(|law| law.curve));
        let drawn = curves.flat_map(|law| self.speeds().map(move |speed| curve(law, speed)));
        let clips = self.printed.map_or(Vec::new(), |law| published_points(law.gait));
        let points = self.laws.iter().flat_map(|law| law.points.clone()).chain(clips);
        let points = points.map(|p| value(p.speed_m_s, p.contact_time_s));
        let highest = drawn.chain(points).filter(|v| v.is_finite()).fold(0.0, f64::max).max(1e-3);
        let frame = Frame {
            x: Axis { values: self.speeds_m_s, px: FRAME_X_PX },
            y: Axis { values: [0.0, 1.1 * highest], px: FRAME_Y_PX },
        };
        svg(title, [HALF_WIDTH_PX, HEIGHT_PX], |pen| {
            frame.draw(pen, [9, 7], ["speed, m/s", ""])?;
            mph_axis(pen, &frame, self.speeds_m_s)?;
            pen.text([0.0, 10.0], y_name, 13.0, Ink::Text, Anchor::Start)?;
            let captured = || self.laws.iter().filter(|law| !is_published(law));
            captured().try_for_each(|law| self.band(pen, &frame, law, &value))?;
            self.published(pen, &frame, &value)?;
            captured().try_for_each(|law| self.curve(pen, &frame, law, &value))
        })
    }

    /// The published curve, dashed, with its clips.
    fn published(&self, pen: &Pen<'_>, frame: &Frame, value: &dyn Fn(f64, f64) -> f64) -> Drawn {
        let Some(law) = self.printed else { return Ok(()) };
        let at = |speed: f64, time_s: f64| frame.at([speed, value(speed, time_s)]);
        let points: Vec<[f64; 2]> = self.speeds().map(|v| at(v, law.curve.contact_time_s(v))).collect();
        pen.dashed(&points, Ink::Muted, 1.75)?;
        let clips = published_points(law.gait);
        clips.iter().try_for_each(|clip| pen.ring(at(clip.speed_m_s, clip.contact_time_s), 4.0, Ink::Muted))
    }

    /// The 95 % confidence band of the curve, where there is one, cut off at the frame.
    fn band(&self, pen: &Pen<'_>, frame: &Frame, law: &GaitLaw, value: &dyn Fn(f64, f64) -> f64) -> Drawn {
        let edge = |sign: f64| -> Option<Vec<[f64; 2]>> {
            self.speeds()
                .map(|speed| {
                    let time_s =
                        law.law.curve.contact_time_s(speed) + sign * law.fit?.band_half_width_s(speed)?;
                    Some(frame.at([speed, value(speed, time_s).clamp(0.0, frame.y.values[1])]))
                })
                .collect()
        };
        let (Some(mut outline), Some(lower)) = (edge(1.0), edge(-1.0)) else { return Ok(()) };
        outline.extend(lower.into_iter().rev());
        pen.area(&outline, style_of(law).0, 0.18)
    }

    fn curve(&self, pen: &Pen<'_>, frame: &Frame, law: &GaitLaw, value: &dyn Fn(f64, f64) -> f64) -> Drawn {
        let (ink, mark) = style_of(law);
        let at = |speed: f64| frame.at([speed, value(speed, law.law.curve.contact_time_s(speed))]);
        pen.line(&self.speeds().map(at).collect::<Vec<_>>(), ink, 2.0)?;
        for point in &law.points {
            let at = frame.at([point.speed_m_s, value(point.speed_m_s, point.contact_time_s)]);
            pen.mark(at, mark, 4.0, ink)?;
        }
        Ok(())
    }
}

/// Miles per hour along the top.
fn mph_axis(pen: &Pen<'_>, frame: &Frame, speeds_m_s: [f64; 2]) -> Drawn {
    let axis = Axis { values: speeds_m_s.map(|v| v / MPS_PER_MPH), px: frame.x.px };
    let top = frame.y.px[1];
    let ticks = axis.ticks(9);
    for mph in &ticks {
        let x = axis.at(*mph);
        pen.line(&[[x, top], [x, top - 5.0]], Ink::Muted, 0.75)?;
        pen.label([x, top - 13.0], &tick_label(*mph, &ticks), Anchor::Middle)?;
    }
    pen.line(&[[axis.px[0], top], [axis.px[1], top]], Ink::Muted, 0.75)?;
    pen.label([axis.px[1], top - 30.0], "speed, mph", Anchor::End)
}

/// Parameters, what they rest on, and how firm they are.
fn parameters(laws: &[&GaitLaw], printed: Option<&ContactLaw>) -> String {
    let mut rows: Vec<Vec<String>> = laws
        .iter()
        .map(|law| {
            let name = if is_published(law) { "support time, published" } else { kind_name(law.law.law) };
            let moved = exponent_shift(&law.points).map_or("&#8211;".into(), |shift| number(shift, 3));
            law_row(name, &law.law, moved)
        })
        .collect();
    // Where a capture replaced it, the published law stands beside it.
    if let Some(law) = printed.filter(|_| !laws.iter().any(|law| is_published(law))) {
        let gait = law.gait;
        let moved =
            exponent_shift(&published_points(gait)).map_or("&#8211;".into(), |shift| number(shift, 3));
        rows.push(law_row("support time, published", law, moved));
    }
    let head =
        ["Law", "<i>a</i>, s", "<i>b</i>", "<i>n</i>", "Rests on", "Provenance", "&#916;<i>b</i> for 1 %"];
    table("laws", &head, &rows)
}

fn law_row(name: &str, law: &ContactLaw, moved: String) -> Vec<String> {
    vec![
        name.to_string(),
        number(law.curve.a, 4),
        number(law.curve.b, 4),
        law.n.to_string(),
        rests_on(law),
        escape(&provenance(&law.provenance)),
        moved,
    ]
}

fn rests_on(law: &ContactLaw) -> String {
    match (&law.interval, &law.provenance, law.n) {
        (Some(interval), _, n) => {
            let range = |[low, high]: [f64; 2]| format!("{} to {}", number(low, 3), number(high, 3));
            format!(
                "{n} points; 95 % interval of <i>a</i> {}, of <i>b</i> {}",
                range(interval.a),
                range(interval.b)
            )
        }
        (None, Provenance::Derived { from, .. }, _) => {
            let shape = from.last().map_or("", String::as_str);
            format!("one capture: shape borrowed from {}", escape(shape))
        }
        (None, _, 1) => "one clip: shape borrowed from the published walk".into(),
        (None, _, 2) => "two points: no interval".into(),
        (None, _, n) => format!("{n} points, no interval"),
    }
}

fn provenance(provenance: &Provenance) -> String {
    match provenance {
        Provenance::Captured { plates, speed, .. } => {
            let speed = match speed {
                SpeedSource::Stated => "stated",
                SpeedSource::Measured => "measured",
                SpeedSource::Inferred => "inferred",
            };
            format!("captured: {}; speed {speed}", plates.join(", "))
        }
        Provenance::Derived { from, how } => {
            format!("derived from {}; {how}", from.first().map_or("", String::as_str))
        }
        Provenance::Published { source } => format!("published: {source}"),
    }
}

/// Standard deviation of the exponent when every contact time errs by 1 % on its own; none below two speeds.
fn exponent_shift(points: &[ContactPoint]) -> Option<f64> {
    let logs: Vec<f64> = points.iter().map(|p| p.speed_m_s.ln()).collect();
    let mean = logs.iter().sum::<f64>() / logs.len() as f64;
    let spread = logs.iter().map(|v| (v - mean).powi(2)).sum::<f64>();
    (logs.len() >= 2 && spread > 1e-12).then(|| 0.01 / spread.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_percent_moves_the_published_exponents_by_hundredths() {
        for gait in [Gait::Walk, Gait::Trot, Gait::Rack, Gait::Canter, Gait::Gallop] {
            let shift = exponent_shift(&published_points(gait)).unwrap();
            assert!((0.01..0.1).contains(&shift), "{gait}: {shift}");
        }
        assert!(exponent_shift(&[ContactPoint { speed_m_s: 2.0, contact_time_s: 0.5 }]).is_none());
    }
}
