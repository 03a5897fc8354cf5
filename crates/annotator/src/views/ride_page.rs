//! The Ride page: a horse in real time, driven by keys, buttons and sliders.

mod diagram;
mod photograph;
mod plate_phase;
mod readout;
mod reins;
mod scene;
mod settings;
mod speed;
mod transport;
mod workshop;

use std::sync::Arc;

use egui::{CentralPanel, Context, Panel, ScrollArea, Ui};
use muybridge_core::{Gait, Side};

use crate::app::PageContext;
use crate::command::Command;
use crate::figure::FigureView;
use crate::ride::wants::Order;
use crate::ride::{RideSession, Which};
use crate::session::Session;
use crate::views::tabs;
use scene::View;
pub(in crate::views) use scene::scene_colors;
use workshop::Workshop;

/// The Ride page with everything that stays while another page is looked at.
#[derive(Default)]
pub struct RidePage {
    is_open: bool,
    workshop: Workshop,
    ride: Option<Ride>,
    /// Why there is no horse.
    fault: Option<String>,
}

/// A ride and how it is looked at.
struct Ride {
    session: RideSession,
    view: View,
    /// The horse from the side of the photographs.
    beside: FigureView,
    /// The horse that the sliders change.
    edited: Which,
    /// egui's time at the frame before, s.
    last_s: Option<f64>,
}

impl RidePage {
    /// Whether the page is looked at.
    pub fn is_open(&self) -> bool {
        self.is_open
    }

    /// Goes to the page; the first time the horse is made ready in the background.
    pub fn open(&mut self, context: &Context) {
        self.is_open = true;
        if self.ride.is_none() {
            self.workshop.begin(context);
        }
    }

    /// Leaves the page; the ride stands still until it is opened again.
    pub fn close(&mut self) {
        self.is_open = false;
        if let Some(ride) = &mut self.ride {
            ride.last_s = None;
        }
    }

    /// The ride, once the horse is ready.
    pub fn session(&self) -> Option<&RideSession> {
        self.ride.as_ref().map(|ride| &ride.session)
    }

    /// The same, to be changed.
    pub fn session_mut(&mut self) -> Option<&mut RideSession> {
        self.ride.as_mut().map(|ride| &mut ride.session)
    }

    /// Waits until the horse is ready: for programs without a window.
    pub fn wait(&mut self) {
        self.workshop.wait();
        self.take_finished();
    }

    /// Takes what was made in the background.
    fn take_finished(&mut self) {
        let Some((which, made)) = self.workshop.finished() else { return };
        match (made, &mut self.ride) {
            (Ok(repertoire), Some(ride)) => ride.session.set_build(which, repertoire),
            (Ok(repertoire), ride) => {
                let mut beside = FigureView::new(Side::Right);
                beside.buttons = false;
                let session = RideSession::new(repertoire);
                let (view, edited) = (View::default(), Which::A);
                *ride = Some(Ride { session, view, beside, edited, last_s: None });
            }
            (Err(fault), _) => self.fault = Some(fault),
        }
    }

    /// Why a command of this page cannot act now.
    pub fn why_not(&self, command: Command) -> Option<&'static str> {
        if !self.is_open {
            Some("Go to the Ride page first")
        } else if self.ride.is_none() && command != Command::RideLeave {
            Some("The horse is being made ready")
        } else {
            None
        }
    }

    /// Does a command of this page; false when it is another's.
    pub fn run(&mut self, command: Command) -> bool {
        if command == Command::RideLeave {
            self.close();
            return true;
        }
        let Some(ride) = &mut self.ride else { return false };
        if let Some(order) = order_of(command) {
            ride.session.give(order);
            return true;
        }
        match command {
            Command::RidePause => ride.session.pause(!ride.session.is_paused()),
            Command::RideStepForward => ride.session.step_forward(),
            Command::RideStepBack => ride.session.step_back(),
            Command::RideCamera => ride.view.next_camera(),
            Command::RideReset => ride.session.reset(),
            _ => return false,
        }
        true
    }

    /// The whole page. `session` is the open plate.
    pub fn show(&mut self, ui: &mut Ui, session: Option<&mut Session>, page: &mut PageContext<'_>) {
        self.take_finished();
        if let Some(fault) = self.fault.take() {
            page.messages.trouble(fault);
        }
        let leave = (Command::PageRide, Command::RideLeave);
        Panel::top("pages").show(ui, |ui| tabs::show_other(ui, leave, session.is_some(), page));
        let Some(ride) = &mut self.ride else {
            CentralPanel::default().show(ui, |ui| {
                ui.centered_and_justified(|ui| {
                    ui.label("The horse is being made ready…");
                });
            });
            return;
        };
        ride.advance(ui, page);
        Panel::bottom("ride time").resizable(false).show(ui, |ui| {
            transport::show(ui, &mut ride.session, page);
            diagram::show(ui, &mut ride.session);
            ui.add_space(4.0);
        });
        let matched = session.as_deref().and_then(|session| plate_phase::of(session, &ride.session));
        Panel::right("ride inspector").default_size(330.0).size_range(280.0..=460.0).show(ui, |ui| {
            let scroll = ScrollArea::vertical().id_salt("ride").auto_shrink(false);
            scroll.show(ui, |ui| ride.inspector(ui, &mut self.workshop, session.as_deref(), page));
        });
        CentralPanel::no_frame().show(ui, |ui| {
            let rect = ui.available_rect_before_wrap();
            scene::show(ui, &ride.session, &mut ride.view);
            if let (Some(session), true) = (session, ride.view.photographs) {
                photograph::show(ui, rect, session, ride, matched);
            }
        });
        self.workshop.work(ui.ctx());
    }
}

impl Ride {
    /// Moves on with the time that has passed, and follows the reins that are held.
    fn advance(&mut self, ui: &Ui, page: &PageContext<'_>) {
        let now_s = ui.input(|input| input.time);
        let passed_s = self.last_s.map_or(0.0, |last_s| now_s - last_s);
        self.session.hold_rein(held_rein(ui, page), passed_s);
        self.session.advance(passed_s);
        let moves = !self.session.is_paused() || self.session.holds_rein();
        self.last_s = moves.then_some(now_s);
        if moves {
            ui.ctx().request_repaint();
        }
    }

    fn inspector(
        &mut self,
        ui: &mut Ui,
        workshop: &mut Workshop,
        plate: Option<&Session>,
        page: &mut PageContext<'_>,
    ) {
        readout::headline(ui, &self.session);
        section(ui, "Reins", |ui| reins::show(ui, &mut self.session, page));
        section(ui, "What it does", |ui| readout::table(ui, &self.session));
        section(ui, "View", |ui| scene::controls(ui, &mut self.view, plate, page));
        section(ui, "Ground", |ui| settings::ground(ui, &mut self.session));
        section(ui, "Horse", |ui| settings::horse(ui, self.edited, &mut self.session, workshop));
        section(ui, "Two horses", |ui| settings::second(ui, self, workshop));
    }
}

/// The rein whose key is down.
fn held_rein(ui: &Ui, page: &PageContext<'_>) -> Option<Side> {
    if ui.ctx().egui_wants_keyboard_input() {
        return None;
    }
    let is_down = |command: Command| {
        let keys = page.settings.keys.keys(command);
        ui.input(|input| {
            let down = |key: &egui::KeyboardShortcut| {
                input.key_down(key.logical_key) && input.modifiers.matches_logically(key.modifiers)
            };
            keys.iter().any(down)
        })
    };
    match (is_down(Command::RideLeft), is_down(Command::RideRight)) {
        (true, false) => Some(Side::Left),
        (false, true) => Some(Side::Right),
        _ => None,
    }
}

/// The order that a command gives.
fn order_of(command: Command) -> Option<Order> {
    Some(match command {
        Command::RideFaster => Order::Faster,
        Command::RideSlower => Order::Slower,
        Command::RideLeft => Order::Tap(Side::Left),
        Command::RideRight => Order::Tap(Side::Right),
        Command::RideHalt => Order::Halt,
        Command::RideLead => Order::NextLead,
        Command::RideLeap => Order::Leap,
        Command::RideAutomatic => Order::Gait(None),
        _ => Order::Gait(Some(GAITS.iter().find(|(_, of)| *of == command)?.0)),
    })
}

/// Gaits that can be asked for, with their commands.
const GAITS: [(Gait, Command); 6] = [
    (Gait::Walk, Command::RideWalk),
    (Gait::Amble, Command::RideAmble),
    (Gait::Trot, Command::RideTrot),
    (Gait::Rack, Command::RideRack),
    (Gait::Canter, Command::RideCanter),
    (Gait::Gallop, Command::RideGallop),
];

/// A part of the inspector that can be folded away.
fn section(ui: &mut Ui, title: &str, content: impl FnOnce(&mut Ui)) {
    let heading = egui::RichText::new(title).strong().size(14.0);
    egui::CollapsingHeader::new(heading)
        .id_salt(("ride", title))
        .default_open(true)
        .show_unindented(ui, content);
    ui.add_space(6.0);
}

/// What a button's command does, with its key.
pub(in crate::views) fn with_key(page: &PageContext<'_>, command: Command) -> String {
    let keys: Vec<String> = page.settings.keys.keys(command).iter().map(crate::keys::to_words).collect();
    match keys.as_slice() {
        [] => command.title().to_string(),
        keys => format!("{} ({})", command.title(), keys.join(" or ")),
    }
}

/// A button that does a command.
pub(in crate::views) fn command_button(
    ui: &mut Ui,
    page: &mut PageContext<'_>,
    command: Command,
    text: &str,
    is_on: bool,
) {
    let button = egui::Button::selectable(is_on, text).frame_when_inactive(true);
    if ui.add(button).on_hover_text(with_key(page, command)).clicked() {
        page.commands.push(command);
    }
}

/// The motion of a horse, shared.
type SharedRepertoire = Arc<muybridge_core::Repertoire>;

/// A colour of the data as text: lighter on dark backgrounds, darker on light ones.
fn legible(ui: &Ui, color: egui::Color32) -> egui::Color32 {
    let towards = if ui.visuals().dark_mode { egui::Color32::WHITE } else { egui::Color32::BLACK };
    color.lerp_to_gamma(towards, 0.35)
}
