//! Files that are wrong in every way we could think of.

mod documents;
mod names;
mod pictures;

use std::path::{Path, PathBuf};

use muybridge_capture::{Document, Keypoint, write_atomically};
use serde_json::Value;

/// A file to be dropped.
pub(crate) struct Dropped {
    /// Where it is.
    pub(crate) path: PathBuf,
    /// Whether it may turn out to be a plate after all.
    pub(crate) may_open: bool,
}

/// The documents and the picture of a good plate.
#[derive(Clone)]
pub(crate) struct Specimen {
    /// The manifest.
    pub(crate) manifest: Value,
    /// The annotation.
    pub(crate) annotation: Value,
    picture: Vec<u8>,
}

impl Specimen {
    /// As it comes with the program.
    pub(crate) fn read() -> Self {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../plates/specimens");
        let json = |name: &str| serde_json::from_slice(&std::fs::read(folder.join(name)).unwrap()).unwrap();
        Self {
            manifest: json("specimen-trot.json"),
            annotation: json("annotations/specimen-trot.json"),
            picture: std::fs::read(folder.join("specimen-trot.jpg")).unwrap(),
        }
    }

    /// Lays it into a folder under another name; the annotation's path.
    pub(crate) fn unpack(mut self, folder: &Path, id: &str) -> PathBuf {
        std::fs::create_dir_all(folder.join("annotations")).unwrap();
        if self.manifest["id"].is_string() {
            self.manifest["id"] = id.into();
        }
        if self.annotation["plate"] == "../specimen-trot.json" {
            self.annotation["plate"] = format!("../{id}.json").into();
        }
        write(&folder.join("specimen-trot.jpg"), &self.picture);
        write(&folder.join(format!("{id}.json")), self.manifest.to_string().as_bytes());
        let path = folder.join(format!("annotations/{id}.json"));
        write(&path, self.annotation.to_string().as_bytes());
        path
    }
}

/// Writes a file.
pub(crate) fn write(path: &Path, content: &[u8]) {
    write_atomically(path, content).unwrap();
}

/// All hostile files; some are in the folder of journals.
pub(crate) fn hostile_files(folder: &Path, journals: &Path) -> Vec<Dropped> {
    std::fs::create_dir_all(folder).unwrap();
    let mut files = pictures::pictures(&folder.join("pictures"));
    files.extend(documents::documents(&folder.join("documents")));
    files.extend(names::names(&folder.join("names")));
    files.extend(damaged_journals(&folder.join("journals"), journals));
    files
}

/// Plates with work that was left behind, whose journals are damaged.
fn damaged_journals(folder: &Path, journals: &Path) -> Vec<Dropped> {
    let poll = Keypoint::from_name("poll").unwrap();
    let damages: [fn(&mut Vec<u8>); 5] = [
        Vec::clear,
        |text| text.truncate(text.len() / 2),
        |text| text[2000] ^= 1,
        |text| *text.last_mut().unwrap() = b'x',
        |text| text.extend_from_slice(b"00000000 {}\n\xff\xff"),
    ];
    let damaged = damages.iter().enumerate().map(|(at, damage)| {
        let path = Specimen::read().unpack(&folder.join(at.to_string()), &format!("left-{at}"));
        let before = journal_names(journals);
        let mut document = Document::open(&path, Some(journals)).unwrap();
        document.edit("Forget poll", |draft| draft.panel_mut(1).keypoints.remove(poll));
        drop(document);
        let journal = journal_names(journals).into_iter().find(|path| !before.contains(path)).unwrap();
        let mut text = std::fs::read(&journal).unwrap();
        damage(&mut text);
        write(&journal, &text);
        Dropped { path, may_open: true }
    });
    damaged.collect()
}

fn journal_names(journals: &Path) -> Vec<PathBuf> {
    std::fs::read_dir(journals).unwrap().map(|entry| entry.unwrap().path()).collect()
}

/// Plates that nobody would make, but which are not wrong.
pub(crate) fn odd_plates(folder: &Path) -> Vec<PathBuf> {
    let changes: [fn(&mut Specimen); 8] = [
        |plate| plate.manifest["panels"] = Value::Array(Vec::new()),
        |plate| (plate.manifest["calibration"], plate.manifest["facing"]) = (Value::Null, Value::Null),
        |plate| plate.annotation["panels"] = Value::Array(Vec::new()),
        // Far from its panel.
        |plate| plate.annotation["panels"][0]["keypoints"]["poll"]["at_px"] = vec![9.9e5, -9.9e5].into(),
        // All in one place.
        |plate| {
            for point in plate.annotation["panels"][0]["keypoints"].as_object_mut().unwrap().values_mut() {
                point["at_px"] = vec![100.0, 100.0].into();
            }
        },
        // Steep ground, marks on one another.
        |plate| {
            plate.annotation["panels"][1]["ground_px"] = serde_json::json!([[300.0, 10.0], [300.0, 10.0]]);
            plate.annotation["panels"][2]["ground_px"] = serde_json::json!([[9.0, 10.0], [8.0, 9e5]]);
            for mark in plate.annotation["panels"][1]["marks"].as_array_mut().unwrap() {
                mark["at_px"] = vec![1.0, 1.0].into();
            }
        },
        // Corners that make no photograph.
        |plate| {
            let quad = serde_json::json!([[10.0, 10.0], [300.0, 10.0], [20.0, 20.0], [10.0, 300.0]]);
            plate.manifest["panels"][0]["quad_px"] = quad;
            plate.annotation["stride"] =
                serde_json::json!({"first": 900, "last": 2, "closes_after_panels": 1000.0});
        },
        |plate| {
            let panel = plate.manifest["panels"][0].clone();
            let numbered = (1..=1000).map(|number| {
                let mut panel = panel.clone();
                panel["panel"] = number.into();
                panel
            });
            plate.manifest["panels"] = numbered.collect();
        },
    ];
    let plates = changes.iter().enumerate().map(|(at, change)| {
        let mut plate = Specimen::read();
        change(&mut plate);
        plate.unpack(&folder.join(at.to_string()), &format!("odd-{at}"))
    });
    plates.collect()
}
