//! Wrong input, one fault at a time: the message names file, panel and field and says what to do; the other plates are
//! fitted all the same; an older database stays as it is.

#![allow(clippy::unwrap_used, reason = "a test stops at the first thing it cannot do")]

mod bad_input_cases;

use bad_input_cases::{Case, GOOD, annotations, calibrations, files, manifests, points};
use muybridge_tests::Workspace;
use serde_json::Value;

const OLD_DATABASE: &str = "an older database, worth keeping";

#[test]
fn faults_of_files_are_named_and_hurt_nothing_else() {
    check(&files());
}

#[test]
fn faults_of_annotations_are_named_and_hurt_nothing_else() {
    check(&annotations());
}

#[test]
fn faults_of_points_are_named_and_hurt_nothing_else() {
    check(&points());
}

#[test]
fn faults_of_manifests_are_named_and_hurt_nothing_else() {
    check(&manifests());
}

#[test]
fn faults_of_calibrations_are_named_and_hurt_nothing_else() {
    check(&calibrations());
}

fn check(cases: &[Case]) {
    let complaints: Vec<String> = cases.iter().flat_map(complaints).collect();
    assert!(complaints.is_empty(), "{} complaints:\n{}", complaints.len(), complaints.join("\n"));
}

/// Runs a case; what is not as it should be.
fn complaints(case: &Case) -> Vec<String> {
    let workspace = Workspace::new();
    workspace.add_good_plate(GOOD);
    workspace.write("db.json", OLD_DATABASE);
    (case.damage)(&workspace);
    let run = workspace.fit_gaits(&[&["--json"], case.arguments].concat());
    let mut wrong = Vec::new();
    let mut check = |good: bool, what: &str| {
        if !good {
            wrong.push(format!("{}: {what}; exit code {}, it said: {}", case.name, run.code, run.stderr));
        }
    };
    check(run.code == case.code, &format!("expected exit code {}", case.code));
    for part in case.says {
        check(run.stderr.contains(part), &format!("expected {part:?}"));
    }
    check(!run.stderr.contains("panicked"), "no panic");
    let line = run.stderr.lines().find(|line| line.contains(case.says[0])).unwrap_or_default();
    check(line.len() < 600, "a line of readable length");
    check(workspace.text("db.json") == OLD_DATABASE, "the database was to stay as it was");
    if case.code == 1 {
        check(strides(&run.stdout) == [GOOD], "the good plate was to be fitted");
    } else {
        check(run.stdout.is_empty(), "nothing was to be printed");
    }
    wrong
}

/// Plates of a `--json` document that were fitted.
fn strides(stdout: &str) -> Vec<String> {
    let Ok(document) = serde_json::from_str::<Value>(stdout) else { return Vec::new() };
    let strides = document["strides"].as_array().cloned().unwrap_or_default();
    strides.iter().filter_map(|stride| Some(stride["plate"].as_str()?.to_string())).collect()
}

#[test]
fn a_panel_without_a_horse_may_be_called_unused() {
    let workspace = Workspace::new();
    workspace.add_good_plate(GOOD);
    workspace.edit(&format!("annotations/{GOOD}.json"), |annotation| {
        annotation["panels"][5]["use"] = "unused".into();
        annotation["panels"][5]["keypoints"] = serde_json::json!({});
    });
    let run = workspace.fit_gaits(&["--json", "--only", GOOD]).expect_code(0);
    assert_eq!(strides(&run.stdout), [GOOD]);
}

#[test]
fn an_image_that_is_not_there_is_no_fault() {
    let workspace = Workspace::new();
    workspace.add_good_plate(GOOD);
    assert!(!workspace.path("plates/sallie-gardner-1878.jpg").exists());
    workspace.fit_gaits(&["--only", GOOD]).expect_code(0);
}

#[test]
fn a_database_or_report_that_cannot_be_written_is_named_and_the_result_still_printed() {
    // The user of a test may be allowed to write anywhere, so the places are ones where nothing can be written.
    let cases: [(&[&str], &str); 4] = [
        (
            &["--out", "no-such-folder/db.json", "--report", "report"],
            "no-such-folder/db.json: cannot be written",
        ),
        (&["--out", "a-file/db.json", "--report", "report"], "a-file/db.json: cannot be written"),
        (&["--out", "db.json", "--report", "a-file"], "a-file: cannot create the report's folder"),
        (
            &["--out", "db.json", "--report", "a-file/report"],
            "a-file/report: cannot create the report's folder",
        ),
    ];
    for (arguments, message) in cases {
        let workspace = Workspace::new();
        workspace.add_good_plate(GOOD);
        workspace.write("db.json", OLD_DATABASE);
        workspace.write("a-file", "a file where a folder is wanted");
        let all = [&["--json", "--only", GOOD], arguments].concat();
        let run = workspace.run("fit-gaits", &all).expect_code(1);
        assert!(
            run.stderr.contains(message) && !run.stderr.contains("panicked"),
            "{arguments:?}: {}",
            run.stderr
        );
        assert_eq!(strides(&run.stdout), [GOOD], "{arguments:?}");
        assert_eq!(workspace.text("db.json"), OLD_DATABASE, "{arguments:?}");
        assert_eq!(workspace.text("a-file"), "a file where a folder is wanted", "{arguments:?}");
    }
}

#[test]
fn a_folder_without_annotations_is_said_to_be_empty() {
    let workspace = Workspace::new();
    std::fs::create_dir(workspace.path("nothing")).unwrap();
    workspace.write("db.json", OLD_DATABASE);
    let run = workspace.fit_gaits(&["--annotations", "nothing"]).expect_code(1);
    assert!(run.stderr.contains("nothing: holds no annotation file"), "{}", run.stderr);
    assert_eq!(workspace.text("db.json"), OLD_DATABASE);
}
