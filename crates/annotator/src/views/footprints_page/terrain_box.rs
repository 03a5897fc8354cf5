//! The ground's form and numbers.

use egui::{ComboBox, Ui};
use muybridge_footprints::{Terrain, Track};

use super::fields::{Number, slider};
use crate::footprints::Editor;

/// Width of a slider's rail, points.
const SLIDER: f32 = 120.0;

/// Grounds to choose, with where they begin.
fn choices() -> [(&'static str, Terrain); 4] {
    [
        ("Flat", Terrain::Flat),
        ("Slope", Terrain::Slope { rise_deg: 8.0, towards_deg: 0.0 }),
        (
            "Stairs",
            Terrain::Stairs { tread_m: 0.4, rise_m: 0.15, steps: 10, towards_deg: 0.0, from_m: [0.6, 0.0] },
        ),
        (
            "Spiral stairs",
            Terrain::SpiralStairs {
                centre_m: [0.0, -1.5],
                inner_m: 0.5,
                outer_m: 2.5,
                steps_per_turn: 18,
                rise_m: 0.15,
                turns: 0.75,
                from_deg: -90.0,
                clockwise: false,
            },
        ),
    ]
}

fn name(terrain: &Terrain) -> &'static str {
    match terrain {
        Terrain::Flat => "Flat",
        Terrain::Slope { .. } => "Slope",
        Terrain::Stairs { .. } => "Stairs",
        Terrain::SpiralStairs { .. } => "Spiral stairs",
        Terrain::HeightField { .. } => "Heights of the file",
    }
}

/// The box.
pub(super) fn show(ui: &mut Ui, editor: &mut Editor) {
    let now = editor.track().terrain.clone();
    ComboBox::from_label("Ground").selected_text(name(&now)).show_ui(ui, |ui| {
        for (title, terrain) in choices() {
            let is_now = name(&now) == title;
            if ui.selectable_label(is_now, title).clicked() && !is_now {
                editor.document.edit("Ground", |track| track.terrain = terrain);
            }
        }
    });
    ui.spacing_mut().slider_width = SLIDER;
    let degrees = |name, range| Number { name, suffix: "°", range, speed: 0.5, decimals: 1 };
    let metres = |name, range| Number { name, suffix: " m", range, speed: 0.01, decimals: 3 };
    match now {
        Terrain::Flat | Terrain::HeightField { .. } => {}
        Terrain::Slope { rise_deg, towards_deg } => {
            part(ui, editor, rise_deg, &degrees("Rise", -40.0..=40.0), |terrain, value| {
                if let Terrain::Slope { rise_deg, .. } = terrain {
                    *rise_deg = value;
                }
            });
            part(ui, editor, towards_deg, &degrees("Towards", -180.0..=180.0), |terrain, value| {
                if let Terrain::Slope { towards_deg, .. } = terrain {
                    *towards_deg = value;
                }
            });
        }
        Terrain::Stairs { tread_m, rise_m, steps, towards_deg, from_m } => {
            let stairs = Stairs { tread_m, rise_m, steps, towards_deg, along_m: from_m[0] };
            stairs.show(ui, editor);
        }
        Terrain::SpiralStairs { rise_m, turns, .. } => {
            part(ui, editor, rise_m, &metres("Rise", -0.4..=0.4), |terrain, value| {
                if let Terrain::SpiralStairs { rise_m, .. } = terrain {
                    *rise_m = value;
                }
            });
            let number = Number { name: "Turns", suffix: "", range: 0.1..=1.0, speed: 0.01, decimals: 2 };
            part(ui, editor, turns, &number, |terrain, value| {
                if let Terrain::SpiralStairs { turns, .. } = terrain {
                    *turns = value;
                }
            });
        }
    }
}

fn part(
    ui: &mut Ui,
    editor: &mut Editor,
    value: f64,
    number: &Number<'_>,
    set: impl FnOnce(&mut Terrain, f64),
) {
    slider(ui, editor, value, number, |track: &mut Track, value| set(&mut track.terrain, value));
}

/// The numbers of a straight flight.
struct Stairs {
    tread_m: f64,
    rise_m: f64,
    steps: u32,
    towards_deg: f64,
    along_m: f64,
}

impl Stairs {
    fn show(&self, ui: &mut Ui, editor: &mut Editor) {
        let number = |name, suffix, range, decimals| Number { name, suffix, range, speed: 0.01, decimals };
        part(ui, editor, self.tread_m, &number("Tread", " m", 0.1..=3.0, 2), |terrain, value| {
            if let Terrain::Stairs { tread_m, .. } = terrain {
                *tread_m = value;
            }
        });
        part(ui, editor, self.rise_m, &number("Rise", " m", -0.6..=0.6, 3), |terrain, value| {
            if let Terrain::Stairs { rise_m, .. } = terrain {
                *rise_m = value;
            }
        });
        let count = f64::from(self.steps);
        part(ui, editor, count, &number("Stairs", "", 1.0..=60.0, 0), |terrain, value| {
            if let Terrain::Stairs { steps, .. } = terrain {
                *steps = value.round().clamp(1.0, 1000.0) as u32;
            }
        });
        let towards = number("Towards", "°", -180.0..=180.0, 0);
        part(ui, editor, self.towards_deg, &towards, |terrain, value| {
            if let Terrain::Stairs { towards_deg, .. } = terrain {
                *towards_deg = value;
            }
        });
        let begin = number("Begin at x", " m", -20.0..=20.0, 2);
        part(ui, editor, self.along_m, &begin, |terrain, value| {
            if let Terrain::Stairs { from_m, .. } = terrain {
                from_m[0] = value;
            }
        });
    }
}
