//! A short tour of the window, step by step, on the plate that is open.

use egui::{Align2, Context, RichText, Window};

use crate::session::{Page, Session};

/// One step: where, heading, text.
struct Step {
    page: Page,
    heading: &'static str,
    text: &'static str,
}

const STEPS: [Step; 7] = [
    Step {
        page: Page::Plate,
        heading: "This is a specimen plate",
        text: "It is a drawing in the manner of a plate of 1887, made by this program from a known motion, so that you \
               can try everything. Your own plates come in by File, by dropping a file on the window, or from the \
               catalogue of Animal Locomotion.",
    },
    Step {
        page: Page::Plate,
        heading: "1  Split the plate",
        text: "“Find panels” looks for the photographs. Drag a corner where it is wrong; add, delete and reorder \
               panels at the right. Points stay on the plate whatever happens to the panels.",
    },
    Step {
        page: Page::Calibrate,
        heading: "2  Calibrate",
        text: "Say what is known of scale and time: a length in the picture, the height of the animal, the interval \
               between the photographs. What follows from it is shown at once, and where two sources disagree.",
    },
    Step {
        page: Page::Pose,
        heading: "3  Pose the horse",
        text: "Click the points in the order that is shown; V, O and X say whether a point is seen, guessed or absent. \
               Or press K and drag the skeleton: the limbs follow, the bones keep their length. After two panels T \
               proposes the next one: look it over and correct what is off.",
    },
    Step {
        page: Page::Pose,
        heading: "Footfalls",
        text: "The four lanes below show when each hoof is down. Click a lane to label a panel, drag an edge to \
               place the moment of a strike or lift-off between two panels.",
    },
    Step {
        page: Page::Gait,
        heading: "4  Fit and look again",
        text: "The stride is fitted while you work. The worst points are listed first; click one to go there. \
               Contact times, duty factors and the gait follow as you drag.",
    },
    Step {
        page: Page::Play,
        heading: "5  Play",
        text: "Enter plays the fitted stride over the photographs. Ctrl+Z takes any step back, and every change is \
               kept even if the power goes. Ctrl+Shift+P lists all commands. Help, Tour shows this again.",
    },
];

/// The tour while it is shown.
#[derive(Debug, Default)]
pub struct Tour {
    step: usize,
    /// The step whose page was opened.
    opened: Option<usize>,
}

impl Tour {
    /// Draws the present step; false when the tour is over.
    pub fn show(&mut self, context: &Context, session: Option<&mut Session>) -> bool {
        if let Some(session) = session
            && self.opened != Some(self.step)
        {
            session.page = STEPS[self.step].page;
            self.opened = Some(self.step);
        }
        let number = self.step + 1;
        let (mut stays, mut open) = (true, true);
        let step = &STEPS[self.step];
        let window = Window::new("Tour").open(&mut open).collapsible(false).resizable(false);
        window.anchor(Align2::LEFT_BOTTOM, [24.0, -190.0]).default_width(400.0).show(context, |ui| {
            ui.set_width(400.0);
            ui.label(RichText::new(step.heading).heading());
            ui.label(step.text);
            ui.add_space(6.0);
            ui.horizontal(|ui| {
                if ui.add_enabled(self.step > 0, egui::Button::new("Back")).clicked() {
                    self.step -= 1;
                }
                let last = self.step + 1 == STEPS.len();
                if ui.button(if last { "Done" } else { "Next" }).clicked() {
                    stays = !last;
                    self.step = (self.step + 1).min(STEPS.len() - 1);
                }
                if !last && ui.button("Skip the tour").clicked() {
                    stays = false;
                }
                ui.label(format!("{number} of {}", STEPS.len()));
            });
        });
        stays && open
    }
}
