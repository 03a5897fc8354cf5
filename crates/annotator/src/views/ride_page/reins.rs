//! Buttons and sliders for everything that the keys ask of the horse.

use egui::{Slider, Ui, vec2};
use muybridge_core::{Leap, Side, Turn};

use super::{GAITS, command_button, speed, with_key};
use crate::app::PageContext;
use crate::command::Command;
use crate::ride::RideSession;
use crate::ride::wants::{Order, Wants};

/// Between the buttons of the gaits, points.
const GAP: f32 = 4.0;

/// Speed, gait, lead, turn, leap.
pub(super) fn show(ui: &mut Ui, ride: &mut RideSession, page: &mut PageContext<'_>) {
    speed_row(ui, ride, page);
    speed::show(ui, ride);
    ui.add_space(4.0);
    gaits(ui, ride, page);
    lead(ui, ride, page);
    turn(ui, ride, page);
    leap(ui, ride, page);
}

fn speed_row(ui: &mut Ui, ride: &RideSession, page: &mut PageContext<'_>) {
    ui.horizontal(|ui| {
        let mph = ride.shown().wants.speed_mph;
        let asked = if mph > 0.0 { format!("Asked for {mph:.0} mph") } else { "Asked to halt".into() };
        ui.label(asked);
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            command_button(ui, page, Command::RideHalt, "Halt", false);
            command_button(ui, page, Command::RideFaster, "Faster", false);
            command_button(ui, page, Command::RideSlower, "Slower", false);
        });
    });
}

/// Two rows of four, all of one width.
fn gaits(ui: &mut Ui, ride: &RideSession, page: &mut PageContext<'_>) {
    let wanted = ride.shown().wants.gait;
    let width = (ui.available_width() - 3.0 * GAP) / 4.0;
    let gaits = GAITS.iter().map(|(gait, command)| (*command, command.title(), wanted == Some(*gait)));
    let all = [(Command::RideAutomatic, "By speed", wanted.is_none())].into_iter().chain(gaits);
    let all: Vec<_> = all.chain([(Command::RideLeap, "Leap", false)]).collect();
    for row in all.chunks(4) {
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = GAP;
            for (command, text, is_on) in row {
                let button = egui::Button::selectable(*is_on, *text).frame_when_inactive(true);
                let size = vec2(width, ui.spacing().interact_size.y);
                if ui.add_sized(size, button).on_hover_text(with_key(page, *command)).clicked() {
                    page.commands.push(*command);
                }
            }
        });
    }
}

fn lead(ui: &mut Ui, ride: &mut RideSession, page: &PageContext<'_>) {
    ui.horizontal(|ui| {
        ui.label("Lead").on_hover_text(with_key(page, Command::RideLead));
        let wanted = ride.shown().wants.lead;
        let leads = [(None, "As the turn"), (Some(Side::Left), "Left"), (Some(Side::Right), "Right")];
        for (lead, text) in leads {
            let name = format!("Lead: {text}");
            let button = egui::Button::selectable(wanted == lead, text).frame_when_inactive(true);
            let response = ui.add(button).on_hover_text(with_key(page, Command::RideLead));
            response.widget_info(|| {
                egui::WidgetInfo::selected(egui::accesskit::Role::Button, true, wanted == lead, &name)
            });
            if response.clicked() {
                ride.give(Order::Lead(lead));
            }
        }
    });
}

fn turn(ui: &mut Ui, ride: &mut RideSession, page: &mut PageContext<'_>) {
    ui.horizontal(|ui| {
        ui.label("Rein");
        command_button(ui, page, Command::RideLeft, "15° left", false);
        let heading_rad =
            ride.shown().riders[0].as_ref().map_or(0.0, |rider| rider.readout.heading_rad as f32);
        let straight = egui::Button::new("Straight on");
        if ui.add(straight).on_hover_text("Keeps the present heading").clicked() {
            ride.give(Order::Turn(Turn::Heading(heading_rad)));
        }
        command_button(ui, page, Command::RideRight, "15° right", false);
    });
    let mut deg_s = match ride.shown().wants.turn {
        Turn::Rate(rate) => rate.to_degrees(),
        Turn::Heading(_) | Turn::Steps(_) => 0.0,
    };
    let slider = Slider::new(&mut deg_s, Wants::TURN_DEG_S).text("Turn").suffix("°/s").fixed_decimals(0);
    let text = "A circle: to the left positive. Held reins turn at 40°/s.";
    ui.spacing_mut().slider_width = 170.0;
    if ui.add(slider).on_hover_text(text).changed() {
        ride.give(Order::Turn(Turn::Rate(deg_s.to_radians())));
    }
}

fn leap(ui: &mut Ui, ride: &mut RideSession, page: &PageContext<'_>) {
    let Leap { mut height_m, mut length_m } = ride.wants().leap;
    ui.horizontal(|ui| {
        ui.label("Leaps").on_hover_text(with_key(page, Command::RideLeap));
        let drag = |value, range, name: &'static str| {
            egui::DragValue::new(value).range(range).speed(0.02).fixed_decimals(2).suffix(" m").prefix(name)
        };
        let height = ui.add(drag(&mut height_m, Wants::LEAP_HEIGHT_M, "high "));
        let height = height.on_hover_text("How far the trunk rises in flight");
        let length = ui.add(drag(&mut length_m, Wants::LEAP_LENGTH_M, "long "));
        let length = length.on_hover_text("How far the trunk travels in flight");
        if height.changed() || length.changed() {
            ride.give(Order::LeapSize(Leap { height_m, length_m }));
        }
    });
}
