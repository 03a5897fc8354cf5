//! Plates from their IIIF Image API services (versions 2 and 3).
//!
//! [`fetch`] reads `info.json` and takes the whole picture, which is kept byte for byte. Where the service limits the
//! size of an answer, answers with less than it describes, or serves tiles only, it fetches tiles at full size and puts
//! them together without loss. Where only a smaller picture is to be had, it takes that, and [`Fetched`] says so.
//!
//! A picture appears at its final name whole or not at all. After a failure only what a later fetch goes on from stays:
//! `TARGET.part` with `TARGET.part.json` (a whole picture's beginning and what it is the beginning of), `TARGET.tiles`.

use std::io::{Cursor, ErrorKind};
use std::path::{Path, PathBuf};
use std::time::Duration;

use image::{DynamicImage, ImageFormat};
use muybridge_capture::{FileError, Hash, hash_file, write_atomically};

use crate::picture::{LoadLimits, PictureError, load_gray};

mod address;
mod client;
mod description;
mod error;
mod jpeg;
mod place;
mod tiles;
mod whole;

pub use error::FetchError;

use address::Address;
use client::Client;
use description::Description;
use place::{Place, write_error};
use whole::Whole;

/// Most bytes of an `info.json`; they are a few thousand.
const MOST_INFO_BYTES: u64 = 1_000_000;
/// Longest wait before another attempt, also when the server asks for a longer one: then it is left to the person.
const LONGEST_WAIT: Duration = Duration::from_secs(60);

/// What is fetched at most, and how patiently.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FetchLimits {
    /// Most bytes of a picture, all tiles together.
    pub bytes: u64,
    /// Most pixels of a picture.
    pub pixels: u64,
    /// How often a request is made in all, when it fails in a way that may pass. At least 1.
    pub attempts: u32,
    /// Wait before the second attempt; it doubles with every further one.
    pub first_wait: Duration,
    /// Longest time without data.
    pub timeout: Duration,
}

impl Default for FetchLimits {
    /// 400 MB, twice the largest JPEG of as many pixels as [`LoadLimits`] allows at one byte each; four attempts, 1, 2
    /// and 4 s apart; half a minute, in which slow servers render a large picture.
    fn default() -> Self {
        Self {
            bytes: 400_000_000,
            pixels: LoadLimits::default().pixels,
            attempts: 4,
            first_wait: Duration::from_secs(1),
            timeout: Duration::from_secs(30),
        }
    }
}

/// How a fetch goes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Progress {
    /// The service has described the picture.
    Described {
        /// Width of the whole picture, px.
        width_px: u32,
        /// Height of the whole picture, px.
        height_px: u32,
    },
    /// A picture arrives in one answer.
    Bytes {
        /// Bytes there are, those of earlier fetches included.
        received: u64,
        /// Bytes there will be, where the server says.
        total: Option<u64>,
    },
    /// A picture arrives in tiles.
    Tiles {
        /// Tiles there are, those of earlier fetches included.
        done: u32,
        /// Tiles there will be.
        total: u32,
        /// Bytes of the tiles there are.
        bytes: u64,
    },
    /// A request has failed and is made again after a wait.
    Waiting {
        /// The wait.
        wait: Duration,
        /// Why it failed.
        cause: String,
    },
}

/// A plate's picture on disk that reads to its end.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StoredPlate {
    /// The file.
    pub path: PathBuf,
    /// Its hash.
    pub sha256: Hash,
    /// Width, px.
    pub width_px: u32,
    /// Height, px.
    pub height_px: u32,
    /// Size of the file.
    pub bytes: u64,
}

/// What was fetched.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fetched {
    /// The file.
    pub plate: StoredPlate,
    /// Where it is from: the address of the picture, or that of the service where it was put together from tiles.
    pub url: String,
    /// Number of tiles it was put together from; 0 when it came whole.
    pub tiles: u32,
    /// Width and height that the service describes, px. Larger than those of the file when only a smaller picture is to
    /// be had.
    pub full_px: [u32; 2],
}

/// Fetches a plate's picture from a IIIF image service to `target.jpg` (as it came) or `target.png` (put together from
/// tiles), replacing what is there; see [`stored`] for not asking again. `target` is a path without an ending; its folder
/// is made. `progress` is told how it goes.
///
/// The service's address must be https, or http on this computer.
///
/// # Errors
/// When the plate cannot be had within the limits, or cannot be written. Then what was at `target` is still there.
pub fn fetch(
    service: &str,
    target: &Path,
    limits: &FetchLimits,
    progress: &mut dyn FnMut(Progress),
) -> Result<Fetched, FetchError> {
    let address = Address::parse(service)?;
    let place = Place::new(target);
    let mut client = Client::new(&address, limits, progress);
    fetch_to(&mut client, &address, &place).inspect_err(|error| {
        // The failure itself is what to tell of.
        let _ = place.tidy_after(error);
    })
}

/// The picture that is at `target` (a path as for [`fetch`]) and reads to its end, so that it need not be fetched. A
/// damaged one, or one of more than `most_pixels`, counts as none.
///
/// # Errors
/// When there is a file that cannot be read.
pub fn stored(target: &Path, most_pixels: u64) -> Result<Option<StoredPlate>, FetchError> {
    let place = Place::new(target);
    for path in [place.jpeg(), place.png()] {
        match load_gray(&path, LoadLimits { pixels: most_pixels }) {
            Ok(picture) => return stored_plate(path, picture.dimensions().into()).map(Some),
            Err(PictureError::Read { path, source }) if source.kind() != ErrorKind::NotFound => {
                return Err(FileError::Read { path, source }.into());
            }
            Err(_) => {}
        }
    }
    Ok(None)
}

fn stored_plate(path: PathBuf, [width_px, height_px]: [u32; 2]) -> Result<StoredPlate, FetchError> {
    let sha256 = hash_file(&path)?;
    let bytes = match std::fs::metadata(&path) {
        Ok(metadata) => metadata.len(),
        Err(source) => return Err(FileError::Read { path, source }.into()),
    };
    Ok(StoredPlate { path, sha256, width_px, height_px, bytes })
}

/// One picture to fetch.
struct Job<'a> {
    address: &'a Address,
    place: &'a Place,
    description: &'a Description,
    origin: tiles::Origin,
}

fn fetch_to(client: &mut Client, address: &Address, place: &Place) -> Result<Fetched, FetchError> {
    let url = address.info();
    let json = client.persist(|client| client.get_bytes(&url, [0, MOST_INFO_BYTES]));
    let json = json.map_err(|error| match error {
        FetchError::TooManyBytes { url, most } => {
            FetchError::NotIiif { url, fault: format!("more than {most} bytes") }
        }
        error => error,
    })?;
    let description = &Description::parse(&url, &json, client.limits.pixels)?;
    let [width_px, height_px] = description.full_px;
    (client.progress)(Progress::Described { width_px, height_px });
    place.make_folder()?;
    let description_text = String::from_utf8_lossy(&json).into_owned();
    let origin = tiles::Origin { service: address.base().into(), description: description_text };
    let job = Job { address, place, description, origin };
    let Some(tile_px) = description.tile_px() else {
        let (url, whole) = job.whole(client)?;
        return job.keep_whole(url, &whole);
    };
    if description.is_limited() || job.origin.is_at(place) {
        return job.in_tiles(client, tile_px);
    }
    match job.whole(client) {
        Ok((url, whole)) if whole.size_px() == description.full_px => job.keep_whole(url, &whole),
        Err(error) if !error.is_not_offered() => Err(error),
        // Smaller than described, or not offered whole.
        _ => {
            place.remove_part()?;
            job.in_tiles(client, tile_px)
        }
    }
}

impl Job<'_> {
    /// The whole picture by the first address that it is offered at, with the address.
    fn whole(&self, client: &mut Client) -> Result<(String, Whole), FetchError> {
        let mut refusal = None;
        for size in self.description.whole_sizes() {
            let url = self.address.picture("full", &size);
            match whole::fetch_whole(client, &url, self.place) {
                Ok(whole) => {
                    self.check_shape(&url, &whole)?;
                    return Ok((url, whole));
                }
                Err(error) if error.is_not_offered() => {
                    refusal.get_or_insert(error);
                }
                Err(error) => return Err(error),
            }
        }
        let nothing = || FetchError::NotIiif { url: self.address.info(), fault: "it offers no size".into() };
        Err(refusal.unwrap_or_else(nothing))
    }

    fn check_shape(&self, url: &str, whole: &Whole) -> Result<(), FetchError> {
        if self.description.has_shape_of(whole.size_px()) {
            return Ok(());
        }
        let ([w, h], [width, height]) = (whole.size_px(), self.description.full_px);
        let found = format!("a picture of {w} x {h} px, where {width} x {height} px are described,");
        Err(FetchError::WrongContent { url: url.into(), found })
    }

    fn keep_whole(&self, url: String, whole: &Whole) -> Result<Fetched, FetchError> {
        let path = self.place.jpeg();
        write_atomically(&path, &whole.jpeg)?;
        self.done(path, whole.size_px(), url, 0)
    }

    fn in_tiles(&self, client: &mut Client, tile_px: [u32; 2]) -> Result<Fetched, FetchError> {
        let (picture, tiles) = tiles::fetch_tiles(client, self, tile_px)?;
        let path = self.place.png();
        write_atomically(&path, &png(&picture, &path)?)?;
        self.done(path, self.description.full_px, self.address.base().into(), tiles)
    }

    fn done(&self, path: PathBuf, size_px: [u32; 2], url: String, tiles: u32) -> Result<Fetched, FetchError> {
        self.place.keep_only(&path)?;
        let plate = stored_plate(path, size_px)?;
        Ok(Fetched { plate, url, tiles, full_px: self.description.full_px })
    }
}

fn png(picture: &DynamicImage, path: &Path) -> Result<Vec<u8>, FetchError> {
    let mut bytes = Vec::new();
    let written = picture.write_to(&mut Cursor::new(&mut bytes), ImageFormat::Png);
    written.map_err(|error| write_error(path, std::io::Error::other(error)))?;
    Ok(bytes)
}
