//! The ground, the horse's proportions, and the second horse.

use std::ops::RangeInclusive;

use egui::{ComboBox, DragValue, Slider, Ui};
use muybridge_core::Gait;

use super::workshop::Workshop;
use super::{GAITS, Ride};
use crate::ride::build::Build;
use crate::ride::terrain::Shape;
use crate::ride::{RideSession, Which};

/// Width of a slider's rail, points.
const SLIDER: f32 = 140.0;

/// Form of the ground, with its numbers.
pub(super) fn ground(ui: &mut Ui, ride: &mut RideSession) {
    let shape = ride.shown().terrain.shape;
    ui.spacing_mut().slider_width = SLIDER;
    ui.horizontal(|ui| {
        for (first, name) in Shape::ALL {
            let button = egui::Button::selectable(shape.is_kind_of(&first), name).frame_when_inactive(true);
            let text = "Another ground begins around the horse";
            if ui.add(button).on_hover_text(text).clicked() && !shape.is_kind_of(&first) {
                ride.set_shape(first);
            }
        }
    });
    let mut changed = shape;
    match &mut changed {
        Shape::Flat => {}
        Shape::Slope(degrees) => {
            let slider = Slider::new(degrees, Shape::SLOPE_DEG).text("Slope").suffix("°").fixed_decimals(0);
            ui.add(slider).on_hover_text("Up ahead of the horse; negative goes down");
        }
        Shape::Steps([height, length]) => {
            metres(ui, height, Shape::STEP_HEIGHT_M, "Height of a step", "Negative goes down");
            metres(ui, length, Shape::STEP_LENGTH_M, "Length of a step", "From one face to the next");
        }
        Shape::Hills([height, length]) => {
            metres(ui, height, Shape::HILL_HEIGHT_M, "Height of the hills", "From valley to top");
            metres(ui, length, Shape::HILL_LENGTH_M, "Distance of the tops", "Along the way ahead");
        }
    }
    if changed != shape {
        ride.set_shape(changed);
    }
}

fn metres(ui: &mut Ui, value: &mut f32, range: RangeInclusive<f32>, name: &str, hover: &str) {
    let slider = Slider::new(value, range).text(name).suffix(" m").fixed_decimals(2);
    ui.add(slider).on_hover_text(hover);
}

/// Proportions, seed and gait of the horse that the sliders change.
pub(super) fn horse(ui: &mut Ui, which: Which, ride: &mut RideSession, workshop: &mut Workshop) {
    if ride.has_second() {
        ui.label(egui::RichText::new(format!("Horse {}", which.name())).strong());
    }
    ui.spacing_mut().slider_width = SLIDER;
    let before = workshop.wanted(which);
    let mut build = before;
    let mut slider = |value: &mut f32, range: RangeInclusive<f32>, name: &str, hover: &str| {
        let slider = Slider::new(value, range).text(name).fixed_decimals(2).suffix("×");
        ui.add(slider).on_hover_text(hover);
    };
    slider(&mut build.legs, Build::LEGS, "Legs", "Length of the legs against the reference horse");
    slider(&mut build.trunk, Build::TRUNK, "Trunk", "Length from croup to withers");
    slider(&mut build.neck, Build::NECK, "Neck", "Length of the neck");
    slider(&mut build.size, Build::SIZE, "Size", "The whole horse");
    ui.horizontal(|ui| {
        if ui.button("As the reference").on_hover_text("1.60 m at the withers").clicked() {
            build = Build::default();
        }
        if workshop.is_busy() {
            ui.spinner();
            ui.weak("being made ready…");
        }
    });
    if build != before {
        workshop.want(which, build, ui.input(|input| input.time));
    }
    character(ui, which, ride);
}

/// Seed, and a gait of its own.
fn character(ui: &mut Ui, which: Which, ride: &mut RideSession) {
    let (own_gait, seed) = ride.own(which);
    ui.horizontal(|ui| {
        let label = ui.label("Seed");
        let mut chosen = seed;
        let drag = ui.add(DragValue::new(&mut chosen).range(0..=999)).labelled_by(label.id);
        if drag
            .on_hover_text("What it chooses where it has a choice; counts from the next beginning on")
            .changed()
        {
            ride.set_seed(which, chosen);
        }
        let label = ui.label("Gait");
        let text = own_gait.map_or("as asked", Gait::name);
        let combo = ComboBox::from_id_salt(("own gait", which.index())).selected_text(text).width(110.0);
        let combo = combo.show_ui(ui, |ui| {
            let gaits = GAITS.iter().map(|(gait, _)| (Some(*gait), gait.name()));
            for (gait, name) in [(None, "as asked")].into_iter().chain(gaits) {
                if ui.selectable_label(own_gait == gait, name).clicked() {
                    ride.set_own_gait(which, gait);
                }
            }
        });
        combo.response.labelled_by(label.id).on_hover_text("A gait that this horse keeps, whatever is asked");
    });
}

/// Horse B: whether it is there, where it is drawn, and which horse the sliders change.
pub(super) fn second(ui: &mut Ui, ride: &mut Ride, workshop: &mut Workshop) {
    let mut there = ride.session.has_second();
    let text = "A second horse with other settings, driven by the same reins";
    if ui.checkbox(&mut there, "Horse B").on_hover_text(text).changed() {
        if there {
            workshop.copy_first();
            ride.session.bring_second();
            ride.edited = Which::B;
        } else {
            ride.session.take_second_away();
            ride.edited = Which::A;
        }
    }
    if !there {
        ui.weak("Another build, gait or seed beside the first, driven by the same reins.");
        return;
    }
    ui.horizontal(|ui| {
        ui.label("Sliders change");
        for which in Which::ALL {
            let name = format!("Horse {}", which.name());
            let button = egui::Button::selectable(ride.edited == which, name.as_str());
            if ui.add(button.frame_when_inactive(true)).clicked() {
                ride.edited = which;
            }
        }
    });
    ui.checkbox(&mut ride.view.second_as_ghost, "B as a ghost within A")
        .on_hover_text("Otherwise B goes at the left of A");
    let text = "Where the two have drifted apart: puts B beside A again, in A's stride";
    if ui.button("Bring B beside A").on_hover_text(text).clicked() {
        ride.session.bring_second();
    }
}
