//! The plate as a whole: its panels, their corners and order, and what is known of the plate in words.

use egui::{Align2, Color32, CursorIcon, FontId, Grid, Rect, RichText, Sense, Stroke, TextEdit, Ui, Vec2};
use muybridge_capture::Panel;
use muybridge_core::Gait;

use crate::app::PageContext;
use crate::canvas::moved;
use crate::command::Command;
use crate::picture::{ImageState, Look, ViewTransform};
use crate::session::Session;

/// Half the side of a corner's handle, screen points.
const GRASP: f32 = 8.0;

/// The plate with its panels; corners can be dragged.
pub fn canvas(ui: &mut Ui, session: &mut Session, _page: &mut PageContext<'_>) {
    let rect = ui.available_rect_before_wrap();
    let response = ui.allocate_rect(rect, Sense::click_and_drag());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::accesskit::Role::Canvas, true, "Plate"));
    let painter = ui.painter_at(rect);
    painter.rect_filled(rect, 0.0, ui.visuals().extreme_bg_color);
    let image = session.panel_place().map_or(0, |panel| panel.image);
    let size_px = match session.images.states().get(image) {
        Some(ImageState::Ready(pyramid)) => pyramid.size_px(),
        Some(ImageState::Failed(trouble)) => {
            painter.text(
                rect.center(),
                Align2::CENTER_CENTER,
                trouble,
                FontId::proportional(14.0),
                Color32::GRAY,
            );
            session.draft().manifest.images.get(image).map_or([1, 1], |i| [i.width_px, i.height_px])
        }
        _ => session.draft().manifest.images.get(image).map_or([1, 1], |i| [i.width_px, i.height_px]),
    };
    let fitted = ViewTransform::fit_whole(size_px, rect.shrink(8.0));
    let before = session.plate_view.unwrap_or(fitted);
    let after = moved(ui, &response, before);
    if after != before {
        session.plate_view = Some(after);
    }
    // The whole plate is fitted anew when the window changes, until somebody looks closer.
    let view = session.plate_view.map_or(fitted, |view| view.clamped(size_px, rect));
    session.plate_view = session.plate_view.map(|_| view);
    if let Some((textures, source)) = session.picture(image) {
        textures.draw(&painter, source, &view, Look::default());
    }
    let panels: Vec<Panel> =
        session.draft().manifest.panels.iter().filter(|panel| panel.image == image).cloned().collect();
    for panel in &panels {
        draw_panel(ui, &painter, session, panel, &view);
    }
    if response.clicked()
        && let Some(at) = response.interact_pointer_pos().map(|at| view.plate_from_screen(at))
        && let Some(panel) = panels.iter().find(|panel| panel.contains(at, 0.0))
    {
        session.go_to(panel.panel);
    }
    if let Some(panel) = panels.iter().find(|panel| panel.panel == session.panel) {
        corners(ui, &painter, session, panel, &view);
    }
}

fn draw_panel(ui: &Ui, painter: &egui::Painter, session: &Session, panel: &Panel, view: &ViewTransform) {
    let selected = session.panel == panel.panel;
    let color = if selected { ui.visuals().selection.stroke.color } else { Color32::from_rgb(90, 200, 255) };
    let corners = panel.quad_px.map(|corner| view.screen_from_plate(corner));
    let width = if selected { 2.5 } else { 1.2 };
    painter.add(egui::Shape::closed_line(corners.into(), Stroke::new(width, color)));
    let font = FontId::proportional(if selected { 18.0 } else { 15.0 });
    let galley = painter.layout_no_wrap(panel.panel.to_string(), font, Color32::WHITE);
    let at = corners[0] + Vec2::new(6.0, 4.0);
    painter.rect_filled(
        Rect::from_min_size(at, galley.size()).expand(3.0),
        3.0,
        Color32::from_black_alpha(170),
    );
    painter.galley(at, galley, Color32::WHITE);
}

/// Handles on the corners of the selected panel, and one in its middle to move it.
fn corners(ui: &Ui, painter: &egui::Painter, session: &mut Session, panel: &Panel, view: &ViewTransform) {
    let names = ["top left", "top right", "bottom right", "bottom left", "middle"];
    let places = panel.quad_px.into_iter().chain([panel.centre_px()]);
    for (at, (place, name)) in places.zip(names).enumerate() {
        let screen = view.screen_from_plate(place);
        let rect = Rect::from_center_size(screen, Vec2::splat(2.0 * GRASP));
        let response = ui.interact(rect, ui.scope_id().with(("corner", at)), Sense::drag());
        let label = format!("Panel {} {name}", panel.panel);
        response.widget_info(|| egui::WidgetInfo::labeled(egui::accesskit::Role::Button, true, &label));
        let fill = if response.hovered() { Color32::WHITE } else { Color32::from_rgb(90, 200, 255) };
        painter.circle(screen, 5.5, fill, Stroke::new(1.5, Color32::BLACK));
        if response.dragged_by(egui::PointerButton::Primary)
            && let Some(pointer) = ui.input(|input| input.pointer.latest_pos())
        {
            drag_corner(session, panel.panel, at, view.plate_from_screen(pointer));
        }
        if response.drag_stopped() {
            session.commit();
        }
        response.on_hover_cursor(CursorIcon::Grab);
    }
}

fn drag_corner(session: &mut Session, number: u32, corner: usize, [x, y]: [f64; 2]) {
    let label = if corner < 4 { "Move a corner" } else { "Move a panel's outline" };
    session.preview(label, |draft| {
        let Some(panel) = draft.manifest.panels.iter_mut().find(|p| p.panel == number) else { return };
        let Some(image) = draft.manifest.images.get(panel.image) else { return };
        let inside = |[x, y]: [f64; 2]| {
            [x.clamp(0.0, f64::from(image.width_px)), y.clamp(0.0, f64::from(image.height_px))]
        };
        if corner < 4 {
            let mut quad_px = panel.quad_px;
            quad_px[corner] = inside([x, y]);
            // A quadrilateral that folds over is no photograph.
            if muybridge_imaging::PanelTransform::new(quad_px, [1.0, 1.0]).is_some() {
                panel.quad_px = quad_px;
            }
        } else {
            let [cx, cy] = panel.centre_px();
            panel.quad_px = panel.quad_px.map(|[px, py]| inside([px + x - cx, py + y - cy]));
        }
    });
}

/// Panels and their order; what is known of the plate.
pub fn inspector(ui: &mut Ui, session: &mut Session, page: &mut PageContext<'_>) {
    ui.heading("Panels");
    ui.label(format!("{} panels, read in the order of their numbers", session.panel_numbers().len()));
    let commands = [
        Command::SplitAutomatically,
        Command::AddPanel,
        Command::DeletePanel,
        Command::PanelEarlier,
        Command::PanelLater,
        Command::MirrorOrder,
        Command::ReverseOrder,
        Command::FindGround,
        Command::FlipFacing,
    ];
    for command in commands {
        let text = format!("{}  {}", command.title(), page.settings.keys.shown(command));
        if ui.add_sized([ui.available_width(), 24.0], egui::Button::new(text)).clicked() {
            page.commands.push(command);
        }
    }
    let facing = match session.draft().manifest.facing {
        Some(muybridge_capture::Facing::Left) => "The animal faces left: its left side is near",
        Some(muybridge_capture::Facing::Right) => "The animal faces right: its right side is near",
        None => "Nobody has said yet which way the animal faces",
    };
    ui.label(facing);
    ui.separator();
    ui.heading("Plate");
    words(ui, session);
    ui.separator();
    tones(ui, session);
}

/// Title, animal and so on; a field is one step when it is left.
fn words(ui: &mut Ui, session: &mut Session) {
    Grid::new("words").num_columns(2).spacing([8.0, 4.0]).show(ui, |ui| {
        gaits(ui, session);
        for field in Words::ALL {
            ui.label(field.name());
            let mut text = field.of(session).clone();
            let edit = ui.add(TextEdit::singleline(&mut text).desired_width(f32::INFINITY));
            edit.widget_info(|| {
                egui::WidgetInfo::labeled(egui::accesskit::Role::TextInput, true, field.name())
            });
            if edit.changed() {
                session.preview(field.name(), |draft| *field.of_draft(draft) = text);
            }
            if edit.lost_focus() {
                session.commit();
            }
            ui.end_row();
        }
    });
}

/// A field of text.
#[derive(Clone, Copy)]
enum Words {
    Title,
    Animal,
    Date,
    Source,
    Holder,
    Licence,
    Annotator,
}

impl Words {
    const ALL: [Self; 7] =
        [Self::Title, Self::Animal, Self::Date, Self::Source, Self::Holder, Self::Licence, Self::Annotator];

    fn name(self) -> &'static str {
        match self {
            Self::Title => "Title",
            Self::Animal => "Animal",
            Self::Date => "Date",
            Self::Source => "Source",
            Self::Holder => "Holder",
            Self::Licence => "Licence",
            Self::Annotator => "Annotator",
        }
    }

    fn of(self, session: &Session) -> &String {
        let (manifest, annotation) = (&session.draft().manifest, &session.draft().annotation);
        match self {
            Self::Title => &manifest.title,
            Self::Animal => &manifest.animal,
            Self::Date => &manifest.date,
            Self::Source => &manifest.source,
            Self::Holder => &manifest.holder,
            Self::Licence => &manifest.licence,
            Self::Annotator => &annotation.annotator,
        }
    }

    fn of_draft(self, draft: &mut muybridge_capture::Draft) -> &mut String {
        let (manifest, annotation) = (&mut draft.manifest, &mut draft.annotation);
        match self {
            Self::Title => &mut manifest.title,
            Self::Animal => &mut manifest.animal,
            Self::Date => &mut manifest.date,
            Self::Source => &mut manifest.source,
            Self::Holder => &mut manifest.holder,
            Self::Licence => &mut manifest.licence,
            Self::Annotator => &mut annotation.annotator,
        }
    }
}

/// The gait of the title, and the one the footfalls show where somebody judged otherwise.
fn gaits(ui: &mut Ui, session: &mut Session) {
    let titled = session.draft().manifest.gait;
    let judged = session.draft().annotation.gait;
    gait_list(ui, "Gait of the title", &titled.to_string(), |ui| {
        for gait in Gait::ALL {
            if ui.selectable_label(titled == gait, gait.to_string()).clicked() {
                session.edit("Gait of the title", |draft| draft.manifest.gait = gait);
            }
        }
    });
    let shown = judged.map_or("as titled".to_string(), |gait| gait.to_string());
    gait_list(ui, "Gait by its footfalls", &shown, |ui| {
        for gait in std::iter::once(None).chain(Gait::ALL.map(Some)) {
            let name = gait.map_or("as titled".to_string(), |gait| gait.to_string());
            if ui.selectable_label(judged == gait, name).clicked() {
                session.edit("Gait by its footfalls", |draft| draft.annotation.gait = gait);
            }
        }
    });
}

fn gait_list(ui: &mut Ui, name: &str, shown: &str, list: impl FnOnce(&mut Ui)) {
    ui.label(name);
    let list = egui::ComboBox::from_id_salt(name).selected_text(shown).show_ui(ui, list);
    let label = format!("{name}: {shown}");
    list.response.widget_info(|| egui::WidgetInfo::labeled(egui::accesskit::Role::ComboBox, true, &label));
    ui.end_row();
}

/// Brightness for looking, not for the files.
fn tones(ui: &mut Ui, session: &mut Session) {
    ui.label(RichText::new("Photograph").strong());
    let mut adjustment = session.textures.adjustment();
    Grid::new("tones").num_columns(2).show(ui, |ui| {
        for (name, value, range) in [
            ("Brightness", &mut adjustment.brightness, -0.5..=0.5),
            ("Contrast", &mut adjustment.contrast, 0.3..=3.0),
            ("Shadows", &mut adjustment.gamma, 0.4..=3.0),
        ] {
            ui.label(name);
            let slider = ui.add(egui::Slider::new(value, range));
            slider.widget_info(|| egui::WidgetInfo::labeled(egui::accesskit::Role::Slider, true, name));
            ui.end_row();
        }
    });
    session.textures.set_adjustment(adjustment);
}
