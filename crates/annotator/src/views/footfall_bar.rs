//! Four lanes under the photographs: when each hoof is down. Edges are dragged between panels.

use egui::{Align2, Color32, CursorIcon, FontId, Rect, Response, Sense, Stroke, Ui, pos2, vec2};
use muybridge_capture::{Annotation, Event, NearOff, StanceLabel};
use muybridge_core::Pair;
use muybridge_fitting::footfalls::{
    EdgeSource, Footfalls, LANES, ShownSpan, StrideClock, leg_name, with_edge, with_label, with_span,
    without_span,
};

use crate::app::PageContext;
use crate::colors;
use crate::session::Session;
use crate::views::strip::{Columns, NAMES};

/// Height of a lane, screen points.
const LANE: f32 = 15.0;
/// Half the width in which an edge is grasped.
const GRASP: f32 = 5.0;

/// A drag on the bar.
#[derive(Clone, Copy, Debug)]
pub enum BarDrag {
    /// An edge.
    Edge {
        /// Whose.
        leg: (NearOff, Pair),
        /// Which.
        event: Event,
        /// Where it was, panels.
        from_panel: f64,
    },
    /// A new span.
    Span {
        /// Whose.
        leg: (NearOff, Pair),
        /// Where the button was pressed, panels.
        from_panel: f64,
    },
}

/// The bar.
pub fn show(ui: &mut Ui, session: &mut Session, columns: &Columns, _page: &mut PageContext<'_>) {
    let Some(footfalls) = session.derived.footfalls.clone() else { return };
    let Some(first) = session.panel_numbers().first().copied() else { return };
    for leg in LANES {
        let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), LANE), Sense::hover());
        let lane = Rect::from_min_max(
            pos2(columns.left, rect.top()),
            pos2(columns.left + columns.width * session.panel_numbers().len() as f32, rect.bottom()),
        );
        let name_at = pos2(rect.left() + NAMES - 8.0, rect.center().y);
        let color = if ui.visuals().dark_mode { colors::side(leg.0) } else { ui.visuals().text_color() };
        ui.painter().text(
            name_at,
            Align2::RIGHT_CENTER,
            leg_name(leg.0, leg.1),
            FontId::proportional(12.0),
            color,
        );
        show_lane(ui, session, &footfalls, leg, lane, columns, first);
    }
    ui.add_space(4.0);
}

fn show_lane(
    ui: &Ui,
    session: &mut Session,
    footfalls: &Footfalls,
    leg: (NearOff, Pair),
    lane: Rect,
    columns: &Columns,
    first: u32,
) {
    let painter = ui.painter_at(lane.expand(1.0));
    painter.rect_filled(lane.shrink2(vec2(0.0, 1.0)), 2.0, ui.visuals().extreme_bg_color);
    let name = format!("Footfalls {}", leg_name(leg.0, leg.1));
    let response = ui.interact(lane, ui.scope_id().with(&name), Sense::click_and_drag());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::accesskit::Role::Slider, true, &name));
    draw_columns(&painter, session, leg, lane, columns, first);
    on_lane(ui, session, &footfalls.clock, leg, &response, columns, first);
    let [low, high] = [lane.left(), lane.right()].map(|x| columns.panel(first, x));
    for span in footfalls.shown(leg.0, leg.1, [low, high]) {
        show_span(ui, session, footfalls, leg, &span, lane, columns, first);
    }
}

/// Lines between panels, and a dot where the label is not known.
fn draw_columns(
    painter: &egui::Painter,
    session: &Session,
    leg: (NearOff, Pair),
    lane: Rect,
    columns: &Columns,
    first: u32,
) {
    for number in session.panel_numbers() {
        let x = columns.x(first, f64::from(number));
        let label =
            session.draft().panel(number).map_or(StanceLabel::Unknown, |p| p.contacts.of(leg.0, leg.1));
        if label == StanceLabel::Unknown {
            painter.text(
                pos2(x, lane.center().y),
                Align2::CENTER_CENTER,
                "?",
                FontId::proportional(11.0),
                Color32::GRAY,
            );
        }
        let edge = x + 0.5 * columns.width;
        painter.vline(edge, lane.y_range(), Stroke::new(0.5, Color32::from_gray(110)));
    }
}

/// A click changes a panel's label; a drag over an empty stretch draws a stance.
fn on_lane(
    ui: &Ui,
    session: &mut Session,
    clock: &StrideClock,
    leg: (NearOff, Pair),
    response: &Response,
    columns: &Columns,
    first: u32,
) {
    let at_panel = |at: egui::Pos2| columns.panel(first, at.x);
    if response.clicked()
        && let Some(at) = response.interact_pointer_pos()
    {
        let panel = at_panel(at).round().max(1.0) as u32;
        let now = session.draft().panel(panel).map_or(StanceLabel::Unknown, |p| p.contacts.of(leg.0, leg.1));
        let next = match now {
            StanceLabel::Unknown => StanceLabel::Stance,
            StanceLabel::Stance => StanceLabel::Swing,
            StanceLabel::Swing => StanceLabel::Unknown,
        };
        edit(session, "Contact label", |annotation| with_label(annotation, clock, leg, panel, next), panel);
    }
    // A drag begins a little after the button went down, when the pointer has moved on.
    if response.drag_started()
        && let Some(at) = ui.input(|input| input.pointer.press_origin())
    {
        session.bar_drag = Some(BarDrag::Span { leg, from_panel: at_panel(at) });
    }
    follow(ui, session, clock, response, columns, first);
}

/// One stance: its body (right click takes it away), and its edges.
#[expect(clippy::too_many_arguments, reason = "where a span is needs the lane, the columns and the ring")]
fn show_span(
    ui: &Ui,
    session: &mut Session,
    footfalls: &Footfalls,
    leg: (NearOff, Pair),
    span: &ShownSpan,
    lane: Rect,
    columns: &Columns,
    first: u32,
) {
    let [from, to] = [span.from_panel, span.to_panel].map(|at| columns.x(first, at));
    let bar = Rect::from_min_max(pos2(from, lane.top() + 2.0), pos2(to, lane.bottom() - 2.0));
    let painter = ui.painter_at(lane.expand(1.0));
    painter.rect_filled(bar, 2.0, colors::side(leg.0));
    let id = ui.scope_id().with(("span", leg_name(leg.0, leg.1), (span.from_panel * 8.0) as i64));
    let body = ui.interact(bar.intersect(lane), id, Sense::click());
    if body.secondary_clicked() {
        let at = 0.5 * (span.from_panel + span.to_panel);
        edit(session, "Take a stance away", |a| without_span(a, &footfalls.clock, leg, at), first);
    }
    if body.clicked()
        && let Some(at) = body.interact_pointer_pos()
    {
        let panel = columns.panel(first, at.x).round().max(1.0) as u32;
        let swing = StanceLabel::Swing;
        edit(session, "Contact label", |a| with_label(a, &footfalls.clock, leg, panel, swing), panel);
    }
    let edges = &footfalls.lane(leg.0, leg.1).spans[span.span];
    for (event, x, at_panel, source) in [
        (Event::Strike, from, span.from_panel, edges.strike.source),
        (Event::LiftOff, to, span.to_panel, edges.lift_off.source),
    ] {
        let grip = Rect::from_center_size(pos2(x, lane.center().y), vec2(2.0 * GRASP, LANE));
        if !lane.intersects(grip) {
            continue;
        }
        let word = if event == Event::Strike { "strike" } else { "lift-off" };
        let name = format!("{} {word} {at_panel:.0}", leg_name(leg.0, leg.1));
        let response = ui.interact(grip.intersect(lane.expand(1.0)), id.with(word), Sense::drag());
        response.widget_info(|| egui::WidgetInfo::labeled(egui::accesskit::Role::Slider, true, &name));
        let by_hand = source == EdgeSource::Hand;
        let width = if by_hand { 3.0 } else { 1.5 };
        painter.vline(
            x,
            lane.y_range(),
            Stroke::new(width, if by_hand { Color32::WHITE } else { Color32::GRAY }),
        );
        if response.drag_started() {
            session.bar_drag = Some(BarDrag::Edge { leg, event, from_panel: at_panel });
        }
        follow(ui, session, &footfalls.clock, &response, columns, first);
        response.on_hover_cursor(CursorIcon::ResizeHorizontal).on_hover_text(format!(
            "{word} at panel {at_panel:.2}, {}",
            if by_hand { "by hand" } else { "between labels" }
        ));
    }
}

fn follow(
    ui: &Ui,
    session: &mut Session,
    clock: &StrideClock,
    response: &Response,
    columns: &Columns,
    first: u32,
) {
    if response.dragged()
        && let Some(pointer) = ui.input(|input| input.pointer.latest_pos())
        && let Some(drag) = session.bar_drag
    {
        let to_panel = columns.panel(first, pointer.x);
        let stride = session.stride_numbers();
        session.preview("Footfall", |draft| {
            for panel in &stride {
                draft.panel_mut(*panel);
            }
            draft.annotation = match drag {
                BarDrag::Edge { leg, event, from_panel } => {
                    with_edge(&draft.annotation, clock, leg, event, [from_panel, to_panel])
                }
                BarDrag::Span { leg, from_panel } => {
                    with_span(&draft.annotation, clock, leg, [from_panel, to_panel])
                }
            };
        });
    }
    if response.drag_stopped() {
        session.bar_drag = None;
        session.commit();
    }
}

fn edit(session: &mut Session, label: &str, change: impl FnOnce(&Annotation) -> Annotation, panel: u32) {
    session.edit(label, |draft| {
        draft.panel_mut(panel);
        draft.annotation = change(&draft.annotation);
    });
}
