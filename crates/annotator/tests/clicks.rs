//! Experiment.
#![allow(clippy::unwrap_used, reason = "a test stops at the first thing it cannot do")]
use std::path::Path;
use annotator::app::{Annotator, Places};
use annotator::command::Command;
use annotator::session::Session;
use annotator::toast::Messages;
use muybridge_capture::*;
use muybridge_core::{Random, Skeleton};
use muybridge_fitting::footfalls::{LANES, with_label, with_span};
use muybridge_fitting::pipeline::{PlateFit, fit_loaded};
use muybridge_fitting::weights::Weights;

const SHARE: [f64; 2] = [1.5 / 187.0, 2.4 / 187.0];

struct Person { random: Random, clicks: usize, contacts: usize, keys: usize, truth: Annotation, withers_px: f64, hand: Vec<[f64;2]> }
struct Run { annotator: Annotator, context: egui::Context, messages: Messages, _folder: tempfile::TempDir }

impl Run {
    fn new(id: &str) -> Self {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../plates/specimens");
        let folder = tempfile::tempdir().unwrap();
        for end in ["jpg", "json"] {
            std::fs::copy(root.join(format!("{id}.{end}")), folder.path().join(format!("{id}.{end}"))).unwrap();
        }
        let context = egui::Context::default();
        let places = Places { state: None, plates: folder.path().into() };
        let mut annotator = Annotator::new(&context, places, Some(&folder.path().join(format!("{id}.json"))));
        annotator.wait_until_open(&context);
        let mut run = Self { annotator, context, messages: Messages::default(), _folder: folder };
        while run.session().picture_is_missing() { run.settle(); }
        run
    }
    fn session(&mut self) -> &mut Session { self.annotator.session.as_mut().unwrap() }
    fn settle(&mut self) {
        loop {
            let context = self.context.clone();
            let mut messages = std::mem::take(&mut self.messages);
            let s = self.session();
            s.finish_background_work(&mut messages);
            s.before_frame(&context, false);
            let busy = s.work_under_way().is_some();
            self.messages = messages;
            if !busy { break; }
            std::thread::sleep(std::time::Duration::from_millis(1));
        }
    }
    fn run(&mut self, command: Command) {
        let context = self.context.clone();
        if let Some(why) = self.annotator.why_not(command) { println!("{command:?}: {why}"); }
        self.annotator.run(&context, command);
        self.settle();
    }
}

impl Person {
    fn truth_px(&self, panel: u32, k: Keypoint) -> [f64; 2] { self.truth.panels.iter().find(|p| p.panel == panel).unwrap().keypoints.place(k).unwrap() }
    fn state(&self, panel: u32, k: Keypoint) -> KeypointState { self.truth.panels.iter().find(|p| p.panel == panel).unwrap().keypoints.get(k).unwrap().state }
    fn sd_px(&self, panel: u32, k: Keypoint) -> f64 { self.withers_px * SHARE[usize::from(self.state(panel, k) != KeypointState::Visible)] }
    fn seen(&self, panel: u32, k: Keypoint) -> [f64; 2] {
        let [x, y] = self.truth_px(panel, k); let sd = self.sd_px(panel, k); let [a, b] = self.hand[(panel as usize - 1) * 26 + k.index()];
        [x + sd * a, y + sd * b]
    }
    fn place(&mut self, run: &mut Run, panel: u32, k: Keypoint) {
        let at_px = Some(self.seen(panel, k)); let state = self.state(panel, k);
        let placed = Placed { at_px, state, by: PlacedBy::Hand };
        self.clicks += 1;
        run.session().edit("Place", |d| d.panel_mut(panel).keypoints.insert(k, placed));
    }
    fn contacts(&mut self, run: &mut Run) {
        let numbers = run.session().panel_numbers();
        let n = numbers.len();
        for leg in LANES {
            let clock = run.session().derived.footfalls.as_ref().unwrap().clock.clone();
            let of = |p: u32| self.truth.panels.iter().find(|q| q.panel == p).unwrap().contacts.of(leg.0, leg.1);
            let down = |i: usize| of(numbers[i % n]) == StanceLabel::Stance;
            for i in 0..n {
                if down(i) && !down(i + n - 1) {
                    let len = (0..n).take_while(|j| down(i + j)).count();
                    let from = f64::from(numbers[i]) - 0.5;
                    run.session().edit("Footfall", |d| { for p in &numbers { d.panel_mut(*p); } d.annotation = with_span(&d.annotation, &clock, leg, [from, from + len as f64]); });
                    self.contacts += 1;
                }
            }
            for p in &numbers {
                let want = of(*p);
                let now = run.session().draft().panel(*p).map_or(StanceLabel::Unknown, |q| q.contacts.of(leg.0, leg.1));
                if now != want {
                    run.session().edit("Contact label", |d| { d.panel_mut(*p); d.annotation = with_label(&d.annotation, &clock, leg, *p, want); });
                    self.contacts += 1;
                }
            }
        }
        run.settle();
    }
    fn bad(&self, run: &mut Run, panel: u32) -> Vec<Keypoint> {
        let Some(ann) = run.session().draft().panel(panel).cloned() else { return Keypoint::all().collect() };
        Keypoint::all().filter(|k| match ann.keypoints.get(*k) {
            Some(p) if p.by == PlacedBy::Hand => false,
            Some(p) => { let a = p.at_px.unwrap(); let b = self.truth_px(panel, *k); (a[0]-b[0]).hypot(a[1]-b[1]) > 2.0 * self.sd_px(panel, *k) }
            None => true }).collect()
    }
    fn correct(&mut self, run: &mut Run, panel: u32) -> usize {
        let bad = self.bad(run, panel);
        for k in &bad { self.place(run, panel, *k); }
        run.settle();
        bad.len()
    }
    fn by_hand(&mut self, run: &mut Run, panel: u32) { for k in Keypoint::all() { self.place(run, panel, k); } run.settle(); }
    fn rms(&self, run: &mut Run) -> f64 {
        let draft = run.session().draft().clone();
        let (mut s, mut n) = (0.0, 0);
        for p in &draft.annotation.panels { for (k, q) in p.keypoints.iter() { let a = q.at_px.unwrap(); let b = self.truth_px(p.panel, k); s += (a[0]-b[0]).powi(2) + (a[1]-b[1]).powi(2); n += 1; } }
        (s / f64::from(n)).sqrt() / self.withers_px * 100.0
    }
    fn rms_fit(&self, fit: &PlateFit) -> f64 {
        let f = &fit.fit; let ks = f.kinematics(); let (mut s, mut n) = (0.0, 0);
        for (slot, i) in f.problem.order.iter().enumerate() { let panel = f.observation.panels[*i].camera.panel;
            for k in Keypoint::all() { let a = f.place_px(slot, &ks[slot], k); let b = self.truth_px(panel, k); s += (a[0]-b[0]).powi(2) + (a[1]-b[1]).powi(2); n += 1; } }
        (s / f64::from(n)).sqrt() / self.withers_px * 100.0
    }
}

fn fit_now(run: &mut Run) -> Result<PlateFit, String> {
    let s = run.session();
    let mut a = s.document.draft().annotation.clone();
    for p in &mut a.panels { if p.keypoints.iter().count() < 6 { p.usage = PanelUse::Unused; } }
    let m = s.document.draft().manifest.clone();
    let plate = Plate::from_documents((s.document.manifest_path(), m), (s.document.annotation_path(), a)).map_err(|e| e.to_string())?;
    fit_loaded(plate, &Skeleton::reference(), &Weights::default()).map_err(|e| e.to_string())
}

fn from_fit(run: &mut Run, fit: &PlateFit, panel: u32) {
    let f = &fit.fit; let ks = f.kinematics();
    let Some(slot) = f.problem.order.iter().position(|i| f.observation.panels[*i].camera.panel == panel) else { return };
    let points: Vec<_> = Keypoint::all().map(|k| (k, f.place_px(slot, &ks[slot], k))).collect();
    run.session().edit("F", |d| { let ks = &mut d.panel_mut(panel).keypoints; for (k, at) in points { let old = ks.get(k).copied();
        if old.is_some_and(|o| o.by == PlacedBy::Hand) { continue; }
        ks.insert(k, Placed { at_px: Some(at), state: old.map_or(KeypointState::Visible, |o| o.state), by: PlacedBy::Fitted }); } });
    run.settle();
}

fn start(id: &str) -> (Person, Run) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../plates/specimens");
    let plate = Plate::load(&root.join(format!("annotations/{id}.json"))).unwrap();
    let c = calibrate(&plate.manifest, &plate.annotation).unwrap();
    let withers_px = 1.6 * c.stride[0].px_per_m;
    let mut random = Random::new(7);
    let hand = (0..12 * 26).map(|_| [random.normal(), random.normal()]).collect();
    let person = Person { random, clicks: 0, contacts: 0, keys: 0, truth: plate.annotation.clone(), withers_px, hand };
    let mut run = Run::new(id);
    run.run(Command::FindGround);
    run.session().edit("Marks", |d| { d.annotation.visible_sd_px = SHARE[0] * withers_px; d.annotation.occluded_sd_px = SHARE[1] * withers_px;
        for p in &plate.annotation.panels { d.panel_mut(p.panel).marks = p.marks.clone(); } });
    run.settle();
    (person, run)
}

#[test]
fn experiment() {
    let mode: u32 = std::env::var("MODE").map_or(1, |m| m.parse().unwrap());
    let gaits = std::env::var("GAITS").unwrap_or("walk trot gallop".into());
    for gait in gaits.split(' ') {
        let id = format!("specimen-{gait}");
        let t = std::time::Instant::now();
        if mode == 0 {
            let (mut person, mut run) = start(&id);
            person.contacts(&mut run);
            for p in 1..=12 { person.by_hand(&mut run, p); }
            let t2 = std::time::Instant::now();
            let fit = fit_now(&mut run).unwrap();
            println!("{gait} hand: clicks {} contacts {} rms {:.3} fit {:.3} gait {} fit time {:?} all {:?}", person.clicks, person.contacts, person.rms(&mut run), person.rms_fit(&fit), fit.analysis.implied.name(), t2.elapsed(), t.elapsed());
            continue;
        }
        let (mut person, mut run) = start(&id);
        person.contacts(&mut run);
        person.by_hand(&mut run, 1);
        let mut counts = vec![26];
        if mode == 1 || mode == 2 {
            // One after the other.
            for p in 2..=12u32 {
                run.session().go_to(p);
                let t2 = std::time::Instant::now();
                run.run(Command::ProposeTracked);
                let track = t2.elapsed();
                let n = person.bad(&mut run, p).len();
                let mut note = format!("T{n}");
                let t2 = std::time::Instant::now();
                if mode == 2 && p >= 4 {
                    match fit_now(&mut run) { Ok(fit) => { from_fit(&mut run, &fit, p); note += &format!(" F{}", person.bad(&mut run, p).len()); }, Err(e) => println!("{e}") }
                }
                if p == 5 { println!("track {track:?} fit {:?}", t2.elapsed()); }
                let bad = person.bad(&mut run, p);
                note += &format!(" {}", bad.iter().map(|k| k.name()).collect::<Vec<_>>().join(" "));
                println!("  {p}: {note}");
                counts.push(person.correct(&mut run, p));
            }
        }
        if mode == 3 {
            let n = 2; for p in 2..=n { run.session().go_to(p); run.run(Command::ProposeTracked); counts.push(person.correct(&mut run, p)); }
            for p in [3, 12, 4, 11, 5, 10, 6, 9, 7, 8u32] {
                run.session().go_to(p);
                run.run(Command::ProposeTracked);
            }
            for p in [3, 12, 4, 11, 5, 10, 6, 9, 7, 8u32] {
                let n = person.bad(&mut run, p).len();
                let fit = fit_now(&mut run).unwrap(); from_fit(&mut run, &fit, p);
                let bad = person.bad(&mut run, p);
                println!("  {p}: T{n} F{} {}", bad.len(), bad.iter().map(|k| k.name()).collect::<Vec<_>>().join(" "));
                counts.push(person.correct(&mut run, p));
            }
        }
        let fit = fit_now(&mut run).unwrap();
        println!("{gait} mode {mode}: clicks {} ({:.0} %) contacts {} {counts:?} rms {:.3} fit {:.3} gait {} {:?}", person.clicks, 100.0 * person.clicks as f64 / 312.0, person.contacts, person.rms(&mut run), person.rms_fit(&fit), fit.analysis.implied.name(), t.elapsed());
    }
}
