//! `muybridge motion` as a user runs it: rides played, drawn and animated, and what it says to a wrong call.

#![allow(clippy::unwrap_used, reason = "a test stops at the first thing it cannot do")]

use std::io::{BufRead, BufReader};
use std::path::PathBuf;
use std::process::{Command, Stdio};

use image::AnimationDecoder;
use muybridge_cli::ride_script::RideScript;
use muybridge_core::{Pose, Skeleton};
use muybridge_tests::{Run, Workspace, program, repository};
use serde_json::Value;

/// A horse that stands, walks, and trots in a curve.
const RIDE: &str = r#"{
  "schema": 1,
  "ride": [
    { "for_s": 1, "speed_mph": 0 },
    { "for_s": 4, "speed_mph": 3, "gait": "walk" },
    { "for_s": 5, "speed_mph": 10, "gait": "trot", "turn_deg_s": 15 }
  ]
}"#;
/// Border of a picture in a change of gait.
const CHANGE: [u8; 3] = [240, 190, 20];

fn workspace() -> Workspace {
    let workspace = Workspace::new();
    workspace.write("ride.json", RIDE);
    workspace
}

fn motion(workspace: &Workspace, arguments: &[&str]) -> Run {
    workspace.run("muybridge", &[&["motion"], arguments].concat())
}

/// The rides of the repository.
fn rides() -> Vec<PathBuf> {
    let folder = repository().join("docs/rides");
    let mut paths: Vec<PathBuf> =
        std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|ending| ending == "json"));
    paths.sort();
    assert!(paths.len() >= 5);
    paths
}

fn picture(workspace: &Workspace, file: &str) -> image::RgbImage {
    image::open(workspace.path(file)).unwrap().to_rgb8()
}

fn bytes(workspace: &Workspace, file: &str) -> Vec<u8> {
    std::fs::read(workspace.path(file)).unwrap()
}

#[test]
fn a_ride_is_played_as_a_table_with_hoof_lanes() {
    let run = motion(&workspace(), &["play", "ride.json"]).expect_code(0);
    let lines: Vec<&str> = run.stdout.lines().collect();
    assert_eq!(lines.len(), 101, "{}", run.stdout);
    for word in ["time_s", "gait", "lead", "change", "m/s", "mph", "heading", "LF", "RH"] {
        assert!(lines[0].contains(word), "{}", lines[0]);
    }
    let at = |tenths: usize| lines[1 + tenths];
    assert!(at(0).contains("stand") && at(0).contains("###### ###### ###### ######"), "{}", at(0));
    assert!(at(45).contains(" walk ") && at(45).contains('.') && at(45).contains('#'), "{}", at(45));
    assert!(at(99).contains(" trot "), "{}", at(99));
    assert!(lines.iter().any(|line| line.contains(" trot ") && line.contains('%')), "a change is told");
    let heading: f64 = at(99).split_whitespace().rev().nth(4).unwrap().parse().unwrap();
    assert!((20.0..85.0).contains(&heading), "{}", at(99));
}

#[test]
fn footfalls_come_in_the_order_of_the_gait() {
    let workspace = workspace();
    let order = |gait: &str| -> Vec<String> {
        let run = motion(&workspace, &["play", "--gait", gait, "--each", "footfall", "--rate", "240"]);
        let lines = run.expect_code(0).stdout;
        let strikes = |line: &str| line.rsplit("  ").next().unwrap_or_default().to_string();
        let strikes: Vec<String> = lines.lines().skip(1).map(strikes).collect();
        strikes.iter().flat_map(|hooves| hooves.split(' ').map(str::to_string)).collect()
    };
    let walk = order("walk");
    assert!(walk.len() >= 7, "{walk:?}");
    let next = |hoof: &str| match hoof {
        "LH" => "LF",
        "LF" => "RH",
        "RH" => "RF",
        _ => "LH",
    };
    for pair in walk.windows(2) {
        assert_eq!(pair[1], next(&pair[0]), "lateral sequence: {walk:?}");
    }
    assert!(order("trot").len() >= 6);
}

#[test]
fn every_frame_is_there_for_other_programs() {
    let workspace = workspace();
    let json = || motion(&workspace, &["play", "ride.json", "--json", "--rate", "50"]).expect_code(0).stdout;
    let text = json();
    assert_eq!(text, json(), "equal calls, equal bytes");
    let document: Value = serde_json::from_str(&text).unwrap();
    let frames = document["frames"].as_array().unwrap();
    assert_eq!((frames.len(), document["bones"].as_array().unwrap().len()), (501, 28));
    assert_eq!((&frames[0]["time_s"], &frames[0]["standing"]), (&Value::from(0.0), &Value::from(true)));
    let last = &frames[500];
    assert_eq!(last["gait"], "trot");
    let pose: Pose = serde_json::from_value(last["pose"].clone()).unwrap();
    assert!(pose.joints(&Skeleton::reference()).toe(muybridge_core::Limb::LF).is_finite());

    let csv = motion(&workspace, &["play", "ride.json", "--csv", "--rate", "50"]).expect_code(0).stdout;
    let columns: Vec<&str> = csv.lines().next().unwrap().split(',').collect();
    assert_eq!(csv.lines().count(), 502);
    assert!(csv.lines().all(|line| line.split(',').count() == columns.len()), "{columns:?}");
    let column = |name: &str| columns.iter().position(|column| *column == name).unwrap();
    let cell = |name: &str| csv.lines().last().unwrap().split(',').nth(column(name)).unwrap().to_string();
    let x: f32 = cell("root_x_m").parse().unwrap();
    assert!((x - pose.root_in_world.x).abs() < 1e-4);
    let bend: f32 = cell("RH_hoof_bend_rad").parse().unwrap();
    assert!((bend - pose.bends_rad[27]).abs() < 1e-5);
}

#[test]
fn a_reader_that_stops_reading_is_no_error() {
    let mut command = Command::new(program("muybridge"));
    command.args(["motion", "play", "--json"]).current_dir(repository());
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let mut first = String::new();
    BufReader::new(child.stdout.take().unwrap()).read_line(&mut first).unwrap();
    let output = child.wait_with_output().unwrap();
    assert_eq!(String::from_utf8(output.stderr).unwrap(), "");
    assert_eq!(output.status.code(), Some(0));
}

#[test]
fn a_strip_shows_the_moments_and_marks_a_change_of_gait() {
    let workspace = workspace();
    let draw = |more: &[&str]| {
        motion(&workspace, &[&["strip", "ride.json", "--out", "strip.png"], more].concat()).expect_code(0);
        (picture(&workspace, "strip.png"), bytes(&workspace, "strip.png").len())
    };
    let marks = |pixel: &&image::Rgb<u8>| (0..3).all(|i| pixel.0[i].abs_diff(CHANGE[i]) < 6);
    let marked = |picture: &image::RgbImage| picture.pixels().filter(marks).count();
    let (whole, size) = draw(&["--from", "4", "--to", "9"]);
    assert!(size <= 300_000, "{size} bytes");
    assert!(marked(&whole) > 1000, "the change from walk to trot has a border");
    let (walk, _) = draw(&["--from", "3", "--to", "4.5"]);
    assert_eq!(walk.dimensions(), whole.dimensions());
    assert_eq!(marked(&walk), 0);
    let (fewer, _) = draw(&["--moments", "4", "--columns", "2", "--view", "three-quarter"]);
    assert!(fewer.width() < whole.width() / 2);
    let (sticks, _) = draw(&["--from", "3", "--to", "4.5", "--sticks"]);
    assert_ne!(sticks, walk);
}

#[test]
fn a_strip_of_one_gait_shows_one_stride_and_a_turntable_one_pose() {
    let workspace = workspace();
    let draw = |arguments: &[&str]| {
        motion(&workspace, &[&["strip", "--out", "strip.png"], arguments].concat()).expect_code(0);
        assert!(bytes(&workspace, "strip.png").len() <= 300_000);
        picture(&workspace, "strip.png")
    };
    let trot = draw(&["--gait", "trot", "--speed", "5.2"]);
    assert_eq!(trot, draw(&["--gait", "trot", "--speed", "5.2m/s"]));
    assert_ne!(trot, draw(&["--gait", "trot", "--speed", "18mph"]));
    assert_ne!(trot, draw(&["--gait", "trot", "--speed", "5.2", "--legs", "0.7"]));
    assert_ne!(trot, draw(&["--gait", "trot", "--speed", "5.2", "--turntable"]));
}

#[test]
fn an_animation_of_one_gait_holds_whole_strides_and_repeats() {
    let workspace = workspace();
    let arguments = ["gif", "--gait", "canter", "--speed", "7", "--out", "canter.gif"];
    let run = motion(&workspace, &arguments).expect_code(0);
    let file = bytes(&workspace, "canter.gif");
    assert!(file.len() <= 2_000_000, "{} bytes", file.len());
    assert!(file.windows(11).any(|window| window == b"NETSCAPE2.0"), "it repeats");
    let decoder = image::codecs::gif::GifDecoder::new(std::io::Cursor::new(file)).unwrap();
    let frames = decoder.into_frames().collect_frames().unwrap();
    assert!(run.stdout.contains(&format!("{} pictures", frames.len())), "{}", run.stdout);
    assert_eq!(frames[0].delay().numer_denom_ms(), (60, 1));
    let differ = |a: usize, b: usize| -> u64 {
        let (a, b) = (frames[a].buffer().as_raw(), frames[b].buffer().as_raw());
        a.iter().zip(b).map(|(a, b)| u64::from(a.abs_diff(*b))).sum()
    };
    let last = frames.len() - 1;
    let (within, around) = (differ(0, 1).max(differ(last - 1, last)), differ(last, 0));
    assert!(around < 2 * within, "the loop closes without a jump: {around} against {within}");
    let play = |times: &str| {
        motion(&workspace, &[&arguments[..], &["--slow", times]].concat()).expect_code(0).stdout
    };
    assert_ne!(play("1"), play("4"));
}

#[test]
fn gaits_are_measured_at_their_speeds_and_follow_the_horses_size() {
    let workspace = workspace();
    let table = |more: &[&str]| motion(&workspace, &[&["gaits"], more].concat()).expect_code(0).stdout;
    let rows = |text: &str| -> Vec<(String, Vec<f64>)> {
        let cells = |line: &str| -> Vec<String> {
            line.split('┆').map(|cell| cell.replace('│', "").trim().into()).collect()
        };
        text.lines()
            .map(cells)
            .filter(|cells| cells.len() == 9 && cells[1].parse::<f64>().is_ok())
            .map(|cells| (cells[0].clone(), cells[1..8].iter().map(|cell| cell.parse().unwrap()).collect()))
            .collect()
    };
    let text = table(&[]);
    let seen = rows(&text);
    assert_eq!(seen.len(), 18, "{text}");
    for three in seen.chunks(3) {
        let [slow, .., fast] = three else { unreachable!() };
        let (speed, stride_time, duty) = (0, 3, 6);
        assert!(fast.1[speed] > 1.3 * slow.1[speed], "{text}");
        assert!(fast.1[stride_time] <= slow.1[stride_time], "{text}");
        assert!(fast.1[duty] <= slow.1[duty] + 0.01, "{text}");
    }
    let small = rows(&table(&["--size", "0.6"]));
    assert!(small[17].1[0] < seen[17].1[0], "a small horse gallops more slowly");
    assert!(text.contains("hind leg is") && text.contains("getting faster: walk"), "{text}");
}

#[test]
fn the_rides_of_the_repository_are_played_to_their_end() {
    for path in rides() {
        let script = RideScript::read(&path).unwrap();
        assert!(script.name.is_some(), "{}", path.display());
        let mut command = Command::new(program("muybridge"));
        command.args(["motion", "play", "--each", "1"]).arg(&path).current_dir(repository());
        let run = Run::of(&mut command).expect_code(0);
        assert_eq!(run.stdout.lines().count() as f64, 1.0 + script.duration_s().ceil(), "{}", path.display());
        assert!(!run.stdout.contains("NaN") && !run.stdout.contains("inf"), "{}", run.stdout);
    }
}

#[test]
fn wrong_calls_and_wrong_scripts_end_with_one_clear_line() {
    let workspace = workspace();
    workspace.write(
        "typo.json",
        "{\n  \"schema\": 1,\n  \"ride\": [\n    { \"for_s\": 3, \"sped_mph\": 3 }\n  ]\n}\n",
    );
    workspace.write("fast.json", r#"{ "schema": 1, "ride": [{ "for_s": 3, "speed_m_s": 300 }] }"#);
    workspace.write("lost.json", r#"{ "schema": 1, "skeleton": "none.json", "ride": [{ "for_s": 3 }] }"#);
    workspace.write("bones.json", r#"{ "schema": 1 }"#);
    let cases: [(i32, &[&str], &[&str]); 14] = [
        (1, &["play", "typo.json"], &["typo.json", "ride[0]", "sped_mph", "line 4 column"]),
        (1, &["play", "fast.json"], &["fast.json", "ride[0].speed_m_s", "between 0 and 30 m/s", "line 1"]),
        (1, &["play", "none.json"], &["none.json: cannot be read"]),
        (1, &["play", "lost.json"], &["none.json: cannot be read"]),
        (1, &["play", "ride.json", "--skeleton", "bones.json"], &["bones.json", "missing field"]),
        (
            1,
            &["strip", "ride.json", "--from", "9", "--to", "8", "--out", "x.png"],
            &["8 s, is before the first"],
        ),
        (1, &["gif", "ride.json", "--from", "300", "--out", "x.gif"], &["nothing of the ride is left"]),
        (1, &["strip", "ride.json", "--out", "none/x.png"], &["none/x.png: cannot be written"]),
        (2, &["play", "ride.json", "--gait", "trot"], &["cannot be used with"]),
        (2, &["play", "--gait", "leap"], &["the names are walk, amble"]),
        (2, &["play", "--speed", "fast"], &["not a number"]),
        (2, &["play", "--ground", "slope:99"], &["between -30 and 30 degrees"]),
        (2, &["play", "--legs", "NaN"], &["between 0.2 and 3"]),
        (2, &["gif", "ride.json"], &["--out <FILE>"]),
    ];
    for (code, arguments, messages) in cases {
        let run = motion(&workspace, arguments).expect_code(code);
        for message in messages {
            assert!(run.stderr.contains(message), "{arguments:?}: {}", run.stderr);
        }
        assert!(run.stdout.is_empty() && !run.stderr.contains("panicked"), "{arguments:?}: {}", run.stderr);
        assert!(!workspace.path("x.png").exists() && !workspace.path("x.gif").exists());
    }
}
