//! The figure as a person meets it: in frames without a window.

use egui::{Context, Event, Modifiers, MouseWheelUnit, PointerButton, Pos2, RawInput, Rect, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use glam::Vec3;
use muybridge_core::{BONE_COUNT, Pose, Side, Skeleton};
use muybridge_imaging::figure::{Terrain, Trace};

use super::{FigureColors, FigurePose, FigureView, Follow, NamedView, SceneParts};

const COLORS: FigureColors = FigureColors {
    near: [230, 120, 40],
    off: [60, 130, 220],
    trunk: [176, 160, 146],
    ground: [90, 90, 90],
    sky: None,
};

fn standing() -> FigurePose {
    let skeleton = Skeleton::reference();
    FigurePose { joints: Pose::standing(&skeleton).joints(&skeleton), standing: [true; 4], ghost: false }
}

fn frame(
    ctx: &Context,
    events: Vec<Event>,
    view: &mut FigureView,
    size: Vec2,
    poses: &[FigurePose],
) -> usize {
    let input = RawInput {
        screen_rect: Some(Rect::from_min_size(Pos2::ZERO, Vec2::new(500.0, 400.0))),
        events,
        ..Default::default()
    };
    let mut output = ctx.run_ui(input, |ui| _ = view.ui(ui, size, poses, &COLORS));
    let mut uploads = std::mem::take(&mut output.textures_delta.set);
    output.textures_delta.free.clear();
    // The fonts.
    uploads.remove(&egui::TextureId::default());
    uploads.len()
}

#[test]
fn poses_of_no_numbers_and_sizes_of_nothing_do_no_harm() {
    let (ctx, mut view) = (Context::default(), FigureView::new(Side::Left));
    let mut poses = Vec::new();
    for bad in [f32::NAN, f32::INFINITY, 1e30] {
        let mut pose = standing();
        pose.joints.tips[20].y = bad;
        poses.push(pose);
    }
    let mut flat = standing();
    flat.joints.bases = [Vec3::ZERO; BONE_COUNT];
    flat.joints.tips = [Vec3::ZERO; BONE_COUNT];
    flat.joints.root = Vec3::ZERO;
    assert_eq!(frame(&ctx, vec![], &mut view, Vec2::new(360.0, 260.0), &poses[..2]), 0);
    poses.push(flat);
    poses.push(standing());
    for size in [Vec2::ZERO, Vec2::new(0.5, 300.0), Vec2::new(1.0, 1.0), Vec2::NAN, Vec2::new(9000.0, 20.0)] {
        frame(&ctx, vec![], &mut view, size, &poses);
    }
    (view.yaw, view.pitch, view.zoom) = (f32::NAN, f32::INFINITY, -3.0);
    frame(&ctx, vec![], &mut view, Vec2::new(360.0, 260.0), &poses);
    assert!(view.yaw.is_finite() && view.pitch.is_finite() && view.zoom > 0.0);
}

#[test]
fn idle_costs_nothing_and_dragging_turns() {
    let (ctx, mut view, size) = (Context::default(), FigureView::new(Side::Right), Vec2::new(360.0, 260.0));
    let poses = [standing()];
    let mut run = |events| (frame(&ctx, events, &mut view, size, &poses), view.yaw, view.zoom);
    assert_eq!(run(vec![]).0, 1);
    assert_eq!(run(vec![]).0, 0, "nothing has changed");
    let at = Pos2::new(200.0, 100.0);
    let press = |pressed| Event::PointerButton {
        pos: at,
        button: PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    };
    run(vec![Event::PointerMoved(at)]);
    run(vec![press(true)]);
    run(vec![Event::PointerMoved(at + Vec2::new(60.0, 0.0))]);
    let yaw = run(vec![]).1;
    let turned = std::f32::consts::TAU - 60.0 * std::f32::consts::PI / 300.0;
    assert!((yaw - turned).abs() < 1e-3, "the near side follows the pointer: {yaw}");
    run(vec![press(false)]);
    let wheel = Event::MouseWheel {
        unit: MouseWheelUnit::Point,
        delta: Vec2::new(0.0, 50.0),
        modifiers: Modifiers::NONE,
        phase: egui::TouchPhase::Move,
        source: egui::MouseWheelSource::Unknown,
    };
    run(vec![wheel]);
    for _ in 0..20 {
        run(vec![]);
    }
    assert!(run(vec![]).2 > 1.02);
}

#[test]
fn each_named_view_is_of_the_filmed_side() {
    for filmed in [Side::Left, Side::Right] {
        let mut view = FigureView::new(filmed);
        let toward = |view: &FigureView| (view.yaw.sin(), view.yaw.cos());
        let side = if filmed == Side::Right { 1.0 } else { -1.0 };
        assert!((toward(&view).1 - side).abs() < 1e-6);
        view.look(NamedView::ThreeQuarter);
        assert!(toward(&view).0 > 0.5 && toward(&view).1 * side > 0.5);
        view.look(NamedView::Front);
        assert!((toward(&view).0 - 1.0).abs() < 1e-6);
    }
}

#[test]
fn the_buttons_are_found_by_name_and_go_to_their_views() {
    let mut harness = Harness::new_ui_state(
        |ui, view: &mut FigureView| _ = view.ui(ui, Vec2::new(360.0, 260.0), &[standing()], &COLORS),
        FigureView::new(Side::Left),
    );
    harness.get_by_label("Front view of the figure").click();
    harness.run();
    assert!((harness.state().yaw - std::f32::consts::FRAC_PI_2).abs() < 1e-6);
    harness.get_by_label("Side view of the figure").click();
    harness.run();
    assert!((harness.state().yaw - std::f32::consts::PI).abs() < 1e-6);
    assert!(harness.query_by_label_contains("drag to turn").is_some());
}

#[test]
fn the_view_turns_with_the_horse_and_stays_above_the_ground() {
    let (ctx, mut view) = (Context::default(), FigureView::new(Side::Right));
    let steep = |x: f32, _: f32| -x;
    let way = [Vec3::ZERO, Vec3::X];
    let traces = [Trace { points: &way, color: [200; 3] }];
    let figures = [standing()];
    let parts = SceneParts {
        figures: &figures,
        tubes: &[],
        decals: &[],
        terrain: Terrain::Height(&steep),
        terrain_version: 1,
        grid_m: 1.0,
        traces: &traces,
        support_polygon: true,
        colors: &COLORS,
        follow: Follow { at: Vec3::ZERO, heading_rad: 0.0, size: 1.0 },
    };
    view.look(NamedView::Follow);
    let camera = |view: &FigureView, heading_rad: f32| {
        view.camera_of(&SceneParts { follow: Follow { heading_rad, ..parts.follow }, ..parts }, [300, 200])
    };
    let eye = camera(&view, 0.0).eye();
    assert!(eye.x < -1.0 && eye.y > -eye.x, "behind the horse and above the hill: {eye}");
    let eye = camera(&view, std::f32::consts::FRAC_PI_2).eye();
    assert!(eye.z > 5.0 && eye.x.abs() < 0.5, "a horse that faces -Z is seen from +Z: {eye}");
    let mut uploads = |version: u64| {
        let input = RawInput {
            screen_rect: Some(Rect::from_min_size(Pos2::ZERO, Vec2::splat(400.0))),
            ..Default::default()
        };
        let parts = SceneParts { terrain_version: version, ..parts };
        let mut output = ctx.run_ui(input, |ui| _ = view.ui_scene(ui, Vec2::new(300.0, 200.0), &parts));
        let mut uploads = std::mem::take(&mut output.textures_delta.set);
        output.textures_delta.free.clear();
        uploads.remove(&egui::TextureId::default());
        uploads.len()
    };
    assert_eq!([uploads(1), uploads(1), uploads(2)], [1, 0, 1], "drawn anew for another terrain only");
}
