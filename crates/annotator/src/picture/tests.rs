//! Drawing in frames without a window, and counting what is uploaded.

use egui::{Context, Mesh, Pos2, RawInput, Rect, Shape, Vec2, pos2};
use image::{Rgb, RgbImage};

use super::{Adjustment, Look, PlateTextures, Pyramid, Source, ViewTransform};

/// The harness' own limit.
const MOST_TEXTURE_SIDE: usize = 2048;
const SCREEN: Rect = Rect { min: Pos2::ZERO, max: pos2(1000.0, 700.0) };

/// What one frame did.
struct Frame {
    /// Sizes of the uploaded tiles.
    uploads: Vec<[usize; 2]>,
    freed: usize,
    meshes: Vec<Mesh>,
    wants_another: bool,
}

fn frame(ctx: &Context, draw: impl FnMut(&egui::Painter)) -> Frame {
    let mut draw = draw;
    let input = RawInput {
        screen_rect: Some(SCREEN),
        max_texture_side: Some(MOST_TEXTURE_SIDE),
        ..Default::default()
    };
    let mut output = ctx.run_ui(input, |ui| draw(&ui.painter().with_clip_rect(SCREEN)));
    let size = |delta: &egui::epaint::ImageDelta| delta.image.size();
    let mut uploads = std::mem::take(&mut output.textures_delta.set);
    // The fonts.
    uploads.remove(&egui::TextureId::default());
    let uploads = uploads.values().flatten().map(size).collect();
    let freed = std::mem::take(&mut output.textures_delta.free).len();
    let wants_another = output.viewport_output.values().any(|v| v.repaint_delay.is_zero());
    let meshes = output.shapes.into_iter().filter_map(|clipped| match clipped.shape {
        Shape::Mesh(mesh) => Some(std::sync::Arc::unwrap_or_clone(mesh)),
        _ => None,
    });
    Frame { uploads, freed, meshes: meshes.collect(), wants_another }
}

/// Frames until nothing else is to come.
fn settle(ctx: &Context, mut draw: impl FnMut(&egui::Painter)) -> Vec<Frame> {
    let mut frames = vec![frame(ctx, &mut draw)];
    while !frames.last().unwrap().uploads.is_empty() {
        assert!(frames.len() < 200, "never ends");
        frames.push(frame(ctx, &mut draw));
    }
    frames
}

fn area(frame: &Frame) -> f64 {
    let cross = |a: Pos2, b: Pos2, c: Pos2| {
        let (ab, ac) = (b - a, c - a);
        f64::from(ab.x * ac.y - ab.y * ac.x).abs() / 2.0
    };
    let of_mesh = |mesh: &Mesh| -> f64 {
        mesh.triangles()
            .map(|[a, b, c]| [a, b, c].map(|i| mesh.vertices[i as usize].pos))
            .map(|[a, b, c]| cross(a, b, c))
            .sum()
    };
    frame.meshes.iter().map(of_mesh).sum()
}

fn pyramid(width: u32, height: u32) -> Pyramid {
    Pyramid::new(RgbImage::from_fn(width, height, |x, y| Rgb([(x / 16) as u8, (y / 16) as u8, 50])))
}

#[test]
fn only_what_is_seen_is_uploaded_and_little_of_it_in_one_frame() {
    let (ctx, plate, mut textures) = (Context::default(), pyramid(4000, 3000), PlateTextures::default());
    let source = Source { image: 0, pyramid: &plate };
    // At two pixels a plate px the screen shows 500 x 350 px: four tiles at most, and the coarsest level.
    let view = ViewTransform { zoom: 2.0, origin: [0.0, 0.0] }.with_at([2000.0, 1500.0], SCREEN.center());
    let frames = settle(&ctx, |painter| textures.draw(painter, source, &view, Look::default()));
    let uploads: usize = frames.iter().map(|frame| frame.uploads.len()).sum();
    assert!((2..=5).contains(&uploads), "{uploads}");
    // Fitted, the matching level is 1000 x 750.
    let view = ViewTransform::fit_whole(plate.size_px(), SCREEN);
    let frames = settle(&ctx, |painter| textures.draw(painter, source, &view, Look::default()));
    let uploads: usize = frames.iter().map(|frame| frame.uploads.len()).sum();
    assert_eq!(uploads, 4);
    // 1333 x 933 px at 0.75: six tiles of level 0, in more than one frame.
    let view = ViewTransform { zoom: 0.75, origin: [0.0, 0.0] };
    let mut largest = 0;
    let frames = settle(&ctx, |painter| textures.draw(painter, source, &view, Look::default()));
    for frame in &frames {
        let bytes: usize = frame.uploads.iter().map(|[w, h]| w * h * 4).sum();
        largest = largest.max(bytes);
        assert!(frame.uploads.iter().flatten().all(|&side| side <= 512), "{:?}", frame.uploads);
        assert!((area(frame) - 1000.0 * 700.0).abs() < 1.0, "no hole while tiles are to come");
    }
    assert!(largest <= 4 << 20 && frames.len() > 2, "{largest} bytes, {} frames", frames.len());
    assert!(frames[0].wants_another && frames.last().unwrap().meshes.len() == 6);
}

#[test]
fn the_first_frame_already_shows_the_whole_plate_and_a_settled_one_uploads_nothing() {
    let (ctx, plate, mut textures) = (Context::default(), pyramid(5000, 3500), PlateTextures::default());
    let source = Source { image: 0, pyramid: &plate };
    let view = ViewTransform::fit_whole(plate.size_px(), SCREEN);
    let mut draw = |painter: &egui::Painter| textures.draw(painter, source, &view, Look::default());
    let first = frame(&ctx, &mut draw);
    assert!((area(&first) - 1000.0 * 700.0).abs() < 1.0);
    settle(&ctx, &mut draw);
    let later = frame(&ctx, &mut draw);
    assert!(later.uploads.is_empty() && !later.meshes.is_empty());
}

#[test]
fn what_is_long_unused_is_given_back_and_comes_again() {
    let (ctx, plate) = (Context::default(), pyramid(4000, 3000));
    let mut textures = PlateTextures::default();
    textures.most_bytes = 8 << 20;
    let source = Source { image: 0, pyramid: &plate };
    let at = |x: f64| ViewTransform { zoom: 1.0, origin: [0.0, 0.0] }.with_at([x, 1500.0], SCREEN.center());
    let mut freed = 0;
    for x in [500.0, 2000.0, 3500.0, 500.0] {
        let frames = settle(&ctx, |painter| textures.draw(painter, source, &at(x), Look::default()));
        assert!(frames[0].uploads.len() > 1);
        freed += frames.iter().map(|frame| frame.freed).sum::<usize>();
        assert!(textures.resident_bytes() <= 10 << 20, "{}", textures.resident_bytes());
    }
    assert!(freed > 6, "{freed}");
}

#[test]
fn an_adjustment_replaces_what_is_seen_over_some_frames() {
    let (ctx, plate, mut textures) = (Context::default(), pyramid(4000, 3000), PlateTextures::default());
    let source = Source { image: 0, pyramid: &plate };
    let view = ViewTransform { zoom: 0.75, origin: [0.0, 0.0] };
    settle(&ctx, |painter| textures.draw(painter, source, &view, Look::default()));
    let resident = textures.resident_bytes();
    textures.set_adjustment(Adjustment { gamma: 2.0, ..Adjustment::default() });
    let frames = settle(&ctx, |painter| textures.draw(painter, source, &view, Look::default()));
    assert!(frames.len() > 2 && frames[0].wants_another);
    assert_eq!(frames.iter().map(|frame| frame.uploads.len()).sum::<usize>(), 7);
    assert_eq!(textures.resident_bytes(), resident, "replaced, not added");
    // A slider that never rests still gets to every tile.
    let mut seen = 0;
    for step in 0..6 {
        textures.set_adjustment(Adjustment { gamma: 2.0 + step as f32 * 0.1, ..Adjustment::default() });
        seen += frame(&ctx, |p| textures.draw(p, source, &view, Look::default())).uploads.len();
    }
    assert!(seen >= 18, "{seen}");
}

#[test]
fn pixels_are_squares_when_magnified() {
    let (ctx, plate, mut textures) = (Context::default(), pyramid(900, 700), PlateTextures::default());
    let source = Source { image: 0, pyramid: &plate };
    let filters = |zoom: f64, textures: &mut PlateTextures| {
        let view = ViewTransform { zoom, origin: [0.0, 0.0] };
        let frames = settle(&ctx, |painter| textures.draw(painter, source, &view, Look::default()));
        let id = frames.last().unwrap().meshes[0].texture_id;
        ctx.tex_manager().read().meta(id).unwrap().options
    };
    assert_eq!(filters(2.0, &mut textures), egui::TextureOptions::LINEAR);
    assert_eq!(filters(8.0, &mut textures), egui::TextureOptions::NEAREST);
}

#[test]
fn any_size_and_any_view_is_drawn_without_harm() {
    let ctx = Context::default();
    let views = [
        ViewTransform { zoom: 64.0, origin: [3.0, 3.0] },
        ViewTransform { zoom: 1e-9, origin: [500.0, 300.0] },
        ViewTransform { zoom: f64::NAN, origin: [0.0, 0.0] },
        ViewTransform { zoom: 1e300, origin: [-1e300, f64::INFINITY] },
        ViewTransform { zoom: 0.02, origin: [-20.0, 300.0] },
    ];
    for (width, height) in [(0, 0), (1, 1), (60_000, 10), (3, 9000), (510, 510), (511, 1020)] {
        let (plate, mut textures) = (Pyramid::new(RgbImage::new(width, height)), PlateTextures::default());
        let source = Source { image: 0, pyramid: &plate };
        for view in &views {
            settle(&ctx, |painter| textures.draw(painter, source, view, Look::default()));
        }
        let quad = [[0.0, 0.0], [5.0, 0.0], [1.0, 1.0], [0.0, 4.0]];
        for into in [SCREEN, Rect::NOTHING, Rect::NAN, Rect::EVERYTHING] {
            settle(&ctx, |painter| textures.draw_quad(painter, source, quad, into, Look::default()));
        }
    }
}

#[test]
fn a_panel_is_squared_up_with_its_perspective() {
    let (ctx, plate, mut textures) = (Context::default(), pyramid(2000, 1500), PlateTextures::default());
    let source = Source { image: 0, pyramid: &plate };
    let quad = [[300.0, 200.0], [900.0, 230.0], [860.0, 640.0], [330.0, 600.0]];
    let into = Rect::from_min_size(pos2(20.0, 30.0), Vec2::new(600.0, 400.0));
    let frames = settle(&ctx, |painter| textures.draw_quad(painter, source, quad, into, Look::default()));
    let last = frames.last().unwrap();
    assert!((area(last) - 240_000.0).abs() < 1.0, "the rectangle is filled: {}", area(last));
    // The panel is in the tiles of rows 0 and 1, columns 0 and 1, and in no others.
    assert_eq!(last.meshes.len(), 4);
    let transform = muybridge_imaging::PanelTransform::new(quad, [600.0, 400.0]).unwrap();
    let first = &last.meshes[0];
    for vertex in &first.vertices {
        let [x, y] =
            transform.plate_from_panel([f64::from(vertex.pos.x) - 20.0, f64::from(vertex.pos.y) - 30.0]);
        // The first tile's texture begins one texel before the plate.
        let [u, v] = [f64::from(vertex.uv.x) * 512.0 - 1.0, f64::from(vertex.uv.y) * 512.0 - 1.0];
        assert!((x - u).hypot(y - v) < 0.5, "{x} {y} {u} {v}");
    }
}

#[test]
fn a_ghost_is_laid_where_the_map_says_and_only_its_panel() {
    let (ctx, plate, mut textures) = (Context::default(), pyramid(2000, 1500), PlateTextures::default());
    let source = Source { image: 0, pyramid: &plate };
    let quad = [[100.0, 100.0], [400.0, 100.0], [400.0, 300.0], [100.0, 300.0]];
    let map = |[x, y]: [f64; 2]| pos2((2.0 * x - 0.3 * y) as f32, (0.3 * x + 2.0 * y) as f32);
    let look = Look { opacity: 0.5, ..Look::default() };
    let drawn = frame(&ctx, |painter| textures.draw_mapped(painter, source, quad, map, look));
    let expected = 300.0 * 200.0 * (4.0 + 0.09);
    assert!((area(&drawn) - expected).abs() < 2000.0, "{} {expected}", area(&drawn));
    assert!(drawn.meshes[0].vertices.iter().all(|vertex| vertex.color.a() == 128));
}

#[test]
fn a_frame_that_uploads_all_it_may_takes_a_few_milliseconds() {
    let (ctx, plate, mut textures) = (Context::default(), pyramid(4000, 3000), PlateTextures::default());
    let source = Source { image: 0, pyramid: &plate };
    let view = ViewTransform { zoom: 0.75, origin: [0.0, 0.0] };
    frame(&ctx, |_| ());
    let mut longest = std::time::Duration::ZERO;
    settle(&ctx, |painter| {
        let start = std::time::Instant::now();
        textures.draw(painter, source, &view, Look::default());
        longest = longest.max(start.elapsed());
    });
    println!("longest drawing with uploads: {longest:?}");
    assert!(longest.as_secs_f64() < 0.1, "{longest:?}");
}
