//! Random work on a specimen: the same seed makes the same changes.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use muybridge_capture::{
    Document, Draft, Event, Instant, Keypoint, KeypointState, Mark, NearOff, Placed, PlacedBy, StanceLabel,
};
use muybridge_core::{Pair, Random};
use muybridge_tests::repository;
use tempfile::TempDir;

/// The specimen that is worked on.
const NAME: &str = "specimen-walk.json";
/// Panels that are left, so that there is something to work on.
const FEWEST_PANELS: usize = 3;
/// Other names the annotation is saved under.
const OTHER_NAMES: [&str; 3] =
    ["annotations/second.json", "annotations/deep/third.json", "annotations/deep/er/fourth.json"];

/// A copy of the specimen's documents in a folder of their own.
pub(crate) fn specimen() -> TempDir {
    specimen_in(tempfile::tempdir().unwrap())
}

/// The same in memory, where the system has such a folder: waiting for the disk, a program does little else.
pub(crate) fn specimen_in_memory() -> TempDir {
    specimen_in(tempfile::tempdir_in("/dev/shm").or_else(|_| tempfile::tempdir()).unwrap())
}

fn specimen_in(folder: TempDir) -> TempDir {
    std::fs::create_dir(folder.path().join("annotations")).unwrap();
    for file in [NAME.to_string(), format!("annotations/{NAME}")] {
        let from = repository().join("plates/specimens").join(&file);
        std::fs::copy(from, folder.path().join(&file)).unwrap();
    }
    folder
}

/// Fowler, Noll and Vo's hash (1a, 64 bits).
fn hash(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |h, b| (h ^ u64::from(*b)).wrapping_mul(0x100_0000_01b3))
}

/// What a draft holds; how it names its plate depends on where it is saved, and is left out.
pub(crate) fn draft_hash(draft: &Draft) -> u64 {
    let mut draft = draft.clone();
    draft.annotation.plate.clear();
    hash(serde_json::to_string(&draft).unwrap().as_bytes())
}

/// All documents of a folder, by name, with the hash of their bytes.
pub(crate) fn documents(folder: &Path) -> Vec<(String, u64)> {
    let names = [NAME.to_string(), format!("annotations/{NAME}")];
    let names = names.into_iter().chain(OTHER_NAMES.map(String::from));
    names.filter_map(|name| Some((name.clone(), hash(&std::fs::read(folder.join(&name)).ok()?)))).collect()
}

/// A state, as a person can tell it from others.
#[derive(Clone, Debug)]
pub(crate) struct Moment {
    /// Draft, place, what can be undone and redone, whether it is saved.
    pub(crate) full: u64,
    /// The draft alone.
    pub(crate) draft: u64,
    /// The draft with everything undone.
    pub(crate) base: u64,
    /// The annotation's path in the folder.
    pub(crate) path: PathBuf,
}

/// The present state of a document.
pub(crate) fn moment(document: &Document, folder: &Path, base: u64) -> Moment {
    let path = document.annotation_path().strip_prefix(folder).unwrap().to_path_buf();
    let (undo, redo) = (document.undo_label(), document.redo_label());
    let draft = serde_json::to_string(document.draft()).unwrap();
    let text = format!("{draft} {undo:?} {redo:?} {} {}", document.is_changed(), path.display());
    Moment { full: hash(text.as_bytes()), draft: draft_hash(document.draft()), base, path }
}

/// Somebody at work.
pub(crate) struct Work {
    /// None only while it is opened again.
    document: Option<Document>,
    random: Random,
    folder: PathBuf,
    journals: Option<PathBuf>,
    base: u64,
    saving: bool,
    versions: BTreeSet<(String, u64)>,
    /// Whether the document is closed and opened again at times.
    pub(crate) may_reopen: bool,
}

impl Work {
    /// Opens the specimen of a folder.
    pub(crate) fn begin(seed: u64, folder: &Path, journals: Option<PathBuf>) -> Self {
        let random = Random::new(seed);
        let versions = documents(folder).into_iter().collect();
        let (folder, may_reopen) = (folder.to_path_buf(), true);
        let mut work =
            Self { document: None, random, folder, journals, base: 0, saving: false, versions, may_reopen };
        work.open(&work.folder.join("annotations").join(NAME));
        work
    }

    fn open(&mut self, path: &Path) {
        let document = Document::open(path, self.journals.as_deref()).unwrap();
        self.base = draft_hash(document.draft());
        self.document = Some(document);
    }

    fn document(&mut self) -> &mut Document {
        self.document.as_mut().unwrap()
    }

    /// The present state.
    pub(crate) fn moment(&self) -> Moment {
        moment(self.document.as_ref().unwrap(), &self.folder, self.base)
    }

    /// Why the journal is not written.
    pub(crate) fn fault(&self) -> Option<&str> {
        self.document.as_ref().unwrap().journal_fault()
    }

    /// Whether the last command was a save.
    pub(crate) fn saving(&self) -> bool {
        self.saving
    }

    /// Every version of every file that was saved.
    pub(crate) fn versions(&self) -> &BTreeSet<(String, u64)> {
        &self.versions
    }

    fn below(&mut self, count: usize) -> usize {
        (self.random.uniform() * count as f64) as usize
    }

    /// One command.
    pub(crate) fn step(&mut self) {
        self.saving = false;
        match self.below(20) {
            0..=2 => drop(self.document().undo()),
            3 | 4 => drop(self.document().redo()),
            5 | 6 => self.save(),
            7 => {
                let name = OTHER_NAMES[self.below(OTHER_NAMES.len())];
                let path = self.folder.join(name);
                self.document().save_as(&path, true).unwrap();
                self.note_versions();
            }
            8 | 9 if self.may_reopen && self.document().is_changed() => self.save(),
            8 | 9 if self.may_reopen => {
                let path = self.document().annotation_path().to_path_buf();
                self.document.take().unwrap().close();
                self.open(&path);
            }
            _ => self.change(),
        }
    }

    fn save(&mut self) {
        self.document().save(false).unwrap();
        self.note_versions();
    }

    fn note_versions(&mut self) {
        self.saving = true;
        self.versions.extend(documents(&self.folder));
    }

    /// One change.
    pub(crate) fn change(&mut self) {
        let mut random = self.random;
        while !self.document().edit("A change", |draft| change(draft, &mut random)) {}
        self.random = random;
    }
}

fn pick<'a, T>(random: &mut Random, items: &'a [T]) -> &'a T {
    &items[(random.uniform() * items.len() as f64) as usize]
}

/// Changes something of what a person can change.
fn change(draft: &mut Draft, random: &mut Random) {
    let numbers: Vec<u32> = draft.manifest.panels.iter().map(|panel| panel.panel).collect();
    let panel = *pick(random, &numbers);
    let leg = (*pick(random, &[NearOff::Near, NearOff::Off]), *pick(random, &[Pair::Fore, Pair::Hind]));
    match (random.uniform() * 10.0) as usize {
        0..=3 => change_point(draft, panel, random),
        4 => {
            let label = *pick(random, &[StanceLabel::Stance, StanceLabel::Swing, StanceLabel::Unknown]);
            draft.panel_mut(panel).contacts.set(leg.0, leg.1, label);
        }
        5 => {
            let event = *pick(random, &[Event::Strike, Event::LiftOff]);
            let at_panel = f64::from(panel) + random.uniform();
            draft.annotation.instants.push(Instant { side: leg.0, pair: leg.1, event, at_panel });
        }
        6 => {
            let at_px = [random.between(0.0, 500.0), random.between(0.0, 500.0)];
            let annotation = draft.panel_mut(panel);
            annotation.marks.push(Mark { mark: random.between(-9.0, 9.0), at_px });
            annotation.ground_px = Some([at_px, [at_px[0] + random.between(20.0, 90.0), at_px[1]]]);
        }
        7 if numbers.len() > FEWEST_PANELS => {
            draft.manifest.panels.retain(|p| p.panel != panel);
            draft.annotation.panels.retain(|p| p.panel != panel);
            draft.annotation.instants.clear();
        }
        8 => exchange_panels(draft, panel, *pick(random, &numbers)),
        _ => change_words(draft, random),
    }
}

fn change_point(draft: &mut Draft, panel: u32, random: &mut Random) {
    let keypoints: Vec<Keypoint> = Keypoint::all().collect();
    let (keypoint, at_px) = (*pick(random, &keypoints), [random.between(-5.0, 1500.0), random.normal()]);
    let states = [KeypointState::Visible, KeypointState::Occluded, KeypointState::Absent];
    let state = *pick(random, &states);
    let placed = Placed {
        at_px: (state != KeypointState::Absent).then_some(at_px),
        state,
        by: *pick(random, &[PlacedBy::Hand, PlacedBy::Tracked]),
        sd_px: None,
    };
    let keypoints = &mut draft.panel_mut(panel).keypoints;
    if random.uniform() < 0.2 { keypoints.remove(keypoint) } else { keypoints.insert(keypoint, placed) }
}

/// Two panels exchange their photographs, and what is marked goes with them.
fn exchange_panels(draft: &mut Draft, a: u32, b: u32) {
    let other = |number: u32| [(a, b), (b, a)].iter().find(|(from, _)| *from == number).map(|(_, to)| *to);
    for panel in &mut draft.manifest.panels {
        panel.panel = other(panel.panel).unwrap_or(panel.panel);
    }
    draft.manifest.panels.sort_by_key(|panel| panel.panel);
    for panel in &mut draft.annotation.panels {
        panel.panel = other(panel.panel).unwrap_or(panel.panel);
    }
    draft.annotation.panels.sort_by_key(|panel| panel.panel);
}

/// Words of every alphabet, and numbers with as many digits as there are.
fn change_words(draft: &mut Draft, random: &mut Random) {
    let letters = ["a", "\u{e9}", "\"", "\\", "\n", "\u{1f40e}", "\u{0}", " ", "{", "\u{2028}"];
    let title = &mut draft.manifest.title;
    title.push_str(pick::<&str>(random, &letters));
    if title.len() > 60 {
        title.clear();
    }
    if let Some(calibration) = &mut draft.manifest.calibration {
        calibration.camera.distance_m.value = random.between(5.0, 50.0);
        calibration.camera.height_m.sd = random.uniform() / 3.0;
    }
    draft.annotation.stride.closes_after_panels = Some(random.between(2.0, 20.0));
    draft.annotation.notes = vec![format!("{}", random.normal())];
}
