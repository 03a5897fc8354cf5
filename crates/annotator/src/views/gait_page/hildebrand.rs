//! Hildebrand's plot: how long a hind foot is down, and by how much the fore follows the hind of its side.

use egui::{Align2, Color32, FontId, Rect, Ui, pos2};
use muybridge_core::Pair;
use muybridge_fitting::gait_analysis::GaitAnalysis;
use muybridge_fitting::pipeline::PlateFit;

use super::plot::{Axis, Plot};
use crate::colors;
use crate::session::Session;

/// Height, screen points.
const HEIGHT: f32 = 230.0;
/// Duty factors shown, percent: below ten no horse's, above eighty none that moves.
const DUTY_PERCENT: [f64; 2] = [10.0, 80.0];
/// Half the width of Hildebrand's classes of the lateral lag, percent: the gait analysis divides where he does.
const HALF_CLASS: f64 = 6.25;

/// A region: corners in percent of duty factor and lag, and its name.
const REGIONS: [([f64; 2], [f64; 2], &str); 6] = [
    ([10.0, 80.0], [0.0, HALF_CLASS], "pace, rack"),
    ([50.0, 80.0], [HALF_CLASS, 50.0 - HALF_CLASS], "walk"),
    ([10.0, 50.0], [HALF_CLASS, 50.0 - HALF_CLASS], "amble"),
    ([10.0, 80.0], [50.0 - HALF_CLASS, 50.0 + HALF_CLASS], "trot"),
    ([10.0, 80.0], [50.0 + HALF_CLASS, 100.0 - HALF_CLASS], "diagonal sequence"),
    ([10.0, 80.0], [100.0 - HALF_CLASS, 100.0], "pace, rack"),
];

/// The plot with the footfall bar's point and the fit's.
pub(super) fn show(ui: &mut Ui, session: &Session, fit: Option<&PlateFit>) {
    let x = Axis { name: "hind foot down, % of stride", range: DUTY_PERCENT };
    let y = Axis { name: "fore after hind of the same side, % of stride", range: [0.0, 100.0] };
    let (plot, response) = Plot::new(ui, HEIGHT, "Hildebrand's plot", x, y);
    let live = session.derived.gait.as_ref().ok().map(|live| &live.analysis);
    if ui.is_rect_visible(response.rect) {
        draw_regions(ui, &plot);
        if let Some(fit) = fit {
            let (at, sd) = point(&fit.analysis);
            plot.point(at, sd, fit_color(ui), true);
        }
        if let Some(analysis) = live {
            let (at, sd) = point(analysis);
            plot.point(at, sd, ui.visuals().strong_text_color(), false);
        }
    }
    match live {
        Some(analysis) => in_words(ui, analysis),
        None => drop(ui.weak("The point is shown when every leg has a stance and a swing.")),
    }
    if fit.is_some() {
        ui.weak("Dot: footfall bar. Ring: fit.");
    }
}

/// Colour of what comes from the fit.
pub(super) fn fit_color(ui: &Ui) -> Color32 {
    if ui.visuals().dark_mode { colors::FIT } else { colors::FIT.lerp_to_gamma(Color32::BLACK, 0.45) }
}

fn draw_regions(ui: &Ui, plot: &Plot) {
    let visuals = ui.visuals();
    let line = egui::Stroke::new(1.0, visuals.weak_text_color().gamma_multiply(0.6));
    for (duty, lag, name) in REGIONS {
        let area = Rect::from_two_pos(plot.at([duty[0], lag[0]]), plot.at([duty[1], lag[1]]));
        plot.painter.rect_stroke(area, 0.0, line, egui::StrokeKind::Middle);
        let at = pos2(area.right() - 4.0, area.top() + 1.0);
        let font = FontId::proportional(11.0);
        // The narrow classes have room for the name only in their middle.
        let (at, anchor) = if area.height() < 30.0 {
            (pos2(area.right() - 4.0, area.center().y), Align2::RIGHT_CENTER)
        } else {
            (at, Align2::RIGHT_TOP)
        };
        plot.painter.text(at, anchor, name, font, visuals.weak_text_color());
    }
}

/// Place in the plot and its standard deviations, percent.
fn point(analysis: &GaitAnalysis) -> ([f64; 2], [f64; 2]) {
    let hind = analysis.contacts.iter().filter(|contact| contact.limb.pair() == Pair::Hind);
    let duty_sd = 0.5 * hind.map(|contact| contact.duty_factor_sd().powi(2)).sum::<f64>().sqrt();
    // The lag is the mean of two, each the difference of two strikes.
    let lag_sd = 0.5 * analysis.contacts.iter().map(|contact| contact.strike.sd.powi(2)).sum::<f64>().sqrt();
    let at = [100.0 * analysis.hind_duty_factor(), 100.0 * analysis.lateral_lag()];
    (at, [100.0 * duty_sd, 100.0 * lag_sd])
}

fn in_words(ui: &mut Ui, analysis: &GaitAnalysis) {
    let (at, sd) = point(analysis);
    ui.label(format!("Hind down {:.1} ± {:.1} %, lag {:.1} ± {:.1} %", at[0], sd[0], at[1], sd[1]));
    if analysis.lead.is_some() {
        ui.weak("The regions are those of symmetrical gaits; this stride has a lead, so its lag names no gait here.");
    }
}
