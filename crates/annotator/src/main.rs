//! The annotator's program: its arguments and its window.

use std::path::PathBuf;
use std::time::Instant;

use annotator::app::{Annotator, Places};
use clap::Parser;

/// Turn a plate of Muybridge's into an annotation: split, calibrate, pose the horse, mark footfalls, fit, play.
#[derive(Debug, Parser)]
#[command(name = "annotator", version)]
struct Arguments {
    /// A plate's picture or manifest, a folder of frames, or an annotation.
    path: Option<PathBuf>,
    /// Folder of manifests and the catalogue, for the plate browser.
    #[arg(long, value_name = "FOLDER", default_value = "plates")]
    plates: PathBuf,
    /// Print how long it took until the first frame was drawn.
    #[arg(long)]
    report_start: bool,
}

/// The program in a window.
struct Window {
    annotator: Annotator,
    started: Option<Instant>,
}

impl eframe::App for Window {
    fn ui(&mut self, ui: &mut egui::Ui, _frame: &mut eframe::Frame) {
        self.annotator.ui(ui);
        if let Some(started) = self.started.take() {
            println!("first frame after {} ms", started.elapsed().as_millis());
        }
    }
}

fn main() -> std::process::ExitCode {
    let started = Instant::now();
    let arguments = Arguments::parse();
    let viewport = egui::ViewportBuilder::default()
        .with_title("Muybridge annotator")
        .with_app_id("muybridge-annotator")
        .with_inner_size([1360.0, 880.0])
        .with_min_inner_size([760.0, 520.0])
        .with_drag_and_drop(true);
    let options = eframe::NativeOptions { viewport, persist_window: true, ..Default::default() };
    let places = Places { plates: arguments.plates.clone(), ..Places::default() };
    let result = eframe::run_native(
        "muybridge-annotator",
        options,
        Box::new(move |creation| {
            let annotator = Annotator::new(&creation.egui_ctx, places, arguments.path.as_deref());
            Ok(Box::new(Window { annotator, started: arguments.report_start.then_some(started) }))
        }),
    );
    match result {
        Ok(()) => std::process::ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("The window cannot be opened: {error}. It needs a display and OpenGL 2.1 or later.");
            std::process::ExitCode::FAILURE
        }
    }
}
