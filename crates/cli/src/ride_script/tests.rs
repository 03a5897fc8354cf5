//! What a ride script says, and what it refuses.

use super::*;
use muybridge_core::{Gait, Ground, Leap, Side, Turn};

fn read(text: &str) -> Result<RideScript, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("ride.json");
    muybridge_capture::write_atomically(&path, text.as_bytes()).unwrap();
    RideScript::read(&path).map_err(|error| error.to_string())
}

/// The script with these steps.
fn ride(steps: &str) -> Result<RideScript, String> {
    read(&format!("{{ \"schema\": 1, \"ride\": [{steps}] }}"))
}

#[test]
fn a_step_is_a_whole_command_and_only_the_speed_stays() {
    let script = ride(
        r#"{"for_s": 3, "speed_mph": 10, "gait": "trot"},
           {"for_s": 4, "gait": "canter", "lead": "left", "turn_deg_s": 10},
           {"for_s": 2, "heading_deg": 90, "speed_m_s": 0}"#,
    )
    .unwrap();
    assert_eq!(script.duration_s(), 9.0);
    let command = |time_s| script.command(time_s, 0.01).unwrap();
    assert_eq!(command(0.0).gait, Some(Gait::Trot));
    let second = command(3.0);
    assert_eq!((second.gait, second.lead), (Some(Gait::Canter), Some(Side::Left)));
    assert!((second.speed_m_s - 4.4704).abs() < 1e-5);
    assert_eq!(second.turn, Turn::Rate(10f32.to_radians()));
    let third = command(8.99);
    assert_eq!((third.gait, third.lead, third.speed_m_s), (None, None, 0.0));
    assert_eq!(third.turn, Turn::Heading(90f32.to_radians()));
    assert_eq!(script.command(9.0, 0.01), None);
}

#[test]
fn every_leap_of_a_script_is_a_new_one() {
    let leap = r#"{"for_s": 1, "speed_m_s": 8, "leap": {"height_m": 0.5, "length_m": 3}}"#;
    let script = ride(&format!("{leap}, {leap}")).unwrap();
    let leaps: Vec<bool> =
        (0..20).map(|tick| script.command(0.1 * f64::from(tick), 0.1).unwrap().leap.is_some()).collect();
    assert_eq!(leaps.iter().filter(|leap| !**leap).count(), 2);
    assert!(!leaps[9] && leaps[10] && !leaps[19]);
    assert_eq!(script.ride[0].leap, Some(Leap { height_m: 0.5, length_m: 3.0 }));
}

#[test]
fn a_skeleton_is_looked_for_beside_the_script() {
    let script = read(r#"{"schema": 1, "skeleton": "pony.json", "ride": [{"for_s": 1}]}"#).unwrap();
    let skeleton = script.skeleton.unwrap();
    assert!(skeleton.is_absolute() && skeleton.ends_with("pony.json"), "{}", skeleton.display());
}

#[test]
fn wrong_scripts_are_refused_with_field_line_and_column() {
    let cases = [
        ("{\"schema\": 1, \"ride\": [{\"for_s\": 1,\n  \"sped\": 2}]}", "ride[0]", "sped", "line 2 column 8"),
        (r#"{"schema": 1, "ride": [{"for_s": 1}], "speed": 2}"#, "speed", "unknown field", "column 45"),
        (r#"{"schema": 1, "ride": [{"for_s": -1}]}"#, "ride[0].for_s", "between 0.1 and 3600 s", "line 1"),
        (
            r#"{"schema": 1, "ride": [{"for_s": 1, "speed_mph": 400}]}"#,
            "ride[0].speed_mph",
            "60 mph",
            "line 1",
        ),
        (
            r#"{"schema": 1, "ride": [{"for_s": 1, "speed_m_s": 1e999}]}"#,
            "ride",
            "number out of range",
            "line 1",
        ),
        (
            r#"{"schema": 1, "ride": [{"for_s": 1, "speed_m_s": 1, "speed_mph": 1}]}"#,
            "ride[0]",
            "one of",
            "line 1",
        ),
        (
            r#"{"schema": 1, "ride": [{"for_s": 1, "turn_deg_s": 1, "heading_deg": 1}]}"#,
            "ride[0]",
            "one of",
            "1",
        ),
        (r#"{"schema": 1, "ride": [{"for_s": 1, "gait": "pace"}]}"#, "ride[0].gait", "`walk`", "line 1"),
        (r#"{"schema": 1, "ride": [{"for_s": 1, "gait": "leap"}]}"#, "ride[0]", "\"leap\":", "line 1"),
        (r#"{"schema": 1, "ride": [{"for_s": 1, "leap": {"height_m": 1}}]}"#, "leap", "length_m", "line 1"),
        (r#"{"schema": 1, "ride": []}"#, "ride: ", "no steps", "line 1"),
        (r#"{"schema": 1, "ride": [{"for_s": 3000}, {"for_s": 3000}]}"#, "ride: ", "6000 s", "line 1"),
        (r#"{"schema": 1, "ground": "lava", "ride": [{"for_s": 1}]}"#, "ground", "slope:DEGREES", "line 1"),
        (r#"{"schema": 1, "ground": "slope:80", "ride": [{"for_s": 1}]}"#, "ground", "30 degrees", "line 1"),
        (r#"{"schema": 1, "start": {"x_m": "far"}, "ride": [{"for_s": 1}]}"#, "start.x_m", "far", "line 1"),
        (r#"{"schema": 1, "legs": 0, "ride": [{"for_s": 1}]}"#, "legs", "between 0.2 and 3", "line 1"),
        (r#"{"schema": 1, "ride": [{"for_s": 1}]"#, "ride.json", "no valid JSON", "line 1"),
        (r#"{"ride": [{"for_s": 1}]}"#, "schema", "missing", ""),
        (r#"{"schema": 2, "ride": [{"for_s": 1}]}"#, "schema", "version 2", ""),
    ];
    for (text, field, message, place) in cases {
        let fault = read(text).expect_err(text);
        for part in ["ride.json: ", field, message, place] {
            assert!(fault.contains(part), "{text}\n{fault}\nsays nothing of {part:?}");
        }
    }
}

#[test]
fn grounds_are_level_at_the_start_and_have_the_shape_they_are_named_for() {
    let ground = |text: &str| text.parse::<RideGround>().unwrap();
    for text in ["flat", "slope:10", "slope:-10", "ridge:12", "steps:0.2", "hills:2"] {
        for x in [-30.0, -1.0, 0.0, 2.0, 4.9] {
            assert_eq!(ground(text).height_m(x, 3.0), 0.0, "{text}");
        }
        assert!(ground(text).surface(300.0, 3.0).height_m.is_finite(), "{text}");
    }
    let slope = ground("slope:10");
    assert!((slope.surface(20.0, 0.0).normal.y - 10f32.to_radians().cos()).abs() < 1e-3);
    assert!(ground("slope:-10").height_m(20.0, 0.0) < -2.0);
    let ridge = ground("ridge:10");
    assert!(ridge.height_m(18.0, 0.0) > 2.0 && ridge.height_m(40.0, 0.0).abs() < 1e-5);
    let steps = ground("steps:0.2");
    let heights = [5.1, 7.6, 12.6, 15.1, 22.6, 25.1].map(|x| steps.height_m(x, 0.0));
    let expected = [0.2, 0.4, 0.8, 0.6, 0.0, 0.2];
    assert!(heights.iter().zip(expected).all(|(a, b): (&f32, f32)| (a - b).abs() < 1e-5), "{heights:?}");
    assert!((ground("hills:2").height_m(12.0, 0.0) - 2.0).abs() < 1e-3);
    for text in ["", "flat:1", "slope", "slope:x", "slope:NaN", "steps:-1", "hills:inf", "hills:6"] {
        assert!(text.parse::<RideGround>().is_err(), "{text}");
    }
}
