//! Work is not lost: programs killed at a random moment, torn journals, full disks.
//!
//! The killed program is this test's own, run again as a process: it makes changes drawn from a seed, and says before and
//! after each how many it has made. The same changes made here without a kill tell what must have survived.

#![allow(clippy::unwrap_used, reason = "a test stops at the first thing it cannot do")]

mod loss_work;

use std::io::{BufRead, BufReader, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::{Mutex, RwLock};
use std::time::{Duration, Instant};

use loss_work::{Moment, Work, draft_hash, moment, specimen, specimen_in_memory};
use muybridge_capture::{Document, waiting};
use muybridge_core::Random;
use tempfile::TempDir;

/// Sequences of changes, each cut short by a kill.
const SEQUENCES: u64 = 200;
/// Programs that run at once.
const THREADS: usize = 2;
/// Changes a program makes when nobody kills it.
const MOST_STEPS: usize = 2000;
/// Lines that are read from a program before it is killed, at most.
const MOST_LINES: f64 = 50.0;
/// Time from the last line to the kill, at most: about what a save takes.
const LONGEST_DELAY_S: f64 = 0.012;
/// Tells a process of this test its seed.
const SEED: &str = "MUYBRIDGE_LOSS_SEED";
/// Tells a process of this test its folder.
const FOLDER: &str = "MUYBRIDGE_LOSS_FOLDER";

/// A process that is being started has this one's files open, and their locks, for a moment: none is started while
/// somebody opens journals here.
static STARTING: RwLock<()> = RwLock::new(());

fn say(text: &str) {
    let mut out = std::io::stdout().lock();
    writeln!(out, "{text}").unwrap();
    out.flush().unwrap();
}

/// A test of this program as a process.
fn process(command: &mut Command, seed: u64, folder: &Path) -> Child {
    let command = command.env(SEED, seed.to_string()).env(FOLDER, folder);
    let _alone = STARTING.write().unwrap();
    command.stdout(Stdio::piped()).stderr(Stdio::null()).spawn().unwrap()
}

fn asked() -> Option<(u64, PathBuf)> {
    let seed = std::env::var(SEED).ok()?.parse().unwrap();
    Some((seed, std::env::var_os(FOLDER).unwrap().into()))
}

#[test]
#[ignore = "run as a process by the test that kills it"]
fn child() {
    let Some((seed, folder)) = asked() else { return };
    let mut work = Work::begin(seed, &folder, Some(folder.join("journals")));
    say("");
    for step in 1..=MOST_STEPS {
        say(&format!("begin {step}"));
        work.step();
        say(&format!("done {step} {:016x}", work.moment().full));
    }
}

/// What a killed program said: commands done and begun, and the state after the last that was done.
#[derive(Default)]
struct Said {
    done: usize,
    begun: usize,
    state: Option<u64>,
}

impl Said {
    fn take(&mut self, line: &str) {
        let words: Vec<&str> = line.split(' ').collect();
        match words[..] {
            ["begin", step] => self.begun = step.parse().unwrap(),
            ["done", step, state] => {
                self.done = step.parse().unwrap();
                self.state = u64::from_str_radix(state, 16).ok();
            }
            _ => {}
        }
    }
}

/// Runs the child and kills it after some lines and some microseconds.
fn run_and_kill(seed: u64, folder: &Path) -> Said {
    let mut random = Random::new(seed ^ 0xdead);
    let (lines, delay_s) = (random.between(1.0, MOST_LINES), random.between(0.0, LONGEST_DELAY_S));
    let mut command = Command::new(std::env::current_exe().unwrap());
    let mut child = process(command.args(["--exact", "child", "--ignored", "--nocapture"]), seed, folder);
    let mut reader = BufReader::new(child.stdout.take().unwrap());
    let (mut said, mut text) = (Said::default(), String::new());
    for _ in 0..lines as usize + 3 {
        text.clear();
        reader.read_line(&mut text).unwrap();
        said.take(text.trim_end());
    }
    // Sleeping is too coarse for moments within a save.
    let until = Instant::now() + Duration::from_secs_f64(delay_s);
    while Instant::now() < until {
        std::hint::spin_loop();
    }
    child.kill().unwrap();
    let mut rest = Vec::new();
    reader.read_to_end(&mut rest).unwrap();
    child.wait().unwrap();
    // A line without its end was being written.
    let rest = String::from_utf8(rest).unwrap();
    rest.split_inclusive('\n')
        .filter(|line| line.ends_with('\n'))
        .for_each(|line| said.take(line.trim_end()));
    said
}

/// The only journal of a folder, if there is one.
fn journal(journals: &Path) -> Option<PathBuf> {
    let entries = std::fs::read_dir(journals).ok()?;
    let mut paths = entries.map(|entry| entry.unwrap().path());
    paths.find(|path| path.extension().is_some_and(|ending| ending == "journal"))
}

/// One sequence; whether the kill hit a save.
fn sequence(seed: u64) -> bool {
    // On a disk the kill often meets a program that waits for it; in memory, one that computes or writes.
    let killed = if seed.is_multiple_of(2) { specimen() } else { specimen_in_memory() };
    let whole = specimen_in_memory();
    let said = run_and_kill(seed, killed.path());
    let mut work = Work::begin(seed, whole.path(), None);
    let mut moments = vec![work.moment()];
    let mut saved = vec![work.saving()];
    for _ in 0..said.begun {
        work.step();
        moments.push(work.moment());
        saved.push(work.saving());
    }
    if let Some(state) = said.state {
        assert_eq!(state, moments[said.done].full, "seed {seed}: the same seed made other changes");
    }
    let possible = &moments[said.done..=said.begun];
    let versions = work.versions();
    for (name, hash) in loss_work::documents(killed.path()) {
        assert!(versions.contains(&(name.clone(), hash)), "seed {seed}: {name} is no saved version");
        if name.starts_with("annotations") {
            Document::open(&killed.path().join(&name), None).unwrap_or_else(|e| panic!("seed {seed}: {e}"));
        }
    }
    check_left(seed, killed.path(), possible);
    saved[said.begun] && said.begun > said.done
}

/// What a person finds at the next start is what was shown last, or with the command in flight.
fn check_left(seed: u64, folder: &Path, possible: &[Moment]) {
    let _none_starts = STARTING.read().unwrap();
    let journals = folder.join("journals");
    let offered = waiting(&journals);
    assert!(offered.len() <= 1, "seed {seed}");
    if offered.is_empty() {
        let saved = possible.iter().find(|moment| {
            let document = Document::open(&folder.join(&moment.path), None);
            document.is_ok_and(|document| draft_hash(document.draft()) == moment.draft)
        });
        assert!(saved.is_some(), "seed {seed}: nothing is offered, and the file is not the last state");
    }
    let Some(Ok(mut left)) = journal(&journals).map(|path| Document::recover(&path)) else {
        assert!(offered.is_empty(), "seed {seed}: what is offered cannot be taken up");
        return;
    };
    let now = moment(&left, folder, 0);
    let Some(found) = possible.iter().find(|moment| moment.full == now.full) else {
        panic!("seed {seed}: neither the last command's state nor the one's before");
    };
    while left.undo().is_some() {}
    assert_eq!(draft_hash(left.draft()), found.base, "seed {seed}: undone, it is not what was opened");
    // Only a save that was cut short may have to be asked about.
    left.save(true).unwrap();
    let again = Document::open(left.annotation_path(), None).unwrap();
    assert!(again.draft() == left.draft(), "seed {seed}: what is saved is not what is open");
}

#[test]
fn a_kill_costs_at_most_the_command_in_flight() {
    let (next, hits) = (Mutex::new(0), Mutex::new(0));
    let started = Instant::now();
    std::thread::scope(|scope| {
        for _ in 0..THREADS {
            scope.spawn(|| {
                loop {
                    let seed = {
                        let mut next = next.lock().unwrap();
                        *next += 1;
                        *next - 1
                    };
                    if seed >= SEQUENCES {
                        return;
                    }
                    let hit = sequence(seed);
                    *hits.lock().unwrap() += i32::from(hit);
                }
            });
        }
    });
    let hits = hits.into_inner().unwrap();
    println!("{SEQUENCES} kills in {:.1} s, {hits} while saving", started.elapsed().as_secs_f64());
    assert!(hits >= 5, "only {hits} kills hit a save: they are to hit the middle of writes");
}

#[test]
fn a_torn_journal_costs_what_was_torn() {
    for seed in 1000..1020 {
        let _none_starts = STARTING.read().unwrap();
        let folder = specimen();
        let journals = folder.path().join("journals");
        let mut work = Work::begin(seed, folder.path(), Some(journals.clone()));
        work.may_reopen = false;
        let path = journal(&journals).unwrap();
        let length = || std::fs::metadata(&path).unwrap().len() as usize;
        let mut moments = vec![(length(), work.moment())];
        for _ in 0..12 {
            work.step();
            moments.push((length(), work.moment()));
        }
        drop(work);
        let whole = std::fs::read(&path).unwrap();
        let mut random = Random::new(seed);
        for _ in 0..8 {
            let cut = random.between(0.0, whole.len() as f64 + 1.0) as usize;
            tear(&path, &whole[..cut], &mut random);
            let expected = moments.iter().rev().find(|(length, _)| *length <= cut);
            match (Document::recover(&path), expected) {
                (Ok(document), Some((_, expected))) => {
                    let found = moment(&document, folder.path(), 0);
                    assert_eq!(found.full, expected.full, "seed {seed}, cut after {cut} bytes");
                    goes_on(document, &path);
                }
                (Err(_), None) => {}
                (result, _) => panic!("seed {seed}, cut after {cut} bytes: {result:?}"),
            }
        }
    }
}

/// Leaves the beginning of a journal, and often something after it that is no line of it.
fn tear(path: &Path, beginning: &[u8], random: &mut Random) {
    let garbage = random.between(-40.0, 200.0).max(0.0) as usize;
    let mut torn = beginning.to_vec();
    torn.extend((0..garbage).map(|_| random.between(0.0, 256.0) as u8));
    muybridge_capture::write_atomically(path, &torn).unwrap();
}

/// After a torn journal was taken up, the next change is as safe as any.
fn goes_on(mut document: Document, path: &Path) {
    assert!(document.edit("Title", |draft| draft.manifest.title.push('x')));
    assert_eq!(document.journal_fault(), None);
    let now = document.draft().clone();
    drop(document);
    assert_eq!(Document::recover(path).unwrap().draft(), &now);
}

#[test]
fn without_a_place_for_the_journal_work_goes_on_and_says_so() {
    let _none_starts = STARTING.read().unwrap();
    let folder: TempDir = specimen();
    let journals = folder.path().join("journals");
    muybridge_capture::write_atomically(&journals, b"a file where the folder should be").unwrap();
    let mut work = Work::begin(7, folder.path(), Some(journals.clone()));
    work.may_reopen = false;
    assert!(work.fault().is_some_and(|fault| fault.contains("journal")));
    (0..20).for_each(|_| work.step());
    assert!(work.fault().is_some());
    std::fs::remove_file(&journals).unwrap();
    work.change();
    assert_eq!(work.fault(), None);
    let (last, base) = (work.moment(), work.moment().base);
    drop(work);
    let mut left = Document::recover(&journal(&journals).unwrap()).unwrap();
    assert_eq!(moment(&left, folder.path(), 0).full, last.full);
    while left.undo().is_some() {}
    assert_eq!(draft_hash(left.draft()), base, "what was done without a journal can be undone, too");
}

#[test]
#[ignore = "run as a process by the test of a full disk"]
fn full_disk_child() {
    let Some((seed, folder)) = asked() else { return };
    let mut work = Work::begin(seed, &folder, Some(folder.join("journals")));
    work.may_reopen = false;
    say("");
    while work.fault().is_none() {
        work.change();
    }
    (0..10).for_each(|_| work.change());
    say(&format!("fault {}", work.fault().unwrap()));
    let id = std::process::id().to_string();
    let freed = Command::new("prlimit").args(["--pid", &id, "--fsize=unlimited"]).status();
    if !freed.is_ok_and(|status| status.success()) {
        return say("skipped");
    }
    work.change();
    say(&format!("room {:016x} {:016x} {:?}", work.moment().full, work.moment().base, work.fault()));
    std::thread::sleep(Duration::from_secs(60));
}

/// A limit on the size of files stands for the full disk: writing fails in the middle of a line, and works again later.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_told_and_costs_nothing_once_there_is_room() {
    let folder = specimen();
    let script = "ulimit -S -f 300; trap '' XFSZ; exec \"$0\" \"$@\"";
    let mut command = Command::new("sh");
    command.args(["-c", script]).arg(std::env::current_exe().unwrap());
    command.args(["--exact", "full_disk_child", "--ignored", "--nocapture"]);
    let mut child = process(&mut command, 3, folder.path());
    let lines = BufReader::new(child.stdout.take().unwrap()).lines().map_while(Result::ok);
    let said: Vec<String> = lines
        .filter(|line| ["fault", "room", "skipped"].iter().any(|word| line.starts_with(word)))
        .take(2)
        .collect();
    child.kill().unwrap();
    child.wait().unwrap();
    assert!(said[0].contains("room") && said[0].contains(".journal"), "{said:?}");
    if said[1] == "skipped" {
        return;
    }
    let words: Vec<&str> = said[1].split(' ').collect();
    assert_eq!(words[3], "None", "{said:?}");
    let mut left = Document::recover(&journal(&folder.path().join("journals")).unwrap()).unwrap();
    assert_eq!(format!("{:016x}", moment(&left, folder.path(), 0).full), words[1]);
    while left.undo().is_some() {}
    assert_eq!(format!("{:016x}", draft_hash(left.draft())), words[2]);
}
