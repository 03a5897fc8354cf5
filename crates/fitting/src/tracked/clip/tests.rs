//! Good and damaged clips.

use super::*;
use crate::track_table::MOST_BYTES;

/// A clip of two frames in which every number of a point differs.
fn good() -> String {
    let mut rows = ["scorer".to_string(), "bodyparts".into(), "coords".into(), "0".into(), "1".into()];
    for (index, point) in POINTS.iter().enumerate() {
        for (coordinate, name) in COORDINATES.iter().enumerate() {
            let value = if coordinate == 2 { 0.9 } else { (100 * index + coordinate) as f64 };
            let [scorer, points, coordinates, first, second] = &mut rows;
            scorer.push_str(",me");
            points.push_str(&format!(",{point}"));
            coordinates.push_str(&format!(",{name}"));
            first.push_str(&format!(",{value}"));
            second.push_str(&format!(",{}", value * 0.5));
        }
    }
    rows.join("\n") + "\n"
}

fn parse(text: &str) -> Result<Clip, ClipFault> {
    Clip::parse("test".into(), text.as_bytes())
}

#[test]
fn points_are_found_by_name() {
    let clip = parse(&good()).unwrap();
    assert_eq!(clip.frames(), 2);
    assert_eq!(clip.withers()[0].at_px, [200.0, 201.0]);
    assert_eq!(clip.hoof(Limb::RH)[0].at_px, [1500.0, 1501.0]);
    let gap = parse(&good().replace("\n1,0,0.5,0.45,", "\n1,,,,")).unwrap();
    assert_eq!(gap.nostril()[1].likelihood, 0.0);
}

#[test]
fn damaged_files_are_errors_that_say_where() {
    let good = good();
    assert!(matches!(parse(""), Err(ClipFault::Empty)));
    assert!(matches!(parse("frame,x,y\n0,1,2\n"), Err(ClipFault::Header)));
    assert!(
        matches!(parse(&good.replace("Poll", "Tail")), Err(ClipFault::UnknownPoint(name)) if name == "Tail")
    );
    assert!(matches!(parse(&good.replace("Poll", "Hip")), Err(ClipFault::Column(..))));
    assert!(matches!(
        parse(&good.replace(",101,", ",inf,")),
        Err(ClipFault::Number { line: 4, column: 6, .. })
    ));
    assert!(matches!(parse(&good.replace(",0.45\n", ",4.5\n")), Err(ClipFault::Number { line: 5, .. })));
    assert!(matches!(parse(&good.replace("\n1,", "\n2,")), Err(ClipFault::Frame { line: 5, .. })));
    let header_only: String = good.lines().take(3).flat_map(|line| [line, "\n"]).collect();
    assert!(matches!(parse(&header_only), Err(ClipFault::NoFrames)));
    assert!(Clip::parse("bytes".into(), &[0xff, 0xfe, 0x00, 0x9c, 0x0a]).is_err());
    assert!(matches!(
        parse(&good[..good.len() - 6]),
        Err(ClipFault::Cells { line: 5, found: 48, expected: 49 })
    ));
    // Cut off anywhere it may be a shorter clip or an error, but no panic.
    for end in 0..good.len() {
        if let Ok(clip) = parse(&good[..end]) {
            assert!(clip.frames() <= 2);
        }
    }
}

#[test]
fn files_that_are_no_files_are_errors_with_their_path() {
    let error = Clip::read(Path::new("/nowhere/walk.csv")).unwrap_err();
    assert!(error.to_string().starts_with("/nowhere/walk.csv: cannot be read"), "{error}");
    assert!(Clip::read(Path::new(env!("CARGO_MANIFEST_DIR"))).is_err());
}

#[test]
fn a_file_that_is_too_long_is_not_read() {
    let path = std::env::temp_dir().join(format!("muybridge-clip-{}.csv", std::process::id()));
    std::fs::File::create(&path).unwrap().set_len(MOST_BYTES + 1).unwrap();
    let error = Clip::read(&path).unwrap_err();
    std::fs::remove_file(&path).unwrap();
    assert!(matches!(error.fault, ClipFault::TooBig));
}
