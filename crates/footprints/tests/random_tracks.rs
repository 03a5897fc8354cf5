//! The two solvers over two hundred random tracks, and the gradient solver from three starts.

use std::thread;

use glam::DVec3;
use muybridge_core::Random;
use muybridge_footprints::{
    Character, Energy, Knot, Method, Motion, Problem, descend, random_track, solve, solve_from,
};

const TRACKS: u64 = 200;
/// Greatest changes of the paper's start for the second one: place, metres, and velocity, m/s.
const SHAKEN: [f64; 2] = [0.3, 1.0];
/// Two energies this near to one another (relative) are the same minimum.
const SAME: f64 = 0.01;

/// Energies that were found for a track.
struct Found {
    name: String,
    greedy: Energy,
    /// By the gradient: from the paper's start, from that one shaken, and from where the greedy search ended.
    gradient: [Energy; 3],
    /// The same without the solver's first step, which leads from all starts to the same pendulum's motion.
    descent: [Energy; 3],
}

impl Found {
    fn of(seed: u64) -> Self {
        let track = random_track(seed);
        let Some(character) = Character::named(&track.model) else { panic!("no model {}", track.model) };
        let motion = Motion::solve(&track, &character, Method::Gradient);
        let motion = motion.unwrap_or_else(|error| panic!("track {seed}: {error}"));
        let problem = motion.problem();
        let greedy = solve(problem, Method::Greedy);
        let starts = [problem.start(), shaken(problem, seed), greedy.trajectory.knots];
        let gradient = starts.clone().map(|start| solve_from(problem, start, Method::Gradient).energy);
        let descent = starts.map(|start| descend(problem, start).energy);
        let name = format!("{} of a {}", track.name.unwrap_or_default(), track.model);
        Self { name, greedy: greedy.energy, gradient, descent }
    }

    /// How much lower the gradient solver's energy is than the greedy one's, share.
    fn lower(&self) -> f64 {
        1.0 - self.gradient[0].total() / self.greedy.total()
    }
}

fn lowest(energies: &[Energy; 3]) -> f64 {
    energies.map(Energy::total).into_iter().fold(f64::INFINITY, f64::min)
}

/// How much the worst of several energies loses against the best one, share.
fn spread(energies: &[Energy; 3]) -> f64 {
    let totals = energies.map(Energy::total);
    totals.into_iter().fold(0.0, f64::max) / lowest(energies) - 1.0
}

/// The paper's start with every number changed by chance.
fn shaken(problem: &Problem, seed: u64) -> Vec<Knot> {
    let mut random = Random::new(seed);
    let mut by = |most: f64| DVec3::from_array([(); 3].map(|()| random.between(-most, most)));
    let shake = |knot: Knot| Knot { at: knot.at + by(SHAKEN[0]), velocity: knot.velocity + by(SHAKEN[1]) };
    problem.start().into_iter().map(shake).collect()
}

fn found() -> Vec<Found> {
    let workers = thread::available_parallelism().map_or(1, usize::from) as u64;
    let part =
        |worker: u64| (worker..TRACKS).step_by(workers as usize).map(Found::of).collect::<Vec<Found>>();
    thread::scope(|scope| {
        let running: Vec<_> = (0..workers).map(|worker| scope.spawn(move || part(worker))).collect();
        running.into_iter().flat_map(|worker| worker.join().unwrap_or_default()).collect()
    })
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

#[test]
fn the_gradient_finds_lower_energies_than_the_greedy_search_and_the_same_ones_from_anywhere() {
    let found = found();
    assert_eq!(found.len() as u64, TRACKS);
    let not_lower: Vec<&Found> = found.iter().filter(|found| found.lower() < 0.0).collect();
    let differing: Vec<&Found> = found.iter().filter(|found| spread(&found.gradient) > SAME).collect();
    let lower = median(found.iter().map(Found::lower).collect());
    println!(
        "{} of {TRACKS} tracks: gradient <= greedy; median {:.1} % lower",
        found.len() - not_lower.len(),
        100.0 * lower
    );
    println!(
        "{} of {TRACKS} tracks: three starts agree to {} %",
        found.len() - differing.len(),
        100.0 * SAME
    );
    let descents = found.iter().filter(|found| spread(&found.descent) <= SAME).count();
    println!("{descents} of {TRACKS} tracks: they do without the pendulum's step, the solver's first one");
    let missed =
        found.iter().filter(|found| lowest(&found.descent) < (1.0 - SAME) * found.gradient[0].total());
    let missed = missed.count();
    println!("{missed} of {TRACKS} tracks: a start finds what is lower by more than that");
    for found in &not_lower {
        println!(
            "  not lower: {}: {:.4} against {:.4}",
            found.name,
            found.gradient[0].total(),
            found.greedy.total()
        );
    }
    for found in &differing {
        println!(
            "  differing: {}: {:.4?}, greedy {:.4}",
            found.name,
            found.gradient.map(Energy::total),
            found.greedy.total()
        );
    }
    assert!(not_lower.is_empty());
    assert!(lower >= 0.05, "{lower}");
    assert!(differing.len() as f64 <= 0.05 * TRACKS as f64, "{} differ", differing.len());
    // The first step makes the three agree; what the solver does without it, 148 and 18 of 200 when this was written, must not get worse.
    assert!(descents >= 140, "{descents} agree without the first step");
    assert!(missed <= 24, "in {missed} a start descends lower");
}
