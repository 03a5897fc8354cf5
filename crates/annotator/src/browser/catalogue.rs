//! The plates of the catalogue: what is fetched can be opened, what is not can be fetched.

use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};

use egui::{Grid, ProgressBar, ScrollArea, Ui};
use muybridge_capture::{Catalogue, CataloguePlate, Manifest, cache_folder, locate_image, write_json};
use muybridge_imaging::acquire::{catalogue_identifier, from_catalogue};
use muybridge_imaging::fetch::{FetchLimits, Progress, fetch, stored};

use crate::job::{Job, take_answer};
use crate::toast::Messages;

/// How far a download is, for people, and as a share where that is known.
type Told = Arc<Mutex<(String, Option<f32>)>>;

/// A download under way.
struct Download {
    number: u32,
    told: Told,
    job: Option<Job<Result<PathBuf, String>>>,
}

/// The list.
pub(super) struct CatalogueList {
    folder: PathBuf,
    catalogue: Result<Catalogue, String>,
    fetched: Vec<bool>,
    download: Option<Download>,
}

impl CatalogueList {
    /// Reads the catalogue of a folder of plates.
    pub(super) fn read(folder: &Path) -> Self {
        let catalogue = Catalogue::read(&folder.join("catalogue.toml")).map_err(|error| error.to_string());
        let mut list = Self { folder: folder.to_path_buf(), catalogue, fetched: Vec::new(), download: None };
        list.look_what_is_fetched();
        list
    }

    fn look_what_is_fetched(&mut self) {
        let Ok(catalogue) = &self.catalogue else { return };
        let fetched = |plate: &CataloguePlate| {
            let path = manifest_path(&self.folder, plate.number);
            Manifest::read(&path)
                .is_ok_and(|manifest| manifest.images.iter().all(|i| locate_image(&path, &i.file).exists()))
        };
        self.fetched = catalogue.plates.iter().map(fetched).collect();
    }

    /// Takes a finished download: its manifest is to be opened.
    pub(super) fn finish(&mut self, messages: &mut Messages) -> Option<PathBuf> {
        let answer = take_answer(&mut self.download.as_mut()?.job)?;
        self.download = None;
        self.look_what_is_fetched();
        match answer.and_then(|answer| answer) {
            Ok(path) => Some(path),
            Err(trouble) => {
                messages.trouble(trouble);
                None
            }
        }
    }

    /// Draws the list; the plate that was chosen.
    pub(super) fn show(&mut self, ui: &mut Ui, filter: &str) -> Option<PathBuf> {
        let catalogue = match &self.catalogue {
            Ok(catalogue) => catalogue.clone(),
            Err(trouble) => {
                ui.label(trouble);
                return None;
            }
        };
        if let Some(download) = &self.download {
            let (text, share) = download.told.lock().map(|told| told.clone()).unwrap_or_default();
            ui.add(ProgressBar::new(share.unwrap_or(0.0)).text(format!("Plate {}: {text}", download.number)));
        }
        let (mut chosen, mut wanted) = (None, None);
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            Grid::new("catalogue").num_columns(5).striped(true).spacing([14.0, 4.0]).show(ui, |ui| {
                for (plate, fetched) in catalogue.plates.iter().zip(&self.fetched) {
                    let words = format!("{} {} {} {}", plate.number, plate.animal, plate.action, plate.gait);
                    if !words.to_lowercase().contains(filter) {
                        continue;
                    }
                    ui.label(plate.number.to_string());
                    ui.label(&plate.animal);
                    ui.label(&plate.action);
                    ui.label(plate.gait.to_string());
                    if *fetched && ui.button(format!("Open {}", plate.number)).clicked() {
                        chosen = Some(manifest_path(&self.folder, plate.number));
                    }
                    let free = self.download.is_none();
                    let fetch = egui::Button::new(format!("Fetch {}", plate.number));
                    if !fetched && ui.add_enabled(free, fetch).clicked() {
                        wanted = Some(plate.clone());
                    }
                    ui.end_row();
                }
            });
        });
        if let Some(plate) = wanted {
            self.start(ui.ctx(), catalogue, plate);
        }
        chosen
    }

    fn start(&mut self, context: &egui::Context, catalogue: Catalogue, plate: CataloguePlate) {
        let told = Told::default();
        let (number, folder, tell, window) =
            (plate.number, self.folder.clone(), told.clone(), context.clone());
        let job = Job::start(format!("Fetching plate {number}"), context, move || {
            download(&catalogue, &plate, &folder, |text, share| {
                if let Ok(mut told) = tell.lock() {
                    *told = (text, share);
                }
                window.request_repaint();
            })
        });
        self.download = Some(Download { number, told, job: Some(job) });
    }
}

fn manifest_path(folder: &Path, number: u32) -> PathBuf {
    folder.join(format!("{}.json", catalogue_identifier(number)))
}

/// Fetches a plate into the cache and writes its manifest, without panels: those are found in the window.
fn download(
    catalogue: &Catalogue,
    plate: &CataloguePlate,
    folder: &Path,
    mut tell: impl FnMut(String, Option<f32>),
) -> Result<PathBuf, String> {
    let cache = cache_folder().ok_or("This system has no cache folder; set MUYBRIDGE_CACHE")?;
    std::fs::create_dir_all(&cache).map_err(|error| format!("{}: {error}", cache.display()))?;
    let target = cache.join(catalogue_identifier(plate.number));
    let limits = FetchLimits::default();
    let picture = match stored(&target, limits.pixels).map_err(|error| error.to_string())? {
        Some(picture) => picture,
        None => {
            let fetched = fetch(&plate.iiif, &target, &limits, &mut |progress| {
                let (text, share) = in_words(&progress);
                tell(text, share);
            });
            fetched.map_err(|error| error.to_string())?.plate
        }
    };
    let path = manifest_path(folder, plate.number);
    if !path.exists() {
        write_json(&path, &from_catalogue(catalogue, plate, &picture)).map_err(|error| error.to_string())?;
    }
    Ok(path)
}

fn in_words(progress: &Progress) -> (String, Option<f32>) {
    let megabytes = |bytes: u64| format!("{:.1} MB", bytes as f64 / 1e6);
    match progress {
        Progress::Described { width_px, height_px } => (format!("{width_px} x {height_px} px"), None),
        Progress::Bytes { received, total } => {
            (megabytes(*received), total.map(|total| *received as f32 / total.max(1) as f32))
        }
        Progress::Tiles { done, total, bytes } => (
            format!("tile {done} of {total}, {}", megabytes(*bytes)),
            Some(*done as f32 / (*total).max(1) as f32),
        ),
        Progress::Waiting { wait, cause } => (format!("again in {:.0} s: {cause}", wait.as_secs_f64()), None),
    }
}
