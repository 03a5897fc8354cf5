//! The horse as it is seen.

use glam::{Quat, Vec2, Vec3};
use image::{Rgba, RgbaImage, imageops};
use muybridge_core::{Database, Gait, Limb, Pose, Side, Skeleton, bone};

use super::body::parts;
use super::canvas::{Canvas, Corner};
use super::frames::Frames;
use super::hoof::Hoof;
use super::terrain::Floor;
use super::{Camera, Decal, Figure, FigureColors, Scene, Terrain, Trace, Tube, render};

const COLORS: FigureColors = FigureColors {
    near: [230, 120, 40],
    off: [60, 130, 220],
    trunk: [176, 160, 146],
    ground: [120, 110, 100],
    sky: None,
};
const SIZE: [usize; 2] = [360, 260];

fn figure(pose: &Pose, skeleton: &Skeleton) -> Figure {
    Figure { joints: pose.joints(skeleton), standing: [true; 4], ghost: false }
}

fn standing() -> Figure {
    let skeleton = Skeleton::reference();
    figure(&Pose::standing(&skeleton), &skeleton)
}

fn scene<'a>(figures: &'a [Figure], terrain: Terrain<'a>) -> Scene<'a> {
    Scene {
        figures,
        tubes: &[],
        decals: &[],
        filmed: Side::Right,
        terrain,
        grid_m: 1.0,
        traces: &[],
        support_polygon: true,
        colors: &COLORS,
    }
}

fn camera(yaw: f32, size: [usize; 2]) -> Camera {
    Camera::orbit(Vec3::new(0.6, 1.08, 0.0), yaw, 0.16, 3.5, size.map(|v| v as f32))
}

/// A figure without ground.
fn picture(figures: &[Figure], yaw: f32) -> RgbaImage {
    render(&scene(figures, Terrain::Hidden), &camera(yaw, SIZE), SIZE, true)
}

fn covered(picture: &RgbaImage) -> usize {
    picture.pixels().filter(|pixel| pixel[3] > 0).count()
}

/// Opaque pixels whose colour is nearest to a limb's: orange or blue.
fn limb_pixels(picture: &RgbaImage) -> [usize; 2] {
    let opaque = || picture.pixels().filter(|pixel| pixel[3] == 255);
    let margin = |a: u8, b: u8| i32::from(a) - i32::from(b);
    [
        opaque().filter(|pixel| margin(pixel[0], pixel[2]) > 45).count(),
        opaque().filter(|pixel| margin(pixel[2], pixel[0]) > 45).count(),
    ]
}

/// A horse that bends to the left round a circle, banks, and sets its legs aside.
fn turning() -> Figure {
    let skeleton = Skeleton::reference();
    let mut pose = Pose::standing(&skeleton);
    pose.lateral_bends_rad = [0.06, 0.06, 0.08, 0.08, 0.15, 0.15, 0.12, 0.1];
    pose.world_from_root = Quat::from_rotation_x(-0.12);
    pose.abductions_rad = [0.1; 4];
    pose.limb_turns_rad = [0.15, 0.15, 0.0, 0.0];
    figure(&pose, &skeleton)
}

#[test]
fn a_standing_horse_fills_a_good_part_of_the_picture_and_none_of_its_edge() {
    let picture = picture(&[standing()], 0.0);
    let share = covered(&picture) as f32 / (SIZE[0] * SIZE[1]) as f32;
    assert!((0.12..0.5).contains(&share), "{share}");
    for x in 0..SIZE[0] as u32 {
        assert_eq!(picture.get_pixel(x, 0)[3], 0, "cut off at the top at {x}");
        assert_eq!(picture.get_pixel(x, SIZE[1] as u32 - 1)[3], 0, "cut off at the bottom at {x}");
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
fn equal_scenes_give_equal_pixels_and_a_turned_camera_and_horse_the_same_picture() {
    let plain = picture(&[turning()], 0.7);
    assert_eq!(plain, picture(&[turning()], 0.7));
    let skeleton = Skeleton::reference();
    let mut pose = Pose::standing(&skeleton);
    let turn = Quat::from_rotation_y(1.1);
    let middle = Vec3::new(0.6, 1.08, 0.0);
    pose.root_in_world = middle + turn * (pose.root_in_world - middle);
    pose.world_from_root = turn;
    let turned = picture(&[figure(&pose, &skeleton)], 0.4 + 1.1);
    let straight = picture(&[standing()], 0.4);
    let differing = turned.pixels().zip(straight.pixels()).filter(|(a, b)| a[3].abs_diff(b[3]) > 64).count();
    assert!(differing < 60, "{differing} pixels of the outline differ");
}

#[test]
fn a_part_of_the_picture_is_drawn_as_the_whole() {
    let whole = Canvas::<[u8; 4]>::new([0, 0], SIZE);
    let windows = [[0, 0], [0, 97], [31, 131]]
        .map(|from| Canvas::<[u8; 4]>::new(from, [SIZE[0] - from[0], SIZE[1] - from[1]]));
    let camera = camera(0.7, SIZE);
    let frames = Frames::of(&turning().joints).unwrap();
    let all = parts(&frames, [true; 4], &Floor(Terrain::Flat));
    let drawn = |mut canvas: Canvas<[u8; 4]>| {
        for surface in all.iter().map(|part| &part.surface) {
            let corner = |at: u32| {
                let at = at as usize;
                Corner { at: camera.project(surface.points[at]).unwrap(), value: surface.normals[at] * 99.0 }
            };
            for triangle in &surface.triangles {
                canvas.triangle(triangle.map(corner), |value| {
                    [value.x as u8, value.y as u8, value.z as u8, 255]
                });
            }
        }
        canvas
    };
    let whole = drawn(whole);
    for window in windows.map(drawn) {
        for y in 0..window.size[1] {
            let from = (y + window.from[1]) * SIZE[0] + window.from[0];
            let row = &window.pixels[y * window.size[0]..(y + 1) * window.size[0]];
            let differing = row.iter().zip(&whole.pixels[from..]).filter(|(a, b)| a != b).count();
            // Where columns are cut off, sums along a row begin elsewhere.
            assert!(differing <= if window.from[0] == 0 { 0 } else { 2 }, "{y} of {:?}", window.from);
        }
    }
}

#[test]
fn every_part_is_closed_and_faces_outwards_in_any_pose() {
    for horse in [standing(), turning()] {
        let frames = Frames::of(&horse.joints).unwrap();
        for part in parts(&frames, horse.standing, &Floor(Terrain::Flat)) {
            let surface = &part.surface;
            let corners = |t: &[u32; 3]| t.map(|i| surface.points[i as usize] - surface.points[0]);
            let volume: f32 = surface.triangles.iter().map(corners).map(|[a, b, c]| a.dot(b.cross(c))).sum();
            assert!(volume > 0.0, "{:?}", part.tones);
            let mut edges: Vec<[u32; 2]> =
                surface.triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]).collect();
            edges.sort_unstable();
            let ends = 2 * surface.points.len() / surface.tints.len().max(1);
            let open = edges.iter().filter(|&&[a, b]| edges.binary_search(&[b, a]).is_err()).count();
            // The two ends are rings of one point each.
            assert!(open <= 2 * 22 * ends, "{:?}: {open} open edges", part.tones);
            assert!(surface.points.iter().chain(&surface.normals).all(|v| v.is_finite()));
        }
    }
}

#[test]
fn the_body_follows_a_horse_that_turns() {
    let skeleton = Skeleton::reference();
    let mut pose = Pose::standing(&skeleton);
    pose.lateral_bends_rad[bone::NECK] = 0.7;
    let bent = figure(&pose, &skeleton);
    // From above, the skin of the neck is on both sides of its bones.
    let frames = Frames::of(&bent.joints).unwrap();
    let parts = parts(&frames, [true; 4], &Floor(Terrain::Flat));
    let body = &parts.last().unwrap().surface;
    let neck = frames.bone(bone::NECK + 1);
    let middle = (neck.base + neck.tip) / 2.0;
    let near = |point: &&Vec3| {
        let from = **point - middle;
        from.dot(neck.along()).abs() < 0.1 && from.dot(neck.fore).abs() < 0.12
    };
    let reach = |side: f32| {
        let across = body.points.iter().filter(near).map(|point| (*point - middle).dot(neck.across) * side);
        across.fold(0.0, f32::max)
    };
    let [right, left] = [1.0, -1.0].map(reach);
    assert!((0.07..0.16).contains(&right) && (0.07..0.16).contains(&left), "{right} {left}");
}

#[test]
fn a_standing_hoof_lies_on_the_slope_and_one_in_the_air_does_not() {
    let slope = |x: f32, _: f32| 0.3 * x;
    let skeleton = Skeleton::reference();
    let mut pose = Pose::standing(&skeleton);
    pose.world_from_root = Quat::from_rotation_z(0.3_f32.atan());
    pose.root_in_world = pose.world_from_root * pose.root_in_world;
    let horse = figure(&pose, &skeleton);
    let frames = Frames::of(&horse.joints).unwrap();
    let lowest = |joints_up: f32| {
        let mut lifted = horse;
        lifted.joints.bases.iter_mut().chain(&mut lifted.joints.tips).for_each(|at| at.y += joints_up);
        (lifted.joints.root.y, lifted.joints.dock.y) =
            (horse.joints.root.y + joints_up, horse.joints.dock.y + joints_up);
        let frames = Frames::of(&lifted.joints).unwrap();
        let hoof = Hoof::of(&frames, Limb::RF, joints_up == 0.0, &Floor(Terrain::Height(&slope))).part();
        let over = |point: &Vec3| point.y - slope(point.x, point.z);
        hoof.surface.points.iter().map(over).fold(f32::INFINITY, f32::min)
    };
    assert!(lowest(0.0).abs() < 0.03 * frames.size, "{}", lowest(0.0));
    assert!(lowest(0.5) > 0.4);
}

#[test]
fn a_ghost_is_seen_through() {
    let ghost = Figure { ghost: true, ..standing() };
    let alone = picture(&[ghost], 0.0);
    assert!(covered(&alone) > 500 && covered(&alone) < covered(&picture(&[standing()], 0.0)) / 2);
    assert!(alone.pixels().all(|pixel| pixel[3] < 200));
}

#[test]
fn the_ground_reaches_the_lower_edge_and_fades_into_the_distance() {
    let hill = |x: f32, z: f32| 0.2 * (x + z).sin();
    for terrain in [Terrain::Flat, Terrain::Height(&hill), Terrain::Stepped(&hill)] {
        let picture = render(&scene(&[standing()], terrain), &camera(0.4, SIZE), SIZE, false);
        let [width, height] = SIZE.map(|v| v as u32);
        assert!((0..width).all(|x| picture.get_pixel(x, height - 1)[3] == 255), "a hole below");
        assert!((0..width).all(|x| picture.get_pixel(x, 0)[3] == 0), "ground in the sky");
        let faint = picture.pixels().filter(|pixel| pixel[3] > 0 && pixel[3] < 255).count();
        assert!(faint > 1000, "{faint}");
    }
}

#[test]
fn a_height_function_of_zero_looks_like_the_plane() {
    let flat = |_: f32, _: f32| 0.0;
    let [plane, mesh] = [Terrain::Flat, Terrain::Height(&flat)]
        .map(|terrain| render(&scene(&[standing()], terrain), &camera(0.4, SIZE), SIZE, true));
    let differs = |(a, b): (&Rgba<u8>, &Rgba<u8>)| (0..4).any(|i| a[i].abs_diff(b[i]) > 12);
    let differing = plane.pixels().zip(mesh.pixels()).filter(|pair| differs(*pair)).count();
    assert!(differing < SIZE[0] * SIZE[1] / 100, "{differing}");
}

#[test]
fn a_hill_hides_what_is_behind_it_and_traces_are_hidden_by_the_horse() {
    let wall = |_: f32, z: f32| 2.6 * (-(z - 2.5) * (z - 2.5)).exp();
    let behind = render(&scene(&[standing()], Terrain::Height(&wall)), &camera(0.0, SIZE), SIZE, true);
    assert_eq!(limb_pixels(&behind), [0, 0]);
    let seen = |z: f32| {
        let points = [Vec3::new(-2.0, 1.3, z), Vec3::new(3.0, 1.3, z)];
        let traces = [Trace { points: &points, color: [0, 255, 0] }];
        let figures = [standing()];
        let scene = Scene { traces: &traces, ..scene(&figures, Terrain::Hidden) };
        let picture = render(&scene, &camera(0.0, SIZE), SIZE, true);
        picture.pixels().filter(|pixel| pixel[1] > 200 && pixel[0] < 80).count()
    };
    assert!(4 * seen(1.0) > 5 * seen(-1.0) && seen(-1.0) > 50, "{} {}", seen(1.0), seen(-1.0));
}

#[test]
fn tubes_are_drawn_and_hidden_like_the_horse_and_leave_a_shadow() {
    let green = |z: f32| Tube {
        points: vec![Vec3::new(-1.0, 1.2, z), Vec3::new(0.6, 1.2, z), Vec3::new(2.2, 1.2, z)],
        radii_m: vec![Vec2::splat(0.15); 3],
        up: Vec3::Y,
        color: [40, 220, 60],
    };
    let seen = |z: f32| {
        let (figures, tubes) = ([standing()], [green(z)]);
        let scene = Scene { tubes: &tubes, ..scene(&figures, Terrain::Hidden) };
        let picture = render(&scene, &camera(0.0, SIZE), SIZE, true);
        picture.pixels().filter(|pixel| pixel[1] > 90 && pixel[0] < pixel[1] / 2).count()
    };
    assert!(seen(1.0) > 3000 && 3 * seen(-0.6) < 2 * seen(1.0), "{} {}", seen(1.0), seen(-0.6));
    let ground = |tubes: &[Tube]| {
        let picture = render(&Scene { tubes, ..scene(&[], Terrain::Flat) }, &camera(0.0, SIZE), SIZE, true);
        let at = camera(0.0, SIZE).project(Vec3::new(0.9, 0.0, 0.0)).unwrap();
        picture.get_pixel(at.x as u32, at.y as u32).0[0]
    };
    let low = Tube { points: vec![Vec3::new(0.0, 0.4, 0.0), Vec3::new(1.2, 0.4, 0.0)], ..green(0.0) };
    assert!(ground(&[low]) + 10 < ground(&[]));
}

#[test]
fn a_print_is_painted_on_the_ground_inside_its_outline_only() {
    // A horseshoe: its middle is open towards X.
    let outline =
        [(0.0, -0.5), (1.0, -0.5), (1.0, -0.3), (0.3, -0.3), (0.3, 0.3), (1.0, 0.3), (1.0, 0.5), (0.0, 0.5)];
    let mut points: Vec<Vec3> = outline.map(|(x, z)| Vec3::new(x, 0.3, z)).to_vec();
    points.insert(3, Vec3::NAN);
    let step = |_: f32, _: f32| 0.3;
    let camera = Camera::orbit(Vec3::new(0.5, 0.3, 0.0), 0.0, 1.4, 2.0, SIZE.map(|v| v as f32));
    for terrain in [Terrain::Height(&step), Terrain::Stepped(&step)] {
        let decals = [Decal { points: points.clone(), color: [255, 0, 0] }];
        let bare = render(&scene(&[], terrain), &camera, SIZE, true);
        let scene = Scene { decals: &decals, ..scene(&[], terrain) };
        let picture = render(&scene, &camera, SIZE, true);
        let is_painted = |x: f32, z: f32| {
            let at = camera.project(Vec3::new(x, 0.3, z)).unwrap();
            picture.get_pixel(at.x as u32, at.y as u32) != bare.get_pixel(at.x as u32, at.y as u32)
        };
        assert!(is_painted(0.15, 0.1) && is_painted(0.7, -0.4) && is_painted(0.7, 0.4));
        assert!(!is_painted(0.7, 0.1) && !is_painted(-0.1, 0.1) && !is_painted(1.2, 0.4));
    }
}

#[test]
fn the_edge_of_a_step_is_where_it_is() {
    let stairs = |x: f32, _: f32| (x / 0.3).floor().clamp(0.0, 6.0) * 0.2;
    let size = [480, 360];
    let camera = Camera::orbit(Vec3::new(0.9, 0.6, 0.0), -0.9, 0.5, 4.0, size.map(|v| v as f32));
    let picture = render(&scene(&[], Terrain::Stepped(&stairs)), &camera, size, true);
    let value = |x: f32, y: f32, z: f32| {
        let at = camera.project(Vec3::new(x, y, z)).unwrap();
        picture.get_pixel(at.x as u32, at.y as u32)[0]
    };
    for step in 1..6 {
        let (edge, height) = (0.3 * step as f32, 0.2 * step as f32);
        for z in [-0.23, 0.31] {
            let (tread, riser) = (value(edge + 0.05, height, z), value(edge, height - 0.1, z));
            assert!(tread > riser + 15, "step {step}: tread {tread}, riser {riser}");
        }
    }
}

#[test]
fn what_is_no_number_and_pictures_of_no_size_do_no_harm() {
    let hole = |x: f32, _: f32| if x > 0.0 { f32::NAN } else { 0.0 };
    let mut broken = standing();
    broken.joints.tips[20].y = f32::NAN;
    let points = [Vec3::ZERO, Vec3::NAN, Vec3::X, Vec3::splat(1e30)];
    let traces = [Trace { points: &points, color: [0; 3] }];
    for figures in [vec![broken], vec![broken, standing()], vec![]] {
        for size in [[0, 0], [0, 7], [7, 0], [1, 1], [90, 70]] {
            let terrain = if size[0] > 1 { Terrain::Height(&hole) } else { Terrain::Stepped(&hole) };
            let scene = Scene { traces: &traces, grid_m: f32::NAN, ..scene(&figures, terrain) };
            let drawn = render(&scene, &camera(0.3, size.map(|v: usize| v.max(1))), size, true);
            assert_eq!(drawn.dimensions(), (size[0] as u32, size[1] as u32));
        }
    }
}

#[test]
fn the_body_keeps_to_its_budget() {
    let frames = Frames::of(&standing().joints).unwrap();
    let all = parts(&frames, [true; 4], &Floor(Terrain::Flat));
    let triangles: usize = all.iter().map(|part| part.surface.triangles.len()).sum();
    assert!((4_000..8_000).contains(&triangles), "{triangles}");
    let timed = || {
        let start = std::time::Instant::now();
        assert!(covered(&picture(&[standing()], 0.0)) > 5000);
        start.elapsed()
    };
    // The quickest: the others waited for something.
    let quickest = (0..8).map(|_| timed()).min().unwrap();
    println!("a picture of {SIZE:?}: {quickest:?}");
    assert!(quickest.as_secs_f64() < 0.1);
}

#[test]
#[ignore = "writes pictures to look at into the folder FIGURE_PICTURES"]
fn pictures() {
    let Some(folder) = std::env::var_os("FIGURE_PICTURES") else { return };
    let size = [480, 360];
    let hill = |x: f32, z: f32| 0.5 * (0.4 * x).sin() * (0.3 * z).cos();
    let database = Database::embedded();
    let gallop = database.strides_of(Gait::Gallop).next().unwrap();
    let skeleton = gallop.skeleton(&Skeleton::reference());
    let mut poses = vec![standing(), turning()];
    poses.extend([0.05, 0.4, 0.7].map(|phase| {
        let mut pose = gallop.pose(phase);
        pose.root_in_world.x = 0.0;
        Figure { standing: gallop.support(phase), ..figure(&pose, &skeleton) }
    }));
    let colors = FigureColors::default();
    let mut sheet = RgbaImage::new(4 * size[0] as u32, 5 * size[1] as u32);
    for (row, pose) in poses.iter().enumerate() {
        for (column, (yaw, is_hilly)) in
            [(0.0, false), (0.8, false), (-1.57, true), (3.6, true)].into_iter().enumerate()
        {
            let terrain = if is_hilly { Terrain::Height(&hill) } else { Terrain::Flat };
            let figures = [*pose];
            let scene = Scene { colors: &colors, ..scene(&figures, terrain) };
            let drawn = render(&scene, &camera(yaw, size), size, true);
            imageops::replace(&mut sheet, &drawn, (column * size[0]) as i64, (row * size[1]) as i64);
        }
    }
    sheet.save(std::path::Path::new(&folder).join("figure.png")).unwrap();
}
