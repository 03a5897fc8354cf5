//! The table of faults: what is done to a good pair of files, and what must be said about it.

use muybridge_tests::Workspace;
use serde_json::{Value, json};

/// Identifier of the plate that stays good.
pub(crate) const GOOD: &str = "good-plate";

const A: &str = "annotations/sallie-gardner-1878.json";
const M: &str = "plates/sallie-gardner-1878.json";

/// One fault.
pub(crate) struct Case {
    /// What is wrong, in words.
    pub(crate) name: &'static str,
    /// Makes it so.
    pub(crate) damage: fn(&Workspace),
    /// Further arguments.
    pub(crate) arguments: &'static [&'static str],
    /// Exit code.
    pub(crate) code: i32,
    /// What standard error holds: the file, the panel and field, and what is wrong or to be done.
    pub(crate) says: &'static [&'static str],
}

/// A fault of one plate among good ones.
const fn fault(name: &'static str, damage: fn(&Workspace), says: &'static [&'static str]) -> Case {
    Case { name, damage, arguments: &[], code: 1, says }
}

/// The first panel's withers.
fn withers(document: &mut Value) -> &mut Value {
    &mut document["panels"][0]["keypoints"]["withers"]
}

/// The files themselves.
pub(crate) fn files() -> Vec<Case> {
    vec![
        Case {
            name: "missing annotation",
            damage: |w| std::fs::remove_file(w.path(A)).unwrap(),
            arguments: &["--only", "sallie-gardner-1878"],
            code: 2,
            says: &["--only sallie-gardner-1878", "no such plate", "there are: good-plate"],
        },
        fault("empty annotation", |w| w.write(A, ""), &[A, "the file is empty", "restore"]),
        fault("blank annotation", |w| w.write(A, " \n\n"), &[A, "the file is empty", "restore"]),
        fault(
            "truncated annotation",
            |w| w.write(A, &w.text(A)[..9000]),
            &[A, "panels[", "no valid JSON", "restore"],
        ),
        fault(
            "annotation that is no JSON",
            |w| w.write(A, "points: many\n"),
            &[A, "no valid JSON", "restore"],
        ),
        fault("annotation that is a list", |w| w.write(A, "[1, 2]\n"), &[A, "[1]: invalid type"]),
        fault(
            "text after the end",
            |w| w.write(A, &format!("{} }}", w.text(A))),
            &[A, "no valid JSON", "trailing characters"],
        ),
        fault(
            "annotation in another encoding",
            |w| {
                muybridge_capture::write_atomically(&w.path(A), b"{\"schema\": 1, \"plate\": \"\xe9\"}")
                    .unwrap();
            },
            &[A, "cannot be read", "UTF-8"],
        ),
        fault(
            "missing manifest",
            |w| std::fs::remove_file(w.path(M)).unwrap(),
            &[A, "plate: the manifest", M, "cannot be read", "correct the path"],
        ),
        fault(
            "no manifest named",
            |w| w.edit(A, |a| a["plate"] = "".into()),
            &[A, "plate: the manifest", "cannot be read", "correct the path"],
        ),
        fault("empty manifest", |w| w.write(M, ""), &[M, "the file is empty", "restore"]),
        fault(
            "truncated manifest",
            |w| w.write(M, &w.text(M)[..3000]),
            &[M, "calibration.scale", "no valid JSON", "restore"],
        ),
        fault(
            "two annotations of one plate",
            |w| w.write(A, &w.text(&format!("annotations/{GOOD}.json"))),
            &[A, "plate: good-plate", "annotations/good-plate.json", "keep one"],
        ),
    ]
}

/// Annotation files and the marks and labels in them.
pub(crate) fn annotations() -> Vec<Case> {
    vec![
        fault(
            "newer annotation schema",
            |w| w.edit(A, |a| a["schema"] = 99.into()),
            &[A, "schema: version 99", "update"],
        ),
        fault("no schema", |w| w.replace(A, "\"schema\": 1,", ""), &[A, "schema: missing"]),
        fault("schema in words", |w| w.edit(A, |a| a["schema"] = "one".into()), &[A, "schema: invalid type"]),
        fault(
            "unknown field",
            |w| w.edit(A, |a| a["colour"] = "bay".into()),
            &[A, "colour", "unknown field"],
        ),
        fault(
            "missing field",
            |w| w.replace(A, "\"annotator\": \"project team\",", ""),
            &[A, "missing field `annotator`"],
        ),
        fault(
            "panel without a horse",
            |w| w.edit(A, |a| a["panels"][4]["keypoints"] = json!({})),
            &[A, "panel 5: keypoints", "only 0 points", "mark the panel as unused"],
        ),
        fault(
            "three points only",
            |w| {
                w.edit(A, |a| {
                    let points = a["panels"][4]["keypoints"].as_object_mut().unwrap();
                    *points = points.clone().into_iter().take(3).collect();
                });
            },
            &[A, "panel 5: keypoints", "only 3 points", "place at least 6"],
        ),
        fault(
            "two panels of one number",
            |w| w.edit(A, |a| a["panels"][4]["panel"] = 4.into()),
            &[A, "panel 4: panel", "without repeats"],
        ),
        fault(
            "panel the manifest does not have",
            |w| w.edit(A, |a| a["panels"][11]["panel"] = 13.into()),
            &[A, "panel 13: panel", "the manifest has no panel of this number"],
        ),
        fault(
            "span of panels that do not exist",
            |w| w.edit(A, |a| a["stride"] = json!({ "first": 20, "last": 30, "closes_after_panels": null })),
            &[A, "panel 20: stride.first", "no panel of this number"],
        ),
        fault(
            "span that ends where there is no panel",
            |w| w.edit(A, |a| a["stride"]["last"] = 40.into()),
            &[A, "panel 40: stride.last", "no panel of this number"],
        ),
        fault(
            "span back to front",
            |w| w.edit(A, |a| a["stride"]["first"] = 12.into()),
            &[A, "stride", "first must come"],
        ),
        fault(
            "absolute path",
            |w| w.edit(A, |a| a["plate"] = "/plates/x.json".into()),
            &[A, "plate", "relative"],
        ),
        fault(
            "backslash path",
            |w| w.edit(A, |a| a["plate"] = "..\\plates\\x.json".into()),
            &[A, "plate", "forward slashes"],
        ),
        fault(
            "points of other images",
            |w| w.edit(A, |a| a["images_sha256"][0] = "0".repeat(64).into()),
            &[A, "images_sha256", "other images"],
        ),
        fault(
            "no images",
            |w| w.edit(A, |a| a["images_sha256"] = json!([])),
            &[A, "images_sha256", "other images"],
        ),
        fault(
            "unknown contact",
            |w| w.edit(A, |a| a["panels"][2]["contacts"]["off_hind"] = "hovering".into()),
            &[A, "panels[2].contacts.off_hind", "expected one of", "`swing`"],
        ),
        fault(
            "instant outside the stride",
            |w| {
                w.edit(A, |a| {
                    a["instants"] =
                        json!([{ "side": "near", "pair": "fore", "event": "strike", "at_panel": 40.5 }]);
                });
            },
            &[A, "instants[0].at_panel", "outside the stride"],
        ),
        fault(
            "ground line back to front",
            |w| w.edit(A, |a| a["panels"][3]["ground_px"].as_array_mut().unwrap().reverse()),
            &[A, "panel 4: ground_px", "left one first"],
        ),
        fault(
            "no marks",
            |w| w.edit(A, |a| a["panels"][3]["marks"] = json!([])),
            &[A, "panel 4: marks", "mark two or drive the scale"],
        ),
    ]
}

/// Keypoints.
pub(crate) fn points() -> Vec<Case> {
    vec![
        fault(
            "duplicate keypoint",
            |w| w.replace(A, "\"poll\": {", "\"muzzle\": {"),
            &[A, "panels[0].keypoints", "duplicate keypoint `muzzle`", "keep one"],
        ),
        fault(
            "unknown keypoint",
            |w| w.replace(A, "\"poll\": {", "\"horn\": {"),
            &[A, "panels[0].keypoints", "unknown keypoint `horn`", "the names are muzzle, poll"],
        ),
        fault(
            "NaN as a coordinate",
            |w| w.replace(A, "\"muzzle\": { \"at_px\": [", "\"muzzle\": { \"at_px\": [NaN, "),
            &[A, "panels[0].keypoints.muzzle.at_px[0]", "no valid JSON", "line "],
        ),
        fault(
            "number beyond all numbers",
            |w| w.replace(A, "\"muzzle\": { \"at_px\": [", "\"muzzle\": { \"at_px\": [1e999, "),
            &[A, "panels[0].keypoints.muzzle.at_px[0]", "number out of range", "line "],
        ),
        fault(
            "coordinate in words",
            |w| w.edit(A, |a| withers(a)["at_px"][1] = "high".into()),
            &[A, "panels[0].keypoints.withers.at_px[1]", "invalid type", "line "],
        ),
        fault(
            "coordinate missing",
            |w| w.edit(A, |a| withers(a)["at_px"] = json!([455.0])),
            &[A, "panels[0].keypoints.withers.at_px", "array of length 2"],
        ),
        fault(
            "point outside its panel",
            |w| w.edit(A, |a| withers(a)["at_px"] = json!([1500.0, 220.0])),
            &[A, "panel 1: keypoints.withers", "outside the panel", "move it"],
        ),
        fault(
            "absent point with a place",
            |w| w.edit(A, |a| withers(a)["state"] = "absent".into()),
            &[A, "panel 1: keypoints.withers", "absent but has a place", "remove one"],
        ),
        fault(
            "visible point without a place",
            |w| w.edit(A, |a| *withers(a) = json!({ "state": "visible", "by": "hand" })),
            &[A, "panel 1: keypoints.withers", "no place", "call it absent"],
        ),
        fault(
            "negative repeatability",
            |w| w.edit(A, |a| a["visible_sd_px"] = (-1.5).into()),
            &[A, "visible_sd_px", "more than 0"],
        ),
    ]
}

/// Manifests.
pub(crate) fn manifests() -> Vec<Case> {
    vec![
        fault(
            "newer manifest schema",
            |w| w.edit(M, |m| m["schema"] = 99.into()),
            &[M, "schema: version 99", "update"],
        ),
        fault(
            "unknown gait",
            |w| w.edit(M, |m| m["gait"] = "tolt".into()),
            &[M, "gait", "unknown variant", "`walk`"],
        ),
        fault(
            "identifier that is not the file's name",
            |w| w.edit(M, |m| m["id"] = "../elsewhere".into()),
            &[M, "id", "sallie-gardner-1878"],
        ),
        fault(
            "another image than the one annotated",
            |w| w.write("plates/sallie-gardner-1878.jpg", "not the photograph"),
            &[M, "images[0].sha256", "another image", "get the right file"],
        ),
        fault(
            "hash that is none",
            |w| {
                w.edit(M, |m| m["images"][0]["sha256"] = "unknown".into());
                w.edit(A, |a| a["images_sha256"][0] = "unknown".into());
            },
            &[M, "images[0].sha256", "64 lower-case hexadecimal digits"],
        ),
        fault(
            "corners the wrong way round",
            |w| w.edit(M, |m| m["panels"][2]["quad_px"].as_array_mut().unwrap().reverse()),
            &[M, "panel 3: quad_px", "clockwise from the top left"],
        ),
        fault(
            "corners begun elsewhere",
            |w| w.edit(M, |m| m["panels"][2]["quad_px"].as_array_mut().unwrap().rotate_left(2)),
            &[M, "panel 3: quad_px", "clockwise from the top left"],
        ),
        fault(
            "corner outside the image",
            |w| w.edit(M, |m| m["panels"][2]["quad_px"][1] = json!([9000.0, 75.0])),
            &[M, "panel 3: quad_px", "outside the image"],
        ),
        fault(
            "two panels of one number in the manifest",
            |w| w.edit(M, |m| m["panels"][5]["panel"] = 5.into()),
            &[M, "panel 5: panel", "without repeats"],
        ),
        fault(
            "panel of an image that is not listed",
            |w| w.edit(M, |m| m["panels"][5]["image"] = 1.into()),
            &[M, "panel 6: image", "no image of this index"],
        ),
    ]
}

/// Drives time by intervals, one between each two of the eleven panels.
fn intervals(workspace: &Workspace, first: f64) {
    workspace.edit(M, |m| {
        m["calibration"]["time"]["driven_by"] = "interval".into();
        let mut intervals = vec![0.04; 10];
        intervals[0] = first;
        m["calibration"]["time"]["intervals_s"] = intervals.into();
    });
}

/// What is known of scale and time.
pub(crate) fn calibrations() -> Vec<Case> {
    vec![
        fault(
            "two panels at the same time",
            |w| intervals(w, 0.0),
            &[M, "calibration.time.intervals_s[0]", "two panels cannot have the same time"],
        ),
        fault(
            "negative interval",
            |w| intervals(w, -0.04),
            &[M, "calibration.time.intervals_s[0]", "more than 0"],
        ),
        fault(
            "negative mean interval",
            |w| w.edit(M, |m| m["calibration"]["time"]["interval_s"]["value"] = (-0.04).into()),
            &[M, "calibration.time.interval_s.value", "out of range", "more than 0"],
        ),
        fault(
            "too few intervals",
            |w| w.edit(M, |m| m["calibration"]["time"]["intervals_s"] = json!([0.04])),
            &[A, "stride", "the manifest's intervals_s", "one entry per gap"],
        ),
        fault(
            "a horse that does not advance",
            |w| {
                w.edit(A, |a| {
                    for point in ["withers", "back", "croup", "dock"] {
                        let x = &mut a["panels"][4]["keypoints"][point]["at_px"][0];
                        *x = (x.as_f64().unwrap() - 100.0).into();
                    }
                });
            },
            &[A, "time: panels 4 and 5", "check the intervals, the facing direction and the trunk points"],
        ),
        fault(
            "a horse that runs backwards",
            |w| {
                w.edit(M, |m| {
                    m["facing"] = "left".into();
                    m["calibration"]["time"]["driven_by"] = "interval".into();
                    m["calibration"]["scale"]["known_length"]["plane"] = "track".into();
                });
            },
            &[A, "time: the trunk moves forward by -", "check the facing direction"],
        ),
        fault(
            "scale from a source that is not given",
            |w| w.edit(M, |m| m["calibration"]["scale"]["known_length"] = Value::Null),
            &[M, "calibration.scale.driven_by", "a source that is not given"],
        ),
        fault(
            "time from a source that is not given",
            |w| w.edit(M, |m| m["calibration"]["time"]["driven_by"] = "stride_time".into()),
            &[M, "calibration.time.driven_by", "a source that is not given"],
        ),
        fault(
            "scale of nothing",
            |w| {
                w.edit(M, |m| {
                    m["calibration"]["scale"]["known_length"]["mark_spacing_m"]["value"] = 0.into();
                });
            },
            &[M, "calibration.scale.known_length.mark_spacing_m.value", "out of range", "more than 0"],
        ),
        fault(
            "speed of no horse",
            |w| w.edit(M, |m| m["calibration"]["time"]["speed_m_s"]["value"] = 300.into()),
            &[M, "calibration.time.speed_m_s.value", "300 is out of range"],
        ),
        fault(
            "unknown source",
            |w| w.edit(M, |m| m["calibration"]["scale"]["driven_by"] = "guess".into()),
            &[M, "calibration.scale.driven_by", "unknown variant `guess`", "`known_length`"],
        ),
    ]
}
