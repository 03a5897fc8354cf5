//! Contact sheets: the synthesised stride over the plate it came from, posture by posture, to one scale.

use muybridge_capture::{Facing, NearOff};
use muybridge_core::{Database, Gait, Limb, MPS_PER_MPH, Pair, Provenance, Skeleton, SpeedSource, Stride};

use super::captures::{self, captured};
use super::page::{escape, figure, number};
use super::plot::{Anchor, Drawn, FULL_WIDTH_PX, Ink, LABEL_PX, Pen, svg};
use super::posture::{Cell, MARGIN_PX, POSTURES, Posture, ink_of, postures_of_plate, postures_of_stride};
use super::{summary, supports};
use crate::pipeline::PlateFit;

/// Postures in a row; six are as large as a page's width allows with the whole stride in sight.
const COLUMNS: usize = 6;
/// Height of the legend, px.
const LEGEND_PX: f64 = 30.0;
/// Height of a row's name over its figures, px.
const NAME_PX: f64 = 20.0;
/// Room under the ground line for the feet that are down and the posture's label, px.
const FOOT_PX: f64 = 46.0;
/// A stride whose speed is farther than this share from the plate's moves otherwise for that reason alone: a tenth of
/// the speed changes a duty factor by nearly a tenth.
const FAR_IN_SPEED: f64 = 0.1;

/// A stride of the database, and the plate it is held against where there is one.
struct Sheet<'a> {
    synthesised: &'a Stride,
    captured: Option<&'a Stride>,
    fit: Option<&'a PlateFit>,
}

/// All sheets, gait by gait, slowest first.
pub(super) fn sheets(fits: &[PlateFit], database: &Database, skeleton: &Skeleton) -> String {
    let gaits: String = Gait::ALL.into_iter().map(|gait| of_gait(gait, fits, database, skeleton)).collect();
    let gaits = if gaits.is_empty() { "<p>The database holds no stride.</p>\n".to_string() } else { gaits };
    format!(
        "<section id=\"sheets\"><h2>Contact sheets</h2>\n<p>The stride that the database plays, over the plate: \
         twelve moments from the left hind&#8217;s strike, each over the panel nearest to it in phase, to one \
         scale.</p>\n{gaits}</section>\n"
    )
}

fn of_gait(gait: Gait, fits: &[PlateFit], database: &Database, skeleton: &Skeleton) -> String {
    let captures = captured(database, gait);
    let mut sheets: Vec<Sheet<'_>> = captures
        .into_iter()
        .map(|capture| Sheet {
            synthesised: played(database, capture),
            captured: Some(capture),
            fit: fits.iter().find(|fit| fit.id() == capture.id),
        })
        .collect();
    if sheets.is_empty() {
        let Some(synthesised) = in_mid_range(database, gait) else { return String::new() };
        sheets.push(Sheet { synthesised, captured: None, fit: None });
    }
    let drawn: String = sheets.iter().map(|sheet| sheet.html(skeleton)).collect();
    format!("<h3 id=\"sheet-{gait}\">{gait}</h3>\n{drawn}{}", captures::section(fits, database, gait))
}

/// The stride that the database plays at a capture's speed: of those derived from the capture the nearest in speed,
/// else of those derived from another capture of its gait; the capture itself where there is none.
fn played<'a>(database: &'a Database, capture: &'a Stride) -> &'a Stride {
    let sources = |stride: &'a Stride| match &stride.provenance {
        Provenance::Derived { from, .. } => Some(from),
        Provenance::Captured { .. } | Provenance::Published { .. } => None,
    };
    let is_own = |stride: &&'a Stride| sources(stride).is_some_and(|from| from.contains(&capture.id));
    let speed_m_s = f64::from(capture.speed_m_s);
    nearest_in_speed(database.strides_of(capture.gait).filter(is_own), speed_m_s)
        .or_else(|| {
            let derived = database.strides_of(capture.gait).filter(|stride| sources(stride).is_some());
            nearest_in_speed(derived, speed_m_s)
        })
        .unwrap_or(capture)
}

/// The stride nearest to the middle of its gait's range of speeds.
fn in_mid_range(database: &Database, gait: Gait) -> Option<&Stride> {
    let mid_m_s = gait.speed_range_mph().map_or(0.0, |[low, high]| 0.5 * (low + high) * MPS_PER_MPH);
    nearest_in_speed(database.strides_of(gait), mid_m_s)
}

fn nearest_in_speed<'a>(strides: impl Iterator<Item = &'a Stride>, speed_m_s: f64) -> Option<&'a Stride> {
    let off = |stride: &Stride| (f64::from(stride.speed_m_s) - speed_m_s).abs();
    strides.min_by(|a, b| off(a).total_cmp(&off(b)))
}

impl Sheet<'_> {
    fn html(&self, skeleton: &Skeleton) -> String {
        let mut stretches = vec![("synthesised".to_string(), supports::sequence(self.synthesised))];
        if let Some(capture) = self.captured {
            stretches.insert(0, ("captured".to_string(), supports::sequence(capture)));
        }
        let title = format!("Support sequence of {}", self.synthesised.id);
        let supports = figure(
            &supports::picture(&title, &stretches),
            "Support sequence from the left hind&#8217;s strike, seen from above, head up: triangles are the fore \
             feet over the circles of the hind feet, left on the left, filled where they are down; the share of \
             the stride that each pattern lasts (after Huang 2012, Fig. 3.5).",
        );
        let facts = self.captured.map_or(String::new(), |capture| {
            format!("<p class=\"note\"><b>Captured:</b> {}</p>\n", facts(capture))
        });
        format!(
            "{}{supports}{facts}<p class=\"note\"><b>Synthesised:</b> {}</p>\n",
            figure(&self.picture(skeleton), &self.caption()),
            facts_of_played(self.synthesised, self.captured)
        )
    }

    /// Which way the animal stands to the reader.
    fn facing(&self) -> Facing {
        self.fit.map_or(Facing::Right, |fit| fit.plate.facing)
    }

    fn caption(&self) -> String {
        let near = self.side(NearOff::Near);
        let plate = match self.fit {
            Some(fit) => format!(
                "The synthesised stride at twelve phases, and under each the fitted skeleton of the panel of {} that \
                 is nearest in phase ({} panels; where they are fewer than twelve, one may stand twice). Forward is \
                 to the right, whichever way the animal faces on the plate.",
                escape(fit.id()),
                fit.calibration.stride.len()
            ),
            None => "The synthesised stride at twelve phases, forward to the right; there is no plate to stand under \
                     it."
                .to_string(),
        };
        format!(
            "{plate} Near is the {near} side. Dots mark the hooves in stance, and the feet that are down are named \
             under the ground line."
        )
    }

    fn side(&self, near_off: NearOff) -> String {
        format!("{:?}", self.facing().side(near_off)).to_lowercase()
    }

    /// The names and postures of the rows: the synthesised stride, and the plate.
    fn rows(&self, skeleton: &Skeleton) -> Vec<(String, Vec<Posture>)> {
        let speed = number(f64::from(self.synthesised.speed_m_s), 2);
        let mut rows = vec![(
            format!("synthesised: {} at {speed} m/s", self.synthesised.id),
            postures_of_stride(self.synthesised, skeleton),
        )];
        if let Some(fit) = self.fit {
            let speed = number(fit.calibration.speed_m_s.value, 2);
            rows.push((format!("plate: {} at {speed} m/s", fit.id()), postures_of_plate(fit)));
        }
        rows
    }

    fn picture(&self, skeleton: &Skeleton) -> String {
        let rows = self.rows(skeleton);
        let cell_px = FULL_WIDTH_PX / COLUMNS as f64;
        let all = || rows.iter().flat_map(|(_, postures)| postures).flat_map(Posture::points);
        let reach = |axis: usize, start: f64, pick: fn(f64, f64) -> f64| {
            all().map(|point| point[axis]).fold(start, pick)
        };
        let (rear_m, front_m, top_m) =
            (reach(0, -0.1, f64::min), reach(0, 0.1, f64::max), reach(1, 1.0, f64::max));
        let px_per_m = (cell_px - 2.0 * MARGIN_PX) / (front_m - rear_m);
        let row_px = NAME_PX + top_m * px_per_m + FOOT_PX;
        let blocks = POSTURES.div_ceil(COLUMNS);
        let size = [FULL_WIDTH_PX, LEGEND_PX + (blocks * rows.len()) as f64 * row_px];
        svg(&format!("Contact sheet of {}", self.synthesised.id), size, |pen| {
            self.legend(pen, px_per_m)?;
            for block in 0..blocks {
                for (i, (name, postures)) in rows.iter().enumerate() {
                    let top = LEGEND_PX + (block * rows.len() + i) as f64 * row_px;
                    pen.text([4.0, top + 8.0], name, LABEL_PX, Ink::Text, Anchor::Start)?;
                    for (column, posture) in postures.iter().skip(block * COLUMNS).take(COLUMNS).enumerate() {
                        let cell = Cell {
                            left_px: column as f64 * cell_px,
                            ground_px: top + row_px - FOOT_PX,
                            width_px: cell_px,
                            px_per_m,
                            rear_m,
                        };
                        posture.draw(pen, &cell, self.facing())?;
                    }
                }
            }
            Ok(())
        })
    }

    fn legend(&self, pen: &Pen<'_>, px_per_m: f64) -> Drawn {
        let y = 10.0;
        let sides = [(4.0, NearOff::Near), (240.0, NearOff::Off)];
        for (x, near_off) in sides {
            let [fore, hind] =
                [Pair::Fore, Pair::Hind].map(|pair| self.facing().limb(near_off, pair).abbreviation());
            let name = format!("{near_off:?}").to_lowercase();
            pen.line(&[[x, y], [x + 24.0, y]], ink_of(near_off), 3.0)?;
            let text = format!("{name}: {} limbs ({fore}, {hind})", self.side(near_off));
            pen.label([x + 30.0, y], &text, Anchor::Start)?;
        }
        pen.line(&[[476.0, y], [500.0, y]], Ink::Body, 3.0)?;
        pen.label([506.0, y], "tail root, spine, neck, head", Anchor::Start)?;
        pen.dot([708.0, y], 4.0, Ink::NearDark, 1.0)?;
        pen.label([718.0, y], "hoof in stance", Anchor::Start)?;
        let right = FULL_WIDTH_PX - 4.0;
        let left = right - px_per_m;
        for x in [left, right] {
            pen.line(&[[x, y - 4.0], [x, y + 4.0]], Ink::Muted, 1.0)?;
        }
        pen.line(&[[left, y], [right, y]], Ink::Muted, 1.0)?;
        pen.label([left - 6.0, y], "1 m", Anchor::End)
    }
}

/// Where a stride comes from, its speed, and its footfalls, in one line.
fn facts(stride: &Stride) -> String {
    let of_limb = |value: &dyn Fn(Limb) -> f32| {
        let each =
            Limb::ALL.map(|limb| format!("{} {}", limb.abbreviation(), number(f64::from(value(limb)), 2)));
        each.join(", ")
    };
    let contact = |limb: Limb| stride.contacts[limb.index()];
    let origin = contact(Limb::LH).strike_phase;
    let lead = stride.lead.map_or("no lead".to_string(), summary::lead_name);
    format!(
        "{}. Speed {} m/s ({} mph), {}; stride {} s, {} m. Duty factors {}. Strikes after the left hind&#8217;s, in \
         strides: {}; {lead}.",
        origin_in_words(stride),
        number(f64::from(stride.speed_m_s), 2),
        number(f64::from(stride.speed_m_s) / MPS_PER_MPH, 1),
        speed_in_words(stride),
        number(f64::from(stride.stride_time_s), 3),
        number(f64::from(stride.stride_length_m()), 2),
        of_limb(&|limb| contact(limb).duty_factor()),
        of_limb(&|limb| (contact(limb).strike_phase - origin).rem_euclid(1.0)),
    )
}

/// How the speed is known.
fn speed_in_words(stride: &Stride) -> &'static str {
    match stride.provenance {
        Provenance::Captured { speed: SpeedSource::Stated, .. } => "stated with the plate",
        Provenance::Captured { speed: SpeedSource::Measured, .. } => "measured from distance and time",
        Provenance::Captured { speed: SpeedSource::Inferred, .. } => {
            "INFERRED from the stride&#8217;s length"
        }
        Provenance::Derived { .. } => "as set",
        Provenance::Published { .. } => "published",
    }
}

/// The line of the stride that is played; where that is the capture itself, it says so.
fn facts_of_played(stride: &Stride, captured: Option<&Stride>) -> String {
    match captured {
        Some(capture) if capture.id == stride.id => {
            "no stride was derived from this capture, so the capture itself is played.".to_string()
        }
        Some(capture) => format!("{}{}", facts(stride), far_in_speed(stride, capture)),
        None => format!("No plate of this gait was fitted. {}", facts(stride)),
    }
}

/// A warning where the two speeds are far apart.
fn far_in_speed(stride: &Stride, capture: &Stride) -> String {
    let ratio = f64::from(stride.speed_m_s) / f64::from(capture.speed_m_s);
    if (ratio - 1.0).abs() < FAR_IN_SPEED {
        return String::new();
    }
    let how = if ratio < 1.0 { "slower" } else { "faster" };
    format!(
        " <span class=\"warning\">The stride nearest in speed is {} % {how} than the plate; part of what differs comes \
         of that.</span>",
        number(100.0 * (ratio - 1.0).abs(), 0)
    )
}

fn origin_in_words(stride: &Stride) -> String {
    let id = escape(&stride.id);
    match &stride.provenance {
        Provenance::Captured { plates, .. } => format!("{id}, from plate {}", escape(&plates.join(", "))),
        Provenance::Derived { from, how } => {
            format!("{id}, derived from {}: {}", escape(&from.join(", ")), escape(how))
        }
        Provenance::Published { source } => format!("{id}, published: {}", escape(source)),
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{database, plate};
    use super::*;

    fn page(database: &Database) -> String {
        sheets(std::slice::from_ref(plate()), database, &Skeleton::reference())
    }

    /// All texts of the first picture, in the order they are drawn.
    fn texts(page: &str) -> Vec<&str> {
        let picture = page.split("</svg>").next().unwrap();
        picture
            .split("<text")
            .skip(1)
            .map(|part| part.split_once('>').unwrap().1.split('<').next().unwrap().trim())
            .collect()
    }

    /// Feet named before each label that begins with a word.
    fn feet_before<'a>(texts: &[&'a str], word: &str) -> Vec<(&'a str, Vec<&'a str>)> {
        let is_label = |text: &str| text.starts_with("phase ") || text.starts_with("panel ");
        let mut found = Vec::new();
        let mut feet = Vec::new();
        for text in texts {
            if is_label(text) {
                let named = std::mem::take(&mut feet);
                if text.starts_with(word) {
                    found.push((*text, named));
                }
            } else if ["LF", "RF", "LH", "RH"].contains(text) {
                feet.push(*text);
            }
        }
        found
    }

    /// The plate's capture and strides derived from it at other speeds, m/s, which move as it does.
    fn with_derived(speeds_m_s: &[f32]) -> Database {
        let mut database = database();
        database.strides.retain(|stride| stride.id == plate().id());
        let capture = database.strides[0].clone();
        database.strides.extend(speeds_m_s.iter().map(|&speed_m_s| {
            let mut stride = capture.clone();
            stride.id = format!("at {speed_m_s}");
            stride.speed_m_s = speed_m_s;
            stride.provenance = Provenance::Derived { from: vec![capture.id.clone()], how: "by hand".into() };
            stride
        }));
        database
    }

    #[test]
    fn a_sheet_has_twelve_and_twelve_postures_and_names_the_feet_that_are_down() {
        let database = with_derived(&[12.0, 15.5]);
        let page = page(&database);
        let texts = texts(&page);
        let shown = feet_before(&texts, "phase ");
        assert_eq!(shown.len(), 12);
        assert_eq!(feet_before(&texts, "panel ").len(), 12);
        assert!(texts.contains(&"synthesised: at 15.5 at 15.50 m/s"));
        let stride = &database.strides[2];
        for (k, (label, feet)) in shown.into_iter().enumerate() {
            assert_eq!(label, format!("phase {k}/12"));
            let down = stride.support(k as f32 / 12.0);
            let expected: Vec<&str> =
                Limb::ALL.iter().filter(|limb| down[limb.index()]).map(|limb| limb.abbreviation()).collect();
            assert_eq!(feet, expected, "{label}");
        }
    }

    #[test]
    fn the_plates_feet_are_those_of_its_panels() {
        let postures = postures_of_plate(plate());
        let of_panel =
            |label: &str| postures.iter().find(|posture| posture.label.starts_with(label)).unwrap();
        assert_eq!(of_panel("panel 3,").down, [false; 4], "the gathered suspension");
        assert_eq!(of_panel("panel 10,").down, [false, true, false, false], "on the leading fore");
    }

    #[test]
    fn a_derived_gait_says_so_and_shows_no_panel() {
        let mut database = with_derived(&[10.0]);
        let mut leap = database.strides.swap_remove(1);
        leap.gait = Gait::Leap;
        leap.provenance =
            Provenance::Derived { from: vec!["a gallop".into()], how: "stretched over a fence".into() };
        database.strides = vec![leap];
        let page = page(&database);
        assert!(page.contains("No plate of this gait was fitted"));
        assert!(page.contains("derived from a gallop: stretched over a fence"));
        let texts = texts(&page);
        assert_eq!(feet_before(&texts, "phase ").len(), 12);
        assert!(feet_before(&texts, "panel ").is_empty());
    }

    #[test]
    fn a_capture_without_strides_of_its_own_stands_under_another_of_its_gait() {
        let mut database = with_derived(&[12.0, 14.0]);
        let mut other = database.strides[0].clone();
        other.id = "other".into();
        other.speed_m_s = 12.5;
        assert_eq!(played(&database, &other).id, "at 12");
        database.strides.clear();
        assert_eq!(played(&database, &other).id, "other");
    }

    #[test]
    fn a_speed_far_from_the_plates_is_owned_up_to() {
        assert!(page(&with_derived(&[12.0])).contains("25 % slower than the plate"));
        assert!(!page(&with_derived(&[12.0, 15.5])).contains("than the plate;"));
    }
}
