//! Tests of the tracks by chance.

use super::*;
use crate::placed::Placed;

const SEEDS: u64 = 600;

fn placed(track: &Track) -> Placed {
    let model = Model::named(&track.model).unwrap();
    track
        .place(&model.timing)
        .unwrap_or_else(|error| panic!("{:?}: {error}\n{}", track.name, track.to_json()))
}

fn tracks_of(kind: Kind) -> Vec<Track> {
    let of_kind = |track: &Track| track.name.as_ref().unwrap().starts_with(kind.name());
    (0..SEEDS).map(random_track).filter(of_kind).collect()
}

/// Whether somebody is in the air before this footfall.
fn flies_to(placed: &Placed, strike: usize) -> bool {
    let strike_s = placed.prints[strike].strike_s;
    strike_s > 0.0 && placed.prints[..strike].iter().all(|print| print.lift_off_s < strike_s)
}

#[test]
fn every_track_can_be_placed_and_has_2_to_24_steps() {
    for seed in 0..SEEDS {
        let track = random_track(seed);
        assert!((3..=25).contains(&track.prints.len()), "{:?} has {}", track.name, track.prints.len());
        let placed = placed(&track);
        assert!(placed.end_s > 0.2 && placed.end_s < 60.0, "{:?} takes {} s", track.name, placed.end_s);
        assert!(placed.prints.iter().any(|print| print.lift_off_s == placed.end_s), "{:?}", track.name);
    }
    for seed in [u64::MAX, 1 << 63, 0xdead_beef] {
        placed(&random_track(seed));
    }
}

#[test]
fn seeds_choose_every_model_every_kind_and_every_mixture_of_times() {
    let tracks: Vec<Track> = (0..200).map(random_track).collect();
    for kind in Kind::ALL {
        for model in &MODEL_NAMES[..3] {
            let such = |track: &&Track| {
                track.model == *model && track.name.as_ref().unwrap().starts_with(kind.name())
            };
            assert!(tracks[..24].iter().filter(such).count() == 1, "{kind:?} {model}");
        }
    }
    let own = |track: &Track| track.prints.iter().filter(|print| print.timing.is_some()).count();
    assert!(tracks.iter().filter(|track| own(track) == 0).count() > 20);
    assert!(tracks.iter().filter(|track| own(track) + 2 >= track.prints.len()).count() > 40);
    assert!(tracks.iter().filter(|track| own(track) > 2 && own(track) + 2 < track.prints.len()).count() > 20);
}

#[test]
fn equal_seeds_give_equal_files_that_read_as_they_were_written() {
    for seed in 0..100 {
        let text = random_track(seed).to_json();
        assert_eq!(text, random_track(seed).to_json());
        assert_eq!(Track::from_json(&text).unwrap(), random_track(seed), "{text}");
    }
}

#[test]
fn hops_are_flights_on_one_foot_and_on_two() {
    for kind in [Kind::HopsOnOneFoot, Kind::HopsOnTwoFeet] {
        for track in tracks_of(kind) {
            let placed = placed(&track);
            let mut feet: Vec<Foot> = placed.prints.iter().map(|print| print.foot).collect();
            feet.sort();
            feet.dedup();
            assert_eq!(feet.len(), if kind == Kind::HopsOnOneFoot { 1 } else { 2 });
            let landings = (1..placed.prints.len()).filter(|i| kind == Kind::HopsOnOneFoot || i % 2 == 0);
            for i in landings {
                assert!(flies_to(&placed, i), "{:?}: no flight to print {}", track.name, i + 1);
            }
        }
    }
}

#[test]
fn walks_never_leave_the_ground_and_runs_do() {
    for kind in Kind::ALL.into_iter().filter(|kind| kind.is_walked()) {
        let tracks = tracks_of(kind);
        let flies = |track: &&Track| {
            let placed = placed(track);
            (1..placed.prints.len()).any(|i| flies_to(&placed, i))
        };
        let flying: Vec<_> = tracks.iter().filter(flies).map(|track| track.name.clone()).collect();
        assert!(flying.len() * 10 <= tracks.len(), "{flying:?} of {} {kind:?}", tracks.len());
    }
    let runs = tracks_of(Kind::Run);
    let flies = |track: &&Track| {
        let placed = placed(track);
        (1..placed.prints.len()).any(|i| flies_to(&placed, i))
    };
    assert!(runs.iter().filter(flies).count() * 2 > runs.len());
}

#[test]
fn stairs_are_climbed_one_at_a_time() {
    for kind in [Kind::Stairs, Kind::SpiralStairs] {
        for track in tracks_of(kind) {
            let (Terrain::Stairs { rise_m, .. } | Terrain::SpiralStairs { rise_m, .. }) = track.terrain
            else {
                panic!("{:?}", track.terrain)
            };
            let heights_m: Vec<f64> = placed(&track).prints.iter().map(|print| print.middle.y).collect();
            for pair in heights_m.windows(2) {
                let stairs = (pair[1] - pair[0]) / rise_m;
                assert!(stairs.abs() < 1e-9 || (stairs - 1.0).abs() < 1e-9, "{:?}: {stairs}", track.name);
            }
            assert!(
                heights_m.len() < 5 || heights_m[heights_m.len() - 1].abs() >= rise_m.abs(),
                "{:?}",
                track.name
            );
        }
    }
}
