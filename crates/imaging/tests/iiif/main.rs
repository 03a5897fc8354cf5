//! Fetching plates from a real image service on this computer, good and bad.

#![allow(clippy::unwrap_used, reason = "a test stops at the first thing it cannot do")]

mod failures;
#[path = "../iiif_server/mod.rs"]
mod iiif_server;
mod interruptions;
mod pictures;

use std::path::{Path, PathBuf};
use std::time::Duration;

use iiif_server::{Fault, Request, Server, Service};
use image::GrayImage;
use muybridge_imaging::fetch::{FetchError, FetchLimits, Fetched, Progress, fetch};

/// Waits short enough for a test.
const LIMITS: FetchLimits = FetchLimits {
    bytes: 10_000_000,
    pixels: 10_000_000,
    attempts: 3,
    first_wait: Duration::from_millis(5),
    timeout: Duration::from_millis(2000),
};
/// Address of the whole picture, below the service.
const WHOLE: &str = "full/max/0/default.jpg";

/// A picture in which no two tiles are alike and few bytes repeat.
fn picture() -> GrayImage {
    let noise =
        |x: u32, y: u32| (x.wrapping_mul(2_654_435_761) ^ y.wrapping_mul(40_503).rotate_left(7)) >> 27;
    GrayImage::from_fn(300, 200, |x, y| image::Luma([(x / 2 + y / 3 + noise(x, y)) as u8]))
}

/// A folder for one plate.
struct Cache {
    folder: tempfile::TempDir,
    told: Vec<Progress>,
}

impl Cache {
    fn new() -> Self {
        Self { folder: tempfile::tempdir().unwrap(), told: Vec::new() }
    }

    /// In a folder that does not exist yet.
    fn target(&self) -> PathBuf {
        self.folder.path().join("cache/plate-616")
    }

    fn fetch(&mut self, server: &Server) -> Result<Fetched, FetchError> {
        self.fetch_within(&server.address(), &LIMITS)
    }

    fn fetch_within(&mut self, address: &str, limits: &FetchLimits) -> Result<Fetched, FetchError> {
        fetch(address, &self.target(), limits, &mut |progress| self.told.push(progress))
    }

    /// Names of all files of the plate.
    fn files(&self) -> Vec<String> {
        let Ok(entries) = std::fs::read_dir(self.folder.path().join("cache")) else { return Vec::new() };
        let mut names: Vec<_> = entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    fn waits(&self) -> usize {
        self.told.iter().filter(|progress| matches!(progress, Progress::Waiting { .. })).count()
    }
}

fn gray(path: &Path) -> GrayImage {
    image::open(path).unwrap().into_luma8()
}

/// Mean absolute difference of two pictures of the same size.
fn difference(a: &GrayImage, b: &GrayImage) -> f64 {
    assert_eq!(a.dimensions(), b.dimensions());
    let sum: u64 = a.iter().zip(b.iter()).map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
    sum as f64 / a.len() as f64
}

/// A fetch that fails with a message that names the address below the service and says `words`, and leaves nothing.
#[track_caller]
fn assert_fails(
    service: Service,
    faults: impl Fn(&Request) -> Option<Fault> + Send + Sync + 'static,
    [path, words]: [&str; 2],
) -> Cache {
    let server = Server::start_with_faults(picture(), service, faults);
    let mut cache = Cache::new();
    let message = cache.fetch(&server).unwrap_err().to_string();
    assert!(message.contains(&format!("{}/{path}", server.address())), "{message}");
    assert!(message.contains(words) && message.contains(';'), "{message}");
    assert_eq!(cache.files(), Vec::<String>::new(), "{message}");
    cache
}

/// The fault for one path, always.
fn at(path: &'static str, fault: Fault) -> impl Fn(&Request) -> Option<Fault> + Send + Sync {
    move |request| (request.path == path).then(|| fault.clone())
}

/// The fault for the first `times` requests of one path.
fn first(times: usize, path: &'static str, fault: Fault) -> impl Fn(&Request) -> Option<Fault> + Send + Sync {
    move |request| (request.path == path && request.earlier < times).then(|| fault.clone())
}
