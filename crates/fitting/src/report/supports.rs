//! The support sequence as Huang 2012 prints it (Fig. 3.5): which feet are down, in turn, and for how long.

use muybridge_core::{Limb, Pair, Side, Stride};

use super::plot::{Anchor, Drawn, FULL_WIDTH_PX, Ink, LABEL_PX, Pen, svg};

/// Stretches shorter than this share of the stride are the rounding of two instants that fall together.
const LEAST_SHARE: f64 = 1e-4;
/// Room for a row's name, px.
const NAME_PX: f64 = 118.0;
/// Height of a row, px.
const ROW_PX: f64 = 84.0;
/// Widest column, px.
const WIDEST_PX: f64 = 104.0;
/// Half the distance between fore and hind, and between left and right, px.
const HALF_PX: [f64; 2] = [8.0, 10.0];
/// Size of a foot, px.
const FOOT_PX: f64 = 6.0;

/// A stretch of the stride with the same feet down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stretch {
    /// Feet down, in the order of [`Limb::ALL`].
    pub(super) down: [bool; 4],
    /// Share of the stride it lasts.
    pub(super) share: f64,
}

/// The stride cut at every strike and lift-off, from the left hind's strike; the shares add up to 1.
pub(super) fn sequence(stride: &Stride) -> Vec<Stretch> {
    let origin = f64::from(stride.contacts[Limb::LH.index()].strike_phase);
    let mut cuts: Vec<f64> = stride
        .contacts
        .iter()
        .flat_map(|contact| [contact.strike_phase, contact.lift_off_phase])
        .map(|phase| (f64::from(phase) - origin).rem_euclid(1.0))
        .filter(|phase| *phase < 1.0 - LEAST_SHARE)
        .collect();
    cuts.sort_by(f64::total_cmp);
    cuts.dedup_by(|later, earlier| *later - *earlier < LEAST_SHARE);
    let ends = cuts.iter().skip(1).copied().chain([1.0]);
    let stretch = |(&start, end): (&f64, f64)| Stretch {
        down: stride.support((origin + 0.5 * (start + end)) as f32),
        share: end - start,
    };
    cuts.iter().zip(ends).map(stretch).collect()
}

/// Names of the feet that are down, or that there are none.
pub(super) fn names(down: [bool; 4]) -> String {
    let names: Vec<&str> =
        Limb::ALL.iter().filter(|limb| down[limb.index()]).map(|limb| limb.abbreviation()).collect();
    if names.is_empty() { "in the air".into() } else { names.join(" ") }
}

/// Rows of four-foot diagrams, one row per named stride, in one picture.
pub(super) fn picture(title: &str, rows: &[(String, Vec<Stretch>)]) -> String {
    let longest = rows.iter().map(|(_, stretches)| stretches.len()).max().unwrap_or(1);
    let column_px = ((FULL_WIDTH_PX - NAME_PX) / longest.max(1) as f64).min(WIDEST_PX);
    svg(title, [FULL_WIDTH_PX, rows.len() as f64 * ROW_PX], |pen| {
        rows.iter().enumerate().try_for_each(|(i, (name, stretches))| {
            let middle = i as f64 * ROW_PX + 26.0;
            pen.text([0.0, middle], name, LABEL_PX, Ink::Text, Anchor::Start)?;
            stretches.iter().enumerate().try_for_each(|(k, stretch)| {
                stretch.draw(pen, [NAME_PX + (k as f64 + 0.5) * column_px, middle])
            })
        })
    })
}

impl Stretch {
    /// The diagram about a point, its share and its feet's names under it.
    fn draw(&self, pen: &Pen<'_>, [x, y]: [f64; 2]) -> Drawn {
        for limb in Limb::ALL {
            let across = if limb.side() == Side::Left { -HALF_PX[0] } else { HALF_PX[0] };
            let along = if limb.pair() == Pair::Fore { -HALF_PX[1] } else { HALF_PX[1] };
            foot(pen, limb.pair(), [x + across, y + along], self.down[limb.index()])?;
        }
        let share = format!("{:.1} %", 100.0 * self.share);
        pen.text([x, y + 28.0], &share, LABEL_PX, Ink::Text, Anchor::Middle)?;
        pen.text([x, y + 43.0], &names(self.down), LABEL_PX - 1.5, Ink::Muted, Anchor::Middle)
    }
}

/// Fore feet are triangles and hind feet circles, filled where they are down.
fn foot(pen: &Pen<'_>, pair: Pair, [x, y]: [f64; 2], down: bool) -> Drawn {
    let corner = |angle_deg: f64| {
        let (sin, cos) = angle_deg.to_radians().sin_cos();
        [x + 1.15 * FOOT_PX * cos, y + 1.15 * FOOT_PX * sin]
    };
    let triangle = [-90.0, 30.0, 150.0, -90.0].map(corner);
    match (pair, down) {
        (Pair::Fore, true) => pen.area(&triangle[..3], Ink::Text, 1.0),
        (Pair::Fore, false) => pen.line(&triangle, Ink::Muted, 1.0),
        (Pair::Hind, true) => pen.dot([x, y], FOOT_PX, Ink::Text, 1.0),
        (Pair::Hind, false) => pen.ring([x, y], FOOT_PX - 0.5, Ink::Muted),
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests;
    use super::*;
    use muybridge_core::Contact;

    fn stride(strikes: [f32; 4], duty: f32) -> Stride {
        let mut stride = tests::database().strides.swap_remove(0);
        stride.contacts = strikes.map(|strike_phase| Contact {
            strike_phase,
            lift_off_phase: (strike_phase + duty).rem_euclid(1.0),
        });
        stride
    }

    #[test]
    fn shares_add_up_to_the_stride_and_begin_with_the_left_hind() {
        let walk = stride([0.25, 0.75, 0.0, 0.5], 0.62);
        for stride in tests::database().strides.iter().chain([&walk]) {
            let stretches = sequence(stride);
            let sum: f64 = stretches.iter().map(|stretch| stretch.share).sum();
            assert!((sum - 1.0).abs() < 1e-9, "{}: {sum}", stride.id);
            assert!(stretches[0].down[Limb::LH.index()], "{}", stride.id);
        }
    }

    #[test]
    fn an_even_walk_stands_on_two_and_three_feet_in_turn() {
        let stretches = sequence(&stride([0.25, 0.75, 0.0, 0.5], 0.62));
        let feet: Vec<usize> =
            stretches.iter().map(|stretch| stretch.down.iter().filter(|down| **down).count()).collect();
        assert_eq!(feet, [3, 2, 3, 2, 3, 2, 3, 2]);
        assert_eq!(names(stretches[0].down), "RF LH RH");
    }

    #[test]
    fn feet_that_strike_together_make_no_stretch_of_their_own() {
        let stretches = sequence(&stride([0.5, 0.0, 0.0, 0.5], 0.4));
        let shown: Vec<String> = stretches.iter().map(|stretch| names(stretch.down)).collect();
        assert_eq!(shown, ["RF LH", "in the air", "LF RH", "in the air"]);
    }
}
