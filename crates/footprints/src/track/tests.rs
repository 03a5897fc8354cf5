//! Tests of the track file, whole and broken.

use super::*;

fn track() -> Track {
    let print = |foot: Foot, x_m: f64, timing: Option<StepTiming>| Print {
        foot,
        at_m: [x_m, -0.1],
        heading_deg: 12.5,
        timing,
    };
    let timing = StepTiming { stance_time_s: 0.625, step_time_s: 0.5 };
    Track {
        name: Some("Two \"steps\"".into()),
        terrain: Terrain::Slope { rise_deg: 5.0, towards_deg: 0.0 },
        prints: vec![print(Foot::Left, 0.0, Some(timing)), print(Foot::Right, 0.7, None)],
        ..Track::new("human")
    }
}

fn fault(text: &str) -> String {
    Track::from_json(text).unwrap_err().to_string()
}

#[test]
fn a_file_has_a_print_on_each_line() {
    let text = track().to_json();
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines[0], "{");
    assert_eq!(lines[1], r#"  "schema": 1,"#);
    assert_eq!(lines[4], r#"  "terrain": { "kind": "slope", "rise_deg": 5.0, "towards_deg": 0.0 },"#);
    let prints = lines.iter().position(|line| *line == r#"  "prints": ["#).unwrap();
    assert_eq!(
        lines[prints + 1],
        r#"    { "foot": "L", "at_m": [0.0, -0.1], "heading_deg": 12.5, "timing": { "stance_time_s": 0.625, "step_time_s": 0.5 } },"#
    );
    assert_eq!(lines[prints + 2], r#"    { "foot": "R", "at_m": [0.7, -0.1], "heading_deg": 12.5 }"#);
    assert_eq!(lines[prints + 3..], ["  ]", "}"]);
}

#[test]
fn what_is_written_is_read_again() {
    let laid: Laying = serde_json::from_str(
        r#"{ "points": [{ "at_m": [0, 0] }, { "at_m": [5, 1], "tangent_m": [1, 0] }], "step_length_m": 0.6 }"#,
    )
    .unwrap();
    let height_field =
        Terrain::HeightField { from_m: [0.0; 2], spacing_m: 1.0, columns: 2, heights_m: vec![0.0; 4] };
    for track in [
        track(),
        Track::new("bird"),
        Track { path: Some(laid), ..Track::new("horse") },
        Track { terrain: height_field, prints: track().prints, ..Track::new("bird") },
    ] {
        let text = track.to_json();
        assert_eq!(Track::from_json(&text).unwrap(), track, "{text}");
        assert_eq!(Track::from_json(&text).unwrap().to_json(), text);
    }
    assert!(Track::new("bird").to_json().ends_with("  \"prints\": []\n}\n"));
}

#[test]
fn the_least_file_has_a_schema_and_a_model() {
    let read = Track::from_json(r#"{ "schema": 1, "model": "bird" }"#).unwrap();
    assert_eq!(read, Track::new("bird"));
}

#[test]
fn another_schema_is_told_first() {
    assert_eq!(fault(r#"{ "schema": 2, "feet": 8 }"#), "schema: 2, but this program reads schema 1");
    assert!(fault(r#"{ "model": "bird" }"#).starts_with("schema: missing"));
    assert!(fault(r#"{ "schema": 1e99, "model": "bird" }"#).contains("line 1"));
}

#[test]
fn a_fault_in_the_text_has_a_line() {
    let text = track().to_json();
    let line = 1 + text.lines().position(|line| line.contains("\"R\"")).unwrap();
    for (right, wrong, cause) in [
        ("\"foot\": \"R\"", "\"foot\": \"Q\"", "unknown variant"),
        ("[0.7, -0.1]", "[null, -0.1]", "null"),
        ("[0.7, -0.1]", "[0.7]", "array of length 2"),
        ("[0.7, -0.1]", "[NaN, -0.1]", "expected"),
        ("[0.7, -0.1]", "[1e999, -0.1]", "out of range"),
        ("\"heading_deg\": 12.5 }", "\"heading\": 12.5 }", "unknown field"),
        ("\"heading_deg\": 12.5 }", "\"heading_deg\": \"12\" }", "string"),
    ] {
        let broken: String = text
            .lines()
            .enumerate()
            .map(|(i, text)| if i + 1 == line { text.replace(right, wrong) } else { text.into() } + "\n")
            .collect();
        let said = fault(&broken);
        assert!(said.starts_with(&format!("line {line} column ")) && said.contains(cause), "{said}");
    }
}

#[test]
fn no_part_of_a_file_is_a_panic() {
    let text = track().to_json();
    for end in 0..text.len() - 2 {
        assert!(text.get(..end).is_none_or(|part| Track::from_json(part).is_err()), "{end}");
    }
    for text in ["", "null", "[]", "{}", "\u{feff}{}", "{\"schema\":1,\"model\":\"bird\",\"prints\":{}}"] {
        assert!(Track::from_json(text).is_err(), "{text}");
    }
    assert!(Track::from_json(&"[".repeat(100_000)).is_err());
    let deep = format!("{{\"schema\":1,\"model\":\"bird\",\"about\":{}1", "[".repeat(100_000));
    assert!(Track::from_json(&deep).is_err());
}

#[test]
fn numbers_that_are_none_are_written_so_that_the_reader_names_them() {
    let mut track = track();
    track.prints[1].heading_deg = f64::NAN;
    assert!(fault(&track.to_json()).contains("null"));
}

#[test]
fn many_prints_are_read_in_one_go() {
    let print = r#"{"foot":"L","at_m":[0,0],"heading_deg":0},"#.repeat(50_000);
    let text = format!("{{\"schema\":1,\"model\":\"bird\",\"prints\":[{}]}}", print.trim_end_matches(','));
    assert_eq!(Track::from_json(&text).unwrap().prints.len(), 50_000);
}
