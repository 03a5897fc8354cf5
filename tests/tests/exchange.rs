//! `muybridge annotations export` and `import` as a process: what other tools get, what comes back, and what is refused.

#![allow(clippy::unwrap_used, reason = "a test stops at the first thing it cannot do")]

use std::path::Path;
use std::process::Command;

use muybridge_capture::{
    ANNOTATION_SCHEMA, Annotation, KeypointState, Manifest, PlacedBy, hash_file, read_json,
};
use muybridge_tests::{Run, SALLIE, Workspace, assert_golden, repository, shared_folder};
use serde_json::{Value, json};

/// A drawn plate of the repository, which has its picture with it.
const SPECIMEN: &str = "plates/specimens/annotations/specimen-walk.json";

fn export(workspace: &Workspace, plate: &str, format: &str, more: &[&str]) -> Run {
    let arguments = ["annotations", "export", plate, "--format", format, "--out", format];
    workspace.run("muybridge", &[&arguments, more].concat())
}

fn import(workspace: &Workspace, files: &[&str], more: &[&str]) -> Run {
    workspace.run("muybridge", &[&["annotations", "import"], files, more].concat())
}

fn annotation(workspace: &Workspace, path: &str) -> Annotation {
    read_json(&workspace.path(path), ANNOTATION_SCHEMA).unwrap()
}

/// A copy of the repository in which Sallie Gardner's plate is not annotated, and her annotation.
fn unannotated() -> (Workspace, Annotation) {
    let workspace = Workspace::new();
    let path = format!("annotations/{SALLIE}.json");
    let known = annotation(&workspace, &path);
    std::fs::rename(workspace.path(&path), workspace.path("known.json")).unwrap();
    // The manifest is where the moved file says.
    workspace.replace("known.json", "../plates/", "plates/");
    (workspace, known)
}

#[test]
fn exported_files_are_those_that_were_checked_with_the_real_readers() {
    let workspace = Workspace::new();
    let run = export(&workspace, SALLIE, "coco", &[]).expect_code(0);
    assert_eq!((run.stdout.trim(), run.stderr.as_str()), ("coco/sallie-gardner-1878.coco.json", ""));
    let run = export(&workspace, SALLIE, "deeplabcut", &["--scorer", "me"]).expect_code(0);
    assert!(run.stderr.contains("122 occluded points"), "{}", run.stderr);
    export(&workspace, SALLIE, "labelme", &[]).expect_code(0);
    export(&workspace, SALLIE, "csv", &[]).expect_code(0);
    for (golden, path) in [
        ("exchange-coco.json", "coco/sallie-gardner-1878.coco.json"),
        ("exchange-deeplabcut.yaml", "deeplabcut/config.yaml"),
        ("exchange-deeplabcut.csv", "deeplabcut/labeled-data/sallie-gardner-1878/CollectedData_me.csv"),
        ("exchange-labelme.json", "labelme/panel_01.json"),
    ] {
        assert_golden(golden, &workspace.text(path));
    }
    let table = workspace.text("csv/sallie-gardner-1878.csv");
    assert!(table.starts_with("panel,keypoint,x_px,y_px,state,by\n1,muzzle,574.2,207.8,visible,hand\n"));
    assert_eq!(table.lines().count(), 1 + 12 * 26);
}

#[test]
fn what_is_exported_comes_back_onto_the_plate() {
    for (format, space, states) in [
        ("csv", "plate", true),
        ("coco", "panel", true),
        ("coco", "plate", true),
        ("labelme", "panel", true),
        ("labelme", "plate", true),
        ("deeplabcut", "panel", false),
    ] {
        let (workspace, known) = unannotated();
        export(&workspace, "known.json", format, &["--space", space, "--scorer", "me"]).expect_code(0);
        let file = match format {
            "csv" => "csv/sallie-gardner-1878.csv",
            "coco" => "coco/sallie-gardner-1878.coco.json",
            "labelme" => "labelme",
            _ => "deeplabcut/labeled-data/sallie-gardner-1878/CollectedData_me.csv",
        };
        let run = import(&workspace, &[file], &["--into", SALLIE]).expect_code(0);
        assert!(
            run.stdout.contains("312 points added, 0 replaced, 0 the same as before, 0 left away"),
            "{}",
            run.stdout
        );
        assert_eq!(run.stderr, "", "{format}");
        let back = annotation(&workspace, &format!("annotations/{SALLIE}.json"));
        assert_eq!(back.plate, known.plate);
        for (panel, there) in known.panels.iter().zip(&back.panels) {
            assert_eq!(panel.panel, there.panel);
            for (keypoint, placed) in panel.keypoints.iter() {
                let found = there.keypoints.get(keypoint).unwrap();
                let state = if states { placed.state } else { KeypointState::Visible };
                assert_eq!((found.state, found.by), (state, PlacedBy::Hand));
                let ([ax, ay], [bx, by]) = (placed.at_px.unwrap(), found.at_px.unwrap());
                assert!((ax - bx).hypot(ay - by) < 1e-6, "{format} {space}: {keypoint} of {}", panel.panel);
            }
        }
    }
}

#[test]
fn likelihoods_come_back_as_tracked_points_with_their_states() {
    let (workspace, known) = unannotated();
    export(&workspace, "known.json", "deeplabcut", &["--scorer", "me"]).expect_code(0);
    let file = "deeplabcut/sallie-gardner-1878DLC_me.csv";
    let run = import(&workspace, &[file], &["--into", SALLIE]).expect_code(0);
    assert!(run.stderr.contains("tracked") && run.stderr.contains("frame 0"), "{}", run.stderr);
    let back = annotation(&workspace, &format!("annotations/{SALLIE}.json"));
    let states = |annotation: &Annotation| -> Vec<KeypointState> {
        annotation.panels.iter().flat_map(|panel| panel.keypoints.iter().map(|(_, p)| p.state)).collect()
    };
    assert_eq!(states(&back), states(&known));
    assert!(back.panels[0].keypoints.iter().all(|(_, placed)| placed.by == PlacedBy::Tracked));
}

#[test]
fn a_persons_points_stay_and_nothing_is_written_over_unasked() {
    let workspace = Workspace::new();
    let path = format!("annotations/{SALLIE}.json");
    let before = workspace.text(&path);
    workspace.write(
        "mine.csv",
        "panel,keypoint,x_px,y_px\n1,muzzle,570,200\n1,poll,505,170\n2,tail,1,1\n44,poll,1,1\n3,dock,9000,1\n",
    );
    let run = import(&workspace, &["mine.csv"], &["--into", SALLIE]).expect_code(1);
    assert!(run.stderr.contains("is there already") && run.stderr.contains("--out"), "{}", run.stderr);
    assert_eq!(workspace.text(&path), before);

    workspace.edit(&path, |document| {
        document["panels"][0]["keypoints"].as_object_mut().unwrap().remove("poll");
    });
    std::fs::create_dir(workspace.path("other")).unwrap();
    let run =
        import(&workspace, &["mine.csv"], &["--into", SALLIE, "--out", "other/merged.json"]).expect_code(0);
    assert!(
        run.stdout.contains("1 points added, 0 replaced, 0 the same as before, 1 left away"),
        "{}",
        run.stdout
    );
    for said in
        ["no keypoint of ours is called that (tail)", "no panel of the plate (panel 44)", "dock of panel 3"]
    {
        assert!(run.stderr.contains(said), "{said}: {}", run.stderr);
    }
    let merged = annotation(&workspace, "other/merged.json");
    let first = |annotation: &Annotation| {
        annotation.panels[0].keypoints.iter().map(|(_, p)| p.at_px).collect::<Vec<_>>()
    };
    assert_eq!(first(&merged)[..2], [Some([574.2, 207.8]), Some([505.0, 170.0])]);
    // It names the manifest from where it lies, so it can be used there.
    workspace.run("muybridge", &["annotations", "check", "other/merged.json"]).expect_code(0);

    import(&workspace, &["mine.csv"], &["--into", SALLIE, "--replace"]).expect_code(0);
    assert_eq!(first(&annotation(&workspace, &path))[0], Some([570.0, 200.0]));
}

#[test]
fn work_done_in_an_exported_file_is_not_written_over() {
    let workspace = Workspace::new();
    export(&workspace, SALLIE, "labelme", &[]).expect_code(0);
    export(&workspace, SALLIE, "labelme", &[]).expect_code(0);
    workspace.replace("labelme/panel_03.json", "\"muzzle\"", "\"poll\"");
    let edited = workspace.text("labelme/panel_03.json");
    let run = export(&workspace, SALLIE, "labelme", &[]).expect_code(1);
    assert!(run.stderr.contains("panel_03.json") && run.stderr.contains("--replace"), "{}", run.stderr);
    assert_eq!(workspace.text("labelme/panel_03.json"), edited);
    export(&workspace, SALLIE, "labelme", &["--replace"]).expect_code(0);
    assert_ne!(workspace.text("labelme/panel_03.json"), edited);
}

#[test]
fn other_names_go_through_a_table() {
    let (workspace, _) = unannotated();
    let table =
        "scorer,S,S,S,S\nbodyparts,Nearknee,Nearknee,Eye,Eye\ncoords,x,y,x,y\nimg002.png,200,150,10,10\n";
    workspace.write("theirs.csv", table);
    workspace.write("names.json", "{ \"eye\": null, \"NEARKNEE\": \"near_knee\" }");
    let run = import(&workspace, &["theirs.csv"], &["--into", SALLIE, "--map", "names.json"]).expect_code(0);
    assert_eq!(run.stderr, "");
    let back = annotation(&workspace, &format!("annotations/{SALLIE}.json"));
    assert_eq!((back.panels.len(), back.panels[0].panel), (1, 2));
    workspace.write("names.json", "{ \"eye\": \"nostril\" }");
    let again = ["--into", SALLIE, "--map", "names.json", "--out", "x.json"];
    assert!(import(&workspace, &["theirs.csv"], &again).expect_code(1).stderr.contains("nostril"));
    workspace.write("names.json", "[1]");
    assert!(import(&workspace, &["theirs.csv"], &again).expect_code(1).stderr.contains("names.json: names"));
}

#[test]
fn what_cannot_be_read_is_named_and_leaves_nothing() {
    let (workspace, _) = unannotated();
    workspace.write("empty.csv", "");
    workspace.write("cut.json", "{\"images\": [], \"annotations\": [{\"id\": 1,");
    workspace.write("none.csv", "panel,keypoint,x_px,y_px\n1,tail,1,1\n");
    // A hole of 100 MB in the file system, read no farther than anything useful goes.
    std::fs::File::create(workspace.path("huge.csv")).unwrap().set_len(100 << 20).unwrap();
    std::fs::create_dir(workspace.path("folder")).unwrap();
    for (file, says) in [
        ("missing.csv", "missing.csv"),
        ("empty.csv", "empty"),
        ("cut.json", "no valid JSON"),
        ("none.csv", "no point could be taken over"),
        ("huge.csv", "too many"),
        ("folder", "no labelme files"),
    ] {
        let run = import(&workspace, &[file], &["--into", SALLIE]).expect_code(1);
        assert!(run.stderr.contains(says), "{file}: {}", run.stderr);
        assert!(!workspace.path(&format!("annotations/{SALLIE}.json")).exists());
    }
    import(&workspace, &["empty.csv"], &["--into", "no-such-plate"]).expect_code(1);
    import(&workspace, &["empty.csv"], &["--into", SALLIE, "--format", "xml"]).expect_code(2);
    for (format, more, says) in [
        ("deeplabcut", ["--space", "plate"], "deeplabcut files cannot hold plate coordinates"),
        ("csv", ["--space", "panel"], "csv files cannot hold panel coordinates"),
        ("deeplabcut", ["--scorer", "../me"], "cannot be part of a file name"),
    ] {
        let run = export(&workspace, "known.json", format, &more).expect_code(1);
        assert!(run.stderr.contains(says), "{}", run.stderr);
    }
    let run = export(&workspace, "known.json", "coco", &["--images"]).expect_code(1);
    assert!(run.stderr.contains("not on this machine"), "{}", run.stderr);
    assert!(!workspace.path("coco").exists(), "all is ready before anything is written");
}

#[test]
fn pictures_are_cut_out_as_the_files_say() {
    let workspace = Workspace::new();
    let specimen = repository().join(SPECIMEN);
    export(&workspace, specimen.to_str().unwrap(), "coco", &["--images"]).expect_code(0);
    let coco = workspace.json("coco/specimen-walk.coco.json");
    let images = coco["images"].as_array().unwrap();
    assert_eq!(images.len(), 12);
    for image in images {
        let picture = workspace.path("coco").join(image["file_name"].as_str().unwrap());
        let (width, height) = image::image_dimensions(picture).unwrap();
        assert_eq!(json!([width, height]), json!([image["width"], image["height"]]));
    }
    // A plate as one picture is copied as it is.
    let plate = ["--space", "plate", "--images", "--replace"];
    export(&workspace, specimen.to_str().unwrap(), "coco", &plate).expect_code(0);
    let manifest = Manifest::read(&repository().join("plates/specimens/specimen-walk.json")).unwrap();
    assert_eq!(hash_file(&workspace.path("coco/specimen-walk.jpg")).unwrap(), manifest.images[0].sha256);
}

/// A plate of single files, as other tools' fixtures have them.
fn plate_of_files(workspace: &Workspace, files: &[&str]) {
    let mut manifest: Value = workspace.json(&format!("plates/{SALLIE}.json"));
    let images = files
        .iter()
        .map(|file| json!({ "file": file, "sha256": "0".repeat(64), "width_px": 60, "height_px": 40 }));
    let panels = (0..files.len()).map(|index| {
        json!({ "panel": index + 1, "image": index, "quad_px": [[0, 0], [60, 0], [60, 40], [0, 40]] })
    });
    manifest["id"] = "files".into();
    manifest["images"] = images.collect();
    manifest["panels"] = panels.collect();
    manifest["calibration"] = Value::Null;
    workspace.write("plates/files.json", &manifest.to_string());
}

#[test]
fn files_of_the_real_libraries_are_read() {
    let fixtures = shared_folder().map(|folder| folder.join("reference/interop-fixtures"));
    let Some(fixtures) = fixtures.filter(|folder| folder.is_dir()) else {
        println!("skipped: no folder shared/reference/interop-fixtures next to the repository");
        return;
    };
    let cases: [(&str, &[&str], Value, usize); 2] = [
        ("ref_coco.json", &["p01.png", "p02.png", "p03.png"], json!({ "hoof": "near_fore_hoof" }), 7),
        ("CollectedData_S.csv", &["img000.png", "img001.png"], json!({ "A": "dock", "B": "poll" }), 3),
    ];
    for (fixture, files, names, count) in cases {
        let workspace = Workspace::new();
        plate_of_files(&workspace, files);
        workspace.write("names.json", &names.to_string());
        let path = fixtures.join(fixture);
        let into = ["--into", "files", "--map", "names.json"];
        let run = import(&workspace, &[path.to_str().unwrap()], &into).expect_code(0);
        assert!(run.stdout.contains(&format!("{count} points added")), "{}", run.stdout);
        let back = annotation(&workspace, "annotations/files.json");
        let first = back.panels[0].keypoints.iter().next().unwrap().1.at_px;
        // In the files 10.5, 5.25 and 2, 3, where the first pixel's centre is 0.
        assert_eq!(first, Some(if fixture.ends_with("json") { [11.0, 5.75] } else { [2.5, 3.5] }));
    }
    let workspace = Workspace::new();
    plate_of_files(&workspace, &["img000.png"]);
    let path = fixtures.join("CollectedData_S.h5");
    let run = import(&workspace, &[path.to_str().unwrap()], &["--into", "files"]).expect_code(1);
    assert!(run.stderr.contains("HDF5") && run.stderr.contains("CSV"), "{}", run.stderr);
}

/// Exports a plate in all formats and lets the installed readers look at it. They open the pictures too.
fn read_with_the_real_readers(annotation: &Path, manifest: &Path) {
    if !manifest.with_extension("jpg").exists() {
        println!("skipped: the picture of {} is not on this machine", manifest.display());
        return;
    }
    let workspace = Workspace::new();
    for format in ["deeplabcut", "coco", "labelme", "csv"] {
        let images: &[&str] = if format == "csv" { &[] } else { &["--images"] };
        export(&workspace, annotation.to_str().unwrap(), format, images).expect_code(0);
    }
    let script = repository().join("tests/readers/annotations.py");
    let run = Run::of(Command::new("python3").arg(script).arg(workspace.path("")).arg(manifest));
    print!("{}", run.stdout);
    run.expect_code(0);
}

#[test]
fn the_tools_themselves_see_our_points() {
    if Command::new("python3").arg("--version").output().is_err() {
        println!("skipped: no python3");
        return;
    }
    for (annotation, manifest) in [
        (SPECIMEN.to_string(), "plates/specimens/specimen-walk.json".to_string()),
        (format!("annotations/{SALLIE}.json"), format!("plates/{SALLIE}.json")),
    ] {
        read_with_the_real_readers(&repository().join(annotation), &repository().join(manifest));
    }
}
