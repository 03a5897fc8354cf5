//! How long a frame of the window takes to compute: the pass over the user interface and the tessellation, without a
//! display. The plate has 50 megapixels and 24 panels; ghosts, trails and fit are shown.

#![allow(clippy::unwrap_used, reason = "a benchmark stops at the first thing it cannot do")]

mod frames_plate;

use std::time::{Duration, Instant};

use annotator::app::{Annotator, Places};
use annotator::canvas::PanelZoom;
use annotator::command::Command;
use annotator::session::{Session, Tool};
use egui::{Context, Event, Modifiers, PointerButton, Pos2, RawInput, Rect, pos2, vec2};
use frames_plate::large_plate;

/// Size of the window, points.
const WINDOW: [f32; 2] = [1500.0, 900.0];
/// Somewhere on the photograph that is looked at.
const ON_PHOTOGRAPH: Pos2 = pos2(560.0, 380.0);
/// Frames of a measurement.
const FRAMES: usize = 300;
const MOST_FRAME_MS: f64 = 8.0;
const MOST_DRAG_MS: f64 = 4.0;
const MOST_STEP_MS: f64 = 8.0;

/// The program without a window.
struct Bench {
    context: Context,
    annotator: Annotator,
    time_s: f64,
    shapes: Vec<egui::epaint::ClippedShape>,
}

fn main() {
    let folder = tempfile::tempdir().unwrap();
    let started = Instant::now();
    let path = large_plate(folder.path());
    println!("50-megapixel plate drawn in {:.1} s", started.elapsed().as_secs_f64());
    let context = Context::default();
    let places = Places { state: Some(folder.path().join("state")), plates: folder.path().to_path_buf() };
    let started = Instant::now();
    let mut annotator = Annotator::new(&context, places, Some(&path));
    annotator.wait_until_open(&context);
    annotator.settings.fit_always = false;
    let mut bench = Bench { context, annotator, time_s: 0.0, shapes: Vec::new() };
    while bench.session().picture_is_missing() {
        bench.frame(Vec::new());
        std::thread::sleep(Duration::from_millis(5));
    }
    println!("opened, read and halved in {:.1} s", started.elapsed().as_secs_f64());
    bench.fit();
    bench.show_everything();
    for pixels_per_point in [1.0, 2.0] {
        bench.context.set_pixels_per_point(pixels_per_point);
        println!("{} x {} points at {pixels_per_point} pixels per point", WINDOW[0], WINDOW[1]);
        bench.measure();
    }
}

impl Bench {
    fn session(&mut self) -> &mut Session {
        self.annotator.session.as_mut().unwrap()
    }

    fn fit(&mut self) {
        let context = self.context.clone();
        let session = self.session();
        session.fit.start(&session.document, &context);
        session.fit.wait();
        println!("fit: {}", session.fit.fault().unwrap_or("there"));
        // From here on all panels are of the stride; the fit stays that of the first twelve.
        session.edit("All panels", |draft| draft.annotation.stride.last = 24);
    }

    fn show_everything(&mut self) {
        let session = self.session();
        session.go_to(5);
        let shown = &mut session.shown;
        (shown.ghost_photograph, shown.ghost_skeletons, shown.hoof_trails, shown.fit) =
            (true, true, true, true);
    }

    /// One frame; what it took.
    fn frame(&mut self, events: Vec<Event>) -> Duration {
        self.time_s += 1.0 / 60.0;
        let input = RawInput {
            screen_rect: Some(Rect::from_min_size(Pos2::ZERO, WINDOW.into())),
            time: Some(self.time_s),
            events,
            ..RawInput::default()
        };
        let started = Instant::now();
        let mut output = self.context.run_ui(input, |ui| self.annotator.ui(ui));
        let passed = started.elapsed();
        self.shapes.clone_from(&output.shapes);
        // Nobody has a graphics card to take them.
        output.textures_delta.clear();
        let started = Instant::now();
        let meshes = self.context.tessellate(output.shapes, output.pixels_per_point);
        std::hint::black_box(&meshes);
        passed + started.elapsed()
    }

    /// Frames until all tiles are there, with the pointer somewhere.
    fn settle(&mut self, at: Pos2) {
        for _ in 0..30 {
            self.frame(vec![Event::PointerMoved(at)]);
        }
    }

    /// A frame of nothing but the shapes of another frame.
    fn bare_frame(&mut self) -> Duration {
        let screen_rect = Some(Rect::from_min_size(Pos2::ZERO, WINDOW.into()));
        let input = RawInput { screen_rect, time: Some(self.time_s), ..RawInput::default() };
        let shapes = self.shapes.clone();
        let started = Instant::now();
        let mut output = self.context.run_ui(input, |ui| {
            for shape in &shapes {
                ui.painter().with_clip_rect(shape.clip_rect).add(shape.shape.clone());
            }
        });
        let meshes = self.context.tessellate(output.shapes, output.pixels_per_point);
        std::hint::black_box(&meshes);
        output.textures_delta.clear();
        started.elapsed()
    }

    fn measure(&mut self) {
        self.settle(ON_PHOTOGRAPH);
        let still: Vec<_> = (0..FRAMES).map(|_| self.frame(Vec::new())).collect();
        report("frame, nothing moves", &still, None);
        println!("  {} shapes", self.shapes.len());
        let bare: Vec<_> = (0..FRAMES).map(|_| self.bare_frame()).collect();
        report("bare frame of the same shapes", &bare, None);
        self.settle(ON_PHOTOGRAPH);
        let moving = self.pan_and_zoom();
        report("frame while panning and zooming", &moving, Some(MOST_FRAME_MS));
        println!(
            "  p95 is {:.1} times the bare frame's",
            percentile(&moving, 0.95) / percentile(&bare, 0.95)
        );
        let steps = self.steps();
        report("panel step", &steps, Some(MOST_STEP_MS));
        let (resting, dragging) = self.drag();
        report("frame with the skeleton's handles", &resting, None);
        report("frame of a drag with inverse kinematics", &dragging, Some(MOST_FRAME_MS));
        let rest = percentile(&resting, 0.5);
        let computing: Vec<_> =
            dragging.iter().map(|t| t.saturating_sub(Duration::from_secs_f64(rest * 1e-3))).collect();
        report("  of that, what the drag adds", &computing, Some(MOST_DRAG_MS));
    }

    /// The middle button pans in circles while a pinch zooms in and out.
    fn pan_and_zoom(&mut self) -> Vec<Duration> {
        self.frame(vec![button(ON_PHOTOGRAPH, PointerButton::Middle, true)]);
        let times = (0..FRAMES).map(|i| {
            let turn = i as f32 * 0.11;
            let at = ON_PHOTOGRAPH + 90.0 * vec2(turn.cos(), turn.sin());
            let factor = if i % 100 < 50 { 1.05 } else { 1.0 / 1.05 };
            self.frame(vec![Event::PointerMoved(at), Event::Zoom(factor)])
        });
        let times = times.collect();
        self.frame(vec![button(ON_PHOTOGRAPH, PointerButton::Middle, false)]);
        assert_ne!(self.session().zoom, PanelZoom::default(), "nothing was panned");
        self.session().zoom.reset();
        times
    }

    /// The command and the frame after it.
    fn steps(&mut self) -> Vec<Duration> {
        let context = self.context.clone();
        let times = (0..72).map(|_| {
            let started = Instant::now();
            self.annotator.run(&context, Command::NextPanel);
            started.elapsed() + self.frame(Vec::new())
        });
        times.collect()
    }

    /// Frames with the skeleton's handles, and frames in which one of them is dragged in circles.
    fn drag(&mut self) -> (Vec<Duration>, Vec<Duration>) {
        self.session().tool = Tool::Skeleton;
        self.session().go_to(5);
        let grasp = self.place_of("near fore fetlock");
        self.settle(grasp);
        let resting = (0..FRAMES).map(|_| self.frame(Vec::new())).collect();
        self.frame(vec![button(grasp, PointerButton::Primary, true)]);
        let dragging = (0..FRAMES).map(|i| {
            let turn = i as f32 * 0.1;
            let at = grasp + 40.0 * vec2(turn.sin(), 1.0 - turn.cos());
            self.frame(vec![Event::PointerMoved(at)])
        });
        let dragging = dragging.collect();
        assert!(self.session().is_dragging(), "the handle was not grasped");
        self.frame(vec![button(grasp, PointerButton::Primary, false)]);
        let context = self.context.clone();
        self.annotator.run(&context, Command::Undo);
        self.session().tool = Tool::Guided;
        (resting, dragging)
    }

    /// Where a handle is on the screen, as a screen reader is told.
    fn place_of(&mut self, name: &str) -> Pos2 {
        self.context.enable_accesskit();
        let screen_rect = Some(Rect::from_min_size(Pos2::ZERO, WINDOW.into()));
        let input = || RawInput { screen_rect, time: Some(self.time_s), ..RawInput::default() };
        let mut output = self.context.run_ui(input(), |ui| self.annotator.ui(ui));
        output.textures_delta.clear();
        self.context.disable_accesskit();
        let tree = output.platform_output.accesskit_update.unwrap();
        let named = |node: &&egui::accesskit::Node| {
            node.label() == Some(name) && node.role() == egui::accesskit::Role::Button
        };
        // The list has the same names: the handle is on the photograph, left of it.
        let nodes = tree.nodes.iter().map(|(_, node)| node).filter(named);
        let places = nodes
            .filter_map(egui::accesskit::Node::bounds)
            .map(|at| pos2(0.5 * (at.x0 + at.x1) as f32, 0.5 * (at.y0 + at.y1) as f32));
        places.min_by(|a, b| a.x.total_cmp(&b.x)).unwrap()
    }
}

fn button(pos: Pos2, button: PointerButton, pressed: bool) -> Event {
    Event::PointerButton { pos, button, pressed, modifiers: Modifiers::NONE }
}

/// Milliseconds below which a share of the times lies.
fn percentile(times: &[Duration], share: f64) -> f64 {
    let mut sorted: Vec<_> = times.iter().map(|time| 1e3 * time.as_secs_f64()).collect();
    sorted.sort_by(f64::total_cmp);
    sorted[((sorted.len() - 1) as f64 * share).round() as usize]
}

fn report(what: &str, times: &[Duration], most_ms: Option<f64>) {
    let [p50, p95, p99] = [0.5, 0.95, 0.99].map(|share| percentile(times, share));
    let bar = most_ms
        .map(|most| format!(" (p95 at most {most} ms: {})", if p95 <= most { "met" } else { "MISSED" }));
    println!("{what}: p50 {p50:.2} ms, p95 {p95:.2} ms, p99 {p99:.2} ms{}", bar.unwrap_or_default());
}
