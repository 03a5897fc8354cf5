//! `muybridge footprints` as a user runs it: every example track solved, drawn and laid; and tracks that cannot be walked.

#![allow(clippy::unwrap_used, reason = "a test stops at the first thing it cannot do")]

use std::path::PathBuf;
use std::time::{Duration, Instant};

use image::AnimationDecoder;
use muybridge_tests::{Run, Workspace, program, repository};
use serde_json::{Value, json};

/// Longest a program may think about any track here: a machine that does other things besides is no reason to fail.
const PATIENCE: Duration = Duration::from_secs(20);

fn footprints(workspace: &Workspace, arguments: &[&str]) -> Run {
    // Built before the clock starts.
    program("muybridge");
    let start = Instant::now();
    let run = workspace.run("muybridge", &[&["footprints"], arguments].concat());
    assert!(start.elapsed() < PATIENCE, "{arguments:?} took {:?}", start.elapsed());
    assert!(!run.stderr.contains("panicked"), "{arguments:?}: {}", run.stderr);
    run
}

/// The tracks of the repository.
fn tracks() -> Vec<PathBuf> {
    let folder = repository().join("docs/footprints/tracks");
    let mut paths: Vec<PathBuf> =
        std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|ending| ending == "json"));
    paths.sort();
    assert!(paths.len() >= 8);
    paths
}

fn track(name: &str) -> String {
    repository().join(format!("docs/footprints/tracks/{name}.json")).display().to_string()
}

fn bytes(workspace: &Workspace, file: &str) -> Vec<u8> {
    std::fs::read(workspace.path(file)).unwrap()
}

/// A bird's track of so many prints, so far apart.
fn straight(prints: usize, step_m: f64) -> Value {
    let print = |i: usize| {
        let (foot, z) = if i.is_multiple_of(2) { ("L", -0.05) } else { ("R", 0.05) };
        json!({ "foot": foot, "at_m": [i as f64 * step_m, z], "heading_deg": 0.0 })
    };
    json!({ "schema": 1, "model": "bird", "prints": (0..prints).map(print).collect::<Vec<_>>() })
}

#[test]
fn every_track_of_the_repository_is_solved_alike_twice() {
    let workspace = Workspace::new();
    for path in tracks() {
        let path = path.display().to_string();
        let solve = |out: &str| footprints(&workspace, &["solve", &path, "--out", out]).expect_code(0).stdout;
        let (first, second) = (solve("a.json"), solve("b.json"));
        let energy =
            first.lines().find(|line| line.starts_with("gradient")).unwrap_or_else(|| panic!("{first}"));
        let numbers: Vec<f64> = energy.split_whitespace().filter_map(|word| word.parse().ok()).collect();
        assert!((numbers[0] - numbers[1] - numbers[2]).abs() < 2e-4 && numbers[0] > 0.0, "{path}: {energy}");
        assert!(!energy.contains("not converged"), "{path}: {energy}");
        assert_eq!(first.replace("a.json", ""), second.replace("b.json", ""), "{path}");
        assert_eq!(bytes(&workspace, "a.json"), bytes(&workspace, "b.json"), "{path}");
    }
}

#[test]
fn the_solution_holds_feet_on_their_prints() {
    let workspace = Workspace::new();
    footprints(&workspace, &["solve", &track("bird-walk"), "--out", "bird.json", "--rate", "50"])
        .expect_code(0);
    let bird = workspace.json("bird.json");
    assert_eq!((&bird["schema"], &bird["model"]), (&json!(1), &json!("bird")));
    let names: Vec<&str> = bird["joints"].as_array().unwrap().iter().map(|n| n.as_str().unwrap()).collect();
    let (heel, toe) = (
        names.iter().position(|name| *name == "right_heel").unwrap(),
        names.iter().position(|name| *name == "right_toe").unwrap(),
    );
    let number = |value: &Value| value.as_f64().unwrap();
    let print = &bird["prints"][3];
    assert_eq!(print["foot"], "R");
    let early_s = number(&print["strike_s"]) + 0.1;
    let frame =
        bird["frames"].as_array().unwrap().iter().find(|frame| number(&frame["time_s"]) >= early_s).unwrap();
    assert!(frame["down"].as_array().unwrap().contains(&json!("R")));
    for axis in 0..3 {
        let middle = (number(&frame["joints_m"][heel][axis]) + number(&frame["joints_m"][toe][axis])) / 2.0;
        assert!((middle - number(&print["at_m"][axis])).abs() < 1e-3, "axis {axis}: {middle}");
    }
    let horse_file = track("horse-trot-uphill");
    footprints(&workspace, &["solve", &horse_file, "--out", "horse.json", "--rate", "20"]).expect_code(0);
    let horse = workspace.json("horse.json");
    assert_eq!(horse["joints"].as_array().unwrap().len(), 29);
    assert!(horse["joints"].as_array().unwrap().contains(&json!("LF_humerus_tip")));
}

#[test]
fn both_methods_are_compared_and_the_gradient_is_not_worse() {
    let workspace = Workspace::new();
    for name in ["bird-walk", "human-hop", "dinosaur-turn-and-leaps"] {
        let run = footprints(&workspace, &["solve", &track(name), "--compare", "--json"]).expect_code(0);
        let document: Value = serde_json::from_str(&run.stdout).unwrap();
        let total = |i: usize| document["compared"][i]["energy"]["total"].as_f64().unwrap();
        assert_eq!(document["compared"][1]["method"], "greedy");
        assert!(total(0) <= total(1), "{name}: {} {}", total(0), total(1));
        let alone =
            footprints(&workspace, &["solve", &track(name), "--method", "greedy"]).expect_code(0).stdout;
        assert!(alone.contains("\ngreedy") && alone.contains(&format!("{:.4}", total(1))), "{alone}");
    }
    let table = footprints(&workspace, &["solve", &track("human-hop")]).expect_code(0).stdout;
    assert!(table.contains("apex_m") && table.contains("weights: physics 1"), "{table}");
}

#[test]
fn pictures_are_drawn_as_pixels_and_lines_and_alike_twice() {
    let workspace = Workspace::new();
    for what in ["plan", "timing", "side"] {
        for file in ["a.svg", "b.svg"] {
            footprints(&workspace, &["picture", &track("human-hop"), "--what", what, "--out", file])
                .expect_code(0);
        }
        let text = workspace.text("a.svg");
        assert_eq!(text, workspace.text("b.svg"));
        assert!(text.contains("double stance") && text.contains("Steps, a hop, a rest"), "{what}");
        assert!(!text.contains("NaN") && text.trim_end().ends_with("</svg>"), "{what}");
    }
    for name in ["dinosaur-stairs", "horse-trot-uphill"] {
        for file in ["a.png", "b.png"] {
            let arguments =
                ["picture", &track(name), "--what", "all", "--width", "700", "--moments", "3", "--out", file];
            footprints(&workspace, &arguments).expect_code(0);
        }
        assert_eq!(bytes(&workspace, "a.png"), bytes(&workspace, "b.png"));
        let picture = image::open(workspace.path("a.png")).unwrap().to_rgb8();
        assert_eq!(picture.width(), 700);
        let plain = picture.pixels().filter(|pixel| **pixel == *picture.get_pixel(0, 0)).count();
        let share = plain as f64 / f64::from(picture.width() * picture.height());
        assert!((0.1..0.9).contains(&share), "{name}: {share} of the picture is paper");
    }
    let wrong =
        footprints(&workspace, &["picture", &track("human-hop"), "--what", "strip", "--out", "a.svg"]);
    assert!(wrong.expect_code(1).stderr.contains("ends in .png"));
    let wrong = footprints(&workspace, &["picture", &track("human-hop"), "--what", "plan", "--out", "a.txt"]);
    assert!(wrong.expect_code(1).stderr.contains(".png or .svg"));
}

#[test]
fn a_motion_is_animated() {
    let workspace = Workspace::new();
    let arguments = ["gif", &track("bird-walk"), "--fps", "5", "--width", "120", "--out", "bird.gif"];
    footprints(&workspace, &arguments).expect_code(0);
    let file = std::io::BufReader::new(std::fs::File::open(workspace.path("bird.gif")).unwrap());
    let frames = image::codecs::gif::GifDecoder::new(file).unwrap().into_frames().collect_frames().unwrap();
    assert!((15..60).contains(&frames.len()), "{}", frames.len());
}

#[test]
fn prints_are_laid_along_a_path_and_can_be_solved() {
    let workspace = Workspace::new();
    let lay = |more: &[&str]| footprints(&workspace, &[&["lay", "--out", "laid.json"], more].concat());
    lay(&["--model", "human", "--path", "0,0", "3,0 5,-2", "--step-length", "0.6"]).expect_code(0);
    let laid = workspace.json("laid.json");
    let prints = laid["prints"].as_array().unwrap();
    assert!((9..14).contains(&prints.len()), "{}", prints.len());
    assert!(prints.last().unwrap()["heading_deg"].as_f64().unwrap() > 10.0, "to the left");
    footprints(&workspace, &["solve", "laid.json"]).expect_code(0);
    lay(&["--model", "horse", "--gait", "walk", "--speed", "1.5", "--path", "0,0", "8,0"]).expect_code(0);
    let feet: Vec<String> = workspace.json("laid.json")["prints"]
        .as_array()
        .unwrap()
        .iter()
        .map(|print| print["foot"].as_str().unwrap().to_string())
        .collect();
    let order = ["LH", "LF", "RH", "RF"];
    let first = order.iter().position(|foot| *foot == feet[0]).unwrap();
    for (i, foot) in feet.iter().enumerate() {
        assert_eq!(*foot, order[(first + i) % 4], "the lateral sequence of a walk: {feet:?}");
    }
    footprints(&workspace, &["solve", "laid.json"]).expect_code(0);
    // From a track: its ground stays.
    lay(&[&track("dinosaur-stairs"), "--path", "0,0", "6,0"]).expect_code(0);
    assert_eq!(workspace.json("laid.json")["terrain"]["kind"], "stairs");
    for (more, says) in [
        (&["--model", "human"][..], "no path"),
        (&["--path", "0,0", "1,1"], "who walks"),
        (&["--model", "human", "--path", "0,0", "0,0"], "two points that differ"),
        (&["--model", "human", "--path", "0,0", "9000,0", "--step-length", "0.1"], "steps long"),
        (&["--model", "horse", "--path", "0,0", "9,0"], "gait"),
        (&["--model", "horse", "--path", "0,0", "9,0", "--gait", "walk", "--speed", "9"], "walk"),
    ] {
        let run = lay(more).expect_code(1);
        assert!(run.stderr.contains(says), "{more:?}: {}", run.stderr);
    }
    for more in [&["--model", "human", "--path", "0,0", "1"][..], &["--model", "cow", "--path", "0,0", "1,0"]]
    {
        lay(more).expect_code(2);
    }
}

#[test]
fn a_bird_wanders_and_crosses_rivers_as_its_seed_says() {
    let workspace = Workspace::new();
    let wander = |seed: &str, file: &str| {
        footprints(&workspace, &["wander", "--seed", seed, "--steps", "40", "--out", file]).expect_code(0)
    };
    wander("3", "a.svg");
    wander("3", "b.svg");
    wander("4", "c.svg");
    assert_eq!(workspace.text("a.svg"), workspace.text("b.svg"));
    assert!(workspace.text("a.svg") != workspace.text("c.svg"));
    assert!(workspace.text("a.svg").contains("trees"));
    wander("3", "track.json");
    footprints(&workspace, &["solve", "track.json"]).expect_code(0);
    footprints(&workspace, &["river", "--seed", "2", "--out", "river.svg"]).expect_code(0);
    assert!(workspace.text("river.svg").contains("stones"));
    let wide = footprints(&workspace, &["river", "--cell", "9", "--across", "20", "--out", "river.svg"]);
    assert!(wide.expect_code(1).stderr.contains("no way over"));
}

/// Tracks that are wrong, and what is said: the part of the message that matters.
fn bad_tracks() -> Vec<(&'static str, String, &'static str)> {
    let edited = |edit: &dyn Fn(&mut Value)| {
        let mut track = straight(6, 0.3);
        edit(&mut track);
        track.to_string()
    };
    let timed = |stance: Value, step: Value| {
        edited(&|track| {
            track["prints"][2]["timing"] = json!({ "stance_time_s": stance, "step_time_s": step });
        })
    };
    vec![
        ("nothing", String::new(), "line 1"),
        ("no prints", straight(0, 0.3).to_string(), "print"),
        ("another document", json!({ "schema": 1, "ride": [] }).to_string(), "ride"),
        ("a list", "[1, 2]".into(), "line 1"),
        ("another schema", edited(&|track| track["schema"] = json!(9)), "schema"),
        ("no model", edited(&|track| track["model"] = json!("unicorn")), "bird, dinosaur, human, horse"),
        ("a hoof of a bird", edited(&|track| track["prints"][1]["foot"] = json!("LH")), "print 2"),
        ("no such foot", edited(&|track| track["prints"][1]["foot"] = json!("X")), "`X`"),
        ("null", edited(&|track| track["prints"][3]["at_m"][0] = Value::Null), "null"),
        ("far away", edited(&|track| track["prints"][3]["at_m"][0] = json!(1e9)), "print 4"),
        ("a huge heading", edited(&|track| track["prints"][3]["heading_deg"] = json!(1e300)), "print 4"),
        ("a misspelt field", edited(&|track| track["prints"][0]["stance"] = json!(1)), "stance"),
        ("a negative stance", timed(json!(-0.5), json!(0.4)), "print 3"),
        ("a negative step", timed(json!(0.5), json!(-0.4)), "print 3"),
        ("an endless stance", timed(json!(1e12), json!(0.4)), "print 3"),
        ("no time", timed(Value::Null, json!(0.4)), "null"),
        (
            "stairs without depth",
            edited(&|track| {
                track["terrain"] = json!({ "kind": "stairs", "tread_m": 0.0, "rise_m": 0.2, "steps": 3,
                "towards_deg": 0.0, "from_m": [0.0, 0.0] });
            }),
            "tread_m",
        ),
        ("a weight below zero", edited(&|track| track["weights"] = json!({ "physics": -1.0 })), "physics"),
        ("truncated", straight(6, 0.3).to_string()[..200].to_string(), "line 1"),
        ("NaN", straight(2, 0.3).to_string().replace("0.3", "NaN"), "line 1"),
        ("too large a number", straight(2, 0.3).to_string().replace("0.3", "1e999"), "line 1"),
        ("10,001 prints", straight(10_001, 0.3).to_string(), "10"),
        ("deep nesting", "[".repeat(100_000), "line 1"),
    ]
}

#[test]
fn a_track_that_cannot_be_walked_is_refused_by_name_and_print() {
    let workspace = Workspace::new();
    let mut complaints = Vec::new();
    for (name, text, says) in bad_tracks() {
        workspace.write("bad.json", &text);
        for arguments in [&["solve", "bad.json"][..], &["picture", "bad.json", "--out", "bad.png"]] {
            let run = footprints(&workspace, arguments);
            let longest = run.stderr.lines().map(str::len).max().unwrap_or(0);
            let is_readable = longest < 600 && run.stderr.lines().count() < 60;
            let is_named = run.stderr.starts_with("error: bad.json: ") && run.stderr.contains(says);
            let is_nothing_done = run.stdout.is_empty() && !workspace.path("bad.png").exists();
            if run.code != 1 || !is_readable || !is_named || !is_nothing_done {
                complaints.push(format!("{name}: exit code {}, it said: {}", run.code, run.stderr));
            }
        }
    }
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
}

#[test]
fn files_that_are_none_are_named() {
    let workspace = Workspace::new();
    std::fs::create_dir(workspace.path("folder")).unwrap();
    workspace.write("latin.json", "placeholder");
    let mut file = std::fs::OpenOptions::new().write(true).open(workspace.path("latin.json")).unwrap();
    std::io::Write::write_all(&mut file, &[0xff, 0xfe, 0x00]).unwrap();
    for file in ["missing.json", "folder", "latin.json"] {
        let run = footprints(&workspace, &["solve", file]).expect_code(1);
        assert!(run.stderr.starts_with(&format!("error: {file}: ")), "{}", run.stderr);
    }
    let good = track("bird-walk");
    for out in ["no-such-folder/a.json", "folder"] {
        let run = footprints(&workspace, &["solve", &good, "--out", out]).expect_code(1);
        assert!(run.stderr.contains(out) && run.stderr.contains("cannot be written"), "{}", run.stderr);
    }
    footprints(&workspace, &["solve"]).expect_code(2);
    footprints(&workspace, &["solve", &good, "--rate", "0"]).expect_code(2);
}

#[test]
fn odd_tracks_have_a_bounded_answer() {
    let workspace = Workspace::new();
    let same_time = {
        let mut track = straight(6, 0.2);
        for print in track["prints"].as_array_mut().unwrap() {
            print["timing"] = json!({ "stance_time_s": 0.5, "step_time_s": 0.0 });
        }
        track
    };
    let mut one_place = straight(8, 0.0);
    one_place["prints"]
        .as_array_mut()
        .unwrap()
        .iter_mut()
        .for_each(|print| print["at_m"] = json!([0.0, 0.0]));
    let tracks = [
        ("one print", straight(1, 0.3), true),
        ("10,000 prints", straight(10_000, 0.3), true),
        ("50 m apart", straight(8, 50.0), true),
        ("all in one place", one_place, true),
        // The same foot cannot fall on two prints at once.
        ("equal times", same_time, false),
    ];
    for (name, track, is_walked) in tracks {
        workspace.write("odd.json", &track.to_string());
        let run = footprints(&workspace, &["solve", "odd.json"]);
        if is_walked {
            let run = run.expect_code(0);
            assert!(run.stdout.contains("gradient") && !run.stdout.contains("NaN"), "{name}: {}", run.stdout);
            assert!(run.stdout.lines().count() < 6100, "{name}: an answer of readable length");
        } else {
            assert!(run.code == 1 && run.stderr.contains("print"), "{name}: {} {}", run.stdout, run.stderr);
        }
    }
    workspace.write("odd.json", &straight(8, 50.0).to_string());
    let far = footprints(&workspace, &["solve", "odd.json"]).stdout;
    assert!(far.contains("remark: print") && far.contains("out of reach"), "{far}");
    for (prints, step_m) in [(1, 0.3), (8, 50.0), (3000, 0.3)] {
        workspace.write("odd.json", &straight(prints, step_m).to_string());
        let arguments = ["picture", "odd.json", "--width", "600", "--moments", "2", "--out", "odd.png"];
        footprints(&workspace, &arguments).expect_code(0);
    }
    let run = footprints(&workspace, &["gif", "odd.json", "--out", "odd.gif"]).expect_code(1);
    assert!(run.stderr.contains("too many"), "{}", run.stderr);
}
