//! The rules of the house: which crate may use which, what every file has, what no file may hold.

#![allow(clippy::unwrap_used, reason = "a test stops at the first thing it cannot do")]

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::Command;

use cargo_metadata::{DependencyKind, Metadata, MetadataCommand, Package};
use muybridge_tests::{Run, program, repository};

/// Which crate of the workspace may use which others; what is not listed may use none.
const ARROWS: [(&str, &[&str]); 8] = [
    ("core", &[]),
    ("capture", &["core"]),
    ("imaging", &["core", "capture"]),
    ("fitting", &["core", "capture"]),
    ("footprints", &["core"]),
    ("export", &["core"]),
    ("cli", &["core", "capture", "imaging", "fitting", "footprints"]),
    ("annotator", &["core", "capture", "imaging", "fitting", "footprints"]),
];
/// The crate that may use all others.
const TESTS: &str = "tests";
/// All that the run-time half of the toolchain rests on.
const CORE_DEPENDENCIES: [&str; 3] = ["glam", "serde", "serde_json"];
/// Longest source file, lines.
const MOST_LINES: usize = 800;

fn metadata() -> Metadata {
    MetadataCommand::new().manifest_path(repository().join("Cargo.toml")).exec().unwrap()
}

/// `muybridge-core` is `core` here.
fn short(package: &str) -> &str {
    package.strip_prefix("muybridge-").unwrap_or(package)
}

fn direct(package: &Package, kind: DependencyKind) -> BTreeSet<&str> {
    package.dependencies.iter().filter(|d| d.kind == kind).map(|d| d.name.as_str()).collect()
}

/// Source files under `crates/` and `tests/`.
fn sources() -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut folders = vec![repository().join("crates"), repository().join("tests")];
    while let Some(folder) = folders.pop() {
        for path in std::fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path()) {
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                found.push(path);
            }
        }
    }
    found.sort();
    assert!(found.len() > 20);
    found
}

/// Files that are or could be committed; none where this is no git checkout.
fn committed_files() -> Option<Vec<PathBuf>> {
    let arguments = ["ls-files", "-z", "--cached", "--others", "--exclude-standard"];
    let output = Command::new("git").args(arguments).current_dir(repository()).output().ok()?;
    output.status.success().then(|| {
        let names = String::from_utf8(output.stdout).unwrap();
        let paths = names.split_terminator('\0').map(|name| repository().join(name));
        paths.filter(|path| path.is_file()).collect()
    })
}

fn shown(path: &Path) -> String {
    path.strip_prefix(repository()).unwrap_or(path).display().to_string()
}

#[test]
fn crates_use_only_the_crates_they_may() {
    let metadata = metadata();
    let packages = metadata.workspace_packages();
    let names: BTreeSet<&str> = packages.iter().map(|package| package.name.as_str()).collect();
    let allowed: BTreeMap<&str, &[&str]> = ARROWS.into_iter().collect();
    for package in &packages {
        let from = short(&package.name);
        if from == TESTS {
            continue;
        }
        let allowed = allowed.get(from).unwrap_or_else(|| panic!("{from}: not in the table of arrows"));
        for dependency in package.dependencies.iter().filter(|d| names.contains(d.name.as_str())) {
            let to = short(&dependency.name);
            assert!(allowed.contains(&to), "{from} must not use {to}");
        }
    }
}

#[test]
fn core_and_capture_stay_small() {
    let metadata = metadata();
    let package = |name: &str| *metadata.workspace_packages().iter().find(|p| p.name == name).unwrap();
    assert_eq!(direct(package("muybridge-core"), DependencyKind::Normal), BTreeSet::from(CORE_DEPENDENCIES));
    assert!(direct(package("muybridge-core"), DependencyKind::Build).is_empty());
    // Not even through another crate: capture works on numbers, not on pixels.
    let nodes = &metadata.resolve.as_ref().unwrap().nodes;
    let mut reached = BTreeSet::new();
    let mut waiting = vec![package("muybridge-capture").id.clone()];
    while let Some(id) = waiting.pop() {
        let node = nodes.iter().find(|node| node.id == id).unwrap();
        for dependency in &node.deps {
            let used = dependency.dep_kinds.iter().any(|kind| kind.kind == DependencyKind::Normal);
            if used && reached.insert(dependency.name.clone()) {
                waiting.push(dependency.pkg.clone());
            }
        }
    }
    assert!(reached.contains("serde_json") && !reached.contains("image"), "{reached:?}");
}

#[test]
fn every_crate_keeps_the_lints_and_is_in_the_architecture() {
    let path = repository().join("ARCHITECTURE.md");
    let architecture =
        std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("ARCHITECTURE.md: {error}"));
    for package in metadata().workspace_packages() {
        let manifest = std::fs::read_to_string(&package.manifest_path).unwrap();
        assert!(manifest.contains("[lints]\nworkspace = true"), "{}: no workspace lints", package.name);
        let named = architecture
            .split(|c: char| !(c.is_alphanumeric() || c == '-'))
            .any(|w| w == package.name.as_str());
        assert!(named, "ARCHITECTURE.md does not name {}", package.name);
    }
}

#[test]
fn every_source_file_says_what_it_is_and_is_of_readable_length() {
    for path in sources() {
        let text = std::fs::read_to_string(&path).unwrap();
        let name = shown(&path);
        assert!(text.starts_with("//! "), "{name} does not begin with a //! line");
        let lines = text.lines().count();
        assert!(lines <= MOST_LINES, "{name} has {lines} lines");
    }
}

#[test]
fn no_file_holds_a_path_of_one_machine() {
    let Some(files) = committed_files() else {
        println!("skipped: no git checkout");
        return;
    };
    // In pieces, so that this file holds none of them.
    let paths = ["root", "home", "Users", "work", "tmp/w"].map(|folder| format!("/{folder}/"));
    for path in files {
        let bytes = std::fs::read(&path).unwrap();
        let text = String::from_utf8_lossy(&bytes);
        for (number, line) in text.lines().enumerate() {
            let found = paths.iter().find(|forbidden| line.contains(forbidden.as_str()));
            assert!(found.is_none(), "{}, line {}: {found:?}", shown(&path), number + 1);
        }
    }
}

/// Command lines in the fenced blocks of a Markdown text.
fn fenced_commands(text: &str) -> Vec<String> {
    let mut commands = Vec::new();
    let mut fenced = false;
    for line in text.lines().map(str::trim) {
        if line.starts_with("```") {
            fenced = !fenced;
        } else if fenced {
            let line = line.trim_start_matches("$ ");
            commands.push(line.split(" #").next().unwrap_or(line).trim().to_string());
        }
    }
    commands
}

/// A command line of one of the programs, as the program's name and its words; `cargo run` is followed through.
fn program_call(command: &str) -> Option<(&str, Vec<&str>)> {
    let words: Vec<&str> = command.split_whitespace().collect();
    let own = |name: &str| ["fit-gaits", "muybridge"].into_iter().find(|own| *own == name);
    let first = words.first()?.rsplit('/').next()?;
    if first != "cargo" {
        return Some((own(first)?, words[1..].to_vec()));
    }
    let split = words.iter().position(|word| *word == "--").unwrap_or(words.len());
    let named = words[..split].iter().position(|word| *word == "--bin").and_then(|at| words.get(at + 1));
    // The window is a program of its own package; its tests run it.
    if words.contains(&"annotator") {
        return None;
    }
    (words.get(1) == Some(&"run")).then_some(())?;
    Some((own(named.unwrap_or(&"fit-gaits"))?, words.get(split + 1..).unwrap_or_default().to_vec()))
}

#[test]
fn commands_in_the_readme_exist() {
    let text = std::fs::read_to_string(repository().join("README.md"))
        .unwrap_or_else(|error| panic!("README.md: {error}"));
    let commands = fenced_commands(&text);
    let calls: Vec<_> = commands.iter().filter_map(|command| program_call(command)).collect();
    assert!(calls.iter().any(|(name, _)| *name == "fit-gaits"), "the README shows how to run the main job");
    for (name, words) in calls {
        let is_subcommand =
            |word: &&&str| name == "muybridge" && word.chars().all(|c| c.is_ascii_lowercase());
        let subcommands: Vec<&str> = words.iter().take(2).take_while(is_subcommand).copied().collect();
        let run = Run::of(Command::new(program(name)).args(&subcommands).arg("--help")).expect_code(0);
        for flag in words.iter().filter(|word| word.starts_with("--")) {
            let flag = flag.split('=').next().unwrap_or(flag);
            assert!(run.stdout.contains(flag), "README.md: {name} {subcommands:?} has no {flag}");
        }
    }
}
