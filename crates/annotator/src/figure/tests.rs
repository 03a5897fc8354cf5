//! The figure as a person meets it: in frames without a window.

use egui::{
    Color32, ColorImage, Context, Event, Modifiers, MouseWheelUnit, PointerButton, Pos2, RawInput, Rect, Vec2,
};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use glam::Vec3;
use muybridge_core::{BONE_COUNT, Database, Gait, Limb, Pose, Side, Skeleton};

use super::camera::Camera;
use super::{FigureColors, FigurePose, FigureView, NamedView, scene};

const COLORS: FigureColors = FigureColors {
    near: Color32::from_rgb(230, 120, 40),
    off: Color32::from_rgb(60, 130, 220),
    trunk: Color32::from_rgb(176, 160, 146),
};
const SIZE: [usize; 2] = [360, 260];

fn standing() -> FigurePose {
    let skeleton = Skeleton::reference();
    FigurePose { joints: Pose::standing(&skeleton).joints(&skeleton), standing: [true; 4], ghost: false }
}

fn picture(poses: &[FigurePose], yaw: f32) -> ColorImage {
    let size = glam::Vec2::new(SIZE[0] as f32, SIZE[1] as f32);
    let camera = Camera::new(Vec3::new(0.6, 1.08, 0.0), [yaw, 0.16, 1.0], 1.0, size);
    scene::render(poses, &camera, SIZE, true, &COLORS, Side::Right)
}

fn covered(picture: &ColorImage) -> usize {
    picture.pixels.iter().filter(|pixel| pixel.a() > 0).count()
}

/// Opaque pixels whose colour is nearest to a limb's: orange or blue.
fn limb_pixels(picture: &ColorImage) -> [usize; 2] {
    let opaque = || picture.pixels.iter().filter(|pixel| pixel.a() == 255);
    let margin = |a: u8, b: u8| i32::from(a) - i32::from(b);
    [
        opaque().filter(|pixel| margin(pixel.r(), pixel.b()) > 45).count(),
        opaque().filter(|pixel| margin(pixel.b(), pixel.r()) > 45).count(),
    ]
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
fn a_standing_horse_fills_a_good_part_of_the_picture_and_none_of_its_edge() {
    let picture = picture(&[standing()], 0.0);
    let share = covered(&picture) as f32 / (SIZE[0] * SIZE[1]) as f32;
    assert!((0.12..0.5).contains(&share), "{share}");
    for x in 0..SIZE[0] {
        assert_eq!(picture[(x, 0)].a(), 0, "cut off at the top at {x}");
        assert_eq!(picture[(x, SIZE[1] - 1)].a(), 0, "cut off at the bottom at {x}");
    }
}

#[test]
fn the_nearer_limbs_hide_the_farther_ones_from_either_side() {
    let right = limb_pixels(&picture(&[standing()], 0.0));
    let left = limb_pixels(&picture(&[standing()], std::f32::consts::PI));
    assert!(right[0] > 2 * right[1], "{right:?}");
    assert!(left[1] > 2 * left[0], "{left:?}");
}

#[test]
fn equal_poses_give_equal_pixels() {
    assert_eq!(picture(&[standing()], 0.7), picture(&[standing()], 0.7));
}

#[test]
fn a_ghost_is_seen_through() {
    let ghost = FigurePose { ghost: true, ..standing() };
    let alone = picture(&[ghost], 0.0);
    assert!(covered(&alone) > 500 && covered(&alone) < covered(&picture(&[standing()], 0.0)) / 2);
    assert!(alone.pixels.iter().all(|pixel| pixel.a() < 200));
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
fn a_new_pose_takes_a_few_milliseconds() {
    let database = Database::embedded();
    let stride = database.strides_of(Gait::Gallop).next().unwrap();
    let skeleton = stride.skeleton(&Skeleton::reference());
    let poses: Vec<FigurePose> = (0..12)
        .map(|i| {
            let mut pose = stride.pose(i as f32 / 12.0);
            pose.root_in_world.x = 0.0;
            FigurePose {
                joints: pose.joints(&skeleton),
                standing: stride.support(i as f32 / 12.0),
                ghost: false,
            }
        })
        .collect();
    let timed = |pose: &FigurePose| {
        let start = std::time::Instant::now();
        assert!(covered(&picture(&[*pose], 0.0)) > 5000);
        start.elapsed()
    };
    // The quickest: the others waited for something.
    let quickest = poses.iter().map(timed).min().unwrap();
    println!("a pose at {SIZE:?}: {quickest:?}");
    assert!(quickest.as_secs_f64() < 0.1);
    assert!(Limb::ALL.iter().all(|limb| poses.iter().any(|pose| pose.standing[limb.index()])));
}

#[test]
#[ignore = "writes pictures to look at into the folder FIGURE_PICTURES"]
fn pictures() {
    let Some(folder) = std::env::var_os("FIGURE_PICTURES") else { return };
    let database = Database::embedded();
    let stride = database.strides_of(Gait::Gallop).next().unwrap();
    let skeleton = stride.skeleton(&Skeleton::reference());
    let mut sheet = image::RgbImage::from_pixel(360 * 4, 260 * 4, image::Rgb([30, 30, 34]));
    let mut put = |column: usize, row: usize, drawn: &ColorImage| {
        for (i, pixel) in drawn.pixels.iter().enumerate() {
            let at = sheet.get_pixel_mut((column * 360 + i % 360) as u32, (row * 260 + i / 360) as u32);
            let over = Color32::from_rgb(at[0], at[1], at[2]).blend(*pixel);
            at.0 = [over.r(), over.g(), over.b()];
        }
    };
    let at = |phase: f32, ghost: bool| {
        let mut pose = stride.pose(phase);
        pose.root_in_world.x = 0.0;
        FigurePose { joints: pose.joints(&skeleton), standing: stride.support(phase), ghost }
    };
    for (row, yaw) in [0.0, 0.8, 1.57, 3.6].into_iter().enumerate() {
        put(0, row, &picture(&[standing()], yaw));
        put(1, row, &picture(&[at(0.05, false)], yaw));
        put(2, row, &picture(&[at(0.4, false)], yaw));
        put(3, row, &picture(&[at(0.7, false), at(0.6, true), at(0.8, true)], yaw));
    }
    sheet.save(std::path::Path::new(&folder).join("figure.png")).unwrap();
}
