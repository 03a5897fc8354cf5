//! Posing: points and skeleton over one photograph.

mod handles;
mod layers;
mod magnifier;
mod points;

use egui::{Grid, RichText, Ui};
use muybridge_capture::{Keypoint, KeypointState, PlacedBy};

use crate::anatomy::{AnatomyPicture, where_it_is};
use crate::app::PageContext;
use crate::canvas::PanelCanvas;
use crate::colors;
use crate::command::Command;
use crate::session::{Session, Tool};
use crate::views::figure_box;

pub use handles::PoseDrag;

/// The photograph with everything on it.
pub fn canvas(ui: &mut Ui, session: &mut Session, page: &mut PageContext<'_>) {
    let Some(canvas) = PanelCanvas::show(ui, session) else { return };
    layers::draw_behind(&canvas, session);
    if session.shown.marks {
        layers::draw_marks(&canvas, session);
        handles::show(ui, &canvas, session);
    }
    if session.shown.magnifier {
        magnifier::show(ui, &canvas, session);
    }
    hint(&canvas, session, page);
}

/// What a click would do, in the corner.
fn hint(canvas: &PanelCanvas, session: &Session, page: &PageContext<'_>) {
    let text = match (session.tool, session.selected) {
        (Tool::Guided, None) => "All points of this panel have a place".to_string(),
        (Tool::Guided | Tool::Free, Some(keypoint)) => {
            let state = match session.next_state {
                KeypointState::Occluded => ", occluded",
                KeypointState::Visible | KeypointState::Absent => "",
            };
            format!("Click: {}{state}. {}", colors::name(keypoint), where_it_is(keypoint))
        }
        (Tool::Free, None) => "Select a point in the list, then click where it is".into(),
        (Tool::Skeleton, _) => {
            "Drag a joint; Shift lets the whole body follow; the square moves the whole skeleton".into()
        }
    };
    let keys = &page.settings.keys;
    let state_keys = format!(
        "{} visible  {} occluded  {} absent  {} next  {} other side",
        keys.shown(Command::Visible),
        keys.shown(Command::Occluded),
        keys.shown(Command::Absent),
        keys.shown(Command::NextPoint),
        keys.shown(Command::OtherSide),
    );
    let rect = canvas.painter.clip_rect();
    let font = egui::FontId::proportional(13.0);
    let galley = canvas.painter.layout(
        format!("{text}\n{state_keys}"),
        font,
        egui::Color32::WHITE,
        rect.width() - 40.0,
    );
    let at = rect.left_top() + egui::vec2(12.0, 10.0);
    let back = egui::Rect::from_min_size(at, galley.size()).expand(6.0);
    canvas.painter.rect_filled(back, 4.0, egui::Color32::from_black_alpha(170));
    canvas.painter.galley(at, galley, egui::Color32::WHITE);
}

/// Tools, the next point, and the list of all.
pub fn inspector(ui: &mut Ui, session: &mut Session, page: &mut PageContext<'_>) {
    repeatability(ui, session);
    tools(ui, session, page);
    ui.separator();
    let selected = session.selected;
    let placed = session.panel_annotation().map(|panel| panel.keypoints.clone()).unwrap_or_default();
    let picture = AnatomyPicture::new(session.facing());
    if let Some(clicked) = picture.show(ui, |keypoint| placed.get(keypoint).is_some(), selected) {
        session.selected = Some(clicked);
    }
    if let Some(keypoint) = selected {
        ui.label(RichText::new(colors::name(keypoint)).strong().size(16.0));
        ui.label(where_it_is(keypoint));
    }
    ui.separator();
    proposals(ui, page);
    panel_use(ui, session);
    ui.separator();
    point_list(ui, session);
    ui.separator();
    figure_box::show(ui, session);
}

/// How well points were placed twice, after a second pass, until it is put away.
fn repeatability(ui: &mut Ui, session: &mut Session) {
    let Some(repeatability) = session.repeatability.clone() else { return };
    ui.group(|ui| {
        ui.label(RichText::new("Placed twice").strong());
        ui.label(repeatability.to_string());
        Grid::new("placed twice").num_columns(3).striped(true).show(ui, |ui| {
            for row in repeatability.by_keypoint() {
                ui.label(colors::name(row.keypoint));
                ui.label(format!("{:.1} px", row.median_px));
                ui.label(format!("{:.1} cm", row.median_cm));
                ui.end_row();
            }
        });
        if ui.button("Use it as this plate's scatter").clicked() {
            let [visible, occluded] = [true, false].map(|visible| repeatability.sd_px(visible));
            session.edit("Scatter of placed points", |draft| {
                let annotation = &mut draft.annotation;
                annotation.visible_sd_px = visible.unwrap_or(annotation.visible_sd_px);
                annotation.occluded_sd_px = occluded.unwrap_or(annotation.occluded_sd_px);
            });
            session.repeatability = None;
        }
        if ui.button("Put away").clicked() {
            session.repeatability = None;
        }
    });
}

fn tools(ui: &mut Ui, session: &Session, page: &mut PageContext<'_>) {
    ui.horizontal_wrapped(|ui| {
        for (tool, command, title) in [
            (Tool::Guided, Command::ToolGuided, "Guided"),
            (Tool::Free, Command::ToolFree, "Free"),
            (Tool::Skeleton, Command::ToolSkeleton, "Skeleton"),
        ] {
            let text = format!("{title}  {}", page.settings.keys.shown(command));
            let button = egui::Button::selectable(session.tool == tool, text);
            if ui.add(button).on_hover_text(command.title()).clicked() {
                page.commands.push(command);
            }
        }
    });
}

fn proposals(ui: &mut Ui, page: &mut PageContext<'_>) {
    ui.label(RichText::new("Propose this panel's points").strong());
    ui.horizontal_wrapped(|ui| {
        for (command, title) in [
            (Command::ProposeTracked, "Track"),
            (Command::ProposeInterpolated, "Interpolate"),
            (Command::ProposeFitted, "From fit"),
            (Command::CopyPrevious, "Copy previous"),
        ] {
            let text = format!("{title}  {}", page.settings.keys.shown(command));
            if ui.button(text).on_hover_text(command.title()).clicked() {
                page.commands.push(command);
            }
        }
    });
}

fn panel_use(ui: &mut Ui, session: &mut Session) {
    use muybridge_capture::PanelUse as U;
    let panel = session.panel;
    let now = session.panel_annotation().map_or(U::Stride, |panel| panel.usage);
    ui.horizontal(|ui| {
        ui.label("This panel is");
        for (usage, title) in [(U::Stride, "of the stride"), (U::Standing, "standing"), (U::Unused, "unused")]
        {
            if ui.selectable_label(now == usage, title).clicked() {
                session.edit("Use of a panel", |draft| draft.panel_mut(panel).usage = usage);
            }
        }
    });
}

/// All points: state, who placed it, how far from the fit.
fn point_list(ui: &mut Ui, session: &mut Session) {
    let panel = session.panel;
    let keypoints = session.panel_annotation().map(|panel| panel.keypoints.clone()).unwrap_or_default();
    let fitted = session.fit.latest().cloned();
    let mut chosen = None;
    Grid::new("points").num_columns(4).striped(true).spacing([8.0, 2.0]).show(ui, |ui| {
        for keypoint in Keypoint::all() {
            let placed = keypoints.get(keypoint);
            let name = RichText::new(colors::name(keypoint))
                .color(colors::on_background(keypoint, ui.visuals().dark_mode));
            if ui.selectable_label(session.selected == Some(keypoint), name).clicked() {
                chosen = Some(keypoint);
            }
            ui.label(placed.map_or("–", |placed| state_symbol(placed.state)));
            let by = placed.filter(|p| p.by != PlacedBy::Hand).map_or("", |placed| by_name(placed.by));
            let quality = placed.and_then(|placed| session.proposals.quality(panel, keypoint, placed));
            match quality {
                Some(quality) => ui.label(format!("{by} {:.0} %", 100.0 * quality)),
                None => ui.label(by),
            };
            let residual = fitted.as_ref().filter(|_| session.second_pass.is_none()).and_then(|fitted| {
                fitted.plate.residuals.iter().find(|r| r.panel == panel && r.keypoint == keypoint)
            });
            let text = residual.map(|r| format!("{:.1} px  {:.1} cm", r.px(), 100.0 * r.metres()));
            ui.label(text.unwrap_or_default());
            ui.end_row();
        }
    });
    if chosen.is_some() {
        session.selected = chosen;
    }
}

fn state_symbol(state: KeypointState) -> &'static str {
    match state {
        KeypointState::Visible => "seen",
        KeypointState::Occluded => "guessed",
        KeypointState::Absent => "absent",
    }
}

fn by_name(by: PlacedBy) -> &'static str {
    match by {
        PlacedBy::Hand => "hand",
        PlacedBy::Interpolated => "interpolated",
        PlacedBy::Tracked => "tracked",
        PlacedBy::Fitted => "fitted",
    }
}
