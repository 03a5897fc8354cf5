//! Damaged and hostile files: an error with its place or a note, soon, and never a panic.

use std::collections::BTreeMap;
use std::time::Instant;

use muybridge_core::Random;

use super::*;

#[test]
fn damage_is_an_error_with_its_place_or_a_note() {
    let deep = format!("{{\"shapes\": {}", "[".repeat(200_000));
    let table = "panel,keypoint,x_px,y_px\n";
    let cases: [(String, &str); 14] = [
        (String::new(), "empty"),
        ("  \n".into(), "empty"),
        ("hello".into(), "neither DeepLabCut"),
        ("{\"a\": 1}".into(), "neither `annotations`"),
        ("{\"shapes\": [], \"imagePath\": NaN}".into(), "no valid JSON"),
        (deep, "no valid JSON"),
        (format!("{table}1,dock,3\n"), "line 2: 3 cells, but the header has 4"),
        (format!("{table}1,dock,3;5,4\n"), "line 2, column x_px"),
        (format!("{table}one,dock,3,4\n"), "line 2, column panel"),
        ("panel;keypoint;x_px;y_px\n1;dock;3;4\n".into(), "no column `panel`"),
        ("scorer,,,S\nbodyparts,,,a\n".into(), "no row `coords`"),
        ("scorer,,,S\nbodyparts,,,a,a\ncoords,,,x\n".into(), "differ in width"),
        ("scorer,S\nbodyparts,a\ncoords,z\n0,1\n".into(), "expected x, y or likelihood"),
        (labels(["a", "b"], &["labeled-data,v,img001.png,1,2,3"]), "line 4: 6 cells, but the header has 7"),
    ];
    for (text, says) in cases {
        let error = imported("file.x", &text).unwrap_err().to_string();
        assert!(error.starts_with("file.x: ") && error.contains(says), "{says}: {error}");
        assert!(error.len() < 400, "{error}");
    }
    let far =
        format!("{table}1,dock,1e308,4\n1,poll,inf,4\n1,back,NaN,4\n1,croup,30,40\n9,dock,1,1\n1,wing,1,1\n");
    let import = imported("p.csv", &far).unwrap();
    assert_eq!((import.point_count(), import.notes.len()), (1, 4), "{:?}", import.notes);
}

#[test]
fn huge_and_foreign_files_are_refused_quickly() {
    let start = Instant::now();
    let commas = format!("scorer{}", ",".repeat(LARGEST_FILE_BYTES - 6));
    assert!(imported("c.csv", &commas).unwrap_err().to_string().contains("columns are too many"));
    let large = ImportFile { name: "l".into(), content: vec![b','; LARGEST_FILE_BYTES + 1] };
    let hdf = ImportFile { name: "h".into(), content: b"\x89HDF\r\n".to_vec() };
    let binary = ImportFile { name: "b".into(), content: vec![0xff; 100] };
    for (file, says) in [(large, "too many"), (hdf, "HDF5"), (binary, "UTF-8")] {
        let error = import(&[file], None, &manifest(), &Cutouts, &BTreeMap::new()).unwrap_err().to_string();
        assert!(error.contains(says), "{error}");
    }
    assert!(start.elapsed().as_secs() < 20, "{:?}", start.elapsed());
}

/// Pieces that break readers.
const POISON: [&str; 14] = [
    "",
    "NaN",
    "1e308",
    "-1e999",
    "\"",
    "\n",
    ",",
    ",,,,,,",
    "[",
    "{}",
    "null",
    "\0",
    "\u{202e}",
    "999999999999999999999",
];

#[test]
fn no_mutation_makes_it_panic() {
    let mut random = Random::new(7);
    let mut below = |n: usize| ((random.uniform() * n as f64) as usize).min(n - 1);
    let (mut good, mut bad) = (0, 0);
    for format in Format::ALL {
        for file in files(&exported(&filled(2), format, None)).into_iter().take(2) {
            for _ in 0..120 {
                let mut content = file.content.clone();
                for _ in 0..=below(3) {
                    let at = below(content.len());
                    match below(4) {
                        0 => content.truncate(at.max(1)),
                        1 => content[at] = below(256) as u8,
                        2 => {
                            let end = (at + below(40)).min(content.len());
                            content.splice(at..end, POISON[below(POISON.len())].bytes());
                        }
                        _ => {
                            let end = (at + below(400)).min(content.len());
                            let piece = content[at..end].to_vec();
                            content.splice(at..at, piece);
                        }
                    }
                    content.push(b'\n');
                }
                let mutated = ImportFile { name: file.name.clone(), content };
                match import(&[mutated], None, &manifest(), &Cutouts, &BTreeMap::new()) {
                    Ok(import) => {
                        good += 1;
                        let finite =
                            |placed: &Placed| placed.at_px.is_none_or(|at| at.iter().all(|v| v.is_finite()));
                        assert!(
                            import.panels.iter().all(|(_, points)| points.iter().all(|(_, p)| finite(p)))
                        );
                    }
                    Err(error) => {
                        bad += 1;
                        assert!(error.to_string().len() < 1000, "{error}");
                    }
                }
            }
        }
    }
    assert!(good > 20 && bad > 20, "{good} read, {bad} refused");
}
