//! Tests of the terrain.

use super::*;

const STAIRS: Terrain =
    Terrain::Stairs { tread_m: 0.5, rise_m: 0.2, steps: 3, towards_deg: 90.0, from_m: [1.0, -2.0] };

fn spiral(turns: f64, clockwise: bool) -> Terrain {
    Terrain::SpiralStairs {
        centre_m: [1.0, 2.0],
        inner_m: 1.0,
        outer_m: 3.0,
        steps_per_turn: 12,
        rise_m: 0.25,
        turns,
        from_deg: 90.0,
        clockwise,
    }
}

fn hill() -> Terrain {
    let heights_m = vec![0.0, 1.0, 2.0, 0.0, 2.0, 6.0];
    Terrain::HeightField { from_m: [10.0, 20.0], spacing_m: 2.0, columns: 3, heights_m }
}

/// Height at a distance and a direction from the middle of the spiral staircase.
fn around(terrain: &Terrain, radius_m: f64, towards_deg: f64) -> f64 {
    let at = DVec2::new(1.0, 2.0) + direction(towards_deg) * radius_m;
    terrain.at(at.x, at.y).0
}

#[test]
fn a_slope_rises_where_it_is_said_to() {
    let slope = Terrain::Slope { rise_deg: 45.0, towards_deg: 90.0 };
    let (height_m, normal) = slope.at(5.0, -2.0);
    assert!((height_m - 2.0).abs() < 1e-12, "to the left of X is towards -Z");
    assert!((normal - DVec3::new(0.0, 1.0, 1.0).normalize()).length() < 1e-12);
}

#[test]
fn stairs_are_level_treads_between_level_landings() {
    for (z_m, height_m) in [(-1.0, 0.0), (-1.99, 0.0), (-2.01, 0.2), (-2.49, 0.2), (-2.51, 0.4), (-3.01, 0.6)]
    {
        assert_eq!(STAIRS.at(7.0, z_m).1, DVec3::Y);
        assert!((STAIRS.at(7.0, z_m).0 - height_m).abs() < 1e-12, "at {z_m}");
    }
    assert!((STAIRS.at(0.0, -500.0).0 - 0.6).abs() < 1e-12, "the landing goes on");
}

#[test]
fn a_spiral_staircase_climbs_to_a_landing_and_starts_on_the_ground() {
    let stairs = spiral(0.5, false);
    let heights = [91.0, 121.0, 269.0, 271.0, 359.0, 361.0, 449.0].map(|deg| around(&stairs, 2.0, deg));
    assert_eq!(heights, [0.25, 0.5, 1.5, 1.5, 1.5, 0.0, 0.0]);
    assert_eq!([0.5, 3.5].map(|radius_m| around(&stairs, radius_m, 200.0)), [0.0, 0.0], "inside and outside");
    let right = spiral(0.5, true);
    assert_eq!([89.0, 59.0, -89.0, 91.0].map(|deg| around(&right, 2.0, deg)), [0.25, 0.5, 1.5, 0.0]);
    assert_eq!(around(&spiral(1.0, false), 2.0, 89.0), 3.0, "a whole turn has no landing");
}

#[test]
fn a_height_field_goes_through_its_heights_and_on_at_its_edges() {
    let hill = hill();
    for (x_m, z_m, height_m) in [(10.0, 20.0, 0.0), (12.0, 22.0, 2.0), (14.0, 22.0, 6.0), (13.0, 21.0, 2.75)]
    {
        assert!((hill.at(x_m, z_m).0 - height_m).abs() < 1e-12, "at {x_m} {z_m}");
    }
    assert_eq!(hill.at(1e4, 1e4), (6.0, DVec3::Y));
    assert_eq!(hill.at(-1e4, 21.0).0, 0.0);
}

#[test]
fn the_normal_of_a_height_field_is_that_of_its_surface() {
    let hill = hill();
    let step_m = 1e-5;
    for (x_m, z_m) in [(10.3, 20.9), (12.7, 21.4), (13.9, 20.1), (9.0, 21.0), (12.7, 30.0)] {
        let rise = |dx: f64, dz: f64| {
            (hill.at(x_m + dx, z_m + dz).0 - hill.at(x_m - dx, z_m - dz).0) / (2.0 * step_m)
        };
        let measured = normal(DVec2::new(rise(step_m, 0.0), rise(0.0, step_m)));
        assert!((hill.at(x_m, z_m).1 - measured).length() < 1e-8, "at {x_m} {z_m}");
    }
}

#[test]
fn it_is_a_ground_to_ride_on() {
    let surface = hill().surface(13.0, 21.0);
    assert!((surface.height_m - 2.75).abs() < 1e-6);
    assert!((surface.normal.length() - 1.0).abs() < 1e-6);
}

#[test]
fn every_kind_is_read_as_it_is_written() {
    let kinds = [
        (Terrain::Flat, "flat"),
        (Terrain::Slope { rise_deg: 5.0, towards_deg: 0.0 }, "slope"),
        (STAIRS, "stairs"),
        (spiral(0.75, true), "spiral-stairs"),
        (hill(), "height-field"),
    ];
    for (terrain, kind) in kinds {
        let text = serde_json::to_string(&terrain).unwrap();
        assert!(text.starts_with(&format!("{{\"kind\":\"{kind}\"")), "{text}");
        assert_eq!(serde_json::from_str::<Terrain>(&text).unwrap(), terrain);
        assert_eq!(terrain.fault(), None);
    }
    assert!(
        serde_json::from_str::<Terrain>(r#"{"kind":"slope","rise_deg":5,"towards_deg":0,"x":1}"#).is_err()
    );
    assert!(serde_json::from_str::<Terrain>(r#"{"kind":"flat","rise_deg":5}"#).is_err());
    assert!(serde_json::from_str::<Terrain>(r#"{"kind":"sea"}"#).is_err());
}

#[test]
fn numbers_that_cannot_be_are_named() {
    let field = |columns: u32, heights_m: Vec<f64>| Terrain::HeightField {
        from_m: [0.0; 2],
        spacing_m: 1.0,
        columns,
        heights_m,
    };
    let stairs = |tread_m: f64, steps: u32| Terrain::Stairs {
        tread_m,
        rise_m: 0.2,
        steps,
        towards_deg: 0.0,
        from_m: [0.0; 2],
    };
    let faulty = [
        (Terrain::Slope { rise_deg: f64::NAN, towards_deg: 0.0 }, "rise_deg"),
        (Terrain::Slope { rise_deg: 90.0, towards_deg: 0.0 }, "rise_deg"),
        (Terrain::Slope { rise_deg: 3.0, towards_deg: f64::INFINITY }, "towards_deg"),
        (stairs(0.0, 3), "tread_m"),
        (stairs(0.3, u32::MAX), "steps"),
        (spiral(1.5, false), "turns"),
        (spiral(0.0, false), "turns"),
        (field(0, vec![1.0]), "heights_m"),
        (field(2, vec![]), "heights_m"),
        (field(2, vec![0.0; 3]), "heights_m"),
        (field(1, vec![0.0; 1_000_001]), "heights_m"),
        (field(2, vec![0.0, f64::NAN]), "height 2 of heights_m"),
    ];
    for (terrain, named) in faulty {
        let fault = terrain.fault().unwrap();
        assert!(fault.contains(named), "{fault}");
        let _ = terrain.at(1.0, 2.0);
    }
}

#[test]
fn one_height_is_a_plane_and_no_place_a_panic() {
    let plane = Terrain::HeightField { from_m: [0.0; 2], spacing_m: 1.0, columns: 1, heights_m: vec![3.0] };
    assert_eq!(plane.fault(), None);
    assert_eq!(plane.at(0.0, 0.0), (3.0, DVec3::Y));
    for terrain in [plane, hill(), spiral(1.0, true), STAIRS] {
        let _ = terrain.at(f64::NAN, f64::INFINITY);
        let _ = terrain.at(1e300, -1e300);
    }
}
