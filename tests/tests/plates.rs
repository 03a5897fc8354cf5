//! `muybridge plates` as a process: fetching from a server on loopback, adding, splitting, showing, drawing specimens.

#![allow(clippy::unwrap_used, reason = "a test stops at the first thing it cannot do")]

#[path = "../../crates/imaging/tests/iiif_server/mod.rs"]
mod iiif_server;

use iiif_server::{Fault, Request, Server, Service};
use muybridge_capture::Manifest;
use muybridge_cli::specimens::kept;
use muybridge_core::Gait;
use muybridge_tests::{Workspace, program};

/// Writes a catalogue of one plate, number 616, that a service has.
fn catalogue(workspace: &Workspace, address: &str) {
    let text = format!(
        "schema = 1\nholder = \"a holder\"\nlicence = \"public domain\"\n[[plate]]\nnumber = 616\nanimal = \"Daisy\"\n\
         action = \"cantering, saddled\"\ngait = \"canter\"\niiif = \"{address}\"\nobject_id = 7\n"
    );
    workspace.write("plates/catalogue.toml", &text);
}

fn manifest(workspace: &Workspace, id: &str) -> Manifest {
    Manifest::read(&workspace.path(&format!("plates/{id}.json"))).unwrap()
}

#[test]
fn a_fetched_plate_has_a_manifest_with_hash_and_panels() {
    let server = Server::start(kept(Gait::Canter).picture, Service::default());
    let workspace = Workspace::new();
    catalogue(&workspace, &server.address());
    let run = workspace.run("muybridge", &["plates", "fetch", "616"]).expect_code(0);
    let manifest_text = workspace.text("plates/animal-locomotion-616.json");
    let found = manifest(&workspace, "animal-locomotion-616");
    assert_eq!(found.panels.len(), 12);
    assert_eq!((found.gait, found.facing, found.calibration), (Gait::Canter, None, None));
    let picture = workspace.path("cache/animal-locomotion-616.jpg");
    assert_eq!(muybridge_capture::hash_file(&picture).unwrap(), found.images[0].sha256);
    assert!(run.stdout.contains(&found.images[0].sha256), "{}", run.stdout);
    assert!(
        !workspace.path("plates/animal-locomotion-616.jpg").exists(),
        "photographs stay out of the repository"
    );

    // A second time nothing is asked for, and what a person has written into the manifest stays.
    let requests = server.requests().len();
    workspace.write(
        "plates/animal-locomotion-616.json",
        &manifest_text.replace("\"facing\": null", "\"facing\": \"left\""),
    );
    workspace.run("muybridge", &["plates", "fetch", "616"]).expect_code(0);
    assert_eq!(server.requests().len(), requests);
    assert!(workspace.text("plates/animal-locomotion-616.json").contains("\"facing\": \"left\""));

    // Everything else takes the plate by its number.
    let run = workspace.run("muybridge", &["plates", "split", "616", "--out", "panels.png"]).expect_code(0);
    assert!(
        run.stdout.lines().filter(|line| line.trim_start().starts_with(|c: char| c.is_ascii_digit())).count()
            == 12
    );
    workspace.run("muybridge", &["plates", "show", "616", "--out", "seen.png"]).expect_code(0);
    for name in ["panels.png", "seen.png"] {
        assert!(image::open(workspace.path(name)).unwrap().width() > 400);
    }
}

#[test]
fn a_plate_that_cannot_be_had_is_named_and_leaves_nothing() {
    let away = {
        // A port that was free a moment ago and that nobody listens at.
        let listener = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
        format!("http://127.0.0.1:{}/iiif/x", listener.local_addr().unwrap().port())
    };
    let html =
        Server::start_with_faults(kept(Gait::Trot).picture, Service::default(), |request: &Request| {
            request.path.ends_with(".jpg").then(|| Fault::Content("text/html", b"<!DOCTYPE html>".to_vec()))
        });
    for (address, says) in [(away.as_str(), "127.0.0.1"), (html.address().as_str(), "DOCTYPE")] {
        let workspace = Workspace::new();
        catalogue(&workspace, address);
        let run = workspace.run("muybridge", &["plates", "fetch", "616"]).expect_code(1);
        assert!(run.stderr.contains("plate 616") && run.stderr.contains(says), "{}", run.stderr);
        assert!(!workspace.path("plates/animal-locomotion-616.json").exists());
        assert_eq!(std::fs::read_dir(workspace.path("cache")).unwrap().count(), 0);
    }
    let workspace = Workspace::new();
    catalogue(&workspace, "https://example.org/x");
    let run = workspace.run("muybridge", &["plates", "fetch", "1"]).expect_code(1);
    assert!(run.stderr.contains("plate 1: not in the catalogue"), "{}", run.stderr);
}

#[test]
fn a_scan_or_a_folder_of_frames_of_ones_own_is_a_plate() {
    let workspace = Workspace::new();
    let specimen = kept(Gait::Trot);
    specimen.picture.save(workspace.path("my scan.png")).unwrap();
    let add = |arguments: &[&str]| workspace.run("muybridge", &[&["plates", "add"], arguments].concat());
    assert!(add(&["my scan.png", "--gait", "trot"]).expect_code(1).stderr.contains("--id"));
    add(&["my scan.png", "--gait", "trot", "--id", "my-scan", "--facing", "right"]).expect_code(0);
    assert_eq!(manifest(&workspace, "my-scan").panels.len(), 12);

    std::fs::create_dir(workspace.path("frames")).unwrap();
    for (n, panel) in (8..).zip(&specimen.truth.panels[..4]) {
        let [[left, top], _, [right, bottom], _] = panel.quad_px.map(|corner| corner.map(|v| v as u32));
        let frame = image::imageops::crop_imm(
            &specimen.picture,
            left + 4,
            top + 4,
            right - left - 8,
            bottom - top - 8,
        );
        frame.to_image().save(workspace.path(&format!("frames/frame-{n}.png"))).unwrap();
    }
    add(&["frames", "--gait", "trot"]).expect_code(0);
    let frames = manifest(&workspace, "frames");
    assert_eq!(frames.panels.iter().map(|panel| panel.image).collect::<Vec<_>>(), [0, 1, 2, 3]);
    assert_eq!(frames.images[1].file, "frames/frame-9.png");
    workspace.run("muybridge", &["plates", "show", "frames", "--out", "seen.png"]).expect_code(0);

    workspace.write("text.jpg", "This is no picture.");
    assert!(add(&["text.jpg", "--gait", "walk"]).expect_code(1).stderr.contains("text.jpg: not a JPEG"));
    assert!(!workspace.path("plates/text.json").exists() && !workspace.path("cache/text.jpg").exists());
}

#[test]
fn panels_corrected_by_hand_are_not_lost() {
    let workspace = Workspace::new();
    kept(Gait::Rack).picture.save(workspace.path("rack.png")).unwrap();
    workspace.run("muybridge", &["plates", "add", "rack.png", "--gait", "rack"]).expect_code(0);
    workspace.edit("plates/rack.json", |manifest| manifest["panels"][0]["quad_px"][0][0] = 61.5.into());
    let corrected = workspace.text("plates/rack.json");
    let split = |more: &[&str]| {
        workspace.run("muybridge", &[&["plates", "split", "rack", "--out", "panels.png"], more].concat())
    };
    split(&[]).expect_code(0);
    assert!(split(&["--write"]).expect_code(1).stderr.contains("--replace"));
    assert_eq!(workspace.text("plates/rack.json"), corrected);
    split(&["--write", "--replace"]).expect_code(0);
    assert_ne!(workspace.text("plates/rack.json"), corrected);
}

#[test]
fn a_specimen_is_a_plate_with_its_truth() {
    let workspace = Workspace::new();
    workspace
        .run("muybridge", &["plates", "specimen", "walk", "--seed", "5", "--out", "drawn"])
        .expect_code(0);
    let id = "specimen-walk-5";
    assert!(workspace.text(&format!("drawn/{id}.truth.json")).contains("NOT A PHOTOGRAPH"));
    let annotation = format!("drawn/annotations/{id}.json");
    workspace.run("muybridge", &["annotations", "check", &annotation]).expect_code(0);
    let manifest = format!("drawn/{id}.json");
    workspace
        .run("muybridge", &["plates", "show", &manifest, "--layers", "tracks", "--out", "tracks.png"])
        .expect_code(0);
    assert!(program("muybridge").exists());
}
