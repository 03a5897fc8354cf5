//! The paper's claim about its two time warpings (Huang 2012, section 3.3) as a picture, with the run time's own change beside them.
//!
//! What is drawn is how far the four legs are from one common moment of the target gait, frame by frame. The two warpings of the
//! paper are worked out by [`crate::time_warping`]; the third curve is measured on a running [`Horse`].

use std::sync::Arc;

use muybridge_core::{
    Command, Contact, Database, FlatGround, Gait, Horse, Limb, MPS_PER_MPH, Readout, Repertoire, Skeleton,
};

use super::plot::{Anchor, Axis, Drawn, Frame, Ink, LABEL_PX, Mark, Pen, svg};
use crate::time_warping::{GaitChange, WarpedMotion, Warping, cyclic_spread};

/// Frames per second: the paper does not say; this is a game's.
const FRAME_RATE_HZ: f64 = 60.0;
/// Phases of the original stride at which the change is begun.
const STARTS: usize = 24;
/// Share of these that a curve's band leaves out on either side.
const BAND_EDGE: f64 = 0.1;
/// Longest a horse is waited for to reach a gait and a speed, frames.
const PATIENCE: usize = 60 * 60;
/// Frames a horse goes on steadily before the change is asked for.
const SETTLING: usize = 60 * 5;
/// The changes shown, with speeds in miles per hour.
const CHANGES: [[(Gait, f64); 2]; 6] = [
    [(Gait::Walk, 4.0), (Gait::Amble, 7.0)],
    [(Gait::Walk, 4.0), (Gait::Trot, 11.0)],
    [(Gait::Trot, 13.0), (Gait::Rack, 13.0)],
    [(Gait::Trot, 13.0), (Gait::Canter, 15.0)],
    [(Gait::Canter, 22.0), (Gait::Gallop, 27.0)],
    [(Gait::Gallop, 27.0), (Gait::Amble, 9.0)],
];

const COLUMNS: usize = 2;
/// Narrower than the report's plots, so that labels are 8 points high across a printed page.
const WIDTH_PX: f64 = 720.0;
const MARGIN_PX: f64 = 16.0;
const CELL_PX: [f64; 2] = [350.0, 206.0];
const TOP_PX: f64 = 102.0;
const BOTTOM_PX: f64 = 68.0;
/// A panel's frame within its cell, px.
const FRAME_X_PX: [f64; 2] = [22.0, 332.0];
const FRAME_Y_PX: [f64; 2] = [166.0, 26.0];
/// Greatest spread there is, percent of a stride.
const WIDEST_PERCENT: f64 = 75.0;

/// Which of the three a curve is.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Way {
    Synchronous,
    Asynchronous,
    Horse,
}

impl Way {
    const ALL: [Self; 3] = [Self::Synchronous, Self::Asynchronous, Self::Horse];

    fn name(self) -> &'static str {
        match self {
            Self::Synchronous => "synchronous (Eq. 3.8)",
            Self::Asynchronous => "asynchronous (Eq. 3.9 to 3.20)",
            Self::Horse => "the run time\u{2019}s horse, measured",
        }
    }

    fn ink(self) -> Ink {
        match self {
            Self::Synchronous => Ink::Near,
            Self::Asynchronous => Ink::Off,
            Self::Horse => Ink::Support,
        }
    }

    /// A line that differs from the others without its colour.
    fn line(self, pen: &Pen<'_>, points: &[[f64; 2]]) -> Drawn {
        match self {
            Self::Synchronous => pen.dashed(points, self.ink(), 1.75),
            Self::Asynchronous => pen.line(points, self.ink(), 1.5),
            Self::Horse => pen.line(points, self.ink(), 3.0),
        }
    }
}

/// Spread of the four legs against frames, over all starts, percent of the target's stride.
struct Curve {
    way: Way,
    /// For each frame the lower edge, the median and the upper edge.
    percent: Vec<[f64; 3]>,
}

impl Curve {
    /// From one series of spreads for each start; as long as the shortest.
    fn new(way: Way, starts: &[Vec<f64>]) -> Self {
        let frames = starts.iter().map(Vec::len).min().unwrap_or(0);
        let at = |i: usize| {
            let mut sorted: Vec<f64> = starts.iter().map(|spreads| 100.0 * spreads[i]).collect();
            sorted.sort_by(f64::total_cmp);
            [BAND_EDGE, 0.5, 1.0 - BAND_EDGE]
                .map(|share| sorted[(share * (sorted.len() - 1) as f64).round() as usize])
        };
        Self { way, percent: (0..frames).map(at).collect() }
    }

    fn draw(&self, pen: &Pen<'_>, frame: &Frame) -> Drawn {
        let edge = |k: usize| -> Vec<[f64; 2]> {
            self.percent.iter().enumerate().map(|(i, row)| frame.at([i as f64, row[k]])).collect()
        };
        let (mut outline, middle) = (edge(0), edge(1));
        outline.extend(edge(2).into_iter().rev());
        pen.area(&outline, self.way.ink(), 0.13)?;
        self.way.line(pen, &middle)
    }
}

/// One change, with what came of it.
struct Panel {
    name: String,
    curves: Vec<Curve>,
}

/// The picture as SVG: for some pairs of gaits of a database, how the legs come together in the synchronous warping (they do not), in
/// the asynchronous one, and in a running horse. A pair whose gaits the database lacks is left out, and so is the horse when no
/// repertoire can be made.
pub fn warping_plot(database: &Database) -> String {
    let repertoire = Repertoire::new(database, &Skeleton::reference()).ok().map(Arc::new);
    let panels: Vec<Panel> =
        CHANGES.iter().filter_map(|change| panel(database, repertoire.as_ref(), *change)).collect();
    let rows = panels.len().div_ceil(COLUMNS);
    let size = [WIDTH_PX, TOP_PX + rows as f64 * CELL_PX[1] + BOTTOM_PX];
    svg("Spread of the four legs during changes of gait", size, |pen| {
        pen.rectangle([0.0, 0.0], size, Ink::Paper, 1.0)?;
        legend(pen)?;
        for (i, panel) in panels.iter().enumerate() {
            let corner =
                [MARGIN_PX + (i % COLUMNS) as f64 * CELL_PX[0], TOP_PX + (i / COLUMNS) as f64 * CELL_PX[1]];
            panel.draw(pen, corner)?;
        }
        notes(pen, size[1])
    })
}

fn panel(
    database: &Database,
    repertoire: Option<&Arc<Repertoire>>,
    change: [(Gait, f64); 2],
) -> Option<Panel> {
    let [from, to] =
        change.map(|(gait, mph)| WarpedMotion::of(database, gait, (mph * MPS_PER_MPH) as f32, FRAME_RATE_HZ));
    let (from, to) = (from?, to?);
    let of_paper = |warp: &dyn Fn(&GaitChange<'_>) -> Warping| -> Vec<Vec<f64>> {
        let begun = |k: usize| {
            let start_frame = k as f64 / STARTS as f64 * from.frames_per_stride();
            let change = GaitChange { from: &from, to: &to, start_frame, reference: Limb::LH };
            warp(&change).frames.iter().map(crate::time_warping::WarpedFrame::spread).collect()
        };
        (0..STARTS).map(begun).collect()
    };
    let synchronous = of_paper(&|change| change.synchronous());
    let frames = synchronous.first().map_or(0, Vec::len);
    let mut curves = vec![
        Curve::new(Way::Synchronous, &synchronous),
        Curve::new(Way::Asynchronous, &of_paper(&|change| change.asynchronous())),
    ];
    if let Some(measured) = repertoire.and_then(|of| measured(database, of, change, 3 * frames / 2)) {
        curves.push(Curve::new(Way::Horse, &measured));
    }
    let [from, to] = change.map(|(gait, mph)| format!("{gait} at {mph:.0} mph"));
    Some(Panel { name: format!("{from} to {to}"), curves })
}

/// Spreads of a horse's legs from each start, beginning with the frame before the change; none when it does not change.
fn measured(
    database: &Database,
    repertoire: &Arc<Repertoire>,
    change: [(Gait, f64); 2],
    frames: usize,
) -> Option<Vec<Vec<f64>>> {
    let [from, to] = change.map(|(gait, mph)| Command {
        speed_m_s: (mph * MPS_PER_MPH) as f32,
        gait: Some(gait),
        // The lead that the database has, so that its strikes are the horse's.
        lead: database.strides_of(gait).find_map(|stride| stride.lead).map(|lead| lead.fore),
        ..Command::default()
    });
    // A horse of another size than the plate's goes at another duty factor, so that its own is asked for.
    let duties = settled_horse(repertoire, &to)?.readout().duty_factors;
    let strikes = database.at_speed(to.gait?, to.speed_m_s)?.contacts().map(|contact| contact.strike_phase);
    let contact = |j: usize| Contact { strike_phase: strikes[j], lift_off_phase: strikes[j] + duties[j] };
    let target = WarpedMotion::new(std::array::from_fn(contact), FRAME_RATE_HZ as u32)?;
    let spread = |horse: &Horse| cyclic_spread(target_phases(&horse.readout(), &target));
    let settled = settled_horse(repertoire, &from)?;
    let one_start = |k: usize| -> Option<Vec<f64>> {
        let mut horse = settled.clone();
        let wanted = horse.readout().strides + k as f64 / STARTS as f64;
        let mut spreads = Vec::new();
        for _ in 0..PATIENCE {
            let before = spread(&horse);
            let command = if horse.readout().strides < wanted { &from } else { &to };
            horse.step(command, FRAME_RATE_HZ.recip() as f32, &FlatGround);
            if spreads.is_empty() && horse.readout().change.is_some() {
                spreads.push(before);
            }
            if !spreads.is_empty() {
                spreads.push(spread(&horse));
            }
            if spreads.len() >= frames {
                return Some(spreads);
            }
        }
        None
    };
    (0..STARTS).map(one_start).collect()
}

/// The moment of the target's stride at which each leg of a horse is as far as it is now, phases.
fn target_phases(readout: &Readout, target: &WarpedMotion) -> [f64; 4] {
    Limb::ALL.map(|limb| {
        let [cycle, duty] =
            [readout.leg_cycles, readout.duty_factors].map(|legs| f64::from(legs[limb.index()]));
        let generic_time =
            if cycle < duty { 0.5 * cycle / duty } else { 0.5 + 0.5 * (cycle - duty) / (1.0 - duty) };
        target.actual_frame(limb, generic_time) / target.frames_per_stride()
    })
}

/// A horse that goes in a gait at a speed; none when it never does.
fn settled_horse(repertoire: &Arc<Repertoire>, command: &Command) -> Option<Horse> {
    let mut horse = Horse::of(Arc::clone(repertoire), 0);
    let mut steady = 0;
    for _ in 0..PATIENCE {
        horse.step(command, FRAME_RATE_HZ.recip() as f32, &FlatGround);
        let readout = horse.readout();
        let is_steady = Some(readout.gait) == command.gait && readout.change.is_none();
        steady = if is_steady { steady + 1 } else { 0 };
        if steady == SETTLING {
            return Some(horse);
        }
    }
    None
}

impl Panel {
    fn draw(&self, pen: &Pen<'_>, [left, top]: [f64; 2]) -> Drawn {
        let last = self.curves.iter().map(|curve| curve.percent.len()).max().unwrap_or(2);
        let frame = Frame {
            x: Axis { values: [0.0, last as f64], px: FRAME_X_PX.map(|x| left + x) },
            y: Axis { values: [0.0, WIDEST_PERCENT], px: FRAME_Y_PX.map(|y| top + y) },
        };
        pen.text([left, top + 8.0], &self.name, LABEL_PX + 2.0, Ink::Text, Anchor::Start)?;
        frame.draw(pen, [7, 4], ["", ""])?;
        self.curves.iter().try_for_each(|curve| curve.draw(pen, &frame))?;
        self.curves.iter().filter(|curve| curve.way != Way::Horse).try_for_each(|curve| {
            let Some([_, median, _]) = curve.percent.last() else { return Ok(()) };
            let [x, y] = frame.at([(curve.percent.len() - 1) as f64, *median]);
            pen.mark([x, y], Mark::Dot, 3.5, curve.way.ink())?;
            if curve.way == Way::Synchronous {
                let text = format!("{median:.0} % apart");
                pen.text([x + 8.0, y], &text, LABEL_PX, Ink::Text, Anchor::Start)?;
            }
            Ok(())
        })
    }
}

/// What the axes and the curves are.
fn legend(pen: &Pen<'_>) -> Drawn {
    let title = "How far the four legs are from one moment of the target gait";
    pen.text([MARGIN_PX, 24.0], title, LABEL_PX + 5.0, Ink::Text, Anchor::Start)?;
    let axes = format!(
        "Up: shortest stretch of the target\u{2019}s stride that holds all four, in percent. Along: frames \
         of the change, {FRAME_RATE_HZ:.0} a second."
    );
    pen.text([MARGIN_PX, 48.0], &axes, LABEL_PX, Ink::Text, Anchor::Start)?;
    let mut x = MARGIN_PX;
    for way in Way::ALL {
        way.line(pen, &[[x, 72.0], [x + 36.0, 72.0]])?;
        pen.text([x + 44.0, 72.0], way.name(), LABEL_PX, Ink::Text, Anchor::Start)?;
        x += 236.0;
    }
    Ok(())
}

fn notes(pen: &Pen<'_>, bottom: f64) -> Drawn {
    let lines = [
        format!(
            "Lines are medians over {STARTS} phases of the stride at which the change may begin; bands hold the middle {:.0} %.",
            100.0 * (1.0 - 2.0 * BAND_EDGE)
        ),
        "Dots mark the last frame of the paper\u{2019}s changes, from which on the target plays alone:"
            .to_string(),
        "legs that are apart then have no posture of it in common.".to_string(),
    ];
    lines.iter().enumerate().try_for_each(|(i, line)| {
        pen.label([MARGIN_PX, bottom - 52.0 + 18.0 * i as f64], line, Anchor::Start)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_picture_shows_every_change_and_says_how_far_apart_the_legs_end() {
        let plot = warping_plot(&Database::embedded());
        assert!(plot.starts_with("<svg") && plot.trim_end().ends_with("</svg>"));
        for [(from, _), (to, _)] in CHANGES {
            assert!(
                plot.contains(&format!("{from} at ")) && plot.contains(&format!("to {to} at ")),
                "{from} to {to}"
            );
        }
        assert_eq!(plot.matches("% apart").count(), CHANGES.len());
        assert!(!plot.contains("NaN") && !plot.contains("not drawn"));
    }

    #[test]
    fn the_papers_legs_and_the_horses_come_together() {
        let database = Database::embedded();
        let repertoire = Arc::new(Repertoire::new(&database, &Skeleton::reference()).unwrap());
        for change in CHANGES {
            let panel = panel(&database, Some(&repertoire), change).unwrap();
            assert_eq!(panel.curves.len(), Way::ALL.len(), "{}", panel.name);
            for curve in &panel.curves {
                let [_, median, upper] = *curve.percent.last().unwrap();
                match curve.way {
                    Way::Synchronous => assert!(median > 1.0, "{}: {median}", panel.name),
                    Way::Asynchronous => assert!(upper < 1e-7, "{}: {upper}", panel.name),
                    Way::Horse => assert!(upper < 0.1, "{}: {upper}", panel.name),
                }
            }
        }
    }

    #[test]
    fn a_database_without_gaits_gives_an_empty_picture() {
        let mut database = Database::embedded();
        database.strides.clear();
        let plot = warping_plot(&database);
        assert!(plot.starts_with("<svg") && !plot.contains("apart</text>"));
    }
}
