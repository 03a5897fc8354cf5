//! Specimens: what the truth says is what the picture shows, and the documents made from it calibrate to the same cameras.

#![allow(clippy::unwrap_used, reason = "a test stops at the first thing it cannot do")]

use image::GrayImage;
use muybridge_capture::{
    BodyPoint, Facing, Keypoint, KeypointState, NearOff, Plate, StanceLabel, calibrate, hash_file,
    write_atomically, write_json,
};
use muybridge_core::Pair;
use muybridge_imaging::PanelTransform;
use muybridge_imaging::specimen::{
    Grid, Hurdle, Mount, NOTICE, PanelTruth, Specimen, SpecimenStyle, SpecimenTruth, draw, encode, swung_legs,
};

/// A plate without blur, grain and scratches.
fn clean() -> SpecimenStyle {
    SpecimenStyle {
        blur_px: 0.0,
        grain_sd: 0.0,
        scratches: 0,
        light_falloff: 0.0,
        ..SpecimenStyle::default()
    }
}

fn px(picture: &GrayImage, [x, y]: [f64; 2]) -> f64 {
    f64::from(picture.get_pixel(x as u32, y as u32).0[0])
}

fn withers_px(panel: &PanelTruth) -> f64 {
    1.6 * panel.camera.px_per_m
}

fn place(panel: &PanelTruth, keypoint: Keypoint) -> [f64; 2] {
    panel.keypoints.place(keypoint).unwrap_or([f64::NAN; 2])
}

#[test]
fn equal_seeds_give_equal_bytes_and_others_do_not() {
    let motion = swung_legs(6, Facing::Right);
    let draw_seed =
        |seed| encode(&draw(&motion, &SpecimenStyle { seed, rows: 2, ..SpecimenStyle::default() }));
    assert_eq!(draw_seed(3), draw_seed(3));
    assert_ne!(draw_seed(3), draw_seed(4));
}

#[test]
fn a_committed_plate_is_small_and_says_what_it_is() {
    for (style, facing) in [
        (SpecimenStyle::default(), Facing::Right),
        (SpecimenStyle::animal_locomotion(), Facing::Left),
        (SpecimenStyle::dark_wall(), Facing::Right),
    ] {
        let specimen = draw(&swung_legs(12, facing), &SpecimenStyle { rider: true, ..style });
        let bytes = encode(&specimen);
        assert!((20_000..250_000).contains(&bytes.len()), "{} bytes", bytes.len());
        assert!(specimen.truth.printed.iter().any(|line| line == NOTICE));
        assert!(specimen.truth.statement.contains("not a photograph"));
        let text = serde_json::to_string(&specimen.truth).unwrap();
        let read: SpecimenTruth = serde_json::from_str(&text).unwrap();
        assert_eq!(read.panels[7].keypoints, specimen.truth.panels[7].keypoints);
        let read = image::load_from_memory(&bytes).unwrap();
        assert_eq!([read.width(), read.height()], specimen.truth.size_px);
    }
}

#[test]
fn keypoints_of_the_topline_lie_on_the_outline() {
    for facing in [Facing::Left, Facing::Right] {
        let specimen = draw(&swung_legs(12, facing), &clean());
        for (panel, silhouette) in specimen.truth.panels.iter().zip(&specimen.silhouettes) {
            let up = panel.camera.up;
            for point in [BodyPoint::Croup, BodyPoint::Back, BodyPoint::Withers] {
                let [x, y] = place(panel, Keypoint::Body(point));
                let off = |by: f64| silhouette.at([x + by * up[0], y + by * up[1]]);
                // The mane reaches a little over the withers.
                let clear = 0.03 * withers_px(panel);
                assert!(off(-1.5) > 200 && off(clear) < 50, "panel {} {point:?}", panel.camera.panel);
            }
        }
    }
}

#[test]
fn toes_touch_the_ground_line_in_stance() {
    let specimen = draw(&swung_legs(12, Facing::Right), &clean());
    for (panel, silhouette) in specimen.truth.panels.iter().zip(&specimen.silhouettes) {
        for pair in [Pair::Fore, Pair::Hind] {
            if panel.contacts.of(NearOff::Near, pair) != StanceLabel::Stance {
                continue;
            }
            let [x, y] = place(panel, Keypoint::hoof(NearOff::Near, pair));
            // Half a hoof behind the toe and a little over the sole.
            assert!(silhouette.at([x - 2.0, y - 1.0]) > 100, "panel {} {pair:?}", panel.camera.panel);
            let [[ax, ay], [bx, by]] = panel.ground_px;
            let ground_y = ay + (by - ay) * (x - ax) / (bx - ax);
            assert!(y < ground_y + 0.5);
        }
    }
}

#[test]
fn the_trunk_hides_the_off_side_and_the_rider_the_withers() {
    let bare = draw(&swung_legs(12, Facing::Left), &SpecimenStyle::default());
    let ridden =
        draw(&swung_legs(12, Facing::Left), &SpecimenStyle { rider: true, ..SpecimenStyle::default() });
    let state = |specimen: &Specimen, panel: usize, name: &str| {
        specimen.truth.panels[panel].keypoints.get(Keypoint::from_name(name).unwrap()).unwrap().state
    };
    for panel in 0..12 {
        for name in ["off_hip", "off_shoulder"] {
            assert_eq!(state(&bare, panel, name), KeypointState::Occluded, "panel {panel} {name}");
        }
        for name in ["near_hip", "near_knee", "croup", "withers", "muzzle", "dock"] {
            assert_eq!(state(&bare, panel, name), KeypointState::Visible, "panel {panel} {name}");
        }
    }
    let hooves = ["off_fore_hoof", "off_hind_hoof"]
        .map(|name| (0..12).filter(|panel| state(&bare, *panel, name) == KeypointState::Visible).count());
    assert!(hooves.iter().all(|visible| *visible >= 8), "{hooves:?} of 12");
    let hidden = |specimen: &Specimen| {
        let all = specimen.truth.panels.iter().flat_map(|panel| panel.keypoints.iter());
        all.filter(|(_, placed)| placed.state == KeypointState::Occluded).count()
    };
    assert!(hidden(&ridden) > hidden(&bare));
}

#[test]
fn uprights_and_grid_are_where_the_truth_says() {
    let style = SpecimenStyle { tilt_deg: 1.5, ..clean() };
    let specimen = draw(&swung_legs(12, Facing::Left), &style);
    for panel in &specimen.truth.panels {
        assert!(panel.uprights.len() >= 3);
        for upright in &panel.uprights {
            let [foot, top] = upright.ends_px;
            // Above the horse, just under the number band.
            let at = [0, 1].map(|i| 0.08 * foot[i] + 0.92 * top[i]);
            if silhouette_near(&specimen, panel, at) {
                continue;
            }
            let darkness = |x: f64| (style.tones.wall - px(&specimen.picture, [x, at[1]])).max(0.0);
            let columns: Vec<f64> = (-3..=3).map(|i| at[0].floor() + 0.5 + f64::from(i)).collect();
            let dark: Vec<f64> =
                columns.iter().map(|x| if darkness(*x) > 20.0 { darkness(*x) } else { 0.0 }).collect();
            let sum: f64 = dark.iter().sum();
            let centre = columns.iter().zip(&dark).map(|(x, d)| x * d).sum::<f64>() / sum;
            assert!((centre - at[0]).abs() < 0.5, "panel {}: {centre} {}", panel.camera.panel, at[0]);
        }
    }
}

fn silhouette_near(specimen: &Specimen, panel: &PanelTruth, [x, y]: [f64; 2]) -> bool {
    let silhouette = &specimen.silhouettes[panel.camera.panel as usize - 1];
    (-8..=8).any(|i| silhouette.at([x + f64::from(i), y]) > 0)
}

#[test]
fn a_silhouette_is_the_dark_part_of_a_bare_wall() {
    let style = SpecimenStyle {
        grid: Grid::None,
        upright_numbers: false,
        numbers: false,
        upright_width_m: 0.0,
        ..clean()
    };
    let specimen = draw(&swung_legs(12, Facing::Right), &style);
    let (mut both, mut either) = (0, 0);
    for (panel, silhouette) in specimen.truth.panels.iter().zip(&specimen.silhouettes) {
        let foot_y = panel.wall_foot_px.unwrap()[0][1].min(panel.wall_foot_px.unwrap()[1][1]) as u32;
        for y in silhouette.top_px + 8..foot_y - 3 {
            for x in silhouette.left_px + 8..silhouette.left_px + silhouette.mask.width() - 8 {
                let at = [f64::from(x) + 0.5, f64::from(y) + 0.5];
                let column = panel.uprights.iter().any(|u| (u.ends_px[0][0] - at[0]).abs() < 6.0);
                let (drawn, dark) = (silhouette.at(at) > 127, px(&specimen.picture, at) < 115.0);
                both += u32::from(drawn && dark && !column);
                either += u32::from((drawn || dark) && !column);
            }
        }
    }
    let overlap = f64::from(both) / f64::from(either);
    assert!(overlap > 0.98, "{overlap}");
}

#[test]
fn documents_load_and_calibrate_to_the_cameras_that_drew_the_plate() {
    for (facing, style) in [
        (Facing::Right, SpecimenStyle { tilt_deg: -2.0, rider: true, ..SpecimenStyle::default() }),
        (Facing::Left, SpecimenStyle { first_axis_mark: 2.4, ..SpecimenStyle::dark_wall() }),
    ] {
        let mut motion = swung_legs(12, facing);
        motion.hurdle = Some(Hurdle { x_m: 1.0, height_m: 0.6 });
        let specimen = draw(&motion, &style);
        let folder = tempfile::tempdir().unwrap();
        let picture = folder.path().join("specimen.jpg");
        write_atomically(&picture, &encode(&specimen)).unwrap();
        let sha256 = hash_file(&picture).unwrap().to_string();
        let manifest = specimen.truth.manifest("specimen", "specimen.jpg", &sha256);
        write_json(&folder.path().join("specimen.json"), &manifest).unwrap();
        let annotation = specimen.truth.annotation("specimen.json", &sha256);
        write_json(&folder.path().join("annotation.json"), &annotation).unwrap();
        let plate = Plate::load(&folder.path().join("annotation.json")).unwrap();
        let calibration = calibrate(&plate.manifest, &plate.annotation).unwrap();
        assert_eq!(calibration.stride.len(), 12);
        for (found, panel) in calibration.stride.iter().zip(&specimen.truth.panels) {
            let drawn = &panel.camera;
            assert!((found.px_per_m / drawn.px_per_m - 1.0).abs() < 0.005, "{found:?}\n{drawn:?}");
            assert!((found.camera_x_m - drawn.camera_x_m).abs() < 0.01, "{found:?}\n{drawn:?}");
            assert!((found.time_s - drawn.time_s).abs() < 1e-9);
            for (keypoint, _) in panel.keypoints.iter() {
                let at = place(panel, keypoint);
                let [ours, theirs] = [drawn, found].map(|camera| camera.world_from_plate(at, 0.0));
                let apart = (ours[0] - theirs[0]).hypot(ours[1] - theirs[1]);
                assert!(apart < 0.01, "panel {} {keypoint}: {apart}", drawn.panel);
            }
        }
        assert!((calibration.speed_m_s.value / specimen.truth.speed_m_s - 1.0).abs() < 0.03);
    }
}

#[test]
fn random_styles_span_what_a_splitter_must_bear() {
    let styles: Vec<SpecimenStyle> = (0..200).map(SpecimenStyle::random).collect();
    let any = |test: &dyn Fn(&SpecimenStyle) -> bool| styles.iter().any(test);
    assert!(
        (2..=6).all(|columns| any(&|s| s.columns == columns)) && (1..=5).all(|rows| any(&|s| s.rows == rows))
    );
    assert!(styles.iter().all(|s| (2..=6).contains(&s.columns) && (1..=5).contains(&s.rows)));
    assert!(
        styles.iter().all(|s| s.tilt_deg.abs() <= 3.0)
            && any(&|s| s.tilt_deg > 2.5)
            && any(&|s| s.tilt_deg < -2.5)
    );
    assert!(any(&|s| s.mount == Mount::Dark) && any(&|s| s.mount == Mount::Light));
    assert!(
        any(&|s| s.fold)
            && any(&|s| s.caption)
            && any(&|s| s.numbers)
            && any(&|s| s.shadowed_panel.is_some())
    );
    assert!(any(&|s| s.grain_sd > 6.0) && any(&|s| s.unevenness > 0.5) && any(&|s| s.grid == Grid::Full));
    for style in &styles {
        assert!((style.tones.wall - style.tones.mount).abs() > 40.0, "{:?}", style.tones);
        assert!((style.tones.wall - style.tones.horse).abs() > 30.0, "{:?}", style.tones);
    }
}

#[test]
fn random_plates_hold_their_panels_apart_and_on_the_picture() {
    for seed in 0..5 {
        let style = SpecimenStyle { grain_sd: 0.0, ..SpecimenStyle::random(seed) };
        let cells = (style.columns * style.rows) as usize;
        let specimen = draw(&swung_legs(cells, Facing::Right), &style);
        let (width, height) = specimen.picture.dimensions();
        assert_eq!(specimen.truth.panels.len(), cells);
        for panel in &specimen.truth.panels {
            assert!(PanelTransform::new(panel.quad_px, [1.0, 1.0]).is_some());
            let inside = |[x, y]: [f64; 2]| {
                (0.0..=f64::from(width)).contains(&x) && (0.0..=f64::from(height)).contains(&y)
            };
            assert!(panel.quad_px.into_iter().all(inside), "seed {seed}: {:?}", panel.quad_px);
            let others =
                specimen.truth.panels.iter().filter(|other| other.camera.panel != panel.camera.panel);
            for other in others {
                let transform = PanelTransform::new(other.quad_px, [1.0, 1.0]).unwrap();
                let apart = panel.quad_px.into_iter().all(|corner| {
                    let [u, v] = transform.panel_from_plate(corner);
                    !((0.0..=1.0).contains(&u) && (0.0..=1.0).contains(&v))
                });
                assert!(apart, "seed {seed}: panels {} and {}", panel.camera.panel, other.camera.panel);
            }
            // The whole horse is in the photograph.
            for (keypoint, placed) in panel.keypoints.iter() {
                let transform = PanelTransform::new(panel.quad_px, [1.0, 1.0]).unwrap();
                let [u, v] = transform.panel_from_plate(placed.place().unwrap());
                let within = (0.0..=1.0).contains(&u) && (0.0..=1.0).contains(&v);
                assert!(within, "seed {seed} panel {} {keypoint}", panel.camera.panel);
            }
        }
    }
}

#[test]
fn odd_styles_and_motions_do_not_panic() {
    let base = SpecimenStyle { rows: 1, columns: 2, fold: true, rider: true, ..SpecimenStyle::default() };
    let motion = swung_legs(2, Facing::Right);
    for style in [
        SpecimenStyle { columns: 0, ..base.clone() },
        SpecimenStyle { columns: 1, rows: 1, panel_px: [1.0, 1.0], margin_px: 0.0, ..base.clone() },
        SpecimenStyle { panel_px: [0.0, 0.0], ..base.clone() },
        SpecimenStyle { panel_px: [f64::NAN, 100.0], ..base.clone() },
        SpecimenStyle { upright_spacing_m: 0.0, grid: Grid::Full, grid_spacing_m: 0.0, ..base.clone() },
        SpecimenStyle { camera_distance_m: 0.0, wall_distance_m: 0.0, ..base.clone() },
        SpecimenStyle { fill: 0.0, blur_px: -1.0, grain_sd: -1.0, ..base.clone() },
    ] {
        let specimen = draw(&motion, &style);
        let _ = encode(&specimen);
    }
    let mut empty = swung_legs(0, Facing::Left);
    assert!(draw(&empty, &base).truth.panels.is_empty());
    empty.poses = vec![swung_legs(1, Facing::Left).poses[0].clone()];
    for bone in &mut empty.poses[0].bones {
        *bone = [[f64::NAN; 3]; 2];
    }
    assert_eq!(draw(&empty, &base).truth.panels.len(), 1);
}
