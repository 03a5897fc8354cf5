//! Which feet are down, one little diagram after the other through the stride.

use egui::accesskit::Role;
use egui::{Align2, FontId, Pos2, Rect, Sense, Stroke, StrokeKind, Ui, WidgetInfo, pos2, vec2};
use muybridge_capture::{Facing, NearOff};
use muybridge_core::{Limb, Pair};
use muybridge_fitting::gait_analysis::Support;
use muybridge_fitting::pipeline::PlateFit;

use super::legible;
use crate::colors;
use crate::session::Session;

/// Size of a diagram with the share below it, screen points.
const SIZE: [f32; 2] = [36.0, 54.0];
/// Distance of the feet from the middle of the diagram.
const APART: [f32; 2] = [9.0, 7.0];
/// Radius of a foot.
const FOOT: f32 = 4.2;

/// The diagrams in order, from the strike of the left hind: the footfall bar's, or the fit's while a leg is missing there.
pub(super) fn show(ui: &mut Ui, session: &Session, fit: Option<&PlateFit>) {
    let live = session.derived.gait.as_ref().ok().map(|live| &live.analysis);
    let Some(analysis) = live.or(fit.map(|fit| &fit.analysis)) else {
        ui.weak("Shown when every leg has a stance and a swing.");
        return;
    };
    let facing = session.facing();
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing = vec2(1.0, 2.0);
        for support in &analysis.supports {
            diagram(ui, support, facing);
        }
    });
    let head = if facing == Facing::Left { "left" } else { "right" };
    ui.weak(format!("From above, head to the {head}; filled: on the ground. Percent of the stride."));
}

fn diagram(ui: &mut Ui, support: &Support, facing: Facing) {
    let (rect, response) = ui.allocate_exact_size(SIZE.into(), Sense::hover());
    let text = in_words(support, facing);
    response.widget_info(|| WidgetInfo::labeled(Role::Image, true, &text));
    let painter = ui.painter_at(rect);
    let frame = Rect::from_min_size(rect.min, vec2(SIZE[0], SIZE[0])).shrink(1.5);
    let none = support.down == [false; 4];
    let visuals = ui.visuals();
    painter.rect_filled(frame, 4.0, if none { visuals.faint_bg_color } else { visuals.extreme_bg_color });
    let edge = Stroke::new(1.0, visuals.weak_text_color().gamma_multiply(0.3));
    painter.rect_stroke(frame, 4.0, edge, StrokeKind::Inside);
    for limb in Limb::ALL {
        let color = legible(ui, colors::side(facing.near_off(limb.side())));
        let at = place(limb, facing, frame.center());
        if support.down[limb.index()] {
            painter.circle_filled(at, FOOT, color);
        } else {
            painter.circle_stroke(at, FOOT - 0.5, Stroke::new(1.0, color.gamma_multiply(0.6)));
        }
    }
    let at = pos2(frame.center().x, rect.bottom() - 1.0);
    let share = format!("{:.0}", 100.0 * support.share);
    painter.text(at, Align2::CENTER_BOTTOM, share, FontId::proportional(12.0), visuals.text_color());
    response.on_hover_text(text);
}

/// Where a foot is in the diagram: the near side, as in the photograph, is before the off side, and the head is where
/// the animal faces.
fn place(limb: Limb, facing: Facing, middle: Pos2) -> Pos2 {
    let forward = if facing == Facing::Left { -1.0 } else { 1.0 };
    let x = if limb.pair() == Pair::Fore { forward } else { -forward };
    let y = if facing.near_off(limb.side()) == NearOff::Near { 1.0 } else { -1.0 };
    middle + vec2(APART[0] * x, APART[1] * y)
}

fn in_words(support: &Support, facing: Facing) -> String {
    let down = Limb::ALL.into_iter().filter(|limb| support.down[limb.index()]).map(|limb| {
        let side = if facing.near_off(limb.side()) == NearOff::Near { "near" } else { "off" };
        let pair = if limb.pair() == Pair::Fore { "fore" } else { "hind" };
        format!("{side} {pair}")
    });
    let down: Vec<String> = down.collect();
    let what = if down.is_empty() { "no foot is down".into() } else { format!("{} down", down.join(", ")) };
    format!("{:.1} % of the stride: {what}", 100.0 * support.share)
}
