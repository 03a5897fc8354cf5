//! Annotations and manifests that are wrong.

use std::path::Path;

use serde_json::{Value, json};

use super::{Dropped, Specimen, write};

/// Changes that each make a plate unusable.
const CHANGES: [fn(&mut Specimen); 46] = [
    |p| p.annotation["schema"] = json!(99),
    |p| p.annotation["schema"] = json!("1"),
    |p| p.annotation["schema"] = json!(-1),
    |p| p.annotation["schema"] = Value::Null,
    |p| p.manifest["schema"] = json!(99),
    |p| p.annotation["panels"] = json!({}),
    |p| p.annotation["panels"] = json!("all"),
    |p| p.annotation["plate"] = json!("/etc/passwd"),
    |p| p.annotation["plate"] = json!("/dev/zero"),
    |p| p.annotation["plate"] = json!("../../../../../../../../../../../../dev/zero"),
    |p| p.annotation["plate"] = json!("../../../../../../../../../../../../../etc/passwd"),
    |p| p.annotation["plate"] = json!(""),
    |p| p.annotation["plate"] = json!("."),
    |p| p.annotation["plate"] = json!(".."),
    |p| p.annotation["plate"] = json!("\0"),
    |p| p.annotation["plate"] = json!("..\\plate.json"),
    |p| p.annotation["plate"] = json!("x".repeat(100_000)),
    |p| p.annotation["panels"][0]["keypoints"]["poll"]["at_px"] = json!([1e300, -1e300]),
    |p| p.annotation["panels"][0]["keypoints"]["poll"]["at_px"] = json!([1.0]),
    |p| p.annotation["panels"][0]["keypoints"]["poll"]["at_px"] = json!([null, 1.0]),
    |p| p.annotation["panels"][0]["keypoints"]["tail"] = json!({}),
    |p| p.annotation["panels"][0]["panel"] = json!(0),
    |p| p.annotation["panels"][11]["panel"] = json!(u32::MAX),
    |p| p.annotation["panels"][1]["panel"] = json!(1),
    |p| p.annotation["panels"][0]["marks"][0]["mark"] = json!(1e300),
    |p| p.annotation["panels"][0]["ground_px"] = json!([[0.0, 1e300], [1e300, 0.0]]),
    |p| p.annotation["stride"]["last"] = json!(u32::MAX),
    |p| p.annotation["stride"]["closes_after_panels"] = json!(1e300),
    |p| p.annotation["visible_sd_px"] = json!(0.0),
    |p| p.annotation["images_sha256"] = json!([]),
    |p| {
        p.annotation["instants"] =
            json!([{"side": "near", "pair": "fore", "event": "strike", "at_panel": 1e300}]);
    },
    |p| p.annotation["notes"] = json!(["x".repeat(3_000_000)]),
    |p| p.manifest["panels"][0]["panel"] = json!(0),
    |p| p.manifest["panels"][11]["panel"] = json!(u32::MAX),
    |p| p.manifest["panels"][11]["panel"] = json!(1u64 << 32),
    |p| p.manifest["panels"][0]["image"] = json!(999),
    |p| p.manifest["panels"][0]["quad_px"] = json!([]),
    |p| p.manifest["panels"][0]["quad_px"] = json!([[5.0, 5.0], [5.0, 5.0], [5.0, 5.0], [5.0, 5.0]]),
    |p| p.manifest["panels"][0]["quad_px"] = json!([[0.0, 0.0], [1e300, 0.0], [1e300, 1e300], [0.0, 1e300]]),
    |p| {
        p.manifest["panels"] =
            (1..=100_000).map(|n| json!({"panel": n, "image": 0, "quad_px": QUAD})).collect();
    },
    |p| {
        p.manifest["panels"] =
            (0..100_000).map(|_| json!({"panel": 0, "image": 9, "quad_px": QUAD})).collect();
    },
    |p| p.manifest["images"] = json!([]),
    |p| p.manifest["images"][0]["width_px"] = json!(0),
    |p| p.manifest["images"][0]["height_px"] = json!(u32::MAX),
    |p| p.manifest["images"][0]["file"] = json!("/dev/zero"),
    |p| p.manifest["calibration"]["time"]["interval_s"]["value"] = json!(-1.0),
];

const QUAD: [[f64; 2]; 4] = [[10.0, 10.0], [200.0, 10.0], [200.0, 200.0], [10.0, 200.0]];

pub(super) fn documents(folder: &Path) -> Vec<Dropped> {
    let mut files = Vec::new();
    for (at, change) in CHANGES.iter().enumerate() {
        let mut plate = Specimen::read();
        change(&mut plate);
        let path = plate.unpack(&folder.join(format!("change-{at}")), &format!("plate-{at}"));
        files.push(Dropped { path, may_open: false });
    }
    // Devices and pipes in the place of pictures: the plate is good, and opens without its photograph.
    for (at, file) in ["../../../../../../../../../../../../dev/zero", "..", ""].into_iter().enumerate() {
        let mut plate = Specimen::read();
        plate.manifest["images"][0]["file"] = file.into();
        let path = plate.unpack(&folder.join(format!("picture-{at}")), &format!("pictured-{at}"));
        files.push(Dropped { path, may_open: true });
    }
    files.extend(texts(&folder.join("texts")));
    files
}

/// Text that is no document: cut short, or with something in it that no JSON has.
fn texts(folder: &Path) -> Vec<Dropped> {
    let path = Specimen::read().unpack(folder, "whole");
    let annotation = std::fs::read_to_string(&path).unwrap();
    let manifest = std::fs::read_to_string(folder.join("whole.json")).unwrap();
    let mut all: Vec<(String, Vec<u8>)> = Vec::new();
    for share in [0.001, 0.01, 0.2, 0.5, 0.8, 0.999] {
        let cut = |text: &str| text.as_bytes()[..(share * text.len() as f64) as usize].to_vec();
        all.push((format!("annotation-{share}"), cut(&annotation)));
        all.push((format!("manifest-{share}"), cut(&manifest)));
    }
    let known = "\"plate\": \"annotator\" ";
    for (name, text) in [
        ("brackets", "[".repeat(100_000)),
        ("known-brackets", known.to_string() + &"[".repeat(100_000)),
        ("braces", format!("{{{known}, \"panels\":{}", "{\"a\":".repeat(100_000))),
        ("not-a-number", annotation.replacen("\"visible_sd_px\":", "\"visible_sd_px\": NaN, \"x\":", 1)),
        ("infinite", annotation.replacen("\"visible_sd_px\":", "\"visible_sd_px\": 1e999, \"x\":", 1)),
        ("twice", annotation.replacen("\"schema\":1", "\"schema\":1,\"schema\":1", 1)),
        (
            "point-twice",
            annotation.replacen("\"poll\":", "\"poll\":{\"state\":\"absent\",\"by\":\"hand\"},\"poll\":", 1),
        ),
        ("more-behind", annotation.clone() + "{}"),
        ("marked-order", format!("\u{feff}{annotation}")),
        ("blank", " \n\t ".into()),
        ("zeros", "\0".repeat(10_000)),
        ("null", "null".into()),
        ("other-tool", "{\"shapes\": [], \"imagePath\": \"x.jpg\"}".into()),
    ] {
        all.push((name.into(), text.into_bytes()));
    }
    let wide: Vec<u8> = annotation.encode_utf16().flat_map(u16::to_le_bytes).collect();
    all.push(("sixteen-bits".into(), wide));
    all.push(("no-text".into(), vec![b'{', 0xff, 0xfe, b'}']));
    let write_one = |(name, content): (String, Vec<u8>)| {
        let path = folder.join(format!("annotations/{name}.json"));
        write(&path, &content);
        Dropped { path, may_open: false }
    };
    all.into_iter().map(write_one).collect()
}
