//! Hostile and damaged files dropped on the window: a message each, no panic, no waiting for ever, and the open plate with
//! its unsaved change untouched.

#![allow(clippy::unwrap_used, reason = "a test stops at the first thing it cannot do")]

mod hostile_files;

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use annotator::app::{Annotator, Places};
use annotator::session::{Page, Tool};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use hostile_files::{Dropped, Specimen, hostile_files, odd_plates};
use muybridge_capture::{Draft, Keypoint};

/// Time in which a file is refused or opened: a hundred times what the slowest takes.
const LONGEST: Duration = Duration::from_secs(30);
/// Headings of the questions that a plate which opened leads to, and the answer that leaves everything as it was.
const QUESTIONS: [(&str, &str); 2] =
    [("Save the changes?", "Cancel"), ("There is unsaved work", "Decide later")];

#[derive(Debug)]
struct File(PathBuf);

impl egui::DroppedFile for File {
    fn path(&self) -> &Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        Err("the program reads files by their path".into())
    }
}

type Window = Harness<'static, Option<Annotator>>;

/// The program with a plate open, as far as it goes without a display.
fn window(state: &Path, path: &Path) -> Window {
    let ui = |ui: &mut egui::Ui, annotator: &mut Option<Annotator>| {
        if let Some(annotator) = annotator {
            annotator.ui(ui);
        }
    };
    let mut window =
        Harness::builder().with_size([1200.0, 800.0]).allow_missing_glyphs().build_ui_state(ui, None);
    let places = Places { state: Some(state.to_path_buf()), plates: state.join("plates") };
    let context = window.ctx.clone();
    let mut annotator = Annotator::new(&context, places, Some(path));
    annotator.wait_until_open(&context);
    *window.state_mut() = Some(annotator);
    window.run_steps(3);
    window
}

fn program(window: &mut Window) -> &mut Annotator {
    window.state_mut().as_mut().unwrap()
}

/// What must not change.
#[derive(Debug, PartialEq)]
struct OpenPlate {
    path: PathBuf,
    draft: Draft,
    undo: Option<String>,
    is_changed: bool,
    journal: Vec<u8>,
}

fn open_plate(window: &mut Window, journals: &Path) -> OpenPlate {
    let document = &program(window).session.as_ref().unwrap().document;
    let stem = document.annotation_path().file_stem().unwrap().to_string_lossy().into_owned();
    let journal = std::fs::read_dir(journals).unwrap().map(|entry| entry.unwrap().path());
    let own = |path: &PathBuf| path.file_name().unwrap().to_string_lossy().starts_with(&format!("{stem}-"));
    OpenPlate {
        path: document.annotation_path().to_path_buf(),
        draft: document.draft().clone(),
        undo: document.undo_label().map(String::from),
        is_changed: document.is_changed(),
        journal: std::fs::read(journal.filter(own).max().unwrap()).unwrap(),
    }
}

/// What the window said to a file.
#[derive(Debug)]
enum Answer {
    Message(String),
    /// It is a plate: the window asks what becomes of the one that is open.
    Question,
}

fn drop_file(window: &mut Window, path: &Path) -> Answer {
    let last = |window: &mut Window| {
        let messages = program(window).messages.all();
        (messages.len(), messages.last().map(|message| message.text.clone()))
    };
    let before = last(window);
    window.input_mut().dropped_files.push(Arc::new(File(path.to_path_buf())));
    let started = Instant::now();
    loop {
        window.step();
        let after = last(window);
        let spoken = after != before;
        if spoken {
            // What is wrong with a plate that opens all the same is said together with the question.
            window.run_steps(2);
        }
        for (heading, leave) in QUESTIONS {
            if window.query_by_label(heading).is_some() {
                // In its first frame a window is not yet in its place.
                window.run_steps(2);
                window.get_by_label(leave).click();
                window.run_steps(3);
                assert!(window.query_by_label(heading).is_none(), "{}: {heading}", path.display());
                return Answer::Question;
            }
        }
        if spoken {
            return Answer::Message(after.1.unwrap());
        }
        assert!(started.elapsed() < LONGEST, "{}: no answer", path.display());
        std::thread::sleep(Duration::from_millis(1));
    }
}

#[test]
fn a_hostile_file_gives_a_message_and_leaves_the_open_plate_alone() {
    let folder = tempfile::tempdir().unwrap();
    let state = folder.path().join("state");
    let open = Specimen::read().unpack(&folder.path().join("open"), "open-plate");
    let mut window = window(&state, &open);
    let poll = Keypoint::from_name("poll").unwrap();
    let session = program(&mut window).session.as_mut().unwrap();
    session.edit("A change that is not saved", |draft| draft.panel_mut(1).keypoints.remove(poll));
    let journals = state.join("journals");
    let before = open_plate(&mut window, &journals);
    assert!(before.is_changed);
    let files = hostile_files(&folder.path().join("hostile"), &journals);
    let (mut refused, mut slowest) = (0, (Duration::ZERO, String::new()));
    for Dropped { path, may_open } in &files {
        let started = Instant::now();
        let answer = drop_file(&mut window, path);
        window.run_steps(2);
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        slowest = slowest.max((started.elapsed(), name));
        match &answer {
            Answer::Message(text) => {
                refused += 1;
                if std::env::var_os("SHOW_MESSAGES").is_some() {
                    println!("{}", text.chars().take(300).collect::<String>());
                }
                assert!(!text.contains("stopped unexpectedly"), "{}: a panic: {text}", path.display());
                assert!(
                    text.len() > 20 && text.contains(": "),
                    "{}: says too little: {text}",
                    path.display()
                );
            }
            Answer::Question => assert!(may_open, "{}: opened", path.display()),
        }
        assert!(open_plate(&mut window, &journals) == before, "{}: changed what is open", path.display());
    }
    println!("{} files, {refused} refused, the slowest {slowest:?}", files.len());
    assert!(files.len() >= 100 && refused >= 90);
}

#[test]
fn odd_but_valid_plates_are_shown_on_every_page() {
    let folder = tempfile::tempdir().unwrap();
    for (at, path) in odd_plates(&folder.path().join("odd")).iter().enumerate() {
        let started = Instant::now();
        let mut window = window(&folder.path().join(format!("state-{at}")), path);
        let messages = program(&mut window).messages.all().to_vec();
        assert!(program(&mut window).session.is_some(), "{}: {messages:?}", path.display());
        for page in [Page::Plate, Page::Calibrate, Page::Pose, Page::Gait, Page::Play] {
            for tool in [Tool::Guided, Tool::Skeleton] {
                let session = program(&mut window).session.as_mut().unwrap();
                (session.page, session.tool) = (page, tool);
                session.shown.ghost_photograph = true;
                session.shown.hoof_trails = true;
                window.run_steps(2);
            }
        }
        program(&mut window).session.as_mut().unwrap().shown.sheet = true;
        window.run_steps(2);
        assert!(started.elapsed() < LONGEST, "{}: {:?}", path.display(), started.elapsed());
    }
}

#[test]
fn of_several_files_dropped_at_once_one_is_opened_and_the_window_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let open = Specimen::read().unpack(&folder.path().join("open"), "open-plate");
    let other = Specimen::read().unpack(&folder.path().join("other"), "other-plate");
    let mut window = window(&folder.path().join("state"), &open);
    for path in [&open, &open, &other] {
        window.input_mut().dropped_files.push(Arc::new(File(path.clone())));
    }
    window.step();
    let text = program(&mut window).messages.all().last().unwrap().text.clone();
    assert!(text.contains("3 files") && text.contains("other-plate.json"), "{text}");
    let context = window.ctx.clone();
    program(&mut window).wait_until_open(&context);
    assert_eq!(program(&mut window).session.as_ref().unwrap().document.annotation_path(), other);
}
