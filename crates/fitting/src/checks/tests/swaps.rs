//! Near and off exchanged, in one panel, in some and in all.

use super::*;

/// Mean distance between near and off joints of a pair, withers heights.
fn apart(plate: &Plate, index: usize, pair: Pair) -> f64 {
    let height_px = 1.6 * calibrate(&plate.manifest, &plate.annotation).unwrap().stride[index].px_per_m;
    let distances = JOINTS[1..].iter().map(|joint| {
        let [a, b] =
            [NearOff::Near, NearOff::Off].map(|s| place(plate, index, Keypoint::Limb(s, pair, *joint)));
        (a[0] - b[0]).hypot(a[1] - b[1]) / height_px
    });
    distances.sum::<f64>() / 4.0
}

#[test]
fn limbs_exchanged_in_a_panel_are_found_wherever_they_are_apart() {
    let mut plates: Vec<Plate> = Gait::ALL.into_iter().map(specimen).collect();
    plates.push(plate("annotations/sallie-gardner-1878.json"));
    let (mut found, mut total) = (0u32, 0u32);
    for original in &plates {
        // Without a closing there are no neighbours on both sides of the first and last panels.
        let ring = original.annotation.stride.closes_after_panels.is_some();
        let last = original.annotation.stride.last as usize - 1;
        for index in if ring { 0..=last } else { 1..=last - 1 } {
            for pair in [Pair::Fore, Pair::Hind] {
                let mut plate = original.clone();
                plate.annotation.panels[index].swap_near_off(Some(pair));
                let list = concerns(&plate);
                let panel = plate.annotation.panels[index].panel;
                let swaps: Vec<&Concern> =
                    list.iter().filter(|c| c.kind <= ConcernKind::SwappedLimbs).collect();
                let apart = apart(original, index, pair);
                for swap in &swaps {
                    let right = swap.panel == Some(panel) && swap.limb.map(|l| l.1) == Some(pair);
                    assert!(right, "{} {panel} {pair:?}: {swap:?}", plate.manifest.id);
                }
                if apart > 0.15 {
                    total += 1;
                    let first = list.first().is_some_and(|c| c.kind == ConcernKind::SwappedLimbs);
                    found += u32::from(first);
                }
            }
        }
    }
    assert!(total > 80 && f64::from(found) > 0.93 * f64::from(total), "{found} of {total}");
}

#[test]
fn a_panel_exchanged_as_a_whole_and_two_in_a_row_are_found() {
    let mut plate = specimen(Gait::Gallop);
    plate.annotation.panels[4].swap_near_off(None);
    let found = concerns(&plate);
    assert_eq!((found[0].kind, found[0].panel), (ConcernKind::SwappedPanel, Some(5)));
    let mut plate = specimen(Gait::Walk);
    for index in [6, 7] {
        plate.annotation.panels[index].swap_near_off(Some(Pair::Hind));
    }
    let found = concerns(&plate);
    let mut panels: Vec<Option<u32>> = found[..2].iter().map(|c| c.panel).collect();
    panels.sort();
    assert_eq!(panels, [Some(7), Some(8)], "{found:#?}");
    assert!(found[..2].iter().all(|c| c.kind == ConcernKind::SwappedLimbs));
}

#[test]
fn near_and_off_exchanged_in_the_whole_plate_is_told_from_what_is_hidden() {
    let mut plate = specimen(Gait::Walk);
    for panel in &mut plate.annotation.panels {
        panel.swap_near_off(None);
    }
    let found = before_fit(&plate.annotation, &plate.manifest, None);
    assert!(found.iter().any(|c| c.kind == ConcernKind::HiddenNear), "{found:#?}");
}
