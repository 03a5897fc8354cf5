//! Files as other people have them: names, orders of rows, animals, likelihoods, sizes.

use std::collections::BTreeMap;

use super::*;

#[test]
fn rows_go_by_the_name_of_their_picture_and_not_by_their_order() {
    let shuffled = labels(
        ["near_hock", "dock"],
        &[
            "labeled-data,p,img005.png,1,2,,",
            "labeled-data,p,img002.png,3,4,5,6",
            "labeled-data,p,img099.png,1,1,1,1",
        ],
    );
    let import = imported("l.csv", &shuffled).unwrap();
    let at = |panel, [x, y]: [f64; 2]| {
        Some(Cutouts.plate_from_panel(panel, [x + 0.5, y + 0.5]).unwrap().map(|v| (v * 1e6).round() / 1e6))
    };
    assert_eq!(panel_of(&import, 5), [("near_hock", at(5, [1.0, 2.0]), KeypointState::Visible)]);
    assert_eq!(panel_of(&import, 2).len(), 2);
    assert_eq!(import.panels.len(), 2);
    assert!(import.notes.iter().any(|note| note.starts_with("2 points skipped") && note.contains("img099")));
    assert!(import.notes.iter().any(|note| note.contains("rows are of `p`")), "{:?}", import.notes);
    // The old layout, with back-slashes, is the same.
    let old =
        "scorer,S,S\r\nbodyparts,Near Hock,Near Hock\r\ncoords,x,y\r\nlabeled-data\\p\\img005.png,1,2\r\n";
    assert_eq!(panel_of(&imported("l.csv", old).unwrap(), 5), panel_of(&import, 5));
}

#[test]
fn rows_of_another_film_stay_out() {
    let two = ["labeled-data,other,img001.png,1,2,3,4", "labeled-data,test-plate,img001.png,5,6,,"];
    let import = imported("l.csv", &labels(["dock", "poll"], &two)).unwrap();
    assert_eq!(panel_of(&import, 1).len(), 1);
    let none = ["labeled-data,other,img001.png,1,2,3,4", "labeled-data,third,img001.png,5,6,,"];
    let error = imported("l.csv", &labels(["dock", "poll"], &none)).unwrap_err().to_string();
    assert!(error.contains("other, third") && error.contains("test-plate"), "{error}");
}

#[test]
fn one_animal_of_a_project_of_several_is_read_and_two_are_refused() {
    let text = "scorer,,,S,S,S,S\nindividuals,,,a,a,single,single\nbodyparts,,,dock,dock,poll,poll\ncoords,,,x,y,x,y\n\
                labeled-data,v,img001.png,1,2,3,4\n";
    assert_eq!(panel_of(&imported("l.csv", text).unwrap(), 1).len(), 2);
    let error = imported("l.csv", &text.replace("single", "b")).unwrap_err().to_string();
    assert!(error.contains("2 animals (a, b)"), "{error}");
}

#[test]
fn likelihoods_are_states_and_frames_are_panels_in_order() {
    let text = "scorer,N,N,N,N,N,N\nbodyparts,dock,dock,dock,poll,poll,poll\ncoords,x,y,likelihood,x,y,likelihood\n\
                0,1,2,0.99,3,4,0.3\n5,1,2,0.6,3,4,0.05\n6,1,2,1,,,\n";
    let import = imported("l.csv", text).unwrap();
    let states = |panel| panel_of(&import, panel).iter().map(|p| (p.0, p.2)).collect::<Vec<_>>();
    assert_eq!(states(1), [("poll", KeypointState::Occluded), ("dock", KeypointState::Visible)]);
    assert_eq!(states(6), [("dock", KeypointState::Visible)]);
    assert!(import.panels[0].1.iter().all(|(_, placed)| placed.by == PlacedBy::Tracked));
    let all = import.notes.join("\n");
    for said in ["tracked", "frame 0", "frame 6", "next to no likelihood"] {
        assert!(all.contains(said), "{said}: {all}");
    }
}

#[test]
fn known_vocabularies_are_understood_as_far_as_they_mark_the_same_point() {
    let expect = |facing, theirs: &str, ours: &str| {
        let table = NameTable::new(facing, &BTreeMap::new()).unwrap();
        let meaning = table.meaning(theirs);
        let expected = Keypoint::from_name(ours).map_or(names::Meaning::Unknown, names::Meaning::Point);
        assert_eq!(meaning, expected, "{theirs}");
    };
    let right = Some(Facing::Right);
    // A horse facing right shows its right side, so the horseman's near side, its left, is off.
    for (theirs, ours) in [
        ("Nose", "muzzle"),
        ("Wither", "withers"),
        ("Elbow", "near_elbow"),
        ("Nearfrontfoot", "off_fore_hoof"),
        ("Offhindhock", "near_hock"),
        ("front_left_thai", "off_elbow"),
        ("back_right_knee", "near_hock"),
        ("back_right_paw", "near_hind_hoof"),
        ("tail_base", "dock"),
        ("Hip", "-"),
        ("Eye", "-"),
        ("front_left_knee_cap", "-"),
        ("NEAR HOCK", "near_hock"),
    ] {
        expect(right, theirs, ours);
    }
    expect(Some(Facing::Left), "Nearfrontfoot", "near_fore_hoof");
    expect(None, "nose", "muzzle");
    let table = NameTable::new(None, &BTreeMap::new()).unwrap();
    assert_eq!(table.meaning("Nearknee"), names::Meaning::NeedsFacing);
}

#[test]
fn a_table_of_ones_own_comes_first() {
    let text = labels(["hufe", "nose"], &["labeled-data,v,img001.png,1,2,3,4"]);
    let own = BTreeMap::from([("HUFE".into(), Some("near_fore_hoof".into())), ("nose".into(), None)]);
    let import = imported_as("l.csv", &text, &manifest(), &own).unwrap();
    assert_eq!(panel_of(&import, 1).iter().map(|p| p.0).collect::<Vec<_>>(), ["near_fore_hoof"]);
    let wrong = BTreeMap::from([("hufe".into(), Some("hoof".into()))]);
    let error = imported_as("l.csv", &text, &manifest(), &wrong).unwrap_err();
    assert!(matches!(error, ExchangeError::Name { .. }));
}

#[test]
fn a_point_said_twice_is_an_error_with_both_places() {
    let twice = labels(["nose", "muzzle"], &["labeled-data,v,img001.png,1,2,3,4"]);
    let error = imported("l.csv", &twice).unwrap_err().to_string();
    assert!(error.contains("`nose`") && error.contains("`muzzle`") && error.contains("line 4"), "{error}");
    let rows = ["labeled-data,v,img001.png,1,2,,", "labeled-data,v,img001.png,3,4,,"];
    let error = imported("l.csv", &labels(["dock", "poll"], &rows)).unwrap_err().to_string();
    assert!(error.contains("line 4") && error.contains("line 5"), "{error}");
}

#[test]
fn a_picture_of_another_size_is_skipped() {
    let export = exported(&filled(3), Format::Coco, None);
    let text = String::from_utf8(export.files[0].1.clone()).unwrap();
    let resized = text.replace("\"width\": 200", "\"width\": 100");
    let import = imported("c.json", &resized).unwrap();
    assert_eq!((import.point_count(), import.notes.len()), (0, 1));
    assert!(import.notes[0].contains("another size"), "{:?}", import.notes);
}

#[test]
fn points_on_the_plate_without_a_panel_go_where_they_lie() {
    let export = exported(&filled(4), Format::Coco, Some(Space::Plate));
    let text = String::from_utf8(export.files[0].1.clone()).unwrap();
    let anonymous = text.replace("muybridge_panel", "somebody_elses");
    assert_eq!(imported("c.json", &anonymous).unwrap().panels, imported("c.json", &text).unwrap().panels);
}

#[test]
fn frames_of_a_plate_of_single_files_keep_their_own_names() {
    let mut frames = manifest();
    frames.panels.truncate(2);
    let [width, height] = SIZE_PX.map(f64::from);
    for (index, panel) in frames.panels.iter_mut().enumerate() {
        panel.image = index;
        panel.quad_px = [[0.0, 0.0], [width, 0.0], [width, height], [0.0, height]];
    }
    let image =
        |file: &str| PlateImage { file: file.into(), sha256: "0".repeat(64), width_px: 200, height_px: 120 };
    // Numbered from 0, as DeepLabCut does: img001 is the second panel.
    frames.images = vec![image("frames/img000.png"), image("frames/img001.png")];
    let text = labels(["dock", "poll"], &["labeled-data,v,img001.png,10,20,,"]);
    let import = imported_as("l.csv", &text, &frames, &BTreeMap::new()).unwrap();
    assert_eq!(panel_of(&import, 2), [("dock", Some([10.5, 20.5]), KeypointState::Visible)]);
    let mut annotation = annotation();
    import.merge_into(&mut annotation, Existing::KeepHand);
    let export =
        export(&frames, &annotation, &Cutouts, Format::DeepLabCut, &ExportOptions::default()).unwrap();
    assert!(String::from_utf8_lossy(&export.files[1].1).contains(",img001.png,"));
    assert_eq!(export.pictures[1].source, PictureSource::Image(1));
    frames.images[1].file = "others/img000.png".into();
    let again = super::export(&frames, &annotation, &Cutouts, Format::Coco, &ExportOptions::default());
    assert!(matches!(again, Err(ExchangeError::SameName(_))), "{again:?}");
}

#[test]
fn what_a_person_placed_stays_unless_it_is_to_be_replaced() {
    let import =
        imported("p.csv", "panel,keypoint,x_px,y_px\n1,dock,30,40\n1,poll,31,41\n3,back,530,40\n").unwrap();
    let placed = |by| Placed { at_px: Some([50.0, 50.0]), state: KeypointState::Visible, by, sd_px: None };
    let (poll, dock) = (Keypoint::from_name("poll").unwrap(), Keypoint::from_name("dock").unwrap());
    let mut there = annotation();
    there.panels = vec![PanelAnnotation::empty(1), PanelAnnotation::empty(6)];
    there.panels[0].keypoints.insert(dock, placed(PlacedBy::Hand));
    there.panels[0].keypoints.insert(poll, placed(PlacedBy::Interpolated));
    let mut all = there.clone();
    assert_eq!(
        import.merge_into(&mut there, Existing::KeepHand),
        Merged { added: 1, replaced: 1, same: 0, kept: 1 }
    );
    assert_eq!(there.panels.iter().map(|panel| panel.panel).collect::<Vec<_>>(), [1, 3, 6]);
    assert_eq!(there.panels[0].keypoints.place(dock), Some([50.0, 50.0]));
    assert_eq!(
        import.merge_into(&mut all, Existing::Replace),
        Merged { added: 1, replaced: 2, same: 0, kept: 0 }
    );
    assert_eq!(all.panels[0].keypoints.place(dock), Some([30.0, 40.0]));
}

#[test]
fn a_point_that_was_not_moved_elsewhere_keeps_what_the_format_could_not_say() {
    let known = filled(5);
    for format in Format::ALL {
        let export = exported(&known, format, None);
        // Of the two tables of DeepLabCut the labels.
        let labels = &files(&export)[..if format == Format::DeepLabCut { 1 } else { export.files.len() }];
        let import = import(labels, None, &manifest(), &Cutouts, &BTreeMap::new()).unwrap();
        let mut back = known.clone();
        let merged = import.merge_into(&mut back, Existing::Replace);
        assert_eq!(merged, Merged { same: import.point_count(), ..Merged::default() }, "{format:?}");
        assert_eq!(back, known);
    }
}

#[test]
fn a_point_that_was_moved_in_labelme_was_placed_by_hand() {
    let mut known = annotation();
    let mut keypoints = Keypoints::default();
    for (name, x) in [("dock", 40.0), ("poll", 50.0)] {
        let placed = Placed {
            at_px: Some([x, 60.0]),
            state: KeypointState::Occluded,
            by: PlacedBy::Fitted,
            sd_px: None,
        };
        keypoints.insert(Keypoint::from_name(name).unwrap(), placed);
    }
    known.panels.push(PanelAnnotation { keypoints, ..PanelAnnotation::empty(1) });
    let mut moved = known.clone();
    let poll = Keypoint::from_name("poll").unwrap();
    let placed = Placed {
        at_px: Some([51.0, 60.0]),
        state: KeypointState::Occluded,
        by: PlacedBy::Fitted,
        sd_px: None,
    };
    moved.panels[0].keypoints.insert(poll, placed);
    let files = files(&exported(&moved, Format::Labelme, None));
    let import = import(&files, None, &manifest(), &Cutouts, &BTreeMap::new()).unwrap();
    let merged = import.merge_into(&mut known, Existing::KeepHand);
    assert_eq!(merged, Merged { same: 1, replaced: 1, ..Merged::default() });
    let back = known.panels[0].keypoints.get(poll).unwrap();
    assert_eq!((back.at_px, back.by), (Some([51.0, 60.0]), PlacedBy::Hand));
}
