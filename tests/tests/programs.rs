//! The programs as a user runs them: what they print, what they write, and their exit codes.

#![allow(clippy::unwrap_used, reason = "a test stops at the first thing it cannot do")]

use std::path::Path;
use std::process::Command;

use muybridge_capture::hash_file;
use muybridge_tests::{Run, SALLIE, Workspace, assert_golden, program, repository, shared_folder};
use serde_json::Value;

const ANNOTATION: &str = "annotations/sallie-gardner-1878.json";

fn parse(text: &str) -> Value {
    serde_json::from_str(text).unwrap_or_else(|error| panic!("{error}:\n{text}"))
}

/// Names and content of a folder's files.
fn files(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let mut files: Vec<_> = entries
        .map(|path| (path.file_name().unwrap().to_string_lossy().into_owned(), std::fs::read(&path).unwrap()))
        .collect();
    files.sort();
    files
}

#[test]
fn a_run_prints_the_table_and_writes_database_report_and_fit() {
    let workspace = Workspace::new();
    let run = workspace.fit_gaits(&[]).expect_code(0);
    assert!(
        run.stdout.contains(SALLIE) && run.stdout.contains("gallop") && run.stdout.contains("transverse")
    );
    assert_golden("fit-gaits.txt", &run.stdout);
    assert!(run.stderr.contains("report: report/index.html") && run.stderr.contains("database: db.json"));
    assert!(workspace.path("report/index.html").is_file());
    let fit = workspace.json(&format!("report/{SALLIE}.fit.json"));
    assert_eq!(fit["plate"], SALLIE);
    assert_eq!(fit["annotation_sha256"], hash_file(&workspace.path(ANNOTATION)).unwrap());
    let database = muybridge_core::Database::from_json(&workspace.text("db.json")).unwrap();
    assert!(database.strides.iter().any(|stride| stride.id == SALLIE));
    assert!(database.strides.len() > 1, "the gallop at other speeds");
}

#[test]
fn output_is_the_same_bytes_each_time_and_with_any_number_of_threads() {
    let mut outputs = Vec::new();
    for threads in [None, None, Some("1"), Some("4")] {
        let workspace = Workspace::new();
        workspace.add_good_plate("second");
        let mut command = workspace.command("fit-gaits");
        command.args(["--json", "--out", "db.json", "--report", "report"]);
        if let Some(threads) = threads {
            command.env("RAYON_NUM_THREADS", threads);
        }
        let run = Run::of(&mut command).expect_code(0);
        outputs.push((run.stdout, workspace.text("db.json"), files(&workspace.path("report"))));
    }
    for output in &outputs[1..] {
        assert_eq!(output.0, outputs[0].0, "--json");
        assert_eq!(output.1, outputs[0].1, "database");
        assert_eq!(output.2, outputs[0].2, "report");
    }
}

#[test]
fn json_is_one_document_on_standard_output_and_nothing_else() {
    let workspace = Workspace::new();
    let run = workspace.fit_gaits(&["--json"]).expect_code(0);
    let document = parse(&run.stdout);
    let laws = document["gaits"].as_array().unwrap();
    assert!(!laws.is_empty());
    for law in laws {
        let name = law["law"].as_str().unwrap();
        assert!(["support", "limb_fore", "limb_hind"].contains(&name), "{law}");
        assert!(
            law["gait"].is_string() && law["a"].is_f64() && law["b"].is_f64() && law["n"].is_u64(),
            "{law}"
        );
        assert!(law["interval"].is_object() || law["interval"].is_null(), "{law}");
        assert!(law.as_object().unwrap().contains_key("interval"), "{law}");
        assert!(law["provenance"]["kind"].is_string(), "{law}");
    }
    for kind in ["support", "limb_fore", "limb_hind"] {
        assert!(laws.iter().any(|law| law["gait"] == "gallop" && law["law"] == kind), "gallop {kind}");
    }
    assert_eq!(document["strides"][0]["plate"], SALLIE);
    assert_eq!(document["strides"][0]["annotation_sha256"], hash_file(&workspace.path(ANNOTATION)).unwrap());
    let drawing = |character: char| character == '\u{1b}' || character == '\r';
    assert!(!run.stderr.contains(drawing), "a progress bar in a file: {:?}", run.stderr);
}

#[test]
fn check_tells_a_stale_database_from_a_fresh_one() {
    let workspace = Workspace::new();
    workspace.fit_gaits(&[]).expect_code(0);
    let run = workspace.fit_gaits(&["--check"]).expect_code(0);
    assert!(run.stderr.contains("db.json: up to date"), "{}", run.stderr);

    let fresh = workspace.text("db.json");
    workspace.edit("db.json", |database| {
        let strides = database["strides"].as_array_mut().unwrap();
        let stride = strides.iter_mut().find(|stride| stride["id"] == SALLIE).unwrap();
        // One character of the packed curves, in the middle of the root's height.
        let mut curves = stride["curves"].as_str().unwrap().to_string().into_bytes();
        curves[400] = if curves[400] == b'A' { b'B' } else { b'A' };
        stride["curves"] = String::from_utf8(curves).unwrap().into();
    });
    let changed = workspace.text("db.json");
    let run = workspace.fit_gaits(&["--check"]).expect_code(1);
    assert!(
        run.stderr.contains("stale") && run.stderr.contains(&format!("stride {SALLIE}")),
        "{}",
        run.stderr
    );
    assert_eq!(workspace.text("db.json"), changed, "--check writes nothing");

    workspace.write("db.json", &fresh);
    workspace.edit(ANNOTATION, |annotation| {
        let x = &mut annotation["panels"][4]["keypoints"]["withers"]["at_px"][0];
        *x = (x.as_f64().unwrap() + 0.5).into();
    });
    let run = workspace.fit_gaits(&["--check"]).expect_code(1);
    assert!(run.stderr.contains(&format!("stride {SALLIE}")), "{}", run.stderr);
}

#[test]
fn check_without_a_database_says_which_file_is_missing() {
    let workspace = Workspace::new();
    let run = workspace.fit_gaits(&["--check"]).expect_code(1);
    assert!(run.stderr.contains("db.json"), "{}", run.stderr);
}

#[test]
fn the_committed_database_is_what_the_committed_annotations_give() {
    let report = tempfile::tempdir().unwrap();
    let mut command = Command::new(program("fit-gaits"));
    command.arg("--check").arg("--report").arg(report.path()).current_dir(repository());
    Run::of(&mut command).expect_code(0);
}

/// The published table: gait, printed a, printed b; one line a gait.
fn published() -> Vec<(String, f64, f64)> {
    let path = repository().join("crates/fitting/data/huang-2012.csv");
    let text = std::fs::read_to_string(path).unwrap();
    let mut gaits: Vec<(String, f64, f64)> = Vec::new();
    for line in text.lines().skip(1) {
        let fields: Vec<&str> = line.split(',').collect();
        if !gaits.iter().any(|gait| gait.0 == fields[0]) {
            gaits.push((fields[0].into(), fields[4].parse().unwrap(), fields[5].parse().unwrap()));
        }
    }
    gaits
}

#[test]
fn the_published_table_is_reproduced() {
    let workspace = Workspace::new();
    let preset = |more: &[&str]| {
        let arguments = [&["--preset", "huang-2012", "--report", "report"], more].concat();
        workspace.run("fit-gaits", &arguments).expect_code(0)
    };
    let published = published();
    assert_eq!(published.len(), 6);
    let table = preset(&[]).stdout;
    assert!(published.iter().all(|(gait, ..)| table.contains(&format!("│ {gait} "))), "{table}");
    let json = preset(&["--json"]).stdout;
    assert_golden("huang-2012.json", &json);
    let document = parse(&json);
    let laws = document["gaits"].as_array().unwrap();
    assert_eq!(laws.len(), 6);
    for (gait, a, b) in &published {
        let law = laws.iter().find(|law| law["gait"] == gait.as_str()).unwrap();
        let (da, db) = (law["a"].as_f64().unwrap() / a - 1.0, law["b"].as_f64().unwrap() - b);
        let (limit_a, limit_b) = if gait == "amble" { (1e-3, 1e-3) } else { (1e-4, 5e-6) };
        assert!(da.abs() <= limit_a && db.abs() <= limit_b, "{gait}: a {da:.1e}, b {db:.1e}");
        assert_eq!(law["provenance"]["kind"], "published");
    }
    preset(&["--check"]);
    assert!(
        !workspace.path("crates").exists() && !workspace.path("db.json").exists(),
        "no database unless asked"
    );
    preset(&["--out", "db.json"]);
    let database = muybridge_core::Database::from_json(&workspace.text("db.json")).unwrap();
    assert_eq!((database.laws.len(), database.strides.len()), (6, 0));
}

#[test]
fn only_picks_plates_and_gaits() {
    let workspace = Workspace::new();
    workspace.add_good_plate("second");
    let plates = |run: &Run| -> Vec<String> {
        let document = parse(&run.stdout);
        let strides = document["strides"].as_array().unwrap();
        strides.iter().map(|stride| stride["plate"].as_str().unwrap().to_string()).collect()
    };
    let part =
        workspace.run("fit-gaits", &["--json", "--report", "report", "--only", "second"]).expect_code(0);
    assert_eq!(plates(&part), ["second"]);
    assert!(part.stderr.contains("not written") && !workspace.path("crates").exists(), "{}", part.stderr);

    let both = ["--json", "--only", SALLIE, "--only", "second"];
    assert_eq!(plates(&workspace.fit_gaits(&both).expect_code(0)), [SALLIE, "second"]);
    let database = workspace.text("db.json");
    let check = workspace.fit_gaits(&["--only", "second", "--check"]).expect_code(0);
    assert!(check.stderr.contains("up to date"), "{}", check.stderr);
    assert_eq!(workspace.text("db.json"), database);

    let gaits =
        ["--preset", "huang-2012", "--only", "walk", "--only", "trot", "--json", "--report", "report"];
    let document = parse(&workspace.run("fit-gaits", &gaits).expect_code(0).stdout);
    let names: Vec<&Value> = document["gaits"].as_array().unwrap().iter().map(|law| &law["gait"]).collect();
    assert_eq!(names, ["walk", "trot"]);
}

#[test]
fn wrong_calls_end_with_two_and_one_clear_line() {
    let workspace = Workspace::new();
    let cases: [(&[&str], &str); 7] = [
        (&["--only", "nonsense"], "--only nonsense: no such plate"),
        (&["--only", SALLIE, "--only", "nonsense"], "--only nonsense: no such plate"),
        (
            &["--preset", "huang-2012", "--only", "nonsense"],
            "--only nonsense: the published table has no such gait",
        ),
        (&["--nonsense"], "unexpected argument '--nonsense'"),
        (&["--preset", "nonsense"], "invalid value 'nonsense'"),
        (&["--annotations", "no-such-folder"], "no-such-folder: cannot read the annotations folder"),
        (&["--annotations", ANNOTATION], "cannot read the annotations folder"),
    ];
    for (arguments, message) in cases {
        let run = workspace.fit_gaits(arguments).expect_code(2);
        let errors = run.stderr.lines().filter(|line| line.starts_with("error: ") && line.contains(message));
        assert_eq!(errors.count(), 1, "{arguments:?}: {}", run.stderr);
        assert!(run.stdout.is_empty() && !run.stderr.contains("panicked"), "{arguments:?}");
        assert!(!workspace.path("db.json").exists() && !workspace.path("report").exists(), "{arguments:?}");
    }
    let run = workspace.run("muybridge", &["nonsense"]).expect_code(2);
    assert!(run.stderr.contains("unrecognized subcommand 'nonsense'"), "{}", run.stderr);
}

#[test]
fn annotations_check_says_good_or_what_is_wrong() {
    let workspace = Workspace::new();
    let run = workspace.run("muybridge", &["annotations", "check", SALLIE]).expect_code(0);
    assert!(run.stdout.contains("good (12 panels, images absent)"), "{}", run.stdout);
    workspace.edit(ANNOTATION, |annotation| annotation["visible_sd_px"] = (-1.0).into());
    let run = workspace.run("muybridge", &["annotations", "check", SALLIE, "nonsense"]).expect_code(1);
    let said = format!("{}{}", run.stdout, run.stderr);
    assert!(said.contains(ANNOTATION) && said.contains("visible_sd_px") && said.contains("2 of 2"), "{said}");
    assert!(said.contains("annotations/nonsense.json: cannot be read"), "{said}");
}

#[test]
fn annotations_compare_measures_two_passes() {
    let workspace = Workspace::new();
    workspace.edit(ANNOTATION, |_| {});
    let text = workspace.text(ANNOTATION);
    workspace.write("second.json", &text);
    let same = workspace.run("muybridge", &["annotations", "compare", SALLIE, "second.json"]).expect_code(0);
    assert!(same.stdout.contains("distance median 0.0 px"), "{}", same.stdout);
    workspace.edit("second.json", |annotation| {
        for panel in annotation["panels"].as_array_mut().unwrap() {
            for point in panel["keypoints"].as_object_mut().unwrap().values_mut() {
                let Some(x) = point.get("at_px").and_then(|at| at[0].as_f64()) else { continue };
                point["at_px"][0] = (x + 3.0).into();
            }
        }
    });
    let moved = workspace.run("muybridge", &["annotations", "compare", SALLIE, "second.json"]).expect_code(0);
    assert!(moved.stdout.contains("distance median 3.0 px"), "{}", moved.stdout);
    let missing =
        workspace.run("muybridge", &["annotations", "compare", SALLIE, "nonsense.json"]).expect_code(1);
    assert!(missing.stderr.contains("nonsense.json: cannot be read"), "{}", missing.stderr);
}

#[test]
fn annotations_show_draws_on_blank_paper_without_the_photograph() {
    let workspace = Workspace::new();
    let show = |more: &[&str]| {
        let run = workspace
            .run("muybridge", &[&["annotations", "show", SALLIE, "--out", "sheet.png"], more].concat());
        let run = run.expect_code(0);
        assert!(run.stderr.contains("blank paper"), "{}", run.stderr);
        image::open(workspace.path("sheet.png")).unwrap().to_rgb8()
    };
    let points = show(&["--points-only", "--zoom", "1", "--panels", "3,4"]);
    let fit = show(&["--zoom", "1", "--panels", "3,4"]);
    assert_eq!(points.dimensions(), fit.dimensions());
    let red = |picture: &image::RgbImage| picture.pixels().filter(|pixel| pixel.0 == [255, 40, 40]).count();
    assert!(red(&points) > 50, "the placed points are drawn");
    assert_ne!(points, fit, "the fit is drawn over them");
    let all = show(&["--points-only", "--zoom", "1"]);
    assert!(all.height() > points.height());
}

#[test]
fn annotations_show_draws_over_the_photograph_and_refuses_another() {
    let Some(photograph) = shared_folder().and_then(|shared| photograph(&shared.join("plates").join(SALLIE)))
    else {
        println!("skipped: no shared plates");
        return;
    };
    let workspace = Workspace::new();
    let photograph = photograph.to_string_lossy().into_owned();
    let arguments = ["annotations", "show", SALLIE, "--points-only", "--zoom", "1", "--out", "sheet.png"];
    let blank = workspace.run("muybridge", &arguments).expect_code(0);
    assert!(blank.stderr.contains("blank paper"));
    let blank = image::open(workspace.path("sheet.png")).unwrap().to_rgb8();
    let over =
        workspace.run("muybridge", &[&arguments[..], &["--image", &photograph]].concat()).expect_code(0);
    assert!(over.stderr.is_empty(), "{}", over.stderr);
    let over = image::open(workspace.path("sheet.png")).unwrap().to_rgb8();
    assert_eq!(over.dimensions(), blank.dimensions());
    assert_ne!(over, blank);
    let other =
        workspace.run("muybridge", &[&arguments[..], &["--image", "sheet.png"]].concat()).expect_code(1);
    assert!(other.stderr.contains("sheet.png: not the image"), "{}", other.stderr);
}

/// The plate's image in a folder, told by its hash.
fn photograph(folder: &Path) -> Option<std::path::PathBuf> {
    let workspace = Workspace::new();
    let manifest = workspace.json(&format!("plates/{SALLIE}.json"));
    let wanted = manifest["images"][0]["sha256"].as_str()?.to_string();
    let entries = std::fs::read_dir(folder).ok()?;
    entries
        .filter_map(|entry| Some(entry.ok()?.path()))
        .find(|path| hash_file(path).is_ok_and(|hash| hash == wanted))
}

#[test]
fn the_catalogue_is_listed_by_gait_and_animal() {
    let list = |arguments: &[&str]| {
        let mut command = Command::new(program("muybridge"));
        command.current_dir(repository()).args(["plates", "list"]).args(arguments).output().unwrap()
    };
    let all = String::from_utf8(list(&[]).stdout).unwrap();
    assert_eq!(all.lines().count(), 76, "a header and plates 574 to 648");
    let canters = String::from_utf8(list(&["--gait", "canter"]).stdout).unwrap();
    assert!(canters.contains("616") && canters.lines().skip(1).all(|line| line.contains("canter")));
    let daisy = String::from_utf8(list(&["--animal", "daisy"]).stdout).unwrap();
    assert!(daisy.lines().skip(1).all(|line| line.contains("Daisy")) && daisy.lines().count() > 2);
    assert_eq!(list(&["--animal", "bucephalus"]).status.code(), Some(1));
    assert_eq!(list(&["--gait", "prance"]).status.code(), Some(2));
}
